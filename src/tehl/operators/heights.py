"""Heights of rough surfaces on a hierarchy of grids, standing or moving, and their resolution.

Theory in docs/theory/roughness.md and docs/theory/numerics-rough.md.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.estimate.duration import components
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem, Scales
from tehl.estimate.ways import Way
from tehl.roughness import Roughness, Sum
from tehl.roughness.model import RoughnessModel
from tehl.roughness.superposition import OneRoughness
from tehl.roughness.waves import HarmonicModel

LEAST_NODES = 4.0
"""Nodes per wavelength below which a wave is aliased."""
ENDS_APART, ROWS_BESIDE = 0.01, 2
"""Difference of the heights at both ends of a piece that repeats itself, over their range, above
which they are not the same ones; and rows on both sides of each end that are compared."""


class UnresolvedError(InputError):
    """The grid has too few nodes for the roughness."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Heights:
    """Heights on the finest grid, positive outwards: they are subtracted from the film.

    Attributes
    ----------
    surface_1, surface_2 : array of ``grid.shape``
        Heights of each surface over a_x^2/R_x [-].
    wavelengths : (float, float)
        Shortest wavelengths along x (in a_x) and y (in a_y); ``inf`` along a direction in which
        nothing changes [-].
    """

    surface_1: Array
    surface_2: Array
    wavelengths: tuple[float, float]

    @property
    def together(self) -> Array:
        """Sum of both heights, ``grid.shape`` [-]."""
        return self.surface_1 + self.surface_2

    def points_per_wave(self, grid: Grid, *, rarest: bool = False) -> float:
        """Return nodes of ``grid`` per shortest wave, of lines in the mean or where rarest."""
        across = grid.largest_dy if rarest else grid.dy
        return min(self.wavelengths[0] / grid.dx, self.wavelengths[1] / across)

    def on(self, grids: list[Grid]) -> list[Array]:
        """Return the heights on each of ``grids``, coarsest first, by repeated full weighting.

        Heights evaluated at the nodes of a coarse grid would be aliased; weighted means fade.
        """
        fields = [self.together]
        for coarse, fine in reversed(list(pairwise(grids))):
            fields.insert(0, full_weighting(fields[0], fine, coarse))
        return fields


def full_weighting(field: Array, fine: Grid, coarse: Grid) -> Array:
    """Return the 1-2-1 means of a field at every other node, along y, x or both.

    Parameters
    ----------
    field : Array
        Values on ``fine``; constant beyond its edges, else as `Grid.beyond` has it.
    fine, coarse : Grid
        Grids, of which ``coarse`` may have as many lines or columns.

    Returns
    -------
    Array
        Of the shape of ``coarse``.
    """
    if coarse.shape[0] < fine.shape[0]:
        south, north = fine.beyond(field, 1)
        south = south if len(south) else field[:1]
        north = north if len(north) else field[-1:]
        field = _means(np.concatenate([south, field, north]))
    if coarse.nx < fine.nx:
        field = _means(np.pad(field, ((0, 0), (1, 1)), mode="edge").T).T
    return field


def _means(padded: Array) -> Array:
    """Return the 1-2-1 means of rows between the first and the last one, at every other row."""
    found: Array = 0.25 * (padded[:-2:2] + 2.0 * padded[1:-1:2] + padded[2::2])
    return found


def heights_of(scaled: ScaledProblem, grid: Grid) -> Heights | None:
    """Return the heights of both surfaces on a grid at time zero, None if both are smooth.

    Parameters
    ----------
    scaled : ScaledProblem
        With the roughness of both surfaces, in metres.
    grid : Grid
        Measured surfaces are filtered to its mesh widths.

    Raises
    ------
    InputError
        If a measured surface cannot be read.
    UnresolvedError
        If a wave of a formula has too few nodes.
    """
    problem, scales = scaled.problem, scaled.scales
    if not problem.is_rough:
        return None
    width, length = units_of(grid, scales)
    x, y = grid.x[None, :] * width, grid.y[:, None] * length
    values, waves, apart = [], [], grid.largest_dy * length
    parts: list[Roughness] = []
    for surface in problem.surfaces:
        resolved = surface.roughness.resolved_on(grid.dx * width, apart)
        field = np.broadcast_to(resolved.height(x, y), grid.shape) / scales.film_thickness
        values.append(_joined(np.ascontiguousarray(field), grid))
        waves.append(resolved.shortest_wavelengths)
        parts += resolved.summands
    along, across = (min(pair) for pair in zip(*waves, strict=True))
    heights = Heights(
        surface_1=values[0], surface_2=values[1], wavelengths=(along / width, across / length)
    )
    # sampled surfaces are filtered to the grid; a formula would be aliased
    shortest = shortest_of_formulas(parts)
    check_nodes(min(shortest[0] / (grid.dx * width), shortest[1] / apart))
    return heights


