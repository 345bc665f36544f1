"""Film thickness by published formulas: the first guess of the solver and the check of its answer.

All take the groups of :mod:`tehl.scaling`: mean speed in U, both built on R_x. A film is given as
``H = h R_x / a_x^2`` and in metres.

References
----------
.. [1] B. J. Hamrock and D. Dowson, J. Lubrication Technology 99 (1977), 264-276.
.. [2] R. J. Chittenden, D. Dowson, J. F. Dunn and C. M. Taylor, Proc. R. Soc. A 397 (1985),
   245-294.
.. [3] G. Nijenbanning, C. H. Venner and H. Moes, Wear 176 (1994), 217-229.
.. [4] W. R. D. Wilson and S. Sheu, J. Lubrication Technology 105 (1983), 187-188.
.. [5] L. E. Murch and W. R. D. Wilson, J. Lubrication Technology 97 (1975), 212-216.
.. [6] P. K. Gupta, H. S. Cheng, D. Zhu, N. H. Forster and J. B. Schrand, Tribology Transactions 35
   (1992), 621-626.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from tehl.problem import ContactProblem
from tehl.scaling import Groups, ScaledProblem, Scales

Regime = Literal[
    "rigid-isoviscous", "elastic-isoviscous", "rigid-piezoviscous", "elastic-piezoviscous"
]


WIDE, SLENDER = 0.7, 1.4
"""R_x/R_y up to and from which a contact is no circle to the formulas for the minimum film.

Against solves at L = 10 (mineral oil, steel) both are 0 to 5 % off at R_x/R_y = 0.2 and M = 50 to
150, 13 % too thick at 0.4 and M = 300, and up to 6 % too thin for an incompressible Barus liquid at
0.5 and M = 50. At R_x/R_y = 2 and M = 150 they are 50 % too thick.
"""

ROLLING = 0.05
"""Slide-roll ratio up to which a contact counts as pure rolling."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Range:
    """Range of one group over which a formula holds, or over which it was compared with solves.

    Attributes
    ----------
    group : str
        Field of :class:`tehl.scaling.Groups`.
    low, high : float
        Limits, both included.
    """

    group: str
    low: float
    high: float

    def remark(self, groups: Groups) -> str | None:
        """Return what is wrong in a sentence, None inside the range."""
        value = getattr(groups, self.group)
        if self.low * (1 - 1e-9) <= value <= self.high * (1 + 1e-9):
            return None
        return f"{self.group} = {value:.4g} is outside {self.low:g} to {self.high:g}"


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmRatio:
    """What a formula gives: film over R_x; ``minimum`` None where the formula has none."""

    central: float
    minimum: float | None


@dataclass(frozen=True, kw_only=True, slots=True)
class Formula:
    """A film formula with where it holds.

    Attributes
    ----------
    name, source : str
        Authors, and where it was published.
    film : callable
        From groups to :class:`FilmRatio`.
    regimes : tuple of str
        Regimes it was made for.
    ranges : tuple of Range
        Groups it was made for.
    minimum_limit : float
        Moes load above which its minimum film is known to be too thick, for contacts that are not
        wide.
    """

    name: str
    source: str
    film: Callable[[Groups], FilmRatio]
    regimes: tuple[Regime, ...]
    ranges: tuple[Range, ...]
    minimum_limit: float = math.inf


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmEstimate:
    """Film thickness by one formula.

    Attributes
    ----------
    formula, source : str
        Which.
    central, minimum : float
        H [-]; ``minimum`` is None where the formula has none.
    central_m, minimum_m : float
        The same in metres.
    remarks : tuple of str
        Why both values may be off; empty inside the range of the formula.
    minimum_remark : str or None
        Why the minimum may be off though the central film is not.
    """

    formula: str
    source: str
    central: float
    minimum: float | None
    central_m: float
    minimum_m: float | None
    remarks: tuple[str, ...]
    minimum_remark: str | None

    @property
    def valid(self) -> bool:
        """Whether the formula was made for this contact."""
        return not self.remarks


