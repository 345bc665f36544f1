"""What is known of a finished case without its fields."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from tehl.result import Cost, Result

Scalar = float | int | str | bool | None

SOLVED = ("converged", "not_converged", "diverged", "stalled")
"""Outcomes that have fields, converged or not."""

NO_COST = Cost(cpu_seconds=0.0, wall_seconds=0.0)

_UNITS = {
    "m": "m",
    "pa": "Pa",
    "k": "K",
    "w": "W",
    "rad": "rad",
    "seconds": "s",
}
"""Unit by the last part of the name of a number."""
_NOT_NUMBERS = ("title", "status", "cause", "message", "hint")
"""Keys of a summary that have a place of their own."""
_PARTS_OF_ESTIMATES = ("value", "uncertainty", "discretisation", "domain")


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """The outcome of one case.

    Attributes
    ----------
    key : str
        Of the case.
    status : str
        As of a result, or ``"bad_input"`` where the solver refused it, or ``"failed"`` where there
        is no result at all.
    cause, message, hint : str or None
        Why it is no answer, as a word and in sentences; message and hint also of an answer whose
        minimum film is hardly known.
    summary : mapping of str to scalar
        Every number and word of the summary, by dotted names: ``"film.h_min_m"``.
    cost : Cost
        Of the solve.
    """

    key: str
    status: str
    cause: str | None = None
    message: str | None = None
    hint: str | None = None
    summary: Mapping[str, Scalar] = field(default_factory=dict)
    cost: Cost = NO_COST

    @property
    def converged(self) -> bool:
        """Whether the numbers may be believed."""
        return self.status == "converged"

    @property
    def has_fields(self) -> bool:
        """Whether there were fields at the end, converged or not."""
        return self.status in SOLVED


def row_of(key: str, result: Result) -> Row:
    """Return the row of a result, converged or not."""
    status = result.status
    blocks = {name: block for name, block in result.summary().items() if block is not None}
    return Row(
        key=key,
        status=status.kind,
        cause=status.cause,
        message=status.message,
        hint=status.hint,
        summary=dict(flat(blocks, skip=_NOT_NUMBERS)),
        cost=result.cost,
    )


def flat(
    tree: Mapping[Any, Any], prefix: str = "", skip: tuple[str, ...] = ()
) -> Iterator[tuple[str, Scalar]]:
    """Yield the scalars of nested tables and lists by dotted names, in order.

    Parameters
    ----------
    tree : mapping
        Tables of tables, lists and scalars.
    prefix : str
        Begins each name.
    skip : tuple of str
        Keys of the outermost table to leave out.
    """
    for key, value in tree.items():
        if key in skip:
            continue
        inside = dict(enumerate(value)) if isinstance(value, list | tuple) else value
        if isinstance(inside, Mapping):
            yield from flat(inside, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def unit_of(name: str) -> str:
    """Return the unit of a number of a summary, ``"1"`` where it has none."""
    parts = [part for part in name.split(".") if not part.isdigit()]
    if parts[0] == "uncertainty" and parts[-1] in (*_PARTS_OF_ESTIMATES, "values"):
        parts.pop()
    _, underscore, ending = parts[-1].rpartition("_")
    return _UNITS.get(ending, "1") if underscore else "1"
