"""Convergence of the iteration."""

from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, NullFormatter

from tehl.plots.frame import BLUE, GREEN, ORANGE, PLAIN, figure_of, single
from tehl.result.solution import Solution

_CURVES = (
    ("residual", "residual, scaled by the diagonal", "o-", BLUE),
    ("change", "change of P per cycle", "s-", ORANGE),
    ("load_error", "load error", "^-", GREEN),
)
_HEAT_CURVE = ("temperature_change", "change of T per cycle, right", "D-", "0.35")


def residual_history(
    result: Solution, *, ax: Axes | None = None, title: bool | None = True
) -> Figure:
    """Draw residual, changes and load error of each cycle, grid after grid.

    The axis is logarithmic, with one in kelvin at the right for a thermal run; vertical lines
    separate the grids.

    Parameters
    ----------
    result : Solution
        Converged or not; its ``history`` has the cycles.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.
    """
    axes = single(result, (7.0, 4.6), ax=ax, title=title)
    axes.set(xlabel="cycle", ylabel="residual, change of P, load error [-]", yscale="log")
    axes.grid(axis="y", lw=0.3)
    if not result.history:
        axes.text(0.5, 0.5, "no cycles were recorded", ha="center", transform=axes.transAxes)
        return figure_of(axes)
    lines = [_draw(axes, result, curve) for curve in _CURVES]
    if result.heat is not None:
        right, colour = axes.twinx(), _HEAT_CURVE[-1]
        right.set(yscale="log")
        right.set_ylabel("change of temperature per cycle [K]", color=colour)
        right.tick_params(axis="y", which="both", colors=colour)
        lines.append(_draw(right, result, _HEAT_CURVE))
        _align_decades(axes, right)
    _separate_grids(axes, [report.points for report in result.history])
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    below: dict[str, Any] = {"bbox_to_anchor": (0.5, -0.13), "ncols": 3 if len(lines) == 3 else 2}
    axes.legend(handles=lines, loc="upper center", **below, **PLAIN)
    return figure_of(axes)


def _draw(axes: Axes, result: Solution, curve: tuple[str, str, str, str]) -> Line2D:
    """Draw one number of all cycles; zeros are left out."""
    name, label, style, colour = curve
    values = np.abs([getattr(report, name) for report in result.history])
    count, shown = np.arange(1, values.size + 1), np.where(values > 0, values, np.nan)
    return axes.plot(count, shown, style, ms=3.5, lw=1.1, color=colour, label=label)[0]


def _align_decades(left: Axes, right: Axes) -> None:
    """Give both axes the same decades, a power of ten apart, so that one grid serves both."""
    values = np.asarray(right.lines[0].get_ydata(), dtype=np.float64)
    values = values[np.isfinite(values)]
    if not values.size:
        return
    low, high = left.get_ylim()
    apart = 10.0 ** np.ceil(np.log10(values.max() / high))
    low = min(low, 0.5 * float(values.min()) / apart)
    for axes, factor in ((left, 1.0), (right, apart)):
        axes.set_ylim(low * factor, high * factor)
        axes.yaxis.set_minor_formatter(NullFormatter())


def _separate_grids(axes: Axes, grids: list[tuple[int, int]]) -> None:
    """Draw a line before each grid, and its nodes above where there is room."""
    starts = [i for i, grid in enumerate(grids) if i == 0 or grid != grids[i - 1]]
    for start, end in pairwise([*starts, len(grids)]):
        if start:
            axes.axvline(start + 0.5, color="0.6", lw=0.8, ls=":")
        # there is room for the number of nodes above
        if end - start >= 0.09 * len(grids) or len(starts) == 1:
            place, nodes = (start + 0.6, 1.0), "{}×{}".format(*grids[start])
            axes.annotate(nodes, place, xycoords=("data", "axes fraction"), va="bottom", fontsize=7)
