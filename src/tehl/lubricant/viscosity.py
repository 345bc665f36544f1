"""Viscosity laws: dynamic viscosity as a function of pressure and temperature."""

from typing import Annotated, Literal, Self

from pydantic import Discriminator, model_validator

from tehl.base.units import Temperature, TemperatureCoefficient, Viscosity
from tehl.lubricant.law import FORTY_DEGREES, ExponentialFall, Values, ViscosityModel
from tehl.lubricant.pressure import NEEDED, Alpha, pressure_coefficient_of
from tehl.lubricant.registered import RegisteredLaws
from tehl.lubricant.roelands import Roelands, RoelandsExponential
from tehl.lubricant.tait import TaitDoolittle
from tehl.lubricant.trial import try_viscosity
from tehl.lubricant.walther import Walther


class Barus(ExponentialFall):
    r"""Barus' law, exponential in pressure and temperature.

    .. math:: \eta = \eta_0 \exp\{\alpha p - \gamma (T - T_0)\}
    """

    law: Literal["barus"] = "barus"
    eta_0: Viscosity
    """Viscosity at ambient pressure and ``reference_temperature`` [Pa s]."""
    alpha: Alpha | None = None
    """Pressure coefficient [1/Pa], or "estimated"."""
    gamma: TemperatureCoefficient | None = None
    """Temperature coefficient [1/K]; None: independent of temperature."""
    reference_temperature: Temperature = FORTY_DEGREES
    """T_0 [K]."""

    @model_validator(mode="after")
    def _must_have_a_slope(self) -> Self:
        if self.alpha is None:
            raise ValueError(NEEDED.replace("exactly one of alpha and z", "alpha"))
        pressure_coefficient_of(self.alpha, self.eta_0)  # raises where none can be estimated
        return self

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return alpha [1/Pa] at any ``temperature`` [K]."""
        del temperature
        return pressure_coefficient_of(self.alpha, self.eta_0)

    def _growth(self, pressure: Values) -> Values:
        return self.pressure_coefficient * pressure


class ConstantViscosity(ViscosityModel):
    """A viscosity independent of pressure and temperature."""

    law: Literal["constant"] = "constant"
    eta_0: Viscosity
    """Viscosity [Pa s]."""
    reference_temperature: Temperature = FORTY_DEGREES
    """Temperature at which it holds [K]."""

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return zero [1/Pa] at any ``temperature`` [K]."""
        del temperature
        return 0.0

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return zero [1/K] at any ``temperature`` [K]."""
        del temperature
        return 0.0

    def viscosity(self, pressure: Values, temperature: Values | float) -> Values:
        """Return eta_0 [Pa s] in the shape of ``pressure`` and ``temperature``."""
        return self.eta_0 + 0.0 * (pressure + temperature)


ViscosityLaw = Annotated[
    Roelands | RoelandsExponential | Barus | Walther | TaitDoolittle | ConstantViscosity,
    Discriminator("law"),
    RegisteredLaws(ViscosityModel, try_viscosity),
]
