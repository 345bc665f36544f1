"""Effect of heat on a film: a thermal result beside its isothermal reference run."""

from dataclasses import dataclass

from tehl.base.errors import InputError
from tehl.contact.problem import ContactProblem
from tehl.estimate.inlet_heating import InletFactor, inlet_factors
from tehl.result.solution import Solution


@dataclass(frozen=True, kw_only=True, slots=True)
class ThermalEffect:
    """Films of a thermal run over those of its isothermal reference run; a block of the summary."""

    central: float
    minimum: float
    """Ratio of the central and of the minimum films [-]."""
    isothermal_h_central_m: float
    isothermal_h_min_m: float
    """Films of the reference run [m]."""
    inlet_factors: tuple[InletFactor, ...]
    """Ratio by heating in the inlet alone, by each formula."""


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
    problem = problem.with_bodies(None, None)
    return problem.model_copy(update={"thermal": None, "lubricant": oil})


def thermal_effect(thermal: Solution, isothermal: Solution) -> ThermalEffect:
    """Return the effect of heat, from a thermal result and its isothermal reference run.

    Parameters
    ----------
    thermal : Solution
        Film with heat.
    isothermal : Solution
        Same contact at the inlet temperature.
    """
    warm, cold = thermal.film, isothermal.film
    return ThermalEffect(
        central=warm.central / cold.central,
        minimum=warm.minimum / cold.minimum,
        isothermal_h_central_m=cold.central,
        isothermal_h_min_m=cold.minimum,
        inlet_factors=inlet_factors(thermal.problem),
    )
