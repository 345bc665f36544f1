"""One grid of the hierarchy: its unknowns, its right-hand sides, and the transfers to other grids.

The unknowns are the pressure P and the rigid approach H00; the film H follows from them. On the
finest grid the right-hand sides f, g, w of `tehl.solver.cycle.equations` are those of the problem.
On a coarser one they carry the full approximation scheme (FAS: Brandt 1977; Venner and Lubrecht
2000, chapters 4 and 6): each equation A(u) = b becomes

    A_c(u_c) = A_c(I u) + R (b - A(u)),

with I u the injected or weighted fine solution and R full weighting.
"""

import numpy as np

from tehl.base.typing import Array, FlagArray
from tehl.estimate.grid import Grid
from tehl.kernels import properties, reynolds, transfer
from tehl.operators.far_field import FarField
from tehl.operators.upstream import UpstreamField
from tehl.solver.cycle.equations import Equations, Sources
from tehl.solver.cycle.relaxation import Relaxation, make_smoother
from tehl.solver.judging.film_summary import central_value
from tehl.solver.physics.cavity import cavity_of
from tehl.solver.physics.share import FILM_PER_PRESSURE, share_of

PRESSURE_STEP = 1e-6
"""Step of the derivative of the conductance by pressure; its error is of this relative size."""
APPROACH_WEIGHT = 10.0
"""Weight of the rigid approach among the pressures in the vector of unknowns."""


