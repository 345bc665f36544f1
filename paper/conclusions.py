"""The conclusions of the paper (C1 to C5) and four added statements (P0 to P3), decided."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from paper.runs import HEATS, Runs
from paper.statements import DIFFERENT, FILMS, check, listed
from paper.tables import EQUAL_SOLIDS, SAME, TREATMENTS, asymmetry, printed, spread
from paper.verdict import Finding, Statement

WEAK = 0.01
"""Largest relative change of the film in pure rolling where heat is weak."""
GLASS = {"glass-1": "surface 1 of glass", "glass-2": "surface 2 of glass"}
SOLIDS = {"D-prime": "steel on steel", **GLASS}
TEXTS = tomllib.loads(Path(__file__).with_name("conclusions.toml").read_text(encoding="utf-8"))


@dataclass(frozen=True, slots=True)
class Conclusion:
    """A conclusion with its verdict."""

    name: str
    verdict: str  # "true", "false", or "only ..."
    statements: list[Statement]
    brief: str = ""  # the numbers that decide

    @property
    def text(self) -> str:
        """The conclusion word by word."""
        return str(TEXTS[self.name])


def _decided(name: str, statements: list[Statement], only: str, brief: str = "") -> Conclusion:
    """Return a conclusion that is true if all statements hold when converged."""
    right = [one.text for one in statements if one.converged and one.converged.holds]
    verdict = f"{only}: {', '.join(right)}" if right else "false"
    verdict = "true" if right and len(right) == len(statements) else verdict
    return Conclusion(name, verdict, statements, brief)


def _load_and_speed(name: str, runs: Runs) -> Conclusion:
    """Film and spike with load and speed."""
    statements = [
        check(runs, statement, series, HEATS)
        for statement, series in (
            ("film-falls-with-load", "A"),
            ("spike-falls-with-load", "A"),
            ("film-rises-with-speed", "B"),
            ("spike-rises-with-speed", "B"),
        )
    ]
    brief = "; ".join([_ends(runs, "A"), _ends(runs, "B"), _spike_on_grids(runs)])
    return _decided(name, statements, "only in part", brief)


def _ends(runs: Runs, series: str) -> str:
    """Return isothermal film and spike at both ends of a series."""
    line = runs.line(series, "converged", "isothermal")
    first, last = line.iloc[0], line.iloc[-1]
    return (
        f"from {runs.series[series].symbol} = {first.name:g} to {last.name:g} H_min goes from "
        f"{first.H_min:.3f} to {last.H_min:.3f} and the spike from {first.spike:.2f} to "
        f"{last.spike:.2f}"
    )


def _spike_on_grids(runs: Runs) -> str:
    """Return how far the height of the spike depends on the grid."""
    grids = runs.line("A", "converged", "isothermal").P_on_grids
    words = "; ".join(f"M = {load:g}: {listed(values)}" for load, values in grids.items() if values)
    return (
        "the height of the spike depends on the grid: largest isothermal pressure on grids of "
        f"halved mesh width, {words or 'not known'}"
    )


def _thermal_over_isothermal(runs: Runs, series: str, film: str) -> pd.Series:
    warm, cold = (runs.line(series, "converged", heat)[film] for heat in ("thermal", "isothermal"))
    return (warm / cold).reindex(runs.series[series].values).dropna()


def _thermal_minimum(name: str, runs: Runs) -> Conclusion:
    """Thermal and isothermal minimum; the central film is reported beside."""
    statements, low = [], []
    for series in ("A", "B", "D-prime", "hot"):
        symbol = runs.series[series].symbol
        for film in FILMS:
            ratios = _thermal_over_isothermal(runs, series, film)
            words = ", ".join(f"{ratio:.4f} ({symbol} = {v:g})" for v, ratio in ratios.items())
            text = f"series {series}: thermal {film} below isothermal"
            statements.append(Statement(text, None, Finding(bool(ratios.max() < 1.0), words)))
            low += list(ratios) if film == "H_min" else []
    brief = f"{min(low):.3f} to {max(low):.3f} of the isothermal H_min" if low else ""
    return Conclusion(name, "true" if low and max(low) < 1.0 else "false", statements, brief)


def _surfaces_cooler(name: str, runs: Runs) -> Conclusion:
    """Surfaces and middle."""
    steel, glass = (
        [
            check(runs, "middle-hotter", series, ("thermal",))._replace(text=words)
            for series, words in solids.items()
        ]
        for solids in ({s: f"steel, series {s}" for s in ("A", "B", "C", "D", "D-prime")}, GLASS)
    )
    verdict = _decided(name, steel, "only in part").verdict
    if verdict == "true" and _decided(name, glass, "only in part").verdict != "true":
        verdict = "only if both surfaces conduct heat well"
    return Conclusion(name, verdict, steel + glass)


def _opposite(runs: Runs) -> list[tuple[str, pd.Series, pd.Series]]:
    """Return the thermal runs at SRR = -1 and 1 for each pair of solids, where both left fields."""
    lines = [(words, runs.line(s, "converged", "thermal")) for s, words in SOLIDS.items()]
    return [(w, one.loc[-1.0], one.loc[1.0]) for w, one in lines if {-1.0, 1.0} <= {*one.index}]


def _pressure_and_sliding(name: str, runs: Runs) -> Conclusion:
    """Spike and central pressure with the sign of sliding."""
    statements, peaks = [], "another peak does not occur"
    for words, before, after in _opposite(runs):
        gain = min(after.P_max / before.P_max, after.P_c / before.P_c) - 1.0
        numbers = (
            f"SRR = -1 and 1: P_max {before.P_max:.3f} and {after.P_max:.3f}, P at the centre "
            f"{before.P_c:.3f} and {after.P_c:.3f}, maxima on the centre line {before.peaks} and "
            f"{after.peaks}"
        )
        statements.append(Statement(words, None, Finding(gain > DIFFERENT, numbers)))
        peaks = "another peak occurs" if after.peaks > before.peaks else peaks
    return _decided(name, statements, "only if the solids differ so", peaks)


def _film_and_sliding(name: str, runs: Runs) -> Conclusion:
    """Minimum and central film with the sign of sliding."""
    statements, first = [], []
    for words, negative, positive in _opposite(runs):
        low, central = (positive[film] / negative[film] - 1.0 for film in FILMS)
        first += [words] if low < -DIFFERENT else []
        numbers = f"from SRR = -1 to 1 H_min {100 * low:+.3g} %, H_c {100 * central:+.3g} %"
        holds = low < -DIFFERENT and central > DIFFERENT
        statements.append(Statement(words, None, Finding(holds, numbers)))
    verdict = _decided(name, statements, "only if the solids differ so").verdict
    if verdict == "false" and first:
        verdict = (
            f"first half only if the solids differ so: {', '.join(first)}; second half false: H_c "
            "changes in the direction of H_min"
        )
    low = printed("T3").thermal_H_min
    own = f"Table 3 states the reverse: H_min {low[-1.0]} at SRR = -1, {low[1.0]} at 1"
    return Conclusion(name, verdict, statements, own)


def _isothermal_sliding(name: str, runs: Runs) -> Conclusion:
    """Isothermal films and sliding."""
    statements = []
    for series in EQUAL_SOLIDS:
        lines = (runs.line(series, treatment, "isothermal") for treatment in TREATMENTS)
        worst = [spread(line[FILMS]) for line in lines]
        findings = (Finding(off <= SAME, f"spread {off:.1e}") for off in worst)
        statements.append(Statement(f"series {series}", *findings))
    return _decided(name, statements, "only in part")


def _pure_rolling(name: str, runs: Runs) -> Conclusion:
    """Thermal and isothermal film in pure rolling."""
    statements = []
    for series, words in (("D-prime", "set A (heat is weak)"), ("hot", "set B (heat is strong)")):
        low, central = (_thermal_over_isothermal(runs, series, film)[0.0] for film in FILMS)
        holds = bool(max(abs(low - 1.0), abs(central - 1.0)) <= WEAK)
        finding = Finding(holds, f"H_min {low:.4f}, H_c {central:.4f} of isothermal")
        statements.append(Statement(words, None, finding))
    return _decided(name, statements, "only if heat is weak")


def _mirror(name: str, runs: Runs) -> Conclusion:
    """Mirror symmetry."""
    statements, worst = [], 0.0
    for series in EQUAL_SOLIDS:
        off = [asymmetry(runs, series, treatment) for treatment in TREATMENTS]
        findings = (Finding(one <= SAME, f"differ by {one:.1e}") for one in off)
        statements.append(Statement(f"series {series}", *findings))
        worst = max(worst, *off)
    one, other = (runs.line(series, "converged", "thermal")[FILMS] for series in GLASS)
    swapped = float((one / other.set_index(-other.index) - 1.0).abs().max(axis=None))
    finding = Finding(swapped <= SAME, f"differ by {swapped:.1e}")
    statements.append(Statement("bodies and sign exchanged, steel and glass", None, finding))
    return _decided(name, statements, "only in part", f"equal solids differ by {worst:.0e} at most")


def _dimple(name: str, runs: Runs) -> Conclusion:
    """Rise of the middle of the thermal film beyond that of the isothermal film."""
    statements = [
        check(runs, "dimple", series, ("thermal",))._replace(text=words)
        for series, words in (("A", "steel on steel, series A"), *SOLIDS.items())
    ]
    verdict = _decided(name, statements, "only if the solids differ").verdict
    wedge = [
        check(runs, "dimple-by-wedge", series, ("thermal",))._replace(text=f"{words}: by the wedge")
        for series, words in (("A", "steel on steel, series A"), ("glass-1", GLASS["glass-1"]))
    ]
    return Conclusion(name, verdict, statements + wedge)


CONCLUSIONS = {
    "C1": (_load_and_speed, ("A", "B")),
    "C2": (_thermal_minimum, ("A", "B", "D-prime", "hot")),
    "C3": (_surfaces_cooler, ("A", "B", "C", "D", "D-prime", *GLASS)),
    "C4": (_pressure_and_sliding, tuple(SOLIDS)),
    "C5": (_film_and_sliding, tuple(SOLIDS)),
    "P0": (_isothermal_sliding, EQUAL_SOLIDS),
    "P1": (_pure_rolling, ("D-prime", "hot")),
    "P2": (_mirror, (*EQUAL_SOLIDS, *GLASS)),
    "P3": (_dimple, ("A", *SOLIDS)),
}
"""What decides each conclusion, and the series that it needs."""
