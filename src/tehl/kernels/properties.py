"""Flow properties of the film: conductance and density at its pressure and thickness.

Dimensionless fields of shape (ny, nx), x along entrainment: ``p, h`` pressure and film,
``eps = rho h^3/(eta lambda)`` the conductance, ``rho`` the density. The laws of the lubricant are
cubic Hermite interpolation in tables over the pressure (`tehl.operators.flow`), eight nodes at once
(`tehl.kernels.lanes`): lines have eight or more.
"""

from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array, FlagArray
from tehl.kernels.compiled import helper, kernel
from tehl.kernels.lanes import LANES, Lanes, greater, lesser, lookup, truncate, where
from tehl.kernels.raw import lanes, raw


class FlowTable(NamedTuple):
    """Isothermal mobility rho/(eta lambda) and density rho over the dimensionless pressure.

    ``mobility`` and ``density`` (n, 2) have value and slope times ``step``, the pressure between
    two rows, the first of which is at zero.
    """

    mobility: Array
    density: Array
    step: float


class Film(NamedTuple):
    """Pressure, film and the frozen flow properties on one grid, each (ny, nx).

    ``eps_x, eps_y`` are the conductances along x and y: ``eps`` itself, or those of a small change
    of the pressure gradient at constant sliding speed if the film thins in shear
    (`tehl.kernels.reynolds.tangent_source`). Where oil is conserved (`Stencil.conserves`),
    ``partial`` marks the cavitated nodes whose gap is partly filled, ``second`` the nodes that
    pass on oil with second order, and ``layer`` (ny,) is the oil that enters each line. Where the
    surfaces spin too, ``held`` is the oil that partly filled nodes hold: it comes from two sides.

    With asperities finer than the grid ``p`` is the pressure of the oil, ``asperity`` theirs and
    ``stiffness`` its slope -dp_a/dH by the separation H of the mean planes; ``h`` is the mean gap
    and ``opening`` dh/dH; ``channel`` is the thickness that conducts along x, and ``across`` the
    conductance along y over that along x, without elements where that is one. Where one surface is
    rougher and both slide, ``carried`` is what they carry over h: ``rho`` is that times the
    density, and ``opening`` its slope by H over it. Without asperities they have no elements, and h
    is H.

    Where the surfaces spin, ``speed`` (ny,) is the mean speed along x of each row over that at the
    centre, and ``drift`` (ny, nx) that along y, times dx over the distance of the rows: with it the
    differences along y have the weights of those along x. Without spin they have no elements.

    Where lines crowd at the ends of a roller, ``south`` and ``north`` (ny,) are the weights of the
    differences to the rows beside over those of uniform rows, else without elements.
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
    held: Array = np.zeros((0, 0))
    asperity: Array = np.zeros((0, 0))
    stiffness: Array = np.zeros((0, 0))
    opening: Array = np.zeros((0, 0))
    channel: Array = np.zeros((0, 0))
    across: Array = np.zeros((0, 0))
    carried: Array = np.zeros((0, 0))
    speed: Array = np.zeros(0)
    drift: Array = np.zeros((0, 0))
    south: Array = np.zeros(0)
    north: Array = np.zeros(0)

    def conducting(self, floor: float) -> Array:
        """Return the thickness that conducts along x, at least ``floor``, (ny, nx)."""
        found: Array = np.maximum(self.channel if self.channel.size else self.h, floor)
        return found


class Factors(NamedTuple):
    """Effect of heat and shear thinning on the flow, each (ny, nx).

    The mobility is ``rest`` plus ``mobility`` times the isothermal Newtonian one; the tangent
    mobilities are ``stretch_x`` and ``stretch_y`` times that; ``density`` is a factor too. The cube
    of the film counts as ``part`` of its own plus ``kept``, the rest of that of the last sweep
    (docs/theory/numerics-thermal.md, coupling with the film).
    """

    rest: Array
    mobility: Array
    density: Array
    stretch_x: Array
    stretch_y: Array
    part: Array
    kept: Array

    def growing(self, thickness: Array) -> Array:
        """Return the part of the conductance that grows as the cube of a thickness, (ny, nx)."""
        own: Array = self.part * thickness**3
        return own / (own + self.kept)


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
def interpolated(table: Array, row: Lanes, t: Lanes) -> tuple[Lanes, Lanes]:
    """Return value, cubic between ``row`` and the next one, and slope times step, linear there.

    ``table`` (n, 2) has value and slope times step; ``t`` is the part of the step behind the row.
    """
    start, rise, end, fall = lookup(table, row)
    s = 1.0 - t
    low, high = start + t * (rise + 2.0 * start), end + s * (2.0 * end - fall)
    return s * s * low + t * t * high, s * rise + t * fall


@helper
def line_properties(film: Film, flow: FlowTable, floor: float, j: int) -> None:
    """Fill ``eps, rho, drho`` of line ``j``; see `properties`."""
    thickness = film.channel if film.channel.shape[0] > 0 else film.h
    last, per_step, nx = float(flow.mobility.shape[0] - 2), 1.0 / flow.step, film.p.shape[1]
    for start in range(0, nx, LANES):
        at = lanes(min(start, nx - LANES))
        x = greater(film.p[j, at] * per_step, 0.0)  # also of a pressure that is not a number
        row = truncate(lesser(x, last))
        t = lesser(x - row, 1.0)
        thick = thickness[j, at]
        thick = where(thick < floor, floor, thick)
        mobility, _ = interpolated(flow.mobility, row, t)
        film.eps[j, at] = mobility * (thick * thick * thick)
        density, slope = interpolated(flow.density, row, t)
        film.rho[j, at] = density
        film.drho[j, at] = slope * per_step


@kernel
def properties(film: Film, flow: FlowTable, floor: float) -> None:
    """Fill ``eps, rho, drho``, and ``eps_y`` if it differs, from ``p, h``.

    Parameters
    ----------
    film : Film
        Fields (ny, nx).
    flow : FlowTable
        Laws of the lubricant.
    floor : float
        Least film in ``eps`` [-].
    """
    film, flow = raw((film, flow))
    for j in range(film.p.shape[0]):
        line_properties(film, flow, floor, j)
        shape_line(film, film.eps, j)


@helper
def shape_line(film: Film, eps_y: Array, j: int) -> None:
    """Change the properties of line ``j``, along y ``eps_y``, as the shape of asperities does."""
    if film.across.shape[0] > 0:
        for i in range(film.p.shape[1]):
            film.eps_y[j, i] = film.across[j, i] * eps_y[j, i]
    if film.carried.shape[0] > 0:
        for i in range(film.p.shape[1]):
            film.rho[j, i] *= film.carried[j, i]
            film.drho[j, i] *= film.carried[j, i]


@kernel
def factors_of(
    heated: Heated, film: Film, flow: FlowTable, thickness: Array, factors: Factors
) -> None:
    """Fill ``factors`` at the pressures ``film.p`` and ``thickness`` (ny, nx) of the film.

    ``film.h`` is 1, so that ``eps`` is the mobility; ``eps, rho, drho`` are overwritten. A flow
    that grows as the slope to the power s grows as H^(1 + 1/n + s) and falls as the viscosity to
    the power 1/n, at a given slope. The tangent multiplies both by s, so their parts are over s.
    """
    heated, film, flow, factors = raw((heated, film, flow, factors))
    for j in range(film.p.shape[0]):
        line_properties(film, flow, 0.0, j)
        for i in range(film.p.shape[1]):
            mobility, over_n = heated.mobility[j, i], heated.over_exponent[j, i]
            over_s = 1.0 / max(heated.stretch_x[j, i], heated.stretch_y[j, i], 1.0)
            factors.rest[j, i] = mobility * (1.0 - over_n * over_s)
            factors.mobility[j, i] = mobility * over_n * over_s / film.eps[j, i]
            factors.density[j, i] = heated.density[j, i] / film.rho[j, i]
            factors.stretch_x[j, i] = heated.stretch_x[j, i]
            factors.stretch_y[j, i] = heated.stretch_y[j, i]
            part = (1.0 + (1.0 + over_n) * over_s) / 3.0
            factors.part[j, i] = part
            factors.kept[j, i] = (1.0 - part) * thickness[j, i] ** 3


@kernel
def heated_properties(film: Film, factors: Factors, flow: FlowTable, floor: float) -> None:
    """Fill ``eps, rho, drho, eps_x, eps_y`` of the heated, sheared film; see `properties`."""
    film, factors, flow = raw((film, factors, flow))
    for j in range(film.p.shape[0]):
        line_properties(film, flow, floor, j)
        _scale_line(film, factors, floor, j)
        shape_line(film, film.eps_y, j)


@helper
def _scale_line(film: Film, factors: Factors, floor: float, j: int) -> None:
    """Turn isothermal Newtonian properties of line ``j`` into those of the heated film."""
    nx = film.p.shape[1]
    thickness = film.channel if film.channel.shape[0] > 0 else film.h
    for i in range(nx):
        thick = max(thickness[j, i], floor)
        cube = thick * thick * thick
        whole = factors.mobility[j, i] * film.eps[j, i] + factors.rest[j, i] * cube
        film.eps[j, i] = whole * (factors.part[j, i] + factors.kept[j, i] / cube)
    for i in range(nx):
        film.rho[j, i] *= factors.density[j, i]
        film.drho[j, i] *= factors.density[j, i]
    for i in range(nx):
        film.eps_x[j, i] = factors.stretch_x[j, i] * film.eps[j, i]
        film.eps_y[j, i] = factors.stretch_y[j, i] * film.eps[j, i]
