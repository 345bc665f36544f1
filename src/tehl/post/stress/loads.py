"""What acts on the surface of each body: pressure and traction of film, asperities and contact."""

from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.post.boundary_contact import touching_nodes
from tehl.post.traction import sliding_direction, slope_across, traction
from tehl.result.solution import Solution

PLACES = 32
"""Places across a line over which the mean of its loads is taken."""


class SurfaceLoads(NamedTuple):
    """Loads on one body, (ny, nx) each [Pa]."""

    pressure: Array
    """Of oil, asperities and contact together."""
    traction_x: Array
    traction_y: Array
    """Force on the body over area."""


def on_even_lines(result: Solution) -> Solution:
    """Return a result on as many even lines: those of a roller crowd at its ends.

    Each has the mean over its cell, linear between the lines of the result, so that the load stays.
    """
    y = result.scaled.y
    even = np.linspace(y[0], y[-1], y.size)
    if np.allclose(y, even, rtol=0.0, atol=1e-9):
        return result
    faces = np.concatenate([even[:1], 0.5 * (even[1:] + even[:-1]), even[-1:]])
    places = faces[:-1] + np.outer((np.arange(PLACES) + 0.5) / PLACES, np.diff(faces))
    weights = np.array([np.interp(places, y, one).mean(axis=0) for one in np.eye(y.size)]).T
    changes: dict[str, object] = {}
    for name in ("scaled", "shear", "asperities", "contact"):
        value = getattr(result, name)
        if value is not None:
            known = {one.name: getattr(value, one.name) for one in fields(value)}
            maps = {key: weights @ one for key, one in known.items() if np.ndim(one) == 2}
            changes[name] = replace(value, **maps)
    changes["scaled"] = replace(changes["scaled"], y=even)  # type: ignore[type-var]
    return result.but(**changes)


def loads_on(result: Solution, body: int, *, without_shear: bool | None = None) -> SurfaceLoads:
    """Return the loads on a body.

    The shear stress of the film acts where there is pressure. That of a Newtonian film which would
    transmit more than any oil can is left out (`left_out`). Where surfaces touch through a boundary
    film, its friction replaces it; that of asperities is added.

    Parameters
    ----------
    result : Solution
        Steady, computed or loaded.
    body : {1, 2}
        The body below z = 0 or above z = h.
    without_shear : bool or None
        Whether the shear stress of the film is left out; `left_out` by default.
    """
    if without_shear is None:
        without_shear = left_out(result)
    sign = 1.0 if body == 1 else -1.0  # its surface is the lower or the upper end of the film
    film = np.maximum(result.pressure, 0.0)
    rubbed = rubbing(result)
    stress_x, stress_y = np.zeros_like(film), np.zeros_like(film)
    shear = result.shear
    if shear is not None and not without_shear:
        wet = film > 0.0
        stress_x = np.where(wet, getattr(shear, f"surface_{body}"), 0.0)
        stress_y = np.where(wet, shear.across - sign * _rolling_across(result, film), 0.0)
    problem = result.problem
    if result.contact is not None and problem.contact_film is not None:
        meet = touching_nodes(result)
        stress_x[meet] = stress_y[meet] = 0.0
    along, across = sliding_direction(result)
    stress_x -= along * rubbed
    stress_y -= across * rubbed
    part = parts_of_cells(result)
    return SurfaceLoads(
        part * whole_pressure(result), part * sign * stress_x, part * sign * stress_y
    )


def whole_pressure(result: Solution) -> Array:
    """Return the pressure of oil, asperities and contact together [Pa], (ny, nx)."""
    problem, total = result.problem, np.maximum(result.pressure, 0.0)
    if result.contact is not None and problem.contact_film is not None:
        total += result.contact.pressure
    if result.asperities is not None and problem.asperities is not None:
        total += result.asperities.pressure
    return total


def parts_of_cells(result: Solution) -> Array:
    """Return the part of its cell that each row fills, (ny, 1): half at the ends of a roller.

    Pieces that go on beyond their ends have whole cells there.
    """
    part = np.ones((result.y.size, 1))
    if result.groups.roller is not None and not result.groups.shape.goes_on:
        part[[0, -1]] = 0.5
    return part


def rubbing(result: Solution) -> Array:
    """Return the friction of asperities, and of contact through a boundary film, positive [Pa]."""
    problem, found = result.problem, np.zeros_like(result.pressure)
    if result.contact is not None and problem.contact_film is not None:
        both = np.maximum(result.pressure, 0.0) + result.contact.pressure
        found += np.where(touching_nodes(result), problem.contact_film.friction * both, 0.0)
    if result.asperities is not None and problem.asperities is not None:
        found += problem.asperities.friction * result.asperities.pressure
    return found


def left_out(result: Solution) -> bool:
    """Whether the shear stress of the film is more than any oil can carry, and is left out."""
    found = traction(result)
    return found is not None and not found.credible


def _rolling_across(result: Solution, pressure: Array) -> Array:
    """Return (h/2) dp/dy [Pa], by which the stress along y falls from mid-film to a surface."""
    return np.asarray(0.5 * result.film_thickness * slope_across(result, pressure))
