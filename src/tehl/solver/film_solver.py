"""The steady film of a contact by full multigrid.

`FilmSolver` fills in the steps of `tehl.solver.fmg.full_multigrid`: how a grid starts if the
coarser one has no acceptable solution, and how often the cycles are repeated on a grid.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from typing import Protocol

import numpy as np

from tehl.operators.heights import Heights
from tehl.options import Options
from tehl.result import CycleReport, ErrorEstimate, Result
from tehl.scaling import Groups
from tehl.solver.anderson import Anderson
from tehl.solver.continuation import (
    MOST_STEPS,
    RAISED,
    SMOOTH_CYCLES,
    Roughness,
    raise_by_cycles,
    raise_by_newton,
)
from tehl.solver.convergence import (
    LARGEST_CHANGE,
    LARGEST_ROUGH_CHANGE,
    GridTrace,
    converged,
    ended,
    error_estimate,
    iterated_enough,
    single_grid_estimate,
    stalled,
)
from tehl.solver.film_summary import central_value
from tehl.solver.fmg import full_multigrid
from tehl.solver.hierarchy import Hierarchy
from tehl.solver.ladder import Strategy
from tehl.solver.level import Level
from tehl.solver.monitor import SILENT, Monitor
from tehl.solver.newton import Newton
from tehl.solver.state import DivergedError, TouchingError, keep_cavities, state_of, take_state
from tehl.solver.thermal import Coupling
from tehl.solver.warm_start import start_from
from tehl.typing import Array

FIRST_STEPS = 6
"""Newton steps on the coarsest grid at the start; they may cycle there, which does no harm."""
MOST_CYCLES = 4
"""Cycles on a grid that only provides the start for the next finer one."""
HERTZ_CYCLES = 2
"""Cycles after which a grid that began with the Hertz pressure has a film."""
RUNAWAY = 100.0
"""Load error and central film from which no iteration recovers (H of a contact is below 2)."""
WILD = 10.0
"""Change of pressure per cycle from which no iteration between rough surfaces recovers."""
DISTANT = 33
"""Least nodes along x of the coarse grid in the preconditioner of Newton's method."""
DAMPED_MEMORY = 3
"""Most earlier cycles that are combined where heat and thinning act by parts."""


class Method(Protocol):
    """One step of it brings a level nearer to its solution."""

    def step(self) -> object:
        """Perform one iteration."""
        ...


@dataclass(frozen=True, slots=True)
class Cycles:
    """Multigrid cycles as a method for the finest of some levels."""

    hierarchy: Hierarchy
    levels: Sequence[Level]

    def step(self) -> None:
        """Perform one cycle."""
        self.hierarchy.cycle(self.levels)


