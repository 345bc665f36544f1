"""The numbers of a result as one JSON object."""

import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from tehl.result import Estimate, Result
from tehl.typing import Array

if TYPE_CHECKING:
    from tehl.post.roughness import Ripples, RoughFilm
    from tehl.post.waviness import WaveResponse


def summary(result: Result) -> dict[str, Any]:
    """Return the summary of ``result`` as JSON can hold it: null where a number is not finite.

    Keys that end in a unit (``_m``, ``_pa``, ``_k``, ``_w``) are SI, the others dimensionless.
    A film that is not positive is null; ``temperature`` and ``heat`` are null for an isothermal
    run, ``traction`` where there are no shear stresses, ``roughness`` where no surface states any.
    A certified result has ``uncertainty``, which mirrors the values.

    Parameters
    ----------
    result : Result
        What a solve returned or a file held.
    """
    status = result.status
    content = {
        "title": result.problem.title,
        "status": status.kind,
        "cause": status.cause,
        "message": status.message,
        "hint": status.hint,
        "laws": _laws(result),
        "domain": _domain(result),
        "groups": _groups(result),
        "film": _film(result),
        "pressure": _pressure(result),
        "temperature": _temperature(result),
        "traction": _traction(result),
        "heat": _heat(result),
        "roughness": None if result.roughness is None else roughness_block(result.roughness),
        "convergence": _convergence(result),
        "errors": asdict(result.errors) if result.errors else None,
        "cost": _cost(result),
    }
    if result.uncertainty:
        content["uncertainty"] = _uncertainty(result)
    plain_content: dict[str, Any] = plain(content)
    return plain_content


