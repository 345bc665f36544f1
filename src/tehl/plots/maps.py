"""Maps of film, pressures, shear stress, heights and ripples, with the Hertz contact."""

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, NullFormatter, NullLocator

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.plots.arrows import MICRO, entrainment_arrow, sliding_arrows
from tehl.plots.frame import (
    GIGA,
    MAP,
    STEPS,
    colour_bar,
    dress_contact,
    figure,
    figure_of,
    film_span,
    inner_levels,
    legend_above,
    length,
    map_axes,
    mark_levels,
    minimum_places,
    nice_levels,
    pressure_top,
    shape,
    window_part,
    window_places,
)
from tehl.post.boundary_contact import touching, touching_nodes
from tehl.post.micro_film import micro_film
from tehl.post.roughness import in_contact, rough_film
from tehl.post.summits import load_sharing
from tehl.post.traction import traction as traction_of
from tehl.result.fields import SurfaceHeights
from tehl.result.solution import Solution

FILTERED = 0.75
"""Half-widths within which filtered ripples are shown: the filter smears the rim of the contact."""
_SHOWN = (0.5, 99.5)
"""Percentiles of the heights between which colours change."""
_OUTSIDE = "#e8e8e4"
"""Colour of films beyond the scale: most of a map is the gap around the contact."""
_LEAST_SHOWN = 400
"""Least places of colours along one direction of a map of the film."""
_LINES: dict[str, Any] = {"colors": "black", "linewidths": 0.6}


def film_map(result: Solution, *, ax: Axes | None = None, title: bool | None = True) -> Figure:
    """Draw the film thickness with labelled contour lines and the Hertz contact.

    Colours are logarithmic, from just below the minimum film to 1.6 times the central film; the gap
    around the contact, where the film is thicker, is grey, and
    contour lines lie close below 1.1 times the central film, so that the horseshoe and the side
    lobes show.

    Parameters
    ----------
    result : Solution
        Values that are not finite are left blank.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.
    """
    axes = map_axes(result, ax=ax, title=title)
    places, film = window_places(result), result.film_thickness[window_part(result)] * MICRO
    low, central = film_span(film, result.film.central * MICRO)
    bottom, top = 0.95 * low, 1.6 * central
    norm = LogNorm(bottom, top)
    colours = colormaps["viridis"].with_extremes(over=_OUTSIDE)
    shown = _finer(*places, np.log(film.clip(min=bottom)))
    mesh = _image(axes, *shown, norm=norm, cmap=colours)
    inner, outer = film_levels(low, central)
    lines = axes.contour(*places, film, levels=inner, colors="white", linewidths=0.7)
    outside = axes.contour(*places, film, levels=outer, colors="black", linewidths=0.5, alpha=0.6)
    if 0.5 < shape(result) < 2.0:  # slender contacts have no room for labels
        axes.clabel(lines, inner[1::2], fontsize=7, fmt="%.3g")
        axes.clabel(outside, fontsize=7, fmt="%.3g")
    legend_above(axes, *_mark_minimum(axes, result))
    bar = colour_bar(axes, mesh, "film thickness h [µm]", extend="max")
    bar.ax.yaxis.set_minor_locator(NullLocator())
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    ticks = nice_levels((low, top), 8)
    ticks = ticks[(ticks >= bottom) & (ticks <= top)]
    bar.ax.set_yticks(ticks, [f"{tick:.4g}" for tick in ticks], fontsize=8)
    return figure_of(axes)


