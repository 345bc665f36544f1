"""Newton step for pressure and rigid motions together, on the coarsest grid.

The Reynolds equation of `tehl.kernels.reynolds` is linearised, each conductance and density
depending on all pressures through the film, and the balances of the load (Venner and Lubrecht 2000,
chapter 6: the coarsest grid is solved with it) and of its moment, where that is stated. The system
is dense. Nodes are numbered row by row; ``influence[m, k]`` is the film at node m per unit pressure
at node k. The neighbours of a node are kept in the order here, east, west, north, south, and two
nodes upstream along x and y.
"""

from math import sqrt
from typing import NamedTuple

from tehl.base.typing import Array, FlagArray, IntArray
from tehl.kernels.compiled import helper, kernel
from tehl.kernels.faces import CLOSED, STEADILY, WRAPPED, Stencil, both, opening_power
from tehl.kernels.raw import raw
from tehl.kernels.reynolds import flux_weights, inner_end

# part of a change of the pressure that asperities take by the film it moves
NEGLIGIBLE_COARSE_PART = 1e-6
HERE, EAST, WEST, NORTH, SOUTH, FAR, ASIDE = range(7)
SLOTS = 7
"""Neighbours of a node, itself included."""


class Conductance(NamedTuple):
    """Conductance ``eps`` of the nodes, and its derivatives by pressure and film.

    Along x and y all three are ``stretch_x`` and ``stretch_y`` times as large.
    """

    eps: Array
    eps_p: Array
    eps_h: Array
    stretch_x: Array
    stretch_y: Array


class Lines(NamedTuple):
    """Speed and drift of surfaces that spin, oil that enters, and weights of the lines beside.

    As of `Film`.
    """

    speed: Array
    drift: Array
    layer: Array
    south: Array
    north: Array


class Coarse(NamedTuple):
    """State of the coarsest grid, in flat fields (ny nx,).

    With asperities ``rho`` is d(rho h)/dH, ``stiffness`` -dp_a/dH, and ``asperity`` their
    pressure; without these have no elements.
    """

    p: Array
    h: Array
    rho: Array
    drho: Array
    partial: FlagArray
    second: FlagArray
    stiffness: Array
    asperity: Array
    conductance: Conductance
    lines: Lines


class CoarseSystem(NamedTuple):
    """The equations to solve.

    ``residual`` (ny, nx) of the Reynolds equation, ``influence`` (n, n), ``frozen`` (ny, nx) of 0
    and 1, ``area`` (ny, nx) that each node stands for, ``lift`` (motions, n), the film by each
    rigid motion, what is ``missing`` of the load and its moment, (motions,), and the largest change
    of the film by rigid motions with asperities.
    """

    residual: Array
    influence: Array
    frozen: FlagArray
    area: Array
    lift: Array
    missing: Array
    nearest: float
    yielding: float


class Work(NamedTuple):
    """Scratch: matrix, right-hand side, numbers of the free nodes, and data of one node.

    ``dry`` marks nodes where asperities alone carry.
    """

    matrix: Array
    rhs: Array
    free: IntArray
    full: Array
    near: IntArray
    by_p: Array
    by_h: Array
    dry: FlagArray


@helper
def _solved_end(ny: int, mirror: int) -> int:
    """Return the row before which the unknowns end: one that wraps is the first one again."""
    return ny - 1 if mirror >= WRAPPED else inner_end(ny, mirror)


