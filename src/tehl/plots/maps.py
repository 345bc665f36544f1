"""Maps of film, pressure, shear stress, heights and ripples, with the Hertz contact."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, NullFormatter, NullLocator

from tehl.errors import InputError
from tehl.fields import SurfaceHeights
from tehl.plots.frame import (
    GIGA,
    MICRO,
    STEPS,
    Span,
    coloured,
    dress_contact,
    entrainment_arrow,
    figure,
    finish_map,
    inner_levels,
    length,
    map_figure,
    nice_levels,
    slenderness,
    window_part,
    window_places,
)
from tehl.post.micro_film import MicroFilm, micro_film
from tehl.post.roughness import in_contact, rough_film
from tehl.result import Result
from tehl.typing import Array

FILTERED = 0.75
"""Half-widths within which ripples by a filter are shown: at the rim the filter sees the rim."""
_SHOWN = (0.5, 99.5)
"""Percentiles of the heights between which colours change."""
_RIPPLES = {"film": (1e9, "nm"), "pressure": (1e-6, "MPa")}


def film_map(result: Result) -> Figure:
    """Draw the film thickness with labelled contour lines and the Hertz contact.

    Colours are logarithmic, from just below the minimum film to 1.6 times the central film, and
    contour lines lie close below 1.1 times the central film, so that the horseshoe and the side
    lobes show.
    """
    picture, axes = map_figure(result)
    film = result.film_thickness[window_part(result)] * MICRO
    low, central = _film_range(result, film)
    bottom, top = 0.95 * low, 1.6 * central
    mesh = coloured(axes, result, film.clip(bottom, top), norm=LogNorm(bottom, top))
    _film_contours(axes, window_places(result), film, film_levels(low, central))
    marks = _mark_minimum(axes, result)
    bar = finish_map(picture, mesh, "film thickness h [µm]", marks=marks, extend="max")
    ticks = nice_levels(low, top, 8)
    bar.ax.yaxis.set_minor_locator(NullLocator())
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    ticks = ticks[(ticks >= bottom) & (ticks <= top)]
    bar.ax.set_yticks(ticks, [f"{tick:.4g}" for tick in ticks], fontsize=8)
    return picture


def _film_contours(
    axes: Axes, places: tuple[Array, Array], film: Array, levels: tuple[Array, Array]
) -> None:
    """Draw the contour lines; slender contacts have no room for labels."""
    inner, outer = levels
    lines = axes.contour(*places, film, levels=inner, colors="white", linewidths=0.7)
    outside = axes.contour(*places, film, levels=outer, colors="black", linewidths=0.5, alpha=0.6)
    if 0.5 < np.ptp(axes.get_ylim()) / np.ptp(axes.get_xlim()) < 2.0:
        axes.clabel(lines, inner[1::2], fontsize=7, fmt="%.3g")
        axes.clabel(outside, fontsize=7, fmt="%.3g")


def _film_range(result: Result, film: Array) -> tuple[float, float]:
    """Return the smallest and the central film [um], positive even where there is no film."""
    central = result.film.central * MICRO
    positive = film[film > 0]
    if not central > 0:
        central = float(np.median(positive)) if positive.size else 1.0
    low = float(positive.min()) if positive.size else 0.1 * central
    return min(max(low, 0.02 * central), 0.95 * central), central


def film_levels(low: float, central: float) -> tuple[Array, Array]:
    """Return contour levels: close ones up to 1.1 central films, wide ones up to three."""
    fine = nice_levels(low, 1.1 * central, 6)
    inner = fine[(fine > low) & (fine <= 1.1 * central)]
    wide = nice_levels(1.1 * central, 3.0 * central, 5)
    outer = wide[(wide > 1.1 * central) & (wide <= 3.0 * central)]
    return inner, outer


def _mark_minimum(axes: Axes, result: Result) -> list[Line2D]:
    """Mark the minimum film, on both sides of a symmetric contact; return the marks."""
    if not result.film.minimum > 0:
        return []
    x, y = result.film_scaled.minimum_at
    film = result.scaled.film
    across = (y, -y) if y and np.allclose(film, film[::-1], equal_nan=True) else (y,)
    return axes.plot(
        np.full(len(across), x * result.scales.half_width_x * MICRO),
        np.array(across) * result.scales.half_width_y * MICRO,
        "r+",
        ms=6,
        mew=1.3,
        zorder=7,
        label="minimum film",
    )


def pressure_map(result: Result) -> Figure:
    """Draw the pressure [GPa] as a map with contour lines, marked on the colour bar.

    Lines follow a slightly smoothed copy of the pressure.
    """
    pressure = result.pressure[window_part(result)] * GIGA
    top = float(np.max(pressure, initial=0.0, where=np.isfinite(pressure)))
    levels = nice_levels(0.0, top if top > 0 else 1.0, 8)
    levels = levels[(levels > 0) & (levels < top)] if top > 0 else levels[1:]
    picture, axes = map_figure(result)
    mesh = coloured(axes, result, pressure, cmap="cividis")
    lines = _contours(axes, result, _smoothed(pressure), levels)
    finish_map(picture, mesh, "pressure p [GPa]", lines=(lines, levels))
    return picture


def _contours(axes: Axes, result: Result, shown: Array, levels: Array) -> Any:
    places = window_places(result)
    return axes.contour(*places, shown, levels=levels, colors="black", linewidths=0.6)


def _smoothed(field: Array) -> Array:
    """Return ``field`` after two binomial filters [1, 2, 1] / 4 along each axis.

    The contour lines of a ridge narrower than a few nodes would otherwise break into islands.
    """
    for axis in (0, 1):
        for _ in range(2):
            wide = np.pad(field, [(1, 1) if axis == side else (0, 0) for side in (0, 1)], "edge")
            count = field.shape[axis]
            below, here, above = (wide.take(range(i, i + count), axis) for i in range(3))
            field = 0.25 * below + 0.5 * here + 0.25 * above
    return field


def shear_stress_map(result: Result) -> Figure:
    """Draw the magnitude of the shear stress at mid-film [MPa] as a map.

    Raises InputError if the result has no shear stresses.
    """
    shear, traction = result.shear, result.traction
    if shear is None or traction is None:
        raise InputError("the result has no shear stresses to draw")
    note = (
        f"SRR = {result.problem.slide_roll_ratio:.4g}; traction {traction.mid_film:.4g} "
        f"at mid-film, {traction.surface_1:.4g} and {traction.surface_2:.4g} on surfaces 1 and 2"
    )
    picture, axes = map_figure(result, note)
    stress = np.hypot(shear.mid_film, shear.across)[window_part(result)] * 1e-6
    top = float(np.max(stress, initial=0.0, where=np.isfinite(stress)))
    levels = inner_levels(0.0, top)
    mesh = coloured(axes, result, stress, cmap="cividis", clim=(0.0, top if top > 0 else 1.0))
    lines = _contours(axes, result, stress, levels)
    finish_map(
        picture, mesh, "magnitude of the shear stress at mid-film [MPa]", lines=(lines, levels)
    )
    return picture


def heights_of(result: Result) -> SurfaceHeights:
    """Return the heights of a rough contact, which the pictures of roughness need."""
    if result.heights is None:
        raise InputError("both surfaces are smooth: there are no heights to draw")
    return result.heights


def heights_map(result: Result) -> Figure:
    """Draw the heights of both surfaces together [nm], as the grid carries them.

    Peaks narrow the film. Raises InputError if both surfaces are smooth.
    """
    heights = heights_of(result).together[window_part(result)] * 1e9
    found = rough_film(result)
    note = ""
    if found is not None:
        note = f"Sq = {length(found.composite)} of both surfaces, "
        note += f"lambda ratio {found.lambda_ratio:.3g}"
    picture, axes = map_figure(result, note)
    low, high = (float(value) for value in np.percentile(heights, _SHOWN))
    span = (low, high) if high > low else (low - 0.5, high + 0.5)
    mesh = coloured(axes, result, heights, clim=span)
    label = "height of both surfaces, outwards [nm]"
    finish_map(picture, mesh, label, extend=_ends(heights, span))
    return picture


def _ends(shown: Array, span: Span) -> str:
    """Return the ends of a colour bar beyond which there are values."""
    slack = 1e-3 * (span[1] - span[0])
    below, above = bool(shown.min() < span[0] - slack), bool(shown.max() > span[1] + slack)
    return ("both" if above else "min") if below else ("max" if above else "neither")


def micro_film_map(result: Result, smooth: Result | None = None) -> Figure:
    """Draw the ripples of film [nm] and pressure [MPa] side by side.

    The smooth reference run is subtracted; without it long waves are filtered off, and the ripples
    at the rim of the contact and beyond are left blank. Colours span the ripples in the Hertz
    contact. Raises InputError if both surfaces are smooth, or the reference run has another grid.
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


def _ripple_panel(axes: Axes, result: Result, ripples: MicroFilm, name: str) -> None:
    factor, unit = _RIPPLES[name]
    contact = in_contact(result, 1.0 if ripples.by_reference else FILTERED)
    values = getattr(ripples, name) * factor
    reach = float(np.percentile(np.abs(values[contact]), 99.0)) or 1.0
    shown = values if ripples.by_reference else np.where(contact, values, np.nan)
    dress_contact(axes, result)
    part, span = window_part(result), (-reach, reach)
    mesh = coloured(axes, result, shown[part], cmap="RdBu_r", clim=span)
    less = "less that of smooth surfaces" if ripples.by_reference else "less its long waves"
    axes.set_title(f"{name} {less}", fontsize=9)
    axes.xaxis.set_major_locator(MaxNLocator(5, steps=STEPS))
    label = f"{name} ripple [{unit}]"
    bar: dict[str, Any] = {"extend": "both", "shrink": 0.9, "aspect": 32}
    axes.figure.colorbar(mesh, ax=axes, location="bottom", label=label, **bar)
    entrainment_arrow(axes)
