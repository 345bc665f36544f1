"""A sheet of panels: layout, titles, and what is said of runs that are no answer."""

import math
from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.ticker import MaxNLocator

from tehl.plots.frame import STEPS, outline
from tehl.reproduce.book import Book
from tehl.reproduce.figures import FigureSpec
from tehl.reproduce.measures import Measures
from tehl.reproduce.series import Run
from tehl.result import Result
from tehl.typing import Array

WINDOW = ((-1.8, 1.5), (-1.5, 1.5))
"""What of the domain panels show: X and Y in half-widths."""
MINUS = "\N{MINUS SIGN}"
_HEAD = 0.62
_RED = "#b3001b"
_LETTERS = "abcdefghijklmnop"


@dataclass(frozen=True, slots=True)
class Panel:
    """One panel of a figure.

    Attributes
    ----------
    letter : str
        As the paper counts.
    run : Run
        Which contact.
    result : Result
        Its fields.
    measures : Measures
        What was measured in it.
    """

    letter: str
    run: Run
    result: Result
    measures: Measures


def panels_of(spec: FigureSpec, book: Book) -> list[Panel]:
    """Return the panels that a figure has; runs without fields are left out."""
    found = []
    for letter, run in zip(_LETTERS, spec.panels(book), strict=False):
        measures = book.measures(run)
        if measures is not None:
            found.append(Panel(letter, run, book.result(run), measures))
    return found


@dataclass(frozen=True, kw_only=True, slots=True)
class Layout:
    """Room on a sheet, in inches.

    Attributes
    ----------
    width, height : float
        Of the axes of one panel.
    left, right, above, below : float
        Between the axes and the edges of their panel.
    foot : float
        Below all panels.
    """

    width: float
    height: float
    left: float
    right: float
    above: float
    below: float
    foot: float = 0.0


FLAT = Layout(width=2.65, height=2.41, left=0.52, right=0.62, above=0.42, below=0.5)
CURVES = Layout(width=2.65, height=2.41, left=0.5, right=0.55, above=0.5, below=0.45, foot=0.3)
LAYERS = Layout(width=2.2, height=2.0, left=0.75, right=0.55, above=0.34, below=0.42)
SPATIAL = Layout(width=3.5, height=2.9, left=0.1, right=0.3, above=0.42, below=0.2)


