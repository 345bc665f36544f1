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
    for j in range(ny):
        for i in range(nx):
            u[j + box.oy, i + box.ox] = p[j, i]
    reflect(u, box)


@njit(cache=True)
def reflect(u: Array, box: Box) -> None:
    """Fill the rows before a mirror line with the image of those behind it."""
    if box.mirror:
        for j in range(1, box.oy + 1):
            u[box.oy - j, :] = u[box.oy + j, :]


@njit(cache=True)
def gather_rows(u: Array, fine: Box, coarse_u: Array, coarse: Box) -> None:
    """Send sources to even rows: the transpose of interpolation."""
    x0, x1 = fine.i0 + fine.ox, fine.i1 + fine.ox + 1
    shift = coarse.ox - fine.ox
    for j in range(coarse.j0, coarse.j1 + 1):
        f = 2 * j + fine.oy
        target = coarse_u[j + coarse.oy]
        for x in range(x0, x1):
            target[x + shift] = (
                u[f, x]
                + C1 * (u[f - 1, x] + u[f + 1, x])
                + C3 * (u[f - 3, x] + u[f + 3, x])
                + C5 * (u[f - 5, x] + u[f + 5, x])
            )
    reflect(coarse_u, coarse)


@njit(cache=True)
def add_patch_rows(u: Array, table: Array, f: int, first: int, step: int, out: Array) -> None:
    """Add the patch of sources around row ``f`` of ``u`` to ``out``, element for element."""
    reach, side = table.shape[0] - 1, table.shape[1] - 1
    n = u.shape[1]
    fold = np.empty(n)
    for d in range(first, reach + 1, step):
        above, below = u[f + d], u[f - d]
        if d == 0:
            for x in range(n):
                fold[x] = above[x]
        else:
            for x in range(n):
                fold[x] = above[x] + below[x]
        e0, e1, e2 = table[d, 0], table[d, 1], table[d, 2]
        for x in range(side, n - side):
            out[x] += (
                e0 * fold[x] + e1 * (fold[x - 1] + fold[x + 1]) + e2 * (fold[x - 2] + fold[x + 2])
            )
        for q in range(3, side + 1):
            e = table[d, q]
            for x in range(side, n - side):
                out[x] += e * (fold[x - q] + fold[x + q])


