"""Interpolation to the next finer grid: cubic for pressures, linear for lubricant factors."""

from typing import TypeVar

import numpy as np

from tehl.base.typing import Array, FlagArray
from tehl.estimate.grid import Grid

Field = TypeVar("Field", Array, FlagArray)


def refine(pressure: Array, fine: Grid) -> Array:
    """Return a pressure interpolated to a finer grid: cubic, not negative, zero on the edges.

    Full multigrid needs an interpolation of higher order than the second-order discretisation
    (Trottenberg, Oosterlee and Schüller 2001, section 2.6).

    Parameters
    ----------
    pressure : Array
        P on the grid with twice the mesh widths, or twice that along one axis [-].
    fine : Grid
        Decides whether row 0 is the symmetry line.
    """
    field = np.maximum(refine_signed(pressure, fine), 0.0)
    field[:, [0, -1]] = 0.0
    field[list(fine.edge_rows)] = 0.0
    return field


def refine_signed(pressure: Array, fine: Grid) -> Array:
    """Return a difference of pressures interpolated to a finer grid, as of `refine`.

    Parameters
    ----------
    pressure, fine : Array, Grid
        As of `refine`.
    """
    field = pressure if fine.nx == pressure.shape[1] else _cubic_along_x(pressure)
    if fine.shape[0] != pressure.shape[0]:
        # two more rows make a symmetry line or a closed end an inner one
        before, behind = fine.beyond(field, 2)
        field = _cubic_along_x(np.concatenate([before, field, behind]).T).T
        field = field[2 * len(before) : len(field) - 2 * len(behind)]
    return field


def _cubic_along_x(values: Array) -> Array:
    """Insert midpoints along the last axis: (-1, 9, 9, -1)/16 inside, linear at the ends."""
    fine = np.empty((*values.shape[:-1], 2 * values.shape[-1] - 1))
    fine[..., ::2] = values
    inner = 9.0 * (values[..., 1:-2] + values[..., 2:-1]) - values[..., :-3] - values[..., 3:]
    fine[..., 3:-3:2] = inner / 16.0
    fine[..., 1] = 0.5 * (values[..., 0] + values[..., 1])
    fine[..., -2] = 0.5 * (values[..., -2] + values[..., -1])
    return fine


def injected(fine: Field, coarse: Array | FlagArray) -> Field:
    """Return the values at the nodes of a coarser grid, which may have as many along one axis.

    Parameters
    ----------
    fine, coarse : (ny, nx) array
        Values, and any field of the coarser grid.
    """
    rows, columns = (1 + (n > m) for n, m in zip(fine.shape, coarse.shape, strict=True))
    return fine[::rows, ::columns]


def midpoints(values: Array, shape: tuple[int, ...] | None = None) -> Array:
    """Insert midpoints along the first and the last axis, linearly; a single row stays one.

    Parameters
    ----------
    values : Array
        On the coarser grid.
    shape : tuple of int or None
        That of the field on the finer grid, which may have the same lines; None inserts midpoints
        along both axes.
    """
    first, *inner, last = values.shape
    shape = (2 * first - 1, *inner, 2 * last - 1) if shape is None else shape
    fine, rows, columns = np.empty(shape), 1 + (shape[0] > first), 1 + (shape[-1] > last)
    fine[::rows, ..., ::columns] = values
    if rows == 2:
        fine[1::2, ..., ::columns] = 0.5 * (values[1:] + values[:-1])
    if columns == 2:
        fine[..., 1::2] = 0.5 * (fine[..., :-1:2] + fine[..., 2::2])
    return fine
