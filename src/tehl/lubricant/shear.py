r"""Shear laws: how the stress follows the shear rate.

All have one form. With the magnitude of the shear stress tau, the Newtonian viscosity eta at the
pressure and temperature and a ``scale`` of the stress, which may depend on the pressure, let
``s = tau / scale`` and ``y = eta (shear rate) / scale``. Then ``y = s F(s)``, where ``F >= 1`` is
the Newtonian over the effective viscosity. Stresses vary linearly across a film, so the flow
is computed from ``ln F`` at a stress, and no rate is solved for.
"""

import math
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Discriminator, Field, model_validator

from tehl.base.typing import Array, np
from tehl.base.units import NonNegativeStress, Stress, StressSlope
from tehl.lubricant.law import Law, Values, functions, limited
from tehl.lubricant.registered import RegisteredLaws
from tehl.lubricant.trial import try_shear

LEAST_EYRING = 1e4
"""Eyring stress [Pa] below which a unit has been forgotten."""
LEAST_LIMIT = 1e5
"""Least limiting stress [Pa], so that oil at ambient pressure is not without friction."""
LARGEST_SHEAR_RATE = 1e8
"""Dimensionless shear rate up to which a table of ``ln F`` is needed."""

_KNEE = 0.9999  # part of the limiting stress from which on ln F is a straight line
_KNEE_RATE = -math.log1p(-_KNEE)
_KNEE_LOG = math.log(_KNEE_RATE / _KNEE)
_KNEE_SLOPE = 1.0 / ((1.0 - _KNEE) * _KNEE_RATE) - 1.0 / _KNEE
_SERIES_LIMIT = 0.05  # below, the power series is the more accurate


class ShearModel(Law):
    """Base of the shear laws: most thin an oil, and each layer by the stress that it feels."""

    yields_as_a_whole: ClassVar[bool] = False
    """Whether F is that of the mid-film stress at all layers."""

    @property
    def is_newtonian(self) -> bool:
        """Whether F is one at every stress."""
        return False

    @property
    def knee(self) -> float:
        """Part of a limiting stress from which on ln F is a straight line; 0 without a limit."""
        return 0.0

    @property
    def largest_stress(self) -> float:
        """Return the dimensionless stress up to which a table of ln F is needed."""
        return 1.0

    def stress_scale(self, pressure: Values) -> Values:
        """Return the scale of the stress [Pa] at ``pressure`` [Pa]."""
        raise NotImplementedError

    def log_thinning(self, stress: Array) -> Array:
        """Return ln F at the dimensionless ``stress``."""
        raise NotImplementedError

    def stress_at(self, rate: Values) -> Values:
        """Return the dimensionless stress at a dimensionless ``rate``."""
        raise NotImplementedError

    def thinned(self, newtonian: float, pressure: float) -> float:
        """Return the stress [Pa] where a Newtonian film had ``newtonian`` [Pa].

        Parameters
        ----------
        newtonian : float
            Viscosity times shear rate [Pa], not negative.
        pressure : float
            Decides the stress scale of the law [Pa].
        """
        scale = self.stress_scale(pressure)
        return scale * self.stress_at(newtonian / scale)


class Newtonian(ShearModel):
    """Stress is viscosity times shear rate, however large."""

    law: Literal["newtonian"] = "newtonian"

    @property
    def is_newtonian(self) -> bool:
        """Whether F is one at every stress."""
        return True

    def stress_scale(self, pressure: Values) -> Values:
        """Return 1 MPa [Pa] in the shape of ``pressure`` [Pa]: the law has no scale."""
        return 1e6 + 0.0 * pressure

    def log_thinning(self, stress: Array) -> Array:
        """Return ln F = 0 in the shape of the dimensionless ``stress``."""
        return 0.0 * stress

    def stress_at(self, rate: Values) -> Values:
        """Return the dimensionless stress, which is the dimensionless ``rate``."""
        return rate


