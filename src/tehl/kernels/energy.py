"""Compiled energy equation of the film: properties, flow across the film, columns, surfaces.

The march goes along x, station by station; all arrays have y as the last axis, so that each loop
over the rows of a station is one vector loop. Fields carry two ghost stations and two ghost rows
on each side, which hold the inlet temperature (or the mirror image). Dimensionless except for the
temperature in kelvin:

    c rho (u T_x + v T_y/kappa + omega/h T_zeta) = k T_zeta,zeta / h^2 + compression + shear,
    omega rho = -(h int_0^zeta rho u)_x - (h int_0^zeta rho v)_y / kappa, zero at both walls.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from tehl.typing import Array

GHOSTS = 2
MAGIC = 6755399441055744.0  # 1.5 2^52: adding it leaves the nearest integer in the low bits
LOG2_E = 1.4426950408889634
LN2_HIGH, LN2_LOW = 0.693147180369123816490, 1.90821492927058770002e-10
LARGEST_EXPONENT = 690.0
LARGEST_THINNING = 200.0  # ln F
BEYOND_LIMIT = 1.02  # of a limiting stress; there ln F is above 20
LARGEST_STEP = 40.0  # [K] per solution of a column
PRESSURISED = 0.02  # from this pressure on changes of the temperature count
CONDUCTION = 8.0  # a little less than pi^2, the slowest decay across the film
BLOCK = 16  # rows whose columns are solved together, so that they stay in the first cache
ETA_TERMS, RHO_TERMS = 12, 5  # of the polynomials in temperature
TERMS = ETA_TERMS + RHO_TERMS


class Across(NamedTuple):
    """Nodes across the film and the matrices that differentiate and integrate.

    ``zeta`` (n,), ``d1, d2`` (n, n) first and second derivative, ``step[k]`` weights of the
    integral from node k-1 to k, ``weights`` of that from 0 to 1; ``band`` is how far from the
    diagonal these matrices reach.
    """

    zeta: Array
    d1: Array
    d2: Array
    step: Array
    weights: Array
    band: int


class Laws(NamedTuple):
    """Tables of the lubricant.

    ``fluid`` (rows, TERMS, 2): over ln(1 + per_scale p) the coefficients, and their slopes times
    the step, of ln eta as a polynomial in ``(1/T - middle) over_inverse`` and of rho in
    ``(T - inlet) over_rise``, for T of ``coldest`` to ``hottest``. ``thinning`` (rows, 2): ln F
    and its slope times the step over s/(1 + s), ``per_stress`` rows per unit; ``newtonian``
    where there is no thinning, ``uniform`` where all layers thin as mid-film does.
    """

    fluid: Array
    per_scale: float
    per_row: float
    middle: float
    over_inverse: float
    inlet: float
    over_rise: float
    coldest: float
    hottest: float
    thinning: Array
    per_stress: float
    newtonian: int
    uniform: int


class Terms(NamedTuple):
    """Dimensionless numbers of the equations.

    ``peclet, compression, brinkman``: factors of convection, compression and shear heat;
    ``poiseuille`` is 12/lambda; ``slide`` (u2 - u1)/u_m; ``speed`` u1/u_m; ``over_x, over_y``
    1/dx and 1/(kappa dy); ``w0, w1, w2`` upstream weights; ``mirror`` whether row 0 is a symmetry
    line; ``mean`` 0 local properties, 1 mean ones in Reynolds, 2 mean ones everywhere; ``inlet``
    the temperature of the oil; ``heat`` 0 keeps the temperature as it is.
    """

    peclet: float
    compression: float
    brinkman: float
    poiseuille: float
    slide: float
    speed: float
    over_x: float
    over_y: float
    w0: float
    w1: float
    w2: float
    mirror: int
    mean: int
    inlet: float
    heat: int


class Model(NamedTuple):
    """What does not change during a run: nodes across the film, laws and numbers."""

    across: Across
    laws: Laws
    terms: Terms


class Surface(NamedTuple):
    """One surface, with the line source that heats it.

    Its temperature is ``bulk`` (nx, ny) plus ``factor`` times the integral of the flux over the
    root of the distance, with the weights of `tehl.operators.line_source.History`; ``factor`` is
    zero where ``bulk`` says it all. ``flux`` (nx + 4, ny) into the surface is filled.
    """

    bulk: Array
    factor: float
    near: float
    next_: float
    decay: Array
    older: Array
    newer: Array
    flux: Array


class Fields(NamedTuple):
    """Fields of the film, y last.

    In: ``p, h, px, py`` (nx, ny), ``capacity, conductivity`` ratios to those at ambient pressure,
    ``stress`` one over the scale of the shear law. In and out: ``temperature``
    (nx + 4, n, ny + 4), ``tau_x, tau_y`` mid-film stress (nx, ny). Out: ``mobility, density`` of
    the Reynolds equation, ``enthalpy_x, enthalpy_y`` fluxes, ``shear, work`` powers,
    ``effective`` viscosity ratio, ``steep``: how the mobility follows the Newtonian one, both as
    logarithms, ``stretch``: mobility along x of a small change over ``mobility``.
    """

    p: Array
    h: Array
    px: Array
    py: Array
    capacity: Array
    conductivity: Array
    stress: Array
    temperature: Array
    tau_x: Array
    tau_y: Array
    mobility: Array
    density: Array
    enthalpy_x: Array
    enthalpy_y: Array
    shear: Array
    work: Array
    effective: Array
    steep: Array
    stretch: Array


class Work(NamedTuple):
    """Scratch of one station.

    ``column`` (QUANTITIES, n, ny) one layer after the other; ``matrix`` (n, n, BLOCK) and ``rhs``
    (n, BLOCK) of some columns; ``mass`` (3, n, ny) the cumulative mass flux along x at the last
    three stations, ``mass_y`` (n, ny) that along y here; ``line`` (LINES, ny) whatever has no
    layers; ``modes`` (2, m, ny) the exponentials of both surfaces.
    """

    column: Array
    matrix: Array
    rhs: Array
    mass: Array
    mass_y: Array
    line: Array
    modes: Array


LN_ETA, FLUIDITY, SLOPE, RHO, RHO_T, I0, I1, U, V, OMEGA, YIELD, SHARE, NEW, A, B = range(15)
QUANTITIES = 15
TX, TY, MEAN, PAST, FIRST, SECOND, THIRD, FOURTH, FIFTH, SIXTH = range(10)
COEFFICIENTS = 10
LINES = COEFFICIENTS + TERMS


@njit(cache=True, fastmath={"contract"})
def exponential(x: Array, scratch: Array, out: Array) -> None:
    """Write exp(x) to ``out`` (n,), to a relative 1e-15, for |x| below 690."""
    bits = scratch.view(np.int64)
    for j in range(x.shape[0]):
        scratch[j] = x[j] * LOG2_E + MAGIC
    for j in range(x.shape[0]):
        n = scratch[j] - MAGIC
        r = (x[j] - n * LN2_HIGH) - n * LN2_LOW
        q = 1.0 / 39916800.0
        q = q * r + 1.0 / 3628800.0
        q = q * r + 1.0 / 362880.0
        q = q * r + 1.0 / 40320.0
        q = q * r + 1.0 / 5040.0
        q = q * r + 1.0 / 720.0
        q = q * r + 1.0 / 120.0
        q = q * r + 1.0 / 24.0
        q = q * r + 1.0 / 6.0
        q = q * r + 0.5
        q = q * r + 1.0
        out[j] = q * r + 1.0
    for j in range(x.shape[0]):
        bits[j] = (bits[j] + 1023) << 52
    for j in range(x.shape[0]):
        out[j] *= scratch[j]


@njit(cache=True, fastmath={"contract"})
def coefficients(laws: Laws, p: Array, work: Work) -> None:
    """Interpolate the polynomials of the laws to the pressures of a station."""
    flat, last = laws.fluid.ravel(), laws.fluid.shape[0] - 2
    lines = work.line
    for j in range(p.shape[0]):
        x = math.log(1.0 + laws.per_scale * max(p[j], 0.0)) * laws.per_row
        row = min(int(x), last)
        s = min(x - row, 1.0)
        r = 1.0 - s
        p0, p1 = r * r * (1.0 + 2.0 * s), s * r * r
        p2, p3 = s * s * (3.0 - 2.0 * s), -s * s * r
        near = flat[2 * TERMS * row : 2 * TERMS * (row + 2)]
        for c in range(TERMS):
            low, high = 2 * c, 2 * (c + TERMS)
            value = p0 * near[low] + p1 * near[low + 1] + p2 * near[high] + p3 * near[high + 1]
            lines[COEFFICIENTS + c, j] = value


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def look_up(laws: Laws, temperature: Array, work: Work, k: int) -> None:
    """Fill ln eta, its slope by -T, rho and rho_T of layer ``k``."""
    ln_eta, slope = work.column[LN_ETA, k], work.column[SLOPE, k]
    rho, rho_t = work.column[RHO, k], work.column[RHO_T, k]
    ny, t, inverse = temperature.shape[0], work.line[FIRST], work.line[SECOND]
    for j in range(ny):
        inverse[j] = 1.0 / min(max(temperature[j], laws.coldest), laws.hottest)
        t[j] = (inverse[j] - laws.middle) * laws.over_inverse
    horner(work.line[COEFFICIENTS : COEFFICIENTS + ETA_TERMS], t, ln_eta, slope)
    for j in range(ny):
        ln_eta[j] = min(max(ln_eta[j], -LARGEST_EXPONENT), LARGEST_EXPONENT)
        slope[j] *= laws.over_inverse * inverse[j] * inverse[j]
        rise = min(max(temperature[j], laws.coldest), laws.hottest) - laws.inlet
        t[j] = rise * laws.over_rise
    horner(work.line[COEFFICIENTS + ETA_TERMS :], t, rho, rho_t)
    for j in range(ny):
        rho_t[j] *= laws.over_rise


@njit(cache=True, fastmath={"contract"})
def horner(terms: Array, t: Array, value: Array, slope: Array) -> None:
    """Write polynomials with coefficients ``terms`` (m, ny) and their slopes at ``t`` (ny,)."""
    last = terms.shape[0] - 1
    value[:] = terms[last]
    slope[:] = 0.0
    for c in range(last - 1, -1, -1):
        term = terms[c]
        for j in range(t.shape[0]):
            slope[j] = slope[j] * t[j] + value[j]
            value[j] = value[j] * t[j] + term[j]


@njit(cache=True, fastmath={"contract"})
def evaluate_laws(model: Model, fields: Fields, i: int, work: Work) -> None:
    """Fill viscosity, density and their slopes at all layers of station ``i``."""
    coefficients(model.laws, fields.p[i], work)
    mean = work.line[MEAN]
    mean[:] = 0.0
    n = model.across.zeta.shape[0]
    for k in range(n):
        layer = fields.temperature[i + GHOSTS, k, GHOSTS:-GHOSTS]
        for j in range(mean.shape[0]):
            mean[j] += model.across.weights[k] * layer[j]
    for k in range(n):
        layer = fields.temperature[i + GHOSTS, k, GHOSTS:-GHOSTS]
        look_up(model.laws, mean if model.terms.mean == 2 else layer, work, k)


@njit(cache=True, fastmath={"contract"})
def follow_temperature(model: Model, fields: Fields, i: int, work: Work) -> float:
    """Take the new temperatures and let the laws follow to first order; return the change.

    No temperature changes by more than the largest step. What counts is where there is pressure.
    """
    n, p = model.across.zeta.shape[0], fields.p[i]
    mean, largest = work.line[MEAN], work.line[FIRST]
    mean[:] = 0.0
    largest[:] = 0.0
    for k in range(n):
        layer, step = fields.temperature[i + GHOSTS, k, GHOSTS:-GHOSTS], work.column[NEW, k]
        for j in range(p.shape[0]):
            step[j] = min(max(step[j] - layer[j], -LARGEST_STEP), LARGEST_STEP)
            layer[j] += step[j]
            mean[j] += model.across.weights[k] * step[j]
            largest[j] = max(largest[j], abs(step[j]))
    for k in range(n):
        step = mean if model.terms.mean == 2 else work.column[NEW, k]
        ln_eta, slope = work.column[LN_ETA, k], work.column[SLOPE, k]
        rho, rho_t = work.column[RHO, k], work.column[RHO_T, k]
        for j in range(p.shape[0]):
            ln_eta[j] = min(
                max(ln_eta[j] - slope[j] * step[j], -LARGEST_EXPONENT), LARGEST_EXPONENT
            )
            rho[j] += rho_t[j] * step[j]
    change = 0.0
    for j in range(p.shape[0]):
        if p[j] > PRESSURISED:
            change = max(change, largest[j])
    return change


@njit(cache=True, fastmath={"contract"})
def fluidities(work: Work) -> None:
    """Fill the Newtonian fluidity, one over the viscosity, of a station."""
    negative = work.line[FIRST]
    for k in range(work.mass_y.shape[0]):
        ln_eta = work.column[LN_ETA, k]
        for j in range(negative.shape[0]):
            negative[j] = -ln_eta[j]
        exponential(negative, work.line[SECOND], work.column[FLUIDITY, k])
    work.column[YIELD, :, :] = 1.0


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def thinning(laws: Laws, stress: Array, log_f: Array, bend: Array) -> None:
    """Write ln F and s dlnF/ds at dimensionless stresses (ny,); linear beyond the table."""
    flat, last = laws.thinning.ravel(), laws.thinning.shape[0] - 2
    end = (last + 1) / laws.per_stress
    largest = end / (1.0 - end)
    for j in range(stress.shape[0]):
        s = min(stress[j], largest)
        x = s / (1.0 + s) * laws.per_stress
        k = min(int(x), last)
        t = x - k
        near = flat[2 * k : 2 * k + 4]
        r = 1.0 - t
        value = r * r * ((1.0 + 2.0 * t) * near[0] + t * near[1])
        value += t * t * ((3.0 - 2.0 * t) * near[2] - r * near[3])
        slope = 6.0 * t * r * (near[2] - near[0]) + r * (1.0 - 3.0 * t) * near[1]
        slope += t * (3.0 * t - 2.0) * near[3]
        slope *= laws.per_stress / ((1.0 + s) * (1.0 + s))
        log_f[j] = min(value + (stress[j] - s) * slope, LARGEST_THINNING)
        bend[j] = slope * stress[j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def layer_stress(model: Model, fields: Fields, i: int, work: Work, k: int) -> None:
    """Write both stresses of layer ``k`` to ``FIRST, SECOND`` and the dimensionless to ``THIRD``.

    The stress is linear across the film, by the pressure gradient.
    """
    tilt = model.terms.poiseuille * (model.across.zeta[k] - 0.5)
    tilt = 0.0 if model.laws.uniform else tilt
    x, y, size = work.line[FIRST], work.line[SECOND], work.line[THIRD]
    p_x, p_y, h, per_scale = fields.px[i], fields.py[i], fields.h[i], fields.stress[i]
    tau_x, tau_y = fields.tau_x[i], fields.tau_y[i]
    for j in range(h.shape[0]):
        x[j] = tau_x[j] + tilt * p_x[j] * h[j]
        y[j] = tau_y[j] + tilt * p_y[j] * h[j]
        size[j] = math.sqrt(x[j] * x[j] + y[j] * y[j]) * per_scale[j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def newton_step(model: Model, fields: Fields, i: int, work: Work) -> None:
    """Improve the mid-film stress so that the film is sheared by the sliding speed.

    Both components; the rate is ``F(s) tau/eta`` with ``s = |tau|`` over the scale of the law. The
    problem is convex; a step is no longer than that scale and half the stress. The station's
    fluidity is Newtonian.
    """
    line = work.line
    x, y, size, log_f, bend = line[FIRST], line[SECOND], line[THIRD], line[FOURTH], line[FIFTH]
    sums = work.column[A]  # rate x, rate y, and the matrix xx, xy, yy
    sums[:5] = 0.0
    for k in range(model.across.zeta.shape[0]):
        layer_stress(model, fields, i, work, k)
        thinning(model.laws, size, log_f, bend)
        exponential(log_f, line[SIXTH], size)
        fluid, weight = work.column[FLUIDITY, k], model.across.weights[k]
        for j in range(x.shape[0]):
            rate = weight * fluid[j] * size[j]
            more = rate * bend[j] / (x[j] * x[j] + y[j] * y[j] + 1e-300)
            sums[0, j] += rate * x[j]
            sums[1, j] += rate * y[j]
            sums[2, j] += rate + more * x[j] * x[j]
            sums[3, j] += more * x[j] * y[j]
            sums[4, j] += rate + more * y[j] * y[j]
    tau_x, tau_y, per_scale, h = fields.tau_x[i], fields.tau_y[i], fields.stress[i], fields.h[i]
    for j in range(x.shape[0]):
        rate_x, rate_y = sums[0, j] - model.terms.slide / h[j], sums[1, j]
        det = sums[2, j] * sums[4, j] - sums[3, j] * sums[3, j]
        dx = (sums[4, j] * rate_x - sums[3, j] * rate_y) / det
        dy = (sums[2, j] * rate_y - sums[3, j] * rate_x) / det
        # Newton's step for the logarithm of the rate, where the sliding has a sign
        ratio = min(max(model.terms.slide / h[j] / (sums[0, j] + 1e-300), 1e-9), 1e9)
        grown = math.log(ratio) / (ratio - 1.0) if abs(ratio - 1.0) > 1e-6 else 1.0
        known = (sums[0, j] < 0.0) == (model.terms.slide < 0.0)
        grown = grown if known and model.terms.slide != 0.0 else 1.0
        length = grown * per_scale[j] * math.sqrt(dx * dx + dy * dy)
        size[j] = per_scale[j] * math.sqrt(tau_x[j] * tau_x[j] + tau_y[j] * tau_y[j])
        limit = grown * min((1.0 + 0.5 * size[j]) / (length + 1e-300), 1.0)
        tau_x[j] -= limit * dx
        tau_y[j] -= limit * dy
        if model.laws.uniform:
            size[j] = per_scale[j] * math.sqrt(tau_x[j] * tau_x[j] + tau_y[j] * tau_y[j])
            limit = min(1.0, BEYOND_LIMIT / (size[j] + 1e-300))
            tau_x[j] *= limit
            tau_y[j] *= limit


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def thin(model: Model, fields: Fields, i: int, work: Work) -> None:
    """Multiply the fluidity by F at the mid-film stress found; fill the yields.

    ``YIELD`` is how fast the rate grows with the stress, both as logarithms; ``B`` the fluidity of
    a small change of the stress along x.
    """
    line = work.line
    x, y, size, log_f, bend = line[FIRST], line[SECOND], line[THIRD], line[FOURTH], line[FIFTH]
    for k in range(model.across.zeta.shape[0]):
        layer_stress(model, fields, i, work, k)
        thinning(model.laws, size, log_f, bend)
        exponential(log_f, line[SIXTH], size)
        fluid, yields, tangent = work.column[FLUIDITY, k], work.column[YIELD, k], work.column[B, k]
        for j in range(x.shape[0]):
            fluid[j] *= size[j]
            yields[j] = 1.0 + bend[j]
            share = x[j] * x[j] / (x[j] * x[j] + y[j] * y[j] + 1e-300)
            share = 0.0 if model.laws.uniform else share
            tangent[j] = fluid[j] * (1.0 + bend[j] * share)


@njit(cache=True, fastmath={"contract"})
def integrate(across: Across, first: Array, second: Array, one: Array, two: Array) -> None:
    """Write the integrals of ``first`` and ``second`` (n, ny) from 0 to each node."""
    n, ny = first.shape
    one[0] = 0.0
    two[0] = 0.0
    for k in range(1, n):
        a, b = one[k], two[k]
        a[:] = one[k - 1]
        b[:] = two[k - 1]
        for m in range(max(k - across.band, 0), min(k + across.band, n - 1) + 1):
            weight, c, d = across.step[k, m], first[m], second[m]
            for j in range(ny):
                a[j] += weight * c[j]
                b[j] += weight * d[j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def moments(model: Model, fluid: Array, work: Work) -> None:
    """Fill ``I0, I1``: integrals of ``fluid`` and of it times the distance from mid-film."""
    scratch = work.column[A]
    for k in range(scratch.shape[0]):
        for j in range(scratch.shape[1]):
            scratch[k, j] = (model.across.zeta[k] - 0.5) * fluid[k, j]
    integrate(model.across, fluid, scratch, work.column[I0], work.column[I1])


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def velocities(model: Model, fields: Fields, i: int, work: Work) -> None:
    """Fill the velocities; in a Newtonian film they tell the mid-film stress as well."""
    column, terms = work.column, model.terms
    n = column.shape[1]
    i0, i1 = column[I0], column[I1]
    p_x, p_y, h = fields.px[i], fields.py[i], fields.h[i]
    tau_x, tau_y = work.line[TX], work.line[TY]
    for j in range(h.shape[0]):
        tilt = terms.poiseuille * h[j] * i1[n - 1, j]
        tau_x[j] = (terms.slide / h[j] - tilt * p_x[j]) / i0[n - 1, j]
        tau_y[j] = -tilt * p_y[j] / i0[n - 1, j]
    if model.laws.newtonian:
        fields.tau_x[i, :] = tau_x
        fields.tau_y[i, :] = tau_y
    for k in range(n):
        u, v = column[U, k], column[V, k]
        for j in range(h.shape[0]):
            slope = terms.poiseuille * h[j] * h[j] * i1[k, j]
            u[j] = terms.speed + h[j] * tau_x[j] * i0[k, j] + slope * p_x[j]
            v[j] = h[j] * tau_y[j] * i0[k, j] + slope * p_y[j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def mobility(model: Model, work: Work, out: Array) -> None:
    """Write the generalised mobility ``12 (eta_e rho'_e/eta'_e - rho''_e)`` of a station.

    Yang and Wen 1990; the moments about mid-film give the same and lose no digits.
    """
    i0, i1, rho = work.column[I0], work.column[I1], work.column[RHO]
    n = i0.shape[0]
    tilt = work.line[FIRST]
    for j in range(out.shape[0]):
        tilt[j] = i1[n - 1, j] / i0[n - 1, j]
    out[:] = 0.0
    for k in range(n):
        weight = 12.0 * model.across.weights[k]
        for j in range(out.shape[0]):
            out[j] += weight * rho[k, j] * (tilt[j] * i0[k, j] - i1[k, j])


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def reynolds_fields(model: Model, fields: Fields, i: int, work: Work) -> None:
    """Write mobility and density of the Reynolds equation, and how they follow the pressure.

    The density is that of the Couette flux over h u_m.
    """
    column, terms = work.column, model.terms
    n = column.shape[1]
    i0, density, steep = column[I0], fields.density[i], fields.steep[i]
    mobility(model, work, fields.mobility[i])
    density[:] = 0.0
    for k in range(n):
        weight, rho = model.across.weights[k], column[RHO, k]
        for j in range(density.shape[0]):
            density[j] += weight * rho[j] * (terms.speed + terms.slide * i0[k, j] / i0[n - 1, j])
    for j in range(density.shape[0]):
        steep[j] = 1.0 / column[YIELD, n // 2, j]
        fields.stretch[i, j] = 1.0
        newtonian = math.exp(-column[LN_ETA, n // 2, j])
        fields.effective[i, j] = newtonian / column[FLUIDITY, n // 2, j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def stretch_field(model: Model, fields: Fields, i: int, work: Work) -> None:
    """Write how much more a small change of the gradient along x moves, the sliding being kept."""
    moments(model, work.column[B], work)
    mobility(model, work, fields.stretch[i])
    for j in range(fields.p.shape[1]):
        fields.stretch[i, j] /= fields.mobility[i, j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def mean_fields(model: Model, fields: Fields, i: int, work: Work) -> None:
    """Write mobility and density of the Reynolds equation with properties at the mean temperature.

    The thinning is that of mid-film.
    """
    mean = work.line[MEAN]
    mean[:] = 0.0
    for k in range(model.across.zeta.shape[0]):
        layer = fields.temperature[i + GHOSTS, k, GHOSTS:-GHOSTS]
        for j in range(mean.shape[0]):
            mean[j] += model.across.weights[k] * layer[j]
    look_up(model.laws, mean, work, 0)
    for j in range(mean.shape[0]):
        rho = work.column[RHO, 0, j]
        fields.mobility[i, j] = rho * math.exp(-work.column[LN_ETA, 0, j]) / fields.effective[i, j]
        fields.density[i, j] = rho


@njit(cache=True, fastmath={"contract"})
def mass_fluxes(model: Model, fields: Fields, i: int, work: Work) -> None:
    """Fill the cumulative mass fluxes along x and y of station ``i``."""
    column, h = work.column, fields.h[i]
    for k in range(column.shape[1]):
        for j in range(h.shape[0]):
            flux = h[j] * column[RHO, k, j]
            column[A, k, j] = flux * column[U, k, j]
            column[OMEGA, k, j] = flux * column[V, k, j]
    integrate(model.across, column[A], column[OMEGA], work.mass[i % 3], work.mass_y)
    here, last, before = work.mass[i % 3], work.mass[(i - 1) % 3], work.mass[(i - 2) % 3]
    if i == 0:
        last[:] = here
        before[:] = here
    if i == 1:
        before[:] = 2.0 * last - here


@njit(cache=True, fastmath={"contract"})
def cross_flow(model: Model, i: int, work: Work) -> None:
    """Fill ``OMEGA`` with h rho omega, the mass flux through the layers, zero at both walls."""
    terms, mass_y = model.terms, work.mass_y
    n, ny = mass_y.shape
    here, last, before = work.mass[i % 3], work.mass[(i - 1) % 3], work.mass[(i - 2) % 3]
    half = 0.5 * terms.over_y
    for k in range(n - 1, -1, -1):
        omega, side = work.column[OMEGA, k], mass_y[k]
        now, old, older = here[k], last[k], before[k]
        for j in range(ny):
            along = terms.w0 * now[j] + terms.w1 * old[j] + terms.w2 * older[j]
            omega[j] = -terms.over_x * along
        for j in range(1, ny - 1):
            omega[j] -= half * (side[j + 1] - side[j - 1])
        omega[ny - 1] -= terms.over_y * (side[ny - 1] - side[ny - 2])
        omega[0] -= terms.over_y * (side[1] - (0.0 if terms.mirror else side[0]))
    end = work.line[FIRST]
    end[:] = work.column[OMEGA, n - 1]
    for k in range(n):
        omega, zeta = work.column[OMEGA, k], model.across.zeta[k]
        for j in range(ny):
            omega[j] -= zeta * end[j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def powers(model: Model, fields: Fields, i: int, work: Work) -> None:
    """Write shear power, compression power and enthalpy fluxes of station ``i``."""
    column, h, terms = work.column, fields.h[i], model.terms
    for j in range(h.shape[0]):
        fields.shear[i, j], fields.work[i, j] = 0.0, 0.0
        fields.enthalpy_x[i, j], fields.enthalpy_y[i, j] = 0.0, 0.0
    for k in range(column.shape[1]):
        tilt = terms.poiseuille * (model.across.zeta[k] - 0.5)
        temperature = fields.temperature[i + GHOSTS, k, GHOSTS:-GHOSTS]
        u, v, rho, rho_t = column[U, k], column[V, k], column[RHO, k], column[RHO_T, k]
        for j in range(h.shape[0]):
            weight = model.across.weights[k] * h[j]
            slope_x, slope_y = fields.px[i, j], fields.py[i, j]
            tau_x = fields.tau_x[i, j] + tilt * slope_x * h[j]
            tau_y = fields.tau_y[i, j] + tilt * slope_y * h[j]
            rate = (tau_x**2 + tau_y**2) * column[FLUIDITY, k, j]
            fields.shear[i, j] += weight * terms.brinkman * rate
            rise = -terms.compression * temperature[j] / rho[j] * rho_t[j]
            fields.work[i, j] += weight * rise * (u[j] * slope_x + v[j] * slope_y)
            excess = terms.peclet * fields.capacity[i, j] * rho[j] * (temperature[j] - terms.inlet)
            fields.enthalpy_x[i, j] += weight * excess * u[j]
            fields.enthalpy_y[i, j] += weight * excess * v[j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def shares(model: Model, work: Work) -> None:
    """Fill ``SHARE``: by how much the stress falls, relatively, per kelvin of a layer.

    The sliding speed is kept.
    """
    fluid, slope, yields = work.column[FLUIDITY], work.column[SLOPE], work.column[YIELD]
    share, total, weights = work.column[SHARE], work.line[FIRST], model.across.weights
    n, ny = share.shape
    total[:] = 0.0
    for k in range(n):
        for j in range(ny):
            total[j] += weights[k] * fluid[k, j] * yields[k, j]
    for k in range(n):
        for j in range(ny):
            share[k, j] = weights[k] * fluid[k, j] * slope[k, j] / total[j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def explicit_terms(model: Model, fields: Fields, i: int, work: Work) -> None:
    """Prepare the inner rows: ``A`` diagonal of convection, ``B`` shear heat, ``NEW`` the rest.

    ``OMEGA`` becomes the factor of T_zeta. Neighbours across and, against the march, along x are
    those of the last sweep: there the upstream difference is of second order only where conduction
    across the film holds it.
    """
    column, h, terms = work.column, fields.h[i], model.terms
    temperature = fields.temperature
    per = work.line[FIRST]
    for j in range(h.shape[0]):
        per[j] = h[j] * h[j] / fields.conductivity[i, j]
    p_x, p_y, tau_x, tau_y = fields.px[i], fields.py[i], fields.tau_x[i], fields.tau_y[i]
    capacity, film = work.line[SECOND], fields.h[i]
    for j in range(film.shape[0]):
        capacity[j] = per[j] * terms.peclet * fields.capacity[i, j]
    for k in range(1, column.shape[1] - 1):
        tilt = terms.poiseuille * (model.across.zeta[k] - 0.5)
        here = temperature[i + GHOSTS, k]
        west, far_west = temperature[i + GHOSTS - 1, k], temperature[i + GHOSTS - 2, k]
        east, far_east = temperature[i + GHOSTS + 1, k], temperature[i + GHOSTS + 2, k]
        u, v, rho, rho_t = column[U, k], column[V, k], column[RHO, k], column[RHO_T, k]
        convection, heat, rest = column[A, k], column[B, k], column[NEW, k]
        fluid, omega = column[FLUIDITY, k], column[OMEGA, k]
        for j in range(film.shape[0]):
            x, y = tau_x[j] + tilt * p_x[j] * film[j], tau_y[j] + tilt * p_y[j] * film[j]
            heat[j] = per[j] * terms.brinkman * (x * x + y * y) * fluid[j]
            rise = -terms.compression * here[j + GHOSTS] / rho[j] * rho_t[j]
            rest[j] = heat[j] + per[j] * rise * (u[j] * p_x[j] + v[j] * p_y[j])
        for j in range(film.shape[0]):
            along = capacity[j] * rho[j] * abs(u[j]) * terms.over_x
            w, ww, e, ee = west[j + 2], far_west[j + 2], east[j + 2], far_east[j + 2]
            one, two = (w if u[j] > 0.0 else e), (ww if u[j] > 0.0 else ee)
            held = min(max(2.0 - along / CONDUCTION, 0.0), 1.0)
            second = terms.w2 * (1.0 if u[j] > 0.0 else held)
            convection[j] = (1.0 + second) * along
            rest[j] += along * (one + second * (2.0 * one - two))
        for j in range(film.shape[0]):
            sideways = capacity[j] * rho[j] * abs(v[j]) * terms.over_y
            a, b, c, d = here[j], here[j + 1], here[j + 3], here[j + 4]
            one, two = (b if v[j] > 0.0 else c), (a if v[j] > 0.0 else d)
            third = terms.w2 * min(max(2.0 - sideways / CONDUCTION, 0.0), 1.0)
            convection[j] += (1.0 + third) * sideways
            rest[j] += sideways * (one + third * (2.0 * one - two))
            omega[j] *= capacity[j] / film[j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def inner_rows(model: Model, fields: Fields, i: int, block: int, work: Work) -> None:
    """Fill the rows of the inner layers of the ``BLOCK`` columns from row ``block`` on.

    A warmer layer shears faster, and the stress falls for all of them at a given sliding speed: the
    first is held back where it would outweigh the conduction; banded matrices have room for a safe
    diagonal only. Neither changes the solution.
    """
    across, stop = model.across, block + BLOCK
    n = across.zeta.shape[0]
    full = across.band == n - 1
    column = work.column[:, :, block:stop]
    temperature = fields.temperature[i + GHOSTS, :, block + GHOSTS : stop + GHOSTS]
    held, share = work.line[THIRD, :BLOCK], column[SHARE]
    for k in range(1, n - 1):
        omega, matrix, rhs = column[OMEGA, k], work.matrix[k], work.rhs[k]
        for m in range(max(k - across.band, 0), min(k + across.band, n - 1) + 1):
            first, second = across.d1[k, m], across.d2[k, m]
            for j in range(BLOCK):
                matrix[m, j] = omega[j] * first - second
        convection, rest, yields = column[A, k], column[NEW, k], column[YIELD, k]
        heat, slope, here = column[B, k], column[SLOPE, k], temperature[k]
        for j in range(BLOCK):
            steep = slope[j] * heat[j]
            part = -min(CONDUCTION / (steep + 1e-300), 1.0) if full else 1.0
            matrix[k, j] += convection[j] + part * steep
            rhs[j] = rest[j] + part * steep * here[j]
            held[j] = heat[j] * (yields[j] - part)
        for m in range(n if full else 0):
            for j in range(BLOCK):
                matrix[m, j] += held[j] * share[m, j]
                rhs[j] += held[j] * share[m, j] * temperature[m, j]


@njit(cache=True, fastmath={"contract"})
def carry_modes(surface: Surface, side: int, i: int, work: Work) -> None:
    """Carry the exponentials of a surface on to station ``i``; their sum is in ``PAST + side``."""
    past = work.column[OMEGA, side * (work.column.shape[1] - 1)]
    two, one = surface.flux[i + GHOSTS - 2], surface.flux[i + GHOSTS - 1]
    for j in range(one.shape[0]):
        past[j] = surface.next_ * one[j]
    for m in range(surface.decay.shape[0]):
        mode = work.modes[side, m]
        decay, older, newer = surface.decay[m], surface.older[m], surface.newer[m]
        for j in range(one.shape[0]):
            mode[j] = decay * mode[j] + older * two[j] + newer * one[j]
            past[j] += mode[j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def wall_row(
    model: Model, fields: Fields, surface: Surface, side: int, i: int, block: int, work: Work
) -> None:
    """Fill the row of a wall: its temperature is bulk plus what the heat of the line has done."""
    across, n, stop = model.across, model.across.zeta.shape[0], block + BLOCK
    wall, sign = side * (n - 1), 1.0 - 2.0 * side
    rhs, matrix = work.rhs[wall], work.matrix[wall]
    bulk, past = surface.bulk[i, block:stop], work.column[OMEGA, wall, block:stop]
    h, conductivity = fields.h[i, block:stop], fields.conductivity[i, block:stop]
    for m in range(max(wall - across.band, 0), min(wall + across.band, n - 1) + 1):
        weight = sign * surface.factor * surface.near * across.d1[wall, m]
        unit = 1.0 if m == wall else 0.0
        for j in range(BLOCK):
            matrix[m, j] = unit - weight * conductivity[j] / h[j]
    for j in range(BLOCK):
        rhs[j] = bulk[j] + surface.factor * past[j]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def solve_columns(across: Across, work: Work) -> None:
    """Solve ``BLOCK`` columns by elimination without pivoting; the solution is in ``rhs``."""
    n = across.zeta.shape[0]
    b = work.rhs
    for c in range(n):
        pivot, last = work.matrix[c], min(c + across.band, n - 1)
        for j in range(BLOCK):
            pivot[c, j] = 1.0 / pivot[c, j]
        for r in range(c + 1, last + 1):
            row = work.matrix[r]
            for j in range(BLOCK):
                row[c, j] *= pivot[c, j]
            for m in range(c + 1, last + 1):
                for j in range(BLOCK):
                    row[m, j] -= row[c, j] * pivot[m, j]
            for j in range(BLOCK):
                b[r, j] -= row[c, j] * b[c, j]
    for c in range(n - 1, -1, -1):
        pivot = work.matrix[c]
        for m in range(c + 1, min(c + across.band, n - 1) + 1):
            for j in range(BLOCK):
                b[c, j] -= pivot[m, j] * b[m, j]
        for j in range(BLOCK):
            b[c, j] *= pivot[c, j]


@njit(cache=True)
def new_temperature(work: Work, block: int) -> None:
    """Copy the solution of the columns from row ``block`` on to ``NEW``."""
    work.column[NEW, :, block : block + BLOCK] = work.rhs


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def store_flux(model: Model, fields: Fields, surface: Surface, side: int, i: int) -> None:
    """Write the heat that flows into a surface at station ``i``."""
    n, across = model.across.zeta.shape[0], model.across
    flux, h = surface.flux[i + GHOSTS], fields.h[i]
    wall, sign = side * (n - 1), 1.0 - 2.0 * side
    flux[:] = 0.0
    for m in range(max(wall - across.band, 0), min(wall + across.band, n - 1) + 1):
        weight, layer = sign * across.d1[wall, m], fields.temperature[i + GHOSTS, m, GHOSTS:-GHOSTS]
        for j in range(flux.shape[0]):
            flux[j] += weight * layer[j]
    for j in range(flux.shape[0]):
        flux[j] *= fields.conductivity[i, j] / h[j]


@njit(cache=True)
def mirror_station(station: Array) -> None:
    """Fill the ghost rows of a symmetry line of one station (n, ny + 4)."""
    for k in range(station.shape[0]):
        station[k, 1], station[k, 0] = station[k, 3], station[k, 4]


@njit(cache=True)
def sweep(
    model: Model,
    fields: Fields,
    surfaces: tuple[Surface, Surface],
    steps: int,
    work: Work,
) -> float:
    """March once along x; return the largest change of temperature.

    Each station evaluates laws and flow at its last temperature, solves its columns, and lets the
    laws follow for the fields of the Reynolds equation. Without heat it only evaluates. ``steps``
    is the number of Newton steps for the stress of a thinning film.
    """
    nx = fields.p.shape[0]
    heat, thins = model.terms.heat, not model.laws.newtonian
    change = 0.0
    work.modes[:] = 0.0
    for i in range(nx):
        if model.terms.mirror:
            mirror_station(fields.temperature[i + GHOSTS])
        evaluate_laws(model, fields, i, work)
        for visit in range(1 + heat):
            fluidities(work)
            if thins:
                for _ in range(steps if visit == 0 else 1):
                    newton_step(model, fields, i, work)
                thin(model, fields, i, work)
            moments(model, work.column[FLUIDITY], work)
            velocities(model, fields, i, work)
            if visit == heat:
                break
            mass_fluxes(model, fields, i, work)
            cross_flow(model, i, work)
            shares(model, work)
            explicit_terms(model, fields, i, work)
            carry_modes(surfaces[0], 0, i, work)
            carry_modes(surfaces[1], 1, i, work)
            for block in range(0, fields.p.shape[1], BLOCK):
                inner_rows(model, fields, i, block, work)
                for side in range(2):
                    wall_row(model, fields, surfaces[side], side, i, block, work)
                solve_columns(model.across, work)
                new_temperature(work, block)
            change = max(change, follow_temperature(model, fields, i, work))
        for side in range(2):
            store_flux(model, fields, surfaces[side], side, i)
        powers(model, fields, i, work)
        reynolds_fields(model, fields, i, work)
        if thins:
            stretch_field(model, fields, i, work)
        if model.terms.mean == 1:
            mean_fields(model, fields, i, work)
    return change
