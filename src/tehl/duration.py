"""How long a run in time lasts."""

from tehl.problem import ContactProblem
from tehl.scaling import Scales

BEYOND = 1.5
"""How far downstream of the centre everything has passed [a_x]."""


def duration_of(problem: ContactProblem, units: Scales) -> float:
    """Return how long the run lasts [s]: as stated, or until what moves has passed the contact."""
    transient, motion = problem.transient, problem.motion
    if transient is None:
        return 0.0
    if transient.duration is not None:
        return transient.duration
    distance = (transient.entrance + BEYOND) * units.half_width_x
    speeds = ((problem.surface_1, motion.speed_1), (problem.surface_2, motion.speed_2))
    moving = [abs(speed) for one, speed in speeds if not one.roughness.is_smooth and speed != 0]
    # what a surface lets in at the inlet travels at the mean speed, however fast the surface is
    passing = distance / min(*moving, units.speed) if moving else 0.0
    loaded = max((time for time, _ in transient.load), default=0.0)
    return max(passing, loaded, units.half_width_x / units.speed)
