"""The iteration on one grid of a steady contact: cycles or Newton steps, heights, heat, its end."""

from collections.abc import Callable, Sequence
from functools import partial
from itertools import count

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.operators.heights import Heights
from tehl.result.solution import CycleReport
from tehl.solver.cycle.anderson import Anderson
from tehl.solver.cycle.continuation import (
    MOST_NEWTON_STEPS,
    SMOOTH_CYCLES,
    Roughness,
    TouchingError,
    raise_by_newton,
)
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.ladder import Strategy
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.linearised import set_unknowns, unknowns
from tehl.solver.cycle.newton import Newton
from tehl.solver.cycle.start import pose_problem
from tehl.solver.judging.balance import Balance
from tehl.solver.judging.convergence import (
    LARGEST_CYCLE_CHANGE,
    LARGEST_ROUGH_CHANGE,
    SLOW_CYCLES,
    GridTrace,
    check_divergence,
    film_converged,
    must_stop,
    stalled,
    temperature_converged,
)
from tehl.solver.judging.extrapolation import outputs_of
from tehl.solver.judging.goal import Goal
from tehl.solver.judging.measures import film_numbers, measured, nodal_film
from tehl.solver.monitor import Monitor
from tehl.solver.physics.boundary_contact import (
    BALANCED_OVER_TOLERANCE,
    BALANCED_RESIDUAL,
    TouchingNewton,
    raise_heights,
)
from tehl.solver.physics.boundary_cycle import TouchingCycle
from tehl.solver.physics.thermal import Coupling

MOST_CYCLES = 4
"""Most cycles on a grid that only provides the start for the next finer one."""
MOST_DOUBLINGS = 4
"""Most doublings of `MOST_CYCLES`, one per coarser grid, where temperatures converge slowly."""
MOST_TOUCHING = 30
"""The same where surfaces may touch, also in Newton steps: the nodes that do change for some."""
MOST_COMBINED = 20
"""The same where cycles are combined between asperities finer than the grid: it takes some."""
HERTZ_CYCLES = 2
"""Cycles after which a grid that started from the Hertz pressure has a film."""
MOST_FRONT_CYCLES = 24
"""The same where a meniscus must be found: on coarse grids that costs little."""
OSCILLATES = 4.0
"""Factor on the iteration error of the film that is always accepted where single nodes of a
meniscus oscillate, as it follows these nodes."""
STEADY = 1e-3
"""Mean change of the pressure that ends the cycles on a grid where surfaces may touch and that has
no comparable coarser grid."""
FREE_ORDERS = 4
"""Cycles after which nodes keep the order with which they pass on oil: else it may change with the
meniscus, and the meniscus with it."""
EXTRAPOLATED_PART = 0.15
"""Iteration error accepted on grids that are extrapolated, over that accepted on others."""
COMPARED_GRIDS = 3
"""Grids whose values make error bars."""
ISOTHERMAL_CYCLES = 4
"""Cycles before damped heat begins."""
FIRST_ORDER = 64
"""Nodes along x below which grids of surfaces that may touch have a wedge of first order: they only
provide the start, and thin films have no solution of second order there."""
COARSE_NODES, COARSE_TOUCHING = 33, 17
"""Least nodes along x of the coarse grid in the preconditioner of Newton's method, and where
surfaces may touch: dense equations of more take longer than the iterations they save."""
DAMPED_MEMORY = 3
"""Most earlier cycles combined if heat and thinning are damped: older ones had another flow."""


