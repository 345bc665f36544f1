"""The figures of the paper as ``figures.toml`` states them, and their verdicts."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

from paper.runs import Heat, Runs, read_series
from paper.statements import check
from paper.unconverged import unconverged
from paper.verdict import Verdict, judge


@dataclass(frozen=True, kw_only=True, slots=True)
class Figure:
    """A figure of the paper ("F1"), or an added one ("X1"), as its file describes it."""

    name: str
    title: str
    kind: str
    series: str
    heat: list[Heat]
    statements: list[str]
    also: tuple[str, ...] = ()
    values: tuple[float, ...] = ()

    @property
    def label(self) -> str:
        """What it is called."""
        kind = "Figure" if self.name.startswith("F") else "Added figure"
        return f"{kind} {self.name[1:]}"

    @property
    def panels(self) -> str:
        """What varies from panel to panel."""
        series = read_series(self.series)
        values = ", ".join(f"{value:g}" for value in self.values or series.values)
        return f"{series.symbol} = {values}; {' and '.join(self.heat)}"

    def verdict(self, runs: Runs) -> Verdict:
        """Return the verdict on the figure."""
        where = self.series, tuple(self.heat), tuple(self.values)
        statements = [check(runs, name, *where) for name in self.statements]
        return judge(statements, unconverged(runs, [self.series], *where[1:]))


_FILE = Path(__file__).with_name("figures.toml")
FIGURES = {
    name: Figure(name=name, **table)
    for name, table in tomllib.loads(_FILE.read_text(encoding="utf-8")).items()
}
"""All figures by name, in the order of the paper."""
