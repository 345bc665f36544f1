"""Numbers as people read them: lengths and times in a fitting unit, the inputs of a case."""

import math
from collections.abc import Iterator
from typing import Any, get_args

from pydantic import BaseModel

from tehl.base.units import Quantity

UNTITLED = "Lubricated contact"
"""Title of a case that states none."""

_LENGTHS = ((1e-3, 1e3, "mm"), (1e-6, 1e6, "um"), (0.0, 1e9, "nm"))
_TIMES = ((1.0, 1.0, "s"), (1e-3, 1e3, "ms"), (0.0, 1e6, "us"))
_INPUTS = {
    "Pa": ((1e9, 1e-9, "GPa"), (1e6, 1e-6, "MPa")),
    "1/Pa": ((1e-12, 1e9, "1/GPa"),),
    "m^2/s": ((1e-9, 1e6, "mm^2/s"),),
    "m": ((1.0, 1.0, "m"), (1e-3, 1e3, "mm"), (1e-7, 1e6, "µm"), (1e-12, 1e9, "nm")),
}
"""By SI unit, from the largest: smallest magnitude, factor and unit."""
LARGEST_SHOWN_ERROR = 10.0
"""Relative error from which on its value says nothing: that of a film that has not converged."""


def error_text(error: float) -> str:
    """Return a relative error of a value [-], as in ``about 1.4 %`` or ``above 1000 %``."""
    percent = 100.0 * abs(error)
    if not abs(error) <= LARGEST_SHOWN_ERROR:
        return f"above {100.0 * LARGEST_SHOWN_ERROR:.0f} %"
    return f"about {percent:{'.2g' if percent < 99.5 else '.0f'}} %"


def length_unit(metres: float) -> tuple[float, str]:
    """Return the factor from metres to a fitting unit (mm, um or nm), and that unit."""
    return next(((f, unit) for least, f, unit in _LENGTHS if abs(metres) >= least), (1.0, "m"))


def length(metres: float) -> str:
    """Return a length in a fitting unit."""
    factor, unit = length_unit(metres)
    return f"{metres * factor:.4g} {unit}"


def seconds(time: float) -> str:
    """Return a time [s] in a fitting unit (s, ms or us)."""
    factor, unit = next((f, unit) for least, f, unit in _TIMES if abs(time) >= least)
    return f"{time * factor:.4g} {unit}"


def input_rows(model: BaseModel, prefix: str = "") -> Iterator[tuple[str, str]]:
    """Yield key path (``contact.load``) and value with unit of each value that a model states.

    Paths of the models in it follow after ``prefix``.

    Parameters
    ----------
    model : BaseModel
        A case, or a table of one; empty texts and None are left out.
    prefix : str
        Key path of the table with a final dot; empty for a whole case.
    """
    for name, field in type(model).model_fields.items():
        value = getattr(model, name)
        if isinstance(value, BaseModel):
            yield from input_rows(value, f"{prefix}{name}.")
        elif value is not None and value != "":
            yield f"{prefix}{name}", _with_unit(value, _unit(field.annotation, field.metadata))


def _with_unit(value: Any, unit: str) -> str:
    """Return a value with its unit, with an SI prefix where that is shorter; counts have none."""
    if isinstance(value, int):
        return _shown(value)
    if isinstance(value, float):
        if math.isinf(value):
            return _shown(value)
        for least, factor, better in _INPUTS.get(unit, ()):
            if abs(value) >= least:
                return f"{_shown(value * factor)} {better}"
    return f"{_shown(value)} {unit}".strip()


def _unit(annotation: Any, metadata: list[Any]) -> str:
    """Return the unit of a field, which may stand inside a union with None."""
    for note in metadata:
        if isinstance(note, Quantity):
            return note.unit.strip("-")
    units = (_unit(one, list(getattr(one, "__metadata__", ()))) for one in get_args(annotation))
    return next(filter(None, units), "")


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, tuple | list):
        return "[" + ", ".join(_shown(item) for item in value) + "]"
    return str(value)
