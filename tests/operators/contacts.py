"""Grids and groups for the tests of the discrete operators."""

from tehl.contact.options import Domain
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups, groups
from tests.reference import moes_contact

FLAT = Domain(x=(-3.0, 1.8), y=(-2.0, 2.0))


def contact_groups(radius_ratio: float = 1.0) -> Groups:
    """Return the groups of M = 100, L = 10."""
    return groups(moes_contact(100.0, 10.0, radius_ratio=radius_ratio))


def grid_of(nx: int, ny: int, *, mirror: bool, domain: Domain = FLAT) -> Grid:
    """Return a grid; with the default domain its cells are not square."""
    return Grid(nx=nx, ny=ny, domain=domain, mirror=mirror)
