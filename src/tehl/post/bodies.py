"""Temperatures of the bodies, and the heat that enters them."""

from dataclasses import dataclass

from tehl.post.boundary_contact import touching
from tehl.post.summits import load_sharing
from tehl.result.solution import Solution


@dataclass(frozen=True, kw_only=True, slots=True)
class Bodies:
    """Temperatures of both bodies far from the contact, and the heat that enters them."""

    temperature_1: float
    temperature_2: float
    """Stated, or computed from the heat [K]."""
    heat_1: float
    heat_2: float
    """Heat of film and touching solids in the loaded zone into each body [W]."""
    resistance_1: float | None
    resistance_2: float | None
    """Thermal resistances to the oil [K/W]; None where the temperature is stated."""
    balance: float | None
    """Largest difference of the heat into a body and out of it, over the larger heat that enters
    one [-]; None where both temperatures are stated."""


def bodies(result: Solution) -> Bodies | None:
    """Return temperatures and heat of the bodies of ``result``, None for an isothermal run."""
    energy = result.solved_problem.heat
    if result.heat is None or energy is None:
        return None
    temperatures, heats = (energy.bulk_1, energy.bulk_2), heat_into_bodies(result)
    resistances, largest = result.problem.resistances, max(map(abs, heats)) or 1.0
    wrong = [
        abs(heat - (body - energy.temperature) / one if one else 0.0) / largest
        for heat, body, one in zip(heats, temperatures, resistances, strict=True)
    ]
    return Bodies(
        temperature_1=temperatures[0],
        temperature_2=temperatures[1],
        heat_1=heats[0],
        heat_2=heats[1],
        resistance_1=resistances[0],
        resistance_2=resistances[1],
        balance=max(wrong) if result.problem.computes_bodies else None,
    )


def heat_into_bodies(result: Solution) -> tuple[float, float]:
    """Return the heat of film, asperities and boundary contact into each body [W]."""
    assert result.heat is not None
    problem, balance = result.problem, result.heat.balance
    rubbing = (load_sharing(result), touching(result))
    rubbed = sum(one.power_boundary for one in rubbing if one is not None)
    parts = problem.rubbing_parts
    return balance.surface_1 + parts[0] * rubbed, balance.surface_2 + parts[1] * rubbed
