"""Trials of the laws of other packages: whether the solver can make its tables of them."""

import math
from collections.abc import Callable
from typing import Any

from tehl.base.typing import Array, np
from tehl.lubricant.law import FORTY_DEGREES, DensityModel, ViscosityModel

PRESSURES = (0.0, 5e8, 1e9, 3e9)
"""Where laws are tried [Pa]."""
TEMPERATURES = (-60.0, 0.0, 40.0, 700.0)
"""Where laws are tried, above the reference temperature [K]."""
SAME_VALUE = 1e-9
"""Relative difference of the values of numbers and of arrays."""
SAME_STRESS = 1e-4
"""Relative difference of a stress and of its rate's stress."""


def try_viscosity(law: ViscosityModel) -> None:
    """Raise ValueError if ``law`` does not give viscosities of numbers and of arrays."""
    _try("viscosity", law.viscosity, law.reference_temperature)
    for coefficient in (law.pressure_coefficient, law.temperature_coefficient):
        if not math.isfinite(coefficient):
            raise ValueError("has no finite coefficient of pressure or of temperature")


def try_density(law: DensityModel) -> None:
    """Raise ValueError if ``law`` does not give densities of numbers and of arrays."""
    _try("density", law.density, FORTY_DEGREES)


def try_shear(law: Any) -> None:
    """Raise ValueError if the methods of a shear law do not belong together.

    Parameters
    ----------
    law : ShearModel
        Of which ln F must start at zero, not fall, and be that of the inverse.
    """
    scale = np.asarray(law.stress_scale(np.array(PRESSURES)))
    if scale.shape != (len(PRESSURES),) or not (scale > 0.0).all():
        raise ValueError("needs a positive stress_scale for each of several pressures")
    stress = np.linspace(0.0, law.largest_stress, 65)
    thinning = np.asarray(law.log_thinning(stress.copy()))
    if thinning.shape != stress.shape or not (np.diff(thinning) >= -SAME_VALUE).all():
        raise ValueError("needs a log_thinning that does not fall with stress")
    if not abs(thinning[0]) < SAME_VALUE:
        raise ValueError("needs a log_thinning of zero at no stress")
    rate = stress * np.exp(thinning)
    known = rate < 1e8
    back = np.array([float(law.stress_at(float(one))) for one in rate[known]])
    if not np.allclose(back, stress[known], rtol=SAME_STRESS, atol=SAME_STRESS):
        raise ValueError("needs a stress_at that gives s at the rate s exp(log_thinning(s))")


def _try(name: str, law: Callable[[Any, Any], Any], middle: float) -> None:
    """Raise ValueError if a law of pressure and temperature has no values for some of them."""
    grids = np.meshgrid(PRESSURES, [middle + rise for rise in TEMPERATURES], indexing="ij")
    pressure, temperature = (np.ascontiguousarray(grid) for grid in grids)
    values: Array = np.asarray(law(pressure.copy(), temperature.copy()))
    if values.shape != pressure.shape:
        raise ValueError(f"must give the {name} of each element of arrays")
    if not (values > 0.0).all():
        row = np.unravel_index(np.argmin(values > 0.0), values.shape)
        raise ValueError(
            f"has {name} {values[row]:g} at {pressure[row]:g} Pa and {temperature[row]:g} K; it "
            "must be positive, even where the law does not hold"
        )
    alone = float(law(PRESSURES[1], middle))
    if not math.isclose(alone, float(values[1, 1]), rel_tol=SAME_VALUE):
        raise ValueError(f"must give the same {name} of numbers and of arrays")
