"""Solids: elastic and thermal properties, and the library of named materials."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, ClassVar

from pydantic import BeforeValidator, Field, ValidationInfo

from tehl.base.errors import InputError
from tehl.base.named import Library
from tehl.base.table import Table, folder_of
from tehl.base.units import (
    Pressure,
    SolidConductivity,
    SolidDensity,
    SolidExpansion,
    SolidHeatCapacity,
)


class Solid(Table):
    """An elastic solid."""

    synonyms: ClassVar = {
        "young_modulus": "e youngs_modulus elastic_modulus e_modulus modulus",
        "poisson_ratio": "nu poisson poissons_ratio",
        "density": "rho",
        "heat_capacity": "c cp c_p specific_heat",
        "conductivity": "k thermal_conductivity",
    }

    young_modulus: Pressure
    """E [Pa]."""
    poisson_ratio: Annotated[float, Field(gt=-1.0, le=0.5, allow_inf_nan=False, examples=[0.3])]
    """nu [-], between -1 and 0.5."""
    density: SolidDensity | None = None
    heat_capacity: SolidHeatCapacity | None = None
    conductivity: SolidConductivity | None = None
    """Thermal properties [kg/m^3], [J/kg/K], [W/m/K]; only needed when heat is computed."""
    expansion: SolidExpansion | None = None
    """Thermal expansion of a length [1/K]: only needed for thermal stress."""
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


SOLIDS = Library(
    Path(__file__).with_name("solids.toml"),
    "solid",
    "solid",
    "young_modulus and poisson_ratio",
    Solid,
)


def material(name: str) -> Solid:
    """Return the solid called ``name``, of the package or of the user's own library.

    Raises
    ------
    InputError
        If no library has it.
    """
    try:
        return Solid.model_validate(SOLIDS.find(name).table)
    except ValueError as error:
        raise InputError(f"{name!r} {error}") from None


def _by_name(value: object, info: ValidationInfo) -> object:
    """Return the table of a named solid, with what the case adds; others as they are."""
    folder = folder_of(info)
    if isinstance(value, str | Mapping | Solid):
        return SOLIDS.stated(value, folder)
    known = SOLIDS.listed(folder)
    raise ValueError(f"must be the name of a solid ({known}) or a table with {SOLIDS.needs}")


SolidName = Annotated[str, SOLIDS]


class SolidByName(Table):
    """A named solid with what replaces its own, as the JSON schema of a case shows it."""

    solid: SolidName | str
    """Of the package, or of ``solids.toml`` beside the case or in the configuration folder."""
    young_modulus: Pressure | None = None
    poisson_ratio: float | None = None
    density: SolidDensity | None = None
    heat_capacity: SolidHeatCapacity | None = None
    conductivity: SolidConductivity | None = None
    expansion: SolidExpansion | None = None
    hardness: Pressure | None = None
    transparent: bool | None = None
    name: str | None = None
    source: str | None = None


NamedSolid = Annotated[
    Solid, BeforeValidator(_by_name, json_schema_input_type=SolidName | Solid | SolidByName)
]