class GridIteration:
    """The iteration on the last of some levels, with what it has in common on all grids.

    Parameters
    ----------
    hierarchy, strategy : Hierarchy, Strategy
        The levels; method and settings.
    heights : Heights or None
        Heights of the surfaces on the finest grid; None for smooth surfaces.
    goal, monitor : Goal, Monitor
        The error to reach; receives the report of each cycle.
    """

    def __init__(
        self,
        hierarchy: Hierarchy,
        strategy: Strategy,
        heights: Heights | None,
        goal: Goal,
        monitor: Monitor,
    ) -> None:
        self.hierarchy, self.strategy, self.options = hierarchy, strategy, hierarchy.options
        self.levels, self.goal, self.monitor = hierarchy.levels, goal, monitor
        self.coupling = Coupling(
            hierarchy.scaled,
            self.options,
            slide_in_steps=strategy.slide_in_steps,
            damping=strategy.damping,
        )
        self.roughness = Roughness(hierarchy.levels, heights, strategy.continuation)
        self.traces: list[GridTrace] = []  # of each grid, coarsest first
        self.from_hertz = False  # the present grid started from the Hertz pressure
        self.balance = Balance(hierarchy.options, exactly=strategy.newton)

    @property
    def finest(self) -> Level:
        """The level of the result."""
        return self.hierarchy.finest

    def _iterate(self, levels: Sequence[Level]) -> None:
        """Iterate on the last of ``levels`` until it has converged, stalled or used its cycles."""
        fine, finest = levels[-1], len(levels) == len(self.levels)
        pose_problem(fine)
        fine.update()
        done = self._start_heat(levels)
        by_cycles = fine.equations.contact_film is not None and not self.strategy.newton
        is_rough = self.roughness.is_on(levels) and not by_cycles  # a node that parts changes more
        trace = GridTrace(
            largest_change=LARGEST_ROUGH_CHANGE if is_rough else LARGEST_CYCLE_CHANGE,
            damping=self.coupling.damping,
            negligible=self.goal.negligible * (OSCILLATES if fine.stencil.conserves else 1.0),
            steady=STEADY if by_cycles else 0.0,
            part=EXTRAPOLATED_PART if self.options.extrapolate else 1.0,
        )
        self.traces.append(trace)
        newton, anderson = self._newton(levels), self._anderson(levels)
        step = newton.step if newton else self._cycle(levels)
        begins = len(levels) - 1 == self.roughness.first  # the first level with the heights
        done += self._raise_heights(levels, newton) if begins else 0
        trace.note(*nodal_film(fine))
        most = self._most_steps(levels, newton, anderson)
        for number in range(1, most + 1):
            before = unknowns(fine) if anderson else None
            report = self._iteration(levels, step, number + done)
            trace.add(report)
            if self._is_done(trace, finest=finest):
                return
            if anderson is not None and before is not None:
                combined = anderson.combine(before, unknowns(fine))
                if fine.equations.asperities is None:
                    # a combination must not wet the nodes that the last cycle cavitated
                    combined[:-1][fine.film.p.ravel() <= 0.0] = 0.0
                set_unknowns(fine, combined)

    def _most_steps(
        self, levels: Sequence[Level], newton: Newton | None, anderson: Anderson | None
    ) -> int:
        """Return the most cycles, or steps of Newton's method, on the last of ``levels``."""
        equations, finer = levels[-1].equations, len(self.levels) - len(levels)
        if not finer:
            return self.strategy.patience * self.options.max_cycles
        if newton:
            return MOST_TOUCHING if isinstance(newton, TouchingNewton) else MOST_NEWTON_STEPS
        most = MOST_CYCLES
        if equations.contact_film is not None and not self._is_smoother_than_stated(levels):
            return MOST_TOUCHING
        if self.coupling.state is not None:
            # smooth parts of the temperature may converge slowly: on coarse grids that costs little
            damped = self.coupling.damping < 1.0
            most <<= MOST_DOUBLINGS if damped else min(finer, MOST_DOUBLINGS)
        if equations.stencil.conserves:
            most = max(most, MOST_FRONT_CYCLES)
        return MOST_COMBINED if anderson and not self.roughness.is_on(levels) else most

    def _measure(self, levels: Sequence[Level]) -> None:
        """Record further values of the last of ``levels``."""
        scaled, state = self.hierarchy.scaled, self.coupling.state
        self.traces[-1].measured = measured(levels[-1], scaled, state)
        if not self.options.extrapolate:
            return
        self.traces[-1].measured |= film_numbers(levels[-1])
        self.traces[-1].outputs = outputs_of(levels[-1], scaled, state)
        for trace in self.traces[:-2]:  # two grids are combined
            trace.outputs = None

    def _finish(self, levels: Sequence[Level]) -> None:
        """Make the last of ``levels`` the finest, and iterate until it has converged or stalled."""
        del self.levels[len(levels) :]
        trace = self.traces[-1]
        while not self._is_done(trace, finest=True):
            number = len(trace.reports) + 1
            if number > self.options.max_cycles:
                return
            trace.add(self._iteration(levels, partial(self.hierarchy.cycle, levels), number))

    def _is_done(self, trace: GridTrace, *, finest: bool) -> bool:
        """Return whether the iteration on a grid has converged or stalled."""
        coarser = self._coarser_trace()
        if finest and self.goal.is_over and len(trace.reports) >= SLOW_CYCLES:
            return True
        if not self.balance.is_settled:
            return stalled(trace, self.strategy.patience)
        if not finest:
            done = film_converged(trace, coarser)
            if self.coupling.state is None or len(trace.reports) < MOST_CYCLES:
                return done and temperature_converged(trace, coarser)
            return (done and temperature_converged(trace, coarser)) or stalled(trace, 2)
        done = self.balance.is_kept and must_stop(trace, coarser, self.options)
        return done or stalled(trace, self.strategy.patience)

    def _start_heat(self, levels: Sequence[Level]) -> int:
        """Start heat and shear thinning on the last of ``levels``, if it resolves them.

        Isothermal cycles come first where the film is not in balance: it would flow and heat far
        too much. Return their number.
        """
        cycles = 0
        if self.coupling.is_pending and self.strategy.damping < 1.0:
            cycles = ISOTHERMAL_CYCLES
        elif self.coupling.is_pending and self.from_hertz:
            cycles = HERTZ_CYCLES
        for number in range(1, cycles + 1):
            self._iteration(levels, partial(self.hierarchy.cycle, levels), number)
        finer = len(self.levels) - len(levels)
        full = self.goal.is_open or finer < COMPARED_GRIDS
        if self.coupling.begin(levels, finest=not finer, full=full):
            for level in levels:
                level.set_relaxation(self.strategy.relaxation)
        return cycles

    def _coarser_trace(self) -> GridTrace | None:
        """Return the trace of the next coarser grid; None if its film is not comparable."""
        number = len(self.traces) - 1
        # the coarsest grid is too coarse to compare; a film without the heights is another one
        if number < 2 or number == self.roughness.first_comparable or self.traces[-2].diverged:
            return None
        return self.traces[-2]

    def _newton(self, levels: Sequence[Level]) -> Newton | None:
        """Return Newton's method if the strategy has it and the last of ``levels`` has heights.

        Surfaces that may touch need it on smooth grids too.
        """
        touches = levels[-1].equations.contact_film is not None
        if not (self.strategy.newton and (touches or self.roughness.is_on(levels))):
            return None
        if not touches:
            return Newton(levels[-1], coarse_grid(levels, COARSE_NODES))
        is_last = len(levels) == len(self.levels)
        is_start = levels[-1].grid.nx < FIRST_ORDER and not is_last
        return TouchingNewton(
            levels[-1],
            coarse_grid(levels, COARSE_TOUCHING),
            order=1 if is_start else 2,
            closing=(self._balanced_below or BALANCED_RESIDUAL) if is_last else 0.0,
        )

    @property
    def _balanced_below(self) -> float:
        """Residual below which a tight solve balances the oil; zero at other accuracies."""
        conserves = self.finest.stencil.conserves  # the flux through sections is its criterion
        exactly = self.options.accuracy == "tight" and not conserves
        return BALANCED_OVER_TOLERANCE * self.options.tolerance if exactly else 0.0

    def _cycle(self, levels: Sequence[Level]) -> Callable[[], None]:
        """Return the cycle on ``levels``, with contact if the heights of the last one may touch."""
        fine, cycle = levels[-1], partial(self.hierarchy.cycle, levels)
        if fine.equations.contact_film is None:
            return cycle
        fine.share.stays = self._is_smoother_than_stated(levels)
        if fine.share.stays:
            return cycle
        is_last = len(levels) == len(self.levels)
        return TouchingCycle(levels, cycle, self._balanced_below if is_last else 0.0).step

    def _is_smoother_than_stated(self, levels: Sequence[Level]) -> bool:
        """Return whether the last of ``levels`` does not resolve the heights: nothing touches."""
        return self.roughness.is_rough and not self.roughness.is_on(levels)

    def _anderson(self, levels: Sequence[Level]) -> Anderson | None:
        """Return the acceleration of the cycles if the last of ``levels`` has asperities."""
        memory = self.strategy.memory
        if self.coupling.damping < 1.0:
            memory = min(memory, DAMPED_MEMORY)
        equations = levels[-1].equations
        touches = equations.asperities is not None and not equations.stencil.conserves
        return Anderson(memory) if memory and (touches or self.roughness.is_on(levels)) else None

    def _raise_heights(self, levels: Sequence[Level], newton: Newton | None) -> int:
        """Raise the heights on the first level that has them; return the number of iterations."""
        fine, numbers, cycle = levels[-1], count(1), self._cycle(levels)

        def iterate(step: Callable[[], object]) -> float:
            return self._iteration(levels, step, next(numbers)).residual

        # the smooth film is the start of the continuation, and of a restart on a finer grid
        fine.apply_heights(0.0)
        if isinstance(newton, TouchingNewton):
            raise_heights(fine, newton, lambda: iterate(newton.step))
            return next(numbers) - 1
        for _ in range(SMOOTH_CYCLES):
            iterate(cycle)
        self.roughness.smooth = (len(levels) - 1, *fine.state())
        if newton is None:
            ramp = self.strategy.continuation.ramp
            for part in range(1, ramp):
                fine.apply_heights(part / ramp)
                iterate(cycle)
        else:
            try:
                solve_part = partial(iterate, newton.step)
                raise_by_newton(fine, solve_part, newton.refresh, finest=fine is self.finest)
            except TouchingError:  # its film is the result
                self.traces[-1].add(self._report(fine, fine.pressure.copy(), 0, (0.0, 0.0)))
                raise
        fine.apply_heights(1.0)
        fine.update()
        return next(numbers) - 1

    def _iteration(
        self, levels: Sequence[Level], step: Callable[[], object], number: int
    ) -> CycleReport:
        """Perform one cycle or Newton step on the last of ``levels``, update heat, and report."""
        fine = levels[-1]
        fine.cavity.keeps_orders = number > FREE_ORDERS
        before = fine.pressure.copy()
        if number == 1:
            fine.cavity.settle(fine)
        step()
        rests = fine.cavity.settle(fine)
        fine.update()
        heating = self.coupling.update(levels)
        report = self._report(fine, before, number, heating)
        self.balance.note(
            fine,
            report,
            finest=fine is self.finest,
            rests=rests,
            may_oscillate=self.goal.is_open,
        )
        self.monitor.cycle(report)
        return report

    def _report(
        self, level: Level, before: Array, number: int, heating: tuple[float, float]
    ) -> CycleReport:
        residual = level.evaluate_residual()
        np.subtract(level.pressure, before, out=before)
        central, minimum = nodal_film(level)
        report = CycleReport(
            points=level.grid.points,
            cycle=number,
            residual=residual,
            change=float(max(before.max(), -before.min())),
            load_error=level.load_error(),
            film_central=central,
            film_minimum=minimum,
            smoother=self.strategy.name,
            temperature_change=heating[0],
            temperature_rise=heating[1],
            mean_change=float(np.abs(before).sum() / (level.pressure.sum() or 1.0)),
        )
        check_divergence(report, self.hierarchy.expected_film, rough=self.roughness.is_rough)
        return report


def coarse_grid(levels: Sequence[Level], nodes: int) -> Grid:
    """Return the coarsest grid with enough nodes along x, else the finest one.

    Parameters
    ----------
    levels : sequence of Level
        The coarsest first.
    nodes : int
        Least number along x.
    """
    return next((one.grid for one in levels if one.grid.nx >= nodes), levels[-1].grid)