@dataclass(frozen=True, kw_only=True, slots=True)
class Asymptotes:
    """The four limits of the Nijenbanning-Venner-Moes formula, in Moes form [-]."""

    rigid_isoviscous: float
    elastic_isoviscous: float
    rigid_piezoviscous: float
    elastic_piezoviscous: float
    unloaded: float


def hertz_ratio_squared(groups: Groups) -> float:
    """Return ``(a_x / R_x)^2`` [-], from W, the ellipticity and the deflection factor."""
    cube = 3.0 * groups.W / (math.pi**2 * groups.ellipticity * groups.deflection_factor)
    return math.cbrt(cube) ** 2


def moes_film_unit(groups: Groups) -> float:
    """Return ``H / H_Moes`` [-]: ``(3M/2)^(-2/3)`` on a circle."""
    return math.sqrt(2.0 * groups.U) / hertz_ratio_squared(groups)


def hamrock_dowson(groups: Groups) -> FilmRatio:
    """Return the film of Hamrock and Dowson [1]_, with the exact ellipticity."""
    k, u, g, w = groups.ellipticity, groups.U, groups.G, groups.W
    return FilmRatio(
        central=2.69 * u**0.67 * g**0.53 * w**-0.067 * (1.0 - 0.61 * math.exp(-0.73 * k)),
        minimum=3.63 * u**0.68 * g**0.49 * w**-0.073 * (1.0 - math.exp(-0.68 * k)),
    )


def chittenden(groups: Groups) -> FilmRatio:
    """Return the film of Chittenden and others [2]_ for entrainment along a principal axis."""
    common = groups.U**0.68 * groups.G**0.49 * groups.W**-0.073
    side = groups.radius_ratio ** (-2.0 / 3.0)
    return FilmRatio(
        central=4.31 * common * (1.0 - math.exp(-1.23 * side)),
        minimum=3.68 * common * (1.0 - math.exp(-0.67 * side)),
    )


def asymptotes(groups: Groups) -> Asymptotes:
    """Return the four limits of [3]_, and the film without load."""
    load, speed, d = groups.M, groups.L, groups.radius_ratio
    shape = 1.0 + 0.006 * math.log(d) + 0.63 * d ** (4 / 7)
    return Asymptotes(
        rigid_isoviscous=145.0 * (1.0 + 0.796 * d ** (14 / 15)) ** (-15 / 7) / (d * load**2),
        elastic_isoviscous=3.18 * shape ** (-14 / 25) * d ** (-1 / 15) * load ** (-2 / 15),
        rigid_piezoviscous=1.29 * (1.0 + 0.691 * d) ** (-2 / 3) * speed ** (2 / 3),
        elastic_piezoviscous=1.48
        * shape ** (-7 / 20)
        * d ** (-1 / 24)
        * load ** (-1 / 12)
        * speed**0.75,
        unloaded=1.8 / d,
    )


def nijenbanning_venner_moes(groups: Groups) -> FilmRatio:
    """Return the central film of Nijenbanning, Venner and Moes [3]_, which spans all regimes."""
    limits = asymptotes(groups)
    isoviscous, piezoviscous = _isoviscous(limits), _piezoviscous(limits)
    s = 1.5
    if piezoviscous > 0:
        s += 1.5 * math.exp(-1.2 * limits.elastic_isoviscous / limits.elastic_piezoviscous)
    moes = (isoviscous**s + piezoviscous**s) ** (1.0 / s)
    return FilmRatio(central=moes * math.sqrt(2.0 * groups.U), minimum=None)


def _isoviscous(limits: Asymptotes) -> float:
    """Return the blend of both isoviscous limits."""
    elastic = (limits.elastic_isoviscous**-4 + limits.unloaded**-4) ** (-3 / 8)
    return (limits.rigid_isoviscous**1.5 + elastic) ** (2 / 3)


