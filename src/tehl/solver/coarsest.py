"""The coarsest grid: Newton steps for pressure and rigid approach together, load in the system."""

import numpy as np

from tehl.kernels import reynolds
from tehl.kernels.newton import Coarse, System, newton_step
from tehl.operators.influence import dense_matrix
from tehl.solver.level import Level

LONGEST_STEP = 0.3
"""Largest change of pressure in one step, in Hertz pressures."""


class CoarsestSolver:
    """Joint Newton step on the coarsest level, where slow changes of the approach are cheap.

    The equations are L(P, H00 + K P + g) = f at the wet nodes and sum(P) dx dy = w, with the dense
    matrix K and the derivatives of the conductance by pressure and film.
    """

    def __init__(self, level: Level) -> None:
        self.level = level
        equations = level.equations
        grid = equations.grid
        self.influence = dense_matrix(grid.shape, grid.mirror, equations.influence)

    def step(self) -> None:
        """Perform one Newton step of limited length in place."""
        level = self.level
        level.update()
        residual = np.empty_like(level.residual)
        reynolds.operator(level.film, level.mesh, residual)
        np.subtract(level.sources.reynolds, residual, out=residual)
        system = System(
            residual=residual,
            influence=self.influence,
            frozen=level.smoother.frozen,
            area=level.equations.load.area,
            missing_load=level.missing_load(),
        )
        change = newton_step(self._linearised(), level.mesh, system, LONGEST_STEP)
        level.set_state(level.film.p, level.rigid_approach + change)

    def _linearised(self) -> Coarse:
        """Return film and conductance with the derivatives of the latter."""
        film, factors = self.level.film, self.level.factors
        by_pressure, by_film = self.level.conductance_slopes()
        ones = np.ones_like(film.p)
        stretch_x, stretch_y = (
            (ones, ones) if factors is None else (factors.stretch_x, factors.stretch_y)
        )
        return Coarse(
            *film[:5],
            eps_p=by_pressure,
            eps_h=by_film,
            stretch_x=stretch_x,
            stretch_y=stretch_y,
        )
