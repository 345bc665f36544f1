"""The viscosity of a data sheet: two kinematic viscosities and a pressure coefficient."""

import math
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from tehl.errors import InputError
from tehl.lubricant.exponent import (
    PER_ROELANDS_PRESSURE,
    ROELANDS_OFFSET,
    ROELANDS_PRESSURE,
    exponential,
    exponential_at,
    power_growth,
    temperature_law,
)
from tehl.units import (
    Density,
    KinematicViscosity,
    PressureCoefficient,
    Ratio,
    Temperature,
    TemperatureCoefficient,
)

if TYPE_CHECKING:
    from tehl.typing import Array

_FORTY, _HUNDRED = 313.15, 373.15  # [K]
_SHIFT = 0.7  # [mm^2/s]
_MM2_PER_S = 1e6
_THICKEST = 12.0  # log10 of the largest kinematic viscosity [mm^2/s]: no oil flows so slowly


class Walther(BaseModel):
    r"""Walther's law of ASTM D341 for the temperature, Roelands' law for the pressure.

    .. math:: \log_{10}\log_{10}(\nu + 0.7) = A - B \log_{10} T, \quad
              \eta = \eta_T \exp\{(\ln\eta_T + 9.67)[(1 + 5.1\cdot10^{-9}\,p)^z - 1]\}, \quad
              \eta_T = \nu(T)\,\rho(T)

    with nu in mm^2/s. The index z is constant, so that the pressure coefficient falls with
    temperature as ``z (ln eta_T + 9.67) / 1.96e8``.

    Attributes
    ----------
    nu_40, nu_100 : float
        Kinematic viscosities at 40 and 100 degC [m^2/s].
    alpha : float or None
        Pressure coefficient at ambient pressure and ``alpha_temperature`` [1/Pa].
    z : float or None
        Pressure index [-].
    alpha_temperature : float
        Where alpha holds [K].
    density : float or None
        Density at ambient pressure and 40 degC [kg/m^3]; None in an oil takes that of its density
        law.
    expansion : float
        Thermal expansion beta [1/K] of ``rho(T) = rho(40 degC) / (1 + beta (T - 313.15 K))``.

    References
    ----------
    .. [1] ASTM D341, Standard Practice for Viscosity-Temperature Charts for Liquid Petroleum
       Products.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    law: Literal["walther"] = "walther"
    nu_40: KinematicViscosity
    nu_100: Annotated[KinematicViscosity, Field(examples=["9 mm^2/s"])]
    alpha: PressureCoefficient | None = None
    z: Ratio | None = None
    alpha_temperature: Temperature = _FORTY
    density: Density | None = None
    expansion: TemperatureCoefficient = 6.5e-4

    @model_validator(mode="after")
    def _must_be_complete(self) -> Self:
        if (self.alpha is None) == (self.z is None):
            raise ValueError("needs exactly one of alpha and z")
        thin, thick = self.nu_100 * _MM2_PER_S, self.nu_40 * _MM2_PER_S
        if not 0.5 <= thin < thick <= 1e6:
            raise ValueError(
                f"has nu_40 = {thick:g} mm^2/s and nu_100 = {thin:g} mm^2/s, but viscosity falls "
                "with temperature and both lie between 0.5 and 1e6 mm^2/s"
            )
        return self

    @property
    def reference_temperature(self) -> float:
        """Return 40 degC [K], where the oil enters if nothing else is said."""
        return _FORTY

    @property
    def eta_0(self) -> float:
        """Return the viscosity at ambient pressure and 40 degC [Pa s]."""
        return self.nu_40 * self._density

    @property
    def pressure_index(self) -> float:
        """Return z [-], stated or from alpha."""
        if self.z is not None:
            return self.z
        return (self.alpha or 0.0) * ROELANDS_PRESSURE / self._span(self.alpha_temperature)

    @property
    def pressure_coefficient(self) -> float:
        """Return alpha at 40 degC [1/Pa]."""
        return self.pressure_coefficient_at(_FORTY)

    @property
    def temperature_coefficient(self) -> float:
        """Return ``-d ln eta / dT`` at 40 degC [1/K]."""
        return self.temperature_coefficient_at(_FORTY)

    @property
    def temperature_law(self) -> str:
        """Return the name of the law and of its fall with temperature."""
        return temperature_law("walther", "ASTM D341", 1.0)

    def ambient(self, temperature: float) -> float:
        """Return the viscosity [Pa s] at ambient pressure and ``temperature`` [K]."""
        kinematic = 10.0 ** min(self._log_shifted(temperature), _THICKEST) - _SHIFT
        return kinematic / _MM2_PER_S * self._density / self._volume(temperature)

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return ``d ln eta / dp`` [1/Pa] at ambient pressure and ``temperature`` [K]."""
        if self.alpha is not None and temperature == self.alpha_temperature:
            return self.alpha
        return self.pressure_index * self._span(temperature) / ROELANDS_PRESSURE

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return ``-d ln eta / dT`` [1/K] at ambient pressure and ``temperature`` [K]."""
        log_shifted = self._log_shifted(temperature)
        shifted = 10.0 ** min(log_shifted, _THICKEST)
        fall = math.log(10.0) * log_shifted * self._slope / temperature
        loss = self.expansion / self._volume(temperature)
        return shifted / (shifted - _SHIFT) * fall + loss

    @property
    def _density(self) -> float:
        if self.density is None:
            raise InputError("the law walther needs the density of the oil at 40 degC")
        return self.density

    @property
    def _slope(self) -> float:
        """Return B [-]."""
        steps = math.log10(_loglog(self.nu_40) / _loglog(self.nu_100))
        return steps / math.log10(_HUNDRED / _FORTY)

    def _log_shifted(self, temperature: float) -> float:
        """Return log10 of nu + 0.7 in mm^2/s."""
        return float(_loglog(self.nu_40) * (_FORTY / temperature) ** self._slope)

    def _volume(self, temperature: float) -> float:
        return max(1.0 + self.expansion * (temperature - _FORTY), 0.1)

    def _span(self, temperature: float) -> float:
        """Return ``ln eta_T + 9.67`` [-]."""
        return math.log(self.ambient(temperature)) + ROELANDS_OFFSET

    def viscosity_at(self, pressure: float, temperature: float) -> float:
        """Return the viscosity [Pa s] at one ``pressure`` [Pa] and ``temperature`` [K]."""
        slope = self.pressure_coefficient_at(temperature)
        growth = power_growth(pressure, slope, self.pressure_index)
        return exponential_at(self.ambient(temperature), growth)

    def viscosity(self, pressure: "Array", temperature: "Array | float") -> "Array":
        """Return the viscosity [Pa s] at ``pressure`` [Pa] and ``temperature`` [K]."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        warm = np.asarray(temperature, dtype=np.float64)
        log_shifted = _loglog(self.nu_40) * (_FORTY / warm) ** self._slope
        kinematic = 10.0 ** np.minimum(log_shifted, _THICKEST) - _SHIFT
        volume = np.maximum(1.0 + self.expansion * (warm - _FORTY), 0.1)
        ambient = kinematic / _MM2_PER_S * self._density / volume
        growth = (1.0 + PER_ROELANDS_PRESSURE * np.asarray(pressure)) ** self.pressure_index - 1.0
        return exponential(ambient, np.maximum(np.log(ambient) + ROELANDS_OFFSET, 0.0) * growth)


def _loglog(kinematic: float) -> float:
    """Return log10(nu + 0.7), nu in mm^2/s."""
    return math.log10(kinematic * _MM2_PER_S + _SHIFT)
