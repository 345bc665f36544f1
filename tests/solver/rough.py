"""Rough contacts for the tests of the solver: heights as arrays, without models of surfaces."""

import numpy as np

from tehl.grid import Grid
from tehl.operators.heights import Heights
from tehl.options import Options
from tehl.result import Result
from tehl.scaling import groups
from tehl.solver.steady import finest_grid, solve
from tests.reference import moes_contact


def wave(grid: Grid, amplitude: float, length: float, degrees: float) -> Heights:
    """Return a wave that thickens the gap by ``amplitude`` at the origin."""
    along, across = (float(np.round(f(np.radians(degrees)), 12)) for f in (np.cos, np.sin))
    phase = grid.x[None, :] * along - grid.y[:, None] * across
    lengths = (length / along if along else np.inf, length / across if across else np.inf)
    return Heights(values=-amplitude * np.cos(2.0 * np.pi * phase / length), wavelengths=lengths)


def bump(grid: Grid, height: float, radius: float) -> Heights:
    """Return a Gaussian bump at the origin; a dent if ``height`` is negative."""
    square = grid.x[None, :] ** 2 + grid.y[:, None] ** 2
    return Heights(
        values=height * np.exp(-square / radius**2), wavelengths=(4.0 * radius, 4.0 * radius)
    )


def rough_film(
    contact: tuple[float, float], options: Options, shape: tuple[float, float, float]
) -> Result:
    """Return the result of a contact (M, L) with a wave (amplitude, length, degrees)."""
    problem = moes_contact(*contact)
    heights = wave(finest_grid(options, groups(problem)), *shape)
    return solve(problem, options, heights=heights)
