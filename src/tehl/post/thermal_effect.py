"""Effect of heat on a film: a thermal result beside its isothermal reference run."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter

from tehl.errors import InputError
from tehl.inlet_heating import InletFactor, inlet_factors
from tehl.problem import ContactProblem

if TYPE_CHECKING:
    from tehl.result import Result


@dataclass(frozen=True, kw_only=True, slots=True)
class ThermalEffect:
    """Films of a thermal run over those of its isothermal reference run.

    Attributes
    ----------
    central, minimum : float
        Ratio of the central and of the minimum films [-].
    isothermal_central, isothermal_minimum : float
        Films of the reference run [m].
    inlet_factors : tuple of InletFactor
        Ratio by heating in the inlet alone, by each formula.
    """

    central: float
    minimum: float
    isothermal_central: float
    isothermal_minimum: float
    inlet_factors: tuple[InletFactor, ...]


def isothermal_reference(problem: ContactProblem) -> ContactProblem:
    """Return ``problem`` without heat, its oil at inlet temperature everywhere.

    Raises
    ------
    InputError
        If the problem is isothermal already.
    """
    if problem.thermal is None:
        raise InputError("the case is isothermal: no [thermal] table to compare without")
    oil = problem.lubricant.model_copy(update={"temperature": problem.inlet_temperature})
    surfaces = {
        name: getattr(problem, name).model_copy(update={"temperature": None})
        for name in ("surface_1", "surface_2")
    }
    return problem.model_copy(update={"thermal": None, "lubricant": oil, **surfaces})


def thermal_effect(thermal: "Result", isothermal: "Result") -> ThermalEffect:
    """Return the effect of heat, from a thermal result and its isothermal reference run."""
    warm, cold = thermal.film, isothermal.film
    return ThermalEffect(
        central=warm.central / cold.central,
        minimum=warm.minimum / cold.minimum,
        isothermal_central=cold.central,
        isothermal_minimum=cold.minimum,
        inlet_factors=inlet_factors(thermal.problem),
    )


_KEYS = {
    "isothermal_central": "isothermal_h_central_m",
    "isothermal_minimum": "isothermal_h_min_m",
}


def effect_block(effect: ThermalEffect) -> dict[str, Any]:
    """Return the comparison as the block ``thermal_effect`` of a summary."""
    return {_KEYS.get(name, name): value for name, value in asdict(effect).items()}


def stored_effect(summary: Mapping[str, Any]) -> ThermalEffect | None:
    """Return the comparison in a summary of a stored result, None without one."""
    block: Any = summary.get("thermal_effect")
    try:
        values = {one.name: block[_KEYS.get(one.name, one.name)] for one in fields(ThermalEffect)}
        return TypeAdapter(ThermalEffect).validate_python(values)
    except (TypeError, KeyError, ValueError):  # missing, or written by another program
        return None
