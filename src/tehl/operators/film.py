"""Film equation H = H00 + gap + K P (docs/theory/model.md): undeformed gap."""

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups

PLACES = (np.arange(32) + 0.5) / 32 - 0.5
"""Places across a line at which the profile of a roller is averaged, over its width."""


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
    if groups.roller is not None:  # the mean over a line: at the ends a profile is steep
        faces = grid.faces
        places = faces[:-1] + np.outer(PLACES + 0.5, np.diff(faces))
        rise = groups.roller.rise(places).mean(axis=0) - groups.roller.rise(grid.y)
        found = found + rise[:, None]
    return found if curvature == 1.0 else found + 0.5 * (curvature - 1.0) * x**2
