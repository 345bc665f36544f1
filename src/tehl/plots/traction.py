"""Traction against slide-to-roll ratio, of many results or of a table."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.plots.frame import BLUE, GIGA, ORANGE, PLAIN, empty, figure_of
from tehl.post.traction import traction as traction_of
from tehl.result.solution import Solution

_STYLES = {True: ("o-", ORANGE, "thermal"), False: ("s--", BLUE, "isothermal")}
_FADING = (1.0, 0.55, 0.3)


def traction_curve(
    runs: Sequence[Solution] | Mapping[str, Any],
    *,
    ax: Axes | None = None,
    title: bool | None = True,
) -> Figure:
    """Draw the traction coefficient at mid-film against the slide-to-roll ratio.

    The coefficient is drawn as friction: positive where surface 1 is the faster, so with the sign
    of the slide-to-roll ratio, against that of the stress. Contacts that differ in anything but
    sliding and heat have curves of their own: circles are thermal, squares isothermal runs.

    Parameters
    ----------
    runs : sequence of Solution, or Mapping
        Results with shear stresses; or a table, anything with columns ``slide_roll_ratio`` and
        ``traction`` (at mid-film, with its sign) and perhaps ``thermal`` (true or false) and
        ``case`` (a name).
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.

    Raises
    ------
    InputError
        If a column is missing or nothing has a traction.
    """
    table = _columns(_of_results(runs) if isinstance(runs, Sequence) else runs)
    if not table["slide_roll_ratio"].size:
        raise InputError("there is no traction to draw: no run has shear stresses")
    axes = empty(ax)
    cases = list(dict.fromkeys(table["case"].tolist()))
    for thermal, (style, colour, word) in _STYLES.items():
        for number, case in enumerate(cases):
            chosen = (table["thermal"] == thermal) & (table["case"] == case)
            if not chosen.any():
                continue
            ratio, traction = table["slide_roll_ratio"][chosen], table["traction"][chosen]
            order = np.argsort(ratio, kind="stable")
            label = f"{word}, {case}" if case and len(cases) > 1 else word
            look: dict[str, Any] = {"color": colour, "ms": 4.5, "lw": 1.3, "label": label}
            alpha = _FADING[number % len(_FADING)]
            axes.plot(100.0 * ratio[order], -traction[order], style, alpha=alpha, **look)
    _dress(axes, table, cases if title else [])
    return figure_of(axes)


def _dress(axes: Any, table: dict[str, Array], cases: list[str]) -> None:
    ratio = table["slide_roll_ratio"]
    if not (ratio < 0).any():
        axes.set(xlim=(0.0, 104.0 * max(float(ratio.max()), 1e-3)))
        if not (table["traction"] > 0).any():
            axes.set_ylim(bottom=0.0)
    else:
        axes.axhline(0.0, color="0.6", lw=0.6)
        axes.axvline(0.0, color="0.6", lw=0.6)
    axes.set(xlabel="slide-to-roll ratio $(u_1 - u_2)/u_m$ [%]", ylabel="traction coefficient [-]")
    if len(cases) == 1 and cases[0]:
        axes.set_title(cases[0].replace("$", r"\$"), fontsize=9)
    axes.grid(lw=0.3)
    axes.legend(**PLAIN)


def _of_results(results: Sequence[Solution]) -> dict[str, list[Any]]:
    """Return the columns of results; those without stresses are left out.

    A case has the same groups, pressure and shear law at any sliding.
    """
    rows = []
    for one in results:
        if (traction := traction_of(one)) is not None:
            groups, law = one.groups, one.problem.lubricant.shear.law
            pressure = f"p_h = {one.scales.hertz_pressure * GIGA:.3g} GPa"
            case = f"M = {groups.M:.4g}, L = {groups.L:.4g}, {pressure}, {law}"
            ratio = one.problem.slide_roll_ratio
            rows.append((ratio, traction.mid_film, one.heat is not None, case))
    names = ("slide_roll_ratio", "traction", "thermal", "case")
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}


def _columns(table: Mapping[str, Any]) -> dict[str, Array]:
    known = list(table.keys())
    for name in ("slide_roll_ratio", "traction"):
        if name not in known:
            raise InputError(f"the table has no column {name}; it has {', '.join(map(str, known))}")
    ratio = np.asarray(table["slide_roll_ratio"], np.float64)
    return {
        "slide_roll_ratio": ratio,
        "traction": np.asarray(table["traction"], np.float64),
        "thermal": np.broadcast_to(table["thermal"] if "thermal" in known else True, ratio.shape),
        "case": np.broadcast_to(table["case"] if "case" in known else "", ratio.shape),
    }
