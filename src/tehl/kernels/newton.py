"""Compiled Newton step for pressure and rigid approach together, on the coarsest grid.

Dense in the film: every conductance and density depends on every pressure. The nodes are numbered
row by row; ``influence[m, k]`` is the film at node m per unit pressure at node k. The neighbours of
a node are kept in the order here, east, west, north, south, far west.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from tehl.kernels.reynolds import Mesh
from tehl.typing import Array, FlagArray, IntArray

HERE, EAST, WEST, NORTH, SOUTH, FAR = range(6)


class Coarse(NamedTuple):
    """State of the coarsest grid: fields (ny, nx) and the derivatives of the conductance.

    Along x and y the conductance and its derivatives are ``stretch_x`` and ``stretch_y`` times as
    large.
    """

    p: Array
    h: Array
    eps: Array
    rho: Array
    drho: Array
    eps_p: Array
    eps_h: Array
    stretch_x: Array
    stretch_y: Array


class System(NamedTuple):
    """What the step solves besides the state.

    ``residual`` (ny, nx) of the Reynolds equation, ``influence`` (n, n), ``frozen`` (ny, nx) of 0
    and 1, ``area`` of a cell and the load that is missing.
    """

    residual: Array
    influence: Array
    frozen: FlagArray
    area: float
    missing_load: float


@njit(cache=True)
def pivot_row(a: Array, b: Array, k: int) -> None:
    """Swap row ``k`` with the row below that has the largest entry in column ``k``."""
    n = b.shape[0]
    pivot = k
    for i in range(k + 1, n):
        if abs(a[i, k]) > abs(a[pivot, k]):
            pivot = i
    for c in range(k, n):
        a[k, c], a[pivot, c] = a[pivot, c], a[k, c]
    b[k], b[pivot] = b[pivot], b[k]


@njit(cache=True)
def solve_dense(a: Array, b: Array) -> None:
    """Solve ``a x = b`` in place by elimination with row pivoting; ``b`` becomes x.

    A singular matrix gives values that are not finite.
    """
    n = b.shape[0]
    for k in range(n):
        pivot_row(a, b, k)
        upper = a[k, k + 1 :]
        for i in range(k + 1, n):
            factor = a[i, k] / a[k, k] if a[k, k] != 0.0 else np.nan
            row = a[i, k + 1 :]
            for c in range(upper.shape[0]):
                row[c] -= factor * upper[c]
            b[i] -= factor * b[k]
    for k in range(n - 1, -1, -1):
        b[k] /= a[k, k] if a[k, k] != 0.0 else np.nan
        for i in range(k):
            b[i] -= a[i, k] * b[k]


@njit(cache=True)
def find_active(p: Array, system: System, mirror: int) -> IntArray:
    """Return the numbers of the nodes that may move: wet or ought to be, and not frozen."""
    ny, nx = p.shape
    active = np.empty(ny * nx, np.int64)
    count = 0
    for j in range(0 if mirror else 1, ny - 1):
        for i in range(1, nx - 1):
            wet = p[j, i] > 0.0 or system.residual[j, i] < 0.0
            if wet and not system.frozen[j, i]:
                active[count] = j * nx + i
                count += 1
    return active[:count]


@njit(cache=True)
def slopes(state: Coarse, mesh: Mesh, near: IntArray, by_p: Array, by_h: Array) -> None:
    """Fill the derivatives of L at node ``near[0]`` by pressure and film of its neighbours."""
    p, eps = state.p.ravel(), state.eps.ravel()
    eps_p, eps_h = state.eps_p.ravel(), state.eps_h.ravel()
    by_p[:] = 0.0
    by_h[:] = 0.0
    here, stretch_x, stretch_y = near[HERE], state.stretch_x.ravel(), state.stretch_y.ravel()
    for n in range(EAST, FAR):
        there, along = near[n], n <= WEST
        c = 0.5 * (mesh.cx if along else mesh.cy)
        mine = c * (stretch_x[here] if along else stretch_y[here])
        theirs = c * (stretch_x[there] if along else stretch_y[there])
        face, drop = mine * eps[here] + theirs * eps[there], p[there] - p[here]
        by_p[HERE] += drop * mine * eps_p[here] - face
        by_h[HERE] += drop * mine * eps_h[here]
        by_p[n] += face + drop * theirs * eps_p[there]
        by_h[n] += drop * theirs * eps_h[there]
    first = near[FAR] == near[WEST]
    w0 = mesh.w0 - mesh.w2 if first else mesh.w0
    w1 = mesh.w1 + 2.0 * mesh.w2 if first else mesh.w1
    w2 = 0.0 if first else mesh.w2
    rho, drho, h = state.rho.ravel(), state.drho.ravel(), state.h.ravel()
    for n, w in ((HERE, w0), (WEST, w1), (FAR, w2)):
        by_p[n] -= w * drho[near[n]] * h[near[n]]
        by_h[n] -= w * rho[near[n]]


@njit(cache=True)
def assemble(state: Coarse, mesh: Mesh, system: System, active: IntArray) -> tuple[Array, Array]:
    """Return matrix and right-hand side: a row per active node, the load balance as the last."""
    ny, nx = state.p.shape
    count = active.shape[0]
    a, b = np.zeros((count + 1, count + 1)), np.zeros(count + 1)
    near, by_p, by_h = np.empty(6, np.int64), np.empty(6), np.empty(6)
    full = np.empty(ny * nx)
    residual = system.residual.ravel()
    for row in range(count):
        here = active[row]
        south = here - nx if here >= nx else here + nx
        near[HERE], near[EAST], near[WEST] = here, here + 1, here - 1
        near[NORTH], near[SOUTH] = here + nx, south
        near[FAR] = max(here - 2, here // nx * nx)
        slopes(state, mesh, near, by_p, by_h)
        full[:] = 0.0
        for n in range(6):
            column = system.influence[near[n]]
            for m in range(full.shape[0]):
                full[m] += by_h[n] * column[m]
        for n in range(6):
            full[near[n]] += by_p[n]
        for column_number in range(count):
            a[row, column_number] = full[active[column_number]]
        a[row, count] = by_h.sum()
        b[row] = residual[here]
    for column_number in range(count):
        twice = mesh.mirror and active[column_number] >= nx
        a[count, column_number] = system.area * (2.0 if twice else 1.0)
    b[count] = system.missing_load
    return a, b


@njit(cache=True)
def newton_step(state: Coarse, mesh: Mesh, system: System, longest: float) -> float:
    """Take one Newton step on ``state.p`` in place; return the change of the rigid approach.

    The step is shortened so that no pressure moves by more than ``longest``; pressures are clipped
    at zero.
    """
    active = find_active(state.p, system, mesh.mirror)
    a, b = assemble(state, mesh, system, active)
    solve_dense(a, b)
    count = active.shape[0]
    largest = 0.0
    for row in range(count):
        largest = max(largest, abs(float(b[row])))
    scale = min(1.0, longest / max(largest, 1e-300))
    nx = state.p.shape[1]
    for row in range(count):
        j, i = active[row] // nx, active[row] % nx
        state.p[j, i] = max(state.p[j, i] + scale * b[row], 0.0)
    return scale * float(b[count])
