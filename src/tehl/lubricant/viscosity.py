"""Viscosity laws: dynamic viscosity as a function of pressure and temperature."""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from tehl.lubricant.exponent import exponential, exponential_at, temperature_law
from tehl.lubricant.roelands import Roelands, RoelandsExponential
from tehl.lubricant.tait import TaitDoolittle
from tehl.lubricant.walther import Walther
from tehl.units import PressureCoefficient, Temperature, TemperatureCoefficient, Viscosity

if TYPE_CHECKING:
    from tehl.typing import Array


class Barus(BaseModel):
    r"""Barus' law, exponential in pressure and temperature.

    .. math:: \eta = \eta_0 \exp\{\alpha p - \gamma (T - T_0)\}

    Attributes
    ----------
    eta_0 : float
        Viscosity at ambient pressure and ``reference_temperature`` [Pa s].
    alpha : float
        Pressure coefficient [1/Pa].
    gamma : float or None
        Temperature coefficient [1/K]; None when the law knows no temperature.
    reference_temperature : float
        T_0 [K].
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    law: Literal["barus"] = "barus"
    eta_0: Viscosity
    alpha: PressureCoefficient
    gamma: TemperatureCoefficient | None = None
    reference_temperature: Temperature = 313.15

    @property
    def pressure_coefficient(self) -> float:
        """Return alpha [1/Pa]."""
        return self.alpha

    @property
    def temperature_coefficient(self) -> float:
        """Return gamma [1/K], zero when it is not stated."""
        return self.gamma or 0.0

    @property
    def temperature_law(self) -> str:
        """Return the name of the law and of its fall with temperature."""
        return temperature_law("barus", "gamma", self.temperature_coefficient)

    def ambient(self, temperature: float) -> float:
        """Return the viscosity [Pa s] at ambient pressure and ``temperature`` [K]."""
        warmer = temperature - self.reference_temperature
        return exponential_at(self.eta_0, -self.temperature_coefficient * warmer)

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return alpha [1/Pa] at any ``temperature`` [K]."""
        del temperature
        return self.alpha

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return gamma [1/K] at any ``temperature`` [K]."""
        del temperature
        return self.temperature_coefficient

    def viscosity_at(self, pressure: float, temperature: float) -> float:
        """Return the viscosity [Pa s] at one ``pressure`` [Pa] and ``temperature`` [K]."""
        return exponential_at(self.ambient(temperature), self.alpha * pressure)

    def viscosity(self, pressure: "Array", temperature: "Array | float") -> "Array":
        """Return the viscosity [Pa s] at ``pressure`` [Pa] and ``temperature`` [K]."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        growth = np.asarray(self.alpha * pressure, dtype=np.float64)
        if self.temperature_coefficient > 0:
            warmer = temperature - self.reference_temperature
            growth = growth - self.temperature_coefficient * warmer
        return exponential(self.eta_0, growth)


class ConstantViscosity(BaseModel):
    """A liquid whose viscosity knows neither pressure nor temperature.

    Attributes
    ----------
    eta_0 : float
        Viscosity [Pa s].
    reference_temperature : float
        Temperature at which it holds [K].
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    law: Literal["constant"] = "constant"
    eta_0: Viscosity
    reference_temperature: Temperature = 313.15

    @property
    def pressure_coefficient(self) -> float:
        """Return zero [1/Pa]."""
        return 0.0

    @property
    def temperature_coefficient(self) -> float:
        """Return zero [1/K]."""
        return 0.0

    @property
    def temperature_law(self) -> str:
        """Return the name of the law and of its fall with temperature."""
        return temperature_law("constant", "", 0.0)

    def ambient(self, temperature: float) -> float:
        """Return eta_0 [Pa s] at any ``temperature`` [K]."""
        del temperature
        return self.eta_0

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return zero [1/Pa] at any ``temperature`` [K]."""
        del temperature
        return 0.0

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return zero [1/K] at any ``temperature`` [K]."""
        del temperature
        return 0.0

    def viscosity_at(self, pressure: float, temperature: float) -> float:
        """Return eta_0 [Pa s] at any ``pressure`` [Pa] and ``temperature`` [K]."""
        del pressure, temperature
        return self.eta_0

    def viscosity(self, pressure: "Array", temperature: "Array | float") -> "Array":
        """Return eta_0 [Pa s] in the shape of ``pressure`` and ``temperature``."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        shape = np.broadcast_shapes(np.shape(pressure), np.shape(temperature))
        return np.full(shape, self.eta_0)


ViscosityLaw = Annotated[
    Roelands | RoelandsExponential | Barus | Walther | TaitDoolittle | ConstantViscosity,
    Field(discriminator="law"),
]
