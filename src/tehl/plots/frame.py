"""Parts that the pictures of a contact share: title, banner, window, map, colour bar, legend."""

import io
from pathlib import Path
from textwrap import fill
from typing import IO, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse, Patch, Rectangle
from matplotlib.ticker import MaxNLocator

from tehl.base.typing import Array
from tehl.contact.hertz import axes_of
from tehl.plots.arrows import MICRO, entrainment_arrow, outline, spinning_arrows
from tehl.post.film import no_film
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution

GIGA = 1e-9
WINDOW = ((-2.2, 1.6), (-1.7, 1.7))
"""Part of the domain that is shown, along x and y [Hertz half-widths]."""
STEPS = (1, 2, 2.5, 5, 10)
BLUE, ORANGE, GREEN = "#1f4e9c", "#c2410c", "#3f7d20"
PRESSURE, FILM = BLUE, ORANGE
"""Colours of pressure and film."""
ALONG_X = "x along entrainment [µm]  (y = 0)"
"""Label of the axis of a centre line."""
MAP: dict[str, Any] = {"shading": "gouraud", "rasterized": True}
"""Style of the colours of a map."""
PLAIN: dict[str, Any] = {"fontsize": 8, "frameon": False}
"""Style of a small legend."""
_ALARM: dict[str, Any] = {"color": "white", "backgroundcolor": "#b3001b", "weight": "bold"}
_DRAWN = 1.6
"""Largest height over width, or width over height, of a map as drawn."""

Span = tuple[float, float]


class Picture(Figure):
    """A figure outside pyplot, which a notebook shows when it is the value of a cell."""

    def _repr_png_(self) -> bytes:
        """Return the picture as PNG, for notebooks."""
        buffer = io.BytesIO()
        self.savefig(buffer, format="png", dpi=self.dpi, bbox_inches="tight")
        return buffer.getvalue()


def write_png(picture: Figure, file: Path | IO[bytes], dpi: int) -> None:
    """Write a picture as PNG, faster than ``savefig``, which draws it twice, for layout and file.

    Parameters
    ----------
    picture : Figure
        Any figure of matplotlib; it keeps ``dpi``.
    file : Path or file object
        Where to write.
    dpi : int
        Pixels per inch.
    """
    picture.set_dpi(dpi)
    lay_out(picture)
    FigureCanvasAgg(picture).print_png(file)


def lay_out(picture: Figure) -> None:
    """Lay a picture out once before it is drawn, where axes have a fixed aspect.

    Their size follows from the first layout, so that one alone cuts labels at the edges.

    Parameters
    ----------
    picture : Figure
        With all of its content.
    """
    engine = picture.get_layout_engine()
    if engine is not None and any(axes.get_aspect() != "auto" for axes in picture.axes):
        engine.execute(picture)


def figure(
    result: Solution | TransientSolution,
    size: tuple[float, float] = (7.0, 5.6),
    note: str = "",
    *,
    title: bool | None = True,
) -> Picture:
    """Return an empty figure under the title of ``result``, with a banner if not converged.

    Parameters
    ----------
    result : Solution or TransientSolution
        Gives title, groups and status.
    size, note : (float, float), str
        Width and height [inch], and the last line of the title.
    title : bool or None
        Whether it has a title.
    """
    start = result.start if isinstance(result, TransientSolution) else result
    picture = Picture(figsize=size, layout="constrained")
    if title:
        words = fill(start.problem.title, 80).replace("$", r"\$") or "Lubricated contact"
        picture.suptitle(f"{words}\n{_subtitle(result, start)}\n{note}".strip(), fontsize=9)
    if not result.status.converged:
        picture.supxlabel(_banner(result), fontsize=11, **_ALARM)
    return picture


def _banner(result: Solution | TransientSolution) -> str:
    cause = result.status.outcome.removeprefix("not converged").removeprefix(": ")
    return f"NOT CONVERGED: {cause}".rstrip(": ")


def single(
    result: Solution, size: tuple[float, float], *, ax: Axes | None, title: bool | None
) -> Axes:
    """Return the axes of a picture that has one: ``ax`` itself, or those of a new figure.

    Parameters
    ----------
    result : Solution
        Gives title, groups and status of a new figure; ``ax`` gets the banner only.
    size : (float, float)
        Width and height of a new figure [inch].
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.
    """
    if ax is None:
        return figure(result, size, title=title).add_subplot()
    _mark_failure(ax, result)
    return ax


