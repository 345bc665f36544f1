"""Temperatures of both surfaces and of the middle of the film."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tehl.plots.frame import span_part
from tehl.reproduce.book import Book
from tehl.reproduce.draw.sheet import (
    LAYERS,
    WINDOW,
    Panel,
    Sheet,
    draw_map,
    dress_map,
    panel_title,
    panels_of,
)
from tehl.reproduce.figures import FigureSpec
from tehl.reproduce.measures import centre_line
from tehl.typing import Array

_NAMES = ("layer 1: surface 1", "layer 2: surface 2", "layer 3: mid-film")
_COLOURS = ("#1f4e9c", "#2a9d8f", "#c2410c")


def layers(spec: FigureSpec, book: Book) -> Figure:
    """Draw a figure of layer temperatures: a column per panel, a row per layer, and lines."""
    panels = panels_of(spec, book)
    page = Sheet(spec, book, (len(_NAMES) + 1, len(panels)), LAYERS)
    for column, panel in enumerate(panels):
        rises = _rises(panel)
        for row, rise in enumerate(rises):
            place = row * len(panels) + column
            axes = _map(page, place, panel, rise)
            if row == 0:
                panel_title(axes, panel, book, _note(panel))
            if column == 0:
                axes.set_ylabel(f"{_NAMES[row]}\nY")
        axes = page.axes(len(_NAMES) * len(panels) + column)
        _lines(axes, panel, rises)
        if column == 0:
            axes.legend(fontsize=7, frameon=False, loc="upper left")
            axes.set_ylabel("rise [K]")
    return page.picture


def _rises(panel: Panel) -> list[Array]:
    """Return the rises of surface 1, surface 2 and mid-film [K]."""
    found, heat = panel.result.temperature, panel.result.heat
    if found is None or heat is None:
        return [np.full(panel.result.scaled.film.shape, np.nan)] * 3
    fields = (heat.temperature[0], heat.temperature[-1], found.mid_film)
    return [np.asarray(field - found.inlet) for field in fields]


def _note(panel: Panel) -> str:
    warmth = panel.measures.warmth
    if warmth is None:
        return ""
    return f"at most {warmth.surface_1:.0f}, {warmth.surface_2:.0f} and {warmth.mid_film:.0f} K"


def _map(page: Sheet, place: int, panel: Panel, rise: Array) -> Axes:
    axes: Axes = page.axes(place)
    scaled = panel.result.scaled
    columns, rows = span_part(scaled.x, *WINDOW[0]), span_part(scaled.y, *WINDOW[1])
    part = rise[rows, columns]
    top = max(float(np.percentile(part, 99.8)), 1e-3)
    image = draw_map(
        axes, scaled.x[columns], scaled.y[rows], part, cmap="inferno", vmin=0.0, vmax=top
    )
    dress_map(axes)
    bar = page.picture.colorbar(image, cax=page.colour_axes(place))
    bar.ax.tick_params(labelsize=7)
    bar.ax.set_title("K", fontsize=8)
    return axes


def _lines(axes: Axes, panel: Panel, rises: list[Array]) -> None:
    x = panel.result.scaled.x
    for rise, name, colour in zip(rises, _NAMES, _COLOURS, strict=True):
        axes.plot(x, centre_line(panel.result, rise), color=colour, lw=1.4, label=name)
    axes.set(xlim=WINDOW[0], xlabel="X  (Y = 0)")
    axes.tick_params(labelsize=8)