@njit(cache=True)
def spread_rows(u: Array, table: Array, fine: Box, coarse_w: Array, coarse: Box, w: Array) -> None:
    """Correct the sums on even rows, interpolate the odd rows and correct them.

    ``coarse_w`` and ``w`` have the shapes of the padded source arrays of their grids.
    """
    for j in range(coarse.j0, coarse.j1 + 1):
        add_patch_rows(u, table, 2 * j + fine.oy, 1, 2, coarse_w[j + coarse.oy])
    for j in range(fine.j0, fine.j1 + 1):
        target = w[j + fine.oy]
        if j % 2 == 0:
            target[:] = coarse_w[j // 2 + coarse.oy]
            continue
        low = (j - 1) // 2
        a, b, c = low, low - 1, low - 2
        if coarse.mirror:
            a, b, c = abs(a), abs(b), abs(c)
        near_a, near_b = coarse_w[a + coarse.oy], coarse_w[low + 1 + coarse.oy]
        mid_a, mid_b = coarse_w[b + coarse.oy], coarse_w[low + 2 + coarse.oy]
        far_a, far_b = coarse_w[c + coarse.oy], coarse_w[low + 3 + coarse.oy]
        for x in range(target.shape[0]):
            target[x] = (
                C1 * (near_a[x] + near_b[x])
                + C3 * (mid_a[x] + mid_b[x])
                + C5 * (far_a[x] + far_b[x])
            )
        add_patch_rows(u, table, j + fine.oy, 0, 1, target)


@njit(cache=True)
def split_columns(u: Array, box: Box, even: Array, odd: Array) -> None:
    """De-interleave: ``even[:, a]`` holds node 2a, ``odd[:, a]`` node 2a+1, both at a + ox/2."""
    n = even.shape[1]
    parity = box.ox % 2
    for y in range(u.shape[0]):
        for a in range(n - 1):
            even[y, a] = u[y, 2 * a + parity]
            odd[y, a] = u[y, 2 * a + 1 + parity]


@njit(cache=True)
def gather_columns(even: Array, odd: Array, fine: Box, coarse_u: Array, coarse: Box) -> None:
    """Send sources to even columns: the transpose of interpolation."""
    shift = fine.ox // 2
    for j in range(coarse.j0, coarse.j1 + 1):
        y = j + fine.oy
        target = coarse_u[j + coarse.oy]
        for i in range(coarse.i0, coarse.i1 + 1):
            a = i + shift
            target[i + coarse.ox] = (
                even[y, a]
                + C1 * (odd[y, a] + odd[y, a - 1])
                + C3 * (odd[y, a + 1] + odd[y, a - 2])
                + C5 * (odd[y, a + 2] + odd[y, a - 3])
            )
    reflect(coarse_u, coarse)


@njit(cache=True)
def add_even(table_row: Array, odd: Array, n0: int, n1: int, out: Array) -> None:
    """Add the patch of odd sources to even outputs ``out[n0:n1]`` for one folded row."""
    reach = table_row.shape[0] - 1
    for d in range(1, reach + 1, 2):
        e, s = table_row[d], (d + 1) // 2
        for a in range(n0, n1):
            out[a] += e * (odd[a + s - 1] + odd[a - s])


@njit(cache=True)
def add_odd(table_row: Array, even: Array, odd: Array, n0: int, n1: int, out: Array) -> None:
    """Add the patch of all sources to odd outputs ``out[n0:n1]`` for one folded row."""
    reach = table_row.shape[0] - 1
    e = table_row[0]
    for a in range(n0, n1):
        out[a] += e * odd[a]
    for d in range(1, reach + 1):
        e, s = table_row[d], d // 2
        if d % 2:
            for a in range(n0, n1):
                out[a] += e * (even[a + s + 1] + even[a - s])
        else:
            for a in range(n0, n1):
                out[a] += e * (odd[a + s] + odd[a - s])


@njit(cache=True)
def spread_columns(
    even: Array, odd: Array, table: Array, fine: Box, coarse_w: Array, coarse: Box, w: Array
) -> None:
    """Correct the sums on even columns, interpolate the odd ones, correct and interleave them."""
    n = even.shape[1]
    side = table.shape[1] - 1
    reach = table.shape[0] - 1
    fold_e, fold_o = np.empty(n), np.empty(n)
    sum_e, sum_o = np.empty(n), np.empty(n)
    margin = reach // 2 + 2
    shift = fine.ox // 2 - coarse.ox
    parity = fine.ox % 2
    for j in range(fine.j0, fine.j1 + 1):
        y = j + fine.oy
        sum_e[:] = 0.0
        sum_o[:] = 0.0
        row = coarse_w[j + coarse.oy]
        for i in range(coarse.i0, coarse.i1 + 1):
            sum_e[i + coarse.ox + shift] = row[i + coarse.ox]
        for q in range(side + 1):
            if q == 0:
                fold_e[:] = even[y]
                fold_o[:] = odd[y]
            else:
                for a in range(n):
                    fold_e[a] = even[y + q, a] + even[y - q, a]
                    fold_o[a] = odd[y + q, a] + odd[y - q, a]
            add_even(table[:, q], fold_o, margin, n - margin, sum_e)
            add_odd(table[:, q], fold_e, fold_o, margin, n - margin, sum_o)
        for a in range(margin, n - margin):
            sum_o[a] += (
                C1 * (sum_e[a] + sum_e[a + 1])
                + C3 * (sum_e[a - 1] + sum_e[a + 2])
                + C5 * (sum_e[a - 2] + sum_e[a + 3])
            )
        target = w[y]
        for a in range(margin, n - margin):
            target[2 * a + parity] = sum_e[a]
            target[2 * a + 1 + parity] = sum_o[a]


@njit(cache=True)
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
    for j in range(ny):
        for i in range(nx):
            out[j, i] = w[j + box.oy, i + box.ox]
