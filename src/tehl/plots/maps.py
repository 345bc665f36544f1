"""Maps of film thickness and pressure, and the pressure as a surface."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, NullFormatter, NullLocator

from tehl.plots.frame import (
    GIGA,
    MICRO,
    STEPS,
    colour_axes,
    contact_axes,
    entrainment_arrow,
    figure,
    legend_above,
    map_figure,
    nice_levels,
    span_part,
    window,
    window_part,
)
from tehl.result import Result
from tehl.typing import Array

_REACH = 1.4
_PROFILES = 45

_Levels = tuple[Array, Array]


def film_map(result: Result) -> Figure:
    """Draw the film thickness with labelled contour lines and the Hertz contact.

    Colours are logarithmic, from just below the minimum film to 1.6 times the central film, and
    contour lines lie close below 1.1 times the central film, so that the horseshoe and the side
    lobes show.

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
    x, y = window_places(result)
    film = result.film_thickness[part] * MICRO
    low, central = _film_range(result, film)
    bottom, top = 0.95 * low, 1.6 * central
    mesh = axes.pcolormesh(
        x, y, film.clip(bottom, top), shading="gouraud", norm=LogNorm(bottom, top), rasterized=True
    )
    _film_contours(axes, x, y, film, film_levels(low, central))
    legend_above(axes, *_mark_minimum(axes, result))
    entrainment_arrow(axes)
    bar = picture.colorbar(mesh, cax=colour_axes(axes), extend="max", label="film thickness h [µm]")
    ticks = nice_levels(low, top, 8)
    bar.ax.yaxis.set_minor_locator(NullLocator())
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    ticks = ticks[(ticks >= bottom) & (ticks <= top)]
    bar.ax.set_yticks(ticks, [f"{tick:.4g}" for tick in ticks], fontsize=8)
    return picture


def window_places(result: Result) -> tuple[Array, Array]:
    """Return x and y [um] of the nodes that :func:`window_part` shows."""
    rows, columns = window_part(result)
    return result.x[columns] * MICRO, result.y[rows] * MICRO


def slenderness(result: Result) -> float:
    """Return how many times as long across entrainment as along it the window is."""
    (west, east), (south, north) = window(result)
    return (north - south) / (east - west) * result.groups.ellipticity


def _film_contours(axes: Axes, x: Array, y: Array, film: Array, levels: _Levels) -> None:
    """Draw the contour lines; slender contacts have no room for labels."""
    inner, outer = levels
    lines = axes.contour(x, y, film, levels=inner, colors="white", linewidths=0.7)
    outside = axes.contour(x, y, film, levels=outer, colors="black", linewidths=0.5, alpha=0.6)
    if 0.5 < np.ptp(axes.get_ylim()) / np.ptp(axes.get_xlim()) < 2.0:
        axes.clabel(lines, inner[1::2], fontsize=7, fmt="%.3g")
        axes.clabel(outside, fontsize=7, fmt="%.3g")


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
    """Draw the pressure as a map with contour lines, named on the colour bar.

    Lines follow a slightly smoothed copy of the pressure.

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
    x, y = window_places(result)
    pressure = result.pressure[part] * GIGA
    mesh = axes.pcolormesh(x, y, pressure, shading="gouraud", cmap="cividis", rasterized=True)
    levels = _pressure_levels(pressure)
    lines = axes.contour(x, y, _smoothed(pressure), levels=levels, colors="black", linewidths=0.6)
    entrainment_arrow(axes)
    legend_above(axes)
    bar = picture.colorbar(mesh, cax=colour_axes(axes), label="pressure p [GPa]")
    if levels.size:
        bar.add_lines(lines)
    bar.set_ticks([0.0, *levels])
    return picture


def _smoothed(field: Array) -> Array:
    """Return ``field`` after a binomial filter of two nodes' reach.

    A ridge thinner than the nodes that carry it would else break into islands.
    """
    for axis in (0, 1):
        for _ in range(2):
            wide = np.pad(field, [(1, 1) if axis == side else (0, 0) for side in (0, 1)], "edge")
            count = field.shape[axis]
            below, here, above = (wide.take(range(i, i + count), axis) for i in range(3))
            field = 0.25 * below + 0.5 * here + 0.25 * above
    return field


def _pressure_levels(pressure: Array) -> Array:
    top = float(np.max(pressure, initial=0.0, where=np.isfinite(pressure)))
    levels = nice_levels(0.0, top if top > 0 else 1.0, 8)
    return levels[(levels > 0) & (levels < top)] if top > 0 else levels[1:]


def pressure_surface(result: Result) -> Figure:
    """Draw the pressure as profiles along x, one behind another, seen from the outlet.

    The profiles are rows of the stored field: nothing is interpolated, and the spike stands free.
    Wide contacts are shortened to 2.5 times their breadth, the axes tell.

    Parameters
    ----------
    result : Result
        What to draw.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, in micrometres and gigapascals.
    """
    picture = figure(result, (7.0, 5.4))
    axes: Any = picture.add_subplot(projection="3d", computed_zorder=False)
    columns = span_part(result.scaled.x, -_REACH, _REACH)
    every = np.arange(result.scaled.y.size)[span_part(result.scaled.y, -_REACH, _REACH)]
    rows = np.unique(np.linspace(every[0], every[-1], _PROFILES).round().astype(int))
    x, y = result.x[columns] * MICRO, result.y[rows] * MICRO
    pressure = np.nan_to_num(result.pressure[rows][:, columns] * GIGA)
    top = max(float(pressure.max()), 1e-9)
    axes.add_collection3d(_curtains(x, y, pressure))
    axes.set(xlim=x[[0, -1]], ylim=y[[0, -1]], zlim=(0.0, 1.02 * top))
    axes.set_xlabel("x [µm]", labelpad=3)
    axes.set_ylabel("y [µm]", labelpad=5)
    axes.set_zlabel("p [GPa]")
    wide = float(np.clip(np.ptp(y) / np.ptp(x), 0.4, 2.5))
    axes.set_box_aspect((1.0, wide, 0.62 * max(1.0, wide)), zoom=1.15 if wide < 2.0 else 0.98)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(4, steps=STEPS))
    axes.view_init(elev=27, azim=-52)
    return picture


def _curtains(x: Array, y: Array, pressure: Array) -> Any:
    """Return one polygon below each profile."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # noqa: PLC0415 (0.1 s)

    ends = np.concatenate([x[:1], x, x[-1:]])
    curtains = [
        np.column_stack([ends, np.full(ends.size, place), np.pad(row, 1)])
        for place, row in zip(y, pressure, strict=True)
    ]
    return Poly3DCollection(curtains, facecolors="#dbe6f2", edgecolors="#16325c", linewidths=0.6)
