"""Pressure and flow of asperities finer than the grid, tabulated over the separation."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from tehl.asperities import channel, gaussian_integral, mean_gap
from tehl.scaling import ScaledProblem
from tehl.typing import Array

LEAST, MOST, STEP = -6.0, 30.0, 0.02
"""Separations of the mean planes over sigma between which the laws are tabulated, and the step."""


@dataclass(frozen=True, kw_only=True, slots=True)
class AsperityTable:
    """Laws over the separation H of the mean planes.

    Attributes
    ----------
    table : (n, 6) array
        Pressure of the asperities, mean gap and channel, each with its slope times the step [-].
    grid : (2,) array
        Least separation, and difference of two rows [-].
    """

    table: Array
    grid: Array


def asperity_table(scaled: ScaledProblem) -> AsperityTable | None:
    """Tabulate the laws of the asperities; None for a contact without."""
    problem, scales = scaled.problem, scaled.scales
    asperities = problem.asperities
    if asperities is None:
        return None
    sigma = problem.asperity_rms
    unit = sigma / scales.film_thickness
    pressure = asperities.unit(sigma, problem.reduced_modulus) / scales.hertz_pressure
    factors = np.repeat([pressure, unit, unit], 2)
    return AsperityTable(table=_laws() * factors, grid=np.array([LEAST, STEP]) * unit)


@cache
def _laws() -> Array:
    """Return F_(5/2), mean gap and channel over gaps, all over sigma, each with slope and step."""
    gap = np.arange(LEAST, MOST + STEP, STEP)
    d = 0.1 * STEP
    widening = 8.0 * (channel(gap + d) - channel(gap - d))
    widening -= channel(gap + 2.0 * d) - channel(gap - 2.0 * d)
    opening = (mean_gap(gap + d) - mean_gap(gap - d)) * 8.0
    opening -= mean_gap(gap + 2.0 * d) - mean_gap(gap - 2.0 * d)
    columns = [
        gaussian_integral(2.5, gap),
        -2.5 * gaussian_integral(1.5, gap) * STEP,
        mean_gap(gap),
        opening / (12.0 * d) * STEP,
        channel(gap),
        widening / (12.0 * d) * STEP,
    ]
    return np.ascontiguousarray(np.stack(columns, axis=1))
