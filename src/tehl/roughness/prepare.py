"""From measured heights to heights that a contact can have: fill, level, filter, check the form."""

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from scipy import ndimage, sparse

from tehl.errors import InputError
from tehl.typing import Array, BoolArray

Level = Literal["none", "mean", "plane", "quadratic"]
Fill = Literal["auto", "linear", "nearest", "refuse"]

FEW, MOST = 0.01, 0.5
"""Share of missing points that is filled by default, and that no filling bridges."""
_NEIGHBOURS = 5
_NORMAL = 1.4826
_DEGREE = {"mean": 0, "plane": 1, "quadratic": 2}
_ALPHA = math.sqrt(math.log(2.0) / math.pi)
_RIM = 12
"""Points of zeros around a flat tile, after which its spline is zero to rounding."""
_MOST_LEFT, _COUNTS = 0.5, 0.2
"""Sq without the quadratic over Sq below which it is odd; share of a bend that is named."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Heights:
    """Heights on a lattice, and what was done to them."""

    values: Array
    """[m], (ny, nx); rows along x."""
    pixel: tuple[float, float]
    """Distances (dx, dy) of the lattice [m]."""
    notes: tuple[str, ...] = ()
    """What a reader of the result should know."""

    @property
    def size(self) -> tuple[float, float]:
        """Return the lengths along x and y [m]."""
        ny, nx = self.values.shape
        return nx * self.pixel[0], ny * self.pixel[1]


def without_outliers(values: Array, sigmas: float) -> tuple[Array, int]:
    """Return heights with spikes as missing points, and the number of spikes.

    A spike lies further from the median of the 5 x 5 points around it than ``sigmas`` times the
    usual distance, 1.48 times the median one.
    """
    there = np.isfinite(values)
    whole = np.where(there, values, np.median(values[there]))
    off = np.abs(whole - ndimage.median_filter(whole, _NEIGHBOURS, mode="nearest"))
    spikes = there & (off > sigmas * _NORMAL * max(float(np.median(off[there])), 1e-300))
    return np.where(spikes, np.nan, values), int(spikes.sum())


def filled(values: Array, how: Fill) -> Array:
    """Return heights with their gaps, NaN or infinite, filled.

    "linear" spans a membrane over each gap (Laplace's equation), "nearest" takes the nearest
    height, "auto" is "linear" for up to 1 % of the points. Raises InputError if more are missing.
    """
    missing = ~np.isfinite(values)
    count = int(missing.sum())
    if count == 0:
        return values
    _check_gaps(missing, how, count)
    nearest = ndimage.distance_transform_edt(missing, return_distances=False, return_indices=True)
    whole = values[tuple(nearest)]
    return whole if how == "nearest" else _with_membranes(whole, missing)


def _check_gaps(missing: BoolArray, how: Fill, count: int) -> None:
    share = count / missing.size
    row, column = (int(places[0]) for places in np.nonzero(missing))
    gaps = (
        f"has {count} points without a height ({100 * share:.2g} %), the first in row {row + 1}, "
        f"column {column + 1}"
    )
    if share == 1.0:
        raise InputError("has no point with a height")
    if share > MOST:
        raise InputError(f"{gaps}: that is too much to fill, crop the map")
    if how == "refuse" or (how == "auto" and share > FEW):
        raise InputError(f'{gaps}: crop the map, or say how to fill them, fill = "linear"')


def _with_membranes(whole: Array, missing: BoolArray) -> Array:
    """Return heights with gaps that fulfil Laplace's equation; at edges, without slope."""
    ny, nx = missing.shape
    number = np.full(missing.shape, -1)
    number[missing] = np.arange(missing.sum())
    rows, columns = np.nonzero(missing)
    diagonal, right = np.zeros(rows.size), np.zeros(rows.size)
    from_, to = [], []
    for down, across in ((-1, 0), (1, 0), (0, -1), (0, 1)):
        row, column = rows + down, columns + across
        inside = (row >= 0) & (row < ny) & (column >= 0) & (column < nx)
        diagonal += inside
        row, column = row.clip(0, ny - 1), column.clip(0, nx - 1)
        gap = inside & missing[row, column]
        right += np.where(inside & ~gap, whole[row, column], 0.0)
        from_.append(np.flatnonzero(gap))
        to.append(number[row, column][gap])
    start, end = np.concatenate(from_), np.concatenate(to)
    graph = sparse.csr_array((-np.ones(start.size), (start, end)), shape=(rows.size, rows.size))
    matrix = graph + sparse.diags_array(diagonal)
    base = float(whole[missing].mean())  # so that the tolerance is one of the relief
    found, _ = sparse.linalg.cg(
        matrix,
        right - matrix @ np.full(rows.size, base),
        x0=whole[missing] - base,
        rtol=1e-6,
        maxiter=2000,
        M=sparse.diags_array(1.0 / diagonal),
    )
    result = whole.copy()
    result[missing] = found + base
    return result


def levelled(values: Array, how: Level) -> Array:
    """Return heights without their mean, plane or quadratic form, by least squares."""
    if how == "none":
        return values
    off = values - values.mean()
    rows, columns, weights, _ = _fitted(off, _DEGREE[how])
    return np.asarray(off - rows.T @ (weights @ columns))


def _fitted(off: Array, degree: int) -> tuple[Array, Array, Array, float]:
    """Return powers of y and of x, their weights by least squares, and the fit's mean square."""
    rows, columns = (
        np.vander(np.linspace(-1.0, 1.0, count), degree + 1, increasing=True).T
        for count in off.shape
    )
    powers = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i)]
    # sums over the map part into sums over rows and columns, so that no term is ever a map
    along, across = columns @ columns.T, rows @ rows.T
    products = [[across[i, k] * along[j, m] for k, m in powers] for i, j in powers]
    sums = rows @ off @ columns.T
    moments = np.array([sums[power] for power in powers])
    weights = np.zeros((degree + 1, degree + 1))
    found = np.linalg.solve(np.array(products), moments)
    weights[tuple(np.transpose(powers))] = found
    return rows, columns, weights, float(found @ moments) / off.size


