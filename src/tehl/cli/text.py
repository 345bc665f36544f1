"""What ``tehl solve`` prints: a steady or transient result in a few lines."""

import math
from collections.abc import Callable, Iterator

import numpy as np

from tehl.cli.reference_runs import Comparisons
from tehl.post.film import no_film
from tehl.post.roughness import RoughFilm
from tehl.post.waves import WaveResponse
from tehl.report.readable import UNTITLED, length, length_unit, seconds
from tehl.result import Result, Status
from tehl.transient_result import TransientResult
from tehl.typing import Array

UNUSUAL_BALANCE = 0.05
"""Missing share of the heat from which it is remarked."""

Rows = Iterator[tuple[str, str]]
Unit = tuple[float, str]
"""Factor from SI, and the unit."""

_GPA: Unit = (1e-9, "GPa")


def as_text(result: Result | TransientResult, compared: Comparisons | None = None) -> str:
    """Return the main numbers of a result and its comparisons with reference runs, one per line."""
    if isinstance(result, TransientResult):
        title, rows = result.start.problem.title, _transient_rows(result)
    else:
        title, rows = result.problem.title, _steady_rows(result, compared or Comparisons())
    headline = f"{title or UNTITLED} - {result.status.outcome}"
    return "\n".join([headline, *(f"  {name:<17}{value}" for name, value in rows)])


def failure_text(status: Status, reason: str | None) -> str:
    """Return why a result did not converge, and the hint in a second line if there is one."""
    message = f"tehl: not converged ({status.kind}): {status.message or reason}"
    return f"{message}\nhint: {status.hint}" if status.hint else message


# ---- steady results


def _steady_rows(result: Result, compared: Comparisons) -> Rows:
    yield "minimum film", _film(result, "minimum")
    yield "central film", _film(result, "central")
    yield "largest pressure", _pressure(result)
    yield from _heat(result)
    yield from _traction(result)
    yield from _roughness(compared.rough_film or result.roughness)
    yield "groups", _groups(result)
    yield "grid", _grid(result)
    yield "effort", _effort(result)
    status = result.status
    if status.converged and status.message:
        yield "uncertain" if status.is_vague else "certified", status.message
    if status.is_vague:
        yield "hint", str(status.hint)
    yield from _compared(compared)


def _film(result: Result, which: str) -> str:
    if why := no_film(result):
        return f"none: {why}"
    metres, scaled = getattr(result.film, which), getattr(result.film_scaled, which)
    factor, unit = length_unit(metres)
    bar = _bar(result, f"film_{which}", (result.scales.film_thickness * factor, unit))
    return f"{length(metres)}   (H = {scaled:.5g})" + bar


def _pressure(result: Result) -> str:
    highest = float(result.scaled.pressure.max())
    giga = result.scales.hertz_pressure * 1e-9
    text = f"{highest * giga:.4g} GPa   ({highest:.4g} p_h, p_h = {giga:.4g} GPa)"
    return text + _bar(result, "pressure_max", (giga, "GPa"))


def _heat(result: Result) -> Rows:
    heat, found = result.heat, result.temperature
    if heat is None or found is None:
        return
    x, y, zeta = found.film_rise_max_at
    rise = (
        f"rise {found.film_rise_max:.4g} K at most (X = {x:.3g}, Y = {y:.3g}, z/h = {zeta:.3g}), "
        f"{found.mid_film_rise_central:.4g} K central, over {found.inlet - 273.15:.4g} degC"
    )
    yield "film temperature", rise + _bar(result, "film_rise_max", (1.0, "K"))
    both = f"{found.surface_1_rise_max:.4g} K and {found.surface_2_rise_max:.4g} K"
    yield "surfaces", f"rise {both} at most over the oil (surface 1 and 2)"
    error = heat.balance.error
    unusual = abs(error) > UNUSUAL_BALANCE
    doubt = "   (more than usual: the inlet is not resolved)" if unusual else ""
    yield "heat balance", f"error {100 * error:.2g} %{doubt}"


