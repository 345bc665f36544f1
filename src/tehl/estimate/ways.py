"""Rigid motion of surfaces in their plane: how far they have moved and turned between two times."""

import math
from collections.abc import Iterable
from functools import cache
from typing import NamedTuple, TypeVar

import numpy as np

from tehl.base.typing import Array

Number = TypeVar("Number", float, Array)
Velocity = tuple[float, float]
"""Components at the centre of the contact over u_m."""


class Way(NamedTuple):
    """A motion between two times: of a point at (x, y) to ``R(turn) (x, y) + (along, across)``."""

    along: float
    across: float = 0.0
    """[a_x]."""
    turn: float = 0.0
    """Angle from x to y [rad]."""

    def back(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Return where the points were that are at ``x``, ``y`` now [a_x].

        Parameters
        ----------
        x, y : Array
            Places that broadcast [a_x].
        """
        there = x - self.along, y - self.across
        if self.turn == 0.0:
            return there
        return _turned(-self.turn, *there)

    def after(self, first: "Way") -> "Way":
        """Return the motion ``first`` with this one after it."""
        along, across = first.along, first.across
        if self.turn != 0.0:
            along, across = _turned(self.turn, along, across)
        return Way(self.along + along, self.across + across, self.turn + first.turn)

    def since(self, earlier: "Way") -> "Way":
        """Return the motion from the end of an earlier one on; both begin together.

        Parameters
        ----------
        earlier : Way
            Of the same surface.
        """
        turn, along, across = self.turn - earlier.turn, earlier.along, earlier.across
        if turn != 0.0:
            along, across = _turned(turn, along, across)
        return Way(self.along - along, self.across - across, turn)


def steady_way(velocity: Velocity, spin: float, time: float) -> Way:
    """Return the motion of a surface at constant velocity and spin.

    The points move along circles about the place at rest,
    ``int_0^t R(spin s) ds (u, v) = sin(a)/spin (u, v) + (1 - cos(a))/spin (-v, u)`` with the angle
    a = spin t.

    Parameters
    ----------
    velocity, spin : (float, float), float
        At the centre over u_m, and angular velocity times a_x/u_m.
    time : float
        Duration, negative before the start [a_x/u_m].
    """
    (u, v), turn = velocity, spin * time
    if turn == 0.0:
        return Way(u * time, v * time)
    along, aside = math.sin(turn) / spin, 2.0 * math.sin(0.5 * turn) ** 2 / spin
    return Way(u * along - v * aside, v * along + u * aside, turn)


def way_of(velocities: Iterable[Velocity], spin: float, step: float) -> Way:
    """Return the motion of a surface in a time step in which its velocity changes.

    Parameters
    ----------
    velocities : iterable of (float, float)
        At `parts_of_step`.
    spin : float
        Angular velocity times a_x/u_m.
    step : float
        Time step [a_x/u_m].
    """
    along = across = 0.0
    for (node, weight), velocity in zip(_nodes_of_gauss(), velocities, strict=True):
        left = spin * step * (1.0 - node)
        u, v = _turned(left, *velocity) if left != 0.0 else velocity
        along += weight * step * u
        across += weight * step * v
    return Way(along, across, spin * step)


def parts_of_step() -> tuple[float, ...]:
    """Return the parts of a time step, from 0 to 1, at which `way_of` takes velocities."""
    return tuple(node for node, _ in _nodes_of_gauss())


@cache
def _nodes_of_gauss() -> tuple[tuple[float, float], ...]:
    """Return four nodes and weights of Gauss on 0 to 1: of eighth order in the step."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    return tuple(zip((0.5 * (nodes + 1.0)).tolist(), (0.5 * weights).tolist(), strict=True))


def _turned(angle: float, x: Number, y: Number) -> tuple[Number, Number]:
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * x - sine * y, sine * x + cosine * y
