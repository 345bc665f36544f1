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

from tehl.kernels.lanes import (
    LANES,
    addresses,
    gather,
    if_positive,
    largest,
    load,
    lower,
    number,
    put,
    root,
    shifted_power,
    size,
    store,
    upper,
    whole,
)
from tehl.typing import Array

GHOSTS = 2
MAGIC = 6755399441055744.0  # 1.5 2^52: adding it leaves the nearest integer in the low bits
LOG2_E = 1.4426950408889634
LN2_HIGH, LN2_LOW = 0.693147180369123816490, 1.90821492927058770002e-10
LARGEST_EXPONENT = 690.0
LARGEST_THINNING = 200.0  # ln F
BEYOND_LIMIT = 1.02  # of a limiting stress; there ln F is above 20
LARGEST_STEP = 40.0  # [K] per solution of a column
LARGEST_FALL = 0.5  # of the stress that follows it, relatively
LARGEST_GROWTH = 6.0  # of the logarithm of the fluidity that follows it
PRESSURISED = 0.02  # from this pressure on changes of the temperature count
CONDUCTION = 8.0  # a little less than pi^2, the slowest decay across the film
HELD_BY_WALLS = 1.0  # over the squared distance to both walls: a little more than conduction
SETTLED = 1e-5  # step of the stress over its scale after which what is left is its square
STRAIGHT = 0.03  # excess of the tangent along y that changes no iteration
BLOCK = LANES  # rows that are treated together
ETA_TERMS, RHO_TERMS = 16, 8  # of the polynomials in temperature
TERMS = ETA_TERMS + RHO_TERMS


class Across(NamedTuple):
    """Nodes across the film and the matrices that differentiate and integrate.

    ``zeta`` (n,), ``d1, d2`` (n, n) first and second derivative, ``step[k]`` weights of the
    integral from node k-1 to k, ``turn[k]`` those of the integral times ``zeta - 1/2``,
    ``weights`` of the integral from 0 to 1; ``band`` is how far from the diagonal these matrices
    reach.
    """

    zeta: Array
    d1: Array
    d2: Array
    step: Array
    turn: Array
    weights: Array
    band: int


class Laws(NamedTuple):
    """Tables of the lubricant.

    ``fluid`` (rows, 2, TERMS): over ln(1 + per_scale p) the coefficients, and their slopes times
    the step, of ln eta as a polynomial in ``(1/(T - pole) - middle) over_inverse`` and of rho in
    ``(T - inlet) over_rise``, for T of ``coldest`` to ``hottest``. ``thinning`` (rows, 2): ln F
    and its slope times the step over s/(1 + s), ``per_stress`` rows per unit. ``last_row,
    last_stress``: rows where the last interval of either begins. ``gentle`` is the dimensionless
    stress up to which ln F does not count; ``newtonian`` where it never does, ``uniform`` where
    all layers thin as mid-film does.
    """

    fluid: Array
    per_scale: float
    per_row: float
    pole: float
    middle: float
    over_inverse: float
    inlet: float
    over_rise: float
    coldest: float
    hottest: float
    thinning: Array
    per_stress: float
    last_row: int
    last_stress: int
    gentle: float
    newtonian: int
    uniform: int


