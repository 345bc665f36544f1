"""Heights as text: a table of them, or columns x, y and z. One is never taken for the other."""

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from tehl.errors import InputError
from tehl.roughness.files.raw import LARGEST_MAP, RawMap, check_count, step
from tehl.typing import Array

Layout = Literal["auto", "matrix", "xyz"]

_LARGEST_TEXT = 10**9
_COMMENT = ("#", "%", "//")
_MISSING = {"": "nan", "na": "nan", "n/a": "nan", "bad": "nan", "***": "nan", "-": "nan"}
_LEAST_COVERED = 0.5
_DIGITS = 1e-6


def read_text(path: Path, layout: Layout) -> RawMap:
    """Return the heights of a text file.

    Parameters
    ----------
    path : Path
        Numbers parted by commas, semicolons, tabs or blanks; lines that begin with ``#``, ``%`` or
        ``//`` and one line of names are skipped; nothing and ``nan`` are points without a height,
        but a mark at the end of a row that is as long as the others without it is nothing more.
    layout : {"auto", "matrix", "xyz"}
        What the numbers are. "auto" takes three columns as x, y and z only if the first two make
        a lattice, and as a table never.

    Raises
    ------
    InputError
        If it holds anything else; the message has the line.
    """
    table = _table(path)
    if layout == "matrix" or (layout == "auto" and table.shape[1] != 3):
        check_count(table.shape)
        return RawMap(heights=table, kind="table of heights")
    if table.shape[1] != 3:
        raise InputError(f"has {table.shape[1]} columns, but x, y and z are three")
    return _lattice(table)


def _table(path: Path) -> Array:
    if path.stat().st_size > _LARGEST_TEXT:
        raise InputError(f"is a text of more than {_LARGEST_TEXT // 10**9} GB: store it as .npy")
    rows = _Rows()
    names_may_come = True
    with path.open(encoding="utf-8-sig", errors="strict") as file:
        try:
            for number, line in enumerate(file, start=1):
                text = line.strip("\r\n \0")
                if _is_blank(text) or text.lstrip().startswith(_COMMENT):
                    continue
                if names_may_come and _are_names(text):
                    names_may_come = False
                    continue
                names_may_come = False
                rows.add(_cells(text), number)
        except UnicodeDecodeError:
            raise InputError("is not a text in UTF-8") from None
    if not rows.found:
        raise InputError("holds no numbers")
    return np.array(rows.found)


@dataclass(slots=True)
class _Rows:
    """Rows of one length, as they come.

    What ends with a mark may lack its last height, or be ended by the mark: only the length of
    the other rows tells. Where all rows end with one, it ends them.
    """

    found: list[Array] = field(default_factory=list)
    all_end_with_a_mark: bool = True

    def add(self, cells: list[str], number: int) -> None:
        """Add the cells of a line.

        Raises
        ------
        InputError
            If one is not a number, or their count differs from that of the lines before.
        """
        ends_with_a_mark = not cells[-1] and len(cells) > 1
        row = _row(cells[:-1] if ends_with_a_mark else cells, number)
        lacking = row.size - self.found[0].size if self.found else 0
        if lacking == 1 and self.all_end_with_a_mark and not ends_with_a_mark:
            self.found = [np.append(one, np.nan) for one in self.found]
        elif lacking == -1 and ends_with_a_mark and not self.all_end_with_a_mark:
            row = np.append(row, np.nan)
        self.found.append(row)
        self.all_end_with_a_mark &= ends_with_a_mark
        _check_row(self.found, number)


def _check_row(rows: list[Array], number: int) -> None:
    first, last = rows[0].size, rows[-1].size
    if first != last:
        raise InputError(f"line {number} has {last} numbers, but the lines before have {first}")
    if len(rows) * first > 3 * LARGEST_MAP:
        raise InputError(f"holds more than {LARGEST_MAP // 10**6} million heights: crop it before")


def _is_blank(text: str) -> bool:
    """Return whether a line is empty; several tabs are a row of missing points."""
    return not text.strip() and text.count("\t") < 2


def _cells(text: str) -> list[str]:
    """Return the cells of a line; the comma is decimal where something else parts the cells."""
    for mark in (";", "\t"):
        if mark in text:
            return [cell.strip().replace(",", ".") for cell in text.split(mark)]
    if "," in text:
        return [cell.strip() for cell in text.split(",")]
    return text.split()


def _row(cells: list[str], number: int) -> Array:
    if "_" not in "".join(cells):  # which Python takes for a part of a number
        try:
            return np.array(cells, dtype=np.float64)
        except ValueError:
            pass
    cells = [_MISSING.get(cell.lower(), cell) for cell in cells]
    for cell in cells:
        if not _is_number(cell):
            raise InputError(f"line {number} has {_short(cell)}, which is not a number")
    return np.array(cells, dtype=np.float64)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return "_" not in cell


def _are_names(text: str) -> bool:
    """Return whether a line is one of column names: short words, none a number or a gap."""
    cells = _cells(text)
    cells = cells if cells[-1] else cells[:-1]
    return len(text) < 400 and all(map(_is_name, cells))


def _is_name(cell: str) -> bool:
    if cell.lower() in _MISSING or _is_number(cell):  # nan and inf are numbers
        return False
    return re.fullmatch(r"[^\W\d][\w .()\[\]/µ]{0,30}", cell) is not None


def _short(cell: str) -> str:
    text = "".join(c if c.isprintable() else "?" for c in cell)
    return repr(text if len(text) <= 40 else f"{text[:37]}...")


def _lattice(table: Array) -> RawMap:
    """Return the map of columns x, y and z in any order."""
    if not np.isfinite(table[:, :2]).all():
        raise InputError("has three columns with gaps in the first two, so they are not x and y")
    (x, column), (y, row) = _places(table[:, 0]), _places(table[:, 1])
    shape = (y.size, x.size)
    covered = table.shape[0] / (y.size * x.size)
    if min(shape) < 2 or not _LEAST_COVERED <= covered:
        raise InputError(
            "has three columns whose first two are not a lattice of x and y: give x, y and z; a "
            "table of heights three points wide is not a map"
        )
    check_count(shape)
    heights = np.full(shape, np.nan)
    if np.unique(row * x.size + column).size < table.shape[0]:
        raise InputError("has several heights at one x and y")
    heights[row, column] = table[:, 2]
    return RawMap(heights=heights, kind="columns x, y, z", pixel=(step(x, "x"), step(y, "y")))


def _places(column: Array) -> tuple[Array, "np.ndarray"]:
    """Return the different values of a column, and which of them each row has."""
    values = np.sort(column)
    near = _DIGITS * max(values[-1] - values[0], 0.0)
    first = np.concatenate(([True], np.diff(values) > near))
    places = values[first]
    return places, np.abs(np.searchsorted(places, column + near, side="right") - 1)
