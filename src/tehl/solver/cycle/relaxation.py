"""Relaxation of the pressure on one grid: hybrid line relaxation, and point Gauss-Seidel.

Where the film conducts, the Poiseuille term dominates, and Gauss-Seidel by lines along x smooths
the error. In the contact the equation is (rho H)_x = 0 and a change at one node moves the film
everywhere, so nodes change there as dipoles: one up, its four neighbours down by a quarter each
(Venner and Lubrecht 2000, chapter 6; docs/theory/relaxation.md).
"""

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from tehl.base.typing import Array, FlagArray, IntArray
from tehl.estimate.grid import LONG_STRETCH, Grid
from tehl.kernels import relaxation as kernels
from tehl.kernels.faces import CLOSED, Stencil
from tehl.kernels.properties import Film
from tehl.operators.flow import FlowTable
from tehl.operators.influence import Influence
from tehl.operators.reynolds import line_influence, line_shapes
from tehl.operators.turning import curved_influence
from tehl.solver.cycle.equations import FLOOR, Equations


@dataclass(frozen=True, kw_only=True, slots=True)
class Relaxation:
    """Settings of the hybrid line relaxation."""

    name: str
    """As in `tehl.contact.options.Options` and in the reports of the cycles."""
    threshold: float
    """Conductance over mesh width squared below which a node relaxes as a dipole [-]."""
    point: float
    dipole: float
    """Under-relaxation of points (Gauss-Seidel) and of dipoles (Jacobi) [-]."""
    lines: int = 0
    """Lines to each side that are assumed to change with a line while it is solved. At a ridge
    across the flow neighbouring lines change alike, and their films add."""
    stiff: bool = False
    """Add the change of conductance with pressure to the diagonal."""
    correction: tuple[float, float] = (1.0, math.inf)
    """Part of the correction of the coarser grid that is added, and largest change of a pressure by
    it, over that pressure: less than all between asperities, and at fronts that it does not
    resolve."""
    together: bool = True
    """Whether asperities that carry alone may change together, not each by itself."""
    rate: float = 0.0
    """Least convergence rate per cycle that iteration errors assume [-], as small steps hide slow
    changes: without it, 14 of 31 bearings (M = 20,000 to 185,000) err by twice to a hundred times
    their iteration errors, and two by more than their bars (minimum films by 0.6 and 2.9 %)."""


FAST = Relaxation(name="fast", threshold=1.0, point=0.7, dipole=0.6)
APART = replace(FAST, together=False)
BROAD = Relaxation(name="broad", threshold=10.0, point=0.7, dipole=0.6)
ROBUST = Relaxation(name="robust", threshold=1.0, point=0.4, dipole=0.3, lines=4, stiff=True)
STEEP = Relaxation(name="steep", threshold=1.0, point=0.25, dipole=0.3, stiff=True, rate=0.5)
THIN = Relaxation(name="thin", threshold=3.0, point=0.12, dipole=0.2, stiff=True, rate=0.65)
FRONTS = replace(STEEP, name="fronts", threshold=3.0, dipole=0.2, correction=(0.7, math.inf))
LIMITED = replace(FRONTS, name="limited", correction=(0.7, 0.3))
STEEPER = Relaxation(name="steeper", threshold=10.0, point=0.25, dipole=0.1, stiff=True)
ROUGH = Relaxation(name="rough", threshold=1.0, point=0.6, dipole=0.4, lines=4)
CAREFUL = Relaxation(name="careful", threshold=1.0, point=0.5, dipole=0.35, lines=4, stiff=True)
DAMPED = Relaxation(name="damped", threshold=1.0, point=0.3, dipole=0.2, lines=4, stiff=True)
BESIDE_NEWTON = Relaxation(name="newton", threshold=1.0, point=0.5, dipole=0.35)
GAUSS_SEIDEL = Relaxation(name="gauss-seidel", threshold=0.0, point=0.5, dipole=0.0)
HELD, HELD_LONG, ROLLER_STRETCH = 1.0, 0.8, 1.5
LINE_THRESHOLD, LINE_POINT, LINE_DIPOLE = 3.0, 0.7, 0.67
"""In a line contact: conductance to neighbours that are held, over that along the line, and factors
on the settings. The one line holds all unknowns, and its system lacks the deflection from afar: it
must not move smooth errors, as lines between held ones do not. Least number of cycles for M = 5 to
200, L = 0 to 11 on 513 to 2049 nodes: 0.2 to 0.5 of the residual is left by each. The second is
that of long cells, beside which lines are held a little: with it 0.24 to 0.32 is left for a_y/a_x =
10 to 50, M = 1000 to 4000. The third is the length of cells over their width from which on those
of a roller are long: as all its lines are alike, an error at the end of its film is one of all."""
ROLLER_POINT, THIN_FILM, POINT_OF_THIN, ROLLER_LINES = 0.7, 0.01, 0.45, 4
"""Of rollers, beside whose lines none are held: factor on the points; central film below which that
is the third one [-]; lines to each side that change with one. An error of the inlet that all lines
share grows with a factor of 0.8 at M = 150, with 0.7 at M = 300 (film 0.004), and on the first grid
of a tilted one at M = 78 (film 0.008, 37 widths), whose first strategy diverged. Where lines are
held, the load of crowned ones alternates from cycle to cycle. 0.2 to 0.35 of the residual is left
for a length of 8 to 140 widths, M = 5 to 150, crowned, logarithmic and lundberg profiles."""


