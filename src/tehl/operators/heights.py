"""Heights of both surfaces together on a hierarchy of grids, and how well each resolves them."""

import math
from dataclasses import dataclass

import numpy as np

from tehl.errors import InputError
from tehl.grid import Grid
from tehl.problem import ContactProblem
from tehl.roughness import Roughness
from tehl.scaling import Scales
from tehl.typing import Array


@dataclass(frozen=True, kw_only=True, slots=True)
class Heights:
    """Heights on the finest grid, positive outwards: the film is the smooth one less these.

    Attributes
    ----------
    surface_1, surface_2 : (ny, nx) array
        Heights of each surface at the nodes that the grid holds, over a_x^2/R_x [-].
    wavelengths : (float, float)
        Shortest wavelengths along x (in a_x) and y (in a_y) that matter; ``inf`` along a direction
        in which nothing changes [-].
    """

    surface_1: Array
    surface_2: Array
    wavelengths: tuple[float, float]

    @property
    def together(self) -> Array:
        """Return what both surfaces take off the film, (ny, nx) [-]."""
        return self.surface_1 + self.surface_2

    def points_per_wave(self, grid: Grid) -> float:
        """Return how many nodes of ``grid`` fall on the shortest wave."""
        return min(self.wavelengths[0] / grid.dx, self.wavelengths[1] / grid.dy)

    def on(self, grids: list[Grid]) -> list[Array]:
        """Return the heights on each of ``grids``, coarsest first, from the finest downwards.

        Each coarser grid gets weighted means of the next finer one, never values of its own nodes:
        what it cannot carry must fade on it and not turn into another wave.
        """
        fields = [self.together]
        for grid in reversed(grids[:-1]):
            fields.insert(0, full_weighting(fields[0], mirror=grid.mirror))
        return fields


def full_weighting(fine: Array, *, mirror: bool) -> Array:
    """Return the 1-2-1 means of ``fine`` at every other node; the edges continue evenly."""
    padded = np.pad(fine, ((1, 1), (1, 1)), mode="edge")
    if mirror:
        padded[0] = padded[2]
    rows = 0.25 * (padded[:-2:2] + 2.0 * padded[1:-1:2] + padded[2::2])
    return 0.25 * (rows[:, :-2:2] + 2.0 * rows[:, 1:-1:2] + rows[:, 2::2])


def heights_of(problem: ContactProblem, scales: Scales, grid: Grid) -> Heights | None:
    """Return the heights of both surfaces as they stand on ``grid``, None where both are smooth.

    Raises
    ------
    InputError
        If a measured surface cannot be read.
    """
    if not problem.is_rough:
        return None
    width, length = scales.half_width_x, scales.half_width_y
    x, y = grid.x[None, :] * width, grid.y[:, None] * length
    values, waves = [], []
    for surface in (problem.surface_1, problem.surface_2):
        resolved = surface.roughness.resolved_on(grid.dx * width, grid.dy * length)
        heights = np.broadcast_to(resolved.height(x, y), grid.shape)
        values.append(np.ascontiguousarray(heights / scales.film_thickness))
        waves.append(resolved.shortest_wavelengths)
    along, across = (min(pair) for pair in zip(*waves, strict=True))
    return Heights(
        surface_1=values[0], surface_2=values[1], wavelengths=(along / width, across / length)
    )


class MovingHeights:
    """Heights of both surfaces that move along, on one grid.

    Parameters
    ----------
    problem : ContactProblem
        Surfaces and motion.
    scales : Scales
        Units.
    grid : Grid
        The nodes.
    entrance : float or None
        Surfaces that are rough all over begin so far upstream at time zero, and come in [a_x]; None
        has them rough everywhere from the beginning.

    Raises
    ------
    InputError
        If a measured surface cannot be read, or one that stands still is to come in.
    """

    def __init__(
        self, problem: ContactProblem, scales: Scales, grid: Grid, entrance: float | None
    ) -> None:
        width, length = scales.half_width_x, scales.half_width_y
        self.x, self.y = grid.x[None, :] * width, grid.y[:, None] * length
        self.widths = (width, length)
        self.shape, self.unit = grid.shape, scales.film_thickness
        motion, self.entrance = problem.motion, entrance
        self.front = None if entrance is None else entrance * width
        self.parts = []
        for name, speed in (("surface_1", motion.speed_1), ("surface_2", motion.speed_2)):
            roughness = getattr(problem, name).roughness
            if self.front is not None and roughness.rms > 0 and speed == 0:
                raise InputError(
                    f"{name} stands still, so its roughness never comes in: let transient.start be "
                    '"standing"'
                )
            resolved = roughness.resolved_on(grid.dx * width, grid.dy * length)
            self.parts.append((resolved, speed, self._fade(resolved, grid.dx * width)))

    @property
    def is_rough(self) -> bool:
        """Whether either surface has heights."""
        return any(not surface.is_smooth for surface, _, _ in self.parts)

    @property
    def wavelengths(self) -> tuple[float, float]:
        """Return the shortest wavelengths along x [a_x] and y [a_y]."""
        pairs = [surface.shortest_wavelengths for surface, _, _ in self.parts]
        along, across = (min(pair) for pair in zip(*pairs, strict=True))
        return along / self.widths[0], across / self.widths[1]

    def _fade(self, surface: Roughness, dx: float) -> float:
        """Return over what length a surface that comes in begins [m], 0 if it does not."""
        if self.front is None or not surface.rms > 0:
            return 0.0
        along = surface.shortest_wavelengths[0]
        return min(max(along, 8.0 * dx), 0.5 * self.front)

    def at(self, time: float) -> tuple[Array, Array]:
        """Return the heights of both surfaces at ``time`` [s], (ny, nx) each [-]."""
        first, second = (self._one(*part, time) for part in self.parts)
        return first, second

    def _one(self, surface: Roughness, speed: float, fade: float, time: float) -> Array:
        if surface.is_smooth:
            return np.zeros(self.shape)
        height = surface.height(self.x, self.y, time, speed) / self.unit
        if fade > 0.0 and self.front is not None:
            body = math.copysign(1.0, speed) * (self.x - speed * time)
            inside = np.clip((-self.front - body) / fade, 0.0, 1.0)
            height = height * (0.5 - 0.5 * np.cos(math.pi * inside))
        return np.ascontiguousarray(np.broadcast_to(height, self.shape))
