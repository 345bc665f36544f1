"""Asperities finer than the grid: the pressure they carry, and how they change film and flow.

Their laws are cubic Hermite interpolation in tables over the separation H of the mean planes
(`tehl.operators.summits`), eight nodes at once (`tehl.kernels.lanes`).
"""

from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array, FlagArray
from tehl.kernels.compiled import helper, kernel
from tehl.kernels.lanes import LANES, any_of, greater, lesser, truncate, where
from tehl.kernels.properties import Film, FlowTable, interpolated, line_properties, shape_line
from tehl.kernels.raw import lanes, raw

MOST_ASPERITY_STEPS, LAST_STEP_OVER_SUM, SHORT_STEP_ROWS = 20, 0.01, 0.1
"""Newton's method for the pressure of dry asperities: most steps; last step over their sum; and
rows of the table that a step moves, times the slope dP_a/dP if above one, below which the next one
would be as small as that: within a row the slope changes by less than a fifth."""


class AsperityLaws(NamedTuple):
    """Laws over the separation H of the mean planes, each (n, 2): value and slope times step.

    ``pressure``, mean ``gap``, ``channel`` along x and, without elements where they are one, the
    conductance ``across`` over that along x and what the surfaces carry, ``carried``, over the gap.
    ``grid`` (3,): H of the first row, step, and H from which no asperities touch: there the
    pressure is zero and the mean gap is H [-].
    """

    pressure: Array
    gap: Array
    channel: Array
    grid: Array
    across: Array = np.zeros((0, 2))
    carried: Array = np.zeros((0, 2))


@kernel
def touch(
    film: Film,
    separation: Array,
    laws: AsperityLaws,
    flow: FlowTable,
    frozen: FlagArray,
    reach: float,
) -> None:
    """Fill the fields of the asperities from the separation H, and ``eps, rho, drho``.

    Parameters
    ----------
    film : Film
        Fields (ny, nx). The sum of ``p`` and ``asperity`` stays as it is; where the oil is
        cavitated, p = 0, or frozen, p stays.
    separation : array (ny, nx)
        H of the mean planes [-].
    laws, flow : AsperityLaws, FlowTable
        Of the asperities, and of the lubricant.
    frozen : array (ny, nx)
        1 where ``p`` stays.
    reach : float
        Film of a smooth change of pressure over that change, by which asperities that lead follow
        less; where it is infinite they keep their pressure; below zero ``p`` stays everywhere.
    """
    film, separation, laws, flow, frozen = raw((film, separation, laws, flow, frozen))
    for j in range(film.p.shape[0]):
        _evaluate(film, separation, laws, j)
        _share(film, separation, laws, frozen, (j, reach))
        line_properties(film, flow, 0.0, j)
        shape_line(film, film.eps, j)


@helper
def _evaluate(film: Film, separation: Array, laws: AsperityLaws, j: int) -> None:
    """Fill what depends on H alone in line ``j``; ``eps`` holds P_a meanwhile."""
    nx, last = film.p.shape[1], float(laws.channel.shape[0] - 2)
    first, per_step, apart = laws.grid[0], 1.0 / laws.grid[1], laws.grid[2]
    for start in range(0, nx, LANES):
        at = lanes(min(start, nx - LANES))
        height = separation[j, at]
        x = (height - first) * per_step
        near = x < last  # not of NaN
        touching = near & (height < apart)
        row = truncate(where(near, greater(x, 0.0), 0.0))
        # below the first row the laws continue linearly
        t, below = greater(x, 0.0) - row, lesser(x, 0.0)
        film.eps[j, at] = film.stiffness[j, at] = 0.0
        film.opening[j, at] = 1.0
        film.h[j, at] = film.channel[j, at] = height
        if any_of(touching):
            value, slope = interpolated(laws.pressure, row, t)
            film.eps[j, at] = where(touching, value + below * slope, 0.0)
            film.stiffness[j, at] = where(touching, -per_step * slope, 0.0)
            value, slope = interpolated(laws.gap, row, t)
            film.h[j, at] = where(touching, value + below * slope, height)
            film.opening[j, at] = where(touching, per_step * slope, 1.0)
        if any_of(near):
            value, slope = interpolated(laws.channel, row, t)
            film.channel[j, at] = where(near, value + below * slope, height)
        if laws.across.shape[0] > 0:
            value, slope = interpolated(laws.across, row, t)
            film.across[j, at] = where(near, value + below * slope, 1.0)
        if laws.carried.shape[0] > 0:
            value, slope = interpolated(laws.carried, row, t)
            value = value + below * slope
            film.carried[j, at] = where(near, value, 1.0)
            more = where(near, film.h[j, at] * slope * per_step / value, 0.0)
            film.opening[j, at] = film.opening[j, at] + more


@helper
def _share(
    film: Film,
    separation: Array,
    laws: AsperityLaws,
    frozen: FlagArray,
    place: tuple[int, float],
) -> None:
    """Let oil and asperities share the pressure of line j; ``place``: j and reach. See `touch`."""
    j, reach = place
    for i in range(film.p.shape[1]):
        missing = film.eps[j, i] - film.asperity[j, i]
        if reach >= 0.0 and film.p[j, i] != 0.0 and frozen[j, i] == 0:
            # those that change together take no more than the oil had; else the load would grow
            missing = min(missing, film.p[j, i]) if reach == np.inf else missing
            film.p[j, i] = max(film.p[j, i] - missing, 0.0)
        elif reach == np.inf:
            missing = 0.0
        elif reach > 0.0 and missing != 0.0:
            at, law = (separation[j, i], reach), (missing, -reach * film.stiffness[j, i])
            missing = _followed(laws, at, film.asperity[j, i], law)
        if missing != 0.0:  # else the field is not written
            film.asperity[j, i] += missing


@helper
def _followed(
    laws: AsperityLaws, place: tuple[float, float], q: float, law: tuple[float, float]
) -> float:
    """Return the change m of an asperity pressure q with  q + m = P_a(H + reach m).

    A smooth change moves the film too, by ``reach`` times that change. As P_a falls with H, there
    is one m; linearised, it may be many times too large.

    Parameters
    ----------
    laws : AsperityLaws
        Of the asperities.
    place : (float, float)
        H and reach.
    q : float
        Present pressure.
    law : (float, float)
        P_a(H) - q, and reach times the slope of P_a at H.
    """
    (height, reach), (left, slope), table, more = place, law, laws.pressure, 0.0
    first, per_step = laws.grid[0], 1.0 / laws.grid[1]
    for _ in range(MOST_ASPERITY_STEPS):
        step = left / (1.0 - slope)
        if abs(step) <= LAST_STEP_OVER_SUM * abs(more):
            break
        more += step
        if abs(reach * per_step * step) * max(1.0, abs(slope)) < SHORT_STEP_ROWS:
            break
        x = (height + reach * more - first) * per_step
        pressure, rise = 0.0, 0.0
        if x < table.shape[0] - 2:
            k = int(max(x, 0.0))
            t, start, rise = x - k, table[k, 0], table[k, 1]
            pressure = start + t * rise
            if t > 0.0:  # as `interpolated`
                end, fall, s = table[k + 1, 0], table[k + 1, 1], 1.0 - t
                low, high = pressure + 2.0 * t * start, end + s * (2.0 * end - fall)
                pressure, rise = s * s * low + t * t * high, s * rise + t * fall
        slope, left = reach * rise * per_step, pressure - q - more
    return more
