"""Starved contacts before the solve: the oil that enters, the film to expect, the domain.

The central film of a starved circular contact follows

    H_c = H_cff r / (1 + r^gamma)^(1/gamma),    r = H_oil / (rho_c H_cff),

with the film H_cff and the density rho_c of the fully flooded contact [1]_ [2]_.

References
----------
.. [1] F. Chevalier, A. A. Lubrecht, P. M. E. Cann, F. Colin and G. Dalmaz, J. Tribology 120 (1998),
   126-133.
.. [2] D. P. Damiens, C. H. Venner, P. M. E. Cann and A. A. Lubrecht, J. Tribology 126 (2004),
   105-111.
"""

import math
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.options import Domain
from tehl.contact.supply import Supply
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.line import line_supplied_domain
from tehl.estimate.scaling import CIRCULAR, Groups, ScaledProblem

GAMMA = 3.0
"""Exponent of the film law for a circular contact."""
FLOODED_SUPPLY, FLOODED_THIN_FILM, FLOODED_ERROR = 50.0, 0.5, 0.002
"""Supply over that of the flooded contact from which a thin film, H up to `FLOODED_THIN_FILM`, is
flooded, and its error: half of the 0.4 % that it lacks at r = 20 (M = 20 and 50). A thick one is
4 % from flooded at r = 60 and M = 5, and 22 % at M = 2."""
FORMULA_ERROR = 0.25
"""Error of a flooded film by formula, where heat or thinning is strong: 0.23 seen."""
LINE_FLOODED = 0.995
"""Supply of a line contact, over what it passes on flooded, from which it is flooded: the meniscus
of one that is starved lies at a distance of 1.5/sqrt(1 - r), which has no limit."""
MENISCUS_GAP_MARGIN, MENISCUS_GAP_SLOPE, LARGEST_SLOPE_SUPPLY = 1.2, 0.4, 3.0
"""Margin on the gap at the meniscus, more of it per r up to r = 3: near the contact the pressure
returns more oil than far upstream."""
GAP_OVER_LAYER_AT_SIDES = 2.5
"""Gap over layer where the film ends at the sides."""
LEAST_INLET, LEAST_SIDE = 2.3, 1.7
"""Least distances of the inlet edge and of the side edges, in Hertz half-widths."""
PASSES_SIDE_FACTOR = 1.3
"""Factor on the sides if the surfaces pass repeatedly."""
OUTLETS = ((3.0, 0.6), (math.inf, 5.0 / 11.0))
"""Outlet over inlet, up to these distances of the inlet: X = 0 is a node."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Flooded:
    """The same contact fully flooded and smooth."""

    film: float
    oil: float
    """H and rho H at its centre [-]."""
    error: float
    """Relative error bar of both [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class EnteringOil:
    """The oil rho H that enters, over Y: at ``y`` [half-widths] the layers ``oil`` [-].

    A layer that does not depend on Y has one entry.
    """

    y: Array
    oil: Array

    def __call__(self, y: Array) -> Array:
        """Return the oil that enters lines at ``y``, linear between the places [-]."""
        found: Array = np.interp(y, self.y, self.oil)
        return found

    @property
    def largest(self) -> float:
        """Most oil of all lines [-]."""
        return float(self.oil.max())

    @property
    def central(self) -> float:
        """Oil on the line Y = 0 [-]."""
        return float(self(np.zeros(1))[0])


def flooded_oil(scaled: ScaledProblem) -> float:
    """Return rho H in the middle of the fully flooded contact, computed or by formula [-]."""
    if scaled.flooded_oil is not None:
        return scaled.flooded_oil
    problem, scales = scaled.problem, scaled.scales
    density = float(problem.lubricant.density.density(scales.hertz_pressure, scales.temperature))
    return density / scales.density * expected_central_film(scaled.entering)


def entering_oil(scaled: ScaledProblem) -> EnteringOil | None:
    """Return the oil that enters; None if the contact is flooded, by its supply too."""
    supply = scaled.problem.supply
    if supply is None:
        return None
    unit = (2.0 if supply.each else 1.0) / scaled.scales.film_thickness
    if supply.ratio is not None:
        y, oil = np.zeros(1), np.array([supply.ratio * flooded_oil(scaled)])
    elif supply.layer is not None:
        y, oil = np.zeros(1), np.array([supply.layer * unit])
    else:
        places, layers = np.array(supply.profile).T
        y, oil = places / scaled.scales.half_width_y, layers * unit
    found = EnteringOil(y=y, oil=oil)
    flooded = flooded_oil(scaled)
    if scaled.groups.shape.as_line:
        return None if float(oil.min()) > LINE_FLOODED * flooded else found
    is_flooded = flooded <= FLOODED_THIN_FILM and float(oil.min()) > FLOODED_SUPPLY * flooded
    return None if is_flooded else found


def is_starved(scaled: ScaledProblem) -> bool:
    """Return whether a layer of oil limits the film."""
    return entering_oil(scaled) is not None


def supply_ratio(scaled: ScaledProblem) -> float:
    """Return r, the oil that enters at Y = 0 over that of the flooded contact [-]."""
    oil = entering_oil(scaled)
    return math.inf if oil is None else oil.central / flooded_oil(scaled)


def starved_part(ratio: float) -> float:
    """Return the central film over that of the flooded contact by the film law [-].

    ``ratio`` is r, the oil that enters over that of the flooded contact [-].
    """
    if math.isinf(ratio):
        return 1.0
    return float(ratio / (1.0 + ratio**GAMMA) ** (1.0 / GAMMA))


def starved_degree(groups: Groups, ratio: float) -> tuple[float, float | None]:
    """Return the central film over that of the flooded contact, and its error bar [-].

    Linear between the contacts of ``starvation.csv``, as a factor on the film law; beyond them the
    law alone, without an error bar.

    Parameters
    ----------
    groups : Groups
        Load, speed and shape of the contact.
    ratio : float
        r, the oil that enters over that of the flooded contact [-].
    """
    if groups.shape.as_line:  # nothing flows aside: what enters is what passes
        return min(ratio, 1.0), None
    law, axes, factors, errors = starved_part(ratio), *table()
    place = np.log(groups.M), groups.L, np.log(max(ratio, 1e-9))
    inside = all(axis[0] <= at <= axis[-1] for axis, at in zip(axes, place, strict=True))
    if not inside or groups.twist or abs(groups.radius_ratio - 1.0) > CIRCULAR:
        return law, None
    from scipy.interpolate import interpn  # noqa: PLC0415 (0.1 s, for starved contacts only)

    factor, error = (float(interpn(axes, values, place)[0]) for values in (factors, errors))
    return law * factor, law * error


@cache
def table() -> tuple[tuple[Array, Array, Array], Array, Array]:
    """Return the axes log M, L and log r of the table, the film over the law, and its errors."""
    with files(__package__).joinpath("starvation.csv").open(encoding="utf-8") as file:
        load, speed, ratio, degree, error = np.loadtxt(file, delimiter=",", skiprows=1).T
    loads, speeds, ratios = (np.unique(one) for one in (load, speed, ratio))
    law = np.array([starved_part(one) for one in ratio])
    shape = loads.size, speeds.size, ratios.size
    axes = np.log(loads), speeds, np.log(ratios)
    return axes, (degree / law).reshape(shape), (error / law).reshape(shape)


def part_passed_on(supply: Supply) -> float:
    """Return the part of its relative error that the flooded film passes on to the starved one [-].

    By the film law, 1 / (1 + r^gamma) of a ratio r, with gamma = 2 at least; all of it for other
    supplies, whose degree of starvation it decides.
    """
    return 1.0 if supply.ratio is None else 1.0 / (1.0 + supply.ratio**2)


def supply_error(scaled: ScaledProblem) -> float:
    """Return the relative error of the film by what is known of the supply.

    Of a stated ratio by the error of the flooded film, which is that of the formula if no flooded
    film was found (`part_passed_on`).
    """
    supply = scaled.problem.supply
    if supply is not None and not is_starved(scaled):
        return 0.0 if scaled.groups.shape.as_line else FLOODED_ERROR
    if supply is None or supply.ratio is None:
        return 0.0
    error = FORMULA_ERROR if scaled.flooded_oil is None else scaled.flooded_error
    return error * part_passed_on(supply)


def supplied_film(scaled: ScaledProblem) -> float:
    """Return the central film to expect, of a starved contact by the film law [-]."""
    flooded = expected_central_film(scaled.entering)
    oil = entering_oil(scaled)
    if oil is None:
        return flooded
    ratio = max(oil.largest / flooded_oil(scaled), 1e-6)
    return flooded * (min(ratio, 1.0) if scaled.groups.shape.as_line else starved_part(ratio))


def starved_domain(scaled: ScaledProblem) -> Domain:
    """Return a domain that contains the film of a starved contact, in Hertz half-widths."""
    oil, groups = entering_oil(scaled), scaled.groups
    assert oil is not None
    across = groups.shape.across
    if groups.shape.as_line:
        ratio = oil.largest / flooded_oil(scaled)
        return line_supplied_domain(ratio, supplied_film(scaled), groups.shape)
    # far upstream the pressure returns 3/(3 + 2 D) of the oil that the surfaces drag in
    backflow = 1.5 / groups.radius_ratio + 1.0
    margin = MENISCUS_GAP_MARGIN + MENISCUS_GAP_SLOPE * min(
        oil.largest / flooded_oil(scaled), LARGEST_SLOPE_SUPPLY
    )
    # where the rigid gap, less the approach of about one, is the thickest that the oil can fill
    inlet = max(LEAST_INLET, math.sqrt(2.0 * (margin * backflow * oil.largest + 1.0)))
    side = max(
        LEAST_SIDE,
        math.sqrt(
            2.0 * (MENISCUS_GAP_MARGIN * GAP_OVER_LAYER_AT_SIDES * oil.largest + 1.0) / across
        ),
    )
    if scaled.problem.has_passes:
        side *= PASSES_SIDE_FACTOR  # for the ridges of oil beside the track
    inlet, side = (math.ceil(10.0 * edge) / 10.0 for edge in (inlet, side))
    part = next(part for limit, part in OUTLETS if inlet <= limit)
    return Domain.model_construct(x=(-inlet, part * inlet), y=(-side, side))


def check_supply(scaled: ScaledProblem, domain: Domain) -> None:
    """Check that a stated domain can hold the layer, and the profile covers the domain.

    Parameters
    ----------
    scaled : ScaledProblem
        A fully flooded one passes.
    domain : Domain
        Edges in Hertz half-widths.

    Raises
    ------
    InputError
        If the profile is too narrow, or the layer fills the gap at the inlet edge.
    """
    supply, oil, scales = scaled.problem.supply, entering_oil(scaled), scaled.scales
    if supply is None or oil is None:
        return
    if supply.profile is not None and not (
        oil.y[0] <= domain.y[0] * (1 - 1e-9) and domain.y[1] * (1 - 1e-9) <= oil.y[-1]
    ):
        least, most = (1e3 * edge * scales.half_width_y for edge in domain.y)
        raise InputError(
            f"supply.profile: goes from y = {1e3 * supply.profile[0][0]:.4g} to "
            f"{1e3 * supply.profile[-1][0]:.4g} mm and does not cover the domain, {least:.4g} to "
            f"{most:.4g} mm: add places there"
        )
    ends = oil(np.array(domain.y))
    if supply.profile is not None and scaled.groups.shape.wraps and not np.isclose(*ends):
        first, last = (1e6 * one * scales.film_thickness for one in ends)
        raise InputError(
            f"supply.profile: {first:.4g} um at one end of the piece and {last:.4g} um at the "
            'other; with contact.ends = "periodic" both must be the same'
        )
    gap = 0.5 * domain.x[0] ** 2
    if oil.central > gap:
        raise InputError(
            f"supply: the layer of {1e6 * oil.central * scales.film_thickness:.4g} um is thicker "
            f"than the gap of about {1e6 * gap * scales.film_thickness:.4g} um at the inlet edge "
            f"X = {domain.x[0]:.4g}: the contact is flooded there; leave out [supply], or take a "
            'larger numerics.domain ("auto" is large enough)'
        )
