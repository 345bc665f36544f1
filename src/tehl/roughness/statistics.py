"""Numbers that describe a surface."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import fft

from tehl.base.typing import Array, BoolArray
from tehl.roughness.tile import response


@dataclass(frozen=True, kw_only=True, slots=True)
class Statistics:
    """Areal parameters of a map, as in ISO 25178-2."""

    sq: float
    sa: float
    sz: float
    """Root mean square, mean absolute and largest height difference [m]."""
    ssk: float
    sku: float
    """Skewness and kurtosis [-]; nan for a map without heights."""
    sdq: float
    """Root mean square slope [-]."""
    correlation_lengths: tuple[float, float]
    """Along x and y, where the autocorrelation has fallen to 1/e [m]; infinite where it does not
    within half of the map."""


def statistics(
    heights: Array, pixel: tuple[float, float], measured: BoolArray | None = None
) -> Statistics:
    """Return the parameters of heights; their mean is subtracted.

    Parameters
    ----------
    heights, pixel : (ny, nx) array, (dx, dy)
        Heights without gaps, and distances of their points [m].
    measured : (ny, nx) array or None
        Which points count; None is all. Correlation lengths are those of all points.
    """
    there = np.ones(heights.shape, bool) if measured is None else measured
    off = heights - heights[there].mean()
    valid = off[there]
    sq = float(np.sqrt(np.mean(valid**2)))
    scaled = valid / sq if sq > 0 else np.full_like(valid, np.nan)
    slope_y, slope_x = np.gradient(off, pixel[1], pixel[0])
    along, across = (_correlation_length(off, axis) for axis in (1, 0))
    return Statistics(
        sq=sq,
        sa=float(np.mean(np.abs(valid))),
        sz=float(np.ptp(valid)),
        ssk=float(np.mean(scaled**3)),
        sku=float(np.mean(scaled**4)),
        sdq=float(np.sqrt(np.mean((slope_x**2 + slope_y**2)[there]))),
        correlation_lengths=(along * pixel[0], across * pixel[1]),
    )


def _correlation_length(heights: Array, axis: int) -> float:
    """Return the lag where the autocorrelation has fallen to 1/e, infinite if nowhere [points].

    Products are not wrapped around.
    """
    count = heights.shape[axis]
    whole = fft.next_fast_len(2 * count, real=True)
    power = (np.abs(fft.rfft(heights, whole, axis=axis)) ** 2).sum(axis=1 - axis)
    mean = fft.irfft(power, whole)[: count // 2] / (count - np.arange(count // 2))
    if not (mean.size and mean[0] > 0):
        return math.inf
    scaled = mean / mean[0]
    below = np.flatnonzero(scaled < math.exp(-1.0))
    if below.size == 0:
        return math.inf
    high, low = scaled[below[0] - 1], scaled[below[0]]
    return float(below[0] - 1 + (high - math.exp(-1.0)) / (high - low))


class Spectrum(NamedTuple):
    """Power of a map, averaged over all directions.

    ``density`` is the mean two-dimensional power spectral density [m^4] of the ring around each
    ``wave_number`` q = 2 pi / wavelength [rad/m], arrays (n,).
    """

    wave_number: Array
    density: Array


def spectrum(heights: Array, pixel: tuple[float, float], rings: int = 60) -> Spectrum:
    r"""Return the radially averaged power spectral density.

    It is :math:`C(q) = |\hat h|^2/A` of the heights under a Hann window, scaled so that the mean
    square height is :math:`\int C \, d^2q / 4\pi^2`; a window is needed because maps do not repeat.
    Source: Jacobs, Junge and Pastewka, see :class:`tehl.roughness.Random`.

    Parameters
    ----------
    heights, pixel : (ny, nx) array, (dx, dy)
        Heights, and distances of their points [m].
    rings : int
        How many rings, of equal width on a logarithmic scale; those without a wave are left out.
    """
    off = heights - heights.mean()
    ny, nx = off.shape
    window = np.hanning(ny + 2)[1:-1, None] * np.hanning(nx + 2)[1:-1]
    window /= np.sqrt(np.mean(window**2))
    power = np.abs(fft.fft2(off * window) / off.size) ** 2
    number = 2.0 * np.pi * np.hypot(fft.fftfreq(nx, pixel[0]), fft.fftfreq(ny, pixel[1])[:, None])
    width, height = (n * step for n, step in zip(heights.shape[::-1], pixel, strict=True))
    least, largest = 2.0 * math.pi / max(width, height), math.pi / min(pixel)
    edges = np.geomspace(0.9 * least, max(largest, 1.1 * least), rings + 1)
    count, total = np.histogram(number, edges)[0], np.histogram(number, edges, weights=power)[0]
    there = count > 0
    middle = np.sqrt(edges[1:] * edges[:-1])
    return Spectrum(middle[there], width * height * total[there] / count[there])


def share_beyond(heights: Array, pixel: tuple[float, float], mesh: tuple[float, float]) -> float:
    """Return which share of the variance a mesh loses, in waves shorter than four widths.

    Parameters
    ----------
    heights, pixel, mesh : (ny, nx) array, (dx, dy)
        Heights, and distances of their points and of the nodes [m].
    """
    ny, nx = heights.shape
    power = fft.dctn(heights - heights.mean(), type=2, norm="ortho") ** 2  # no jumps at edges
    x, y = np.arange(nx) / (2.0 * nx * pixel[0]), np.arange(ny) / (2.0 * ny * pixel[1])
    lost = 1.0 - response(x, y, mesh, radial=False) ** 2
    return float((power * lost).sum() / power.sum()) if power.sum() > 0 else 0.0
