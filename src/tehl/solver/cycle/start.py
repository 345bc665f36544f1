"""Problems on a level, and its first approximations: dry, coarser, or of a similar contact."""

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.operators.dry import STEEP_LINES, dry_pressure
from tehl.operators.transfer import refine, refine_signed
from tehl.result.solution import Solution
from tehl.solver.cycle.equations import Equations
from tehl.solver.cycle.level import Level

LEAST_GUESS_GAIN = 0.1
"""Residual of a guess over that of the interpolated coarser film, below which the guess is taken.
Full multigrid starts near the solution, which few neighbours of a study beat."""


def pose_problem(level: Level) -> None:
    """Set the right-hand sides of a steady problem: f = 0, g = gap - heights, w the load."""
    level.sources.reynolds[:] = 0.0
    balances = level.equations.balances
    level.sources.load, level.sources.moments = balances.target, balances.moments
    level.is_finest = True
    level.share.stays = False
    level.apply_heights(1.0)
    level.smoother.frozen[:] = 0  # the finest grid decides where the film ends


def pose_step(level: Level, history: Array, heights: Array, equations: Equations) -> None:
    """Set the right-hand sides of a time step: f contains the history.

    Parameters
    ----------
    level : Level
        Its film is evaluated.
    history : array of ``grid.shape``
        Contribution of previous films to wedge and squeeze [-].
    heights : array of ``grid.shape``
        Heights of both surfaces at the new time [-].
    equations : Equations
        With the load, the gap and the pressure on the edges at the new time.
    """
    level.sources.history, level.sources.heights = history, heights
    level.equations = equations
    balances = equations.balances
    level.sources.load, level.sources.moments = balances.target, balances.moments
    level.is_finest = True
    level.apply_heights(1.0)
    level.smoother.frozen[:] = 0
    level.update()
    level.write_source()


def from_dry_pressure(level: Level, expected_film: float) -> None:
    """Start from the Hertz pressure, or of dry asperities, at the expected central film.

    Parameters
    ----------
    level : Level
        Poses its problem too.
    expected_film : float
        H in the middle [-].
    """
    pose_problem(level)
    level.share.start(level, expected_film)


def from_coarser(coarse: Level, fine: Level) -> None:
    """Start from the solution of the next coarser grid, by cubic interpolation.

    Parameters
    ----------
    coarse, fine : Level
        The unknowns of the finer one change in place.
    """
    oil, asperity = refine(coarse.film.p, fine.grid), coarse.film.asperity
    is_steep = fine.grid.is_closed and (not fine.grid.crowding or fine.grid.ny <= STEEP_LINES)
    if is_steep and fine.grid.shape[0] > coarse.grid.shape[0]:
        # at the ends of a roller the dry pressure is steep, but not the difference to it; over the
        # numbers of more lines that crowd there it is smooth: this start leaves a fifth to one of
        # the residual, without the time of the dry pressure
        dry, groups = coarse.film.p.copy(), coarse.equations.groups
        dry -= dry_pressure(coarse.grid, groups)
        rise = refine_signed(dry, fine.grid)
        oil = np.where(oil > 0.0, np.maximum(dry_pressure(fine.grid, groups) + rise, 0.0), 0.0)
    asperity = refine(asperity, fine.grid) if asperity.size else asperity
    fine.set_state(oil, coarse.rigid, asperity)


def from_guess(level: Level, guess: Solution | None) -> None:
    """Start from the film of a similar contact if its residual is much smaller.

    Parameters
    ----------
    level : Level
        With a first approximation.
    guess : Solution or None
        None leaves it as it is.
    """
    if guess is None or level.share.bounds_film:
        return
    pose_problem(level)
    here, before = level.state(), _distance(level)
    level.set_state(_values_on(level.grid, guess, guess.scaled.pressure), guess.rigid_approach)
    if guess.asperities is not None:
        pressure = guess.asperities.pressure / guess.scales.hertz_pressure
        level.film.asperity[:] = _values_on(level.grid, guess, pressure)
    if not _distance(level) < LEAST_GUESS_GAIN * before:
        level.set_state(*here)


def _distance(level: Level) -> float:
    """Return residual plus load error of the present state [-]."""
    level.update()
    return level.evaluate_residual() + abs(level.load_error())


def _values_on(grid: Grid, guess: Solution, pressure: Array) -> Array:
    """Return a pressure of a result on ``grid``, bilinear between its nodes [-]."""
    x, y = guess.scaled.x, guess.scaled.y
    if not np.array_equal(grid.x, x):
        pressure = np.array([np.interp(grid.x, x, row, left=0.0, right=0.0) for row in pressure])
    if not np.array_equal(grid.y, y):
        columns = [np.interp(grid.y, y, column, left=0.0, right=0.0) for column in pressure.T]
        pressure = np.array(columns).T
    found = np.maximum(pressure, 0.0)
    found[:, 0] = found[:, -1] = 0.0
    found[list(grid.edge_rows)] = 0.0
    return found
