"""Error bars of a transient run, from three grids and one larger domain.

The stride is the same on all grids, so the time step is proportional to the mesh width and the
scheme is of second order in both together (docs/theory/numerics-transient.md).
"""

from dataclasses import replace
from functools import partial

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.options import Options, can_be_halved, check_certifiable
from tehl.contact.problem import ContactProblem
from tehl.contact.transient import Transient
from tehl.estimate.settled import keeping_order, settled
from tehl.result.bars import Estimate, shows_second_order
from tehl.result.solution import ConvergenceError
from tehl.result.transient import HistoryBars, TransientSolution
from tehl.solver.cost import end_of_time
from tehl.solver.judging.certify import (
    WITHOUT_FIRST,
    Companion,
    halved,
    message_on,
    nodes_of,
    not_certified,
    reach_of_spike,
    too_coarse_to_certify,
    widened,
    widest,
    with_limits,
)
from tehl.solver.judging.richardson import (
    SPIKE_GROWTH,
    estimate,
    grid_bar,
    order_of_history,
    with_growing_spike,
)
from tehl.solver.judging.verdict import LARGEST_FILM_BAR
from tehl.solver.monitor import SILENT, StepMonitor
from tehl.solver.transient.run import solve_transient

JUDGED = ("film_minimum", "film_central_least")
"""Values whose error bars decide whether the grid is too coarse; temperatures do not."""

Other = Companion[TransientSolution]
Runs = tuple[TransientSolution, ...]
"""Two or three runs, coarse to fine, each with twice the steps of the one before. ``wide`` below is
the run on the larger domain, with mesh and steps of the run before the last."""


def certify_transient(
    problem: ContactProblem, options: Options | None = None, *, monitor: StepMonitor = SILENT
) -> TransientSolution:
    """Solve a transient problem on three grids and on a larger domain; return error bars.

    The coarser grids have a half and a quarter of the intervals and the same stride. The larger
    domain has the mesh and the time steps of the grid of half the intervals.

    Parameters
    ----------
    problem : ContactProblem
        The contact, with a ``transient`` table.
    options : Options
        Of the finest grid.
    monitor : StepMonitor
        Receives the report of each step of each run.

    Returns
    -------
    TransientSolution
        Of the finest grid, with ``uncertainty`` and ``bars``. If it ended early, or if no error bar
        follows from the other runs, ``status`` says so and both are empty. A failed run on a
        quarter of the intervals is left out.

    Raises
    ------
    ConvergenceError
        When the steady film at time zero did not converge on the finest grid.
    InputError
        When the transient problem is not valid, or the grid cannot be halved.
    """
    options = options or Options()
    until = end_of_time(options) if "max_time" in options.model_fields_set else None
    if problem.contact.has_lines:
        options = settled(problem, options)
    if options.points != "auto":
        check_certifiable(options, transient=True)
    monitor.message("certify: the finest grid")
    # the finest run is first, because it decides whether the problem is valid
    finest = solve_transient(problem, options, monitor=monitor, until=until, one_grid=True)
    if options.points == "auto":
        options = keeping_order(problem, options, finest.start.grid_options)
    if not finest.status.converged:
        return finest
    assert problem.transient is not None
    others = problem.model_copy(update={"transient": _without_frames(problem.transient, finest)})
    solve = partial(_companion, others, monitor, until)
    middle = solve(halved(options, 1), "half the intervals")
    if middle.result is None:
        return _not_certified(finest, "the run on half the intervals", middle)
    wide = solve(widened(options, finest.start), "the larger domain")
    finest = replace(finest, cost=finest.cost + middle.cost)
    if wide.result is None:
        return _not_certified(finest, "the run on the larger domain", wide)
    coarse = solve(halved(options, 2), "a quarter of the intervals")
    runs = tuple(one for one in (coarse.result, middle.result, finest) if one is not None)
    result = replace(
        finest,
        status=replace(finest.status, message=_message(finest, coarse, middle, wide)),
        cost=finest.cost + coarse.cost + wide.cost,
        uncertainty=with_limits(estimates(runs, wide.result), finest.start.errors),
        bars=history_bars(runs, wide.result),
    )
    worst = widest(result.uncertainty, JUDGED)
    if worst > LARGEST_FILM_BAR:
        return replace(result, status=too_coarse_to_certify(result.start, worst))
    return result