class Eyring(ShearModel):
    r"""Ree and Eyring's law of thermally activated flow.

    .. math:: \eta\dot\gamma = \tau_0 \sinh(\tau/\tau_0), \quad F = \sinh(s)/s

    References
    ----------
    .. [1] K. L. Johnson and J. L. Tevaarwerk, Proc. R. Soc. A 356 (1977), 215-236.
    """

    law: Literal["eyring"] = "eyring"
    stress: Stress
    """Eyring stress tau_0 [Pa], about where the oil begins to thin."""

    @model_validator(mode="after")
    def _must_be_that_of_an_oil(self) -> Self:
        if self.stress < LEAST_EYRING:
            raise ValueError(
                f'has stress = {self.stress:g} Pa, but oils thin from some MPa on: write "5 MPa"'
            )
        return self

    @property
    def largest_stress(self) -> float:
        """Return the dimensionless stress up to which a table of ln F is needed."""
        return 60.0

    def stress_scale(self, pressure: Values) -> Values:
        """Return tau_0 [Pa] in the shape of ``pressure`` [Pa]."""
        return self.stress + 0.0 * pressure

    def log_thinning(self, stress: Array) -> Array:
        """Return ln F at the dimensionless ``stress``."""
        square = np.minimum(stress, _SERIES_LIMIT) ** 2
        series = square / 6.0 - square**2 / 180.0 + square**3 / 2835.0 - square**4 / 37800.0
        large = np.maximum(stress, _SERIES_LIMIT)
        curve = large + np.log(-np.expm1(-2.0 * large) / (2.0 * large))
        return np.where(stress < _SERIES_LIMIT, series, curve)

    def stress_at(self, rate: Values) -> Values:
        """Return the dimensionless stress at a dimensionless ``rate``."""
        return functions(rate).asinh(rate)


class Carreau(ShearModel):
    r"""Carreau's law, a power law above a modulus.

    .. math:: \eta_e = \eta \left[1 + (\eta\dot\gamma/G)^2\right]^{(n-1)/2}, \quad
              s = y\,(1 + y^2)^{(n-1)/2}, \quad \ln F = \tfrac{1-n}{2}\ln(1 + y^2)

    References
    ----------
    .. [1] S. Bair, Tribology Letters 16 (2004), 267-276.
    """

    law: Literal["carreau"] = "carreau"
    modulus: Stress
    """G [Pa], the Newtonian stress about where the oil begins to thin."""
    exponent: Annotated[float, Field(ge=0.01, le=1.0, allow_inf_nan=False, examples=[0.4])]
    """n [-], slope of stress against rate far above; 1 is Newtonian."""

    @property
    def is_newtonian(self) -> bool:
        """Whether F is one at every stress."""
        return self.exponent == 1.0

    @property
    def largest_stress(self) -> float:
        """Return the dimensionless stress up to which a table of ln F is needed."""
        return LARGEST_SHEAR_RATE * math.hypot(1.0, LARGEST_SHEAR_RATE) ** (self.exponent - 1.0)

    def stress_scale(self, pressure: Values) -> Values:
        """Return G [Pa] in the shape of ``pressure`` [Pa]."""
        return self.modulus + 0.0 * pressure

    def log_thinning(self, stress: Array) -> Array:
        """Return ln F at the dimensionless ``stress``."""
        return 0.5 * (1.0 - self.exponent) * np.logaddexp(0.0, 2.0 * self._log_rate(stress))

    def _log_rate(self, stress: Array) -> Array:
        """Return ln y by Newton's method from the left of a concave function: never too far."""
        aim = np.log(np.maximum(stress, 1e-150))
        part = 1.0 - self.exponent
        log_rate = np.maximum(aim, aim / self.exponent)
        for _ in range(100):  # it needs fewer than twenty
            missing = aim - log_rate + 0.5 * part * np.logaddexp(0.0, 2.0 * log_rate)
            step = missing / (1.0 - part / (1.0 + np.exp(np.minimum(-2.0 * log_rate, 700.0))))
            log_rate = log_rate + step
            if not np.any(np.abs(step) > 1e-14 * (1.0 + np.abs(log_rate))):
                break
        return log_rate

    def stress_at(self, rate: Values) -> Values:
        """Return the dimensionless stress at a dimensionless ``rate``."""
        return rate * functions(rate).hypot(1.0, rate) ** (self.exponent - 1.0)