class FilmSolver:
    """Full multigrid for the film of a contact.

    Parameters
    ----------
    hierarchy : Hierarchy
        The levels.
    strategy : Strategy
        Method and settings.
    coupling : Coupling or None
        Heat and shear thinning; None for an isothermal Newtonian film.
    heights : Heights or None
        Heights of the surfaces on the finest grid; None for smooth surfaces.
    monitor : Monitor
        Receives a report of each cycle.
    guess : Result or None
        The film of a similar contact.
    """

    def __init__(
        self,
        hierarchy: Hierarchy,
        strategy: Strategy,
        *,
        coupling: Coupling | None = None,
        heights: Heights | None = None,
        monitor: Monitor = SILENT,
        guess: Result | None = None,
    ) -> None:
        self.hierarchy, self.strategy = hierarchy, strategy
        self.coupling = coupling or Coupling()
        self.roughness = Roughness(hierarchy.levels, heights, strategy.continuation)
        self.monitor, self.guess = monitor, guess
        self.traces: list[GridTrace] = []
        self.accepted, self.from_hertz = True, False

    @property
    def levels(self) -> list[Level]:
        """The levels, coarsest first."""
        return self.hierarchy.levels

    @property
    def finest(self) -> Level:
        """The level of the result."""
        return self.hierarchy.finest

    @property
    def groups(self) -> Groups:
        """Dimensionless groups of the contact."""
        return self.hierarchy.scaled.groups

    @property
    def options(self) -> Options:
        """Numerical choices."""
        return self.hierarchy.options

    def solve(self, *, patient: bool) -> bool:
        """Run full multigrid; return whether the finest grid converged.

        Parameters
        ----------
        patient : bool
            Go on to the finest grid even if the one before has no acceptable solution.

        Raises
        ------
        DivergedError
            When the unknowns on the finest grid grow without bound or are not finite.
        """

        def improve(levels: Sequence[Level]) -> None:
            if levels[-1] is self.finest:
                if not (self.accepted or patient):
                    raise DivergedError
                self._solve_finest()
            else:
                self.accepted = self._approximate(levels)

        full_multigrid(self.levels, self._solve_coarsest, self._start, improve)
        return converged(self.traces[-1], self._coarser_trace(), self.options)

    # steps of full multigrid

    def _solve_coarsest(self) -> None:
        """Newton's method on the coarsest grid, from the Hertz pressure."""
        coarsest = self.levels[0]
        coarsest.start_from_hertz(self.hierarchy.expected_film)
        for _ in range(FIRST_STEPS):
            self.hierarchy.coarsest.step()
        coarsest.update()
        self.traces.append(GridTrace())
        self.traces[0].note(*nodal_film(coarsest))

    def _start(self, coarse: Level, fine: Level) -> None:
        """Interpolate the coarser solution; if there is none, start from the smooth or Hertz film.

        A grid that cannot resolve the film may have no acceptable discrete solution.
        """
        number, film = self.levels.index(fine), self.hierarchy.expected_film
        self.from_hertz = False
        if self.accepted:
            fine.interpolate_from(coarse)
        elif number > self.roughness.first:
            self.from_hertz = not self.roughness.restart(number, film)
        else:
            fine.start_from_hertz(film)
            self.from_hertz = True

    def _approximate(self, levels: Sequence[Level]) -> bool:
        """Iterate on a coarser grid; return whether its solution is a start for the next one."""
        try:
            self._iterate(levels)
        except DivergedError:
            accepted = False
        else:
            accepted = self._is_acceptable(self.traces[-1])
        if not accepted:  # leave nothing of this grid to the next one
            self.coupling.forget(levels)
            for level in levels:
                level.set_relaxation(self.strategy.first_relaxation)
        return accepted

    def _is_acceptable(self, trace: GridTrace) -> bool:
        """Return whether a grid that gives the next one its start was converging."""
        first, last = trace.reports[0], trace.reports[-1]
        falling = last.cycle < MOST_CYCLES or last.residual < self.options.tolerance
        if self.strategy.newton:  # the heights were raised before, so it begins near its end
            falling = falling or iterated_enough(trace, self._coarser_trace())
        falling = falling or last.residual < 0.5 * first.residual
        return falling and last.change < LARGEST_CHANGE and abs(last.load_error) < LARGEST_CHANGE

    def _solve_finest(self) -> None:
        """Iterate on the finest grid; if Newton's method fails there, raise the heights on it.

        Not if all heights of the grid before have no positive film: those of this grid take ten
        times as long as all before to end alike.
        """
        start_from(self.finest, self.guess)
        last, roughness = len(self.levels) - 1, self.roughness
        try:
            self._iterate(self.levels)
        except DivergedError:
            raised_before = self.strategy.newton and roughness.first < last
            if not raised_before or self.has_no_film_before:
                raise
            self.monitor.message("raising the heights on the finest grid")
            self.traces.pop()
            comparable = roughness.first_comparable
            self.from_hertz = not roughness.restart(last, self.hierarchy.expected_film)
            roughness.first_comparable = comparable  # the film of the coarser grid is a sound one
            self._iterate(self.levels)

    # iteration on one grid

    def _iterate(self, levels: Sequence[Level]) -> None:
        """Iterate with the last of ``levels`` as the finest, until it is good enough."""
        fine, finest = levels[-1], levels[-1] is self.finest
        fine.pose_problem()
        fine.update()
        self._couple(levels, has_film=not self.from_hertz)
        trace = self._new_trace(levels)
        method = self._method(levels)
        done = self._raise_heights(levels, method) if self.roughness.begins_on(levels) else 0
        trace.note(*nodal_film(fine))
        anderson, newton = self._anderson(levels), isinstance(method, Newton)
        patience = self.strategy.patience
        most = patience * self.options.max_cycles
        for number in range(1, 1 + (most if finest else MOST_STEPS if newton else MOST_CYCLES)):
            if number > HERTZ_CYCLES and self.from_hertz and not finest:
                self.from_hertz = False  # now there is a film to heat
                self._couple(levels, has_film=True)
            before = state_of(fine) if anderson else None
            report = self._iteration(levels, method, number + done)
            trace.add(report)
            coarser = self._coarser_trace()
            if finest and (ended(trace, coarser, self.options) or stalled(trace, patience)):
                return
            if not finest and iterated_enough(trace, coarser):
                return
            if anderson is not None and before is not None:
                combined = anderson.combine(before, state_of(fine))
                take_state(fine, keep_cavities(fine, combined))

    def _couple(self, levels: Sequence[Level], *, has_film: bool) -> None:
        """Start heat and shear thinning on the last of ``levels``, if they pay there."""
        finest = levels[-1] is self.finest
        if self.coupling.begin(levels, finest=finest, has_film=has_film):
            for level in levels:
                level.set_relaxation(self.strategy.relaxation)

    def _new_trace(self, levels: Sequence[Level]) -> GridTrace:
        trace = GridTrace()
        if self.roughness.is_on(levels):
            trace.largest_change = LARGEST_ROUGH_CHANGE
        trace.damp(self.coupling.follow)
        self.traces.append(trace)
        return trace

    def _coarser_trace(self) -> GridTrace | None:
        """Return the trace of the grid before; None if its film is not comparable."""
        number = len(self.traces) - 1
        if number < 2 or number == self.roughness.first_comparable:
            return None
        return self.traces[-2]

    def _method(self, levels: Sequence[Level]) -> Method:
        """Return cycles or, between rough surfaces if the strategy says so, Newton's method."""
        if not (self.strategy.newton and self.roughness.is_on(levels)):
            return Cycles(self.hierarchy, levels)
        coarse = next(level.grid for level in levels if level.grid.nx >= DISTANT)
        return Newton(levels[-1], coarse)

    def _anderson(self, levels: Sequence[Level]) -> Anderson | None:
        """Return the acceleration of the cycles on the last of ``levels``, if they need one."""
        memory = self.strategy.memory
        if self.coupling.follow < 1.0:  # another flow belongs to the older cycles
            memory = min(memory, DAMPED_MEMORY)
        return Anderson(memory) if memory and self.roughness.is_on(levels) else None

    def _raise_heights(self, levels: Sequence[Level], method: Method) -> int:
        """Introduce the heights on the first level that has them; return the iterations."""
        fine, numbers = levels[-1], count(1)

        def iterate(how: Method) -> float:
            return self._iteration(levels, how, next(numbers)).residual

        fine.apply_heights(0.0)
        for _ in range(SMOOTH_CYCLES):
            iterate(Cycles(self.hierarchy, levels))
        self.roughness.remember_smooth_film(levels)
        if isinstance(method, Newton):
            try:
                raise_by_newton(
                    fine,
                    lambda: iterate(method),
                    method.refresh,
                    finest=fine is self.finest,
                )
            except TouchingError:  # the film found is all that there is to report
                self.traces[-1].add(self._report(fine, fine.film.p.copy(), 0, (0.0, 0.0)))
                raise
        else:
            raise_by_cycles(fine, self.strategy.continuation.ramp, lambda: iterate(method))
        fine.apply_heights(1.0)
        fine.update()
        return next(numbers) - 1

    def _iteration(self, levels: Sequence[Level], method: Method, number: int) -> CycleReport:
        """Perform and report one iteration on the last of ``levels``."""
        fine = levels[-1]
        before = fine.film.p.copy()
        method.step()
        fine.update()
        heating = self.coupling.update(levels)
        report = self._report(fine, before, number, heating)
        self.monitor.cycle(report)
        return report

    def _report(
        self, level: Level, before: Array, number: int, heating: tuple[float, float]
    ) -> CycleReport:
        residual = level.evaluate_residual()
        np.subtract(level.film.p, before, out=before)
        central, minimum = nodal_film(level)
        report = CycleReport(
            points=(level.grid.nx, level.grid.ny),
            cycle=number,
            residual=residual,
            change=float(max(before.max(), -before.min())),
            load_error=level.load_error(),
            film_central=central,
            film_minimum=minimum,
            smoother=self.strategy.name,
            temperature_change=heating[0],
            temperature_rise=heating[1],
            mean_change=float(np.abs(before).sum() / (level.film.p.sum() or 1.0)),
        )
        if not (np.isfinite(residual) and abs(report.load_error) < RUNAWAY and central < RUNAWAY):
            raise DivergedError
        if self.roughness.is_rough and not report.change < WILD:
            raise DivergedError
        return report

    # what is known of the result

    def errors(self) -> ErrorEstimate | None:
        """Return estimated errors of the film; None before the finest grid was iterated on."""
        roughness, traces = self.roughness, self.traces
        if len(traces) < len(self.levels) or not traces[-1].reports:
            return None
        if not roughness.is_rough:
            return error_estimate(traces, self.options.wedge_order)
        comparable = traces[roughness.first_comparable :]
        if len(comparable) < 2:
            dx = self.finest.grid.dx
            return single_grid_estimate(traces[-1], dx, roughness.points, roughness.amplitude)
        return error_estimate(comparable, self.options.wedge_order, rough=True)

    @property
    def has_no_film_before(self) -> bool:
        """Whether Newton's method found no positive film with all heights on the grid before."""
        last = len(self.levels) - 1
        if not (self.strategy.newton and self.roughness.first < last <= len(self.traces)):
            return False
        level, reports = self.levels[-2], self.traces[last - 1].reports
        solved = bool(reports) and reports[-1].residual < RAISED
        return solved and float(level.film.h.min()) < -level.equations.floor

    def salvage(self) -> None:
        """Interpolate the finest sound coarser state to the finest grid."""
        levels = self.levels
        sound = max((k for k, level in enumerate(levels) if _is_sound(level)), default=0)
        if not _is_sound(levels[sound]):
            levels[0].start_from_hertz(self.hierarchy.expected_film)
        for coarse, fine in zip(levels[sound:], levels[sound + 1 :], strict=False):
            fine.interpolate_from(coarse)
        self.finest.pose_problem()
        self.finest.update()


def nodal_film(level: Level) -> tuple[float, float]:
    """Return central and smallest nodal film of a level."""
    return central_value(level.grid, level.film.h), float(level.film.h.min())


def _is_sound(level: Level) -> bool:
    """Return whether a level holds a finite pressure of credible size."""
    largest = float(level.film.p.max())
    return 0.0 < largest < RUNAWAY and bool(np.isfinite(level.rigid_approach))