def _message(finest: TransientSolution, coarse: Other, middle: Other, wide: Other) -> str:
    """Return how each run ended, and what follows for the bars."""
    last = f"{nodes_of(finest.start.grid_options)} {finest.status.outcome}"
    message = message_on([coarse.ending, middle.ending, last], wide.ending)
    if finest.status.is_vague:
        message = f"{finest.status.message} {message}"
    return message if coarse.result is not None else f"{message} {WITHOUT_FIRST}"


def _without_frames(transient: Transient, finest: TransientSolution) -> Transient:
    """Return the table of the other runs: the stride of the finest one, which alone has fields."""
    if "stride" in transient.model_fields_set:
        return transient.model_copy(update={"frames": 0})
    grid, scales = finest.start.scaled, finest.start.scales
    mesh_width = float(grid.x[1] - grid.x[0]) * scales.half_width_x
    stride = round(finest.time_step * scales.speed / mesh_width)
    return transient.model_copy(update={"frames": 0, "stride": stride})


def _companion(
    problem: ContactProblem,
    monitor: StepMonitor,
    until: float | None,
    options: Options,
    what: str,
) -> Other:
    """Solve on another grid; a run that fails has no result."""
    name = nodes_of(options)
    if not can_be_halved(options, 0):
        return Companion(ending=f"{name} has too few nodes")
    monitor.message(f"certify: {name} nodes, {what}")
    found: Other
    try:
        run = solve_transient(problem, options, monitor=monitor, until=until)
    except InputError as error:
        found = Companion(ending=f"{name} not possible ({error})")
    except ConvergenceError as error:
        result = error.result
        found = Companion(ending=f"{name} at time zero {result.status.outcome}", cost=result.cost)
    else:
        used = run if run.status.converged else None
        found = Companion(ending=f"{name} {run.status.outcome}", result=used, cost=run.cost)
    if found.result is None:
        monitor.message(f"certify: {found.ending}")
    return found


def _not_certified(finest: TransientSolution, what: str, failed: Other) -> TransientSolution:
    """Return the finest run without error bars, because another one failed."""
    status = not_certified(finest.start, f"{what} failed ({failed.ending}).")
    return replace(finest, status=status, cost=finest.cost + failed.cost)


def estimates(runs: Runs, wide: TransientSolution) -> dict[str, Estimate]:
    """Return extremes over time with their error bars, in SI.

    Parameters
    ----------
    runs : tuple of TransientSolution
        On grids and time steps halved each time, the finest last.
    wide : TransientSolution
        On the larger domain, with the mesh width of the second finest run.
    """
    end = float(runs[-1].history.time[-1])
    found, wider = [_extremes(run, end) for run in runs], _extremes(wide, end)
    bars = {
        name: estimate(tuple(one[name] for one in found), domain=abs(wider[name] - found[-2][name]))
        for name in wider
    }
    growth, pressures = _growth(runs), _shared(runs[-2:], "pressure_max")[-1]
    highest = found[-1]["pressure_max"] + float(growth[np.argmax(pressures + growth)])
    bars["pressure_max"] = with_growing_spike(bars["pressure_max"], highest)
    hottest = bars.get("film_rise_max")
    if hottest is not None and not hottest.is_second_order:  # heated by the spike
        before, now = hottest.values[-2:]
        reach = now + SPIKE_GROWTH * max(now - before, 0.0)
        bars["film_rise_max"] = with_growing_spike(hottest, reach)
    return bars


