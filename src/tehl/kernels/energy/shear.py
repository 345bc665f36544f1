"""Shear stress of a film that thins: Newton's method for the stress at mid-film.

Momentum makes the stress linear across the film, ``tau(zeta) = tau_m + 12/lambda h grad p
(zeta - 1/2)``. The law of the oil gives the rate at a stress, ``F(s) tau/eta`` with s = |tau| over
its scale. Unknown is ``tau_m``, both components, such that the film is sheared by the sliding
speed: ``h int rate = u2 - u1``, both components (docs/theory/thermal.md, shear thinning).
"""

from tehl.base.typing import Record, Records
from tehl.kernels.compiled import helper
from tehl.kernels.energy.laws import exponential
from tehl.kernels.energy.records import Laws, Model, Terms
from tehl.kernels.lanes import Lanes, greater, largest, lesser, log, lookup, root, truncate, where

LARGEST_THINNING = 350.0  # ln F
SMALL_STRESS = 1e-3  # of a limiting one, below which ln F is a series
SETTLED = 1e-5  # step of the stress over its scale; the error left is of the order of its square
LEAST_SQUARED_STRESS = 1e-300


@helper
def thinning(laws: Laws, stress: Lanes) -> tuple[Lanes, Lanes]:
    """Return F and s dlnF/ds at dimensionless stresses s.

    ln F is interpolated by cubic Hermite polynomials over s/(1 + s), and linear in s beyond the
    table. That of a limiting stress, which a table would not resolve, is computed.
    """
    if laws.knee > 0.0:
        log_f, slope = _limiting(laws, stress)
        return exponential(lesser(log_f, LARGEST_THINNING)), slope * stress
    last = laws.last_stress
    end = (last + 1) / laws.per_stress
    s = lesser(stress, end / (1.0 - end))
    part = 1.0 / (1.0 + s)
    x = s * part * laws.per_stress
    row = lesser(truncate(x), float(last))
    t = x - row
    start, first, end_value, second = lookup(laws.thinning, row)
    rise = end_value - start
    square, cube = 3.0 * rise - 2.0 * first - second, first + second - 2.0 * rise
    slope = (first + t * (2.0 * square + 3.0 * t * cube)) * (laws.per_stress * part * part)
    log_f = start + t * (first + t * (square + t * cube)) + (stress - s) * slope
    return exponential(lesser(log_f, LARGEST_THINNING)), slope * stress


@helper
def _limiting(laws: Laws, stress: Lanes) -> tuple[Lanes, Lanes]:
    """Return ln F and its slope for F = -ln(1 - s)/s, from ``knee`` on a straight line."""
    inside = lesser(stress, laws.knee)
    large = greater(inside, SMALL_STRESS)
    left = 1.0 - large
    rate = -1.0 * log(left)
    is_small = inside < SMALL_STRESS
    log_f = where(is_small, inside * (0.5 + inside * (5.0 / 24.0)), log(rate / large))
    slope = where(is_small, 0.5 + inside * (5.0 / 12.0), 1.0 / (left * rate) - 1.0 / large)
    return log_f + (stress - inside) * slope, slope


@helper
def stress_at(terms: Terms, line: Record, arm: float) -> tuple[Lanes, Lanes]:
    """Return both components of the stress at ``arm`` from mid-film."""
    tilt = (terms.poiseuille * arm) * line.h
    return line.tau_x + tilt * line.p_x, line.tau_y + tilt * line.p_y


@helper
def set_thinning(model: Model, line: Record) -> bool:
    """Set and return ``thins``: whether the oil thins in the block at the stress of a wall."""
    most = 0.0
    if not model.laws.newtonian:
        for arm in (-0.5, 0.5):
            x, y = stress_at(model.terms, line, arm)
            most = max(most, largest(line.over_scale * root(x * x + y * y)))
    thins = most > model.laws.newtonian_limit
    line.thins = 1.0 if thins else 0.0
    return thins


@helper
def _thinning_arm(model: Model, k: int) -> float:
    """Return the distance from mid-film of the stress that determines the thinning of layer k."""
    return 0.0 if model.laws.uniform else model.across.zeta[k] - 0.5


