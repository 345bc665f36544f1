"""Lists of cases, of values and of measured points in Excel and CSV files of spreadsheets."""

import csv
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from importlib.util import find_spec
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tehl.base.atomic import shortened
from tehl.base.encoding import decoded
from tehl.base.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

_DECIMAL_COMMA = re.compile(r"^([+-]?\d+),(\d+)(?=[eE\s]|$)")
_DECIMAL_POINT = re.compile(r"^([+-]?\d+)\.(\d+)(?=[eE\s]|$)")
_THOUSANDS = re.compile(r"^([+-]?\d{1,3}(?:\.\d{3})+)(?=,\d|$)")
"""Thousands parted by points, which Excel writes beside decimal commas."""
_STATED_DELIMITER = re.compile(r'"?sep=(.)"?\s*', re.IGNORECASE)
"""A first line of Excel that states what parts the cells."""
_UNIT = re.compile(r"(.*?)\s*\[(.*)\]\s*")
LARGEST_LIST = 50_000_000
"""Bytes of a list."""
_PACKAGES = {".xlsx": ("openpyxl", "xlsx"), ".parquet": ("pyarrow", "parquet")}
"""Packages of formats, and the extras that install them."""


class Doubtful(str):
    """A cell such as ``1.234`` among decimal commas: twelve hundred, or a little more than one."""

    __slots__ = ()

    @property
    def mistake(self) -> str:
        """What is wrong with it where a number is needed."""
        fraction = f" or {self.replace('.', ',')}" if self.count(".") == 1 else ""
        return (
            f"{self} has a point, but this list has decimal commas: "
            f"write {self.replace('.', '')}{fraction}"
        )


@dataclass(frozen=True, slots=True)
class Spelling:
    """What parts the cells of a CSV file, the decimal mark of its numbers, and its encoding."""

    delimiter: str = ","
    decimal: str = "."
    encoding: str = "utf-8"

    def write(self, frame: "pd.DataFrame", path: Path) -> None:
        """Write a frame as CSV, and numbers in its texts alike.

        Parameters
        ----------
        frame : pandas.DataFrame
            Numbers, and texts as they were read, with decimal points.
        path : Path
            The file.
        """
        if self.decimal == ",":
            texts = frame.select_dtypes(exclude="number").columns
            frame = frame.assign(**{name: frame[name].map(_with_comma) for name in texts})
        frame.to_csv(
            path, index=False, sep=self.delimiter, decimal=self.decimal, encoding=self.encoding
        )


def spelling_of(path: Path) -> Spelling:
    """Return the spelling of a list; of an Excel or Parquet file the usual one.

    Parameters
    ----------
    path : Path
        A file that `lines_of` reads.
    """
    if path.suffix.lower() in _READERS:
        return Spelling()
    content = path.read_bytes()
    text = decoded(content)
    # a spreadsheet program that does not write plain UTF-8 reads it by the mark at its beginning
    is_plain = text.encode("utf-8") == content
    return replace(_spelling(text), encoding="utf-8" if is_plain else "utf-8-sig")


def _spelling(text: str) -> Spelling:
    lines = text.splitlines() or [""]
    delimiter = _delimiter(lines[0])
    numbers = (cell.strip() for line in lines for cell in line.split(delimiter))
    has_comma = delimiter != "," and any(
        _DECIMAL_COMMA.match(_THOUSANDS.sub(_joined, cell)) for cell in numbers
    )
    return Spelling(delimiter, "," if has_comma else ".")


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
    """Return the cells of :func:`lines_of` as texts, without the numbers of the lines."""
    lines = lines_of(path, what)
    for number, cells in lines:
        for cell in cells:
            if isinstance(cell, Doubtful):
                raise InputError(f"{shortened(path)}: line {number}: {cell.mistake}")
    return [["" if cell is None else str(cell) for cell in line] for _, line in lines]


