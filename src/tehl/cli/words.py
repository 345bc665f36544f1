"""A result told to people, in a few lines."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from tehl.report.explain import UNTITLED, length_unit

if TYPE_CHECKING:
    from tehl.post.micro_film import RoughnessEffect
    from tehl.post.roughness import RoughFilm
    from tehl.post.thermal_effect import ThermalEffect
    from tehl.post.waviness import WaveResponse
    from tehl.result import Estimate, Result

UNUSUAL_BALANCE = 0.05
"""Part of the heat that may be missing without a remark."""


def headline(result: "Result") -> str:
    """Return title and outcome in one line."""
    return f"{result.problem.title or UNTITLED} - {result.status.outcome}"


def as_text(result: "Result", *, rough: "RoughFilm | None" = None) -> str:
    """Return the numbers of ``result`` that people ask for first, one per line.

    Parameters
    ----------
    result : Result
        What to tell.
    rough : RoughFilm or None
        Its film between rough surfaces, if it is known better than the result alone knows it.
    """
    groups, nx, ny = result.groups, result.scaled.x.size, result.scaled.y.size
    x, y = result.scaled.x, result.scaled.y
    rows = [
        ("minimum film", _film(result, "minimum")),
        ("central film", _film(result, "central")),
        ("largest pressure", _pressure(result)),
        *_heat(result),
        *_traction(result),
        *_roughness(rough or result.roughness),
        ("groups", f"M = {groups.M:.4g}, L = {groups.L:.4g}, alpha p_h = {groups.alpha_bar:.4g}"),
        ("grid", f"{nx} x {ny} on [{x[0]:g}, {x[-1]:g}] x [{y[0]:g}, {y[-1]:g}] half-widths"),
        ("effort", _effort(result)),
    ]
    status = result.status
    if status.converged and status.message:
        rows.append(("uncertain" if status.is_vague else "certified", status.message))
    if status.is_vague:
        rows.append(("hint", str(status.hint)))
    return "\n".join([headline(result), *(f"  {name:<17}{value}" for name, value in rows)])


def _film(result: "Result", which: str) -> str:
    from tehl.post.film import no_film

    if why := no_film(result):
        return f"none: {why}"
    metres, scaled = getattr(result.film, which), getattr(result.film_scaled, which)
    factor, unit = length_unit(metres)
    text = f"{metres * factor:.4g} {unit}   (H = {scaled:.5g})"
    return text + _bar(result, f"film_{which}", result.scales.film_thickness * factor, unit)


def _pressure(result: "Result") -> str:
    highest = float(result.scaled.pressure.max())
    giga = result.scales.hertz_pressure * 1e-9
    text = f"{highest * giga:.4g} GPa   ({highest:.4g} p_h, p_h = {giga:.4g} GPa)"
    return text + _bar(result, "pressure_max", giga, "GPa")


def _heat(result: "Result") -> Iterator[tuple[str, str]]:
    """Yield the rows of a thermal run."""
    heat, found = result.heat, result.temperature
    if heat is None or found is None:
        return
    x, y, zeta = found.film_rise_max_at
    yield (
        "film temperature",
        f"rise {found.film_rise_max:.4g} K at most (X = {x:.3g}, Y = {y:.3g}, z/h = {zeta:.3g}), "
        f"{found.mid_film_rise_central:.4g} K central, over {found.inlet - 273.15:.4g} degC"
        + _bar(result, "film_rise_max", 1.0, "K"),
    )
    first, second = found.surface_1_rise_max, found.surface_2_rise_max
    yield (
        "surfaces",
        f"rise {first:.4g} K and {second:.4g} K at most over the oil (surface 1 and 2)",
    )
    error = heat.balance.error
    doubt = "   (more than usual: the inlet is not settled)" if abs(error) > UNUSUAL_BALANCE else ""
    yield "heat balance", f"error {100 * error:.2g} %{doubt}"


def _clean(value: float) -> str:
    """Return a number in words, rounding errors as zero."""
    return "0" if abs(value) < 1e-12 else f"{value:.4g}"


def _traction(result: "Result") -> Iterator[tuple[str, str]]:
    found = result.traction
    if found is None:
        return
    yield (
        "traction",
        f"{found.surface_1:.4g} on surface 1, {_clean(found.mid_film)} at mid-film, "
        f"{found.surface_2:.4g} on surface 2"
        + _bar(result, "traction_mid_film", 1.0, "at mid-film"),
    )
    if not found.credible:
        yield "", too_much_traction(result)


def too_much_traction(result: "Result") -> str:
    """Return why nobody should believe the traction, and what to do."""
    law = result.problem.lubricant.shear.law
    how = "state lubricant.shear" if law == "newtonian" else "check its numbers"
    return f"more than any oil bears: the shear law is {law}, {how}"


def _roughness(found: "RoughFilm | None") -> Iterator[tuple[str, str]]:
    """Yield the rows of a film between surfaces that are not ideally smooth."""
    if found is None:
        return
    yield (
        "roughness",
        f"Sq = {_length(found.composite)} of both, lambda = {found.lambda_ratio:.3g} (film over Sq)"
        f", {100 * found.below_composite:.2g} % of the contact below Sq",
    )
    lines = [*map(wave_in_words, found.waves), *found.wave_notes]
    for number, line in enumerate(lines):
        yield "" if number else "waves left", line


def wave_in_words(wave: "WaveResponse") -> str:
    """Return what is left of a wave in film and pressure, in a line."""
    giga, theory = 1e-9, wave.theory
    film, pressure = "", ""
    if theory.left_to_inlet:
        film = " (as the inlet lets it)"
    elif theory.film_ratio is not None and theory.pressure is not None:
        film = f" (theory {100 * theory.film_ratio:.3g})"
        pressure = f"theory {theory.pressure * giga:.3g}, "
    return (
        f"{_length(wave.wavelength)} at {math.degrees(wave.angle) + 0.0:.3g} deg: "
        f"{100 * wave.film_ratio:.3g} % in the film{film}, "
        f"{wave.pressure_amplitude * giga:.3g} GPa "
        f"({pressure}{theory.elastic_pressure * giga:.3g} flattens it)"
    )


def _length(metres: float) -> str:
    factor, unit = length_unit(metres)
    return f"{metres * factor:.4g} {unit}"


def effect_as_text(effect: "ThermalEffect") -> str:
    """Return what heat does to the film in a line or two."""
    parts = [
        f"  {'over isothermal':<17}{effect.central:.4f} of the central, "
        f"{effect.minimum:.4f} of the minimum film without heat"
    ]
    if effect.inlet_factors:
        factors = ", ".join(f"{one.factor:.4f} {one.formula}" for one in effect.inlet_factors)
        parts.append(f"  {'inlet heating':<17}by formula {factors}")
    return "\n".join(parts)


def roughness_effect_as_text(effect: "RoughnessEffect") -> str:
    """Return what roughness does to the film in a line."""
    traction = "" if effect.traction is None else f", {effect.traction:.4f} of the traction"
    return (
        f"  {'over smooth':<17}{effect.central:.4f} of the central, {effect.minimum:.4f} of the "
        f"minimum film, {effect.largest_pressure:.4f} of the largest pressure{traction}"
    )


def _bar(result: "Result", name: str, unit: float, word: str) -> str:
    """Return the error bar: that of a certified run, else the estimate of the discretisation."""
    estimate = result.uncertainty.get(name)
    if estimate is not None:
        return f"   {certified_in_words(estimate, unit, word)}"
    error = getattr(result.errors, f"discretisation_{name.removeprefix('film_')}", None)
    if error is None:
        return ""
    percent = 100.0 * abs(error)
    return f"   grid error about {percent:.2g} %" if percent < 99.5 else f"   {_times(abs(error))}"


def certified_in_words(estimate: "Estimate", unit: float, word: str) -> str:
    """Return a certified value with its error bar and the parts of that.

    Parameters
    ----------
    estimate : Estimate
        The value.
    unit : float
        Factor to the unit in which it reads well.
    word : str
        That unit.
    """
    bar = (estimate.uncertainty, estimate.discretisation, estimate.domain)
    width, grid, domain = (part * unit for part in bar)
    parts = f"grid {grid:.2g}, domain {domain:.2g}"
    return f"certified {estimate.value * unit:.5g} +- {width:.2g} {word} ({parts})"


def _times(error: float) -> str:
    """Return a relative error of all of the value or more in words."""
    return f"grid error about {error:.2g} times itself"


def _effort(result: "Result") -> str:
    if not result.history:
        return f"{result.cost.cpu_seconds:.3g} s"
    last = result.history[-1]
    cycles = sum(report.points == last.points for report in result.history)
    return (
        f"{cycles} cycles on the finest grid, residual {last.residual:.1e}, "
        f"load error {last.load_error:.1e}, {result.cost.cpu_seconds:.3g} s"
    )
