"""The iteration on one grid of a steady contact: cycles or Newton steps, heights, heat, its end."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import count

import numpy as np

from tehl.base.typing import Array
from tehl.operators.heights import Heights
from tehl.result.bars import ErrorEstimate
from tehl.result.solution import CycleReport
from tehl.solver.cycle.continuation import Roughness, TouchingError
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.ladder import Strategy
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.methods import Cycles, Visit, method_of
from tehl.solver.cycle.start import pose_problem
from tehl.solver.judging.balance import LARGEST_OIL_ERROR, Balance
from tehl.solver.judging.convergence import (
    SECOND_LOAD,
    SECOND_RATE,
    Criteria,
    GridTrace,
    TimeIsOverError,
    check_divergence,
    converged,
    film_converged,
    must_stop,
    recedes,
    stalled,
    temperature_converged,
)
from tehl.solver.judging.extrapolation import outputs_of
from tehl.solver.judging.film_errors import estimated_errors
from tehl.solver.judging.goal import Goal
from tehl.solver.judging.measures import film_extremes, film_numbers, measured
from tehl.solver.monitor import Monitor
from tehl.solver.physics.thermal import Coupling

FREE_ORDERS = 4
"""Cycles after which nodes keep the order with which they pass on oil: else it may change with the
meniscus, and the meniscus with it."""
EXTRAPOLATED_PART = 0.15
"""Iteration error accepted on grids that are extrapolated, over that accepted on others."""
COMPARED_GRIDS = 3
"""Grids whose values make error bars."""


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
            chain=hierarchy.chain,
        )
        self.roughness = Roughness(hierarchy.levels, heights, strategy.continuation)
        self.traces: list[GridTrace] = []  # of each grid, coarsest first
        self.from_hertz = False  # the present grid started from the Hertz pressure
        self.known_errors: tuple[ErrorEstimate | None] | None = None  # where coarser grids are free
        self.balance = Balance(
            self.options,
            exactly=strategy.newton,
            is_coupled=hierarchy.scaled.problem.is_coupled,
        )

    @property
    def finest(self) -> Level:
        """The level of the result."""
        return self.hierarchy.finest

    def _iterate(self, levels: Sequence[Level]) -> None:
        """Iterate on the last of ``levels`` until it has converged, stalled or used its cycles."""
        fine, finest = levels[-1], len(levels) == len(self.levels)
        pose_problem(fine)
        fine.update()
        self.traces.append(GridTrace(columns=fine.grid.nx))  # also if it diverges before the heat
        done = self._start_heat(levels)
        self.goal.begin_cycles()  # no finer grid starts its heat from nothing
        method = method_of(self._visit(levels))
        is_slow = self.coupling.state is not None or self.hierarchy.scaled.groups.M > SECOND_LOAD
        criteria = Criteria(
            largest_change=method.largest_change,
            damping=self.coupling.damping,
            rate=self.strategy.relaxation.rate,
            second_rate=SECOND_RATE if is_slow else 0.0,
            negligible=self._negligible(),
            steady=method.steady,
            part=EXTRAPOLATED_PART if self.options.extrapolate else 1.0,
        )
        trace = GridTrace(criteria, coupled=self.coupling.state is not None, columns=fine.grid.nx)
        self.traces[-1] = trace
        begins = len(levels) - 1 == self.roughness.first  # the first level with the heights
        done += self._raise_heights(levels, method) if begins else 0
        trace.note(*film_extremes(fine))
        for number in range(1, self._most_steps(levels, method) + 1):
            method.begin()
            self._add(trace, self._iteration(levels, method.step, number + done), method)
            if self._is_done(trace, finest=finest):
                return
            method.combine()

    def _add(self, trace: GridTrace, report: CycleReport, method: Cycles) -> None:
        trace.add(report, method.touching_share(), rests=self.coupling.rest == "now")

    def _visit(self, levels: Sequence[Level]) -> Visit:
        return Visit(
            hierarchy=self.hierarchy,
            levels=levels,
            strategy=self.strategy,
            roughness=self.roughness,
            damping=self.coupling.damping,
            is_damped=self.coupling.is_damped,
        )

    def _most_steps(self, levels: Sequence[Level], method: Cycles) -> int:
        """Return the most cycles, or steps of Newton's method, on the last of ``levels``."""
        finer = len(self.levels) - len(levels)
        if not finer:
            return self.strategy.patience * self.options.max_cycles
        return method.most(self.coupling.doublings(finer))

    def _measure(self, levels: Sequence[Level]) -> None:
        """Record further values of the last of ``levels``."""
        scaled, state = self.hierarchy.scaled, self.coupling.state
        self.traces[-1].measured = measured(levels[-1], scaled, state)
        if self.options.extrapolate or levels[-1].grid.crowding:
            self.traces[-1].measured |= film_numbers(levels[-1])
        if not self.options.extrapolate:
            return
        self.traces[-1].outputs = outputs_of(levels[-1], scaled, state)
        for trace in self.traces[:-2]:  # two grids are combined
            trace.outputs = None

    def _finish(self, levels: Sequence[Level]) -> None:
        """Make the last of ``levels`` the finest, and iterate until it has converged or stalled."""
        del self.levels[len(levels) :]
        trace, method = self.traces[-1], method_of(self._visit(levels))
        trace.outputs = None  # of the film before
        while not self._is_done(trace, finest=True):
            number = len(trace.reports) + 1
            if number > self.options.max_cycles:
                return
            self._add(trace, self._iteration(levels, method.step, number), method)

    def _go_further(self, levels: Sequence[Level]) -> None:
        """Perform another cycle on the last of ``levels``, which has converged."""
        trace, method = self.traces[-1], method_of(self._visit(levels))
        number = len(trace.reports) + 1
        self._add(trace, self._iteration(levels, method.step, number), method)
        self._measure(levels)

    def _is_done(self, trace: GridTrace, *, finest: bool) -> bool:
        """Return whether the iteration on a grid has converged or stalled."""
        coarser = self._coarser_trace()
        fails = stalled(trace, self.strategy.patience)
        fails = fails or (finest and self.strategy.gives_up and recedes(trace))
        if not self.balance.is_settled:
            return fails
        if not finest:
            done = film_converged(trace, coarser) and temperature_converged(trace, coarser)
            return done or stalled(trace, self.coupling.patience)
        self._accept(trace, self.goal.most_spare)
        if not (fails or must_stop(trace, coarser, self.options)):
            return False  # nor would it with what is left, whose estimate costs a tenth of a cycle
        self._accept(trace, self.goal.spare(self.errors()))
        done = self.balance.is_kept and must_stop(trace, coarser, self.options)
        if fails and not done and self.balance.is_kept:
            doubtful = trace.doubted()
            if converged(doubtful, coarser, self.options):  # the film rests, single nodes do not
                self.traces[-1] = doubtful
        done = done and not self.awaits_oil()
        return done or fails

    def _accept(self, trace: GridTrace, spare: float) -> None:
        """Let the iteration error of the finest grid be what the goal leaves, or is negligible."""
        negligible = max(self._negligible(), self.roughness.spare(spare))
        trace.criteria = replace(trace.criteria, negligible=negligible)

    def awaits_oil(self) -> bool:
        """Return whether the error to reach is exceeded by that of the oil balance alone."""
        oil = self.balance.oil_error
        found = self.errors() if oil > LARGEST_OIL_ERROR else None
        if found is None:
            return False
        without = replace(found, supply=found.supply - oil)
        return self.goal.is_met(without) and not self.goal.is_met(found)

    def _negligible(self) -> float:
        return self.goal.negligible * self.finest.cavity.oscillates

    def errors(self) -> ErrorEstimate | None:
        """Return estimated errors of the film on the last grid; None before its first cycle."""
        if self.known_errors is not None:
            return self.known_errors[0]
        level = self.levels[len(self.traces) - 1]
        found = estimated_errors(level, self.traces, self.roughness, self.hierarchy)
        if found is None or self.balance.oil_error <= LARGEST_OIL_ERROR:
            return found
        # each section should pass the same oil, and the film is in proportion to what passes
        return replace(found, supply=found.supply + self.balance.oil_error)

    def _start_heat(self, levels: Sequence[Level]) -> int:
        """Start heat and shear thinning on the last of ``levels``, if it resolves them.

        Isothermal cycles come first where the film is not in balance: it would flow and heat far
        too much. Return their number.
        """
        cycles = self.coupling.cycles_before(from_hertz=self.from_hertz)
        for number in range(1, cycles + 1):
            self._iteration(levels, partial(self.hierarchy.cycle, levels), number)
        finer = len(self.levels) - len(levels)
        full = self.goal.is_open or finer < COMPARED_GRIDS
        early = self._heats_early(finer)
        if self.coupling.begin(levels, finest=not finer, full=full, early=early):
            self._relax_heated(levels)
        return cycles

    def _heats_early(self, finer: int) -> bool:
        """Return whether a grid before ``finer`` ones may be heated with half as many lines.

        So may the last one before the finest: an isothermal film is not comparable with a heated
        one, and their difference is not an error.
        """
        return self.strategy.early or finer == 1

    def _relax_heated(self, levels: Sequence[Level]) -> None:
        """Relax ``levels`` as heated or thinned films need it."""
        for level in (*levels, *self.hierarchy.between.values()):
            level.set_relaxation(self.strategy.relaxation)

    def _coarser_trace(self) -> GridTrace | None:
        """Return the trace of the next coarser grid; None if its film is not comparable."""
        number = len(self.traces) - 1
        # the coarsest grid is too coarse to compare; a film without the heights is another one
        if number < 2 or number == self.roughness.first_comparable or self.traces[-2].diverged:
            return None
        return self.traces[-2]

    def _raise_heights(self, levels: Sequence[Level], method: Cycles) -> int:
        """Raise the heights on the first level that has them; return the number of iterations."""
        fine, numbers = levels[-1], count(1)

        def iterate(step: Callable[[], object]) -> float:
            return self._iteration(levels, step, next(numbers)).residual

        try:
            method.raise_heights(iterate)
        except TouchingError:  # its film is the result
            self.traces[-1].add(self._report(fine, fine.pressure.copy(), 0, (0.0, 0.0)))
            raise
        fine.apply_heights(1.0)
        fine.update()
        return next(numbers) - 1

    def _iteration(
        self, levels: Sequence[Level], step: Callable[[], object], number: int
    ) -> CycleReport:
        """Perform one cycle or Newton step on the last of ``levels``, update heat, and report.

        Raises TimeIsOverError in place of a cycle after the time of the goal.
        """
        if self.goal.is_over:
            raise TimeIsOverError
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
        central, minimum = film_extremes(level)
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
        check_divergence(report, self.hierarchy.expected_film, self.roughness.largest_step)
        return report