def empty(ax: Axes | None, size: tuple[float, float] = (7.0, 5.0)) -> Axes:
    """Return the given axes, or those of a new figure without a title.

    Parameters
    ----------
    ax : Axes or None
        Returned as they are if given.
    size : (float, float)
        Width and height of a new figure [inch].
    """
    return Picture(figsize=size, layout="constrained").add_subplot() if ax is None else ax


def _mark_failure(axes: Axes, result: Solution) -> None:
    """Put the banner of a result that did not converge into axes of the caller's figure."""
    if not result.status.converged:
        place: dict[str, Any] = {"transform": axes.transAxes, "ha": "center", "zorder": 9}
        axes.text(0.5, 0.03, _banner(result), fontsize=8, **place, **_ALARM)


def _subtitle(result: Solution | TransientSolution, start: Solution) -> str:
    """Return groups, and the film of a steady result or the constant sliding of a transient one."""
    groups, film, scaled = start.groups, start.film, start.film_scaled
    about = (
        f"M = {float(f'{groups.M:.4g}'):g}, L = {groups.L:.4g}, "  # 14300, not 1.43e+04
        f"$p_h$ = {start.scales.hertz_pressure * GIGA:.3g} GPa"
    )
    if start is not result:
        transient = start.problem.transient
        if transient is not None and transient.slides_in_time:
            return about
        return f"{about}, SRR = {start.problem.slide_roll_ratio:g}"
    if why := no_film(start):
        return f"{about}\nno film: {why}"
    return (
        f"{about}\n$h_c$ = {length(film.central)} ($H_c$ = {scaled.central:.4g}), "
        f"$h_{{min}}$ = {length(film.minimum)} ($H_{{min}}$ = {scaled.minimum:.4g})"
    )


def length(metres: float) -> str:
    """Return a film thickness, in nanometres below a tenth of a micrometre."""
    return f"{metres * 1e9:.1f} nm" if abs(metres) < 1e-7 else f"{metres * 1e6:.3f} µm"


def map_axes(
    result: Solution, note: str = "", *, ax: Axes | None = None, title: bool | None = True
) -> Axes:
    """Return the axes of one map, with arrow and legend: ``ax``, or those of a new figure.

    Parameters
    ----------
    result : Solution
        Gives title, groups, status and window.
    note : str
        Last line of the title.
    ax : Axes or None
        Where to draw; None makes a figure shaped as the contact.
    title : bool or None
        Whether a new figure has a title.
    """
    if ax is None:
        ax = figure(result, _map_size(result), note, title=title).add_subplot()
    else:
        _mark_failure(ax, result)
    dress_contact(ax, result)
    entrainment_arrow(ax)
    legend_above(ax)
    return ax


def _map_size(result: Solution) -> tuple[float, float]:
    """Return width and height of the figure of a map [inch]."""
    ratio = shape(result)
    longest = 4.9 if 0.5 < ratio < 2.0 else 5.8  # [inch]
    width, height = (longest, longest * ratio) if ratio < 1 else (longest / ratio, longest)
    return max(width + 1.8, 5.6), max(height + 1.6, 3.4)


def figure_of(axes: Axes) -> Figure:
    """Return the whole figure that axes belong to."""
    found = axes.get_figure(root=True)
    assert isinstance(found, Figure)
    return found


def window(result: Solution) -> tuple[Span, Span]:
    """Return the part of the domain that maps show, x and y in half-widths.

    Slender contacts have less room at their tips and more beside them, so that the map does not
    become a thin strip.
    """
    if result.problem.contact.has_lines:  # a roller is shown from end to end
        side = float(np.abs(result.scaled.y).max())
        return (max(WINDOW[0][0], float(result.scaled.x[0])), WINDOW[0][1]), (-side, side)
    ratio = result.groups.ellipticity
    spans = []
    for span, axis, slender in zip(
        WINDOW, (result.scaled.x, result.scaled.y), (1.0 / ratio, ratio), strict=True
    ):
        tips = 1.0 / np.sqrt(max(slender, 1.0))
        sides = max(1.0, 1.0 / (6.0 * slender))
        low, high = ((end - np.sign(end)) * tips + np.sign(end) for end in span)
        spans.append((max(low * sides, float(axis[0])), min(high * sides, float(axis[-1]))))
    return spans[0], spans[1]


