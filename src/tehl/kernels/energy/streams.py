"""Rise of a surface along the paths of its points: exponentials that go from station to station.

Equation and weights in `tehl.operators.stream_source`.
"""

import math
from typing import NamedTuple

from tehl.base.typing import Array, IntArray
from tehl.kernels.compiled import helper, kernel
from tehl.kernels.raw import raw

SMALL_DECAY = 1e-2  # below it averages are series, where the closed form cancels


class Paths(NamedTuple):
    """Where the points at station i + 1 were at station i: rows and weights, (4, stations, ny).

    ``steps`` (stations, ny) are the times in between over those at the centre.
    """

    rows: IntArray
    weights: Array
    steps: Array


class Modes(NamedTuple):
    """Weights and rates of the exponentials, (m,), and what is carried, (2, ny, m + 1).

    After the exponentials each point carries the flux. ``table`` (3, m) has the decay over the last
    step, and the parts of the older and of the newer flux.
    """

    weight: Array
    rate: Array
    carried: Array
    table: Array


@kernel
def follow(flux: Array, paths: Paths, modes: Modes, rise: Array) -> None:
    """Write the rise under a flux, both (nx, ny), over the factor and the root of the mesh width.

    ``modes.carried`` is overwritten.
    """
    flux, paths, modes, rise = raw((flux, paths, modes, rise))
    (nx, ny), count, carried, last = flux.shape, modes.rate.shape[0], modes.carried, -1.0
    for j in range(ny):
        rise[0, j] = 4.0 / 3.0 * flux[0, j]
        for m in range(count):
            carried[0, j, m] = 0.0
        carried[0, j, count] = flux[0, j]
    for i in range(1, nx):
        now, before = i % 2, (i - 1) % 2
        for j in range(ny):
            step = paths.steps[i - 1, j]
            if step != last:
                _fill_table(modes, step)
                last = step
            rise[i, j] = _arrive(flux[i, j], paths, modes, (i - 1, j), (before, now))


@helper
def _arrive(
    flux: float, paths: Paths, modes: Modes, place: tuple[int, int], times: tuple[int, int]
) -> float:
    """Carry the exponentials to a point, and return its rise."""
    (i, j), (before, now) = place, times
    carried, table, count = modes.carried, modes.table, modes.rate.shape[0]
    a, b = paths.rows[0, i, j], paths.rows[1, i, j]
    c, d = paths.rows[2, i, j], paths.rows[3, i, j]
    of_a, of_b = paths.weights[0, i, j], paths.weights[1, i, j]
    of_c, of_d = paths.weights[2, i, j], paths.weights[3, i, j]
    older = of_a * carried[before, a, count] + of_b * carried[before, b, count]
    older += of_c * carried[before, c, count] + of_d * carried[before, d, count]
    found = math.sqrt(paths.steps[i, j]) * (4.0 / 3.0 * flux + 2.0 / 3.0 * older)
    for m in range(count):
        mode = of_a * carried[before, a, m] + of_b * carried[before, b, m]
        mode += of_c * carried[before, c, m] + of_d * carried[before, d, m]
        mode *= table[0, m]
        found += mode
        carried[now, j, m] = mode + table[1, m] * older + table[2, m] * flux
    carried[now, j, count] = flux
    return found


@helper
def _fill_table(modes: Modes, step: float) -> None:
    """Fill the table for a step: int_0^1 exp(-d t) dt and the same with 1 - t, d the decay.

    As `tehl.operators.line_source.averages`, which is for all rates at once.
    """
    for m in range(modes.rate.shape[0]):
        decay = modes.rate[m] * step
        left = math.exp(-decay)
        if decay < SMALL_DECAY:
            first = 0.5 - decay / 6 + decay**2 / 24 - decay**3 / 120
            total = 1 - decay / 2 + decay**2 / 6 - decay**3 / 24
        else:
            first = (decay - 1 + left) / decay**2
            total = (1 - left) / decay
        modes.table[0, m] = left
        modes.table[1, m] = modes.weight[m] * step * (total - first)
        modes.table[2, m] = modes.weight[m] * step * first
