"""Sums of the elastic deflection w = K * p over all nodes.

Multilevel multi-integration by coarsening one axis at a time (Brandt and Lubrecht 1990; Venner and
Lubrecht 2000, chapter 5). Along the axis that is halved, odd values are interpolated to sixth order
from even ones; near the singularity of the kernel a patch of sources around each node corrects the
sum (``table[d, q]``: error of the interpolated kernel ``d`` rows and ``q`` columns away). Sources
are padded with zeros, so that loops need no bounds; with a mirror line the rows before row 0 hold
the image. ``Box`` says where nodes lie in an array: node (j, i)
is element ``[j + oy, i + ox]``.

With few lines the exact sum across them of the transforms along x is faster (`sum_across`).
"""

from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.kernels.compiled import helper, kernel, summing_helper
from tehl.kernels.lanes import LANES
from tehl.kernels.raw import lanes, raw

C1, C3, C5 = 150.0 / 256.0, -25.0 / 256.0, 3.0 / 256.0  # sixth-order midpoint interpolation


class Box(NamedTuple):
    """First and last node of each axis, offsets of node (0, 0) in the array, mirror flag."""

    j0: int
    j1: int
    i0: int
    i1: int
    oy: int
    ox: int
    mirror: int


class Columns(NamedTuple):
    """Sources of even and odd columns, and scratch for the sums of one row.

    ``even[:, a]`` holds node 2a, ``odd[:, a]`` node 2a+1, both at a + ox/2. ``even_folds,
    odd_folds``: see `folds`. ``sums`` (2, m): at even and at odd columns ``start`` to ``stop``,
    with ``margin`` columns beside them.
    """

    even: Array
    odd: Array
    even_folds: Array
    odd_folds: Array
    sums: Array
    start: int
    stop: int
    margin: int


def folds(table: Array, width: int) -> Array:
    """Return scratch: sums of rows at equal distance by that distance, and their weighted sum."""
    return np.zeros((table.shape[0] + 1, width))


def row_folds(table: Array, fine: Box) -> Array:
    """Return the scratch of sums on the nodes of a row."""
    return folds(table, fine.i1 - fine.i0 + 2 * table.shape[1] - 1)


def columns_of(table: Array, shape: tuple[int, int], fine: Box, coarse: Box) -> Columns:
    """Return empty sources of even and odd columns for a source array of ``shape``."""
    half, shift, margin = shape[1] // 2 + 2, fine.ox // 2, table.shape[1] // 2 + 2
    start, stop = max(coarse.i0 + shift, margin), min(coarse.i1 + shift + 1, half - margin)
    width = stop - start + 2 * margin
    even, odd = np.zeros((2, shape[0], half))
    two = folds(table, width), folds(table, width)
    return Columns(even, odd, *two, np.zeros((2, width)), start, stop, margin)


@helper
def _reflect(u: Array, box: Box) -> None:
    """Fill the rows before a mirror line with the image of those behind it."""
    if box.mirror:
        for j in range(1, box.oy + 1):
            for x in range(u.shape[1]):
                u[box.oy - j, x] = u[box.oy + j, x]


@kernel
def gather_rows(u: Array, fine: Box, coarse_u: Array, coarse: Box) -> None:
    """Restrict sources to even rows by the transpose of interpolation, P_c = I^T P."""
    u, coarse_u = raw((u, coarse_u))
    for j in range(coarse.j0, coarse.j1 + 1):
        f, target = 2 * j + fine.oy, j + coarse.oy
        for x in range(fine.i0 + fine.ox, fine.i1 + fine.ox + 1):
            near = u[f, x] + C1 * (u[f + 1, x] + u[f - 1, x])
            middle = C3 * (u[f + 3, x] + u[f - 3, x])
            coarse_u[target, x] = near + middle + C5 * (u[f + 5, x] + u[f - 5, x])
    _reflect(coarse_u, coarse)


@helper
def _fold(u: Array, row: int, start: int, d: int, folded: Array) -> None:
    """Write the sum of the two rows ``d`` away from a row, from column ``start`` on."""
    if d == 0:
        for x in range(folded.shape[1]):
            folded[0, x] = u[row, start + x]
    else:
        for x in range(folded.shape[1]):
            folded[d, x] = u[row + d, start + x] + u[row - d, start + x]


