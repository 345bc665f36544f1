"""Dry pressure; of a roller that which makes the gap zero where it is positive.

Conjugate gradients with the load as a constraint (Polonsky and Keer, Wear 231 (1999) 206-219): the
descent is the gap less its mean over the contact, and nodes of negative pressure leave it.
"""

from functools import lru_cache

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups
from tehl.operators.deformation import choose
from tehl.operators.film import gap
from tehl.operators.load import Load

MOST_DESCENTS, DRY_CHANGE = 400, 1e-6
"""Most iterations, and mean change of the pressure over its mean at which they end."""


@lru_cache(maxsize=8)
def dry_roller(grid: Grid, groups: Groups) -> Array:
    """Return the dry pressure of a roller, ``grid.shape``, read-only [-].

    Parameters
    ----------
    grid, groups : Grid, Groups
        Nodes, and the roller under its load.
    """
    shape, load, deformation = groups.shape, Load(grid), choose("fft", grid, groups)
    undeformed = gap(grid, groups)
    inside = np.zeros(undeformed.shape, bool)
    inside[:, 1:-1] = True
    weight = grid.widths[:, None]
    p = np.where(inside, shape.dry_pressure(grid.x[None, :], grid.y[:, None]), 0.0)
    p *= shape.load / load.integral(p)
    rest, bent, step = (
        np.empty_like(undeformed),
        np.empty_like(undeformed),
        np.zeros_like(undeformed),
    )
    conjugate, before = 0.0, 1.0
    for _ in range(MOST_DESCENTS):
        touching = p > 0.0
        deformation.deflect(p, rest)
        rest += undeformed
        part = touching * weight
        rest -= (part * rest).sum() / part.sum()
        square = float((part * rest**2).sum())
        step = np.where(touching, rest + conjugate * square / before * step, 0.0)
        deformation.deflect(step, bent)
        bent -= (part * bent).sum() / part.sum()
        length = float((part * rest * step).sum() / (part * bent * step).sum())
        last, p = p, np.maximum(p - length * step, 0.0)
        missed = inside & (p == 0.0) & (rest < 0.0)
        p[missed] -= length * rest[missed]
        p *= shape.load / load.integral(p)
        conjugate, before = 0.0 if missed.any() else 1.0, square
        if float(np.abs(p - last).sum()) < DRY_CHANGE * float(p.sum()):
            break
    p.flags.writeable = False
    return p


def dry_pressure(grid: Grid, groups: Groups) -> Array:
    """Return the pressure of the dry contact, shape ``grid.shape`` [-].

    Parameters
    ----------
    grid : Grid
        Nodes X, Y in Hertz half-widths.
    groups : Groups
        Shape of the contact.
    """
    if groups.roller is not None:
        return dry_roller(grid, groups).copy()
    return groups.shape.dry_pressure(grid.x[None, :], grid.y[:, None])
