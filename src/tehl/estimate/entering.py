"""Oil that enters between bodies of another temperature: what of its own it has kept."""

import math

import numpy as np

from tehl.base.typing import Array
from tehl.contact.options import Domain
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.inlet_heating import wilson_sheu
from tehl.estimate.scaling import ScaledProblem

THIN_FILM_ERROR, THICK_FILM_ERROR = 0.008, 0.8
"""Error of the film per unit of ln(viscosity) that the oil has still to gain or lose in the domain:
of a thin film at the least distance of the inlet edge, and of a thick one at three widths s."""
DISTANCE, WIDTHS = 3.4, 3.0
"""These distances: in Hertz half-widths, and in widths s."""
REVERSE_FLOW_ERROR = 0.03
"""Error of the film of a line, per root of its reduction by inlet heating, at 3.3 distances where
the undeformed gap is the film: oil that flows back heats the inlet far upstream, and no oil flows
aside. Lines of 0.3 to 1 GPa, 3 to 30 m/s, against domains of 20 such distances: 0.005 to 0.025; at
5 and 8 distances less by the square."""
POINT_REVERSE_FLOW_ERROR = 0.065
"""The same of a point contact, per part that inlet heating leaves of the film and part that it
takes: 0.041 to 0.065 of six contacts (M = 2 to 255, L = 18 to 30, a_y/a_x = 1 to 15) that lose 17
to 61 %, against domains of twice or three times their distance."""


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
    M = 3, 100 and 500 with bodies 20 to 25 K off: 13, 1.0 and 0.7 %.

    Parameters
    ----------
    scaled : ScaledProblem
        Its ``groups`` hold at the inlet temperature of the oil, ``entering`` at that of the bodies.
    domain : Domain
        The distance of the inlet edge decides, in Hertz half-widths.
    """
    contrast = body_contrast(scaled)
    heated = _reverse_flow_error(scaled, domain)
    if not contrast:
        return heated
    inlet = -domain.x[0]
    kept = float(kept_part(scaled, inlet, np.zeros(1))[0])
    thick = THICK_FILM_ERROR * (WIDTHS * math.sqrt(2.0 * _film(scaled)) / inlet) ** 3
    return heated + contrast * kept * (THIN_FILM_ERROR * (DISTANCE / inlet) ** 2 + thick)


def body_contrast(scaled: ScaledProblem) -> float:
    """Return |ln(viscosity at the bodies over that at the inlet)|; zero if they are as warm [-]."""
    return abs(math.log(scaled.entering.lambda_bar / scaled.groups.lambda_bar))


def _reverse_flow_error(scaled: ScaledProblem, domain: Domain) -> float:
    """Return the error by the heat of oil that flows back upstream of the domain, as if rolling."""
    loading = scaled.problem.thermal_loading if scaled.problem.thermal is not None else None
    if loading is None:
        return 0.0
    distances = -domain.x[0] / math.sqrt(2.0 * _film(scaled)) / 3.3
    left = wilson_sheu(loading, 0.0)
    if scaled.groups.shape.as_line:
        return REVERSE_FLOW_ERROR * math.sqrt(1.0 - left) / distances**2
    return POINT_REVERSE_FLOW_ERROR * left * (1.0 - left) / distances**2


def _film(scaled: ScaledProblem) -> float:
    return expected_central_film(scaled.entering)
