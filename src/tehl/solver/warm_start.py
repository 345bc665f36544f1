"""A start from another film: that of a neighbour in a study."""

import numpy as np

from tehl.grid import Grid
from tehl.result import Result
from tehl.solver.level import Level
from tehl.typing import Array

NEARER = 0.1
"""Residual of the guess, over that of the film from the coarser grid, below which it is taken."""


def start_from(level: Level, guess: Result | None) -> bool:
    """Start the finest level from another film where that is nearer to the answer.

    Full multigrid gives a start that is as good as the next coarser grid, which few neighbours
    beat: only a film that is much nearer is taken.

    Parameters
    ----------
    level : Level
        With the pressure and approach from the coarser grid.
    guess : Result or None
        The other film, on any grid; None is never taken.

    Returns
    -------
    bool
        Whether it was taken.
    """
    if guess is None:
        return False
    level.pose_problem()
    known, approach, before = level.film.p.copy(), level.rigid_approach, _distance(level)
    level.set_state(pressure_on(level.grid, guess), guess.rigid_approach)
    if _distance(level) < NEARER * before:
        return True
    level.set_state(known, approach)
    return False


def _distance(level: Level) -> float:
    """Return how far the present state is from a solution: residual and load error [-]."""
    level.update()
    return level.evaluate_residual() + abs(level.load_error())


def pressure_on(grid: Grid, guess: Result) -> Array:
    """Return the pressure of another film on ``grid``, between its nodes by lines [-]."""
    x, y, pressure = guess.scaled.x, guess.scaled.y, guess.scaled.pressure
    if not np.array_equal(grid.x, x):
        pressure = np.array([np.interp(grid.x, x, row, left=0.0, right=0.0) for row in pressure])
    if not np.array_equal(grid.y, y):
        columns = [np.interp(grid.y, y, column, left=0.0, right=0.0) for column in pressure.T]
        pressure = np.array(columns).T
    found = np.maximum(pressure, 0.0)
    found[-1] = found[:, 0] = found[:, -1] = 0.0
    if not grid.mirror:
        found[0] = 0.0
    return found
