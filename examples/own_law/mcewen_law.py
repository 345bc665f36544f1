"""McEwen's viscosity as a law of tehl, J. Institute of Petroleum 38 (1952) 646-672."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from tehl.base.units import PressureCoefficient, Temperature, TemperatureCoefficient, Viscosity
from tehl.lubricant import ViscosityModel


class McEwen(ViscosityModel):
    """A power of the pressure, with an exponential fall with temperature."""

    law: Literal["mcewen"] = "mcewen"
    eta_0: Viscosity
    """Viscosity at ambient pressure and ``reference_temperature`` [Pa s]."""
    alpha: PressureCoefficient
    """Pressure coefficient at ambient pressure [1/Pa]."""
    q: Annotated[float, Field(gt=0.0, le=100.0)]
    """Exponent [-]; the law of Barus in the limit of large q."""
    gamma: TemperatureCoefficient = 0.0
    """Temperature coefficient [1/K]; zero: independent of temperature."""
    reference_temperature: Temperature = 313.15
    """T_0 [K]."""

    def viscosity(self, pressure, temperature):
        """Return the viscosity [Pa s]; pressure [Pa] and temperature [K]: numbers or arrays."""
        growth = self.q * np.log1p(self.alpha * pressure / self.q)
        return self.eta_0 * np.exp(growth - self.gamma * (temperature - self.reference_temperature))
