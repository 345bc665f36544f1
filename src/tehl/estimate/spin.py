"""Spin of the mean motion: its number, and the error of a film by the load outside its domain."""

import math
from dataclasses import replace

import numpy as np

from tehl.base.typing import Array
from tehl.contact.options import Domain
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.scaling import Groups, ScaledProblem

LOAD_PER_E_FOLD = 1.6312
"""Load outside an ellipse that spins, over lambda S and the shape, as the radius grows by a factor
of e: 4/3 of ``P = lambda S (1 - D)/(3 (1 + D)) X E / G^2`` without cavitation in the rigid gap G,
1.2234 times as much with it, on all ellipses alike."""
LEFT_PART, SIDE_PART, FLOATS = 0.1, 0.006, 3.0
"""Error of the film over that part of the load and the width of the gap over the distance of the
inlet edge, and over S, as the sides are inlets too; and the load outside a thin film, over that of
the contact, at which it floats so high that it is unknown, by the eighth power: 55 contacts with
M = 3 to 100, a_y/a_x = 0.4 to 5, S = 0.05 to 1. Domains of twice the size change the film by 0.4 %
at most up to 1.8, by a quarter at 2.5; there and beyond most do not converge."""
DOMAIN_PART, LARGEST_BY_SPIN, LEAST_WIDTH = 0.3, 2.5, 0.68
"""Part of the error that the edges leave to it, largest factor on the domain because of it, and
least width of the gap."""
WHOLE_POOL, SQUARE = 1.5, 0.886
"""Radius out to which there is oil, over the distance of the inlet edge, up to which the domain has
all of it, and its edges over that radius: a square of the same area."""
NEAREST, FROM_WIDTHS, LEAST_LOAD_LEFT, PART_STEP = 5.0, 3.0, 0.1, 1e-4
"""Radius from which spin carries load outside of thin films [a_x], the same over the width of the
gap of thick ones; the least part of the load left to the contact, and the step of its logarithm."""
LESS_SPIN = (
    "State contact.flooded_radius if oil ends nearer, or take a higher load or less spin (the mean "
    "of contact.spin_1 and contact.spin_2): more of the load is then on the grid."
)
"""What helps where the load outside is too large."""


def spin_number(scaled: ScaledProblem) -> float:
    """Return S = omega a_x / u_m, omega the mean spin of both surfaces [-]."""
    return scaled.problem.motion.mean_spin * scaled.scales.half_width_x / scaled.scales.speed


def slowing(scaled: ScaledProblem, y: Array) -> Array:
    """Return what spin takes from the mean speed along x of some rows, over u_m, (n,).

    Parameters
    ----------
    scaled, y : ScaledProblem, Array
        The motion, and the rows [a_y].
    """
    spin = spin_number(scaled)
    return spin * scaled.groups.ellipticity * y if spin != 0.0 else np.zeros(y.size)


def spins(scaled: ScaledProblem) -> tuple[float, float, float]:
    """Return the same of the mean motion and of both surfaces [-]."""
    motion, unit = scaled.problem.motion, scaled.scales.half_width_x / scaled.scales.speed
    return spin_number(scaled), motion.spin_1 * unit, motion.spin_2 * unit


def sliding_field(scaled: ScaledProblem, x: Array, y: Array) -> tuple[Array, Array]:
    """Return both components of u_1 - u_2 over u_m at the moment, (ny, nx) or what broadcasts.

    Parameters
    ----------
    scaled : ScaledProblem
        The motion.
    x, y : Array
        Nodes along x [a_x] and y [a_y].
    """
    _, first, second = spins(scaled)
    spin, moment = first - second, scaled.moment
    if spin == 0.0:
        return np.array([[moment.sliding]]), np.array([[moment.across]])
    stretched = scaled.groups.ellipticity * y[:, None]
    return moment.sliding - spin * stretched, (moment.across + spin * x)[None, :]


def flooded_reach(scaled: ScaledProblem) -> float:
    """Return the radius out to which there is oil [a_x].

    The smaller of both radii of curvature unless another one is stated: farther out no body is a
    paraboloid.
    """
    problem = scaled.problem
    stated = problem.contact.flooded_radius
    radius = min(problem.radius_x, problem.radius_y) if stated is None else stated
    return radius / scaled.scales.half_width_x


