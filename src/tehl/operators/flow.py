"""Mobility and density of the lubricant, tabulated over pressure for the Reynolds equation."""

from collections.abc import Callable

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.scaling import ScaledProblem
from tehl.kernels.properties import FlowTable

LARGEST_PRESSURE = 8.0
"""End of the table, in Hertz pressures: rough contacts reach 2 to 5."""
NODES = 8192


def flow_table(scaled: ScaledProblem) -> FlowTable:
    """Tabulate the laws of the lubricant at the inlet temperature.

    Cubic Hermite interpolation between 8192 pressures is accurate to 1e-6 (see the tests), and
    kernels are independent of the laws.
    """
    scales, lubricant = scaled.scales, scaled.problem.lubricant
    temperature = scales.temperature

    def density(pressure: Array) -> Array:
        si = lubricant.density.density(scales.hertz_pressure * pressure, temperature)
        return np.broadcast_to(si / scales.density, pressure.shape)

    def mobility(pressure: Array) -> Array:
        si = lubricant.viscosity.viscosity(scales.hertz_pressure * pressure, temperature)
        return density(pressure) / (si / scales.viscosity * scaled.groups.lambda_bar)

    step = LARGEST_PRESSURE / NODES
    pressure = step * np.arange(NODES + 1.0)

    def tabulated(law: Callable[[Array], Array]) -> Array:
        return np.stack([law(pressure), slope(law, pressure, step) * step], axis=1)

    return FlowTable(mobility=tabulated(mobility), density=tabulated(density), step=step)


def slope(law: Callable[[Array], Array], pressure: Array, step: float) -> Array:
    """Differentiate ``law`` to fourth order by differences, one-sided at p = 0.

    Parameters
    ----------
    law : callable
        From pressures [-] to values of the same shape.
    pressure : (n,) array
        Increasing from zero [-].
    step : float
        Ten times the width of the differences [-].

    Returns
    -------
    (n,) array
        Derivative of ``law`` at ``pressure``.
    """
    d = 0.1 * step
    # central: (8 (f_1 - f_-1) - (f_2 - f_-2)) / (12 d)
    central = 8 * (law(pressure[1:] + d) - law(pressure[1:] - d))
    central -= law(pressure[1:] + 2 * d) - law(pressure[1:] - 2 * d)
    weights = np.array([-25.0, 48.0, -36.0, 16.0, -3.0])
    first = weights @ law(d * np.arange(5.0))
    return np.concatenate([[first], central]) / (12 * d)
