"""Roelands' laws of viscosity, with either fall with temperature."""

import math
from typing import TYPE_CHECKING, Literal, Self

from pydantic import BaseModel, ConfigDict, model_validator

from tehl.lubricant.exponent import (
    PER_ROELANDS_PRESSURE,
    ROELANDS_OFFSET,
    ROELANDS_PRESSURE,
    exponential,
    exponential_at,
    power_growth,
    temperature_law,
)
from tehl.units import PressureCoefficient, Ratio, Temperature, TemperatureCoefficient, Viscosity

if TYPE_CHECKING:
    from tehl.typing import Array

LEAST_THETA = 0.01
"""Least ``(T - 138)/(T_0 - 138)``: Roelands' law ends at 138 K."""

_ROELANDS_TEMPERATURE = 138.0  # [K]


class _RoelandsPressure(BaseModel):
    """How the viscosity grows with pressure, the same in both laws."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    law: str
    eta_0: Viscosity
    alpha: PressureCoefficient | None = None
    z: Ratio | None = None
    gamma: TemperatureCoefficient | None = None

    @model_validator(mode="after")
    def _must_be_complete(self) -> Self:
        self._check_slope()
        return self

    def _check_slope(self) -> None:
        """Refuse what fixes no slope against pressure."""
        if (self.alpha is None) == (self.z is None):
            raise ValueError("needs exactly one of alpha and z")
        if not self.viscosity_span > 0:
            raise ValueError(
                f"has eta_0 = {self.eta_0:g} Pa s, but the Roelands law needs more than 6.3e-5 Pa s"
            )

    @property
    def viscosity_span(self) -> float:
        """Return ``ln eta_0 + 9.67`` [-]."""
        return math.log(self.eta_0) + ROELANDS_OFFSET

    @property
    def pressure_index(self) -> float:
        """Return z [-], stated or from alpha."""
        if self.z is not None:
            return self.z
        return (self.alpha or 0.0) * ROELANDS_PRESSURE / self.viscosity_span

    @property
    def pressure_coefficient(self) -> float:
        """Return alpha [1/Pa], stated or from z."""
        if self.alpha is not None:
            return self.alpha
        return (self.z or 0.0) * self.viscosity_span / ROELANDS_PRESSURE


class Roelands(_RoelandsPressure):
    r"""Roelands' law of viscosity against pressure and temperature.

    .. math:: \eta = \eta_0 \exp\{(\ln\eta_0 + 9.67)
              [(1 + 5.1\cdot10^{-9}\,p)^z \, \theta^{-S_0} - 1]\}, \quad
              \theta = \frac{T - 138}{T_0 - 138}

    Pressure in Pa, temperature in K. State the slope as ``z`` or as ``alpha``, and the fall with
    temperature as ``S0``, as ``gamma`` or not at all (then the law knows no temperature).

    Attributes
    ----------
    eta_0 : float
        Viscosity at ambient pressure and ``reference_temperature`` [Pa s].
    alpha : float or None
        Pressure coefficient at ambient pressure [1/Pa], ``z = 1.96e8 alpha / (ln eta_0 + 9.67)``.
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

    law: Literal["roelands"] = "roelands"
    S0: Ratio | None = None
    reference_temperature: Temperature = 313.15

    @model_validator(mode="after")
    def _must_be_complete(self) -> Self:
        self._check_slope()
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

    @property
    def temperature_law(self) -> str:
        """Return the name of the law and of its fall with temperature."""
        return temperature_law("roelands", "S0", self.temperature_index)

    def ambient(self, temperature: float) -> float:
        """Return the viscosity [Pa s] at ambient pressure and ``temperature`` [K]."""
        growth = self.viscosity_span * (self._thinner(temperature) - 1.0)
        return exponential_at(self.eta_0, growth)

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return ``d ln eta / dp`` [1/Pa] at ambient pressure and ``temperature`` [K]."""
        return self.pressure_coefficient * self._thinner(temperature)

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return ``-d ln eta / dT`` [1/K] at ambient pressure and ``temperature`` [K]."""
        return self.temperature_coefficient * self._thinner(temperature) / self._theta(temperature)

    def _theta(self, temperature: float) -> float:
        above = self.reference_temperature - _ROELANDS_TEMPERATURE
        return max((temperature - _ROELANDS_TEMPERATURE) / above, LEAST_THETA)

    def _thinner(self, temperature: float) -> float:
        return float(self._theta(temperature) ** -self.temperature_index)

    def viscosity_at(self, pressure: float, temperature: float) -> float:
        """Return the viscosity [Pa s] at one ``pressure`` [Pa] and ``temperature`` [K]."""
        slope = self.pressure_coefficient_at(temperature)
        growth = power_growth(pressure, slope, self.pressure_index)
        return exponential_at(self.ambient(temperature), growth)

    def viscosity(self, pressure: "Array", temperature: "Array | float") -> "Array":
        """Return the viscosity [Pa s] at ``pressure`` [Pa] and ``temperature`` [K].

        Arrays of one shape; ``temperature`` may be a number. Pressures must exceed -1.9e8 Pa.
        """
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        growth = np.asarray(np.multiply(pressure, PER_ROELANDS_PRESSURE))
        growth += 1.0
        growth = np.power(growth, self.pressure_index, out=growth)
        if self.temperature_index > 0:
            above = self.reference_temperature - _ROELANDS_TEMPERATURE
            theta = np.maximum((temperature - _ROELANDS_TEMPERATURE) / above, LEAST_THETA)
            growth = growth * theta**-self.temperature_index
        growth -= 1.0
        growth *= self.viscosity_span
        return exponential(self.eta_0, growth)