class Terms(NamedTuple):
    """Dimensionless numbers of the equations.

    ``peclet, compression, brinkman``: factors of convection, compression and shear heat;
    ``poiseuille`` is 12/lambda; ``slide`` (u2 - u1)/u_m; ``speed`` u1/u_m; ``over_x, over_y``
    1/dx and 1/(kappa dy); ``over_t`` the weight of the present in a derivative by time, 0 where it
    is steady; ``w0, w1, w2`` upstream weights; ``mirror`` whether row 0 is a symmetry
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
    over_t: float
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
    (nx + 4, n, ny + 4), ``tau_x, tau_y`` mid-film stress (nx, ny). In, where time passes:
    ``past`` (nx, n, ny) what former temperatures bring to their derivative, ``pressing`` (nx, ny)
    the derivative of the pressure. Out: ``mobility, density`` of the Reynolds equation, ``held``
    the mean density across the film, ``enthalpy_x, enthalpy_y`` fluxes, ``shear, work`` powers,
    ``effective`` viscosity ratio, ``steep``: how the mobility follows the Newtonian one, both as
    logarithms, ``stretch_x, stretch_y``: mobility of a small change along x or y over ``mobility``.
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
    held: Array
    enthalpy_x: Array
    enthalpy_y: Array
    shear: Array
    work: Array
    effective: Array
    steep: Array
    stretch_x: Array
    stretch_y: Array
    past: Array
    pressing: Array


class Work(NamedTuple):
    """Scratch of one station.

    ``cells``, flat: block by block `LINES` values without layers, then the `LAYER` values of each
    layer, all of them lanes. ``matrix``, flat: the n by n lanes of the columns of a block, then n
    right-hand sides, which become the solution. ``terms`` (BLOCK, TERMS): coefficients of the laws,
    row by row. ``mass`` (3, n, ny): cumulative mass flux along x at the last three stations,
    ``mass_y`` (n, ny + 2) that along y here with a ghost row on each side; ``modes`` (2, m, ny) the
    exponentials of both surfaces; ``change`` (BLOCK,) the largest change of temperature;
    ``back`` (1,) how many stations there are up to the last one with backflow.
    """

    cells: Array
    matrix: Array
    terms: Array
    mass: Array
    mass_y: Array
    modes: Array
    change: Array
    back: Array


class Place(NamedTuple):
    """One block of rows of one station.

    ``i`` station, ``j`` first row, ``base`` where its cells begin; ``n, ny`` nodes across the film
    and rows of a station; ``modes`` exponentials of a surface.
    """

    i: int
    j: int
    base: int
    n: int
    ny: int
    modes: int


# cells of a block: values without layers
P, H, PX, PY, CAPACITY, CONDUCTIVITY, STRESS, TAU_X, TAU_Y, PER, PULL, THINS, ASKEW, PT, ETA = (
    LANES * field for field in range(15)
)
DENSITY = ETA + LANES * ETA_TERMS
LINE = DENSITY + LANES * RHO_TERMS
# and values of each layer
T, LN_ETA, FLUIDITY, SLOPE, RHO, RHO_T, I0, I1, U, V, OMEGA, YIELD, SHARE, A, B, ASIDE = (
    LANES * field for field in range(16)
)
TANGENT_X, TANGENT_Y = LANES * 16, LANES * 17
LAYER = LANES * 18


def scratch(nodes: int, rows: int, modes: int) -> Work:
    """Return the scratch for so many nodes across the film, rows and exponentials."""
    return Work(
        cells=np.zeros(rows // BLOCK * (LINE + nodes * LAYER)),
        matrix=np.zeros(nodes * (nodes + 1) * BLOCK),
        terms=np.zeros((BLOCK, TERMS)),
        mass=np.zeros((3, nodes, rows)),
        mass_y=np.zeros((nodes, rows + 2)),
        modes=np.zeros((2, modes, rows)),
        change=np.zeros(BLOCK),
        back=np.zeros(1),
    )


@njit(cache=True)
def moved(place: Place, i: int, block: int) -> Place:
    """Return a block of station ``i``."""
    base = block * (LINE + place.n * LAYER)
    return Place(i, block * BLOCK, base, place.n, place.ny, place.modes)


@njit(cache=True)
def layer(place: Place, k: int) -> int:
    """Return where the cells of layer ``k`` begin."""
    return place.base + LINE + k * LAYER


@njit(cache=True)
def node(place: Place, station: int, k: int) -> int:
    """Return where layer ``k`` of a block begins among the temperatures, ghosts included."""
    row = (place.i + station + GHOSTS) * place.n + k
    return row * (place.ny + 2 * GHOSTS) + GHOSTS + place.j


@njit(cache=True)
def exponential(x: float) -> float:
    """Return exp(x) of lanes to a relative 1e-15, for |x| below 690."""
    shifted = x * LOG2_E + MAGIC
    n = shifted - MAGIC
    r = (x - n * LN2_HIGH) - n * LN2_LOW
    q = r * (1.0 / 479001600.0) + 1.0 / 39916800.0
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
    return (q * r + 1.0) * shifted_power(shifted)


@njit(cache=True)
def load_block(model: Model, fields: Fields, work: Work, place: Place) -> None:
    """Copy what the block needs of the fields to its cells."""
    cells, base, at = work.cells, place.base, place.i * place.ny + place.j
    h, conductivity = load(fields.h, at), load(fields.conductivity, at)
    store(cells, base + P, load(fields.p, at))
    store(cells, base + H, h)
    store(cells, base + PER, h * h / conductivity)
    store(cells, base + PX, load(fields.px, at))
    store(cells, base + PY, load(fields.py, at))
    store(cells, base + CAPACITY, load(fields.capacity, at))
    store(cells, base + CONDUCTIVITY, conductivity)
    store(cells, base + STRESS, load(fields.stress, at))
    store(cells, base + TAU_X, load(fields.tau_x, at))
    store(cells, base + TAU_Y, load(fields.tau_y, at))
    store(cells, base + PT, 0.0 * h)
    if model.terms.over_t > 0.0:
        store(cells, base + PT, load(fields.pressing, at))
    for k in range(place.n):
        store(cells, layer(place, k) + T, load(fields.temperature, node(place, 0, k)))


@njit(cache=True)
def coefficients(laws: Laws, work: Work, place: Place) -> None:
    """Interpolate the polynomials of the laws to the pressures of the block."""
    fluid, last, terms = laws.fluid, laws.last_row, work.terms
    for lane in range(BLOCK):
        p = number(work.cells, place.base + P + lane)
        x = math.log(1.0 + laws.per_scale * max(p, 0.0)) * laws.per_row
        row = max(min(int(x), last), 0)
        s = min(x - row, 1.0)
        r = 1.0 - s
        p0, p1 = r * r * (1.0 + 2.0 * s), s * r * r
        p2, p3 = s * s * (3.0 - 2.0 * s), -s * s * r
        for c in range(0, TERMS, LANES):
            at = 2 * TERMS * row + c
            value = p0 * load(fluid, at) + p1 * load(fluid, at + TERMS)
            value += p2 * load(fluid, at + 2 * TERMS) + p3 * load(fluid, at + 3 * TERMS)
            store(terms, lane * TERMS + c, value)
    for c in range(TERMS):
        for lane in range(BLOCK):
            at = place.base + ETA + c * LANES + lane
            put(work.cells, at, number(terms, lane * TERMS + c))


@njit(cache=True)
def horner(cells: Array, first: int, count: int, t: float) -> tuple[float, float]:
    """Return a polynomial and its slope at ``t``; coefficients from ``first`` on."""
    value, slope = load(cells, first + (count - 1) * LANES), 0.0 * t
    for c in range(count - 2, -1, -1):
        slope = slope * t + value
        value = value * t + load(cells, first + c * LANES)
    return value, slope


@njit(cache=True)
def limited(ln_eta: float) -> float:
    """Return ln eta where its exponential is a number."""
    return lower(upper(ln_eta, -LARGEST_EXPONENT), LARGEST_EXPONENT)


@njit(cache=True)
def look_up(laws: Laws, work: Work, place: Place, k: int, temperature: float) -> None:
    """Fill ln eta, its slope by -T, rho and rho_T of layer ``k``."""
    cells, here = work.cells, layer(place, k)
    kelvin = lower(upper(temperature, laws.coldest), laws.hottest)
    inverse = 1.0 / (kelvin - laws.pole)
    t = (inverse - laws.middle) * laws.over_inverse
    value, slope = horner(cells, place.base + ETA, ETA_TERMS, t)
    store(cells, here + LN_ETA, limited(value))
    store(cells, here + SLOPE, slope * inverse * inverse * laws.over_inverse)
    t = (kelvin - laws.inlet) * laws.over_rise
    value, slope = horner(cells, place.base + DENSITY, RHO_TERMS, t)
    store(cells, here + RHO, value)
    store(cells, here + RHO_T, slope * laws.over_rise)


@njit(cache=True)
def mean_temperature(across: Across, work: Work, place: Place) -> float:
    """Return the temperature averaged across the film."""
    mean = 0.0 * load(work.cells, layer(place, 0) + T)
    for k in range(place.n):
        mean += number(across.weights, k) * load(work.cells, layer(place, k) + T)
    return mean


@njit(cache=True)
def evaluate_laws(model: Model, work: Work, place: Place) -> None:
    """Fill viscosity, density and their slopes at all layers."""
    coefficients(model.laws, work, place)
    mean = mean_temperature(model.across, work, place)
    for k in range(place.n):
        here = load(work.cells, layer(place, k) + T)
        look_up(model.laws, work, place, k, mean if model.terms.mean == 2 else here)


@njit(cache=True)
def follow_temperature(model: Model, fields: Fields, work: Work, place: Place) -> None:
    """Take the new temperatures, which are in ``A``, and let laws and stress follow to first order.

    No temperature changes by more than the largest step. What counts is where there is pressure.
    """
    cells = work.cells
    mean = 0.0 * load(cells, place.base + P)
    most, fall = mean, mean
    for k in range(place.n):
        here = layer(place, k)
        old = load(cells, here + T)
        step = lower(upper(load(cells, here + A) - old, -LARGEST_STEP), LARGEST_STEP)
        store(cells, here + A, step)
        store(cells, here + T, old + step)
        store(fields.temperature, node(place, 0, k), old + step)
        mean += number(model.across.weights, k) * step
        fall += load(cells, here + SHARE) * step
        most = upper(most, size(step))
    fall = lower(upper(fall, -LARGEST_FALL), LARGEST_FALL)
    for tau in (TAU_X, TAU_Y):
        store(cells, place.base + tau, load(cells, place.base + tau) * (1.0 - fall))
    for k in range(place.n):
        here = layer(place, k)
        step = mean if model.terms.mean == 2 else load(cells, here + A)
        thinner = load(cells, here + SLOPE) * step
        store(cells, here + LN_ETA, limited(load(cells, here + LN_ETA) - thinner))
        store(cells, here + RHO, load(cells, here + RHO) + load(cells, here + RHO_T) * step)
        growth = thinner - (load(cells, here + YIELD) - 1.0) * fall
        growth = exponential(lower(upper(growth, -LARGEST_GROWTH), LARGEST_GROWTH))
        for quantity in (FLUIDITY, TANGENT_X, TANGENT_Y):
            store(cells, here + quantity, load(cells, here + quantity) * growth)
    counts = if_positive(load(cells, place.base + P) - PRESSURISED, most, 0.0)
    store(work.change, 0, upper(load(work.change, 0), counts))


@njit(cache=True)
def fluidities(work: Work, place: Place) -> None:
    """Fill the Newtonian fluidity, one over the viscosity."""
    for k in range(place.n):
        here = layer(place, k)
        store(work.cells, here + FLUIDITY, exponential(-1.0 * load(work.cells, here + LN_ETA)))
        store(work.cells, here + YIELD, 1.0)


@njit(cache=True)
def thinning(laws: Laws, stress: float) -> tuple[float, float]:
    """Return F and s dlnF/ds at dimensionless stresses; ln F is linear beyond the table."""
    table, last = laws.thinning, laws.last_stress
    end = (last + 1) / laws.per_stress
    s = lower(stress, end / (1.0 - end))
    part = 1.0 / (1.0 + s)
    x = s * part * laws.per_stress
    row = lower(whole(x), float(last))
    t = x - row
    start, first, end_value, second = gather(table, row)
    rise = end_value - start
    square, cube = 3.0 * rise - 2.0 * first - second, first + second - 2.0 * rise
    slope = (first + t * (2.0 * square + 3.0 * t * cube)) * (laws.per_stress * part * part)
    log_f = start + t * (first + t * (square + t * cube)) + (stress - s) * slope
    return exponential(lower(log_f, LARGEST_THINNING)), slope * stress


@njit(cache=True)
def stress_at(model: Model, work: Work, place: Place, arm: float) -> tuple[float, float]:
    """Return both stresses at ``arm`` from mid-film: linear, by the pressure gradient."""
    cells, base = work.cells, place.base
    tilt = (model.terms.poiseuille * arm) * load(cells, base + H)
    x = load(cells, base + TAU_X) + tilt * load(cells, base + PX)
    y = load(cells, base + TAU_Y) + tilt * load(cells, base + PY)
    return x, y


@njit(cache=True)
def note_thinning(model: Model, work: Work, place: Place) -> None:
    """Note whether the oil thins anywhere in the block, by the last stress at both walls."""
    thins = 0.0
    if not model.laws.newtonian:
        for arm in (-0.5, 0.5):
            x, y = stress_at(model, work, place, arm)
            stress = load(work.cells, place.base + STRESS) * root(x * x + y * y)
            thins = max(thins, largest(stress))
    put(work.cells, place.base + THINS, 1.0 if thins > model.laws.gentle else 0.0)


@njit(cache=True)
def thins(work: Work, place: Place) -> bool:
    """Return what was noted of the block."""
    return number(work.cells, place.base + THINS) > 0.0


@njit(cache=True)
def thinning_arm(model: Model, k: int) -> float:
    """Return how far from mid-film the stress is taken by which layer ``k`` thins."""
    return 0.0 if model.laws.uniform else number(model.across.zeta, k) - 0.5


@njit(cache=True)
def growth(model: Model, rate: float, work: Work, place: Place) -> float:
    """Return Newton's step for the logarithm of the rate over that for the rate.

    It is one where the sliding has no sign, or the rate not that of the sliding.
    """
    cells, at = work.cells, place.base + PULL
    ratio = model.terms.slide / load(cells, place.base + H) / (rate + 1e-300)
    store(cells, at, lower(upper(ratio, 1e-9), 1e9))
    for lane in range(BLOCK):
        value = number(cells, at + lane)
        other = value - 1.0
        put(cells, at + lane, math.log(value) / other if abs(other) > 1e-6 else 1.0)
    return if_positive(rate * model.terms.slide, load(cells, at), 1.0)


@njit(cache=True)
def newton_step(model: Model, work: Work, place: Place) -> float:
    """Improve the mid-film stress so that the film is sheared by the sliding speed.

    Both components; the rate is ``F(s) tau/eta`` with ``s = |tau|`` over the scale of the law. The
    problem is convex; a step is no longer than that scale and half the stress. The fluidity is
    Newtonian. Return the largest step over the scale.
    """
    cells, base = work.cells, place.base
    scale = load(cells, base + STRESS)
    zero = 0.0 * scale
    rate_x, rate_y, xx, xy, yy = zero, zero, zero, zero, zero
    for k in range(place.n):
        x, y = stress_at(model, work, place, thinning_arm(model, k))
        square = x * x + y * y
        thinner, bend = thinning(model.laws, root(square) * scale)
        rate = load(cells, layer(place, k) + FLUIDITY) * number(model.across.weights, k) * thinner
        more = rate * bend / (square + 1e-300)
        rate_x += rate * x
        rate_y += rate * y
        xx += rate + more * x * x
        xy += more * x * y
        yy += rate + more * y * y
    grown = growth(model, rate_x, work, place)
    rate_x -= model.terms.slide / load(cells, base + H)
    per_det = 1.0 / (xx * yy - xy * xy)
    dx = (yy * rate_x - xy * rate_y) * per_det
    dy = (xx * rate_y - xy * rate_x) * per_det
    step = scale * root(dx * dx + dy * dy)
    x, y = load(cells, base + TAU_X), load(cells, base + TAU_Y)
    longest = 1.0 + 0.5 * scale * root(x * x + y * y)
    limit = grown * lower(longest / (grown * step + 1e-300), 1.0)
    x, y = x - limit * dx, y - limit * dy
    if model.laws.uniform:
        part = lower(BEYOND_LIMIT / (scale * root(x * x + y * y) + 1e-300), 1.0)
        x, y = part * x, part * y
    store(cells, base + TAU_X, x)
    store(cells, base + TAU_Y, y)
    return largest(step)


@njit(cache=True)
def thin(model: Model, work: Work, place: Place, steps: int) -> None:
    """Find the mid-film stress in some Newton steps, and multiply the fluidity by F there.

    ``YIELD`` is how fast the rate grows with the stress, both as logarithms; ``TANGENT_X`` and
    ``TANGENT_Y`` the fluidity of a small change of the stress along x or y, ``ASKEW`` by how much
    the latter exceeds the fluidity, relatively, at most.
    """
    cells, along = work.cells, 0.0 if model.laws.uniform else 1.0
    askew = 0.0 * load(cells, place.base + P)
    for _ in range(steps):
        if newton_step(model, work, place) < SETTLED:
            break
    for k in range(place.n):
        here = layer(place, k)
        x, y = stress_at(model, work, place, thinning_arm(model, k))
        square = x * x + y * y
        thinner, bend = thinning(model.laws, root(square) * load(cells, place.base + STRESS))
        fluid, more = load(cells, here + FLUIDITY) * thinner, along * bend / (square + 1e-300)
        store(cells, here + FLUIDITY, fluid)
        store(cells, here + YIELD, 1.0 + bend)
        store(cells, here + TANGENT_X, fluid * (1.0 + more * x * x))
        store(cells, here + TANGENT_Y, fluid * (1.0 + more * y * y))
        askew = upper(askew, more * y * y)
    put(cells, place.base + ASKEW, largest(askew))


@njit(cache=True)
def reach(across: Across, k: int, n: int) -> tuple[int, int]:
    """Return the first layer that the matrices join with layer ``k``, and one past the last."""
    return max(k - across.band, 0), min(k + across.band, n - 1) + 1


@njit(cache=True)
def moments(across: Across, fluid: int, work: Work, place: Place) -> None:
    """Fill ``I0, I1``: integrals of ``fluid`` and of it times the distance from mid-film."""
    cells, n = work.cells, place.n
    i0 = 0.0 * load(cells, place.base + P)
    i1 = i0
    for k in range(n):
        first, stop = reach(across, k, n)
        more, turned = 0.0 * i0, 0.0 * i0
        for m in range(first, stop):
            value = load(cells, layer(place, m) + fluid)
            more += number(across.step, k * n + m) * value
            turned += number(across.turn, k * n + m) * value
        i0 += more
        i1 += turned
        store(cells, layer(place, k) + I0, i0)
        store(cells, layer(place, k) + I1, i1)


@njit(cache=True)
def velocities(model: Model, work: Work, place: Place) -> None:
    """Fill the velocities; where nothing thins they tell the mid-film stress as well."""
    cells, base, terms = work.cells, place.base, model.terms
    h, p_x, p_y = load(cells, base + H), load(cells, base + PX), load(cells, base + PY)
    wall = layer(place, place.n - 1)
    over_i0 = 1.0 / load(cells, wall + I0)
    tilt = terms.poiseuille * h * load(cells, wall + I1)
    tau_x, tau_y = (terms.slide / h - tilt * p_x) * over_i0, -1.0 * tilt * p_y * over_i0
    if not thins(work, place):
        store(cells, base + TAU_X, tau_x)
        store(cells, base + TAU_Y, tau_y)
    for k in range(place.n):
        here = layer(place, k)
        i0, slope = load(cells, here + I0), terms.poiseuille * h * h * load(cells, here + I1)
        store(cells, here + U, terms.speed + h * tau_x * i0 + slope * p_x)
        store(cells, here + V, h * tau_y * i0 + slope * p_y)


@njit(cache=True)
def flow(model: Model, steps: int, work: Work, place: Place) -> None:
    """Find stress and velocities of a block at the viscosities in its cells.

    A block that did not thin may do so now: the Newtonian stress tells, which is the larger one.
    """
    cells, base = work.cells, place.base
    x, y = load(cells, base + TAU_X), load(cells, base + TAU_Y)
    fluidities(work, place)
    note_thinning(model, work, place)
    if not thins(work, place):
        moments(model.across, FLUIDITY, work, place)
        velocities(model, work, place)
        note_thinning(model, work, place)
        if not thins(work, place):
            return
        store(cells, base + TAU_X, x)
        store(cells, base + TAU_Y, y)
    thin(model, work, place, steps)
    moments(model.across, FLUIDITY, work, place)
    velocities(model, work, place)


@njit(cache=True)
def mass_fluxes(across: Across, work: Work, place: Place) -> None:
    """Fill the cumulative mass fluxes along x and y."""
    cells, n, ny = work.cells, place.n, place.ny
    h = load(cells, place.base + H)
    for k in range(n):
        here = layer(place, k)
        dense = h * load(cells, here + RHO)
        store(cells, here + A, dense * load(cells, here + U))
        store(cells, here + B, dense * load(cells, here + V))
    along, sideways = 0.0 * h, 0.0 * h
    for k in range(n):
        first, stop = reach(across, k, n)
        east, north = 0.0 * h, 0.0 * h
        for m in range(first, stop):
            weight = number(across.step, k * n + m)
            east += weight * load(cells, layer(place, m) + A)
            north += weight * load(cells, layer(place, m) + B)
        along += east
        sideways += north
        store(work.mass, (place.i % 3 * n + k) * ny + place.j, along)
        store(work.mass_y, k * (ny + 2) + 1 + place.j, sideways)


@njit(cache=True)
def complete_mass(terms: Terms, work: Work, place: Place) -> None:
    """Fill the ghost rows of the mass flux, and at the first two stations those before the grid."""
    i, n, ny = place.i, place.n, place.ny
    for k in range(n):
        side = k * (ny + 2)
        first, second = number(work.mass_y, side + 1), number(work.mass_y, side + 2)
        put(work.mass_y, side, -second if terms.mirror else 2.0 * first - second)
        last, other = number(work.mass_y, side + ny), number(work.mass_y, side + ny - 1)
        put(work.mass_y, side + ny + 1, 2.0 * last - other)
    if i > 1:
        return
    size = n * ny
    here, last, before = (i % 3) * size, ((i - 1) % 3) * size, ((i - 2) % 3) * size
    for at in range(0, size, LANES):
        now = load(work.mass, here + at)
        if i == 0:
            store(work.mass, last + at, now)
        store(work.mass, before + at, 2.0 * load(work.mass, last + at) - now)


@njit(cache=True)
def cross_flow(model: Model, work: Work, place: Place) -> None:
    """Fill ``OMEGA`` with h rho omega, the mass flux through the layers, zero at both walls."""
    cells, terms, n, ny, i = work.cells, model.terms, place.n, place.ny, place.i
    end = 0.0 * load(cells, place.base + P)
    for k in range(n):
        now = load(work.mass, (i % 3 * n + k) * ny + place.j)
        old = load(work.mass, ((i - 1) % 3 * n + k) * ny + place.j)
        older = load(work.mass, ((i - 2) % 3 * n + k) * ny + place.j)
        side = k * (ny + 2) + 1 + place.j
        sideways = load(work.mass_y, side + 1) - load(work.mass_y, side - 1)
        end = -terms.over_x * (terms.w0 * now + terms.w1 * old + terms.w2 * older)
        end -= 0.5 * terms.over_y * sideways
        store(cells, layer(place, k) + OMEGA, end)
    for k in range(n):
        at = layer(place, k) + OMEGA
        store(cells, at, load(cells, at) - number(model.across.zeta, k) * end)


@njit(cache=True)
def shares(across: Across, work: Work, place: Place) -> None:
    """Fill ``SHARE``: by how much the stress falls, relatively, per kelvin of a layer.

    The sliding speed is kept. ``PULL``: by how much at the last temperatures.
    """
    cells = work.cells
    total = 0.0 * load(cells, place.base + P)
    for k in range(place.n):
        here, weight = layer(place, k), number(across.weights, k)
        total += weight * load(cells, here + FLUIDITY) * load(cells, here + YIELD)
    per_total, pull = 1.0 / total, 0.0 * total
    for k in range(place.n):
        here, weight = layer(place, k), number(across.weights, k)
        part = weight * load(cells, here + FLUIDITY) * load(cells, here + SLOPE) * per_total
        store(cells, here + SHARE, part)
        pull += part * load(cells, here + T)
    store(cells, place.base + PULL, pull)


@njit(cache=True)
def heat_sources(model: Model, work: Work, place: Place, k: int) -> tuple[float, float]:
    """Return shear power and compression power in layer ``k``."""
    cells, base, here, terms = work.cells, place.base, layer(place, k), model.terms
    x, y = stress_at(model, work, place, number(model.across.zeta, k) - 0.5)
    shear = terms.brinkman * (x * x + y * y) * load(cells, here + FLUIDITY)
    rise = -terms.compression * load(cells, here + T) / load(cells, here + RHO)
    flow_x = load(cells, here + U) * load(cells, base + PX)
    flow_y = load(cells, here + V) * load(cells, base + PY)
    return shear, rise * load(cells, here + RHO_T) * (flow_x + flow_y + load(cells, base + PT))


@njit(cache=True)
def hold(along: float) -> float:
    """Return how much second order conduction across the film holds: two less, 0 to 1."""
    return lower(upper(2.0 - along * (1.0 / CONDUCTION), 0.0), 1.0)


@njit(cache=True)
def convection(
    model: Model, fields: Fields, work: Work, place: Place, k: int
) -> tuple[float, float]:
    """Return the diagonal of convection and change in time, and what neighbours and past bring.

    Those across and, against the march, along x are of the last sweep: there the upstream
    difference is of second order only where conduction across the film holds it.
    """
    cells, base, here, terms = work.cells, place.base, layer(place, k), model.terms
    u, v, t = load(cells, here + U), load(cells, here + V), fields.temperature
    dense = load(cells, base + PER) * (
        terms.peclet * load(cells, base + CAPACITY) * load(cells, here + RHO)
    )
    along = dense * size(u) * terms.over_x
    one = if_positive(u, load(t, node(place, -1, k)), load(t, node(place, 1, k)))
    two = if_positive(u, load(t, node(place, -2, k)), load(t, node(place, 2, k)))
    second = terms.w2 * if_positive(u, 1.0, hold(along))
    diagonal = (1.0 + second) * along
    rest = along * (one + second * (2.0 * one - two))
    sideways, at = dense * size(v) * terms.over_y, node(place, 0, k)
    one = if_positive(v, load(t, at - 1), load(t, at + 1))
    two = if_positive(v, load(t, at - 2), load(t, at + 2))
    third = terms.w2 * hold(sideways)
    diagonal += (1.0 + third) * sideways
    rest += sideways * (one + third * (2.0 * one - two))
    store(cells, here + ASIDE, if_positive(v, sideways, -1.0 * sideways))
    if terms.over_t > 0.0:
        diagonal += dense * terms.over_t
        rest += dense * load(fields.past, (place.i * place.n + k) * place.ny + place.j)
    return diagonal, rest


@njit(cache=True)
def inner_row(model: Model, fields: Fields, work: Work, place: Place, k: int) -> None:
    """Fill the row of an inner layer.

    A warmer layer shears faster, and the stress falls for all of them at a given sliding speed: the
    first is held back where it would outweigh the conduction; banded matrices have room for a safe
    diagonal only. Neither changes the solution.
    """
    across, cells, base, n = model.across, work.cells, place.base, place.n
    here, full = layer(place, k), model.across.band == place.n - 1
    h, per = load(cells, base + H), load(cells, base + PER)
    shear, compression = heat_sources(model, work, place, k)
    diagonal, rest = convection(model, fields, work, place, k)
    heat = per * shear
    rest += heat + per * compression
    steep = load(cells, here + SLOPE) * heat
    part = -1.0 * lower(CONDUCTION / (steep + 1e-300), 1.0) if full else 1.0 + 0.0 * steep
    held = heat * (load(cells, here + YIELD) - part) if full else 0.0 * heat
    capacity = model.terms.peclet * load(cells, base + CAPACITY)
    omega = load(cells, here + OMEGA) * capacity * h / load(cells, base + CONDUCTIVITY)
    rest += part * steep * load(cells, here + T) + held * load(cells, base + PULL)
    first, stop = reach(across, k, n)
    for m in range(first, stop):
        at, share = k * n + m, load(cells, layer(place, m) + SHARE)
        flow_and_heat = omega * number(across.d1, at) - number(across.d2, at)
        store(work.matrix, at * LANES, flow_and_heat + held * share)
    at = (k * n + k) * LANES
    store(work.matrix, at, load(work.matrix, at) + diagonal + part * steep)
    zeta, step = number(across.zeta, k), number(across.zeta, k + 1) - number(across.zeta, k - 1)
    to_walls = HELD_BY_WALLS / (zeta * (1.0 - zeta)) ** 2
    out = diagonal + size(omega) * (2.0 / step) + to_walls
    store(cells, here + ASIDE, load(cells, here + ASIDE) / out)
    store(work.matrix, (n * n + k) * LANES, rest)


@njit(cache=True)
def inner_rows(model: Model, fields: Fields, work: Work, place: Place) -> None:
    """Fill the rows of all inner layers."""
    cross_flow(model, work, place)
    shares(model.across, work, place)
    for k in range(1, place.n - 1):
        inner_row(model, fields, work, place, k)


@njit(cache=True)
def carry_modes(surface: Surface, side: int, work: Work, place: Place) -> float:
    """Carry the exponentials of a surface on to this station; return their sum."""
    at, ny = (place.i + GHOSTS) * place.ny + place.j, place.ny
    two, one = load(surface.flux, at - 2 * ny), load(surface.flux, at - ny)
    past, count = surface.next_ * one, place.modes
    for m in range(count):
        place_m = (side * count + m) * ny + place.j
        mode = number(surface.decay, m) * load(work.modes, place_m)
        mode += number(surface.older, m) * two + number(surface.newer, m) * one
        store(work.modes, place_m, mode)
        past += mode
    return past


@njit(cache=True)
def wall_row(across: Across, surface: Surface, side: int, work: Work, place: Place) -> None:
    """Fill the row of a wall: its temperature is bulk plus what the heat of the line has done."""
    cells, base, n = work.cells, place.base, place.n
    wall, sign = side * (n - 1), 1.0 - 2.0 * side
    past = carry_modes(surface, side, work, place)
    over_h = load(cells, base + CONDUCTIVITY) / load(cells, base + H)
    first, stop = reach(across, wall, n)
    for m in range(first, stop):
        at = wall * n + m
        weight = sign * surface.factor * surface.near * number(across.d1, at)
        unit = 1.0 if m == wall else 0.0
        store(work.matrix, at * LANES, unit - weight * over_h)
    bulk = load(surface.bulk, place.i * place.ny + place.j)
    store(work.matrix, (n * n + wall) * LANES, bulk + surface.factor * past)


@njit(cache=True)
def eliminate(matrix: Array, n: int, band: int, c: int) -> None:
    """Take unknown ``c`` out of the rows below; its diagonal becomes its inverse."""
    stop = min(c + band, n - 1) + 1
    pivot = c * n
    inverse = 1.0 / load(matrix, (pivot + c) * LANES)
    store(matrix, (pivot + c) * LANES, inverse)
    known = load(matrix, (n * n + c) * LANES)
    for r in range(c + 1, stop):
        factor = load(matrix, (r * n + c) * LANES) * inverse
        for m in range(c + 1, stop):
            at = (r * n + m) * LANES
            store(matrix, at, load(matrix, at) - factor * load(matrix, (pivot + m) * LANES))
        at = (n * n + r) * LANES
        store(matrix, at, load(matrix, at) - factor * known)


@njit(cache=True)
def solve_columns(matrix: Array, n: int, band: int) -> None:
    """Solve the columns of a block without pivoting; the solution takes the right-hand sides."""
    for c in range(n):
        eliminate(matrix, n, band, c)
    for c in range(n - 1, -1, -1):
        value = load(matrix, (n * n + c) * LANES)
        for m in range(c + 1, min(c + band, n - 1) + 1):
            value -= load(matrix, (c * n + m) * LANES) * load(matrix, (n * n + m) * LANES)
        store(matrix, (n * n + c) * LANES, value * load(matrix, (c * n + c) * LANES))


@njit(cache=True)
def heat_block(
    model: Model, fields: Fields, surfaces: tuple[Surface, Surface], work: Work, place: Place
) -> None:
    """Solve the energy equation in the columns of a block; the solution is in ``A``."""
    inner_rows(model, fields, work, place)
    for side in range(2):
        wall_row(model.across, surfaces[side], side, work, place)
    solve_block(model, work, place)


@njit(cache=True)
def solve_block(model: Model, work: Work, place: Place) -> None:
    """Solve the columns of a block; the solution is in ``A``."""
    n = place.n
    solve_columns(work.matrix, n, model.across.band)
    for k in range(n):
        store(work.cells, layer(place, k) + A, load(work.matrix, (n * n + k) * LANES))


@njit(cache=True)
def carry_aside(work: Work, start: Place) -> None:
    """Let the rows follow the change of the row that the oil comes from, station by station.

    The columns take their neighbours from the last sweep, so that what flows across would move on
    by one row per sweep. Changes follow the flow outwards, then inwards, with the part that the
    inflow has in the balance of a column; that does not change the solution.
    """
    cells, changes = work.cells, work.terms  # of the row before, one per layer
    for step in (1, -1):
        row = 0 if step > 0 else start.ny - 1
        for k in range(1, start.n - 1):
            put(changes, k, 0.0)
        for _ in range(start.ny):
            first = row // BLOCK * (LINE + start.n * LAYER) + LINE + row % BLOCK
            for k in range(1, start.n - 1):
                at = first + k * LAYER
                part = step * number(cells, at + ASIDE)
                new = number(cells, at + A)
                if part > 0.0:
                    new += part * number(changes, k)
                    put(cells, at + A, new)
                put(changes, k, new - number(cells, at + T))
            row += step


@njit(cache=True)
def mobility(across: Across, work: Work, place: Place) -> float:
    """Return the generalised mobility ``12 (eta_e rho'_e/eta'_e - rho''_e)``.

    Yang and Wen 1990; the moments about mid-film give the same and lose no digits.
    """
    cells, wall = work.cells, layer(place, place.n - 1)
    tilt = load(cells, wall + I1) / load(cells, wall + I0)
    total = 0.0 * tilt
    for k in range(place.n):
        here, weight = layer(place, k), 12.0 * number(across.weights, k)
        arm = tilt * load(cells, here + I0) - load(cells, here + I1)
        total += weight * load(cells, here + RHO) * arm
    return total


@njit(cache=True)
def reynolds_fields(model: Model, fields: Fields, work: Work, place: Place) -> None:
    """Write mobility and density of the Reynolds equation, and how they follow the pressure.

    The density is that of the Couette flux over h u_m; ``stretch_x`` is by how much more a small
    change of the gradient along x moves, the sliding being kept, ``stretch_y`` that along y.
    """
    cells, terms, at = work.cells, model.terms, place.i * place.ny + place.j
    middle = layer(place, place.n // 2)
    whole_mobility = mobility(model.across, work, place)
    store(fields.mobility, at, whole_mobility)
    per_i0 = terms.slide / load(cells, layer(place, place.n - 1) + I0)
    density, held = 0.0 * per_i0, 0.0 * per_i0
    for k in range(place.n):
        here, weight = layer(place, k), number(model.across.weights, k)
        speed, rho = terms.speed + per_i0 * load(cells, here + I0), load(cells, here + RHO)
        density += weight * rho * speed
        held += weight * rho
    store(fields.density, at, density)
    store(fields.held, at, held)
    store(fields.steep, at, 1.0 / load(cells, middle + YIELD))
    newtonian = exponential(-1.0 * load(cells, middle + LN_ETA))
    store(fields.effective, at, newtonian / load(cells, middle + FLUIDITY))
    store(fields.stretch_x, at, 1.0)
    store(fields.stretch_y, at, 1.0)
    if thins(work, place):
        moments(model.across, TANGENT_X, work, place)
        store(fields.stretch_x, at, mobility(model.across, work, place) / whole_mobility)
    if thins(work, place) and number(cells, place.base + ASKEW) > STRAIGHT:
        moments(model.across, TANGENT_Y, work, place)
        store(fields.stretch_y, at, mobility(model.across, work, place) / whole_mobility)


@njit(cache=True)
def mean_fields(model: Model, fields: Fields, work: Work, place: Place) -> None:
    """Write mobility and density of the Reynolds equation with properties at the mean temperature.

    The thinning is that of mid-film.
    """
    at, first = place.i * place.ny + place.j, layer(place, 0)
    look_up(model.laws, work, place, 0, mean_temperature(model.across, work, place))
    rho = load(work.cells, first + RHO)
    fluid = exponential(-1.0 * load(work.cells, first + LN_ETA))
    store(fields.mobility, at, rho * fluid / load(fields.effective, at))
    store(fields.density, at, rho)
    store(fields.held, at, rho)


@njit(cache=True)
def powers(model: Model, fields: Fields, work: Work, place: Place) -> None:
    """Write mid-film stress, shear power, compression power and enthalpy fluxes."""
    cells, base, terms = work.cells, place.base, model.terms
    at, h = place.i * place.ny + place.j, load(cells, base + H)
    capacity = terms.peclet * load(cells, base + CAPACITY)
    shear, compression, along, sideways = 0.0 * h, 0.0 * h, 0.0 * h, 0.0 * h
    for k in range(place.n):
        here, weight = layer(place, k), number(model.across.weights, k) * h
        power, rise = heat_sources(model, work, place, k)
        shear += weight * power
        compression += weight * rise
        warmer = load(cells, here + T) - terms.inlet
        excess = weight * capacity * load(cells, here + RHO) * warmer
        along += excess * load(cells, here + U)
        sideways += excess * load(cells, here + V)
    store(fields.shear, at, shear)
    store(fields.work, at, compression)
    store(fields.enthalpy_x, at, along)
    store(fields.enthalpy_y, at, sideways)
    store(fields.tau_x, at, load(cells, base + TAU_X))
    store(fields.tau_y, at, load(cells, base + TAU_Y))


@njit(cache=True)
def store_flux(across: Across, surface: Surface, side: int, work: Work, place: Place) -> None:
    """Write the heat that flows into a surface."""
    cells, n = work.cells, place.n
    wall, sign = side * (n - 1), 1.0 - 2.0 * side
    flux = 0.0 * load(cells, place.base + H)
    first, stop = reach(across, wall, n)
    for m in range(first, stop):
        flux += (sign * number(across.d1, wall * n + m)) * load(cells, layer(place, m) + T)
    flux *= load(cells, place.base + CONDUCTIVITY) / load(cells, place.base + H)
    store(surface.flux, (place.i + GHOSTS) * place.ny + place.j, flux)


@njit(cache=True)
def write_block(
    model: Model, fields: Fields, surfaces: tuple[Surface, Surface], work: Work, place: Place
) -> None:
    """Write all that the block tells about the film."""
    for side in range(2):
        store_flux(model.across, surfaces[side], side, work, place)
    powers(model, fields, work, place)
    reynolds_fields(model, fields, work, place)
    if model.terms.mean == 1:
        mean_fields(model, fields, work, place)


@njit(cache=True)
def mirror_station(temperature: Array, place: Place) -> None:
    """Fill the ghost rows of a symmetry line."""
    for k in range(place.n):
        first = node(place, 0, k)
        put(temperature, first - 1, number(temperature, first + 1))
        put(temperature, first - 2, number(temperature, first + 2))


@njit(cache=True)
def flow_of_block(model: Model, fields: Fields, work: Work, place: Place, steps: int) -> None:
    """Evaluate laws, flow and mass fluxes of a block at its last temperature."""
    load_block(model, fields, work, place)
    evaluate_laws(model, work, place)
    flow(model, steps, work, place)
    mass_fluxes(model.across, work, place)
    slowest = load(work.cells, layer(place, 0) + U)
    for k in range(1, place.n):
        slowest = lower(slowest, load(work.cells, layer(place, k) + U))
    if largest(-1.0 * slowest) > 0.0:
        put(work.back, 0, max(number(work.back, 0), place.i + 1.0))


@njit(cache=True)
def march(
    model: Model,
    fields: Fields,
    surfaces: tuple[Surface, Surface],
    work: Work,
    start: Place,
    numbers: tuple[int, int],
) -> None:
    """Solve one station after the other; see `sweep`.

    All arrays are given by their addresses; ``numbers``: stations, and Newton steps. Temperatures
    are taken only when all blocks of a station are solved, for they look at their neighbours.
    """
    heat, blocks = model.terms.heat, start.ny // BLOCK
    for i in range(numbers[0]):
        if model.terms.mirror:
            mirror_station(fields.temperature, moved(start, i, 0))
        for block in range(blocks):
            flow_of_block(model, fields, work, moved(start, i, block), numbers[1])
        if heat:
            complete_mass(model.terms, work, moved(start, i, 0))
            for block in range(blocks):
                heat_block(model, fields, surfaces, work, moved(start, i, block))
            carry_aside(work, start)
        for block in range(blocks):
            place = moved(start, i, block)
            if heat:
                follow_temperature(model, fields, work, place)
                moments(model.across, FLUIDITY, work, place)
                velocities(model, work, place)
            write_block(model, fields, surfaces, work, place)


@njit(cache=True)
def keep_wall(side: int, work: Work, place: Place) -> None:
    """Fill the row of a wall that keeps its temperature."""
    n, wall = place.n, side * (place.n - 1)
    for m in range(n):
        store(work.matrix, (wall * n + m) * LANES, 1.0 if m == wall else 0.0)
    here = load(work.cells, layer(place, wall) + T)
    store(work.matrix, (n * n + wall) * LANES, here)


@njit(cache=True)
def flow_before(
    model: Model, fields: Fields, work: Work, start: Place, numbers: tuple[int, int]
) -> None:
    """Evaluate a station, and before it those upstream whose mass flux is not known yet.

    ``numbers``: the station, and one for the first station of the march.
    """
    i, first = numbers
    for station in (i - 1, i - 2, i):
        if station >= 0 and (first or station != i - 1):
            for block in range(start.ny // BLOCK):
                flow_of_block(model, fields, work, moved(start, station, block), 1)
    complete_mass(model.terms, work, moved(start, i, 0))


@njit(cache=True)
def march_back(model: Model, fields: Fields, work: Work, start: Place) -> None:
    """Solve the stations against the march, from the last one with backflow on.

    What flows back settles at one station per sweep of the other march. The walls keep their
    temperature.
    """
    blocks, last = start.ny // BLOCK, int(number(work.back, 0)) - 1
    for i in range(last, -1, -1):
        if model.terms.mirror:
            mirror_station(fields.temperature, moved(start, i, 0))
        flow_before(model, fields, work, start, (i, 1 if i == last else 0))
        for block in range(blocks):
            place = moved(start, i, block)
            inner_rows(model, fields, work, place)
            for side in range(2):
                keep_wall(side, work, place)
            solve_block(model, work, place)
        for block in range(blocks):
            follow_temperature(model, fields, work, moved(start, i, block))


class Known(NamedTuple):
    """All that a sweep works on, by the addresses of the arrays; see `known`."""

    model: Model
    fields: Fields
    surfaces: tuple[Surface, Surface]
    work: Work
    stations: int
    start: Place


def known(model: Model, fields: Fields, surfaces: tuple[Surface, Surface], work: Work) -> Known:
    """Return what a sweep works on; whoever keeps it holds the arrays meanwhile."""
    nx, n, ny = fields.p.shape[0], *work.mass.shape[1:]
    start = Place(i=0, j=0, base=0, n=n, ny=ny, modes=work.modes.shape[1])
    parts = (addresses(model), addresses(fields), addresses(surfaces), addresses(work))
    return Known(*parts, stations=nx, start=start)


def sweep_back(at: Known) -> None:
    """March against x where the last sweep found backflow; only the temperature changes."""
    march_back(at.model, at.fields, at.work, at.start)


def sweep(at: Known, work: Work, steps: int) -> float:
    """March once along x; return the largest change of temperature.

    Each station evaluates laws and flow at its last temperature, solves its columns, and lets the
    laws follow for the fields of the Reynolds equation. Without heat it only evaluates. ``steps``
    is the number of Newton steps for the stress of a thinning film.
    """
    work.modes[:] = 0.0
    work.change[:] = 0.0
    work.back[:] = 0.0
    march(at.model, at.fields, at.surfaces, at.work, at.start, (at.stations, steps))
    return float(work.change.max())
