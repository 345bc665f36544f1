"""Pressure and flow of asperities finer than the grid, tabulated over the separation."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, lru_cache

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.sparse.linalg import LinearOperator, gmres

from tehl.base.typing import Array
from tehl.contact.problem import ContactProblem
from tehl.contact.summits import (
    Asperities,
    GreenwoodTripp,
    SurfacePatch,
    channel,
    gaussian_integral,
    mean_gap,
)
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.summits import LAST_SEPARATION, LEAST_SEPARATION
from tehl.kernels.summits import AsperityLaws
from tehl.operators.deformation import Deformation

TABLE_SEPARATION_STEP = 0.02
"""Difference of the separations at which the laws are tabulated, over sigma."""
LEAST_OPENING = 0.01
"""Least slope of the mean gap by the separation. Gaussian planes that cross by more than 2.3 sigma
have it, where the gap is below 0.004 sigma, and none is left at 2.7 sigma: else the film would not
determine the separation, and cycles diverge where a coarse grid lets the planes cross far."""
LEAST_CARRIED = 0.01
"""Least oil that is carried over that of the gap: pools of a rough surface at rest carry none."""

LEFT_OF_LACKING, MOST_TOGETHER = 0.3, 10
"""Part of what asperities lack that the solution of their linear system may leave, and most
iterations of GMRES. The next evaluation goes on from there: with 0.1 cycles are not fewer."""

Tables = dict[str, Array]
"""Laws over the gap over sigma, by the names of `AsperityLaws`."""
NO_PRESSURE, NO_OVERLAP = 1e-15, 1e-12
"""Pressure over its unit, and mean gap less separation over sigma, of asperities that are apart."""


@dataclass(frozen=True, kw_only=True, slots=True)
class AsperityTable:
    """Laws over the separation H of the mean planes.

    Attributes
    ----------
    laws : AsperityLaws
        Their values and slopes at steps of H.
    separations : (n,) array
        The H of each row [-].
    friction : float
        Friction coefficient of the asperities [-].
    """

    laws: AsperityLaws
    separations: Array
    friction: float = 0.0

    @property
    def sigma(self) -> float:
        """Standard deviation of the heights [-]."""
        return float(self.laws.grid[1]) / TABLE_SEPARATION_STEP

    @property
    def is_anisotropic(self) -> bool:
        """Whether the conductance along y may differ from that along x."""
        return self.laws.across.size > 0

    @property
    def slides(self) -> bool:
        """Whether the surfaces carry more or less than the gap holds."""
        return self.laws.carried.size > 0

    def widening(self, separation: Array) -> Array:
        """Return the slope of the channel by the separation, of the shape of ``separation`` [-]."""
        slopes = self.laws.channel[:, 1] / self.laws.grid[1]
        found: Array = np.interp(separation, self.separations, slopes, right=1.0)
        return found

    def pressure(self, separation: Array) -> Array:
        """Return the pressure of the asperities at separations of the mean planes [-].

        Interpolated linearly: that of a start.
        """
        curve = self.laws.pressure[:, 0]
        return np.asarray(np.interp(separation, self.separations, curve, right=0.0))

    def carried(self, separation: Array) -> Array:
        """Return the same, interpolated as by `tehl.kernels.summits.touch`."""
        (first, step, apart), (values, slopes) = self.laws.grid, self.laws.pressure.T
        law = CubicHermiteSpline(self.separations, values, slopes / step)
        inside = np.maximum(separation, first)  # below the first row it goes on linearly
        found = law(inside) + (separation - inside) * slopes[0] / step
        return np.where(separation < min(apart, self.separations[-2]), found, 0.0)  # not of NaN

    def separation(self, gap: float) -> float:
        """Return the separation of the mean planes at a mean gap [-]."""
        return float(np.interp(gap, self.laws.gap[:, 0], self.separations, right=gap))


def change_together(
    deformation: Deformation, lacking: Array, stiffness: Array
) -> tuple[Array, Array]:
    """Return the change m of asperities that carry alone by their law, and its film K m.

    A Newton step of  q + m = P_a(H + K m):  (1 - P_a' K) m = P_a(H) - q.

    Parameters
    ----------
    deformation : Deformation
        K.
    lacking, stiffness : array of ``grid.shape``
        P_a(H) - q and -P_a', zero where asperities do not carry alone [-].
    """
    moved = np.empty_like(lacking)

    def applied(change: Array) -> Array:
        deformation.deflect(change.reshape(moved.shape), moved)
        return change + (stiffness * moved).ravel()

    system = LinearOperator((moved.size, moved.size), matvec=applied, dtype=float)
    found, _ = gmres(
        system, lacking.ravel(), rtol=LEFT_OF_LACKING, restart=MOST_TOGETHER, maxiter=1
    )
    step = found.reshape(moved.shape)
    deformation.deflect(step, moved)
    return step, moved


def asperity_table(scaled: ScaledProblem) -> AsperityTable | None:
    """Tabulate the laws of the asperities; None for a contact without."""
    problem, scales = scaled.problem, scaled.scales
    law, sigma = problem.asperities, problem.asperity_rms
    if law is None:
        return None
    pressure = law.unit(sigma, problem.reduced_modulus) / scales.hertz_pressure
    stamp = law.map.stamp if isinstance(law, SurfacePatch) else None
    found = _scaled(law, stamp, sliding_part(problem), pressure, sigma / scales.film_thickness)
    return replace(found, friction=law.friction)


@lru_cache(maxsize=4)  # one for all grids of a contact
def _scaled(
    law: Asperities, stamp: object, part: float, pressure: float, unit: float
) -> AsperityTable:
    """Return the laws for units of pressure and of height [-]."""
    laws = _of_patch(law, stamp) if isinstance(law, SurfacePatch) else _of_summits()
    if part:
        laws = laws | _of_sliding(law, stamp, part)
    units = {"pressure": pressure, "gap": unit, "channel": unit}
    separations = LEAST_SEPARATION + TABLE_SEPARATION_STEP * np.arange(float(len(laws["gap"])))
    overlap = laws["gap"][:, 0] - separations
    touching = np.nonzero((laws["pressure"][:, 0] > NO_PRESSURE) | (overlap > NO_OVERLAP))[0]
    apart = separations[touching[-1]] + TABLE_SEPARATION_STEP
    return AsperityTable(
        laws=AsperityLaws(
            **{name: units.get(name, 1.0) * table for name, table in laws.items()},
            grid=np.array([LEAST_SEPARATION, TABLE_SEPARATION_STEP, apart]) * unit,
        ),
        separations=separations * unit,
    )


@cache
def _of_summits() -> Tables:
    """Return the laws of Greenwood and Tripp, the same for all summits."""
    return {
        "pressure": _tabulated(lambda gap: gaussian_integral(2.5, gap)),
        "gap": _opening(_tabulated(mean_gap)),
        "channel": _tabulated(channel),
    }


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
def _of_sliding(law: Asperities, stamp: object, part: float) -> Tables:
    """Return what the surfaces carry over the mean gap."""
    del stamp
    return {
        "carried": _tabulated(lambda gap: np.maximum(1.0 + part * law.carried(gap), LEAST_CARRIED))
    }


@lru_cache(maxsize=4)
def _of_patch(law: SurfacePatch, stamp: object) -> Tables:
    """Return the laws of a measured patch."""
    del stamp
    return {
        "pressure": _tabulated(law.load),
        "gap": _opening(_tabulated(law.mean_gap)),
        "channel": _tabulated(law.channel),
        "across": _tabulated(law.across),
    }


def _opening(gap: Array) -> Array:
    """Return a table of the mean gap that is linear where its slope would be too small."""
    least = LEAST_OPENING * TABLE_SEPARATION_STEP
    first = int(np.argmax(gap[:, 1] >= least))
    gap[:first, 0] = gap[first, 0] - least * np.arange(first, 0, -1)
    gap[:first, 1] = least
    return gap


def _tabulated(curve: Callable[[Array], Array]) -> Array:
    """Return a curve over the gap and its slope times the step, (n, 2)."""
    step = TABLE_SEPARATION_STEP
    gap, d = np.arange(LEAST_SEPARATION, LAST_SEPARATION + step, step), 0.1 * step
    rise = 8.0 * (curve(gap + d) - curve(gap - d)) - (curve(gap + 2 * d) - curve(gap - 2 * d))
    return np.stack([curve(gap), rise / (12.0 * d) * step], axis=1)
