"""Rough contacts: heights, ripples of film and pressure, centre line, distribution of the film."""

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tehl.errors import InputError
from tehl.fields import SurfaceHeights
from tehl.plots.frame import (
    GIGA,
    MICRO,
    STEPS,
    Span,
    colour_axes,
    contact_axes,
    dress_contact,
    entrainment_arrow,
    figure,
    legend_above,
    length,
    map_figure,
    window_part,
)
from tehl.plots.lines import FILM, PRESSURE, show_film_behind
from tehl.plots.maps import slenderness, window_places
from tehl.post.film import hertz_pressure
from tehl.post.micro_film import MicroFilm, micro_film
from tehl.post.roughness import RoughFilm, film_histogram, in_contact, rough_film
from tehl.result import Result
from tehl.typing import Array

_HEIGHTS, _RIPPLES = "viridis", "RdBu_r"
_SURFACE = "#3f7d20"
_SHOWN = (0.5, 99.5)
"""Percentiles between which colours change."""
_REACH = 1.25
"""Half-widths of the centre line on each side."""
_FILTERED = 0.75
"""Part of the contact in which ripples by a filter are shown: its rim is no ripple."""


def heights_of(result: Result) -> SurfaceHeights:
    """Return the heights of a rough contact, for pictures that are about them."""
    if result.heights is None:
        raise InputError("both surfaces are smooth: there are no heights to draw")
    return result.heights


def _numbers_of(result: Result, smooth: Result | None = None) -> RoughFilm:
    found = rough_film(result, smooth)
    if found is None:
        raise InputError("the result has no film between rough surfaces to draw")
    return found


def heights_map(result: Result) -> Figure:
    """Draw the heights of both surfaces together, as the grid carries them.

    Parameters
    ----------
    result : Result
        Of a rough contact.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, in micrometres and nanometres; peaks narrow the film.

    Raises
    ------
    InputError
        If both surfaces are smooth.
    """
    heights = heights_of(result).together * 1e9
    picture = map_figure(result, _note(result))
    axes = contact_axes(picture, result)
    part = window_part(result)
    span = _span(heights[part])
    mesh = _coloured(axes, result, heights, _HEIGHTS, span)
    entrainment_arrow(axes)
    legend_above(axes)
    label = "height of both surfaces, outwards [nm]"
    picture.colorbar(mesh, cax=colour_axes(axes), extend=_ends(heights[part], span), label=label)
    return picture


def _note(result: Result) -> str:
    found = rough_film(result)
    if found is None:
        return ""
    return f"Sq = {length(found.composite)} of both surfaces, lambda ratio {found.lambda_ratio:.3g}"


def _span(shown: Array) -> Span:
    low, high = (float(value) for value in np.percentile(shown, _SHOWN))
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _ends(shown: Array, span: Span) -> Any:
    """Return which ends of a colour bar stand for more than they say."""
    slack = 1e-3 * (span[1] - span[0])
    below, above = shown.min() < span[0] - slack, shown.max() > span[1] + slack
    return {(False, False): "neither", (True, False): "min", (False, True): "max"}.get(
        (bool(below), bool(above)), "both"
    )


def _coloured(axes: Axes, result: Result, values: Array, colours: str, span: Span) -> Any:
    x, y = window_places(result)
    shown = values[window_part(result)]
    return axes.pcolormesh(x, y, shown, shading="gouraud", cmap=colours, clim=span, rasterized=True)


def micro_film_map(result: Result, smooth: Result | None = None) -> Figure:
    """Draw the ripples of film and pressure side by side.

    Colours reach as far as the ripples in the Hertz contact do.

    Parameters
    ----------
    result : Result
        Of a rough contact.
    smooth : Result or None
        Its smooth twin, which is subtracted; without it long waves are filtered off, and the
        ripples at the rim of the contact and beyond are left blank.

    Returns
    -------
    matplotlib.figure.Figure
        Two maps, in nanometres and megapascals.

    Raises
    ------
    InputError
        If both surfaces are smooth, or the twin lies on another grid.
    """
    heights_of(result)
    ripples = micro_film(result, smooth)
    side_by_side = slenderness(result) > 0.5
    picture = figure(result, (9.6, 5.2) if side_by_side else (6.4, 6.4))
    rows, columns = (1, 2) if side_by_side else (2, 1)
    panels = picture.subplots(rows, columns, squeeze=False).ravel()
    _ripple_panel(panels[0], result, ripples, "film")
    _ripple_panel(panels[1], result, ripples, "pressure")
    if side_by_side:
        panels[1].set_ylabel("")
    return picture


_UNITS = {"film": (1e9, "nm"), "pressure": (1e-6, "MPa")}


