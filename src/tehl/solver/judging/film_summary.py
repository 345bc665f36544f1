"""Central and minimum film, interpolated between the nodes of a grid."""

import math
from dataclasses import replace
from functools import cache

import numpy as np

from tehl.base.typing import Array, IntArray
from tehl.estimate.grid import Grid
from tehl.result.fields import FilmSummary

SPLINE_NODES = 5
"""Nodes on each side of the smallest one in the spline."""
SPLINE_SPAN = 1.5
"""Distance from the smallest node within which the minimum is searched, in mesh widths."""
SPLINE_SAMPLES = 121
"""Samples of the spline per direction: the minimum of the samples is above that of the spline by
1e-4 of the change over one mesh width."""

LEAST_OF_NODE = 0.8
"""Minimum of the spline over the smallest node below which that of the logarithm of the film is
taken: beside steep ends of rollers it grows a hundredfold within some lines, and its spline is
negative. Where the ends are smooth, both agree within 1 %."""


def central_value(grid: Grid, field: Array) -> float:
    """Return a field at X = Y = 0: the node there, else cubic interpolation.

    Parameters
    ----------
    grid : Grid
        On mirrored grids row 0 is the line y = 0.
    field : Array
        Nodal values, ``grid.shape``.
    """
    columns, column_weights = _lagrange(grid.x, grid.dx)
    if grid.mirror:
        return float(field[0, columns] @ column_weights)
    if grid.crowding and grid.ny % 2:
        return float(field[grid.ny // 2, columns] @ column_weights)
    rows, row_weights = _lagrange(grid.y, grid.dy)
    return float(row_weights @ field[np.ix_(rows, columns)] @ column_weights)


def _lagrange(nodes: Array, spacing: float) -> tuple[IntArray, Array]:
    """Return nodes around 0 and their weights: one if 0 is a node, else four (cubic)."""
    place = -float(nodes[0]) / spacing
    nearest = round(place)
    if abs(place - nearest) < 1e-9:
        return np.array([nearest]), np.ones(1)
    first = int(np.clip(np.floor(place) - 1, 0, len(nodes) - 4))
    offsets = place - first - np.arange(4.0)
    weights = np.array(
        [np.prod([offsets[m] / (k - m) for m in range(4) if m != k]) for k in range(4)]
    )
    return first + np.arange(4), weights


def film_summary(grid: Grid, film: Array, least: float | None = None) -> FilmSummary:
    """Return central and minimum film H, the minimum from a bicubic spline around its node.

    Where lines crowd at the ends of a roller the spline is that of the smallest film of each line:
    along x the film falls there from a plateau into its valley within two cells, and a spline
    beyond it: of a logarithmic profile (M = 50) it errs by 3 % on 257 x 129 nodes, and by 1.3 % on
    513 x 257, that of the lines by 0.7 and 0.2.

    The valley of a side lobe is narrow and oblique to the grid: its minimum may be more than a mesh
    width from the smallest node, beyond the reach of a quadratic through the neighbours.

    Parameters
    ----------
    grid : Grid
        Nodes of the film.
    film : Array
        H at the nodes [-], ``grid.shape``.
    least : float or None
        Boundary film H, the minimum between nodes that touch; None where surfaces do not touch.
    """
    full = grid.unfold(film)
    row = replace(grid, mirror=False).y
    j, i = (int(n) for n in np.unravel_index(int(full.argmin()), full.shape))
    wide, at = full, j
    if grid.wraps:  # no edge
        before, behind = grid.beyond(full, min(SPLINE_NODES, grid.ny - 1))
        wide, at = np.concatenate([before, full, behind]), j + len(before)
    # `SPLINE_NODES` nodes on each side of (j, i), symmetrically fewer near edges
    across, along = min(SPLINE_NODES, at, len(wide) - 1 - at), min(SPLINE_NODES, i, grid.nx - 1 - i)
    patch = wide[at - across : at + across + 1, i - along : i + along + 1]
    if grid.crowding:
        patch = wide[at - across : at + across + 1].min(axis=1, keepdims=True)
    minimum, (shift_y, shift_x) = subgrid_minimum(patch)
    if grid.is_closed and minimum < LEAST_OF_NODE * full[j, i] and patch.min() > 0.0:
        logarithm, (shift_y, shift_x) = subgrid_minimum(np.log(patch))
        minimum = math.exp(logarithm)
    if grid.wraps:
        shift_y = (j + shift_y) % (grid.ny - 1) - j
    at_y = float(np.interp(j + shift_y, np.arange(row.size), row))
    floor = -np.inf if least is None else least
    return FilmSummary(
        central=max(central_value(grid, film), floor),
        minimum=max(minimum, floor),
        minimum_node=float(full[j, i]),
        minimum_at=(float(grid.x[i] + shift_x * grid.dx), abs(at_y) if grid.mirror else at_y),
    )


def subgrid_minimum(patch: Array) -> tuple[float, tuple[float, float]]:
    """Return the minimum of a bicubic spline through ``patch``, and its place.

    The place is (row, column) from the central node in mesh widths, at most `SPLINE_SPAN` each.
    """
    rows, columns = (_sampling(n) for n in patch.shape)
    samples = rows @ patch @ columns.T
    j, i = np.unravel_index(int(samples.argmin()), samples.shape)
    places = [
        np.linspace(-SPLINE_SPAN, SPLINE_SPAN, len(m)) if len(m) > 1 else np.zeros(1)
        for m in (rows, columns)
    ]
    return float(samples[j, i]), (float(places[0][j]), float(places[1][i]))


@cache
def _sampling(nodes: int) -> Array:
    """Return the weights of the samples of a not-a-knot cubic spline of ``nodes`` values.

    `scipy.interpolate` has such a spline, but takes 0.4 s to load.
    """
    if nodes < 5:
        return np.eye(nodes)[nodes // 2 : nodes // 2 + 1]
    half = nodes // 2
    bend = np.zeros((nodes, nodes))  # second derivatives = inverse(system) @ bend @ values
    system = np.zeros((nodes, nodes))
    for k in range(1, nodes - 1):
        system[k, k - 1 : k + 2] = 1.0, 4.0, 1.0
        bend[k, k - 1 : k + 2] = 6.0, -12.0, 6.0
    # not-a-knot: the third derivative is continuous at the second and the last but one node
    system[0, :3] = system[-1, -3:] = 1.0, -2.0, 1.0
    curvature = np.linalg.solve(system, bend)
    place = half + np.linspace(-SPLINE_SPAN, SPLINE_SPAN, SPLINE_SAMPLES)
    left = np.floor(place).astype(int)
    t = (place - left)[:, None]
    value = np.eye(nodes)
    s = 1.0 - t
    return (
        s * value[left]
        + t * value[left + 1]
        + (s**3 - s) / 6.0 * curvature[left]
        + (t**3 - t) / 6.0 * curvature[left + 1]
    )
