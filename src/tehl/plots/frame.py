"""What all pictures of a contact share: size, title, banner, window and contact ellipse."""

from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse
from matplotlib.patheffects import AbstractPathEffect, withStroke
from matplotlib.ticker import MaxNLocator

from tehl.post.film import no_film
from tehl.result import Result, Status
from tehl.typing import Array

MICRO = 1e6
GIGA = 1e-9
WINDOW = ((-2.2, 1.6), (-1.7, 1.7))
STEPS = (1, 2, 2.5, 5, 10)
_LONGEST = 5.8
_SLENDER = 6.0

Span = tuple[float, float]


def figure(result: Result, size: tuple[float, float] = (7.0, 5.6)) -> Figure:
    """Return an empty figure under the title of ``result``, with a banner if it is no answer."""
    picture = Figure(figsize=size, layout="constrained")
    _dress(picture, result)
    return picture


def map_figure(result: Result, note: str = "") -> Figure:
    """Return an empty figure for one map, shaped as the contact; ``note`` ends the title."""
    (west, east), (south, north) = window(result)
    ratio = (north - south) / (east - west) * result.groups.ellipticity
    longest = 4.9 if 0.5 < ratio < 2.0 else _LONGEST
    width, height = (longest, longest * ratio) if ratio < 1 else (longest / ratio, longest)
    size = (max(width + 1.8, 5.6), max(height + 1.6, 3.4))
    picture = Figure(figsize=size, layout="constrained")
    _dress(picture, result, note)
    return picture


def _dress(picture: Figure, result: Result, note: str = "") -> None:
    picture.suptitle(f"{_heading(result)}\n{note}".strip(), fontsize=9)
    banner(picture, result.status)


def subtitle(result: Result) -> str:
    """Return the groups and film numbers that belong under each title."""
    groups, film, scaled = result.groups, result.film, result.film_scaled
    about = (
        f"M = {groups.M:.4g}, L = {groups.L:.4g}, "
        f"$p_h$ = {result.scales.hertz_pressure * GIGA:.3g} GPa\n"
    )
    if why := no_film(result):
        return f"{about}no film: {why}"
    return (
        f"{about}$h_c$ = {length(film.central)} ($H_c$ = {scaled.central:.4g}), "
        f"$h_{{min}}$ = {length(film.minimum)} ($H_{{min}}$ = {scaled.minimum:.4g})"
    )


def length(metres: float) -> str:
    """Return a film thickness as people say it: nanometres below a tenth of a micrometre."""
    return f"{metres * 1e9:.1f} nm" if abs(metres) < 1e-7 else f"{metres * 1e6:.3f} µm"


def _heading(result: Result) -> str:
    title = fill(result.problem.title, 80).replace("$", r"\$") or "Lubricated point contact"
    return f"{title}\n{subtitle(result)}"


def banner(picture: Figure, status: Status) -> None:
    """Write across the foot of a picture that it shows no answer, if it shows none."""
    if status.converged:
        return
    text = f"NOT AN ANSWER: {status.outcome}"
    picture.supxlabel(text, color="white", backgroundcolor="#b3001b", fontsize=11, weight="bold")


def window(result: Result) -> tuple[Span, Span]:
    """Return what of the domain maps show, x and y in half-widths.

    Slender contacts have less room at their tips and more beside them, so that the map does not
    become a thin strip.
    """
    ratio = result.groups.ellipticity
    spans = []
    for span, axis, slender in zip(
        WINDOW, (result.scaled.x, result.scaled.y), (1.0 / ratio, ratio), strict=True
    ):
        tips = 1.0 / np.sqrt(max(slender, 1.0))
        sides = max(1.0, 1.0 / (_SLENDER * slender))
        low, high = ((end - np.sign(end)) * tips + np.sign(end) for end in span)
        spans.append((max(low * sides, float(axis[0])), min(high * sides, float(axis[-1]))))
    return spans[0], spans[1]


def outline(colour: str = "black", width: float = 2.4) -> list[AbstractPathEffect]:
    """Return path effects that keep a thin line or a text legible on any ground."""
    return [withStroke(linewidth=width, foreground=colour)]


