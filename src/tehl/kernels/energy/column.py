"""Energy equation in the columns of a block: one linear system across the film per row.

    Pe c rho (u T_x + v T_y/kappa + omega/h T_zeta) = k T_zeta,zeta/h^2 + compression + shear

times h^2/k, with the upstream differences and the derivative in time of second order
(docs/theory/thermal.md, energy). The unknowns are the layers of the column; upstream neighbours
along x are known, those along y and downstream are of the last sweep.
"""

from tehl.base.typing import Array, Record, Records
from tehl.kernels.compiled import helper
from tehl.kernels.energy.flow import cross_flow, reach
from tehl.kernels.energy.records import (
    BLOCK,
    GHOSTS,
    NEW_T,
    SIDEWAYS,
    Across,
    Fields,
    Model,
    Place,
    T,
    Terms,
    Work,
)
from tehl.kernels.energy.shear import LEAST_SQUARED_STRESS, stress_at
from tehl.kernels.lanes import LANES, Lanes, greater, lesser, where
from tehl.kernels.raw import lanes

CONDUCTION = 8.0  # a little less than pi^2, the slowest decay across the film


@helper
def _shares(across: Across, line: Record, layers: Records) -> None:
    """Fill ``share``, the relative fall of the stress per kelvin of a layer, and ``pull``.

    ``s_m = w_m phi_m gamma_m / sum w phi n`` with gamma = -dln(eta)/dT, at a given sliding speed.
    ``pull`` is the sum of share times temperature.
    """
    total = 0.0 * line.p
    for k in range(layers.shape[0]):
        here = layers[k]
        total = total + across.weights[k] * here.fluidity * here.exponent
    per_total, pull = 1.0 / total, 0.0 * total
    for k in range(layers.shape[0]):
        here = layers[k]
        part = across.weights[k] * here.fluidity * here.slope * per_total
        here.share = part
        pull = pull + part * here.t
    line.pull = pull


@helper
def heat_sources(model: Model, line: Record, here: Record, k: int) -> tuple[Lanes, Lanes]:
    """Return shear power ``Br phi tau^2`` and compression ``-Cp T rho_T/rho (u.grad p + p_t)``."""
    terms = model.terms
    x, y = stress_at(terms, line, model.across.zeta[k] - 0.5)
    shear = line.sheared * terms.brinkman * (x * x + y * y) * here.fluidity
    rise = -terms.compression * here.t / here.rho * here.rho_t
    return shear, rise * (here.u * line.climb_x + here.v * line.climb_y + line.p_t)


@helper
def _hold(along: Lanes) -> Lanes:
    """Return the weight of second order, 0 to 1, at which conduction across the film is stable."""
    return lesser(greater(2.0 - along * (1.0 / CONDUCTION), 0.0), 1.0)


@helper
def along_x(terms: Terms, temperature: Array, flow: Lanes, u: Lanes, place: tuple[int, int, int]
) -> tuple[Lanes, Lanes]:  # fmt: skip
    """Return diagonal and source of convection along x; ``place``: i, k, j.

    Against the march the difference is of second order only as far as `_hold` allows.
    """
    i, k, j = place
    rows, back = lanes(j), u > 0.0
    one = where(back, temperature[i - 1, k, rows], temperature[i + 1, k, rows])
    two = where(back, temperature[i - 2, k, rows], temperature[i + 2, k, rows])
    second = terms.w2 * where(back, 1.0, _hold(flow))
    return (1.0 + second) * flow, flow * (one + second * (2.0 * one - two))


@helper
def along_y(terms: Terms, temperature: Array, flow: Lanes, v: Lanes, place: tuple[int, int, int]
) -> tuple[Lanes, Lanes]:  # fmt: skip
    """Return diagonal and source of convection along y, with neighbours of the last sweep."""
    i, k, j = place
    south = v > 0.0
    one = where(south, temperature[i, k, lanes(j - 1)], temperature[i, k, lanes(j + 1)])
    two = where(south, temperature[i, k, lanes(j - 2)], temperature[i, k, lanes(j + 2)])
    second = terms.w2 * _hold(flow)
    return (1.0 + second) * flow, flow * (one + second * (2.0 * one - two))


@helper
def _convection(
    model: Model, fields: Fields, line: Record, here: Record, place: tuple[int, int, int]
) -> tuple[Lanes, Lanes]:
    """Return diagonal and source of convection and of the time derivative."""
    terms, (i, k, j) = model.terms, place
    dense = line.h2_over_k * (terms.peclet * line.capacity * here.rho)
    ghosts = (i + GHOSTS, k, j + GHOSTS)
    forward = dense * abs(here.u) * terms.over_x
    diagonal, rest = along_x(terms, fields.temperature, forward, here.u, ghosts)
    sideways = dense * abs(here.v) * line.over_y
    more, brought = along_y(terms, fields.temperature, sideways, here.v, ghosts)
    diagonal = diagonal + more
    rest = rest + brought
    here.sideways = where(here.v > 0.0, sideways, -sideways)
    if terms.over_t > 0.0:
        diagonal = diagonal + dense * terms.over_t
        rest = rest + dense * fields.past[i, k, lanes(j)]
    return diagonal, rest


