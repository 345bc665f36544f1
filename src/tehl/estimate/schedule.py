"""Load, motion and radius at each time step, and the distances travelled until then."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.course import LARGEST_FACTOR
from tehl.contact.moment import Moment, courses_of, moment_at, timeline
from tehl.contact.transient import MOTION
from tehl.estimate.scaling import ScaledProblem

NODES_PER_STEP = 4
"""Nodes of Gauss per step for the distances: their error is of eighth order in the step."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Schedule:
    """What a run knows of its steps before it begins."""

    step: float
    """Time step [a_x / u_m of the contact]."""
    moments: tuple[Moment, ...]
    """At the end of each step, that of the start first."""
    travelled: Array | None
    """Distances of the mean motion and of both surfaces since the start, (3, steps + 1) [a_x]; None
    where all move as the contact states."""

    def places(self, step: int) -> tuple[float, float] | None:
        """Return the distances of both surfaces until a step [a_x]; None if of constant speeds."""
        if self.travelled is None:
            return None
        return float(self.travelled[1, step]), float(self.travelled[2, step])

    def moved(self, step: int) -> tuple[float, float] | None:
        """Return the distances of both surfaces in a step [a_x]; None if of constant speeds."""
        if self.travelled is None:
            return None
        first, second = self.travelled[1:, step] - self.travelled[1:, step - 1]
        return float(first), float(second)

    def length(self, spacing: float, nodes: int) -> tuple[int, int] | None:
        """Return steps of the run, and mesh widths by which surfaces come back.

        Parameters
        ----------
        spacing, nodes : float, int
            Mesh width [a_x], and number of nodes along x: farther away heat is as at the last one.
        """
        if self.travelled is None:
            return None
        ways = self.travelled[1:]
        back = np.maximum.accumulate(ways, axis=1) - ways
        return len(self.moments), min(math.ceil(float(back.max()) / spacing), nodes)

    def passed(self, step: int) -> tuple[float, float] | None:
        """Return the distances of the mean motion in the last step and in the last two [a_x].

        Before the start it moves as at the start; None if it always moves as the contact states.
        """
        if self.travelled is None:
            return None
        mean, before = self.travelled[0], -self.moments[0].speed * self.step
        last, farther = (mean[at] if at >= 0 else before for at in (step - 1, step - 2))
        return float(mean[step] - last), float(mean[step] - farther)


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
    for key, course in courses_of(problem).items():
        for time in times:
            _check(key, course.at(time), time)
    moments = tuple(map(at, times))
    if not moments[0].speed > 0.0:
        raise InputError(
            f"transient.entrainment_speed = {moments[0].speed:g} at 0 s: a run starts from a "
            "steady film, so its first speed must be positive"
        )
    if problem.thermal is not None and not min(moments[0].speeds) > 0.0:
        raise InputError(
            "transient: a surface stands still or moves against x at 0 s, too slow for the steady "
            "heat of its start; begin where both surfaces move along x"
        )
    stated = moment_at(problem.model_copy(update={"transient": None}), 0.0)
    constant = all((one.speed, one.sliding) == (stated.speed, stated.sliding) for one in moments)
    travelled = None if constant else _travelled(at, step, times)
    return Schedule(step=step, moments=moments, travelled=travelled)


def _check(key: str, value: float, time: float) -> None:
    """Check a value of a formula or table, over that of the contact."""
    is_possible = math.isfinite(value) and (key in MOTION or value > 0.0)
    if not (is_possible and abs(value) <= LARGEST_FACTOR):
        what = "finite" if key in MOTION else "positive"
        raise InputError(
            f"transient.{key} = {value:g} at {time:.4g} s: must be {what} and at most "
            f"{LARGEST_FACTOR:g} times that of the contact"
        )


def _travelled(at: Callable[[float], Moment], step: float, times: list[float]) -> Array:
    """Return the distances of `Schedule.travelled` for steps [a_x / u_m] at times [s]."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES_PER_STEP)
    gained = np.zeros((3, len(times)))
    for n, (start, end) in enumerate(pairwise(times), 1):
        for node, weight in zip(0.5 * (nodes + 1.0), 0.5 * weights, strict=True):
            moment = at(start + node * (end - start))
            gained[:, n] += weight * step * np.array([moment.speed, *moment.speeds])
    return np.asarray(np.cumsum(gained, axis=1))
