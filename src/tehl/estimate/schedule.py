"""Load, motion and radius at each time step, and the distances travelled until then."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import groupby, pairwise

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.course import LARGEST_FACTOR, Course
from tehl.contact.moment import Moment, courses_of, moment_at, timeline
from tehl.contact.problem import ContactProblem
from tehl.contact.transient import MOTION
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import spin_number, spins
from tehl.estimate.ways import Way, parts_of_step, steady_way, way_of

LARGEST_PEAK_ERROR = 0.25
"""Largest error of a peak at the nearest step, over the whole change of the table."""
Ways = tuple[Way, Way, Way]
"""Of the mean motion and of both surfaces."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Schedule:
    """What a run knows of its steps before it begins."""

    step: float
    """Time step [a_x / u_m of the contact]."""
    moments: tuple[Moment, ...]
    """At the end of each step, that of the start first."""
    ways: tuple[Ways, ...] | None
    """Since the start, at the end of each step; None where all move along x at the speeds that the
    contact states."""
    spin: float = 0.0
    """Of the mean motion, over u_m/a_x."""

    @property
    def travelled(self) -> Array | None:
        """Distances of the mean motion and of both surfaces along x since the start [a_x].

        (3, steps + 1); None as of `ways`.
        """
        if self.ways is None:
            return None
        return np.array([[way.along for way in ways] for ways in self.ways]).T

    def places(self, step: int) -> tuple[Way, Way] | None:
        """Return the ways of both surfaces until a step; None as of `ways`."""
        return None if self.ways is None else self.ways[step][1:]

    def moved(self, step: int) -> tuple[Way, Way] | None:
        """Return the ways of both surfaces in a step; None as of `ways`."""
        if self.ways is None:
            return None
        (_, *now), (_, *last) = self.ways[step], self.ways[step - 1]
        first, second = (way.since(before) for way, before in zip(now, last, strict=True))
        return first, second

    def length(self, spacing: float, nodes: int) -> tuple[int, int] | None:
        """Return steps of the run, and mesh widths by which surfaces come back.

        Parameters
        ----------
        spacing, nodes : float, int
            Mesh width [a_x], and number of nodes along x: farther away heat is as at the last one.
        """
        travelled = self.travelled
        if travelled is None:
            return None
        ways = travelled[1:]
        back = np.maximum.accumulate(ways, axis=1) - ways
        return len(self.moments), min(math.ceil(float(back.max()) / spacing), nodes)

    def passed(self, step: int) -> tuple[Way, Way] | None:
        """Return the ways of the mean motion in the last step and in the last two.

        Before the start it moves as at the start; None as of `ways`.
        """
        if self.ways is None:
            return None
        mean = [ways[0] for ways in self.ways]
        before = steady_way((self.moments[0].speed, 0.0), self.spin, -self.step)
        last, farther = (mean[at] if at >= 0 else before for at in (step - 1, step - 2))
        return mean[step].since(last), mean[step].since(farther)


def schedule_of(scaled: ScaledProblem, step: float, number: int) -> Schedule:
    """Return the schedule of a run.

    Parameters
    ----------
    scaled : ScaledProblem
        A transient problem.
    step, number : float, int
        Time step [a_x / u_m], and number of steps.

    Raises
    ------
    InputError
        If a value is not possible; the message has its key and time.
    """
    problem, at = scaled.problem, timeline(scaled.problem)
    seconds = step * scaled.scales.half_width_x / scaled.scales.speed
    times = [n * seconds for n in range(number + 1)]
    _check_courses(problem, times)
    moments = tuple(map(at, times))
    if not moments[0].speed > 0.0:
        slow = 0.1 * scaled.scales.speed
        raise InputError(
            f"transient.entrainment_speed = {moments[0].speed:g} at 0 s: a run starts from a "
            f'steady film, so its first speed must be positive, such as "{slow:.2g} m/s"'
        )
    if problem.thermal is not None and not min(moments[0].speeds) > 0.0:
        both = (t for t, one in zip(times, moments, strict=True) if min(one.speeds) > 0.0)
        since = next(both, None)
        raise InputError(
            "transient: a surface stands still or moves against x at 0 s, too slow for the steady "
            "heat of its start; begin where both surfaces move along x"
            + ("" if since is None else f", as they do after {since:.3g} s")
        )
    stated = moment_at(problem.model_copy(update={"transient": None}), 0.0)
    constant = all((one.speed, one.sliding) == (stated.speed, stated.sliding) for one in moments)
    ways = None if constant and problem.motion.is_plain else _ways(scaled, at, step, times)
    return Schedule(step=step, moments=moments, ways=ways, spin=spin_number(scaled))


