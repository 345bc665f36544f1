"""The tables of the paper, beside ours."""

from collections.abc import Callable
from dataclasses import dataclass

from tehl.film_formulas import hamrock_dowson, hertz_ratio_squared
from tehl.reproduce.book import Book
from tehl.reproduce.claims import LEAST_DIFFERENCE
from tehl.reproduce.judge import Check, Finding, Verdict, judged
from tehl.reproduce.measures import Measures
from tehl.reproduce.open_runs import open_runs
from tehl.reproduce.parameters import parameter_rows
from tehl.reproduce.printed import printed
from tehl.reproduce.series import Heat, Run, Treatment
from tehl.scaling import groups

NEAR_MINIMUM, NEAR_CENTRAL = 0.05, 0.12
"""How near a print on 64 x 64 intervals has to come, relatively."""
NEAR_RATIO = 0.015
"""The same of the ratio of thermal and isothermal films."""
ROUNDING = 5e-5
"""Half of the last printed digit."""
AGREES = 0.1
"""Difference up to which two columns agree, relatively."""
SAME = 1e-6
"""Relative difference up to which numbers are equal."""
WAYS: tuple[Treatment, Treatment] = ("paper", "converged")
"""The two treatments of each contact."""
_HEATS: tuple[Heat, Heat] = ("isothermal", "thermal")
_FILMS = (("minimum", "H_min"), ("central", "H_c"))
_MINUS = "\N{MINUS SIGN}"
_GRID = "the {} films are those of 64 × 64 intervals"


@dataclass(frozen=True, kw_only=True, slots=True)
class Table:
    """A table and what can be said of it.

    Attributes
    ----------
    name, title : str
        "T2", and what it holds.
    head : tuple of str
        Names of the columns.
    rows : tuple of tuple of str
        Cells.
    notes : tuple of str
        Footnotes.
    verdict : Verdict
        What can be said of it.
    """

    name: str
    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...]
    verdict: Verdict


def table_1(book: Book) -> Table:
    """Return the parameters: what the paper states, and what had to be assumed."""
    del book
    rows = parameter_rows()
    missing = [row.name for row in rows if row.assumed]
    check = Check(
        "the printed parameters fix the problem",
        None,
        Finding(not missing, f"not printed: {', '.join(missing)}"),
    )
    return Table(
        name="T1",
        title="Solid and lubricant properties",
        head=("", "printed", "set A", "set B", ""),
        rows=tuple((r.name, r.printed, r.set_a, r.set_b, r.remark) for r in rows),
        notes=(
            "“Table 1 (Continued)” is lost; the values without print are assumed. The four speeds "
            "L of series B are in the ratios of 2U = 4.2, 5, 6 and 7e-11 with one G = 5126; set A "
            "has G = 5117.",
            "“Density of surfaces 2000” repeats the heat capacity of the lubricant.",
            "“Temperature-viscosity coefficient -1.1” is the index of Roelands' law with its sign, "
            "S0 = 1.1: read as gamma = 1.1 1/K it would thin the oil by e for each kelvin, read as "
            "-1.1 the oil would thicken when it gets warm.",
        ),
        verdict=judged([check]),
    )


def table_2(book: Book) -> Table:
    """Return film thickness for three loads, with Hamrock and Dowson's formula."""
    loads = printed().column("T2", "M")
    rows = [
        _film_row(book, "A", heat, load, f"M = {load:g}", film)
        for load in loads
        for heat in _HEATS
        for film in _FILMS
    ]
    rows += [_formula_row(book, load, film) for load in loads for film in _FILMS]
    checks = [
        _near_check(book, "A", "isothermal", loads, _GRID.format("isothermal")),
        _near_check(book, "A", "thermal", loads, _GRID.format("thermal")),
        _ratio_check(book, loads, "minimum"),
        _ratio_check(book, loads, "central"),
        _formula_check(book, loads),
        _agreement_check(loads),
    ]
    return Table(
        name="T2",
        title="Minimum and central film for three loads, L = 12.04, SRR = 0.25, smooth",
        head=_HEAD,
        rows=tuple(row for row in rows if row),
        notes=(
            "0.6199 is printed where 0.1699 stands: it would exceed the central film of its row, "
            "and with two digits exchanged its ratios to the numbers beside it are those of the "
            "other rows.",
            *_formula_notes(book, loads),
            *_ratio_notes(book, loads),
            "The paper's column is 64 × 64 intervals of second order and carries their error: "
            "compare it with ours on that grid. The right answer is the converged one.",
        ),
        verdict=judged(checks, _open_runs_2(book, tuple(loads))),
    )


