"""Where the oil is in a starved contact: the filled part of the gap, meniscus and stream lines."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from tehl.plots.arrows import MICRO, NANO
from tehl.plots.frame import (
    MAP,
    colour_bar,
    figure_of,
    legend_above,
    map_axes,
    single,
    window_part,
    window_places,
)
from tehl.post.starvation import meniscus, oil_flux
from tehl.result.solution import Solution

_STREAMS: dict[str, Any] = {"color": "0.25", "linewidth": 0.5, "arrowsize": 0.6, "density": 0.9}


def oil_map(result: Solution, *, ax: Axes | None = None, title: bool | None = True) -> Figure:
    """Draw the part of the gap that is oil, the meniscus, and stream lines of the oil.

    Parameters
    ----------
    result : Solution
        With conserving cavitation or a supply.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.

    Raises
    ------
    ValueError
        If the oil of cavities was not conserved.
    """
    if result.oil is None:
        raise ValueError("the result has no oil map: its cavities do not conserve oil")
    axes = map_axes(result, ax=ax, title=title)
    part, places = window_part(result), window_places(result)
    mesh = axes.pcolormesh(*places, result.oil.fill[part], cmap="Blues", vmin=0.0, vmax=1.5, **MAP)
    along, across = (flux[part] for flux in oil_flux(result))
    x, y = (np.linspace(axis[0], axis[-1], axis.size) for axis in places)  # to the last bit
    lines = axes.streamplot(x, y, along, across, **_STREAMS)
    lines.arrows.set_alpha(0.7)
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(y[0], y[-1])
    legend_above(axes, *_draw_meniscus(axes, result))
    colour_bar(axes, mesh, "part of the gap that is oil").ax.set_ylim(0.0, 1.0)
    return figure_of(axes)


def _draw_meniscus(axes: Axes, result: Solution) -> list[Line2D]:
    scales, at = result.scales, meniscus(result)
    x, y = at * scales.half_width_x * MICRO, result.y * MICRO
    return axes.plot(x, y, color="tab:red", lw=1.4, zorder=6, label="meniscus")


def pass_history(result: Solution, *, ax: Axes | None = None, title: bool | None = True) -> Figure:
    """Draw the films and the oil that enters, pass after pass, on logarithmic axes.

    Parameters
    ----------
    result : Solution
        Of several passes.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.

    Raises
    ------
    ValueError
        If the result is of a single pass.
    """
    if result.passes is None:
        raise ValueError("the result is of a single pass: state supply.passes")
    axes, passes = single(result, (7.0, 4.8), ax=ax, title=title), result.passes
    curves: tuple[tuple[Any, dict[str, Any]], ...] = (
        (passes.entering, {"color": "tab:blue", "ls": "--", "label": "oil that enters, y = 0"}),
        (passes.film_central, {"color": "black", "label": "central film"}),
        (passes.film_minimum, {"color": "tab:red", "label": "minimum film"}),
    )
    for values, style in curves:
        axes.loglog(passes.number, values * NANO, **style)
    axes.set_xlabel("pass")
    axes.set_ylabel("thickness [nm]")
    axes.grid(visible=True, which="both", alpha=0.3)
    axes.legend()
    return figure_of(axes)
