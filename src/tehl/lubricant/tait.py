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

import math
from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, Field

from tehl.lubricant.exponent import exponential, exponential_at, temperature_law
from tehl.units import (
    BulkModulus,
    Density,
    SignedTemperatureCoefficient,
    Temperature,
    TemperatureCoefficient,
    Viscosity,
)

if TYPE_CHECKING:
    from tehl.typing import Array

LEAST_VOLUME = 0.2
"""Least part of a volume that the equations of this module compress or cool to."""
LEAST_MODULUS = 0.02
"""Least part of the bulk modulus that heat leaves: the exponential is one of moderate heat."""
LEAST_FREE = 1e-4
"""Least free volume, in units of the reference volume: the oil is a glass long before."""

Slope = Annotated[float, Field(gt=0.0, le=100.0, allow_inf_nan=False, examples=[11.0])]


class _State(NamedTuple):
    """What the equation of state says at ambient pressure and one temperature."""

    volume: float
    modulus: float


class TaitDensity(BaseModel):
    r"""Tait's equation of state, ``rho = rho_0 V_R / V``.

    Attributes
    ----------
    rho_0 : float
        Density at ambient pressure and ``reference_temperature`` [kg/m^3].
    bulk_modulus : float
        K_0R at ambient pressure and ``reference_temperature`` [Pa].
    bulk_modulus_slope : float
        K_0', its slope by pressure [-]; about 11 for all oils.
    expansion : float
        a_V, thermal expansion of the volume [1/K].
    softening : float
        beta_K, fall of the bulk modulus with temperature [1/K]; about 0.006 for oils.
    reference_temperature : float
        T_0 [K].
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    law: Literal["tait"] = "tait"
    rho_0: Density
    bulk_modulus: BulkModulus
    bulk_modulus_slope: Slope = 11.0
    expansion: TemperatureCoefficient = 0.0
    softening: TemperatureCoefficient = 0.0
    reference_temperature: Temperature = 313.15

    def ambient(self, temperature: float) -> float:
        """Return the density [kg/m^3] at ambient pressure and ``temperature`` [K]."""
        warmer = temperature - self.reference_temperature
        return self.rho_0 / max(1.0 + self.expansion * warmer, LEAST_VOLUME)

    def density(self, pressure: "Array", temperature: "Array | float") -> "Array":
        """Return the density [kg/m^3] at ``pressure`` [Pa] and ``temperature`` [K]."""
        return self.rho_0 / relative_volume(self, pressure, temperature)


class TaitDoolittle(BaseModel):
    r"""Doolittle's law: the viscosity follows the free volume.

    .. math:: \eta = \eta_0 \exp\left\{B R_0 \left[\frac{v}{V/V_R - R_0 v}
              - \frac{1}{1 - R_0}\right]\right\}, \quad v = 1 + \varepsilon (T - T_0)

    with the volume of :mod:`tehl.lubricant.tait`. Where the equation of state leaves no free volume
    (above about 2 GPa), the oil is a solid.

    Attributes
    ----------
    eta_0 : float
        Viscosity at ambient pressure and ``reference_temperature`` [Pa s].
    B : float
        Doolittle parameter [-]; 3 to 6 for oils.
    occupied : float
        R_0, occupied part of the volume at ambient pressure and ``reference_temperature`` [-].
    occupied_expansion : float
        epsilon, thermal expansion of the occupied volume [1/K]; about -1e-3 for oils.
    bulk_modulus, bulk_modulus_slope, expansion, softening : float
        K_0R [Pa], K_0' [-], a_V [1/K] and beta_K [1/K] of the equation of state.
    reference_temperature : float
        T_0 [K].
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    law: Literal["tait-doolittle"] = "tait-doolittle"
    eta_0: Viscosity
    B: Annotated[float, Field(gt=0.0, le=100.0, allow_inf_nan=False, examples=[4.7])]
    occupied: Annotated[float, Field(gt=0.0, lt=1.0, allow_inf_nan=False, examples=[0.66])]
    occupied_expansion: SignedTemperatureCoefficient = 0.0
    bulk_modulus: BulkModulus
    bulk_modulus_slope: Slope = 11.0
    expansion: TemperatureCoefficient = 0.0
    softening: TemperatureCoefficient = 0.0
    reference_temperature: Temperature = 313.15

    @property
    def pressure_coefficient(self) -> float:
        """Return alpha at the reference temperature [1/Pa]."""
        return self.pressure_coefficient_at(self.reference_temperature)

    @property
    def temperature_coefficient(self) -> float:
        """Return ``-d ln eta / dT`` at the reference temperature [1/K]."""
        return self.temperature_coefficient_at(self.reference_temperature)

    @property
    def temperature_law(self) -> str:
        """Return the name of the law and of its fall with temperature."""
        return temperature_law("tait-doolittle", "free volume", self.temperature_coefficient)

    def ambient(self, temperature: float) -> float:
        """Return the viscosity [Pa s] at ambient pressure and ``temperature`` [K]."""
        return self.viscosity_at(0.0, temperature)

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return ``d ln eta / dp`` [1/Pa] at ambient pressure and ``temperature`` [K]."""
        state, core = self._state(temperature), self._core(temperature)
        return self.B * core * state.volume / (state.modulus * self._free(temperature) ** 2)

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return ``-d ln eta / dT`` [1/K] at ambient pressure and ``temperature`` [K]."""
        volume, core = self._state(temperature).volume, self._core(temperature)
        shrinking = self.occupied * self.occupied_expansion
        gain = core * self.expansion - volume * shrinking
        return self.B * gain / self._free(temperature) ** 2

    @property
    def _rest(self) -> float:
        return self.occupied / (1.0 - self.occupied)

    def _core(self, temperature: float) -> float:
        warmer = temperature - self.reference_temperature
        return self.occupied * max(1.0 + self.occupied_expansion * warmer, 0.0)

    def _free(self, temperature: float) -> float:
        return max(self._state(temperature).volume - self._core(temperature), LEAST_FREE)

    def _state(self, temperature: float) -> _State:
        warmer = temperature - self.reference_temperature
        return _State(
            volume=max(1.0 + self.expansion * warmer, LEAST_VOLUME),
            modulus=max(
                exponential_at(self.bulk_modulus, -self.softening * warmer),
                LEAST_MODULUS * self.bulk_modulus,
            ),
        )

    def viscosity_at(self, pressure: float, temperature: float) -> float:
        """Return the viscosity [Pa s] at one ``pressure`` [Pa] and ``temperature`` [K]."""
        state, core = self._state(temperature), self._core(temperature)
        steepness = 1.0 + self.bulk_modulus_slope
        squeezed = 1.0 - math.log1p(steepness * pressure / state.modulus) / steepness
        free = max(state.volume * max(squeezed, LEAST_VOLUME) - core, LEAST_FREE)
        return exponential_at(self.eta_0, self.B * (core / free - self._rest))

    def viscosity(self, pressure: "Array", temperature: "Array | float") -> "Array":
        """Return the viscosity [Pa s] at ``pressure`` [Pa] and ``temperature`` [K]."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        warmer = np.asarray(temperature, dtype=np.float64) - self.reference_temperature
        core = self.occupied * np.maximum(1.0 + self.occupied_expansion * warmer, 0.0)
        free = np.maximum(relative_volume(self, pressure, temperature) - core, LEAST_FREE)
        return exponential(self.eta_0, self.B * (core / free - self._rest))


def relative_volume(
    law: TaitDensity | TaitDoolittle, pressure: "Array", temperature: "Array | float"
) -> "Array":
    """Return ``V / V_R`` [-] at ``pressure`` [Pa] and ``temperature`` [K]."""
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

    warmer = np.asarray(temperature, dtype=np.float64) - law.reference_temperature
    steepness = 1.0 + law.bulk_modulus_slope
    modulus = exponential(law.bulk_modulus, -law.softening * warmer)
    modulus = np.maximum(modulus, LEAST_MODULUS * law.bulk_modulus)
    strain = np.maximum(steepness * np.asarray(pressure) / modulus, -0.9)
    squeezed = 1.0 - np.log1p(strain) / steepness
    expanded = np.maximum(1.0 + law.expansion * warmer, LEAST_VOLUME)
    return np.maximum(squeezed, LEAST_VOLUME) * expanded
