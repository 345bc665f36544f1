"""Changes of a case along dotted paths, and what stands there in the validated case."""

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, get_args

from pydantic import BaseModel

from tehl.options import Options
from tehl.problem import ContactProblem
from tehl.studies.case import Label
from tehl.units import Quantity

NUMERICS = "numerics"
_LONGEST = 60


def changed(tables: Mapping[str, Any], path: str, value: Any) -> dict[str, Any]:
    """Return tables with ``value`` at a dotted path; ``false`` leaves the key out.

    A name on the way, such as that of an oil, becomes the table with this name.

    Raises
    ------
    ValueError
        If the path goes through a number or a list.
    """
    key, *deeper = (part.strip() for part in path.split("."))
    after = dict(tables)
    if not deeper:
        if value is False:
            after.pop(key, None)
        else:
            after[key] = value
        return after
    below = after.get(key, {})
    if isinstance(below, str):
        below = {"name": below}
    if not isinstance(below, Mapping):
        raise ValueError(f"{path} goes through {key}, which is no table in the base case")
    after[key] = changed(below, ".".join(deeper), value)
    return after


def found_at(problem: ContactProblem, options: Options, path: str) -> tuple[Any, str | None]:
    """Return what stands at a path of a case, and its SI unit if it is a quantity.

    Returns
    -------
    value, unit
        None and None where the case has no such place any more: another law was chosen.
    """
    keys = [part.strip() for part in path.split(".")]
    node: Any = problem
    if keys[0] == NUMERICS:
        node, keys = options, keys[1:]
    unit = None
    for key in keys:
        if not isinstance(node, BaseModel) or key not in type(node).model_fields:
            return None, None
        field = type(node).model_fields[key]
        unit = next(_units([*field.metadata, field.annotation]), None)
        node = getattr(node, key)
    return node, unit


def _units(notes: Iterable[Any]) -> Iterator[str]:
    """Yield the units among the metadata of a field and in its annotation."""
    for note in notes:
        if isinstance(note, Quantity):
            yield "1" if note.unit == "-" else note.unit
        else:
            yield from _units(get_args(note))


def label_of(stated: Any, found: Any) -> Label:
    """Return what to write into a table for a value.

    Parameters
    ----------
    stated : object
        As the study states it.
    found : object
        What the case made of it: numbers in SI are taken from here.
    """
    if isinstance(found, bool) or stated is False:
        return "none" if stated is False else str(found).lower()
    if isinstance(found, int | float):
        return float(found)
    if isinstance(stated, str):
        return stated
    if isinstance(stated, Mapping):
        words = [stated[key] for key in ("law", "name", "type") if key in stated]
        if words:
            return str(words[0])
    return json.dumps(stated, ensure_ascii=False, default=str)[:_LONGEST]
