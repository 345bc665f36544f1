"""The conclusions of the paper and what was added to them, as computed statements."""

from collections.abc import Callable
from dataclasses import dataclass

from tehl.reproduce.book import Book
from tehl.reproduce.claims import LEAST_DIFFERENCE, LEAST_DIMPLE, View, check
from tehl.reproduce.measures import Measures
from tehl.reproduce.printed import printed
from tehl.reproduce.series import Heat
from tehl.reproduce.tables import SAME, WAYS, asymmetry, spread

WEAK = 0.01
"""What compression alone may do to the film where heat is weak, relatively."""
_HEATS: tuple[Heat, Heat] = ("isothermal", "thermal")
_EQUAL = ("D", "D-prime", "D-prime-wavy")
_ROLES = {"glass-1": "surface 1 of glass", "glass-2": "surface 2 of glass"}


@dataclass(frozen=True, slots=True)
class Proposition:
    """A statement with its verdict.

    Attributes
    ----------
    name, text : str
        "C1", and the statement.
    verdict : str
        "true", "false", or "only if ...".
    numbers : tuple of str
        That decide.
    brief : str
        The most telling of them.
    """

    name: str
    text: str
    verdict: str
    numbers: tuple[str, ...]
    brief: str = ""

    @property
    def told(self) -> str:
        """Return the verdict with its most telling numbers."""
        return f"{self.verdict}; {self.brief}" if self.brief else self.verdict


def _all_or(parts: list[tuple[str, bool, str]]) -> str:
    """Return true, false, or which parts are true."""
    right = [name for name, holds, _ in parts if holds]
    if len(right) == len(parts):
        return "true"
    return f"only in part: {', '.join(right)}" if right else "false"


def _lines(parts: list[tuple[str, bool, str]]) -> tuple[str, ...]:
    return tuple(
        f"{name}: {'true' if holds else 'false'} - {numbers}" for name, holds, numbers in parts
    )


def conclusion_1(book: Book) -> Proposition:
    """Film and spike with load and speed."""
    parts = []
    for name, claim, one in (
        ("the film falls with M", "film-falls-with-load", "A"),
        ("the spike falls with M", "spike-falls-with-load", "A"),
        ("the film rises with L", "film-rises-with-speed", "B"),
        ("the spike rises with L", "spike-rises-with-speed", "B"),
    ):
        found = check(book, claim, one, _HEATS)
        for where, finding in (("paper's grid", found.paper), ("converged", found.converged)):
            if finding is not None:
                parts.append((f"{name} ({where})", finding.holds, finding.numbers))
    fine = [part for part in parts if "converged" in part[0]]
    numbers = _lines(parts) + _spike_on_grids(book)
    brief = "; ".join(words for name in ("A", "B") if (words := _ends(book, name)))
    return Proposition("C1", printed().conclusion(1), _all_or(fine), numbers, brief)


def _ends(book: Book, name: str) -> str:
    """Return isothermal film and spike at both ends of a series."""
    line = book.line(name, "converged", "isothermal")
    if not line:
        return ""
    low, high = min(line), max(line)
    first, last = line[low], line[high]
    return (
        f"{book.series[name].symbol} = {low:g} to {high:g} takes H_min from "
        f"{first.film.best_minimum:.3f} to {last.film.best_minimum:.3f} and the spike from "
        f"{first.pressure.crest:.2f} to {last.pressure.crest:.2f}"
    )


def _spike_on_grids(book: Book) -> tuple[str, ...]:
    """Say how far the height of the spike is a matter of the grid."""
    line = book.line("A", "converged", "isothermal")
    words = [
        f"M = {load:g}: {', '.join(f'{p:.3f}' for p in m.pressure.on_grids)}"
        for load, m in line.items()
        if m.pressure.on_grids
    ]
    if not words:
        return ()
    return (
        "the height of the spike belongs to the grid: largest isothermal pressure on grids halved "
        f"each time, {'; '.join(words)}",
    )


def conclusion_2(book: Book) -> Proposition:
    """Thermal and isothermal minimum."""
    parts, holds, low = [], True, []
    for name in ("A", "B", "D-prime", "hot"):
        view = View(book, name, _HEATS, "converged")
        warm, cold = view.line("thermal"), view.line("isothermal")
        shared = [v for v in warm if v in cold]
        for film, label in (("minimum", "H_min"), ("central", "H_c")):
            ratios = [_film(warm[v], film) / _film(cold[v], film) for v in shared]
            if not ratios:
                continue
            smaller = max(ratios) < 1.0
            holds &= smaller or film == "central"
            low += ratios if film == "minimum" else []
            values = ", ".join(
                f"{ratio:.4f} ({book.series[name].symbol} = {v:g})"
                for v, ratio in zip(shared, ratios, strict=True)
            )
            parts.append((f"series {name}, {label} thermal over isothermal", smaller, values))
    verdict = "true" if holds and parts else "false"
    brief = f"{min(low):.3f} to {max(low):.3f} of the isothermal H_min" if low else ""
    return Proposition("C2", printed().conclusion(2), verdict, _lines(parts), brief)


