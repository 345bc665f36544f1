"""Columns of a table as they are shown: names, units that suit, axes."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.result.quantity import UNITS
from tehl.result.registry import in_summary, shown_in

if TYPE_CHECKING:
    import pandas as pd

FAILED = "#b3001b"
"""Colour of notes on cases that did not converge."""
_KEYS = {
    "supply.ratio": "supply over that of the flooded contact r",
    "supply.layer": "layer of oil",
    "contact.slide_roll_ratio": "slide-to-roll ratio $(u_1 - u_2)/u_m$",
    "contact.entrainment_speed": "entrainment speed $u_m$",
    "contact.load": "load $w$",
    "lubricant.temperature": "temperature of the oil",
    "contact.hertz_pressure": "Hertz pressure $p_h$",
    "contact.moes_load": "M",
    "contact.moes_speed": "L",
}
"""Labels of axes along keys of the case; those of numbers are in `tehl.result.quantities`."""
_SUITABLE: dict[str, tuple[tuple[float, float, str], ...]] = {
    "m": ((1e-7, 1e9, "nm"), (1e-3, 1e6, "µm"), (1.0, 1e3, "mm")),
    "Pa": ((1e4, 1.0, "Pa"), (3e8, 1e-6, "MPa"), (np.inf, 1e-9, "GPa")),
    "Pa s": ((0.1, 1e3, "mPa s"),),
}
"""By SI unit: up to which value, by which factor, to which unit."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Column:
    """Numbers of a table in the unit in which they are shown."""

    name: str
    values: Array
    factor: float
    """From SI to what is shown; negative where the sign is turned."""
    unit: str
    si: str
    """Unit as shown, and in SI; ``"1"`` where there is none."""
    offset: float = 0.0
    """Added after the factor: temperatures are shown in degrees Celsius, rises in kelvin."""

    def shown(self, values: Array) -> Array:
        """Return values in SI in the unit that is shown."""
        return values * self.factor + self.offset

    @property
    def title(self) -> str:
        """Label of an axis."""
        labels = {one.path: one.words["axis"] for one in shown_in("axis")} | _KEYS
        words = labels.get(self.name, self.name.replace("_", " "))
        return words if self.unit == "1" else f"{words} [{self.unit}]"


def find_column(table: "pd.DataFrame", name: str) -> str:
    """Return the full name of a column; its last part suffices where it is unique.

    An axis of the study precedes a number of the same name.

    Parameters
    ----------
    table : DataFrame
        Of a study.
    name : str
        Full path such as ``film.central``, or its last part.

    Raises
    ------
    InputError
        If there is no such column, or several.
    """
    names = [str(known) for known in table.columns]
    if name in names:
        return name
    values = [known for known in names if not known.startswith("uncertainty.")]
    alike = [known for known in values if known.endswith(f".{name}")]
    labels = [known for known in alike if known in names[: names.index("status")]]
    if 1 in (len(alike), len(labels)):
        return (labels or alike)[0]
    if alike:
        raise InputError(f"the table has several columns {name}: {', '.join(alike)}")
    close = [known for known in values if name.lower() in known.lower()][:6]
    hint = f"did you mean {' or '.join(close)}?" if close else f"it has {', '.join(names[:12])} ..."
    raise InputError(f"the table has no column {name}: {hint}")


