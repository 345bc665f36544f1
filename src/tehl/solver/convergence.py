"""Stopping criteria of the cycles, and estimated errors of the film.

Full multigrid has solved the coarser grids anyway, so the discretisation error follows from the
difference of two grids, and cycles below it are wasted (Brandt 1977; docs/theory/numerics.md on
stopping and errors).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from tehl.options import Options
from tehl.solution import CycleReport, ErrorEstimate

LEAST_CYCLES = 2
LEAST_RATE, GUESSED_RATE, LARGEST_RATE, LARGEST_ALTERNATING = 0.2, 0.3, 0.95, 0.8
"""Least convergence rate per cycle in iteration errors, its value from one change, and its largest
value where changes have the same sign, and where they alternate."""
SAFETY = 2.0
"""Factor on a discretisation error from three grids: the coarser ones are not fully converged."""
ROUGH_PART = 0.7
"""Error over the last change of the film between grids that resolve the heights: a third if of
second order; measured up to 0.65 for the minimum film between waves (87 of them, 257 and 513
nodes)."""
SMOOTH_PART, WAVE_PART = 1.7, 20.0
"""Factors of the two terms of `single_grid_estimate`."""
SPIKE_GROWTH, UNRESOLVED_GROWTH, SLOWING = 2.0, 6.0, 0.7
"""Further growth of the pressure spike over its last change, where that is less than this part of
the one before, and where it is not."""
LARGE_GROWTH, SECOND_ORDER = 0.01, 0.35
"""Relative growth of the largest pressure on a finer grid above which its change must be less than
this part of the one before: a quarter is second order."""
UNEVEN = 1.5
"""Factor on the bars of ripples and heat fluxes, which converge less regularly: without it 95 % of
101 random contacts lie inside, as judged on grids four times as fine."""
SHARED = 0.25
"""Part of the change of the central film below which the error of the minimum is not estimated: two
coarse grids may agree on a thin minimum by chance."""
LARGEST_LOAD_ERROR = 1e-3
"""Load error accepted as balance; it changes the film by a tenth of this, relatively."""
LARGEST_CHANGE = 0.2
"""Change of pressure per cycle, in Hertz pressures, beyond which a grid is not converging. A spike
that moves by one node changes by less."""
LARGEST_ROUGH_CHANGE = 0.05
"""The same between rough surfaces, where asperities have steep pressures of their own that central
and minimum film do not show."""
LARGEST_KELVIN_CHANGE = 0.1
"""Change of temperature per cycle at any node, over the largest rise, beyond which the temperature
is not converged. Nodes at the spike change most, and matter least."""
RISE_ERROR = 0.005
"""Relative iteration error of the largest rise that is always accepted."""
LEAST_KELVIN = 0.02
"""Change of temperature [K] that is always accepted."""
TIGHTER = 100.0
"""Tolerance of the temperature over that of the film, which the temperature follows."""
MEAN_CHANGE, KELVIN_CHANGE = 1e-4, 3e-3
"""Sum of the pressure changes in a cycle over the sum of pressures, and largest change of
temperature [K], at which ``accuracy = "change"`` stops; 3 mK are 1e-5 of the inlet temperature."""
RUNAWAY = 100.0
"""Load error, and central film over that by formula or 1, beyond which no iteration recovers."""
LARGEST_ROUGH_STEP = 10.0
"""Change of pressure per cycle beyond which no iteration between rough surfaces recovers."""
STALL_CYCLES, STALL_FACTOR = 8, 0.5
"""Cycles in which the residual must fall by this factor, else the iteration has stalled."""


class DivergedError(ArithmeticError):
    """Runaway or non-finite unknowns, a failed step, or a coarser grid that is not accepted."""


def check_divergence(report: CycleReport, expected_film: float, *, rough: bool) -> None:
    """Check that an iteration may still converge.

    Raises DivergedError when residual, load error, film or, between rough surfaces, change are too
    large or NaN.
    """
    largest = RUNAWAY * max(expected_film, 1.0)
    numbers = abs(report.load_error) < RUNAWAY and report.film_central < largest
    if not (np.isfinite(report.residual) and numbers):
        raise DivergedError
    if rough and not report.change < LARGEST_ROUGH_STEP:
        raise DivergedError


@dataclass(slots=True)
class Trace:
    """One film number over the cycles on one grid."""

    values: list[float] = field(default_factory=list)
    least_rate: float = LEAST_RATE

    def iteration_error(self) -> float:
        """Estimate the change by all further cycles: d q / (1 - q), last change d, rate q.

        Changes of one sign add up: q may be as near to one as they show. Those of alternating signs
        nearly cancel.
        """
        if len(self.values) < 2:
            return float("inf")
        last = self.values[-1] - self.values[-2]
        rate = max(GUESSED_RATE, self.least_rate)
        if len(self.values) > 2:
            before = self.values[-2] - self.values[-3]
            largest = LARGEST_RATE if last * before > 0.0 else LARGEST_ALTERNATING
            rate = min(max(abs(last / before) if before else 0.0, self.least_rate), largest)
        return abs(last) * rate / (1.0 - rate)


@dataclass(slots=True)
class GridTrace:
    """Film and temperature rise over the cycles on one grid, with the reports of the cycles.

    ``measured`` has further values after the last cycle (`tehl.solver.measures`).
    ``damping`` is the damping factor of heat and thinning between rough surfaces, 1 is undamped: no
    convergence rate is below 1 - damping. ``negligible`` is the relative iteration error of the
    film that is always accepted. A grid on which the iteration ``diverged`` is not compared with
    others.
    """

    central: Trace = field(default_factory=Trace)
    minimum: Trace = field(default_factory=Trace)
    rise: Trace = field(default_factory=Trace)
    reports: list[CycleReport] = field(default_factory=list)
    measured: dict[str, float] = field(default_factory=dict)
    largest_change: float = LARGEST_CHANGE
    least_cycles: int = LEAST_CYCLES
    damping: float = 1.0
    negligible: float = 0.0
    diverged: bool = False

    def __post_init__(self) -> None:
        self.least_cycles = max(LEAST_CYCLES, math.ceil(1.0 / self.damping))
        for trace in (self.central, self.minimum, self.rise):
            trace.least_rate = max(LEAST_RATE, 1.0 - self.damping)

    def note(self, central: float, minimum: float) -> None:
        """Append the film before the first cycle."""
        self.central.values.append(central)
        self.minimum.values.append(minimum)

    def add(self, report: CycleReport) -> None:
        """Append film and temperature rise after a cycle, and its report."""
        self.reports.append(report)
        self.note(report.film_central, report.film_minimum)
        self.rise.values.append(report.temperature_rise)


def must_stop(now: GridTrace, coarser: GridTrace | None, options: Options) -> bool:
    """Whether ``options.accuracy`` ends the cycles on this grid, converged or not.

    Parameters
    ----------
    now, coarser : GridTrace
        This grid, and the next coarser one if its film is comparable, else None.
    options : Options
        Accuracy and tolerance.
    """
    if options.accuracy != "change":
        return converged(now, coarser, options)
    last = now.reports[-1]
    if len(now.reports) < now.least_cycles and now.damping < 1.0:
        return False
    small = last.mean_change <= now.damping * MEAN_CHANGE
    return small and last.temperature_change <= KELVIN_CHANGE


def converged(now: GridTrace, coarser: GridTrace | None, options: Options) -> bool:
    """Whether the cycles reached the accuracy of the options.

    Parameters
    ----------
    now, coarser, options
        As in `must_stop`.
    """
    if len(now.reports) < now.least_cycles:
        return False
    if options.accuracy == "tight":
        last = now.reports[-1]
        change = max(last.residual, last.change, abs(last.load_error)) / now.damping
        kelvin = max(abs(last.temperature_rise), 1.0) * TIGHTER * options.tolerance
        return change <= options.tolerance and last.temperature_change <= kelvin
    return film_converged(now, coarser) and temperature_converged(now, coarser)


def temperature_converged(now: GridTrace, coarser: GridTrace | None) -> bool:
    """Whether the iteration error of the largest rise is a third of its discretisation error.

    Or below `RISE_ERROR`, or below `LEAST_KELVIN`.
    """
    last = now.reports[-1]
    largest = LARGEST_KELVIN_CHANGE * abs(last.temperature_rise)
    if last.temperature_change > max(largest, LEAST_KELVIN):
        return False
    before = coarser.rise.values[-1:] if coarser else []
    # second order: a third of the change from the coarser grid
    discretisation = abs(last.temperature_rise - before[0]) / 3.0 if before else 0.0
    limit = max(discretisation / 3.0, RISE_ERROR * abs(last.temperature_rise), LEAST_KELVIN)
    return now.rise.iteration_error() <= limit


def film_converged(now: GridTrace, coarser: GridTrace | None) -> bool:
    """Whether the iteration error of the film is below a third of its discretisation error."""
    if len(now.reports) < now.least_cycles:
        return False
    last = now.reports[-1]
    if last.residual > now.reports[-2].residual:  # its changes are not errors yet
        return False
    if abs(last.load_error) > LARGEST_LOAD_ERROR or last.change > now.largest_change:
        return False
    if coarser is None:  # without a discretisation error: a change of 1e-3 Hertz pressures
        return last.change < now.damping * 1e-3
    pairs = ((now.central, coarser.central), (now.minimum, coarser.minimum))
    # discretisation error of second order: a third of the change from the coarser grid
    limit = max(abs(a.values[-1] - b.values[-1]) / 3.0 for a, b in pairs) / 3.0
    # of two numbers the one with the smaller discretisation error may take a tenth of the limit
    return all(
        a.iteration_error()
        <= max(
            abs(a.values[-1] - b.values[-1]) / 9.0, 0.1 * limit, now.negligible * abs(a.values[-1])
        )
        for a, b in pairs
    )


def stalled(now: GridTrace, patience: int = 1) -> bool:
    """Whether the residual has not halved over the last 8 ``patience`` cycles."""
    residuals, cycles = [report.residual for report in now.reports], patience * STALL_CYCLES
    if len(residuals) <= cycles:
        return False
    return residuals[-1] > STALL_FACTOR * residuals[-1 - cycles]


def error_estimate(
    traces: list[GridTrace],
    order: int,
    domain: float = 0.0,
    *,
    rough: bool = False,
    newtonian: bool = False,
) -> ErrorEstimate:
    """Estimate the relative errors of the film on the last of two or more grids.

    Parameters
    ----------
    traces : list of GridTrace
        Grids halved each time, coarsest first.
    order : {1, 2}
        Order of the wedge.
    domain : float
        Relative error from the edges of the domain [-].
    rough : bool
        Whether the grids carry heights of rough surfaces.
    newtonian : bool
        Whether the film is isothermal and Newtonian: then its traction has no bar where the spike
        is not resolved.
    """
    bars: list[float] = []
    changes: list[float] = []
    for name in ("central", "minimum"):
        values = [getattr(trace, name).values[-1] for trace in traces[-3:]]
        film = abs(values[-1]) or 1.0
        bar = (
            discretisation_bar(values, ROUGH_PART if rough else 1.0)
            if order > 1
            else first_order_bar(values)
        )
        changes.append(abs(values[-1] - values[-2]))
        if rough and changes[-1] > film:  # far from the limit
            bar = changes[-1]
        bars.append(max(bar, SHARED * changes[0]) / film)
    estimate = _estimate(traces[-1], domain, *bars)
    found = further_errors(traces, ROUGH_PART if rough else 1.0, domain)
    resolved = _resolves_spike(traces, found)
    if newtonian and not resolved:  # the stress at the spike grows with its viscosity
        found.pop("traction_mid_film", None)
    if "traction_mid_film" in found:  # the shear rate is the sliding speed over the film
        found["traction_mid_film"] = max(found["traction_mid_film"], estimate.central)
    elif _is_hottest_inside(traces[-1]) and not (resolved and _slows(_excess(traces))):
        # without sliding that is where the oil flows through the spike
        found["film_rise_max"] = max(found.get("film_rise_max", 1.0), 1.0)
    others: dict[str, Any] = found | {"spike_resolved": resolved}
    return replace(estimate, **others)


def further_errors(traces: list[GridTrace], otherwise: float, domain: float) -> dict[str, float]:
    """Return the relative error bars of the values that at least two grids have measured.

    Each is at least the last change: temperature and stress converge with the film, but less
    regularly.

    Parameters
    ----------
    traces : list of GridTrace
        Grids halved each time, coarsest first.
    otherwise : float
        As in `discretisation_bar`.
    domain : float
        Relative error from the edges of the domain [-].
    """
    found = {}
    for name, last in traces[-1].measured.items():
        values = [one.measured[name] for one in traces[-3:] if name in one.measured]
        if name in ("spike", "excess") or len(values) < 2 or last == 0.0:
            continue
        bar = max(discretisation_bar(values, otherwise), abs(values[-1] - values[-2]))
        if "rise" in name:
            bar += LEAST_KELVIN  # the cycles stop there
        if name.startswith(("ripple", "heat")):
            bar *= UNEVEN
        found[name] = abs(bar / last) + domain
    return found


def _resolves_spike(traces: list[GridTrace], errors: Mapping[str, float]) -> bool:
    """Return whether the largest pressure stays so on finer grids, but for its error bar.

    The excess of the pressure spike over Hertz may grow by as much on each finer grid (M = 75,
    L = 11: 0.17, 0.25, 0.34, 0.45, 0.55 on 65 to 1025 nodes), until the spike is the largest
    pressure, which then grows in the same way.
    """
    known, excess = [one.measured for one in traces if one.measured][-3:], _excess(traces)
    if len(known) < 2:
        return True
    largest = [one["pressure_max"] for one in known]
    change = largest[-1] - largest[-2]
    if change > LARGE_GROWTH * largest[-1] and not _slows(largest, SECOND_ORDER):
        return False
    growth = max(excess[-1] - excess[-2], 0.0)
    further = (SPIKE_GROWTH if _slows(excess) else UNRESOLVED_GROWTH) * growth
    return known[-1]["spike"] + further <= (1.0 + errors["pressure_max"]) * largest[-1]


def _is_hottest_inside(trace: GridTrace) -> bool:
    """Return whether the largest rise is in the oil, not on a surface."""
    rises = trace.measured
    surfaces = max(rises.get(f"surface_{side}_rise_max", 0.0) for side in (1, 2))
    return rises.get("film_rise_max", 0.0) > (1.0 + LARGE_GROWTH) * surfaces


def _excess(traces: list[GridTrace]) -> list[float]:
    """Return the excess of the spike over the Hertz pressure on the last grids [-]."""
    return [one.measured["excess"] for one in traces if one.measured][-3:]


def _slows(values: list[float], part: float = SLOWING) -> bool:
    """Return whether the last change of three values is less than a part of the one before."""
    return len(values) == 3 and values[2] - values[1] < part * (values[1] - values[0])


def single_grid_estimate(
    trace: GridTrace, mesh_width: float, points: float, amplitude: float, domain: float = 0.0
) -> ErrorEstimate:
    """Estimate the relative errors of the film if no coarser grid resolves the heights.

    By a rule, 1.7 h^2 / H^1.2 of the smooth film plus 20 A / (H n^2) of the waves. For ten waves
    (lengths 0.25 and 0.5, M = 57 to 500) the change of the minimum film from 257 to 513 nodes was a
    third to one and a half times the second term, mostly less than it.

    Parameters
    ----------
    trace : GridTrace
        The grid.
    mesh_width : float
        h, in Hertz half-widths.
    points : float
        n, nodes per shortest wavelength.
    amplitude : float
        A, half the range of the heights [-].
    domain : float
        Relative error from the edges of the domain [-].
    """
    bars = []
    for numbers in (trace.central, trace.minimum):
        film = abs(numbers.values[-1]) or 1.0
        smooth = SMOOTH_PART * mesh_width**2 / film**1.2
        bars.append(float(smooth + WAVE_PART * amplitude / film / points**2))
    return _estimate(trace, domain, *bars)


def _estimate(trace: GridTrace, domain: float, central: float, minimum: float) -> ErrorEstimate:
    """Return relative errors by domain and mesh together with the iteration errors of a trace."""
    iteration = [
        numbers.iteration_error() / (abs(numbers.values[-1]) or 1.0)
        for numbers in (trace.central, trace.minimum)
    ]
    return ErrorEstimate(
        discretisation_central=central,
        discretisation_minimum=minimum,
        iteration_central=iteration[0],
        iteration_minimum=iteration[1],
        domain=domain,
    )


def first_order_bar(values: list[float]) -> float:
    """Return the error bar of a scheme with a first-order wedge: twice the largest change.

    Its errors of first and of second order have opposite signs and cancel on coarse grids, so that
    the last change alone may be too small.
    """
    return 2.0 * max(abs(b - a) for a, b in pairwise(values))


def discretisation_bar(values: list[float], otherwise: float = 1.0) -> float:
    """Return the error bar of the last of two or three values on grids halved each time.

    A third of the last change, times `SAFETY`, if the three values show second order;
    ``otherwise`` times the change if not, as coarse grids may be far from their limit. If that
    change is less than a quarter of the one before, which second order would leave, two grids agree
    by chance, and the quarter counts.
    """
    change = abs(values[-1] - values[-2])
    if len(values) == 3 and min(values) > 0.3 * values[-1] > 0:
        before = abs(values[1] - values[0])
        ratio = (values[1] - values[0]) / (values[2] - values[1]) if change > 0 else math.inf
        if change < 0.3 * values[-1] and 3.0 <= ratio <= 5.6:  # 4 is second order
            return SAFETY * change / 3.0
        if before < 0.3 * values[-1]:
            return otherwise * max(change, before / 4.0)
    return otherwise * change
