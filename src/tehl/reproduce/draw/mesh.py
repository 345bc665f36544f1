"""Meshes on which surfaces are drawn: they follow what would else be torn by a coarse mesh."""

from dataclasses import dataclass

import numpy as np

from tehl.plots.frame import span_part
from tehl.reproduce.measures import bilinear
from tehl.typing import Array

Window = tuple[tuple[float, float], tuple[float, float]]

_RIM = 1.28
"""Radius of a round mesh, in half-widths."""
_RINGS, _RAYS = 44, 96
_INNER, _EDGE = 0.004, 0.7
"""Radius of the innermost ring, and beyond which rings lie closer."""
_ROWS = 61
"""Rows drawn one behind another."""


@dataclass(frozen=True, slots=True)
class Surface:
    """Places and values, arrays of one shape.

    Attributes
    ----------
    x, y, z : (rows, columns) array
        Places [half-widths] and values.
    """

    x: Array
    y: Array
    z: Array


def round_mesh(x: Array, y: Array, field: Array) -> Surface:
    """Return a field on rings around the contact, closer near its rim."""
    half = _RINGS // 2
    inner = np.linspace(_INNER, _EDGE, half, endpoint=False)
    rings = np.concatenate([inner, np.linspace(_EDGE, _RIM, _RINGS - half)])
    rays = np.linspace(0.0, 2.0 * np.pi, _RAYS + 1)
    at_x, at_y = np.outer(rings, np.cos(rays)), np.outer(rings, np.sin(rays))
    columns = (at_x - x[0]) / (x[1] - x[0])
    rows = (at_y - y[0]) / (y[1] - y[0])
    return Surface(at_x, at_y, bilinear(field, rows, columns))


@dataclass(frozen=True, slots=True)
class Profiles:
    """Rows of a field along X, one behind another.

    Attributes
    ----------
    x : (n,) array
        Places along X [half-widths].
    y : (m,) array
        Of the rows.
    z : (m, n) array
        Values.
    """

    x: Array
    y: Array
    z: Array


def profiles(x: Array, y: Array, field: Array, window: Window) -> Profiles:
    """Return some rows of a field with all their nodes: nothing is interpolated."""
    columns, rows = (span_part(axis, *span) for axis, span in zip((x, y), window, strict=True))
    kept = np.unique(np.linspace(rows.start, rows.stop - 1, _ROWS).round().astype(int))
    return Profiles(x[columns], y[kept], field[kept][:, columns])
