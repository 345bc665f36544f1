"""Size of the domain and number of nodes, proposed from the dimensionless groups."""

import math
from dataclasses import replace

from tehl.film_formulas import expected_central_film, moes_film_unit
from tehl.options import Domain
from tehl.scaling import Groups

NODES = tuple(2**k * n + 1 for k in range(4, 12) for n in (2, 3))
SIZES = (
    (500.0, 2.4, 1.5),
    (100.0, 3.0, 1.5),
    (40.0, 4.0, 1.5),
    (15.0, 6.0, 1.5),
    (0.0, 12.0, 3.0),
)
"""Least Moes load of a size, its half-width along y, and its outlet edge (circular contact)."""
AIM = 0.03332
"""Relative error of the central film on the proposed grid."""
CAUTION = 2.0
"""Factor on the slope of the film formula by load, which is half of what wider domains show between
M = 2 and 5."""
NEARLY_RIGID = 7.0
"""Moes load below which the pressure extends beyond any domain worth computing."""
LONGEST_REACH = 2.3
"""Largest factor on the inlet of a wide contact: a line contact draws from a finite distance."""
SIXTEENTHS = (11, 12, 13, 14, 15)
"""Parts of the length that the inlet may have, so that X = 0 is a node of every grid."""


def recommended_domain(groups: Groups) -> Domain:
    """Return the domain, in Hertz half-widths, that truncates the central film by at most 0.3 %.

    The wedge draws pressure from far away, above all from the sides, where the film is thick: the
    edges move out as the Moes load falls. Doubling this domain changes the central film by at most
    0.25 % for M = 7 to 1000 at L = 10, and the minimum film by at most 0.42 %
    (``python -m benchmarks domain``). Below M = 7 the contact is nearly rigid, the load outside
    decays only as one over the width, and up to 3 % remain. A contact that is wide across the
    entrainment draws from further upstream, as ellipticity to the power 0.4 (measured at
    radius_y / radius_x = 2 and 5).
    """
    width, outlet = next((w, out) for load, w, out in SIZES if groups.M >= load)
    reach = min(max(groups.ellipticity, 1.0) ** 0.4, LONGEST_REACH)
    needed = (2.0 * width - outlet) * reach
    # the first inlet that is long enough and has X = 0 at a node of the coarsest grid
    inlets = (outlet * k / (16 - k) for k in SIXTEENTHS)
    inlet = next((x for x in inlets if x > 0.97 * needed), outlet * 15)
    return Domain(x=(-inlet, outlet), y=(-width, width))


def domain_error(groups: Groups, domain: Domain) -> float:
    """Estimate the relative error of the central film due to the finite domain, for thick films.

    Far from the contact the pressure upstream is that of a rigid parabolic gap,
    ``P = 4 lambda |X| / ((3 + 2 D) (X^2 + D kappa^2 Y^2)^2)`` (docs/theory/numerics.md). Its load
    outside the domain is missing, and the film changes with the slope of its formula by load. Wider
    domains show 3 to 4 % at M = 5, 22 to 34 % at M = 3 and more below; this estimate is 1 to 10 and
    11 to 33 %. Elastic contacts (M > 10) lose less, and lose it at the inlet.
    """
    stretch = math.sqrt(groups.radius_ratio) * groups.ellipticity
    side = stretch * min(-domain.y[0], domain.y[1])
    inlet = -domain.x[0]
    # integral of |X| / (X^2 + Y^2)^2 upstream of the contact and outside the rectangle
    beyond = 1.0 / side + math.atan(side / inlet) / inlet
    amplitude = 4.0 * groups.lambda_bar / ((3.0 + 2.0 * groups.radius_ratio) * stretch)
    missing = amplitude * beyond / (2.0 * math.pi / 3.0)
    heavier = replace(groups, M=1.02 * groups.M)
    films = [expected_central_film(one) / moes_film_unit(one) for one in (groups, heavier)]
    slope = math.log(films[0] / films[1]) / math.log(1.02)
    return CAUTION * slope * missing


def grid_error(groups: Groups, nodes: int) -> float:
    """Estimate the relative error of the central film on ``nodes`` per direction.

    It is about 1.7 h^2 / H^1.2 with mesh width h on the recommended domain and film H (measured at
    M = 100 to 500).
    """
    domain = recommended_domain(groups)
    width = (domain.x[1] - domain.x[0]) / (nodes - 1)
    return float(1.7 * width**2 / expected_central_film(groups) ** 1.2)


def needed_points(groups: Groups) -> int:
    """Return the nodes per direction at which `grid_error` is about three percent.

    The error of the minimum film is larger. Coarser grids may converge too, with larger errors.
    """
    return next((nodes for nodes in NODES if grid_error(groups, nodes) <= AIM), NODES[-1])
