"""What changes along a series, on both grids and in print: the panel beside the others."""

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes

from tehl.plots.lines import FILM, PRESSURE
from tehl.reproduce.book import Book
from tehl.reproduce.draw.sheet import number
from tehl.reproduce.figures import FigureSpec
from tehl.reproduce.measures import Measures
from tehl.reproduce.printed import printed
from tehl.reproduce.series import Heat, Treatment

_WARM, _COOL = "#c2410c", "#2a9d8f"
Quantity = Callable[[Measures], float]


def draw_trend(axes: Axes, spec: FigureSpec, book: Book) -> None:
    """Draw what the figure is about against what varies: converged, and on the paper's grid."""
    heat = spec.heat[-1]
    curves = _CURVES[spec.kind]
    for quantity, label, colour in curves(book, spec):
        _curve(axes, spec, book, "converged", heat, quantity, label, colour)
        _curve(axes, spec, book, "paper", heat, quantity, "", colour)
    if spec.kind.startswith("film"):
        _print(axes, spec, heat)
    one = book.series[spec.series]
    if book.line(spec.series, "paper", heat):
        axes.plot([], [], "o--", color="0.4", mfc="none", ms=4, lw=0.9, label="on the paper's grid")
    axes.set_xlabel(one.symbol)
    axes.set_xticks(one.values, [number(value) for value in one.values])
    if min(np.diff(one.values)) < 0.08 * np.ptp(one.values):
        axes.tick_params(axis="x", rotation=60)
    low, high = axes.get_ylim()
    axes.set_ylim(min(0.0, low), high + 0.12 * (high - min(0.0, low)))
    axes.legend(fontsize=7.5, framealpha=0.7, edgecolor="none")
    axes.tick_params(labelsize=8)
    axes.grid(lw=0.3)
    axes.set_title("Along the series", fontsize=9.5)


def _curve(  # noqa: PLR0913, PLR0917
    axes: Axes,
    spec: FigureSpec,
    book: Book,
    treatment: Treatment,
    heat: Heat,
    quantity: Quantity,
    label: str,
    colour: str,
) -> None:
    line = book.line(spec.series, treatment, heat)
    places, values = list(line), [quantity(measures) for measures in line.values()]
    if treatment == "paper":
        axes.plot(places, values, "o--", color=colour, mfc="none", ms=4, lw=0.9)
        return
    axes.plot(places, values, "o-", color=colour, ms=4, lw=1.5, label=label)


def _film_curves(book: Book, spec: FigureSpec) -> list[tuple[Quantity, str, str]]:
    del book, spec
    return [
        (lambda m: m.film.best_minimum, "$H_{min}$", FILM),
        (lambda m: m.film.best_central, "$H_c$", PRESSURE),
    ]


def _pressure_curves(book: Book, spec: FigureSpec) -> list[tuple[Quantity, str, str]]:
    if book.series[spec.series].is_rough:
        return [(lambda m: m.pressure.largest, "$P_{max}$", PRESSURE)]
    return [
        (lambda m: m.pressure.spike, "spike at Y = 0", PRESSURE),
        (lambda m: m.pressure.central, "$P$ at the centre", "0.5"),
    ]


def _heat_curves(book: Book, spec: FigureSpec) -> list[tuple[Quantity, str, str]]:
    del book, spec

    def of(name: str) -> Quantity:
        return lambda m: np.nan if m.warmth is None else float(getattr(m.warmth, name))

    return [
        (of("mid_film"), "mid-film, at most [K]", _WARM),
        (of("surface_1"), "surface 1 [K]", PRESSURE),
        (of("surface_2"), "surface 2 [K]", _COOL),
    ]


_CURVES: dict[str, Callable[[Book, FigureSpec], list[tuple[Quantity, str, str]]]] = {
    "film-surface": _film_curves,
    "film-contours": _film_curves,
    "pressure-surface": _pressure_curves,
    "temperature-surface": _heat_curves,
}


def _print(axes: Axes, spec: FigureSpec, heat: Heat) -> None:
    """Mark what the paper prints in its tables for the same contacts."""
    known = printed().films(spec.series, heat)
    if not known:
        return
    for index, colour in ((0, FILM), (1, PRESSURE)):
        axes.plot(
            list(known), [film[index] for film in known.values()], "x", color=colour, ms=7, mew=1.6
        )
    axes.plot([], [], "x", color="0.4", ms=7, mew=1.6, label="printed in the paper")
