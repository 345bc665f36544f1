"""Surfaces in space over X and Y: film, pressure, temperature."""

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from tehl.plots.frame import STEPS
from tehl.reproduce.book import Book
from tehl.reproduce.draw.mesh import Profiles, Surface, profiles, round_mesh
from tehl.reproduce.draw.sheet import (
    SPATIAL,
    Panel,
    Sheet,
    film_note,
    panel_title,
    panels_of,
    shape,
)
from tehl.reproduce.draw.trends import draw_trend
from tehl.reproduce.figures import FigureSpec
from tehl.typing import Array

_X, _Y = (-1.6, 1.3), (-1.25, 1.25)
_LID = 1.5
"""Film over central film at which it is cut off."""
_HEIGHT = 1.55
"""Of the box, in half-widths."""
_LIGHT = np.array([0.35, -0.5, 0.8]) / np.linalg.norm([0.35, -0.5, 0.8])
_SHADE = 0.45
"""Part of the brightness that the light decides."""


def surfaces(spec: FigureSpec, book: Book) -> Figure:
    """Draw a figure of surfaces."""
    panels = panels_of(spec, book)
    page = Sheet(spec, book, shape(len(panels)), SPATIAL)
    draw = _DRAW[spec.kind]
    for place, panel in enumerate(panels):
        draw(page.axes(place, projection="3d"), panel, book)
    if len(panels) < page.rows * page.columns:
        draw_trend(page.spare(), spec, book)
    return page.picture


def _film(axes: Any, panel: Panel, book: Book) -> None:
    """Draw the film upside down: what is thin stands up."""
    top = _LID * max(panel.measures.film.central, 1e-3)
    scaled = panel.result.scaled
    found = round_mesh(scaled.x, scaled.y, scaled.film.clip(None, top))
    low = min(float(found.z.min()), 0.9 * top)
    _surface(axes, found, "viridis", (low, top))
    axes.set_zlim(1.02 * top, min(0.0, low))
    axes.set_zlabel("H, downwards", labelpad=-1)
    axes.view_init(elev=33, azim=-50)
    panel_title(axes, panel, book, film_note(panel.measures))


def _pressure(axes: Any, panel: Panel, book: Book) -> None:
    scaled, numbers = panel.result.scaled, panel.measures.pressure
    wavy = book.series[panel.run.series].is_rough
    _curtains(axes, profiles(scaled.x, scaled.y, scaled.pressure, (_X, _Y)), "cividis")
    axes.set_zlabel("P", labelpad=-3)
    axes.view_init(elev=27, azim=-58)
    note = f"$P_{{max}}$ = {numbers.largest:.3f}"
    if numbers.spike > 0 and not wavy:
        note += f",  at Y = 0 spike {numbers.spike:.3f} at X = {numbers.spike_at:.2f}"
    panel_title(axes, panel, book, note)


def _temperature(axes: Any, panel: Panel, book: Book) -> None:
    temperature, warmth = panel.result.temperature, panel.measures.warmth
    if temperature is None or warmth is None:
        return
    scaled, rise = panel.result.scaled, temperature.mid_film - temperature.inlet
    _curtains(axes, profiles(scaled.x, scaled.y, rise, (_X, _Y)), "inferno")
    axes.set_zlabel("rise [K]", labelpad=-1)
    axes.view_init(elev=27, azim=-58)
    note = f"at most {warmth.mid_film:.3g} K, at the centre {warmth.central:.3g} K"
    panel_title(axes, panel, book, note)


_DRAW = {
    "film-surface": _film,
    "pressure-surface": _pressure,
    "temperature-surface": _temperature,
}


def _curtains(axes: Any, found: Profiles, colours: str) -> None:
    """Draw rows one behind another, each as a curtain coloured by its height."""
    low, top = min(float(found.z.min()), 0.0), max(float(found.z.max()), 1e-9)
    ends = np.concatenate([found.x[:1], found.x, found.x[-1:]])
    curtains = [
        np.column_stack([ends, np.full(ends.size, at), np.pad(row, 1)])
        for at, row in zip(found.y, found.z, strict=True)
    ]
    heights = Normalize(low, top)(found.z.max(axis=1))
    faces = 0.8 * colormaps[colours](heights)[:, :3] + 0.2
    axes.add_collection3d(
        Poly3DCollection(curtains, facecolors=faces, edgecolors="0.15", linewidths=0.45)
    )
    axes.set_zlim(low, 1.02 * top)
    _dress(axes)


def _surface(axes: Any, found: Surface, colours: str, span: tuple[float, float]) -> None:
    """Draw one lit surface."""
    paint = colormaps[colours](Normalize(*span)(found.z))[..., :3]
    light = _brightness(found, _HEIGHT / max(span[1] - span[0], 1e-12))
    axes.plot_surface(
        found.x,
        found.y,
        found.z,
        facecolors=np.clip(paint * light[..., None], 0.0, 1.0),
        rstride=1,
        cstride=1,
        linewidth=0,
        antialiased=False,
        shade=False,
        rasterized=True,
    )
    _dress(axes)


def _dress(axes: Any) -> None:
    axes.set(xlim=_X, ylim=_Y)
    axes.set_xlabel("X", labelpad=-4)
    axes.set_ylabel("Y", labelpad=-4)
    axes.set_box_aspect((np.ptp(_X), np.ptp(_Y), _HEIGHT), zoom=1.18)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(4, steps=STEPS))
    axes.tick_params(labelsize=7, pad=-1)


def _brightness(found: Surface, stretch: float) -> Array:
    """Return how bright each node is under the light, about one on flat ground."""
    points = np.stack([found.x, found.y, stretch * found.z], axis=-1)
    normal = np.cross(np.gradient(points, axis=1), np.gradient(points, axis=0))
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True) + 1e-30
    normal *= np.where(normal[..., 2:] < 0.0, -1.0, 1.0)
    lit = np.maximum(normal @ _LIGHT, 0.0) / _LIGHT[2]
    return np.asarray(1.0 - _SHADE + _SHADE * _calm(lit))


def _calm(light: Array) -> Array:
    """Return the light averaged over neighbours: a crest has no direction of its own."""
    for axis in (0, 1):
        wide = np.pad(light, [(1, 1) if axis == side else (0, 0) for side in (0, 1)], "edge")
        count = light.shape[axis]
        below, here, above = (wide.take(range(k, k + count), axis) for k in range(3))
        light = 0.25 * below + 0.5 * here + 0.25 * above
    return np.minimum(light, 1.15)
