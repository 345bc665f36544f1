"""Interpolation to the next finer grid: cubic for pressures, linear for lubricant factors."""

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.grid import Grid


def refine(pressure: Array, fine: Grid) -> Array:
    """Return a pressure interpolated to a finer grid: cubic, not negative, zero on the edges.

    Full multigrid needs an interpolation of higher order than the second-order discretisation
    (Trottenberg, Oosterlee and Schüller 2001, section 2.6).

    Parameters
    ----------
    pressure : Array
        P on the grid with twice the mesh widths [-].
    fine : Grid
        Decides whether row 0 is the symmetry line.
    """
    rows = _cubic_along_x(pressure)
    if fine.ny == 1:
        rows[:, [0, -1]] = 0.0
        return np.maximum(rows, 0.0)
    if fine.mirror:  # two mirrored rows make the symmetry line an inner one
        rows = np.concatenate([rows[2:0:-1], rows])
    field = _cubic_along_x(rows.T).T
    if fine.mirror:
        field = field[4:]
    field = np.maximum(field, 0.0)
    field[-1] = field[:, 0] = field[:, -1] = 0.0
    if not fine.mirror:
        field[0] = 0.0
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


def midpoints(values: Array) -> Array:
    """Insert midpoints along the first and the last axis, linearly; a single row stays one."""
    shape = (2 * values.shape[0] - 1, *values.shape[1:-1], 2 * values.shape[-1] - 1)
    fine = np.empty(shape)
    fine[::2, ..., ::2] = values
    fine[1::2, ..., ::2] = 0.5 * (values[1:] + values[:-1])
    fine[..., 1::2] = 0.5 * (fine[..., :-1:2] + fine[..., 2::2])
    return fine