def _joined(heights: Array, grid: Grid) -> Array:
    """Make the last row the first one where the film wraps, in place; return the heights."""
    if grid.wraps:
        heights[-1] = heights[0]
    return heights


def check_ends(scaled: ScaledProblem, grid: Grid) -> None:
    """Check that the heights of a piece that repeats itself are the same ones at both ends.

    Also where they come from: upstream and downstream by twice the domain.

    Parameters
    ----------
    scaled, grid : ScaledProblem, Grid
        The surfaces, and nodes to whose mesh widths measured ones are filtered.

    Raises
    ------
    InputError
        If they differ by more than `ENDS_APART`, or a measured surface cannot be read.
    """
    if not scaled.groups.shape.wraps:
        return
    (width, length), (low, high) = units_of(grid, scaled.scales), grid.domain.y
    columns = np.arange(-2 * grid.nx, 3 * grid.nx)
    x, y = width * (grid.x[0] + grid.dx * columns)[None], grid.y[:, None] * length
    near = grid.dy * np.arange(-ROWS_BESIDE, ROWS_BESIDE + 1.0)[:, None]
    for number, surface in enumerate(scaled.problem.surfaces, 1):
        resolved = surface.roughness.resolved_on(grid.dx * width, grid.dy * length)
        size = float(np.ptp(resolved.height(x, y)))
        south, north = (resolved.height(x, (end + near) * length) for end in (low, high))
        apart = float(np.abs(south - north).max())
        if apart > ENDS_APART * size:
            piece = 1e3 * length * (high - low)
            raise InputError(
                f"surface_{number}.roughness: the heights beside both ends of the piece differ by "
                f"{100.0 * apart / size:.2g} % of their range; with contact.ends = "
                f'"periodic" they must repeat along y after contact.length = {piece:.6g} mm, as a '
                "whole number of waves or a random surface with that repeat_y; "
                'contact.ends = "mirrored" takes any heights'
            )


def units_of(grid: Grid, scales: Scales) -> tuple[float, float]:
    """Return the units of X and Y for heights [m].

    A line contact has the heights at y = 0, of which its mesh carries what it carries along x.

    Parameters
    ----------
    grid, scales : Grid, Scales
        Nodes, and half-widths [m].
    """
    along = scales.half_width_x
    return along, grid.dx * along / grid.dy if grid.ny == 1 else scales.half_width_y


def shortest_of_formulas(parts: Iterable[Roughness]) -> tuple[float, float]:
    """Return the shortest wavelengths along x and y [m] of the parts given by a formula.

    Sampled surfaces do not count: their short waves have been filtered.
    """
    pairs = [one.shortest_wavelengths for one in parts if isinstance(one, RoughnessModel)]
    along, across = zip(*pairs, strict=True) if pairs else ((), ())
    return min(along, default=math.inf), min(across, default=math.inf)


def check_nodes(nodes: float) -> None:
    """Check the number of nodes per shortest wavelength.

    Raises
    ------
    UnresolvedError
        If it is below `LEAST_NODES`.
    """
    if nodes < LEAST_NODES * (1.0 - 1e-9):
        factor = LEAST_NODES / nodes
        raise UnresolvedError(
            f"roughness: the shortest wave has {nodes:.2g} nodes per wavelength and would be "
            f"aliased; increase numerics.points by a factor of at least {rounded_up(factor)}, and "
            f"of {rounded_up(4.0 * factor)} for an accurate film"
        )


def rounded_up(factor: float) -> str:
    """Return ``factor`` rounded up to two digits."""
    step = 10.0 ** (math.floor(math.log10(factor)) - 1)
    return f"{math.ceil(factor / step * (1.0 - 1e-9)) * step:.2g}"


@dataclass(frozen=True, slots=True)
class _Moving:
    """Speed of a surface [m/s], and its parts with the lengths of their fade-in [m]."""

    speed: float
    parts: tuple[tuple[Roughness, float], ...]

    @property
    def wavelengths(self) -> tuple[float, float]:
        """Shortest wavelengths of formulas along x and y [m]."""
        return shortest_of_formulas(part for part, _ in self.parts)