def nice_levels(low: float, high: float, count: int) -> Array:
    """Return about ``count`` round values from ``low`` to ``high`` or a little beyond."""
    locator = MaxNLocator(count, steps=STEPS)
    return np.asarray(locator.tick_values(low, high), dtype=np.float64)


def inner_levels(low: float, high: float, count: int = 10) -> Array:
    """Return about ``count`` round values between ``low`` and ``high``; none if they are equal."""
    if not high > low:
        return np.empty(0)
    levels = nice_levels(low, high, count)
    return levels[(levels > low) & (levels < high)]


def contact_axes(picture: Figure, result: Result) -> Axes:
    """Return axes in micrometres with equal aspect, showing the contact and its ellipse.

    Parameters
    ----------
    picture : Figure
        Where to put them.
    result : Result
        Gives the half-widths and the window: what of the domain lies near the contact.
    """
    axes = picture.add_subplot()
    dress_contact(axes, result)
    return axes


def dress_contact(axes: Axes, result: Result) -> None:
    """Make axes those of a map in micrometres, as :func:`contact_axes` gives them."""
    widths = (result.scales.half_width_x * MICRO, result.scales.half_width_y * MICRO)
    axes.set_aspect("equal")
    axes.set(xlabel="x along entrainment [µm]", ylabel="y [µm]")
    spans = zip(window(result), widths, strict=True)
    limits = [(low * width, high * width) for (low, high), width in spans]
    axes.set(xlim=limits[0], ylim=limits[1])
    slender = np.ptp(limits[1]) / np.ptp(limits[0])
    axes.xaxis.set_major_locator(MaxNLocator(3 if slender > 2 else 8, steps=STEPS))
    axes.yaxis.set_major_locator(MaxNLocator(3 if slender < 0.5 else 8, steps=STEPS))
    axes.add_patch(
        Ellipse((0, 0), 2 * widths[0], 2 * widths[1], fill=False, zorder=5, **_rim_style())
    )


def _rim_style() -> dict[str, Any]:
    return {"color": "white", "ls": "--", "lw": 1.1, "path_effects": outline("0.25", 1.9)}


def legend_above(axes: Axes, *others: Line2D) -> None:
    """Put a legend of the Hertz contact and of ``others`` above the map, where it hides nothing."""
    rim = Line2D([], [], label="Hertz contact", color="white", ls="--", lw=1.3)
    axes.legend(
        handles=[rim, *others],
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=2,
        fontsize=8,
        facecolor="0.78",
        edgecolor="none",
        handlelength=2.6,
    )


def colour_axes(axes: Axes) -> Axes:
    """Return axes for a colour bar at the right of a map, as tall as the map."""
    (west, east), (south, north) = axes.get_xlim(), axes.get_ylim()
    tall = (north - south) / (east - west)
    thick = 0.045 * max(tall, 1.0)
    return axes.inset_axes((1.0 + 0.8 * thick, 0.0, thick, 1.0))


def entrainment_arrow(axes: Axes) -> None:
    """Draw the direction in which the surfaces carry the oil; it has one size on all maps."""
    arrow = axes.annotate(
        "",
        xy=(46, 9),
        xytext=(6, 9),
        xycoords="axes points",
        textcoords="axes points",
        arrowprops={"arrowstyle": "-|>", "color": "white", "lw": 1.6, "shrinkA": 0, "shrinkB": 0},
        zorder=6,
    )
    if arrow.arrow_patch is not None:
        arrow.arrow_patch.set_path_effects(outline("0.15", 3.2))
    words = axes.annotate(
        "oil enters", (6, 15), xycoords="axes points", color="white", fontsize=8, zorder=6
    )
    words.set_path_effects(outline("0.15"))


def window_part(result: Result) -> tuple[slice, slice]:
    """Return the part (rows, columns) of the fields inside the window, and one node around it."""
    x, y = window(result)
    return span_part(result.scaled.y, *y), span_part(result.scaled.x, *x)


def span_part(axis: Array, low: float, high: float) -> slice:
    """Return the nodes of ``axis`` between two places, and one on either side."""
    inside = np.flatnonzero((axis >= low) & (axis <= high))
    return slice(max(int(inside[0]) - 1, 0), int(inside[-1]) + 2)
