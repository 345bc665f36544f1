"""Solids: elastic and thermal properties, and the library of named materials."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

from pydantic import BeforeValidator, Field, WithJsonSchema

from tehl.base.errors import InputError
from tehl.base.named import find_table, known_names, read_tables
from tehl.base.table import Table
from tehl.base.units import Pressure, SolidConductivity, SolidDensity, SolidHeatCapacity


class Solid(Table):
    """An elastic solid."""

    young_modulus: Pressure
    """E [Pa]."""
    poisson_ratio: Annotated[float, Field(gt=-1.0, le=0.5, allow_inf_nan=False, examples=[0.3])]
    """nu [-], between -1 and 0.5."""
    density: SolidDensity | None = None
    heat_capacity: SolidHeatCapacity | None = None
    conductivity: SolidConductivity | None = None
    """Thermal properties [kg/m^3], [J/kg/K], [W/m/K]; only needed when heat is computed."""
    hardness: Pressure | None = None
    """Of indentation [Pa]: summits that would carry more yield."""
    transparent: bool = False
    """Whether film thickness can be measured through it by light: interferograms are drawn."""
    name: str | None = None
    source: str | None = None
    """Where the numbers come from."""

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
    """Return E' with ``2/E' = (1-nu_1^2)/E_1 + (1-nu_2^2)/E_2`` [Pa]; twice the contact modulus.

    Parameters
    ----------
    first, second : Solid
        Materials of both surfaces; the order has no effect.
    """
    return 2.0 / (first.compliance + second.compliance)


SOLIDS = Path(__file__).with_name("materials.toml")
_NEEDS = "young_modulus and poisson_ratio"


def material(name: str) -> Solid:
    """Return the solid called ``name``.

    Raises
    ------
    InputError
        If the library does not have it; the message lists what it has.
    """
    try:
        return Solid.model_validate(_by_name(name))
    except ValueError as error:
        raise InputError(f"{name!r} {error}") from None


def _by_name(value: object) -> object:
    """Return the table of a name; a table is returned unchanged."""
    if isinstance(value, Mapping | Solid):
        return value
    if not isinstance(value, str):
        known = ", ".join(read_tables(SOLIDS))
        raise ValueError(f"must be the name of a solid ({known}) or a table with {_NEEDS}")
    return find_table(SOLIDS, value, "solid", _NEEDS)


SolidName = Annotated[str, WithJsonSchema(known_names(SOLIDS))]
NamedSolid = Annotated[Solid, BeforeValidator(_by_name, json_schema_input_type=SolidName | Solid)]
