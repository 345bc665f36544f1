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
    r"""Return heights with given moments by a monotone transformation: each peak stays one.

    .. math:: t(z) = \sinh\frac{\operatorname{arsinh} z + \epsilon}{\delta}

    with the two parameters that these heights need, not those of a Gaussian distribution (Jones and
    Pewsey, see :class:`tehl.roughness.Random`).

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
    """
    count, edges = np.histogram(heights, bins=_BINS)
    places, share = 0.5 * (edges[1:] + edges[:-1]), count / count.sum()

    def transformed(heights: Array, parameters: Array) -> Array:
        return np.sinh((np.arcsinh(heights) + parameters[0]) * np.exp(-parameters[1]))

    def missed(parameters: Array) -> Array:
        changed = transformed(places, parameters)
        off = changed - np.sum(share * changed)
        off /= np.sqrt(np.sum(share * off**2))
        return np.array([np.sum(share * off**3) - skewness, np.sum(share * off**4) - kurtosis])

    fits = [
        least_squares(missed, (start * np.sign(skewness), 0.0), bounds=([-30, -3], [30, 3]))
        for start in (_STARTS if skewness else _STARTS[:1])
    ]
    best = min(fits, key=lambda fit: float(fit.cost))
    if not np.abs(best.fun).max() < _MISSED:
        raise InputError(
            f"kurtosis = {kurtosis:g} with skewness = {skewness:g} cannot be made of these heights"
        )
    changed = transformed(heights, best.x)
    changed -= changed.mean()
    return changed / np.sqrt(np.mean(np.square(changed)))
