"""The strategies of a ladder, tried in turn on a grid: each attempt and its judgement."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from tehl.base.wording import grid_size
from tehl.contact.options import Options
from tehl.estimate.grid import Grid
from tehl.estimate.nodes import finest_grid
from tehl.estimate.scaling import ScaledProblem
from tehl.operators.dry import at_loaded_ends, presses_as_edge
from tehl.result.solution import Status
from tehl.result.transient import TIME_OVER
from tehl.solver.cycle.continuation import TouchingError
from tehl.solver.cycle.film_solver import FilmSolver, Solved
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.ladder import Strategy
from tehl.solver.judging.convergence import TimeIsOverError
from tehl.solver.judging.diagnosis import diverged, reached_hint, time_over
from tehl.solver.judging.extrapolation import Outputs, unfolded
from tehl.solver.judging.goal import Goal
from tehl.solver.judging.remedy import Reached
from tehl.solver.judging.verdict import touching, verdict
from tehl.solver.monitor import Monitor

NO_MEMORY = "memory"
GRID_CAUSES = (
    NO_MEMORY,
    "grid_too_coarse",
    "error_not_reached",
    "domain_too_small",
    "inlet_too_short",
    "sides_too_close",
)
"""Causes of failure that no other strategy removes."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Attempt:
    """One strategy tried: its run, its status, and whether it met the stopping criterion."""

    run: FilmSolver
    status: Status
    reached: bool
    reached_before: Reached | None = None
    """The best film on coarser grids of all strategies, between smooth surfaces."""
    kept: Outputs | None = None
    """Fields of the result of a run that is at rest, on the rows that its grid stores."""

    def at_rest(self) -> "Attempt":
        """Return the attempt with the fields of its result alone, its coarser grids free.

        Unless motion in time, or small motions, begin from its grids.
        """
        problem = self.run.hierarchy.scaled.problem
        if self.kept is not None or problem.transient is not None or problem.dynamics is not None:
            return self
        kept = self._outputs()
        self.run.rest()
        return replace(self, kept=kept)

    def outputs(self) -> Outputs:
        """Return the fields of the result, on the full domain."""
        return unfolded(self._outputs(), self.run.finest.grid)

    def _outputs(self) -> Outputs:
        with np.errstate(all="ignore"):  # of a film that diverged
            return self.kept or self.run.outputs(valid=self.status.kind != "diverged")

    @property
    def is_final(self) -> bool:
        """Whether another strategy would end the same way."""
        touching = self.reached and self.status.cause == "asperity_contact"
        return self.status.converged or self.status.cause in GRID_CAUSES or touching

    @property
    def rank(self) -> tuple[bool, bool, bool, float]:
        """Sorting key, best first: final, converged, finite, least error of a grid too coarse."""
        error = self.run.film_error() if self.status.cause in GRID_CAUSES else 0.0
        is_wrong = self.status.kind == "diverged" or self.status.cause == TIME_OVER
        return not self.is_final, not self.reached, is_wrong, error