def _open_runs_2(book: Book, loads: tuple[float, ...]) -> str:
    """Say which of the wide runs are no answer, or else which of those on the paper's domain."""
    wide = open_runs(book, ["A"], values=loads)
    return wide or open_runs(book, ["A"], values=loads, way="domain")


def table_3(book: Book) -> Table:
    """Return film thickness for five slide-roll ratios."""
    ratios = printed().column("T3", "SRR")
    rows = []
    for name, words in (
        ("D", "M = 57.21, wavy"),
        ("D-prime", "M = 40, smooth"),
        ("D-prime-wavy", "M = 40, wavy"),
    ):
        rows += [
            _film_row(book, name, heat, ratio, f"{words}, SRR = {_signed(ratio)}", film)
            for heat in _HEATS
            for ratio in ratios
            for film in _FILMS
        ]
    checks = [
        _near_check(book, "D", "isothermal", ratios, "the isothermal films are those of its label"),
        _near_check(book, "D", "thermal", ratios, "the thermal films are those of its label"),
        _independence_check(book),
        _symmetry_check(book),
    ]
    return Table(
        name="T3",
        title="Minimum and central film for five slide-roll ratios",
        head=_HEAD,
        rows=tuple(row for row in rows if row),
        notes=_notes_3(book, ratios),
        verdict=judged(checks, open_runs(book, ["D", "D-prime", "D-prime-wavy"])),
    )


TABLES: dict[str, tuple[Callable[[Book], Table], tuple[str, ...]]] = {
    "T1": (table_1, ()),
    "T2": (table_2, ("A",)),
    "T3": (table_3, ("D", "D-prime", "D-prime-wavy", "D-smooth")),
}
"""Tables by name, and the series they need."""

_HEAD = (
    "",
    "",
    "",
    "paper",
    "ours, paper's grid",
    "ours, converged",
    "Hamrock-Dowson",
    "paper / ours, its grid",
    "paper / converged",
)


_CANDIDATES = {
    "D": "M = 57.21, L = 10.52, wavy",
    "D-smooth": "M = 57.21, L = 10.52, smooth",
    "D-prime": "M = 40, L = 12.04, smooth (the first row of Table 2)",
    "D-prime-wavy": "M = 40, L = 12.04, wavy",
}


# ---- rows


def _film_row(
    book: Book, series: str, heat: Heat, value: float, label: str, film: tuple[str, str]
) -> tuple[str, ...]:
    """Return a row of one number; nothing where it was not computed."""
    coarse = book.line(series, "paper", heat).get(value)
    fine = book.line(series, "converged", heat).get(value)
    run = book.run(series, "converged", heat, value)
    print_ = _print(series, heat, value, film[0])
    if coarse is None or fine is None or run is None or print_ is None:
        return ()
    on_grid, best = _value(coarse, film[0]), _value(fine, film[0])
    return (
        label,
        heat,
        film[1],
        f"{print_:.4f}",
        _marked(on_grid, coarse),
        _with_error(fine, film[0]),
        f"{_formula(run)[film[0]]:.4f}",
        f"{print_ / on_grid:.3f}" if on_grid > 0 else "",
        f"{print_ / best:.3f}" if best > 0 else "",
    )


def _formula_row(book: Book, load: float, film: tuple[str, str]) -> tuple[str, ...]:
    """Return a row of the column that is called Hamrock and Dowson."""
    run = book.run("A", "converged", "isothermal", load)
    if run is None:
        return ()
    place = printed().column("T2", "M").index(load)
    print_ = printed().column("T2", f"formula_{film[0]}")[place]
    true = _formula(run)[film[0]]
    return (
        f"M = {load:g}",
        "“Hamrock and Dowson”",
        film[1],
        f"{print_:.4f}",
        "",
        "",
        f"{true:.4f}",
        "",
        f"{print_ / true:.3f} of the formula",
    )


def _print(series: str, heat: Heat, value: float, film: str) -> float | None:
    found = printed().films(series, heat).get(value)
    return None if found is None else found[0 if film == "minimum" else 1]


def _value(measures: Measures, film: str) -> float:
    return float(getattr(measures.film, f"best_{film}"))


def _marked(value: float, measures: Measures) -> str:
    """Return a number; a star where the run is no converged answer."""
    return f"{value:.4f}" + ("" if measures.quality.converged else " *")