class Level:
    """One grid with its unknowns.

    `set_state`, `relax`, `correct_from`, `apply_heights` and `uncouple` mark the film as stale;
    `update` evaluates film, density and conductance again.
    """

    def __init__(self, equations: Equations, relaxation: Relaxation) -> None:
        shape = equations.grid.shape
        self.equations = equations
        self.smoother = make_smoother(equations, relaxation)
        p, h, eps, rho, drho, f, g = (np.zeros(shape) for _ in range(7))
        self.is_finest = True  # of those in use: its equations are those of the problem
        self.film = properties.Film(p, h, eps, rho, drho, eps_x=eps, eps_y=eps)
        self.cavity = cavity_of(equations)
        self.film = self.cavity.extend(self.film)
        self.share = share_of(equations)
        self.film = self.share.extend(self.film)
        # of the mean planes: the film itself where no solids carry load
        self.separation = np.zeros(shape) if self.film.asperity.size else h
        self.rigid_approach = 0.0
        self.sources = Sources(f, g, equations.target)
        self.residual = np.zeros(shape)
        self.restricted = (np.zeros(shape), 0.0)
        self.total = np.zeros(shape)  # pressure of oil and asperities
        self.heights: Array | None = None
        # of the correction of the next finer grid: factor, and limit of its relative change of P
        self.correction = relaxation.correction
        self.factors: properties.Factors | None = None
        self._is_stale = True

    @property
    def grid(self) -> Grid:
        """The nodes."""
        return self.equations.grid

    @property
    def far_field(self) -> FarField | UpstreamField | None:
        """Pressure on the edges and load outside of the finest level; None if it is zero."""
        return self.equations.far_field if self.is_finest else None

    @property
    def stencil(self) -> reynolds.Stencil:
        """Weights of the Reynolds operator.

        Coarser levels of a cycle, and the coarsest, have a wedge of second order (double
        discretisation: Brandt 1982): it is more robust where the mesh does not resolve the film.
        """
        return self.equations.stencil if self.is_finest else self.equations.robust

    @property
    def balance(self) -> reynolds.Stencil:
        """The same by fluxes through the faces of cells where surfaces may touch.

        The order of each flux is then chosen by `Film.second`, and oil is conserved all the same.
        In a time step there are none: what moves with the film stays in it. Coarser grids of a
        cycle correct the finest one by the usual wedge.
        """
        if not (self.share.by_flux and self.is_finest) or self.stencil.w1 == 0.0:
            return self.stencil
        return self.stencil._replace(conserves=reynolds.STEADILY)

    @property
    def is_resolved(self) -> bool:
        """Whether the film exceeds the floor of the conductance, or is the boundary film."""
        return self.share.bounds_film or float(self.film.h.min()) > self.equations.floor

    @property
    def frozen(self) -> FlagArray:
        """Nodes whose oil pressure stays."""
        return self.smoother.frozen

    # state

    def set_state(
        self, pressure: Array, rigid_approach: float, asperity: Array | float = 0.0
    ) -> None:
        """Set the pressures of oil and asperities, and the rigid approach; the film is stale.

        Parameters
        ----------
        pressure : array of ``grid.shape``
            Of the oil; it is cavitated where this is zero.
        rigid_approach : float
            H00 [-].
        asperity : array of ``grid.shape``
            Of the asperities: where oil and they share a pressure, its parts follow with the film.
        """
        self.film.p[:] = pressure
        self.film.asperity[:] = asperity
        self.rigid_approach = rigid_approach
        self._is_stale = True

    def set_pressure(self, pressure: Array) -> None:
        """Set the pressure of oil and asperities together; the film is stale.

        With asperities the oil stays cavitated where it is.
        """
        solids = self.film.asperity
        if not solids.size:
            self.set_state(pressure, self.rigid_approach)
        else:
            oil = np.where(self.film.p == 0.0, 0.0, pressure - solids)
            self.set_state(oil, self.rigid_approach, pressure - oil)

    def state(self) -> tuple[Array, float, Array]:
        """Return a copy of what `set_state` sets."""
        return self.film.p.copy(), self.rigid_approach, self.film.asperity.copy()

    def move(self, change: float) -> None:
        """Change the rigid approach."""
        self.rigid_approach += change
        self._is_stale = True

    @property
    def pressure(self) -> Array:
        """Pressure of oil and asperities together, written anew at each access [-]."""
        film = self.film
        return np.add(film.p, film.asperity, out=self.total) if film.asperity.size else film.p

    def unknowns(self) -> Array:
        """Return pressure and weighted rigid approach as one vector, (n + 1,)."""
        return np.append(self.pressure.ravel(), APPROACH_WEIGHT * self.rigid_approach)

    def set_unknowns(self, vector: Array) -> None:
        """Set pressure and rigid approach from a vector; negative pressures are clipped."""
        self.set_pressure(np.maximum(vector[:-1].reshape(self.grid.shape), 0.0))
        self.rigid_approach = float(vector[-1]) / APPROACH_WEIGHT

    def update(self) -> None:
        """Evaluate film H = H00 + K P + g, conductance and density if they are stale."""
        if not self._is_stale:
            return
        h = self.separation
        # the deflection is the largest part of the cost: once per change of the pressure
        self.equations.deformation.deflect(self.pressure, h)
        np.add(h, self.sources.film, out=h)
        np.add(h, self.share.raised(self.rigid_approach), out=h)
        if self.far_field is not None:
            self.far_field.set_edges(self.film.p, h)
            self.sources.outside = self.far_field.load(h, self.equations.gap)
        self.share.follow(self, FILM_PER_PRESSURE)
        self._is_stale = False
        self.cavity.mark(self)

    def touch(self) -> None:
        """Mark the film as stale."""
        self._is_stale = True

    def update_properties(self) -> None:
        """Evaluate conductance and density for the present pressure and film."""
        self._evaluate(self.film)

    def _evaluate(self, film: properties.Film) -> None:
        flow, floor = self.equations.flow, self.equations.floor
        if self.factors is None:
            properties.properties(film, flow, floor)
        else:
            properties.heated_properties(film, self.factors, flow, floor)

    def nodal_film(self) -> tuple[float, float]:
        """Return central and smallest nodal film [-]."""
        return central_value(self.grid, self.film.h), float(self.film.h.min())

    def conductance_slopes(self) -> tuple[Array, Array]:
        """Return d eps/dP and d eps/dH at the present pressure and film, each ``grid.shape``."""
        film = self.film
        eps, rho, drho, eps_x, eps_y = (np.empty_like(film.p) for _ in range(5))
        shifted = properties.Film(
            film.p + PRESSURE_STEP, film.h, eps, rho, drho, eps_x, eps_y
        )._replace(channel=film.channel, across=film.across, carried=film.carried)
        self._evaluate(shifted)
        by_pressure = (shifted.eps - film.eps) / PRESSURE_STEP
        return by_pressure, self.share.widening(self)

    def couple(self, factors: properties.Factors) -> None:
        """Set the factors of heat and shear thinning on mobility and density."""
        if self.factors is None:
            eps_x, eps_y = np.empty(self.grid.shape), np.empty(self.grid.shape)
            self.film = self.film._replace(eps_x=eps_x, eps_y=eps_y)
        self.factors = factors

    def uncouple(self) -> None:
        """Reset to an isothermal Newtonian film."""
        self.factors = None
        eps_y = self.film.eps_y if self.film.across.size else self.film.eps
        self.film = self.film._replace(eps_x=self.film.eps, eps_y=eps_y)
        self._is_stale = True

    # the problem of the finest level

    def pose_problem(self) -> None:
        """Set the right-hand sides of a steady problem: f = 0, g = gap - heights, w the load."""
        self.sources.reynolds[:] = 0.0
        self.sources.load = self.equations.target
        self.is_finest = True
        self.share.stays = False
        self.apply_heights(1.0)
        self.smoother.frozen[:] = 0  # the finest grid decides where the film ends

    def pose_step(self, history: Array, heights: Array, load: float) -> None:
        """Set the right-hand sides of a time step: f contains the history.

        Parameters
        ----------
        history : array of ``grid.shape``
            Contribution of previous films to wedge and squeeze [-].
        heights : array of ``grid.shape``
            Heights of both surfaces at the new time [-].
        load : float
            Load over that of the contact [-].
        """
        self.sources.history, self.heights = history, heights
        self.sources.load = load * self.equations.groups.shape.load
        self.is_finest = True
        self.apply_heights(1.0)
        self.smoother.frozen[:] = 0
        self.update()
        self.write_source()

    def apply_heights(self, part: float) -> None:
        """Set g = gap - ``part`` * heights."""
        self.sources.film[:] = self.equations.gap
        if self.heights is not None:
            self.sources.film -= part * self.heights
        self._is_stale = True

    def write_source(self) -> None:
        """Set f of the finest level for the present film.

        A shear-thinning film relaxes with tangent conductances, those of a small change of the
        pressure gradient along x or y. With P0 the present pressure, that of the last energy sweep,
        L_tan(P) = f = L_tan(P0) - L_sec(P0) - history  has the solution of the secant operator
        where P = P0 (docs/theory/numerics-thermal.md).
        """
        reynolds.tangent_source(self.film, self.stencil, self.sources.reynolds)
        if self.sources.history is not None:
            self.sources.reynolds -= self.sources.history

    # relaxation and residual

    def set_relaxation(self, relaxation: Relaxation) -> None:
        """Change the settings of the smoother; frozen nodes stay frozen."""
        frozen = self.smoother.frozen
        if self.share.is_steep:
            self.correction = relaxation.correction
        self.smoother = make_smoother(self.equations, relaxation)
        self.smoother.frozen[:] = frozen

    def relax(self, sweeps: int) -> None:
        """Smooth the error of the pressure by ``sweeps`` relaxation sweeps."""
        for _ in range(sweeps):
            self.update()
            self.smoother.sweep(self.film, self.balance, self.sources.reynolds, self.equations.flow)
            self._is_stale = True

    def evaluate_residual(self) -> float:
        """Evaluate f - L(P), zero where cavitated; return its mean over the local diagonal.

        Where surfaces touch the error of their gap is added.
        """
        self_film = self.equations.influence.self_film
        flow = reynolds.residual(
            self.film, self.balance, self.sources.reynolds, self_film, self.residual
        )
        return flow + self.share.error(self)

    def missing_load(self) -> float:
        """Return w less the integral of P, inside and outside the domain [-]."""
        inside = self.equations.load.integral(self.pressure)
        missing = self.sources.load - self.sources.outside - inside
        return missing + self.share.answered(self)

    def load_error(self) -> float:
        """Return the relative error of the load balance."""
        return -self.missing_load() / self.sources.load

    # full approximation scheme

    def restrict_to(self, coarse: "Level") -> None:
        """Pose the FAS problem of this level's error on ``coarse``."""
        self.update()
        self.evaluate_residual()
        self.restrict_solution(coarse)
        self.restrict_film(coarse)
        self.restrict_reynolds(coarse)
        self.restrict_load(coarse)
        coarse.share.follow_response(self.share, coarse)
        coarse._is_stale = False  # its film is the injected one, not that of K_c P_c

    def restrict_solution(self, coarse: "Level") -> None:
        """Restrict P by full weighting, beside cavities and on edges by injection, and H00.

        Coarse nodes of low pressure beside a cavity are frozen: the coarse grid would cavitate them
        in every cycle (Venner and Lubrecht 2000, chapter 6, restrict there by injection).
        """
        mirror, frozen = self.stencil.mirror, coarse.smoother.frozen
        limit = self.cavity.frozen_below
        transfer.restrict_pressure(self.film.p, mirror, coarse.film.p)
        transfer.freeze(self.film.p, self.smoother.frozen, coarse.film.p, mirror, limit, frozen)
        coarse.is_finest, coarse.sources.outside = False, 0.0
        self.cavity.inject(self, coarse)
        # I P and H00: `correct_from` interpolates the change since
        before, _ = coarse.restricted
        before[:] = coarse.film.p
        coarse.restricted = (before, self.rigid_approach)
        coarse.rigid_approach = self.rigid_approach

    def restrict_film(self, coarse: "Level") -> None:
        """Pose the film equation:  g_c = I H - K_c P_c - H00,  I injection.

        The fine film satisfies its equation exactly, so there is no residual to add. Density and
        conductance of the coarse grid follow from the injected film.
        """
        g = coarse.sources.film
        coarse.separation[:] = self.share.gap(self)[::2, ::2]
        coarse.share.receive(coarse)
        coarse.equations.deformation.deflect(coarse.pressure, g)
        np.subtract(coarse.separation, g, out=g)
        g -= coarse.rigid_approach

    def restrict_reynolds(self, coarse: "Level") -> None:
        """Pose the Reynolds equation:  f_c = L_c(P_c, H_c) + R (f - L(P, H)),  R full weighting.

        The residual is zero where the fine grid is cavitated: complementarity holds there.
        """
        mirror = self.stencil.mirror
        self.cavity.restrict(self, coarse)
        transfer.restrict_residual(self.residual, mirror, coarse.residual)
        reynolds.operator(coarse.film, coarse.stencil, coarse.sources.reynolds)
        coarse.sources.reynolds += coarse.residual

    def restrict_load(self, coarse: "Level") -> None:
        """Pose the load balance:  w_c = sum(P_c) dx_c dy_c + (w - sum(P) dx dy)."""
        carried = coarse.equations.load.integral(coarse.pressure)
        coarse.sources.load = self.missing_load() + carried

    def correct_from(self, coarse: "Level") -> None:
        """Add the interpolated change  u_c - I u  of the coarse grid, u the pressure and H00.

        By bilinear interpolation, never across the cavitation front: two grids would move the front
        back and forth.
        """
        (before, approach), (part, limit) = coarse.restricted, coarse.correction
        mirror, now = self.stencil.mirror, coarse.share.changed(coarse)
        transfer.correct(self.film.p, now, before, mirror, (part, limit, self.share.lowest))
        self.cavity.correct(self, coarse, before, (part, limit))
        self.rigid_approach += part * (coarse.rigid_approach - approach)
        self._is_stale = True
