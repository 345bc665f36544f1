"""Contours of film thickness over X and Y."""

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator

from tehl.plots.frame import nice_levels, span_part
from tehl.plots.maps import film_levels
from tehl.reproduce.book import Book
from tehl.reproduce.draw.sheet import (
    FLAT,
    WINDOW,
    Panel,
    Sheet,
    draw_map,
    dress_map,
    film_note,
    panel_title,
    panels_of,
    shape,
)
from tehl.reproduce.draw.trends import draw_trend
from tehl.reproduce.figures import FigureSpec


def contours(spec: FigureSpec, book: Book) -> Figure:
    """Draw a figure of film contours."""
    panels = panels_of(spec, book)
    page = Sheet(spec, book, shape(len(panels)), FLAT)
    for place, panel in enumerate(panels):
        _film(page, place, panel, book)
    if len(panels) < page.rows * page.columns:
        draw_trend(page.spare(), spec, book)
    return page.picture


def _film(page: Sheet, place: int, panel: Panel, book: Book) -> None:
    axes, scaled, found = page.axes(place), panel.result.scaled, panel.measures.film
    columns, rows = span_part(scaled.x, *WINDOW[0]), span_part(scaled.y, *WINDOW[1])
    x, y, film = scaled.x[columns], scaled.y[rows], scaled.film[rows, columns]
    central = max(found.central, 1e-3)
    low = max(float(film.min()), 0.02 * central)
    bottom, top = 0.95 * low, 1.6 * central
    image = draw_map(axes, x, y, film.clip(bottom, top), norm=LogNorm(bottom, top))
    inner, outer = film_levels(low, central)
    axes.contour(x, y, film, levels=inner, colors="white", linewidths=0.6)
    axes.contour(x, y, film, levels=outer, colors="black", linewidths=0.4, alpha=0.6)
    dress_map(axes)
    at_x, at_y = found.minimum_at
    sides = (at_y, -at_y) if np.allclose(scaled.film, scaled.film[::-1]) else (at_y,)
    axes.plot([at_x] * len(sides), sides, "r+", ms=7, mew=1.4, zorder=7)
    bar = page.picture.colorbar(image, cax=page.colour_axes(place))
    ticks = nice_levels(low, top, 6)
    ticks = ticks[(ticks >= bottom) & (ticks <= top)]
    bar.ax.yaxis.set_minor_locator(NullLocator())
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    bar.ax.set_yticks(ticks, [f"{tick:.3g}" for tick in ticks], fontsize=7)
    bar.ax.set_title("H", fontsize=8)
    panel_title(axes, panel, book, film_note(panel.measures))
