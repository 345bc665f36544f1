"""Compiled steps of multilevel multi-integration: w = K * u by coarsening one axis at a time.

Brandt and Lubrecht (1990). Along the axis that is halved, odd values are interpolated to sixth
order from even ones; where the kernel is not smooth the difference is put right on a patch of
sources around each node (``table[d, q]``: error of the interpolated kernel at distance ``d`` along
the axis and ``q`` across it). Sources are padded with zeros, so that no loop asks for bounds; a
source array with a mirror line has its image in the rows before row 0. ``Box`` says where nodes
lie in an array: node (j, i) is element ``[j + oy, i + ox]``.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from tehl.typing import Array

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


@njit(cache=True)
def load(p: Array, u: Array, box: Box) -> None:
    """Copy nodal sources ``p`` into the padded array ``u``."""
    ny, nx = p.shape
    u[box.oy : box.oy + ny, box.ox : box.ox + nx] = p
    reflect(u, box)


@njit(cache=True)
def reflect(u: Array, box: Box) -> None:
    """Fill the rows before a mirror line with the image of those behind it."""
    if box.mirror:
        for j in range(1, box.oy + 1):
            u[box.oy - j, :] = u[box.oy + j, :]


@njit(cache=True, fastmath={"contract"})
def gather_rows(u: Array, fine: Box, coarse_u: Array, coarse: Box) -> None:
    """Send sources to even rows: the transpose of interpolation."""
    a, b = fine.i0 + fine.ox, fine.i1 + fine.ox + 1
    begin = fine.i0 + coarse.ox
    for j in range(coarse.j0, coarse.j1 + 1):
        f = 2 * j + fine.oy
        target = coarse_u[j + coarse.oy, begin : begin + b - a]
        mid, up1, down1 = u[f, a:b], u[f + 1, a:b], u[f - 1, a:b]
        up3, down3, up5, down5 = u[f + 3, a:b], u[f - 3, a:b], u[f + 5, a:b], u[f - 5, a:b]
        for x in range(b - a):
            near = mid[x] + C1 * (up1[x] + down1[x])
            target[x] = near + C3 * (up3[x] + down3[x]) + C5 * (up5[x] + down5[x])
    reflect(coarse_u, coarse)


@njit(cache=True, fastmath={"contract"})
def fold(above: Array, below: Array, out: Array) -> None:
    """Write the sum of two rows."""
    for x in range(out.shape[0]):
        out[x] = above[x] + below[x]


@njit(cache=True, fastmath={"contract"})
def weigh(rows: Array, weights: Array, first: int, step: int, out: Array) -> None:
    """Write the weighted sum of rows ``first, first + step, ...`` to ``out``, three at a time."""
    n = weights.shape[0]
    k = first
    out[:] = 0.0
    while k + 2 * step < n:
        a, b, c = rows[k], rows[k + step], rows[k + 2 * step]
        e0, e1, e2 = weights[k], weights[k + step], weights[k + 2 * step]
        for x in range(out.shape[0]):
            out[x] += e0 * a[x] + e1 * b[x] + e2 * c[x]
        k += 3 * step
    while k < n:
        a, e0 = rows[k], weights[k]
        for x in range(out.shape[0]):
            out[x] += e0 * a[x]
        k += step


@njit(cache=True)
def add(one: Array, out: Array) -> None:
    """Add a row to ``out``."""
    for x in range(out.shape[0]):
        out[x] += one[x]


@njit(cache=True)
def add_pair(one: Array, other: Array, out: Array) -> None:
    """Add two rows to ``out``."""
    for x in range(out.shape[0]):
        out[x] += one[x] + other[x]


@njit(cache=True)
def add_patch_rows(
    u: Array, table: Array, at: tuple[int, int, int], first: int, work: Array, out: Array
) -> None:
    """Add the patch of sources around ``(row, start, stop) = at`` of ``u`` to ``out``.

    Distances are all from 0 on (``first = 0``) or the odd ones (``first = 1``). ``work`` has
    one row more than ``table`` and ``stop - start`` columns and those of the patch.
    """
    row, start, stop = at
    reach, side = table.shape[0] - 1, table.shape[1] - 1
    low, high = start - side, stop + side
    total = work[reach + 1]
    if first == 0:
        work[0, :] = u[row, low:high]
    for d in range(1, reach + 1, 1 + first):
        fold(u[row + d, low:high], u[row - d, low:high], work[d])
    n = stop - start
    for q in range(side + 1):
        weigh(work, table[:, q], first, 1 + first, total)
        if q == 0:
            add(total[side : side + n], out[start:stop])
        else:
            add_pair(
                total[side + q : side + q + n], total[side - q : side - q + n], out[start:stop]
            )


@njit(cache=True, fastmath={"contract"})
def interpolate_row(w: Array, box: Box, low: int, start: int, out: Array) -> None:
    """Interpolate midway between rows ``low`` and ``low + 1``, from column ``start`` on."""
    stop = start + out.shape[0]
    below = low + box.oy, low - 1 + box.oy, low - 2 + box.oy
    if box.mirror:
        below = low + box.oy, abs(low - 1) + box.oy, abs(low - 2) + box.oy
    near_a, near_b = w[below[0], start:stop], w[low + 1 + box.oy, start:stop]
    mid_a, mid_b = w[below[1], start:stop], w[low + 2 + box.oy, start:stop]
    far_a, far_b = w[below[2], start:stop], w[low + 3 + box.oy, start:stop]
    for x in range(stop - start):
        near = C1 * (near_a[x] + near_b[x])
        out[x] = near + C3 * (mid_a[x] + mid_b[x]) + C5 * (far_a[x] + far_b[x])


@njit(cache=True, fastmath={"contract"})
def spread_rows(u: Array, table: Array, fine: Box, coarse_w: Array, coarse: Box, w: Array) -> None:
    """Correct the sums on even rows, interpolate the odd rows and correct them.

    ``coarse_w`` and ``w`` have the shapes of the padded source arrays of their grids.
    """
    start, stop = fine.i0 + fine.ox, fine.i1 + fine.ox + 1
    work = np.empty((table.shape[0] + 1, stop - start + 2 * table.shape[1] - 2))
    for j in range(coarse.j0, coarse.j1 + 1):
        place = (2 * j + fine.oy, start, stop)
        add_patch_rows(u, table, place, 1, work, coarse_w[j + coarse.oy])
    for j in range(fine.j0, fine.j1 + 1):
        target = w[j + fine.oy]
        if j % 2 == 0:
            target[start:stop] = coarse_w[j // 2 + coarse.oy, start:stop]
            continue
        interpolate_row(coarse_w, coarse, (j - 1) // 2, start, target[start:stop])
        add_patch_rows(u, table, (j + fine.oy, start, stop), 0, work, target)


@njit(cache=True)
def split_columns(u: Array, box: Box, even: Array, odd: Array) -> None:
    """De-interleave: ``even[:, a]`` holds node 2a, ``odd[:, a]`` node 2a+1, both at a + ox/2."""
    parity = box.ox % 2
    n = min(even.shape[1], (u.shape[1] - parity) // 2)
    for y in range(u.shape[0]):
        row, even_row, odd_row = u[y, parity:], even[y], odd[y]
        for a in range(n):
            even_row[a] = row[2 * a]
            odd_row[a] = row[2 * a + 1]


@njit(cache=True, fastmath={"contract"})
def gather_columns(even: Array, odd: Array, fine: Box, coarse_u: Array, coarse: Box) -> None:
    """Send sources to even columns: the transpose of interpolation."""
    a, n = coarse.i0 + fine.ox // 2, coarse.i1 - coarse.i0 + 1
    begin = coarse.i0 + coarse.ox
    for j in range(coarse.j0, coarse.j1 + 1):
        target = coarse_u[j + coarse.oy, begin : begin + n]
        mid, side = even[j + fine.oy, a : a + n], odd[j + fine.oy, a - 3 : a + n + 2]
        for i in range(n):
            target[i] = (
                mid[i]
                + C1 * (side[i + 3] + side[i + 2])
                + C3 * (side[i + 4] + side[i + 1])
                + C5 * (side[i + 5] + side[i])
            )
    reflect(coarse_u, coarse)


@njit(cache=True, fastmath={"contract"})
def add_patch_columns(
    even: Array, odd: Array, table: Array, span: tuple[int, int], sum_e: Array, sum_o: Array
) -> None:
    """Add the patch of sources to elements ``span`` of the sums at even and at odd columns.

    ``even`` and ``odd`` (side + 1, n) hold the sources folded about the row of the sums.
    """
    start, stop = span
    total = np.empty(even.shape[1])
    for d in range(table.shape[0]):
        s = d // 2
        weigh(odd, table[d], 0, 1, total)
        if d == 0:
            add(total[start:stop], sum_o[start:stop])
        elif d % 2 == 0:
            add_pair(total[start + s : stop + s], total[start - s : stop - s], sum_o[start:stop])
        else:
            add_pair(
                total[start + s : stop + s],
                total[start - s - 1 : stop - s - 1],
                sum_e[start:stop],
            )
            weigh(even, table[d], 0, 1, total)
            add_pair(
                total[start + s + 1 : stop + s + 1],
                total[start - s : stop - s],
                sum_o[start:stop],
            )


@njit(cache=True, fastmath={"contract"})
def spread_columns(  # noqa: PLR0913, PLR0917
    even: Array, odd: Array, table: Array, fine: Box, coarse_w: Array, coarse: Box, w: Array
) -> None:
    """Correct the sums on even columns, interpolate the odd ones, correct and interleave them."""
    n, side = even.shape[1], table.shape[1] - 1
    margin = table.shape[0] // 2 + 2
    shift, parity = fine.ox // 2, fine.ox % 2
    start, stop = max(coarse.i0 + shift, margin), min(coarse.i1 + shift + 1, n - margin)
    wide = slice(start - margin, stop + margin)
    m = stop - start + 2 * margin
    fold_e, fold_o = np.empty((side + 1, m)), np.empty((side + 1, m))
    sum_e, sum_o = np.empty(m), np.empty(m)
    for j in range(fine.j0, fine.j1 + 1):
        y = j + fine.oy
        fold_e[0, :], fold_o[0, :] = even[y, wide], odd[y, wide]
        for q in range(1, side + 1):
            fold(even[y + q, wide], even[y - q, wide], fold_e[q])
            fold(odd[y + q, wide], odd[y - q, wide], fold_o[q])
        sum_e[:] = 0.0
        sum_o[:] = 0.0
        begin = start - shift + coarse.ox
        sum_e[margin : m - margin] = coarse_w[j + coarse.oy, begin : begin + stop - start]
        add_patch_columns(fold_e, fold_o, table, (margin, m - margin), sum_e, sum_o)
        for a in range(margin, m - margin):
            sum_o[a] += (
                C1 * (sum_e[a] + sum_e[a + 1])
                + C3 * (sum_e[a - 1] + sum_e[a + 2])
                + C5 * (sum_e[a - 2] + sum_e[a + 3])
            )
        target = w[y, 2 * start + parity :]
        for a in range(stop - start):
            target[2 * a] = sum_e[a + margin]
            target[2 * a + 1] = sum_o[a + margin]


@njit(cache=True, fastmath={"contract", "reassoc"})
def direct(matrix: Array, u: Array, box: Box, w: Array) -> None:
    """Sum by definition on the coarsest grid, nodes numbered row by row."""
    nx = box.i1 - box.i0 + 1
    n = matrix.shape[0]
    flat = np.empty(n)
    for k in range(n):
        flat[k] = u[box.j0 + box.oy + k // nx, box.i0 + box.ox + k % nx]
    for m in range(n):
        total = 0.0
        row = matrix[m]
        for k in range(n):
            total += row[k] * flat[k]
        w[box.j0 + box.oy + m // nx, box.i0 + box.ox + m % nx] = total


@njit(cache=True)
def unload(w: Array, box: Box, out: Array) -> None:
    """Copy the sums at the nodes of the grid into ``out`` (ny, nx)."""
    ny, nx = out.shape
    out[:, :] = w[box.oy : box.oy + ny, box.ox : box.ox + nx]
