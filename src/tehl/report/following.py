"""What follows from a solution, by the names that templates use."""

from typing import Any

from tehl.post.boundary_contact import touching
from tehl.post.heat import temperature
from tehl.post.starvation import starvation
from tehl.post.summits import load_sharing
from tehl.post.traction import traction
from tehl.post.transient_numbers import (
    friction,
    late_extremes,
    longer_duration,
    why_share_unknown,
)
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution


def following(result: Solution | TransientSolution) -> dict[str, Any]:
    """Return what follows from a solution; of a transient one what follows from its start too."""
    start = result.start if isinstance(result, TransientSolution) else result
    found: dict[str, Any] = {"traction": traction(start)}
    if isinstance(result, TransientSolution):
        return found | {
            "friction": friction(result),
            "late_extremes": late_extremes(result),
            "longer_duration": longer_duration(result),
            "why_share_unknown": why_share_unknown(result),
        }
    return found | {
        "load_sharing": load_sharing(start),
        "starvation": starvation(start),
        "temperature": temperature(start),
        "touching": touching(start),
    }
