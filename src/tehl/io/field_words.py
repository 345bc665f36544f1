"""What a field of a case takes, in words: a good value, and the numbers between which it lies."""

import json
from collections.abc import Iterator
from typing import Any, get_args

from pydantic.fields import FieldInfo

from tehl.units import Quantity


def example(field: FieldInfo) -> str | None:
    """Return a good value of a field, as a case file shows it; None where it has none."""
    if field.examples:
        return json.dumps(field.examples[0])
    return next((note.example for note in field.metadata if isinstance(note, Quantity)), None)


def limits_in_words(field: FieldInfo) -> str:
    """Return between which numbers a field must lie, as ``must be ...``; empty without limits."""
    found = dict(_limits(field.annotation, field.metadata))
    whole = found.pop("whole", False)
    if whole and {"ge", "le"} <= found.keys():
        return f"must be a whole number from {found['ge']} to {found['le']}"
    words = [f"{_WORDS[name]} {found[name]:g}" for name in _WORDS if name in found]
    return f"must be {' and '.join(words)}" if words else ""


_WORDS = {"gt": "greater than", "ge": "at least", "lt": "less than", "le": "at most"}


def _limits(annotation: Any, notes: list[Any]) -> Iterator[tuple[str, Any]]:
    """Yield the limits of a field by name, and whether it is a whole number."""
    if annotation is int:
        yield "whole", True
    for note in notes:
        if isinstance(note, FieldInfo):
            yield from _limits(None, note.metadata)
        for name in _WORDS:
            if (limit := getattr(note, name, None)) is not None:
                yield name, limit
    for argument in get_args(annotation):
        if not isinstance(argument, Quantity):
            yield from _limits(argument, list(getattr(argument, "__metadata__", ())))