@helper
def weigh(folded: Array, table: Array, q: int, every: tuple[int, int]) -> None:
    """Sum rows by ``table[:, q]`` to the last row, three at a time; ``every``: first row, step."""
    first, step = every
    n, width = table.shape[0], folded.shape[1]
    k = first
    if k + 2 * step < n:
        b, c = k + step, k + 2 * step
        e0, e1, e2 = table[k, q], table[b, q], table[c, q]
        for x in range(width):
            folded[n, x] = e0 * folded[k, x] + e1 * folded[b, x] + e2 * folded[c, x]
        k += 3 * step
    else:
        for x in range(width):
            folded[n, x] = 0.0
    while k + 2 * step < n:
        b, c = k + step, k + 2 * step
        e0, e1, e2 = table[k, q], table[b, q], table[c, q]
        for x in range(width):
            folded[n, x] += e0 * folded[k, x] + e1 * folded[b, x] + e2 * folded[c, x]
        k += 3 * step
    while k < n:
        e0 = table[k, q]
        for x in range(width):
            folded[n, x] += e0 * folded[k, x]
        k += step


@helper
def _add_shifted(
    folded: Array, shifts: tuple[int, int], out: Array, place: tuple[int, int, int]
) -> None:
    """Add the last row of ``folded``, shifted both ways, to ``out``; ``place``: row and span."""
    n, (left, right), (row, start, stop) = folded.shape[0] - 1, shifts, place
    if left == right:
        for x in range(start, stop):
            out[row, x] += folded[n, x + left]
    else:
        for x in range(start, stop):
            out[row, x] += folded[n, x + left] + folded[n, x + right]


@helper
def _add_patch_rows(
    u: Array, table: Array, folded: Array, out: Array, place: tuple[int, int, int, int]
) -> None:
    """Add the patch of sources around a row of ``u`` to a row of ``out``.

    ``place``: 0 for all distances, 1 for the odd ones, both rows, and the first column.
    """
    first, row, target, start = place
    side = table.shape[1] - 1
    stop = start + folded.shape[1] - 2 * side
    for d in range(first, table.shape[0], 1 + first):
        _fold(u, row, start - side, d, folded)
    for q in range(side + 1):
        weigh(folded, table, q, (first, 1 + first))
        shifts = (side - start + q, side - start - q)
        _add_shifted(folded, shifts, out, (target, start, stop))


@helper
def _interpolate_row(coarse_w: Array, box: Box, low: int, w: Array, target: int) -> None:
    """Interpolate a row of ``w`` midway between rows ``low`` and ``low + 1``."""
    a, b, c = low + box.oy, low - 1 + box.oy, low - 2 + box.oy
    if box.mirror:
        b, c = abs(low - 1) + box.oy, abs(low - 2) + box.oy
    above = low + box.oy
    for x in range(box.i0 + box.ox, box.i1 + box.ox + 1):
        near = C1 * (coarse_w[a, x] + coarse_w[above + 1, x])
        middle = C3 * (coarse_w[b, x] + coarse_w[above + 2, x])
        w[target, x] = near + middle + C5 * (coarse_w[c, x] + coarse_w[above + 3, x])


