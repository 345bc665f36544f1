"""Curves of a film: centre lines, profiles of the pressure, distribution of the film."""

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from tehl.base.errors import InputError
from tehl.plots.arrows import MICRO
from tehl.plots.frame import (
    ALONG_X,
    FILM,
    GIGA,
    GREEN,
    PLAIN,
    PRESSURE,
    STEPS,
    WINDOW,
    figure,
    figure_of,
    pressure_label,
    pressure_top,
    single,
    span_part,
)
from tehl.plots.maps import FILTERED, heights_of
from tehl.plots.temperature import Line, rises
from tehl.post.film import Profile, profile_x, profile_y
from tehl.post.micro_film import micro_film
from tehl.post.roughness import film_histogram, rough_film
from tehl.post.stress.loads import whole_pressure
from tehl.result.solution import Solution

_AROUND = (-1.4, 1.4)
"""Part of both axes with profiles of the pressure [half-widths]."""


def centre_lines(result: Solution, *, title: bool | None = True) -> Figure:
    """Draw pressure and film along x (y = 0) and along y (x = 0), with the dry contact dashed.

    A line contact has them along x alone. Pressure [GPa] and film [um] share the x axis; a thermal
    run has two more panels beside them, with the temperature rises [K].

    Parameters
    ----------
    result : Solution
        Isothermal or thermal.
    title : bool or None
        Whether the figure has a title.
    """
    thermal = result.heat is not None
    rows = 1 if result.problem.contact.is_line else 2
    size = (12.4 if thermal else 7.2, 4.4 if rows == 1 else 7.2)
    picture = figure(result, size, title=title)
    grid = picture.subplots(rows, 2 if thermal else 1, squeeze=False)
    row, column = result.scaled.centre
    lines: tuple[Line, ...] = ((row, slice(None)), (slice(None), column))[:rows]
    profiles = (profile_x(result), *([profile_y(result)] if rows == 2 else []))
    for panels, profile, (low, high), line in zip(
        grid, profiles, WINDOW[:rows], lines, strict=True
    ):
        place, scaled = profile.coordinate * MICRO, profile.scaled_coordinate
        curves = [_pressure_and_film(panels[0], result, profile, line)]
        if thermal:
            for rise, style in rises(result, line):
                panels[1].plot(place, rise, **style)
            panels[1].set_ylabel("temperature rise [K]")
            panels[1].grid(axis="y", lw=0.3)
            curves.append(panels[1].lines)
        shown = place[(scaled >= low) & (scaled <= high)]
        for axes in panels:
            axes.set_xlim(shown[0], shown[-1])
    for stacked, handles in zip(grid.T, curves, strict=True):
        upper, lower = stacked[0], stacked[-1]
        lower.set_xlabel("y [µm]  (x = 0)")
        upper.set_xlabel("x along entrainment [µm]" if rows == 1 else ALONG_X)
        below: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.15)}
        lower.legend(handles=handles, ncols=5, **below, **PLAIN)
    return picture


def _pressure_and_film(axes: Axes, result: Solution, profile: Profile, line: Line) -> list[Any]:
    """Draw pressure, film, and the oil in it along a line; return the curves."""
    place, film = profile.coordinate * MICRO, axes.twinx()
    dry: dict[str, Any] = {"color": "0.45", "lw": 1.0, "ls": "--", "label": "dry Hertz"}
    axes.plot(place, profile.hertz_pressure * GIGA, **dry)
    touches = result.contact is not None or result.asperities is not None
    if touches:
        whole: dict[str, Any] = {"color": PRESSURE, "lw": 0.9, "ls": "-.", "label": "with solids"}
        axes.plot(place, whole_pressure(result)[line] * GIGA, **whole)
    name = "pressure of the oil" if touches else "pressure"
    axes.plot(place, profile.pressure * GIGA, color=PRESSURE, lw=1.4, label=name)
    axes.set_ylabel(pressure_label(result, "pressure p [GPa]"), color=PRESSURE)
    axes.set_ylim(bottom=0.0)
    if result.errors is not None and not result.errors.pressure_has_limit:
        axes.set_ylim(top=1.05 * pressure_top(result) * GIGA)
    film.plot(place, profile.dry_gap * MICRO, color=FILM, lw=0.8, ls=":", label="dry gap")
    film.plot(place, profile.film_thickness * MICRO, color=FILM, lw=1.4, label="film")
    if result.oil is not None:
        oil = result.oil.fill[line] * profile.film_thickness * MICRO
        film.fill_between(place, oil, color=FILM, alpha=0.15, linewidth=0.0, label="oil")
    _show_film_behind(axes, film, result, 4.0)
    return [*axes.lines, *film.lines, *film.collections]


def _show_film_behind(axes: Axes, film: Axes, result: Solution, most: float) -> None:
    """Give drawn axes of the film [um] up to ``most`` central films, behind the pressure's."""
    film.set_ylabel("film h [µm]", color=FILM)
    central = result.film.central * MICRO
    film.set_ylim(0.0, most * central if central > 0 else None)
    axes.set_zorder(film.get_zorder() + 1)
    axes.patch.set_visible(False)