def lines_of(path: Path, what: str = "list of cases") -> list[tuple[int, list[Any]]]:
    """Return the numbers and the cells of the lines of a file that are not empty, headings first.

    All lines have as many cells as the first one; an empty cell is None, and one that may be two
    numbers is `Doubtful`.

    Parameters
    ----------
    path : Path
        ``.xlsx`` is read as Excel, its first sheet, with the values of formulas that it stored;
        ``.parquet`` as Parquet; all others as CSV, whose delimiter is found from the first line.
    what : str
        How messages call the file.

    Raises
    ------
    InputError
        If the file is missing, too large or cannot be read, or its lines differ in length.
    """
    ending, shown = path.suffix.lower(), shortened(path)
    if ending in (".toml", ".nc"):
        raise InputError(f"{shown} is not a {what}: expected .csv, .xlsx or .parquet")
    _check_package(ending, path)
    kind, read = _READERS.get(ending, (f"a {what}", _csv))
    try:
        if path.stat().st_size > LARGEST_LIST:
            raise InputError(f"larger than {LARGEST_LIST // 10**6} MB, so not a {what}")
        return _filled(read(path))
    except FileNotFoundError:
        raise InputError(f"{what} {shown} does not exist") from None
    except InputError as error:
        raise InputError(f"{shown}: {error}") from None
    except OSError as error:
        raise InputError(f"{shown}: cannot be read ({error.strerror or error})") from None
    except Exception as error:  # openpyxl and pyarrow have no common base of their errors
        raise InputError(f"{shown} cannot be read as {kind}: {error}") from None


def _filled(rows: Iterable[tuple[int, list[Any]]]) -> list[tuple[int, list[Any]]]:
    """Return the rows that are not empty, all as long as the first one."""
    stripped_rows = ((number, [stripped(cell) for cell in line]) for number, line in rows)
    lines = [(n, line) for n, line in stripped_rows if any(cell is not None for cell in line)]
    for number, line in lines:
        if (width := len(lines[0][1])) != len(line):
            raise InputError(f"line {number} has {len(line)} cells, but the first has {width}")
    return lines


def _csv(path: Path) -> Iterator[tuple[int, list[str]]]:
    text = decoded(path.read_bytes())
    spelling = _spelling(text)
    file = StringIO(text, newline="")
    skipped = _STATED_DELIMITER.fullmatch(file.readline()) is not None
    if not skipped:
        file.seek(0)
    for number, line in _records(file, spelling.delimiter, 1 + skipped):
        cells = [cell.strip() for cell in line]
        yield number, [_of_commas(cell) for cell in cells] if spelling.decimal == "," else cells


def _records(file: StringIO, delimiter: str, first: int) -> Iterator[tuple[int, list[str]]]:
    """Yield the cells of the lines of a CSV file, and where each ends."""
    reader = csv.reader(file, delimiter=delimiter, strict=True)
    begun = first
    try:
        for line in reader:
            yield reader.line_num + first - 1, line
            begun = reader.line_num + first
    except csv.Error:
        raise InputError(f"line {begun}: a quote is not closed, or has more behind it") from None


def _sheet(path: Path) -> list[tuple[int, list[Any]]]:
    """Return the rows of the first Excel sheet; as wide as there are headings."""
    from openpyxl import load_workbook  # noqa: PLC0415 (an extra)

    width, lines = 0, []
    with closing(load_workbook(path, read_only=True, data_only=True)) as book:
        for line in book.worksheets[0].iter_rows(values_only=True):
            if not width:
                width = max((k + 1 for k, cell in enumerate(line) if stripped(cell)), default=0)
            lines.append([*line, *[None] * width][:width])
    texts = [cell.strip() for line in lines for cell in line if isinstance(cell, str)]
    if any((found := _DECIMAL_COMMA.match(cell)) and len(found[2]) != 3 for cell in texts):
        lines = [
            [_of_commas(cell.strip()) if isinstance(cell, str) else cell for cell in line]
            for line in lines
        ]
    if not any(cell is None for line in lines for cell in line):
        return list(enumerate(lines, 1))
    # an empty cell would be that of the template: a formula without its value must not look empty
    with closing(load_workbook(path, read_only=True)) as book:
        for row in book.worksheets[0].iter_rows(max_col=width):
            for cell in row:
                formula = isinstance(cell.value, str) and cell.value.startswith("=")
                if formula and lines[cell.row - 1][cell.column - 1] is None:
                    raise InputError(
                        f"cell {cell.coordinate} has a formula without its value: open the file "
                        "in a spreadsheet program and save it"
                    )
    return list(enumerate(lines, 1))


