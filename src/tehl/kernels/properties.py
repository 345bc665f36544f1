"""Flow properties of the film: conductance and density at its pressure and thickness.

Dimensionless fields of shape (ny, nx), x along entrainment: ``p, h`` pressure and film,
``eps = rho h^3/(eta lambda)`` the conductance, ``rho`` the density. The laws of the lubricant are
cubic Hermite interpolation in a table over the pressure with columns rho/(eta lambda), its slope
times ``step``, rho, its slope times ``step`` (`tehl.operators.flow`).
"""

from typing import NamedTuple

import numpy as np

from tehl.kernels.compiled import helper, kernel
from tehl.kernels.raw import raw
from tehl.typing import Array, FlagArray

FOLLOWING, FOLLOWED = 20, 0.01
"""Most steps of Newton's method for the pressure of asperities, and the last over their sum."""


class Film(NamedTuple):
    """Pressure, film and the frozen flow properties on one grid, each (ny, nx).

    ``eps_x, eps_y`` are the conductances along x and y: ``eps`` itself, or those of a small change
    of the pressure gradient at constant sliding speed if the film thins in shear
    (`tehl.kernels.reynolds.tangent_source`). Where oil is conserved (`Stencil.conserves`),
    ``partial`` marks the cavitated nodes whose gap is partly filled, ``second`` the nodes that
    pass on oil with second order, and ``layer`` (ny,) is the oil that enters each line.

    With asperities finer than the grid ``p`` is the pressure of the oil, ``asperity`` theirs and
    ``stiffness`` its slope -dp_a/dH by the separation H of the mean planes; ``h`` is the mean gap
    and ``opening`` dh/dH; ``channel`` is the thickness that conducts along x, and ``across`` the
    conductance along y over that along x, without elements where that is one. Where one surface is
    rougher and both slide, ``carried`` is what they carry over h: ``rho`` is that times the
    density, and ``opening`` its slope by H over it. Without asperities they have no elements, and h
    is H.
    """

    p: Array
    h: Array
    eps: Array
    rho: Array
    drho: Array
    eps_x: Array
    eps_y: Array
    partial: FlagArray = np.zeros((0, 0), np.uint8)
    second: FlagArray = np.zeros((0, 0), np.uint8)
    layer: Array = np.zeros(0)
    asperity: Array = np.zeros((0, 0))
    stiffness: Array = np.zeros((0, 0))
    opening: Array = np.zeros((0, 0))
    channel: Array = np.zeros((0, 0))
    across: Array = np.zeros((0, 0))
    carried: Array = np.zeros((0, 0))


class Factors(NamedTuple):
    """Effect of heat and shear thinning on the flow, each (ny, nx).

    The mobility is ``rest`` plus ``mobility`` times the isothermal Newtonian one; the tangent
    mobilities are ``stretch_x`` and ``stretch_y`` times that; ``density`` is a factor too
    (docs/theory/numerics-thermal.md, coupling with the film).
    """

    rest: Array
    mobility: Array
    density: Array
    stretch_x: Array
    stretch_y: Array


class Heated(NamedTuple):
    """Flow properties from the energy equation, each (ny, nx).

    ``mobility``, rho/(eta lambda), and ``density`` of the heated, sheared film, scaled as those of
    the table; ``over_exponent`` = 1/n at mid-film, n = dln(rate)/dln(stress), the part of the
    mobility that follows the isothermal one; ``stretch_x, stretch_y`` as in `Factors`.
    """

    mobility: Array
    density: Array
    over_exponent: Array
    stretch_x: Array
    stretch_y: Array


