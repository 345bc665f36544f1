"""The form of a body that is left in a map: a contact has it already, by its radii."""

import math
from dataclasses import dataclass

import numpy as np

from tehl.roughness.prepare import Heights, Level, levelled, quadratic_of

_MOST_LEFT = 0.5
_COUNTS = 0.2


@dataclass(frozen=True, kw_only=True, slots=True)
class Form:
    """The quadratic that fits a map best.

    Attributes
    ----------
    sq, sq_without : float
        Of the map without a plane, and without the quadratic [m].
    curvatures : (float, float)
        Second derivatives of the heights along x and along y of the map [1/m].
    sags : (float, float)
        What they make between the middle and the edges [m].
    """

    sq: float
    sq_without: float
    curvatures: tuple[float, float]
    sags: tuple[float, float]


def form_of(heights: Heights) -> Form:
    """Return the quadratic form of a map by least squares."""
    flat = levelled(heights.values, "plane")  # a slope that was left does not bend
    weights, square = quadratic_of(flat)
    sq = float(np.std(flat))
    sags = (float(weights[0, 2]), float(weights[2, 0]))
    halves = [
        0.5 * (count - 1) * step
        for count, step in zip(reversed(heights.values.shape), heights.pixel, strict=True)
    ]
    return Form(
        sq=sq,
        sq_without=math.sqrt(max(sq**2 - square, 0.0)),
        curvatures=(2.0 * sags[0] / halves[0] ** 2, 2.0 * sags[1] / halves[1] ** 2),
        sags=sags,
    )


def question_of_form(heights: Heights, level: Level) -> str | None:
    """Return a question if more than half of Sq is a quadratic form; None where all is well.

    Parameters
    ----------
    heights : Heights
        As they are prepared.
    level : {"none", "mean", "plane", "quadratic"}
        What was taken off.
    """
    if level == "quadratic":
        return None
    form = form_of(heights)
    if not form.sq_without < _MOST_LEFT * form.sq:
        return None
    return (
        f'the map {_shape(form)} (level = "{level}"), and without that its Sq is '
        f"{_metres(form.sq_without)}, not {_metres(form.sq)}: is it the form of the body, which "
        'the radii of the contact have already? Then take it off, level = "quadratic"'
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