@kernel
def spread_rows(  # noqa: PLR0913, PLR0917
    u: Array, table: Array, folded: Array, fine: Box, coarse_w: Array, coarse: Box, w: Array
) -> None:
    """Correct the sums on even rows, interpolate the odd rows and correct them.

    ``coarse_w`` and ``w`` have the shapes of the padded source arrays of their grids; ``folded``
    is scratch.
    """
    u, table, folded, coarse_w, w = raw((u, table, folded, coarse_w, w))
    start = fine.i0 + fine.ox
    for j in range(coarse.j0, coarse.j1 + 1):
        place = (1, 2 * j + fine.oy, j + coarse.oy, start)
        _add_patch_rows(u, table, folded, coarse_w, place)
    for j in range(fine.j0, fine.j1 + 1):
        row = j + fine.oy
        if j % 2 == 0:
            for x in range(start, fine.i1 + fine.ox + 1):
                w[row, x] = coarse_w[j // 2 + coarse.oy, x]
        else:
            _interpolate_row(coarse_w, coarse, (j - 1) // 2, w, row)
            _add_patch_rows(u, table, folded, w, (0, row, row, start))


@kernel
def split_columns(u: Array, box: Box, columns: Columns) -> None:
    """De-interleave the sources into even and odd columns."""
    u, columns = raw((u, columns))
    parity = box.ox % 2
    n = min(columns.even.shape[1], (u.shape[1] - parity) // 2)
    for y in range(u.shape[0]):
        for a in range(n):
            columns.even[y, a] = u[y, 2 * a + parity]
            columns.odd[y, a] = u[y, 2 * a + parity + 1]


@kernel
def gather_columns(columns: Columns, fine: Box, coarse_u: Array, coarse: Box) -> None:
    """Restrict sources to even columns by the transpose of interpolation, P_c = I^T P."""
    columns, coarse_u = raw((columns, coarse_u))
    even, odd, shift = columns.even, columns.odd, coarse.ox - fine.ox // 2
    for j in range(coarse.j0, coarse.j1 + 1):
        y, target = j + fine.oy, j + coarse.oy
        for a in range(coarse.i0 + fine.ox // 2, coarse.i1 + fine.ox // 2 + 1):
            near = even[y, a] + C1 * (odd[y, a] + odd[y, a - 1])
            middle = C3 * (odd[y, a + 1] + odd[y, a - 2])
            coarse_u[target, a + shift] = near + middle + C5 * (odd[y, a + 2] + odd[y, a - 3])
    _reflect(coarse_u, coarse)


@helper
def _add_patch_columns(columns: Columns, table: Array, start: int, stop: int) -> None:
    """Add the patch of folded sources to a span of the sums at even and at odd columns."""
    even, odd, sums = columns.even_folds, columns.odd_folds, columns.sums
    in_even, in_odd = (0, start, stop), (1, start, stop)
    for d in range(table.shape[1]):
        s = d // 2
        weigh(odd, table, d, (0, 1))
        if d % 2 == 0:
            _add_shifted(odd, (s, -s), sums, in_odd)
        else:
            _add_shifted(odd, (s, -s - 1), sums, in_even)
            weigh(even, table, d, (0, 1))
            _add_shifted(even, (s + 1, -s), sums, in_odd)


@kernel
def spread_columns(
    columns: Columns, table: Array, fine: Box, coarse_w: Array, coarse: Box, w: Array
) -> None:
    """Correct the sums on even columns, interpolate the odd ones, correct and interleave them."""
    columns, table, coarse_w, w = raw((columns, table, coarse_w, w))
    sums, start, stop, margin = columns.sums, columns.start, columns.stop, columns.margin
    span = (margin, margin + stop - start)
    first, target = coarse.ox - fine.ox // 2 + start, 2 * start + fine.ox % 2
    for j in range(fine.j0, fine.j1 + 1):
        y = j + fine.oy
        for q in range(table.shape[0]):
            _fold(columns.even, y, start - margin, q, columns.even_folds)
            _fold(columns.odd, y, start - margin, q, columns.odd_folds)
        for x in range(sums.shape[1]):
            sums[0, x] = 0.0
            sums[1, x] = 0.0
        for a in range(stop - start):
            sums[0, margin + a] = coarse_w[j + coarse.oy, first + a]
        _add_patch_columns(columns, table, span[0], span[1])
        for x in range(span[0], span[1]):
            near = C1 * (sums[0, x] + sums[0, x + 1])
            middle = C3 * (sums[0, x - 1] + sums[0, x + 2])
            sums[1, x] += near + middle + C5 * (sums[0, x - 2] + sums[0, x + 3])
        for a in range(stop - start):
            w[y, target + 2 * a] = sums[0, margin + a]
            w[y, target + 2 * a + 1] = sums[1, margin + a]


@summing_helper
def _row_product(matrix: Array, m: int, flat: Array) -> float:
    """Return row ``m`` of a matrix times a vector."""
    total = 0.0
    for k in range(flat.shape[0]):
        total += matrix[m, k] * flat[k]
    return total


@kernel
def direct(matrix: Array, u: Array, box: Box, w: Array, flat: Array) -> None:
    """Sum directly on the coarsest grid, nodes numbered row by row; ``flat`` is scratch."""
    matrix, u, w, flat = raw((matrix, u, w, flat))
    nx = box.i1 - box.i0 + 1
    for k in range(flat.shape[0]):
        flat[k] = u[box.j0 + box.oy + k // nx, box.i0 + box.ox + k % nx]
    for m in range(flat.shape[0]):
        w[box.j0 + box.oy + m // nx, box.i0 + box.ox + m % nx] = _row_product(matrix, m, flat)


@kernel
def sum_across(lines: Array, kernel: Array, scratch: Array, out: Array, mirror: int) -> None:
    """Write the transforms along x of w = K * p: for each wavenumber a sum over the lines.

    ``lines, out`` (rows, modes) complex: transforms of p and of w; ``kernel`` (modes, width): that
    of the kernel at row offsets -(rows - 1), ..., real as the kernel is even, then eight zeros;
    ``scratch`` (2, rows). With ``mirror`` the images of rows 1, 2, ... contribute too.
    """
    lines, kernel, scratch, out = raw((lines, kernel, scratch, out))
    rows, modes = lines.shape
    for k in range(modes):
        for j in range(rows):
            scratch[0, j] = lines[j, k].real
            scratch[1, j] = lines[j, k].imag
        for first in range(0, rows, LANES):
            at = rows - 1 + first
            weight = kernel[k, lanes(at)]
            real, imaginary = weight * scratch[0, 0], weight * scratch[1, 0]
            for j in range(1, rows):
                weight = kernel[k, lanes(at - j)]
                if mirror:
                    weight = weight + kernel[k, lanes(at + j)]
                real += weight * scratch[0, j]
                imaginary += weight * scratch[1, j]
            for lane in range(min(LANES, rows - first)):
                out[first + lane, k] = complex(real[lane], imaginary[lane])