def _ripple_panel(axes: Axes, result: Result, ripples: MicroFilm, name: str) -> None:
    factor, unit = _UNITS[name]
    contact = in_contact(result, 1.0 if ripples.by_twin else _FILTERED)
    values = getattr(ripples, name) * factor
    reach = float(np.percentile(np.abs(values[contact]), 99.0)) or 1.0
    shown = values if ripples.by_twin else np.where(contact, values, np.nan)
    dress_contact(axes, result)
    mesh = _coloured(axes, result, shown, _RIPPLES, (-reach, reach))
    less = "less that of smooth surfaces" if ripples.by_twin else "less its long waves"
    axes.set_title(f"{name} {less}", fontsize=9)
    axes.xaxis.set_major_locator(MaxNLocator(5, steps=STEPS))
    axes.figure.colorbar(
        mesh,
        ax=axes,
        location="bottom",
        extend="both",
        shrink=0.9,
        aspect=32,
        label=f"{name} ripple [{unit}]",
    )
    entrainment_arrow(axes)


def rough_centre_line(result: Result, smooth: Result | None = None) -> Figure:
    """Draw pressure, film and the surfaces along y = 0.

    Parameters
    ----------
    result : Result
        Of a rough contact.
    smooth : Result or None
        Its smooth twin, drawn thin.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels: pressure [GPa] over film [um]; and the heights of the surfaces as they were
        made beside the ripple of the film [nm].

    Raises
    ------
    InputError
        If both surfaces are smooth.
    """
    heights = heights_of(result)
    row = int(np.argmin(np.abs(result.scaled.y)))
    inside = np.abs(result.scaled.x) <= _REACH
    place = result.x[inside] * MICRO
    picture = figure(result, (7.6, 7.0))
    upper, lower = picture.subplots(2, 1, sharex=True, height_ratios=[1.5, 1.0])
    dry = hertz_pressure(result.scaled.x[inside], result.scaled.y[row])
    upper.plot(place, dry * result.scales.hertz_pressure * GIGA, color="0.45", ls="--", lw=1.0)
    upper.plot(place, result.pressure[row, inside] * GIGA, color=PRESSURE, lw=1.4)
    film = upper.twinx()
    film.plot(place, result.film_thickness[row, inside] * MICRO, color=FILM, lw=1.4)
    if smooth is not None:
        upper.plot(place, smooth.pressure[row, inside] * GIGA, color=PRESSURE, lw=0.7)
        film.plot(place, smooth.film_thickness[row, inside] * MICRO, color=FILM, lw=0.7)
    upper.set_ylabel("pressure p [GPa], dashed: dry Hertz", color=PRESSURE)
    upper.set_ylim(bottom=0.0)
    show_film_behind(upper, film, result, 3.0)
    if smooth is not None:
        upper.set_title("thin lines: smooth surfaces", fontsize=8)
    _line_of_heights(lower, place, heights.together[row, inside])
    ripple = micro_film(result, smooth).film[row, inside] * 1e9
    reach = _FILTERED if smooth is None else 1.0
    shown = np.abs(result.scaled.x[inside]) < reach
    _line_of_ripples(lower, place, np.where(shown, ripple, np.nan))
    lower.set(xlabel="x along entrainment [µm]  (y = 0)", xlim=(place[0], place[-1]))
    lower.legend(loc="upper left", bbox_to_anchor=(0.0, -0.22), ncols=2, fontsize=8, frameon=False)
    return picture


def _line_of_heights(axes: Axes, place: Array, heights: Array) -> None:
    axes.plot(
        place, -heights * 1e9, color=_SURFACE, lw=1.2, label="gap left by undeformed heights (-s)"
    )
    axes.axhline(0.0, color="0.6", lw=0.6)
    axes.set_ylabel("beside the mean [nm]")


def _line_of_ripples(axes: Axes, place: Array, ripple: Array) -> None:
    axes.plot(place, ripple, color=FILM, lw=1.2, label="ripple of the film")


def film_distribution(result: Result) -> Figure:
    """Draw how the film is distributed over the Hertz contact.

    Parameters
    ----------
    result : Result
        Of a rough contact, or of one that states ``rms_roughness``.

    Returns
    -------
    matplotlib.figure.Figure
        The histogram, with the part of the contact that has a thinner film, and Sq.

    Raises
    ------
    InputError
        If the result has neither roughness nor ``rms_roughness``, or no film.
    """
    found = _numbers_of(result)
    edges, share = film_histogram(result)
    picture = figure(result, (6.8, 4.6))
    axes = picture.add_subplot()
    unit = 1e9
    axes.stairs(share / unit, edges * unit, fill=True, color="#9db8dc")
    axes.set(xlabel="film thickness h [nm]", ylabel="part of the contact by film [1/nm]")
    axes.set_xlim(float(edges[0]) * unit, float(edges[-1]) * unit)
    axes.axvline(found.composite * unit, color=FILM, lw=1.2, ls="--", label="Sq of both surfaces")
    thinner = axes.twinx()
    below = np.concatenate([[0.0], np.cumsum(share * np.diff(edges))])
    thinner.plot(edges * unit, 100.0 * below, color=PRESSURE, lw=1.3)
    thinner.set_ylabel("part with a thinner film [%]", color=PRESSURE)
    thinner.set_ylim(0.0, 100.0)
    median = dict(found.quantiles)[0.5]
    if math.isfinite(median):
        axes.axvline(median * unit, color="0.3", lw=1.0, label="median film")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, fontsize=8, frameon=False)
    return picture
