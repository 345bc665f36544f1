"""Drawings of the theory pages, made by the package from a solved contact."""

from pathlib import Path

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch

import tehl
from tehl.kernels.reynolds import mark_dipoles
from tehl.operators.flow import flow_table
from tehl.operators.influence import influence_of
from tehl.operators.reynolds import line_influence
from tehl.scaling import groups, scales
from tehl.solver.fas import Cycle, cycle
from tehl.solver.level import Level
from tehl.solver.smoother import FAST, LineSmoother
from tehl.solver.steady import finest_grid

POINTS = 129


def make(folder: Path) -> None:
    """Draw all figures into ``folder``."""
    folder.mkdir(exist_ok=True)
    for name, draw in {"dipoles": dipoles, "regions": regions, "visits": visits}.items():
        path = folder / f"{name}.svg"
        if not path.exists() or path.stat().st_mtime < Path(__file__).stat().st_mtime:
            draw().savefig(path)


def problem() -> tehl.ContactProblem:
    """Return the contact of the drawings: M = 100, L = 10."""
    return tehl.ContactProblem(
        contact=tehl.Contact(radius="20 mm", moes_load=100.0, moes_speed=10.0),
        surface_1=tehl.Surface(material="steel"),
        surface_2=tehl.Surface(material="steel"),
        lubricant="mineral-oil",
    )


def level() -> Level:
    """Return the solved contact as the grid that the relaxation sees."""
    case, options = problem(), tehl.Options(points=POINTS, half_domain="never")
    result = tehl.solve(case, options)
    numbers = groups(case)
    grid = finest_grid(options, numbers)
    here = Level(grid, numbers, flow_table(case, scales(case), numbers), options, FAST)
    here.film.p[:] = result.scaled.pressure
    here.film.h[:] = result.scaled.film
    here.update_properties()
    return here


def regions() -> Figure:
    """Draw which nodes relax as points, which as dipoles, and which are cavitated."""
    here = level()
    smoother = here.smoother
    assert isinstance(smoother, LineSmoother)
    mark_dipoles(here.film, here.mesh, smoother.relaxation)
    kind = np.where(here.film.p > 0, smoother.relaxation.kind + 1.0, 0.0)
    figure = Figure(figsize=(5.0, 4.4), layout="constrained")
    axes = figure.add_subplot(xlabel="X", ylabel="Y")
    grid, colours = here.grid, ["#d9d9d9", "#4c78a8", "#e45756"]
    (west, east), (south, north) = grid.domain.x, grid.domain.y
    edges = (west - grid.dx / 2, east + grid.dx / 2, south - grid.dy / 2, north + grid.dy / 2)
    axes.imshow(
        kind, extent=edges, origin="lower", interpolation="nearest", cmap=ListedColormap(colours)
    )
    axes.add_patch(Circle((0, 0), 1, fill=False, ls="--"))
    axes.set(xlim=(-2, 1.5), ylim=(-1.6, 1.6))
    names = ("cavitated", "points", "dipoles")
    axes.legend(
        handles=[Patch(color=c, label=n) for c, n in zip(colours, names, strict=True)],
        loc="upper left",
    )
    return figure


def dipoles() -> Figure:
    """Draw how far a change of one node and a dipole reach."""
    grid = finest_grid(tehl.Options(points=POINTS), groups(problem()))
    point, dipole = line_influence(influence_of(grid, groups(problem())))
    figure = Figure(figsize=(5.4, 3.4), layout="constrained")
    axes = figure.add_subplot(
        xlabel="distance along the line [nodes]", ylabel="change of film / that at the node"
    )
    axes.semilogy(np.arange(len(point)), point / point[0], "o-", label="one node")
    axes.semilogy(np.arange(len(dipole)), np.abs(dipole) / dipole[0], "s-", label="dipole")
    axes.legend()
    return figure


class Visitor:
    """A level that only notes when it is visited."""

    def __init__(self, number: int, path: list[int]) -> None:
        self.number, self.path = number, path

    def relax(self, sweeps: int) -> None:
        """Note the visit; none without sweeps."""
        if sweeps:
            self.path.append(self.number)

    def restrict_to(self, coarse: "Visitor") -> None:
        """Do nothing."""

    def correct_from(self, coarse: "Visitor") -> None:
        """Do nothing."""


def visits() -> Figure:
    """Draw the order in which full multigrid with V-cycles visits the grids."""
    path = [0]
    shape = Cycle(kind="V", pre_sweeps=2, post_sweeps=2)
    levels = [Visitor(number, path) for number in range(4)]
    for count in (2, 3, 4):
        path.append(count - 1)
        for _ in range(2):
            cycle(levels[:count], lambda: path.append(0), shape)
    figure = Figure(figsize=(7.2, 2.8), layout="constrained")
    axes = figure.add_subplot(yticks=range(4), xticks=[])
    axes.set_yticklabels(["17", "33", "65", "129"])
    axes.set_ylabel("nodes per direction")
    axes.plot(path, "o-", ms=3, lw=1)
    axes.set_xlabel("upward by interpolation, then two V-cycles on each grid")
    return figure
