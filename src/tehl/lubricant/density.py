"""Density laws: density as a function of pressure and temperature."""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from tehl.lubricant.tait import TaitDensity
from tehl.units import Density, PressureCoefficient, Temperature, TemperatureCoefficient

if TYPE_CHECKING:
    from tehl.typing import Array


LARGEST_LOSS = 0.9
"""Most of the ambient density that heat may take, far beyond where a law holds."""


class DowsonHigginson(BaseModel):
    r"""Dowson and Higginson's law, with a linear fall with temperature.

    .. math:: \rho = \rho_0 \left(1 + \frac{s p}{1 + c p}\right) [1 - \beta (T - T_0)]

    or, with ``form = "additive"``, :math:`\rho_0 [1 + s p/(1 + c p) - \beta (T - T_0)]`.

    Attributes
    ----------
    rho_0 : float
        Density at ambient pressure and ``reference_temperature`` [kg/m^3].
    slope : float
        s, compressibility at ambient pressure [1/Pa]. The pair (0.6e-9, 1.7e-9) is the usual
        rounding; (0.58e-9, 1.69e-9) is ``(5.9e8 + 1.34 p)/(5.9e8 + p)`` rounded.
    saturation : float
        c [1/Pa]; the density never exceeds ``rho_0 (1 + s/c)``.
    beta : float
        Thermal expansion [1/K].
    form : {"product", "additive"}
        How pressure and temperature combine.
    reference_temperature : float
        T_0 [K].

    References
    ----------
    .. [1] D. Dowson and G. R. Higginson, Elasto-hydrodynamic Lubrication, Pergamon, 1966.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    law: Literal["dowson-higginson"] = "dowson-higginson"
    rho_0: Density
    slope: PressureCoefficient = 0.6e-9
    saturation: PressureCoefficient = 1.7e-9
    beta: TemperatureCoefficient = 0.0
    form: Literal["product", "additive"] = "product"
    reference_temperature: Temperature = 313.15

    def ambient(self, temperature: float) -> float:
        """Return the density [kg/m^3] at ambient pressure and ``temperature`` [K]."""
        loss = self.beta * (temperature - self.reference_temperature)
        return self.rho_0 * (1.0 - min(loss, LARGEST_LOSS))

    def density(self, pressure: "Array", temperature: "Array | float") -> "Array":
        """Return the density [kg/m^3] at ``pressure`` [Pa] and ``temperature`` [K]."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        pressure = np.asarray(pressure, dtype=np.float64)
        ratio = 1.0 + self.slope * pressure / (1.0 + self.saturation * pressure)
        if self.beta > 0:
            loss = self.beta * (temperature - self.reference_temperature)
            loss = np.minimum(loss, LARGEST_LOSS)
            ratio = ratio - loss if self.form == "additive" else ratio * (1.0 - loss)
        return self.rho_0 * ratio


class ConstantDensity(BaseModel):
    """An incompressible liquid.

    Attributes
    ----------
    rho_0 : float
        Density [kg/m^3].
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    law: Literal["constant"] = "constant"
    rho_0: Density

    def ambient(self, temperature: float) -> float:
        """Return rho_0 [kg/m^3] at any ``temperature`` [K]."""
        del temperature
        return self.rho_0

    def density(self, pressure: "Array", temperature: "Array | float") -> "Array":
        """Return rho_0 [kg/m^3] in the shape of ``pressure`` and ``temperature``."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        shape = np.broadcast_shapes(np.shape(pressure), np.shape(temperature))
        return np.full(shape, self.rho_0)


DensityLaw = Annotated[DowsonHigginson | TaitDensity | ConstantDensity, Field(discriminator="law")]
