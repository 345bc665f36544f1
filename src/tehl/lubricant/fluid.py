"""The lubricant: its laws and thermal properties, and the library of named oils."""

import difflib
import tomllib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict

from tehl.errors import InputError
from tehl.lubricant.density import DensityLaw
from tehl.lubricant.shear import Newtonian, ShearLaw
from tehl.lubricant.viscosity import ViscosityLaw
from tehl.units import Conductivity, HeatCapacity


class Lubricant(BaseModel):
    """An oil.

    Attributes
    ----------
    viscosity : Roelands, Barus or ConstantViscosity
        Law with the method ``viscosity(pressure, temperature)``.
    density : DowsonHigginson or ConstantDensity
        Law with the method ``density(pressure, temperature)``.
    shear : Newtonian, Eyring, Carreau or Limiting
        Law of the shear stress, see :mod:`tehl.lubricant.shear`.
    conductivity, heat_capacity : float or None
        [W/m/K] and [J/kg/K]; only needed when heat is computed.
    name, source : str or None
        Where the numbers come from.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    viscosity: ViscosityLaw
    density: DensityLaw
    shear: ShearLaw = Newtonian()
    conductivity: Conductivity | None = None
    heat_capacity: HeatCapacity | None = None
    name: str | None = None
    source: str | None = None


@cache
def _tables() -> dict[str, dict[str, Any]]:
    """Return the tables of the library, by name."""
    text = Path(__file__).with_name("oils.toml").read_text(encoding="utf-8")
    return {name: {"name": name} | table for name, table in tomllib.loads(text).items()}


def library() -> dict[str, Lubricant]:
    """Return the named oils, by name."""
    return {name: Lubricant(**table) for name, table in _tables().items()}


def oil(name: str) -> Lubricant:
    """Return the oil called ``name``.

    Raises
    ------
    InputError
        If the library does not have it; the message lists what it has.
    """
    try:
        return Lubricant.model_validate(_by_name(name))
    except ValueError as error:
        raise InputError(f"{name!r} {error}") from None


def _by_name(value: object) -> object:
    """Return the table of a name, a table as it is."""
    if isinstance(value, Mapping | Lubricant):
        return value
    known = _tables()
    if not isinstance(value, str):
        raise ValueError(
            f"must be the name of an oil ({', '.join(known)}) or a table with viscosity and density"
        )
    if value in known:
        return known[value]
    close = difflib.get_close_matches(value, known, n=1)
    guess = f"did you mean {close[0]}? " if close else ""
    raise ValueError(
        f"is no known oil: {guess}known are {', '.join(known)}; or give a table with "
        "viscosity and density"
    )


NamedLubricant = Annotated[
    Lubricant, BeforeValidator(_by_name, json_schema_input_type=str | Lubricant)
]