def is_long(stencil: Stencil, *, touches: bool = False) -> bool:
    """Whether lines of a grid conduct so little across that each is a line contact nearby.

    Parameters
    ----------
    stencil : Stencil
        Weights across and along lines.
    touches : bool
        Asperities below the grid carry load: soft ones of an inner ring (a_y/a_x = 13) lose their
        balance where lines of an ellipse are held.
    """
    if stencil.mirror >= CLOSED:
        return stencil.cy * ROLLER_STRETCH**2 < stencil.cx
    return stencil.cy * LONG_STRETCH**2 < stencil.cx and not (touches and stencil.cy > 0.0)


class Smoother(Protocol):
    """Relaxation of the pressure of one level."""

    relaxation: Relaxation
    """Settings."""
    frozen: FlagArray
    """Nodes that keep their pressure on this level, (ny, nx) of 0 and 1."""
    ends: IntArray
    """Nodes from which on all of a line keeps its pressure, (ny,)."""

    def sweep(self, film: Film, stencil: Stencil, rhs: Array, flow: FlowTable) -> None:
        """Relax ``film.p`` in place by one sweep; the rest of ``film`` stays as evaluated last.

        Parameters
        ----------
        film, stencil : Film, Stencil
            Pressure, film, conductance and density; weights of the Reynolds operator.
        rhs, flow : (ny, nx) array, FlowTable
            Right-hand side f; mobility and density of the lubricant.
        """


def _dipole_parts(influence: Influence, stencil: Stencil, *, touches: bool) -> tuple[float, float]:
    """Return the parts by which a dipole lowers each of its neighbours along x and along y.

    A quarter each (Venner and Lubrecht 2000) on square cells. On cells longer along one direction
    the neighbours there are too far to cancel the film of the node: each part is in proportion to
    the inverse square of the distance. Wedges of second order keep the quarters unless cells are
    long. On a line contact there are two neighbours.
    """
    if stencil.cy == 0.0:
        return 0.5, 0.0
    ratio = (influence.dx / influence.dy) ** 2
    if not stencil.geometric and not is_long(stencil, touches=touches):
        return 0.25, 0.25
    return 0.5 / (1.0 + ratio), 0.5 * ratio / (1.0 + ratio)


