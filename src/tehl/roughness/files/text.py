"""Heights as text: a table of them, or columns x, y and z. One is never taken for the other."""

import re
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
        ``//`` and one line of names are skipped; nothing and ``nan`` are points without a height.
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
    rows: list[Array] = []
    names_may_come = True
    with path.open(encoding="utf-8-sig", errors="strict") as file:
        try:
            for number, line in enumerate(file, start=1):
                text = line.strip("\r\n \0")
                if not text.strip() or text.lstrip().startswith(_COMMENT):
                    continue
                if names_may_come and _are_names(text):
                    names_may_come = False
                    continue
                names_may_come = False
                rows.append(_row(text, number))
                _check_row(rows, number)
        except UnicodeDecodeError:
            raise InputError("is no text in UTF-8") from None
    if not rows:
        raise InputError("holds no numbers")
    return np.array(rows)


def _check_row(rows: list[Array], number: int) -> None:
    first, last = rows[0].size, rows[-1].size
    if first != last:
        raise InputError(f"line {number} has {last} numbers, but the lines before have {first}")
    if len(rows) * first > 3 * LARGEST_MAP:
        raise InputError(f"holds more than {LARGEST_MAP // 10**6} million heights: crop it before")


def _cells(text: str) -> list[str]:
    """Return the cells of a line; the comma is decimal where something else parts the cells."""
    for mark in (";", "\t"):
        if mark in text:
            cells = text.removesuffix(mark).split(mark)
            return [cell.strip().replace(",", ".") for cell in cells]
    if "," in text:
        return [cell.strip() for cell in text.removesuffix(",").split(",")]
    return text.split()


def _row(text: str, number: int) -> Array:
    cells = _cells(text)
    try:
        return np.array(cells, dtype=np.float64)
    except ValueError:
        pass
    cells = [_MISSING.get(cell.lower(), cell) for cell in cells]
    for cell in cells:
        if not _is_number(cell):
            raise InputError(f"line {number} has {_short(cell)}, which is no number")
    return np.array(cells, dtype=np.float64)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _are_names(text: str) -> bool:
    """Return whether a line is one of column names: short words, none of them a number."""
    cells = _cells(text)
    return len(text) < 400 and all(re.fullmatch(r"[^\W\d][\w .()\[\]/µ]{0,30}", c) for c in cells)


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
            "has three columns whose first two are no lattice of x and y: if it is a table of "
            "heights three points wide, it is no map; if it is columns of something else, give x, "
            "y and z"
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
