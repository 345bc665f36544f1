"""The coarsest grid: Newton steps for pressure and rigid approach together, load in the system."""

import numpy as np

from tehl.kernels import reynolds
from tehl.kernels.newton import Coarse, System, newton_step
from tehl.operators.influence import dense_matrix
from tehl.solver.level import Level

LONGEST_STEP = 0.3
"""Largest change of pressure in one step, in Hertz pressures."""


class CoarsestSolver:
    """Joint Newton step on the coarsest level, where slow changes of the approach are cheap."""

    def __init__(self, level: Level) -> None:
        self.level = level
        self.influence = dense_matrix(level.grid.shape, level.grid.mirror, level.influence)

    def step(self) -> None:
        """Take one Newton step of limited length in place."""
        level = self.level
        level.update()
        residual = np.empty_like(level.residual)
        reynolds.operator(level.film, level.mesh, residual)
        np.subtract(level.rhs, residual, out=residual)
        by_pressure, by_film = level.conductance_slopes()
        film = level.film
        system = System(
            residual=residual,
            influence=self.influence,
            frozen=level.smoother.frozen,
            area=level.load.area,
            missing_load=level.load_target - level.load.integral(film.p),
        )
        factors, ones = level.factors, np.ones_like(film.p)
        stretch_x = ones if factors is None else factors.stretch_x
        stretch_y = ones if factors is None else factors.stretch_y
        change = newton_step(
            Coarse(
                film.p,
                film.h,
                film.eps,
                film.rho,
                film.drho,
                by_pressure,
                by_film,
                stretch_x,
                stretch_y,
            ),
            level.mesh,
            system,
            LONGEST_STEP,
        )
        level.rigid_approach += change
        level.stale = True
