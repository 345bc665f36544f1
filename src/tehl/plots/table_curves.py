"""Curves over a column of a table, with error bars where they are known."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tehl.errors import InputError
from tehl.plots.table_columns import (
    Column,
    answers,
    dress,
    find_column,
    kinds,
    note_left_out,
    numbers,
)
from tehl.typing import Array
from tehl.units import Quantity

if TYPE_CHECKING:
    import pandas as pd

COLOURS = ("#1f4e9c", "#c2410c", "#2f7d32", "#7b3fa0", "#b58900", "#0f8b8d", "#a3123f", "#555555")
_LINES = ("-", "--", ":", "-.")
_MARKS = ("o", "s", "^", "D", "v", "P")
_POINTS = "x+*1"
_MOST_CURVES = 40
_LARGEST_OVERLAY = 10**7


def curves(
    table: "pd.DataFrame",
    x: str,
    y: str,
    hue: str | None = None,
    style: str | None = None,
    log: str = "",
) -> Figure:
    """Draw ``y`` against ``x``, a curve for each combination of ``hue`` and ``style``.

    Parameters
    ----------
    table : pandas.DataFrame
        As :func:`tehl.studies.table` gives it. Cases that did not converge are left out, and
        counted below. Of certified cases the certified value is drawn, with its error bar.
    x, y : str
        Columns of numbers; the last part of a dotted name will do, and a minus turns the sign.
    hue, style : str or None
        Columns that tell curves apart, by colour and by line.
    log : {"", "x", "y", "xy"}
        Axes with a logarithmic scale.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.

    Raises
    ------
    InputError
        If a column is missing or there is nothing to draw.
    """
    rows = answers(table)
    across, up = numbers(rows, x), _certified(rows, numbers(rows, y))
    bars = _bars(rows, up)
    hues, styles = kinds(rows, hue), kinds(rows, style)
    if len(hues) * len(styles) > _MOST_CURVES:
        raise InputError(f"{len(hues) * len(styles)} curves are too many for a picture")
    picture = Figure(figsize=(7.0, 5.0), layout="constrained")
    axes = picture.add_subplot()
    for i, colour in enumerate(hues):
        for k, line in enumerate(styles):
            chosen = _chosen(rows, ((hue, colour), (style, line)))
            chosen &= np.isfinite(across.values) & np.isfinite(up.values)
            if not chosen.any():
                continue
            order = np.flatnonzero(chosen)[np.argsort(across.values[chosen], kind="stable")]
            axes.errorbar(
                across.values[order],
                up.values[order],
                yerr=None if bars is None else bars[order],
                color=COLOURS[i % len(COLOURS)],
                ls=_LINES[k % len(_LINES)],
                marker=_MARKS[k % len(_MARKS)],
                ms=4.0,
                lw=1.3,
                capsize=2.5,
                label=_name(rows, ((hue, colour), (style, line))),
            )
    dress(axes, across, up, log)
    note_left_out(axes, table)
    _legend(axes)
    return picture


def overlay(picture: Figure, table: "pd.DataFrame", x: str, y: str, *, path: Path) -> None:
    """Draw measured points of a CSV file into a picture of :func:`curves`.

    The first two columns are x and y, in SI or in the unit in brackets behind the name,
    ``film [nm]``; a column ``error`` gives bars, and a column ``name`` tells series apart.

    Parameters
    ----------
    picture : Figure
        What :func:`curves` made of ``table``, ``x`` and ``y``.
    table : pandas.DataFrame
        Says in which units the picture is.
    x, y : str
        Columns of the picture.
    path : Path
        The CSV file.

    Raises
    ------
    InputError
        If it cannot be read as such; the message names it.
    """
    points = _points(path)
    rows = answers(table)
    across, up = numbers(rows, x), numbers(rows, y)
    names = [str(name) for name in points.columns]
    values = [
        _in_si(points, name, column, path) * abs(column.factor)
        for name, column in zip(names, (across, up), strict=False)
    ]
    errors = [name for name in names[2:] if name.split("[")[0].strip() == "error"]
    bars = _in_si(points, errors[0], up, path) * abs(up.factor) if errors else None
    series = points["name"].astype(str) if "name" in names else None
    axes = picture.axes[0]
    for number, name in enumerate(["measured"] if series is None else dict.fromkeys(series)):
        chosen = np.ones(len(points), bool) if series is None else (series == name).to_numpy()
        axes.errorbar(
            values[0][chosen],
            values[1][chosen],
            yerr=None if bars is None else bars[chosen],
            fmt=f"k{_POINTS[number % len(_POINTS)]}",
            ms=6.0,
            capsize=2.0,
            lw=1.0,
            label=name,
        )
    _legend(axes)


def _points(path: Path) -> "pd.DataFrame":
    import pandas as pd  # noqa: PLC0415 (0.5 s, and only for overlays)

    try:
        if path.stat().st_size > _LARGEST_OVERLAY:
            raise InputError(f"{path} is larger than 10 MB, so no list of measured points")
        points = pd.read_csv(path, skipinitialspace=True)
    except FileNotFoundError:
        raise InputError(f"there is no file of measured points {path}") from None
    except (OSError, ValueError) as error:
        reason = str(error).partition("\n")[0]
        raise InputError(f"{path} cannot be read as measured points: {reason}") from None
    if points.shape[1] < 2 or not len(points):
        raise InputError(f"{path} has no measured points: give two columns, x and y, with names")
    return points


def _in_si(points: "pd.DataFrame", name: str, column: Column, path: Path) -> Array:
    """Return a column of measured points in SI."""
    try:
        values = points[name].to_numpy(np.float64)
    except ValueError:
        raise InputError(f"{path}: the column {name} does not hold numbers") from None
    _, bracket, rest = name.partition("[")
    if not bracket:
        return values
    si = "-" if column.si == "1" else column.si
    quantity = Quantity(name=f"the unit of {column.name}", unit=si, example=si, sign="any")
    try:
        factor = quantity.parse(f"1 {rest.rstrip('] ')}")
    except ValueError as error:
        raise InputError(f"{path}: the column {name} {error}") from None
    return values * factor


def _certified(rows: "pd.DataFrame", up: Column) -> Column:
    """Return the column with certified values where there are any."""
    name = f"uncertainty.{up.name}.value"
    if name not in rows:
        return up
    known = rows[name].to_numpy(np.float64, na_value=np.nan) * up.factor
    values = np.where(np.isfinite(known), known, up.values)
    return Column(name=up.name, values=values, factor=up.factor, unit=up.unit, si=up.si)


def _bars(rows: "pd.DataFrame", up: Column) -> Array | None:
    name = f"uncertainty.{up.name}.uncertainty"
    if name not in rows:
        return None
    found = rows[name].to_numpy(np.float64, na_value=np.nan)
    return np.nan_to_num(found) * abs(up.factor)


def _chosen(rows: "pd.DataFrame", wanted: tuple[tuple[str | None, Any], ...]) -> Any:
    chosen = np.ones(len(rows), bool)
    for name, value in wanted:
        if name is not None:
            chosen &= (rows[find_column(rows, name)] == value).to_numpy()
    return chosen


def _name(rows: "pd.DataFrame", wanted: tuple[tuple[str | None, Any], ...]) -> str | None:
    """Return what to call a curve."""
    parts = []
    for name, value in wanted:
        if name is None:
            continue
        if isinstance(value, str):
            parts.append(value)
            continue
        full = find_column(rows, name)
        unit = rows.attrs.get("units", {}).get(full, "1")
        short = full.rpartition(".")[2].replace("_", " ")
        parts.append(f"{short} = {value:.4g}" + ("" if unit == "1" else f" {unit}"))
    return ", ".join(parts) or None


def _legend(axes: Axes) -> None:
    if axes.get_legend_handles_labels()[1]:
        axes.legend(fontsize=8, frameon=False)
