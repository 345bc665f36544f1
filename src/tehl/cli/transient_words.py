"""A transient run told to people, in a few lines."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from tehl.cli.words import certified_in_words, too_much_traction
from tehl.report.explain import UNTITLED, length_unit
from tehl.report.time import seconds_in_words

if TYPE_CHECKING:
    from tehl.transient_result import TransientResult
    from tehl.typing import Array


def as_text(run: "TransientResult") -> str:
    """Return the numbers of ``run`` that people ask for first, one per line."""
    title = run.start.problem.title or UNTITLED
    lines = (f"  {name:<17}{value}" for name, value in _rows(run))
    return "\n".join([f"{title} - {run.status.outcome}", *lines])


def _rows(run: "TransientResult") -> Iterator[tuple[str, str]]:
    history, start = run.history, run.start
    groups, x, y = start.groups, start.scaled.x, start.scaled.y
    thinnest, highest = int(history.film_minimum.argmin()), int(history.pressure_max.argmax())
    steps, end = len(history.time) - 1, float(history.time[-1])
    yield (
        "duration",
        f"{seconds_in_words(end)} in {steps} steps of {seconds_in_words(run.time_step)}; the mean "
        f"of both surfaces moves on by {end * start.scales.speed / start.scales.half_width_x:.3g} "
        "half-widths",
    )
    yield (
        "minimum film",
        f"{_length(history.film_minimum[thinnest])} at the least, at "
        f"{seconds_in_words(history.time[thinnest])}   (at the start "
        f"{_length(history.film_minimum[0])})" + _film_bar(run, "film_minimum"),
    )
    yield "central film", _between(run.history.film_central, _length)
    yield from _central_bars(run)
    yield (
        "largest pressure",
        f"{_giga(history.pressure_max[highest])} at {seconds_in_words(history.time[highest])}   "
        f"(at the start {_giga(history.pressure_max[0])})" + _bar(run, "pressure_max", 1e-9, "GPa"),
    )
    yield (
        "traction",
        f"{_between(history.traction, _clean)}   (at mid-film)"
        + _bar(run, "traction_extreme", 1.0, "at the extreme"),
    )
    told = start.traction
    if told is not None and not told.credible:
        yield "", too_much_traction(start)
    hottest = int(history.temperature_rise.argmax())
    if history.temperature_rise[hottest] > 0:
        yield (
            "film temperature",
            f"rise {history.temperature_rise[hottest]:.4g} K at most, at "
            f"{seconds_in_words(history.time[hottest])}   (at the start "
            f"{history.temperature_rise[0]:.4g} K)" + _bar(run, "film_rise_max", 1.0, "K"),
        )
    if history.load.min() < history.load.max():
        yield "load", _between(history.load * start.problem.load, _newton)
    yield (
        "groups",
        f"M = {groups.M:.4g}, L = {groups.L:.4g}, alpha p_h = {groups.alpha_bar:.4g}, "
        f"SRR = {start.problem.slide_roll_ratio:g}",
    )
    yield (
        "grid",
        f"{x.size} x {y.size} on [{x[0]:g}, {x[-1]:g}] x [{y[0]:g}, {y[-1]:g}] half-widths, "
        f"{len(run.frames.step)} fields kept",
    )
    yield "effort", _effort(run)
    yield from _certified(run)
    if run.status.is_vague:
        yield "uncertain", str(run.status.message)
        yield "hint", str(run.status.hint)


def _bar(run: "TransientResult", name: str, unit: float, word: str) -> str:
    """Return a certified extreme, nothing where the run is not certified."""
    found = run.uncertainty.get(name)
    return "" if found is None else f"   {certified_in_words(found, unit, word)}"


def _film_bar(run: "TransientResult", name: str) -> str:
    found = run.uncertainty.get(name)
    return "" if found is None else _bar(run, name, *length_unit(found.value))


def _central_bars(run: "TransientResult") -> Iterator[tuple[str, str]]:
    for name, what in (("film_central_least", "least"), ("film_central_largest", "largest")):
        if bar := _film_bar(run, name):
            yield "", f"{what}{bar}"


def _certified(run: "TransientResult") -> Iterator[tuple[str, str]]:
    """Yield what is known of the whole history, and from which grids."""
    bars = run.bars
    if bars is not None:
        yield (
            "over time",
            f"+- {_length(bars.film_central.max())} of the central film at most, "
            f"{_length(bars.film_minimum.max())} of the minimum film, "
            f"{_giga(bars.pressure_max.max())} of the largest pressure, "
            f"at {len(bars.time)} instants",
        )
    if run.uncertainty and run.status.converged:
        yield "certified", str(run.status.message)


def _between(values: "Array", word: Callable[[float], str]) -> str:
    return f"{word(values.min())} to {word(values.max())}   (at the start {word(values[0])})"


def _length(metres: float) -> str:
    factor, unit = length_unit(metres)
    return f"{metres * factor:.4g} {unit}"


def _giga(pascal: float) -> str:
    return f"{pascal * 1e-9:.4g} GPa"


def _newton(load: float) -> str:
    return f"{load:.4g} N"


def _clean(value: float) -> str:
    return "0" if abs(value) < 1e-12 else f"{value:.4g}"


def _effort(run: "TransientResult") -> str:
    cycles = run.history.cycles[1:]
    mean, most = (float(cycles.mean()), int(cycles.max())) if cycles.size else (0.0, 0)
    return f"{mean:.3g} cycles per step, {most} at most, {run.cost.cpu_seconds:.3g} s"
