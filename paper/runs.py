"""The contacts of the paper: one study file per series, and the numbers of their results."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache, cached_property
from pathlib import Path
from typing import Any, Literal

import pandas as pd

from paper.numbers import numbers
from tehl import ContactProblem, Options, Result
from tehl.studies import Case, Store, read_study, study_of

Treatment = Literal["paper", "converged", "domain", "mean", "coarser"]
"""The paper's; converged; that on the paper's domain, with mean properties, on a coarser grid."""
Heat = Literal["isothermal", "thermal"]

HEATS: tuple[Heat, Heat] = ("isothermal", "thermal")
_STUDIES = Path(__file__).with_name("studies")
SERIES = tuple(sorted(file.stem for file in _STUDIES.glob("*.toml")))
"""Names of the study files."""
SYMBOLS = ("M", "L", "SRR")
FEWEST_CERTIFIED = 129
"""Nodes per direction that error bars take: the grid is halved twice."""


@dataclass(frozen=True, slots=True)
class Series:
    """Contacts that differ by one number, as a study file states them."""

    name: str
    symbol: str  # what varies: "M", "L" or "SRR"
    values: tuple[float, ...]
    cases: tuple[Case, ...]

    @property
    def problem(self) -> ContactProblem:
        """The first contact."""
        return self.cases[0].problem

    @property
    def fixed(self) -> str:
        """What does not vary, in words."""
        contact = self.problem.contact
        values = (contact.moes_load, contact.moes_speed, contact.slide_roll_ratio)
        words = [f"{s} = {v:g}" for s, v in zip(SYMBOLS, values, strict=True) if s != self.symbol]
        return ", ".join([*words, "wavy surface" if self.problem.is_rough else "smooth"])


@cache
def read_series(name: str, points: int | None = None) -> Series:
    """Return a series from its study file.

    Parameters
    ----------
    name : str
        Name of the file.
    points : int or None
        Nodes per direction of the fine grids, in place of those of the file.
    """
    study = study_of(read_study(_STUDIES / f"{name}.toml"))
    symbol = next(key for key in study.cases[0].labels if key in SYMBOLS)
    cases = tuple(_prepared(name, symbol, case, points) for case in study.cases)
    values = dict.fromkeys(float(case.labels[symbol]) for case in cases)
    return Series(name, symbol, tuple(values), cases)


def _prepared(name: str, symbol: str, case: Case, points: int | None) -> Case:
    """Name a case; with ``accuracy = "tight"`` it gets error bars from three grids."""
    treatment, heat, value = (case.labels[key] for key in ("treatment", "heat", symbol))
    options = case.options
    if points is not None and treatment in ("converged", "domain", "mean"):
        options = Options(**{**options.model_dump(exclude_unset=True), "points": points})
    certify = options.accuracy == "tight" and min(options.shape) >= FEWEST_CERTIFIED
    labels = {"series": name, "treatment": treatment, "heat": heat, symbol: value}
    title = f"{name}: {symbol} = {value:g}, {heat}, {treatment}"
    return replace(case, name=title, labels=labels, options=options, certify=certify)


class Runs:
    """The runs of some series, solved or not.

    Parameters
    ----------
    folder : Path
        Where the results are kept.
    names : iterable of str
        Names of the series.
    points : int or None
        Nodes per direction of the fine grids, in place of those of the study files.
    """

    def __init__(self, folder: Path, names: Iterable[str], points: int | None = None) -> None:
        self.store = Store(folder / "cases", keep="fields")
        self.series = {name: read_series(name, points) for name in names}
        self.cases = [case for one in self.series.values() for case in one.cases]

    @cached_property
    def numbers(self) -> dict[str, dict[str, Any]]:
        """Numbers of all runs that left fields, by the key of their case."""
        results = ((case.key, self.store.result(case)) for case in self.cases)
        return {key: numbers(result) for key, result in results if result is not None}

    @cached_property
    def _lines(self) -> dict[tuple[Any, ...], pd.DataFrame]:
        """The same by series, treatment and heat."""
        found: dict[tuple[Any, ...], dict[float, dict[str, Any]]] = {}
        for case in self.cases:
            if case.key in self.numbers:
                *place, value = case.labels.values()
                row = {"case": case, "treatment": place[1], **self.numbers[case.key]}
                found.setdefault(tuple(place), {})[float(value)] = row
        return {place: pd.DataFrame(rows.values(), rows.keys()) for place, rows in found.items()}

    def line(
        self, series: str, treatment: Treatment, heat: Heat, values: tuple[float, ...] = ()
    ) -> pd.DataFrame:
        """Return the numbers of a series by what varies, empty where there is nothing.

        A converged run that did not converge is replaced by the one on the coarser grid if that
        one did.

        Parameters
        ----------
        series, treatment, heat : str
            Which runs.
        values : tuple of float
            Of what varies; all if empty.
        """
        found = self._line(series, treatment, heat)
        if treatment == "converged":
            coarser = self._line(series, "coarser", heat)
            better = [v for v in coarser.index if coarser.ok[v] and not found.ok.get(v, False)]
            found = pd.concat([found.drop(better), coarser.loc[better]]).loc[found.index]
        return found[found.index.isin(values)] if values else found

    def _line(self, *place: str) -> pd.DataFrame:
        some = next(iter(self._lines.values()), pd.DataFrame())
        return self._lines.get(place, some.iloc[:0])

    def result(self, case: Case) -> Result:
        """Return the result of a case that left fields."""
        found = self.store.result(case)
        assert found is not None
        return found
