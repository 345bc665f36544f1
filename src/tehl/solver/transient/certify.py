"""A transient run with error bars: three grids, and one larger domain."""

import math
from dataclasses import dataclass, replace

import numpy as np

from tehl.errors import ConvergenceError, InputError
from tehl.options import Options, can_be_halved, check_certifiable
from tehl.problem import ContactProblem
from tehl.result import Cost, Estimate, Status
from tehl.solver.certify import (
    ORDERS,
    RESIDUE,
    estimate,
    halved,
    nodes_of,
    spike,
    widened,
    with_growing_spike,
)
from tehl.solver.monitor import SILENT, StepMonitor
from tehl.solver.transient.run import solve_transient
from tehl.solver.verdict import LARGEST_BAR, not_certified, too_coarse
from tehl.transient_result import HistoryBars, TransientResult
from tehl.typing import Array

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
    check_certifiable(options, transient=True)
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


GROWTH = 2.0
"""By how often the last change a spike may still grow."""

Runs = tuple[TransientResult, ...]
"""Coarse to fine, two or three of them, each with twice the steps of the one before."""


def estimates(runs: Runs, wide: TransientResult) -> dict[str, Estimate]:
    """Return extremes over time with their error bars, in SI.

    Parameters
    ----------
    runs : tuple of TransientResult
        Two or three, coarse to fine.
    wide : TransientResult
        On the larger domain, with mesh and steps of the run before the last.
    """
    end = float(runs[-1].history.time[-1])
    found, wider = [_extremes(run, end) for run in runs], _extremes(wide, end)
    bars = {
        name: estimate(tuple(one[name] for one in found), domain=abs(wider[name] - found[-2][name]))
        for name in wider
    }
    growth, pressures = _growth(runs), _shared(runs[-2:], "pressure_max")[-1]
    highest = found[-1]["pressure_max"] + float(growth[np.argmax(pressures + growth)])
    bars["pressure_max"] = with_growing_spike(bars["pressure_max"], highest, highest)
    hottest = bars.get("film_rise_max")
    if hottest is not None and not _is_second(hottest.observed_order):  # the spike is what heats it
        bars["film_rise_max"] = with_growing_spike(hottest, *hottest.values[-2:])
    return bars


def _extremes(run: TransientResult, end: float) -> dict[str, float]:
    """Return the extremes until ``end`` [s], at which coarser runs need not have a step."""
    told, start = run.history, run.start

    def until_end(values: Array) -> Array:
        return np.append(values[told.time <= end], np.interp(end, told.time, values))

    central = until_end(told.film_central)
    found = {
        "film_minimum": until_end(told.film_minimum).min(),
        "film_central_least": central.min(),
        "film_central_largest": central.max(),
        "pressure_max": until_end(told.pressure_max).max(),
    }
    if start.heat is not None:
        found["film_rise_max"] = until_end(told.temperature_rise).max()
    if start.problem.is_coupled and start.problem.slide_roll_ratio != 0.0:
        traction = until_end(told.traction)
        found["traction_extreme"] = traction[np.abs(traction).argmax()]
    return {name: float(value) for name, value in found.items()}


def history_bars(runs: Runs, wide: TransientResult) -> HistoryBars:
    """Return error bars along the history, at the instants that all runs share.

    Parameters
    ----------
    runs : tuple of TransientResult
        Two or three, coarse to fine.
    wide : TransientResult
        On the larger domain, with mesh and steps of the run before the last.
    """
    time = _shared(runs, "time")[-1]
    return HistoryBars(
        time=time,
        film_central=_bar(runs, wide, "film_central"),
        film_minimum=_bar(runs, wide, "film_minimum"),
        pressure_max=_pressure_bar(runs, wide),
    )


def _shared(runs: Runs, name: str) -> list[Array]:
    """Return a column of each history at the shared instants, coarse to fine."""
    columns = [getattr(run.history, name) for run in runs]
    every = [2**place for place in range(len(runs))]
    count = min((one.size - 1) // steps for one, steps in zip(columns, every, strict=True)) + 1
    return [
        one[: (count - 1) * steps + 1 : steps] for one, steps in zip(columns, every, strict=True)
    ]


def _bar(runs: Runs, wide: TransientResult, name: str) -> Array:
    """Return the parts of grid and domain joined in quadrature."""
    return np.hypot(grid_bar(_shared(runs, name)), _domain_bar(runs, wide, name))


def _domain_bar(runs: Runs, wide: TransientResult, name: str) -> Array:
    """Return what the larger domain changed."""
    # the larger domain in the place of the run whose mesh and steps it has
    wider = _shared((*runs[:-2], wide, runs[-1]), name)[-2]
    return np.abs(wider - _shared(runs, name)[-2])


def _pressure_bar(runs: Runs, wide: TransientResult) -> Array:
    """Return the bar of the largest pressure, which holds a spike that grows."""
    series, steps = _shared(runs, "pressure_max"), 2 ** (len(runs) - 2)
    grid = np.maximum(grid_bar(series), _growth(runs)[::steps][: series[-1].size])
    return np.hypot(grid, _domain_bar(runs, wide, "pressure_max"))


def _growth(runs: Runs) -> Array:
    """Return by how much the largest pressure may still grow, at the instants of the last two runs.

    A spike gets higher on each finer grid, by as much again as between the last two, twice. The
    largest pressure may be that of a spike where it does not show second order; where it does, a
    spike may overtake it by as much as at the beginning, of which all runs have the whole field.
    """
    middle, finest = _shared(runs[-2:], "pressure_max")
    overtaking = np.full_like(finest, _overtaking(*runs[-2:]))
    if _is_second(_order(_shared(runs, "pressure_max"))):
        return overtaking
    return np.maximum(overtaking, GROWTH * (finest - middle))


def _overtaking(middle: TransientResult, finest: TransientResult) -> float:
    """Return by how much the spike of the steady film may overtake its largest pressure [Pa]."""
    now, before, highest = spike(finest.start), spike(middle.start), finest.history.pressure_max[0]
    reach = (now + GROWTH * max(now - before, 0.0)) * finest.start.scales.hertz_pressure
    return max(reach - float(highest), 0.0)


def grid_bar(series: list[Array]) -> Array:
    """Return the part of the grid in the error bars of a history.

    It is the change between the last two grids, less by the observed order (not more than two)
    where three grids show one near two in the mean square over time. A quarter of its mean over
    time is joined in quadrature: changes pass through zero where errors need not.

    Parameters
    ----------
    series : list of array
        Two or three, coarse to fine, at the same instants.
    """
    bar, order = np.abs(series[-1] - series[-2]), _order(series)
    if order is not None and _is_second(order):
        bar /= 2.0 ** min(order, 2.0) - 1.0
    return np.hypot(bar, RESIDUE * _mean(bar))


def _is_second(order: float | None) -> bool:
    return order is not None and ORDERS[0] <= order <= ORDERS[1]


def _order(series: list[Array]) -> float | None:
    """Return the order that three grids show in the mean square over time."""
    if len(series) < 3:
        return None
    first, last = _mean(series[1] - series[0]), _mean(series[2] - series[1])
    return math.log2(first / last) if first > 0 and last > 0 else None


def _mean(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
