"""What follows from a solution, by the names that templates use."""

from typing import Any

from tehl.post.following import Following
from tehl.post.transient_numbers import (
    friction,
    late_extremes,
    longer_duration,
    why_share_unknown,
)
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution


def following(result: Solution | TransientSolution) -> Following | dict[str, Any]:
    """Return what follows from a solution; of a transient one what follows from its start too."""
    start = result.start if isinstance(result, TransientSolution) else result
    found = Following(start)
    if isinstance(result, TransientSolution):
        return {
            "traction": found.traction,
            "friction": friction(result),
            "late_extremes": late_extremes(result),
            "longer_duration": longer_duration(result),
            "why_share_unknown": why_share_unknown(result),
        }
    return found
