"""Spin of the mean motion: its number, and the error of a film by the load outside its domain."""

import math

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.scaling import ScaledProblem

LOAD_PER_E_FOLD = 1.6312
"""Load outside an ellipse that spins, over lambda S and the shape, as the radius grows by a factor
of e: 4/3 of ``P = lambda S (1 - D)/(3 (1 + D)) X E / G^2`` without cavitation in the rigid gap G,
1.2234 times as much with it, on all ellipses alike."""
LINEAR_PART, SIDE_PART = 0.1, 0.006
"""Error of the film over that part of the load, which adds to its square, and over S, as the sides
are inlets too: 90 contacts with M = 3 to 100, a_y/a_x = 1.3 to 5, S = 0.05 to 1 on domains of twice
the size."""


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


def spin_error(scaled: ScaledProblem) -> float:
    """Return the relative error of the film by what spin changes outside the domain.

    A paraboloid that spins about its axis moves no oil. The gap of an ellipse does, the more the
    farther out: its load grows with the logarithm of the radius, and is not on the grid. Nothing is
    beside the ends of a roller.
    """
    groups, spin = scaled.entering, abs(spin_number(scaled))
    ratio, twist = groups.radius_ratio, groups.twist / groups.ellipticity
    if spin == 0.0 or scaled.problem.contact.has_lines:
        return 0.0
    unequal = math.hypot(1.0 - ratio, 2.0 * twist) / ((ratio - twist**2) * (1.0 + ratio))
    load = LOAD_PER_E_FOLD * groups.lambda_bar * spin * unequal
    load /= groups.ellipticity * groups.shape.load
    return LINEAR_PART * load + load**2 + SIDE_PART * spin
