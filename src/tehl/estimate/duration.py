"""Duration and time step of a transient run: when roughness has passed, what a step resolves."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tehl.base.errors import InputError
from tehl.contact.moment import courses_of, moments_of
from tehl.contact.transient import Transient
from tehl.estimate.scaling import ScaledProblem, Scales
from tehl.roughness.map import Map
from tehl.roughness.model import Extent
from tehl.roughness.superposition import OneRoughness, Sum
from tehl.roughness.waves import HarmonicModel

MOST_TIME_STEPS = 20_000
"""Number of steps beyond which a stated duration is considered a mistake."""
PASSED_DISTANCE = 1.5
"""Distance downstream of the centre at which the middle of a feature has passed [a_x]."""
MOST_FOR_COURSES = 256
"""Most time steps that a grid is refined for, so that they follow what changes in time."""
PERIODS = 2.5
"""Wavelengths of a harmonic surface that pass the centre, so that a fit over time has two."""
STEP_OF_SMOOTH, LONGEST_STRIDE = 0.02, 4
"""Way of the mean motion in a time step between smooth surfaces [a_x], the mesh width of 257 nodes
on the usual domain, and the mesh widths that it is at the most: finer grids resolve a thin film,
whose changes are as slow as on others."""
LONGEST_WAVE = 6.0
"""Longest wave along x that extends a run [a_x]: longer ones tilt the surfaces as a whole."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Part:
    """A rough component of a surface, and its motion."""

    surface: str
    """The surface that carries it."""
    roughness: OneRoughness
    """Its heights."""
    speed: float
    """Of that surface [m/s]."""
    extent: Extent
    """Its edges along x and y at time zero, between y = -a_y and a_y [m]."""

    @property
    def is_endless(self) -> bool:
        """Whether it is infinite along x, and so enters at the inlet."""
        return math.isinf(self.extent[0][0])

    @property
    def ends(self) -> tuple[float, float]:
        """Rear and front end along its own motion, from the centre of the contact [m]."""
        first, last = self.extent[0]
        return (first, last) if self.speed >= 0 else (-last, -first)

    def passing_time(self, units: Scales, transient: Transient) -> float:
        """Return the time in which it, and the film that it lets in, pass the contact [s].

        Parameters
        ----------
        units : Scales
            For the Hertz half-width along x [m] and the entrainment speed [m/s].
        transient : Transient
            Its ``entrance`` is the inlet edge of the roughness at time zero [a_x].
        """
        width = units.half_width_x
        distance = max(transient.entrance + PASSED_DISTANCE, self._waves(width, transient)) * width
        if not self.is_endless:
            distance = max(distance, width - self.ends[0])
        # the film that a surface lets in at the inlet travels at the mean speed
        return distance / min(abs(self.speed), units.speed)

    def _waves(self, width: float, transient: Transient) -> float:
        """Return the distance in which `PERIODS` of a harmonic surface pass the centre [a_x]."""
        if not isinstance(self.roughness, HarmonicModel):
            return 0.0
        wave = self.roughness.shortest_wavelengths[0] / width
        if not wave <= LONGEST_WAVE:
            return 0.0
        front = transient.entrance if transient.start == "smooth" else 0.0
        return front + min(wave, 0.5 * front) + PERIODS * wave  # the second term is its fade-in

    def is_in_contact(self, units: Scales, seconds: float, entrance: float | None) -> bool:
        """Whether some of it is in the contact within ``seconds``.

        Parameters
        ----------
        units, seconds : Scales, float
            Half-widths of the contact, and time since the start [s].
        entrance : float or None
            Distance upstream at which endless parts start [a_x]; None if they start everywhere.
        """
        first, last = self.extent[1]
        beside = first > units.half_width_y or last < -units.half_width_y
        rear, front = self.ends
        if self.is_endless and entrance is not None:
            front = -entrance * units.half_width_x
        width = units.half_width_x
        return not beside and rear < width and front + abs(self.speed) * seconds > -width


