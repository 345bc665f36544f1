"""One grid with its unknowns: pressure, film and rigid approach, and their right-hand sides.

On the finest grid the right-hand sides are those of the problem; on a coarser one they carry the
full approximation scheme (Brandt 1977; Venner and Lubrecht 2000, ch. 4 and 6), for the Reynolds,
the film and the load equation alike.
"""

from typing import TYPE_CHECKING

import numpy as np

from tehl.grid import Grid
from tehl.kernels import reynolds, transfer
from tehl.operators.deformation import choose
from tehl.operators.film import gap
from tehl.operators.flow import FlowTable
from tehl.operators.influence import influence_of
from tehl.operators.load import TARGET, Load
from tehl.operators.reynolds import stencil
from tehl.options import Options
from tehl.scaling import Groups
from tehl.solver.smoother import Setting, make_smoother

if TYPE_CHECKING:
    from tehl.typing import Array

PRESSURE_STEP = 1e-6
"""Step of the derivative of the conductance by pressure; its error is of this relative size."""
FROZEN_BELOW = 1e-3
"""Pressure below which a coarse node beside a cavity is left to the finer grid."""


class Level:
    """One grid of the hierarchy; the only mutable thing in the solver.

    Parameters
    ----------
    grid : Grid
        The nodes.
    groups : Groups
        Dimensionless groups.
    flow : FlowTable
        The lubricant.
    options : Options
        Wedge order and deformation.
    setting : Setting
        Of the relaxation.
    """

    def __init__(
        self, grid: Grid, groups: Groups, flow: FlowTable, options: Options, setting: Setting
    ) -> None:
        self.grid, self.groups, self.flow = grid, groups, flow
        self.mesh = stencil(grid, groups, options.wedge_order)
        self.influence = influence_of(grid, groups)
        self.deformation = choose(options.deformation, grid, groups)
        self.load = Load(grid)
        self.smoother = make_smoother(grid, self.influence, setting)
        self.self_film = float(self.influence(0, 0))
        self.gap = gap(grid, groups)
        self.heights: Array | None = None
        self.history: Array | None = None
        self.correction, self.limit = 1.0, np.inf
        self.floor = 0.0
        p, h, eps, rho, drho = (np.zeros(grid.shape) for _ in range(5))
        self.film = reynolds.Film(p, h, eps, rho, drho, eps_x=eps, eps_y=eps)
        self.deflection, self.residual, self.rhs, self.film_rhs, self.before = (
            np.zeros(grid.shape) for _ in range(5)
        )
        self.rigid_approach, self.rigid_approach_before = 0.0, 0.0
        self.load_part, self.load_target = 1.0, TARGET
        self.stale, self.started_dry = True, False
        self.factors: reynolds.Factors | None = None

    def pose_problem(self) -> None:
        """Make this the finest level: the right-hand sides of the problem itself."""
        self.rhs[:] = 0.0
        self.roughen(1.0)
        self.load_target = self.load_part * TARGET
        self.smoother.frozen[:] = 0
        self.stale = True

    def pose_step(self, history: "Array", heights: "Array", load: float) -> None:
        """Make this the finest level of a step of time.

        Parameters
        ----------
        history : (ny, nx) array
            What former films bring to wedge and squeeze [-].
        heights : (ny, nx) array
            Of both surfaces now [-].
        load : float
            Over the load of the contact [-].
        """
        self.history, self.heights = history, heights
        self.roughen(1.0)
        self.load_target = load * TARGET
        self.smoother.frozen[:] = 0
        self.update()
        reynolds.tangent_source(self.film, self.mesh, self.rhs)
        self.add_history()

    def add_history(self) -> None:
        """Bring back what a new right-hand side has overwritten."""
        if self.history is not None:
            self.rhs -= self.history

    def roughen(self, part: float) -> None:
        """Take ``part`` of the heights of the surfaces off the gap of the finest level."""
        self.film_rhs[:] = self.gap
        if self.heights is not None:
            self.film_rhs -= part * self.heights
        self.stale = True

    def set_smoother(self, setting: Setting) -> None:
        """Relax with another setting from now on."""
        frozen = self.smoother.frozen
        self.smoother = make_smoother(self.grid, self.influence, setting)
        self.smoother.frozen[:] = frozen

    def load_error(self) -> float:
        """Return the relative error of the load balance."""
        return self.load.integral(self.film.p) / self.load_target - 1.0

    def update(self) -> None:
        """Evaluate the film, then conductance and density, for the present pressure."""
        if not self.stale:
            return
        self.deformation.deflect(self.film.p, self.deflection)
        np.add(self.deflection, self.film_rhs, out=self.film.h)
        np.add(self.film.h, self.rigid_approach, out=self.film.h)
        self.update_properties()
        self.stale = False

    def update_properties(self) -> None:
        """Evaluate conductance and density for the present pressure and film."""
        self._evaluate(self.film)

    def _evaluate(self, film: reynolds.Film) -> None:
        """Fill the properties of ``film`` by its pressure and thickness."""
        table, step = self.flow.table, self.flow.step
        if self.factors is None:
            reynolds.properties(film, table, step, self.floor)
        else:
            reynolds.heated_properties(film, self.factors, table, step, self.floor)

    def conductance_slopes(self) -> "tuple[Array, Array]":
        """Return the derivatives of the conductance by pressure and by film; it is up to date."""
        film = self.film
        scratch = (np.empty_like(film.p) for _ in range(5))
        shifted = reynolds.Film(film.p + PRESSURE_STEP, film.h, *scratch)
        self._evaluate(shifted)
        by_pressure = (shifted.eps - film.eps) / PRESSURE_STEP
        thick = film.h > self.floor
        by_film = np.where(thick, 3.0 * film.eps / np.maximum(film.h, self.floor), 0.0)
        return by_pressure, by_film

    def couple(self, factors: reynolds.Factors) -> None:
        """Take what heat and shear thinning make of the flow; the film is up to date."""
        if self.factors is None:
            eps_x, eps_y = np.empty(self.grid.shape), np.empty(self.grid.shape)
            self.film = self.film._replace(eps_x=eps_x, eps_y=eps_y)
        self.factors = factors

    def uncouple(self) -> None:
        """Let the film be isothermal and Newtonian again."""
        self.factors = None
        self.film = self.film._replace(eps_x=self.film.eps, eps_y=self.film.eps)
        self.stale = True

    def relax(self, sweeps: int) -> None:
        """Smooth the error of pressure and film in place."""
        for _ in range(sweeps):
            self.update()
            self.smoother.sweep(self.film, self.mesh, self.rhs, self.flow)
            self.stale = True

    def evaluate_residual(self) -> float:
        """Fill ``residual`` (zero where cavitated); return its scaled mean. Film is up to date."""
        return reynolds.residual(self.film, self.mesh, self.rhs, self.self_film, self.residual)

    def restrict_to(self, coarse: "Level") -> None:
        """Send unknowns and right-hand sides of the full approximation scheme to ``coarse``."""
        self.update()
        self.evaluate_residual()
        mirror = self.mesh.mirror
        transfer.restrict_pressure(self.film.p, mirror, coarse.film.p)
        transfer.freeze(
            self.film.p,
            self.smoother.frozen,
            coarse.film.p,
            mirror,
            FROZEN_BELOW,
            coarse.smoother.frozen,
        )
        coarse.before[:] = coarse.film.p
        coarse.rigid_approach = coarse.rigid_approach_before = self.rigid_approach
        coarse.film.h[:] = self.film.h[::2, ::2]
        coarse.deformation.deflect(coarse.film.p, coarse.deflection)
        np.subtract(coarse.film.h, coarse.deflection, out=coarse.film_rhs)
        coarse.film_rhs -= coarse.rigid_approach
        coarse.update_properties()
        transfer.restrict_residual(self.residual, mirror, coarse.residual)
        reynolds.operator(coarse.film, coarse.mesh, coarse.rhs)
        coarse.rhs += coarse.residual
        missing = self.load_target - self.load.integral(self.film.p)
        coarse.load_target = missing + coarse.load.integral(coarse.film.p)
        coarse.stale = False

    def correct_from(self, coarse: "Level") -> None:
        """Add the change that ``coarse`` found, never across the cavitation front."""
        mirror, part = self.mesh.mirror, coarse.correction
        transfer.correct(self.film.p, coarse.film.p, coarse.before, mirror, part, coarse.limit)
        self.rigid_approach += part * (coarse.rigid_approach - coarse.rigid_approach_before)
        self.stale = True
