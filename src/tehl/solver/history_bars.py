"""Error bars of transient runs: of extremes over time, and along the history."""

import math

import numpy as np

from tehl.result import Estimate
from tehl.solver.certify import ORDERS, RESIDUE, estimate, spike, with_growing_spike
from tehl.transient_result import HistoryBars, TransientResult
from tehl.typing import Array

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