class Limiting(ShearModel):
    r"""Bair and Winer's law without its elastic part: the stress has a limit.

    .. math:: \tau = \tau_L \left[1 - e^{-\eta\dot\gamma/\tau_L}\right], \quad
              \tau_L = \tau_{L0} + \Lambda p, \quad F = -\ln(1 - s)/s

    From ``s = 0.9999`` on, ln F goes on as a straight line, so that every stress has a rate. The
    limit is then exceeded by 0.6 % at ``y = 1e4``, by 1.5 % at ``y = 1e8``, and by 4.8 % at ``y =
    1e24``, as traction drives have it: with a sharper knee, 1e-6 from the limit, heat and stress of
    heavy contacts swing (two bearings, M = 32,000 and 41,000, diverge).

    Notes
    -----
    F is that of the mid-film stress at all layers: at the limit the smallest pressure gradient
    would have all of the film slip at one wall.

    References
    ----------
    .. [1] S. Bair and W. O. Winer, J. Lubrication Technology 101 (1979), 251-257.
    .. [2] R. Gohar, Elastohydrodynamics, Ellis Horwood, 1988 (the exponential form).
    """

    yields_as_a_whole = True

    law: Literal["limiting"] = "limiting"
    stress: NonNegativeStress = 0.0
    """Limiting stress tau_L0 at ambient pressure [Pa]; may be zero."""
    slope: Annotated[StressSlope, Field(examples=[0.04])] = 0.0
    """Lambda, increase of the limit with pressure [-]. The limit is nowhere less than 0.1 MPa."""

    @model_validator(mode="after")
    def _must_have_a_limit(self) -> Self:
        if not (self.stress > 0 or self.slope > 0):
            raise ValueError('needs stress or slope, such as slope = 0.04 or stress = "20 MPa"')
        return self

    @property
    def knee(self) -> float:
        """Part of the limit from which on ln F is a straight line."""
        return _KNEE

    def stress_scale(self, pressure: Values) -> Values:
        """Return tau_L [Pa] at ``pressure`` [Pa]."""
        return limited(self.stress + self.slope * pressure, LEAST_LIMIT)

    def log_thinning(self, stress: Array) -> Array:
        """Return ln F at the dimensionless ``stress``."""
        inside = np.clip(stress, 1e-3, _KNEE)
        small = np.minimum(stress, 1e-3)
        series = small * (1 / 2 + small * (1 / 3 + small * (1 / 4 + small * (1 / 5 + small / 6))))
        curve = np.where(stress < 1e-3, np.log1p(series), np.log(-np.log1p(-inside) / inside))
        return curve + _KNEE_SLOPE * np.maximum(stress - _KNEE, 0.0)

    def thinned(self, newtonian: float, pressure: float) -> float:
        """Return the stress [Pa] where a Newtonian film had ``newtonian`` [Pa], below the limit."""
        limit = self.stress_scale(pressure)
        return -limit * math.expm1(-newtonian / limit)

    def stress_at(self, rate: Values) -> Values:
        """Return the dimensionless stress at a dimensionless ``rate``."""
        known = np.log(np.maximum(rate, _KNEE_RATE)) - _KNEE_LOG + _KNEE_SLOPE * _KNEE
        known += math.log(_KNEE_SLOPE)
        beyond = known - np.log(known)  # solves x + ln x = known, with x = slope times s
        for _ in range(4):
            beyond -= (beyond + np.log(beyond) - known) / (1.0 + 1.0 / beyond)
        return np.where(rate < _KNEE_RATE, -np.expm1(-rate), beyond / _KNEE_SLOPE)[()]


ShearLaw = Annotated[
    Newtonian | Eyring | Carreau | Limiting,
    Discriminator("law"),
    RegisteredLaws(ShearModel, try_shear),
]
