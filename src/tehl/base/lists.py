"""Lists of cases, of values and of measured points in Excel and CSV files of spreadsheets."""

import csv
import re
import tomllib
from collections.abc import Sequence
from contextlib import closing
from importlib.util import find_spec
from io import StringIO
from pathlib import Path
from typing import Any

from tehl.base.atomic import shortened
from tehl.base.encoding import decoded
from tehl.base.errors import InputError

_DECIMAL_COMMA = re.compile(r"^([+-]?\d+),(\d+)(?=[eE\s]|$)")
_UNIT = re.compile(r"(.*?)\s*\[(.*)\]\s*")
_LARGEST_LIST = 50_000_000
"""Bytes of a list."""
_PACKAGES = {".xlsx": ("openpyxl", "xlsx"), ".parquet": ("pyarrow", "parquet")}
"""Packages of formats, and the extras that install them."""


def values_of_file(path: Path, column: str) -> list[Any]:
    """Return the values of one column of a CSV file, with the unit of its heading.

    Parameters
    ----------
    path : Path
        CSV with a first line of headings, such as ``load [N]``.
    column : str
        Heading without its unit; a file with a single column may have any.

    Raises
    ------
    InputError
        If the column is missing or the file cannot be read; the message names file and columns.
    """
    shown = shortened(path)
    lines = lines_of_file(path)
    headings = [heading(cell) for cell in lines[0]] if lines else []
    names = [name for name, _ in headings]
    if len(lines) < 2 or (column not in names and len(names) > 1):
        found = f"its columns are {', '.join(names)}" if names else "it is empty"
        raise InputError(f"{shown}: values of {column} are missing; {found}")
    place = names.index(column) if column in names else 0
    return [value_of(line[place], headings[place][1]) for line in lines[1:] if line[place]]


def lines_of_file(path: Path, what: str = "list of cases") -> list[list[str]]:
    """Return the cells of the lines of a file that are not empty, all of the same number.

    Parameters
    ----------
    path : Path
        ``.xlsx`` is read as Excel, its first sheet; all others as CSV.
    what : str
        How messages call the file.
    """
    return [line for _, line in numbered_lines(path, what)]


def numbered_lines(path: Path, what: str = "list of cases") -> list[tuple[int, list[str]]]:
    """Return the lines of :func:`lines_of_file` with their numbers in the file.

    Parameters
    ----------
    path : Path
        Excel or CSV, whose delimiter is found from the first line.
    what : str
        How messages call the file.

    Raises
    ------
    InputError
        If the file is missing, too large or cannot be read, or its lines differ in length.
    """
    if path.suffix.lower() == ".xlsx":
        return [
            (number, ["" if cell is None else str(cell) for cell in line])
            for number, line in lines_of_sheet(path, what)
        ]
    shown = shortened(path)
    try:
        if path.stat().st_size > _LARGEST_LIST:
            raise InputError(f"{shown} is larger than {_LARGEST_LIST // 10**6} MB, so not a {what}")
        file = StringIO(decoded(path.read_bytes()), newline="")
        reader = csv.reader(file, delimiter=_delimiter(file.readline()))
        file.seek(0)
        lines = [(reader.line_num, [cell.strip() for cell in line]) for line in reader]
        if reader.dialect.delimiter != ",":
            lines = [(number, [_pointed(cell) for cell in line]) for number, line in lines]
    except FileNotFoundError:
        raise InputError(f"{what} {shown} does not exist") from None
    except (OSError, UnicodeError, csv.Error) as error:
        raise InputError(f"{shown} cannot be read as a {what}: {error}") from None
    lines = [(number, line) for number, line in lines if any(line)]
    for number, line in lines:
        if len(line) != len(lines[0][1]):
            raise InputError(
                f"{shown}: line {number} has {len(line)} cells, but the first has "
                f"{len(lines[0][1])}"
            )
    return lines


def lines_of_sheet(path: Path, what: str = "list of cases") -> list[tuple[int, list[Any]]]:
    """Return the numbers and the cells of the rows of the first Excel sheet that are not empty.

    All rows have as many cells as the first one has headings; an empty cell is None.

    Parameters
    ----------
    path : Path
        An ``.xlsx`` file; formulas have the values that Excel stored.
    what : str
        How messages call the file.
    """
    check_package("openpyxl", "xlsx", path)
    from openpyxl import load_workbook  # noqa: PLC0415 (an extra)

    if not path.exists():
        raise InputError(f"{what} {shortened(path)} does not exist")
    try:
        book = load_workbook(path, read_only=True, data_only=True)
    except Exception as error:  # openpyxl has no common base of its errors
        raise InputError(f"{shortened(path)} cannot be read as Excel: {error}") from None
    with closing(book):
        found = [
            (number, [stripped(cell) for cell in line])
            for number, line in enumerate(book.worksheets[0].iter_rows(values_only=True), 1)
        ]
    found = [(number, line) for number, line in found if any(cell is not None for cell in line)]
    width = max((k + 1 for _, line in found[:1] for k, one in enumerate(line) if one), default=0)
    return [(number, (line + [None] * width)[:width]) for number, line in found]


def stripped(cell: Any) -> Any:
    """Return a cell without blanks around its text; None if nothing is left."""
    return (cell.strip() or None) if isinstance(cell, str) else cell


def check_format(path: Path, endings: Sequence[str], what: str) -> None:
    """Raise an InputError if a file has none of the endings, or its format needs a package."""
    ending = path.suffix.lower()
    if ending not in endings:
        known = " or ".join(endings)
        raise InputError(f"output {path}: format not supported; {what} ends in {known}")
    if ending in _PACKAGES:
        check_package(*_PACKAGES[ending], path)


def check_package(package: str, extra: str, path: Path) -> None:
    """Check that a package for a format is installed.

    Parameters
    ----------
    package : str
        Name by which it is imported.
    extra : str
        Extra of this package that installs it.
    path : Path
        File that needs it, named by the message.

    Raises
    ------
    InputError
        If it is missing; the message has the command that installs it.
    """
    if find_spec(package) is None:
        raise InputError(f'{path}: needs {package}; install it with pip install "tehl[{extra}]"')


def _delimiter(first: str) -> str:
    """Return what separates the cells of a list: semicolon, tab or comma."""
    return next((mark for mark in ";\t" if mark in first), ",")


def _pointed(cell: str) -> str:
    """Return a cell with a decimal point in place of a decimal comma."""
    return _DECIMAL_COMMA.sub(r"\1.\2", cell)


def heading(cell: str) -> tuple[str, str]:
    """Return the name and the unit of a column."""
    match = _UNIT.fullmatch(cell)
    return (match[1], match[2].strip()) if match else (cell, "")


def value_of(cell: str, unit: str) -> object:
    """Return the value of a cell of a column with a unit.

    Parameters
    ----------
    cell : str
        Stripped text of the cell.
    unit : str
        Of the heading; empty, "-" and "1" leave a plain number, text or truth value.
    """
    return f"{cell} {unit}" if unit not in ("", "-", "1") else plain_value(cell)


def plain_value(text: str) -> object:
    """Return a value as TOML reads it, or the text itself if it is not TOML."""
    try:
        tables = tomllib.loads(f"value = {text}")
    except ValueError:
        return text
    return tables["value"] if len(tables) == 1 else text
