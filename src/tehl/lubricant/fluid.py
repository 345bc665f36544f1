"""The lubricant: its laws and thermal properties, and the library of named oils."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidationInfo,
    field_validator,
)

from tehl.base.errors import InputError
from tehl.base.named import Library
from tehl.base.table import Table, folder_of
from tehl.base.typing import Array
from tehl.base.units import Conductivity, HeatCapacity, Pressure, PressureCoefficient, Temperature
from tehl.lubricant.density import DensityLaw
from tehl.lubricant.law import Law
from tehl.lubricant.shear import Newtonian, ShearLaw
from tehl.lubricant.viscosity import ViscosityLaw
from tehl.lubricant.walther import Walther


class ConductivityOfPressure(Law):
    """A thermal conductivity that grows with pressure, ``value (1 + s p / (1 + c p))``.

    References
    ----------
    .. [1] R. Larsson and O. Andersson, Proc. IMechE Part J 214 (2000), 337-342.
    """

    value: Conductivity
    """At ambient pressure [W/m/K]."""
    slope: Annotated[PressureCoefficient, Field(examples=["1.4 1/GPa"])]
    saturation: PressureCoefficient = 0.0
    """s and c [1/Pa]."""


class HeatCapacityOfPressure(Law):
    """A heat capacity that changes with pressure, ``value (1 + s p / (1 + c p))``.

    References
    ----------
    .. [1] R. Larsson and O. Andersson, Proc. IMechE Part J 214 (2000), 337-342.
    """

    value: HeatCapacity
    """Per mass, at ambient pressure [J/kg/K]."""
    slope: Annotated[PressureCoefficient, Field(examples=["0.5 1/GPa"])]
    saturation: PressureCoefficient = 0.0
    """s and c [1/Pa]."""
    basis: Literal["mass", "volume"] = "mass"
    """Whether it is the capacity of a mass or of a volume that grows so. Measured is that of a
    volume: most of its growth is that of the density, and the one of a mass hardly changes."""


class Limits(Table):
    """Conditions in which the constants of an oil are known."""

    temperature: tuple[Temperature, Temperature] | None = None
    """Lowest and highest temperature [K]."""
    pressure: Pressure | None = None
    """Largest pressure [Pa]."""


def _number_or_table(value: object) -> str:
    return "table" if isinstance(value, Mapping | BaseModel) else "number"


AnyConductivity = Annotated[
    Annotated[Conductivity, Tag("number")] | Annotated[ConductivityOfPressure, Tag("table")],
    Discriminator(_number_or_table),
]
AnyHeatCapacity = Annotated[
    Annotated[HeatCapacity, Tag("number")] | Annotated[HeatCapacityOfPressure, Tag("table")],
    Discriminator(_number_or_table),
]


class Lubricant(Law):
    """An oil."""

    synonyms: ClassVar = {
        "viscosity.eta_0": "eta eta0 eta_0 dynamic_viscosity viscosity_0",
        "viscosity.alpha": "alpha pressure_coefficient pressure_viscosity_coefficient",
        "viscosity.nu_40": "nu_40 viscosity_40 kinematic_viscosity",
        "viscosity.nu_100": "nu_100 viscosity_100",
        "shear.stress": "eyring_stress shear_stress limiting_shear_stress",
        "heat_capacity": "cp specific_heat",
        "temperature": "inlet_temperature oil_temperature",
        "name": "grade",
    }

    density: DensityLaw
    """Law with the method ``density(pressure, temperature)``."""
    viscosity: ViscosityLaw
    """Law with the method ``viscosity(pressure, temperature)``. A Walther law that states no
    density takes that of the density law at 40 degC."""
    shear: ShearLaw = Newtonian()
    """Law of the shear stress, see :mod:`tehl.lubricant.shear`."""
    conductivity: AnyConductivity | None = None
    heat_capacity: AnyHeatCapacity | None = None
    """[W/m/K] and [J/kg/K]; only needed when heat is computed. Numbers, or tables for properties
    that grow with pressure: see :meth:`conductivity_at` and :meth:`heat_capacity_at`."""
    temperature: Temperature | None = None
    """Temperature of the oil at the inlet [K]; None is the reference temperature of the
    viscosity."""
    name: str | None = None
    source: str | None = None
    """Where the numbers come from."""
    limits: Limits | None = None
    """Where the constants hold; `tehl explain` asks about contacts outside."""

    @field_validator("viscosity", mode="after")
    @classmethod
    def _lend_density(cls, law: ViscosityLaw, info: ValidationInfo) -> ViscosityLaw:
        density = info.data.get("density")
        if isinstance(law, Walther) and law.density is None and density is not None:
            return law.model_copy(update={"density": density.ambient(law.reference_temperature)})
        return law

    @property
    def ambient_conductivity(self) -> float | None:
        """Return the thermal conductivity at ambient pressure [W/m/K], None if not stated."""
        return _ambient(self.conductivity)

    @property
    def ambient_heat_capacity(self) -> float | None:
        """Return the heat capacity at ambient pressure [J/kg/K], None if not stated."""
        return _ambient(self.heat_capacity)

    def conductivity_at(self, pressure: Array) -> Array:
        """Return the conductivity [W/m/K] at ``pressure`` [Pa]; raise InputError without one."""
        return _grown(self.conductivity, "conductivity", pressure)

    def heat_capacity_at(self, pressure: Array) -> Array:
        """Return the heat capacity [J/kg/K] at ``pressure`` [Pa]; raise InputError without one."""
        grown, stated = _grown(self.heat_capacity, "heat_capacity", pressure), self.heat_capacity
        if isinstance(stated, HeatCapacityOfPressure) and stated.basis == "volume":
            at = self.viscosity.reference_temperature
            grown *= self.density.ambient(at) / self.density.density(pressure, at)
        return grown


Property = float | ConductivityOfPressure | HeatCapacityOfPressure | None


def _ambient(stated: Property) -> float | None:
    return stated.value if isinstance(stated, Law) else stated


def _grown(stated: Property, name: str, pressure: Array) -> Array:
    """Return a property at ``pressure`` [Pa]."""
    if stated is None:
        raise InputError(f"lubricant.{name} is missing: heat is not computed without it")
    if isinstance(stated, Law):
        growth = stated.slope * pressure / (1.0 + stated.saturation * pressure)
        return stated.value * (1.0 + growth)
    return stated + 0.0 * pressure


OILS = Library(
    Path(__file__).with_name("oils.toml"),
    "oil",
    "oil",
    "viscosity and density, such as that of tehl new data-sheet",
    Lubricant,
)
OilName = Annotated[str, OILS]
_LAWS = {"viscosity", "density"}


def oil(name: str) -> Lubricant:
    """Return the oil called ``name``, of the package or of the user's own library.

    Raises
    ------
    InputError
        If no library has it.
    """
    try:
        return Lubricant.model_validate(OILS.find(name).table)
    except ValueError as error:
        raise InputError(f"{name!r} {error}") from None


def _by_name(value: object, info: ValidationInfo) -> object:
    return oil_table(value, folder_of(info))


def oil_table(value: object, folder: Path | None) -> Any:
    """Return the table of a named oil, with what the case adds; others as they are.

    Parameters
    ----------
    value : str, Mapping or Lubricant
        As a case states it.
    folder : Path or None
        Of the case, where an own library may be.
    """
    if isinstance(value, str | Mapping | Lubricant):
        alone = isinstance(value, Mapping) and not {OILS.key, *_LAWS} & set(value)
        return OILS.stated(value, folder, "name" if alone else OILS.key)
    known = OILS.listed(folder)
    raise ValueError(f"must be the name of an oil ({known}) or a table with viscosity and density")


class OilByName(Table):
    """A named oil with what replaces its own, as the JSON schema of a case shows it."""

    model_config = ConfigDict(
        json_schema_extra={"anyOf": [{"required": ["oil"]}, {"required": ["name"]}]}
    )

    oil: OilName | str | None = None
    """Of the package, or of ``oils.toml`` beside the case or in the configuration folder."""
    viscosity: dict[str, Any] | None = None
    density: dict[str, Any] | None = None
    """Single constants, or another law."""
    shear: ShearLaw | None = None
    conductivity: AnyConductivity | None = None
    heat_capacity: AnyHeatCapacity | None = None
    temperature: Temperature | None = None
    name: OilName | str | None = None
    """Its name in outputs; that of a known oil if ``oil`` is left out."""
    source: str | None = None


NamedLubricant = Annotated[
    Lubricant, BeforeValidator(_by_name, json_schema_input_type=OilName | Lubricant | OilByName)
]
"""An oil: by its name, by its laws, or by a name with other constants or a ``temperature``."""
