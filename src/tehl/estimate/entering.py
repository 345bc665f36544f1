"""Oil that enters between bodies of another temperature: what of its own it has kept."""

import math

import numpy as np

from tehl.base.typing import Array
from tehl.contact.options import Domain
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.inlet_heating import wilson_sheu
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.starvation import is_starved

THIN_FILM_ERROR, THICK_FILM_ERROR = 0.008, 0.8
"""Error of the film per unit of ln(viscosity) that the oil has still to gain or lose in the domain:
of a thin film at the least distance of the inlet edge, and of a thick one at three widths s."""
DISTANCE, WIDTHS = 3.4, 3.0
"""These distances: in Hertz half-widths, and in widths s."""
SLOWEST, WARMED_MARGIN = 0.1, 1.2
"""Least speed of a surface that warms upstream, over the entrainment speed; and margin, as the gap
of a dry contact is 0.8 of the parabola at X = -3.4. Without it 17 lines (M = 3 to 200, between
glass, steel, bronze, ceramics or peek) lose 0.08 to 1 of the film that is estimated, with that of
the far field, and a circle that loses half of its film by heat 1.1. Two others lose 0.008 %, and
with asperities (M = 259) 0.35 %, where it is less than 0.001 and 0.04 %."""

THIN_LOSES, THICK_LOSES = 0.65, 0.35
"""Error of the film of a point contact by that heat over `_film_lost` of a line, of a thin film,
and more of it for each unit of H up to one. As judged on domains two and three times as wide, 24
contacts with M = 3 to 560, L = 0.7 to 22 and a_y/a_x = 0.7 to 2.7 err by 0.04 to 0.6 of it where H
is below one, and by 0.4 to 0.95 where it is not."""


def film_peclet(scaled: ScaledProblem) -> float:
    """Return rho c u_m H_unit^2 / (k a_x), convection along over conduction across the film [-]."""
    lubricant, scales = scaled.problem.lubricant, scaled.scales
    conductivity = lubricant.ambient_conductivity or 1.0
    capacity = lubricant.ambient_heat_capacity or 0.0
    along = scales.speed / scales.half_width_x
    return scales.density * capacity * along * (scales.film_thickness**2 / conductivity)


def kept_part(scaled: ScaledProblem, inlet: float, y: Array) -> Array:
    """Return which part of T - T_b oil has kept when it enters the domain, of the shape of y [-].

    Upstream the oil passes the parabolic gap  H = (X^2 + s^2)/2,  s^2 = D kappa^2 Y^2 + 2 H_c,  and
    takes the temperature T_b of the bodies: in plug flow  dT/dX = -pi^2/(Pe H^2) (T - T_b).

    Parameters
    ----------
    scaled : ScaledProblem
        With the expected film H_c and the thermal properties of the oil.
    inlet : float
        Distance of the inlet edge [half-widths].
    y : array
        Y of rows [half-widths].
    """
    groups, peclet = scaled.entering, film_peclet(scaled)
    if not peclet:
        return np.ones(y.shape)
    s = np.sqrt(groups.shape.across * y**2 + 2 * _film(scaled))
    distance = 2.0 / s**3 * np.arctan2(s, inlet) - 2.0 * inlet / (s**2 * (inlet**2 + s**2))
    kept: Array = np.exp(-(np.pi**2) / peclet * distance)
    return kept


def entry_error(scaled: ScaledProblem, domain: Domain) -> float:
    """Estimate the relative error of the film by what warms or cools oil upstream of the domain.

    Bodies of another temperature do, and the heat of the inlet. Measured on wider domains for
    M = 3, 100 and 500 with bodies 20 to 25 K off: 13, 1.0 and 0.7 %. Scarce oil fills no gap there.

    Parameters
    ----------
    scaled : ScaledProblem
        Its ``groups`` hold at the inlet temperature of the oil, ``entering`` at that of the bodies.
    domain : Domain
        The distance of the inlet edge decides, in Hertz half-widths.
    """
    if is_starved(scaled):
        return 0.0
    contrast = body_contrast(scaled)
    inlet = -domain.x[0]
    heated = _film_lost(scaled, inlet)
    if not contrast:
        return heated
    kept = float(kept_part(scaled, inlet, np.zeros(1))[0])
    thick = THICK_FILM_ERROR * (WIDTHS * math.sqrt(2.0 * _film(scaled)) / inlet) ** 3
    return heated + contrast * kept * (THIN_FILM_ERROR * (DISTANCE / inlet) ** 2 + thick)


