"""Dry contact of a periodic rough patch: the pressure that flattens it, and the gap left.

Rough half-spaces under a mean pressure p_m touch where the pressure is positive,

    p >= 0,   g = K p - z + const >= 0,   p g = 0,   mean(p) = p_m,

with the deflection K p, in Fourier space 2 p / (E* |q|), its mean left out: the mean of the gap g
is the distance of the mean planes. Conjugate gradients with projection [1]_.

References
----------
.. [1] I. A. Polonsky and L. M. Keer, Wear 231 (1999), 206-219.
"""

from dataclasses import dataclass

import numpy as np
from scipy.fft import fftfreq, irfft2, rfft2, rfftfreq
from scipy.ndimage import label
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from tehl.base.typing import Array

MOST_ITERATIONS = 2000
"""Of a contact; the last change of the pressure is then beyond 1e-7."""
NO_GAP = 1e-12
"""Gap that is taken for zero, over the highest summit."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DryContact:
    """A pressed patch."""

    pressure: Array
    """(ny, nx): over E* [-]."""
    gap: Array
    """(ny, nx): zero where the surfaces touch, in the unit of the heights."""

    @property
    def mean_pressure(self) -> float:
        """Mean pressure over E* [-]."""
        return float(self.pressure.mean())

    @property
    def mean_gap(self) -> float:
        """Mean gap: the distance of the mean planes, in the unit of the heights."""
        return float(self.gap.mean())

    @property
    def area(self) -> float:
        """Part of the area in which the surfaces touch [-]."""
        return float(np.count_nonzero(self.pressure > 0.0) / self.pressure.size)

    @property
    def spots(self) -> int:
        """Number of connected places where the surfaces touch, across the edges of the period."""
        places, found = label(self.pressure > 0.0)
        edges = [
            np.stack(pair, axis=1)
            for pair in ((places[0], places[-1]), (places[:, 0], places[:, -1]))
        ]
        pairs = np.concatenate(edges)
        pairs = pairs[np.all(pairs > 0, axis=1)] - 1
        links = coo_array((np.ones(len(pairs)), pairs.T), shape=(found, found))
        return int(connected_components(links, directed=False)[0])


def pressed(
    heights: Array, pixel: tuple[float, float], pressure: float, start: Array | None = None
) -> DryContact:
    """Return the contact of a periodic patch under a mean pressure.

    Parameters
    ----------
    heights : (ny, nx) array
        Of both surfaces together, one period along x and y.
    pixel : (float, float)
        Distances dx, dy, in the unit of the heights.
    pressure : float
        Mean pressure over E* [-].
    start : (ny, nx) array
        Pressure of a similar load.

    Raises
    ------
    ArithmeticError
        If the iteration does not converge.
    """
    compliance = _compliance(heights.shape, pixel)

    def deflection(load: Array) -> Array:
        found: Array = irfft2(compliance * rfft2(load), s=heights.shape)
        return found

    p = np.full(heights.shape, pressure) if start is None else start * (pressure / start.mean())
    step, before, restart = np.zeros(heights.shape), 1.0, True
    least = NO_GAP * float(np.abs(heights).max())
    for _ in range(MOST_ITERATIONS):
        gap, touching = deflection(p) - heights, p > 0.0
        gap -= gap[touching].mean()
        size = float((gap[touching] ** 2).sum())
        at_rest = size <= least**2 * touching.sum()  # a few points, whose gaps are rounding
        if at_rest and not (gap < -least).any():
            return DryContact(pressure=p, gap=np.where(touching, 0.0, np.maximum(gap, 0.0)))
        step = np.where(
            touching, gap + (0.0 if restart or before == 0.0 else size / before) * step, 0.0
        )
        before = size
        change = deflection(step)
        change -= change[touching].mean()
        resistance = float((change * step)[touching].sum())
        moves = resistance > 0.0 and not at_rest
        factor = float((gap * step)[touching].sum()) / resistance if moves else 1.0
        after = np.maximum(p - factor * step, 0.0)
        closed = (after == 0.0) & (gap < 0.0)
        restart = bool(closed.any())
        after[closed] -= factor * gap[closed]
        after *= pressure / after.mean()
        error = float(np.abs(after - p).mean()) / pressure
        p = after
        if error < 1e-7:
            gap = deflection(p) - heights
            gap -= gap[p > 0.0].mean()
            return DryContact(pressure=p, gap=np.where(p > 0.0, 0.0, np.maximum(gap, 0.0)))
    raise ArithmeticError("the contact of the rough patch does not converge")


def _compliance(shape: tuple[int, ...], pixel: tuple[float, float]) -> Array:
    """Return 2 / |q| of the half spectrum, zero for the mean."""
    (ny, nx), (dx, dy) = shape, pixel
    qx = 2.0 * np.pi * rfftfreq(nx, dx)
    qy = 2.0 * np.pi * fftfreq(ny, dy)
    size = np.hypot(qy[:, None], qx)
    size[0, 0] = np.inf
    found: Array = 2.0 / size
    return found
