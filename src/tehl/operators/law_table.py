"""The laws of the lubricant as the compiled kernels see them: tables over pressure and temperature.

Each law is written once, in SI, and called here; over the pressure cubic Hermite interpolation in
ln(1 + 5.1e-9 p), over the temperature polynomials in 1/T and T, whose coefficients are what is
interpolated. That keeps ln eta and rho to about 1e-6 (checked in the tests).
"""

from collections.abc import Callable

import numpy as np

from tehl.kernels.energy import ETA_TERMS, RHO_TERMS, Laws
from tehl.lubricant import Lubricant
from tehl.scaling import Scales
from tehl.typing import Array

PER_PRESSURE = 5.1e-9
LARGEST_PRESSURE = 8.0
ROWS = 96
COLDER, HOTTER = 60.0, 700.0
COLDEST = 200.0
RISE = 400.0
STRESSES = 2048
LARGEST_STRESS = 1000.0
DIFFERENCE = 0.05
SOLID = 300.0
"""ln eta beyond which the viscosity no longer counts: the film is a solid for every purpose."""


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
    per_scale = PER_PRESSURE * scales.hertz_pressure
    rows = np.linspace(0.0, np.log1p(per_scale * LARGEST_PRESSURE), ROWS)
    coldest = max(scales.temperature - COLDER, COLDEST)
    hottest = scales.temperature + HOTTER
    middle, half = 0.5 * (1 / coldest + 1 / hottest), 0.5 * (1 / coldest - 1 / hottest)

    def ln_eta(row: Array, t: Array) -> Array:
        pressure, temperature = np.broadcast_arrays(
            np.expm1(row) / PER_PRESSURE, 1.0 / (middle + half * t)
        )
        eta = lubricant.viscosity.viscosity(pressure, temperature) / scales.viscosity
        return np.minimum(np.log(np.maximum(eta, 1e-300)), SOLID)

    def rho(row: Array, t: Array) -> Array:
        pressure, temperature = np.broadcast_arrays(
            np.expm1(row) / PER_PRESSURE, scales.temperature + RISE * t
        )
        return lubricant.density.density(pressure, temperature) / scales.density

    thinning, per_stress = thinning_table(lubricant)
    span = ((coldest - scales.temperature) / RISE, (hottest - scales.temperature) / RISE)
    parts = [_terms(ln_eta, rows, ETA_TERMS, (-1.0, 1.0)), _terms(rho, rows, RHO_TERMS, span)]
    return Laws(
        fluid=np.ascontiguousarray(np.concatenate(parts, axis=1)),
        per_scale=per_scale,
        per_row=(ROWS - 1) / rows[-1],
        middle=middle,
        over_inverse=1.0 / half,
        inlet=scales.temperature,
        over_rise=1.0 / RISE,
        coldest=coldest,
        hottest=hottest,
        thinning=thinning,
        per_stress=per_stress,
        newtonian=int(lubricant.shear.is_newtonian),
        uniform=int(lubricant.shear.yields_as_a_whole),
    )


def _terms(
    law: Callable[[Array, Array], Array], rows: Array, count: int, span: tuple[float, float]
) -> Array:
    """Return coefficients of the powers of t, and their slopes by row, (rows, count, 2)."""
    step = rows[1] - rows[0]
    d = DIFFERENCE * step

    def fit(row: Array) -> Array:
        unit = np.cos(np.pi * (np.arange(2 * count) + 0.5) / (2 * count))
        t = 0.5 * (span[0] + span[1]) + 0.5 * (span[1] - span[0]) * unit
        values = law(row[:, None], t[None, :])
        power = np.vander(t, count, increasing=True)
        return np.asarray(np.linalg.lstsq(power, values.T, rcond=None)[0].T, np.float64)

    slope = (8 * (fit(rows + d) - fit(rows - d)) - fit(rows + 2 * d) + fit(rows - 2 * d)) / 12
    return np.stack([fit(rows), slope / DIFFERENCE], axis=2)


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