def parts_of(scaled: ScaledProblem) -> Iterator[Part]:
    """Yield the rough components of both surfaces."""
    problem, units = scaled.problem, scaled.scales
    motion = problem.motion
    for name, speed in (("surface_1", motion.speed_1), ("surface_2", motion.speed_2)):
        roughness = getattr(problem, name).roughness
        for part in components(roughness):
            extent = part.extent(units.half_width_y)
            yield Part(surface=name, roughness=part, speed=speed, extent=extent)


def components(roughness: OneRoughness | Sum) -> tuple[OneRoughness, ...]:
    """Return the rough terms of a sum of surfaces."""
    return tuple(part for part in roughness.summands if not part.is_smooth)


def misplaced(scaled: ScaledProblem, seconds: float) -> str | None:
    """Return why the roughness never enters the contact, or starts inside it; None if it enters.

    Parameters
    ----------
    scaled : ScaledProblem
        With the roughness of both surfaces and ``transient.start``.
    seconds : float
        Duration of the run [s].
    """
    problem, units = scaled.problem, scaled.scales
    transient = problem.transient
    parts = tuple(parts_of(scaled))
    if transient is None or not parts:
        return None
    entrance = transient.entrance if transient.start == "smooth" else None
    for part in parts if entrance is not None else ():
        if part.is_endless and part.speed == 0:
            return (
                f"{part.surface}.roughness: never enters the contact, as the surface stands still; "
                'set transient.start = "standing"'
            )
        if not part.is_endless and part.is_in_contact(units, 0.0, entrance):
            return _starts_inside(part, units)
    if any(part.is_in_contact(units, seconds, entrance) for part in parts):
        return None
    too_short = " and transient.duration" if transient.duration is not None else ""
    return (
        f"roughness: does not enter the contact within {seconds:.3g} s; check its position "
        f"(x, y){too_short}"
    )


def _starts_inside(part: Part, units: Scales) -> str:
    """Return the message on a feature that would appear in the contact at once."""
    kind = getattr(part.roughness, "type", "roughness")
    remedy = 'set transient.start = "standing"'
    if part.speed != 0:
        back = math.copysign(1.001 * (part.ends[1] + units.half_width_x), part.speed)
        place = 1e6 * (getattr(part.roughness, "x", 0.0) - back)
        remedy += f", or place it upstream, at x = {place:.4g} um or farther"
    return (
        f"{part.surface}.roughness: the {kind} is in the contact at time zero, where the film is "
        f"still that of smooth surfaces; {remedy}"
    )


def duration_of(scaled: ScaledProblem) -> float:
    """Return the duration of the run [s]: as stated, or until all that moves has passed."""
    transient, units = scaled.problem.transient, scaled.scales
    if transient is None:
        return 0.0
    if transient.duration is not None:
        return transient.duration
    moving = (part for part in parts_of(scaled) if part.speed != 0)
    passing = max((part.passing_time(units, transient) for part in moving), default=0.0)
    changing = max((course.end for course in courses_of(scaled.problem).values()), default=0.0)
    return max(passing, changing, units.half_width_x / units.speed)


def whole_passing(scaled: ScaledProblem) -> float:
    """Return the time in which maps that repeat at their edges pass the contact whole [s].

    It is zero without one that moves.
    """
    transient, units = scaled.problem.transient, scaled.scales
    if transient is None:
        return 0.0
    before = (transient.entrance if transient.start == "smooth" else 0.0) + PASSED_DISTANCE
    distances = (
        (before * units.half_width_x + part.roughness.box[0][1] - part.roughness.box[0][0], part)
        for part in parts_of(scaled)
        if isinstance(part.roughness, Map) and part.is_endless and part.speed != 0
    )
    times = (far / min(abs(part.speed), units.speed) for far, part in distances)
    return max(times, default=0.0)


