"""Spots on which summits touch, and how warm they become for the moment of their contact.

Where asperities of Greenwood and Tripp touch on a part A of the area, in N spots per area,

    A = pi^2 (eta beta sigma)^2 F_2(h/sigma),    N = 4 pi eta^2 beta sigma F_1(h/sigma),

or, of a measured patch, from its dry contact, whose connected pixels are counted. A spot has a mean
area A/N, and a mean pressure of p_a/A. Where that exceeds the hardness of the softer solid the
summits yield: the pressure stays at the hardness, and the area grows to p_a over it [2]_. It is
taken for a circle of radius
a with uniform heat q = mu_b p_a/A |u_1 - u_2|. On one surface that moves with u its largest rise is
[1]_

    2 q a / (k sqrt(pi (1.273 + Pe))),    Pe = u a / (2 kappa),

and on both together, of which each takes the part that makes them equally warm (Blok),
1/dT = 1/dT_1 + 1/dT_2.

References
----------
.. [1] X. Tian and F. E. Kennedy, J. Tribology 116 (1994), 167-174.
.. [2] F. P. Bowden and D. Tabor, The Friction and Lubrication of Solids (1950), chapter 1.
"""

import math
from dataclasses import dataclass

import numpy as np

from tehl.base.typing import Array
from tehl.post.traction import cell_widths
from tehl.result.fields import FilmAsperities
from tehl.result.solution import Solution


@dataclass(frozen=True, kw_only=True, slots=True)
class Spots:
    """Spots on which summits touch."""

    number: float
    """In the whole contact."""
    radius: float
    """Mean radius where the asperities carry most [m]."""
    pressure: float
    """Mean pressure on them there [Pa], at most the hardness of the softer solid."""
    elastic_pressure: float
    """The same if they were elastic [Pa]."""
    flash_rise: float | None
    """Rise of their temperature over that of the surfaces, the largest in the contact [K]; None if
    thermal properties of a surface are not stated."""


def real_area(result: Solution, found: FilmAsperities) -> Array:
    """Return the part of the area in which asperities touch, at each node [-].

    That of elastic summits, or the part on which they yield if it is larger.

    Parameters
    ----------
    result : Solution
        For the hardness of the softer surface [Pa]; without one, summits are elastic.
    found : FilmAsperities
        Pressure [Pa] and elastic area [-] of the asperities at the nodes.
    """
    problem = result.problem
    stated = (problem.surface_1.material.hardness, problem.surface_2.material.hardness)
    hardest = min((one for one in stated if one is not None), default=math.inf)
    return np.maximum(found.area, found.pressure / hardest)


def spots(result: Solution, found: FilmAsperities) -> Spots | None:
    """Return the spots of a result with asperities; None where none touches.

    Parameters
    ----------
    result : Solution
        With the laws of asperities and of friction.
    found : FilmAsperities
        Pressure [Pa], area [-] and density of the spots [1/m^2] at the nodes, (ny, nx).
    """
    law = result.problem.asperities
    if law is None or not found.area.max() > 0.0:
        return None
    density, touching = found.spots, found.spots > 0.0
    real = real_area(result, found)
    area = np.where(touching, real, 0.0) / np.where(touching, density, 1.0)
    radius = np.sqrt(area / math.pi)
    elastic = found.pressure / np.where(found.area > 0.0, found.area, 1.0)
    pressure = found.pressure / np.where(real > 0.0, real, 1.0)
    cells = np.outer(cell_widths(result.y), cell_widths(result.x))
    number = float((cells * density).sum())
    if number < 0.5:  # none touches
        return None
    most = np.unravel_index(found.pressure.argmax(), found.pressure.shape)
    rises = _flash_rises(result, law.friction * pressure, radius)
    return Spots(
        number=number,
        radius=float(radius[most]),
        pressure=float(pressure[most]),
        elastic_pressure=float(elastic[most]),
        flash_rise=None if rises is None else float(rises.max()),
    )


def _flash_rises(result: Solution, stress: Array, radius: Array) -> Array | None:
    """Return the rise at each node [K] by shear stress [Pa] and radius [m] of its spots."""
    motion, places = result.problem.motion, (result.x, result.y[:, None])
    sliding, cooling = np.hypot(*motion.sliding_field(*places)), np.zeros_like(radius)
    for number, surface in enumerate(result.problem.surfaces, 1):
        speed = np.hypot(*motion.field_of(number, *places))
        conductivity, diffusivity = surface.material.conductivity, surface.material.diffusivity
        if conductivity is None or diffusivity is None:
            return None
        peclet = speed * radius / (2.0 * diffusivity)
        cooling += conductivity * np.sqrt(math.pi * (1.273 + peclet))
    return 2.0 * stress * sliding * radius / cooling
