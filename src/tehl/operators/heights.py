"""Heights of both surfaces together on a hierarchy of grids, and how well each resolves them."""

from dataclasses import dataclass

import numpy as np

from tehl.grid import Grid
from tehl.typing import Array


@dataclass(frozen=True, kw_only=True, slots=True)
class Heights:
    """Heights on the finest grid, positive outwards: the film is the smooth one less these.

    Attributes
    ----------
    values : (ny, nx) array
        Sum of both surfaces at the nodes that the grid holds, over a_x^2/R_x [-].
    wavelengths : (float, float)
        Shortest wavelengths along x (in a_x) and y (in a_y) that matter; ``inf`` along a direction
        in which nothing changes [-].
    """

    values: Array
    wavelengths: tuple[float, float]

    def points_per_wave(self, grid: Grid) -> float:
        """Return how many nodes of ``grid`` fall on the shortest wave."""
        return min(self.wavelengths[0] / grid.dx, self.wavelengths[1] / grid.dy)

    def on(self, grids: list[Grid]) -> list[Array]:
        """Return the heights on each of ``grids``, coarsest first, from the finest downwards.

        Each coarser grid gets weighted means of the next finer one, never values of its own nodes:
        what it cannot carry must fade on it and not turn into another wave.
        """
        fields = [np.asarray(self.values, dtype=float)]
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
