"""The discrete equations on one grid: operators and right-hand sides.

    L(P, H) = f                       Reynolds: (eps P_x)_x + (eps P_y)_y/kappa^2 - (rho H)_x,
    H - H00 - T Y - K P = g           film, K the elastic deflection of the half-spaces,
    sum(P) dx dy = w                  load balance
    sum(Y P) dx dy = m                moment balance, where it is stated; else T = 0

(docs/theory/model.md), with P >= 0 and complementarity where the film is cavitated.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.contact.moment import Moment
from tehl.contact.options import Options
from tehl.estimate.grid import Grid
from tehl.estimate.inlet_heating import inlet_heating_factor
from tehl.estimate.scaling import Groups, ScaledProblem
from tehl.estimate.spin import spin_number
from tehl.estimate.starvation import EnteringOil, entering_oil, supplied_film
from tehl.estimate.summits import shared_load
from tehl.kernels.faces import Stencil
from tehl.operators.deformation import Deformation, choose
from tehl.operators.dry import start_pressure
from tehl.operators.far_field import Edges
from tehl.operators.far_spin import oil_outside
from tehl.operators.film import gap, rigid_motions
from tehl.operators.flow import FlowTable
from tehl.operators.influence import Influence, influence_of
from tehl.operators.load import Load
from tehl.operators.reynolds import of_second_order, steady_stencil
from tehl.operators.summits import AsperityTable, asperity_table
from tehl.operators.turning import Entrainment, entrainment

MOSTLY_DRY = 0.8
"""Part of the load on asperities, by formulas, from which those of point contacts without oil
change together: two circles (0.91 and 0.98 of the load, M = 856 and 224, the second with scarce
oil) converged by no strategy in 25 s, and do in 0.5 and 0.2; a gear tooth with 0.98 takes a third
of the time. With less they take up to twice the time, and an outer ring (0.17, M = 74,000) no
longer converges."""
FLOOR = 0.02
"""Least film in the conductance, over the expected central film: a heated roller with M = 68 has
0.017 of its isothermal film at its ends, and 0.05 of its own."""
AT_REST = 0.05
"""The same over that where the speed varies in time: a line (M = 10, L = 16) that stops has 0.022
of its film at its edges 4 ms later, and ever less."""


class Balances(NamedTuple):
    """Balances of the load and of its stated moments."""

    load: Load
    """Integral over the grid."""
    target: float
    """Integral of P over the domain [-]."""
    modes: Array
    """Film by each rigid motion over its size, (motions, ny): one by the approach, and Y by the
    tilt of a roller whose moment is stated."""
    moments: Array
    """Integral of P times each motion but the approach, (motions - 1,) [-]."""

    def integral(self, field: Array) -> float:
        """Return the integral of a field over the domain, ``grid.shape`` [-]."""
        return self.load.integral(field)

    def moments_of(self, pressure: Array) -> Array:
        """Return the integral of a pressure times each motion but the approach [-]."""
        return np.array([self.integral(mode[:, None] * pressure) for mode in self.modes[1:]])


class Outside(NamedTuple):
    """The oil beyond the edges of the grid."""

    far_field: Edges | None
    """Pressure on the edges and load outside; None if the pressure is zero there."""
    layer: Array | None
    """Oil that enters each line, ``rho H``, (ny,), infinite if flooded; None if oil is not
    conserved in cavities."""


class Solids(NamedTuple):
    """The bodies: how curved they are, and what carries load beside the oil."""

    asperities: AsperityTable | None
    """Laws of asperities finer than the grid; None without."""
    together: bool
    """Whether asperities that carry alone change together, not each by itself."""
    contact_film: float | None
    """Boundary film through which the surfaces may touch [-]; None has no contact."""
    friction: float
    """Friction coefficient where surfaces touch through it [-]."""
    curvature: float
    """1/R_x at this moment over that of the contact [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Equations:
    """The operators on one grid, which do not change while the equations are solved."""

    grid: Grid
    groups: Groups
    flow: FlowTable
    """Mobility and density of the lubricant over pressure."""
    stencil: Stencil
    """Weights of the Reynolds operator on the finest grid of a cycle."""
    influence: Influence
    """Deflection per unit pressure on one cell."""
    deformation: Deformation
    """The sum K P over all cells."""
    balances: Balances
    """Of the load and of its stated moments."""
    gap: Array
    """Undeformed gap [-], ``grid.shape``."""
    outside: Outside
    """The oil beyond the edges."""
    solids: Solids
    """How curved the bodies are, and what carries load beside the oil."""
    floor: float
    """Least film in the conductance [-]: the discrete film of coarse grids may not be positive."""
    entrainment: Entrainment
    """Mean speeds of the surfaces where they spin, without elements where they do not."""

    def start_pressure(self) -> Array:
        """Return the dry pressure of this moment to start from, ``grid.shape`` [-]."""
        load, curvature = self.balances.target, self.solids.curvature
        return start_pressure(self.grid, self.groups, load, curvature)

    @property
    def robust(self) -> Stencil:
        """Weights on the coarser grids of a cycle: a wedge of second order at most."""
        return of_second_order(self.stencil)

    def at(self, moment: Moment, scaled: ScaledProblem) -> "Equations":
        """Return the equations with load, gap and pressure on the edges at another moment.

        Parameters
        ----------
        moment, scaled : Moment, ScaledProblem
            Load, motion and radius; and the contact.
        """
        balances = self.balances._replace(target=moment.load * self.groups.shape.load)
        stated = scaled.moment
        if (moment.speed, moment.curvature) == (stated.speed, stated.curvature) and (
            moment.load == stated.load or not self.groups.shape.as_line
        ):
            return replace(self, balances=balances)
        outside = self.outside
        if outside.far_field is not None:
            far = oil_outside(self.grid, scaled, moment)
            outside = outside._replace(far_field=far)
        return replace(
            self,
            balances=balances,
            gap=gap(self.grid, self.groups, moment.curvature),
            outside=outside,
            solids=self.solids._replace(curvature=moment.curvature),
        )

    @classmethod
    def on(
        cls,
        grid: Grid,
        scaled: ScaledProblem,
        flow: FlowTable,
        options: Options,
    ) -> "Equations":
        """Discretise a contact.

        Parameters
        ----------
        grid, scaled : Grid, ScaledProblem
            The nodes, and the contact.
        flow : FlowTable
            Mobility and density of the lubricant, the same on all grids.
        options : Options
            Order of the wedge, and method of the deflection.
        """
        groups, oil, moment = scaled.groups, entering_oil(scaled), scaled.moment
        conserves = scaled.problem.conserves_oil
        film, far, spins = scaled.problem.contact_film, None, spin_number(scaled) != 0.0
        if options.has_far_field and oil is None:
            far = oil_outside(grid, scaled, moment)
        modes, moments = rigid_motions(grid, groups)
        return cls(
            grid=grid,
            groups=groups,
            flow=flow,
            stencil=steady_stencil(
                grid,
                groups,
                options.order,
                conserves=conserves,
                speed=1.0 if spins else moment.speed,  # that of a spin has its own for each row
                oblique=groups.twist != 0.0 or spins,
            ),
            influence=influence_of(grid, groups),
            deformation=choose(
                options.deformation, grid, groups, exact=options.accuracy == "tight"
            ),
            balances=Balances(Load(grid), moment.load * groups.shape.load, modes, moments),
            gap=gap(grid, groups, moment.curvature),
            outside=Outside(far, _layer(scaled, oil, grid)),
            solids=Solids(
                asperity_table(scaled),
                together=move_together(scaled),
                contact_film=boundary_film(scaled),
                friction=0.0 if film is None else film.friction,
                curvature=moment.curvature,
            ),
            floor=_floor(scaled),
            entrainment=entrainment(grid, scaled),
        )


def move_together(scaled: ScaledProblem) -> bool:
    """Return whether dry asperities change together: on lines and rollers, whose bodies yield far.

    And where oil carries so little that nearly all of them are dry.
    """
    if scaled.problem.asperities is None:
        return False
    return scaled.groups.shape.as_line or shared_load(scaled).share > MOSTLY_DRY


def boundary_film(scaled: ScaledProblem) -> float | None:
    """Return the boundary film through which the surfaces may touch [-]; None has no contact."""
    film = scaled.problem.contact_film
    return None if film is None else film.thickness / scaled.scales.film_thickness


def _floor(scaled: ScaledProblem) -> float:
    """Return the least film in the conductance [-].

    Films of hot inlets are thinner, and that at the end of a roller is a hundredth of the central.
    """
    if scaled.problem.asperities is not None:
        return 0.0
    contact = boundary_film(scaled)
    if contact is not None:
        return contact
    problem = scaled.problem
    heated = inlet_heating_factor(problem) if problem.thermal is not None else None
    varies = problem.transient is not None and bool(problem.transient.entrainment_speed)
    return FLOOR * supplied_film(scaled) * (heated or 1.0) * (AT_REST if varies else 1.0)


def _layer(scaled: ScaledProblem, oil: EnteringOil | None, grid: Grid) -> Array | None:
    """Return the oil that enters each line of a grid; None if its cavities do not conserve it."""
    if not scaled.problem.conserves_oil:
        return None
    return np.full(grid.shape[0], np.inf) if oil is None else oil(grid.y)


@dataclass(slots=True)
class Sources:
    """Right-hand sides: f of the Reynolds, g of the film equation, w and m of the balances.

    ``residual`` is what f leaves at the last evaluation, and ``heights`` are those of the surfaces
    that g has lost. ``history`` is the contribution of previous films to wedge and squeeze in a
    time step; f is less by it. ``drift`` is the divergence of what sliding carries beside the mean
    flow; f is more by it. ``outside`` is what the load beyond the edges changes by with the
    approach, on coarser grids.
    """

    reynolds: Array
    film: Array
    load: float
    moments: Array
    residual: Array
    heights: Array | None = None
    history: Array | None = None
    drift: Array | None = None
    outside: float = 0.0
