"""Axes of a study and the values along them; blocks of axes that vary together."""

import json
import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations, zip_longest
from pathlib import Path
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from tehl.base.atomic import shortened
from tehl.base.errors import InputError
from tehl.base.lists import heading, lines_of_file, value_of, values_of_file
from tehl.base.table import Table
from tehl.base.typing import Array
from tehl.studies.tables import is_reserved

End = float | int | str
Ends = tuple[End, End]
Steps = tuple[End, End, Annotated[int, Field(ge=1)]]

_KINDS = ("values", "file", "linspace", "geomspace", "uniform", "loguniform")
"""Ways to state the values of an axis."""
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+|inf|nan)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
_TITLES = "name"
"""Column of a list of cases that names them."""


@dataclass(frozen=True, slots=True)
class Setting:
    """A value along an axis, and its name in the table if it has one."""

    value: Any
    name: str | None = None


class Axis(Table):
    """One path of the case file with the values that it takes."""

    path: str
    """Dotted path: ``"contact.load"``."""
    name: str | None = None
    """Of its column in the table; the path if left out."""
    values: list[Any] | None = None
    """Numbers, words, quantities or tables; ``false`` leaves a key out that is not a switch."""
    file: str | None = None
    """CSV file with the values in a column; beside the study file."""
    column: str | None = None
    """Heading of that column without its unit; the path if left out."""
    names: list[str] | None = None
    """Names of the values in the table."""
    linspace: Steps | None = None
    geomspace: Steps | None = None
    """Values with equal steps or equal ratios, both ends included."""
    uniform: Ends | None = None
    loguniform: Ends | None = None
    """Sampled between two ends, as the table ``sample`` states."""
    zip: str | None = None
    """Axes with the same word here vary together, value by value."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        stated = [kind for kind in _KINDS if getattr(self, kind) is not None]
        if len(stated) != 1:
            how = f"states {' and '.join(stated)}" if stated else "has no values"
            raise ValueError(f"{how}: give one of {', '.join(_KINDS)}")
        if self.values == []:
            raise ValueError("has an empty list of values")
        self._check_file_and_names()
        if self.zip is not None and self.is_sampled:
            raise ValueError("is sampled, and all sampled axes vary together: remove zip")
        if not all(part.strip() for part in self.path.split(".")):
            raise ValueError("is not a dotted path of a case, such as contact.load")
        try:
            self.settings(np.zeros(0))
        except ValueError as error:
            kind = stated[0]
            raise ValueError(f"{kind} = {list(getattr(self, kind))}: {error}") from None
        if self.zip is None:  # zipped values may repeat, beside others
            self._check_repeated()
        return self

    def _check_file_and_names(self) -> None:
        if self.column is not None and self.file is None:
            raise ValueError("states column without a file")
        known = self.file is None and self.names is not None
        if known and len(self.names or ()) != len(self.values or ()):
            raise ValueError("must have as many names as values")

    def _check_repeated(self) -> None:
        if (steps := self.linspace or self.geomspace) and steps[0] == steps[1] and steps[2] > 1:
            raise ValueError(f"has the value {steps[0]} {steps[2]} times: give two different ends")
        for what, found in (("value", self.values), ("name", self.names)):
            words = Counter(json.dumps(one, default=str, sort_keys=True) for one in found or ())
            word, count = next(iter(words.most_common(1)), ("", 0))
            if count > 1:
                raise ValueError(f"has the {what} {word[:60]} twice: give each once")

    def with_values(self, folder: Path) -> "Axis":
        """Return the axis with the values of its file, whose path begins in ``folder``."""
        if self.file is None:
            return self
        values = values_of_file(folder / self.file, self.column or self.path)
        return Axis.model_validate(
            self.model_dump(exclude={"file", "column", "values"}, exclude_none=True)
            | {"values": values}
        )

    @property
    def is_sampled(self) -> bool:
        """Whether its values are sampled."""
        return self.uniform is not None or self.loguniform is not None

    @property
    def count(self) -> int:
        """Number of its values, if it is not sampled."""
        steps = self.linspace or self.geomspace
        return steps[2] if steps else len(self.values or ())

    def settings(self, places: Array | None = None) -> list[Setting]:
        """Return its values; those of a sampled axis at ``places`` between 0 and 1."""
        ends = self.linspace or self.geomspace or self.uniform or self.loguniform
        if ends is None:
            return [Setting(*one) for one in zip_longest(self.values or (), self.names or ())]
        geometric = self.geomspace is not None or self.loguniform is not None
        places = np.linspace(0.0, 1.0, self.count) if places is None else places
        return [Setting(value) for value in _spread(ends[0], ends[1], places, geometric=geometric)]


def _spread(first: End, last: End, places: Array, *, geometric: bool) -> list[End]:
    """Return values at places from 0 to 1 between two ends, by equal ratios if ``geometric``.

    Messages of errors continue a sentence about the ends.
    """
    (low, unit), (high, other) = _split(first), _split(last)
    if unit != other:
        raise ValueError(f"has the units {unit or 'none'} and {other or 'none'}: give one unit")
    if geometric and not (low > 0 and high > 0):
        raise ValueError("must have two positive ends to be geometric")
    rest = 1.0 - places  # so that both ends are exact
    numbers = low**rest * high**places if geometric else low * rest + high * places
    # 0.3, not 0.30000000000000004
    return [_stated(float(f"{number:.12g}"), unit) for number in numbers]


def _stated(number: float, unit: str) -> End:
    """Return a number as a case file states it."""
    if unit:
        return f"{number!r} {unit}"
    return int(number) if number.is_integer() and abs(number) < 1e9 else number


def _split(end: End) -> tuple[float, str]:
    match = _NUMBER.fullmatch(str(end))
    if not match:
        raise ValueError(f'has an end "{str(end)[:40]}" that does not begin with a number')
    if re.match(r",\d", match[2]):
        raise ValueError(f'has an end "{str(end)[:40]}" with a comma: write a decimal point')
    if not math.isfinite(float(match[1])):
        raise ValueError("must have finite ends")
    return float(match[1]), match[2]


class Sample(Table):
    """How sampled axes take their values."""

    method: Literal["latin-hypercube", "sobol", "random"] = "latin-hypercube"
    """Points that fill the box evenly, or independent ones."""
    number: Annotated[int, Field(ge=1)]
    """Number of points."""
    seed: Annotated[int, Field(ge=0)] = 0
    """Of the random numbers."""

    def places(self, dimensions: int) -> Array:
        """Return the points between 0 and 1, (number, dimensions)."""
        from scipy.stats import qmc  # noqa: PLC0415 (half a second, for sampled studies only)

        generator = np.random.default_rng(self.seed)
        if self.method == "random":
            return generator.random((self.number, dimensions))
        if self.method == "latin-hypercube":
            found = qmc.LatinHypercube(dimensions, seed=generator).random(self.number)
        else:
            doublings = max(self.number - 1, 1).bit_length()
            found = qmc.Sobol(dimensions, seed=generator).random_base2(doublings)
        places: Array = np.asarray(found[: self.number], np.float64)
        return places


# ---- blocks


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

    Parameters
    ----------
    group : sequence of Axis
        One axis, axes of one ``zip``, or all sampled ones.
    sample : Sample or None
        Number and method of sampled points.

    Raises
    ------
    ValueError
        If zipped axes differ in length, or sampled ones have no sample.
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
    """Return the block of a group of axes that :func:`count_of` has accepted.

    Parameters
    ----------
    group : sequence of Axis
        One axis, axes of one ``zip``, or all sampled ones.
    sample : Sample or None
        Places of sampled points in the unit cube.
    """
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
    names the cases. An empty cell keeps the value of the base case. Cells are separated by commas,
    or by semicolons or tabs, with which numbers may have decimal commas.
    """
    shown = shortened(path)
    lines = lines_of_file(path)
    if len(lines) < 2:
        raise InputError(f"{shown} lists no cases: give a line of paths and a line per case")
    columns = [heading(cell) for cell in lines[0]]
    paths = [path for path, _ in columns]
    if "" in lines[0] or len(set(lines[0])) < len(lines[0]):
        raise InputError(f"{shown}: each column needs a different path in the first line")
    varied = [number for number, path in enumerate(paths) if path != _TITLES]
    stated = tuple(paths[k] for k in varied)
    return Block(
        paths=stated,
        names=stated,
        rows=tuple(tuple(_setting(line[k], columns[k][1]) for k in varied) for line in lines[1:]),
        titles=tuple(line[paths.index(_TITLES)] for line in lines[1:]) if _TITLES in paths else (),
    )


def _setting(cell: str, unit: str) -> Setting | None:
    return Setting(value_of(cell, unit)) if cell else None


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
        if path.split(".")[0] == "title":
            raise InputError("axis title: changes no result; state the key that does")
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
