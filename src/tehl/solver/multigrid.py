"""Full multigrid: from the coarsest grid up, each grid starts from the next coarser solution."""

from collections.abc import Callable
from functools import partial
from itertools import count
from typing import TYPE_CHECKING, Protocol

import numpy as np

from tehl.film_formulas import expected_central_film
from tehl.grid import Grid, hierarchy
from tehl.operators.film import hertz_pressure
from tehl.operators.flow import FlowTable
from tehl.operators.heights import Heights
from tehl.operators.transfer import refine
from tehl.options import Options
from tehl.result import CycleReport, ErrorEstimate, Result
from tehl.scaling import ScaledProblem
from tehl.solver.anderson import Anderson
from tehl.solver.coarsest import CoarsestSolver
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
from tehl.solver.fas import ENOUGH, Cycle, Cycles
from tehl.solver.film_numbers import central_value
from tehl.solver.guess import start_from
from tehl.solver.level import Level
from tehl.solver.monitor import Monitor
from tehl.solver.newton import RAISED, Newton
from tehl.solver.smoother import BROAD, FAST, Setting
from tehl.solver.state import DivergedError, TouchingError, keep_cavities, state_of, take_state
from tehl.solver.thermal import Coupling, Uncoupled

if TYPE_CHECKING:
    from tehl.typing import Array

FIRST_STEPS = 6
"""Newton steps on the coarsest grid at the start; they may cycle there, which does no harm."""
DRY_CYCLES = 2
"""Cycles after which a grid that began with the dry pressure has a film."""
RUNAWAY = 100.0
"""Load error and central film that no iteration comes back from (H of a contact is below 2)."""
WILD = 10.0
"""Change of pressure per cycle that no iteration comes back from between rough surfaces."""
SMOOTH_CYCLES = 2
"""Cycles without heights on the first grid that gets them."""
BLURRED = 12.0
"""Nodes per wave below which a grid does not resolve it well enough for its whole correction."""
RESOLVED = 8.0
"""Nodes per wave from which the film of a grid says something of that of the next one."""
DISTANT = 33
"""Least nodes along x of the grid on which Newton's method sees what distant nodes do."""
DAMPED_MEMORY = 3
"""Most earlier cycles that are combined where heat and thinning act by parts."""
FLOOR = 0.02
"""Least film in the conductance, over the expected central film: coarse grids may need it."""


class Method(Protocol):
    """What brings a level nearer to its solution.

    ``enough`` is the most steps on a grid that only gives the start for the next finer one.
    """

    enough: int

    def step(self) -> object:
        """Do so once."""
        ...

    def raise_heights(self, once: Callable[[], float], *, last: bool) -> None:
        """Raise the heights of the level from nearly none to nearly all.

        ``once`` takes a step, tells of it and returns the residual; ``last``: the level is that of
        the answer.
        """
        ...