@helper
def _logarithmic(target: Lanes, rate: Lanes) -> Lanes:
    """Return Newton's step for the logarithm of the rate over that for the rate.

    With r = target/rate that is ``ln r / (r - 1)``; it is one if the target is zero or the rate
    has the opposite sign.
    """
    ratio = lesser(greater(target / (rate + LEAST_SQUARED_STRESS), 1e-90), 1e90)
    other = ratio - 1.0
    far = abs(other) > 1e-6
    grown = where(far, log(ratio) / where(far, other, 1.0), 1.0)
    return where(rate * target > 0.0, grown, 1.0)


@helper
def _stress_step(model: Model, line: Record, layers: Records) -> float:
    """Take a Newton step of the mid-film stress towards the sliding speed.

    The matrix is the derivative of both rates, ``phi (delta_ij + s dlnF/ds tau_i tau_j/|tau|^2)``
    integrated across. A step is at most the scale plus half the
    stress. The fluidity is Newtonian. Return the largest step over the scale.
    """
    scale, along, across = line.over_scale, line.slide_x / line.h, line.slide_y / line.h
    zero = 0.0 * scale
    rate_x, rate_y, xx, xy, yy, bend = zero, zero, zero, zero, zero, zero
    for k in range(layers.shape[0]):
        x, y = stress_at(model.terms, line, _thinning_arm(model, k))
        square = x * x + y * y
        thinner, bend = thinning(model.laws, root(square) * scale)
        rate = layers[k].fluidity * model.across.weights[k] * thinner
        more = rate * bend / (square + LEAST_SQUARED_STRESS)
        rate_x = rate_x + rate * x
        rate_y = rate_y + rate * y
        xx = xx + rate + more * x * x
        xy = xy + more * x * y
        yy = yy + rate + more * y * y
    sliding = root(along * along + across * across)
    whole = sliding + LEAST_SQUARED_STRESS
    part_x, part_y = along / whole, across / whole
    grown = _logarithmic(sliding, part_x * rate_x + part_y * rate_y)
    rate_x, rate_y = rate_x - along, rate_y - across
    per_det = 1.0 / (xx * yy - xy * xy)
    dx = (yy * rate_x - xy * rate_y) * per_det
    dy = (xx * rate_y - xy * rate_x) * per_det
    step = scale * root(dx * dx + dy * dy)
    _take_step(
        model,
        line,
        dx,
        dy,
        grown * lesser(_longest(line) / (grown * step + LEAST_SQUARED_STRESS), 1.0),
    )
    # beside a limit the rate changes much more than the stress
    return largest(step * (1.0 + bend)) if model.laws.uniform else largest(step)


@helper
def _longest(line: Record) -> Lanes:
    """Return the longest step of the stress, over its scale."""
    x, y = line.tau_x, line.tau_y
    return 1.0 + 0.5 * line.over_scale * root(x * x + y * y)


@helper
def _take_step(model: Model, line: Record, dx: Lanes, dy: Lanes, part: Lanes) -> None:
    """Take a part of a step; a limiting stress stays where ln F is finite."""
    x, y = line.tau_x - part * dx, line.tau_y - part * dy
    if model.laws.uniform:
        factor = lesser(
            model.laws.most / (line.over_scale * root(x * x + y * y) + LEAST_SQUARED_STRESS), 1.0
        )
        x, y = factor * x, factor * y
    line.tau_x = x
    line.tau_y = y


@helper
def thin(model: Model, line: Record, layers: Records, steps: int) -> None:
    """Find the mid-film stress in at most ``steps`` Newton steps, and multiply the fluidity by F.

    ``exponent`` is n = dln(rate)/dln(stress); ``tangent_x``, ``tangent_y`` the fluidity of a small
    change of the stress along x or y; ``excess_y`` the largest excess of ``tangent_y`` over the
    fluidity.
    """
    for _ in range(steps):
        if _stress_step(model, line, layers) < SETTLED:
            break
    along = 0.0 if model.laws.uniform else 1.0
    excess_y = 0.0 * line.p
    for k in range(layers.shape[0]):
        here = layers[k]
        x, y = stress_at(model.terms, line, _thinning_arm(model, k))
        square = x * x + y * y
        thinner, bend = thinning(model.laws, root(square) * line.over_scale)
        fluid, more = here.fluidity * thinner, along * bend / (square + LEAST_SQUARED_STRESS)
        here.fluidity = fluid
        here.exponent = 1.0 + bend
        here.tangent_x = fluid * (1.0 + more * x * x)
        here.tangent_y = fluid * (1.0 + more * y * y)
        excess_y = greater(excess_y, more * y * y)
    line.excess_y = largest(excess_y)
