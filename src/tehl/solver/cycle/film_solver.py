"""The steady film of a contact by full multigrid.

`FilmSolver` supplies the steps of `tehl.solver.cycle.fmg.full_multigrid`: how a grid starts if the
coarser one has no acceptable solution, and whether a finer one follows.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups
from tehl.kernels.energy.march import LARGEST_KELVIN_STEP
from tehl.kernels.properties import Factors
from tehl.operators.energy import FilmState
from tehl.operators.heights import Heights, heights_of
from tehl.result.solution import Solution
from tehl.solver.cycle.continuation import RAISED_RESIDUAL, TouchingError
from tehl.solver.cycle.fmg import full_multigrid
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.iteration import GridIteration
from tehl.solver.cycle.ladder import Strategy
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.methods import MOST_CYCLES, solve_coarsest
from tehl.solver.cycle.start import from_coarser, from_dry_pressure, from_guess, pose_problem
from tehl.solver.judging.convergence import (
    LARGEST_CYCLE_CHANGE,
    LARGEST_LOAD_ERROR,
    DivergedError,
    GridTrace,
    converged,
    film_converged,
    stalled,
)
from tehl.solver.judging.extrapolation import Outputs, extrapolated, outputs_of
from tehl.solver.judging.film_errors import estimated_errors
from tehl.solver.judging.goal import Goal
from tehl.solver.judging.measures import film_extremes, is_resolved
from tehl.solver.monitor import SILENT, Monitor

TOO_COARSE = 0.5
"""Error bar of the film beyond which the grid may be why the cycles do not converge."""
GRIDS_WITHOUT_BARS = 2
"""Most grids that give no error bars: the coarsest one does not resolve the contact."""


@dataclass(frozen=True, slots=True)
class Solved:
    """A grid that a strategy solved before it ended on a finer one: another one may go on there.

    ``traces`` are those of the grid and of the coarser ones, ``state`` is what `Level.set_state`
    takes, ``heat`` what `Coupling.take` takes.
    """

    grid: Grid
    traces: tuple[GridTrace, ...]
    state: tuple[Array, Array, Array]
    heat: tuple[FilmState, Factors] | None


class FilmSolver(GridIteration):
    """Full multigrid for the film of a contact.

    Parameters
    ----------
    hierarchy, strategy : Hierarchy, Strategy
        The levels; method and settings.
    heights : Heights or None
        Heights of the surfaces on the finest grid; None for smooth surfaces.
    goal : Goal
        The error to reach; by default the grid of the hierarchy is the finest.
    monitor : Monitor
        Receives the report of each cycle.
    guess : Solution or None
        The film of a similar contact.
    """

    def __init__(
        self,
        hierarchy: Hierarchy,
        strategy: Strategy,
        *,
        heights: Heights | None = None,
        goal: Goal | None = None,
        monitor: Monitor = SILENT,
        guess: Solution | None = None,
    ) -> None:
        goal = goal or Goal(hierarchy.scaled, hierarchy.options)
        super().__init__(hierarchy, strategy, heights, goal, monitor)
        self.guess = guess
        self.solved: tuple[Solved, ...] = ()  # coarser grids, for another strategy
        self.accepted = True  # the next coarser grid has an acceptable solution
        self.wanted: tuple[int, int] | None = None  # nodes of another grid for the goal

    @property
    def groups(self) -> Groups:
        """Dimensionless groups of the contact."""
        return self.hierarchy.scaled.groups

    def solve(self, *, force: bool, solved: tuple[Solved, ...] = ()) -> bool:
        """Run full multigrid; return whether the finest grid converged.

        If the goal is open, finer grids follow until the error estimate of the film is below it.
        ``force`` continues on the finest grid even if the next coarser one has no acceptable
        solution, and on one finer grid if the finest one diverges. The solve goes on from the
        grids that another strategy ``solved``.

        Raises
        ------
        DivergedError
            When the unknowns on the finest grid grow without bound or are not finite, no Newton
            step reduces the residual, or, unless forced, the coarser grid was not accepted.
        """

        def improve(levels: Sequence[Level]) -> None:
            if levels[-1] is self.finest:
                if not (self.accepted or force or self.strategy.early):
                    raise DivergedError
                self._improve_finest(force=force)
            else:
                self.accepted = self._approximate(levels)
                if self._runs_away() and not force:
                    raise DivergedError
                if self._is_last(levels):
                    self._finish(levels)
                    self._measure(levels)
                    if self._needs_finer_grid(force=force):
                        self._refine()

        self.solved = solved
        full_multigrid(self.levels, self._solve_coarsest, self._start, improve, self._go_on())
        return self._has_converged()

    def _go_on(self) -> int:
        """Take the finest of the grids that another strategy solved; return how many are solved.

        A third strategy begins a grid lower, as two have ended on the next grid. A strategy that
        heats coarser grids, or raises the sliding speed in steps, begins where they are isothermal.
        """
        strategy, grids = self.strategy, [level.grid for level in self.levels]
        while self.solved:
            *before, known = self.solved
            self.solved = tuple(before)
            number = len(known.traces)
            few = self._heats_early(len(grids) - number)
            early = self.coupling.heats_from(known.grid, early=few)
            fits = number <= len(grids) and grids[number - 1] == known.grid
            if not fits or (strategy.slide_in_steps if known.heat else early):
                continue
            fine, levels = self.levels[number - 1], self.levels[:number]
            self.traces += known.traces
            pose_problem(fine)
            fine.set_state(*known.state)
            self.coupling.take(levels, known.heat)
            if known.heat:
                self._relax_heated(levels)
            fine.update()
            if number == len(grids):
                self._refine()
            return number
        return 0

    def _keep(self, levels: Sequence[Level]) -> None:
        """Note that the last of ``levels`` is solved, for other strategies."""
        if not self.roughness.is_rough:  # another strategy would raise no heights there
            traces, heat = tuple(replace(one) for one in self.traces), self.coupling.kept(levels)
            found = Solved(levels[-1].grid, traces, levels[-1].state(), heat)
            self.solved = (*self.solved, found)

    def _improve_finest(self, *, force: bool) -> None:
        """Solve on the finest grid, and append a finer one if the goal is not reached."""
        try:
            self._solve_finest()
            self._measure(self.levels)
            self._reach_goal()
        except TouchingError:
            raise
        except DivergedError:
            self.traces[-1].diverged = True
            if not (force and self.goal.may_try(self.finest)):
                raise
            self._discard(self.levels)
            self._refine()
        else:
            if self._needs_finer_grid(force=force):
                if self._has_converged():
                    self._keep(self.levels)
                self._refine()

    def _reach_goal(self) -> None:
        """Cycle on where the iteration error is what the goal lacks: a finer grid costs more."""
        trace = self.traces[-1]
        while len(trace.reports) < self.options.max_cycles and not self.goal.is_over:
            ends = stalled(trace, self.strategy.patience) or not self._has_converged()
            if ends or not self.goal.awaits_cycles(self.errors(), self.minimum_part()):
                return
            self._go_further(self.levels)

    def keep_solved(self, known: tuple[Solved, ...]) -> bool:
        """Make the finest grid that is solved the last one; return whether it has error bars.

        Parameters
        ----------
        known : tuple of Solved
            Grids that another strategy solved.
        """
        grids = [level.grid for level in self.levels]
        mine = [one for one in (*known, *self.solved) if one.grid in grids]
        last = max(mine, key=lambda one: len(one.traces), default=None)
        if last is None or len(last.traces) <= GRIDS_WITHOUT_BARS:
            return False
        del self.levels[len(last.traces) :]
        self.traces[:] = last.traces
        pose_problem(self.finest)
        self.finest.set_state(*last.state)
        self.coupling.take(self.levels, last.heat)
        self.finest.update()
        return self.errors() is not None

    def outputs(self, *, valid: bool) -> Outputs:
        """Return the fields of the last grid, extrapolated if others show the order.

        On the rows that it stores.

        Parameters
        ----------
        valid : bool
            Whether the film is one that has stresses and temperatures.
        """
        found, coarser, errors = self.traces[-1].outputs, None, self.errors()
        if not valid or found is None:
            found = outputs_of(self.finest, self.hierarchy.scaled, self.coupling.state, valid=valid)
        if len(self.traces) > 1:
            coarser = self.traces[-2].outputs
        if valid and errors is not None and errors.extrapolated and coarser is not None:
            return extrapolated(found, coarser)
        return found

    def rest(self) -> None:
        """Free what cycles need beside the finest grid, while other grids are tried."""
        self.known_errors = (self.errors(),)
        self.hierarchy.free_coarser()
        self.coupling.reset(())
        self.solved = ()
        for trace in self.traces:
            trace.outputs = None

    def _has_converged(self) -> bool:
        """Return whether the last grid converged, and its oil flux is constant."""
        tolerance = max(self.options.tolerance, self.goal.tolerance)
        options = self.options.model_copy(update={"tolerance": tolerance})
        return self.balance.is_settled and converged(
            self.traces[-1], self._coarser_trace(), options
        )

    def reached_before(self, *, last: bool = False) -> tuple[tuple[int, int], float] | None:
        """Return nodes and error bar of the last grid but one that converged to a positive film.

        The ``last`` one counts too if the solve ended before the next grid.
        """
        for number in range(len(self.traces) - (1 if last else 2), GRIDS_WITHOUT_BARS - 1, -1):
            trace, level = self.traces[number], self.levels[number]
            if not trace.reports or not self._is_acceptable(trace):
                continue
            if abs(trace.reports[-1].load_error) > LARGEST_LOAD_ERROR:
                continue  # a start perhaps, but not of this load
            if not level.share.bounds_film and trace.minimum.values[-1] <= level.equations.floor:
                continue
            known = self.traces[: number + 1]
            errors = estimated_errors(level, known, self.roughness, self.hierarchy)
            if errors is not None and errors.film() < TOO_COARSE:
                return level.grid.points, errors.film()
        return None

    def film_error(self) -> float:
        """Return the relative error bar of the film on the last grid; infinite if it is unknown."""
        errors = self.errors()
        return math.inf if errors is None else errors.film()

    def minimum_part(self) -> float:
        """Return the minimum film over the film to which its error is relative [-].

        Itself between smooth surfaces, the central film of the smooth contact between rough ones.
        """
        least, smooth = float(self.finest.film.h.min()), self.hierarchy.expected_film
        return min(self.roughness.film_part(least, smooth), self.finest.share.largest_part)

    def _needs_finer_grid(self, *, force: bool) -> bool:
        """Return whether a finer grid follows: the film is not accurate, or does not converge.

        A grid too coarse explains cycles that do not converge; else another strategy may help.
        """
        if not self.goal.is_open:
            return False
        errors, part = self.errors(), self.minimum_part()
        resolved = is_resolved(self.finest)
        if not self._has_converged():
            resolved = resolved and self.goal.is_met(errors, part, TOO_COARSE)
            is_explained = not (resolved or self.leads_away())
            return (force or is_explained) and self.goal.may_try(self.finest)
        if resolved and self.goal.is_met(errors, part):
            return False
        self.wanted = self.goal.other_nodes(self.finest, errors) if resolved else None
        return self.wanted is None and self.goal.may_refine(self.finest, errors)

    def leads_away(self) -> bool:
        """Return whether cycles lead away from the film, or a coarser grid resolves it.

        So they do where heat runs away.
        """
        reports = self.traces[-1].reports
        grows = bool(reports) and reports[-1].residual > reports[0].residual
        hotter = bool(reports) and reports[-1].temperature_change >= LARGEST_KELVIN_STEP
        return grows or hotter or self.reached_before() is not None

    def _is_last(self, levels: Sequence[Level]) -> bool:
        """Return whether a grid is accurate enough, or no finer one may follow."""
        if not (self.goal.may_end_early and self.accepted and len(levels) > GRIDS_WITHOUT_BARS):
            return False
        if self.coupling.is_pending or not is_resolved(levels[-1]):
            return False
        return self.goal.is_met(self.errors()) or not self.goal.may_refine(levels[-1])

    def _refine(self) -> None:
        """Append a grid of half the mesh width."""
        self.hierarchy.refine(self.strategy.first_relaxation)
        if self.roughness.heights is not None:
            self.roughness.refine(heights_of(self.hierarchy.scaled, self.finest.grid))
        else:
            self.roughness.refine(None)

    # steps of full multigrid

    def _solve_coarsest(self) -> None:
        """Solve on the coarsest grid by Newton's method, from the Hertz pressure."""
        coarsest = self.levels[0]
        from_dry_pressure(coarsest, self.hierarchy.expected_film)
        start = coarsest.state()
        if not solve_coarsest(self.hierarchy, newton=self.strategy.newton):
            coarsest.set_state(*start)
            coarsest.update()
            self._discard(self.levels[:1])
        self.traces.append(GridTrace(columns=coarsest.grid.nx))
        self.traces[0].note(*film_extremes(coarsest))

    def _start(self, coarse: Level, fine: Level) -> None:
        """Interpolate the coarser solution, or restart from the smooth film or the Hertz pressure.

        A grid that does not resolve the film may have no acceptable discrete solution.
        """
        number, film = self.levels.index(fine), self.hierarchy.expected_film
        self.from_hertz = False
        if self.accepted:
            from_coarser(coarse, fine)
        elif number > self.roughness.first:
            self.from_hertz = not self.roughness.restart(number, film)
        else:
            from_dry_pressure(fine, film)
            self.from_hertz = True
            self.accepted = number == 1  # no cycles have failed yet

    def _approximate(self, levels: Sequence[Level]) -> bool:
        """Iterate on a coarser grid; return whether its solution is a start for the next grid."""
        try:
            self._iterate(levels)
            self._measure(levels)
        except DivergedError:
            accepted, self.traces[-1].diverged = False, True
        else:
            accepted = self._is_acceptable(self.traces[-1])
        if not accepted:
            self._discard(levels)
        elif film_converged(self.traces[-1], self._coarser_trace()):
            self._keep(levels)  # not one that oscillates
        return accepted

    def _runs_away(self) -> bool:
        """Return whether undamped heat or thinning diverged.

        So it does on the next grid: of 300 machines' contacts all eight that were tried there.
        """
        last = self.traces[-1]
        return last.diverged and last.coupled and self.strategy.damping == 1.0

    def _discard(self, levels: Sequence[Level]) -> None:
        """Let the next grid start without film, heat and relaxation of ``levels``."""
        self.accepted = False
        self.coupling.reset(levels)
        for level in (*levels, *self.hierarchy.between.values()):
            level.set_relaxation(self.strategy.first_relaxation)

    def _is_acceptable(self, trace: GridTrace) -> bool:
        """Return whether a coarser grid was converging, so that the next one may start from it.

        Not while temperatures change by the most that a sweep may change them: the first heated
        film is so far off that the residual may halve while heat runs away.
        """
        first, last = trace.reports[0], trace.reports[-1]
        # fewer cycles than MOST_CYCLES: it converged before
        falling = last.cycle < MOST_CYCLES or last.residual < self.options.tolerance
        if self.strategy.newton or trace.criteria.damping < 1.0:
            # it may start so close that its residual cannot halve; heat is added in increments
            falling = falling or film_converged(trace, self._coarser_trace())
        falling = falling or last.residual < 0.5 * first.residual
        # single nodes may part, and those at the ends of rollers change most
        single = trace.criteria.steady or self.finest.grid.is_closed
        change = last.mean_change if single else last.change
        return (
            falling
            and last.temperature_change < LARGEST_KELVIN_STEP
            and change < LARGEST_CYCLE_CHANGE
            and abs(last.load_error) < LARGEST_CYCLE_CHANGE
        )

    def _solve_finest(self) -> None:
        """Iterate on the finest grid; if Newton's method fails, raise the heights on this grid.

        Not if the next coarser grid has no positive film with all heights: raising them takes ten
        times as long as all before, and fails alike.
        """
        from_guess(self.finest, self.guess)
        last, roughness = len(self.levels) - 1, self.roughness
        try:
            self._iterate(self.levels)
        except DivergedError:
            raised_before = self.strategy.newton and roughness.first < last
            if not raised_before or self.coarser_film_is_negative:
                raise
            self.monitor.message("Newton's method failed: raising the heights on the finest grid")
            self.traces.pop()
            comparable = roughness.first_comparable
            self.from_hertz = not roughness.restart(last, self.hierarchy.expected_film)
            roughness.first_comparable = comparable  # the film of the coarser grid is valid
            self._iterate(self.levels)

    @property
    def coarser_film_is_negative(self) -> bool:
        """Whether Newton's method converged on the next coarser grid to a film that is negative."""
        last = len(self.levels) - 1
        if not (self.strategy.newton and self.roughness.first < last <= len(self.traces)):
            return False
        level, reports = self.levels[-2], self.traces[last - 1].reports
        solved = bool(reports) and reports[-1].residual < RAISED_RESIDUAL
        # below -floor: negative beyond doubt
        return solved and float(level.film.h.min()) < -level.equations.floor
