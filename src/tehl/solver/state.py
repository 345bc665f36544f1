"""Pressure and rigid approach of a level as one array, to go back to and to combine."""

import numpy as np

from tehl.solver.level import Level
from tehl.typing import Array

APPROACH = 10.0
"""Weight of the rigid approach among the pressures, where states are compared."""


class DivergedError(ArithmeticError):
    """The unknowns ran away."""


class TouchingError(DivergedError):
    """The film is not positive with ``part`` of the heights already."""

    def __init__(self, part: float) -> None:
        super().__init__(part)
        self.part = part


def state_of(level: Level) -> Array:
    """Return pressure and approach of a level as one array."""
    return np.append(level.film.p.ravel(), APPROACH * level.rigid_approach)


def take_state(level: Level, state: Array) -> None:
    """Set pressure and approach; no pressure is negative."""
    level.film.p[:] = np.maximum(state[:-1].reshape(level.film.p.shape), 0.0)
    level.rigid_approach = float(state[-1]) / APPROACH
    level.stale = True


def keep_cavities(level: Level, state: Array) -> Array:
    """Return ``state`` with no pressure where ``level`` is cavitated now."""
    return np.where(np.append(level.film.p.ravel() > 0.0, True), state, 0.0)
