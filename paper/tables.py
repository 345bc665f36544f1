"""The three tables of the paper beside ours, and their verdicts."""

import math
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from paper.runs import HEATS, Heat, Runs, Treatment
from paper.statements import DIFFERENT, FILMS, listed
from paper.unconverged import unconverged
from paper.verdict import Finding, Statement, Verdict, judge

TREATMENTS: tuple[Treatment, Treatment] = ("paper", "converged")
NEAR = {"H_min": 0.05, "H_c": 0.12}
"""Largest relative difference between print and ours on the paper's grid."""
NEAR_RATIO = 0.015
"""Largest difference between printed and our ratio of thermal and isothermal films."""
ROUNDING = 5e-5
"""Half of the last printed digit."""
AGREES = 0.1
"""Relative difference up to which two columns agree."""
SAME = 1e-6
"""Relative difference up to which numbers are equal."""
EQUAL_SOLIDS = ("D", "D-prime", "D-prime-wavy")
CANDIDATES = {
    "D": "M = 57.21, L = 10.52, wavy",
    "D-smooth": "M = 57.21, L = 10.52, smooth",
    "D-prime": "M = 40, L = 12.04, smooth (the first row of Table 2)",
    "D-prime-wavy": "M = 40, L = 12.04, wavy",
}
"""Contacts that Table 3 may belong to."""
TABLES = tomllib.loads(Path(__file__).with_name("tables.toml").read_text(encoding="utf-8"))
SERIES_OF = {"T1": (), "T2": ("A",), "T3": tuple(CANDIDATES)}
"""Series that each table needs."""


@dataclass(frozen=True, slots=True)
class Table:
    """A table of the paper beside ours."""

    name: str
    head: tuple[str, ...]
    rows: list[tuple[str, ...]]
    notes: list[str]
    verdict: Verdict

    @property
    def title(self) -> str:
        """What it shows."""
        return str(TABLES[self.name]["title"])


def printed(table: str, *, corrected: bool = True) -> pd.DataFrame:
    """Return what Table 2 or 3 prints by load or sliding, its misprint corrected or not."""
    better = TABLES[table].get("corrected", {}) if corrected else {}
    frame = pd.DataFrame(TABLES[table]["printed"] | better)
    return frame.set_index(frame.columns[0])


def printed_films(series: str, heat: str) -> pd.DataFrame:
    """Return printed H_min and H_c of a series by what varies, empty where nothing is printed."""
    if series not in ("A", *CANDIDATES):
        return pd.DataFrame(columns=FILMS)
    frame = printed("T2" if series == "A" else "T3")
    return pd.DataFrame({film: frame[f"{heat}_{film}"] for film in FILMS})


def make_table(name: str, runs: Runs) -> Table:
    """Return a table of the paper beside ours: "T1", "T2" or "T3"."""
    return {"T1": _table_1, "T2": _table_2, "T3": _table_3}[name](runs)


def _table_1(_: Runs) -> Table:
    rows = [tuple(row) for row in TABLES["T1"]["rows"]]
    missing = [name for name, value, *_ in rows if not value]
    finding = Finding(False, f"not printed: {', '.join(missing)}")
    verdict = judge([Statement("the printed parameters fix the problem", None, finding)])
    return Table("T1", ("", "printed", "set A", "set B", ""), rows, TABLES["T1"]["notes"], verdict)


def _table_2(runs: Runs) -> Table:
    loads = tuple(printed("T2").index)
    formula, on_low, on_central = _formula(runs, loads), _ratio(runs, "H_min"), _ratio(runs, "H_c")
    ours = ("ours, paper's grid", "ours, converged", "Hamrock-Dowson")
    head = ("", "", "", "paper", *ours, "paper / ours, its grid", "paper / converged")
    rows = [_row_2(runs, load, heat, film) for load in loads for heat in HEATS for film in FILMS]
    rows += [_formula_row(runs, load, film) for load in loads for film in FILMS]
    words = {"formula": formula.numbers, "heat": on_low.converged.numbers}  # type: ignore[union-attr]
    statements = [
        *(
            _near(runs, "A", heat, loads, f"the {heat} films are those of 64 × 64 intervals")
            for heat in HEATS
        ),
        *(on_low, on_central),
        Statement("the column “Hamrock and Dowson” is that formula", None, formula),
        _agreement(),
    ]
    failed = unconverged(runs, ["A"], values=loads) or unconverged(
        runs, ["A"], values=loads, treatment="domain"
    )
    return Table("T2", head, rows, _notes("T2", **words), judge(statements, failed))


