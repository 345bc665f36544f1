"""Blocks: columns of a study that vary together; its cases are the grid of all blocks."""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations
from pathlib import Path

from tehl.errors import InputError
from tehl.io.atomic import shortened
from tehl.io.case import plain_value
from tehl.studies.axes import Axis, Sample, Setting
from tehl.studies.tables import is_reserved

_NAME = "name"
"""Column of a list of cases that names them."""
_UNIT = re.compile(r"(.*?)\s*\[(.*)\]\s*")
_LARGEST = 50_000_000
"""Bytes of a list of cases."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Block:
    """Columns that vary together: paths in the case, names in the table, rows of values.

    A value None keeps that of the base case. ``titles`` names the rows, if they have names.
    """

    paths: tuple[str, ...]
    names: tuple[str, ...]
    rows: tuple[tuple[Setting | None, ...], ...]
    titles: tuple[str, ...] = ()


def groups_of(axes: Sequence[Axis]) -> list[list[Axis]]:
    """Return the axes that vary together: zipped ones, all sampled ones, and each other alone."""
    groups: dict[str | int, list[Axis]] = {}
    for number, axis in enumerate(axes):
        kind = "sampled" if axis.is_sampled else f"zip {axis.zip}" if axis.zip else number
        groups.setdefault(kind, []).append(axis)
    return list(groups.values())


def count_of(group: Sequence[Axis], sample: Sample | None) -> int:
    """Return the number of rows of a group of axes, before they are made.

    Raises a ValueError for zipped axes of different lengths, and sampled ones without a sample.
    """
    first = group[0]
    if first.is_sampled:
        if sample is None:
            raise ValueError(
                f"{first.path} is sampled, but there is no table [sample] with the number of "
                'points: sample = { method = "latin-hypercube", number = 100 }'
            )
        return sample.number
    if len({axis.count for axis in group}) > 1:
        counts = ", ".join(f"{axis.path} {axis.count}" for axis in group)
        raise ValueError(f'zip = "{first.zip}" joins axes of different lengths: {counts}')
    return first.count


def block_of(group: Sequence[Axis], sample: Sample | None) -> Block:
    """Return the block of a group of axes that :func:`count_of` has accepted."""
    if sample is not None and group[0].is_sampled:
        places = sample.places(len(group))
        columns = [axis.settings(places[:, number]) for number, axis in enumerate(group)]
    else:
        columns = [axis.settings() for axis in group]
    return Block(
        paths=tuple(axis.path for axis in group),
        names=tuple(axis.name or axis.path for axis in group),
        rows=tuple(zip(*columns, strict=True)),
    )


def block_of_file(path: Path) -> Block:
    """Return the cases listed in a CSV file as a block.

    The first line has dotted paths, optionally with a unit: ``contact.load [N]``; a column ``name``
    names the cases. An empty cell keeps the value of the base case.
    """
    shown = shortened(path)
    lines = _lines(path, shown)
    if len(lines) < 2:
        raise InputError(f"{shown} lists no cases: give a line of paths and a line per case")
    columns = [_column(cell) for cell in lines[0]]
    paths = [path for path, _ in columns]
    if "" in lines[0] or len(set(lines[0])) < len(lines[0]):
        raise InputError(f"{shown}: each column needs a different path in the first line")
    varied = [number for number, path in enumerate(paths) if path != _NAME]
    stated = tuple(paths[k] for k in varied)
    return Block(
        paths=stated,
        names=stated,
        rows=tuple(tuple(_setting(line[k], columns[k][1]) for k in varied) for line in lines[1:]),
        titles=tuple(line[paths.index(_NAME)] for line in lines[1:]) if _NAME in paths else (),
    )


def _lines(path: Path, shown: str) -> list[list[str]]:
    """Return the cells of the lines that are not empty, all of the same number."""
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError(
                f"{shown} is larger than {_LARGEST // 10**6} MB, so not a list of cases"
            )
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file)
            lines = [(reader.line_num, [cell.strip() for cell in line]) for line in reader]
    except FileNotFoundError:
        raise InputError(f"list of cases {shown} does not exist") from None
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{shown} cannot be read as a list of cases: {error}") from None
    lines = [(number, line) for number, line in lines if any(line)]
    for number, line in lines:
        if len(line) != len(lines[0][1]):
            raise InputError(
                f"{shown}: line {number} has {len(line)} cells, but the first has "
                f"{len(lines[0][1])}"
            )
    return [line for _, line in lines]


def _column(cell: str) -> tuple[str, str]:
    """Return path and unit of a column."""
    match = _UNIT.fullmatch(cell)
    return (match[1], match[2].strip()) if match else (cell, "")


def _setting(cell: str, unit: str) -> Setting | None:
    if not cell:
        return None
    return Setting(f"{cell} {unit}" if unit not in ("", "-", "1") else plain_value(cell))


def check_axes(blocks: Sequence[Block]) -> None:
    """Raise for axes of the same key, of a key within another's, or named as another column."""
    names = [name for block in blocks for name in block.names]
    paths = [".".join(map(str.strip, path.split("."))) for b in blocks for path in b.paths]
    for what, words, remedy in (
        ("path", paths, "zip different ones"),
        ("name", names, 'give each a different name, name = "load"'),
    ):
        if twice := [word for word in words if words.count(word) > 1]:
            raise InputError(f"has two axes with the {what} {twice[0]}: {remedy}")
    for path in paths:
        if path.split(".")[0] in ("title", "transient"):
            raise InputError(f"axis {path}: a study of steady films does not vary it")
    for outer, inner in permutations(paths, 2):
        if inner.startswith(f"{outer}."):
            raise InputError(
                f"has an axis {outer} and an axis {inner}, which is a key of it, so one would "
                "override the other: vary the key within the tables of the first, or take single "
                "keys"
            )
    if reserved := [name for name in names if is_reserved(name)]:
        raise InputError(
            f'has an axis with the name "{reserved[0]}", which is another column of the table: '
            'give another name, name = "my oil"'
        )
