"""Viscosity and density at the layers of a block, from the tables of the laws.

The tables hold, over pressure, the coefficients of two polynomials in temperature, from which the
layers get values and slopes (`tehl.operators.law_table`).
"""

from tehl.base.typing import Array, Record, Records
from tehl.kernels.compiled import helper
from tehl.kernels.energy.records import BLOCK, ETA_TERMS, TERMS, Across, Laws, Model, Terms
from tehl.kernels.lanes import LANES, Lanes, greater, largest, lesser, log, power_of_two
from tehl.kernels.raw import lanes

LARGEST_KERNEL_EXPONENT = 690.0
MAGIC = 6755399441055744.0  # 1.5 2^52: adding it leaves the nearest integer in the low bits
LOG2_E = 1.4426950408889634
LN2_HIGH, LN2_LOW = 0.693147180369123816490, 1.90821492927058770002e-10


@helper
def exponential(x: Lanes) -> Lanes:
    """Return exp(x) to a relative 1e-15, for |x| below 690.

    exp(x) = 2^n exp(r) with n the integer nearest to x/ln 2 and |r| < 0.35, for which thirteen
    terms of the series suffice (Cody and Waite 1980, range reduction in two steps).
    """
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
    return (q * r + 1.0) * power_of_two(shifted)


@helper
def limited(ln_eta: Lanes) -> Lanes:
    """Limit ln eta to the range in which its exponential is finite."""
    return lesser(greater(ln_eta, -LARGEST_KERNEL_EXPONENT), LARGEST_KERNEL_EXPONENT)


@helper
def _interpolate_row(laws: Laws, x: float, out: Array, lane: int) -> None:
    """Interpolate the coefficients between rows of the table by cubic Hermite polynomials."""
    fluid = laws.fluid
    row = max(min(int(x), laws.last_row), 0)
    s = min(x - row, 1.0)
    r = 1.0 - s
    p0, p1 = r * r * (1.0 + 2.0 * s), s * r * r
    p2, p3 = s * s * (3.0 - 2.0 * s), -s * s * r
    for c in range(0, TERMS, LANES):
        eight = lanes(c)
        value = p0 * fluid[row, 0, eight] + p1 * fluid[row, 1, eight]
        value += p2 * fluid[row + 1, 0, eight] + p3 * fluid[row + 1, 1, eight]
        out[lane, eight] = value


@helper
def _coefficients(laws: Laws, line: Record, terms: Array) -> None:
    """Interpolate the polynomials of the laws to the pressures of the block."""
    x = log(1.0 + laws.per_scale * greater(line.p, 0.0)) * laws.per_row
    for lane in range(BLOCK):
        _interpolate_row(laws, x[lane], terms, lane)
    for c in range(TERMS):
        for lane in range(BLOCK):
            line.terms[c, lane] = terms[lane, c]


@helper
def _horner(terms: Array, first: int, count: int, t: Lanes) -> tuple[Lanes, Lanes]:
    """Return a polynomial and its slope at ``t``; coefficients from ``first`` on."""
    rows = lanes(0)
    value, slope = 1.0 * terms[first + count - 1, rows], 0.0 * t
    for c in range(first + count - 2, first - 1, -1):
        slope = slope * t + value
        value = value * t + terms[c, rows]
    return value, slope


@helper
def look_up(laws: Laws, line: Record, layer: Record, temperature: Lanes) -> None:
    """Fill ln eta, -dln(eta)/dT, rho and drho/dT of a layer."""
    kelvin = lesser(greater(temperature, laws.coldest), laws.hottest)
    inverse = 1.0 / (kelvin - laws.pole)
    t = (inverse - laws.middle) * laws.over_inverse
    value, slope = _horner(line.terms, 0, ETA_TERMS, t)
    layer.ln_eta = limited(value)
    layer.slope = slope * inverse * inverse * laws.over_inverse
    t = (kelvin - laws.inlet) * laws.over_rise
    value, slope = _horner(line.terms, ETA_TERMS, TERMS - ETA_TERMS, t)
    layer.rho = value
    layer.rho_t = slope * laws.over_rise


@helper
def mean_temperature(across: Across, layers: Records) -> Lanes:
    """Return the temperature averaged across the film."""
    mean = across.weights[0] * layers[0].t
    for k in range(1, layers.shape[0]):
        mean += across.weights[k] * layers[k].t
    return mean


@helper
def is_uniform(terms: Terms, layers: Records) -> bool:
    """Return whether the film is not heated, and all layers have one temperature."""
    if terms.heat:
        return False
    most = 0.0 * layers[0].t
    for k in range(1, layers.shape[0]):
        most = greater(most, abs(layers[k].t - layers[0].t))
    return largest(most) == 0.0


@helper
def evaluate_laws(model: Model, terms: Array, line: Record, layers: Records) -> None:
    """Fill viscosity, density and their slopes at all layers."""
    _coefficients(model.laws, line, terms)
    if is_uniform(model.terms, layers):
        first = layers[0]
        look_up(model.laws, line, first, first.t)
        for k in range(1, layers.shape[0]):
            here = layers[k]
            here.ln_eta = first.ln_eta
            here.slope = first.slope
            here.rho = first.rho
            here.rho_t = first.rho_t
        return
    mean = mean_temperature(model.across, layers)
    for k in range(layers.shape[0]):
        here = layers[k]
        look_up(model.laws, line, here, mean if model.terms.mean == 2 else here.t)
