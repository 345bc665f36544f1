"""From measured heights to heights that a contact can have: fill, level, filter, check the form."""

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from scipy import ndimage, sparse

from tehl.base.errors import InputError
from tehl.base.typing import Array, BoolArray

Level = Literal["none", "mean", "plane", "quadratic"]
Fill = Literal["auto", "linear", "nearest", "refuse"]

RELATIVE_ROUNDING = 1e-12
_DEGREE = {"mean": 0, "plane": 1, "quadratic": 2}
_ALPHA = math.sqrt(math.log(2.0) / math.pi)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Heights:
    """Heights on a lattice, and what was done to them."""

    values: Array
    """[m], (ny, nx); rows along x."""
    pixel: tuple[float, float]
    """Distances (dx, dy) of the lattice [m]."""
    measured: BoolArray
    """Which points have a measured height, (ny, nx); at the others, gaps and spikes, it is filled.
    Statistics leave them out."""
    spikes: int = 0
    """Points that were removed as spikes."""
    notes: tuple[str, ...] = ()
    """What a reader of the result should know."""

    @property
    def size(self) -> tuple[float, float]:
        """Return the lengths along x and y [m]."""
        ny, nx = self.values.shape
        return nx * self.pixel[0], ny * self.pixel[1]

    @property
    def sq(self) -> float:
        """Return the root mean square height Sq over the measured points [m]."""
        return float(self.values[self.measured].std())


def without_outliers(values: Array, sigmas: float) -> tuple[Array, int]:
    r"""Return heights with spikes as missing points, and the number of spikes.

    With :math:`m` the median of the 5 x 5 points around each, a point is a spike if

    .. math:: |z - m| > \max\left(k \sigma,\ \max_{7 \times 7} m - \min_{7 \times 7} m\right)

    where :math:`\sigma` is the standard deviation of :math:`z - m` without the spikes. The second
    bound is what a smooth surface explains: a quadratic one leaves its median by at most 0.7 of the
    range of the medians in 5 x 5 points, crossed waves of 12 points by that in 7 x 7. Spikes do not
    widen it, since a median ignores up to 12 of its 25 points.

    Parameters
    ----------
    values : (ny, nx) array
        Heights; NaN or infinite where nothing was measured.
    sigmas : float
        k [-].
    """
    there = np.isfinite(values)
    whole = _nearest(values, ~there)
    # of windows of 5 x 5 points; the shape explains what these medians span in windows of 7 x 7
    median = ndimage.median_filter(whole, 5, mode="nearest")
    explained = ndimage.maximum_filter(median, 7, mode="nearest")
    explained -= ndimage.minimum_filter(median, 7, mode="nearest")
    off = np.abs(whole - median)
    rounding = RELATIVE_ROUNDING * float(np.abs(whole).max())
    limit = np.maximum(explained, max(sigmas * _usual(off[there]), rounding))
    spikes = there & (off > limit)
    return np.where(spikes, np.nan, values), int(spikes.sum())


def _usual(distances: Array) -> float:
    """Return the root mean square of distances without outliers, beyond five times that value."""
    while True:
        usual = math.sqrt(float(np.mean(distances**2)))
        kept = distances[distances <= 5.0 * usual]  # outliers do not count for their size
        if kept.size == distances.size:
            return usual
        distances = kept


def _nearest(values: Array, missing: BoolArray) -> Array:
    """Return heights with the nearest one at each missing point."""
    if not missing.any():
        return values
    places = ndimage.distance_transform_edt(missing, return_distances=False, return_indices=True)
    return values[tuple(places)]


def filled(values: Array, how: Fill, spikes: int = 0) -> Array:
    """Return heights with their gaps filled.

    Parameters
    ----------
    values : Array
        (ny, nx) [m]; NaN and infinite values are gaps.
    how : {"auto", "linear", "nearest", "refuse"}
        "linear" spans a membrane over each gap (Laplace's equation), "nearest" takes the nearest
        height, "auto" is "linear" for up to 1 % of the points and an error beyond.
    spikes : int
        Gaps that were outliers, which the message counts apart.

    Raises
    ------
    InputError
        If more points are missing than ``how`` allows, or more than half of them.
    """
    missing = ~np.isfinite(values)
    if not missing.any():
        return values
    _check_gaps(missing, how, spikes)
    whole = _nearest(values, missing)
    return whole if how == "nearest" else _with_membranes(whole, missing)


