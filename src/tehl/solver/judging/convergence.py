"""Stopping criteria of the cycles.

Full multigrid has solved the coarser grids anyway, so the discretisation error follows from the
difference of two grids, and cycles below it are wasted (Brandt 1977; docs/theory/numerics.md on
stopping and errors).
"""

import math
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from tehl.contact.options import Options
from tehl.result.solution import CycleReport
from tehl.solver.judging.extrapolation import Outputs

LEAST_CYCLES = 2
"""Least cycles of a grid, and of a time step."""
LEAST_CONVERGENCE_RATE, GUESSED_RATE, LARGEST_CONVERGENCE_RATE, LARGEST_ALTERNATING = (
    0.2,
    0.3,
    0.95,
    0.8,
)
"""Least convergence rate per cycle in iteration errors, its value from one change, and its largest
value where changes have the same sign, and where they alternate."""
SECOND_RATE, SECOND_LOAD = 0.45, 1e3
"""Least rate after two cycles, of which the first mostly removes errors of the interpolated start,
and the load M from which it is assumed: without it films of bearings (M = 5,000) that end there err
by 0.3 to 0.4 %, six to ten times their iteration errors, and by two of their bars once they are
extrapolated. Heat follows the film later (a surface at rest: 3 % after two cycles). An isothermal
circle (M = 20) errs by 0.007 %, the estimate."""
SLOW_CONVERGENCE_RATE, SLOW_CYCLES = 0.8, 8
"""Ratio of residuals above which cycles are slow, and how many these are at least: the film hardly
changes in one of them, and two grids that are as far from their solutions agree by chance."""
LARGEST_LOAD_ERROR = 1e-3
"""Load error accepted as balance; it changes the film by a tenth of this, relatively."""
LARGEST_CYCLE_CHANGE = 0.2
"""Change of pressure per cycle, in Hertz pressures, beyond which a grid is not converging. A spike
that moves by one node changes by less."""
LARGEST_ROUGH_CHANGE = 0.05
"""The same between rough surfaces, where asperities have steep pressures of their own that central
and minimum film do not show."""
LARGEST_KELVIN_CHANGE = 0.1
"""Change of temperature per cycle at any node, over the largest rise, beyond which the temperature
is not converged. Nodes at the spike change most, and matter least."""
SHARE_ERROR = 2e-3
"""Iteration error of the part of the load where surfaces touch that is always accepted [-]: a
twentieth of the least error bar of it, of random and grooved surfaces on 257 nodes 0.04 to 0.14."""
SHARE_CYCLES = (4, 8)
"""Cycles over which a share that creeps is followed: single nodes change from one to the next."""
CREEP_CYCLES = 4
"""The same of a film that small steps change by small and large amounts in turn."""
RISE_ERROR = 0.005
"""Relative iteration error of the largest rise that is always accepted."""
LEAST_KELVIN = 0.02
"""Change of temperature [K] that is always accepted."""
KELVIN_TOLERANCE_FACTOR = 100.0
"""Tolerance of the temperature over that of the film, which the temperature follows."""
MEAN_CHANGE, KELVIN_CHANGE = 1e-4, 3e-3
"""Sum of the pressure changes in a cycle over the sum of pressures, and largest change of
temperature [K], at which ``accuracy = "change"`` stops; 3 mK are 1e-5 of the inlet temperature."""
RUNAWAY = 100.0
"""Load error, and central film over that by formula or 1, beyond which no iteration recovers."""
ROUNDING_CHANGE = 1e-12
"""Relative iteration error of the film that is rounding: a boundary film is the same on all."""
STALL_CYCLES, STALL_FACTOR = 8, 0.5
"""Cycles in which the residual must fall by this factor, else the iteration has stalled."""
RECEDING, LEAST_RECEDING = 2, 5
"""Successive cycles in which the residual grows that end a strategy if another one follows; and
cycles after which one above that of the first cycle does. In 180 contacts of machines three finest
grids end so, of which none converges in up to 12 cycles more."""
DOUBTFUL_RATE, DOUBTFUL_CHANGE = 0.75, 0.01
"""Least convergence rate per cycle in the iteration errors of a film whose residual does not fall,
and largest change of its pressure, in Hertz pressures: single nodes may grow where the film rests.
The film of an ellipse with spin (M = 258, 1281 x 1281 nodes) whose cycles recede errs by 0.03 %, a
tenth of the iteration error with that rate."""


