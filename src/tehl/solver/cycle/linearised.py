"""A level as Newton's methods see it: a vector of unknowns, and slopes of the conductance."""

import numpy as np

from tehl.base.typing import Array
from tehl.kernels import reynolds
from tehl.kernels.coarsest import Coarse, Conductance, Lines
from tehl.kernels.properties import Film
from tehl.solver.cycle.level import Level

PRESSURE_STEP = 1e-6
"""Step of the derivative of the conductance by pressure; its error is of this relative size."""
APPROACH_WEIGHT = 10.0
"""Weight of rigid motions among the pressures in the vector of unknowns."""


def unknowns(level: Level) -> Array:
    """Return pressure and weighted rigid motions of a level as one vector, (n + motions,)."""
    return np.append(level.pressure.ravel(), APPROACH_WEIGHT * level.rigid)


def set_unknowns(level: Level, vector: Array) -> None:
    """Set pressure and rigid motions from a vector; negative pressures are clipped.

    Parameters
    ----------
    level, vector : Level, (n + motions,) array
        As `unknowns` takes and returns them.
    """
    nodes = level.film.p.size
    level.set_pressure(np.maximum(vector[:nodes].reshape(level.grid.shape), 0.0))
    level.rigid = vector[nodes:] / APPROACH_WEIGHT


def conductance_slopes(level: Level) -> tuple[Array, Array]:
    """Return d eps/dP and d eps/dH at the present pressure and film, each ``grid.shape``."""
    film = level.film
    eps, rho, drho, eps_x, eps_y = (np.empty_like(film.p) for _ in range(5))
    shifted = Film(film.p + PRESSURE_STEP, film.h, eps, rho, drho, eps_x, eps_y)._replace(
        channel=film.channel, across=film.across, carried=film.carried
    )
    level.update_properties(shifted)
    return (shifted.eps - film.eps) / PRESSURE_STEP, level.share.widening(level)


def linearised(level: Level) -> Coarse:
    """Return film and conductance of a level, flat, with the derivatives of the conductance."""
    film, factors, columns = level.film, level.factors, level.grid.nx
    by_pressure, by_film = conductance_slopes(level)
    ones = np.ones_like(film.p)
    stretch_x, stretch_y = (
        (ones, ones) if factors is None else (factors.stretch_x, factors.stretch_y)
    )
    if film.across.size:
        stretch_y = stretch_y * film.across
    rho = film.rho * film.opening if film.opening.size else film.rho
    conductance = Conductance(film.eps, by_pressure, by_film, stretch_x, stretch_y)
    return Coarse(
        film.p.ravel(),
        film.h.ravel(),
        rho=rho.ravel(),
        drho=film.drho.ravel(),
        partial=film.partial.ravel(),
        second=film.second.ravel(),
        stiffness=film.stiffness.ravel(),
        asperity=film.asperity.ravel(),
        conductance=Conductance._make(one.ravel() for one in conductance),
        lines=Lines(
            film.speed,
            film.drift,
            film.layer,
            south=np.repeat(film.south, columns),
            north=np.repeat(film.north, columns),
        ),
    )


def residual_of(level: Level) -> Array:
    """Return the residual of a level with the wedge of coarser levels, (ny, nx).

    Unlike that of `Level.evaluate_residual` it is not zero at cavitated nodes: a Newton step may
    wet them.
    """
    residual = np.empty_like(level.sources.residual)
    reynolds.operator(level.film, level.equations.robust, residual)
    return np.subtract(level.sources.reynolds, residual, out=residual)
