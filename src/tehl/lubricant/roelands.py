"""Roelands' laws of viscosity, with either fall with temperature."""

import math
from typing import Any, Literal, Self

from pydantic import model_validator

from tehl.base.units import Ratio, Temperature, TemperatureCoefficient, Viscosity
from tehl.lubricant.law import (
    FORTY_DEGREES,
    ExponentialFall,
    Values,
    ViscosityModel,
    exponential,
    limited,
)
from tehl.lubricant.pressure import NEEDED, Alpha, pressure_coefficient_of

ROELANDS_OFFSET = 9.67  # -ln of 6.31e-5 Pa s, the viscosity at Roelands' common point
ROELANDS_PRESSURE = 1.96e8  # [Pa], in the definition of z
PER_ROELANDS_PRESSURE = 5.1e-9  # [1/Pa], in the bracket: the rounded 1/1.96e8
_ROELANDS_TEMPERATURE = 138.0  # [K]


class _RoelandsPressure(ViscosityModel):
    """How the viscosity grows with pressure, the same in both laws."""

    law: str
    eta_0: Viscosity
    alpha: Alpha | None = None
    z: Ratio | None = None
    gamma: TemperatureCoefficient | None = None

    @model_validator(mode="after")
    def _must_have_a_slope(self) -> Self:
        if (self.alpha is None) == (self.z is None):
            raise ValueError(NEEDED)
        if not self.viscosity_span > 0:
            raise ValueError(
                f"has eta_0 = {self.eta_0:g} Pa s, but the Roelands law needs more than 6.3e-5 Pa s"
            )
        pressure_coefficient_of(self.alpha, self.eta_0)  # raises where none can be estimated
        return self

    @property
    def viscosity_span(self) -> float:
        """Return ``ln eta_0 + 9.67`` [-]."""
        return math.log(self.eta_0) + ROELANDS_OFFSET

    @property
    def pressure_index(self) -> float:
        """Return z [-], stated or from alpha."""
        if self.z is not None:
            return self.z
        return self.pressure_coefficient * ROELANDS_PRESSURE / self.viscosity_span

    @property
    def pressure_coefficient(self) -> float:
        """Return alpha [1/Pa], stated, estimated or from z."""
        if self.alpha is not None:
            return pressure_coefficient_of(self.alpha, self.eta_0)
        return (self.z or 0.0) * self.viscosity_span / ROELANDS_PRESSURE


class Roelands(_RoelandsPressure):
    r"""Roelands' law of viscosity against pressure and temperature.

    .. math:: \eta = \eta_0 \exp\{(\ln\eta_0 + 9.67)
              [(1 + 5.1\cdot10^{-9}\,p)^z \, \theta^{-S_0} - 1]\}, \quad
              \theta = \frac{T - 138}{T_0 - 138}

    Pressure in Pa, temperature in K. State the slope as ``z`` or as ``alpha``, and the fall with
    temperature as ``S0``, as ``gamma`` or not at all (independent of temperature).

    Attributes
    ----------
    eta_0 : float
        Viscosity at ambient pressure and ``reference_temperature`` [Pa s].
    alpha : float, "estimated" or None
        Pressure coefficient at ambient pressure [1/Pa], or Wooster's estimate;
        ``z = 1.96e8 alpha / (ln eta_0 + 9.67)``.
    z : float or None
        Pressure index [-].
    gamma : float or None
        Temperature coefficient ``-d ln eta / dT`` at the reference [1/K],
        ``S0 = gamma (T_0 - 138) / (ln eta_0 + 9.67)``.
    S0 : float or None
        Temperature index [-].
    reference_temperature : float
        T_0 [K].

    References
    ----------
    .. [1] C. J. A. Roelands, Correlational aspects of the viscosity-temperature-pressure
       relationship of lubricating oils, PhD thesis, TU Delft, 1966.
    .. [2] L. Houpert, J. Tribology 107 (1985), 241-247 (the form with alpha and S0).
    """

    FALL = "S0"

    law: Literal["roelands"] = "roelands"
    S0: Ratio | None = None
    reference_temperature: Temperature = FORTY_DEGREES

    @model_validator(mode="after")
    def _must_have_one_fall(self) -> Self:
        if self.gamma is not None and self.S0 is not None:
            raise ValueError("takes only one of gamma and S0")
        if not self.reference_temperature > _ROELANDS_TEMPERATURE:
            raise ValueError(
                f"has reference_temperature = {self.reference_temperature:g} K, but the Roelands "
                "law needs more than 138 K"
            )
        return self

    @property
    def temperature_index(self) -> float:
        """Return S0 [-], stated or from gamma; zero when neither is stated."""
        if self.S0 is not None:
            return self.S0
        above = self.reference_temperature - _ROELANDS_TEMPERATURE
        return (self.gamma or 0.0) * above / self.viscosity_span

    @property
    def temperature_coefficient(self) -> float:
        """Return gamma [1/K], stated or from S0."""
        above = self.reference_temperature - _ROELANDS_TEMPERATURE
        return self.temperature_index * self.viscosity_span / above

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return ``d ln eta / dp`` [1/Pa] at ambient pressure and ``temperature`` [K]."""
        return self.pressure_coefficient * self._thinner(temperature)

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return ``-d ln eta / dT`` [1/K] at ambient pressure and ``temperature`` [K]."""
        return self.temperature_coefficient * self._thinner(temperature) / self._theta(temperature)

    def _theta(self, temperature: Any) -> Any:
        above = self.reference_temperature - _ROELANDS_TEMPERATURE
        return limited((temperature - _ROELANDS_TEMPERATURE) / above, 0.01)  # it ends at 138 K

    def _thinner(self, temperature: Any) -> Any:
        return self._theta(temperature) ** -self.temperature_index

    def viscosity(self, pressure: Values, temperature: Values | float) -> Values:
        """Return the viscosity [Pa s] at ``pressure`` above -1.9e8 Pa and ``temperature`` [K]."""
        growth = pressure * PER_ROELANDS_PRESSURE
        growth += 1.0  # in place from here on: this is evaluated in each cycle
        growth **= self.pressure_index
        if self.temperature_index > 0:
            growth = growth * self._thinner(temperature)
        growth -= 1.0
        growth *= self.viscosity_span
        return exponential(self.eta_0, growth)


class RoelandsExponential(ExponentialFall, _RoelandsPressure):
    r"""Roelands' law against pressure, exponential against temperature.

    .. math:: \eta = \eta_0 \exp\{(\ln\eta_0 + 9.67)
              [(1 + 5.1\cdot10^{-9}\,p)^z - 1] - \gamma (T - T_0)\}

    Heat thins the oil by the same factor at every pressure, while :class:`Roelands` makes a
    compressed oil the more sensitive: the temperatures of a film differ much between both.

    Attributes
    ----------
    eta_0, alpha, z, reference_temperature
        As of :class:`Roelands`.
    gamma : float or None
        Temperature coefficient [1/K]; None: independent of temperature.

    References
    ----------
    .. [1] K. H. Kim, P. Ehret, D. Dowson and C. M. Taylor, Proc. IMechE Part J 215 (2001), 339-352.
    """

    law: Literal["roelands-exponential"] = "roelands-exponential"
    reference_temperature: Temperature = FORTY_DEGREES

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return alpha [1/Pa] at any ``temperature`` [K]."""
        del temperature
        return self.pressure_coefficient

    def _growth(self, pressure: Values) -> Values:
        bracket = (1.0 + PER_ROELANDS_PRESSURE * pressure) ** self.pressure_index
        return self.viscosity_span * (bracket - 1.0)
