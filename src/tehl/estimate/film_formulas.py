"""Film thickness by published formulas: initial guess of the solver, comparison with its result.

All take the groups of :mod:`tehl.estimate.scaling`, with the mean speed in U and R_x in both U and
W. Films are ``H = h R_x / a_x^2`` and metres.

References
----------
.. [1] B. J. Hamrock and D. Dowson, J. Lubrication Technology 99 (1977), 264-276.
.. [2] R. J. Chittenden, D. Dowson, J. F. Dunn and C. M. Taylor, Proc. R. Soc. A 397 (1985),
   245-294.
.. [3] G. Nijenbanning, C. H. Venner and H. Moes, Wear 176 (1994), 217-229.
.. [4] T. E. Tallian, ASLE Transactions 10 (1967), 418-439.
.. [5] B. J. Hamrock, S. R. Schmid and B. O. Jacobson, Fundamentals of Fluid Film Lubrication,
   2nd ed. (2004), chapter 3.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, get_args

from tehl.base.errors import InputError
from tehl.contact.problem import ContactProblem
from tehl.estimate.formula import Asymptotes, FilmRatio, Formula, Regime
from tehl.estimate.line_formulas import LINE_FORMULAS, line_asymptotes, moes_line
from tehl.estimate.scaling import Groups, ScaledProblem, Scales

Lubrication = Literal["boundary", "mixed", "full film"]
FULL_FILM, BOUNDARY = 3.0, 1.0
"""Lambda from which the film separates the surfaces, and below which asperities carry the load."""

FULL_FILM_SHARE, BOUNDARY_SHARE = 0.01, 0.9
"""Part of the load on asperities below which the film is full, and from which on they are said to
carry the load: where asperities are computed, lambda is not asked."""

LARGEST_FILM_PART = 0.1
"""Largest film over the reduced radius: the gap is ten times as wide at ``sqrt(18 h R)``, which is
then 1.3 R, beyond the body."""

LEAST_FORMULA_RATIO, LARGEST_FORMULA_RATIO = 0.7, 1.4
"""R_x/R_y below and above which the formulas for the minimum film lose accuracy.

