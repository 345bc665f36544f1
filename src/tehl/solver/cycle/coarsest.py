"""The solver of the coarsest level: Newton's method for pressure and rigid motions together."""

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dgetrf, dgetrs

from tehl.base.typing import Array, IntArray
from tehl.kernels.coarsest import (
    SLOTS,
    Coarse,
    CoarseSystem,
    Conductance,
    Work,
    fill_step,
    take_step,
)
from tehl.operators.influence import matrix_of
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.linearised import linearised, residual_of
from tehl.solver.cycle.newton import one_thread

MOST_CARRIED, MOST_HALVINGS = 1.5, 8
"""Pressure of the asperities beyond which a Newton step is halved, over that of Hertz, which they
exceed by little even when dry; and most times."""
LONGEST_STEP = 0.3
"""Largest change of pressure in a Newton step, in Hertz pressures."""
CONTRACTION, SMALL_REPEATED, MOST_REPEATED = 0.5, 0.15, 4
"""Steps with the matrix of an earlier state: over the one before, above which that is too far away,
over the first one, below which they have converged, and most after the first."""
LEAST_KEPT_NODES = 1000
"""Nodes from which a time step may use the matrix of an earlier one: on 65 x 33 nodes of a roller
it takes 0.15 s, half of a step on 257 x 129 nodes; on 17 x 17 nodes of a circle 1 ms."""
PACKED = ("p", "h", "rho", "drho", "partial", "second")
"""Fields of the state of a linearised system that a snapshot has, beside its conductance."""


class Factored(NamedTuple):
    """A linearised system: its state and nodes, how many are free, LU factors and pivots.

    ``packed`` is the state at that time; the fields of ``state`` follow the level.
    """

    state: Coarse
    work: Work
    size: int
    factors: Array
    pivots: IntArray
    packed: Array