@helper
def _find_free(state: Coarse, system: CoarseSystem, mirror: int, nx: int, free: IntArray) -> int:
    """List the nodes with p > 0 or residual < 0 that are not frozen; return their count."""
    count = 0
    for j in range(0 if mirror else 1, _solved_end(state.p.shape[0] // nx, mirror)):
        for here in range(j * nx + 1, j * nx + nx - 1):
            wet = state.p[here] != 0.0 or system.residual[here] < 0.0
            if wet and not system.frozen[here]:
                free[count] = here
                count += 1
    return count


@helper
def _find_carrying(state: Coarse, system: CoarseSystem, shape: tuple[int, int], work: Work) -> int:
    """List the nodes where oil or asperities change; mark those where asperities alone do.

    Return their count. ``shape``: mirror, and nodes of a row.
    """
    count, (mirror, nx) = 0, shape
    for j in range(0 if mirror else 1, _solved_end(state.p.shape[0] // nx, mirror)):
        for here in range(j * nx + 1, j * nx + nx - 1):
            wet = state.p[here] != 0.0 or system.residual[here] < 0.0
            work.dry[here] = not wet or system.frozen[here] > 0
            carried = state.stiffness[here] * system.influence[here, here]
            if not work.dry[here] or carried > NEGLIGIBLE_COARSE_PART:
                work.free[count] = here
                count += 1
    return count


@helper
def _soften(state: Coarse, work: Work) -> None:
    """Add that the oil loses the pressure which asperities take."""
    for n in range(SLOTS):
        work.by_h[n] += work.by_p[n] * state.stiffness[work.near[n]]


@helper
def _touch(state: Coarse, system: CoarseSystem, work: Work) -> None:
    """Add that asperities carry; where they alone change, the row is that of no change of oil."""
    by_p, by_h, here = work.by_p, work.by_h, work.near[HERE]
    if work.dry[here]:
        for n in range(SLOTS):
            by_p[n] = 0.0
            by_h[n] = 0.0
        by_p[HERE] = 1.0
        system.residual[here] = 0.0
    _soften(state, work)


@helper
def _find_neighbours(here: int, nx: int, rows: tuple[int, int], near: IntArray) -> None:
    """Fill the numbers of a node and its neighbours; one row is its own neighbour.

    ``rows``: the number of nodes, and ``mirror``. Where the film wraps, rows are a ring.
    """
    nodes, mirror = rows
    near[HERE], near[EAST], near[WEST] = here, here + 1, here - 1
    near[NORTH] = here + nx if here + nx < nodes else max(here - nx, here % nx)
    near[SOUTH] = here - nx if here >= nx else near[NORTH]
    if mirror >= WRAPPED:
        near[NORTH] = (here + nx) % (nodes - nx)
        near[SOUTH] = (here + nodes - 2 * nx) % (nodes - nx)
    near[FAR] = max(here - 2, here // nx * nx)
    near[ASIDE] = here


@helper
def _clear_slopes(work: Work) -> None:
    """Set the derivatives by pressure and film to zero."""
    for n in range(SLOTS):
        work.by_p[n] = 0.0
        work.by_h[n] = 0.0


@helper
def _add_face(state: Coarse, stencil: Stencil, work: Work, n: int) -> None:
    """Add the derivatives of the pressure flow from neighbour ``n``."""
    near, by_p, by_h = work.near, work.by_p, work.by_h
    here, there, along = near[HERE], near[n], n <= WEST
    faces, lines = state.conductance, state.lines
    c = 0.5 * (stencil.cx if along else stencil.cy)
    if lines.south.shape[0] > 0 and not along:
        c *= lines.north[here] if n == NORTH else lines.south[here]
    mine = c * (faces.stretch_x[here] if along else faces.stretch_y[here])
    theirs = c * (faces.stretch_x[there] if along else faces.stretch_y[there])
    face, drop = mine * faces.eps[here] + theirs * faces.eps[there], state.p[there] - state.p[here]
    if not along and stencil.arithmetic < 1.0:
        ours, others = mine * faces.eps[here], theirs * faces.eps[there]
        ratio = sqrt(others / ours)
        opening = opening_power(stencil, state.h[here], state.h[there])
        face = both(stencil, ours, others, opening)
        if stencil.mirror >= CLOSED and min(state.h[here], state.h[there]) > 0.0:
            opens = 1.5 * stencil.arithmetic * (opening * ours - others / opening)
            by_h[HERE] -= drop * opens / state.h[here]
            by_h[n] += drop * opens / state.h[there]
        mine *= ratio + stencil.arithmetic * (opening - ratio)
        theirs *= 1.0 / ratio + stencil.arithmetic * (1.0 / opening - 1.0 / ratio)
    by_p[HERE] += drop * mine * faces.eps_p[here] - face
    by_h[HERE] += drop * mine * faces.eps_h[here]
    by_p[n] += face + drop * theirs * faces.eps_p[there]
    by_h[n] += drop * theirs * faces.eps_h[there]


@helper
def _slopes(state: Coarse, stencil: Stencil, work: Work) -> None:
    """Fill the derivatives of L at node ``near[0]`` by pressure and film of its neighbours."""
    near, by_p, by_h = work.near, work.by_p, work.by_h
    _clear_slopes(work)
    here, curved = near[HERE], state.lines.speed.shape[0] > 0
    upstream = (
        EAST if curved and state.lines.speed[here // state.lines.drift.shape[1]] < 0.0 else WEST
    )
    for n in range(EAST, FAR):
        there = near[n]
        if (
            stencil.conserves == STEADILY
            and n == upstream
            and state.partial[there]
            and not state.partial[here]
        ):
            continue
        _add_face(state, stencil, work, n)
    if curved:
        _add_curved(state, stencil, work)
        return
    first, far, west = near[FAR] == near[WEST], near[FAR], near[WEST]
    w0 = stencil.w0 - stencil.w2 if first else stencil.w0
    w1 = stencil.w1 + 2.0 * stencil.w2 if first else stencil.w1
    w2 = 0.0 if first else stencil.w2
    if stencil.conserves == STEADILY:
        partial = state.partial[here] > 0, state.partial[west] > 0, state.partial[far] > 0
        orders = state.second[here] > 0, state.second[west] > 0
        w0, w1, w2 = flux_weights(stencil, partial, orders, 1 if first else 2)
    for n, w in ((HERE, w0), (WEST, w1), (FAR, w2)):
        there = near[n]
        by_p[n] -= w * state.drho[there] * state.h[there]
        by_h[n] -= w * state.rho[there]


@helper
def _add_curved(state: Coarse, stencil: Stencil, work: Work) -> None:
    """Subtract the derivatives of the wedge where the surfaces spin, of second order at most."""
    near, (ny, nx) = work.near, state.lines.drift.shape
    here = near[HERE]
    j, i = here // nx, here % nx
    u, v = state.lines.speed[j], state.lines.drift[j, i]
    along, across = -1 if u > 0.0 else 1, -1 if v > 0.0 else 1
    near[FAR] = here + 2 * along if 0 <= i + 2 * along < nx else here
    near[ASIDE] = here + 2 * across * nx if 0 <= j + 2 * across < ny else here
    _subtract_wedge(state, stencil, work, (abs(u), WEST if u > 0.0 else EAST, FAR))
    if 0 <= j + across < ny:
        _subtract_wedge(state, stencil, work, (abs(v), SOUTH if v > 0.0 else NORTH, ASIDE))
    elif stencil.conserves == STEADILY:
        _subtract_excess(state, stencil, work, (abs(v), NORTH if v > 0.0 else SOUTH, j))


@helper
def _subtract_excess(
    state: Coarse, stencil: Stencil, work: Work, way: tuple[float, int, int]
) -> None:
    """Subtract the derivatives of what an end line passes on beyond the layer that enters there.

    ``way``: speed, slot of the node downstream, and row.
    """
    (size, ahead, j), rate = way, stencil.w0 - stencil.w2
    here, after = work.near[HERE], work.near[ahead]
    part = 0.5 if stencil.w2 > 0.0 and state.second[after] and not state.partial[after] else 0.0
    mass = (1.0 - part) * state.rho[here] * state.h[here]
    mass += part * state.rho[after] * state.h[after]
    if mass <= state.lines.layer[j]:
        return
    for n, w in ((HERE, 1.0 - part), (ahead, part)):
        there = work.near[n]
        work.by_p[n] -= size * rate * w * state.drho[there] * state.h[there]
        work.by_h[n] -= size * rate * w * state.rho[there]


@helper
def _subtract_wedge(
    state: Coarse, stencil: Stencil, work: Work, way: tuple[float, int, int]
) -> None:
    """Subtract the derivatives of a wedge; ``way``: speed, slots of two nodes upstream."""
    near, (size, next_slot, far_slot) = work.near, way
    first = near[far_slot] == near[HERE]
    w0 = stencil.w0 - stencil.w2 if first else stencil.w0
    w1 = stencil.w1 + 2.0 * stencil.w2 if first else stencil.w1
    w2 = 0.0 if first else stencil.w2
    if stencil.conserves == STEADILY:
        partial = (
            state.partial[near[HERE]] > 0,
            state.partial[near[next_slot]] > 0,
            state.partial[near[far_slot]] > 0,
        )
        second = state.second[near[HERE]] > 0 and not (partial[1] or partial[2])
        before = state.second[near[next_slot]] > 0 and not (partial[2] or first)
        w0, w1, w2 = flux_weights(stencil, partial, (second, before), 1 if first else 2)
    for n, w in ((HERE, w0), (next_slot, w1), (far_slot, w2)):
        there = near[n]
        work.by_p[n] -= size * w * state.drho[there] * state.h[there]
        work.by_h[n] -= size * w * state.rho[there]


@helper
def _add_slopes(system: CoarseSystem, work: Work, row: int, count: int) -> None:
    """Add the derivatives at node ``near[0]`` to a row of the matrix, of all nodes in ``full``."""
    full, near, by_p, by_h = work.full, work.near, work.by_p, work.by_h
    for n in range(SLOTS):
        if by_h[n] != 0.0:  # dry asperities move with their own film only
            for m in range(full.shape[0]):
                full[m] += by_h[n] * system.influence[near[n], m]
    for n in range(SLOTS):
        full[near[n]] += by_p[n]
        for m in range(system.lift.shape[0]):
            work.matrix[row, count + m] += by_h[n] * system.lift[m, near[n]]


@helper
def _add_upstream(
    state: Coarse, stencil: Stencil, system: CoarseSystem, work: Work, place: tuple[int, int, int]
) -> None:
    """Add the pressure flow into the partly filled cells upstream of a node to its row.

    They pass on what flows in from the films beside them. Without it a step would lose that oil.
    ``place``: row, number of free nodes, nodes per row of the grid.
    """
    row, count, nx = place
    here = work.free[row] - 1
    while here % nx > 0 and state.partial[here]:
        _find_neighbours(here, nx, (state.p.shape[0], stencil.mirror), work.near)
        _clear_slopes(work)
        _add_face(state, stencil, work, NORTH)
        _add_face(state, stencil, work, SOUTH)
        if state.stiffness.shape[0] > 0:
            _soften(state, work)
        _add_slopes(system, work, row, count)
        here -= 1


@helper
def _assemble(
    state: Coarse, stencil: Stencil, system: CoarseSystem, work: Work, sizes: tuple[int, int]
) -> None:
    """Fill matrix and right-hand side: a row per free node.

    ``sizes``: how many nodes are free, and how many nodes a row of the grid has.
    """
    (count, nx), motions = sizes, system.lift.shape[0]
    for row in range(count):
        here = work.free[row]
        for m in range(work.full.shape[0]):
            work.full[m] = 0.0
        for m in range(motions):
            work.matrix[row, count + m] = 0.0
        _find_neighbours(here, nx, (state.p.shape[0], stencil.mirror), work.near)
        _slopes(state, stencil, work)
        if state.stiffness.shape[0] > 0:
            _touch(state, system, work)
        _add_slopes(system, work, row, count)
        passes = stencil.conserves == STEADILY and state.lines.speed.shape[0] == 0
        if passes and not work.dry[here]:
            _add_upstream(state, stencil, system, work, (row, count, nx))
        for column in range(count):
            work.matrix[row, column] = work.full[work.free[column]]
        work.rhs[row] = system.residual[here]


@helper
def _add_balances(system: CoarseSystem, work: Work, count: int) -> None:
    """Fill the last rows of matrix and right-hand side: load, and moment if it is stated."""
    motions = system.lift.shape[0]
    for m in range(motions):
        for column in range(count):
            here = work.free[column]
            work.matrix[count + m, column] = system.area[here] * system.lift[m, here]
        for n in range(motions):
            work.matrix[count + m, count + n] = 0.0
        work.rhs[count + m] = system.missing[m]
    work.matrix[count, count] = -system.yielding


@kernel
def fill_step(state: Coarse, stencil: Stencil, system: CoarseSystem, work: Work, nx: int) -> int:
    """Fill the system of a step; return the number of free nodes.

    Parameters
    ----------
    state, stencil, system, work : Coarse, Stencil, CoarseSystem, Work
        Pressure and film with the derivatives of the conductance, weights of the differences,
        residual, influence and load, and scratch; on flat fields.
    nx : int
        Nodes per row.
    """
    state, system, work = raw((state, system, work))
    count = _find_free(state, system, stencil.mirror, nx, work.free)
    if state.stiffness.shape[0] > 0:
        count = _find_carrying(state, system, (stencil.mirror, nx), work)
    _assemble(state, stencil, system, work, (count, nx))
    _add_balances(system, work, count)
    return count


@kernel
def take_step(state: Coarse, system: CoarseSystem, work: Work, count: int, longest: float) -> float:
    """Take a solved step; return the part of it that is taken.

    Parameters
    ----------
    state, system, work : Coarse, CoarseSystem, Work
        As of `fill_step`; the right-hand side is the step.
    count, longest : int, float
        Free nodes, and largest change of a pressure [-].
    """
    state, system, work = raw((state, system, work))
    touches, most = state.stiffness.shape[0] > 0, 0.0
    for row in range(count):
        most = max(most, abs(work.rhs[row]))
    scale = min(1.0, longest / max(most, 1e-300))
    if touches:  # a film that comes nearer than the asperities are high changes everything
        moved = 0.0
        for m in range(system.lift.shape[0]):
            moved += abs(work.rhs[count + m])
        scale = min(scale, system.nearest / max(moved, 1e-300))
    for row in range(count):
        here = work.free[row]
        if touches and work.dry[here]:
            state.asperity[here] += scale * work.rhs[row]
            continue
        state.p[here] = max(state.p[here] + scale * work.rhs[row], 0.0)
    return scale
