"""How much of the film to compute, and how finely: domain and grid proposed from the groups."""

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
"""From which Moes load on, which half width and which outlet (square for a circular contact)."""
AIM = 0.03332
"""Error of the central film that the proposed grid keeps, relative [-]."""
CAUTION = 2.0
"""The formula's slope by load is half of what wider domains show between M = 2 and 5."""
NEARLY_RIGID = 7.0
"""Moes load below which the pressure reaches further than any domain that is worth computing."""
LONGEST_REACH = 2.3
"""Most that a wide contact lengthens the inlet: a line contact draws from a finite distance."""
SIXTEENTHS = (11, 12, 13, 14, 15)
"""Parts of the length that the inlet may take, so that X = 0 is a node of every grid."""


def recommended_domain(groups: Groups) -> Domain:
    """Return the domain whose part of the error of the central film stays below 0.3 %.

    The wedge draws pressure from far away, most of all from the sides, when the film is thick
    against the contact: the edges move out as the Moes load falls. With these widths a domain twice
    as large changes the central film by 0.25 % at most for M = 7 to 1000 at L = 10, the minimum
    film by 0.42 % at most (``python -m benchmarks domain``). Below M = 7 the
    contact is nearly rigid, the load outside falls off like one over the width only, and up to 3 %
    remain. A contact that is wide across the entrainment draws from further upstream, like the
    power 0.4 of its ellipticity (measured at radius_y / radius_x = 2 and 5).

    Parameters
    ----------
    groups : Groups
        Dimensionless groups of the contact.

    Returns
    -------
    Domain
        In Hertz half-widths.
    """
    width, outlet = next((w, out) for load, w, out in SIZES if groups.M >= load)
    reach = min(max(groups.ellipticity, 1.0) ** 0.4, LONGEST_REACH)
    needed = (2.0 * width - outlet) * reach
    inlets = (outlet * k / (16 - k) for k in SIXTEENTHS)
    inlet = next((x for x in inlets if x > 0.97 * needed), outlet * 15)
    return Domain(x=(-inlet, outlet), y=(-width, width))


def domain_error(groups: Groups, domain: Domain) -> float:
    """Return the part of the central film that a domain leaves out, estimated for thick films.

    Far from the contact the pressure of the inlet side is that of a rigid parabolic gap,
    ``P = 4 lambda |X| / ((3 + 2 D) (X^2 + D kappa^2 Y^2)^2)``. Its load outside the domain is
    missing; the film answers with the slope of its formula by load. Wider domains show 3 to 4 % at
    M = 5, 22 to 34 % at M = 3 and more below; this says 1 to 10 and 11 to 33 %. Elastic contacts
    (M > 10) lose less, and that at the inlet.

    Parameters
    ----------
    groups : Groups
        Dimensionless groups.
    domain : Domain
        In Hertz half-widths.
    """
    stretch = math.sqrt(groups.radius_ratio) * groups.ellipticity
    side = stretch * min(-domain.y[0], domain.y[1])
    inlet = -domain.x[0]
    beyond = 1.0 / side + math.atan(side / inlet) / inlet
    amplitude = 4.0 * groups.lambda_bar / ((3.0 + 2.0 * groups.radius_ratio) * stretch)
    missing = amplitude * beyond / (2.0 * math.pi / 3.0)
    heavier = replace(groups, M=1.02 * groups.M)
    slope = math.log(_moes_film(groups) / _moes_film(heavier)) / math.log(1.02)
    return CAUTION * slope * missing


def _moes_film(groups: Groups) -> float:
    return expected_central_film(groups) / moes_film_unit(groups)


def grid_error(groups: Groups, nodes: int) -> float:
    """Return the error to expect of the central film on the proposed domain, relative [-].

    It is about 1.7 h^2 / H^1.2 for mesh width h and film H (measured at M = 100 to 500).

    Parameters
    ----------
    groups : Groups
        Dimensionless groups of the contact.
    nodes : int
        Per direction.
    """
    domain = recommended_domain(groups)
    width = (domain.x[1] - domain.x[0]) / (nodes - 1)
    return float(1.7 * width**2 / expected_central_film(groups) ** 1.2)


def needed_points(groups: Groups) -> int:
    """Return the nodes per direction that give the central film to about three percent.

    This is what :func:`grid_error` says of the proposed domain. The minimum film is less well
    known, and coarser grids may have an answer too, with a larger error.
    """
    return next((nodes for nodes in NODES if grid_error(groups, nodes) <= AIM), NODES[-1])