def film_span(film: Array, central: float) -> tuple[float, float]:
    """Return the least and the central film of a map, both positive for its colours.

    Parameters
    ----------
    film : Array
        Of the map.
    central : float
        Central film, in the unit of the map.
    """
    positive = film[film > 0]
    if not central > 0:
        central = float(np.median(positive)) if positive.size else 1.0
    low = float(positive.min()) if positive.size else 0.1 * central
    return min(max(low, 0.02 * central), 0.95 * central), central


def minimum_places(result: Solution) -> list[tuple[float, float]]:
    """Return the places of the minimum film [half-widths], both of a symmetric contact."""
    if not result.film.minimum > 0:
        return []
    (x, y), film = result.film_scaled.minimum_at, result.scaled.film
    mirrored = y != 0.0 and np.allclose(film, film[::-1], equal_nan=True)
    return [(x, side) for side in ((y, -y) if mirrored else (y,))]


def pressure_top(result: Solution) -> float:
    """Return the pressure at which scales end [Pa]: the largest one that has a limit, or zero.

    The pressure at the sharp end of a roller has none, and would leave no colours to the rest.
    """
    pressure = np.nan_to_num(result.pressure, nan=0.0, posinf=0.0, neginf=0.0)
    if result.errors is not None and not result.errors.pressure_has_limit:
        # half-widths from the end within which the pressure may have no limit
        inside = result.groups.ellipticity * (1.0 - np.abs(result.scaled.y)) > 0.5
        pressure = pressure[inside]
    return max(float(pressure.max(initial=0.0)), 0.0)


def pressure_label(result: Solution, words: str) -> str:
    """Return ``words`` for an axis of pressure [GPa], and what a scale that ends before omits."""
    if result.errors is None or result.errors.pressure_has_limit:
        return words
    return f"{words}, at the ends to {float(result.pressure.max()) * GIGA:.3g}"


def stretched(result: Solution) -> float:
    """Return the scale of y over that of x on maps: one unless the window is slender."""
    true = slenderness(result)
    return float(np.clip(true, 1.0 / _DRAWN, _DRAWN)) / true


def shape(result: Solution) -> float:
    """Return the height of a map over its width, as drawn."""
    return slenderness(result) * stretched(result)


def stretched_label(label: str, stretch: float) -> str:
    """Return the label of an axis with how its scale differs from that of the other."""
    if stretch == 1.0:
        return label
    words = f"stretched {stretch:.2g}:1" if stretch > 1 else f"compressed 1:{1 / stretch:.2g}"
    return f"{label}, {words}"


def slenderness(result: Solution) -> float:
    """Return the height of the window over its width."""
    x, y = window(result)
    return float(np.ptp(y) / np.ptp(x) * result.groups.ellipticity)


def window_part(result: Solution) -> tuple[slice, slice]:
    """Return the part (rows, columns) of the fields inside the window, and one node around it."""
    x, y = window(result)
    return span_part(result.scaled.y, y), span_part(result.scaled.x, x)


def span_part(axis: Array, span: Span) -> slice:
    """Return the nodes between two places, and one on either side.

    Parameters
    ----------
    axis : Array
        Rising coordinates, at least one of which lies in the span.
    span : (float, float)
        Two places in the unit of ``axis``.
    """
    inside = np.flatnonzero((axis >= span[0]) & (axis <= span[1]))
    return slice(max(int(inside[0]) - 1, 0), int(inside[-1]) + 2)


def window_places(result: Solution) -> tuple[Array, Array]:
    """Return x and y [um] of the nodes that :func:`window_part` shows."""
    rows, columns = window_part(result)
    return result.x[columns] * MICRO, result.y[rows] * MICRO


