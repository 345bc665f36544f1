"""The numbers of a result as one JSON object."""

import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from tehl.result import Estimate, Result
from tehl.typing import Array


def summary(result: Result) -> dict[str, Any]:
    """Return the summary of ``result`` as JSON can hold it: null where a number is not finite.

    Keys that end in a unit (``_m``, ``_pa``) are SI, the others dimensionless. ``temperature`` and
    ``traction`` are null where they do not apply. A certified result has ``uncertainty``, which
    mirrors the film and pressure values.

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
        "temperature": None,
        "traction": None,
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
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value


def _laws(result: Result) -> dict[str, str]:
    lubricant = result.problem.lubricant
    return {
        "viscosity": lubricant.viscosity.law,
        "density": lubricant.density.law,
        "shear": lubricant.shear.law,
        "reynolds": "isothermal",
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
    return {
        "h_min_m": film.minimum,
        "h_central_m": film.central,
        "H_min": scaled.minimum,
        "H_min_node": scaled.minimum_node,
        "H_central": scaled.central,
        "H_min_moes": scaled.minimum * moes,
        "H_central_moes": scaled.central * moes,
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
        "P_central": _at_origin(result, result.scaled.pressure),
    }


def _at_origin(result: Result, field: Array) -> float:
    """Return ``field`` at X = Y = 0, by the parabolas through the nearest three nodes each way."""
    rows, row_weights = _parabola(result.scaled.y)
    columns, column_weights = _parabola(result.scaled.x)
    return float(row_weights @ field[rows, columns] @ column_weights)


def _parabola(axis: Array) -> tuple[slice, Array]:
    middle = int(np.clip(np.argmin(np.abs(axis)), 1, axis.size - 2))
    part = slice(middle - 1, middle + 2)
    t = -axis[middle] / (axis[middle + 1] - axis[middle])
    return part, np.array([t * (t - 1) / 2, 1 - t**2, t * (t + 1) / 2])


def _convergence(result: Result) -> dict[str, Any]:
    if not result.history:
        return {"cycles": 0, "residual": None, "load_error": None, "heat_balance_error": None}
    last = result.history[-1]
    return {
        "cycles": sum(report.points == last.points for report in result.history),
        "residual": last.residual,
        "change": last.change,
        "load_error": last.load_error,
        "heat_balance_error": None,
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
)


def _uncertainty(result: Result) -> dict[str, dict[str, Any]]:
    units = {"film": result.scales.film_thickness, "pressure": result.scales.hertz_pressure}
    blocks: dict[str, dict[str, Any]] = {"film": {}, "pressure": {}}
    for name, block, scaled_key, si_key in _MIRRORED:
        if name in result.uncertainty:
            estimate = result.uncertainty[name]
            blocks[block][scaled_key] = asdict(estimate)
            blocks[block][si_key] = asdict(_scaled_estimate(estimate, units[block]))
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