def numbers(table: "pd.DataFrame", name: str) -> Column:
    """Return a column of numbers in a unit that suits.

    Parameters
    ----------
    table : DataFrame
        Of a study, with the units of its columns in ``attrs``.
    name : str
        Path or last part of it, with a minus to turn the sign.

    Raises
    ------
    InputError
        If the column does not hold numbers.
    """
    full = find_column(table, name.removeprefix("-"))
    try:
        values = table[full].to_numpy(np.float64, na_value=np.nan)
    except (TypeError, ValueError):
        raise InputError(f"the column {full} does not hold numbers") from None
    si = table.attrs.get("units", {}).get(full, "1")
    largest = np.abs(values[np.isfinite(values)]).max(initial=0.0)
    suitable = (one[1:] for one in _SUITABLE.get(si, ()) if largest < one[0])
    factor, unit = next(suitable, (1.0, si))
    factor, offset = -factor if name.startswith("-") else factor, 0.0
    if si == "K" and "rise" not in full and not name.startswith("-"):
        unit, offset = "°C", UNITS["°C"][1]
    return Column(
        name=full,
        values=values * factor + offset,
        factor=factor,
        unit=unit,
        si=si,
        offset=offset,
    )


def certified(rows: "pd.DataFrame", column: Column) -> tuple[Column, Array | None]:
    """Return a column with certified values where there are any, and its error bars.

    The bar of a value that is not certified is its estimated error.

    Parameters
    ----------
    rows : DataFrame
        Rows of the table that are drawn.
    column : Column
        Values on the grids of the cases, with the factor of their unit.

    Returns
    -------
    column : Column
        With values extrapolated from several grids where there are any.
    bars : Array or None
        In the unit of the column; None without any estimate.
    """
    name = f"uncertainty.{column.name}"
    estimated = _estimated(rows, column)
    if f"{name}.value" not in rows:
        return column, estimated
    known, bars = (
        rows[f"{name}.{part}"].to_numpy(np.float64, na_value=np.nan)
        for part in ("value", "uncertainty")
    )
    values = np.where(np.isfinite(known), column.shown(known), column.values)
    fallback = np.zeros(len(rows)) if estimated is None else estimated
    bars = np.where(np.isfinite(bars), bars * abs(column.factor), fallback)
    return replace(column, values=values), bars


def _estimated(rows: "pd.DataFrame", column: Column) -> Array | None:
    """Return the estimated errors of a column, None where there are none."""
    known = (one.error_path for one in in_summary() if one.path == column.name)
    error = next(known, "")
    if error not in rows:
        return None
    relative = rows[error].to_numpy(np.float64, na_value=np.nan)
    return np.nan_to_num(np.abs(relative * column.values))


def converged(table: "pd.DataFrame") -> "pd.DataFrame":
    """Return the rows that converged; raise InputError if there are none."""
    found = table[table["status"] == "converged"]
    if not len(found):
        raise InputError("the table has no case that converged, so nothing to draw")
    return found


def dress(
    axes: Axes,
    table: "pd.DataFrame",
    columns: tuple[Column, Column],
    log: str,
    title: str | None,
) -> None:
    """Give axes their titles, scales, a light grid, and a note on cases that are not shown.

    Parameters
    ----------
    axes : Axes
        With everything drawn.
    table : pandas.DataFrame
        All cases; those that failed or are not finished are counted below the axes.
    columns : (Column, Column)
        Along x and y.
    log : {"", "x", "y", "xy"}
        Axes with a logarithmic scale.
    title : str or None
        Title above the axes.
    """
    if title:
        axes.set_title(title.replace("$", r"\$"), fontsize=10)
    axes.set(xlabel=columns[0].title, ylabel=columns[1].title)
    for letter in log:
        axes.set(**{f"{letter}scale": "log"})
        axis = axes.xaxis if letter == "x" else axes.yaxis
        low, high = axis.get_view_interval()
        if 0 < low and high / low < 2e3:  # few decades: numbers at 2 and 5 too
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    axes.grid(lw=0.3, which="both" if log else "major")
    open_cases = int((table["status"] == "open").sum())
    failed = int((table["status"] != "converged").sum()) - open_cases
    notes = [f"{failed} of {len(table)} cases failed and are left out"] if failed else []
    notes += [f"{open_cases} of {len(table)} are not finished yet"] if open_cases else []
    if notes:
        axes.figure.supxlabel("; ".join(notes), fontsize=8, color=FAILED)
