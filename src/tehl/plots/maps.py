"""Maps of film thickness and pressure, and the pressure as a surface."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullFormatter, NullLocator

from tehl.plots.frame import (
    GIGA,
    MICRO,
    contact_axes,
    entrainment_arrow,
    figure,
    map_figure,
    window_part,
)
from tehl.result import Result
from tehl.typing import Array


def film_map(result: Result) -> Figure:
    """Draw the film thickness with labelled contour lines and the Hertz contact.

    Colours are logarithmic and end at three times the central film, contour lines lie close below
    1.1 times the central film, so that the horseshoe and the side lobes show.

    Parameters
    ----------
    result : Result
        What to draw.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, in micrometres.
    """
    picture = map_figure(result)
    axes = contact_axes(picture, result)
    part = window_part(result)
    x, y = result.x[part[1]] * MICRO, result.y[part[0]] * MICRO
    film = result.film_thickness[part] * MICRO
    low, central = _film_range(result, film)
    top = 3.0 * central
    mesh = axes.pcolormesh(
        x,
        y,
        np.clip(film, low, top),
        shading="gouraud",
        cmap="viridis",
        norm=LogNorm(low, top),
        rasterized=True,
    )
    inner, outer = film_levels(low, central)
    lines = axes.contour(x, y, film, levels=inner, colors="white", linewidths=0.7)
    axes.clabel(lines, inner[::2], fontsize=7, fmt="%.3g")
    outside = axes.contour(x, y, film, levels=outer, colors="black", linewidths=0.5, alpha=0.6)
    axes.clabel(outside, fontsize=7, fmt="%.3g")
    _mark_minimum(axes, result)
    entrainment_arrow(axes, "black")
    ticks = np.unique(np.concatenate([inner, outer]))
    bar = picture.colorbar(mesh, ax=axes, extend="max", label="film thickness h [µm]", ticks=ticks)
    bar.ax.yaxis.set_minor_locator(NullLocator())
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    bar.ax.set_yticks(ticks, [f"{tick:.4g}" for tick in ticks], fontsize=8)
    return picture


def _film_range(result: Result, film: Array) -> tuple[float, float]:
    """Return the smallest and the central film [um], positive even for a state that is no film."""
    central = result.film.central * MICRO
    positive = film[film > 0]
    if not central > 0:
        central = float(np.median(positive)) if positive.size else 1.0
    low = float(positive.min()) if positive.size else 0.1 * central
    return min(max(low, 0.02 * central), 0.95 * central), central


def film_levels(low: float, central: float) -> tuple[Array, Array]:
    """Return contour levels: close ones up to 1.1 central films, wide ones up to three.

    Parameters
    ----------
    low, central : float
        Smallest and central film, in any unit.
    """
    fine = _nice(low, 1.1 * central, 7)
    inner = fine[(fine > low) & (fine <= 1.1 * central)]
    wide = _nice(1.1 * central, 3.0 * central, 5)
    outer = wide[(wide > 1.1 * central) & (wide <= 3.0 * central)]
    return inner, outer


def _nice(low: float, high: float, count: int) -> Array:
    locator = MaxNLocator(count, steps=[1, 2, 2.5, 5, 10])
    return np.asarray(locator.tick_values(low, high), dtype=np.float64)


def _mark_minimum(axes: Axes, result: Result) -> None:
    x, y = result.film_scaled.minimum_at
    place = (x * result.scales.half_width_x * MICRO, y * result.scales.half_width_y * MICRO)
    axes.plot(
        *place, marker="+", color="red", ms=9, mew=1.6, zorder=7, label="$h_{min}$", ls="none"
    )
    axes.legend(loc="upper left", fontsize=8, framealpha=0.8)


def pressure_map(result: Result) -> Figure:
    """Draw the pressure as a map with contour lines and the Hertz contact.

    Parameters
    ----------
    result : Result
        What to draw.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, in micrometres and gigapascals.
    """
    picture = map_figure(result)
    axes = contact_axes(picture, result)
    part = window_part(result)
    x, y = result.x[part[1]] * MICRO, result.y[part[0]] * MICRO
    pressure = result.pressure[part] * GIGA
    mesh = axes.pcolormesh(x, y, pressure, shading="gouraud", cmap="cividis", rasterized=True)
    lines = axes.contour(
        x, y, pressure, levels=_pressure_levels(pressure), colors="black", linewidths=0.5
    )
    axes.clabel(lines, fontsize=7, fmt="%.3g")
    entrainment_arrow(axes)
    picture.colorbar(mesh, ax=axes, label="pressure p [GPa]")
    return picture


def _pressure_levels(pressure: Array) -> Array:
    top = float(np.max(pressure, initial=0.0, where=np.isfinite(pressure)))
    levels = _nice(0.0, top if top > 0 else 1.0, 8)
    return levels[(levels > 0) & (levels < top)] if top > 0 else levels[1:]


def pressure_surface(result: Result) -> Figure:
    """Draw the pressure as a surface, seen from the outlet, where the spike stands.

    Parameters
    ----------
    result : Result
        What to draw.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, in micrometres and gigapascals.
    """
    picture = figure(result, (7.0, 5.2))
    axes: Any = picture.add_subplot(projection="3d", computed_zorder=False)
    part = window_part(result)
    x, y = np.meshgrid(result.x[part[1]] * MICRO, result.y[part[0]] * MICRO)
    axes.plot_surface(
        x,
        y,
        result.pressure[part] * GIGA,
        cmap="cividis",
        rcount=120,
        ccount=120,
        linewidth=0.15,
        edgecolor=(0.0, 0.0, 0.0, 0.45),
        rasterized=True,
    )
    axes.set(xlabel="x along entrainment [µm]", ylabel="y [µm]", zlabel="p [GPa]")
    height = 0.5 * max(np.ptp(x), np.ptp(y))
    axes.set_box_aspect((np.ptp(x), np.ptp(y), height), zoom=1.1)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(4))
    axes.view_init(elev=26, azim=-40)
    return picture
