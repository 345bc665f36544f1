r"""Decay of a starved film by side flow, over many passes: the layer between them grows thinner.

In each pass the pressure of the contact squeezes oil sideways. Where the film is much thinner than
flooded, the layer h_s on each surface obeys [1]_

    dh_s/dt = -F h_s^3 / 3 + R / 2,        h_c = 2 h_s / rho_c,

    F = (2 / l) \int -p_yy / (rho^2 eta) dx     on y = 0,

with the length l of both running tracks, rho over the ambient density, and the replenishment R of
both surfaces together. For R = 0:  h_c(t) = (rho_c^2 F t / 6 + h_c(0)^-2)^(-1/2). The speed does
not matter. For the Hertz pressure and Barus oil of constant density the integral is nearly

    F = (2 / l) (p_h / b^2) (a / eta_0) pi ((pi alpha p_h / 2)^(3/2) + 1)^(-2/3).

References
----------
.. [1] M. T. van Zoelen, C. H. Venner and P. M. Lugt, Proc. IMechE Part J 224 (2010), 1171-1185.
"""

import math
from dataclasses import dataclass

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.hertz import HertzContact
from tehl.contact.problem import ContactProblem
from tehl.result.solution import Solution

PRESSURES = 4001
"""Steps of the integral of the reduced pressure, closest where oil flows."""
FITTED = 0.5
"""Half-widths beside the middle in which S is a polynomial of fourth order: F to 1 % on 129^2."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LayerDecay:
    """Central film over time by side flow."""

    rate: float
    """F by the pressure of the solved contact [1/(m^2 s)]."""
    rate_by_formula: float
    """F by the closed form for the Hertz pressure [1/(m^2 s)]."""
    start: float
    """Central film at time zero [m]."""
    density: float
    """Density in the middle of the contact over the ambient one [-]."""
    replenishment: float
    """Oil that comes back to both surfaces together [m/s]."""

    def film(self, time: Array, *, by_formula: bool = False) -> Array:
        """Return the central film at times since the start [m].

        Parameters
        ----------
        time : array
            Increasing from zero [s].
        by_formula : bool
            Whether F is that of the closed form.
        """
        rate = self.rate_by_formula if by_formula else self.rate
        decay = self.density**2 * rate / 6.0
        if not self.replenishment:
            found: Array = (decay * time + self.start**-2) ** -0.5
            return found
        return _with_replenishment(time, self.start, decay, self.replenishment / self.density)

    @property
    def limit(self) -> float:
        """Film at which as much oil comes back as is squeezed out, zero without it [m]."""
        decay = self.density**2 * self.rate / 6.0
        return (2.0 * self.replenishment / self.density / decay) ** (1.0 / 3.0)


def _with_replenishment(time: Array, start: float, decay: float, gain: float) -> Array:
    """Return h of  dh/dt = gain - decay h^3 / 2  at times [m]."""
    from scipy.integrate import solve_ivp  # noqa: PLC0415 (0.2 s, for replenished layers only)

    found = solve_ivp(  # of h over its start
        lambda _, h: gain / start - 0.5 * decay * start**2 * h**3,
        (0.0, float(time[-1])),
        [1.0],
        method="LSODA",
        t_eval=time,
        rtol=1e-8,
        atol=1e-10,
    )
    films: Array = found.y[0] * start
    return films


def _side_flow_rate(result: Solution, track: float) -> float:
    """Return F by the pressure of a result [1/(m^2 s)].

    Only the edges of the contact count, where oil still flows: a second difference there sees the
    mesh. The flow of a row is the derivative of its reduced pressure, which is smooth along y::

        F = -(2 / l) S_yy,    S(y) = int int_0^p dp / (rho^2 eta) dx
    """
    oil, temperature = result.problem.lubricant, result.scales.temperature
    steps = np.linspace(0.0, 1.0, PRESSURES) ** 2 * result.pressure.max()
    density = oil.density.density(steps, temperature) / result.scales.density
    ease = 1.0 / (density**2 * oil.viscosity.viscosity(steps, temperature))
    reduced = np.concatenate([[0.0], np.cumsum(0.5 * (ease[1:] + ease[:-1]) * np.diff(steps))])
    rows = np.trapezoid(np.interp(result.pressure, steps, reduced), result.x, axis=1)
    half_width = result.problem.hertz.half_width_y
    y = result.y / half_width
    near = np.abs(y) <= FITTED
    powers = y[near, None] ** np.array([0, 2, 4])
    bend = 2.0 * np.linalg.lstsq(powers, rows[near], rcond=None)[0][1] / half_width**2
    return float(-2.0 / track * bend)


def rate_by_formula(hertz: HertzContact, viscosity: float, alpha: float, track: float) -> float:
    """Return F by the closed form for the Hertz pressure [1/(m^2 s)].

    Parameters
    ----------
    hertz : HertzContact
        The dry contact.
    viscosity, alpha : float
        Ambient viscosity [Pa s] and pressure coefficient [1/Pa].
    track : float
        Length of both running tracks together [m].
    """
    thin = hertz.pressure / hertz.half_width_y**2 * hertz.half_width_x / viscosity * math.pi
    thick = (0.5 * math.pi * alpha * hertz.pressure) ** 1.5 + 1.0
    return 2.0 / track * thin * thick ** (-2.0 / 3.0)


def check_layer(problem: ContactProblem) -> None:
    """Raise InputError if the law of side flow does not hold for a contact, or lacks the track."""
    supply = problem.supply
    if supply is None or supply.track is None:
        raise InputError(
            'supply.track is missing: give the length of both running tracks, such as "250 mm"'
        )
    if problem.contact.has_lines:
        raise InputError(
            "contact.type: the law of side flow is for the rounded rim of a ball or an ellipse; a "
            "roller loses oil at its ends alone; take supply.passes"
        )
    if problem.radii.twist:
        raise InputError(
            "contact.entrainment_angle: oil flows across the middle of a track that is not "
            "symmetric, so one line does not tell how the layer thins; take supply.passes"
        )


def layer_decay(result: Solution) -> LayerDecay:
    """Return how the film of a result decays by side flow.

    Raises InputError where `check_layer` does.
    """
    problem, supply = result.problem, result.problem.supply
    check_layer(problem)
    assert supply is not None
    assert supply.track is not None
    scales, pressure = result.scales, result.scaled.at_origin(result.pressure)
    density = float(problem.lubricant.density.density(pressure, scales.temperature))
    return LayerDecay(
        rate=_side_flow_rate(result, supply.track),
        rate_by_formula=rate_by_formula(
            problem.hertz, problem.ambient_viscosity, problem.pressure_coefficient, supply.track
        ),
        start=result.film.central,
        density=density / scales.density,
        replenishment=supply.replenishment,
    )
