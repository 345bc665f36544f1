"""How much of the film to compute, and how finely: domain and grid proposed from the groups."""

from tehl.film_formulas import expected_central_film
from tehl.options import Domain
from tehl.scaling import Groups

NODES = tuple(2**k * n + 1 for k in range(4, 12) for n in (2, 3))


def recommended_domain(groups: Groups) -> Domain:
    """Return the domain whose part of the error of the film stays below 0.3 %.

    The wedge draws pressure from far away when the film is thick against the contact: the edges
    move out as the Moes load falls. X = Y = 0 is a node of every grid.

    Parameters
    ----------
    groups : Groups
        Dimensionless groups of the contact.

    Returns
    -------
    Domain
        In Hertz half-widths.
    """
    size = 1.0
    for limit, factor in ((100.0, 1.5), (30.0, 2.0), (12.0, 3.0), (6.0, 4.0)):
        if groups.M < limit:
            size = factor
    return Domain(x=(-4.5 * size, 1.5 * size), y=(-3.0 * size, 3.0 * size))


def needed_points(groups: Groups) -> int:
    """Return the nodes per direction that resolve the expected film on the proposed domain.

    The discretisation error of the central film grows with mesh width over film thickness; the
    grid proposed keeps it below about one percent.
    """
    domain = recommended_domain(groups)
    width = domain.x[1] - domain.x[0]
    film = expected_central_film(groups)
    for nodes in NODES:
        if width / (nodes - 1) <= 0.3 * film**0.6:
            return nodes
    return NODES[-1]