def _with_error(measures: Measures, film: str) -> str:
    error = float(getattr(measures.film, f"{film}_error"))
    digits = 5 if error < 0.001 else 4
    star = "" if measures.quality.converged else " *"
    return f"{_value(measures, film):.{digits}f} ± {error:.{digits}f}{star}"


def _formula(run: Run) -> dict[str, float]:
    """Return the film of Hamrock and Dowson's formula, H."""
    numbers = groups(run.case.problem)
    found, unit = hamrock_dowson(numbers), hertz_ratio_squared(numbers)
    return {"minimum": (found.minimum or 0.0) / unit, "central": found.central / unit}


def _signed(value: float) -> str:
    return f"{value:g}".replace("-", _MINUS)


# ---- what decides


def _near_check(book: Book, series: str, heat: Heat, values: list[float], statement: str) -> Check:
    """Hold the print against ours on its grid."""
    off = {
        film: max(
            (abs(ratio - 1.0) for ratio in _ratios(book, series, heat, values, film)), default=0
        )
        for film, _ in _FILMS
    }
    if not any(off.values()):
        return Check(statement, None, None)
    holds = off["minimum"] <= NEAR_MINIMUM and off["central"] <= NEAR_CENTRAL
    numbers = (
        f"print off ours on its grid by {100 * off['minimum']:.1f} % (H_min, limit "
        f"{100 * NEAR_MINIMUM:.0f} %) and {100 * off['central']:.1f} % (H_c, limit "
        f"{100 * NEAR_CENTRAL:.0f} %) at most"
    )
    return Check(statement, Finding(holds, numbers), Finding(holds, numbers))


def _ratios(book: Book, series: str, heat: Heat, values: list[float], film: str) -> list[float]:
    """Return print over ours on its grid."""
    line = book.line(series, "paper", heat)
    prints = printed().films(series, heat)
    place = 0 if film == "minimum" else 1
    return [prints[v][place] / _value(line[v], film) for v in values if v in line and v in prints]


def _ratio_check(book: Book, loads: list[float], film: str) -> Check:
    """Hold the ratio of thermal and isothermal films against ours, on the domain of the paper.

    A film of fine grids on a wide domain is another contact: the ratio there is told beside it.
    """
    name = dict(_FILMS)[film]
    on_grid, fine, wide = (
        _ratio_finding(book, loads, film, way) for way in ("paper", "domain", "converged")
    )
    if fine is not None and wide is not None:
        numbers = f"on the paper's domain {fine.numbers}; on a wide one {wide.numbers}"
        fine = Finding(fine.holds, numbers)
    return Check(f"the effect of heat on {name}", on_grid, fine)


def _ratio_finding(book: Book, loads: list[float], film: str, way: Treatment) -> Finding | None:
    warm = book.line("A", way, "thermal")
    cold = book.line("A", way, "isothermal")
    pairs, blurred = [], 0.0
    for load in loads:
        if load not in warm or load not in cold:
            return None
        first, second = (_print("A", heat, load, film) or 0.0 for heat in ("thermal", "isothermal"))
        pairs.append((first / second, _value(warm[load], film) / _value(cold[load], film)))
        blurred = max(blurred, ROUNDING / first + ROUNDING / second)
    worst = max(abs(theirs - ours) for theirs, ours in pairs)
    words = ", ".join(f"{theirs:.4f} ({ours:.4f})" for theirs, ours in pairs)
    return Finding(
        worst <= NEAR_RATIO,
        f"thermal over isothermal, paper (ours): {words}; off by {worst:.4f} (limit {NEAR_RATIO}), "
        f"of which the rounding of the print may be {blurred:.4f}",
    )


def _formula_check(book: Book, loads: list[float]) -> Check:
    ratios = []
    for place, load in enumerate(loads):
        run = book.run("A", "converged", "isothermal", load)
        if run is None:
            continue
        true = _formula(run)
        ratios += [printed().column("T2", f"formula_{f}")[place] / true[f] for f, _ in _FILMS]
    holds = bool(ratios) and all(abs(ratio - 1.0) < AGREES for ratio in ratios)
    numbers = "column over formula " + ", ".join(f"{ratio:.3f}" for ratio in ratios)
    return Check("the column “Hamrock and Dowson” is that formula", None, Finding(holds, numbers))


def _agreement_check(loads: list[float]) -> Check:
    ours = printed().column("T2", "isothermal_minimum") + printed().column(
        "T2", "isothermal_central"
    )
    theirs = printed().column("T2", "formula_minimum") + printed().column("T2", "formula_central")
    off = [a / b - 1.0 for a, b in zip(ours, theirs, strict=True)]
    numbers = f"{100 * min(off):+.0f} % to {100 * max(off):+.0f} % between the printed columns"
    del loads
    return Check(
        "results and Hamrock and Dowson “agree very well”",
        None,
        Finding(max(map(abs, off)) < AGREES, numbers),
    )