def _traction(result: Result) -> Rows:
    found = result.traction
    if found is None:
        return
    text = (
        f"{found.surface_1:.4g} on surface 1, {_clean(found.mid_film)} at mid-film, "
        f"{found.surface_2:.4g} on surface 2"
    )
    yield "traction", text + _bar(result, "traction_mid_film", (1.0, "at mid-film"))
    yield from _excessive_traction(result)


def _excessive_traction(result: Result) -> Rows:
    """Yield a remark on a traction that no oil can carry, and what to do."""
    found = result.traction
    if found is not None and not found.credible:
        law = result.problem.lubricant.shear.law
        remedy = "state lubricant.shear" if law == "newtonian" else "check its numbers"
        yield "", f"more than any oil can carry: the shear law is {law}, {remedy}"


def _roughness(found: RoughFilm | None) -> Rows:
    if found is None:
        return
    yield (
        "roughness",
        f"Sq = {length(found.composite)} of both, lambda = {found.lambda_ratio:.3g} (film over Sq)"
        f", {100 * found.below_composite:.2g} % of the contact below Sq",
    )
    for number, line in enumerate([*map(_wave, found.waves), *found.wave_notes]):
        yield "" if number else "waves left", line


def _wave(wave: WaveResponse) -> str:
    """Return the amplitude of a wave in film and pressure, relative to the undeformed one."""
    giga, theory = 1e-9, wave.theory
    film, pressure = "", ""
    if theory.left_to_inlet:
        film = " (determined by the inlet)"
    elif theory.film_ratio is not None and theory.pressure is not None:
        film = f" (theory {100 * theory.film_ratio:.3g})"
        pressure = f"theory {theory.pressure * giga:.3g}, "
    return (
        f"{length(wave.wavelength)} at {math.degrees(wave.angle) + 0.0:.3g} deg: "
        f"{100 * wave.film_ratio:.3g} % in the film{film}, "
        f"{wave.pressure_amplitude * giga:.3g} GPa "
        f"({pressure}{theory.elastic_pressure * giga:.3g} flattens it)"
    )


def _groups(result: Result) -> str:
    groups = result.groups
    return f"M = {groups.M:.4g}, L = {groups.L:.4g}, alpha p_h = {groups.alpha_bar:.4g}"


def _grid(result: Result) -> str:
    x, y = result.scaled.x, result.scaled.y
    domain = f"[{x[0]:g}, {x[-1]:g}] x [{y[0]:g}, {y[-1]:g}]"
    return f"{x.size} x {y.size} on {domain} half-widths"


def _effort(result: Result) -> str:
    if not result.history:
        return f"{result.cost.cpu_seconds:.3g} s"
    last = result.history[-1]
    cycles = sum(report.points == last.points for report in result.history)
    return (
        f"{cycles} cycles on the finest grid, residual {last.residual:.1e}, "
        f"load error {last.load_error:.1e}, {result.cost.cpu_seconds:.3g} s"
    )


def _compared(compared: Comparisons) -> Rows:
    heat, rough = compared.heat, compared.roughness
    if heat is not None:
        films = f"{heat.central:.4f} of the central, {heat.minimum:.4f} of the minimum film"
        yield "over isothermal", f"{films} without heat"
        if heat.inlet_factors:
            factors = ", ".join(f"{one.factor:.4f} {one.formula}" for one in heat.inlet_factors)
            yield "inlet heating", f"by formula {factors}"
    if rough is not None:
        films = f"{rough.central:.4f} of the central, {rough.minimum:.4f} of the minimum film"
        traction = "" if rough.traction is None else f", {rough.traction:.4f} of the traction"
        pressure = f"{rough.largest_pressure:.4f} of the largest pressure"
        yield "over smooth", f"{films}, {pressure}{traction}"


# ---- transient results


