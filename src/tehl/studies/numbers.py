"""Values along an axis: two ends with a unit, and what lies between them."""

import math
import re
from collections.abc import Callable, Sequence

import numpy as np

from tehl.typing import Array

End = float | int | str
Value = float | int | str

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
_DIGITS = 12
"""Significant digits of a value: 0.3, not 0.30000000000000004."""

Spread = Callable[[Array], list[Value]]


def between(first: End, last: End, *, geometric: bool) -> Spread:
    """Return what makes values with the unit of both ends out of places from 0 to 1.

    Parameters
    ----------
    first, last : float or str
        Both ends: numbers, or numbers with the same unit, ``"10 N"``.
    geometric : bool
        Equal places have equal ratios, not equal differences.

    Raises
    ------
    ValueError
        If there is nothing between them; the message continues a sentence about them.
    """
    (low, unit), (high, other) = _split(first), _split(last)
    if unit != other:
        raise ValueError(f"has the units {unit or 'none'} and {other or 'none'}: give one unit")
    if geometric and not (low > 0 and high > 0):
        raise ValueError("must have two positive ends to be geometric")

    def spread(places: Array) -> list[Value]:
        numbers = low * (high / low) ** places if geometric else low + (high - low) * places
        return [_joined(number, unit) for number in _exact_ends(numbers, places, (low, high))]

    return spread


def evenly(count: int) -> Array:
    """Return ``count`` places from 0 to 1, both included."""
    return np.linspace(0.0, 1.0, count)


def _exact_ends(numbers: Array, places: Array, ends: tuple[float, float]) -> Sequence[float]:
    numbers = np.where(places == 0.0, ends[0], np.where(places == 1.0, ends[1], numbers))
    return [float(number) for number in numbers]


def _split(end: End) -> tuple[float, str]:
    if isinstance(end, bool):
        raise ValueError("must have numbers at its ends")
    if not isinstance(end, str):
        number, unit = float(end), ""
    elif match := _NUMBER.fullmatch(end):
        number, unit = float(match[1]), match[2]
    else:
        raise ValueError(f'has an end "{end[:40]}" that does not begin with a number')
    if not math.isfinite(number):
        raise ValueError("must have finite ends")
    return number, unit


def _joined(number: float, unit: str) -> Value:
    short = float(f"{number:.{_DIGITS}g}")
    if unit:
        return f"{short!r} {unit}"
    return int(short) if short.is_integer() and abs(short) < 1e9 else short