def _formula_notes(book: Book, loads: list[float]) -> tuple[str, ...]:
    found = _formula_check(book, loads).converged
    return (
        ()
        if found is None
        else (
            "The column “Hamrock and Dowson” has the load exponents of the formula, but one factor "
            f"({found.numbers}): an error of conversion, the same in all rows.",
        )
    )


def _ratio_notes(book: Book, loads: list[float]) -> tuple[str, ...]:
    found = _ratio_check(book, loads, "minimum").converged
    return () if found is None else (f"Effect of heat on H_min: {found.numbers}.",)


def spread(values: list[float]) -> float:
    """Return the largest relative difference from the first value."""
    return max((abs(value / values[0] - 1.0) for value in values), default=0.0)


def _independence_check(book: Book) -> Check:
    findings = []
    for way in WAYS:
        worst = 0.0
        for name in ("D", "D-prime", "D-prime-wavy"):
            line = list(book.line(name, way, "isothermal").values())
            for film, _ in _FILMS:
                worst = max(worst, spread([_value(m, film) for m in line]))
        print_ = max(spread(printed().column("T3", f"isothermal_{f}")) for f, _ in _FILMS)
        findings.append(
            Finding(
                print_ <= SAME,
                f"ours are equal to {worst:.1e}, the printed rows differ by {100 * print_:.1f} %",
            )
        )
    return Check("the isothermal rows are one film, as they must be", *findings)


def asymmetry(book: Book, series: str, way: Treatment) -> float:
    """Return the largest relative difference of thermal films at opposite sliding."""
    line = book.line(series, way, "thermal")
    pairs = [(line[v], line[-v]) for v in line if v > 0 and -v in line]
    return max(
        (abs(_value(a, f) / _value(b, f) - 1.0) for a, b in pairs for f, _ in _FILMS), default=0.0
    )


def _symmetry_check(book: Book) -> Check:
    """Hold the printed asymmetry against ours: equal solids cannot tell the sign of sliding."""
    low = printed().column("T3", "thermal_minimum")
    off = abs(low[0] / low[-1] - 1.0)
    findings = []
    for way in WAYS:
        worst = max(asymmetry(book, name, way) for name in ("D", "D-prime", "D-prime-wavy"))
        findings.append(
            Finding(
                worst > LEAST_DIFFERENCE,
                f"ours differ by {worst:.1e} at most, the printed H_min at SRR = ±1 by "
                f"{100 * off:.0f} %",
            )
        )
    return Check("equal solids make different films for SRR and -SRR", *findings)


def _notes_3(book: Book, ratios: list[float]) -> tuple[str, ...]:
    worst = max(asymmetry(book, name, "converged") for name in ("D", "D-prime", "D-prime-wavy"))
    return (
        f"The table is labelled M = 57.21, L = 10.52 with roughness. {_nearest(book, ratios)}",
        "Isothermal Reynolds knows no sliding, so all five rows are one film; the spread of the "
        "printed ones is the noise of the paper's iteration.",
        "Between equal solids SRR and -SRR are the same contact seen in a mirror: ours agree to "
        f"{worst:.0e}, relatively. The printed asymmetry is an artefact.",
        "A star marks runs that are no converged answer: the list of runs says what is wrong with "
        "each. On the paper's domain the sides at Y = ±2 starve M = 40 by a rule of thumb.",
    )


def _nearest(book: Book, ratios: list[float]) -> str:
    """Say which contact the isothermal numbers of Table 3 belong to."""
    off: dict[str, tuple[float, float]] = {}
    for name, words in _CANDIDATES.items():
        print_over_ours = [_mean(_ratios(book, name, "isothermal", ratios, f)) for f, _ in _FILMS]
        if all(print_over_ours):
            off[words] = (print_over_ours[0] - 1.0, print_over_ours[1] - 1.0)
    if not off:
        return ""
    best = min(off, key=lambda words: sum(map(abs, off[words])))
    told = "; ".join(f"{w}: {100 * a:+.0f} %, {100 * b:+.0f} %" for w, (a, b) in off.items())
    return (
        f"Its isothermal numbers are nearest to {best}. Mean of the printed rows over ours on the "
        f"paper's grid, H_min and H_c: {told}."
    )


def _mean(values: list[float]) -> float:
    return sum(values) / len(values) if values else 0.0
