"""Pressure and film on the centre line, ours on both grids."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from tehl.plots.lines import FILM, PRESSURE
from tehl.reproduce.book import Book
from tehl.reproduce.draw.sheet import (
    CURVES,
    Panel,
    Sheet,
    film_note,
    panel_title,
    panels_of,
    shape,
)
from tehl.reproduce.figures import FigureSpec
from tehl.reproduce.measures import centre_line
from tehl.reproduce.series import Run
from tehl.result import Result

_X = (-2.0, 1.5)
_HIGHEST = 1.65


def centre_lines(spec: FigureSpec, book: Book) -> Figure:
    """Draw a figure of centre lines."""
    panels = panels_of(spec, book)
    page = Sheet(spec, book, shape(len(panels)), CURVES)
    for place, panel in enumerate(panels):
        _lines(page.axes(place), panel, book)
    styles = (
        ("P", {"color": PRESSURE, "lw": 1.6}),
        ("H", {"color": FILM, "lw": 1.6}),
        ("P, H on the paper's grid", {"color": "0.25", "ls": "none", "marker": "o", "ms": 2.5}),
        ("dry contact", {"color": "0.6", "ls": ":", "lw": 1.2}),
    )
    handles = [Line2D([], [], label=label, **style) for label, style in styles]  # type: ignore[arg-type]
    page.picture.legend(handles=handles, loc="lower center", ncols=4, frameon=False)
    return page.picture


def _lines(axes: Axes, panel: Panel, book: Book) -> None:
    twin = axes.twinx()
    scaled = panel.result.scaled
    dry = np.sqrt(np.maximum(1.0 - scaled.x**2, 0.0))
    axes.plot(scaled.x, dry, color="0.6", ls=":", lw=1.2)
    axes.plot(scaled.x, centre_line(panel.result, scaled.pressure), color=PRESSURE, lw=1.6)
    twin.plot(scaled.x, centre_line(panel.result, scaled.film), color=FILM, lw=1.6)
    coarse = _on_papers_grid(panel.run, book)
    if coarse is not None:
        grid = coarse.scaled
        axes.plot(grid.x, centre_line(coarse, grid.pressure), "o", color=PRESSURE, ms=2.4)
        twin.plot(grid.x, centre_line(coarse, grid.film), "o", color=FILM, ms=2.4)
    highest = max(_HIGHEST, 1.04 * panel.measures.pressure.largest)
    axes.set(xlim=_X, ylim=(0.0, highest), xlabel="X")
    axes.set_ylabel("P", color=PRESSURE, labelpad=1)
    if coarse is None:
        twin.axhline(panel.measures.film.central, color=FILM, lw=0.6, ls="--")
    twin.set_ylim(0.0, 2.4 * max(panel.measures.film.central, 1e-3))
    twin.set_ylabel("H", color=FILM, labelpad=2)
    for one in (axes, twin):
        one.tick_params(labelsize=8)
    panel_title(axes, panel, book, film_note(panel.measures))


def _on_papers_grid(run: Run, book: Book) -> Result | None:
    """Return the result of the same contact by the treatment of the paper."""
    same = book.run(run.series, "paper", run.heat, run.value)
    if same is None or book.measures(same) is None:
        return None
    return book.result(same)
