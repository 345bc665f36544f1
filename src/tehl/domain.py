"""How much of the film to compute, and how finely: domain and grid proposed from the groups."""

from tehl.film_formulas import expected_central_film
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
NEARLY_RIGID = 7.0
"""Moes load below which the pressure reaches further than any domain that is worth computing."""
SIXTEENTHS = (11, 12, 13, 14, 15)
"""Parts of the length that the inlet may take, so that X = 0 is a node of every grid."""


def recommended_domain(groups: Groups) -> Domain:
    """Return the domain whose part of the error of the central film stays below 0.3 %.

    The wedge draws pressure from far away, most of all from the sides, when the film is thick
    against the contact: the edges move out as the Moes load falls. The widths are measured: 0.2 %
    at M = 500, 0.28 % at 100, 0.25 % at 40, 0.2 % at 15, 0.1 % at 10 (L = 10). Below M = 7 the
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
    needed = (2.0 * width - outlet) * max(groups.ellipticity, 1.0) ** 0.4
    inlets = (outlet * k / (16 - k) for k in SIXTEENTHS)
    inlet = next((x for x in inlets if x > 0.97 * needed), outlet * 15)
    return Domain(x=(-inlet, outlet), y=(-width, width))


def needed_points(groups: Groups) -> int:
    """Return the nodes per direction that resolve the expected film on the proposed domain.

    The discretisation error of the central film is about 1.7 h^2 / H^1.2 for mesh width h and film
    H (measured at M = 100 to 500); the grid proposed keeps it near three percent.
    """
    domain = recommended_domain(groups)
    width = domain.x[1] - domain.x[0]
    film = expected_central_film(groups)
    for nodes in NODES:
        if width / (nodes - 1) <= 0.14 * film**0.6:
            return nodes
    return NODES[-1]
