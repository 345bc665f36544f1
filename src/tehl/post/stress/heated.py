"""Bodies under the heat of a film and of rubbing, and how their thermal stress is computed."""

import numpy as np

from tehl.contact.stress import FAST_PECLET
from tehl.post.stress.loads import parts_of_cells, rubbing
from tehl.post.stress.slow import RestingStress, SlowStress
from tehl.post.stress.thermal import Heated, ThermalStress
from tehl.post.stress.window import Window
from tehl.result.solution import Solution

ThermalBody = ThermalStress | RestingStress | SlowStress


def heated_body(
    result: Solution, body: int, window: Window, sides: tuple[int, int]
) -> Heated | None:
    """Return a body with its heat, that of rubbing included; None if its wake is not along x.

    Parameters
    ----------
    result : Solution
        Heated.
    body : {1, 2}
        Number of the body.
    window : Window
        Nodes whose stresses are wanted.
    sides : (int, int)
        Nodes before and behind it with a wake, even.
    """
    problem, heat = result.problem, result.heat
    speed, peclet = problem.motion.speed_of(body), problem.solid_peclet[body - 1]
    if heat is None or peclet is None or not problem.motion.is_plain:
        return None
    part = problem.rubbing_parts[body - 1]
    sliding = problem.motion.sliding_field(result.x, result.y[:, None])
    rubbed = rubbing(result) * np.hypot(*sliding)
    flux = (heat.flux_1, heat.flux_2)[body - 1] + part * rubbed
    flux = flux * parts_of_cells(result)
    columns, last = window.columns, window.columns.stop + sides[1]
    before = max(sides[0] - columns.start, 0)
    before += before % 2
    flux = np.pad(flux, ((0, 0), (before, max(last - flux.shape[1], 0))))
    # the first node of the window stays one of every second node
    first = (window.rows.start % 2, columns.start % 2)
    rows = slice(window.rows.start - first[0], window.rows.stop - first[0])
    shift = before - first[1]
    wide = slice(columns.start - sides[0] + shift, last + shift)
    flux = flux[first[0] :, first[1] :]
    slow = abs(peclet) < FAST_PECLET
    solid = problem.surfaces[body - 1].material
    return Heated(flux, window.spacing, speed, solid, (rows, wide), slow, problem.contact.ends)


def thermal_stress_of(heated: Heated) -> ThermalBody:
    """Return the thermal stress of a body that moves fast, slowly or not at all."""
    if not heated.speed:
        return RestingStress(heated)
    return SlowStress(heated) if heated.slow else ThermalStress(heated)


def surface_stress(heated: Heated) -> float:
    """Return the largest compression along the surface of a body [Pa].

    E alpha dT/(1 - nu) of the largest rise; of a body at rest or slow, that of its stress.
    """
    body = thermal_stress_of(heated)
    if not isinstance(body, ThermalStress):
        return float(-body.stresses(0.0)[:2].min())
    expansion, rise = heated.solid.expansion or 0.0, float(body.temperature(0.0).max())
    return heated.solid.young_modulus * expansion * rise / (1.0 - heated.solid.poisson_ratio)
