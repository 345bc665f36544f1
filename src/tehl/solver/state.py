"""Pressure and rigid approach of a level as one vector, and exceptions of the iteration."""

import numpy as np

from tehl.solver.level import Level
from tehl.typing import Array

APPROACH = 10.0
"""Weight of the rigid approach among the pressures, where states are compared."""


class DivergedError(ArithmeticError):
    """The unknowns are not finite or grow without bound."""


class TouchingError(DivergedError):
    """The film is not positive with ``part`` of the heights already."""

    def __init__(self, part: float) -> None:
        super().__init__(part)
        self.part = part


def state_of(level: Level) -> Array:
    """Return pressure and weighted rigid approach of a level, (n + 1,)."""
    return np.append(level.film.p.ravel(), APPROACH * level.rigid_approach)


def take_state(level: Level, state: Array) -> None:
    """Set pressure and rigid approach of a level; negative pressures are clipped."""
    pressure = np.maximum(state[:-1].reshape(level.grid.shape), 0.0)
    level.set_state(pressure, float(state[-1]) / APPROACH)


def keep_cavities(level: Level, state: Array) -> Array:
    """Return ``state`` with zero pressure where ``level`` is cavitated."""
    return np.where(np.append(level.film.p.ravel() > 0.0, True), state, 0.0)
