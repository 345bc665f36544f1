"""Density laws: density as a function of pressure and temperature."""

import math
from typing import Annotated, Literal

from pydantic import Discriminator

from tehl.base.units import Density, PressureCoefficient, Temperature, TemperatureCoefficient
from tehl.lubricant.law import FORTY_DEGREES, DensityModel, Values, limited
from tehl.lubricant.registered import RegisteredLaws
from tehl.lubricant.tait import TaitDensity
from tehl.lubricant.trial import try_density

LARGEST_LOSS = 0.9
"""Most of the ambient density that heat may take, far beyond where a law holds."""


class DowsonHigginson(DensityModel):
    r"""Dowson and Higginson's law, with a linear fall with temperature.

    .. math:: \rho = \rho_0 \left(1 + \frac{s p}{1 + c p}\right) [1 - \beta (T - T_0)]

    or, with ``form = "additive"``, :math:`\rho_0 [1 + s p/(1 + c p) - \beta (T - T_0)]`.

    References
    ----------
    .. [1] D. Dowson and G. R. Higginson, Elasto-hydrodynamic Lubrication, Pergamon, 1966.
    """

    law: Literal["dowson-higginson"] = "dowson-higginson"
    rho_0: Density
    """Density at ambient pressure and ``reference_temperature`` [kg/m^3]."""
    slope: PressureCoefficient = 0.6e-9
    """s, compressibility at ambient pressure [1/Pa]. The pair (0.6e-9, 1.7e-9) is the usual
    rounding; (0.58e-9, 1.69e-9) is ``(5.9e8 + 1.34 p)/(5.9e8 + p)`` rounded."""
    saturation: PressureCoefficient = 1.7e-9
    """c [1/Pa]; the density never exceeds ``rho_0 (1 + s/c)``."""
    beta: TemperatureCoefficient = 0.0
    """Thermal expansion [1/K]."""
    form: Literal["product", "additive"] = "product"
    """How pressure and temperature combine."""
    reference_temperature: Temperature = FORTY_DEGREES
    """T_0 [K]."""

    def density(self, pressure: Values, temperature: Values | float) -> Values:
        """Return the density [kg/m^3] at ``pressure`` [Pa] and ``temperature`` [K].

        Parameters
        ----------
        pressure : float or Array
            Gauge pressure [Pa], above -1/saturation.
        temperature : float or Array
            Absolute [K]; the thermal loss of density is limited to `LARGEST_LOSS`.
        """
        ratio = 1.0 + self.slope * pressure / (1.0 + self.saturation * pressure)
        if self.beta > 0:
            warmer = temperature - self.reference_temperature
            loss = limited(self.beta * warmer, -math.inf, LARGEST_LOSS)
            ratio = ratio - loss if self.form == "additive" else ratio * (1.0 - loss)
        return self.rho_0 * ratio


class ConstantDensity(DensityModel):
    """An incompressible liquid."""

    law: Literal["constant"] = "constant"
    rho_0: Density
    """Density [kg/m^3]."""

    def density(self, pressure: Values, temperature: Values | float) -> Values:
        """Return rho_0 [kg/m^3] in the shape of ``pressure`` and ``temperature``."""
        return self.rho_0 + 0.0 * (pressure + temperature)


DensityLaw = Annotated[
    DowsonHigginson | TaitDensity | ConstantDensity,
    Discriminator("law"),
    RegisteredLaws(DensityModel, try_density),
]