def dress_contact(axes: Axes, result: Solution) -> None:
    """Give axes micrometres, the window and the Hertz ellipse of a result.

    The aspect is equal, and of a slender contact stretched so that its map can be read.

    Parameters
    ----------
    axes : Axes
        Of a map in micrometres.
    result : Solution
        Gives the window and the Hertz ellipse.
    """
    widths = (result.scales.half_width_x * MICRO, result.scales.half_width_y * MICRO)
    x, y = ((low * a, high * a) for (low, high), a in zip(window(result), widths, strict=True))
    stretch = stretched(result)
    axes.set_aspect(stretch)
    label = stretched_label("y [µm]", stretch)
    axes.set(xlabel="x along entrainment [µm]", ylabel=label, xlim=x, ylim=y)
    slender = shape(result)
    axes.xaxis.set_major_locator(MaxNLocator(3 if slender > 2 else 8, steps=STEPS))
    axes.yaxis.set_major_locator(MaxNLocator(3 if slender < 0.5 else 8, steps=STEPS))
    style: dict[str, Any] = {"color": "white", "ls": "--", "lw": 1.1, "zorder": 5}
    straight = result.problem.contact.has_lines
    rim = contact_rim(widths, result.groups.skew, straight=straight, **style)
    axes.add_patch(rim).set_path_effects(outline("0.25", 1.9))
    if result.problem.motion.mean_spin:
        spinning_arrows(axes, result)


def contact_rim(widths: tuple[float, float], skew: float, *, straight: bool, **style: Any) -> Patch:
    """Return the rim of a contact, to be drawn on a map.

    Parameters
    ----------
    widths : (float, float)
        Half-widths along x and y, in units of the axes.
    skew : float
        s of an ellipse at an angle [-].
    straight : bool
        Whether it is that of a line or a roller.
    **style : Any
        Of the patch.
    """
    if straight:
        (a, b), corner = widths, (-widths[0], -widths[1])
        return Rectangle(corner, 2 * a, 2 * b, fill=False, **style)
    first, second, angle = axes_of(*widths, skew)
    return Ellipse((0, 0), 2 * first, 2 * second, angle=np.degrees(angle), fill=False, **style)


def mark_levels(bar: Colorbar, lines: QuadContourSet) -> None:
    """Mark contour lines and zero on a colour bar.

    Parameters
    ----------
    bar : Colorbar
        Of the map below the lines; its ticks are replaced.
    lines : QuadContourSet
        With levels in the unit of the bar.
    """
    levels = np.asarray(lines.levels)
    if levels.size:
        bar.add_lines(lines)
    bar.set_ticks(sorted({0.0, *levels}))


def legend_above(axes: Axes, *others: Line2D) -> None:
    """Put a legend of the Hertz contact and of ``others`` above the map, where it hides nothing."""
    rim = Line2D([], [], label="Hertz contact", color="white", ls="--", lw=1.3)
    style: dict[str, Any] = {"facecolor": "0.78", "edgecolor": "none", "handlelength": 2.6}
    place: dict[str, Any] = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": 2}
    axes.legend(handles=[rim, *others], fontsize=8, **place, **style)


def colour_bar(axes: Axes, mesh: ScalarMappable, label: str, **style: Any) -> Colorbar:
    """Draw a colour bar at the right of a map, as tall as the map."""
    drawn = float(np.ptp(axes.get_ylim()) / np.ptp(axes.get_xlim())) * float(axes.get_aspect())
    thick = 0.045 * max(drawn, 1.0)
    place = axes.inset_axes((1.0 + 0.8 * thick, 0.0, thick, 1.0))
    return figure_of(axes).colorbar(mesh, cax=place, label=label, **style)


def nice_levels(span: Span, count: int) -> Array:
    """Return round values from end to end of a span or a little beyond.

    Parameters
    ----------
    span : (float, float)
        Least and largest value.
    count : int
        Wanted number of intervals, at most.
    """
    return np.asarray(MaxNLocator(count, steps=STEPS).tick_values(*span), dtype=np.float64)


def inner_levels(span: Span) -> Array:
    """Return about ten round values inside ``span``; none if its ends are equal."""
    low, high = span
    if not high > low:
        return np.empty(0)
    levels = nice_levels(span, 10)
    return levels[(levels > low) & (levels < high)]