def load_per_e_fold(scaled: ScaledProblem) -> float:
    """Return the load by spin of all places between a radius and e times it, over that of all.

    A paraboloid that spins about its axis moves no oil. The gap of an ellipse does, far from the
    contact as well. Nothing is beside the ends of a roller.
    """
    groups, spin = scaled.entering, abs(spin_number(scaled))
    if spin == 0.0 or scaled.problem.contact.has_lines:
        return 0.0
    ratio, twist = groups.radius_ratio, groups.twist / groups.ellipticity
    unequal = math.hypot(1.0 - ratio, 2.0 * twist) / ((ratio - twist**2) * (1.0 + ratio))
    load = LOAD_PER_E_FOLD * groups.lambda_bar * spin * unequal
    return load / (groups.ellipticity * groups.shape.load)


def left_by_spin(scaled: ScaledProblem) -> Groups:
    """Return the groups of the load that spin leaves to the contact.

    The film by the formula at that load begins to open where the load outside ends.
    """
    groups, per_fold = scaled.entering, load_per_e_fold(scaled)
    if per_fold == 0.0:
        return groups
    reach, low, high = flooded_reach(scaled), math.log(LEAST_LOAD_LEFT), 0.0
    while high - low > PART_STEP:  # the film falls with the load that is left
        part = math.exp(0.5 * (low + high))
        film = expected_central_film(replace(groups, M=part * groups.M))
        start = max(NEAREST, FROM_WIDTHS * math.sqrt(2.0 * film))
        if part + per_fold * max(math.log(reach / start), 0.0) > 1.0:
            high = math.log(part)
        else:
            low = math.log(part)
    return replace(groups, M=math.exp(high) * groups.M)


def outside_by_spin(scaled: ScaledProblem) -> float:
    """Return the part of the load that oil far from the contact carries, as spin moves it [-]."""
    return 1.0 - left_by_spin(scaled).M / scaled.entering.M


def ends_within(scaled: ScaledProblem, domain: Domain) -> bool:
    """Return whether oil around an ellipse that spins ends at the edges of the domain."""
    nearest = scaled.groups.ellipticity * min(map(abs, domain.y))
    return load_per_e_fold(scaled) > 0.0 and SQUARE * flooded_reach(scaled) <= 1.001 * min(
        nearest, *map(abs, domain.x)
    )


def spin_error(scaled: ScaledProblem, domain: Domain) -> float:
    """Return the relative error of the film by the oil outside a domain, as spin moves it."""
    load, spin = load_per_e_fold(scaled), abs(spin_number(scaled))
    near = max(math.sqrt(2.0 * expected_central_film(left_by_spin(scaled))), LEAST_WIDTH)
    return LEFT_PART * load * near / -domain.x[0] + _floating(scaled) + SIDE_PART * spin


def _floating(scaled: ScaledProblem) -> float:
    """Return the error of a film that the load outside lifts, see `FLOATS`."""
    outside = load_per_e_fold(scaled) * math.log(max(flooded_reach(scaled) / NEAREST, 1.0))
    return float((outside / FLOATS) ** 8)


def spun_domain(scaled: ScaledProblem, domain: Domain, error: float) -> Domain:
    """Return a domain on which spin leaves `DOMAIN_PART` of an error, and in which there is oil.

    Parameters
    ----------
    scaled, domain : ScaledProblem, Domain
        The contact, and the least domain, which is large enough without spin.
    error : float
        Relative error of the film by the edges [-].
    """
    if load_per_e_fold(scaled) == 0.0:
        return domain
    still = _floating(scaled) + SIDE_PART * abs(spin_number(scaled))
    factor = (spin_error(scaled, domain) - still) / (DOMAIN_PART * error)
    factor, reach = min(max(factor, 1.0), LARGEST_BY_SPIN), flooded_reach(scaled)
    x, y = ((factor * low, factor * high) for low, high in (domain.x, domain.y))
    if reach < WHOLE_POOL * -x[0]:
        edge = SQUARE * reach
        side = edge / scaled.groups.ellipticity
        x, y = (-edge, edge), (-side, side)
    return Domain.model_construct(x=x, y=y)