def body_contrast(scaled: ScaledProblem) -> float:
    """Return |ln(viscosity at the bodies over that at the inlet)|; zero if they are as warm [-]."""
    return abs(math.log(scaled.entering.lambda_bar / scaled.groups.lambda_bar))


def warmed_upstream(scaled: ScaledProblem, inlet: float) -> tuple[float, float]:
    """Return by what shear upstream of the domain warms both surfaces where the film is loaded [K].

    Far upstream in the gap  h = h_s X^2/2  of a line, shear generates  (12 u^2 + du^2) eta/h  per
    area where the surfaces slide with du. Each surface takes half, and comes to the contact warmer
    by

        (8 u^2 + 2/3 du^2) eta/h_s (a_x/(pi k rho c u_s))^(1/2) |X|^(-3/2),

    with a margin, `WARMED_MARGIN`.
    As oil of a point contact flows aside, its pressure rises by 3/(3 + 2 D) of that of a line.

    Parameters
    ----------
    scaled : ScaledProblem
        With the viscosity of the oil, and both solids.
    inlet : float
        Distance of the inlet edge [half-widths].
    """
    problem, scales, groups, moment = scaled.problem, scaled.scales, scaled.entering, scaled.moment
    aside = 1.0 if groups.shape.as_line else 3.0 / (3.0 + 2.0 * groups.radius_ratio)
    rolls = 8.0 * aside**2 * moment.speed**2
    slides = 2.0 / 3.0 * (moment.sliding**2 + moment.across**2)
    stress = problem.ambient_viscosity * scales.speed / scales.film_thickness
    generated = WARMED_MARGIN * (rolls + slides) * scales.speed * stress * inlet**-1.5
    first, second = (
        generated * math.sqrt(scales.half_width_x / (math.pi * takes)) if takes else 0.0
        for takes in _taking(scaled)
    )
    return first, second


def heat_across(scaled: ScaledProblem, warmer: float) -> float:
    """Return the heat from one surface, warmer by ``warmer`` [K], to the other [W; line: W/m].

    It passes the film over the area of the dry contact, and both surfaces, which a flux q warms by
    2 q (x/(pi k rho c u_s))^(1/2)  at the distance x, in the mean by two thirds of that at the end.
    """
    conductivity = scaled.problem.lubricant.ambient_conductivity
    taking = _taking(scaled)
    if conductivity is None or not all(taking):
        return 0.0
    scales, shape = scaled.scales, scaled.entering.shape
    path = 2.0 * scales.half_width_x / math.pi
    resistance = _film(scaled) * scales.film_thickness / conductivity
    resistance += sum(4.0 / 3.0 * math.sqrt(path / takes) for takes in taking)
    width = 1.0 if shape.as_line else scales.half_width_y
    return abs(warmer) * shape.area * scales.half_width_x * width / resistance


def _taking(scaled: ScaledProblem) -> list[float]:
    """Return k rho c u_s of both surfaces, zero where the case does not state it."""
    problem, found = scaled.problem, []
    surfaces = problem.surface_1, problem.surface_2
    for surface, part in zip(surfaces, scaled.moment.speeds, strict=True):
        solid, speed = surface.material, scaled.scales.speed * max(abs(part), SLOWEST)
        stated = solid.conductivity, solid.density, solid.heat_capacity
        found.append(math.prod(value or 0.0 for value in stated) * speed)
    return found


def _film_lost(scaled: ScaledProblem, inlet: float) -> float:
    """Return the error of the film by the heat of the oil that is sheared upstream of the domain.

    Oil beside a surface that is warmer is thinner by b times that.
    """
    problem = scaled.problem
    loading = problem.thermal_loading if problem.thermal is not None else None
    if loading is None:
        return 0.0
    thinner = problem.temperature_coefficient * sum(warmed_upstream(scaled, inlet)) / 2.0
    left, is_line = wilson_sheu(loading, 0.0), scaled.entering.shape.as_line
    part = 1.0 if is_line else min(THIN_LOSES + THICK_LOSES * left * _film(scaled), 1.0)
    return part * left * thinner


def _film(scaled: ScaledProblem) -> float:
    return expected_central_film(scaled.entering)