class TimeIsOverError(Exception):
    """The time of a solve is over before a cycle."""


class DivergedError(ArithmeticError):
    """Runaway or non-finite unknowns, a failed step, or a coarser grid that is not accepted."""


def check_divergence(report: CycleReport, expected_film: float, largest_step: float) -> None:
    """Check that an iteration may still converge.

    Parameters
    ----------
    report : CycleReport
        Of the last cycle.
    expected_film : float
        Central film H; `RUNAWAY` times it is too thick.
    largest_step : float
        Change of a pressure beyond which no iteration recovers, in Hertz pressures.

    Raises
    ------
    DivergedError
        If residual, load error, film or change are too large or NaN.
    """
    largest = RUNAWAY * max(expected_film, 1.0)
    numbers = abs(report.load_error) < RUNAWAY and report.film_central < largest
    if not (np.isfinite(report.residual) and numbers and report.change < largest_step):
        raise DivergedError


@dataclass(slots=True)
class Trace:
    """One film number over the cycles on one grid."""

    values: list[float] = field(default_factory=list)
    least_rate: float = LEAST_CONVERGENCE_RATE
    second_rate: float = 0.0
    alternates: bool = False

    def iteration_error(self) -> float:
        """Estimate the change by all further cycles: d q / (1 - q), last change d, rate q.

        Changes of one sign add up: q may be as near to one as they show. Those of alternating signs
        nearly cancel. Where large and small changes alternate, d is the larger of the last two.
        """
        if len(self.values) < 2:
            return float("inf")
        last = self.values[-1] - self.values[-2]
        rate = max(GUESSED_RATE, self.least_rate)
        if len(self.values) > 2:
            before = self.values[-2] - self.values[-3]
            largest = LARGEST_CONVERGENCE_RATE if last * before > 0.0 else LARGEST_ALTERNATING
            least = max(self.least_rate, self.second_rate if len(self.values) == 3 else 0.0)
            rate = min(max(abs(last / before) if before else 0.0, least), largest)
            last = max(abs(last), abs(before)) if self.alternates else last
        error = abs(last) * rate / (1.0 - rate)
        return max(error, self.creep(CREEP_CYCLES)) if self.alternates else error

    def swing(self) -> float:
        """Estimate the same of a number that swings about its limit: by the larger change at most.

        The limit of changes that alternate lies between the last values.
        """
        error, last = self.iteration_error(), self.values[-3:]
        if len(last) < 3 or not (last[2] - last[1]) * (last[1] - last[0]) < 0.0:
            return error
        return min(error, max(abs(last[2] - last[1]), abs(last[1] - last[0])))

    def creep(self, cycles: int) -> float:
        """Estimate the same by changes over some ``cycles`` each; zero if they alternate."""
        if len(self.values) <= 2 * cycles:
            return 0.0
        first, middle, last = self.values[-1 - 2 * cycles :: cycles]
        before, change = middle - first, last - middle
        if not before * change > 0.0:
            return 0.0
        rate = min(change / before, LARGEST_CONVERGENCE_RATE**cycles)
        return abs(change) * rate / (1.0 - rate)


@dataclass(frozen=True, slots=True)
class Criteria:
    """What is known of the cycles on a grid before the first one, and accepted of their changes.

    ``damping`` is the damping factor of heat and thinning between rough surfaces, 1 is undamped: no
    convergence rate is below 1 - damping, or below ``rate``, or after two cycles ``second_rate``.
    With a ``rate``, that of small steps, large and small changes alternate: the minimum of an outer
    ring (M = 21,000), 0.57 % from its limit, changed by 0.44 and then by 0.12 %.
    ``negligible`` is the relative iteration error of the film that is always accepted. Without a
    coarser film to compare, a mean change of ``steady`` is accepted: where surfaces touch, single
    nodes change by more, and ``largest_change`` is that of the mean. Fields to extrapolate have an
    iteration error that may be ``part`` of what it may be without. The residual of cycles that are
    ``doubtful`` may grow.
    """

    largest_change: float = LARGEST_CYCLE_CHANGE
    damping: float = 1.0
    rate: float = 0.0
    second_rate: float = 0.0
    negligible: float = 0.0
    steady: float = 0.0
    part: float = 1.0
    doubtful: bool = False

    @property
    def least_rate(self) -> float:
        """Least convergence rate per cycle, by damping and small steps [-]."""
        return max(self.rate, 1.0 - self.damping)

    @property
    def least_cycles(self) -> int:
        """Least cycles before the film may have converged."""
        return max(LEAST_CYCLES, math.ceil(1.0 / (1.0 - self.least_rate)))

    def doubted(self) -> "Criteria":
        """Return the same of cycles whose residual does not fall: their changes hide errors."""
        change = min(self.largest_change, DOUBTFUL_CHANGE)
        rate = max(self.rate, DOUBTFUL_RATE)
        return replace(self, largest_change=change, rate=rate, doubtful=True)


