"""Central film of starved circular contacts over the supply, from solved contacts."""

from functools import cache
from importlib.resources import files

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.scaling import Groups
from tehl.estimate.starvation import starved_part

CIRCULAR = 0.1
"""Largest difference of the ratio of the radii from one."""


def starved_degree(groups: Groups, ratio: float) -> tuple[float, float | None]:
    """Return the central film over that of the flooded contact, and its error bar [-].

    Linear between the contacts of ``starvation.csv``, as a factor on the film law; beyond them the
    law alone, without an error bar.

    Parameters
    ----------
    groups : Groups
        Load, speed and shape of the contact.
    ratio : float
        r, the oil that enters over that of the flooded contact [-].
    """
    law, axes, factors, errors = starved_part(ratio), *table()
    place = np.log(groups.M), groups.L, np.log(max(ratio, 1e-9))
    inside = all(axis[0] <= at <= axis[-1] for axis, at in zip(axes, place, strict=True))
    if not inside or abs(groups.radius_ratio - 1.0) > CIRCULAR:
        return law, None
    from scipy.interpolate import interpn  # noqa: PLC0415 (0.1 s, for starved contacts only)

    factor, error = (float(interpn(axes, values, place)[0]) for values in (factors, errors))
    return law * factor, law * error


@cache
def table() -> tuple[tuple[Array, Array, Array], Array, Array]:
    """Return the axes log M, L and log r of the table, the film over the law, and its errors."""
    with files(__package__).joinpath("starvation.csv").open(encoding="utf-8") as file:
        load, speed, ratio, degree, error = np.loadtxt(file, delimiter=",", skiprows=1).T
    loads, speeds, ratios = (np.unique(one) for one in (load, speed, ratio))
    law = np.array([starved_part(one) for one in ratio])
    shape = loads.size, speeds.size, ratios.size
    axes = np.log(loads), speeds, np.log(ratios)
    return axes, (degree / law).reshape(shape), (error / law).reshape(shape)
