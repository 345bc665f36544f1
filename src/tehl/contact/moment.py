"""Load, motion and radius of a contact at one moment, over those that it states."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from tehl.base.units import Force, ForcePerLength, Length, Number, quantity
from tehl.contact.bodies import direction
from tehl.contact.course import SIGNED_SPEED, Course, Stated, course_of
from tehl.contact.point_contact import PointContact

Problem = TypeVar("Problem", bound=PointContact)

SLIDING = {"slide_roll_ratio", "sliding_speed"}
"""Keys of the sliding."""
SAMPLES = 200
"""Intervals in which a run is sampled before it begins."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Moment:
    """What changes in time, over the load, entrainment speed and radius of ``[contact]``."""

    load: float = 1.0
    speed: float = 1.0
    """Entrainment speed; negative against x."""
    sliding: float = 0.0
    across: float = 0.0
    """u_1 - u_2 along x and along y at the centre, over the entrainment speed of ``[contact]``."""
    curvature: float = 1.0
    """1/R_x."""

    @property
    def is_possible(self) -> bool:
        """Whether load and radius are positive numbers."""
        return 0.0 < self.load < math.inf and 0.0 < self.curvature < math.inf

    @property
    def speeds(self) -> tuple[float, float]:
        """Speeds of both surfaces along x over the entrainment speed of ``[contact]``."""
        return self.speed + 0.5 * self.sliding, self.speed - 0.5 * self.sliding

    @property
    def velocities(self) -> tuple[tuple[float, float], tuple[float, float], tuple[float, float]]:
        """Velocities of the mean motion and of both surfaces at the centre, over that speed."""
        (first, second), half = self.speeds, 0.5 * self.across
        return (self.speed, 0.0), (first, half), (second, -half)


STEADY = Moment()
"""That of a contact in which nothing changes, without sliding."""


def moment_at(problem: PointContact, time: float) -> Moment:
    """Return the moment of a contact at a time since the start [s].

    Parameters
    ----------
    problem : PointContact
        Without ``transient`` nothing changes.
    time : float
        Since the start [s].
    """
    return timeline(problem)(time)


def timeline(problem: PointContact) -> Callable[[float], Moment]:
    """Return the function from times since the start [s] to the moments of a contact."""
    courses, ratio = courses_of(problem), problem.slide_roll_ratio
    along, across = direction(problem.contact.sliding_angle)
    load, speed, radius, sliding, slip = (
        courses[key].at if key in courses else None
        for key in ("load", "entrainment_speed", "radius", "sliding_speed", "slide_roll_ratio")
    )

    def at(time: float) -> Moment:
        mean = speed(time) if speed else 1.0
        slid = sliding(time) if sliding else (slip(time) if slip else ratio) * mean
        return Moment(
            load=load(time) if load else 1.0,
            speed=mean,
            sliding=along * slid,
            across=across * slid,
            curvature=1.0 / (radius(time) or math.nan) if radius else 1.0,
        )

    return at


def moments_of(problem: PointContact, duration: float) -> list[Moment]:
    """Return the moments of a run at `SAMPLES` times.

    Parameters
    ----------
    problem : PointContact
        With a ``transient`` table.
    duration : float
        Of the run [s].
    """
    at = timeline(problem)
    return [at(duration * n / SAMPLES) for n in range(SAMPLES + 1)]


def frozen(problem: Problem, moment: Moment) -> Problem:
    """Return the steady contact with load, motion and radius of one moment of a run.

    Parameters
    ----------
    problem : ContactProblem
        The contact of the run.
    moment : Moment
        With a positive speed.
    """
    contact, radii = problem.contact, problem.radii_of_axes
    has_lines, x = contact.has_lines, radii.x / moment.curvature
    along, across = direction(contact.sliding_angle)
    slid = along * moment.sliding + across * moment.across
    stated = {
        "radius": x if has_lines else None,
        "radius_x": None if has_lines else x,
        "radius_y": None if has_lines else radii.y,
        "load_per_length" if contact.is_line else "load": problem.load * moment.load,
        "entrainment_speed": problem.entrainment_speed * moment.speed,
        "slide_roll_ratio": slid / moment.speed,
        "hertz_pressure": None,
        "moes_load": None,
        "moes_speed": None,
    }
    steady = {"contact": contact.model_copy(update=stated), "transient": None}
    return problem.model_copy(update=steady)


def slides_ever(problem: PointContact) -> bool:
    """Whether the surfaces slide, at least at times."""
    return problem.motion.slides or bool(SLIDING & set(courses_of(problem)))


def courses_of(problem: PointContact) -> dict[str, Course]:
    """Return what changes in time, by key of ``[transient]``.

    Raises ValueError for a value whose unit is not that of this contact.
    """
    transient = problem.transient
    if transient is None:
        return {}
    by_length = problem.contact.is_line
    kinds = {
        "load": (quantity(ForcePerLength if by_length else Force), problem.load),
        "entrainment_speed": (SIGNED_SPEED, problem.entrainment_speed),
        "slide_roll_ratio": (quantity(Number), 1.0),
        "sliding_speed": (SIGNED_SPEED, problem.entrainment_speed),
        "radius": (quantity(Length), problem.radius_x),
    }
    stated: dict[str, Stated] = {key: getattr(transient, key) for key in kinds}
    found = dict[str, Course]()
    for key, (kind, reference) in kinds.items():
        try:
            if stated[key]:
                found[key] = course_of(stated[key], kind, reference)
        except ValueError as error:
            raise ValueError(f"transient.{key}: a value {error}") from None
    return found
