r"""Shear laws: how the stress follows the shear rate.

All have one form. With the magnitude of the shear stress tau, the Newtonian viscosity eta at the
pressure and temperature and a ``scale`` of the stress, which may depend on the pressure, let
``s = tau / scale`` and ``y = eta (shear rate) / scale``. Then ``y = s F(s)``, where ``F >= 1`` is
the Newtonian over the effective viscosity. Stresses vary linearly across a film, so whoever
computes the flow asks for ``ln F`` at a stress and solves for no rate.
"""

import math
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from tehl.units import NonNegativeStress, Stress, StressSlope

if TYPE_CHECKING:
    from tehl.typing import Array

LEAST_EYRING = 1e4
"""Eyring stress [Pa] below which a unit has been forgotten."""
LEAST_LIMIT = 1e5
"""Least limiting stress [Pa], so that oil at ambient pressure is not without friction."""
LARGEST_RATE = 1e8
"""Dimensionless shear rate up to which a table of ``ln F`` is wanted."""

_KNEE = 0.9999  # part of the limiting stress from which on ln F is a straight line
_KNEE_RATE = -math.log1p(-_KNEE)
_KNEE_LOG = math.log(_KNEE_RATE / _KNEE)
_KNEE_SLOPE = 1.0 / ((1.0 - _KNEE) * _KNEE_RATE) - 1.0 / _KNEE
_SMALL = 0.05  # below, the power series is the more accurate
_STEPS = 100  # of Newton's method; it needs fewer than twenty


