"""Maps over two columns of a table, and film formulas against computed films over M and L."""

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.estimate.film_formulas import (
    FilmRatio,
    chittenden,
    hamrock_dowson,
    nijenbanning_venner_moes,
)
from tehl.estimate.scaling import Groups
from tehl.plots.frame import Picture, empty, figure_of
from tehl.plots.table_columns import FAILED, converged, dress, numbers

if TYPE_CHECKING:
    import pandas as pd

LEVELS = (-50, -30, -20, -10, -5, -2, 2, 5, 10, 20, 30, 50)
"""Deviations between which the colours change [%]."""
_FORMULAS: tuple[tuple[str, Callable[[Groups], FilmRatio], str], ...] = (
    ("Nijenbanning, Venner, Moes: central", nijenbanning_venner_moes, "central"),
    ("Hamrock, Dowson: central", hamrock_dowson, "central"),
    ("Chittenden et al.: central", chittenden, "central"),
    ("Hamrock, Dowson: minimum", hamrock_dowson, "minimum"),
    ("Chittenden et al.: minimum", chittenden, "minimum"),
)
_COMPUTED = {"central": "film.H_central_moes", "minimum": "film.H_min_moes"}
_GROUPS = ("M", "L", "U", "G", "lambda_bar", "alpha_bar", "ellipticity", "radius_ratio")


def contour_map(  # noqa: PLR0913 (one call, as in other libraries of pictures)
    table: "pd.DataFrame",
    x: str,
    y: str,
    z: str,
    log: str = "",
    *,
    ax: Axes | None = None,
    title: str | None = None,
) -> Figure:
    """Draw contours of a column over two others, which need not form a grid.

    Parameters
    ----------
    table : pandas.DataFrame
        As :func:`tehl.studies.table` returns it; cases that did not converge are left out.
    x, y, z : str
        Columns of numbers.
    log : {"", "x", "y", "xy"}
        Axes with a logarithmic scale.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : str or None
        Title above the map.

    Raises
    ------
    InputError
        If a column is missing, or the points span no area.
    """
    rows = converged(table)
    across, up, shown = numbers(rows, x), numbers(rows, y), numbers(rows, z)
    axes = empty(ax, (6.6, 5.0))
    known = np.isfinite(shown.values)
    mesh = _mesh(across.values[known], up.values[known], log)
    filled = axes.tricontourf(mesh, shown.values[known], 14, cmap="viridis")
    figure_of(axes).colorbar(filled, ax=axes, label=shown.title)
    axes.plot(across.values, up.values, "k.", ms=1.5, alpha=0.5)
    dress(axes, table, (across, up), log, title)
    return figure_of(axes)


def moes_map(table: "pd.DataFrame") -> Figure:
    """Draw the deviation of film formulas from the computed films, over the Moes numbers M and L.

    The table is that of :func:`tehl.studies.table`, of contacts with many M and L. The panels have
    the computed central film in Moes form, and for each formula its film over the computed one
    less one, in per cent; crosses are failed cases. Raises InputError if the points span no area.
    """
    rows = converged(table)
    load, speed = numbers(rows, "groups.M").values, numbers(rows, "groups.L").values
    mesh = _mesh(load, speed, "xy")
    picture = Picture(figsize=(11.5, 6.8), layout="constrained")
    panels = picture.subplots(2, 3, sharex=True, sharey=True).ravel()
    film = np.log10(numbers(rows, "film.H_central_moes").values)
    panels[0].tricontourf(mesh, film, 14, cmap="viridis")
    levels = np.linspace(film.min(), film.max(), 8)[1:-1]
    lines = panels[0].tricontour(mesh, film, levels, colors="white", linewidths=0.7)
    panels[0].clabel(lines, fmt=lambda level: f"{10**level:.2g}", fontsize=7)
    panels[0].set_title("computed central film, $h_c/R_x \\, (2U)^{-1/2}$", fontsize=9)
    for axes, (title, off) in zip(panels[1:], film_deviations(rows).items(), strict=True):
        axes.tricontourf(mesh, np.clip(off, -99, 99), LEVELS, cmap="RdBu_r", extend="both")
        lines = axes.tricontour(mesh, off, (-10, -5, 5, 10), colors="0.25", linewidths=0.6)
        axes.clabel(lines, fmt="%d %%", fontsize=7)
        axes.set_title(title, fontsize=9)
    words = "formula over computed film, less one [%]"
    picture.colorbar(panels[1].collections[0], ax=panels, label=words, ticks=LEVELS)
    _mark(panels, table, (load, speed))
    return picture


def film_deviations(table: "pd.DataFrame") -> dict[str, Array]:
    """Return films by formula over the computed ones, less one [%], by the name of the formula.

    Each array has a value for each converged case, in their order.
    """
    rows, deviations = converged(table), {}
    columns = (rows[f"groups.{name}"] for name in _GROUPS)
    cases = [
        Groups(**dict(zip(_GROUPS, case, strict=True)), deflection_factor=math.nan)
        for case in zip(*columns, strict=True)
    ]
    for name, formula, which in _FORMULAS:
        films = [getattr(formula(groups), which) or math.nan for groups in cases]
        by_formula = np.array(films) / np.sqrt([2.0 * groups.U for groups in cases])
        computed = rows[_COMPUTED[which]].to_numpy(np.float64, na_value=np.nan)
        deviations[name] = 100.0 * (by_formula / computed - 1.0)
    return deviations


def _mark(panels: Sequence[Axes], table: "pd.DataFrame", points: tuple[Array, Array]) -> None:
    """Show where the cases are, and which of them failed."""
    missing = table[table["status"] != "converged"].dropna(
        subset=[name for name in ("groups.M", "groups.L") if name in table]
    )
    for number, axes in enumerate(panels):
        axes.plot(*points, "k.", ms=1.2, alpha=0.5)
        if len(missing):
            axes.plot(missing["groups.M"], missing["groups.L"], "x", color=FAILED, ms=4)
        axes.set(xscale="log", yscale="log")
        axes.set(xlabel="M" if number > 2 else "", ylabel="L" if number % 3 == 0 else "")


def _mesh(x: Array, y: Array, log: str) -> Triangulation:
    """Return triangles between points in the scale of the axes; raise InputError for a line."""
    places: list[Any] = []
    for letter, values in (("x", x), ("y", y)):
        if letter in log and not (values > 0).all():
            raise InputError(f"the {letter} axis cannot be logarithmic: it has values up to zero")
        straight = np.log(values) if letter in log else values
        places.append((straight - straight.min()) / (np.ptp(straight) or 1.0))
    try:
        triangles = Triangulation(*places).triangles
    except (ValueError, RuntimeError):
        raise InputError("a map needs at least three cases that are not in one line") from None
    return Triangulation(x, y, triangles)
