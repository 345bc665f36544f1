"""Solids: elastic and thermal properties, and the library of named materials."""

import difflib
import tomllib
from functools import cache
from importlib import resources
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

from tehl.units import Conductivity, Density, HeatCapacity, Pressure


class Solid(BaseModel):
    """An elastic solid.

    Attributes
    ----------
    young_modulus : float
        E [Pa].
    poisson_ratio : float
        nu [-], between -1 and 0.5.
    density, heat_capacity, conductivity : float or None
        Thermal properties [kg/m^3], [J/kg/K], [W/m/K]; only needed when heat is computed.
    name, source : str or None
        Where the numbers come from.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    young_modulus: Pressure
    poisson_ratio: Annotated[float, Field(gt=-1.0, le=0.5, allow_inf_nan=False)]
    density: Density | None = None
    heat_capacity: HeatCapacity | None = None
    conductivity: Conductivity | None = None
    name: str | None = None
    source: str | None = None

    @property
    def compliance(self) -> float:
        """Return ``(1 - nu^2) / E`` [1/Pa]."""
        return (1.0 - self.poisson_ratio**2) / self.young_modulus

    @property
    def diffusivity(self) -> float | None:
        """Return the thermal diffusivity [m^2/s], None when a property is not stated."""
        if self.density is None or self.heat_capacity is None or self.conductivity is None:
            return None
        return self.conductivity / (self.density * self.heat_capacity)


def reduced_modulus(first: Solid, second: Solid) -> float:
    """Return E' with ``2/E' = (1-nu_1^2)/E_1 + (1-nu_2^2)/E_2`` [Pa]; twice the contact modulus."""
    return 2.0 / (first.compliance + second.compliance)


@cache
def library() -> dict[str, Solid]:
    """Return the named solids, by name."""
    text = resources.files("tehl").joinpath("materials.toml").read_text(encoding="utf-8")
    return {
        name: Solid(name=name, **properties) for name, properties in tomllib.loads(text).items()
    }


def material(name: str) -> Solid:
    """Return the solid called ``name``.

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
        f"is not a known material: {guess}Known are {', '.join(known)}; or give a table with "
        "young_modulus and poisson_ratio"
    )


def _by_name(value: object) -> object:
    return material(value) if isinstance(value, str) else value


NamedSolid = Annotated[Solid, BeforeValidator(_by_name, json_schema_input_type=str | Solid)]
