"""Undeformed gap and rigid motions; `Level.update` adds the deflection, H = H00 + gap + K P."""

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


def rigid_motions(grid: Grid, groups: Groups) -> tuple[Array, Array]:
    """Return the film by each rigid motion over its size, and the stated moments.

    The first motion is the approach, which lifts all lines by one; a second one the tilt of a
    roller whose moment is stated, by Y. Shapes (motions, ny) and (motions - 1,).

    Parameters
    ----------
    grid, groups : Grid, Groups
        On one half of a contact that is symmetric in y nothing tilts.
    """
    approach, roller = np.ones((1, grid.shape[0])), groups.roller
    if roller is None or roller.moment is None or grid.mirror:
        return approach, np.zeros(0)
    return np.append(approach, grid.centres[None], axis=0), np.array([roller.scaled_moment])