def _extremes(run: TransientSolution, end: float) -> dict[str, float]:
    """Return the extremes until ``end`` [s], which need not be a step of a coarser run."""
    history, start = run.history, run.start

    def until_end(values: Array) -> Array:
        return np.append(values[history.time <= end], np.interp(end, history.time, values))

    central = until_end(history.film_central)
    found = {
        "film_minimum": until_end(history.film_minimum).min(),
        "film_central_least": central.min(),
        "film_central_largest": central.max(),
        "pressure_max": until_end(history.pressure_max).max(),
    }
    if start.heat is not None:
        found["film_rise_max"] = until_end(history.temperature_rise).max()
    sheared = {
        "traction": history.sliding.any(),
        "traction_across": history.traction_across.any(),
        "drilling_moment": history.drilling_moment.any(),
    }
    wanted = {name: slides and start.problem.is_coupled for name, slides in sheared.items()}
    wanted["rolling_moment"] = start.problem.contact.has_lines
    for name in (name for name, is_wanted in wanted.items() if is_wanted):
        values = until_end(getattr(history, name))
        found[f"{name}_extreme"] = values[np.abs(values).argmax()]
    return {name: float(value) for name, value in found.items()}


def history_bars(runs: Runs, wide: TransientSolution) -> HistoryBars:
    """Return error bars along the history, at the times that all runs share.

    Parameters
    ----------
    runs : tuple of TransientSolution
        On grids and time steps halved each time, the finest last.
    wide : TransientSolution
        On the larger domain, with the mesh width of the second finest run.
    """
    growth = _growth(runs)[:: 2 ** (len(runs) - 2)]
    errors, times = runs[-1].start.errors, _shared(runs, "time")[-1]
    thins, presses = (
        errors is not None and not getattr(errors, f"{name}_has_limit")
        for name in ("minimum", "pressure")
    )
    unknown = np.full(times.shape, np.nan)
    return HistoryBars(
        time=times,
        film_central=_bar(runs, wide, "film_central"),
        film_minimum=unknown if thins else _bar(runs, wide, "film_minimum"),
        pressure_max=unknown if presses else _bar(runs, wide, "pressure_max", growth),
    )


def _shared(runs: Runs, name: str) -> list[Array]:
    """Return a column of each history at the shared times, coarse to fine."""
    columns = [getattr(run.history, name) for run in runs]
    every = [2**place for place in range(len(runs))]
    count = min((one.size - 1) // steps for one, steps in zip(columns, every, strict=True)) + 1
    return [
        one[: (count - 1) * steps + 1 : steps] for one, steps in zip(columns, every, strict=True)
    ]


def _bar(runs: Runs, wide: TransientSolution, name: str, least: Array | None = None) -> Array:
    """Return the errors of grid, at least ``least``, and domain, added in quadrature."""
    series = _shared(runs, name)
    grid = grid_bar(series)
    if least is not None:
        grid = np.maximum(grid, least[: grid.size])
    # the larger domain has mesh and steps of the run before the last
    wider = _shared((*runs[:-2], wide, runs[-1]), name)[-2]
    return np.hypot(grid, np.abs(wider - series[-2]))


def _growth(runs: Runs) -> Array:
    """Return the possible growth of the largest pressure, at the times of the last two runs.

    If the largest pressure does not show second order it may be that of a spike, which may grow by
    `SPIKE_GROWTH` times its last change. If it does, a spike may exceed it by as much as at time
    zero, the only time at which all runs have the whole field.
    """
    middle, finest = _shared(runs[-2:], "pressure_max")
    start = runs[-1].start
    reach = reach_of_spike([run.start for run in runs]) * start.scales.hertz_pressure
    excess = np.full_like(finest, max(reach - float(runs[-1].history.pressure_max[0]), 0.0))
    if shows_second_order(order_of_history(_shared(runs, "pressure_max"))):
        return excess
    return np.maximum(excess, SPIKE_GROWTH * (finest - middle))
