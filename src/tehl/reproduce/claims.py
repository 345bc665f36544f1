"""What the text of the paper says about its figures, as statements that numbers decide."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from tehl.reproduce.book import Book
from tehl.reproduce.figures import FigureSpec
from tehl.reproduce.judge import Check, Finding
from tehl.reproduce.measures import Measures
from tehl.reproduce.series import Heat, Treatment

LEAST_DIMPLE = 0.02
"""Rise of the film in the middle beyond that of the cold film that counts, over H_c."""
LEAST_DIFFERENCE = 1e-3
"""Relative difference between opposite sliding that counts."""
LEAST_RIPPLE = 0.3
"""Variation of the film across the waves that counts, over the central film."""
SIDE = 0.3
"""|Y| from which a minimum lies in a side lobe."""
KNOWN = 0.1
"""Relative difference of temperatures up to which they are known."""

Line = dict[float, Measures]
Test = Callable[["View"], Finding | None]


@dataclass(frozen=True, slots=True)
class View:
    """The runs that a statement is about.

    Attributes
    ----------
    book : Book
        All runs.
    series : str
        Name of the series.
    heats : tuple of str
        Which of its runs.
    treatment : str
        Computed how.
    values : tuple of float
        Of what varies; empty for all.
    """

    book: Book
    series: str
    heats: tuple[Heat, ...]
    treatment: Treatment
    values: tuple[float, ...] = ()

    def line(self, heat: Heat) -> Line:
        """Return the measures of the runs."""
        found = self.book.line(self.series, self.treatment, heat)
        return {v: m for v, m in found.items() if not self.values or v in self.values}

    @property
    def lines(self) -> list[Line]:
        """Return the measures of all runs, a line for each way of heat."""
        return [line for heat in self.heats if (line := self.line(heat))]

    @property
    def all(self) -> list[Measures]:
        """Return the measures of all runs."""
        return [measures for line in self.lines for measures in line.values()]


def checks_of(spec: FigureSpec, book: Book) -> list[Check]:
    """Return what the text says about a figure, held against the runs."""
    return [check(book, name, spec.series, spec.heat, spec.values) for name in spec.claims]


def check(
    book: Book, name: str, series: str, heats: tuple[Heat, ...], values: tuple[float, ...] = ()
) -> Check:
    """Return a statement by its name, held against the runs of a series."""
    statement, test = CLAIMS[name]
    ways: tuple[Treatment, Treatment] = ("paper", "converged")
    found = [test(View(book, series, heats, way, values)) for way in ways]
    return Check(statement, found[0], found[1])


def falls(values: Sequence[float]) -> bool:
    """Whether a sequence falls all the way; what is no number does not."""
    return all(after < before for before, after in pairwise(values))


def rises(values: Sequence[float]) -> bool:
    """Whether a sequence rises all the way."""
    return all(after > before for before, after in pairwise(values))


def _range(values: Sequence[float], digits: int = 3) -> str:
    return ", ".join(f"{value:.{digits}f}" for value in values)


def _film_changes(sign: float) -> Test:
    """Return that both films rise (1) or fall (-1); converged, as far as error bars can tell."""

    def found(view: View) -> Finding | None:
        if not view.lines:
            return None
        known = 1.0 if view.treatment == "converged" else 0.0
        films = [
            (
                [(m.film.best_minimum, known * m.film.minimum_error) for m in line.values()],
                [(m.film.best_central, known * m.film.central_error) for m in line.values()],
            )
            for line in view.lines
        ]
        holds = all(_goes(sign, low) and _goes(sign, central) for low, central in films)
        words = [
            f"H_min {_range([v for v, _ in low], 4)}; H_c {_range([v for v, _ in central], 4)}"
            for low, central in films
        ]
        return Finding(holds, " | ".join(words))

    return found


def _goes(sign: float, line: Sequence[tuple[float, float]]) -> bool:
    """Whether values with errors rise or fall all in all, and at each step within their errors."""
    steps = all(
        sign * (after - before) + error + spread > 0
        for (before, error), (after, spread) in pairwise(line)
    )
    return steps and sign * (line[-1][0] - line[0][0]) > 0


def _spike_changes(test: Callable[[Sequence[float]], bool]) -> Test:
    def found(view: View) -> Finding | None:
        if not view.lines:
            return None
        spikes = [[m.pressure.crest for m in line.values()] for line in view.lines]
        words = " | ".join(_range(line) for line in spikes).replace("nan", "none")
        return Finding(all(test(line) for line in spikes), f"spike {words}")

    return found


def _each(test: Callable[[Measures], bool], words: Callable[[Measures], str]) -> Test:
    """Return a statement that has to hold in each run."""

    def found(view: View) -> Finding | None:
        if not view.all:
            return None
        return Finding(all(map(test, view.all)), ", ".join(words(m) for m in view.all))

    return found


def _dimple(view: View) -> Finding | None:
    """Compare the hump of the heated film with that of the cold one."""
    if "thermal" not in view.heats:
        return None
    series = "D-prime" if view.series.startswith("glass") else view.series
    cold = View(view.book, series, ("isothermal",), view.treatment).line("isothermal")
    return _humps(view.line("thermal"), cold, "without heat")


def _dimple_by_wedge(view: View) -> Finding | None:
    """Compare the hump with that of properties that are constant across the film."""
    if view.treatment == "paper":
        return None
    flat = view.book.line(view.series, "mean", "thermal")
    return _humps(view.line("thermal"), flat, "without the wedge")


def _humps(warm: Line, other: Line, words: str) -> Finding | None:
    shared = [value for value in warm if value in other]
    if not shared:
        return None
    gains = [warm[v].film.hump - other[v].film.hump for v in shared]
    numbers = ", ".join(
        f"{100 * warm[v].film.hump:.1f} % ({100 * other[v].film.hump:.1f} %)" for v in shared
    )
    return Finding(
        max(gains) > LEAST_DIMPLE, f"film rises in the middle by {numbers} of H_c ({words})"
    )


def _thermal_below(view: View) -> Finding | None:
    warm, cold = view.line("thermal"), view.line("isothermal")
    shared = [value for value in warm if value in cold]
    if not shared:
        return None
    ratios = [warm[v].film.best_minimum / cold[v].film.best_minimum for v in shared]
    return Finding(max(ratios) < 1.0, f"thermal over isothermal H_min {_range(ratios, 4)}")


def _middle_hotter(view: View) -> Finding | None:
    warm = [m.warmth for m in view.all if m.warmth is not None]
    if not warm:
        return None
    holds = all(w.mid_film > max(w.surface_1, w.surface_2) for w in warm)
    words = ", ".join(
        f"{w.mid_film:.3g} K over {w.surface_1:.3g} and {w.surface_2:.3g}" for w in warm
    )
    return Finding(holds, words)


def _temperatures_known(view: View) -> Finding | None:
    """Compare two contacts of one M and L that differ in size and speed."""
    hot = view.book.line("hot", "converged", "thermal")
    usual = view.book.line("D-prime", "converged", "thermal")
    shared = [v for v in hot if v in usual and v > 0]
    if not shared or view.treatment == "paper":
        return None
    value = shared[-1]
    one, other = usual[value].warmth, hot[value].warmth
    if one is None or other is None:
        return None
    off = abs(other.central / one.central - 1.0)
    return Finding(
        off < KNOWN,
        f"at M = 40, L = 12.04, SRR = {value:g} the centre is {one.central:.0f} K warmer than the "
        f"inlet with set A and {other.central:.0f} K with set B",
    )


def _opposite(view: View) -> tuple[Measures, Measures] | None:
    """Return the runs of the largest negative and positive sliding."""
    for line in view.lines[-1:]:
        values = sorted(line)
        if len(values) > 1 and values[0] < 0 < values[-1]:
            return line[values[0]], line[values[-1]]
    return None


def _moves_to_the_back(view: View) -> Finding | None:
    pair = _opposite(view)
    if pair is None:
        return None
    places = [measures.film.minimum_at for measures in pair]
    holds = abs(places[0][1]) > SIDE >= abs(places[1][1])
    at = " and ".join(f"({x:.2f}, {y:.2f})" for x, y in places)
    return Finding(holds, f"minimum at X, Y = {at}")


def _compared(name: str, of: Callable[[Measures], float], sign: float) -> Test:
    def found(view: View) -> Finding | None:
        pair = _opposite(view)
        if pair is None:
            return None
        negative, positive = (of(measures) for measures in pair)
        holds = sign * (positive - negative) > LEAST_DIFFERENCE * abs(negative)
        return Finding(holds, f"{name} {negative:.5g} for SRR < 0, {positive:.5g} for SRR > 0")

    return found


CLAIMS: dict[str, tuple[str, Test]] = {
    "film-falls-with-load": ("H_min and H_c fall with M", _film_changes(-1.0)),
    "film-falls-with-speed": (
        "H_min and H_c decrease as the speed increases",
        _film_changes(-1.0),
    ),
    "film-rises-with-speed": ("H_min and H_c rise with L", _film_changes(1.0)),
    "constriction": (
        "the film is constricted at the outlet",
        _each(
            lambda m: m.film.outlet < 0.95 * m.film.central,
            lambda m: f"{m.film.outlet / m.film.central:.3f} H_c",
        ),
    ),
    "horseshoe": (
        "horseshoe: side lobes thinner than the outlet, outlet thinner than the middle",
        _each(
            lambda m: m.film.minimum < 0.98 * m.film.outlet < 0.98 * m.film.central,
            lambda m: f"{m.film.minimum:.4f} < {m.film.outlet:.4f} < {m.film.central:.4f}",
        ),
    ),
    "minimum-in-side-lobes": (
        "the minimum lies in the side lobes",
        _each(
            lambda m: abs(m.film.minimum_at[1]) > SIDE,
            lambda m: f"|Y| = {abs(m.film.minimum_at[1]):.2f}",
        ),
    ),
    "dimple": ("heat makes a dimple", _dimple),
    "dimple-by-wedge": ("the temperature-viscosity wedge makes it", _dimple_by_wedge),
    "spike": (
        "the pressure has a spike at the outlet",
        _each(lambda m: m.pressure.crest > 0, lambda m: f"{m.pressure.crest:.3f}"),
    ),
    "spike-falls-with-load": ("the spike falls with M", _spike_changes(falls)),
    "spike-rises-with-speed": ("the spike rises with L", _spike_changes(rises)),
    "thermal-minimum-below": ("heat makes H_min smaller", _thermal_below),
    "middle-hotter": ("the middle of the film is hotter than its surfaces", _middle_hotter),
    "temperatures-known": ("the temperatures follow from M and L", _temperatures_known),
    "ridges": (
        "ridges of pressure",
        _each(lambda m: m.pressure.ridges >= 2, lambda m: f"{m.pressure.ridges}"),
    ),
    "peak-at-outlet": (
        "the highest pressure stands at the outlet",
        _each(
            lambda m: m.pressure.largest_at[0] > 0,
            lambda m: f"{m.pressure.largest:.2f} at X = {m.pressure.largest_at[0]:.2f}",
        ),
    ),
    "wavy-film": (
        "the wave shows in the film",
        _each(
            lambda m: m.film.ripple > LEAST_RIPPLE,
            lambda m: f"H varies by {m.film.ripple:.2f} H_c across the wave",
        ),
    ),
    "fingers": (
        "fingers of temperature",
        _each(
            lambda m: m.warmth is not None and m.warmth.fingers >= 2,
            lambda m: f"{0 if m.warmth is None else m.warmth.fingers}",
        ),
    ),
    "minimum-moves-to-the-back": (
        "the minimum lies in a side lobe for SRR < 0 and at the back for SRR > 0",
        _moves_to_the_back,
    ),
    "minimum-smaller-for-positive-sliding": (
        "H_min is smaller for SRR > 0 than for SRR < 0",
        _compared("H_min", lambda m: m.film.minimum, -1.0),
    ),
    "central-contrasts": (
        "H_c is larger for SRR > 0 than for SRR < 0",
        _compared("H_c", lambda m: m.film.central, 1.0),
    ),
    "pressure-higher-for-positive-sliding": (
        "the pressure is higher for SRR > 0 than for SRR < 0",
        _compared("P_max", lambda m: m.pressure.largest, 1.0),
    ),
}
"""Statements by name: in words, and what decides."""