@helper
def _line_properties(film: Film, table: Array, step: float, floor: float, j: int) -> None:
    """Fill ``eps, rho, drho`` of line ``j``; see `properties`."""
    last, per_step = table.shape[0] - 2, 1.0 / step
    thickness = film.channel if film.channel.shape[0] > 0 else film.h
    for i in range(film.p.shape[1]):
        x = film.p[j, i] * per_step
        x = x if x > 0.0 else 0.0  # also of a pressure that is not a number
        k = int(min(x, last))
        t = min(x - k, 1.0)
        s = 1.0 - t
        start, rise, end, fall = table[k, 0], table[k, 1], table[k + 1, 0], table[k + 1, 1]
        low, high = start + t * (rise + 2.0 * start), end + s * (2.0 * end - fall)
        thick = max(thickness[j, i], floor)
        film.eps[j, i] = (s * s * low + t * t * high) * (thick * thick * thick)
        start, rise, end, fall = table[k, 2], table[k, 3], table[k + 1, 2], table[k + 1, 3]
        low, high = start + t * (rise + 2.0 * start), end + s * (2.0 * end - fall)
        film.rho[j, i] = s * s * low + t * t * high
        film.drho[j, i] = (s * rise + t * fall) * per_step


@kernel
def properties(film: Film, table: Array, step: float, floor: float) -> None:
    """Fill ``eps, rho, drho`` from ``p, h``.

    Parameters
    ----------
    film : Film
        Fields (ny, nx).
    table : array (n, 4)
        Mobility, its slope times ``step``, density, its slope times ``step``, row by row.
    step : float
        Difference of pressure of two rows of ``table`` [-].
    floor : float
        Least film in ``eps`` [-].
    """
    film, table = raw((film, table))
    for j in range(film.p.shape[0]):
        _line_properties(film, table, step, floor, j)


@kernel
def touch(
    film: Film, separation: Array, table: Array, grid: Array, frozen: FlagArray, reach: float
) -> None:
    """Fill the fields of the asperities from the separation H of the mean planes.

    Parameters
    ----------
    film : Film
        Fields (ny, nx). The sum of ``p`` and ``asperity`` stays as it is; where the oil is
        cavitated, p = 0, or frozen, p stays.
    separation : array (ny, nx)
        H [-].
    table : array (n, 6) or (n, 8) or (n, 10)
        Pressure, mean gap, channel and, if they matter, conductance along y over that along x, and
        what the surfaces carry over the gap, over H, each with its slope times the step.
    grid : array (3,)
        H of the first row, step, and H from which no asperities touch: there the pressure is zero
        and the mean gap is H [-].
    frozen : array (ny, nx)
        1 where ``p`` stays.
    reach : float
        Film of a smooth change of pressure over that change, by which asperities that lead follow
        less; below zero ``p`` stays everywhere.
    """
    film, separation, table, grid, frozen = raw((film, separation, table, grid, frozen))
    first, per_step, apart = grid[0], 1.0 / grid[1], grid[2]
    for j in range(film.p.shape[0]):
        for i in range(film.p.shape[1]):
            gap = separation[j, i]
            x, pressure, fall, opening = (gap - first) * per_step, 0.0, 0.0, 1.0
            if gap < apart:  # not of NaN
                k = int(max(x, 0.0))
                pressure, fall = _hermite(table, k, x - k, 0)
                gap, opening = _hermite(table, k, x - k, 2)
                fall, opening = fall * per_step, opening * per_step
            missing = pressure - film.asperity[j, i]
            if reach >= 0.0 and film.p[j, i] != 0.0 and frozen[j, i] == 0:
                film.p[j, i] = max(film.p[j, i] - missing, 0.0)
            elif reach > 0.0 and missing != 0.0:
                q = film.asperity[j, i]
                missing = _followed(table, (x, reach * per_step), q, (missing, reach * fall))
            if missing != 0.0:  # else the field is not written: memory limits the speed
                film.asperity[j, i] += missing
            film.stiffness[j, i] = -fall
            film.h[j, i] = gap
            film.opening[j, i] = opening
        _line_channel(film, separation, table, grid, j)


@helper
def _line_channel(film: Film, separation: Array, table: Array, grid: Array, j: int) -> None:
    """Fill what asperities change in the flow of line ``j``; ``h, opening`` are known."""
    first, per_step, last = grid[0], 1.0 / grid[1], table.shape[0] - 2
    columns = table.shape[1]
    for i in range(film.p.shape[1]):
        channel, across, carried, more = separation[j, i], 1.0, 1.0, 0.0
        x = (channel - first) * per_step
        if x < last:  # else far apart, or NaN
            k = int(max(x, 0.0))
            channel = _hermite(table, k, x - k, 4)[0]
            if columns > 6:
                across = _hermite(table, k, x - k, 6)[0]
            if columns > 8:
                carried, more = _hermite(table, k, x - k, 8)
        film.channel[j, i] = channel
        if columns > 6:
            film.across[j, i] = across
        if columns > 8:
            film.opening[j, i] += film.h[j, i] * more * per_step / carried
            film.carried[j, i] = carried


