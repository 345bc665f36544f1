"""Duration of a transient run: where roughness starts and when it has passed the contact."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from tehl.errors import InputError
from tehl.problem import ContactProblem
from tehl.roughness.protocol import Extent
from tehl.roughness.surface import OneRoughness, Sum
from tehl.roughness.waves import HarmonicModel
from tehl.scaling import ScaledProblem, Scales
from tehl.transient import Transient

MOST_STEPS = 20_000
"""Steps that nobody asks for by accident."""
BEYOND = 1.5
"""How far downstream of the centre the middle of what is passing has passed [a_x]."""
PERIODS = 2.5
"""Wavelengths of a harmonic surface that pass the centre, so that a fit in time has two of them."""
LONGEST = 6.0
"""Longest wave along x that is waited for [a_x]: longer ones tilt the surfaces as a whole."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Part:
    """One of the things that a surface carries.

    Attributes
    ----------
    surface : {"surface_1", "surface_2"}
        Whose it is.
    roughness : Roughness
        Its heights.
    speed : float
        [m/s].
    extent : ((float, float), (float, float))
        Where it is along x and y at time zero, between y = -a_y and a_y [m].
    """

    surface: str
    roughness: OneRoughness
    speed: float
    extent: Extent

    @property
    def is_endless(self) -> bool:
        """Whether it is rough wherever one goes along x: it has to come in at the inlet."""
        return math.isinf(self.extent[0][0])

    @property
    def ends(self) -> tuple[float, float]:
        """Return how far its ends are downstream of the centre, hind and front one [m].

        Downstream is where the part goes.
        """
        first, last = self.extent[0]
        return (first, last) if self.speed >= 0 else (-last, -first)

    def passing(self, units: Scales, transient: Transient) -> float:
        """Return how long it takes to come, pass and be gone [s]; what it lets in passes too."""
        width = units.half_width_x
        distance = max(transient.entrance + BEYOND, self._waves(width, transient)) * width
        if not self.is_endless:
            distance = max(distance, width - self.ends[0])
        # what a surface lets in at the inlet travels at the mean speed, however fast the surface is
        return distance / min(abs(self.speed), units.speed)

    def _waves(self, width: float, transient: Transient) -> float:
        """Return how far a harmonic surface goes until whole waves have passed the centre [a_x]."""
        if not isinstance(self.roughness, HarmonicModel):
            return 0.0
        wave = self.roughness.shortest_wavelengths[0] / width
        if not wave <= LONGEST:
            return 0.0
        front = transient.entrance if transient.start == "smooth" else 0.0
        return front + min(wave, 0.5 * front) + PERIODS * wave  # it fades in over the second

    def is_in_contact(self, units: Scales, seconds: float, entrance: float | None) -> bool:
        """Whether some of it is in the contact within ``seconds``, come in from the entrance."""
        first, last = self.extent[1]
        beside = first > units.half_width_y or last < -units.half_width_y
        hind, front = self.ends
        if self.is_endless and entrance is not None:
            front = -entrance * units.half_width_x
        width = units.half_width_x
        return not beside and hind < width and front + abs(self.speed) * seconds > -width


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
    """Return what a surface is the sum of, without what is smooth."""
    parts = roughness.parts if isinstance(roughness, Sum) else (roughness,)
    return tuple(part for part in parts if not part.is_smooth)


def misplaced(scaled: ScaledProblem, seconds: float) -> str | None:
    """Return why roughness cannot come into the contact as stated, None if it can.

    Parameters
    ----------
    scaled : ScaledProblem
        With a ``transient`` table.
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
                f"{part.surface} stands still, so its roughness never comes in: let "
                'transient.start be "standing"'
            )
        if not part.is_endless and part.is_in_contact(units, 0.0, entrance):
            return _there_already(part, units)
    if any(part.is_in_contact(units, seconds, entrance) for part in parts):
        return None
    return (
        f"the roughness of the surfaces does not come into the contact within {seconds:.3g} s: "
        f"look at its place (x, y){_and_duration(problem)}"
    )


def _and_duration(problem: ContactProblem) -> str:
    stated = problem.transient is not None and problem.transient.duration is not None
    return " and at transient.duration" if stated else ""


def _there_already(part: Part, units: Scales) -> str:
    """Return the sentence on a feature that would appear in the contact at once."""
    kind = getattr(part.roughness, "type", "roughness")
    remedy = 'let transient.start be "standing"'
    if part.speed != 0:
        back = math.copysign(1.001 * (part.ends[1] + units.half_width_x), part.speed)
        place = 1e6 * (getattr(part.roughness, "x", 0.0) - back)
        remedy += f", or put it upstream, at x = {place:.4g} um or farther"
    return (
        f"the {kind} of {part.surface} is in the contact at time zero, where the film is still "
        f"that of smooth surfaces: {remedy}"
    )


def duration_of(scaled: ScaledProblem) -> float:
    """Return how long the run lasts [s]: as stated, or until what moves has passed the contact."""
    transient, units = scaled.problem.transient, scaled.scales
    if transient is None:
        return 0.0
    if transient.duration is not None:
        return transient.duration
    moving = (part for part in parts_of(scaled) if part.speed != 0)
    passing = max((part.passing(units, transient) for part in moving), default=0.0)
    loaded = max((time for time, _ in transient.load), default=0.0)
    return max(passing, loaded, units.half_width_x / units.speed)


def number_of_steps(scaled: ScaledProblem, seconds: float) -> int:
    """Return the steps of ``seconds`` until the end of the question.

    Raises
    ------
    InputError
        If there are more than anybody wants.
    """
    duration = duration_of(scaled)
    steps = duration / seconds
    if not steps <= MOST_STEPS:
        raise InputError(
            f"transient.duration = {duration:g} s takes {steps:.6g} steps of {seconds:.3g} s, more "
            f"than {MOST_STEPS}: give a shorter one, or a larger transient.stride"
        )
    return math.ceil(steps * (1.0 - 1e-9))
