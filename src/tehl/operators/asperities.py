"""Pressure and flow of asperities finer than the grid, tabulated over the separation."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np

from tehl.asperities import (
    Asperities,
    GreenwoodTripp,
    SurfacePatch,
    channel,
    gaussian_integral,
    mean_gap,
)
from tehl.mixed import LEAST, MOST
from tehl.problem import ContactProblem
from tehl.scaling import ScaledProblem
from tehl.typing import Array

STEP = 0.02
"""Difference of the separations at which the laws are tabulated, over sigma."""
LEAST_CARRIED = 0.01
"""Least oil that is carried over that of the gap: pools of a rough surface at rest carry none."""

NO_PRESSURE, NO_OVERLAP = 1e-15, 1e-12
"""Pressure over its unit, and mean gap less separation over sigma, of asperities that are apart."""


@dataclass(frozen=True, kw_only=True, slots=True)
class AsperityTable:
    """Laws over the separation H of the mean planes.

    Attributes
    ----------
    table : (n, 6) or (n, 8) array
        Pressure of the asperities, mean gap, channel along x and, if they matter, conductance
        along y over that along x, and what the surfaces carry over the gap, each with its slope
        times the step [-].
    grid : (3,) array
        Least separation, difference of two rows, and the separation from which no asperities
        touch [-].
    """

    table: Array
    grid: Array

    @property
    def sigma(self) -> float:
        """Standard deviation of the heights [-]."""
        return float(self.grid[1]) / STEP

    @property
    def is_anisotropic(self) -> bool:
        """Whether the conductance along y may differ from that along x."""
        return self.table.shape[1] > 6

    @property
    def slides(self) -> bool:
        """Whether the surfaces carry more or less than the gap holds."""
        return self.table.shape[1] > 8

    def widening(self, separation: Array) -> Array:
        """Return the slope of the channel by the separation, of the shape of ``separation`` [-]."""
        separations = self.grid[0] + self.grid[1] * np.arange(len(self.table))
        slopes = self.table[:, 5] / self.grid[1]
        found: Array = np.interp(separation, separations, slopes, right=1.0)
        return found

    def separation(self, gap: float) -> float:
        """Return the separation of the mean planes at a mean gap [-]."""
        separations = self.grid[0] + self.grid[1] * np.arange(len(self.table))
        return float(np.interp(gap, self.table[:, 2], separations, right=gap))


def asperity_table(scaled: ScaledProblem) -> AsperityTable | None:
    """Tabulate the laws of the asperities; None for a contact without."""
    problem, scales = scaled.problem, scaled.scales
    law, sigma = problem.asperities, problem.asperity_rms
    if law is None:
        return None
    unit = sigma / scales.film_thickness
    pressure = law.unit(sigma, problem.reduced_modulus) / scales.hertz_pressure
    stamp = law.map.stamp if isinstance(law, SurfacePatch) else None
    laws = _of_patch(law, stamp) if isinstance(law, SurfacePatch) else _of_summits()
    if part := sliding_part(problem):
        laws = np.concatenate([laws, _of_sliding(law, stamp, part)], axis=1)
    factors = np.repeat([pressure, unit, unit, 1.0, 1.0], 2)[: laws.shape[1]]
    separations = LEAST + STEP * np.arange(len(laws))
    overlap = laws[:, 2] - separations
    touching = np.nonzero((laws[:, 0] > NO_PRESSURE) | (overlap > NO_OVERLAP))[0]
    apart = separations[touching[-1]] + STEP
    return AsperityTable(table=laws * factors, grid=np.array([LEAST, STEP, apart]) * unit)


@cache
def _of_summits() -> Array:
    """Return the laws of Greenwood and Tripp, the same for all summits, as `_tabulated`."""
    return _tabulated(lambda gap: gaussian_integral(2.5, gap), mean_gap, channel)


def sliding_part(problem: ContactProblem) -> float:
    """Return the factor of the shear flow of Patir and Cheng (1979): zero if both are as rough.

    (u_1 - u_2) / (2 u_m) times (sigma_1^2 - sigma_2^2) / sigma^2. Zero also where no surface states
    its roughness, or sigma is not theirs, and in transient runs.
    """
    law, rms = problem.asperities, problem.rms_roughness
    is_stated = isinstance(law, GreenwoodTripp) and law.rms is not None
    if is_stated or rms == 0.0 or problem.transient is not None:
        return 0.0
    first, second = problem.surface_1.rms_roughness, problem.surface_2.rms_roughness
    return 0.5 * problem.slide_roll_ratio * (first**2 - second**2) / rms**2


@lru_cache(maxsize=4)
def _of_sliding(law: Asperities, stamp: object, part: float) -> Array:
    """Return what the surfaces carry over the mean gap, after no anisotropy of summits."""
    del stamp

    def carried(gap: Array) -> Array:
        return np.maximum(1.0 + part * law.carried(gap), LEAST_CARRIED)

    is_patch = isinstance(law, SurfacePatch)
    return _tabulated(carried) if is_patch else _tabulated(np.ones_like, carried)


@lru_cache(maxsize=4)
def _of_patch(law: SurfacePatch, stamp: object) -> Array:
    """Return the laws of a measured patch, as `_tabulated`."""
    del stamp
    return _tabulated(law.load, law.mean_gap, law.channel, law.across)


def _tabulated(*curves: Callable[[Array], Array]) -> Array:
    """Return curves over the gap, each with its slope times the step."""
    gap, d = np.arange(LEAST, MOST + STEP, STEP), 0.1 * STEP
    columns = []
    for curve in curves:
        rise = 8.0 * (curve(gap + d) - curve(gap - d)) - (curve(gap + 2 * d) - curve(gap - 2 * d))
        columns += [curve(gap), rise / (12.0 * d) * STEP]
    return np.ascontiguousarray(np.stack(columns, axis=1))
