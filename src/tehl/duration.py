"""How long a run in time lasts."""

from tehl.passage import parts_of
from tehl.problem import ContactProblem
from tehl.scaling import Scales


def duration_of(problem: ContactProblem, units: Scales) -> float:
    """Return how long the run lasts [s]: as stated, or until what moves has passed the contact."""
    transient = problem.transient
    if transient is None:
        return 0.0
    if transient.duration is not None:
        return transient.duration
    moving = (part for part in parts_of(problem, units) if part.speed != 0)
    passing = max((part.passing(units, transient) for part in moving), default=0.0)
    loaded = max((time for time, _ in transient.load), default=0.0)
    return max(passing, loaded, units.half_width_x / units.speed)
