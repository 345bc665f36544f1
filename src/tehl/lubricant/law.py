"""What the laws of an oil share: their settings, and functions of numbers and of arrays.

Laws are formulas for numbers as well as for arrays: a case is explained without numpy.
"""

import math
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from tehl.base.table import Table
from tehl.base.typing import Array, np

LARGEST_LAW_EXPONENT = 600.0
"""``exp`` of more would overflow; so thick a film is a solid for every purpose."""
FORTY_DEGREES = 313.15
"""Temperature at which oils are stated, compared and tried if they state no other [K]."""

Values = TypeVar("Values", float, Array)


class Law(Table):
    """Base of the tables of an oil."""


class ViscosityModel(Law):
    """Base of the viscosity laws.

    ``FALL`` is the constant or the standard that states the fall with temperature. A law needs the
    method ``viscosity`` only: without formulas of their own its coefficients are differences.
    """

    FALL: ClassVar[str] = "with temperature"
    if TYPE_CHECKING:  # a field of most laws
        law: str

        @property
        def reference_temperature(self) -> float:
            """Return the temperature at which the constants hold [K]."""

    @property
    def pressure_coefficient(self) -> float:
        """Return alpha at the reference temperature [1/Pa]."""
        return self.pressure_coefficient_at(self.reference_temperature)

    @property
    def is_estimated(self) -> bool:
        """Return whether the pressure coefficient is an estimate."""
        return isinstance(getattr(self, "alpha", None), str)

    @property
    def temperature_coefficient(self) -> float:
        """Return ``-d ln eta / dT`` at the reference temperature [1/K]."""
        return self.temperature_coefficient_at(self.reference_temperature)

    @property
    def temperature_law(self) -> str:
        """Return the name of the law and of its fall with temperature."""
        fall = self.FALL if self.temperature_coefficient > 0 else "no temperature"
        return f"{self.law.removesuffix('-exponential')}, {fall}"

    def ambient(self, temperature: float) -> float:
        """Return the viscosity [Pa s] at ambient pressure and ``temperature`` [K]."""
        return self.viscosity(0.0, temperature)

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Return ``d ln eta / dp`` [1/Pa] at ambient pressure and ``temperature`` [K]."""
        d = 1e4  # [Pa]
        first, second, third = (
            math.log(self.viscosity(pressure, temperature)) for pressure in (0.0, d, 2.0 * d)
        )
        return (4.0 * second - 3.0 * first - third) / (2.0 * d)

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return ``-d ln eta / dT`` [1/K] at ambient pressure and ``temperature`` [K]."""
        d = 1e-2  # [K]
        colder, warmer = (math.log(self.viscosity(0.0, temperature + step)) for step in (-d, d))
        return (colder - warmer) / (2.0 * d)

    def viscosity(self, pressure: Values, temperature: Values | float) -> Values:
        """Return the viscosity [Pa s] at ``pressure`` [Pa] and ``temperature`` [K].

        Parameters
        ----------
        pressure : float or Array
            Gauge pressure [Pa].
        temperature : float or Array
            Absolute [K]; a number, or of the shape of ``pressure``.
        """
        raise NotImplementedError


class ExponentialFall(ViscosityModel):
    """Base of the laws that fall exponentially with temperature, by the same factor everywhere."""

    FALL = "gamma"
    if TYPE_CHECKING:
        eta_0: float
        gamma: float | None

    def temperature_coefficient_at(self, temperature: float) -> float:
        """Return gamma [1/K] at any ``temperature`` [K], zero when it is not stated."""
        del temperature
        return self.gamma or 0.0

    def viscosity(self, pressure: Values, temperature: Values | float) -> Values:
        """Return the viscosity [Pa s] at ``pressure`` [Pa] and ``temperature`` [K]."""
        growth = self._growth(pressure)
        if self.gamma:
            growth = growth - self.gamma * (temperature - self.reference_temperature)
        return exponential(self.eta_0, growth)

    def _growth(self, pressure: Values) -> Values:
        """Return the exponent at ``pressure`` [Pa] and the reference temperature."""
        raise NotImplementedError


class DensityModel(Law):
    """Base of the density laws."""

    def ambient(self, temperature: float) -> float:
        """Return the density [kg/m^3] at ambient pressure and ``temperature`` [K]."""
        return self.density(0.0, temperature)

    def density(self, pressure: Values, temperature: Values | float) -> Values:
        """Return the density [kg/m^3] at ``pressure`` [Pa] and ``temperature`` [K].

        Parameters
        ----------
        pressure : float or Array
            Gauge pressure [Pa].
        temperature : float or Array
            Absolute [K]; a number, or of the shape of ``pressure``.
        """
        raise NotImplementedError


def functions(values: Any) -> Any:
    """Return the module with the elementary functions of ``values``: math or numpy."""
    return math if isinstance(values, float) else np


def limited(values: Any, least: float, most: float = math.inf) -> Any:
    """Return values within limits.

    Parameters
    ----------
    values : float or array
        What is limited.
    least, most : float
        The limits; NaN stays NaN.
    """
    if isinstance(values, float):
        return min(max(values, least), most)
    return np.clip(values, least, most)


def exponential(eta_0: Any, exponent: Any) -> Any:
    """Return ``eta_0 exp(exponent)`` without overflow, arrays written over ``exponent``.

    Parameters
    ----------
    eta_0 : float or Array
        Factor, a viscosity [Pa s].
    exponent : float or Array
        Limited to `LARGEST_LAW_EXPONENT` in size; an array is overwritten by the result.
    """
    if isinstance(exponent, float):
        return eta_0 * math.exp(limited(exponent, -LARGEST_LAW_EXPONENT, LARGEST_LAW_EXPONENT))
    np.clip(exponent, -LARGEST_LAW_EXPONENT, LARGEST_LAW_EXPONENT, out=exponent)
    np.exp(exponent, out=exponent)
    exponent *= eta_0
    return exponent