class MovingHeights:
    """Heights of both surfaces that move with them, on one grid.

    Parameters
    ----------
    scaled : ScaledProblem
        Surfaces and motion.
    grid : Grid
        Heights are filtered to its mesh widths.
    entrance : float or None
        Distance upstream at which roughness without end along x starts at time zero, and from which
        it moves in [a_x]; None starts it everywhere. Features, and maps with flat surroundings,
        start at their stated positions.

    Raises
    ------
    InputError
        If a measured surface cannot be read.
    """

    def __init__(self, scaled: ScaledProblem, grid: Grid, entrance: float | None) -> None:
        problem, scales = scaled.problem, scaled.scales
        width, length = units_of(grid, scales)
        self.x, self.y = grid.x[None, :] * width, grid.y[:, None] * length
        self.widths = (width, length)
        self.grid, self.shape, self.unit = grid, grid.shape, scales.film_thickness
        self.front = None if entrance is None else entrance * width
        stride = 1 if problem.transient is None else problem.transient.stride
        self.surfaces = tuple(
            _Moving(speed, self._parts(surface.roughness, grid, stride * abs(speed) / scales.speed))
            for surface, speed in (
                (problem.surface_1, problem.motion.speed_1),
                (problem.surface_2, problem.motion.speed_2),
            )
        )

    def _parts(
        self, roughness: OneRoughness | Sum, grid: Grid, shift: float
    ) -> tuple[tuple[Roughness, float], ...]:
        """Return each part of a surface as grid and time steps resolve it, with its fade-in.

        ``shift`` is the number of mesh widths that the surface moves per step. The waves of a
        sampled surface that the steps would alias are filtered. The fade-in is zero for a part that
        does not enter at the inlet.
        """
        width, length = self.widths
        along = grid.dx * width * max(shift, 1.0)  # steps longer than a mesh width sample coarser
        resolved = []
        for part in components(roughness):
            shown = part.resolved_on(along, grid.largest_dy * length)
            enters = self.front is not None and math.isinf(part.extent(length)[0][0])
            # waves fade in over a wavelength, other surfaces over eight mesh widths at least
            least = 0.0 if isinstance(part, HarmonicModel) else 8.0 * grid.dx * width
            resolved.append((shown, self._fade(shown, least) if enters else 0.0))
        return tuple(resolved)

    def _fade(self, surface: Roughness, least: float) -> float:
        """Return the length of the fade-in of a surface that enters, at least ``least`` [m]."""
        along = surface.shortest_wavelengths[0]
        return min(max(along, least), 0.5 * (self.front or math.inf))

    @property
    def wavelengths(self) -> tuple[float, float]:
        """Shortest wavelengths of formulas along x [a_x] and y [a_y]."""
        pairs = [one.wavelengths for one in self.surfaces]
        along, across = (min(pair) for pair in zip(*pairs, strict=True))
        return along / self.widths[0], across / self.widths[1]

    @property
    def waves_per_length(self) -> tuple[float, float]:
        """Shortest waves of each surface in a_x, zero where its formulas have none along x."""
        first, second = (self.widths[0] / one.wavelengths[0] for one in self.surfaces)
        return first, second

    def at(self, time: float, moved: Sequence[Way] | None = None) -> tuple[Array, Array]:
        """Return the heights of both surfaces, ``grid.shape`` each [-].

        Parameters
        ----------
        time : float
            Since the start [s].
        moved : (Way, Way) or None
            Of each surface since then [a_x]; None where it moves along x at its speed.
        """
        ways = [Way(one.speed * time) for one in self.surfaces]
        if moved is not None:
            width = self.widths[0]
            ways = [Way(width * one.along, width * one.across, one.turn) for one in moved]
        first, second = map(self._one, self.surfaces, ways)
        return first, second

    def _one(self, surface: _Moving, way: Way) -> Array:
        """Return the heights of one surface that has moved by ``way``, its distances in [m]."""
        total, (x, y) = np.zeros(self.shape), way.back(self.x, self.y)
        for part, fade in surface.parts:
            height = part.height(x, y) / self.unit
            if fade > 0.0 and self.front is not None:
                body = math.copysign(1.0, surface.speed) * x
                inside = np.clip((-self.front - body) / fade, 0.0, 1.0)
                height = height * (0.5 - 0.5 * np.cos(math.pi * inside))
            total += height
        return _joined(total, self.grid)