@dataclass(frozen=True, slots=True)
class Climb:
    """The strategies of a ladder, tried in turn on the grid of a plan."""

    scaled: ScaledProblem
    goal: Goal
    monitor: Monitor
    solver: Callable[[Hierarchy, Strategy], FilmSolver]

    def best(self, plan: Options, rungs: tuple[Strategy, ...]) -> Attempt:
        """Return the best attempt.

        Parameters
        ----------
        plan : Options
            With the nodes of the finest grid.
        rungs : tuple of Strategy
            Fastest first.
        """
        best: Attempt | None = None
        solved: tuple[Solved, ...] = ()
        steps = tuple(self._steps(plan, rungs))
        planned = plan
        for number, (grid, strategy) in enumerate(steps):
            if number:
                self.monitor.message(f"falling back to {strategy.description}")
            # else a strategy goes on from the grid that the error of the one before led to
            if grid is not planned:
                planned, plan, solved = grid, grid, ()
            # Newton's method is expensive: the cycles before it are tried to the end
            force = all(one.newton for _, one in steps[number + 1 :])
            attempt, known = self._attempt(plan, strategy, solved, force=force), solved
            best = _better(best, attempt)
            while attempt.run.wanted is not None and not self.goal.is_over:
                plan = plan.on_points(*attempt.run.wanted)
                self.monitor.message(f"another grid: {grid_size(plan.shape[::-1])}")
                del attempt  # frees its grids, unless it is the best one: that keeps its finest
                best = best.at_rest()
                attempt = self._attempt(plan, strategy, force=force)
                best = _better(best, attempt)
            solved = attempt.run.solved
            if attempt.is_final or self.goal.is_over:
                return self._in_time(best, attempt.run, known)
            del attempt  # as above: of two strategies that fail on large grids one keeps its own
            best = best.at_rest()
        assert best is not None
        return best

    def _in_time(self, best: Attempt, run: FilmSolver, known: tuple[Solved, ...]) -> Attempt:
        """Return the film of the finest grid that was solved where the time ended others."""
        goal = self.goal
        if best.is_final or not (goal.is_open and goal.is_over and run.keep_solved(known)):
            return best
        goal.obstacle = f"numerics.max_time is {run.options.max_time:g} s, and over"
        status = verdict(run, reached=True)
        return Attempt(run=run, status=status, reached=True, reached_before=best.reached_before)

    def _steps(
        self, plan: Options, rungs: tuple[Strategy, ...]
    ) -> Iterator[tuple[Options, Strategy]]:
        """Yield the strategies, each with its grid.

        Those with another wedge order than that of ``plan`` have as many lines as columns, but of
        wide contacts. Where that is more than planned, the first ones are tried so before: with few
        lines the edge of scarce oil may not rest.
        """
        rungs = self._for_lines(finest_grid(self.scaled, plan), rungs)
        own = tuple(one for one in rungs if one.wedge_order in (None, plan.order))
        yield from ((plan, one) for one in own)
        lines, nodes = plan.shape
        if lines > 1 and self.scaled.groups.ellipticity >= 1.0 and len(own) < len(rungs):
            plan = self.goal.fitting(plan.on_points(nodes, max(lines, nodes)))
            yield from ((plan, one) for one in own if lines < nodes)
        for one in rungs[len(own) :]:
            if one.wedge_order != plan.order:
                plan = plan.model_copy(update={"wedge_order": one.wedge_order})
            yield plan, one

    def _for_lines(self, grid: Grid, rungs: tuple[Strategy, ...]) -> tuple[Strategy, ...]:
        """Return the strategies for the lines of a grid, few that crowd where an end is an edge.

        `presses_as_edge`: of 59 such rollers (M = 1 to 111, seeds 1 to 6 of `benchmarks.rollers`)
        57 converge so within 25 s, and with all strategies on lines that crowd 47 within 40 s.
        """
        groups, crowded = self.scaled.groups, tuple(one for one in rungs if one.crowds)
        uniform = rungs[len(crowded) :]
        if not at_loaded_ends(grid, groups).crowding:
            return crowded
        if uniform and presses_as_edge(grid, groups):
            crowded = (crowded[0], *(one for one in crowded[1:] if one.early))
        return (*crowded, *uniform)

    def _attempt(
        self,
        plan: Options,
        strategy: Strategy,
        solved: tuple[Solved, ...] = (),
        *,
        force: bool,
    ) -> Attempt:
        """Run a strategy on the grid of a plan, from grids that are solved; judge its result."""
        grid = finest_grid(self.scaled, plan)
        if strategy.crowds:
            grid = at_loaded_ends(grid, self.scaled.groups)
        else:
            grid = replace(grid, crowding=0.0)
        hierarchy = Hierarchy.on(grid, self.scaled, plan, strategy.first_relaxation)
        return _run(self.solver(hierarchy, strategy), force=force, solved=solved)


def _better(best: Attempt | None, attempt: Attempt) -> Attempt:
    """Return the better attempt, of equals the later one, with the best film on coarser grids."""
    run, status = attempt.run, attempt.status
    films = [] if best is None else [best.reached_before]
    if not (status.converged or run.hierarchy.scaled.problem.is_rough):
        films.append(run.reached_before(last=status.cause == NO_MEMORY))
    known = [film for film in films if film is not None]
    kept = attempt if best is None or attempt.rank <= best.rank else best
    before = min(known, key=lambda film: film[1], default=None)
    status = kept.status
    if before is not None and status.is_vague and not kept.run.finest.grid.crowding:
        hint = reached_hint(*before, ", with the film at the ends")  # on lines that crowd there
        status = replace(status, hint=hint if hint.settings else status.hint)
    return replace(kept, status=status, reached_before=before)


def _run(run: FilmSolver, *, force: bool, solved: tuple[Solved, ...]) -> Attempt:
    """Run a strategy and judge its result, finite or not."""
    with np.errstate(all="ignore"):  # divergence ends in a status, not in warnings
        try:
            reached = run.solve(force=force, solved=solved)
        except TouchingError as error:
            return Attempt(run=run, status=touching(run, error.part), reached=True)
        except TimeIsOverError:
            run.hierarchy.salvage()
            return Attempt(run=run, status=time_over(run), reached=False)
        except ArithmeticError:
            run.hierarchy.salvage()
            return Attempt(run=run, status=diverged(run), reached=False)
        except MemoryError:
            nx, ny = run.finest.grid.points
            del run.levels[len(run.traces) :]
            message = f"The memory is not enough for {grid_size((nx, ny))}."
            status = Status(kind="not_converged", cause=NO_MEMORY, message=message)
            return Attempt(run=run, status=status, reached=False)
    return Attempt(run=run, status=verdict(run, reached=reached), reached=reached)
