"""Tables of the laws of the lubricant over pressure and temperature, for the kernels.

Polynomials in 1/(T + 60 K) for ln eta and in T for rho, whose coefficients are interpolated over
ln(1 + 5.1e-9 p) by cubic Hermite polynomials. Errors are below 2e-6 in ln eta and a relative 1e-6
in rho wherever ln eta is below 40 (see the tests), except for the free-volume law of Tait and
Doolittle near the glass transition.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from tehl.base.typing import Array
from tehl.contact.problem import COLDEST_TEMPERATURE
from tehl.estimate.scaling import Scales
from tehl.kernels.energy.records import ETA_TERMS, RHO_TERMS, Laws
from tehl.lubricant import Lubricant
from tehl.lubricant.roelands import PER_ROELANDS_PRESSURE
from tehl.operators.flow import LARGEST_PRESSURE

ROWS = 96
POLE = -60.0
"""Pole of the variable 1/(T - POLE) [K]: accurate for laws in 1/T and in T."""
RISE = 400.0
STRESSES = 2048
DIFFERENCE = 0.05
FIT_TEMPERATURES = 48
"""Temperatures at which the polynomials are fitted."""
FIT_TOLERANCE = 2e-6
LARGEST_FITTED_LOG_VISCOSITY = 40.0
"""ln eta up to which the polynomials meet the tolerance."""
SOLID = 300.0
"""ln eta above which the viscosity is cut off: the film is effectively solid."""
LARGEST_STRESS, LARGEST_LOG = 1000.0, 340.0
"""Dimensionless stress at which a table of ln F ends at the latest, and ln F up to which stresses
of oil that yields as a whole may grow: above `SOLID`, so that it takes any sliding."""


@lru_cache(maxsize=8)
def law_table(lubricant: Lubricant, scales: Scales) -> Laws:
    """Tabulate viscosity, density and thinning of ``lubricant``.

    Parameters
    ----------
    lubricant : Lubricant
        The laws, in SI.
    scales : Scales
        Units of pressure, viscosity and density, and the inlet temperature: the table reaches
        from 60 K below to 700 K above it and up to 8 p_h.
    """
    per_scale = PER_ROELANDS_PRESSURE * scales.hertz_pressure
    rows = np.linspace(0.0, np.log1p(per_scale * LARGEST_PRESSURE), ROWS)
    coldest = max(scales.temperature - 60.0, COLDEST_TEMPERATURE)
    hottest = scales.temperature + 700.0
    ends = 1.0 / (coldest - POLE), 1.0 / (hottest - POLE)
    middle, half = 0.5 * (ends[0] + ends[1]), 0.5 * (ends[0] - ends[1])

    # a column of pressures and a row of temperatures: laws evaluate what depends on one once
    def ln_eta(row: Array, t: Array) -> Array:
        pressure, temperature = (
            np.expm1(row) / PER_ROELANDS_PRESSURE,
            POLE + 1 / (middle + half * t),
        )
        eta = lubricant.viscosity.viscosity(pressure, temperature) / scales.viscosity
        known = np.minimum(np.log(np.maximum(eta, 1e-300)), SOLID)
        return np.broadcast_to(known, np.broadcast_shapes(row.shape, t.shape))

    def rho(row: Array, t: Array) -> Array:
        pressure, temperature = np.expm1(row) / PER_ROELANDS_PRESSURE, scales.temperature + RISE * t
        known = lubricant.density.density(pressure, temperature) / scales.density
        return np.broadcast_to(known, np.broadcast_shapes(row.shape, t.shape))

    thinning, per_stress = thinning_table(lubricant)
    unit = np.cos(np.pi * (np.arange(FIT_TEMPERATURES) + 0.5) / FIT_TEMPERATURES)
    kelvin = POLE + 1.0 / (middle + half * unit)
    rise = (
        0.5 * (coldest + hottest) + 0.5 * (hottest - coldest) * unit - scales.temperature
    ) / RISE

    def thin(values: Array) -> Array:
        return _known(kelvin - scales.temperature) / (
            1.0 + (values / LARGEST_FITTED_LOG_VISCOSITY) ** 8
        )

    def known(values: Array) -> Array:
        return _known(RISE * rise) * np.ones_like(values)

    parts = [
        _terms(ln_eta, rows, ETA_TERMS, unit, thin),
        _terms(rho, rows, RHO_TERMS, rise, known),
    ]
    return Laws(
        fluid=np.ascontiguousarray(np.concatenate(parts, axis=2)),
        per_scale=per_scale,
        per_row=(ROWS - 1) / rows[-1],
        pole=POLE,
        middle=middle,
        over_inverse=1.0 / half,
        inlet=scales.temperature,
        over_rise=1.0 / RISE,
        coldest=coldest,
        hottest=hottest,
        thinning=thinning,
        per_stress=per_stress,
        last_row=ROWS - 2,
        last_stress=STRESSES - 2,
        newtonian_limit=newtonian_limit(lubricant),
        newtonian=int(lubricant.shear.is_newtonian),
        uniform=int(lubricant.shear.yields_as_a_whole),
        most=stress_limit(lubricant),
        knee=lubricant.shear.knee,
    )


def stress_limit(lubricant: Lubricant) -> float:
    """Return the dimensionless stress at which ln F, a straight line at the end, is largest."""
    shear = lubricant.shear
    end, step = shear.knee or min(shear.largest_stress, LARGEST_STRESS), 1e-6
    last, beyond = map(float, shear.log_thinning(np.array([end, end + step])))
    return end + (LARGEST_LOG - last) / max((beyond - last) / step, 1e-9)


def newtonian_limit(lubricant: Lubricant) -> float:
    """Return the dimensionless stress below which ln F is less than the tolerance."""
    stress = np.geomspace(1e-6, 1.0, 241)
    counts = lubricant.shear.log_thinning(stress) > FIT_TOLERANCE
    return float(stress[max(int(np.argmax(counts)) - 1, 0)]) if counts.any() else 1.0


def _known(warmer: Array) -> Array:
    """Return the fit weights of temperature rises [K]: small beyond those of films."""
    return np.where(warmer < 300.0, 1.0, 1e-4)


def _terms(
    law: Callable[[Array, Array], Array],
    rows: Array,
    count: int,
    nodes: Array,
    weights: Callable[[Array], Array],
) -> Array:
    """Return coefficients of the powers of t, and their slopes by row, (rows, 2, count).

    Least squares over ``nodes``; weighted by ``weights`` of the values if the error exceeds the
    tolerance, as of laws with a kink or a pole in the range of the table.
    """
    step = rows[1] - rows[0]
    d = DIFFERENCE * step
    power = np.vander(nodes, count, increasing=True)

    fitting = np.linalg.pinv(power).T

    def fit(values: Array) -> Array:
        return np.asarray(values @ fitting, np.float64)

    def weighted(values: Array) -> Array:
        weight = weights(values)
        scaled = np.linalg.pinv(weight[:, :, None] * power)
        return np.asarray(np.einsum("rct,rt->rc", scaled, weight * values), np.float64)

    values = law(rows[:, None], nodes[None, :])
    found = fit(values)
    misfit = np.abs(found @ power.T - values)[np.abs(values) < LARGEST_FITTED_LOG_VISCOSITY]
    method = fit
    if np.max(misfit) > FIT_TOLERANCE:
        method, found = weighted, weighted(values)
    lower, low, high, higher = (
        method(law(rows[:, None] + shift * d, nodes[None, :])) for shift in (-2, -1, 1, 2)
    )
    slope = 8 * (high - low) - higher + lower
    return np.stack([found, slope / (12 * DIFFERENCE)], axis=1)


def thinning_table(lubricant: Lubricant) -> tuple[Array, float]:
    """Return ln F and its slope over s/(1 + s), and the rows per unit of it."""
    top = min(lubricant.shear.largest_stress, LARGEST_STRESS)
    step = top / (1.0 + top) / (STRESSES - 1)
    row = step * np.arange(float(STRESSES))
    shift = 0.1 * step

    def log_f(row: Array) -> Array:
        return lubricant.shear.log_thinning(np.abs(row) / (1.0 - np.abs(row)))

    slope = (log_f(row + shift) - log_f(row - shift)) / (2 * shift)
    return np.stack([log_f(row), slope * step], axis=1), 1.0 / step
