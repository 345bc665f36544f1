"""The numbers of a result as one JSON object."""

import math
import re
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any, TypeVar

import numpy as np
from pydantic import TypeAdapter

from tehl.base.typing import Array
from tehl.post.boundary_contact import Touching, touching
from tehl.post.heat import Temperature, temperature, work_error
from tehl.post.roughness import RoughFilm, rough_film
from tehl.post.starvation import Starvation, starvation
from tehl.post.summits import LoadSharing, load_sharing
from tehl.post.traction import Traction, traction
from tehl.post.transient_numbers import friction, late_extremes, longer_duration
from tehl.post.waves.response import WaveResponse
from tehl.result.fields import FilmHeat
from tehl.result.solution import ErrorEstimate, Estimate, Solution
from tehl.result.transient import HistoryBars, TransientSolution

Block = dict[str, Any]
Part = TypeVar("Part")
_UNIT = re.compile("_(m2|m|pa|k|w|rad)$")


def summary(result: Solution | TransientSolution) -> Block:
    """Return the summary of a result as JSON can hold it: null where a number is not finite.

    Keys that end in a unit (``_m``, ``_pa``, ``_k``, ``_s``, ``_w``) are SI, the others
    dimensionless. A film that is not positive is null; ``temperature`` and ``heat`` are null for an
    isothermal run, ``traction`` without shear stresses, ``roughness`` if no surface states any. A
    certified result has ``uncertainty``, which mirrors the values.

    A transient result has ``"kind": "transient"``, extremes with their times, and under ``start``
    the summary of the steady film at its start.
    """
    status = result.status
    if isinstance(result, TransientSolution):
        title, kind, content = result.start.problem.title, {"kind": "transient"}, _transient(result)
    else:
        title, kind, content = result.problem.title, {}, _steady(result)
    head = {"title": title, "status": status.kind} | _picked(status, "cause", "message")
    hint: Block = {"hint": None, "settings": None}
    if status.hint is not None:
        hint = {"hint": str(status.hint), "settings": dict(status.hint.settings)}
    found: Block = plain(kind | head | hint | content)
    return found


def _picked(owner: object, *keys: str) -> Block:
    """Return attributes of ``owner`` by keys: their names, with the SI unit as ending if any."""
    return {key: getattr(owner, _UNIT.sub("", key)) for key in keys}


