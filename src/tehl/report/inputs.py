"""The inputs of a case as rows of a table, each with its unit."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, get_args

from pydantic import BaseModel

from tehl.units import Quantity


@dataclass(frozen=True, kw_only=True, slots=True)
class InputRow:
    """One stated value.

    Attributes
    ----------
    path : str
        Key path in the case file: ``"contact.load"``.
    value, unit : str
        As text; the unit is empty for words and plain numbers.
    """

    path: str
    value: str
    unit: str


_READABLE: dict[str, tuple[tuple[float, float, str], ...]] = {
    "Pa": ((1e9, 1e-9, "GPa"), (1e6, 1e-6, "MPa")),
    "1/Pa": ((1e-12, 1e9, "1/GPa"),),
    "m^2/s": ((1e-9, 1e6, "mm^2/s"),),
    "m": ((1.0, 1.0, "m"), (1e-3, 1e3, "mm"), (1e-7, 1e6, "µm"), (1e-12, 1e9, "nm")),
}
"""By SI unit, from the largest: least value, factor and unit that reads well."""


def input_rows(model: BaseModel, prefix: str = "") -> Iterator[InputRow]:
    """Yield the stated values of a model and of the models in it; nothing for None.

    Parameters
    ----------
    model : BaseModel
        A problem, options or a part of them.
    prefix : str
        Key path of ``model``, with its last dot.
    """
    for name, field in type(model).model_fields.items():
        value = getattr(model, name)
        if isinstance(value, BaseModel):
            yield from input_rows(value, f"{prefix}{name}.")
        elif value is not None and value != "":
            unit = _unit(field.annotation, field.metadata)
            yield InputRow(path=f"{prefix}{name}", **_readable(value, unit))


def _readable(value: Any, unit: str) -> dict[str, str]:
    """Return value and unit as text, large and small ones with a prefix."""
    if isinstance(value, float) and math.isfinite(value):
        for least, factor, better in _READABLE.get(unit, ()):
            if abs(value) >= least:
                return {"value": _shown(value * factor), "unit": better}
    endless = isinstance(value, float) and math.isinf(value)
    return {"value": _shown(value), "unit": "" if endless else unit}


def _unit(annotation: Any, metadata: list[Any]) -> str:
    """Return the unit of a field, which may stand inside a union with None."""
    for note in metadata:
        if isinstance(note, Quantity):
            return note.unit.strip("-")
    for argument in get_args(annotation):
        unit = _unit(argument, list(getattr(argument, "__metadata__", ())))
        if unit:
            return unit
    return ""


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, tuple | list):
        return "[" + ", ".join(_shown(item) for item in value) + "]"
    return str(value)
