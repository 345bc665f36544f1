"""What heat does to a film: a thermal result beside its isothermal twin."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from tehl.errors import InputError
from tehl.film_formulas import InletFactor, inlet_factors
from tehl.problem import ContactProblem

if TYPE_CHECKING:
    from tehl.result import Result


@dataclass(frozen=True, kw_only=True, slots=True)
class ThermalEffect:
    """Films of a thermal run over those of its isothermal twin.

    Attributes
    ----------
    central, minimum : float
        Ratio of the central and of the minimum films [-].
    isothermal_central, isothermal_minimum : float
        Films of the twin [m].
    inlet_factors : tuple of InletFactor
        Ratio that heating in the inlet alone would make, by each formula.
    """

    central: float
    minimum: float
    isothermal_central: float
    isothermal_minimum: float
    inlet_factors: tuple[InletFactor, ...]


def isothermal_twin(problem: ContactProblem) -> ContactProblem:
    """Return ``problem`` without heat, its oil as warm everywhere as it is at the inlet.

    Raises
    ------
    InputError
        If the problem is isothermal already.
    """
    if problem.thermal is None:
        raise InputError("the case is isothermal: it has no [thermal] table to compare without")
    oil = problem.lubricant.model_copy(update={"temperature": problem.inlet_temperature})
    surfaces = {
        name: getattr(problem, name).model_copy(update={"temperature": None})
        for name in ("surface_1", "surface_2")
    }
    return problem.model_copy(update={"thermal": None, "lubricant": oil, **surfaces})


def thermal_effect(thermal: "Result", isothermal: "Result") -> ThermalEffect:
    """Return what heat does to the film, from a thermal result and that of its twin."""
    warm, cold = thermal.film, isothermal.film
    return ThermalEffect(
        central=warm.central / cold.central,
        minimum=warm.minimum / cold.minimum,
        isothermal_central=cold.central,
        isothermal_minimum=cold.minimum,
        inlet_factors=inlet_factors(thermal.problem),
    )


def effect_block(effect: ThermalEffect) -> dict[str, Any]:
    """Return what a summary says of the comparison, in the block ``thermal_effect``."""
    return {
        "central": effect.central,
        "minimum": effect.minimum,
        "isothermal_h_central_m": effect.isothermal_central,
        "isothermal_h_min_m": effect.isothermal_minimum,
        "inlet_factors": [asdict(factor) for factor in effect.inlet_factors],
    }


def stored_effect(summary: Mapping[str, Any]) -> ThermalEffect | None:
    """Return the comparison that a stored summary holds; None where there is none.

    Parameters
    ----------
    summary : mapping
        As :func:`tehl.io.store.load_summary` returns it.
    """
    block: Any = summary.get("thermal_effect")
    try:
        return ThermalEffect(
            central=float(block["central"]),
            minimum=float(block["minimum"]),
            isothermal_central=float(block["isothermal_h_central_m"]),
            isothermal_minimum=float(block["isothermal_h_min_m"]),
            inlet_factors=tuple(_factor(**one) for one in block["inlet_factors"]),
        )
    except (TypeError, KeyError, ValueError):  # none, or one that another program wrote
        return None


def _factor(formula: str, source: str, factor: float, remarks: list[str]) -> InletFactor:
    return InletFactor(formula=formula, source=source, factor=factor, remarks=tuple(remarks))