def _transient_rows(run: TransientResult) -> Rows:
    history, start = run.history, run.start
    steps, end = history.time.size - 1, float(history.time[-1])
    moved = end * start.scales.speed / start.scales.half_width_x
    duration = f"{seconds(end)} in {steps} steps of {seconds(run.time_step)}"
    yield "duration", f"{duration}; the mean of both surfaces moves on by {moved:.3g} half-widths"
    yield from _film_history(run)
    largest = _peak(history.pressure_max, history.time, _GPA)
    yield "largest pressure", largest + _bar(run, "pressure_max", _GPA)
    traction = _between(history.traction, _clean)
    bar = _bar(run, "traction_extreme", (1.0, "at the extreme"))
    yield "traction", f"{traction}   (at mid-film){bar}"
    yield from _excessive_traction(start)
    if (history.temperature_rise > 0).any():
        rise = _peak(history.temperature_rise, history.time, (1.0, "K"), " at most,")
        yield "film temperature", f"rise {rise}" + _bar(run, "film_rise_max", (1.0, "K"))
    if history.load.min() < history.load.max():
        yield "load", _between(history.load * start.problem.load, lambda load: f"{load:.4g} N")
    yield "groups", f"{_groups(start)}, SRR = {start.problem.slide_roll_ratio:g}"
    yield "grid", f"{_grid(start)}, {len(run.frames.step)} fields kept"
    cycles = history.cycles[1:] if steps else np.zeros(1)
    effort = f"{cycles.mean():.3g} cycles per step, {cycles.max():.0f} at most"
    yield "effort", f"{effort}, {run.cost.cpu_seconds:.3g} s"
    yield from _trust(run)


def _film_history(run: TransientResult) -> Rows:
    film, time = run.history.film_minimum, run.history.time
    thinnest = int(film.argmin())
    when = _at_start(seconds(time[thinnest]), length(film[0]))
    bar = _bar(run, "film_minimum")
    yield "minimum film", f"{length(film[thinnest])} at the least, at {when}{bar}"
    yield "central film", _between(run.history.film_central, length)
    for which in ("least", "largest"):
        if bar := _bar(run, f"film_central_{which}"):
            yield "", which + bar


def _trust(run: TransientResult) -> Rows:
    """Yield the error bars of the whole history, the grids they come from, and doubts."""
    bars, status = run.bars, run.status
    if bars is not None:
        yield (
            "over time",
            f"+- {length(bars.film_central.max())} of the central film at most, "
            f"{length(bars.film_minimum.max())} of the minimum film, "
            f"{bars.pressure_max.max() * 1e-9:.4g} GPa of the largest pressure, "
            f"at {len(bars.time)} times",
        )
    if run.uncertainty and status.converged:
        yield "certified", str(status.message)
    if status.is_vague:
        yield from (("uncertain", str(status.message)), ("hint", str(status.hint)))


def _peak(values: Array, time: Array, unit: Unit, most: str = "") -> str:
    """Return the largest value, its time, and the value at the start."""
    (factor, name), place = unit, int(values.argmax())
    first, largest = (f"{value * factor:.4g} {name}" for value in (values[0], values[place]))
    return f"{largest}{most} at {_at_start(seconds(time[place]), first)}"


def _between(values: Array, word: Callable[[float], str]) -> str:
    return _at_start(f"{word(values.min())} to {word(values.max())}", word(values[0]))


def _at_start(text: str, first: str) -> str:
    return f"{text}   (at the start {first})"


def _clean(value: float) -> str:
    """Return a number, rounding errors as zero."""
    return "0" if abs(value) < 1e-12 else f"{value:.4g}"


def _bar(result: Result | TransientResult, name: str, unit: Unit | None = None) -> str:
    """Return the error bar of a certified value, else the estimated error of the grid if known.

    A value without ``unit`` is a length in metres.
    """
    estimate = result.uncertainty.get(name)
    if estimate is not None:
        factor, symbol = unit or length_unit(estimate.value)
        parts = (
            f"grid {estimate.discretisation * factor:.2g}, domain {estimate.domain * factor:.2g}"
        )
        bar = f"{estimate.value * factor:.5g} +- {estimate.uncertainty * factor:.2g} {symbol}"
        return f"   certified {bar} ({parts})"
    errors = None if isinstance(result, TransientResult) else result.errors
    error = getattr(errors, f"discretisation_{name.removeprefix('film_')}", None)
    if error is None:
        return ""
    percent = 100.0 * abs(error)
    return f"   grid error about {percent:{'.2g' if percent < 99.5 else '.0f'}} %"