def _check_courses(problem: ContactProblem, times: list[float]) -> None:
    """Check what changes in a run with steps at times [s], and when its fields are kept."""
    courses, transient = courses_of(problem), problem.transient
    for key, course in courses.items():
        for time in times:
            _check(key, course.at(time), time)
    seconds = times[1] - times[0]
    check_peaks(courses, seconds)
    if transient is not None:
        _check_frames(transient.frames, times[-1], seconds)


def check_peaks(courses: Mapping[str, Course], seconds: float) -> None:
    """Check that time steps resolve the peaks of tables over time.

    Parameters
    ----------
    courses : Mapping
        What changes in time, by key of ``[transient]``.
    seconds : float
        Time step [s].

    Raises
    ------
    InputError
        If a peak lies between two steps.
    """
    for key, course in courses.items():
        levels = plateaus(course.table)
        values = [value for *_, value in levels]
        change = max(values, default=0.0) - min(values, default=0.0)
        for before, (first, last, value), after in zip(
            levels, levels[1:], levels[2:], strict=False
        ):
            turns = (value - before[2]) * (value - after[2]) > 0
            steps = [round(time / seconds) * seconds for time in (first, last)]
            seen = math.ceil(first / seconds) * seconds <= last
            missed = min(abs(value - course.at(time)) for time in steps)
            if turns and not seen and missed > LARGEST_PEAK_ERROR * change:
                raise InputError(
                    f"transient.{key} = {value:g} at {first:g} s: a peak between two time steps of "
                    f"{seconds:.3g} s, which do not resolve it; take more numerics.points, or a "
                    "longer peak"
                )


def plateaus(table: tuple[tuple[float, float], ...]) -> list[tuple[float, float, float]]:
    """Return start, end and value of each constant part of a table of times and values."""
    parts = (list(part) for _, part in groupby(table, key=lambda row: row[1]))
    return [(part[0][0], *part[-1]) for part in parts]


def _check_frames(frames: int | tuple[float, ...], end: float, seconds: float) -> None:
    """Check that stated times of fields are within a run, whose end and time step are in [s]."""
    late = [] if isinstance(frames, int) else [one for one in frames if one > end + 0.5 * seconds]
    if late:
        raise InputError(
            f"transient.frames = {late[0]:g} s: after the end of the run at {end:.4g} s"
        )


def _check(key: str, value: float, time: float) -> None:
    """Check a value of a formula or table, over that of the contact."""
    is_possible = math.isfinite(value) and (key in MOTION or value > 0.0)
    if not (is_possible and abs(value) <= LARGEST_FACTOR):
        what = "finite" if key in MOTION else "positive"
        raise InputError(
            f"transient.{key} = {value:g} at {time:.4g} s: must be {what} and at most "
            f"{LARGEST_FACTOR:g} times that of the contact"
        )


def _ways(
    scaled: ScaledProblem, at: Callable[[float], Moment], step: float, times: list[float]
) -> tuple[Ways, ...]:
    """Return the ways of `Schedule` for steps [a_x / u_m] at times [s]."""
    turning, parts = spins(scaled), parts_of_step()
    ways = [(Way(0.0), Way(0.0), Way(0.0))]
    for start, end in pairwise(times):
        moving = (at(start + part * (end - start)).velocities for part in parts)
        gained = (
            way_of(velocities, spin, step)
            for velocities, spin in zip(zip(*moving, strict=True), turning, strict=True)
        )
        mean, first, second = (more.after(way) for more, way in zip(gained, ways[-1], strict=True))
        ways.append((mean, first, second))
    return tuple(ways)
