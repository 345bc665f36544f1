"""When to stop: estimated iteration and discretisation errors of the film, stall, divergence."""

import math
from dataclasses import dataclass, field
from itertools import pairwise

from tehl.options import Options
from tehl.result import CycleReport, ErrorEstimate

LEAST_CYCLES = 2
LEAST_RATE, GUESSED_RATE, LARGEST_RATE = 0.2, 0.3, 0.8
"""Convergence rates per cycle that iteration errors are estimated with."""
SAFETY = 2.0
"""Factor on the discretisation error where three grids show its order: the coarser ones are not
iterated to the end."""
ROUGH_PART = 0.7
"""Error over the last change of the film between grids that all resolve the heights: a third if of
second order; measured up to 0.65 for the minimum film between waves (87 of them, 257 and 513
nodes)."""
SMOOTH_PART, WAVE_PART = 1.7, 20.0
"""Factors of the two parts of `single_grid_estimate`."""
SHARED = 0.25
"""Least part of the change of the central film that a minimum is uncertain by: two coarse grids may
agree on a thin minimum by chance."""
LARGEST_LOAD_ERROR = 1e-3
"""Load error at which the film is taken for balanced; it changes by a tenth of this, relatively."""
LARGEST_CHANGE = 0.2
"""Change of pressure per cycle, in Hertz pressures, beyond which a grid is in disorder: a spike
that shifts by a node changes by less."""
LARGEST_ROUGH_CHANGE = 0.05
"""The same between rough surfaces: asperities carry steep pressures of their own, and central and
minimum film say little of the others."""
RESTLESS = 0.1
"""Change of temperature per cycle, at any node and over the largest rise, beyond which a film is
not heated yet, whatever the rise does: nodes at the spike change most, and matter least."""
HEATED = 0.005
"""Iteration error of the largest rise, relatively, that never counts."""
LEAST_KELVIN = 0.02
"""Change of temperature [K] that never counts."""
TIGHTER = 100.0
"""Factor between the tolerance of the film and that of the temperature rise, which follows it."""
MEAN_CHANGE, KELVIN_CHANGE = 1e-4, 3e-3
"""Sum of the changes of pressure by a cycle over the sum of pressures, and largest change of
temperature [K], at which ``accuracy = "change"`` stops; 3 mK are 1e-5 of the inlet temperature."""
STALL_CYCLES = 8
STALL_FACTOR = 0.5


@dataclass(slots=True)
class Trace:
    """A film number as it changes from cycle to cycle on one grid."""

    values: list[float] = field(default_factory=list)
    least_rate: float = LEAST_RATE

    def iteration_error(self) -> float:
        """Estimate what further cycles would still change, from the last two changes."""
        if len(self.values) < 2:
            return float("inf")
        last = abs(self.values[-1] - self.values[-2])
        rate = max(GUESSED_RATE, self.least_rate)
        if len(self.values) > 2:
            before = abs(self.values[-2] - self.values[-3])
            rate = min(max(last / before if before > 0 else 0.0, self.least_rate), LARGEST_RATE)
        return last * rate / (1.0 - rate)


@dataclass(slots=True)
class GridTrace:
    """Film and temperature rise on one grid, cycle by cycle, and the reports of the cycles."""

    central: Trace = field(default_factory=Trace)
    minimum: Trace = field(default_factory=Trace)
    rise: Trace = field(default_factory=Trace)
    reports: list[CycleReport] = field(default_factory=list)
    largest_change: float = LARGEST_CHANGE
    least_cycles: int = LEAST_CYCLES
    follow: float = 1.0

    def damp(self, follow: float) -> None:
        """Take into account that heat and thinning act on the flow by a part per cycle only."""
        self.follow = follow
        self.least_cycles = max(LEAST_CYCLES, math.ceil(1.0 / follow))
        for trace in (self.central, self.minimum, self.rise):
            trace.least_rate = max(LEAST_RATE, 1.0 - follow)

    def note(self, central: float, minimum: float) -> None:
        """Append the film before the first cycle."""
        self.central.values.append(central)
        self.minimum.values.append(minimum)

    def add(self, report: CycleReport) -> None:
        """Append film and temperature rise after a cycle, and its report."""
        self.reports.append(report)
        self.note(report.film_central, report.film_minimum)
        self.rise.values.append(report.temperature_rise)


def ended(now: GridTrace, coarser: GridTrace | None, options: Options) -> bool:
    """Whether the options stop the cycles on this grid here, converged or not."""
    if options.accuracy != "change":
        return converged(now, coarser, options)
    last = now.reports[-1]
    if len(now.reports) < now.least_cycles and now.follow < 1.0:
        return False
    return last.mean_change <= now.follow * MEAN_CHANGE and last.temperature_change <= KELVIN_CHANGE


def converged(now: GridTrace, coarser: GridTrace | None, options: Options) -> bool:
    """Whether the cycles on this grid have done what the options ask for."""
    if len(now.reports) < now.least_cycles:
        return False
    if options.accuracy == "tight":
        last = now.reports[-1]
        change = max(last.residual, last.change, abs(last.load_error)) / now.follow
        settled = change <= options.tolerance
        kelvin = max(last.temperature_rise, 1.0) * TIGHTER * options.tolerance
        return settled and last.temperature_change <= kelvin
    return iterated_enough(now, coarser) and heated_enough(now, coarser)