def rough_centre_line(
    result: Solution, smooth: Solution | None = None, *, title: bool | None = True
) -> Figure:
    """Draw pressure, film and the surfaces along y = 0.

    The upper panel has pressure [GPa] and film [um], the lower one the undeformed heights beside
    the ripple of the film [nm].

    Parameters
    ----------
    result : Solution
        Film between rough surfaces.
    smooth : Solution or None
        Smooth reference run on the same grid, drawn thin.
    title : bool or None
        Whether the figure has a title.

    Raises
    ------
    InputError
        If both surfaces are smooth.
    """
    heights, row = heights_of(result).together, result.scaled.centre[0]
    # half-widths on each side
    inside = np.abs(result.scaled.x) <= 1.25
    place = result.x[inside] * MICRO
    picture = figure(result, (7.6, 7.0), title=title)
    upper, lower = picture.subplots(2, 1, sharex=True, height_ratios=[1.5, 1.0])
    dry = result.groups.shape.dry_pressure(result.scaled.x[inside], result.scaled.y[row])
    upper.plot(place, dry * result.scales.hertz_pressure * GIGA, color="0.45", ls="--", lw=1.0)
    film = upper.twinx()
    for one, width in ((result, 1.4), *([(smooth, 0.7)] if smooth else [])):
        upper.plot(place, one.pressure[row, inside] * GIGA, color=PRESSURE, lw=width)
        film.plot(place, one.film_thickness[row, inside] * MICRO, color=FILM, lw=width)
    upper.set_ylabel("pressure p [GPa], dashed: dry Hertz", color=PRESSURE)
    upper.set_ylim(bottom=0.0)
    _show_film_behind(upper, film, result, 3.0)
    if smooth is not None:
        upper.set_title("thin lines: smooth surfaces", fontsize=8)
    gap = "gap left by undeformed heights (-s)"
    lower.plot(place, -heights[row, inside] * 1e9, color=GREEN, lw=1.2, label=gap)
    lower.axhline(0.0, color="0.6", lw=0.6)
    shown = np.abs(result.scaled.x[inside]) < (FILTERED if smooth is None else 1.0)
    ripple = np.where(shown, micro_film(result, smooth).film[row, inside] * 1e9, np.nan)
    lower.plot(place, ripple, color=FILM, lw=1.2, label="ripple of the film")
    lower.set(xlabel=ALONG_X, ylabel="heights and ripple [nm]", xlim=(place[0], place[-1]))
    lower.legend(loc="upper left", bbox_to_anchor=(0.0, -0.22), ncols=2, **PLAIN)
    return picture


def film_distribution(
    result: Solution, *, ax: Axes | None = None, title: bool | None = True
) -> Figure:
    """Draw the distribution of the film thickness over the Hertz contact.

    Beside the histogram are the part of the contact that has a thinner film, and Sq.

    Parameters
    ----------
    result : Solution
        With roughness or ``rms_roughness``.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.

    Raises
    ------
    InputError
        If the result has neither, or no film.
    """
    found = rough_film(result)
    if found is None:
        raise InputError("the result has no film between rough surfaces to draw")
    edges, share = film_histogram(result)
    below = 100.0 * np.concatenate([[0.0], np.cumsum(share * np.diff(edges))])
    edges, share = edges * 1e9, share * 1e-9
    axes = single(result, (6.8, 4.6), ax=ax, title=title)
    axes.stairs(share, edges, fill=True, color="#9db8dc")
    axes.set(xlabel="film thickness h [nm]", ylabel="part of the contact by film [1/nm]")
    axes.set_xlim(float(edges[0]), float(edges[-1]))
    axes.axvline(found.composite * 1e9, color=FILM, lw=1.2, ls="--", label="Sq of both surfaces")
    thinner = axes.twinx()
    thinner.plot(edges, below, color=PRESSURE, lw=1.3)
    thinner.set_ylabel("part with a thinner film [%]", color=PRESSURE)
    thinner.set_ylim(0.0, 100.0)
    median = dict(found.quantiles)[0.5]
    if math.isfinite(median):
        axes.axvline(median * 1e9, color="0.3", lw=1.0, label="median film")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, **PLAIN)
    return figure_of(axes)


def pressure_surface(result: Solution, *, title: bool | None = True) -> Figure:
    """Draw the pressure as profiles along x, one behind another, seen from the outlet.

    The profiles are rows of the stored field: nothing is interpolated, and the spike stands free.
    Wide contacts are drawn at most 2.5 times as wide as long; the axes show the true size.

    Parameters
    ----------
    result : Solution
        At most `_PROFILES` of its rows are drawn.
    title : bool or None
        Whether the figure has a title.
    """
    picture = figure(result, (7.0, 5.4), title=title)
    axes: Any = picture.add_subplot(projection="3d", computed_zorder=False)
    columns = span_part(result.scaled.x, _AROUND)
    every = np.arange(result.scaled.y.size)[span_part(result.scaled.y, _AROUND)]
    rows = np.unique(np.linspace(every[0], every[-1], 45).round().astype(int))
    x, y = result.x[columns] * MICRO, result.y[rows] * MICRO
    top = max(pressure_top(result) * GIGA, 1e-9)
    pressure = np.minimum(np.nan_to_num(result.pressure[rows][:, columns] * GIGA), 1.02 * top)
    ends = np.concatenate([x[:1], x, x[-1:]])
    curtains = [
        np.column_stack([ends, np.full(ends.size, place), np.pad(row, 1)])
        for place, row in zip(y, pressure, strict=True)
    ]
    style: dict[str, Any] = {"facecolors": "#dbe6f2", "edgecolors": "#16325c", "linewidths": 0.6}
    axes.add_collection3d(Poly3DCollection(curtains, **style))
    axes.set(xlim=x[[0, -1]], ylim=y[[0, -1]], zlim=(0.0, 1.02 * top))
    axes.set_xlabel("x [µm]", labelpad=3)
    axes.set_ylabel("y [µm]", labelpad=5)
    axes.set_zlabel(pressure_label(result, "p [GPa]"))
    wide = float(np.clip(np.ptp(y) / np.ptp(x), 0.4, 2.5))
    axes.set_box_aspect((1.0, wide, 0.62 * max(1.0, wide)), zoom=1.15 if wide < 2.0 else 0.98)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(4, steps=STEPS))
    axes.view_init(elev=27, azim=-52)
    return picture
