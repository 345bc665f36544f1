"""Heights of a random surface: filtered noise, with a given skewness and kurtosis."""

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from scipy import fft
from scipy.optimize import least_squares

from tehl.errors import InputError
from tehl.roughness.tile import Tile
from tehl.typing import Array

if TYPE_CHECKING:
    from tehl.roughness.random_surface import Random

_BINS = 4001
_STARTS = (0.0, 1.0, 3.0)
_MISSED = 1e-3


@lru_cache(maxsize=4)
def tile_of(surface: "Random") -> Tile:
    """Return one period of a random surface."""
    points, pixel = surface.lattice
    noise = np.random.default_rng(surface.seed).standard_normal((points, points))
    along, across = (2.0 * np.pi / step for step in pixel)
    density = surface.density(
        along * fft.rfftfreq(points), across * fft.fftfreq(points)[:, np.newaxis]
    )
    density[0, 0] = 0.0
    heights = fft.irfft2(fft.rfft2(noise) * np.sqrt(density), (points, points))
    heights /= np.sqrt(np.mean(np.square(heights)))
    if (surface.skewness, surface.kurtosis) != (0.0, 3.0):
        heights = with_moments(heights, surface.skewness, surface.kurtosis)
    return Tile(heights=surface.rms * heights, pixel=pixel, angle=surface.angle)


def with_moments(heights: Array, skewness: float, kurtosis: float) -> Array:
    r"""Return heights with given moments by a monotone transformation [1]_: each peak stays one.

    .. math:: t(z) = \sinh\frac{\operatorname{arsinh} z + \epsilon}{\delta}

    with the two parameters that these heights need, not those of a Gaussian distribution.

    Parameters
    ----------
    heights : Array
        With a mean of zero and a mean square of one.
    skewness, kurtosis : float
        Ssk and Sku [-].

    Returns
    -------
    Array
        With a mean of zero and a mean square of one.

    Raises
    ------
    InputError
        If no parameters give these moments.

    References
    ----------
    .. [1] M. C. Jones and A. Pewsey, Sinh-arcsinh distributions, Biometrika 96 (2009), 761-780.
    """
    count, edges = np.histogram(heights, bins=_BINS)
    places, share = 0.5 * (edges[1:] + edges[:-1]), count / count.sum()

    def missed(parameters: Array) -> Array:
        found = _moments(_transformed(places, parameters), share)
        return np.array(found) - (skewness, kurtosis)

    fits = [
        least_squares(missed, (start * np.sign(skewness), 0.0), bounds=([-30, -3], [30, 3]))
        for start in (_STARTS if skewness else _STARTS[:1])
    ]
    best = min(fits, key=lambda fit: float(fit.cost))
    if not np.abs(best.fun).max() < _MISSED:
        raise InputError(
            f"kurtosis = {kurtosis:g} with skewness = {skewness:g} cannot be made of these heights"
        )
    changed = _transformed(heights, best.x)
    changed -= changed.mean()
    return changed / np.sqrt(np.mean(np.square(changed)))


def _transformed(heights: Array, parameters: Array) -> Array:
    shift, tail = parameters
    return np.sinh((np.arcsinh(heights) + shift) * np.exp(-tail))


def _moments(heights: Array, share: Array) -> tuple[float, float]:
    """Return skewness and kurtosis of heights that have a share each."""
    off = heights - np.sum(share * heights)
    spread = np.sqrt(np.sum(share * off**2))
    return float(np.sum(share * (off / spread) ** 3)), float(np.sum(share * (off / spread) ** 4))