def plain(value: Any) -> Any:
    """Return ``value`` with plain numbers and lists, and None for each number not finite."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def from_block(kind: type[Part], block: Any) -> Part | None:
    """Return the dataclass that a block of a stored summary holds; None if it does not fit."""
    try:
        return TypeAdapter(kind).validate_python(block)
    except ValueError:  # missing, or written by another program
        return None


Path = tuple[str, ...]

_STEADY: dict[str, tuple[Path, ...]] = {
    "film_central": (("film", "H_central"), ("film", "h_central_m")),
    "film_minimum": (("film", "H_min"), ("film", "h_min_m")),
    "pressure_max": (("pressure", "P_max"), ("pressure", "max_pa")),
    "film_rise_max": (("temperature", "film_rise_max_k"),),
    "mid_film_rise_central": (("temperature", "mid_film_rise_central_k"),),
    "traction_mid_film": (("traction", "mid_film"),),
    "load_share": (("load_sharing", "share"),),
}
_TRANSIENT: dict[str, tuple[Path, ...]] = {
    "film_minimum": (("film", "h_min_m", "value"),),
    "film_central_least": (("film", "h_central_m", "least"),),
    "film_central_largest": (("film", "h_central_m", "largest"),),
    "pressure_max": (("pressure", "p_max_pa", "value"),),
    "film_rise_max": (("temperature", "film_rise_max_k", "value"),),
    "traction_extreme": (("traction", "extreme"),),
}
"""Keys of the summary that the estimates of a certified result belong to."""


def estimates(result: Solution | TransientSolution) -> dict[str, Estimate]:
    """Return the values of a certified result with their error bars, in SI."""
    return result.uncertainty if isinstance(result, TransientSolution) else result.certified


def _mirrored(result: Solution | TransientSolution, places: dict[str, tuple[Path, ...]]) -> Block:
    """Return the estimates of a result under the keys of their values."""
    blocks: Block = {}
    in_si = estimates(result)
    for name, paths in places.items():
        for *parents, key in paths if name in in_si else ():
            block = blocks
            for parent in parents:
                block = block.setdefault(parent, {})
            dimensionless = key.startswith(("H_", "P_"))
            block[key] = asdict((result.uncertainty if dimensionless else in_si)[name])
    return blocks


# ---- steady results


def _steady(result: Solution) -> Block:
    lubricant, heat, rough = result.problem.lubricant, result.heat, rough_film(result)
    heated, forces, scaled = temperature(result), traction(result), result.scaled
    starved, shared, touched = starvation(result), load_sharing(result), touching(result)
    content = {
        "laws": {
            "viscosity": lubricant.viscosity.law,
            "viscosity_temperature": getattr(lubricant.viscosity, "temperature_law", None),
            "density": lubricant.density.law,
            "shear": lubricant.shear.law,
            "reynolds": getattr(result.problem.heat, "reynolds", "isothermal"),
        },
        "domain": {"x": scaled.x[[0, -1]].tolist(), "y": scaled.y[[0, -1]].tolist()},
        "groups": _groups(result),
        "film": _film(result),
        "pressure": _pressure(result),
        "temperature": None if heated is None else _temperature(heated),
        "traction": None if forces is None else _traction(forces),
        "heat": None if heat is None else _heat(heat),
        "roughness": None if rough is None else roughness_block(rough),
        "load_sharing": None if shared is None else _load_sharing(shared),
        "touching": None if touched is None else _touching(touched),
        "starvation": None if starved is None else _starvation(starved),
        "convergence": _convergence(result),
        "errors": None if result.errors is None else _errors(result.errors),
        "cost": {"points": [scaled.x.size, scaled.y.size]} | asdict(result.cost),
    }
    if result.uncertainty:
        content["uncertainty"] = {"film": {}, "pressure": {}} | _mirrored(result, _STEADY)
    return content


def _errors(found: ErrorEstimate) -> Block:
    return {"central": found.central, "minimum": found.minimum} | asdict(found)


def _groups(result: Solution) -> Block:
    groups, scales = asdict(result.groups), result.scales
    del groups["deflection_factor"]
    return groups | {
        "hertz_pressure_pa": scales.hertz_pressure,
        "hertz_half_width_m": scales.half_width_x,
        "hertz_half_width_y_m": scales.half_width_y,
    }


def _film(result: Solution) -> Block:
    film, moes, unit = result.film, moes_film_factor(result), result.scales.film_thickness
    minimum, central = film.minimum / unit, film.central / unit
    numbers = {
        "h_min_m": film.minimum,
        "h_central_m": film.central,
        "H_min": minimum,
        "H_min_node": result.film_scaled.minimum_node,
        "H_central": central,
        "H_min_moes": minimum * moes,
        "H_central_moes": central * moes,
    }
    return {name: value if value > 0 else None for name, value in numbers.items()} | {
        "minimum_at": result.film_scaled.minimum_at,
        "rigid_approach": result.rigid_approach,
    }


def moes_film_factor(result: Solution) -> float:
    """Return what turns H into the Moes film ``(h/R_x) (2U)^(-1/2)``.

    For a circle this is ``(3M/2)^(2/3)``.
    """
    scales, groups = result.scales, result.groups
    # h = H a_x^2/R_x with R_x = a_x^2 / (a_x^2/R_x), so h/R_x = H (film_thickness/a_x)^2.
    return (scales.film_thickness / scales.half_width_x) ** 2 / math.sqrt(2.0 * groups.U)


def _pressure(result: Solution) -> Block:
    highest = float(np.max(result.scaled.pressure))
    return {
        "max_pa": highest * result.scales.hertz_pressure,
        "P_max": highest,
        "P_central": result.scaled.at_origin(result.scaled.pressure),
    }


def _temperature(found: Temperature) -> Block:
    return {"film_rise_max_at": found.film_rise_max_at} | _picked(
        found,
        *("film_rise_max_k", "mid_film_rise_central_k", "mean_rise_central_k"),
        *("surface_1_rise_max_k", "surface_2_rise_max_k", "inlet_k"),
    )


def _traction(found: Traction) -> Block:
    around = found.surroundings
    return (
        {"sliding": found.mid_film}
        | _picked(
            found,
            *("surface_1", "mid_film", "surface_2", "rolling", "rolling_by_film"),
            *("closure_error", "credible", "friction_power_w"),
        )
        | {"surroundings": None if around is None else _picked(around, *_SURROUNDINGS)}
    )


_SURROUNDINGS = ("surface_1", "mid_film", "surface_2", "friction_power_w", "radius_m")


def _heat(heat: FilmHeat) -> Block:
    powers = {f"{name}_w": power for name, power in asdict(heat.balance).items()}
    return powers | {"solid_peclet": heat.solid_peclet, "sources": heat.sources}


def _load_sharing(found: LoadSharing) -> Block:
    names = ("number", "radius_m", "pressure_pa", "elastic_pressure_pa", "flash_rise_k")
    return _picked(
        found,
        *("share", "share_error", "friction", "friction_film", "friction_boundary"),
        *("area_m2", "area_part", "asperity_pressure_max_pa", "pressure_max_pa"),
        *("separation_central_m", "separation_ratio", "power_boundary_w", "balance"),
    ) | {"spots": None if found.spots is None else _picked(found.spots, *names)}


def _touching(found: Touching) -> Block:
    names = ("number", "area_mean_m2", "area_largest_m2", "pressure_mean_pa", "pressure_max_pa")
    block = _picked(
        found,
        *("share", "share_error", "margin_m", "friction", "friction_film", "friction_boundary"),
        *("area_m2", "area_part", "contact_pressure_max_pa", "pressure_max_pa"),
        *("power_boundary_w", "balance"),
    ) | {"patches": None if found.patches is None else _picked(found.patches, *names, "cells")}
    # what follows from a share that is not known is not known either
    hidden = () if found.is_share_known else _OF_SHARE
    return {key: None if key in hidden else value for key, value in block.items()}


_OF_SHARE = ("share", "share_error", "friction", "friction_boundary", "power_boundary_w", "patches")


def _starvation(found: Starvation) -> Block:
    return _picked(
        found,
        *("ratio", "degree", "degree_error", "degree_by_law", "flooded_film_m", "meniscus_m"),
        *("inlet_distance_m", "entering_m", "leaving_m", "leaving_each_m", "balance"),
    )


def roughness_block(found: RoughFilm) -> Block:
    """Return the block ``roughness`` of a summary from the numbers of a rough film."""
    return {
        "surface_1_sq_m": found.sq[0],
        "surface_2_sq_m": found.sq[1],
        "composite_sq_m": found.composite,
        "surface_1_sa_m": found.resolution.sa[0] if found.resolution else None,
        "surface_2_sa_m": found.resolution.sa[1] if found.resolution else None,
        "surface_1_sq_on_grid_m": found.sq_on_grid[0],
        "surface_2_sq_on_grid_m": found.sq_on_grid[1],
        "composite_sq_on_grid_m": math.hypot(*found.sq_on_grid),
        "lost_share": found.resolution.lost_share if found.resolution else 0.0,
        "warning": found.resolution.warning if found.resolution else None,
        "lambda_central": found.lambda_central,
        "lambda_minimum": found.lambda_minimum,
        "lambda_by_formula": found.lambda_by_formula,
        "lubrication": found.lubrication,
        "film_quantiles": [{"part": part, "h_m": film} for part, film in found.quantiles],
        "area_below_composite_sq": found.below_composite,
        "area_below_half_median": found.below_half,
        "minimum_at": found.minimum_at,
        "P_max": found.largest_pressure,
        "ripple_film_m": found.ripple_film,
        "ripple_pressure_pa": found.ripple_pressure,
        "ripples_x": {"count": found.ripples_x.count, "depth_m": found.ripples_x.depth},
        "ripples_y": {"count": found.ripples_y.count, "depth_m": found.ripples_y.depth},
        "waves": [_wave(wave) for wave in found.waves],
        "wave_notes": list(found.wave_notes),
    }


def _wave(wave: WaveResponse) -> Block:
    measured = _picked(
        wave,
        *("wavelength_m", "angle_rad", "amplitude_m", "points_per_wave", "film_amplitude_m"),
        *("film_phase_rad", "film_ratio", "pressure_amplitude_pa", "pressure_phase_rad"),
        "carried_amplitude_m",
    )
    return measured | {
        "theory_film_ratio": wave.theory.film_ratio,
        "theory_pressure_pa": wave.theory.pressure,
        "elastic_pressure_pa": wave.theory.elastic_pressure,
        "compressibility": wave.theory.compressibility,
    }


def _convergence(result: Solution) -> Block:
    history, names = result.history, ("residual", "change", "load_error")
    finest = [report for report in history if report.points == history[-1].points]
    last = _picked(finest[-1], *names) if finest else dict.fromkeys(names)
    balance = None if result.heat is None else result.heat.balance.error
    balances = {"heat_balance_error": balance, "work_balance_error": work_error(result)}
    return {"cycles": len(finest), **last, **balances}


# ---- transient results


def _transient(run: TransientSolution) -> Block:
    history, times = run.history, run.history.time
    rise = _extreme(history.temperature_rise, times, np.argmax)
    cycles = history.cycles[1:].astype(float) if history.cycles.size > 1 else np.zeros(1)
    content: Block = {
        "time": {
            "duration_s": float(times[-1]),
            "step_s": run.time_step,
            "steps": len(times) - 1,
            "frames": len(run.frames.step),
            "late_extremes": list(late_extremes(run)),
            "longer_duration_s": longer_duration(run),
        },
        "film": {
            "h_min_m": _extreme(history.film_minimum, times, np.argmin),
            "h_central_m": _range(history.film_central),
        },
        "pressure": {"p_max_pa": _extreme(history.pressure_max, times, np.argmax)},
        "temperature": None if run.start.heat is None else {"film_rise_max_k": rise},
        "traction": _range(history.traction),
        "friction": None if (rubbed := friction(run)) is None else _range(rubbed),
        "asperity_load": None
        if run.start.asperities is None and run.start.problem.contact_film is None
        else _extreme(history.asperity_load, times, np.argmax),
        "load_factor": _range(history.load),
        "cycles": {"per_step": cycles.mean(), "most": cycles.max(), "total": cycles.sum()},
        "cost": asdict(run.cost),
        "start": summary(run.start),
    }
    if run.uncertainty:
        content["uncertainty"] = _mirrored(run, _TRANSIENT)
        if run.bars is not None:
            content["uncertainty"]["history"] = _history_bars(run.bars)
    return content


def _extreme(values: Array, times: Array, find: Any) -> Block:
    place = find(values)
    return {"value": values[place], "time_s": times[place], "start": values[0]}


def _range(values: Array) -> Block:
    return {"least": values.min(), "largest": values.max(), "start": values[0], "end": values[-1]}


def _history_bars(bars: HistoryBars) -> Block:
    return {
        "instants": len(bars.time),
        "h_central_m": bars.film_central.max(),
        "h_min_m": bars.film_minimum.max(),
        "p_max_pa": bars.pressure_max.max(),
    }
