"""The figures of the paper as their file states them."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

from tehl.reproduce.book import Book
from tehl.reproduce.open_runs import THINNING
from tehl.reproduce.series import Heat, Run

_FILE = Path(__file__).with_name("figures.toml")
_BOTH: tuple[Heat, Heat] = ("isothermal", "thermal")


@dataclass(frozen=True, kw_only=True, slots=True)
class FigureSpec:
    """A figure of the paper.

    Attributes
    ----------
    name, title : str
        "F1", and what it shows.
    kind : str
        How it is drawn.
    series : str
        Whose runs.
    heat : tuple of str
        Isothermal, thermal or both.
    values : tuple of float
        Of what varies; empty for all of the series.
    claims : tuple of str
        Names of what the text says about it.
    """

    name: str
    title: str
    kind: str
    series: str
    heat: tuple[Heat, ...]
    values: tuple[float, ...]
    claims: tuple[str, ...]

    @property
    def label(self) -> str:
        """Return what it is called."""
        kind = "Figure" if self.name.startswith("F") else "Added figure"
        return f"{kind} {self.name[1:]}"

    @property
    def is_hard(self) -> bool:
        """Whether Newtonian oil may have no answer where one that thins has."""
        return self.series in THINNING and "thermal" in self.heat

    @property
    def needs(self) -> tuple[str, ...]:
        """Return the series that it is drawn and judged from."""
        others = ("hot", "D-prime") if "temperatures-known" in self.claims else ()
        cold = ("D-prime",) if self.series.startswith("glass") else ()
        thinning = (THINNING[self.series],) if self.is_hard else ()
        return tuple(dict.fromkeys((self.series, *others, *cold, *thinning)))

    def panels(self, book: Book) -> list[Run]:
        """Return the runs of its panels, (a) first."""
        values = self.values or book.series[self.series].values
        places = [(heat, value) for heat in self.heat for value in values]
        found = (book.run(self.series, "converged", heat, value) for heat, value in places)
        return [run for run in found if run is not None]


def figures() -> dict[str, FigureSpec]:
    """Return all figures by name, in the order of the paper."""
    with _FILE.open("rb") as file:
        tables = tomllib.load(file)
    return {name: _spec(name, table) for name, table in tables.items()}


def _spec(name: str, table: dict[str, object]) -> FigureSpec:
    heat = table.pop("heat")
    values = table.pop("values", [])
    claims = table.pop("claims")
    assert isinstance(values, list)
    assert isinstance(claims, list)
    return FigureSpec(
        name=name,
        heat=_BOTH if heat == "both" else (heat,),  # type: ignore[arg-type]
        values=tuple(float(value) for value in values),
        claims=tuple(claims),
        **table,  # type: ignore[arg-type]
    )