def _table_3(runs: Runs) -> Table:
    ratios = tuple(printed("T3").index)
    labels = ("M = 57.21, wavy", "M = 40, smooth", "M = 40, wavy")
    treatments = ("its grid", "converged")
    head = ("", "", "SRR", "paper", *(f"{c}, {t}" for c in labels for t in treatments))
    rows = [_row_3(runs, heat, film, ratio) for heat in HEATS for film in FILMS for ratio in ratios]
    lines = {name: runs.line(name, "converged", "isothermal") for name in ("D", "D-prime")}
    formula = "; ".join(
        f"{CANDIDATES[name].split(',')[0]}: H_min {line.formula_H_min.mean():.4f}, H_c "
        f"{line.formula_H_c.mean():.4f}"
        for name, line in lines.items()
    )
    worst = max(asymmetry(runs, name, "converged") for name in EQUAL_SOLIDS)
    statements = [
        *(
            _near(runs, "D", heat, ratios, f"the {heat} films are those of its label")
            for heat in HEATS
        ),
        *(_independence(runs), _symmetry(runs)),
    ]
    notes = _notes("T3", formula=formula, worst=worst, **_nearest(runs))
    return Table("T3", head, rows, notes, judge(statements, unconverged(runs, EQUAL_SOLIDS)))


def _notes(table: str, **words: object) -> list[str]:
    return [note.format(**words) for note in TABLES[table]["notes"]]


# ---- rows


def _row_2(runs: Runs, load: float, heat: Heat, film: str) -> tuple[str, ...]:
    coarse, fine = (runs.line("A", treatment, heat) for treatment in TREATMENTS)
    value = printed_films("A", heat)[film][load]
    return (
        *(f"M = {load:g}", heat, film, f"{value:.4f}"),
        _number(coarse, load, film),
        _number(fine, load, film, error=True),
        f"{fine[f'formula_{film}'].get(load, math.nan):.4f}",
        *(f"{value / line[film].get(load, math.nan):.3f}" for line in (coarse, fine)),
    )


def _formula_row(runs: Runs, load: float, film: str) -> tuple[str, ...]:
    """Return a row of the column that is called Hamrock and Dowson."""
    value = printed("T2")[f"formula_{film}"][load]
    true = runs.line("A", "converged", "isothermal")[f"formula_{film}"].get(load, math.nan)
    return (
        *(f"M = {load:g}", "“Hamrock and Dowson”", film, f"{value:.4f}", "", ""),
        *(f"{true:.4f}", "", f"{value / true:.3f} of the formula"),
    )


def _row_3(runs: Runs, heat: Heat, film: str, ratio: float) -> tuple[str, ...]:
    cells = [
        _number(runs.line(name, treatment, heat), ratio, film, error=treatment == "converged")
        for name in EQUAL_SOLIDS
        for treatment in TREATMENTS
    ]
    value = printed("T3")[f"{heat}_{film}"][ratio]
    return (heat, film, f"{ratio:g}".replace("-", "\N{MINUS SIGN}"), f"{value:.4f}", *cells)


def _number(line: pd.DataFrame, value: float, film: str, *, error: bool = False) -> str:
    """Return a film, with its error bar if wanted, and a star where the run did not converge."""
    if value not in line.index:
        return "no fields"
    run = line.loc[value]
    star = "" if run.ok else " *"
    if not error:
        return f"{run[film]:.4f}{star}"
    bar = run[f"{film}_error"]
    digits = 5 if bar < 0.001 else 4
    return f"{run[film]:.{digits}f} ± {bar:.{digits}f}{star}"


# ---- statements


def _ratios(runs: Runs, series: str, heat: Heat, film: str) -> pd.Series:
    """Return print over ours on the paper's grid."""
    return (printed_films(series, heat)[film] / runs.line(series, "paper", heat)[film]).dropna()


def _near(runs: Runs, series: str, heat: Heat, values: Iterable[float], text: str) -> Statement:
    """Compare the print with ours on the paper's grid."""
    ratios = {film: _ratios(runs, series, heat, film).reindex(values) for film in FILMS}
    off = {film: float((ratio - 1.0).abs().max()) for film, ratio in ratios.items()}
    words = " and ".join(
        f"{100 * off[film]:.1f} % ({film}, limit {100 * NEAR[film]:.0f} %)" for film in FILMS
    )
    holds = all(off[film] <= NEAR[film] for film in FILMS)
    finding = Finding(holds, f"print differs from ours on its grid by at most {words}")
    return Statement(text, finding, finding)


