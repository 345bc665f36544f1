"""How the iteration went."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tehl.plots.frame import figure
from tehl.result import Result

_CURVES = (
    ("residual", "residual, scaled by the diagonal", "o-", "#1f4e9c"),
    ("change", "change of P per cycle", "s-", "#c2410c"),
    ("load_error", "load error", "^-", "#3f7d20"),
)
_HEAT_CURVE = ("temperature_change", "change of T per cycle [K]", "D-", "0.35")


def residual_history(result: Result) -> Figure:
    """Draw residual, changes and load error of each cycle, grid after grid.

    Parameters
    ----------
    result : Result
        What to draw.

    Returns
    -------
    matplotlib.figure.Figure
        One panel with a logarithmic axis; vertical lines part the grids.
    """
    picture = figure(result, (7.0, 4.6))
    axes = picture.add_subplot()
    axes.set(xlabel="cycle", ylabel="dimensionless", yscale="log")
    axes.grid(axis="y", lw=0.3)
    if not result.history:
        axes.text(0.5, 0.5, "no cycles were recorded", ha="center", transform=axes.transAxes)
        return picture
    count = np.arange(1, len(result.history) + 1)
    curves = _CURVES if result.heat is None else (*_CURVES, _HEAT_CURVE)
    for name, label, style, colour in curves:
        values = np.abs([getattr(report, name) for report in result.history])
        shown = np.where(values > 0, values, np.nan)
        axes.plot(count, shown, style, ms=3.5, lw=1.1, color=colour, label=label)
    grids = [report.points for report in result.history]
    starts = [i for i, grid in enumerate(grids) if i == 0 or grid != grids[i - 1]]
    for start in starts:
        if start:
            axes.axvline(start + 0.5, color="0.6", lw=0.8, ls=":")
        label = "{}×{}".format(*grids[start])
        axes.annotate(
            label, (start + 0.6, 1.0), xycoords=("data", "axes fraction"), va="bottom", fontsize=7
        )
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, -0.13),
        ncols=3 if len(curves) == 3 else 2,
        fontsize=8,
        frameon=False,
    )
    return picture
