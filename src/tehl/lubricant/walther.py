"""The viscosity of a data sheet: two kinematic viscosities and a pressure coefficient."""

import math
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from tehl.base.errors import InputError
from tehl.base.units import (
    Density,
    KinematicViscosity,
    Ratio,
    Temperature,
    TemperatureCoefficient,
)
from tehl.lubricant.law import (
    FORTY_DEGREES,
    Values,
    ViscosityModel,
    exponential,
    functions,
    limited,
)
from tehl.lubricant.pressure import NEEDED, Alpha, pressure_coefficient_of
from tehl.lubricant.roelands import PER_ROELANDS_PRESSURE, ROELANDS_OFFSET, ROELANDS_PRESSURE

_HUNDRED_DEGREES = 373.15  # [K]
_SHIFT = 0.7  # [mm^2/s]
_MM2_PER_S = 1e6
_LARGEST_LOG_VISCOSITY = (
    12.0  # log10 of the largest kinematic viscosity [mm^2/s]: no oil flows so slowly
)


class Walther(ViscosityModel):
    r"""Walther's law of ASTM D341 for the temperature, Roelands' law for the pressure.

    .. math:: \log_{10}\log_{10}(\nu + 0.7) = A - B \log_{10} T, \quad
              \eta = \eta_T \exp\{(\ln\eta_T + 9.67)[(1 + 5.1\cdot10^{-9}\,p)^z - 1]\}, \quad
              \eta_T = \nu(T)\,\rho(T)

    with nu in mm^2/s. The index z is constant, so that the pressure coefficient falls with
    temperature as ``z (ln eta_T + 9.67) / 1.96e8``.

    References
    ----------
    .. [1] ASTM D341, Standard Practice for Viscosity-Temperature Charts for Liquid Petroleum
       Products.
    """

    FALL = "ASTM D341"

    law: Literal["walther"] = "walther"
    nu_40: KinematicViscosity
    nu_100: Annotated[KinematicViscosity, Field(examples=["9 mm^2/s"])]
    """Kinematic viscosities at 40 and 100 degC [m^2/s]."""
    alpha: Alpha | None = None
    """Pressure coefficient at ambient pressure and ``alpha_temperature`` [1/Pa], or "estimated"."""
    z: Ratio | None = None
    """Pressure index [-]."""
    alpha_temperature: Temperature = FORTY_DEGREES
    """Where alpha holds [K]."""
    density: Density | None = None
    """Density at ambient pressure and 40 degC [kg/m^3]; None in an oil takes that of its density
    law."""
    expansion: TemperatureCoefficient = 6.5e-4
    """Thermal expansion beta [1/K] of ``rho(T) = rho(40 degC) / (1 + beta (T - 313.15 K))``."""

    @model_validator(mode="after")
    def _must_be_complete(self) -> Self:
        if (self.alpha is None) == (self.z is None):
            raise ValueError(NEEDED)
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
        return FORTY_DEGREES

    @property
    def eta_0(self) -> float:
        """Return the viscosity at ambient pressure and 40 degC [Pa s]."""
        return self.nu_40 * self._density

    @property
    def pressure_index(self) -> float:
        """Return z [-], stated or from alpha."""
        if self.z is not None:
            return self.z
        return self._alpha * ROELANDS_PRESSURE / self._span(self.alpha_temperature)

    @property
    def _alpha(self) -> float:
        """Return alpha at its temperature [1/Pa], stated or estimated."""
        return pressure_coefficient_of(self.alpha, self._ambient(self.alpha_temperature))

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return ``d ln eta / dp`` [1/Pa] at ambient pressure and ``temperature`` [K]."""
        if self.alpha is not None and temperature == self.alpha_temperature:
            return self._alpha
        return self.pressure_index * self._span(temperature) / ROELANDS_PRESSURE

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return ``-d ln eta / dT`` [1/K] at ambient pressure and ``temperature`` [K]."""
        log_shifted = self._log_shifted(temperature)
        shifted = 10.0 ** min(log_shifted, _LARGEST_LOG_VISCOSITY)
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
        return steps / math.log10(_HUNDRED_DEGREES / FORTY_DEGREES)

    def _log_shifted(self, temperature: Any) -> Any:
        """Return log10 of nu + 0.7 in mm^2/s."""
        return _loglog(self.nu_40) * (FORTY_DEGREES / temperature) ** self._slope

    def _volume(self, temperature: Any) -> Any:
        return limited(1.0 + self.expansion * (temperature - FORTY_DEGREES), 0.1)

    def _ambient(self, temperature: Any) -> Any:
        kinematic = (
            10.0 ** limited(self._log_shifted(temperature), 0.0, _LARGEST_LOG_VISCOSITY) - _SHIFT
        )
        return kinematic / _MM2_PER_S * self._density / self._volume(temperature)

    def _span(self, temperature: Any) -> Any:
        """Return ``ln eta_T + 9.67`` [-]."""
        ambient = self._ambient(temperature)
        return functions(ambient).log(ambient) + ROELANDS_OFFSET

    def viscosity(self, pressure: Values, temperature: Values | float) -> Values:
        """Return the viscosity [Pa s] at ``pressure`` above -1.9e8 Pa and ``temperature`` [K]."""
        growth = (1.0 + PER_ROELANDS_PRESSURE * pressure) ** self.pressure_index - 1.0
        span = limited(self._span(temperature), 0.0)
        return exponential(self._ambient(temperature), span * growth)


def _loglog(kinematic: float) -> float:
    """Return log10(nu + 0.7), nu in mm^2/s."""
    return math.log10(kinematic * _MM2_PER_S + _SHIFT)