@dataclass(slots=True)
class GridTrace:
    """Film, temperature rise and share of contact over the cycles on one grid, with their reports.

    ``measured`` has further values after the last cycle (`tehl.solver.judging.measures`), and
    ``outputs`` are the fields to extrapolate. A grid on which the iteration ``diverged`` is not
    compared with others. ``coupled`` says whether the film is heated or thins on this grid.
    ``columns`` are its nodes along x. In the last cycle heat may have ``rested``.
    """

    criteria: Criteria = field(default_factory=Criteria)
    central: Trace = field(default_factory=Trace)
    minimum: Trace = field(default_factory=Trace)
    rise: Trace = field(default_factory=Trace)
    touching: Trace = field(default_factory=Trace)
    reports: list[CycleReport] = field(default_factory=list)
    measured: dict[str, float] = field(default_factory=dict)
    diverged: bool = False
    outputs: Outputs | None = None
    coupled: bool = False
    columns: int = 0
    rested: bool = False

    def __post_init__(self) -> None:
        known = self.criteria
        for trace in (self.central, self.minimum, self.rise, self.touching):
            trace.least_rate = max(LEAST_CONVERGENCE_RATE, known.least_rate)
            trace.second_rate, trace.alternates = known.second_rate, known.rate > 0.0

    def note(self, central: float, minimum: float) -> None:
        """Append the film before the first cycle.

        Parameters
        ----------
        central, minimum : float
            Film H of the interpolated start [-].
        """
        self.central.values.append(central)
        self.minimum.values.append(minimum)

    def add(self, report: CycleReport, touching: float = 0.0, *, rests: bool = False) -> None:
        """Append film, temperature rise and the part of the load in contact after a cycle.

        The cycle after one whose heat rests continues that one: its film has met the same heat, and
        a change that is small for that reason says nothing of what heat has still to change.

        Parameters
        ----------
        report : CycleReport
            Of the cycle.
        touching : float
            Part of the load where surfaces touch [-].
        rests : bool
            Whether no sweep of the energy equation has followed the cycle.
        """
        if self.rested:
            for film in (self.central, self.minimum):
                film.values.pop()
        if rests and self.rise.values:
            self.rise.values.pop()
        self.rested = rests
        self.reports.append(report)
        self.touching.values.append(touching)
        self.note(report.film_central, report.film_minimum)
        self.rise.values.append(report.temperature_rise)

    def doubted(self) -> "GridTrace":
        """Return the same cycles with the criteria of those whose residual does not fall."""
        names = ("central", "minimum", "rise", "touching")
        films = {name: replace(getattr(self, name)) for name in names}
        return replace(self, criteria=self.criteria.doubted(), **films)


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
    if len(now.reports) < now.criteria.least_cycles and now.criteria.damping < 1.0:
        return False
    small = last.mean_change <= now.criteria.damping * MEAN_CHANGE
    return small and last.temperature_change <= KELVIN_CHANGE


def temperature_scale(report: CycleReport) -> float:
    """Return the tolerance of the temperature over that of the film [K]."""
    return max(abs(report.temperature_rise), 1.0) * KELVIN_TOLERANCE_FACTOR


def converged(now: GridTrace, coarser: GridTrace | None, options: Options) -> bool:
    """Whether the cycles reached the accuracy of the options.

    Parameters
    ----------
    now, coarser, options
        As in `must_stop`.
    """
    if len(now.reports) < now.criteria.least_cycles:
        return False
    if options.accuracy == "tight":
        last = now.reports[-1]
        change = max(last.residual, last.change, abs(last.load_error)) / now.criteria.damping
        kelvin = temperature_scale(last) * options.tolerance
        return change <= options.tolerance and last.temperature_change <= kelvin
    return film_converged(now, coarser) and temperature_converged(now, coarser)