def extremes_of(scaled: ScaledProblem) -> tuple[float, float]:
    """Return the largest sliding speed over that of entrainment [-] and Hertz pressure [Pa].

    Of all moments of a run, whose pressure follows load and curvature: as the root of both for
    lines, for points as ``load^(1/3) (1/R_x + 1/R_y)^(2/3)``, exact for circles.
    """
    problem, still = scaled.problem, scaled.problem.sliding_speed / scaled.scales.speed
    pressure = problem.hertz.pressure
    if not courses_of(problem):
        return still, pressure
    moments = moments_of(problem, duration_of(scaled))
    slides = max(math.hypot(one.sliding, one.across) for one in moments)
    if problem.contact.has_lines:
        return slides, pressure * max(math.sqrt(one.load * one.curvature) for one in moments)
    part = problem.radius_y / (problem.radius_x + problem.radius_y)
    curved = [1.0 + part * (one.curvature - 1.0) for one in moments]
    rises = (one.load ** (1 / 3) * c ** (2 / 3) for one, c in zip(moments, curved, strict=True))
    return slides, pressure * max(rises)


def bend_between(scaled: ScaledProblem, steps: int) -> float:
    """Return how far what changes in time is off straight lines between equal time steps [-].

    Parameters
    ----------
    scaled : ScaledProblem
        A transient problem.
    steps : int
        Number of steps of its duration.

    Returns
    -------
    float
        The largest part of the largest value of a load, a speed or a radius.
    """
    time, found = np.linspace(0.0, duration_of(scaled), 4 * steps + 1), 0.0
    for course in courses_of(scaled.problem).values():
        values = np.array([course.at(moment) for moment in time])
        straight = np.interp(time, time[::4], values[::4])
        largest = float(np.abs(values).max())
        found = max(found, float(np.abs(values - straight).max()) / max(largest, 1e-300))
    return found


def steps_of_courses(scaled: ScaledProblem, part: float) -> int:
    """Return the fewest time steps, a power of two, within which nothing bends by more.

    Parameters
    ----------
    scaled : ScaledProblem
        A transient problem, or a steady one, for which it is zero.
    part : float
        Of the largest value, as `bend_between` [-].
    """
    if not courses_of(scaled.problem):
        return 0
    steps = 4
    while steps < MOST_FOR_COURSES and bend_between(scaled, steps) > part:
        steps *= 2
    return steps


def stride_on(scaled: ScaledProblem, mesh_width: float, part: float) -> int:
    """Return the mesh widths that the mean motion passes per time step on a grid.

    The stated ``stride``; left out, between smooth surfaces what `STEP_OF_SMOOTH` has, but no
    more than follow what changes in time.

    Parameters
    ----------
    scaled : ScaledProblem
        A transient problem.
    mesh_width : float
        Along x [a_x].
    part : float
        Of the largest value by which a step may miss what changes, as `bend_between` [-].
    """
    transient, scales = scaled.problem.transient, scaled.scales
    if transient is None:
        return 1
    if "stride" in transient.model_fields_set or scaled.problem.is_rough:
        return transient.stride
    way = duration_of(scaled) * scales.speed / scales.half_width_x
    found = min(max(int(STEP_OF_SMOOTH / mesh_width * (1.0 + 1e-9)), 1), LONGEST_STRIDE)
    while found > 1 and bend_between(scaled, math.ceil(way / (found * mesh_width))) > part:
        found //= 2
    return found


def number_of_steps(scaled: ScaledProblem, seconds: float) -> int:
    """Return the number of time steps of the run.

    Parameters
    ----------
    scaled : ScaledProblem
        A transient problem; its stated duration or that of the passage counts.
    seconds : float
        Time step [s].

    Raises
    ------
    InputError
        If the number exceeds `MOST_TIME_STEPS`.
    """
    duration = duration_of(scaled)
    steps = duration / seconds
    if not steps <= MOST_TIME_STEPS:
        raise InputError(
            f"transient.duration = {duration:g} s: takes {steps:.6g} steps of {seconds:.3g} s, "
            f"more than {MOST_TIME_STEPS}; give a shorter one, or a larger transient.stride"
        )
    return math.ceil(steps * (1.0 - 1e-9))
