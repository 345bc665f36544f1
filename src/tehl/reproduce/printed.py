"""What the paper prints."""

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

_FILE = Path(__file__).with_name("printed.toml")
_TABLE = {"A": ("T2", "M")} | dict.fromkeys(
    ("D", "D-smooth", "D-prime", "D-prime-wavy"), ("T3", "SRR")
)
"""Table and column of what varies, of each series whose films are printed."""


@dataclass(frozen=True, slots=True)
class Printed:
    """The file of printed numbers and words.

    Attributes
    ----------
    tables : dict
        As parsed.
    """

    tables: dict[str, Any]

    @property
    def citation(self) -> str:
        """Return which paper it is."""
        return str(self.tables["citation"])

    @property
    def parameters(self) -> list[tuple[str, str]]:
        """Return name and value of each line of Table 1."""
        return [(line["name"], line["value"]) for line in self.tables["T1"]]

    def column(self, table: str, name: str, *, corrected: bool = True) -> list[float]:
        """Return a column of a table, misprints corrected or as they stand."""
        found = self.tables[table]
        better = found.get("corrected", {})
        return list(better.get(name, found[name]) if corrected else found[name])

    def conclusion(self, number: int) -> str:
        """Return a conclusion, word by word."""
        return str(self.tables["conclusions"][str(number)])

    def films(self, series: str, heat: str) -> dict[float, tuple[float, float]]:
        """Return printed minimum and central film of the contacts of a series, if there are any."""
        if series not in _TABLE:
            return {}
        table, key = _TABLE[series]
        low = self.column(table, f"{heat}_minimum")
        central = self.column(table, f"{heat}_central")
        places = self.column(table, key)
        return {p: (a, b) for p, a, b in zip(places, low, central, strict=True)}


@cache
def printed() -> Printed:
    """Return what the paper prints."""
    with _FILE.open("rb") as file:
        return Printed(tomllib.load(file))
