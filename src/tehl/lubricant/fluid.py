"""The lubricant: its laws and thermal properties, and the library of named oils."""

import difflib
import tomllib
from functools import cache
from importlib import resources
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict

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
    shear : Newtonian
        Law of the shear stress.
    conductivity, heat_capacity : float or None
        [W/m/K] and [J/kg/K]; only needed when heat is computed.
    name, source : str or None
        Where the numbers come from.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    viscosity: ViscosityLaw
    density: DensityLaw
    shear: ShearLaw = Newtonian()
    conductivity: Conductivity | None = None
    heat_capacity: HeatCapacity | None = None
    name: str | None = None
    source: str | None = None


@cache
def library() -> dict[str, Lubricant]:
    """Return the named oils, by name."""
    text = resources.files("tehl.lubricant").joinpath("oils.toml").read_text(encoding="utf-8")
    return {name: Lubricant(name=name, **laws) for name, laws in tomllib.loads(text).items()}


def oil(name: str) -> Lubricant:
    """Return the oil called ``name``.

    Raises
    ------
    ValueError
        If the library does not have it; the message lists what it has.
    """
    known = library()
    if name in known:
        return known[name]
    close = difflib.get_close_matches(name, known, n=1)
    guess = f"did you mean {close[0]!r}? " if close else ""
    raise ValueError(
        f"is not a known oil: {guess}Known are {', '.join(known)}; or give a table with viscosity "
        "and density"
    )


def _by_name(value: object) -> object:
    return oil(value) if isinstance(value, str) else value


NamedLubricant = Annotated[
    Lubricant, BeforeValidator(_by_name, json_schema_input_type=str | Lubricant)
]
