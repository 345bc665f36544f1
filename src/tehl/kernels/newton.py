"""Compiled Newton step for pressure and rigid approach together, on the coarsest grid.

Dense in the film: every conductance and density depends on every pressure. The nodes are numbered
row by row; ``influence[m, k]`` is the film at node m per unit pressure at node k.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from tehl.typing import Array


class Coarse(NamedTuple):
    """State of the coarsest grid: fields (ny, nx) and the derivatives of the conductance."""

    p: Array
    h: Array
    eps: Array
    rho: Array
    drho: Array
    eps_p: Array
    eps_h: Array


@njit(cache=True)
def solve_dense(a: Array, b: Array) -> bool:
    """Solve ``a x = b`` in place by elimination with row pivoting; ``b`` becomes x."""
    n = b.shape[0]
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(a[i, k]) > abs(a[pivot, k]):
                pivot = i
        if not abs(a[pivot, k]) > 0.0:
            return False
        if pivot != k:
            for c in range(k, n):
                a[k, c], a[pivot, c] = a[pivot, c], a[k, c]
            b[k], b[pivot] = b[pivot], b[k]
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, n):
            factor = a[i, k] * inverse
            if factor != 0.0:
                for c in range(k + 1, n):
                    a[i, c] -= factor * a[k, c]
                b[i] -= factor * b[k]
    for k in range(n - 1, -1, -1):
        total = b[k]
        for c in range(k + 1, n):
            total -= a[k, c] * b[c]
        b[k] = total / a[k, k]
    return True


@njit(cache=True)
def newton_step(
    state: Coarse,
    stencil: tuple[float, float, float, float, float, int],
    residual: Array,
    influence: Array,
    load: tuple[float, float],
    frozen: Array,
) -> float:
    """Take one limited Newton step on ``p`` in place; return the change of H00.

    ``stencil`` is (cx, cy, w0, w1, w2, mirror); ``load`` is (cell area, missing load); nodes with
    p = 0 and residual >= 0, and ``frozen`` ones, stay as they are.
    """
    cx, cy, w0, w1, w2, mirror = stencil
    ny, nx = state.p.shape
    size = ny * nx
    number = np.full(size, -1, np.int64)
    active = np.empty(size, np.int64)
    count = 0
    for j in range(0 if mirror else 1, ny - 1):
        for i in range(1, nx - 1):
            if (state.p[j, i] > 0.0 or residual[j, i] < 0.0) and not frozen[j, i]:
                number[j * nx + i] = count
                active[count] = j * nx + i
                count += 1
    a = np.zeros((count + 1, count + 1))
    b = np.zeros(count + 1)
    q = np.empty(6, np.int64)
    by_p, by_h = np.empty(6), np.empty(6)
    p, eps = state.p, state.eps
    for row in range(count):
        j, i = active[row] // nx, active[row] % nx
        south = j - 1 if j > 0 else 1
        q[0] = j * nx + i
        q[1], q[2] = q[0] + 1, q[0] - 1
        q[3], q[4], q[5] = q[0] + nx, south * nx + i, j * nx + max(i - 2, 0)
        by_p[:] = 0.0
        by_h[:] = 0.0
        total = 0.0
        for n in range(1, 5):
            jn, in_ = q[n] // nx, q[n] % nx
            c = cx if n < 3 else cy
            face = 0.5 * c * (eps[j, i] + eps[jn, in_])
            drop = 0.5 * c * (p[jn, in_] - p[j, i])
            by_p[0] -= face
            by_p[n] += face + drop * state.eps_p[jn, in_]
            by_h[n] += drop * state.eps_h[jn, in_]
            total += drop
        by_p[0] += total * state.eps_p[j, i]
        by_h[0] += total * state.eps_h[j, i]
        weights = (w0, w1, w2) if i > 1 else (w0 - w2, w2 - w0, 0.0)
        for n, w in ((0, weights[0]), (2, weights[1]), (5, weights[2])):
            jn, in_ = q[n] // nx, q[n] % nx
            by_p[n] -= w * state.drho[jn, in_] * state.h[jn, in_]
            by_h[n] -= w * state.rho[jn, in_]
        for n in range(6):
            if number[q[n]] >= 0:
                a[row, number[q[n]]] += by_p[n]
            if by_h[n] != 0.0:
                for column in range(count):
                    a[row, column] += by_h[n] * influence[q[n], active[column]]
                a[row, count] += by_h[n]
        b[row] = residual[j, i]
    for column in range(count):
        a[count, column] = load[0] * (2.0 if mirror and active[column] >= nx else 1.0)
    b[count] = load[1]
    if not solve_dense(a, b):
        return 0.0
    largest = 0.0
    for column in range(count):
        largest = max(largest, abs(b[column]))
    if not largest < 1e300:
        return 0.0
    scale = min(1.0, 0.3 / max(largest, 1e-300))
    for column in range(count):
        j, i = active[column] // nx, active[column] % nx
        p[j, i] = max(p[j, i] + scale * b[column], 0.0)
    return scale * b[count]
