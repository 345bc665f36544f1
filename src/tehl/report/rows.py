"""What texts and pages show of a result: rows of quantities, and what follows from it by name."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from tehl.post.following import Following
from tehl.post.transient import way
from tehl.post.transient_numbers import (
    friction,
    lambda_central,
    late_extremes,
    longer_duration,
    sliding_power,
    unresolved,
    why_share_unknown,
)
from tehl.result.quantity import Quantity
from tehl.result.registry import dimensionless, shown_in
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """A quantity of a result as a text or page shows it."""

    name: str
    quantity: Quantity
    value: float
    on_grid: float
    """In SI, the certified value if there is one, and that of the grid."""
    scaled: float | None
    """Dimensionless, on the grid; None where the summary has it in SI only."""
    error: float | None
    """Relative error bar [-]."""


def rows_of(result: Solution, place: str) -> Iterator[Row]:
    """Yield a row for each quantity that ``result`` has and that a place shows.

    Parameters
    ----------
    result : Solution
        A certified one has values with error bars, and those of its grid beside them.
    place : str
        Output whose wording and choice of quantities are taken, a key of ``Quantity.words``.
    """
    numbers, on_grid = Following(result).numbers, Following(result.but(uncertainty={})).numbers
    for one in shown_in(place):
        rolls = one.block == "traction" and not result.problem.motion.slides
        value = None if rolls else numbers.get(one.path)
        if value is not None:
            other = dimensionless(one)
            yield Row(
                name=one.words[place],
                quantity=one,
                value=value,
                on_grid=on_grid.get(one.path),
                scaled=None if other is None else numbers.get(other.path),
                error=one.error_in(numbers),
            )


def following(result: Solution | TransientSolution) -> Following | dict[str, Any]:
    """Return what follows from a solution; of a transient one what follows from its start too."""
    start = result.start if isinstance(result, TransientSolution) else result
    found = Following(start)
    if isinstance(result, TransientSolution):
        return {
            "traction": found.traction,
            "stress": found.stress,
            "friction": friction(result),
            "lambda_central": lambda_central(result),
            "sliding_power": sliding_power(result),
            "late_extremes": late_extremes(result),
            "unresolved": unresolved(result),
            "longer_duration": longer_duration(result),
            "why_share_unknown": why_share_unknown(result),
            "way": way(result),
        }
    return found