def _finer(x: Array, y: Array, field: Array) -> tuple[Array, Array, Array]:
    """Return a field at `_LEAST_SHOWN` places or more along x and y, linear between its nodes.

    Colours of coarse grids would fade from node to node where the scale ends.
    """
    fine = []
    for axis in (x, y):
        times = -(-_LEAST_SHOWN // axis.size)
        fine.append(np.linspace(axis[0], axis[-1], times * (axis.size - 1) + 1))
    rows = np.array([np.interp(fine[0], x, row) for row in field])
    return *fine, np.array([np.interp(fine[1], y, column) for column in rows.T]).T  # type: ignore[return-value]


def _image(axes: Axes, x: Array, y: Array, field: Array, **style: Any) -> AxesImage:
    """Draw the exponential of a field at even places as an image: quick, for any of their number.

    Colours between places follow from values between, not from their colours.
    """
    (left, right), (bottom, top) = (
        (axis[0] - 0.5 * (axis[1] - axis[0]), axis[-1] + 0.5 * (axis[1] - axis[0]))
        for axis in (x, y)
    )
    limits = axes.get_xlim(), axes.get_ylim()
    image = axes.imshow(
        np.exp(field),
        extent=(left, right, bottom, top),
        origin="lower",
        aspect=axes.get_aspect(),
        interpolation="bilinear",
        interpolation_stage="data",
        **style,
    )
    axes.set(xlim=limits[0], ylim=limits[1])
    return image


def film_levels(low: float, central: float) -> tuple[Array, Array]:
    """Return contour levels: close ones up to 1.1 central films, wide ones up to three.

    Parameters
    ----------
    low, central : float
        Minimum and central film, in the unit of the map.

    Returns
    -------
    close, wide : Array
        Levels for thick and for thin contour lines.
    """
    middle, top = 1.1 * central, 3.0 * central
    fine, wide = nice_levels((low, middle), 6), nice_levels((middle, top), 5)
    return fine[(fine > low) & (fine <= middle)], wide[(wide > middle) & (wide <= top)]


def _mark_minimum(axes: Axes, result: Solution) -> list[Line2D]:
    """Mark the minimum film, on both sides of a symmetric contact; return the marks."""
    widths = np.array([result.scales.half_width_x, result.scales.half_width_y]) * MICRO
    places = widths * np.array(minimum_places(result)).reshape(-1, 2)
    if not places.size:
        return []
    return axes.plot(*places.T, "r+", ms=6, mew=1.3, zorder=7, label="minimum film")


def pressure_map(result: Solution, *, ax: Axes | None = None, title: bool | None = True) -> Figure:
    """Draw the pressure [GPa] as a map with contour lines, marked on the colour bar.

    Lines follow a slightly smoothed copy of the pressure.

    Parameters
    ----------
    result : Solution
        The colours have the pressure of the nodes.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.
    """
    places, pressure = window_places(result), result.pressure[window_part(result)] * GIGA
    top = pressure_top(result) * GIGA
    levels = nice_levels((0.0, top if top > 0 else 1.0), 8)
    levels = levels[(levels > 0) & (levels < top)] if top > 0 else levels[1:]
    axes = map_axes(result, ax=ax, title=title)
    scale: dict[str, Any] = {"cmap": "cividis", "vmin": 0.0, "vmax": top or None}
    mesh = axes.pcolormesh(*places, pressure, **scale, **MAP)
    lines = axes.contour(*places, _smoothed(pressure), levels=levels, **_LINES)
    above = "max" if np.nan_to_num(pressure).max() > top else "neither"
    mark_levels(colour_bar(axes, mesh, "pressure p [GPa]", extend=above), lines)
    return figure_of(axes)


def _smoothed(field: Array) -> Array:
    """Return ``field`` after two binomial filters [1, 2, 1] / 4 along each axis.

    The contour lines of a ridge narrower than a few nodes would otherwise break into islands.
    """
    for _ in range(4):  # along one axis, then the other
        wide = np.pad(field, ((0, 0), (1, 1)), "edge")
        field = (0.25 * wide[:, :-2] + 0.5 * field + 0.25 * wide[:, 2:]).T
    return field


def shear_stress_map(
    result: Solution, *, ax: Axes | None = None, title: bool | None = True
) -> Figure:
    """Draw the magnitude of the shear stress at mid-film [MPa] as a map.

    Parameters
    ----------
    result : Solution
        Its ``shear`` has the stresses at mid-film [Pa].
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.

    Raises
    ------
    InputError
        If the result has no shear stresses.
    """
    shear, traction = result.shear, traction_of(result)
    if shear is None or traction is None:
        raise InputError("the result has no shear stresses to draw")
    note = (
        f"SRR = {result.problem.slide_roll_ratio:.4g}; traction {traction.mid_film:.4g} "
        f"at mid-film, {traction.surface_1:.4g} and {traction.surface_2:.4g} on surfaces 1 and 2"
    )
    if traction.across is not None:
        note += f"\nacross {traction.across:.4g}; orange: sliding of surface 1 over surface 2"
    if traction.drilling_moment is not None:
        note += f"; drilling moment {1e3 * traction.drilling_moment:.4g} N mm"
    stress = np.hypot(shear.mid_film, shear.across) * 1e-6
    label = "magnitude of the shear stress at mid-film [MPa]"
    axes = map_axes(result, note, ax=ax, title=title)
    sliding_arrows(axes, result)
    return _map_from_zero(axes, result, stress, label, lined=True)


def asperity_map(result: Solution, *, ax: Axes | None = None, title: bool | None = True) -> Figure:
    """Draw the pressure of the asperities [MPa] as a map, averaged over many of them.

    Raises InputError if the case has none.
    """
    found, shared = result.asperities, load_sharing(result)
    if found is None or shared is None:
        raise InputError("the result has no asperities to draw: the case states none, or diverged")
    note = (
        f"asperities carry {100 * shared.share:.3g} % of the load on "
        f"{100 * shared.area_part:.2g} % of the Hertz area"
    )
    axes, pressure = map_axes(result, note, ax=ax, title=title), found.pressure * 1e-6
    return _map_from_zero(axes, result, pressure, "pressure of the asperities [MPa]")


def contact_map(result: Solution, *, ax: Axes | None = None, title: bool | None = True) -> Figure:
    """Draw the pressure of film and contact together [GPa] where the surfaces touch, as a map.

    Raises InputError if the case states no boundary film.
    """
    found, shared = result.contact, touching(result)
    if found is None or shared is None:
        raise InputError("the result has no contact to draw: the case states none, or diverged")
    note = f"the surfaces touch on {100 * shared.area_part:.2g} % of the Hertz area"
    if shared.patches is None:
        note = "the surfaces touch nowhere"
    both = np.where(touching_nodes(result), (result.pressure + found.pressure) * 1e-9, np.nan)
    axes = map_axes(result, note, ax=ax, title=title)
    return _map_from_zero(axes, result, both, "pressure where surfaces touch [GPa]")


def _map_from_zero(
    axes: Axes, result: Solution, field: Array, label: str, *, lined: bool = False
) -> Figure:
    """Draw a field of zero and above as a map, with contour lines or without."""
    places, shown = window_places(result), field[window_part(result)]
    top = float(np.max(shown, initial=0.0, where=np.isfinite(shown)))
    span = (0.0, top if top > 0 else 1.0)
    mesh = axes.pcolormesh(*places, shown, cmap="cividis", clim=span, **MAP)
    bar = colour_bar(axes, mesh, label)
    if lined:
        mark_levels(bar, axes.contour(*places, shown, levels=inner_levels((0.0, top)), **_LINES))
    return figure_of(axes)


def heights_of(result: Solution) -> SurfaceHeights:
    """Return the heights of a rough contact, which the pictures of roughness need."""
    if result.heights is None:
        raise InputError("both surfaces are smooth: there are no heights to draw")
    return result.heights


def heights_map(result: Solution, *, ax: Axes | None = None, title: bool | None = True) -> Figure:
    """Draw the heights of both surfaces together [nm], as the grid carries them.

    Peaks narrow the film.

    Parameters
    ----------
    result : Solution
        With at least one rough surface.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.

    Raises
    ------
    InputError
        If both surfaces are smooth.
    """
    heights = heights_of(result).together[window_part(result)] * 1e9
    found, note = rough_film(result), ""
    if found is not None:
        sq = length(found.composite)
        note = f"Sq = {sq} of both surfaces, λ = {found.lambda_central:.3g}"
    axes = map_axes(result, note, ax=ax, title=title)
    low, high = (float(value) for value in np.percentile(heights, _SHOWN))
    low, high = (low, high) if high > low else (low - 0.5, high + 0.5)
    mesh = axes.pcolormesh(*window_places(result), heights, clim=(low, high), **MAP)
    slack = 1e-3 * (high - low)
    ends = {(True, True): "both", (True, False): "min", (False, True): "max"}
    beyond = ends.get((bool(heights.min() < low - slack), bool(heights.max() > high + slack)))
    label = "height of both surfaces, outwards [nm]"
    colour_bar(axes, mesh, label, extend=beyond or "neither")
    return figure_of(axes)


def micro_film_map(
    result: Solution, smooth: Solution | None = None, *, title: bool | None = True
) -> Figure:
    """Draw the ripples of film [nm] and pressure [MPa] side by side.

    Colours span the ripples in the Hertz contact.

    Parameters
    ----------
    result : Solution
        With at least one rough surface.
    smooth : Solution or None
        Reference run to subtract; without it long waves are filtered off, and the ripples at
        the rim of the contact and beyond are left blank.
    title : bool or None
        Whether the figure has a title.

    Raises
    ------
    InputError
        If both surfaces are smooth, or the reference run has another grid.
    """
    heights_of(result)
    ripples = micro_film(result, smooth)
    contact = in_contact(result, 1.0 if ripples.by_reference else FILTERED)
    part, places = window_part(result), window_places(result)
    side_by_side = shape(result) > 0.5
    picture = figure(result, (9.6, 5.2) if side_by_side else (6.4, 6.4), title=title)
    panels = picture.subplots(*((1, 2) if side_by_side else (2, 1)))
    less = "less that of smooth surfaces" if ripples.by_reference else "less its long waves"
    for axes, name, values, unit in (
        (panels[0], "film", ripples.film * 1e9, "nm"),
        (panels[1], "pressure", ripples.pressure * 1e-6, "MPa"),
    ):
        reach = float(np.percentile(np.abs(values[contact]), 99.0)) or 1.0
        shown = values if ripples.by_reference else np.where(contact, values, np.nan)
        dress_contact(axes, result)
        style = {"cmap": "RdBu_r", "clim": (-reach, reach), **MAP}
        mesh = axes.pcolormesh(*places, shown[part], **style)
        axes.set_title(f"{name} {less}", fontsize=9)
        axes.xaxis.set_major_locator(MaxNLocator(5, steps=STEPS))
        bar: dict[str, Any] = {"extend": "both", "shrink": 0.9, "aspect": 32}
        picture.colorbar(mesh, ax=axes, location="bottom", label=f"{name} ripple [{unit}]", **bar)
        entrainment_arrow(axes)
    if side_by_side:
        panels[1].set_ylabel("")
    return picture
