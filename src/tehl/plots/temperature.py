"""Where a film is hot: layers, mid-film, cross-section and what the surfaces feel.

Temperatures are drawn as rises over the oil at the inlet, in kelvin. Each function raises an
InputError for an isothermal run.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tehl.errors import InputError
from tehl.fields import FilmHeat
from tehl.plots.frame import (
    MICRO,
    STEPS,
    WINDOW,
    Span,
    colour_axes,
    contact_axes,
    dress_contact,
    entrainment_arrow,
    figure,
    inner_levels,
    legend_above,
    map_figure,
    span_part,
    window,
    window_part,
)
from tehl.plots.maps import slenderness, window_places
from tehl.post.heat import Temperature
from tehl.result import Result
from tehl.typing import Array

HEAT_COLOURS = "inferno"
FIRST, SECOND, MIDDLE, MEAN = "#1f4e9c", "#3f7d20", "#c2410c", "0.35"
"""Colours of surface 1, surface 2, mid-film and mean."""
_TICKS = {2: 7, 3: 4, 6: 2}
"""Ticks along x for which the panels of so many columns have room."""
_ACROSS = 81
_FLAT = 1e-6
"""Part of the span around zero without a contour line: far out the rise is flat, and zero."""
_HIGHEST = 3.0
"""Films that the section shows, in central films."""


def heat_of(result: Result) -> tuple[FilmHeat, Temperature]:
    """Return what is known of the heat, for pictures that are about it."""
    heat, found = result.heat, result.temperature
    if heat is None or found is None:
        raise InputError("the result is isothermal: it has no temperatures to draw")
    return heat, found


def mid_film_temperature(result: Result) -> Figure:
    """Draw the temperature rise half-way between the surfaces as a map.

    Parameters
    ----------
    result : Result
        Of a thermal run.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, in micrometres and kelvin.
    """
    found = heat_of(result)[1]
    picture = map_figure(result, heat_note(found))
    axes = contact_axes(picture, result)
    rise = found.mid_film - found.inlet
    span = _span(rise[window_part(result)])
    mesh, lines = _map(axes, result, rise, span)
    entrainment_arrow(axes)
    legend_above(axes)
    bar = picture.colorbar(mesh, cax=colour_axes(axes), label="mid-film temperature rise [K]")
    _rule(bar, lines, span)
    return picture


def heat_note(found: Temperature) -> str:
    """Return the temperatures that end a title."""
    return (
        f"oil enters at {found.inlet - 273.15:.4g} °C; largest rise {found.film_rise_max:.3g} K "
        f"in the film, {found.surface_1_rise_max:.3g} and {found.surface_2_rise_max:.3g} K "
        "on the surfaces"
    )


def _span(rise: Array) -> Span:
    """Return the least and the largest rise of a picture, zero among them."""
    shown = rise[np.isfinite(rise)]
    low, high = (float(shown.min()), float(shown.max())) if shown.size else (0.0, 0.0)
    return min(low, 0.0), max(high, 1e-3)


def _rule(bar: Any, lines: Any, span: Span) -> None:
    """Put the contour lines and their values on a colour bar."""
    bar.add_lines(lines)
    bar.set_ticks(sorted({0.0, *inner_levels(*span)}))


def _map(axes: Axes, result: Result, rise: Array, span: Span) -> tuple[Any, Any]:
    """Draw one map of a rise; return what the colours and the contour lines belong to."""
    x, y = np.meshgrid(*window_places(result))
    return _coloured(axes, (x, y), rise[window_part(result)], span)


def _coloured(axes: Axes, places: tuple[Array, Array], rise: Array, span: Span) -> tuple[Any, Any]:
    mesh = axes.pcolormesh(
        *places, rise, shading="gouraud", cmap=HEAT_COLOURS, clim=span, rasterized=True
    )
    levels = inner_levels(*span)
    levels = levels[np.abs(levels) > _FLAT * (span[1] - span[0])]
    shown = np.nan_to_num(rise)
    lines = axes.contour(*places, shown, levels=levels, colors="white", linewidths=0.6, alpha=0.75)
    return mesh, lines


def temperature_layers(result: Result) -> Figure:
    """Draw the temperature rise on both surfaces and on layers between, in one scale of colours.

    Parameters
    ----------
    result : Result
        Of a thermal run.

    Returns
    -------
    matplotlib.figure.Figure
        Up to six maps, from surface 1 to surface 2.
    """
    found = heat_of(result)[1]
    layers = _layers(result)
    slender = slenderness(result)
    columns = 2 if slender < 0.5 else 3 if slender < 2.0 else 6
    rows = len(layers) // columns
    width = 6.6 / columns
    height = float(np.clip(rows * (width * slender + 0.4), 2.2, 10.0)) + 1.4
    picture = figure(result, (8.6, height))
    picture.set_layout_engine("compressed")  # closes the gaps that equal aspects leave
    grid = picture.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    part = window_part(result)
    span = _span(np.stack([field[part] for field in layers.values()]) - found.inlet)
    for axes, (name, field) in zip(grid.flat, layers.items(), strict=True):
        mesh, lines = _map(axes, result, field - found.inlet, span)
        dress_contact(axes, result)
        axes.set_xlabel("x [µm]")
        axes.xaxis.set_major_locator(MaxNLocator(_TICKS[columns], steps=STEPS, prune="both"))
        axes.label_outer()
        axes.set_title(name, fontsize=9)
    entrainment_arrow(grid[0, 0])
    bar = picture.colorbar(mesh, ax=grid, label="temperature rise [K]", pad=0.02)
    _rule(bar, lines, span)
    return picture


def _layers(result: Result) -> dict[str, Array]:
    """Return the layers to draw, by their names."""
    heat, found = heat_of(result)
    quarters = [int(np.argmin(np.abs(heat.zeta - place))) for place in (0.25, 0.75)]
    low, high = (heat.temperature[layer] for layer in quarters)
    names = [f"z = {heat.zeta[layer]:.2g} h" for layer in quarters]
    return {
        "surface 1": heat.temperature[0],
        names[0]: low,
        "mid-film": found.mid_film,
        names[1]: high,
        "surface 2": heat.temperature[-1],
        "mean": found.mean,
    }


def temperature_section(result: Result) -> Figure:
    """Draw the temperature rise in the plane y = 0: over z/h, and over z as the film is.

    Between its nodes across the film the temperature is a cubic spline.

    Parameters
    ----------
    result : Result
        Of a thermal run.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels over x, in one scale of colours.
    """
    heat, found = heat_of(result)
    row = int(np.argmin(np.abs(result.scaled.y)))
    columns = span_part(result.scaled.x, *window(result)[0])
    x, film = result.x[columns] * MICRO, np.nan_to_num(result.film_thickness[row, columns] * 1e9)
    zeta, rise = _refined(heat, row, columns, found.inlet)
    span = _span(rise)
    picture = figure(result, (7.6, 7.0))
    upper, lower = picture.subplots(2, 1, sharex=True)
    along = np.broadcast_to(x, rise.shape)
    _coloured(upper, (along, np.outer(zeta, np.ones(x.size))), rise, span)
    upper.set(ylabel="z / h", ylim=(0.0, 1.0))
    mesh, lines = _coloured(lower, (along, np.outer(zeta, film)), rise, span)
    lower.plot(x, film, color="black", lw=0.9)
    top = _HIGHEST * result.film.central * 1e9
    lower.set(ylabel="z [nm]", ylim=(0.0, top if top > 0 else 1.0), facecolor="0.88")
    lower.set(xlabel="x along entrainment [µm]  (y = 0)", xlim=(x[0], x[-1]))
    for axes in (upper, lower):
        _mark_ends(axes, result, "white", 1.0)
    _name_surfaces(upper)
    bar = picture.colorbar(mesh, ax=[upper, lower], label="temperature rise [K]", pad=0.02)
    _rule(bar, lines, span)
    return picture


def _name_surfaces(axes: Axes) -> None:
    for word, place, side in (("surface 2", 0.97, "top"), ("surface 1", 0.03, "bottom")):
        axes.text(
            0.99,
            place,
            word,
            transform=axes.transAxes,
            ha="right",
            va=side,
            color="white",
            fontsize=8,
        )


def _refined(heat: FilmHeat, row: int, columns: slice, inlet: float) -> tuple[Array, Array]:
    """Return zeta and the rises on one row, on lines close enough to look smooth."""
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 (0.3 s)

    zeta = np.linspace(0.0, 1.0, _ACROSS)
    rise = np.nan_to_num(heat.temperature[:, row, columns] - inlet)
    return zeta, CubicSpline(heat.zeta, rise, axis=0)(zeta)


def _mark_ends(axes: Axes, result: Result, colour: str, width: float) -> None:
    """Mark where the Hertz contact begins and ends."""
    for side in (-1.0, 1.0):
        place = side * result.scales.half_width_x * MICRO
        axes.axvline(place, color=colour, lw=width, ls="--")


def surface_heat(result: Result) -> Figure:
    """Draw temperatures and the heat that flows into the solids along y = 0.

    Parameters
    ----------
    result : Result
        Of a thermal run.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels over x: temperature rises [K], heat fluxes into the solids [MW/m^2].
    """
    heat = heat_of(result)[0]
    row = int(np.argmin(np.abs(result.scaled.y)))
    x = result.x * MICRO
    picture = figure(result, (7.2, 6.6))
    upper, lower = picture.subplots(2, 1, sharex=True)
    temperature_lines(upper, x, (row, slice(None)), result)
    for flux, name, colour in ((heat.flux_1, "1", FIRST), (heat.flux_2, "2", SECOND)):
        lower.plot(x, flux[row] * 1e-6, color=colour, lw=1.4, label=f"into surface {name}")
    lower.set_ylabel("heat flux [MW/m²]")
    lower.axhline(0.0, color="0.6", lw=0.6)
    inside = span_part(result.scaled.x, *WINDOW[0])
    lower.set(xlabel="x along entrainment [µm]  (y = 0)", xlim=(x[inside][0], x[inside][-1]))
    for axes in (upper, lower):
        axes.grid(axis="y", lw=0.3)
        axes.legend(
            fontsize=8, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 0.98), ncols=4
        )
        _mark_ends(axes, result, "0.6", 0.8)
    return picture


def temperature_lines(
    axes: Axes, place: Array, line: tuple[int, slice] | tuple[slice, int], result: Result
) -> None:
    """Draw the rises of both surfaces, of the mid-film and of the mean along a grid line.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    place : array
        Coordinate along the line, in the unit of the axes.
    line : index
        The line in the fields.
    result : Result
        Of a thermal run.
    """
    heat, found = heat_of(result)
    for field, name, colour, style in (
        (found.mid_film, "mid-film", MIDDLE, "-"),
        (found.mean, "mean across film", MEAN, "--"),
        (heat.temperature[0], "surface 1", FIRST, "-"),
        (heat.temperature[-1], "surface 2", SECOND, "-"),
    ):
        axes.plot(place, field[line] - found.inlet, color=colour, ls=style, lw=1.3, label=name)
    axes.set_ylabel("temperature rise [K]")
