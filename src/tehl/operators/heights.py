"""Heights of both surfaces together on a hierarchy of grids, and how well each resolves them."""

from dataclasses import dataclass

import numpy as np

from tehl.grid import Grid
from tehl.problem import ContactProblem
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