@helper
def _followed(
    table: Array, place: tuple[float, float], q: float, law: tuple[float, float]
) -> float:
    """Return the change m of an asperity pressure q with  q + m = P_a(H + reach m).

    A smooth change moves the film too, by ``reach`` times that change. As P_a falls with H, there
    is one m; linearised, it may be many times too large.

    Parameters
    ----------
    table : array
        As for `touch`.
    place : (float, float)
        H and reach, in rows of the table.
    q : float
        Present pressure.
    law : (float, float)
        P_a(H) - q, and reach times the slope of P_a at H.
    """
    (x, reach), (left, slope), last = place, law, table.shape[0] - 2
    more = 0.0
    for _ in range(FOLLOWING):
        step = left / (1.0 - slope)
        if abs(step) <= FOLLOWED * abs(more):
            break
        more += step
        at = x + reach * more
        pressure, rise = 0.0, 0.0
        if at < last:
            k = int(max(at, 0.0))
            pressure, rise = _hermite(table, k, at - k, 0)
        slope, left = reach * rise, pressure - q - more
    return more


@helper
def _hermite(table: Array, k: int, t: float, column: int) -> tuple[float, float]:
    """Return value, cubic between rows ``k`` and k + 1, and slope times step, linear there.

    Below the first row the value continues linearly.
    """
    start, rise = table[k, column], table[k, column + 1]
    if t < 0.0:
        return start + t * rise, rise
    end, fall, s = table[k + 1, column], table[k + 1, column + 1], 1.0 - t
    low, high = start + t * (rise + 2.0 * start), end + s * (2.0 * end - fall)
    return s * s * low + t * t * high, s * rise + t * fall


@kernel
def factors_of(heated: Heated, film: Film, table: Array, step: float, factors: Factors) -> None:
    """Fill ``factors`` at the pressures ``film.p``; ``eps, rho, drho`` are overwritten."""
    heated, film, table, factors = raw((heated, film, table, factors))
    for j in range(film.p.shape[0]):
        _line_properties(film, table, step, 0.0, j)
        for i in range(film.p.shape[1]):
            mobility, part = heated.mobility[j, i], heated.over_exponent[j, i]
            factors.rest[j, i] = mobility * (1.0 - part)
            factors.mobility[j, i] = mobility * part / film.eps[j, i]
            factors.density[j, i] = heated.density[j, i] / film.rho[j, i]
            factors.stretch_x[j, i] = heated.stretch_x[j, i]
            factors.stretch_y[j, i] = heated.stretch_y[j, i]


@kernel
def heated_properties(
    film: Film, factors: Factors, table: Array, step: float, floor: float
) -> None:
    """Fill ``eps, rho, drho, eps_x, eps_y`` of the heated, sheared film; see `properties`."""
    film, factors, table = raw((film, factors, table))
    for j in range(film.p.shape[0]):
        _line_properties(film, table, step, floor, j)
        _scale_line(film, factors, floor, j)


@helper
def _scale_line(film: Film, factors: Factors, floor: float, j: int) -> None:
    """Turn isothermal Newtonian properties of line ``j`` into those of the heated film."""
    nx = film.p.shape[1]
    thickness = film.channel if film.channel.shape[0] > 0 else film.h
    for i in range(nx):
        thick = max(thickness[j, i], floor)
        rest = factors.rest[j, i] * (thick * thick * thick)
        film.eps[j, i] = factors.mobility[j, i] * film.eps[j, i] + rest
    for i in range(nx):
        film.rho[j, i] *= factors.density[j, i]
        film.drho[j, i] *= factors.density[j, i]
    for i in range(nx):
        film.eps_x[j, i] = factors.stretch_x[j, i] * film.eps[j, i]
        film.eps_y[j, i] = factors.stretch_y[j, i] * film.eps[j, i]
