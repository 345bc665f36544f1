"""Check of what the text of the paper states about its figures, from ``statements.toml``."""

import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from paper.runs import Heat, Runs, Treatment
from paper.verdict import Finding, Statement

STATEMENTS = tomllib.loads(Path(__file__).with_name("statements.toml").read_text(encoding="utf-8"))
FILMS = ["H_min", "H_c"]
DIMPLE = 0.02
"""Rise of the middle of the film beyond that of another film that counts as a dimple, over H_c."""
DIFFERENT = 1e-3
"""Relative difference between opposite sliding that counts."""
SIDE = 0.3
"""|Y| beyond which a minimum lies in a side lobe."""
SAME_RISE = 0.1
"""Relative difference up to which temperature rises are the same."""


@dataclass(frozen=True, slots=True)
class Selection:
    """The runs that a statement is checked on."""

    runs: Runs
    series: str
    heats: tuple[Heat, ...]
    treatment: Treatment
    values: tuple[float, ...] = ()  # of what varies; empty for all

    def line(self, heat: Heat) -> pd.DataFrame:
        """Return the runs with or without heat."""
        return self.runs.line(self.series, self.treatment, heat, self.values)

    @property
    def lines(self) -> list[pd.DataFrame]:
        """The runs, one line for each of ``heats`` that has any."""
        return [line for heat in self.heats if len(line := self.line(heat))]


def check(
    runs: Runs, name: str, series: str, heats: tuple[Heat, ...], values: tuple[float, ...] = ()
) -> Statement:
    """Return a statement checked on the runs of a series, on the paper's grid and converged.

    Parameters
    ----------
    runs : Runs
        All runs.
    name : str
        Key of ``statements.toml``.
    series, heats, values
        As in :class:`Selection`.
    """
    stated = STATEMENTS[name]
    test = next(test for key, test in _TESTS.items() if key in stated or stated.get("test") == key)
    on_grid, converged = (
        test(Selection(runs, series, heats, treatment, values), stated)
        for treatment in ("paper", "converged")
    )
    return Statement(stated["text"], on_grid, converged)


def listed(values: Sequence[float], digits: int = 3) -> str:
    """Return numbers separated by commas."""
    return ", ".join(f"{value:.{digits}f}" for value in values)


def changes(sign: float, values: Any, errors: Any = 0.0) -> bool:
    """Whether values rise (``sign`` = 1) or fall (-1) from first to last.

    Each step may go the other way within the errors of its ends. False with NaN.
    """
    steps = sign * np.diff(values)
    bars = np.broadcast_to(errors, np.shape(values))
    within = bool(np.all(steps + bars[:-1] + bars[1:] > 0))
    return within and sign * (values[-1] - values[0]) > 0


def _changing(selection: Selection, stated: dict[str, Any]) -> Finding | None:
    if not selection.lines:
        return None
    sign, columns = (-1.0, stated["falls"]) if "falls" in stated else (1.0, stated["rises"])
    known = columns == FILMS and selection.treatment == "converged"
    holds = all(
        changes(sign, line[name].array, line[f"{name}_error"].array if known else 0.0)
        for line in selection.lines
        for name in columns
    )
    digits = 4 if columns == FILMS else 3
    words = [
        "; ".join(f"{name} {listed(line[name], digits)}" for name in columns)
        for line in selection.lines
    ]
    return Finding(holds, " | ".join(words).replace("nan", "none"))


def _each(selection: Selection, stated: dict[str, Any]) -> Finding | None:
    lines = [line[line[stated.get("known", "ok")].notna()] for line in selection.lines]
    runs = pd.concat(lines) if lines else pd.DataFrame()
    if runs.empty:
        return None
    words = ", ".join(stated["numbers"].format(**run) for run in runs.to_dict("records"))
    return Finding(bool(runs.eval(stated["each"]).all()), words)


def _opposite(selection: Selection) -> tuple[pd.Series, pd.Series] | None:
    """Return the runs of the largest negative and positive sliding."""
    for line in selection.lines[-1:]:
        values = sorted(line.index)
        if values[0] < 0 < values[-1]:
            return line.loc[values[0]], line.loc[values[-1]]
    return None


