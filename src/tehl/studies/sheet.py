"""Chosen columns of a table in chosen units, with the unit in each heading, as CSV or Excel."""

from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from tehl.base.atomic import replacing
from tehl.base.errors import InputError
from tehl.base.lazy import lazy
from tehl.base.units import Quantity

if TYPE_CHECKING:
    import pandas as pd

    from tehl.plots import table_columns
else:
    table_columns = lazy("tehl.plots.table_columns")

FORMATS = (".csv", ".xlsx")


def check_sheet(path: Path) -> None:
    """Raise if the format of a sheet is not supported, or needs a package that is missing."""
    ending = path.suffix.lower()
    if ending not in FORMATS:
        raise InputError(f"output {path}: format not supported; a sheet ends in .csv or .xlsx")
    if ending == ".xlsx" and find_spec("openpyxl") is None:
        raise InputError(f'output {path}: needs openpyxl; install it with pip install "tehl[xlsx]"')


def sheet(table: "pd.DataFrame", columns: Sequence[str]) -> "pd.DataFrame":
    """Return columns of a table in chosen units, each named with its unit in brackets.

    Parameters
    ----------
    table : pandas.DataFrame
        As :func:`tehl.studies.table` returns it.
    columns : sequence of str
        Names, of which the last part suffices, perhaps with a unit: ``"film.h_min_m [nm]"``,
        ``"max_pa [GPa]"``, ``"inlet_k [degC]"``. Without any all columns, in SI.

    Raises
    ------
    InputError
        If a column is missing or has another kind of unit.
    """
    units, found = table.attrs.get("units", {}), {}
    for wanted in columns or list(table.columns):
        name, _, bracket = (part.strip() for part in wanted.partition("["))
        full = table_columns.find_column(table, name)
        si, unit = units.get(full, "1"), bracket.rstrip("] ")
        factor, offset = _conversion(full, si, unit) if unit else (1.0, 0.0)
        shown = unit or si
        values = (table[full] - offset) / factor if unit else table[full]
        found[full if shown == "1" else f"{full} [{shown}]"] = values
    return type(table)(found)


def _conversion(name: str, si: str, unit: str) -> tuple[float, float]:
    """Return factor and offset to SI of a unit of a column."""
    if si == "1":
        raise InputError(f"column {name} [{unit}]: has no unit; leave out the brackets")
    quantity = Quantity(name=f"the unit of {name}", unit=si, example=f"1 {si}", sign="any")
    try:
        zero, one = (quantity.parse(f"{number} {unit}") for number in (0, 1))
    except ValueError as error:
        raise InputError(f"column {name} [{unit}]: {error}") from None
    if zero and "rise" in name:
        raise InputError(f"column {name} [{unit}]: is a difference; state it in K")
    return one - zero, zero


def write_sheet(table: "pd.DataFrame", path: Path, columns: Sequence[str]) -> None:
    """Write columns of a table as CSV or Excel, by the ending of ``path``; whole or not at all."""
    check_sheet(path)
    found = sheet(table, columns)
    with replacing(path) as temporary:
        if path.suffix.lower() == ".csv":
            found.to_csv(temporary, index=False)
        else:
            made = temporary.with_suffix(".xlsx")  # pandas chooses the writer by the ending
            try:
                found.to_excel(made, index=False, engine="openpyxl")
                made.replace(temporary)
            finally:
                made.unlink(missing_ok=True)
