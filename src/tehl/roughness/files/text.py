"""Heights as text: a table of heights, or columns x, y and z; ambiguous files are rejected."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from tehl.base.encoding import encoding_of
from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.roughness.files.header import Header
from tehl.roughness.files.raw import LARGEST_MAP, RawMap, check_count, shown, step

Layout = Literal["auto", "matrix", "xyz"]

_LARGEST_TEXT = 10**9
_COMMENT = ("#", "%", "//")
_MISSING = {"": "nan", "na": "nan", "n/a": "nan", "bad": "nan", "***": "nan", "-": "nan"}


def read_text(path: Path, layout: Layout) -> RawMap:
    """Return the heights of a text file.

    Numbers are separated by commas, semicolons, tabs or blanks; lines that begin with ``#``, ``%``
    or ``//``, lines ``key: value`` or ``key = value`` before the first number, and one line of
    names are its header, whose unit, conversion factor and size count; nothing and ``nan`` are
    points without a height, but a mark at the end of a row that is as long as the others without it
    is not a point.

    Parameters
    ----------
    path : Path
        Text in UTF-8, or in UTF-16 with a byte order mark.
    layout : {"auto", "matrix", "xyz"}
        "auto" takes three columns as x, y and z, never as a table.

    Raises
    ------
    InputError
        With the line, if the file holds anything else.
    """
    header = Header()
    table = _table(path, header)
    if layout == "matrix" or (layout == "auto" and table.shape[1] != 3):
        check_count(table.shape)
        return RawMap(
            heights=table,
            kind="table of heights",
            unit=header.unit,
            pixel=header.pixel(table.shape),
            pixel_units=("m", "m"),
        )
    if table.shape[1] != 3:
        raise InputError(f"has {table.shape[1]} columns, but x, y and z are three")
    return replace(_lattice(table), unit=header.unit)


def _table(path: Path, header: Header) -> Array:
    if path.stat().st_size > _LARGEST_TEXT:
        raise InputError(f"is a text of more than {_LARGEST_TEXT // 10**9} GB: store it as .npy")
    rows: list[Array] = []
    marked: list[bool] = []
    numbers: list[int] = []
    for number, cells in _lines(path, header):
        marked.append(not cells[-1] and len(cells) > 1)
        rows.append(_row(cells[:-1] if marked[-1] else cells, number))
        numbers.append(number)
        if len(rows) * rows[0].size > 3 * LARGEST_MAP:
            raise InputError(
                f"holds more than {LARGEST_MAP // 10**6} million heights: crop it before"
            )
    if not rows:
        raise InputError("contains only text; expected numbers")
    return _evened(rows, marked, numbers)


def _lines(path: Path, header: Header) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and the cells of each line of data; fill the header."""
    is_first = True
    try:
        with path.open(encoding=_encoding(path), errors="strict") as file:
            for number, line in enumerate(file, start=1):
                text = line.strip("\r\n \0")
                is_blank = not text.strip() and text.count("\t") < 2  # tabs: missing points
                is_header = is_first and header.takes(text.lstrip(" #%/"))
                if is_blank or is_header or text.lstrip().startswith(_COMMENT):
                    continue
                cells = _cells(text)
                if not (is_first and len(text) < 400 and _are_names(cells)):
                    yield number, cells
                is_first = False
    except UnicodeDecodeError:
        raise InputError("is not a text in UTF-8 or UTF-16") from None


def _encoding(path: Path) -> str:
    """Return the encoding of a text by its first bytes."""
    with path.open("rb") as file:
        return encoding_of(file.read(2))


def _evened(rows: list[Array], marked: list[bool], numbers: list[int]) -> Array:
    """Return rows of one length.

    A row with a mark at its end may lack its last height, or be ended by the mark, as the length of
    the rows without one decides. Where all rows end with a mark, it ends them.
    """
    full = next((row.size for row, mark in zip(rows, marked, strict=True) if not mark), 0)
    for place, mark in enumerate(marked):
        if mark and rows[place].size == full - 1:
            rows[place] = np.append(rows[place], np.nan)
        if rows[place].size != rows[0].size:
            raise InputError(
                f"line {numbers[place]} has {rows[place].size} numbers, but the lines before have "
                f"{rows[0].size}"
            )
    return np.array(rows)


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
            raise InputError(
                f"line {number} has {shown(cell, 40)!r}, which is not a number: lines of a header "
                'are "key: value", or begin with #'
            )
    return np.array(cells, dtype=np.float64)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return "_" not in cell


def _are_names(cells: list[str]) -> bool:
    """Return whether cells are column names: short words, none a number or a gap."""
    return all(
        re.fullmatch(r"[^\W\d][\w .()\[\]/µ]{0,30}", cell)
        and cell.lower() not in _MISSING
        and not _is_number(cell)  # nan and inf are numbers
        for cell in (cells if cells[-1] else cells[:-1])
    )


def _lattice(table: Array) -> RawMap:
    """Return the map of columns x, y and z in any order."""
    if not np.isfinite(table[:, :2]).all():
        raise InputError("has three columns with gaps in the first two, so they are not x and y")
    (x, column), (y, row) = _places(table[:, 0]), _places(table[:, 1])
    shape = (y.size, x.size)
    covered = table.shape[0] / (y.size * x.size)
    if min(shape) < 2 or not covered >= 0.5:
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
    near = 1e-6 * max(values[-1] - values[0], 0.0)
    first = np.concatenate(([True], np.diff(values) > near))
    places = values[first]
    return places, np.abs(np.searchsorted(places, column + near, side="right") - 1)
