"""How long a run in time lasts."""

import math

from tehl.errors import InputError
from tehl.passage import parts_of
from tehl.problem import ContactProblem
from tehl.scaling import Scales

MOST_STEPS = 20_000
"""Steps that nobody asks for by accident."""


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


def number_of_steps(problem: ContactProblem, units: Scales, seconds: float) -> int:
    """Return the steps of ``seconds`` until the end of the question.

    Raises
    ------
    InputError
        If there are more than anybody wants.
    """
    duration = duration_of(problem, units)
    steps = duration / seconds
    if not steps <= MOST_STEPS:
        raise InputError(
            f"transient.duration = {duration:g} s takes {steps:.6g} steps of {seconds:.3g} s, more "
            f"than {MOST_STEPS}: give a shorter one, or a larger transient.stride"
        )
    return math.ceil(steps * (1.0 - 1e-9))
