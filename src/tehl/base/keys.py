"""Keys of the tables of a case: their models, limits and examples, and where they stand."""

import json
from collections.abc import Iterator, Sequence
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from tehl.base.units import Quantity

Model = type[BaseModel]
KeyPath = tuple[str | int, ...]
COMPARISONS = {"gt": "greater than", "ge": "at least", "lt": "less than", "le": "at most"}
"""Limits of a field by their names, and words for them."""


def models_in(annotation: object) -> Iterator[Model]:
    """Yield the models an annotation may hold."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for argument in get_args(annotation):
        yield from models_in(argument)


def _added(field: FieldInfo) -> Iterator[Model]:
    """Yield the models that notes on a field add to its annotation."""
    for note in field.metadata:
        yield from getattr(note, "models", ())


def models_at(root: Model, path: KeyPath) -> list[list[Model]]:
    """Return the possible models of each step of ``path``, the root first."""
    steps = [[root]]
    for key in path:
        field = field_at(steps[-1], key)
        inside = steps[-1] if isinstance(key, int) else []
        steps.append([*models_in(field.annotation), *_added(field)] if field else inside)
    return steps


def field_at(models: Sequence[Model], key: str | int) -> FieldInfo | None:
    """Return the field of a key, of the first of ``models`` that has it."""
    found = (model.model_fields[key] for model in models if key in model.model_fields)
    return next(found, None) if isinstance(key, str) else None


def limits_of(annotation: Any, notes: list[Any]) -> Iterator[tuple[str, Any]]:
    """Yield the limits of a field by name, and whether it is a whole number or a share."""
    if annotation is int:
        yield "whole", True
    for note in notes:
        if isinstance(note, FieldInfo):
            yield from limits_of(None, note.metadata)
        for name in (*COMPARISONS, "is_share"):
            if (limit := getattr(note, name, None)) is not None:
                yield name, limit
    for argument in get_args(annotation):
        if not isinstance(argument, Quantity):
            yield from limits_of(argument, list(getattr(argument, "__metadata__", ())))


def tags(model: Model, key: str = "law") -> tuple[str, ...]:
    """Return the words under ``key`` that choose a model; none if it has no such key."""
    law = model.model_fields.get(key)
    annotation = law.annotation if law else None
    return get_args(annotation) if get_origin(annotation) is Literal else ()


def example(field: FieldInfo) -> str | None:
    """Return a good value of a field, as a case file shows it; None if it has none."""
    if field.examples:
        return json.dumps(field.examples[0])
    found = quantity_of(field)
    return None if found is None else found.example


def quantity_of(field: FieldInfo) -> Quantity | None:
    """Return the kind of number that a field holds, None if it holds none with a unit."""
    inside = (
        note for one in get_args(field.annotation) for note in getattr(one, "__metadata__", ())
    )
    return next((note for note in (*field.metadata, *inside) if isinstance(note, Quantity)), None)


# ---- words


def key_paths(model: Model, prefix: str = "") -> Iterator[str]:
    """Yield the paths of all keys of a model, those of tables in it included.

    Parameters
    ----------
    model : Model
        Class of the outermost table.
    prefix : str
        Path of that table with a final dot; empty for a whole case.
    """
    for key, field in model.model_fields.items():
        yield f"{prefix}{key}"
        for deeper in models_in(field.annotation):
            yield from key_paths(deeper, f"{prefix}{key}.")
