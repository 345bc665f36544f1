"""Kinds of controls: a number with its unit, one of several words, groups of both."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tehl.base.units import Quantity

_DECADE = 10.0
"""A logarithmic slider reaches from a tenth of its value to ten times it."""
Settings = dict[str, Any]
"""Values by their paths; None and False remove a key."""
Span = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Knob:
    """A number with its unit: slider, exact entry, selector of the unit."""

    path: str
    """Dotted key of the case."""
    label: str
    kind: Quantity
    units: tuple[str, ...]
    """Units to choose from; ``""`` alone for plain numbers."""
    span: Span
    """Sane range, SI."""
    value: float
    """SI."""
    unit: str = ""
    """The unit that is shown."""
    is_log: bool = True

    def number(self, value: float, unit: str) -> float:
        """Return an SI value in a unit."""
        return value - 273.15 if unit == "degC" else value / self._factor(unit)

    def si(self, number: float, unit: str) -> float:
        """Return a number in a unit in SI."""
        return number + 273.15 if unit == "degC" else number * self._factor(unit)

    def _factor(self, unit: str) -> float:
        return self.kind.parse(f"1 {unit}") if unit and unit != "degC" else 1.0

    def stated(self, number: float, unit: str) -> str | float:
        """Return what the case states: a number with its unit, or a plain number."""
        if not unit:
            return float(f"{number:.6g}")
        return f"{number:.6g} {unit}"

    def reach(self, value: float) -> Span:
        """Return the range of the slider around a value, SI; a logarithmic one keeps its sign."""
        low, high = self.span
        if self.is_log and value < 0:
            low, high = self.reach(-value)
            return -high, -low
        if self.is_log and value > 0:
            return max(min(low, value), value / _DECADE), min(max(high, value), value * _DECADE)
        return min(low, value), max(high, value)

    def part(self, value: float, reach: Span) -> float:
        """Return where a value lies in a range, from 0 to 1."""
        low, high = reach
        value = min(max(value, low), high)
        if self.spreads(reach):
            return math.log(value / low) / math.log(high / low)
        return (value - low) / (high - low)

    def at(self, part: float, reach: Span) -> float:
        """Return the value at a part of a range, the inverse of `part`."""
        low, high = reach
        return low * (high / low) ** part if self.spreads(reach) else low + part * (high - low)

    def spreads(self, reach: Span) -> bool:
        """Return whether a slider over a range is logarithmic: it has one sign."""
        return self.is_log and reach[0] * reach[1] > 0


@dataclass(frozen=True, slots=True)
class Choice:
    """One of several words."""

    path: str
    label: str
    value: str
    options: Mapping[str, tuple[str, Settings]]
    """What is shown, and the keys of the case that it sets, by what is chosen."""


@dataclass(frozen=True, slots=True)
class Group:
    """Controls that belong together."""

    name: str
    items: tuple[Knob | Choice, ...]
    is_open: bool = False