def heated_enough(now: GridTrace, coarser: GridTrace | None) -> bool:
    """Whether the largest rise of the temperature is as well known as the film, or well enough."""
    last = now.reports[-1]
    if last.temperature_change > max(RESTLESS * last.temperature_rise, LEAST_KELVIN):
        return False
    before = coarser.rise.values[-1:] if coarser else []
    discretisation = abs(last.temperature_rise - before[0]) / 3.0 if before else 0.0
    limit = max(discretisation / 3.0, HEATED * last.temperature_rise, LEAST_KELVIN)
    return now.rise.iteration_error() <= limit


def iterated_enough(now: GridTrace, coarser: GridTrace | None) -> bool:
    """Whether the iteration error is below a third of the discretisation error."""
    if len(now.reports) < now.least_cycles:
        return False
    if coarser is None:
        return now.reports[-1].change < now.follow * 1e-3
    pairs = ((now.central, coarser.central), (now.minimum, coarser.minimum))
    last = now.reports[-1]
    if last.residual > now.reports[-2].residual:
        return False
    if abs(last.load_error) > LARGEST_LOAD_ERROR or last.change > now.largest_change:
        return False
    limit = max(abs(a.values[-1] - b.values[-1]) / 3.0 for a, b in pairs) / 3.0
    return all(
        a.iteration_error() <= max(abs(a.values[-1] - b.values[-1]) / 9.0, 0.1 * limit)
        for a, b in pairs
    )


def stalled(now: GridTrace, patience: int = 1) -> bool:
    """Whether the residual has not halved over the last cycles, ``patience`` times as many."""
    residuals, cycles = [report.residual for report in now.reports], patience * STALL_CYCLES
    if len(residuals) <= cycles:
        return False
    return residuals[-1] > STALL_FACTOR * residuals[-1 - cycles]


def error_estimate(traces: list[GridTrace], order: int, *, rough: bool = False) -> ErrorEstimate:
    """Return relative errors of the film on the last of two or more grids, for a wedge order."""
    parts: list[tuple[float, float]] = []
    changes: list[float] = []
    for name in ("central", "minimum"):
        sequence = [getattr(trace, name) for trace in traces[-3:]]
        value = abs(sequence[-1].values[-1]) or 1.0
        values = [trace.values[-1] for trace in sequence]
        bar = (
            discretisation_bar(values, ROUGH_PART if rough else 1.0)
            if order > 1
            else first_order_bar(values)
        )
        changes.append(abs(values[-1] - values[-2]))
        if rough and changes[-1] > value:  # not near the limit yet
            bar = changes[-1]
        bar = max(bar, SHARED * changes[0])
        parts.append((bar / value, sequence[-1].iteration_error() / value))
    return ErrorEstimate(
        discretisation_central=parts[0][0],
        discretisation_minimum=parts[1][0],
        iteration_central=parts[0][1],
        iteration_minimum=parts[1][1],
    )


def single_grid_estimate(
    trace: GridTrace, mesh_width: float, points: float, amplitude: float
) -> ErrorEstimate:
    """Return relative errors of the film where no coarser grid has the same heights.

    The part of the smooth film, and a rule for that of a wave of ``points`` nodes and of some
    ``amplitude``: between ten waves (lengths 0.25 and 0.5, M = 57 to 500) the minimum film changed
    from 257 to 513 nodes by a third of that to one and a half times as much, mostly by less.
    """
    parts: list[tuple[float, float]] = []
    for numbers in (trace.central, trace.minimum):
        film = abs(numbers.values[-1]) or 1.0
        smooth = SMOOTH_PART * mesh_width**2 / film**1.2
        bar = float(smooth + WAVE_PART * amplitude / film / points**2)
        parts.append((bar, numbers.iteration_error() / film))
    return ErrorEstimate(
        discretisation_central=parts[0][0],
        discretisation_minimum=parts[1][0],
        iteration_central=parts[0][1],
        iteration_minimum=parts[1][1],
    )


def first_order_bar(values: list[float]) -> float:
    """Return the error bar of a scheme with a first-order wedge: twice the largest change.

    Its error of first order and that of second order have opposite signs and cancel on coarse
    grids, so that the last change alone says too little.
    """
    return 2.0 * max(abs(b - a) for a, b in pairwise(values))


def discretisation_bar(values: list[float], otherwise: float = 1.0) -> float:
    """Return the error bar of the last of two or three values on grids halved each time.

    A third of the last change, with a safety factor, where the three values show second order;
    ``otherwise`` times the change where they do not: coarse grids may be far from their limit. If
    it is less than a quarter of the change before, which second order would leave, two grids
    agree by chance, and that quarter counts.
    """
    change = abs(values[-1] - values[-2])
    if len(values) == 3 and min(values) > 0.3 * values[-1] > 0:
        before = abs(values[1] - values[0])
        ratio = (values[1] - values[0]) / (values[2] - values[1]) if change > 0 else math.inf
        if change < 0.3 * values[-1] and 3.0 <= ratio <= 5.6:
            return SAFETY * change / 3.0
        if before < 0.3 * values[-1]:
            return otherwise * max(change, before / 4.0)
    return otherwise * change
