"""Film equation H = H00 + gap + K P (docs/theory/model.md): undeformed gap and Hertz pressure."""

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups


def gap(grid: Grid, groups: Groups) -> Array:
    """Return the undeformed gap X^2/2 + D kappa^2 Y^2/2, shape ``grid.shape`` [-].

    Parameters
    ----------
    grid : Grid
        Nodes X, Y in Hertz half-widths.
    groups : Groups
        Radius ratio D = R_x/R_y and ellipticity kappa = a_y/a_x.
    """
    across = groups.radius_ratio * groups.ellipticity**2
    return 0.5 * grid.x[None, :] ** 2 + 0.5 * across * grid.y[:, None] ** 2


def hertz_pressure(grid: Grid) -> Array:
    """Return the dry pressure sqrt(1 - X^2 - Y^2), shape ``grid.shape`` [-]."""
    return np.sqrt(np.maximum(0.0, 1.0 - grid.x[None, :] ** 2 - grid.y[:, None] ** 2))