class LineSmoother:
    """Lines along x in two colours; nodes are points where the film conducts, else dipoles.

    Each line is a linear complementarity problem, solved by policy iteration
    (`tehl.kernels.relaxation.relax_lines`).
    """

    def __init__(
        self,
        grid: Grid,
        influence: Influence,
        relaxation: Relaxation,
        *,
        touches: bool = False,
        parts: tuple[float, float] = (0.25, 0.25),
        curved: Array | None = None,
    ) -> None:
        point, dipole, of_dipoles = map(
            kernels.by_lanes, line_shapes(grid, influence, parts, relaxation.lines)
        )
        shapes = kernels.Shapes(point, dipole, of_dipoles)
        self.frozen = np.zeros(grid.shape, np.uint8)
        self.ends = np.full(grid.shape[0], grid.nx - 1)
        self.stiffness = np.zeros(grid.shape)
        self.workspace = kernels.LineRelaxation(
            xi=relaxation.threshold,
            omega_point=relaxation.point,
            omega_dipole=relaxation.dipole,
            shapes=shapes if curved is None else shapes._replace(curved=curved),
            systems=kernels.empty_systems(grid.nx),
            kind=np.zeros(grid.shape, np.uint8),
            delta=np.zeros(grid.shape),
            frozen=self.frozen,
            stiffness=self.stiffness,
            ends=self.ends,
            touches=int(touches),
        )
        self.relaxation, self.is_stiff = relaxation, relaxation.stiff

    def sweep(self, film: Film, stencil: Stencil, rhs: Array, flow: FlowTable) -> None:
        """Relax ``film.p`` in place."""
        if self.is_stiff or stencil.mirror >= CLOSED:
            kernels.stiffen(film, stencil, flow, int(self.is_stiff), self.stiffness)
        is_held = is_long(stencil, touches=bool(self.workspace.touches))
        if is_held and not self.workspace.apart:
            held = (HELD if stencil.cy == 0.0 else HELD_LONG) * stencil.cx * film.eps_x
            self.stiffness[:] = self.stiffness + held if self.is_stiff else held
        kernels.relax_lines(film, stencil, rhs, self.workspace)


class PointSmoother:
    """Plain Gauss-Seidel, node by node: for teaching, as it diverges in loaded contacts."""

    def __init__(self, grid: Grid, influence: Influence, relaxation: Relaxation) -> None:
        self.frozen = np.zeros(grid.shape, np.uint8)
        self.ends = np.full(grid.shape[0], grid.nx - 1)
        self.point, _ = line_influence(influence)
        self.relaxation, self.omega = relaxation, relaxation.point

    def sweep(self, film: Film, stencil: Stencil, rhs: Array, flow: FlowTable) -> None:
        """Relax ``film.p`` in place."""
        del flow
        kernels.relax_points(film, stencil, rhs, self.point, self.omega)


def make_smoother(equations: Equations, relaxation: Relaxation) -> Smoother:
    """Return the smoother of one grid: plain Gauss-Seidel if so named, else by lines.

    Parameters
    ----------
    equations : Equations
        Grid, influence and stencil of the level.
    relaxation : Relaxation
        One of the named settings of this module.
    """
    if relaxation is GAUSS_SEIDEL:
        return PointSmoother(equations.grid, equations.influence, relaxation)
    settings, touches = relaxation, equations.solids.asperities is not None
    apart = is_long(equations.stencil, touches=touches)
    if apart:
        settings = replace(relaxation, threshold=LINE_THRESHOLD * relaxation.threshold)
        if equations.grid.is_closed:
            point = ROLLER_POINT if equations.floor > FLOOR * THIN_FILM else POINT_OF_THIN
            lines = max(ROLLER_LINES, relaxation.lines)
            settings = replace(settings, point=point * relaxation.point, lines=lines)
        else:
            point, dipole = LINE_POINT * relaxation.point, LINE_DIPOLE * relaxation.dipole
            settings = replace(settings, point=point, dipole=dipole)
    influence = equations.influence
    parts = _dipole_parts(influence, equations.stencil, touches=touches)
    spins = equations.entrainment.speed.size > 0
    curved = curved_influence(influence, equations.stencil, parts) if spins else None
    smoother = LineSmoother(
        equations.grid, influence, settings, touches=touches, parts=parts, curved=curved
    )
    smoother.workspace = smoother.workspace._replace(apart=int(apart and equations.grid.is_closed))
    smoother.relaxation = relaxation
    return smoother
