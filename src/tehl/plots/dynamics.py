"""Stiffness and damping of the film over frequency."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tehl.base.typing import Array, BoolArray
from tehl.plots.frame import BLUE, ORANGE, PLAIN, figure, figure_of
from tehl.result.solution import Solution

_PER_UM = 1e-6
_LABELS = ("stiffness k [N/µm]", "damping c [N s/m]")


def dynamics_curves(
    result: Solution, *, ax: tuple[Axes, Axes] | None = None, title: bool | None = True
) -> Figure:
    """Draw stiffness and damping of the film over frequency, with their error bars.

    The dry point contact has the stiffness of the dashed line. The axis above has omega a_x/u_m.

    Parameters
    ----------
    result : Solution
        Of a case with ``[dynamics]``.
    ax : (Axes, Axes) or None
        Where to draw both; None makes a figure.
    title : bool or None
        Whether a new figure has a title.

    Raises
    ------
    ValueError
        If the case has no ``[dynamics]``.
    """
    film = result.dynamics
    if film is None:
        raise ValueError("the result has no stiffness and damping: state [dynamics] in its case")
    axes = figure(result, (7.0, 6.0), title=title).subplots(2, 1, sharex=True) if ax is None else ax
    shown = film.frequency > 0.0
    hertz = film.frequency[shown]
    values = (
        (film.stiffness * _PER_UM, film.stiffness_error * _PER_UM),
        (film.damping, film.damping_error),
    )
    for one, (value, bar), colour, label in zip(axes, values, (BLUE, ORANGE), _LABELS, strict=True):
        look: dict[str, Any] = {"color": colour, "ms": 4, "lw": 1.3, "label": "film"}
        one.plot(hertz, value[shown], "o-", **look)
        one.fill_between(hertz, *_band(value, bar, shown), color=colour, alpha=0.2, lw=0)
        one.set(xscale="log", ylabel=label)
        one.grid(lw=0.3)
    if not result.problem.contact.has_lines:  # load ~ approach^1.5
        dry = 1.5 * result.load / result.problem.hertz.approach * _PER_UM
        axes[0].axhline(dry, color="0.4", ls="--", lw=1.0, label="dry contact")
    axes[0].legend(**PLAIN, title="of one metre" if result.problem.contact.is_line else None)
    axes[1].set_ylim(bottom=min(0.0, 1.1 * float(film.damping.min())))
    axes[1].set_xlabel("frequency [Hz]")
    omega = 2.0 * np.pi * result.scales.half_width_x / result.scales.speed
    scaling: Any = (lambda f: f * omega, lambda f: f / omega)
    top = axes[0].secondary_xaxis("top", functions=scaling)
    top.set_xlabel("frequency $\\omega a_x/u_m$ [-]")
    return figure_of(axes[0])


def _band(value: Array, bar: Array, shown: BoolArray) -> tuple[Array, Array]:
    return (value - bar)[shown], (value + bar)[shown]
