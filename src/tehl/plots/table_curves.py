"""Curves over a column of a table, with error bars where they are known."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tehl.base.errors import InputError
from tehl.base.lists import lines_of_file
from tehl.base.typing import Array
from tehl.base.units import Quantity
from tehl.plots.frame import BLUE, ORANGE, PLAIN, empty, figure_of
from tehl.plots.table_columns import Column, certified, converged, dress, find_column, numbers

if TYPE_CHECKING:
    import pandas as pd

COLOURS = (BLUE, ORANGE, "#2f7d32", "#7b3fa0", "#b58900", "#0f8b8d", "#a3123f", "#555555")
_LINES = ("-", "--", ":", "-.")
_MARKS = ("o", "s", "^", "D", "v", "P")
_POINTS = "x+*1"


def curves(  # noqa: PLR0913 (one call, as in other libraries of pictures)
    table: "pd.DataFrame",
    x: str,
    y: str,
    hue: str | None = None,
    style: str | None = None,
    log: str = "",
    *,
    ax: Axes | None = None,
    title: str | None = None,
) -> Figure:
    """Draw ``y`` against ``x``, a curve for each combination of ``hue`` and ``style``.

    Axes of the study that are not named distinguish curves too, where several cases have one x;
    where that does not suffice, or the other axes wander along x as samples do, cases are points
    without a line.

    Parameters
    ----------
    table : pandas.DataFrame
        As :func:`tehl.studies.table` returns it. Cases that did not converge are left out, and
        counted below. Of certified cases the certified value is drawn with its error bar, of others
        the value with its estimated error.
    x, y : str
        Columns of numbers; the last part of a dotted name suffices, and a minus turns the sign.
    hue, style : str or None
        Columns that distinguish curves, by colour and by line.
    log : {"", "x", "y", "xy"}
        Axes with a logarithmic scale.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : str or None
        Title above the curves.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.

    Raises
    ------
    InputError
        If a column is missing or there is nothing to draw.
    """
    rows = converged(table)
    across = numbers(rows, x)
    up, bars = certified(rows, numbers(rows, y))
    hue, style, joined = _distinguished(rows, across.name, hue, style)
    hues, styles = _distinct(rows, hue), _distinct(rows, style)
    if len(hues) * len(styles) > 40:
        raise InputError(f"{len(hues) * len(styles)} curves are too many for a picture")
    axes = empty(ax)
    for i, one in enumerate(hues):
        for k, other in enumerate(styles):
            chosen, name = _chosen(rows, ((hue, one), (style, other)))
            chosen &= np.isfinite(across.values) & np.isfinite(up.values)
            if not chosen.any():
                continue
            order = np.flatnonzero(chosen)[np.argsort(across.values[chosen], kind="stable")]
            line = _LINES[k % len(_LINES)] if joined else "none"
            look: dict[str, Any] = {"ls": line, "lw": 1.3, "capsize": 2.5}
            look |= {"marker": _MARKS[k % len(_MARKS)], "ms": 4.0, "label": name}
            colour, error = COLOURS[i % len(COLOURS)], None if bars is None else bars[order]
            axes.errorbar(across.values[order], up.values[order], error, color=colour, **look)
    dress(axes, table, (across, up), log, title)
    _legend(axes)
    return figure_of(axes)


def _distinguished(
    rows: "pd.DataFrame", x: str, hue: str | None, style: str | None
) -> tuple[str | None, str | None, bool]:
    """Return hue and style that leave one case per x on each curve, and whether to join cases."""
    keys = [find_column(rows, name) for name in (hue, style) if name is not None]
    labels = [str(name) for name in rows.columns[: list(rows.columns).index("status")]]
    varied = [n for n in labels if n not in (x, "name", *keys) and 1 < rows[n].nunique()]
    for name in varied:
        if None not in (hue, style) or not rows.duplicated([x, *keys]).any():
            break
        if rows[name].nunique() <= len(COLOURS) and rows.duplicated([x, *keys, name]).sum() < (
            rows.duplicated([x, *keys]).sum()
        ):
            hue, style = (name, style) if hue is None else (hue, name)
            keys.append(name)
    joined = not rows.duplicated([x, *keys]).any()
    return hue, style, joined and not any(_wanders(rows, x, n) for n in varied if n not in keys)


def _wanders(rows: "pd.DataFrame", x: str, name: str) -> bool:
    """Return whether a column of numbers goes up and down along x, as that of a sample does."""
    values = rows.sort_values(x, kind="stable").groupby(x, sort=True)[name].first()
    if values.dtype == object:
        return False
    return not (values.is_monotonic_increasing or values.is_monotonic_decreasing)


def _distinct(table: "pd.DataFrame", name: str | None) -> list[Any]:
    """Return the different values of a column in their order; one None without a column."""
    if name is None:
        return [None]
    values = table[find_column(table, name)].dropna().unique().tolist()
    return sorted(values) if all(isinstance(v, int | float) for v in values) else values


def _chosen(
    rows: "pd.DataFrame", wanted: tuple[tuple[str | None, Any], ...]
) -> tuple[Any, str | None]:
    """Return which rows have the wanted values, and the name of their curve."""
    chosen, parts = np.ones(len(rows), bool), []
    for name, value in wanted:
        if name is None:
            continue
        full = find_column(rows, name)
        chosen &= (rows[full] == value).to_numpy()
        if isinstance(value, str):
            parts.append(value)
            continue
        column, short = numbers(rows, full), full.rpartition(".")[2].replace("_", " ")
        unit = "" if column.unit == "1" else f" {column.unit}"
        parts.append(f"{short} = {column.shown(value):.4g}{unit}")
    return chosen, ", ".join(parts) or None


def overlay(picture: Figure, table: "pd.DataFrame", x: str, y: str, *, path: Path) -> None:
    """Draw measured points of a CSV file into a picture of :func:`curves`.

    The first two columns are x and y, in SI or in the unit in brackets behind the name,
    ``film [nm]``; a column ``error`` gives bars, and a column ``name`` distinguishes series.
    Semicolons or tabs may separate the cells, and then commas be decimal.

    Parameters
    ----------
    picture : Figure
        What :func:`curves` made of ``table``, ``x`` and ``y``.
    table : pandas.DataFrame
        Determines the units of the picture.
    x, y : str
        Columns of the picture.
    path : Path
        The CSV file.

    Raises
    ------
    InputError
        If it cannot be read as such; the message names it.
    """
    points, rows = _points(path), converged(table)
    columns = numbers(rows, x), numbers(rows, y)
    names = [str(name) for name in points.columns]
    x_values, y_values = (
        _as_shown(points, *pair, path) for pair in zip(names, columns, strict=False)
    )
    bars = [n for n in names[2:] if n.split("[")[0].strip() == "error"]
    difference = replace(columns[1], offset=0.0)
    errors = _as_shown(points, bars[0], difference, path) if bars else None
    series = points["name"].astype(str) if "name" in names else np.full(len(points), "measured")
    axes = picture.axes[0]
    for number, name in enumerate(dict.fromkeys(series)):
        chosen = np.asarray(series == name)
        look: dict[str, Any] = {"ms": 6.0, "capsize": 2.0, "lw": 1.0, "label": name}
        error, mark = None if errors is None else errors[chosen], _POINTS[number % len(_POINTS)]
        axes.errorbar(x_values[chosen], y_values[chosen], error, fmt=f"k{mark}", **look)
    _legend(axes)


def _points(path: Path) -> "pd.DataFrame":
    import pandas as pd  # noqa: PLC0415 (0.5 s, and only for overlays)

    lines = lines_of_file(path, "file of measured points")
    points = pd.DataFrame(lines[1:], columns=lines[0] if lines else None).replace("", "nan")
    if points.shape[1] < 2 or not len(points):
        raise InputError(f"{path} has no measured points: give two columns, x and y, with names")
    return points


def _as_shown(points: "pd.DataFrame", name: str, column: Column, path: Path) -> Array:
    """Return a column of measured points in the unit of the picture."""
    try:
        values = points[name].to_numpy(np.float64)
    except ValueError:
        raise InputError(f"{path}: the column {name} does not hold numbers") from None
    _, bracket, rest = name.partition("[")
    factor, zero = 1.0, 0.0
    if bracket:
        si = "-" if column.si == "1" else column.si
        quantity = Quantity(name=f"the unit of {column.name}", unit=si, example=si, sign="any")
        try:
            zero, one = (quantity.parse(f"{one} {rest.rstrip('] ')}") for one in (0, 1))
        except ValueError as error:
            raise InputError(f"{path}: the column {name} {error}") from None
        factor, zero = one - zero, zero if column.offset else 0.0  # differences have no zero
    return (values * factor + zero) * abs(column.factor) + column.offset


def _legend(axes: Axes) -> None:
    if axes.get_legend_handles_labels()[1]:
        axes.legend(**PLAIN)
