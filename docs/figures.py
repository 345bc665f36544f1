"""Draw the figures of the theory pages from solved contacts."""

from pathlib import Path

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch

import tehl
from tehl.estimate.nodes import finest_grid
from tehl.estimate.scaling import ScaledProblem
from tehl.operators.flow import flow_table
from tehl.operators.influence import influence_of
from tehl.operators.reynolds import line_influence
from tehl.post.waves import WaveResponse, wave_responses
from tehl.roughness import Wave
from tehl.solver.cycle.equations import Equations
from tehl.solver.cycle.fas import Cycle, Transfers, cycle
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.relaxation import FAST, LineSmoother

POINTS = 129


def make(folder: Path) -> None:
    """Draw all figures into ``folder``."""
    folder.mkdir(exist_ok=True)
    drawings = {"dipoles": dipoles, "regions": regions, "visits": visits, "ripples": ripples}
    for name, draw in drawings.items():
        path = folder / f"{name}.svg"
        if not path.exists() or path.stat().st_mtime < Path(__file__).stat().st_mtime:
            draw().savefig(path)


def problem(load: float = 100.0) -> tehl.ContactProblem:
    """Return the contact of the figures, at L = 10."""
    return tehl.ContactProblem(
        contact=tehl.Contact(radius="20 mm", moes_load=load, moes_speed=10.0),
        surface_1=tehl.Surface(material="steel"),
        surface_2=tehl.Surface(material="steel"),
        lubricant="mineral-oil",
    )


def level() -> Level:
    """Return the level of the finest grid of the solved contact."""
    case, options = problem(), tehl.Options(points=POINTS, half_domain="never")
    result = tehl.solve(case, options)
    scaled = ScaledProblem.of(case)
    grid = finest_grid(scaled, options)
    here = Level(Equations.on(grid, scaled, flow_table(scaled), options), FAST)
    here.film.p[:] = result.scaled.pressure
    here.film.h[:] = result.scaled.film
    here.update_properties()
    return here


def regions() -> Figure:
    """Draw the nodes that relax as points and as dipoles, and the cavitated ones."""
    here = level()
    smoother = here.smoother
    assert isinstance(smoother, LineSmoother)
    here.relax(1)  # which marks the dipoles
    kind = np.where(here.film.p > 0, smoother.workspace.kind + 1.0, 0.0)
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
    """Draw the change of the film by one node and by a dipole, over the distance."""
    scaled = ScaledProblem.of(problem())
    grid = finest_grid(scaled, tehl.Options(points=POINTS))
    point, dipole = line_influence(influence_of(grid, scaled.groups))
    figure = Figure(figsize=(5.4, 3.4), layout="constrained")
    axes = figure.add_subplot(
        xlabel="distance along the line [nodes]", ylabel="change of film / that at the node"
    )
    axes.semilogy(np.arange(len(point)), point / point[0], "o-", label="one node")
    axes.semilogy(np.arange(len(dipole)), np.abs(dipole) / dipole[0], "s-", label="dipole")
    axes.legend()
    return figure


class Visitor:
    """A level that records its visits."""

    def __init__(self, number: int, path: list[int]) -> None:
        self.number, self.path = number, path

    def relax(self, sweeps: int) -> None:
        """Record a visit with sweeps."""
        if sweeps:
            self.path.append(self.number)


def nothing(fine: Visitor, coarse: Visitor) -> None:
    """Transfer nothing."""


def visits() -> Figure:
    """Draw the order in which full multigrid with V-cycles visits the grids."""
    path = [0]
    shape = Cycle(kind="V", pre_sweeps=2, post_sweeps=2)
    levels = [Visitor(number, path) for number in range(4)]
    for count in (2, 3, 4):
        path.append(count - 1)
        for _ in range(2):
            cycle(levels[:count], lambda: path.append(0), Transfers(*2 * (nothing,)), shape)
    figure = Figure(figsize=(7.2, 2.8), layout="constrained")
    axes = figure.add_subplot(yticks=range(4), xticks=[])
    axes.set_yticklabels(["17", "33", "65", "129"])
    axes.set_ylabel("nodes per direction")
    axes.plot(path, "o-", ms=3, lw=1)
    axes.set_xlabel("upward by interpolation, then two V-cycles on each grid")
    return figure


def ripples() -> Figure:
    """Draw the part of standing waves that remains in the film, computed and by theory."""
    lengths = (0.25, 0.35, 0.5)
    figure = Figure(figsize=(5.6, 3.8), layout="constrained")
    axes = figure.add_subplot(xlabel="wavelength / a", ylabel="ripple of the film / wave")
    options = tehl.Options(points=257, domain=tehl.Domain(x=(-2.5, 1.5), y=(-2.0, 2.0)))
    smooth = tehl.solve(problem(200.0), options)
    for angle, mark in ((0.0, "o"), (45.0, "+"), (90.0, "^")):
        found = [response(length, angle, options, smooth) for length in lengths]
        left = [wave.film_ratio for wave in found]
        axes.plot(lengths, left, mark, ms=9, mfc="none", label=f"computed, {angle:g}°")
        if angle == 0.0:
            axes.plot(lengths, [w.theory.film_ratio for w in found], "k-", lw=0.8, label="theory")
    axes.set(ylim=(0, 1), title="M = 200, L = 10, crests across the entrainment at 0°")
    axes.legend()
    return figure


def response(
    length: float, angle: float, options: tehl.Options, smooth: tehl.Result
) -> WaveResponse:
    """Return the response to a standing wave of ``length`` [a] at ``angle`` [degree]."""
    case = problem(200.0)
    a = case.hertz.half_width_x
    height = 0.004 * a**2 / case.radius_x
    wave = Wave(amplitude=height, wavelength=length * a, angle=np.deg2rad(angle))
    wavy = case.surface_2.model_copy(update={"roughness": wave})
    rough = tehl.solve(case.model_copy(update={"surface_2": wavy}), options)
    return wave_responses(rough, smooth)[0]