class RoelandsExponential(_RoelandsPressure):
    r"""Roelands' law against pressure, exponential against temperature.

    .. math:: \eta = \eta_0 \exp\{(\ln\eta_0 + 9.67)
              [(1 + 5.1\cdot10^{-9}\,p)^z - 1] - \gamma (T - T_0)\}

    Heat thins the oil by the same factor at every pressure, while :class:`Roelands` makes a
    compressed oil the more sensitive: the temperatures of a film differ much between both.

    Attributes
    ----------
    eta_0 : float
        Viscosity at ambient pressure and ``reference_temperature`` [Pa s].
    alpha : float or None
        Pressure coefficient at ambient pressure [1/Pa], ``z = 1.96e8 alpha / (ln eta_0 + 9.67)``.
    z : float or None
        Pressure index [-].
    gamma : float or None
        Temperature coefficient [1/K]; None when the law knows no temperature.
    reference_temperature : float
        T_0 [K].

    References
    ----------
    .. [1] K. H. Kim, P. Ehret, D. Dowson and C. M. Taylor, Proc. IMechE Part J 215 (2001), 339-352.
    """

    law: Literal["roelands-exponential"] = "roelands-exponential"
    reference_temperature: Temperature = 313.15

    @property
    def temperature_coefficient(self) -> float:
        """Return gamma [1/K], zero when it is not stated."""
        return self.gamma or 0.0

    @property
    def temperature_law(self) -> str:
        """Return the name of the law and of its fall with temperature."""
        return temperature_law("roelands", "gamma", self.temperature_coefficient)

    def ambient(self, temperature: float) -> float:
        """Return the viscosity [Pa s] at ambient pressure and ``temperature`` [K]."""
        warmer = temperature - self.reference_temperature
        return exponential_at(self.eta_0, -self.temperature_coefficient * warmer)

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return alpha [1/Pa] at any ``temperature`` [K]."""
        del temperature
        return self.pressure_coefficient

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return gamma [1/K] at any ``temperature`` [K]."""
        del temperature
        return self.temperature_coefficient

    def viscosity_at(self, pressure: float, temperature: float) -> float:
        """Return the viscosity [Pa s] at one ``pressure`` [Pa] and ``temperature`` [K]."""
        slope = self.pressure_coefficient_at(temperature)
        growth = power_growth(pressure, slope, self.pressure_index)
        return exponential_at(self.ambient(temperature), growth)

    def viscosity(self, pressure: "Array", temperature: "Array | float") -> "Array":
        """Return the viscosity [Pa s] at ``pressure`` [Pa] and ``temperature`` [K]."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        growth = (1.0 + PER_ROELANDS_PRESSURE * np.asarray(pressure)) ** self.pressure_index
        growth = (growth - 1.0) * self.viscosity_span
        if self.temperature_coefficient > 0:
            warmer = temperature - self.reference_temperature
            growth = growth - self.temperature_coefficient * warmer
        return exponential(self.eta_0, growth)
