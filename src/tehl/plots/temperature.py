"""Temperature of a film: mid-film, layers, cross-section, surfaces and their heat fluxes.

Temperatures are drawn as rises over the oil at the inlet, in kelvin. Each function raises an
InputError for an isothermal result.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.plots.arrows import MICRO, entrainment_arrow
from tehl.plots.frame import (
    ALONG_X,
    BLUE,
    GREEN,
    MAP,
    ORANGE,
    PLAIN,
    STEPS,
    WINDOW,
    Span,
    colour_bar,
    dress_contact,
    figure,
    figure_of,
    inner_levels,
    map_axes,
    mark_levels,
    shape,
    span_part,
    window,
    window_part,
    window_places,
)
from tehl.post.heat import Temperature, temperature
from tehl.result.fields import FilmHeat
from tehl.result.solution import Solution

Line = tuple[int, slice] | tuple[slice, int]
"""Index of a grid line in the fields."""
_TICKS = {2: 7, 3: 4, 6: 2}
"""Ticks along x, by the number of columns."""


def mid_film_temperature(
    result: Solution, *, ax: Axes | None = None, title: bool | None = True
) -> Figure:
    """Draw the temperature rise half-way between the surfaces [K] as a map.

    Parameters
    ----------
    result : Solution
        Of a thermal run.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.
    """
    found = _heat_of(result)[1]
    note = (
        f"oil enters at {found.inlet - 273.15:.4g} °C; largest rise {found.film_rise_max:.3g} K "
        f"in the film, {found.surface_1_rise_max:.3g} and {found.surface_2_rise_max:.3g} K "
        "on the surfaces"
    )
    axes = map_axes(result, note, ax=ax, title=title)
    rise = (found.mid_film - found.inlet)[window_part(result)]
    mesh, lines = _coloured(axes, window_places(result), rise, _span(rise))
    mark_levels(colour_bar(axes, mesh, "mid-film temperature rise [K]"), lines)
    return figure_of(axes)


def _heat_of(result: Solution) -> tuple[FilmHeat, Temperature]:
    """Return heat and temperatures of a thermal result."""
    heat, found = result.heat, temperature(result)
    if heat is None or found is None:
        raise InputError("the result is isothermal: it has no temperatures to draw")
    return heat, found


def _span(rise: Array) -> Span:
    """Return the least and the largest rise of a picture, zero among them."""
    shown = rise[np.isfinite(rise)]
    low, high = (float(shown.min()), float(shown.max())) if shown.size else (0.0, 0.0)
    return min(low, 0.0), max(high, 1e-3)


def _coloured(
    axes: Axes, places: Sequence[Array], rise: Array, span: Span
) -> tuple[QuadMesh, QuadContourSet]:
    """Draw a rise as colours and contour lines; return both."""
    mesh = axes.pcolormesh(*places, rise, clim=span, cmap="inferno", **MAP)
    levels = inner_levels(span)
    # without a line around zero: far out the rise is flat, and zero
    levels = levels[np.abs(levels) > 1e-6 * (span[1] - span[0])]
    line: dict[str, Any] = {"colors": "white", "linewidths": 0.6, "alpha": 0.75}
    return mesh, axes.contour(*places, np.nan_to_num(rise), levels=levels, **line)


def temperature_layers(result: Solution, *, title: bool | None = True) -> Figure:
    """Draw the temperature rise on both surfaces and on layers between, in one scale of colours.

    Parameters
    ----------
    result : Solution
        Of a thermal run.
    title : bool or None
        Whether the figure has a title.
    """
    found = _heat_of(result)[1]
    layers = _layers(result)
    slender = shape(result)
    columns = 2 if slender < 0.5 else 3 if slender < 2.0 else 6
    rows = len(layers) // columns
    width = 6.6 / columns
    height = float(np.clip(rows * (width * slender + 0.4), 2.2, 10.0)) + 1.4
    picture = figure(result, (8.6, height), title=title)
    picture.set_layout_engine("compressed")  # closes the gaps that equal aspects leave
    grid = picture.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    part, places = window_part(result), window_places(result)
    rises = [field[part] - found.inlet for field in layers.values()]
    span = _span(np.stack(rises))
    for axes, name, rise in zip(grid.flat, layers, rises, strict=True):
        mesh, lines = _coloured(axes, places, rise, span)
        dress_contact(axes, result)
        axes.set_xlabel("x [µm]")
        axes.xaxis.set_major_locator(MaxNLocator(_TICKS[columns], steps=STEPS, prune="both"))
        axes.label_outer()
        axes.set_title(name, fontsize=9)
    entrainment_arrow(grid[0, 0])
    mark_levels(picture.colorbar(mesh, ax=grid, label="temperature rise [K]", pad=0.02), lines)
    return picture


def _layers(result: Solution) -> dict[str, Array]:
    """Return the temperatures of both surfaces, of three layers and their mean, by name."""
    heat, found = _heat_of(result)
    low, high = (int(np.argmin(np.abs(heat.zeta - place))) for place in (0.25, 0.75))
    return {
        "surface 1": heat.temperature[0],
        f"z = {heat.zeta[low]:.2g} h": heat.temperature[low],
        "mid-film": found.mid_film,
        f"z = {heat.zeta[high]:.2g} h": heat.temperature[high],
        "surface 2": heat.temperature[-1],
        "mean": found.mean,
    }


def temperature_section(result: Solution, *, title: bool | None = True) -> Figure:
    """Draw the temperature rise in the plane y = 0, over z/h and over z, in one scale of colours.

    Between its nodes across the film the temperature is a cubic spline.

    Parameters
    ----------
    result : Solution
        Of a thermal run.
    title : bool or None
        Whether the figure has a title.
    """
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 (0.3 s)

    heat, found = _heat_of(result)
    row, columns = result.scaled.centre[0], span_part(result.scaled.x, window(result)[0])
    x, film = result.x[columns] * MICRO, np.nan_to_num(result.film_thickness[row, columns] * 1e9)
    zeta = np.linspace(0.0, 1.0, 81)
    rise = np.nan_to_num(heat.temperature[:, row, columns] - found.inlet)
    rise = CubicSpline(heat.zeta, rise, axis=0)(zeta)
    picture = figure(result, (7.6, 7.0), title=title)
    upper, lower = picture.subplots(2, 1, sharex=True)
    along = np.broadcast_to(x, rise.shape)
    for axes, height in ((upper, np.ones_like(x)), (lower, film)):
        mesh, lines = _coloured(axes, (along, np.outer(zeta, height)), rise, _span(rise))
    lower.plot(x, film, color="black", lw=0.9)
    top = 3.0 * result.film.central * 1e9  # what the section shows
    lower.set(ylabel="z [nm]", ylim=(0.0, top if top > 0 else 1.0), facecolor="0.88")
    lower.set(xlabel=ALONG_X, xlim=(x[0], x[-1]))
    upper.set(ylabel="z / h", ylim=(0.0, 1.0))
    for axes in (upper, lower):
        _mark_ends(axes, result, "white", 1.0)
    style = {"transform": upper.transAxes, "color": "white", "fontsize": 8, "ha": "right"}
    upper.text(0.99, 0.97, "surface 2", va="top", **style)
    upper.text(0.99, 0.03, "surface 1", va="bottom", **style)
    bar = picture.colorbar(mesh, ax=[upper, lower], label="temperature rise [K]", pad=0.02)
    mark_levels(bar, lines)
    return picture


def _mark_ends(axes: Axes, result: Solution, colour: str, width: float) -> None:
    """Mark where the Hertz contact begins and ends on y = 0, where a turned ellipse is narrower."""
    half = result.scales.half_width_x * MICRO * np.sqrt(1.0 - result.groups.skew**2)
    for place in (-half, half):
        axes.axvline(place, color=colour, lw=width, ls="--")


def surface_heat(result: Solution, *, title: bool | None = True) -> Figure:
    """Draw temperature rises [K] and heat fluxes into the solids [MW/m^2] along y = 0.

    Parameters
    ----------
    result : Solution
        Of a thermal run.
    title : bool or None
        Whether the figure has a title.
    """
    heat = _heat_of(result)[0]
    row = result.scaled.centre[0]
    x = result.x * MICRO
    picture = figure(result, (7.2, 6.6), title=title)
    upper, lower = picture.subplots(2, 1, sharex=True)
    for rise, style in rises(result, (row, slice(None))):
        upper.plot(x, rise, **style)
    upper.set_ylabel("temperature rise [K]")
    for flux, name, colour in ((heat.flux_1, "1", BLUE), (heat.flux_2, "2", GREEN)):
        lower.plot(x, flux[row] * 1e-6, color=colour, lw=1.4, label=f"into surface {name}")
    lower.set_ylabel("heat flux [MW/m²]")
    lower.axhline(0.0, color="0.6", lw=0.6)
    inside = x[span_part(result.scaled.x, WINDOW[0])]
    lower.set(xlabel=ALONG_X, xlim=(inside[0], inside[-1]))
    for axes in (upper, lower):
        axes.grid(axis="y", lw=0.3)
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 0.98), ncols=4, **PLAIN)
        _mark_ends(axes, result, "0.6", 0.8)
    return picture


def rises(result: Solution, line: Line) -> list[tuple[Array, dict[str, Any]]]:
    """Return the temperature rises along a grid line [K], and the style of the curve of each.

    Parameters
    ----------
    result : Solution
        Of a thermal run.
    line : (int or slice, int or slice)
        Row and columns, or rows and column, of the grid.
    """
    heat, found = _heat_of(result)
    return [
        (field[line] - found.inlet, {"label": name, "color": colour, "ls": style, "lw": 1.3})
        for field, name, colour, style in (
            (found.mid_film, "mid-film", ORANGE, "-"),
            (found.mean, "mean across film", "0.35", "--"),
            (heat.temperature[0], "surface 1", BLUE, "-"),
            (heat.temperature[-1], "surface 2", GREEN, "-"),
        )
    ]