def _piezoviscous(limits: Asymptotes) -> float:
    """Return the blend of both piezoviscous limits; zero for L = 0."""
    rigid, elastic = limits.rigid_piezoviscous, limits.elastic_piezoviscous
    if not (rigid > 1e-30 and elastic > 1e-30):
        return 0.0
    return rigid * (1.0 + (rigid / elastic) ** 8) ** (-1 / 8)


def expected_central_film(groups: Groups) -> float:
    """Return the central film H to expect, from Nijenbanning, Venner and Moes [-]."""
    return nijenbanning_venner_moes(groups).central / hertz_ratio_squared(groups)


def expected_film(scaled: ScaledProblem) -> float:
    """Return the central film to expect, from Nijenbanning, Venner and Moes [m]."""
    return expected_central_film(scaled.groups) * scaled.scales.film_thickness


def regime(groups: Groups) -> Regime:
    """Return the lubrication regime.

    Elastic when the central film is thinner than the elastic deflection ``a_x^2 / R_x``,
    piezoviscous when the piezoviscous part of [3]_ exceeds the isoviscous one.
    """
    limits = asymptotes(groups)
    piezoviscous = _piezoviscous(limits) > _isoviscous(limits)
    if expected_central_film(groups) < 1.0:
        return "elastic-piezoviscous" if piezoviscous else "elastic-isoviscous"
    return "rigid-piezoviscous" if piezoviscous else "rigid-isoviscous"


FORMULAS = (
    Formula(
        name="Nijenbanning-Venner-Moes",
        source="Wear 176 (1994) 217-229",
        film=nijenbanning_venner_moes,
        regimes=(
            "rigid-isoviscous",
            "elastic-isoviscous",
            "rigid-piezoviscous",
            "elastic-piezoviscous",
        ),
        ranges=(Range(group="radius_ratio", low=0.04, high=1.0),),
    ),
    Formula(
        name="Hamrock-Dowson",
        source="J. Lubrication Technology 99 (1977) 264-276",
        film=hamrock_dowson,
        regimes=("elastic-piezoviscous",),
        ranges=(Range(group="ellipticity", low=1.0, high=8.0),),
        minimum_limit=100.0,
    ),
    Formula(
        name="Chittenden",
        source="Proc. R. Soc. A 397 (1985) 245-294",
        film=chittenden,
        regimes=("elastic-piezoviscous",),
        ranges=(Range(group="radius_ratio", low=0.1, high=10.0),),
        minimum_limit=100.0,
    ),
)


def film_estimates(groups: Groups, scales: Scales) -> tuple[FilmEstimate, ...]:
    """Return what each formula gives for a contact, with what speaks against believing it."""
    return tuple(_estimate(formula, groups, scales) for formula in FORMULAS)


def _estimate(formula: Formula, groups: Groups, scales: Scales) -> FilmEstimate:
    film, unit = formula.film(groups), hertz_ratio_squared(groups)
    central = film.central / unit
    minimum = None if film.minimum is None else film.minimum / unit
    return FilmEstimate(
        formula=formula.name,
        source=formula.source,
        central=central,
        minimum=minimum,
        central_m=central * scales.film_thickness,
        minimum_m=None if minimum is None else minimum * scales.film_thickness,
        remarks=_remarks(formula, groups),
        minimum_remark=_minimum_remark(formula, groups),
    )


def _remarks(formula: Formula, groups: Groups) -> tuple[str, ...]:
    remarks = [remark for limits in formula.ranges if (remark := limits.remark(groups))]
    here = regime(groups)
    if here not in formula.regimes:
        remarks.append(f"made for {' and '.join(formula.regimes)}, this contact is {here}")
    return tuple(remarks)


def _minimum_remark(formula: Formula, groups: Groups) -> str | None:
    if math.isinf(formula.minimum_limit):
        return None
    if groups.radius_ratio < WIDE:
        return "the minimum may be wrong by several percent, either way, in so wide a contact"
    if not formula.minimum_limit < groups.M:
        return None
    how = " and much too thick in slender contacts" if groups.radius_ratio > SLENDER else ""
    return f"the minimum is too thick for M above {formula.minimum_limit:g}{how}"


