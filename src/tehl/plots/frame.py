"""What all pictures of a contact share: size, title, banner, window and contact ellipse."""

from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from tehl.result import Result

MICRO = 1e6
GIGA = 1e-9
WINDOW = ((-2.2, 1.6), (-1.7, 1.7))


def figure(result: Result, size: tuple[float, float] = (7.0, 5.6)) -> Figure:
    """Return an empty figure under the title of ``result``, with a banner if it is no answer."""
    picture = Figure(figsize=size, layout="constrained")
    _dress(picture, result)
    return picture


def map_figure(result: Result, note: str = "") -> Figure:
    """Return an empty figure for one map, shaped as the contact; ``note`` ends the title."""
    (west, east), (south, north) = WINDOW
    ratio = (north - south) / (east - west) * result.groups.ellipticity
    width, height = (4.9, 4.9 * ratio) if ratio < 1 else (4.9 / ratio, 4.9)
    picture = Figure(figsize=(max(width + 1.8, 5.6), max(height + 1.3, 3.2)), layout="compressed")
    _dress(picture, result, note)
    return picture


def _dress(picture: Figure, result: Result, note: str = "") -> None:
    picture.suptitle(f"{_heading(result)}\n{note}".strip(), fontsize=9)
    if not result.status.converged:
        _banner(picture, result)


def subtitle(result: Result) -> str:
    """Return the groups and film numbers that belong under each title."""
    groups, film, scaled = result.groups, result.film, result.film_scaled
    return (
        f"M = {groups.M:.4g}, L = {groups.L:.4g}, "
        f"$p_h$ = {result.scales.hertz_pressure * GIGA:.3g} GPa\n"
        f"$h_c$ = {length(film.central)} ($H_c$ = {scaled.central:.4g}), "
        f"$h_{{min}}$ = {length(film.minimum)} ($H_{{min}}$ = {scaled.minimum:.4g})"
    )


def length(metres: float) -> str:
    """Return a film thickness as people say it: nanometres below a tenth of a micrometre."""
    return f"{metres * 1e9:.1f} nm" if abs(metres) < 1e-7 else f"{metres * 1e6:.3f} µm"


def _heading(result: Result) -> str:
    title = fill(result.problem.title, 80).replace("$", r"\$") or "Lubricated point contact"
    return f"{title}\n{subtitle(result)}"


def _banner(picture: Figure, result: Result) -> None:
    status = result.status
    text = f"NOT AN ANSWER: {status.outcome}"
    picture.supxlabel(text, color="white", backgroundcolor="#b3001b", fontsize=11, weight="bold")


def contact_axes(picture: Figure, result: Result, *, edge: str = "white") -> Axes:
    """Return axes in micrometres with equal aspect, showing the contact and its ellipse.

    Parameters
    ----------
    picture : Figure
        Where to put them.
    result : Result
        Gives the half-widths and the window: what of the domain lies near the contact.
    edge : str
        Colour of the ellipse.
    """
    axes = picture.add_subplot()
    widths = (result.scales.half_width_x * MICRO, result.scales.half_width_y * MICRO)
    axes.set_aspect("equal")
    axes.set(xlabel="x along entrainment [µm]", ylabel="y [µm]")
    limits = [
        (max(low, axis[0]) * width, min(high, axis[-1]) * width)
        for (low, high), axis, width in zip(
            WINDOW, (result.scaled.x, result.scaled.y), widths, strict=True
        )
    ]
    axes.set(xlim=limits[0], ylim=limits[1])
    axes.add_patch(
        Ellipse(
            (0, 0), 2 * widths[0], 2 * widths[1], fill=False, ec=edge, ls="--", lw=1.1, zorder=5
        )
    )
    return axes


def entrainment_arrow(axes: Axes, colour: str = "white") -> None:
    """Draw the direction in which the surfaces carry the oil."""
    axes.annotate(
        "",
        xy=(0.16, 0.06),
        xytext=(0.03, 0.06),
        xycoords="axes fraction",
        arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.6},
        zorder=6,
    )
    axes.text(
        0.03, 0.085, "oil enters", color=colour, fontsize=8, transform=axes.transAxes, zorder=6
    )


def window_part(result: Result) -> tuple[slice, slice]:
    """Return the part (rows, columns) of the fields inside the window, and one node around it."""
    (west, east), (south, north) = WINDOW
    return _span(result.scaled.y, south, north), _span(result.scaled.x, west, east)


def _span(axis: np.ndarray, low: float, high: float) -> slice:
    inside = np.flatnonzero((axis >= low) & (axis <= high))
    return slice(max(int(inside[0]) - 1, 0), int(inside[-1]) + 2)
