"""The film of a rough contact: lambda, distribution, ripples."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tehl.base.typing import Array, BoolArray
from tehl.contact.shape import Shape
from tehl.estimate.film_formulas import Lubrication, likely_film, lubrication, lubrication_by_share
from tehl.post.boundary_contact import touching
from tehl.post.film import no_film
from tehl.post.summits import load_sharing
from tehl.post.traction import cell_widths
from tehl.post.waves.response import FIT_HALF_WIDTH, WaveResponse, wave_notes, wave_responses
from tehl.result.solution import Solution
from tehl.roughness.resolution import Resolution

QUANTILES = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99)
"""Parts of the contact whose films are reported."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Ripples:
    """Valleys of the film along a centre line, where the coordinate is within 0.8 half-widths."""

    count: int
    """Of valleys that lie between two hills."""
    depth: float
    """Mean depth below the mean of both hills [m]; zero without valleys."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RoughFilm:
    """Numbers of the film between rough surfaces."""

    sq: tuple[float, float]
    """Root mean square height of each full surface where |X|, |Y| < 1; the stated ``rms_roughness``
    of a surface that is computed as smooth [m]."""
    sq_on_grid: tuple[float, float]
    """The same of what the grid carries [m]."""
    resolution: Resolution | None
    """Which part of the stated heights that is."""
    composite: float
    """Of both together, ``sqrt(Sq_1^2 + Sq_2^2)`` [m]."""
    lambda_central: float
    """Central film over ``composite`` [-]; between rough surfaces the central film is the mean
    where |X|, |Y| < 0.4, so that no single asperity decides."""
    lambda_minimum: float | None
    """Minimum film over ``composite`` [-]; None at an end of a roller where it has no limit."""
    lambda_by_formula: float
    """Central film of the smooth contact by formula over ``composite`` [-]."""
    quantiles: tuple[tuple[float, float], ...]
    """Part of the Hertz contact, and the film that is thicker than that of this part [m]."""
    below_composite: float
    below_half: float
    """Part of the Hertz contact whose film is thinner than ``composite``, and than half of its
    median [-]."""
    minimum_at: tuple[float, float]
    """Where the minimum film is, in half-widths [-]."""
    largest_pressure: float
    """Over the Hertz pressure [-]."""
    ripple_film: float
    ripple_pressure: float
    """Root mean square of the film [m], and of the pressure less that of Hertz [Pa], about a
    parabola where R < 0.5, of a roller |X|, |Y| < 0.5."""
    ripples_x: Ripples
    ripples_y: Ripples
    """On the centre lines along and across entrainment."""
    waves: tuple[WaveResponse, ...]
    """The waves of the surfaces, one by one."""
    wave_notes: tuple[str, ...]
    """What is left out of them, and why."""
    share: float | None
    """Load on asperities, or where surfaces touch, over the load [-]; None if not computed."""

    @property
    def lubrication(self) -> Lubrication:
        """Boundary, mixed or full film, by ``share`` or else by ``lambda_central``."""
        if self.share is not None:
            return lubrication_by_share(self.share)
        return lubrication(self.lambda_central)


def rough_film(result: Solution, smooth: Solution | None = None) -> RoughFilm | None:
    """Return the numbers of the film between rough surfaces.

    Parameters
    ----------
    result : Solution
        What a solve returned or a file held.
    smooth : Solution or None
        The same contact with smooth surfaces on the same grid: without it waves longer than 0.4
        half-widths are separated from the shape of the film to a few per cent only.

    Returns
    -------
    RoughFilm or None
        None where there is no film, or neither roughness nor ``rms_roughness``.
    """
    first, second = sq_of(result)
    composite = math.hypot(first, second)
    finer = 0.0 if result.asperities is None else float(result.asperities.rms)
    if result.heights is not None:  # the grid carries these, and not those of the asperities
        composite = math.hypot(composite, finer)
    elif finer:
        composite = finer
    if no_film(result) or not composite > 1e-12:
        return None  # smooth, or the foot of a bump far upstream
    film, areas = film_in_contact(result), areas_in_contact(result)
    films = tuple(map(float, weighted_quantiles(film, areas, QUANTILES)))
    (median,) = weighted_quantiles(film, areas, (0.5,))
    formula = likely_film(result.scaled_problem).central_m
    central = result.film.central if result.heights is None else middle_film(result)
    scaled, (row, column) = result.scaled, result.scaled.centre
    has_limit = result.errors is None or result.errors.minimum_has_limit
    shape = result.groups.shape
    ripple_film, ripple_pressure = ripples(scaled.x, scaled.y, scaled.film, scaled.pressure, shape)
    return RoughFilm(
        sq=(first, second),
        sq_on_grid=sq_on_grid(result),
        resolution=result.resolution,
        composite=composite,
        lambda_central=central / composite,
        lambda_minimum=result.film.minimum / composite if has_limit else None,
        lambda_by_formula=formula / composite,
        quantiles=tuple(zip(QUANTILES, films, strict=True)),
        below_composite=area_below(result, composite),
        below_half=area_below(result, 0.5 * float(median)),
        minimum_at=result.film_scaled.minimum_at,
        largest_pressure=float(result.scaled.pressure.max()),
        ripple_film=ripple_film * result.scales.film_thickness,
        ripple_pressure=ripple_pressure * result.scales.hertz_pressure,
        ripples_x=_ripples(result.scaled.x, result.film_thickness[row]),
        ripples_y=_ripples(result.scaled.y, result.film_thickness[:, column]),
        waves=wave_responses(result, smooth),
        wave_notes=wave_notes(result),
        share=_solid_share(result),
    )


def _solid_share(result: Solution) -> float | None:
    """Return the part of the load that asperities carry [-]; None where it is not known.

    Roughness that is stated, but not computed, may touch where patches on the grid do not.
    """
    averaged, patches = load_sharing(result), touching(result)
    if patches is None:
        return None if averaged is None else averaged.share
    if not patches.is_share_known or (averaged is None and result.heights is None):
        return None
    return patches.share + (0.0 if averaged is None else averaged.share)


def ripples(x: Array, y: Array, film: Array, pressure: Array, shape: Shape) -> tuple[float, float]:
    """Return the rms of film and of pressure less the dry one, about a parabola [-].

    Parameters
    ----------
    x : (nx,) array
    y : (ny,) array
        Coordinates in half-widths, y of the full or of the half domain.
    film, pressure : (ny, nx) array
        Dimensionless.
    shape : Shape
        Of the dry contact.
    """
    # the middle of the contact, and of the length of a roller
    inside = (shape.radius_squared(x, y[:, None]) < 0.5**2) & (np.abs(y[:, None]) < 0.5)
    rows, columns = np.nonzero(inside)
    along, across = x[columns], y[rows]
    weight = cell_widths(y)[rows]
    root = np.sqrt(weight / weight.sum())
    terms = [np.ones(rows.size), along, along**2, across**2]
    if y[0] != 0.0:  # not of a half domain
        terms += [across, along * across]
    parabola = np.stack(terms)
    dry = shape.dry_pressure(x, y[:, None])
    values = np.stack([film[inside], (pressure - dry)[inside]])
    fitted, *_ = np.linalg.lstsq((root * parabola).T, (root * values).T, rcond=None)
    rest = (values - fitted.T @ parabola) * root
    found = np.linalg.norm(rest, axis=1)
    return float(found[0]), float(found[1])


def sq_of(result: Solution) -> tuple[float, float]:
    """Return Sq of both full surfaces where |X|, |Y| < 1, or the one stated of smooth ones [m].

    Waves that the grid does not carry count by their share of the variance.
    """
    whole, found = result.resolution, sq_on_grid(result)
    if result.heights is None or whole is None:
        return found
    first, second = (
        on_grid * sq / kept if on_grid > 0 and kept > 0 else on_grid or sq
        for on_grid, sq, kept in zip(found, whole.sq, whole.kept, strict=True)
    )
    return first, second


def sq_on_grid(result: Solution) -> tuple[float, float]:
    """Return Sq of what the grid carries where |X|, |Y| < 1, or the one stated [m]."""
    stated = (result.problem.surface_1.rms_roughness, result.problem.surface_2.rms_roughness)
    if result.heights is None:
        return stated
    part, surfaces = square(result), (result.heights.surface_1, result.heights.surface_2)
    widths = cell_widths(result.y)[part[0]]
    first, second = (
        math.sqrt(_mean((heights[part] - _mean(heights[part], widths)) ** 2, widths))
        for heights in surfaces
    )
    return first or stated[0], second or stated[1]


def _mean(field: Array, widths: Array) -> float:
    """Return the mean of a field over even columns and over lines of widths (ny, 1)."""
    return float((field.mean(axis=1) * widths[:, 0]).sum() / widths.sum())


def square(result: Solution) -> tuple[Array, ...]:
    """Return the indices of the nodes where |X|, |Y| < 1."""
    return np.ix_(*(np.abs(axis) < 1.0 for axis in (result.scaled.y, result.scaled.x)))


def middle_film(result: Solution) -> float:
    """Return the mean film where |X|, |Y| < 0.4 [m]."""
    part = np.ix_(*(np.abs(axis) <= FIT_HALF_WIDTH for axis in (result.scaled.y, result.scaled.x)))
    return _mean(result.film_thickness[part], cell_widths(result.y)[part[0]])


def in_contact(result: Solution, reach: float = 1.0) -> BoolArray:
    """Return which nodes lie in the Hertz contact, (ny, nx).

    Parameters
    ----------
    result : Solution
        Decides the nodes.
    reach : float
        Size of the region over that of the Hertz contact [-].
    """
    at = result.groups.shape.radius_squared(result.scaled.x, result.scaled.y[:, None])
    inside: BoolArray = at < reach**2
    return inside


def film_in_contact(result: Solution) -> Array:
    """Return the film at all nodes in the Hertz contact, (n,) [m]; see `areas_in_contact`."""
    return result.film_thickness[in_contact(result)]


def areas_in_contact(result: Solution) -> Array:
    """Return the areas that these nodes stand for, (n,) [m^2]: lines of rollers may crowd."""
    cells = np.outer(cell_widths(result.y), cell_widths(result.x))
    return np.asarray(cells[in_contact(result)])


def weighted_quantiles(values: Array, weights: Array, parts: Sequence[float]) -> Array:
    """Return the values below which lie given parts of the weight, linear between the values.

    Parameters
    ----------
    values, weights : (n,) array
        Equal weights give `numpy.quantile`.
    parts : sequence of float
        From 0 to 1.
    """
    order = np.argsort(values)
    below = np.cumsum(weights[order]) - 0.5 * weights[order]
    below -= below[0]
    return np.interp(parts, below / max(below[-1], 1e-300), values[order])


def area_below(result: Solution, threshold: float) -> float:
    """Return the part of the Hertz contact whose film is thinner than a threshold [-].

    Parameters
    ----------
    result : Solution
        By the areas of its nodes in the Hertz contact; of a roller, in that of its slices.
    threshold : float
        Film thickness [m].
    """
    areas, thin = areas_in_contact(result), film_in_contact(result) < threshold
    return float(areas[thin].sum() / areas.sum())


def film_histogram(result: Solution, bins: int | Sequence[float] = 60) -> tuple[Array, Array]:
    """Return how the film is distributed over the Hertz contact.

    Parameters
    ----------
    result : Solution
        Where to look.
    bins : int or sequence of float
        How many bins up to the 99.5 % quantile, or their edges [m].

    Returns
    -------
    (n + 1,) array, (n,) array
        Edges [m], and the part of the contact in each bin by its width [1/m].
    """
    film, areas = film_in_contact(result), areas_in_contact(result)
    if isinstance(bins, int):
        (top,) = weighted_quantiles(film, areas, (0.995,))
        bins = np.linspace(min(0.0, float(film.min())), top, bins + 1).tolist()
    parts, edges = np.histogram(film, bins=bins, weights=areas / areas.sum())
    return edges, parts / np.diff(edges)


def _ripples(axis: Array, film: Array) -> Ripples:
    """Return the valleys of a film along ``axis`` [half-widths], of 1 % of its mean or deeper."""
    line = film[np.abs(axis) <= 0.8]  # half-widths
    turns = _turns(line, 0.01 * float(line.mean()))
    # Every other turn is a valley; those at the ends lie beside one hill only.
    depths = [
        0.5 * (line[before] + line[after]) - line[here]
        for before, here, after in zip(turns, turns[1:], turns[2:], strict=False)
        if line[here] < line[before]
    ]
    return Ripples(count=len(depths), depth=float(np.mean(depths)) if depths else 0.0)


def _turns(line: Array, least: float) -> list[int]:
    """Return where a line turns by more than ``least``, with its ends."""
    turns, direction, extreme = [0], 0, 0
    for place in range(1, line.size):
        if direction == 0 and abs(line[place] - line[0]) > least:
            direction, extreme = (1 if line[place] > line[0] else -1), place
        elif direction * (line[place] - line[extreme]) > 0:
            extreme = place
        elif direction * (line[extreme] - line[place]) > least:
            turns.append(extreme)
            direction, extreme = -direction, place
    return [*turns, extreme] if direction else turns
