"""A transient run with error bars: grids and steps that double together, and a larger domain."""

import math
from dataclasses import dataclass, replace

from tehl.errors import ConvergenceError, InputError
from tehl.options import Options, can_be_halved, check_certifiable_transient
from tehl.problem import ContactProblem
from tehl.result import Cost, Status
from tehl.solver.certify import halved, nodes_of, widened
from tehl.solver.history_bars import estimates, history_bars
from tehl.solver.monitor import SILENT, StepMonitor
from tehl.solver.transient import solve_transient
from tehl.solver.verdict import LARGEST_BAR, not_certified, too_coarse
from tehl.transient_result import TransientResult

JUDGED = ("film_minimum", "film_central_least", "pressure_max")
"""What must be known well enough, else the grid is too coarse; temperatures need not be."""


def certify_transient(
    problem: ContactProblem, options: Options | None = None, *, monitor: StepMonitor = SILENT
) -> TransientResult:
    """Follow a contact in time on three grids and on a larger domain; return it with error bars.

    The coarser grids have a half and a quarter of the intervals. Their stride is the same, so that
    steps grow with the mesh: the scheme is of second order in both together. The larger domain has
    the mesh and the steps of the grid of half the intervals.

    Parameters
    ----------
    problem : ContactProblem
        The question; it has a ``transient`` table.
    options : Options
        Of the finest grid.
    monitor : StepMonitor
        Told of each step of each run.

    Returns
    -------
    TransientResult
        That of the finest grid, with ``uncertainty`` and ``bars`` filled. If it did not come to its
        end, or no error bar follows from the other runs, ``status`` says so and they are not
        filled. A run on a quarter of the intervals that is refused or has no end is left out.

    Raises
    ------
    ConvergenceError
        When the finest grid did not reach the steady film of the beginning.
    InputError
        When the question cannot be followed in time, or the grid cannot be halved.
    """
    options = options or Options()
    check_certifiable_transient(options)
    monitor.message(f"certify: {nodes_of(options)} nodes, as asked")
    # first, as only this run tells whether the question can be answered at all
    finest = solve_transient(problem, options, monitor=monitor)
    if not finest.status.converged:
        return finest
    runs = _Runs(problem=_without_frames(problem), monitor=monitor)
    middle = runs.follow(halved(options, 1), "half the intervals")
    if middle.run is None:
        return _refused(finest, "the run on half the intervals", (middle,))
    wide = runs.follow(widened(options, finest.start), "the larger domain")
    if wide.run is None:
        return _refused(finest, "the run on the larger domain", (middle, wide))
    coarse = runs.quarter(options)
    status = _told(finest, coarse, middle, wide)
    known = tuple(one for one in (coarse.run, middle.run, finest) if one is not None)
    cost = _sum((finest.cost, coarse.cost, middle.cost, wide.cost))
    return _judged(
        replace(
            finest,
            status=status,
            cost=cost,
            uncertainty=estimates(known, wide.run),
            bars=history_bars(known, wide.run),
        )
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class _Other:
    """A run beside the finest; ``run`` is None when nothing follows from it."""

    ending: str
    run: TransientResult | None = None
    cost: Cost | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class _Runs:
    """Makes the runs beside the finest; none of them ends the certification by failing."""

    problem: ContactProblem
    monitor: StepMonitor

    def follow(self, options: Options, what: str) -> _Other:
        """Return a run, to its end or with what kept it from there."""
        self.monitor.message(f"certify: {nodes_of(options)} nodes, {what}")
        found = self._try(options)
        if found.run is None:
            self.monitor.message(f"certify: {found.ending}")
        return found

    def quarter(self, options: Options) -> _Other:
        """Return the run on a quarter of the intervals, if there is such a grid."""
        coarse = halved(options, 2)
        if not can_be_halved(options, 2):
            return _Other(ending=f"{nodes_of(coarse)} has too few nodes")
        return self.follow(coarse, "a quarter of the intervals")

    def _try(self, options: Options) -> _Other:
        name = nodes_of(options)
        try:
            run = solve_transient(self.problem, options, monitor=self.monitor)
        except InputError as error:
            return _Other(ending=f"{name} refused, as {error}")
        except ConvergenceError as error:
            ending = f"{name} at time zero {error.result.status.outcome}"
            return _Other(ending=ending, cost=error.result.cost)
        ending = f"{name} {run.status.outcome}"
        return _Other(ending=ending, run=run if run.status.converged else None, cost=run.cost)


def _without_frames(problem: ContactProblem) -> ContactProblem:
    """Return the question without fields to keep: nobody looks at those of the other runs."""
    assert problem.transient is not None
    bare = problem.transient.model_copy(update={"frames": 0})
    return problem.model_copy(update={"transient": bare})


def _refused(finest: TransientResult, what: str, others: tuple[_Other, ...]) -> TransientResult:
    """Return the finest run without error bars, and why it has none: the last of the others."""
    status = not_certified(finest.start, f"{what} failed ({others[-1].ending}).")
    cost = _sum((finest.cost, *(other.cost for other in others)))
    return replace(finest, status=status, cost=cost)


def _told(finest: TransientResult, coarse: _Other, middle: _Other, wide: _Other) -> Status:
    """Return the status that tells how each run ended, and what that does to the bars."""
    last = f"{nodes_of(finest.start.options)} {finest.status.outcome}"
    endings = f"{coarse.ending}, {middle.ending}, {last}"
    message = f"Grids of the error bars: {endings}; larger domain: {wide.ending}."
    if coarse.run is None:
        message += " The first is left out: each bar is the whole change between the other two."
    return replace(finest.status, message=message, hint=None)


def _sum(costs: tuple[Cost | None, ...]) -> Cost:
    known = [one for one in costs if one is not None]
    return Cost(
        cpu_seconds=sum(one.cpu_seconds for one in known),
        wall_seconds=sum(one.wall_seconds for one in known),
    )


def _judged(run: TransientResult) -> TransientResult:
    """Call the grid too coarse where a bar says no more than that."""
    bars = [run.uncertainty[name] for name in JUDGED]
    # a film extrapolated to nothing is as unknown as it gets
    worst = max(abs(bar.uncertainty / bar.value) if bar.value else math.inf for bar in bars)
    return run if worst <= LARGEST_BAR else replace(run, status=too_coarse(run.start, worst))