def _compared(selection: Selection, stated: dict[str, Any]) -> Finding | None:
    pair = _opposite(selection)
    if pair is None:
        return None
    sign, column = (1.0, stated["larger"]) if "larger" in stated else (-1.0, stated["smaller"])
    negative, positive = (float(run[column]) for run in pair)
    holds = sign * (positive - negative) > DIFFERENT * abs(negative)
    name = column.removesuffix("_on_grid")
    return Finding(holds, f"{name} {negative:.5g} for SRR < 0, {positive:.5g} for SRR > 0")


def _moves_to_the_back(selection: Selection, _: object) -> Finding | None:
    pair = _opposite(selection)
    if pair is None:
        return None
    holds = abs(pair[0].Y_of_H_min) > SIDE >= abs(pair[1].Y_of_H_min)
    at = " and ".join(f"({run.X_of_H_min:.2f}, {run.Y_of_H_min:.2f})" for run in pair)
    return Finding(holds, f"minimum at X, Y = {at}")


def _shared(one: pd.DataFrame, other: pd.DataFrame) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the runs of both lines at the values that both have."""
    values = one.index.intersection(other.index, sort=False)
    return one.loc[values], other.loc[values]


def _dimple(selection: Selection, _: object) -> Finding | None:
    """Compare the middle of the thermal film with that of the isothermal film."""
    if "thermal" not in selection.heats:
        return None
    series = "D-prime" if selection.series.startswith("glass") else selection.series
    cold = selection.runs.line(series, selection.treatment, "isothermal")
    return _humps(selection.line("thermal"), cold, "isothermal")


def _dimple_by_wedge(selection: Selection, _: object) -> Finding | None:
    """Compare the middle of the film with that of properties constant across the film."""
    if selection.treatment == "paper":
        return None
    flat = selection.runs.line(selection.series, "mean", "thermal")
    return _humps(selection.line("thermal"), flat, "without the wedge")


def _humps(line: pd.DataFrame, other: pd.DataFrame, words: str) -> Finding | None:
    line, other = _shared(line, other)
    if line.empty:
        return None
    pairs = zip(100 * line.hump, 100 * other.hump, strict=True)
    numbers = ", ".join(f"{a:.1f} % ({b:.1f} %)" for a, b in pairs)
    holds = bool((line.hump - other.hump).max() > DIMPLE)
    return Finding(holds, f"film rises in the middle by {numbers} of H_c ({words})")


def _thermal_below(selection: Selection, _: object) -> Finding | None:
    warm, cold = _shared(selection.line("thermal"), selection.line("isothermal"))
    if warm.empty:
        return None
    ratios = warm.H_min / cold.H_min
    return Finding(bool(ratios.max() < 1.0), f"thermal over isothermal H_min {listed(ratios, 4)}")


def _same_temperatures(selection: Selection, _: object) -> Finding | None:
    """Compare two contacts of one M and L that differ in size and speed."""
    lines = (selection.runs.line(s, "converged", "thermal") for s in ("D-prime", "hot"))
    usual, hot = _shared(*lines)
    if selection.treatment == "paper" or usual.empty or usual.index[-1] <= 0.0:
        return None
    one, other = usual.rise_c.iloc[-1], hot.rise_c.iloc[-1]
    return Finding(
        bool(abs(other / one - 1.0) < SAME_RISE),
        f"at M = 40, L = 12.04, SRR = {usual.index[-1]:g} the centre is {one:.0f} K warmer than "
        f"the inlet with set A and {other:.0f} K with set B",
    )


_TESTS: dict[str, Callable[[Selection, dict[str, Any]], Finding | None]] = {
    "falls": _changing,
    "rises": _changing,
    "each": _each,
    "larger": _compared,
    "smaller": _compared,
    "dimple": _dimple,
    "dimple-by-wedge": _dimple_by_wedge,
    "thermal-minimum-below": _thermal_below,
    "temperatures-known": _same_temperatures,
    "minimum-moves-to-the-back": _moves_to_the_back,
}
"""Tests by key of a statement, or by what its key ``test`` says."""
