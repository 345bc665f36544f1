"""Relaxation of pressure on one level: the hybrid line relaxation, and plain Gauss-Seidel."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tehl.grid import Grid
from tehl.kernels.gauss_seidel import relax_points
from tehl.kernels.reynolds import Film, Mesh, Relaxation, relax_lines, stiffen
from tehl.operators.flow import FlowTable
from tehl.operators.influence import Influence
from tehl.operators.reynolds import line_influence
from tehl.typing import Array, FlagArray


@dataclass(frozen=True, kw_only=True, slots=True)
class Rough:
    """Numbers of the full multigrid method for rough surfaces.

    Attributes
    ----------
    correction : float
        Part of its correction that the finest grid that does not resolve the heights gives [-].
    limit : float
        Largest change of pressure by that correction and those above it, over the pressure [-].
    ramp : int
        Cycles over which the heights are raised on the first grid that has them.
    points : float
        Nodes per wave from which a grid has the heights [-].
    lines : int
        Lines to each side that are taken to move with a line where its points are solved for. On
        the steep flank of a ridge along them they do, and together move the film by more than
        each by itself.
    stiff : bool
        Add the change of conductance with pressure to the diagonal.
    memory : int
        Earlier cycles of which the next start is combined (`tehl.solver.anderson`); none if 0.
    patience : int
        Factor on the cycles after which a run is given up.
    follow : float
        Part of the way, in logarithms, that the flow follows what a sweep of the energy equation
        says of heat and shear thinning [-].
    newton : bool
        Take Newton's method in place of the cycles (`tehl.solver.newton`).
    """

    correction: float = 1.0
    limit: float = np.inf
    ramp: int = 4
    points: float = 8.0
    lines: int = 0
    stiff: bool = False
    memory: int = 0
    patience: int = 1
    follow: float = 1.0
    newton: bool = False


@dataclass(frozen=True, kw_only=True, slots=True)
class Setting:
    """Numbers of the hybrid line relaxation.

    Attributes
    ----------
    name : str
        As in `tehl.options.Options`.
    threshold : float
        Conductance over mesh width squared below which a node relaxes as a dipole [-].
    point, dipole : float
        Under-relaxation of points (Gauss-Seidel) and of dipoles (Jacobi) [-].
    rough : Rough
        What is done where the surfaces are rough.
    """

    name: str
    threshold: float
    point: float
    dipole: float
    rough: Rough = Rough()


FAST = Setting(name="fast", threshold=1.0, point=0.7, dipole=0.6)
BROAD = Setting(name="broad", threshold=10.0, point=0.7, dipole=0.6)
ROBUST = Setting(
    name="robust", threshold=1.0, point=0.4, dipole=0.3, rough=Rough(lines=4, stiff=True)
)
ROUGH = Setting(name="rough", threshold=1.0, point=0.6, dipole=0.4, rough=Rough(lines=4, memory=5))
CAREFUL = Setting(
    name="careful",
    threshold=1.0,
    point=0.5,
    dipole=0.35,
    rough=Rough(
        correction=0.5,
        limit=0.3,
        ramp=8,
        lines=4,
        stiff=True,
        memory=8,
        patience=2,
        follow=0.3,
    ),
)
GENTLE = Setting(
    name="gentle",
    threshold=1.0,
    point=0.3,
    dipole=0.2,
    rough=Rough(
        correction=0.15,
        limit=0.15,
        ramp=48,
        points=12.0,
        lines=4,
        stiff=True,
        memory=10,
        patience=3,
        follow=0.3,
    ),
)
NEWTON = Setting(
    name="newton", threshold=1.0, point=0.5, dipole=0.35, rough=Rough(points=5.0, newton=True)
)
POINTWISE = Setting(name="gauss-seidel", threshold=0.0, point=0.5, dipole=0.0)
SETTINGS = {setting.name: setting for setting in (FAST, BROAD, ROBUST, POINTWISE)}


class Smoother(Protocol):
    """One sweep over the pressure of a level; the film is that of the last evaluation."""

    frozen: FlagArray
    """Nodes that keep their pressure on this level, (ny, nx) of 0 and 1."""

    def sweep(self, film: Film, mesh: Mesh, rhs: Array, flow: FlowTable) -> None:
        """Relax ``film.p`` in place."""
        ...


class LineSmoother:
    """Lines along x in two colours: points where the film conducts, dipoles in the contact."""

    def __init__(self, grid: Grid, influence: Influence, setting: Setting) -> None:
        point, dipole = line_influence(influence)
        point += 2.0 * neighbours(influence, setting.rough.lines, point.size)
        self.frozen = np.zeros(grid.shape, np.uint8)
        self.steep = np.zeros(grid.shape)
        self.relaxation = Relaxation(
            xi=setting.threshold,
            omega_point=setting.point,
            omega_dipole=setting.dipole,
            point=point,
            dipole=dipole,
            kind=np.zeros(grid.shape, np.uint8),
            delta=np.zeros(grid.shape),
            frozen=self.frozen,
            steep=self.steep,
        )
        self.is_stiff = setting.rough.stiff

    def sweep(self, film: Film, mesh: Mesh, rhs: Array, flow: FlowTable) -> None:
        """Relax ``film.p`` in place."""
        if self.is_stiff:
            stiffen(film, mesh, flow.table, flow.step, self.steep)
        relax_lines(film, mesh, rhs, self.relaxation)


class PointSmoother:
    """Plain Gauss-Seidel, node by node: for teaching; it fails when the contact is loaded."""

    def __init__(self, grid: Grid, influence: Influence, setting: Setting) -> None:
        self.frozen = np.zeros(grid.shape, np.uint8)
        self.point, _ = line_influence(influence)
        self.omega = setting.point

    def sweep(self, film: Film, mesh: Mesh, rhs: Array, flow: FlowTable) -> None:
        """Relax ``film.p`` in place."""
        del flow
        relax_points(film, mesh, rhs, self.point, self.omega)


def neighbours(influence: Influence, lines: int, size: int) -> Array:
    """Return the film along a line by a unit change of nodes abreast of it on 1 to ``lines``."""
    total = np.zeros(size)
    for line in range(1, lines + 1):
        total += influence(line, slice(0, size))
    return total


def make_smoother(grid: Grid, influence: Influence, setting: Setting) -> Smoother:
    """Return the smoother of ``setting`` for one grid."""
    if setting is POINTWISE:
        return PointSmoother(grid, influence, setting)
    return LineSmoother(grid, influence, setting)