def temperature_converged(now: GridTrace, coarser: GridTrace | None) -> bool:
    """Whether the iteration error of the largest rise is a third of its discretisation error.

    Or below `RISE_ERROR`, or below `LEAST_KELVIN`.

    Parameters
    ----------
    now : GridTrace
        Cycles on this grid.
    coarser : GridTrace or None
        Of the grid before, for the discretisation error; None on the first grid.
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
    """Whether the iteration error of the film is below a third of its discretisation error.

    Parameters
    ----------
    now : GridTrace
        Cycles on this grid.
    coarser : GridTrace or None
        Of the grid before, for the discretisation error; None on the first grid.
    """
    if len(now.reports) < now.criteria.least_cycles:
        return False
    last = now.reports[-1]
    least = SLOW_CONVERGENCE_RATE if len(now.reports) < SLOW_CYCLES else 1.0
    may_grow = now.criteria.doubtful or last.change <= ROUNDING_CHANGE
    if not may_grow and last.residual > least * now.reports[-2].residual:
        return False  # its changes are not errors yet
    change = last.mean_change if now.criteria.steady else last.change
    if abs(last.load_error) > LARGEST_LOAD_ERROR or change > now.criteria.largest_change:
        return False
    if coarser is None:  # without a discretisation error: a change of 1e-3 Hertz pressures
        return last.change < now.criteria.damping * 1e-3 or last.mean_change < now.criteria.steady
    pairs = ((now.central, coarser.central), (now.minimum, coarser.minimum))
    # discretisation error of second order: a third of the change from the coarser grid
    limit = max(abs(a.values[-1] - b.values[-1]) / 3.0 for a, b in pairs) / 3.0
    if not touching_converged(now, coarser):
        return False
    # of two numbers the one with the smaller discretisation error may take a tenth of the limit
    return all(
        a.iteration_error()
        <= max(
            now.criteria.part * max(abs(a.values[-1] - b.values[-1]) / 9.0, 0.1 * limit),
            max(now.criteria.negligible, ROUNDING_CHANGE) * abs(a.values[-1]),
        )
        for a, b in pairs
    )


def touching_converged(now: GridTrace, coarser: GridTrace) -> bool:
    """Whether the iteration error of the share of contact is a third of its discretisation error.

    Or below `SHARE_ERROR`.

    Parameters
    ----------
    now, coarser : GridTrace
        This grid, and the next coarser one.
    """
    shares, before = now.touching, coarser.touching.values[-1:]
    # second order: a third of the change from the coarser grid
    discretisation = abs(shares.values[-1] - before[0]) / 3.0 if before else 0.0
    error = max(shares.swing(), *map(shares.creep, SHARE_CYCLES))
    if len(shares.values) > LEAST_CYCLES:  # where it oscillates, a change may be small by chance
        error = max(error, Trace(shares.values[:-1], shares.least_rate).swing())
    return error <= max(discretisation / 3.0, SHARE_ERROR)


def stalled(now: GridTrace, patience: float = 1) -> bool:
    """Whether the residual has not halved over the last cycles, and no contact spreads.

    Parameters
    ----------
    now : GridTrace
        Cycles on this grid.
    patience : float
        Factor on the 8 cycles that are considered.
    """
    residuals, cycles = [report.residual for report in now.reports], patience * STALL_CYCLES
    if len(residuals) <= cycles or max(map(now.touching.creep, SHARE_CYCLES)) > SHARE_ERROR:
        return False
    return residuals[-1] > STALL_FACTOR * residuals[-1 - int(cycles)]


def recedes(now: GridTrace) -> bool:
    """Whether the residual has grown in the last two cycles, or in all: it will hardly fall.

    No film of 60 contacts whose cycles recede on the finest grid converges by the same cycles.

    Parameters
    ----------
    now : GridTrace
        Cycles on this grid.
    """
    residuals = [report.residual for report in now.reports]
    rises = [after > before for before, after in pairwise(residuals[-RECEDING - 1 :])]
    grown = len(residuals) >= LEAST_RECEDING and residuals[-1] > residuals[0]
    return grown or (len(rises) == RECEDING and all(rises))
