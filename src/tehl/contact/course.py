"""Courses over time: tables of times and values, or formulas of t."""

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from operator import itemgetter
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, ValidationInfo

from tehl.base.table import folder_of
from tehl.base.typing import np
from tehl.base.units import (
    Force,
    ForcePerLength,
    Instant,
    Length,
    Number,
    PositiveNumber,
    Quantity,
    quantity,
)
from tehl.contact.columns import read_columns
from tehl.contact.velocities import SIGNED_SPEED
from tehl.roughness.expression import NUMBERS_IN_TIME, read_formula

LARGEST_FACTOR = 10.0
"""Largest load, speed and radius over the stated one."""
Stated = tuple[tuple[float, float | str], ...] | str
"""Pairs of times [s] and values, plain ones or with their unit; or a formula."""


@dataclass(frozen=True, slots=True)
class Course:
    """A number that changes in time, linear between the rows of a table and constant outside."""

    table: tuple[tuple[float, float], ...] = ()
    formula: Callable[[Any], Any] | None = None

    def at(self, time: float) -> float:
        """Return the number at ``time`` [s]."""
        if self.formula is not None:
            return float(self.formula(time))
        table = self.table
        after = bisect_right(table, time, key=itemgetter(0))
        if after in (0, len(table)):
            return table[min(after, len(table) - 1)][1]
        (start, value), (end, next_value) = table[after - 1 : after + 1]
        return value + (time - start) / (end - start) * (next_value - value)

    @property
    def end(self) -> float:
        """Time after which a table is constant [s]; zero of a formula."""
        return self.table[-1][0] if self.table else 0.0


@lru_cache(maxsize=64)
def course_of(stated: Stated, kind: Quantity, reference: float) -> Course:
    """Return the course of what a case states.

    Parameters
    ----------
    stated : tuple or str
        As `Transient` holds it.
    kind : Quantity
        Reads values with a unit.
    reference : float
        What plain numbers are over, in SI: one with a unit is divided by it.
    """
    if isinstance(stated, str):
        return Course(formula=read_formula(stated, NUMBERS_IN_TIME))
    return Course(
        tuple(
            (time, kind.parse(value) / reference if isinstance(value, str) else value)
            for time, value in stated
        )
    )


def _reader(*kinds: Quantity, signed: bool = False) -> BeforeValidator:
    """Return the validator of a course whose values with a unit are of one of these kinds."""
    plain = quantity(Number if signed else PositiveNumber)

    def read(value: object, info: ValidationInfo) -> object:
        key = info.field_name or ""
        if isinstance(value, str) and value.lower().endswith((".csv", ".txt")):
            value = _table_of_file((folder_of(info) or Path()) / value, kinds[0])
        if isinstance(value, str):
            return _checked_formula(value)
        if not isinstance(value, list | tuple) or not all(_is_pair(row) for row in value):
            raise ValueError(
                'must be pairs of a time and a value, [["0 s", 1.0], ["1 ms", 1.2]], a formula '
                f'of t such as "{NUMBERS_IN_TIME.example}", or the name of a CSV file'
            )
        rows = tuple(
            (quantity(Instant).parse(row[0]), _value(row[1], kinds, plain)) for row in value
        )
        if any(later <= earlier for (earlier, _), (later, _) in pairwise(rows)):
            raise ValueError(f"{key} must have times that increase")
        if any(not isinstance(one, str) and abs(one) > LARGEST_FACTOR for _, one in rows):
            raise ValueError(
                f"{key} is over that of the contact and must stay below {LARGEST_FACTOR:g} times it"
            )
        return rows

    return BeforeValidator(read)


def _is_pair(row: object) -> bool:
    return isinstance(row, list | tuple) and len(row) == len(("time", "value"))


def _value(value: object, kinds: tuple[Quantity, ...], plain: Quantity) -> float | str:
    """Return a plain number, or the text of one with its unit."""
    if not isinstance(value, str) or not any(letter.isalpha() for letter in value):
        return plain.parse(value)
    *others, usual = kinds
    for kind in others:
        try:
            kind.parse(value)
        except ValueError:
            continue
        return value
    try:
        usual.parse(value)
    except ValueError as error:
        more = (f", or {kind.name} such as {kind.example}" for kind in others)
        raise ValueError(f"{error}{''.join(more)}") from None
    return value


def _checked_formula(text: str) -> str:
    """Return a formula that can be evaluated at time zero."""
    try:
        formula = read_formula(text, NUMBERS_IN_TIME)
    except ValueError as error:
        raise ValueError(
            f"{error}; its numbers are over those of [contact], those with a unit are for tables"
        ) from None
    with np.errstate(all="ignore"):
        found = float(formula(0.0))
    if not np.isfinite(found):
        raise ValueError("is not finite at t = 0")
    return text


def _table_of_file(path: Path, unit: Quantity) -> list[tuple[float, float | str]]:
    """Return times [s] and values of a CSV file, with the unit that its header has."""
    header = f"t [ms], {unit.name.split()[-1]} [{unit.unit}]"
    pairs, units = read_columns(path, ("time", "value"), header)
    if units is None:
        return [(time, value) for time, value in pairs]
    second = quantity(Instant).parse(f"1 {units[0]}")
    if units[1] in ("-", "1", ""):
        return [(time * second, value) for time, value in pairs]
    return [(time * second, f"{value:.15g} {units[1]}") for time, value in pairs]


LoadCourse = Annotated[Stated, _reader(quantity(ForcePerLength), quantity(Force))]
SpeedCourse = Annotated[Stated, _reader(SIGNED_SPEED, signed=True)]
RatioCourse = Annotated[Stated, _reader(quantity(Number), signed=True)]
RadiusCourse = Annotated[Stated, _reader(quantity(Length))]