class Multigrid:
    """A hierarchy of levels, coarsest first, that knows how to cycle.

    Parameters
    ----------
    finest : Grid
        The grid of the answer.
    scaled : ScaledProblem
        The contact.
    flow : FlowTable
        The lubricant.
    options : Options
        How hard to try.
    setting : Setting
        Of the relaxation.
    coupling : Coupling
        What acts on the film besides pressure and elasticity.
    """

    def __init__(
        self,
        finest: Grid,
        scaled: ScaledProblem,
        flow: FlowTable,
        options: Options,
        setting: Setting,
        coupling: Coupling | None = None,
    ) -> None:
        self.coupling = coupling or Uncoupled()
        self.options, self.setting = options, setting
        self.scaled, self.groups = scaled, scaled.groups
        groups = scaled.groups
        # as long as the film is isothermal the zone that conducts is narrow
        first = FAST if setting is BROAD else setting
        self.first_setting = first
        self.levels = [Level(g, groups, flow, options, first) for g in hierarchy(finest)]
        self.coarsest = CoarsestSolver(self.levels[0])
        self.expected_film = expected_central_film(groups)
        for level in self.levels:
            level.floor = FLOOR * self.expected_film
        self.first_rough = self.first_alike = len(self.levels)
        self.smooth: tuple[int, Array, float] | None = None
        self.ripple = (np.inf, 0.0)
        self.coarsest_trace = GridTrace()
        self.traces: list[GridTrace] = []
        self.guess: Result | None = None

    def carry(self, load: float) -> None:
        """Let the film carry ``load`` times the load of the contact."""
        for level in self.levels:
            level.load_part = load

    def roughen(self, heights: Heights) -> None:
        """Make the surfaces rough: give heights on the finest grid to the levels that resolve them.

        The finest level that does not resolve them well has its correction damped: it sees waves
        of another shape, and its whole correction would overshoot.
        """
        rough = self.setting.rough
        fields = heights.on([level.grid for level in self.levels])
        points = [heights.points_per_wave(level.grid) for level in self.levels]
        last = len(self.levels) - 1
        first = next((k for k in range(1, last) if points[k] >= rough.points), last)
        for level, field in zip(self.levels[first:], fields[first:], strict=True):
            level.heights = field
        blurred = max((k for k in range(last) if points[k] < BLURRED), default=None)
        if blurred is not None:
            self.levels[blurred].correction = rough.correction
            for level in self.levels[blurred:]:
                level.limit = rough.limit
        self.first_rough = first
        alike = (k for k in range(first, last) if points[k] >= RESOLVED)
        self.first_alike = next(alike, last)
        inside = np.hypot.outer(self.finest.grid.y, self.finest.grid.x) < 1.0
        self.ripple = (points[-1], 0.5 * float(np.ptp(fields[-1][inside])))

    def errors(self) -> ErrorEstimate | None:
        """Return estimated errors of the film; None before the finest grid was cycled on."""
        if len(self.traces) < len(self.levels) - 1 or not self.traces[-1].reports:
            return None
        alike = [self.coarsest_trace, *self.traces]
        if self.is_rough:
            alike = alike[self.first_alike :]
        if self.is_rough and len(alike) < 2:
            return single_grid_estimate(self.traces[-1], self.finest.grid.dx, *self.ripple)
        return error_estimate(alike, self.options.wedge_order, rough=self.is_rough)

    @property
    def is_rough(self) -> bool:
        """Whether the surfaces have heights."""
        return self.first_rough < len(self.levels)

    @property
    def has_no_film_before(self) -> bool:
        """Whether Newton's method found all heights of the grid before to have no positive film."""
        raised_before = self.setting.rough.newton and self.first_rough < len(self.levels) - 1
        if not raised_before or len(self.traces) < len(self.levels) - 2:
            return False
        level, reports = self.levels[-2], self.traces[len(self.levels) - 3].reports
        solved = bool(reports) and reports[-1].residual < RAISED
        return solved and float(level.film.h.min()) < -level.floor

    @property
    def finest(self) -> Level:
        """The level of the answer."""
        return self.levels[-1]

    def solve(self, monitor: Monitor, *, patient: bool) -> bool:
        """Run full multigrid; return whether the finest grid converged.

        Parameters
        ----------
        monitor : Monitor
            Told of each cycle.
        patient : bool
            Go on to the finest grid even when the one before it is in disorder.

        Raises
        ------
        DivergedError
            When the unknowns run away or are no longer finite on the finest grid.
        """
        self._start_dry(self.levels[0])
        for _ in range(FIRST_STEPS):
            self.coarsest.step()
        self.levels[0].update()
        self.coarsest_trace.note(*film_numbers(self.levels[0]))
        orderly = True
        for held in range(2, len(self.levels) + 1):
            coarse, fine = self.levels[held - 2 : held]
            if orderly:
                fine.film.p[:] = refine(coarse.film.p, fine.grid)
                fine.rigid_approach = coarse.rigid_approach
            elif held > self.first_rough + 1:
                self._start_smooth(held - 1)
            else:
                self._start_dry(fine)
            if fine is self.finest:
                if not (orderly or patient):
                    raise DivergedError
                start_from(fine, self.guess)
                self._answer(monitor)
            else:
                orderly = self._prepare_on(self.levels[:held], monitor)
                if not orderly:
                    self._forget(self.levels[:held])
        return converged(self.traces[-1], self._coarser_trace(), self.options)

    def _answer(self, monitor: Monitor) -> None:
        """Cycle on the finest grid; where Newton's method fails there, raise the heights on it.

        Not if all heights of the grid before have no positive film: those of this grid take ten
        times as long as all before to say the same.
        """
        last = len(self.levels) - 1
        try:
            self._cycle_on(self.levels, monitor)
        except DivergedError:
            raised_before = self.setting.rough.newton and self.first_rough < last
            if not raised_before or self.has_no_film_before:
                raise
            monitor.message("raising the heights on the finest grid")
            self.traces.pop()
            alike = self.first_alike
            self._start_smooth(last)
            self.first_alike = alike  # the film of the coarser grid is a sound one
            self._cycle_on(self.levels, monitor)

    def _forget(self, levels: list[Level]) -> None:
        """Leave nothing of a grid in disorder to the next one."""
        self.coupling.forget(levels)
        for level in levels:
            level.set_smoother(self.first_setting)

    def _start_smooth(self, number: int) -> None:
        """Start a rough level from the smooth film, and raise the heights there once more."""
        self.first_rough = number
        self.first_alike = max(self.first_alike, number)
        if self.smooth is None:
            self._start_dry(self.levels[number])
            return
        known, p, approach = self.smooth
        for level in self.levels[known + 1 : number + 1]:
            p = refine(p, level.grid)
        self.levels[number].film.p[:] = p
        self.levels[number].rigid_approach = approach

    def _coarser_trace(self) -> GridTrace | None:
        """Return the trace of the grid before the last one; None where that had another film."""
        if len(self.traces) < 2 or len(self.traces) == self.first_alike:
            return None
        return self.traces[-2]

    def salvage(self) -> None:
        """Put the finest coarser state that is sound on the finest grid, by interpolation."""
        sound = max((k for k, level in enumerate(self.levels) if _is_sound(level)), default=0)
        if not _is_sound(self.levels[sound]):
            self._start_dry(self.levels[0])
        for coarse, fine in zip(self.levels[sound:], self.levels[sound + 1 :], strict=False):
            fine.film.p[:] = refine(coarse.film.p, fine.grid)
            fine.rigid_approach = coarse.rigid_approach
        self.finest.pose_problem()
        self.finest.update()

    def _start_dry(self, level: Level) -> None:
        """Start from the dry pressure, at the approach that gives the expected central film."""
        level.pose_problem()
        level.film.p[:] = hertz_pressure(level.grid)
        level.rigid_approach = 0.0
        level.update()
        level.rigid_approach = self.expected_film - central_value(level.grid, level.film.h)
        level.stale, level.started_dry = True, True

    def _prepare_on(self, levels: list[Level], monitor: Monitor) -> bool:
        """Cycle on a coarser grid; return whether its solution is a start for the next one.

        A grid that cannot resolve the film may have no sound discrete solution: then the dry
        pressure is the better start.
        """
        try:
            self._cycle_on(levels, monitor)
        except DivergedError:
            return False
        first, last = self.traces[-1].reports[0], self.traces[-1].reports[-1]
        settled = last.cycle < ENOUGH or last.residual < self.options.tolerance
        if self.setting.rough.newton:  # the heights were raised before, so it begins near its end
            settled = settled or iterated_enough(self.traces[-1], self._coarser_trace())
        falling = settled or last.residual < 0.5 * first.residual
        return falling and last.change < LARGEST_CHANGE and abs(last.load_error) < LARGEST_CHANGE

    def _cycle_on(self, levels: list[Level], monitor: Monitor) -> None:
        """Cycle with the last of ``levels`` as the finest, until it is good enough."""
        fine, last = levels[-1], levels[-1] is self.finest
        fine.pose_problem()
        fine.update()
        self._couple(levels, finest=last)
        trace = GridTrace()
        if len(levels) > self.first_rough:
            trace.largest_change = LARGEST_ROUGH_CHANGE
        trace.damp(self.coupling.follow)
        self.traces.append(trace)
        coarser = self._coarser_trace()
        method = self._method(levels)
        try:
            done = self._ramp(levels, method, monitor)
        except TouchingError:  # what was found is all that there is to tell
            trace.reports.append(self._report(fine, fine.film.p.copy(), 0, (0.0, 0.0)))
            trace.note(*film_numbers(fine))
            raise
        trace.note(*film_numbers(fine))
        anderson = self._anderson(levels)
        patience = self.setting.rough.patience
        most = patience * self.options.max_cycles if last else method.enough
        for number in range(1, most + 1):
            if number > DRY_CYCLES and fine.started_dry and not last:
                fine.started_dry = False  # now there is a film to heat
                self._couple(levels, finest=False)
            before = state_of(fine) if anderson else None
            report = self._cycle(levels, method, number + done)
            trace.reports.append(report)
            trace.note(report.film_central, report.film_minimum)
            trace.rise.values.append(report.temperature_rise)
            monitor.cycle(report)
            if last and (ended(trace, coarser, self.options) or stalled(trace, patience)):
                return
            if not last and iterated_enough(trace, coarser):
                return
            if anderson is not None and before is not None:
                combined = anderson.combine(before, state_of(fine))
                take_state(fine, keep_cavities(fine, combined))

    def _couple(self, levels: list[Level], *, finest: bool) -> None:
        """Begin the coupling on the last of ``levels``, if it is worth it there."""
        if self.coupling.begin(levels, finest=finest):
            for level in levels:
                level.set_smoother(self.setting)

    def _anderson(self, levels: list[Level]) -> Anderson | None:
        """Return the acceleration of the cycles on the last of ``levels``, if they need one."""
        memory = self.setting.rough.memory
        if self.coupling.follow < 1.0:  # another flow belongs to the older cycles
            memory = min(memory, DAMPED_MEMORY)
        return Anderson(memory) if memory and len(levels) > self.first_rough else None

    def _method(self, levels: list[Level]) -> Method:
        """Return what brings the last of ``levels`` nearer to its solution.

        Cycles; between rough surfaces, if the setting says so, Newton's method.
        """
        if not (self.setting.rough.newton and len(levels) > self.first_rough):
            return self._cycles(levels)
        coarse = next(level.grid for level in levels if level.grid.nx >= DISTANT)
        return Newton(levels[-1], coarse)

    def _cycles(self, levels: list[Level]) -> Cycles:
        shape = Cycle.of(self.options, levels[0].grid, self.expected_film)
        return Cycles(levels, self.coarsest.step, shape, self.setting.rough.ramp)

    def _ramp(self, levels: list[Level], method: Method, monitor: Monitor) -> int:
        """Raise the heights step by step on the first level that has them; return the cycles."""
        if len(levels) - 1 != self.first_rough:
            return 0
        fine, numbers = levels[-1], count(1)

        def once(how: Method) -> float:
            report = self._cycle(levels, how, next(numbers))
            monitor.cycle(report)
            return report.residual

        fine.roughen(0.0)
        for _ in range(SMOOTH_CYCLES):
            once(self._cycles(levels))
        self.smooth = (len(levels) - 1, fine.film.p.copy(), fine.rigid_approach)
        method.raise_heights(partial(once, method), last=fine is self.finest)
        fine.roughen(1.0)
        fine.update()
        return next(numbers) - 1

    def _cycle(self, levels: list[Level], method: Method, number: int) -> CycleReport:
        """Bring the last of ``levels`` nearer to its solution once and report it."""
        fine = levels[-1]
        before = fine.film.p.copy()
        method.step()
        fine.update()
        heating = self.coupling.update(levels)
        return self._report(fine, before, number, heating)

    def _report(
        self, level: Level, before: np.ndarray, number: int, heating: tuple[float, float]
    ) -> CycleReport:
        residual = level.evaluate_residual()
        np.subtract(level.film.p, before, out=before)
        mean_change = float(np.abs(before).sum() / (level.film.p.sum() or 1.0))
        central, minimum = film_numbers(level)
        report = CycleReport(
            points=(level.grid.nx, level.grid.ny),
            cycle=number,
            residual=residual,
            change=float(max(before.max(), -before.min())),
            load_error=level.load_error(),
            film_central=central,
            film_minimum=minimum,
            smoother=self.setting.name,
            temperature_change=heating[0],
            temperature_rise=heating[1],
            mean_change=mean_change,
        )
        if not (np.isfinite(residual) and abs(report.load_error) < RUNAWAY and central < RUNAWAY):
            raise DivergedError
        if self.is_rough and not report.change < WILD:
            raise DivergedError
        return report


def film_numbers(level: Level) -> tuple[float, float]:
    """Return central and smallest nodal film of a level."""
    return central_value(level.grid, level.film.h), float(level.film.h.min())


def _is_sound(level: Level) -> bool:
    """Whether a level holds a finite pressure of credible size."""
    largest = float(level.film.p.max())
    return 0.0 < largest < RUNAWAY and bool(np.isfinite(level.rigid_approach))
