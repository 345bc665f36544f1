"""Film equation H = H00 + gap + K P (docs/theory/model.md): undeformed gap and dry pressure."""

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups


def gap(grid: Grid, groups: Groups, curvature: float = 1.0) -> Array:
    """Return the undeformed gap, shape ``grid.shape`` [-].

    Parameters
    ----------
    grid : Grid
        Nodes X, Y in Hertz half-widths.
    groups : Groups
        Shape of the contact.
    curvature : float
        Along x, over that of the contact [-].
    """
    x, y = grid.x[None, :], grid.y[:, None]
    found = groups.shape.gap(x, y)
    return found if curvature == 1.0 else found + 0.5 * (curvature - 1.0) * x**2


def dry_pressure(grid: Grid, groups: Groups) -> Array:
    """Return the pressure of the dry contact, shape ``grid.shape`` [-].

    Parameters
    ----------
    grid : Grid
        Nodes X, Y in Hertz half-widths.
    groups : Groups
        Shape of the contact.
    """
    return groups.shape.dry_pressure(grid.x[None, :], grid.y[:, None])
