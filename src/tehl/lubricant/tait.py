r"""Tait's equation of state, and Doolittle's free volume on top of it.

.. math:: \frac{V}{V_R} = [1 + a_V (T - T_0)]
          \left\{1 - \frac{1}{1 + K_0'} \ln\left[1 + \frac{p}{K_0}(1 + K_0')\right]\right\}, \quad
          K_0 = K_{0R}\, e^{-\beta_K (T - T_0)}

Published sets often give ``K_00`` with ``K_0 = K_00 exp(-beta_K T)``: then
``bulk_modulus = K_00 exp(-beta_K T_0)``.

References
----------
.. [1] S. Bair, High-Pressure Rheology for Quantitative Elastohydrodynamics, Elsevier, 2007.
.. [2] S. Bair, Tribology Letters 22 (2006), 197-206 (squalane).
"""

from typing import Annotated, Any, Literal

from pydantic import Field

from tehl.base.units import (
    BulkModulus,
    Density,
    SignedTemperatureCoefficient,
    Temperature,
    TemperatureCoefficient,
    Viscosity,
)
from tehl.lubricant.law import (
    FORTY_DEGREES,
    DensityModel,
    Values,
    ViscosityModel,
    exponential,
    functions,
    limited,
)

LEAST_VOLUME = 0.2
"""Least part of a volume that the equations of this module compress or cool to."""

Slope = Annotated[float, Field(gt=0.0, le=100.0, allow_inf_nan=False, examples=[11.0])]


class TaitDensity(DensityModel):
    r"""Tait's equation of state, ``rho = rho_0 V_R / V``."""

    law: Literal["tait"] = "tait"
    rho_0: Density
    """Density at ambient pressure and ``reference_temperature`` [kg/m^3]."""
    bulk_modulus: BulkModulus
    """K_0R at ambient pressure and ``reference_temperature`` [Pa]."""
    bulk_modulus_slope: Slope = 11.0
    """K_0', its slope by pressure [-]; about 11 for all oils."""
    expansion: TemperatureCoefficient = 0.0
    """a_V, thermal expansion of the volume [1/K]."""
    softening: TemperatureCoefficient = 0.0
    """beta_K, fall of the bulk modulus with temperature [1/K]; about 0.006 for oils."""
    reference_temperature: Temperature = FORTY_DEGREES
    """T_0 [K]."""

    def density(self, pressure: Values, temperature: Values | float) -> Values:
        """Return the density [kg/m^3] at ``pressure`` [Pa] and ``temperature`` [K]."""
        return self.rho_0 / _relative_volume(self, pressure, temperature)


class TaitDoolittle(ViscosityModel):
    r"""Doolittle's law: the viscosity follows the free volume.

    .. math:: \eta = \eta_0 \exp\left\{B R_0 \left[\frac{v}{V/V_R - R_0 v}
              - \frac{1}{1 - R_0}\right]\right\}, \quad v = 1 + \varepsilon (T - T_0)

    with the volume of :mod:`tehl.lubricant.tait`. Where the equation of state leaves no free volume
    (above about 2 GPa), the oil is a solid.
    """

    FALL = "free volume"

    law: Literal["tait-doolittle"] = "tait-doolittle"
    eta_0: Viscosity
    """Viscosity at ambient pressure and ``reference_temperature`` [Pa s]."""
    B: Annotated[float, Field(gt=0.0, le=100.0, allow_inf_nan=False, examples=[4.7])]
    """Doolittle parameter [-]; 3 to 6 for oils."""
    occupied: Annotated[float, Field(gt=0.0, lt=1.0, allow_inf_nan=False, examples=[0.66])]
    """R_0, occupied part of the volume at ambient pressure and ``reference_temperature`` [-]."""
    occupied_expansion: SignedTemperatureCoefficient = 0.0
    """epsilon, thermal expansion of the occupied volume [1/K]; about -1e-3 for oils."""
    bulk_modulus: BulkModulus
    bulk_modulus_slope: Slope = 11.0
    expansion: TemperatureCoefficient = 0.0
    softening: TemperatureCoefficient = 0.0
    """K_0R [Pa], K_0' [-], a_V [1/K] and beta_K [1/K] of the equation of state."""
    reference_temperature: Temperature = FORTY_DEGREES
    """T_0 [K]."""

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return ``d ln eta / dp`` [1/Pa] at ambient pressure and ``temperature`` [K]."""
        slope = _volume(self, temperature) / _modulus(self, temperature)
        return self.B * self._core(temperature) * slope / self._free(0.0, temperature) ** 2

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return ``-d ln eta / dT`` [1/K] at ambient pressure and ``temperature`` [K]."""
        shrinking = self.occupied * self.occupied_expansion * _volume(self, temperature)
        gain = self._core(temperature) * self.expansion - shrinking
        return self.B * gain / self._free(0.0, temperature) ** 2

    def _core(self, temperature: Any) -> Any:
        warmer = temperature - self.reference_temperature
        return self.occupied * limited(1.0 + self.occupied_expansion * warmer, 0.0)

    def _free(self, pressure: Any, temperature: Any) -> Any:
        volume = _relative_volume(self, pressure, temperature)
        return limited(volume - self._core(temperature), 1e-4)  # it is a glass long before

    def viscosity(self, pressure: Values, temperature: Values | float) -> Values:
        """Return the viscosity [Pa s] at ``pressure`` [Pa] and ``temperature`` [K]."""
        ratio = self._core(temperature) / self._free(pressure, temperature)
        return exponential(self.eta_0, self.B * (ratio - self.occupied / (1.0 - self.occupied)))


def _relative_volume(law: TaitDensity | TaitDoolittle, pressure: Any, temperature: Any) -> Any:
    """Return ``V / V_R`` [-] at ``pressure`` [Pa] and ``temperature`` [K]."""
    steepness = 1.0 + law.bulk_modulus_slope
    strain = limited(steepness * pressure / _modulus(law, temperature), -0.9)
    squeezed = 1.0 - functions(strain).log1p(strain) / steepness
    return limited(squeezed, LEAST_VOLUME) * _volume(law, temperature)


def _volume(law: TaitDensity | TaitDoolittle, temperature: Any) -> Any:
    """Return ``V / V_R`` [-] at ambient pressure."""
    return limited(1.0 + law.expansion * (temperature - law.reference_temperature), LEAST_VOLUME)


def _modulus(law: TaitDensity | TaitDoolittle, temperature: Any) -> Any:
    """Return K_0 [Pa]; at most 98 % are lost, as the exponential is one of moderate heat."""
    softer = -law.softening * (temperature - law.reference_temperature)
    return limited(exponential(law.bulk_modulus, softer), 0.02 * law.bulk_modulus)