def gaussian_mean(heights: Array, pixel: tuple[float, float], cut_off: float) -> Array:
    r"""Return heights through the areal Gaussian filter.

    .. math:: s(x, y) = \frac{1}{\alpha^2\lambda_c^2}
              \exp\left(-\pi\frac{x^2 + y^2}{\alpha^2\lambda_c^2}\right), \quad
              \alpha = \sqrt{\ln 2/\pi}

    so that half of a wave as long as ``cut_off`` passes. At the edges heights are mirrored.

    Parameters
    ----------
    heights, pixel, cut_off : (ny, nx) array, (dx, dy), float
        Heights, distances of their points, and lambda_c [m].

    References
    ----------
    .. [1] ISO 16610-61, Geometrical product specification - Filtration - Linear areal filters:
       Gaussian filters.
    """
    sigma = _ALPHA * cut_off / math.sqrt(2.0 * math.pi)
    return np.asarray(
        ndimage.gaussian_filter(heights, (sigma / pixel[1], sigma / pixel[0]), mode="reflect")
    )


def tapered(heights: Heights, width: float) -> Array:
    """Return heights that fall to zero over ``width`` [m] at all edges, with a flat rim around."""
    windows = []
    for count, step in zip(heights.values.shape, reversed(heights.pixel), strict=True):
        edge = np.minimum(np.arange(count) + 0.5, count - np.arange(count) - 0.5)
        share = edge / max(min(width / step, 0.5 * count), 1e-9)
        windows.append(np.sin(0.5 * np.pi * np.clip(share, 0.0, 1.0)) ** 2)
    return np.pad(heights.values * windows[0][:, None] * windows[1], _RIM)


class Form(NamedTuple):
    """Least-squares quadratic of a map: the form of the body that is left in it.

    ``sq`` and ``sq_without`` are those of the map without a plane, and without the quadratic [m];
    ``curvatures`` the second derivatives along x and y of the map [1/m], ``sags`` the heights that
    they make between the middle and the edges [m].
    """

    sq: float
    sq_without: float
    curvatures: tuple[float, float]
    sags: tuple[float, float]


def form_of(heights: Heights) -> Form:
    """Return the quadratic form of a map by least squares."""
    flat = levelled(heights.values, "plane")  # a slope that was left is not a curvature
    _, _, weights, square = _fitted(flat - flat.mean(), _DEGREE["quadratic"])
    sq, sags = float(np.std(flat)), (float(weights[0, 2]), float(weights[2, 0]))
    ny, nx = heights.values.shape
    half_x, half_y = 0.5 * (nx - 1) * heights.pixel[0], 0.5 * (ny - 1) * heights.pixel[1]
    curvatures = (2.0 * sags[0] / half_x**2, 2.0 * sags[1] / half_y**2)
    return Form(sq, math.sqrt(max(sq**2 - square, 0.0)), curvatures, sags)


def note_on_form(heights: Heights, level: Level) -> tuple[str, ...]:
    """Return a note if more than half of Sq is a quadratic form that ``level`` has left."""
    if level == "quadratic":
        return ()
    form = form_of(heights)
    if not form.sq_without < _MOST_LEFT * form.sq:
        return ()
    return (
        f'the map {_shape(form)} (level = "{level}"), and without that its Sq is '
        f"{_metres(form.sq_without)}, not {_metres(form.sq)}: is it the form of the body, which "
        'the radii of the contact have already? Then take it off, level = "quadratic"',
    )


def _shape(form: Form) -> str:
    """Return how a map bends; along an axis only where it makes much of the form."""
    whole = math.sqrt(form.sq**2 - form.sq_without**2)
    bends = [
        f"of {_metres(1.0 / abs(curvature))} along {axis}"
        for axis, curvature, sag in zip("xy", form.curvatures, form.sags, strict=True)
        if abs(sag) > _COUNTS * whole
    ]
    if not bends:
        return "is twisted as a saddle"
    return f"bends with {'a radius' if len(bends) == 1 else 'radii'} {' and '.join(bends)}"


def _metres(length: float) -> str:
    for unit, factor in (("m", 1.0), ("mm", 1e-3), ("um", 1e-6)):
        if length >= factor:
            return f"{length / factor:.3g} {unit}"
    return f"{length * 1e9:.3g} nm"