class _Law(BaseModel):
    """What the laws share: most thin an oil, and each layer by the stress that it feels."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    @property
    def is_newtonian(self) -> bool:
        """Whether F is one at every stress."""
        return False

    @property
    def yields_as_a_whole(self) -> bool:
        """Whether F is that of the mid-film stress at all layers."""
        return False


class Newtonian(_Law):
    """Stress is viscosity times shear rate, however large."""

    law: Literal["newtonian"] = "newtonian"

    @property
    def is_newtonian(self) -> bool:
        """Whether F is one at every stress."""
        return True

    @property
    def largest_stress(self) -> float:
        """Return the dimensionless stress up to which a table of ln F is wanted."""
        return 1.0

    def stress_scale(self, pressure: "Array") -> "Array":
        """Return 1 MPa [Pa] in the shape of ``pressure`` [Pa]: the law has no scale of its own."""
        return _constant(1e6, pressure)

    def log_thinning(self, stress: "Array") -> "Array":
        """Return ln F = 0 in the shape of the dimensionless ``stress``."""
        return _constant(0.0, stress)

    def thinned(self, newtonian: float, pressure: float) -> float:
        """Return the stress [Pa] where a Newtonian film had ``newtonian`` [Pa]."""
        del pressure
        return newtonian

    def stress_at(self, rate: "Array") -> "Array":
        """Return the dimensionless stress, which is the dimensionless ``rate``."""
        return _floats(rate)


class Eyring(_Law):
    r"""Ree and Eyring's law of thermally activated flow.

    .. math:: \eta\dot\gamma = \tau_0 \sinh(\tau/\tau_0), \quad F = \sinh(s)/s

    Attributes
    ----------
    stress : float
        Eyring stress tau_0 [Pa], about where the oil begins to thin.

    References
    ----------
    .. [1] K. L. Johnson and J. L. Tevaarwerk, Proc. R. Soc. A 356 (1977), 215-236.
    """

    law: Literal["eyring"] = "eyring"
    stress: Stress

    @model_validator(mode="after")
    def _must_be_that_of_an_oil(self) -> Self:
        if self.stress < LEAST_EYRING:
            raise ValueError(
                f'has stress = {self.stress:g} Pa, but oils thin from some MPa on: write "5 MPa"'
            )
        return self

    @property
    def largest_stress(self) -> float:
        """Return the dimensionless stress up to which a table of ln F is wanted."""
        return 60.0

    def stress_scale(self, pressure: "Array") -> "Array":
        """Return tau_0 [Pa] in the shape of ``pressure`` [Pa]."""
        return _constant(self.stress, pressure)

    def log_thinning(self, stress: "Array") -> "Array":
        """Return ln F at the dimensionless ``stress``."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        s = _floats(stress)
        square = np.minimum(s, _SMALL) ** 2
        series = square / 6.0 - square**2 / 180.0 + square**3 / 2835.0 - square**4 / 37800.0
        large = np.maximum(s, _SMALL)
        return np.where(s < _SMALL, series, large + np.log(-np.expm1(-2.0 * large) / (2.0 * large)))

    def thinned(self, newtonian: float, pressure: float) -> float:
        """Return the stress [Pa] where a Newtonian film had ``newtonian`` [Pa]."""
        del pressure
        return self.stress * math.asinh(newtonian / self.stress)

    def stress_at(self, rate: "Array") -> "Array":
        """Return the dimensionless stress at a dimensionless ``rate``."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        return np.arcsinh(_floats(rate))


class Carreau(_Law):
    r"""Carreau's law, a power law above a modulus.

    .. math:: \eta_e = \eta \left[1 + (\eta\dot\gamma/G)^2\right]^{(n-1)/2}, \quad
              s = y\,(1 + y^2)^{(n-1)/2}, \quad \ln F = \tfrac{1-n}{2}\ln(1 + y^2)

    Attributes
    ----------
    modulus : float
        G [Pa], the Newtonian stress about where the oil begins to thin.
    exponent : float
        n [-], slope of stress against rate far above; 1 is Newtonian.

    References
    ----------
    .. [1] S. Bair, Tribology Letters 16 (2004), 267-276.
    """

    law: Literal["carreau"] = "carreau"
    modulus: Stress
    exponent: Annotated[float, Field(ge=0.01, le=1.0, allow_inf_nan=False, examples=[0.4])]

    @property
    def is_newtonian(self) -> bool:
        """Whether F is one at every stress."""
        return self.exponent == 1.0

    @property
    def largest_stress(self) -> float:
        """Return the dimensionless stress up to which a table of ln F is wanted."""
        return LARGEST_RATE * math.hypot(1.0, LARGEST_RATE) ** (self.exponent - 1.0)

    def stress_scale(self, pressure: "Array") -> "Array":
        """Return G [Pa] in the shape of ``pressure`` [Pa]."""
        return _constant(self.modulus, pressure)

    def log_thinning(self, stress: "Array") -> "Array":
        """Return ln F at the dimensionless ``stress``."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        return 0.5 * (1.0 - self.exponent) * np.logaddexp(0.0, 2.0 * self._log_rate(stress))

    def _log_rate(self, stress: "Array") -> "Array":
        """Return ln y by Newton's method from the left of a concave function: never too far."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        aim = np.log(np.maximum(_floats(stress), 1e-150))
        part = 1.0 - self.exponent
        log_rate = np.maximum(aim, aim / self.exponent)
        for _ in range(_STEPS):
            missing = aim - log_rate + 0.5 * part * np.logaddexp(0.0, 2.0 * log_rate)
            step = missing / (1.0 - part / (1.0 + np.exp(np.minimum(-2.0 * log_rate, 700.0))))
            log_rate = log_rate + step
            if not np.any(np.abs(step) > 1e-14 * (1.0 + np.abs(log_rate))):
                break
        return log_rate

    def thinned(self, newtonian: float, pressure: float) -> float:
        """Return the stress [Pa] where a Newtonian film had ``newtonian`` [Pa]."""
        del pressure
        rate = newtonian / self.modulus
        return newtonian * math.hypot(1.0, rate) ** (self.exponent - 1.0)

    def stress_at(self, rate: "Array") -> "Array":
        """Return the dimensionless stress at a dimensionless ``rate``."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        y = _floats(rate)
        return y * np.hypot(1.0, y) ** (self.exponent - 1.0)