@helper
def _inner_row(model: Model, fields: Fields, work: Work, place: Place, k: int) -> None:
    """Fill the row of an inner layer.

    The shear heat is linearised: a warmer layer shears faster, and at a given sliding speed the
    stress falls in all layers (`_shares`):
    ``dq_k = q_k (theta_k gamma_k dT_k - (n_k + theta_k) sum_m s_m dT_m)``, exact with theta = 1;
    theta limits the first part to the conduction. A banded matrix has ``-q_k gamma_k dT_k``. The
    converged solution does not depend on it.
    """
    across, line, layers = model.across, work.lines[place.block], work.layers[place.block]
    here, matrix, zeta, rows = layers[k], work.matrix, across.zeta, lanes(0)
    full = across.band == zeta.shape[0] - 1
    shear, compression = heat_sources(model, line, here, k)
    at = (place.i, k, BLOCK * place.block)
    diagonal, rest = _convection(model, fields, line, here, at)
    heat = line.h2_over_k * shear
    gain, part, shared = here.slope * heat, 1.0 + 0.0 * heat, 0.0 * heat
    if full:
        part = -1.0 * lesser(CONDUCTION / (gain + LEAST_SQUARED_STRESS), 1.0)
        shared = heat * (here.exponent - part)
    capacity = model.terms.peclet * line.capacity
    through = here.through * capacity * line.h / line.conductivity
    rest = rest + heat + line.h2_over_k * compression
    work.rhs[k, rows] = rest + part * gain * here.t + shared * line.pull
    first, stop = reach(across, k)
    for m in range(first, stop):
        flow_and_heat = through * across.d1[k, m] - across.d2[k, m]
        matrix[k, m, rows] = flow_and_heat + shared * layers[m].share
    matrix[k, k, rows] = matrix[k, k, rows] + diagonal + part * gain
    # all conduction, not only that to the walls: a change that alternates across a thick film that
    # flows back would be carried too far, and grow from sweep to sweep
    out = diagonal + abs(through) * (2.0 / (zeta[k + 1] - zeta[k - 1])) - across.d2[k, k]
    here.sideways = here.sideways / out


@helper
def inner_rows(model: Model, fields: Fields, work: Work, place: Place) -> None:
    """Fill the rows of all inner layers."""
    cross_flow(model, work, place)
    _shares(model.across, work.lines[place.block], work.layers[place.block])
    for k in range(1, model.across.zeta.shape[0] - 1):
        _inner_row(model, fields, work, place, k)


@helper
def _eliminate(matrix: Array, rhs: Array, band: int, c: int) -> None:
    """Eliminate unknown ``c`` from the rows below; its diagonal becomes its inverse."""
    rows, stop = lanes(0), min(c + band, rhs.shape[0] - 1) + 1
    inverse = 1.0 / matrix[c, c, rows]
    matrix[c, c, rows] = inverse
    known = rhs[c, rows]
    for r in range(c + 1, stop):
        factor = matrix[r, c, rows] * inverse
        for m in range(c + 1, stop):
            matrix[r, m, rows] = matrix[r, m, rows] - factor * matrix[c, m, rows]
        rhs[r, rows] = rhs[r, rows] - factor * known


@helper
def solve_columns(matrix: Array, rhs: Array, band: int) -> None:
    """Solve the columns of a block without pivoting; ``rhs`` becomes the solution."""
    rows, n = lanes(0), rhs.shape[0]
    for c in range(n):
        _eliminate(matrix, rhs, band, c)
    for c in range(n - 1, -1, -1):
        value = 1.0 * rhs[c, rows]
        for m in range(c + 1, min(c + band, n - 1) + 1):
            value = value - matrix[c, m, rows] * rhs[m, rows]
        rhs[c, rows] = value * matrix[c, c, rows]


@helper
def solve_block(model: Model, work: Work, layers: Records) -> None:
    """Solve the columns of a block; the solution is in ``new_t``."""
    solve_columns(work.matrix, work.rhs, model.across.band)
    for k in range(layers.shape[0]):
        here = layers[k]
        here.new_t = work.rhs[k, lanes(0)]


@helper
def carry_sideways(terms: Terms, work: Work) -> None:
    """Add to each row the change of the row upstream along y, weighted by the inflow.

    As columns take their neighbours along y from the last sweep, changes would move by one row per
    sweep. Here they follow the flow outwards, then inwards (an approximate factorisation); the
    converged solution does not depend on it.
    """
    numbers, changes = work.numbers, work.changes
    blocks, n = work.layers.shape
    rows = terms.period + 1 if terms.period > 0 else blocks * LANES
    for step in (1, -1):
        for k in range(1, n - 1):
            changes[k] = 0.0
        for count in range(rows):
            row = count if step > 0 else rows - 1 - count
            block, lane = row // LANES, row % LANES
            for k in range(1, n - 1):
                part = step * numbers[block, k, SIDEWAYS, lane]
                new = numbers[block, k, NEW_T, lane]
                if part > 0.0:
                    new += part * changes[k]
                    numbers[block, k, NEW_T, lane] = new
                changes[k] = new - numbers[block, k, T, lane]


@helper
def join_ends(terms: Terms, work: Work) -> None:
    """Give both ends of a film that wraps the temperature of the one with the inflow.

    They are one row, which `carry_sideways` comes to from either side. Their walls must not part
    either: a flux between the temperatures of two rows grows from station to station.
    """
    numbers, n = work.numbers, work.layers.shape[1]
    if terms.period == 0:
        return
    block, lane = terms.period // LANES, terms.period % LANES
    for k in range(n):
        last, first = numbers[block, k, NEW_T, lane], numbers[0, k, NEW_T, 0]
        new = last if 0 < k < n - 1 and numbers[0, k, SIDEWAYS, 0] > 0.0 else first
        numbers[block, k, NEW_T, lane] = new
        numbers[0, k, NEW_T, 0] = new
