"""The loaded zone, over which friction, powers and largest temperature rises are taken.

Around the contact the gap grows as r^2 / 2 and the shear stress of the oil falls as 1 / r^2: its
integral grows with the logarithm of the domain and has no limit. That over an ellipse around the
Hertz contact has one (docs/theory/traction.md).
"""

import math
from functools import lru_cache

import numpy as np

from tehl.base.typing import Array, BoolArray
from tehl.estimate.grid import Grid

RADIUS = 2.0
"""Half-axes of the loaded zone over those of the Hertz contact: X^2 + Y^2 <= 4."""
STRIPS = 4
"""Strips per cell across y that the edge of the zone crosses as straight lines along y."""

CUT_ERROR = 0.012
"""Largest relative error of an integral over the zone whose edge cuts cells, over the sum of the
squares of their lengths: of 1 / (H_0 + r^2 / 2), the shear rate of a thick film, with H_0 = 3 and 5
and cells of 0.6 to 2.5 half-widths. The traction of one (M = 3.7, a_y/a_x = 10.6) on cells of
2.5 x 3.7 half-widths errs by 1.3 % and has had a bar of 0.7 %."""


@lru_cache(maxsize=16)
def zone_of(grid: Grid, skew: float = 0.0) -> Array:
    """Return which part of the cell of each node lies in the loaded zone, ``grid.shape`` [-].

    Parameters
    ----------
    grid, skew : Grid, float
        As of `zone_part`.
    """
    return zone_part(grid.x, grid.y, skew=skew)


def cut_error(grid: Grid) -> float:
    """Return the relative error of an integral over the zone by cells that its edge cuts [-]."""
    across = 0.0 if grid.ny == 1 or grid.is_closed else grid.dy
    return CUT_ERROR * (grid.dx**2 + across**2)


def zone_part(x: Array, y: Array, radius: float = RADIUS, skew: float = 0.0) -> Array:
    """Return which part of the cell of each node lies in the loaded zone, (ny, nx), read-only [-].

    The cells at the ends are half cells. A sum over nodes with these weights is of second order in
    the mesh width; over whole cells it would jump as nodes enter the zone.

    Parameters
    ----------
    x, y : (nx,), (ny,) array
        Uniform nodes, in Hertz half-widths; of y the upper half is enough if it starts at 0.
    radius : float
        Half-axes of the zone over those of the Hertz contact.
    skew : float
        s of the rim of the contact, X^2 - 2 s X Y + Y^2 = 1 - s^2.
    """
    edges_x, edges_y = _edges(x), _edges(y)
    middles = (np.arange(STRIPS) + 0.5) / STRIPS
    across = edges_y[:-1, None] + np.diff(edges_y)[:, None] * middles
    if ends_at_roller(y):
        across *= 0.0
    chords = np.sqrt(np.maximum(radius**2 - across**2, 0.0))
    chords *= math.sqrt(1.0 - skew**2)
    ends = zip((skew * across - chords).T, (skew * across + chords).T, strict=True)
    part = sum(np.clip(edges_x, low[:, None], high[:, None]) for low, high in ends)
    part = np.diff(part, axis=1) / (STRIPS * np.diff(edges_x))
    part.flags.writeable = False
    return np.asarray(part)


def beside(grid: Grid, field: Array, skew: float = 0.0) -> float:
    """Return the integral of a field over the zone beyond the side edges of a grid [-].

    The field is that of the rows next to the edges: more than a stress there, as the gap grows.

    Parameters
    ----------
    grid, skew : Grid, float
        As of `zone_part`.
    field : array of ``grid.shape``
        Values at the nodes.
    """
    y, dy, found = grid.y, grid.dy, 0.0
    rows = max(math.ceil((RADIUS - float(y[-1])) / dy), 0)
    if rows == 0 or ends_at_roller(y):
        return found
    further = dy * np.arange(rows + 1.0)
    weights = np.full(rows + 1, dy * grid.dx)
    weights[[0, -1]] *= 0.5
    sides = [(float(y[-1]) + further, field[-2])]
    sides.append(sides[0] if grid.mirror else (float(y[0]) - further[::-1], field[1]))
    for across, row in sides:
        found += float(weights @ zone_part(grid.x, across, skew=skew) @ row)
    return found


def contact_mean(x: Array, y: Array, field: Array, skew: float = 0.0) -> float:
    """Return the mean of a field over the Hertz contact, of second order in the mesh width.

    Of a contact within a cell, far from the elastic limit, it is the value at the middle.

    Parameters
    ----------
    x, y : (nx,), (ny,) array
        As in `zone_part`.
    field : (ny, nx) array
        Values at the nodes.
    skew : float
        As of `zone_part`.
    """
    rows = np.diff(_edges(y)) if y.size > 1 else np.ones(1)
    cells = np.outer(rows, np.diff(_edges(x))) * zone_part(x, y, radius=1.0, skew=skew)
    if not cells.any():
        return float(field[np.abs(y).argmin(), np.abs(x).argmin()])
    return float((cells * field).sum() / cells.sum())


def is_inside(x: Array, y: Array, skew: float = 0.0) -> BoolArray:
    """Return which nodes lie in the loaded zone, (ny, nx).

    Parameters
    ----------
    x, y : Array
        Nodes along each axis in Hertz half-widths, (nx,) and (ny,).
    skew : float
        As of `zone_part`.
    """
    y = 0.0 * y if ends_at_roller(y) else y
    reach = np.add.outer(y**2, x**2) - 2.0 * skew * np.multiply.outer(y, x)
    return np.asarray(reach <= RADIUS**2 * (1.0 - skew**2))


def ends_at_roller(y: Array) -> bool:
    """Whether nodes are those of a line or a roller, which lie in the zone along all of it.

    Those of an ellipse reach beyond it.
    """
    return float(np.abs(y).max()) <= 1.0


def _edges(axis: Array) -> Array:
    """Return the edges of the cells around nodes, (n + 1,)."""
    return np.concatenate([axis[:1], 0.5 * (axis[1:] + axis[:-1]), axis[-1:]])


def wet_part(pressure: Array) -> Array:
    r"""Return which part of the cell of each node is under pressure, (ny, nx) [-].

    A film ruptures between its last node under pressure and the one after the next. Upstream of
    the first dry node, j nodes away, the discrete pressure is that of a constant wedge,
    :math:`P_j = c (j^2 + \beta j)` with :math:`-1 < \beta \le 1`, so
    :math:`\beta = (4 P_1 - P_2) / (P_2 - 2 P_1)`, and the parabola with this slope has its vertex
    :math:`\beta / 2` mesh widths downstream of the dry node. Nodes alone would move the front by
    steps of a mesh width, half of one too far upstream on average.

    Parameters
    ----------
    pressure : (ny, nx) array
        On lines along x.
    """
    wet = pressure > 0.0
    part = wet.astype(np.float64)
    rows, columns = np.nonzero(wet[:, 1:-1] & ~wet[:, 2:])
    last, before = pressure[rows, columns + 1], pressure[rows, columns]
    steep = np.maximum(before - 2.0 * last, 1e-12 * last)
    beta = np.clip((4.0 * last - before) / steep, -1.0, 1.0)
    part[rows, columns + 2] = np.where(before > 0.0, 0.5 * (1.0 + beta), 0.0)
    return part
