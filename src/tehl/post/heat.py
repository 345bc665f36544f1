"""Temperatures of a film."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.operators.loaded_zone import is_inside, zone_part
from tehl.post.traction import slope_across, traction, under_pressure
from tehl.result.fields import FilmHeat
from tehl.result.solution import Solution

PLACE_DIGITS = 12
"""Decimals of a place in half-widths: the middle of a grid is zero only to rounding."""
UNTRUSTED_HEAT = 0.2
"""Error of the power that the surfaces transfer above which temperatures are not to be trusted: at
2 to 2.8 GPa films have up to 0.002, and those of an earlier limiting stress lost 0.4 to 0.8."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Temperature:
    """Temperatures of a film; all rises are over the temperature of the oil at the inlet."""

    inlet: float
    """Temperature of the oil at the inlet [K]."""
    film_rise_max: float
    """Largest rise in the film of the loaded zone, surfaces included; of all nodes [K]."""
    film_rise_max_at: tuple[float, float, float]
    """Where: X, Y in Hertz half-widths (Y >= 0 for a symmetric contact) and zeta = z/h."""
    mid_film_rise_central: float
    mean_rise_central: float
    """Rise at X = Y = 0, half-way between the surfaces and as mean across the film [K]."""
    surface_1_rise_max: float
    surface_2_rise_max: float
    """Largest rise of each surface in the loaded zone [K]."""
    mid_film: Array
    mean: Array
    """(ny, nx): T at mid-film and T averaged across the film [K]."""


class Rises(NamedTuple):
    """Rises of a film that get error bars, as in `Temperature` [K]."""

    film_rise_max: float
    mid_film_rise_central: float
    surface_1_rise_max: float
    surface_2_rise_max: float


def temperature(result: Solution) -> Temperature | None:
    """Return the temperatures of ``result``, None for an isothermal run."""
    heat, inlet = result.heat, result.scales.temperature
    if heat is None:
        return None
    mid_film = np.tensordot(lagrange_weights(heat.zeta, 0.5), heat.temperature, axes=1)
    mean = mean_temperature(heat)
    # Of equal temperatures the one with the largest Y: a symmetric contact has Y >= 0.
    scaled = result.scaled
    inside = is_inside(scaled.x, scaled.y, result.groups.skew)
    field = np.where(inside, heat.temperature, -np.inf)[:, ::-1]
    layer, row, column = np.unravel_index(int(np.argmax(field)), field.shape)
    return Temperature(
        inlet=inlet,
        film_rise_max=float(field[layer, row, column]) - inlet,
        film_rise_max_at=(
            round(float(scaled.x[column]), PLACE_DIGITS) + 0.0,
            round(float(scaled.y[::-1][row]), PLACE_DIGITS) + 0.0,  # no -0
            float(heat.zeta[layer]),
        ),
        mid_film_rise_central=scaled.at_origin(mid_film) - inlet,
        mean_rise_central=scaled.at_origin(mean) - inlet,
        surface_1_rise_max=float(heat.temperature[0][inside].max()) - inlet,
        surface_2_rise_max=float(heat.temperature[-1][inside].max()) - inlet,
        mid_film=mid_film,
        mean=mean,
    )


def work_error(result: Solution) -> float | None:
    """Return what the heat of the film lacks of the power that the surfaces transfer to it [-].

    Over the larger of both. Forces and heat follow from different equations, which agree where the
    mesh resolves the film. None for an isothermal run.
    """
    if result.heat is None:
        return None
    forces = traction(result)
    if forces is None:
        return None
    made = result.heat.balance.shear + result.heat.balance.compression
    power = forces.friction_power + _pumped_in(result, result.heat)
    return (power - made) / (max(abs(power), abs(made)) or 1.0)


def _pumped_in(result: Solution, heat: FilmHeat) -> float:
    """Return the work that oil under pressure does as it flows into the loaded zone [W].

    That is the integral of q grad p around it, with ``q = u_m h - h^3/(12 eta) grad p`` of oil
    that is hardly compressed.
    """
    x, film, pressure = result.x, result.film_thickness, result.pressure
    inside = zone_part(result.scaled.x, result.scaled.y, skew=result.groups.skew)
    outside = under_pressure(result) * (1.0 - inside)
    along = np.gradient(pressure, x, axis=1)
    across = slope_across(result, pressure)
    eta = result.problem.lubricant.viscosity.viscosity(pressure, mean_temperature(heat))
    carried = result.problem.motion.entrainment_speed * film * along
    spent = film**3 / (12.0 * eta) * (along**2 + across**2)
    return float((outside * (carried - spent)).sum())


def mean_temperature(heat: FilmHeat) -> Array:
    """Return T averaged across the film, (ny, nx) [K]."""
    return np.tensordot(heat.weights, heat.temperature, axes=1)


def lagrange_weights(nodes: Array, place: float) -> Array:
    """Return the weights of the values at ``nodes`` in their polynomial at ``place``.

    Parameters
    ----------
    nodes : Array
        Different places, (n,).
    place : float
        In the unit of ``nodes``; the weights are 0 and 1 if it is one of them.
    """
    gaps, above = nodes[:, None] - nodes, np.broadcast_to(place - nodes, (nodes.size, nodes.size))
    ratios = np.divide(above, gaps, out=np.ones_like(gaps), where=gaps != 0)
    return ratios.prod(axis=1)