class CoarsestSolver:
    """Newton's method for pressure and rigid motions together on the coarsest level.

    The equations are L(P, H00 + K P + g) = f at the wet nodes and sum(P) dx dy = w, with the dense
    matrix K and the derivatives of the conductance by pressure and film. The rigid approach moves
    all pressures at once, so no local relaxation finds it; here it costs one more unknown. So does
    a tilt that follows from the moment of the load.
    """

    def __init__(self, level: Level) -> None:
        self.level = level
        equations = level.equations
        grid = equations.grid
        self.influence = matrix_of(grid, equations.influence)
        self.widths = grid.widths
        if grid.wraps:  # its last line is not an unknown: the first one has all of its width
            self.widths = np.append(2.0 * self.widths[:1], [*self.widths[1:-1], 0.0])
        self.area = np.repeat(self.widths * grid.dx, grid.nx)
        self.modes = np.repeat(equations.balances.modes, grid.nx, axis=1)
        self.last: Factored | None = None

    def step(self) -> None:
        """Perform a Newton step in place, or some with an earlier matrix if these converge.

        The state changes little from cycle to cycle, and the matrix takes ten times as long as the
        rest (simplified Newton method: Deuflhard 2011, section 2.1).
        """
        before = self.level.state()
        if self.last is not None and self._is_wet_as(self.last) and self._converges(self.last):
            return
        self.level.set_state(*before)
        self.newton_step()

    def _is_wet_as(self, known: Factored) -> bool:
        """Whether no node that has oil now has a row of asperities alone: its error would stay."""
        if not self.level.share.moves_together(self.level):
            return True
        free, film = known.work.free[: known.size], self.level.film
        alone = free[known.work.dry[free] > 0]
        wet = (film.p != 0.0) & (self.level.smoother.frozen == 0)
        return not wet.ravel()[alone].any()

    def _converges(self, known: Factored) -> bool:
        """Take steps with the matrix of an earlier state; return whether they converge."""
        first = before = self._take(known)
        for _ in range(MOST_REPEATED):
            last = self._take(known)
            if last < SMALL_REPEATED * first:
                return True
            if not last < CONTRACTION * before:
                return False
            before = last
        return False

    def newton_step(self) -> float:
        """Perform a Newton step of limited length in place; return the largest change."""
        level = self.level
        level.update()
        self.last = self._factored(linearised(level), self._system())
        return self._take(self.last)

    @property
    def keeps_matrix(self) -> bool:
        """Whether a time step may use the matrix of an earlier one.

        Where asperities or a boundary film may carry load, that depends on more than a snapshot
        has.
        """
        return self.level.film.p.size >= LEAST_KEPT_NODES and not self.level.film.asperity.size

    def begin_step(self) -> None:
        """Forget the matrix of an earlier time step if this one may not use it."""
        if not self.keeps_matrix:
            self.last = None

    def pack(self) -> Array:
        """Return the state of the matrix that later steps may use, as `_packed`; zero without."""
        if self.last is None or not self.keeps_matrix:
            return np.zeros((len(PACKED) + len(Conductance._fields) + 2, self.level.film.p.size))
        return self.last.packed

    def unpack(self, packed: Array) -> None:
        """Make the matrix of a state that `pack` returned again, bit by bit.

        Parameters
        ----------
        packed : (fields, n) array
            Of a level with the same grid and the same weights of the time step.
        """
        self.last, (*values, yielding, free) = None, packed
        if not free.any():
            return
        known, count = linearised(self.level), len(PACKED)
        fields = {}
        for name, one in zip(PACKED, values[:count], strict=True):
            own = getattr(known, name)
            fields[name] = one[: own.size].astype(own.dtype)
        state = known._replace(**fields, conductance=Conductance(*values[count:]))
        system = self._system()._replace(
            residual=np.full(free.size, -1.0),
            frozen=(free == 0.0).astype(np.uint8),
            yielding=float(yielding[0]),
        )
        self.last = self._factored(state, system)

    def _system(self) -> CoarseSystem:
        level = self.level
        laws, answer = level.equations.solids.asperities, level.share.response
        return CoarseSystem(
            residual=residual_of(level).ravel(),
            influence=self.influence,
            frozen=level.smoother.frozen.ravel(),
            area=self.area,
            lift=self.modes if answer is None else self.modes * answer.lift.ravel(),
            missing=level.missing(),
            yielding=(0.0 if answer is None else answer.stiffness) - level.outside_slope,
            nearest=np.inf if laws is None else laws.sigma + 0.5 * float(level.film.h.min()),
        )

    def _factored(self, state: Coarse, system: CoarseSystem) -> Factored:
        """Return the linearised system of a state."""
        level = self.level
        nodes, nx = level.film.p.size, level.film.p.shape[1]
        unknowns = nodes + level.rigid.size
        work = Work(
            matrix=np.empty((unknowns, unknowns)),
            rhs=np.empty(unknowns),
            free=np.empty(nodes, np.int64),
            full=np.empty(nodes),
            near=np.empty(SLOTS, np.int64),
            by_p=np.empty(SLOTS),
            by_h=np.empty(SLOTS),
            dry=np.zeros(nodes, np.uint8),
        )
        system = system._replace(influence=level.share.yielding(self.influence))
        count = fill_step(state, level.equations.robust, system, work, nx)
        with one_thread():
            # a row is a column of LAPACK
            used = count + level.rigid.size
            factors, pivots, _ = dgetrf(work.matrix[:used, :used].T)
        work = work._replace(matrix=np.empty((0, 0)))
        return Factored(
            state, work, count, factors, pivots, _packed(state, system, work.free[:count])
        )

    def _take(self, known: Factored) -> float:
        """Take a step of limited length by a linearised system; return the largest change.

        Of the pressures [-], and of rigid motions over the largest, where that is above one.
        """
        level, film = self.level, self.level.film
        level.update()
        system, work, free = self._system(), known.work, known.work.free[: known.size]
        before, rigid = level.pressure.copy(), level.rigid.copy()
        carried = film.p.copy(), film.asperity.copy()
        used = known.size + rigid.size
        work.rhs[: known.size] = np.where(work.dry[free], 0.0, system.residual[free])
        work.rhs[known.size : used] = system.missing
        step, _ = dgetrs(known.factors, known.pivots, work.rhs[:used], trans=1)
        work.rhs[:used] = step
        state = known.state._replace(p=film.p.ravel(), asperity=film.asperity.ravel())
        part = take_step(state, system, work, known.size, LONGEST_STEP)
        if level.grid.wraps:
            film.p[-1] = film.p[0]
            if film.asperity.size:
                film.asperity[-1] = film.asperity[0]
        change = part * work.rhs[known.size : used]
        level.move(change)
        if level.equations.solids.asperities is not None:
            self._shorten(carried, change)
        moved = np.abs(level.rigid - rigid).max() / max(1.0, np.abs(level.rigid).max())
        largest = max(float(np.abs(level.pressure - before).max()), float(moved))
        if not level.share.moves_together(level):
            return largest
        level.update()  # a small change of both may be a large one of the oil between asperities
        passed = level.equations.balances.integral(np.abs(film.p - carried[0]))
        return max(largest, passed / level.sources.load)

    def _shorten(self, before: tuple[Array, Array], change: Array) -> None:
        """Halve a step until the asperities, steep as they are, carry no more than is likely."""
        level, film = self.level, self.level.film
        after = film.p.copy(), film.asperity.copy()
        largest = max(MOST_CARRIED, 2.0 * before[1].max())
        for _ in range(MOST_HALVINGS):
            level.update()
            if film.asperity.max() <= largest:
                return
            change = 0.5 * change
            level.move(-change)
            for one, old, new in zip((film.p, film.asperity), before, after, strict=True):
                new[:] = 0.5 * (old + new)
                one[:] = new


def _packed(state: Coarse, system: CoarseSystem, free: IntArray) -> Array:
    """Return the fields of a state that `fill_step` reads, (fields, n).

    Without cavities some have no elements, and zeros here. The last but one is the yielding of the
    load everywhere, the last 1 at ``free``.
    """
    values = (*(getattr(state, name) for name in PACKED), *state.conductance)
    packed = np.zeros((len(values) + 2, state.p.size))
    for row, one in zip(packed, values, strict=False):
        row[: one.size] = one
    packed[-2] = system.yielding
    packed[-1, free] = 1.0
    return packed
