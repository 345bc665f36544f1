"""Rolling friction and rolling moment of a line contact.

The pressure lies upstream of the middle, by a shift e: the load makes the moment w e about it. The
flow by the pressure balances it with a force F on each surface, w e = 2 F R (docs/theory/line.md).
Much of it comes from the oil upstream, whose part outside of the grid is added.
"""

from dataclasses import dataclass

import numpy as np

from tehl.operators.upstream import NOTHING, beyond, rolling
from tehl.result.solution import Solution


@dataclass(frozen=True, kw_only=True, slots=True)
class Rolling:
    """Rolling friction of one metre of a line contact."""

    force: float
    """F on each surface, against its motion [N]."""
    moment: float
    """Moment w e = 2 F R of the pressure about the middle [N m]."""
    shift: float
    """Distance e of the pressure centre upstream of the middle [m]."""
    tail_share: float
    """Part of the force by the oil upstream of the grid [-]."""
    closure_error: float
    """Moment of the pressure over that by the flow, on the grid, less one [-]."""
    T: float
    """F/(E' R) W^(-3/2) [-]: the T* of published formulas."""


def rolling_friction(result: Solution) -> Rolling | None:
    """Return the rolling friction of a line contact; None for other shapes and without a film."""
    problem = result.problem
    if not problem.contact.is_line or not result.scaled.film.min() > 0.0:
        return None
    x, pressure, film = result.scaled.x, result.scaled.pressure[0], result.scaled.film[0]
    upstream = NOTHING
    if result.oil is None or result.oil.fill[0, 0] == 1.0:  # the oil reaches further upstream
        peak = int(np.argmax(pressure))
        density = problem.lubricant.density.density(
            result.pressure[0, peak], result.scales.temperature
        )
        flux = float(density) / result.scales.density * film[peak]
        entering = result.scaled_problem.entering
        upstream = beyond(float(x[0]), float(film[0]), min(flux, float(film[0])), entering)
    flow, ratio = rolling(x, pressure, film, upstream)
    scales, groups = result.scales, result.groups
    force = 0.5 * flow * scales.hertz_pressure * scales.film_thickness
    arm = flow * scales.hertz_pressure * scales.half_width_x**2
    load = problem.shape.load_unit(problem.radius_x, problem.reduced_modulus)
    return Rolling(
        force=force,
        moment=arm,
        shift=arm / result.load,
        tail_share=upstream.rolling / flow,
        closure_error=ratio - 1.0,
        T=force / load * groups.W**-1.5,
    )