def _film(measures: Measures, film: str) -> float:
    return float(getattr(measures.film, f"best_{film}"))


def conclusion_3(book: Book) -> Proposition:
    """Surfaces and middle."""
    parts = []
    for name in ("A", "B", "C", "D", "D-prime", "glass-1", "glass-2"):
        found = check(book, "middle-hotter", name, ("thermal",)).converged
        if found is not None:
            parts.append((_ROLES.get(name, f"steel, series {name}"), found.holds, found.numbers))
    steel = all(holds for name, holds, _ in parts if name.startswith("steel"))
    glass = all(holds for name, holds, _ in parts if not name.startswith("steel"))
    verdict = "false"
    if steel:
        verdict = "true" if glass else "only if both surfaces conduct heat well"
    return Proposition("C3", printed().conclusion(3), verdict, _lines(parts))


def _pair(book: Book, name: str) -> tuple[Measures, Measures] | None:
    """Return the thermal runs of a series at SRR = -1 and 1."""
    line = book.line(name, "converged", "thermal")
    return (line[-1.0], line[1.0]) if -1.0 in line and 1.0 in line else None


def _sliding(book: Book) -> dict[str, tuple[Measures, Measures]]:
    names = {"D-prime": "steel on steel", **_ROLES}
    pairs = {words: _pair(book, name) for name, words in names.items()}
    return {words: pair for words, pair in pairs.items() if pair is not None}


def conclusion_4(book: Book) -> Proposition:
    """Spike and central pressure with the sign of sliding."""
    parts, where = [], []
    for words, (negative, positive) in _sliding(book).items():
        before, after = negative.pressure, positive.pressure
        gain = min(after.largest / before.largest, after.central / before.central) - 1.0
        holds = gain > LEAST_DIFFERENCE
        parts.append(
            (
                words,
                holds,
                f"SRR = -1 and 1: P_max {before.largest:.3f} and {after.largest:.3f}, P at the "
                f"centre {before.central:.3f} and {after.central:.3f}, maxima on the centre line "
                f"{before.peaks} and {after.peaks}",
            )
        )
        if holds:
            where.append(words)
    more = any(b.pressure.peaks > a.pressure.peaks for a, b in _sliding(book).values())
    peak = "another peak does not occur" if not more else "another peak occurs"
    return Proposition("C4", printed().conclusion(4), _only_if(where, parts), _lines(parts), peak)


def _only_if(where: list[str], parts: list[tuple[str, bool, str]]) -> str:
    if parts and len(where) == len(parts):
        return "true"
    return f"only if the solids differ so: {', '.join(where)}" if where else "false"


def conclusion_5(book: Book) -> Proposition:
    """Minimum and central film with the sign of sliding."""
    parts, first, second = [], [], []
    for words, (negative, positive) in _sliding(book).items():
        low = positive.film.best_minimum / negative.film.best_minimum - 1.0
        central = positive.film.best_central / negative.film.best_central - 1.0
        smaller, contrary = low < -LEAST_DIFFERENCE, central > LEAST_DIFFERENCE
        first += [words] if smaller else []
        second += [words] if smaller and contrary else []
        parts.append(
            (
                words,
                smaller and contrary,
                f"from SRR = -1 to 1 H_min {100 * low:+.3g} %, H_c {100 * central:+.3g} %",
            )
        )
    verdict = _only_if(second, parts)
    if verdict == "false" and first:
        verdict = (
            f"first half only if the solids differ so: {', '.join(first)}; second half false: H_c "
            "goes the way of H_min"
        )
    told = printed().column("T3", "thermal_minimum")
    own = f"the paper's own Table 3 says the reverse: H_min {told[0]} at SRR = -1, {told[-1]} at 1"
    extra = (own,) if told[0] < told[-1] else ()
    return Proposition("C5", printed().conclusion(5), verdict, (*_lines(parts), *extra))


def added_0(book: Book) -> Proposition:
    """Isothermal films and sliding."""
    parts = []
    for name in _EQUAL:
        for way in WAYS:
            line = list(book.line(name, way, "isothermal").values())
            if line:
                worst = max(spread([_film(m, f) for m in line]) for f in ("minimum", "central"))
                parts.append((f"series {name}, {way}", worst <= SAME, f"spread {worst:.1e}"))
    text = "The isothermal film does not depend on the slide-roll ratio."
    brief = "; ".join(dict.fromkeys(numbers for *_, numbers in parts))
    return Proposition("P0", text, _all_or(parts), _lines(parts), brief)


