"""One grid of the hierarchy: its unknowns, its right-hand sides, and its relaxation.

The unknowns are the pressure P and the rigid motions: the approach H00, and the tilt of a roller
that follows from the moment of its load. The film H follows from them. On the finest grid the
right-hand sides f, g, w of `tehl.solver.cycle.equations` are those of the problem, on a coarser one
those of `tehl.solver.cycle.transfers`.
"""

from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.kernels import properties, reynolds
from tehl.kernels.faces import STEADILY, Stencil
from tehl.operators.far_field import Edges, slope_of
from tehl.solver.cycle.equations import Equations, Sources
from tehl.solver.cycle.relaxation import Relaxation, make_smoother
from tehl.solver.physics.cavity import cavity_of
from tehl.solver.physics.solid_shares import share_of


class Correction(NamedTuple):
    """What a level gives to the next finer grid."""

    part: float
    """Of the correction that is added [-]."""
    limit: float
    """Largest change of a pressure by it, over that pressure [-]."""
    pressure: Array
    rigid: Array
    """P and the rigid motions of the finer grid, restricted: their change since is added."""


class Level:
    """One grid with its unknowns.

    What changes pressures, rigid approach or heights marks the film as stale; `update` evaluates
    film, density and conductance again.
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
        speed, drift = equations.entrainment
        south, north = equations.grid.across
        self.film = self.film._replace(speed=speed, drift=drift, south=south, north=north)
        # of the mean planes: the film itself where no solids carry load
        self.separation = np.zeros(shape) if self.film.asperity.size else h
        balances = equations.balances
        self.rigid = np.zeros(len(balances.modes))
        self.sources = Sources(f, g, balances.target, balances.moments, np.zeros(shape))
        self.correction = Correction(*relaxation.correction, np.zeros(shape), self.rigid)
        self.factors: properties.Factors | None = None
        self.is_stale = True

    @property
    def grid(self) -> Grid:
        """The nodes."""
        return self.equations.grid

    @property
    def far_field(self) -> Edges | None:
        """Pressure on the edges and load outside of the finest level; None if it is zero."""
        return self.equations.outside.far_field if self.is_finest else None

    @property
    def stencil(self) -> Stencil:
        """Weights of the Reynolds operator.

        Coarser levels of a cycle, and the coarsest, have a wedge of second order (double
        discretisation: Brandt 1982): it is more robust where the mesh does not resolve the film.
        """
        return self.equations.stencil if self.is_finest else self.equations.robust

    @property
    def balance(self) -> Stencil:
        """The same by fluxes through the faces of cells where surfaces may touch.

        The order of each flux is then chosen by `Film.second`, and oil is conserved all the same.
        In a time step there are none: what moves with the film stays in it. Coarser grids of a
        cycle correct the finest one by the usual wedge.
        """
        if not (self.share.by_flux and self.is_finest) or self.stencil.w1 == 0.0:
            return self.stencil
        return self.stencil._replace(conserves=STEADILY)

    # state

    def set_state(
        self, pressure: Array, rigid: Array | float, asperity: Array | float = 0.0
    ) -> None:
        """Set the pressures of oil and asperities, and the rigid motions; the film is stale.

        Parameters
        ----------
        pressure : array of ``grid.shape``
            Of the oil; it is cavitated where this is zero.
        rigid : (motions,) array or float
            Film by the rigid motions at Y = 1 [-]; the approach H00 alone has no other ones.
        asperity : array of ``grid.shape``
            Of the asperities: where oil and they share a pressure, its parts follow with the film.
        """
        self.film.p[:] = pressure
        self.film.asperity[:] = asperity
        if self.grid.wraps:  # the last row is the first one again
            for field in (self.film.p, self.film.asperity):
                field[-1:] = field[:1]
        self.rigid = np.append(rigid, np.zeros(self.rigid.size - np.size(rigid)))
        self.is_stale = True

    def set_pressure(self, pressure: Array) -> None:
        """Set the pressure of oil and asperities together; the film is stale.

        With asperities the oil stays cavitated where it is.
        """
        solids = self.film.asperity
        if not solids.size:
            self.set_state(pressure, self.rigid)
        else:
            oil = np.where(self.film.p == 0.0, 0.0, pressure - solids)
            self.set_state(oil, self.rigid, pressure - oil)

    def state(self) -> tuple[Array, Array, Array]:
        """Return a copy of what `set_state` sets."""
        return self.film.p.copy(), self.rigid.copy(), self.film.asperity.copy()

    @property
    def rigid_approach(self) -> float:
        """H00 [-]."""
        return float(self.rigid[0])

    @property
    def rigid_film(self) -> Array:
        """Film by the rigid motions, (ny, 1) [-]."""
        return (self.rigid @ self.equations.balances.modes)[:, None]

    def move(self, change: Array | float) -> None:
        """Change the rigid motions, or the approach alone."""
        self.rigid[: np.size(change)] += change
        self.is_stale = True

    @property
    def pressure(self) -> Array:
        """Pressure of oil and asperities together [-]."""
        film = self.film
        return film.p + film.asperity if film.asperity.size else film.p

    def update(self) -> None:
        """Evaluate film H = H00 + K P + g, conductance and density if they are stale."""
        if not self.is_stale:
            return
        h = self.separation
        # the deflection is the largest part of the cost: once per change of the pressure
        self.equations.deformation.deflect(self.pressure, h)
        np.add(h, self.sources.film, out=h)
        np.add(h, self.share.raised(self.rigid_film), out=h)
        if self.far_field is not None:
            self.far_field.set_edges(self.film.p, h)
        self.share.follow(self, self.share.reach)
        self.is_stale = False
        self.cavity.mark(self)

    def update_properties(self, film: properties.Film | None = None) -> None:
        """Evaluate conductance and density for the pressure and film, those of the level or others.

        Parameters
        ----------
        film : Film or None
            Another one, whose fields are written.
        """
        film = self.film if film is None else film
        flow, floor = self.equations.flow, self.equations.floor
        if self.factors is None:
            properties.properties(film, flow, floor)
        else:
            properties.heated_properties(film, self.factors, flow, floor)

    def couple(self, factors: properties.Factors | None) -> None:
        """Set the factors of heat and shear thinning on mobility and density; None has none."""
        if factors is None:
            eps_y = self.film.eps_y if self.film.across.size else self.film.eps
            self.film = self.film._replace(eps_x=self.film.eps, eps_y=eps_y)
            self.is_stale = True
        elif self.factors is None:
            eps_x, eps_y = np.empty(self.grid.shape), np.empty(self.grid.shape)
            self.film = self.film._replace(eps_x=eps_x, eps_y=eps_y)
        self.factors = factors

    # right-hand sides of the finest level

    def apply_heights(self, part: float) -> None:
        """Set g = gap - ``part`` * heights."""
        self.sources.film[:] = self.equations.gap
        if self.sources.heights is not None:
            self.sources.film -= part * self.sources.heights
        self.is_stale = True

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
        if self.sources.drift is not None:
            self.sources.reynolds += self.sources.drift

    # relaxation and residual

    def set_relaxation(self, relaxation: Relaxation) -> None:
        """Change the settings of the smoother; frozen nodes stay frozen."""
        frozen = self.smoother.frozen
        if self.share.is_steep:
            part, limit = relaxation.correction
            self.correction = self.correction._replace(part=part, limit=limit)
        self.smoother = make_smoother(self.equations, relaxation)
        self.smoother.frozen[:] = frozen

    def relax(self, sweeps: int) -> None:
        """Smooth the error of the pressure by ``sweeps`` relaxation sweeps."""
        for _ in range(sweeps):
            self.update()
            self.smoother.sweep(self.film, self.balance, self.sources.reynolds, self.equations.flow)
            self.is_stale = True

    def evaluate_residual(self) -> float:
        """Evaluate f - L(P), zero where cavitated; return its mean over the local diagonal.

        Where surfaces touch the error of their gap is added.
        """
        self_film = self.equations.influence.self_film
        flow = reynolds.residual(
            self.film, self.balance, self.sources.reynolds, self_film, self.sources.residual
        )
        return flow + self.share.error(self)

    def missing_load(self) -> float:
        """Return w less the integral of P, inside and outside the domain [-]."""
        inside = self.equations.balances.integral(self.pressure)
        missing = self.sources.load - self.outside - inside
        return missing + self.share.answered(self)

    def missing(self) -> Array:
        """Return what is missing of the load and of its stated moments, (motions,) [-]."""
        carried = self.equations.balances.moments_of(self.pressure)
        return np.append(self.missing_load(), self.sources.moments - carried)

    @property
    def outside(self) -> float:
        """Load beyond the edges, part of w; on coarser grids what it has changed by there [-]."""
        far = self.far_field
        if far is None:
            return self.sources.outside * float(self.rigid[0] - self.correction.rigid[0])
        return far.load(self.separation, self.equations.gap)

    @property
    def outside_slope(self) -> float:
        """Change of the load beyond the edges with the approach [-]."""
        far = self.far_field
        if far is None:
            return self.sources.outside
        return slope_of(far, self.separation, self.equations.gap)

    def load_error(self) -> float:
        """Return the error of the load balance, or that of a moment if it is larger, over w."""
        missing = self.missing()
        return -float(missing[np.abs(missing).argmax()]) / self.sources.load
