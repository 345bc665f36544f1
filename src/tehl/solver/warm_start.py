"""Warm start of the finest grid from the film of a similar contact."""

import numpy as np

from tehl.grid import Grid
from tehl.result import Result
from tehl.solver.level import Level
from tehl.typing import Array

NEARER = 0.1
"""Residual of the guess over that of the interpolated coarser film, below which the guess is taken.
Full multigrid starts near the solution, which few neighbours of a study beat."""


def warm_start(level: Level, guess: Result | None) -> None:
    """Start the finest level from ``guess`` if its residual is much smaller, else leave it."""
    if guess is None:
        return
    level.pose_problem()
    pressure, approach, before = level.film.p.copy(), level.rigid_approach, _distance(level)
    level.set_state(pressure_on(level.grid, guess), guess.rigid_approach)
    if not _distance(level) < NEARER * before:
        level.set_state(pressure, approach)


def _distance(level: Level) -> float:
    """Return residual plus load error of the present state [-]."""
    level.update()
    return level.evaluate_residual() + abs(level.load_error())


def pressure_on(grid: Grid, guess: Result) -> Array:
    """Return the pressure of a result on ``grid``, bilinear between its nodes [-]."""
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
