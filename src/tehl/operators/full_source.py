"""Surface temperature under a moving source of any speed: the half-space, by FFT.

The steady rise of a half-space under a heat flux q, seen from the source past which it moves with
the velocity u_s, is (Jaeger 1942; Carslaw and Jaeger 1959, sec. 10.7)

    T(x, y) - T_b = 1/(2 pi k) int q exp[-(|u_s| r - u_s.(x - x')) / (2 diffusivity)] / r dA'.

The line source of `tehl.operators.line_source` is its limit for high solid Peclet numbers.
"""

import math

import numpy as np
from scipy.special import k0e, k1e

from tehl.base.typing import Array, IntArray
from tehl.operators.influence import Influence

NEAR = (4, 10)
"""Rows and columns from the source within which a cell is split: there the plume is narrow."""
SOURCE_IMAGES = 4
"""Images on each side that are summed one by one: the rise errs by 2e-4 of the largest at most, for
periods of 6 to 32 columns and velocities of 0.1 to 5."""
WRAPS = 3
"""In place of a number of mirrors: the last row is the first one again."""
PARTS_PER_SIDE = 5
"""Parts of a near square cell along each side; odd, so that none has a corner on the axes."""


class FullSource:
    """Convolution of the heat flux of one grid with the temperature of a moving point source.

    Parameters
    ----------
    shape : (int, int)
        Rows and columns of nodes that are stored.
    mirrors : int
        1 if row 0 is a symmetry line, 2 if all goes on behind the first and the last row, `WRAPS`
        if the last row is the first one again.
    cell : (float, float)
        Sides (dy, dx) of a cell, in a_x.
    peclet : (float, float)
        u_s a_x / (2 diffusivity) along x and y, signed [-].
    line : float
        Factor of a line source that is accounted for elsewhere and left out here.
    factor : float
        Rise per flux over a cell divided by distance.
    """

    def __init__(
        self,
        shape: tuple[int, int],
        mirrors: int,
        cell: tuple[float, float],
        peclet: tuple[float, float],
        factor: float,
        line: float = 0.0,
    ) -> None:
        (stored, nx), wraps = shape, mirrors == WRAPS
        ny = 2 * stored - 1 if mirrors == 1 else stored
        self.mirror, self.shape, self.wraps = mirrors > 0, (ny, nx), wraps
        self.period = (ny - 1 if wraps else 2 * (ny - 1) or 1, 2 * (nx - 1))
        rows = np.arange(self.period[0] // 2 + 1 if wraps else ny)
        if wraps and peclet[1] != 0.0:
            rows = np.arange(self.period[0])
        elif peclet[1] != 0.0:  # not even in y
            rows = np.arange(self.period[0])
            rows = np.where(rows < ny, rows, rows - self.period[0])
        columns = np.arange(2 * (nx - 1))
        columns = np.where(columns < nx, columns, columns - 2 * (nx - 1))
        source = _row_source if np.isinf(cell[0]) else _point_source
        source = _periodic_source if mirrors > 1 else source
        table = factor * source(rows, columns, cell, peclet)
        if line > 0.0:
            table[0] -= line * _line_cells(columns, cell[1])
        folded = np.minimum(np.arange(self.period[0]), self.period[0] - np.arange(self.period[0]))
        self.spectrum = np.fft.rfft2(table if peclet[1] != 0.0 else table[folded])

    def rise(self, flux: Array) -> Array:
        """Return the temperature rise under ``flux``, both of the stored shape."""
        stored, nx = flux.shape
        padded = np.zeros(self.period)
        if self.wraps:
            padded[:, :nx] = flux[:-1]
            convolved = np.fft.irfft2(np.fft.rfft2(padded) * self.spectrum, s=self.period)
            return np.concatenate([convolved, convolved[:1]])[:, :nx].copy()
        padded[:stored, :nx] = flux
        if self.mirror:
            padded[:-stored:-1, :nx] = flux[1:]
        convolved = np.fft.irfft2(np.fft.rfft2(padded) * self.spectrum, s=self.period)
        return np.ascontiguousarray(convolved[:stored, :nx])


def _point_source(
    rows: IntArray, columns: IntArray, cell: tuple[float, float], peclet: tuple[float, float]
) -> Array:
    """Return the integral of exp[-(|B| r - B.x)]/r over cells (rows, columns) from the source.

    The 1/r is integrated exactly, with the exponential of the middle; cells near the source are
    split, so that the plume is resolved, and so are cells beside it that are long in y: the plume
    is narrower than they are.
    """
    table = _split(rows, columns, cell, peclet, (1, 1))
    near_rows = np.flatnonzero(np.abs(rows) <= NEAR[peclet[1] != 0.0])
    near_columns = np.flatnonzero(np.abs(columns) <= NEAR[1])
    if not near_rows.size:
        return table
    long = 2 * int(0.5 * cell[0] / cell[1]) + 1
    if long > 1:
        table[near_rows] = _split(rows[near_rows], columns, cell, peclet, (long, 1))
    parts = (PARTS_PER_SIDE * long, PARTS_PER_SIDE)
    near = _split(rows[near_rows], columns[near_columns], cell, peclet, parts)
    table[np.ix_(near_rows, near_columns)] = near
    return table


def _split(
    rows: IntArray,
    columns: IntArray,
    cell: tuple[float, float],
    peclet: tuple[float, float],
    parts: tuple[int, int],
) -> Array:
    """Return the integral of `_point_source` over cells that are split into ``parts`` (y, x)."""
    dy, dx = (np.float64(side / count) for side, count in zip(cell, parts, strict=True))
    j, i = (
        (count * places[:, None] + np.arange(count) - count // 2).ravel()
        for places, count in zip((rows, columns), parts, strict=True)
    )
    pieces = _at(Influence(float(dx), float(dy), 1.0), j, i)
    pieces *= _plume(dx * i[None, :], dy * j[:, None], peclet)
    shape = (len(rows), parts[0], len(columns), parts[1])
    return np.asarray(pieces.reshape(shape).sum(axis=(1, 3)))


def _periodic_source(
    rows: IntArray, columns: IntArray, cell: tuple[float, float], peclet: tuple[float, float]
) -> Array:
    """Return the same of a cell and its images at all multiples of a period.

    That is twice the rows, or as long as they are where the source is not even in y. Rows of one
    period together are a `_row_source`, from which the part of images far away follows: they differ
    little from row to row. Where heat moves along y too, those are images whose paths do not come
    back within the columns.
    """
    along, across = peclet
    if across == 0.0:
        period = 2 * (rows.size - 1)
        counts = np.full(rows.size, 2.0)
        counts[[0, -1]] = 1.0
    else:
        period, counts = rows.size, np.ones(rows.size)
        rows = (rows + period // 2) % period - period // 2
    reach = np.abs(columns).max() * cell[1] * abs(across) / (abs(along) * period * cell[0])
    most = SOURCE_IMAGES + math.ceil(reach)
    images = range(-most * period, (most + 1) * period, period)
    table = sum(_point_source(rows + image, columns, cell, peclet) for image in images)
    missing = _row_source(rows, columns, (math.inf, cell[1]), peclet) - counts @ table
    return np.asarray(table + missing / period)


def _at(influence: Influence, rows: IntArray, columns: IntArray) -> Array:
    """Return an influence at offsets (rows, columns), of which it is even."""
    j, i = np.abs(rows), np.abs(columns)
    return influence.table(int(j.max()) + 1, int(i.max()) + 1)[np.ix_(j, i)]


def _row_source(
    rows: IntArray, columns: IntArray, cell: tuple[float, float], velocity: tuple[float, float]
) -> Array:
    """Return the integral of the same over all y and over the cells of a row, (1, columns).

    2 exp(B x) K_0(|B x|), whose antiderivatives are z e^z (K_0 + K_1) and z e^-z (K_0 - K_1) with
    z = |B x|. A surface at rest has no steady temperature.
    """
    del rows
    peclet = velocity[0]  # along a row nothing changes
    sign = np.sign(peclet)
    ends = sign * np.float64(cell[1]) * (columns - 0.5)

    def part(x: Array) -> Array:
        z = np.abs(peclet * x)
        behind = z * (k0e(z) + k1e(z)) - 1.0
        ahead = -z * np.exp(-2.0 * z) * (k0e(z) - k1e(z)) - 1.0
        return np.where(x > 0.0, behind, ahead)

    found = part(ends + sign * cell[1]) - part(ends)
    return 2.0 * np.abs(found)[None, :] / abs(peclet)


def _plume(x: Array, y: Array, peclet: tuple[float, float]) -> Array:
    """Return exp[-(|B| r - B.x)]."""
    along, across = peclet
    if across != 0.0:
        return np.exp(along * x + across * y - math.hypot(along, across) * np.hypot(x, y))
    return np.exp(-abs(along) * (np.hypot(x, y) - x * np.sign(along)))


def _line_cells(columns: IntArray, dx: float) -> Array:
    """Return the integral of 1/sqrt(x - s) over the cells upstream of a node."""
    low = np.sqrt(np.maximum(columns - 0.5, 0.0) * dx)
    high = np.sqrt(np.maximum(columns + 0.5, 0.0) * dx)
    return 2.0 * (high - low)