@dataclass(frozen=True, kw_only=True, slots=True)
class InletFactor:
    """By how much shear heating of the inlet thins the film, by one formula.

    Attributes
    ----------
    formula, source : str
        Which.
    factor : float
        Film over the isothermal film [-].
    remarks : tuple of str
        Why it may be off; empty where the formula was made for.
    """

    formula: str
    source: str
    factor: float
    remarks: tuple[str, ...]


def thermal_loading(problem: ContactProblem) -> float | None:
    """Return the thermal loading parameter ``eta_0 b u_m^2 / k`` [-], at the inlet.

    Returns
    -------
    float or None
        With b the fall of ln eta with temperature; None where the case states no conductivity or
        no temperature coefficient of the oil.
    """
    coefficient, conductivity = (
        problem.temperature_coefficient,
        problem.lubricant.ambient_conductivity,
    )
    if conductivity is None or not coefficient > 0:
        return None
    return problem.ambient_viscosity * coefficient * problem.entrainment_speed**2 / conductivity


def murch_wilson(loading: float) -> float:
    """Return the factor of Murch and Wilson [5]_ on the film of pure rolling [-]."""
    return 1.0 / (1.0 + 0.254 * loading**0.62)


def wilson_sheu(loading: float, slide_roll_ratio: float) -> float:
    """Return the factor of Wilson and Sheu [4]_ on the film of rolling and sliding [-]."""
    slip = 0.5 * abs(slide_roll_ratio)
    return 1.0 / (1.0 + 0.241 * (1.0 + 14.8 * slip**0.83) * loading**0.64)


def gupta(loading: float, slide_roll_ratio: float, relative_pressure: float) -> float:
    """Return the factor of Gupta and others [6]_ [-], with p_h / E' as ``relative_pressure``."""
    compressed = max(1.0 - 13.2 * relative_pressure * loading**0.42, 0.0)
    sliding = 1.0 + 2.23 * abs(slide_roll_ratio) ** 0.83
    return compressed / (1.0 + 0.213 * sliding * loading**0.64)


def inlet_factors(problem: ContactProblem) -> tuple[InletFactor, ...]:
    """Return what each formula says of the heat of the inlet; nothing where they lack a property.

    They are fits to rolling contacts with moderate sliding; 10 to 15 % is all they promise.
    """
    loading = thermal_loading(problem)
    if loading is None:
        return ()
    slip = problem.slide_roll_ratio
    squeezed = problem.hertz.pressure / problem.reduced_modulus
    sliding = "made for pure rolling" if abs(slip) > ROLLING else ""
    opposite = "made for surfaces that move in one direction" if abs(slip) > 2 else ""
    much = f"the part 13.2 p_h/E' L^0.42 = {13.2 * squeezed * loading**0.42:.2g} is no small one"
    large = much if 13.2 * squeezed * loading**0.42 > 0.5 else ""
    found = (
        ("Murch-Wilson", "J. Lubrication Technology 97 (1975) 212-216", murch_wilson(loading)),
        ("Wilson-Sheu", "J. Lubrication Technology 105 (1983) 187-188", wilson_sheu(loading, slip)),
        ("Gupta", "Tribology Transactions 35 (1992) 621-626", gupta(loading, slip, squeezed)),
    )
    doubts = ((sliding,), (opposite,), (opposite, large))
    return tuple(
        InletFactor(formula=name, source=source, factor=factor, remarks=tuple(filter(None, doubt)))
        for (name, source, factor), doubt in zip(found, doubts, strict=True)
    )


def inlet_heating_factor(problem: ContactProblem) -> float | None:
    """Return by how much shear heating of the inlet thins the film, after Wilson and Sheu [4]_.

    Returns
    -------
    float or None
        Factor on the isothermal film [-]; None where the case states no conductivity or no
        temperature coefficient of the oil, or surfaces that move in opposite directions.
    """
    loading = thermal_loading(problem)
    if loading is None or abs(problem.slide_roll_ratio) > 2.0:
        return None
    return wilson_sheu(loading, problem.slide_roll_ratio)
