"""Nodes and depths at which stresses are computed: around the contact, evenly in ln z."""

import math
from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.contact.roller import Ends
from tehl.contact.stress import Stress
from tehl.post.stress.loads import SurfaceLoads
from tehl.result.solution import Solution


class Window(NamedTuple):
    """Part of the nodes whose loads and stresses count, of an odd number along x and y."""

    rows: slice
    columns: slice
    spacing: tuple[float, float]
    """Mesh widths along y and x [m]."""


def window_of(result: Solution, pressure: Array) -> Window:
    """Return the nodes around the contact that carry its load, 1.25 half-widths at least.

    Parameters
    ----------
    result : Solution
        Gives the nodes.
    pressure : (ny, nx) array
        Of all that carries load [Pa].
    """
    # a window leaves out the edges of the domain, where little presses
    scaled, slices, least = result.scaled, [], 0.01 * float(pressure.max())
    for axis, along in ((scaled.y, 1), (scaled.x, 0)):
        inside = np.flatnonzero((pressure.max(axis=along) > least) | (np.abs(axis) <= 1.25))
        first, last = int(inside[0]), int(inside[-1])
        if (last - first) % 2:  # every second node is one of the window
            first, last = (first, last + 1) if last + 1 < axis.size else (first + 1, last)
        if (last - first) % 4 and 0 < first and last + 1 < axis.size:  # the middle is one of them
            first, last = first - 1, last + 1
        slices.append(slice(first, last + 1))
    widths = result.scales.half_width_y, result.scales.half_width_x
    steps = [
        width * (float(axis[1] - axis[0]) if axis.size > 1 else 1.0)
        for axis, width in zip((scaled.y, scaled.x), widths, strict=True)
    ]
    return Window(slices[0], slices[1], (steps[0], steps[1]))


def depths_of(result: Solution, settings: Stress, window: Window) -> Array:
    """Return the depths [m], from two mesh widths on, of rough pressures the larger ones.

    Those of pieces that go on too: where they are smooth they are those of a line contact.

    Parameters
    ----------
    result : Solution
        Gives the half-widths.
    settings : Stress
        Number of depths and the deepest.
    window : Window
        With the mesh widths.
    """
    smaller, goes_on = result.scales.half_width_x, result.groups.shape.goes_on
    if not goes_on:
        smaller = min(smaller, result.scales.half_width_y)
    rough = result.heights is not None or result.contact is not None
    is_line = result.scaled.y.size == 1
    wider = goes_on or (rough and not is_line)
    step = max(window.spacing) if wider else min(window.spacing)
    shallowest = 2.0 * step  # mesh widths: above it a rough pressure is not resolved
    deepest = max(settings.deepest * smaller, 4.0 * shallowest)
    return np.geomspace(shallowest, deepest, settings.depths)


def cut(loads: SurfaceLoads, window: Window) -> SurfaceLoads:
    """Return the loads on the nodes of a window, of a part of those on all nodes."""
    return SurfaceLoads(*(load[window.rows, window.columns] for load in loads))


def halved(field: Array, ends: Ends = "open", *, odd: bool = False) -> Array:
    """Return a field on every second node, by full weighting.

    Parameters
    ----------
    field : (ny, nx) array
        Values at the nodes.
    ends : {"open", "mirrored", "periodic"}
        What lies beyond its first and last row.
    odd : bool
        Whether images behind mirrors have the opposite sign.
    """
    return _weighted(_weighted(field, ends, odd=odd).T).T


def _weighted(field: Array, ends: Ends = "open", *, odd: bool = False) -> Array:
    """Return [1, 2, 1]/4 over every second row; of a single one the row itself."""
    if field.shape[0] == 1:
        return field
    south, north = 0.0 * field[:1], 0.0 * field[:1]
    if ends == "periodic":
        south, north = field[-2:-1], field[1:2]
    elif ends == "mirrored":
        sign = -1.0 if odd else 1.0
        south, north = sign * field[1:2], sign * field[-2:-1]
    wide = np.concatenate([south, field, north])
    return np.asarray(0.25 * wide[:-2:2] + 0.5 * field[::2] + 0.25 * wide[2::2])


def middle_row(result: Solution, window: Window) -> int:
    """Return the row of the window nearest to y = 0."""
    return int(np.argmin(np.abs(result.scaled.y[window.rows])))


def wake(result: Solution, settings: Stress, window: Window) -> tuple[int, int]:
    """Return the nodes before and behind a window that carry the wakes of heated bodies, even.

    They pull at the contact over 2.5 half-widths: twice as many change stresses by 1 % of the
    largest thermal one (balls of steel, solid Peclet number 10).

    Parameters
    ----------
    result : Solution
        Gives the velocities.
    settings : Stress
        Says whether heat counts, and of which bodies.
    window : Window
        With the mesh widths.
    """
    speeds = [result.problem.motion.speed_of(body) for body in settings.bodies]
    nodes = 2 * math.ceil(0.5 * 2.5 * result.scales.half_width_x / window.spacing[1])
    before, behind = any(speed < 0.0 for speed in speeds), any(speed > 0.0 for speed in speeds)
    return nodes * (settings.thermal and before), nodes * (settings.thermal and behind)