Compared with solves at L = 10 (mineral oil, steel) they are within 0 to 5 % at R_x/R_y = 0.2 and
M = 50 to 150, 13 % too thick at 0.4 and M = 300, up to 6 % too thin for an incompressible Barus
liquid at 0.5 and M = 50, and 50 % too thick at R_x/R_y = 2 and M = 150.
"""


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmEstimate:
    """Film thickness by one formula."""

    formula: str
    """Its authors."""
    source: str
    central: float
    minimum: float | None
    """H [-]; ``minimum`` is None if the formula has none."""
    central_m: float
    minimum_m: float | None
    """The same in metres."""
    remarks: tuple[str, ...]
    """Limits of validity that the contact exceeds."""
    minimum_remark: str | None
    """Limit of the minimum film only."""

    @property
    def valid(self) -> bool:
        """Whether the contact is within the range of the formula."""
        return not self.remarks


def hertz_ratio_squared(groups: Groups) -> float:
    """Return ``(a_x / R_x)^2`` [-], from W, the shape and the deflection factor."""
    return groups.shape.ratio_squared(groups.W, groups.deflection_factor)


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
    """Return the film of Chittenden and others [2]_, at an angle with the radii along x and y."""
    common = groups.U**0.68 * groups.G**0.49 * groups.W**-0.073
    side = groups.radius_ratio ** (-2.0 / 3.0)
    return FilmRatio(
        central=4.31 * common * (1.0 - math.exp(-1.23 * side)),
        minimum=3.68 * common * (1.0 - math.exp(-0.67 * side)),
    )


def asymptotes(groups: Groups) -> Asymptotes:
    """Return the four limits of Nijenbanning, Venner and Moes [3]_, and the film without load.

    Those of a line contact are Moes', and have no such film.
    """
    if groups.shape.as_line:
        return line_asymptotes(groups)
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
    """Return the central film of Nijenbanning, Venner and Moes [3]_, which covers all regimes."""
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


@lru_cache(maxsize=64)
def expected_central_film(groups: Groups) -> float:
    """Return the central film H by the formula that covers all regimes [-].

    That of Nijenbanning, Venner and Moes [3]_, of a line contact that of Moes.
    """
    formula = moes_line if groups.shape.as_line else nijenbanning_venner_moes
    return formula(groups).central / hertz_ratio_squared(groups)


def expected_film(scaled: ScaledProblem) -> float:
    """Return the central film to expect, by `expected_central_film` [m]."""
    return expected_central_film(scaled.groups) * scaled.scales.film_thickness


def inlet_stress(scaled: ScaledProblem) -> float:
    """Return the shear stress at the inlet temperature over the pressure, both of the mean [-]."""
    problem, temperature = scaled.problem, scaled.scales.temperature
    pressure, oil = problem.hertz.mean_pressure, problem.lubricant
    rate = problem.sliding_speed / expected_film(scaled)
    viscosity = oil.viscosity.viscosity(pressure, temperature)
    return float(oil.shear.thinned(viscosity * rate, pressure) / pressure)


def likely_film(scaled: ScaledProblem) -> FilmEstimate:
    """Return the film by the first formula whose range has the contact; of [3]_ if none has it."""
    films = film_estimates(scaled.groups, scaled.scales)
    return next((film for film in films if film.valid), films[0])


def film_over_radius(scaled: ScaledProblem) -> float:
    """Return the film to expect over the smaller reduced radius [-]."""
    problem = scaled.problem
    across = math.inf if problem.contact.has_lines else abs(problem.radius_y)
    return likely_film(scaled).central_m / min(problem.radius_x, across)


def check_film(scaled: ScaledProblem) -> None:
    """Check that the film is thin beside the bodies.

    Parameters
    ----------
    scaled : ScaledProblem
        A starved one passes, whose film is that of the supply.

    Raises
    ------
    InputError
        If the film to expect is thicker than `LARGEST_FILM_PART` reduced radii.
    """
    part = film_over_radius(scaled)
    if scaled.problem.supply is None and part > LARGEST_FILM_PART:
        raise InputError(
            f"contact: the film to expect, {1e3 * likely_film(scaled).central_m:.4g} mm, is "
            f"{part:.4g} times the smaller reduced radius, and lubrication theory needs less than "
            f"{LARGEST_FILM_PART:g}: {thick_film_advice(scaled.problem)}"
        )


def thick_film_advice(problem: ContactProblem) -> str:
    """Return what to check where the film to expect is too thick, in words.

    Parameters
    ----------
    problem : ContactProblem
        Cold oil may be far more viscous than its data at the reference temperature suggest.
    """
    return (
        f"check the temperature of the oil at the inlet, {problem.inlet_temperature - 273.15:.4g} "
        f"degC, its viscosity there, {problem.ambient_viscosity:.4g} Pa s, and the units of speed, "
        "load and radius"
    )


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


def lubrication(lambda_central: float) -> Lubrication:
    """Return in words how far a film separates the asperities, by lambda of the central film [4]_.

    The limits are those of the textbooks [5]_: 1 and 3.
    """
    if lambda_central >= FULL_FILM:
        return "full film"
    return "mixed" if lambda_central >= BOUNDARY else "boundary"


def lubrication_by_share(share: float) -> Lubrication:
    """Return in words how far a film separates asperities by the part of the load they carry."""
    if share < FULL_FILM_SHARE:
        return "full film"
    return "mixed" if share < BOUNDARY_SHARE else "boundary"


FORMULAS = (
    Formula(
        name="Nijenbanning-Venner-Moes",
        source="Wear 176 (1994) 217-229",
        film=nijenbanning_venner_moes,
        limits=("radius_ratio", 0.04, 1.0),
        regimes=get_args(Regime),
    ),
    Formula(
        name="Hamrock-Dowson",
        source="J. Lubrication Technology 99 (1977) 264-276",
        film=hamrock_dowson,
        limits=("ellipticity", 1.0, 8.0),
        minimum_limit=100.0,
    ),
    Formula(
        name="Chittenden",
        source="Proc. R. Soc. A 397 (1985) 245-294",
        film=chittenden,
        limits=("radius_ratio", 0.1, 10.0),
        at_angles=True,
        minimum_limit=100.0,
    ),
)


def film_estimates(groups: Groups, scales: Scales) -> tuple[FilmEstimate, ...]:
    """Return the film of a contact by each formula, with remarks on its validity.

    Parameters
    ----------
    groups : Groups
        Moes numbers, ellipticity and radius ratio.
    scales : Scales
        Its film scale a_x^2/R_x [m] converts H to metres.
    """
    unit, metres, estimates = hertz_ratio_squared(groups), scales.film_thickness, []
    for formula in LINE_FORMULAS if groups.shape.as_line else FORMULAS:
        film = formula.film(groups)
        central = film.central / unit
        minimum = None if film.minimum is None else film.minimum / unit
        estimate = FilmEstimate(
            formula=formula.name,
            source=formula.source,
            central=central,
            minimum=minimum,
            central_m=central * metres,
            minimum_m=None if minimum is None else minimum * metres,
            remarks=_remarks(formula, groups),
            minimum_remark=_minimum_remark(formula, groups),
        )
        estimates.append(estimate)
    return tuple(estimates)


def _remarks(formula: Formula, groups: Groups) -> tuple[str, ...]:
    (name, low, high), here, remarks = formula.limits, regime(groups), []
    value = getattr(groups, name)
    if not low * (1 - 1e-9) <= value <= high * (1 + 1e-9):
        remarks.append(f"{name} = {value:.4g} is outside {low:g} to {high:g}")
    if groups.twist and not formula.at_angles:
        remarks.append("valid for entrainment along an axis of the ellipse")
    if here not in formula.regimes:
        remarks.append(f"valid for {' and '.join(formula.regimes)}, this contact is {here}")
    return tuple(remarks)


def _minimum_remark(formula: Formula, groups: Groups) -> str | None:
    if math.isinf(formula.minimum_limit):
        return None
    if groups.radius_ratio < LEAST_FORMULA_RATIO:
        return "the minimum may be several percent too thick or too thin in a contact this wide"
    if not formula.minimum_limit < groups.M:
        return None
    how = (
        " and much too thick in slender contacts"
        if groups.radius_ratio > LARGEST_FORMULA_RATIO
        else ""
    )
    return f"the minimum is too thick for M above {formula.minimum_limit:g}{how}"
