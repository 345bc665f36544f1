"""Surface temperature behind sources past which a surface moves in any direction, or turns.

At high solid Peclet numbers heat flows into the depth only, and each point of the surface keeps the
heat that it took on its way (Carslaw and Jaeger 1959, section 2.9),

    T - T_b = 1/sqrt(pi rho c k) int q(path at t - s)/sqrt(s) ds.

The paths are straight lines, or circles where the surface spins. They are followed from one station
along x to the next, with the exponentials of `tehl.operators.line_source`; in between all that a
point carries is interpolated along y by cubics.
"""

import numpy as np

from tehl.base.typing import Array
from tehl.kernels.energy import streams
from tehl.operators.line_source import exponentials

SLOWEST_ROW = 0.15
"""Least speed along x of a row over that at the centre: slower rows of a surface that spins lie
outside of the contact, where the film brings little heat."""


class StreamSource:
    """The rise of a surface along the paths of its points.

    Parameters
    ----------
    x, y : Array
        Nodes of the full domain in a_x, y the rows.
    factor : float
        Rise per flux integrated over the root of the distance at the centre, along x [K].
    slope : float
        Velocity along y over that along x at the centre [-].
    spin : float
        Angular velocity times a_x over the speed along x at the centre [-].
    """

    def __init__(self, x: Array, y: Array, factor: float, slope: float, spin: float) -> None:
        self.factor, self.spacing = factor, float(x[1] - x[0])
        middle = 0.5 * (x[1:] + x[:-1])[:, None]
        slopes = (slope + spin * middle) / row_speed(spin, y)
        back = y - 0.5 * self.spacing * slopes  # halfway from the last station
        steps = 1.0 / row_speed(spin, back)
        shift = self.spacing * (slope + spin * middle) * steps / (y[1] - y[0])
        place = np.arange(y.size) - shift
        first = np.floor(place).astype(int) - 1
        t = place - first - 1.0
        rows = np.clip(first[None] + np.arange(4)[:, None, None], 0, y.size - 1)
        weights = np.array(
            [
                -t * (t - 1.0) * (t - 2.0) / 6.0,
                (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
                -(t + 1.0) * t * (t - 2.0) / 2.0,
                (t + 1.0) * t * (t - 1.0) / 6.0,
            ]
        )
        self.paths = streams.Paths(rows, weights, steps)
        weight, rate = exponentials(x.size, min(1.0, float(steps.min())))
        self.modes = streams.Modes(
            weight, rate, np.empty((2, y.size, rate.size + 1)), np.empty((3, rate.size))
        )

    def rise(self, flux: Array) -> Array:
        """Return the rise [K] under a flux, both (nx, ny)."""
        rise = np.empty(flux.shape)
        streams.follow(np.ascontiguousarray(flux), self.paths, self.modes, rise)
        return np.asarray(self.factor * np.sqrt(self.spacing) * rise)


def row_speed(spin: float, y: Array) -> Array:
    """Return the speed along x over that at the centre, ``1 - spin y``, at least `SLOWEST_ROW`.

    Parameters
    ----------
    spin : float
        Angular velocity times a_x over the speed at the centre [-].
    y : Array
        Places across [a_x].
    """
    return np.maximum(1.0 - spin * y, SLOWEST_ROW)