def added_1(book: Book) -> Proposition:
    """Pure rolling."""
    parts = []
    for name, words in (("D-prime", "set A (heat is weak)"), ("hot", "set B (heat is strong)")):
        view = View(book, name, _HEATS, "converged")
        warm, cold = view.line("thermal").get(0.0), view.line("isothermal").get(0.0)
        if warm is None or cold is None:
            continue
        low, middle = (_film(warm, f) / _film(cold, f) for f in ("minimum", "central"))
        holds = max(abs(low - 1.0), abs(middle - 1.0)) <= WEAK
        parts.append((words, holds, f"H_min {low:.4f}, H_c {middle:.4f} of isothermal"))
    text = "In pure rolling heat changes the film by less than 1 %."
    right = [name for name, holds, _ in parts if holds]
    verdict = _all_or(parts) if len(right) != 1 else f"only if heat is weak: {right[0]}"
    return Proposition("P1", text, verdict, _lines(parts))


def added_2(book: Book) -> Proposition:
    """Mirror symmetry."""
    parts = []
    for name in _EQUAL:
        for way in WAYS:
            if book.line(name, way, "thermal"):
                worst = asymmetry(book, name, way)
                parts.append((f"series {name}, {way}", worst <= SAME, f"differ by {worst:.1e}"))
    swapped = _swapped(book)
    if swapped is not None:
        parts.append(
            ("bodies and sign exchanged, steel and glass", swapped <= SAME, f"{swapped:.1e}")
        )
    text = (
        "Between equal solids SRR and -SRR give one film; exchanging bodies and sign always does."
    )
    worst = max((asymmetry(book, n, w) for n in _EQUAL for w in WAYS), default=0.0)
    brief = f"equal solids differ by {worst:.0e} at most"
    return Proposition("P2", text, _all_or(parts), _lines(parts), brief)


def _swapped(book: Book) -> float | None:
    """Return how far a contact differs from the one with bodies and sign exchanged."""
    one = book.line("glass-1", "converged", "thermal")
    other = book.line("glass-2", "converged", "thermal")
    shared = [v for v in one if -v in other]
    if not shared:
        return None
    return max(
        abs(_film(one[v], f) / _film(other[-v], f) - 1.0)
        for v in shared
        for f in ("minimum", "central")
    )


def added_3(book: Book) -> Proposition:
    """Where the dimple is."""
    parts = []
    for name, words in (("A", "steel on steel"), ("D-prime", "steel on steel"), *_ROLES.items()):
        cold_name = "D-prime" if name.startswith("glass") else name
        cold = book.line(cold_name, "converged", "isothermal")
        for value, warm in book.line(name, "converged", "thermal").items():
            if value not in cold:
                continue
            gain = warm.film.hump - cold[value].film.hump
            symbol = book.series[name].symbol
            parts.append(
                (
                    f"{words}, {symbol} = {value:g}",
                    gain > LEAST_DIMPLE,
                    _hump_words(book, name, value),
                )
            )
    text = "The temperature-viscosity wedge makes a dimple."
    right = [name for name, holds, _ in parts if holds]
    steel = [name for name in right if name.startswith("steel")]
    verdict = "false"
    if right:
        verdict = "true" if steel else f"only if the solids differ: {'; '.join(right)}"
    return Proposition("P3", text, verdict, _lines(parts))


def _hump_words(book: Book, name: str, value: float) -> str:
    """Return how far the film rises in the middle, with and without wedge."""
    warm = book.line(name, "converged", "thermal")[value].film.hump
    flat = book.line(name, "mean", "thermal").get(value)
    words = f"the film rises in the middle by {100 * warm:.1f} % of H_c"
    return words if flat is None else f"{words}, without the wedge by {100 * flat.film.hump:.1f} %"


PROPOSITIONS: dict[str, tuple[Callable[[Book], Proposition], tuple[str, ...]]] = {
    "C1": (conclusion_1, ("A", "B")),
    "C2": (conclusion_2, ("A", "B", "D-prime", "hot")),
    "C3": (conclusion_3, ("A", "B", "C", "D", "D-prime", "glass-1", "glass-2")),
    "C4": (conclusion_4, ("D-prime", "glass-1", "glass-2")),
    "C5": (conclusion_5, ("D-prime", "glass-1", "glass-2")),
    "P0": (added_0, ("D", "D-prime", "D-prime-wavy")),
    "P1": (added_1, ("D-prime", "hot")),
    "P2": (added_2, ("D", "D-prime", "D-prime-wavy", "glass-1", "glass-2")),
    "P3": (added_3, ("A", "D-prime", "glass-1", "glass-2")),
}
"""Statements by name, and the series they need."""