def plain(value: Any) -> Any:
    """Return ``value`` with plain numbers and lists, and None for each number not finite."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, str | int | None):
        return value
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def _laws(result: Result) -> dict[str, str | None]:
    lubricant = result.problem.lubricant
    return {
        "viscosity": lubricant.viscosity.law,
        "viscosity_temperature": getattr(lubricant.viscosity, "temperature_law", None),
        "density": lubricant.density.law,
        "shear": lubricant.shear.law,
        "reynolds": getattr(result.problem.heat, "reynolds", "isothermal"),
    }


def _domain(result: Result) -> dict[str, list[float]]:
    return {"x": _ends(result.scaled.x), "y": _ends(result.scaled.y)}


def _ends(axis: Array) -> list[float]:
    return [float(axis[0]), float(axis[-1])]


def _groups(result: Result) -> dict[str, float]:
    groups = result.groups
    return {
        "M": groups.M,
        "L": groups.L,
        "U": groups.U,
        "W": groups.W,
        "G": groups.G,
        "lambda_bar": groups.lambda_bar,
        "alpha_bar": groups.alpha_bar,
        "ellipticity": groups.ellipticity,
        "radius_ratio": groups.radius_ratio,
        "hertz_pressure_pa": result.scales.hertz_pressure,
        "hertz_half_width_m": result.scales.half_width_x,
        "hertz_half_width_y_m": result.scales.half_width_y,
    }


def _film(result: Result) -> dict[str, Any]:
    film, scaled, moes = result.film, result.film_scaled, moes_film_factor(result)
    numbers = {
        "h_min_m": film.minimum,
        "h_central_m": film.central,
        "H_min": scaled.minimum,
        "H_min_node": scaled.minimum_node,
        "H_central": scaled.central,
        "H_min_moes": scaled.minimum * moes,
        "H_central_moes": scaled.central * moes,
    }
    return {name: value if value > 0 else None for name, value in numbers.items()} | {
        "minimum_at": scaled.minimum_at,
        "rigid_approach": result.rigid_approach,
    }


def moes_film_factor(result: Result) -> float:
    """Return what turns H into the Moes film ``(h/R_x) (2U)^(-1/2)``.

    For a circle this is ``(3M/2)^(2/3)``.
    """
    scales, groups = result.scales, result.groups
    # h = H a_x^2/R_x with R_x = a_x^2 / (a_x^2/R_x), so h/R_x = H (film_thickness/a_x)^2.
    return (scales.film_thickness / scales.half_width_x) ** 2 / math.sqrt(2.0 * groups.U)


def _pressure(result: Result) -> dict[str, float]:
    highest = float(np.max(result.scaled.pressure))
    return {
        "max_pa": highest * result.scales.hertz_pressure,
        "P_max": highest,
        "P_central": result.scaled.at_origin(result.scaled.pressure),
    }


def _temperature(result: Result) -> dict[str, Any] | None:
    found = result.temperature
    if found is None:
        return None
    return {
        "film_rise_max_k": found.film_rise_max,
        "film_rise_max_at": found.film_rise_max_at,
        "mid_film_rise_central_k": found.mid_film_rise_central,
        "mean_rise_central_k": found.mean_rise_central,
        "surface_1_rise_max_k": found.surface_1_rise_max,
        "surface_2_rise_max_k": found.surface_2_rise_max,
        "inlet_k": found.inlet,
    }


def _traction(result: Result) -> dict[str, float | bool] | None:
    found = result.traction
    if found is None:
        return None
    return {
        "surface_1": found.surface_1,
        "mid_film": found.mid_film,
        "surface_2": found.surface_2,
        "sliding": found.sliding,
        "rolling": found.rolling,
        "rolling_by_film": found.rolling_by_film,
        "closure_error": found.closure_error,
        "credible": found.credible,
        "friction_power_w": found.friction_power,
    }


def _heat(result: Result) -> dict[str, Any] | None:
    heat = result.heat
    if heat is None:
        return None
    powers = {f"{name}_w": power for name, power in asdict(heat.balance).items()}
    return powers | {"solid_peclet": heat.solid_peclet, "sources": heat.sources}


def roughness_block(found: "RoughFilm") -> dict[str, Any]:
    """Return what a summary says of a rough film, in the block ``roughness``.

    Parameters
    ----------
    found : RoughFilm
        As :attr:`tehl.result.Result.roughness` gives it, or with the smooth contact subtracted.
    """
    return {
        "surface_1_sq_m": found.sq[0],
        "surface_2_sq_m": found.sq[1],
        "composite_sq_m": found.composite,
        "lambda_ratio": found.lambda_ratio,
        "lambda_ratio_by_formula": found.lambda_by_formula,
        "film_quantiles": [{"part": part, "h_m": film} for part, film in found.quantiles],
        "area_below_composite_sq": found.below_composite,
        "area_below_half_median": found.below_half,
        "minimum_at": found.minimum_at,
        "P_max": found.largest_pressure,
        "ripples_x": _ripples(found.ripples_x),
        "ripples_y": _ripples(found.ripples_y),
        "waves": [_wave(wave) for wave in found.waves],
        "wave_notes": list(found.wave_notes),
    }


def _ripples(found: "Ripples") -> dict[str, float]:
    return {"count": found.count, "depth_m": found.depth}


def _wave(wave: "WaveResponse") -> dict[str, float | None]:
    return {
        "wavelength_m": wave.wavelength,
        "angle_rad": wave.angle,
        "amplitude_m": wave.amplitude,
        "points_per_wave": wave.points_per_wave,
        "film_amplitude_m": wave.film_amplitude,
        "film_phase_rad": wave.film_phase,
        "film_ratio": wave.film_ratio,
        "pressure_amplitude_pa": wave.pressure_amplitude,
        "pressure_phase_rad": wave.pressure_phase,
        "carried_amplitude_m": wave.carried_amplitude,
        "theory_film_ratio": wave.theory.film_ratio,
        "theory_pressure_pa": wave.theory.pressure,
        "elastic_pressure_pa": wave.theory.elastic_pressure,
        "compressibility": wave.theory.compressibility,
    }


def _convergence(result: Result) -> dict[str, Any]:
    balance = None if result.heat is None else result.heat.balance.error
    if not result.history:
        none = dict.fromkeys(("residual", "change", "load_error"))
        return {"cycles": 0, **none, "heat_balance_error": balance}
    last = result.history[-1]
    return {
        "cycles": sum(report.points == last.points for report in result.history),
        "residual": last.residual,
        "change": last.change,
        "load_error": last.load_error,
        "heat_balance_error": balance,
    }


def _cost(result: Result) -> dict[str, Any]:
    cost = result.cost
    return {
        "points": [result.scaled.x.size, result.scaled.y.size],
        "cpu_seconds": cost.cpu_seconds,
        "wall_seconds": cost.wall_seconds,
        "work": cost.work,
    }


_MIRRORED = (
    ("film_central", "film", "H_central", "h_central_m"),
    ("film_minimum", "film", "H_min", "h_min_m"),
    ("pressure_max", "pressure", "P_max", "max_pa"),
    ("film_rise_max", "temperature", None, "film_rise_max_k"),
    ("mid_film_rise_central", "temperature", None, "mid_film_rise_central_k"),
    ("traction_mid_film", "traction", "mid_film", None),
)
"""Names of estimates, and block and keys of the summary that they mirror: scaled and SI."""


def _uncertainty(result: Result) -> dict[str, dict[str, Any]]:
    units = {"film": result.scales.film_thickness, "pressure": result.scales.hertz_pressure}
    blocks: dict[str, dict[str, Any]] = {"film": {}, "pressure": {}}
    for name, block, scaled_key, si_key in _MIRRORED:
        if name not in result.uncertainty:
            continue
        estimate, mirror = result.uncertainty[name], blocks.setdefault(block, {})
        if scaled_key:
            mirror[scaled_key] = asdict(estimate)
        if si_key:
            mirror[si_key] = asdict(_scaled_estimate(estimate, units.get(block, 1.0)))
    return blocks


def _scaled_estimate(estimate: Estimate, unit: float) -> Estimate:
    return Estimate(
        value=estimate.value * unit,
        uncertainty=estimate.uncertainty * unit,
        discretisation=estimate.discretisation * unit,
        domain=estimate.domain * unit,
        observed_order=estimate.observed_order,
        values=tuple(value * unit for value in estimate.values),
    )
