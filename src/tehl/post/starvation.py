"""Numbers of a starved film: how far it is starved, where it begins, what it leaves behind."""

import math
from dataclasses import dataclass

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.starvation import flooded_oil, is_starved, starved_part
from tehl.post.traction import slope_across
from tehl.result.solution import Solution


@dataclass(frozen=True, kw_only=True, slots=True)
class Starvation:
    """The film of a contact that a layer of oil supplies, beside that of the flooded contact."""

    ratio: float
    """r, oil that enters on y = 0 over what the flooded contact passes on at its centre [-]."""
    degree: float | None
    """Central film over that of the flooded contact [-]; None if that is not known."""
    degree_error: float | None
    """Error bar of the degree [-]: of both films; None without those."""
    degree_by_law: float
    """The same by r / (1 + r^3)^(1/3) for a circular contact [-]."""
    flooded_film: float | None
    """Central film of the flooded contact [m]."""
    meniscus: float | None
    """Where the film begins on y = 0 [m]; None if the gap is full at the inlet edge."""
    inlet_distance: float | None
    """From there to the edge of the Hertz contact [m]."""
    entering: float
    leaving: float
    """Oil on both surfaces together on y = 0, upstream and downstream of the contact [m]."""
    balance: float
    """Largest change of the oil flux over the sections across the flow, relative [-]."""

    @property
    def leaving_each(self) -> float:
        """Oil on each surface downstream, split evenly [m]."""
        return 0.5 * self.leaving


def starvation(result: Solution) -> Starvation | None:
    """Return the numbers of a starved film; None for a flooded one, and after divergence."""
    oil, supplied = result.oil, result.supplied
    if oil is None or supplied is None or result.problem.supply is None:
        return None
    if not result.film.minimum > 0.0 or result.status.kind == "diverged":
        return None
    unit, row = result.scales.film_thickness, result.scaled.centre[0]
    flooded = supplied.flooded_film
    # of the oil that enters: the supply stated is that of the first pass
    ratio = float(oil.entering[row]) / unit / flooded_oil(result.scaled_problem)
    if not is_starved(result.scaled_problem):
        ratio = math.inf
    begins = meniscus(result)[row]
    degree, error = None, None
    if flooded is not None:
        degree = result.film_scaled.central / flooded
        if result.errors is not None:
            error = degree * (result.errors.central + supplied.flooded_error)
    at = None if np.isnan(begins) else float(begins) * result.scales.half_width_x
    return Starvation(
        ratio=ratio,
        degree=degree,
        degree_error=error,
        degree_by_law=min(ratio, 1.0) if result.groups.shape.as_line else starved_part(ratio),
        flooded_film=None if flooded is None else flooded * unit,
        meniscus=at,
        inlet_distance=None if at is None else -at - result.scales.half_width_x,
        entering=float(oil.entering[row]),
        leaving=float(oil.leaving[row]),
        balance=supplied.balance,
    )


def meniscus(result: Solution) -> Array:
    """Return where the film begins on each line, (ny,) [half-widths].

    The cell ahead of the first film node i is partly filled: the film begins at
    ``x_i - dx (q - q_in) / (m - q_in)``, with the oil q that the cell holds, m if it were full, and
    the oil q_in that enters. NaN on lines without a film, and where it begins at the inlet edge.
    """
    found = np.full(result.scaled.y.size, np.nan)
    if result.oil is None:
        return found
    x, unit = result.scaled.x, result.scales.film_thickness
    for row, pressure in enumerate(result.scaled.pressure):
        wet = np.nonzero(pressure > 0.0)[0]
        if not wet.size or wet[0] < 2:
            continue
        ahead = wet[0] - 1
        full, entering = result.scaled.film[row, ahead], result.oil.entering[row] / unit
        held = result.oil.fill[row, ahead] * full
        part = (held - entering) / (full - entering) if full > entering else 0.0
        found[row] = x[wet[0]] - (x[1] - x[0]) * float(np.clip(part, 0.0, 1.0))
    return found


def oil_flux(result: Solution) -> tuple[Array, Array]:
    """Return the oil flux along x and y per width over the entrainment speed, (ny, nx) each [m].

    Wedge less pressure flow of the isothermal Newtonian oil; in cavities the oil moves along x.
    """
    problem, scales, scaled = result.problem, result.scales, result.scaled
    oil, temperature = problem.lubricant, scales.temperature
    pressure = result.pressure
    density = oil.density.density(pressure, temperature) / scales.density
    viscosity = oil.viscosity.viscosity(pressure, temperature)
    thick = result.film_thickness
    fill = np.ones(thick.shape) if result.oil is None else result.oil.fill
    conductance = density * thick**3 / (12.0 * viscosity * scales.speed)
    slope_y, slope_x = slope_across(result, pressure), np.gradient(pressure, result.x, axis=1)
    wet = scaled.pressure > 0.0
    along = density * fill * thick - np.where(wet, conductance * slope_x, 0.0)
    return along, np.where(wet, -conductance * slope_y, 0.0)
