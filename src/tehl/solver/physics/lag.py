"""Damped heat and shear thinning: how far a film is behind the last sweep of the energy equation.

Undamped, a flow that grows with heat and thinning increases both before the pressure can fall. So
the logarithms of mobility and density go a part of the way per sweep
(docs/theory/numerics-thermal.md on the coupling with the film).
"""

import math

import numpy as np

from tehl.base.typing import Array
from tehl.kernels import properties
from tehl.operators.energy import FilmState

LARGEST_LOG_STEP = 0.5
"""Largest change of the logarithms of mobility and density per sweep. On a steep front the gradient
of a pressure not yet converged may increase the mobility by orders of magnitude."""
LARGEST_BOUNDED_STEP = 2.0
"""The same where a boundary film bounds the film: it cannot collapse before the pressure falls."""


class Lag:
    """How far mobility and density of a film are behind those of the last sweep.

    Parameters
    ----------
    damping : float
        Part of the way that logarithms go per sweep, 1 is all [-].
    heats : bool
        Whether the film is heated.
    """

    def __init__(self, damping: float, *, heats: bool) -> None:
        self.damping, self.heats = damping, heats
        self.part: Array | None = None  # of the slopes, (ny, nx)

    def begin(self) -> None:
        """Forget the last sweep: the film is that of another grid or time."""
        self.part = None

    def drive(self, state: FilmState) -> None:
        """Drive the oil of a sweep by the slopes with which it flows as the film does.

        The flow of the film is given. At the slopes of a film that has not thinned or warmed yet,
        oil that has would flow, and heat, by orders of magnitude more. When the film has caught up,
        these are the slopes of its pressure.
        """
        if self.part is not None:
            for name in ("px", "py"):
                state.view(name)[:] *= self.part.T

    def complete(self, heated: properties.Heated) -> None:
        """Continue the mobility of a sweep to the slopes of the film, along its tangent."""
        if self.part is not None:
            heated.mobility[:] *= self.part ** (1.0 - _exponent(heated))

    def damped(
        self,
        old: properties.Factors,
        new: properties.Factors,
        isothermal: Array,
        largest: float = LARGEST_LOG_STEP,
    ) -> properties.Factors:
        """Return damped factors, see `damped`, and note how far they are behind the new ones."""
        found = damped(old, new, isothermal, self.damping, largest)
        if self.heats and self.damping < 1.0:
            now, then = (one.rest + one.mobility * isothermal for one in (found, new))
            self.part = np.minimum(now / then, 1.0) ** (1.0 / _exponent(new))
        return found


def _exponent(film: properties.Heated | properties.Factors) -> Array:
    """Return n of a flow that grows as the slope of the pressure to the power n."""
    return np.maximum(np.maximum(film.stretch_x, film.stretch_y), 1.0)


def damped(
    old: properties.Factors,
    new: properties.Factors,
    isothermal: Array,
    damping: float,
    largest: float = LARGEST_LOG_STEP,
) -> properties.Factors:
    """Return factors between old and new ones, in logarithms, at most ``largest`` away.

    Parameters
    ----------
    old, new : Factors
        Of the last sweep and of this one.
    isothermal : array (ny, nx)
        Isothermal Newtonian mobility at the pressure of this sweep [-].
    damping : float
        Part of the way [-].
    largest : float
        Largest change of a logarithm [-].
    """

    def step(before: Array, after: Array) -> Array:
        if damping == 1.0:  # the same without logarithms
            least, most = math.exp(-largest), math.exp(largest)
            return np.clip(after, least * before, most * before)
        change = damping * np.log(after / before)
        return before * np.exp(np.clip(change, -largest, largest))

    before, after = (one.rest + one.mobility * isothermal for one in (old, new))
    part = step(before, after) / after
    names = ("density", "stretch_x", "stretch_y")
    others = {name: step(getattr(old, name), getattr(new, name)) for name in names}
    return new._replace(rest=part * new.rest, mobility=part * new.mobility, **others)