def _parquet(path: Path) -> list[tuple[int, list[Any]]]:
    import pandas as pd  # noqa: PLC0415 (0.5 s)

    return lines_of_frame(pd.read_parquet(path))


def lines_of_frame(frame: "pd.DataFrame") -> list[tuple[int, list[Any]]]:
    """Return headings and rows of a frame as :func:`lines_of`; the first row has number 1."""
    if not hasattr(frame, "columns"):
        kind = type(frame).__name__
        raise InputError(
            f"frame: must be a pandas.DataFrame, not {kind}; pandas.read_csv reads one"
        )
    head = [(0, [str(name) for name in frame.columns])]
    empty = frame.isna().to_numpy()
    values = frame.astype(object).to_numpy()
    return head + [
        (
            number,
            [None if none else stripped(_plain(cell)) for cell, none in zip(*row, strict=True)],
        )
        for number, row in enumerate(zip(values, empty, strict=True), 1)
    ]


def _plain(cell: Any) -> Any:
    return cell.item() if hasattr(cell, "item") else cell


_READERS: dict[str, tuple[str, Callable[[Path], Iterable[tuple[int, list[Any]]]]]] = {
    ".xlsx": ("Excel", _sheet),
    ".parquet": ("Parquet", _parquet),
}
"""What messages call a format, and how it is read, by the ending of the file."""


def stripped(cell: Any) -> Any:
    """Return a cell without blanks around its text; None if nothing is left."""
    is_text = isinstance(cell, str) and not isinstance(cell, Doubtful)
    return (cell.strip() or None) if is_text else cell


def check_format(path: Path, endings: Sequence[str], what: str) -> None:
    """Raise an InputError if a file has none of the endings, or its format needs a package."""
    ending = path.suffix.lower()
    if ending not in endings:
        known = " or ".join(endings)
        raise InputError(f"output {path}: format not supported; {what} ends in {known}")
    _check_package(ending, path)


def _check_package(ending: str, path: Path) -> None:
    """Raise an InputError if the package that a format needs is missing."""
    package, extra = _PACKAGES.get(ending, (None, None))
    if package is not None and find_spec(package) is None:
        raise InputError(f'{path}: needs {package}; install it with pip install "tehl[{extra}]"')


def _delimiter(first: str) -> str:
    """Return what separates the cells of a list: semicolon, tab or comma, or what it states."""
    if (stated := _STATED_DELIMITER.fullmatch(first)) is not None:
        return stated[1]
    return next((mark for mark in ";\t" if mark in first), ",")


def _of_commas(cell: str) -> str:
    """Return a cell of a list with decimal commas with a decimal point, or as doubtful."""
    return Doubtful(cell) if _THOUSANDS.fullmatch(cell) else _pointed(cell)


def _pointed(cell: str) -> str:
    """Return a cell with a decimal point in place of a decimal comma."""
    return _DECIMAL_COMMA.sub(r"\1.\2", _THOUSANDS.sub(_joined, cell))


def _joined(match: re.Match[str]) -> str:
    """Return a number without points between its thousands."""
    return match[1].replace(".", "")


def _with_comma(cell: Any) -> Any:
    as_read = not isinstance(cell, str) or isinstance(cell, Doubtful)
    return cell if as_read else _DECIMAL_POINT.sub(r"\1,\2", cell)


def heading(cell: str) -> tuple[str, str]:
    """Return the name and the unit of a column."""
    match = _UNIT.fullmatch(cell)
    return (match[1], match[2].strip()) if match else (cell, "")


def value_of(cell: Any, unit: str) -> Any:
    """Return the value of a cell of a column with a unit; text with a unit of its own keeps it.

    Parameters
    ----------
    cell : str or number
        Stripped text of the cell, or what a sheet has.
    unit : str
        Of the heading; empty, "-" and "1" leave a plain number, text or truth value.
    """
    found = plain_value(cell) if isinstance(cell, str) else cell
    is_number = isinstance(found, int | float) and not isinstance(found, bool)
    return f"{cell} {unit}" if is_number and unit not in ("", "-", "1") else found


def plain_value(text: str) -> object:
    """Return a value as TOML reads it, or the text itself if it is not TOML."""
    try:
        tables = tomllib.loads(f"value = {text}")
    except ValueError:
        return text
    return tables["value"] if len(tables) == 1 else text