class Limiting(_Law):
    r"""Bair and Winer's law without its elastic part: the stress has a limit.

    .. math:: \tau = \tau_L \left[1 - e^{-\eta\dot\gamma/\tau_L}\right], \quad
              \tau_L = \tau_{L0} + \Lambda p, \quad F = -\ln(1 - s)/s

    From ``s = 0.9999`` on, ln F goes on as a straight line, so that every stress has a rate. The
    limit is then exceeded by 0.6 % at ``y = 1e4`` and by 1.5 % at ``y = 1e8``.

    Attributes
    ----------
    stress : float
        Limiting stress tau_L0 at ambient pressure [Pa]; may be zero.
    slope : float
        Lambda, increase of the limit with pressure [-]. The limit is nowhere less than 0.1 MPa.

    Notes
    -----
    F is that of the mid-film stress at all layers: at the limit the smallest pressure gradient
    would have all of the film slip at one wall.

    References
    ----------
    .. [1] S. Bair and W. O. Winer, J. Lubrication Technology 101 (1979), 251-257.
    .. [2] R. Gohar, Elastohydrodynamics, Ellis Horwood, 1988 (the exponential form).
    """

    law: Literal["limiting"] = "limiting"
    stress: NonNegativeStress = 0.0
    slope: Annotated[StressSlope, Field(examples=[0.04])] = 0.0

    @model_validator(mode="after")
    def _must_have_a_limit(self) -> Self:
        if not (self.stress > 0 or self.slope > 0):
            raise ValueError('needs stress or slope, such as slope = 0.04 or stress = "20 MPa"')
        return self

    @property
    def yields_as_a_whole(self) -> bool:
        """Whether F is that of the mid-film stress at all layers."""
        return True

    @property
    def largest_stress(self) -> float:
        """Return the dimensionless stress up to which a table of ln F is wanted."""
        return 1.0

    def stress_scale(self, pressure: "Array") -> "Array":
        """Return tau_L [Pa] at ``pressure`` [Pa]."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        return np.maximum(self.stress + self.slope * _floats(pressure), LEAST_LIMIT)

    def log_thinning(self, stress: "Array") -> "Array":
        """Return ln F at the dimensionless ``stress``."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        s = _floats(stress)
        inside = np.clip(s, 1e-3, _KNEE)
        small = np.minimum(s, 1e-3)
        series = small * (1 / 2 + small * (1 / 3 + small * (1 / 4 + small * (1 / 5 + small / 6))))
        curve = np.where(s < 1e-3, np.log1p(series), np.log(-np.log1p(-inside) / inside))
        return curve + _KNEE_SLOPE * np.maximum(s - _KNEE, 0.0)

    def thinned(self, newtonian: float, pressure: float) -> float:
        """Return the stress [Pa] where a Newtonian film had ``newtonian`` [Pa]."""
        limit = max(self.stress + self.slope * pressure, LEAST_LIMIT)
        return -limit * math.expm1(-newtonian / limit)

    def stress_at(self, rate: "Array") -> "Array":
        """Return the dimensionless stress at a dimensionless ``rate``."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        y = _floats(rate)
        known = np.log(np.maximum(y, _KNEE_RATE)) - _KNEE_LOG + _KNEE_SLOPE * _KNEE
        known += math.log(_KNEE_SLOPE)
        beyond = known - np.log(known)  # solves x + ln x = known, with x = slope times s
        for _ in range(4):
            beyond -= (beyond + np.log(beyond) - known) / (1.0 + 1.0 / beyond)
        return np.where(y < _KNEE_RATE, -np.expm1(-y), beyond / _KNEE_SLOPE)


def _floats(values: "Array") -> "Array":
    """Return values as an array of floats."""
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

    return np.asarray(values, dtype=np.float64)


def _constant(value: float, like: "Array") -> "Array":
    """Return a constant in the shape of an array."""
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

    return np.full(np.shape(like), value)


ShearLaw = Annotated[Newtonian | Eyring | Carreau | Limiting, Field(discriminator="law")]