def _check_gaps(missing: BoolArray, how: Fill, spikes: int) -> None:
    count = int(missing.sum())
    share = count / missing.size
    row, column = (int(places[0]) for places in np.nonzero(missing))
    removed = f", {spikes} of them removed as spikes" if spikes else ""
    gaps = (
        f"has {count} points without a height ({100 * share:.2g} %{removed}), the first in row "
        f"{row + 1}, column {column + 1}"
    )
    if share == 1.0:
        raise InputError("has no point with a height")
    if share > 0.5:
        raise InputError(f"{gaps}: that is too much to fill, crop the map")
    if how == "refuse" or (how == "auto" and share > 0.01):
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


def levelled(values: Array, how: Level, measured: BoolArray | None = None) -> Array:
    """Return heights without their mean, plane or quadratic form.

    Parameters
    ----------
    values : Array
        (ny, nx) [m], without gaps.
    how : {"none", "mean", "plane", "quadratic"}
        Form that is subtracted, fitted by least squares.
    measured : BoolArray or None
        Points that the fit takes, not those that were filled; None is all.
    """
    if how == "none":
        return values
    there = np.ones(values.shape, bool) if measured is None else measured
    off = values - values[there].mean()
    rows, columns, weights, _ = _fitted(off, _DEGREE[how], there)
    return np.asarray(off - rows.T @ (weights @ columns))


def _fitted(off: Array, degree: int, there: BoolArray) -> tuple[Array, Array, Array, float]:
    """Return powers of y and of x, their weights by least squares, and the fit's mean square."""
    rows, columns = (
        np.vander(np.linspace(-1.0, 1.0, count), 2 * degree + 1, increasing=True).T
        for count in off.shape
    )
    powers = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i)]
    # sums of powers in both directions, so that no term is ever a map
    both = rows @ there @ columns.T
    products = [[both[i + k, j + m] for k, m in powers] for i, j in powers]
    rows, columns = rows[: degree + 1], columns[: degree + 1]
    sums = rows @ np.where(there, off, 0.0) @ columns.T
    moments = np.array([sums[power] for power in powers])
    weights = np.zeros((degree + 1, degree + 1))
    found = np.linalg.solve(np.array(products), moments)
    weights[tuple(np.transpose(powers))] = found
    return rows, columns, weights, float(found @ moments) / int(there.sum())


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
    """Return heights that fall to zero at all edges, with a flat rim around.

    Parameters
    ----------
    heights : Heights
        (ny, nx) [m] with the distances of their points.
    width : float
        Distance over which they fall, by sin^2 [m]; at most half of the map.
    """
    windows = []
    for count, step in zip(heights.values.shape, reversed(heights.pixel), strict=True):
        edge = np.minimum(np.arange(count) + 0.5, count - np.arange(count) - 0.5)
        share = edge / max(min(width / step, 0.5 * count), 1e-9)
        windows.append(np.sin(0.5 * np.pi * np.clip(share, 0.0, 1.0)) ** 2)
    # after as many zeros the spline of a flat tile is zero to rounding
    return np.pad(heights.values * windows[0][:, None] * windows[1], 12)


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
    there = heights.measured
    flat = levelled(heights.values, "plane", there)  # a slope that was left is not a curvature
    flat -= flat[there].mean()
    _, _, weights, square = _fitted(flat, _DEGREE["quadratic"], there)
    sq, sags = float(np.std(flat[there])), (float(weights[0, 2]), float(weights[2, 0]))
    ny, nx = heights.values.shape
    half_x, half_y = 0.5 * (nx - 1) * heights.pixel[0], 0.5 * (ny - 1) * heights.pixel[1]
    curvatures = (2.0 * sags[0] / half_x**2, 2.0 * sags[1] / half_y**2)
    return Form(sq, math.sqrt(max(sq**2 - square, 0.0)), curvatures, sags)


def note_on_form(heights: Heights, level: Level) -> tuple[str, ...]:
    """Return a note if more than half of Sq is a quadratic form that is left in the heights.

    Parameters
    ----------
    heights : Heights
        After levelling [m].
    level : {"none", "mean", "plane", "quadratic"}
        Form that was subtracted; after "quadratic" there is no note.
    """
    if level == "quadratic":
        return ()
    form = form_of(heights)
    if not form.sq_without < 0.5 * form.sq:
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
        if abs(sag) > 0.2 * whole
    ]
    if not bends:
        return "is twisted as a saddle"
    return f"bends with {'a radius' if len(bends) == 1 else 'radii'} {' and '.join(bends)}"


def _metres(length: float) -> str:
    for unit, factor in (("m", 1.0), ("mm", 1e-3), ("um", 1e-6)):
        if length >= factor:
            return f"{length / factor:.3g} {unit}"
    return f"{length * 1e9:.3g} nm"
