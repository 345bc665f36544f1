"""Error bar of the film to expect with a wedge of third order."""

import math

from tehl.contact.options import Domain
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.scaling import Groups, ScaledProblem
from tehl.estimate.summits import shared_load

CIRCLE_BAR = (0.25, 0.61, 0.19, 0.0)
SLENDER_BAR = (0.37, 0.67, 0.46, 1.34)
"""Factor, powers of M and L and of one over a_y/a_x, below and above `LEAST_SLENDER`."""
WIDE_POWER = 0.8
"""Power of one over a_y/a_x of wide contacts, of two ratios (0.2 and 0.5) with M = 20 to 500."""
TURNED_BAR, TURNED_POWERS = 0.06, (1.17, -0.26, -1.68, -0.57)
"""Factor, and powers of M, L, a_y/a_x and of the narrowing sqrt(1 - s^2) of turned ellipses: on 141
grids of 24 of them (R_y/R_x = 2.9 and 11.6 at 30 to 60 deg, M = 20 to 500, L = 2 and 15) the larger
error of both films is 0.7 of that, within a factor of 1.5 for two of three."""
ACROSS_NARROW = 2.0 / 3.0
"""Part of that error that the mesh along x has, over 1 - sqrt(1 - s^2): slender ellipses are
narrow along both directions, others are thinnest at their sides."""
LEAST_SHARED = 0.25
"""Least factor of contacts whose asperities carry most of the load: the cycles need some nodes."""
LEAST_SLENDER, HEATED_BAR, STARVED_BAR = 1.5, 1.4, 1.5
"""That ratio, and factors of heated and of starved contacts: on 153 grids of 92 contacts of
machines nine of ten minimum films err by 1.7 and 1.5 times as much."""


def third_order_bar(
    scaled: ScaledProblem, domain: Domain, nodes: float, lines: float | None = None
) -> float:
    """Return the error bar of central and minimum film by the mesh, of second order.

    A fit to the nodes that 81 contacts of bearings, gears, cams and rigs with M up to 50,000 need
    for 0.8 %, within a factor of 1.4 for two of three. Thick films vary over the width of the gap.

    Parameters
    ----------
    scaled, domain : ScaledProblem, Domain
        The contact, and the domain of the solve.
    nodes, lines : float
        Nodes along x, and along y, of which the bar of a turned ellipse depends; as many if None.
    """
    groups, problem = scaled.entering, scaled.problem
    along = math.sqrt(2.0 * expected_central_film(groups))
    width = (domain.x[1] - domain.x[0]) / (nodes - 1) / max(along, 1.0)
    factor = (_turned if groups.skew else _on_axes)(groups)
    if groups.skew:
        across = (domain.y[1] - domain.y[0]) / ((lines or nodes) - 1) / max(along, 1.0)
        width *= (across / width) ** (1.0 - ACROSS_NARROW * (1.0 - math.sqrt(1.0 - groups.skew**2)))
    factor *= 1.0 if problem.thermal is None else HEATED_BAR
    factor *= 1.0 if problem.supply is None else STARVED_BAR
    factor *= max(1.0 - shared_load(scaled).share, LEAST_SHARED)  # asperities hold the film
    return float(factor * width**2)


def _on_axes(groups: Groups) -> float:
    """Return the bar over the square of the mesh width, of an ellipse on its axes [-]."""
    ratio = groups.ellipticity
    factor, by_load, by_speed, by_shape = SLENDER_BAR if ratio >= LEAST_SLENDER else CIRCLE_BAR
    loads = groups.M**by_load * max(groups.L, 0.1) ** by_speed
    return factor * loads / max(ratio, 1.0) ** by_shape / min(ratio, 1.0) ** WIDE_POWER


def _turned(groups: Groups) -> float:
    """Return the bar over the square of the mesh width, of a turned ellipse [-]."""
    by_load, by_speed, by_shape, by_narrowing = TURNED_POWERS
    loads = groups.M**by_load * max(groups.L, 0.1) ** by_speed
    narrowing = math.sqrt(1.0 - groups.skew**2)
    return TURNED_BAR * loads * groups.ellipticity**by_shape * narrowing**by_narrowing
