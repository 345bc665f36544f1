"""What a stress does to a material: largest shear, von Mises, amplitudes of a rolling cycle."""

import math
from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.contact.stress import Stress

LEAST_SHEAR = 0.866
"""Largest shear over the root of J2: at least sqrt(3)/2, and at most one."""
UNSURE = 1e-3
"""Part of the largest shear that single precision may miss: where two principal stresses are equal
the angle is wrong by the root of the precision."""


def largest_shear(stress: Array) -> Array:
    """Return half the difference of the largest and the least principal stress.

    Parameters
    ----------
    stress : (6, ...) array
        Components as in `influence.COMPONENTS`.
    """
    stress = np.asarray(stress, float)
    return _shear(stress, _second_invariant(stress))


def _shear(stress: Array, second: Array) -> Array:
    """Return the largest shear stress where J2 is known, in the precision of the components."""
    xx, yy, zz, xy, yz, zx = stress
    mean = (xx + yy + zz) / 3.0
    xx, yy, zz = xx - mean, yy - mean, zz - mean
    third = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * zx) + zx * (xy * yz - yy * zx)
    root = np.sqrt(second)
    ratio = np.divide(
        1.5 * np.sqrt(3.0) * third, root * second, out=np.zeros_like(root), where=root > 0
    )
    return np.asarray(root * np.cos(np.arccos(np.clip(ratio, -1.0, 1.0)) / 3.0 - np.pi / 6.0))


def von_mises(stress: Array) -> Array:
    """Return the equivalent stress of von Mises of components (6, ...)."""
    return np.asarray(np.sqrt(3.0 * _second_invariant(stress)))


def _second_invariant(stress: Array) -> Array:
    """Return J2 of the deviator, never negative."""
    xx, yy, zz, xy, yz, zx = stress
    squares = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.asarray(squares / 6.0 + xy * xy + yz * yz + zx * zx)


class Worst(NamedTuple):
    """What is largest at one depth, in the unit of the stress; place in nodes of the grid."""

    shear: float
    von_mises: float
    orthogonal: float
    """Half the range of tau_zx along the direction of rolling."""
    dang_van: float
    risk: float
    """Sum over y of the criterion above the fatigue limit, to the power of ``stress_exponent``."""
    row: float
    column: float
    """Where the largest shear is."""


def worst(
    stress: Array, settings: Stress, limit: float, weights: Array, residual: float = 0.0
) -> Worst:
    """Return what is largest at one depth, where each line along x is a cycle of the material.

    It begins and ends without load, farther away than the stresses are computed.

    Parameters
    ----------
    stress : (6, ny, nx) array
        At that depth, residual stress included.
    settings : Stress
        With the constants of fatigue.
    limit : float
        Fatigue limit in the unit of the stress.
    weights : (ny,) array
        Of the rows in the sum over y.
    residual : float
        Stress along x and y of the material without load.
    """
    second = _second_invariant(stress)
    most = float(second.max())
    near = np.flatnonzero(second.ravel() >= LEAST_SHEAR**2 * most)
    every = stress.reshape(6, -1)
    shear = _shear(every[:, near], second.ravel()[near])
    near = near[shear >= (1.0 - UNSURE) * shear.max()]
    shear = largest_shear(every[:, near])
    row, column = np.unravel_index(near[int(np.argmax(shear))], second.shape)
    without = np.zeros((*stress.shape[:-1], 1), stress.dtype)
    without[:2] = residual
    cycle = np.concatenate([stress, without], axis=-1)
    low, high = cycle.min(axis=-1, keepdims=True), cycle.max(axis=-1, keepdims=True)
    orthogonal = 0.5 * (high - low)[5, :, 0]
    tension = settings.dang_van_slope / 3.0 * cycle[:3].sum(axis=0)
    dang_van = _largest_along(cycle - 0.5 * (low + high), tension)
    damaging = orthogonal if settings.criterion == "orthogonal-shear" else dang_van
    return Worst(
        shear=float(shear.max()),
        von_mises=math.sqrt(3.0 * most),
        orthogonal=float(orthogonal.max()),
        dang_van=float(dang_van.max()),
        risk=float(np.maximum(damaging - limit, 0.0) ** settings.stress_exponent @ weights),
        row=float(row),
        column=float(column),
    )


def _largest_along(stress: Array, added: Array) -> Array:
    """Return the largest sum of the largest shear and ``added`` on each line along x, (ny,)."""
    second = _second_invariant(stress)
    root = np.sqrt(second)
    least = (LEAST_SHEAR * root + added).max(axis=-1, keepdims=True)
    near = root + added >= least
    found = np.where(near, added, -np.inf)
    found[near] += _shear(stress[:, near], second[near])
    near = found >= found.max(axis=-1, keepdims=True) - UNSURE * root
    found[near] = added[near] + largest_shear(stress[:, near])
    return np.asarray(found.max(axis=-1))
