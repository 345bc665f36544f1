"""Cases listed in a CSV file: a column per path, a row per case."""

import csv
import re
from pathlib import Path

from tehl.errors import InputError
from tehl.io.atomic import shortened
from tehl.io.case import plain_value
from tehl.studies.axes import Block, Setting

_NAME = "name"
_UNIT = re.compile(r"(.*?)\s*\[(.*)\]\s*")
_LARGEST = 50_000_000
"""Bytes of such a file."""


def block_of_file(path: Path) -> Block:
    """Return the rows of a CSV file as a block.

    The first line has dotted paths, if wanted with a unit: ``contact.load [N]``; a column ``name``
    names the cases. An empty cell leaves the base case as it is.

    Raises
    ------
    InputError
        If it cannot be read as such.
    """
    shown = shortened(path)
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError(f"{shown} is larger than {_LARGEST // 10**6} MB, so no list of cases")
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file)
            lines = [(reader.line_num, line) for line in reader if any(map(str.strip, line))]
    except FileNotFoundError:
        raise InputError(f"there is no list of cases {shown}") from None
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{shown} cannot be read as a list of cases: {error}") from None
    if len(lines) < 2:
        raise InputError(f"{shown} lists no cases: give a line of paths and a line per case")
    _check_lines(shown, lines)
    return _block(shown, [cell.strip() for cell in lines[0][1]], [line for _, line in lines[1:]])


def _check_lines(shown: str, lines: list[tuple[int, list[str]]]) -> None:
    """Refuse lines that have not as many cells as the first."""
    (_, header), *others = lines
    for number, line in others:
        if len(line) != len(header):
            raise InputError(
                f"{shown}: line {number} has {len(line)} cells, but the first has {len(header)}"
            )


def _block(shown: str, header: list[str], lines: list[list[str]]) -> Block:
    if "" in header or len(set(header)) < len(header):
        raise InputError(f"{shown}: each column needs a path of its own in the first line")
    split = [_split(cell) for cell in header]
    chosen = [k for k, (path, _) in enumerate(split) if path != _NAME]
    named = [k for k, (path, _) in enumerate(split) if path == _NAME]
    rows = tuple(tuple(_setting(line[k], split[k][1]) for k in chosen) for line in lines)
    paths = tuple(split[k][0] for k in chosen)
    titles = tuple(line[named[0]].strip() for line in lines) if named else ()
    return Block(paths=paths, names=paths, rows=rows, titles=titles)


def _split(cell: str) -> tuple[str, str]:
    match = _UNIT.fullmatch(cell)
    return (match[1], match[2].strip()) if match else (cell, "")


def _setting(cell: str, unit: str) -> Setting | None:
    text = cell.strip()
    if not text:
        return None
    return Setting(f"{text} {unit}" if unit not in ("", "-", "1") else plain_value(text))
