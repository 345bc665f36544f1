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
    pressure = step * np.arange(NODES + 3.0)

    def tabulated(law: Callable[[Array], Array]) -> Array:
        values = law(pressure)
        return np.stack([values, increments(values)], axis=1)[:-2]

    return FlowTable(mobility=tabulated(mobility), density=tabulated(density), step=step)


def increments(values: Array) -> Array:
    """Return the derivative of values times their spacing, of fourth order, one-sided at the ends.

    The last two are zero.

    Parameters
    ----------
    values : (n,) array
        At equal distances.

    Returns
    -------
    (n,) array
        Change per distance.
    """
    found = np.zeros_like(values)
    # central: (8 (f_1 - f_-1) - (f_2 - f_-2)) / 12
    found[2:-2] = (8.0 * (values[3:-1] - values[1:-3]) - (values[4:] - values[:-4])) / 12.0
    found[0] = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) @ values[:5] / 12.0
    found[1] = np.array([-3.0, -10.0, 18.0, -6.0, 1.0]) @ values[:5] / 12.0
    return found
