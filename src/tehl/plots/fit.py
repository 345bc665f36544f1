"""A fit of an oil: measured values beside those of the solver, and the residuals below."""

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.plots.arrows import NANO
from tehl.plots.frame import BLUE, GREEN, ORANGE, PLAIN, Picture

if TYPE_CHECKING:
    import pandas as pd

_STEPS = {"u_m [m/s]": 0.1, "SRR": 0.02, "p_h [GPa]": 0.05, "T [°C]": 3.0}
"""Differences of a condition that make another curve."""
_LOGARITHMIC = ("u_m [m/s]",)
_LABELS = {"film": "central film [nm]", "traction": "traction [-]"}
_COLOURS = (BLUE, ORANGE, GREEN, "#7b3fa0", "#555555")


def oil_fit(table: "pd.DataFrame") -> Picture:
    """Draw a fit: a column for each kind of measured value.

    Parameters
    ----------
    table : pandas.DataFrame
        That of `tehl.OilFit`.

    Returns
    -------
    matplotlib.figure.Figure
        Values with their noise over the speed, or the slide-to-roll ratio for traction, with the
        fitted ones as lines, and residuals in units of the noise.
    """
    kinds = [kind for kind in _LABELS if (table["kind"] == kind).any()]
    if not kinds:
        raise InputError("the table of the fit has no measured values to draw")
    picture = Picture(figsize=(4.6 * len(kinds), 4.8), layout="constrained")
    panels = picture.subplots(2, len(kinds), sharex="col", squeeze=False, height_ratios=(3, 1))
    for (upper, lower), kind in zip(panels.T, kinds, strict=True):
        _draw(upper, lower, table[table["kind"] == kind], kind)
    return picture


def _draw(upper: Axes, lower: Axes, rows: "pd.DataFrame", kind: str) -> None:
    across = _across(rows, kind)
    scale = 1.0 if kind == "traction" else NANO
    steps = {name: step for name, step in _STEPS.items() if name != across}
    clusters = [_clusters(rows[name].to_numpy(), step) for name, step in steps.items()]
    keys = list(zip(*clusters, strict=True))
    groups = list(dict.fromkeys(keys))
    look: dict[str, Any] = {"fmt": "o", "ms": 3.5, "lw": 1.0, "capsize": 2.0}
    varied = [name for k, name in enumerate(steps) if len({key[k] for key in groups}) > 1]
    for number, group in enumerate(groups):
        chosen = rows[[key == group for key in keys]].sort_values(across)
        colour = _COLOURS[number % len(_COLOURS)]
        label = ", ".join(f"{name.split()[0]} {chosen[name].mean():.3g}" for name in varied)
        x = chosen[across]
        upper.errorbar(
            *(x, scale * chosen["measured"], scale * chosen["noise"]),
            **look | {"color": colour},
        )
        named = label if number < 12 else ""  # as the legend has room
        upper.plot(x, scale * chosen["fitted"], color=colour, lw=1.3, label=named or None)
        lower.plot(x, chosen["residual"], color=colour, marker="o", ms=3.0, ls="none")
    lower.axhspan(-2.0, 2.0, color="0.92", zorder=0)
    lower.axhline(0.0, color="0.6", lw=0.8)
    lower.set(xlabel=across, ylabel="residual / noise")
    upper.set(ylabel=_LABELS[kind])
    if across in _LOGARITHMIC:
        upper.set(xscale="log", yscale="log")
    elif rows[across].min() > 0 and rows[across].max() > 20.0 * rows[across].min():
        upper.set(xscale="log")
    for axis in (lower.xaxis, upper.yaxis):
        if axis.get_scale() == "log":
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(NullFormatter())
    if varied:
        upper.legend(**PLAIN)


def _clusters(values: Array, step: float) -> list[int]:
    """Return the number of the cluster of each value; a gap of more than ``step`` begins one."""
    order = np.argsort(values, kind="stable")
    found = np.empty(values.size, dtype=int)
    found[order] = np.concatenate([[0], np.cumsum(np.diff(values[order]) > step)])
    return found.tolist()


def _across(rows: "pd.DataFrame", kind: str) -> str:
    """Return the condition that changes most along the curves of a kind."""
    spans = {name: np.ptp(rows[name].to_numpy()) / step for name, step in _STEPS.items()}
    usual = "SRR" if kind == "traction" else "u_m [m/s]"
    return usual if spans[usual] > 1.0 else max(spans, key=lambda name: spans[name])