def _ratio(runs: Runs, film: str) -> Statement:
    """Compare the ratio of thermal and isothermal films, on the domain of the paper.

    A film of a wide domain is another contact: its ratio is reported beside.
    """
    ways: tuple[Treatment, ...] = ("paper", "domain", "converged")
    on_grid, fine, wide = (_ratio_finding(runs, film, way) for way in ways)
    numbers = f"on the paper's domain {fine.numbers}; on a wide one {wide.numbers}"
    return Statement(f"the effect of heat on {film}", on_grid, Finding(fine.holds, numbers))


def _ratio_finding(runs: Runs, film: str, treatment: Treatment) -> Finding:
    warm, cold = (printed_films("A", heat)[film] for heat in ("thermal", "isothermal"))
    our_warm, our_cold = (runs.line("A", treatment, h)[film] for h in ("thermal", "isothermal"))
    theirs, ours = warm / cold, (our_warm / our_cold).reindex(warm.index)
    worst = float((theirs - ours).abs().max())
    blurred = float((ROUNDING / warm + ROUNDING / cold).max())
    words = ", ".join(f"{a:.4f} ({b:.4f})" for a, b in zip(theirs, ours, strict=True))
    return Finding(
        worst <= NEAR_RATIO,
        f"thermal over isothermal, paper (ours): {words}; largest difference {worst:.4f} (limit "
        f"{NEAR_RATIO}), of which rounding of the print may be {blurred:.4f}",
    )


def _formula(runs: Runs, loads: tuple[float, ...]) -> Finding:
    line = runs.line("A", "converged", "isothermal", loads)
    columns = [f"formula_{film}" for film in FILMS]
    ratios = (printed("T2")[columns] / line[columns]).to_numpy(float).ravel()
    holds = bool((abs(ratios - 1.0) < AGREES).all())
    return Finding(holds, f"column over formula {listed(ratios)}")


def _agreement() -> Statement:
    table = printed("T2")
    off = pd.concat([table[f"isothermal_{f}"] / table[f"formula_{f}"] - 1.0 for f in FILMS])
    numbers = f"{100 * off.min():+.0f} % to {100 * off.max():+.0f} % between the printed columns"
    finding = Finding(bool(off.abs().max() < AGREES), numbers)
    return Statement("results and Hamrock and Dowson “agree very well”", None, finding)


def spread(films: pd.DataFrame) -> float:
    """Return the largest relative difference of films from those of the first row."""
    return float((films / films.iloc[0] - 1.0).abs().max(axis=None))


def _independence(runs: Runs) -> Statement:
    theirs = spread(printed_films("D", "isothermal"))
    findings = []
    for treatment in TREATMENTS:
        lines = [runs.line(name, treatment, "isothermal") for name in EQUAL_SOLIDS]
        worst = max(spread(line[FILMS]) for line in lines)
        numbers = f"ours are equal to {worst:.1e}, the printed rows differ by {100 * theirs:.1f} %"
        findings.append(Finding(theirs <= SAME, numbers))
    return Statement("the isothermal rows are one film, as they must be", *findings)


def asymmetry(runs: Runs, series: str, treatment: Treatment) -> float:
    """Return the largest relative difference of thermal films at opposite sliding.

    Parameters
    ----------
    runs : Runs
        All runs.
    series, treatment : str
        Which of them.
    """
    films = runs.line(series, treatment, "thermal")[FILMS]
    return float((films / films.set_index(-films.index) - 1.0).abs().max(axis=None))


def _symmetry(runs: Runs) -> Statement:
    """Compare the printed asymmetry with ours: equal solids give equal films at SRR and -SRR."""
    low = printed("T3").thermal_H_min
    off = 100 * abs(low.iloc[0] / low.iloc[-1] - 1.0)
    findings = []
    for treatment in TREATMENTS:
        worst = max(asymmetry(runs, name, treatment) for name in EQUAL_SOLIDS)
        words = f"ours differ by {worst:.1e} at most, the printed H_min at SRR = ±1 by {off:.0f} %"
        findings.append(Finding(worst > DIFFERENT, words))
    return Statement("equal solids make different films for SRR and -SRR", *findings)


def _nearest(runs: Runs) -> dict[str, str]:
    """Return which contact the isothermal numbers of Table 3 belong to."""
    off = {
        words: [_ratios(runs, name, "isothermal", film).mean() - 1.0 for film in FILMS]
        for name, words in CANDIDATES.items()
    }
    each = "; ".join(f"{w}: {100 * a:+.0f} %, {100 * b:+.0f} %" for w, (a, b) in off.items())
    return {"nearest": min(off, key=lambda words: sum(map(abs, off[words]))), "ratios": each}