def shape(count: int) -> tuple[int, int]:
    """Return rows and columns of a sheet: five panels leave room for one more."""
    return {4: (2, 2), 5: (2, 3), 8: (2, 4)}.get(count, (max(1, (count + 1) // 3), min(count, 3)))


class Sheet:
    """A figure with places for panels.

    Parameters
    ----------
    spec : FigureSpec
        Which figure.
    book : Book
        Where its runs are.
    shape : (int, int)
        Rows and columns.
    layout : Layout
        Room of each panel.
    """

    def __init__(
        self, spec: FigureSpec, book: Book, shape: tuple[int, int], layout: Layout
    ) -> None:
        self.rows, self.columns, self.layout = *shape, layout
        self.panel = (
            layout.left + layout.width + layout.right,
            layout.above + layout.height + layout.below,
        )
        self.size = (
            self.panel[0] * self.columns,
            self.panel[1] * self.rows + _HEAD + layout.foot,
        )
        self.picture = Figure(figsize=self.size)
        self.picture.text(
            0.5,
            1.0 - 0.12 / self.size[1],
            f"{spec.label}.  {spec.title}\n{fixed_part(spec, book)}",
            ha="center",
            va="top",
            fontsize=12,
        )

    def box(self, place: int) -> tuple[float, float, float, float]:
        """Return left, bottom, width and height of the axes of a place, counted from 0."""
        row, column = divmod(place, self.columns)
        layout = self.layout
        left = column * self.panel[0] + layout.left
        bottom = layout.foot + (self.rows - 1 - row) * self.panel[1] + layout.below
        width, height = self.size
        return left / width, bottom / height, layout.width / width, layout.height / height

    def axes(self, place: int, **options: Any) -> Any:
        """Return axes at a place."""
        return self.picture.add_axes(self.box(place), **options)

    def colour_axes(self, place: int) -> Any:
        """Return axes for a colour bar beside those of a place."""
        left, bottom, width, height = self.box(place)
        thick, gap = 0.1 / self.size[0], 0.08 / self.size[0]
        return self.picture.add_axes((left + width + gap, bottom, thick, height))

    def spare(self) -> Any:
        """Return axes for curves at the last place."""
        left, bottom, width, height = self.box(self.rows * self.columns - 1)
        room, deep = 0.45 / self.size[0], 0.45 / self.size[1]
        if self.layout is SPATIAL:
            box = (left + 2 * room, bottom + deep, width - 2.4 * room, height - 1.5 * deep)
            return self.picture.add_axes(box)
        return self.picture.add_axes((left, bottom, width, height))


def fixed_part(spec: FigureSpec, book: Book) -> str:
    """Return what all panels of a figure share."""
    one = book.series[spec.series]
    names = {"moes_load": "M", "moes_speed": "L", "slide_roll_ratio": "SRR"}
    shared = ", ".join(f"{names[key]} = {number(value)}" for key, value in one.contact.items())
    surface = "wavy surface" if one.is_rough else "smooth"
    shapes = [run.case.options.shape for run in spec.panels(book)]
    grid = " and ".join(dict.fromkeys(f"{nx} × {ny}" for ny, nx in shapes))
    grid = f", {grid} nodes" if grid else ""
    return f"{shared}, {surface}{grid}"


def number(value: float) -> str:
    """Return a number as people write it, with a real minus sign."""
    return f"{value:g}".replace("-", MINUS)


def panel_title(axes: Any, panel: Panel, book: Book, note: str = "") -> None:
    """Write letter, what varies and what was found above a panel."""
    symbol = book.series[panel.run.series].symbol
    heat = panel.run.heat
    nodes = (
        f", {panel.measures.quality.points[0]}² nodes" if panel.run.treatment == "coarser" else ""
    )
    first = f"({panel.letter})  {symbol} = {number(panel.run.value)}, {heat}{nodes}"
    axes.set_title(f"{first}\n{note}" if note else first, fontsize=9, pad=4)
    quality = panel.measures.quality
    if not quality.converged:
        put = axes.text2D if hasattr(axes, "text2D") else axes.text
        put(
            0.5,
            0.02,
            quality.outcome,
            transform=axes.transAxes,
            ha="center",
            va="bottom",
            fontsize=8,
            color="white",
            bbox={"facecolor": _RED, "edgecolor": "none", "pad": 2},
            zorder=20,
        )


def film_note(measures: Measures) -> str:
    """Return the film numbers of a panel, the error of the last digits in brackets."""
    film = measures.film
    low = with_error(film.best_minimum, film.minimum_error)
    return f"$H_{{min}}$ = {low},  $H_c$ = {with_error(film.best_central, film.central_error)}"


def with_error(value: float, error: float) -> str:
    """Return a value with the error of its last digits in brackets: 0.1853(7)."""
    if not error > 0:
        return f"{value:.4f}"
    digits = min(max(-math.floor(math.log10(error)), 0), 6)
    last = round(error * 10**digits)
    if last == 10:
        digits, last = digits - 1, 1
    return f"{value:.{digits}f}({last})"


def dress_map(axes: Axes) -> None:
    """Make axes those of a map over X and Y, equal aspect, with the Hertz circle."""
    axes.set_aspect("equal")
    axes.set(xlim=WINDOW[0], ylim=WINDOW[1], xlabel="X", ylabel="Y")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5, steps=STEPS))
    axes.tick_params(labelsize=8)
    rim = Circle((0, 0), 1, fill=False, color="white", ls="--", lw=0.9, zorder=5)
    rim.set_path_effects(outline("0.25", 1.6))
    axes.add_patch(rim)


def draw_map(axes: Axes, x: Array, y: Array, field: Array, **options: Any) -> Any:
    """Draw a field on uniform nodes as an image; return it."""
    dx, dy = 0.5 * (x[1] - x[0]), 0.5 * (y[1] - y[0])
    edges = (x[0] - dx, x[-1] + dx, y[0] - dy, y[-1] + dy)
    return axes.imshow(field, extent=edges, origin="lower", interpolation="bilinear", **options)
