"""Traction of a film: shear forces on the surfaces and at mid-film over the load.

They are those of the loaded zone, `tehl.operators.loaded_zone`; the drag of the flooded oil around
it stands apart, `tehl.post.surroundings`. The stress is ``tau = eta du/dz``, so all coefficients
are negative where surface 1 is the faster (SRR > 0), which the film brakes. They give the force on
surface 1; that on surface 2 is opposite.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from tehl.base.typing import Array, BoolArray
from tehl.operators.loaded_zone import wet_part, zone_part
from tehl.post.surroundings import Surroundings, surroundings
from tehl.result.solution import Solution

LARGEST_CREDIBLE = 0.1
"""Largest traction coefficient of oils; a Newtonian film has no such limit."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Traction:
    r"""Traction coefficients of a film in the loaded zone, negative for SRR > 0.

    Without inertia the stress is linear across the film, whatever the viscosity does:
    ``surface_1 = mid_film - rolling``, ``surface_2 = mid_film + rolling`` with

    .. math:: \mathrm{rolling} = \frac{1}{2w} \iint h \frac{\partial p}{\partial x}
              = \frac{1}{2w} \iint \left( \frac{\partial (p h)}{\partial x}
              - p \frac{\partial h}{\partial x} \right)
    """

    surface_1: float
    mid_film: float
    surface_2: float
    """Integral of tau_zx over the pressurised film of the loaded zone at z = 0, h/2 and h, over the
    load [-]; the one at mid-film is the sliding part."""
    rolling: float
    """Rolling part by the pressure gradient, positive [-]."""
    rolling_by_film: float
    """The same by the slope of the film [-]."""
    load: float
    """Normal load w [N]."""
    sheared: float
    """Size of the mid-film stress, whatever its direction is at each place, over the load [-]."""
    powers: tuple[float, float]
    """`friction_power` and `sliding_power` [W]."""
    surroundings: Surroundings | None = None
    """Drag of the flooded oil around the loaded zone; None for starved films, and where surfaces
    slide across the entrainment or spin."""
    across: float | None = None
    """Integral of tau_zy at mid-film, over the load [-]; None if all motion is along x."""
    rolling_across: float | None = None
    """Rolling part along y: ``across`` less it at z = 0, plus it at z = h [-]."""
    drilling_moment: float | None = None
    """Moment of the mid-film stress on surface 1 about z at the centre, from x to y [N m]; that on
    surface 2 is opposite. None if neither surface spins."""

    @property
    def friction_power(self) -> float:
        """Return the power that the surfaces transfer to the film in the loaded zone [W]."""
        return self.powers[0]

    @property
    def sliding_power(self) -> float:
        """Return the part of it by sliding, of the mid-film stress; the rest is by rolling [W]."""
        return self.powers[1]

    @property
    def size(self) -> float:
        """Return the coefficient at mid-film of both directions together."""
        return math.hypot(self.mid_film, self.across or 0.0)

    @property
    def credible(self) -> bool:
        """Whether the friction at mid-film is physical: at most 0.1, also that of spin alone."""
        return max(self.size, self.sheared) <= LARGEST_CREDIBLE

    @property
    def closure_error(self) -> float:
        """Imbalance of the forces on the film, over the largest part [-].

        ``surface_2 - surface_1`` is twice the rolling part, by the pressure gradient and by the
        slope of the film: all three agree up to the discretisation error.
        """
        ends = self.surface_2 - self.surface_1
        parts = (ends, 2.0 * self.rolling, 2.0 * self.rolling_by_film)
        if not all(math.isfinite(part) for part in parts):
            return math.nan
        largest = max(map(abs, (*parts, self.surface_1, self.mid_film, self.surface_2)))
        return (max(parts) - min(parts)) / (largest or 1.0)


def traction(result: Solution) -> Traction | None:
    """Return the traction of ``result``, None where it has no shear stresses.

    Integrals are sums over the nodes under pressure, weighted by the part of their cells in the
    loaded zone; the gradient is a central difference. Where surfaces touch through a boundary film,
    its friction replaces the sliding part. The steady film at the start of a transient run carries
    the load at time zero.

    Parameters
    ----------
    result : Solution
        Steady, computed or loaded.
    """
    shear = result.shear
    if shear is None:
        return None
    motion, load = result.problem.motion, result.load
    wet = under_pressure(result)
    area = wet * zone_part(result.scaled.x, result.scaled.y, skew=result.groups.skew)
    inside = area > 0
    weights = area[inside]
    pressure, film = np.maximum(result.pressure, 0.0), result.film_thickness

    def integral(stress: Array) -> float:  # a dot product would start all threads of the BLAS
        return float(np.sum(weights * stress[inside]))

    boundary, found = result.problem.contact_film, result.contact
    carries = found is not None and bool(found.pressure.any())
    meet = carries and boundary is not None and boundary.meets(result.film_thickness)
    rubbed = np.where(meet, shear.mid_film, 0.0)
    first, middle, second = (
        integral(stress - rubbed) for stress in (shear.surface_1, shear.mid_film, shear.surface_2)
    )
    push = integral(film * _slope(pressure, result.x))
    whole = second * motion.speed_2 - first * motion.speed_1
    powers = whole, middle * (motion.speed_2 - motion.speed_1) + 0.0
    others: dict[str, float] = {}
    if not motion.is_plain:
        powers, others = _across(result, np.where(inside, area, 0.0), meet)
    lift = integral(_slope(pressure * film, result.x) - pressure * _slope(film, result.x))
    return Traction(
        surface_1=first / load,
        mid_film=middle / load,
        surface_2=second / load,
        rolling=0.5 * push / load,
        rolling_by_film=0.5 * lift / load,
        load=load,
        sheared=integral(np.hypot(shear.mid_film - rubbed, np.where(meet, 0.0, shear.across)))
        / load,
        surroundings=surroundings(result, shear, wet - area, load) if motion.is_plain else None,
        powers=powers,
        **others,
    )


def _across(
    result: Solution, area: Array, meet: BoolArray | bool
) -> tuple[tuple[float, float], dict[str, float]]:
    """Return the powers [W], and what `Traction` has of motion that is not along x alone.

    ``area`` is that of each node in the loaded zone [m^2]. Where surfaces ``meet`` there is no
    stress of the film.
    """
    shear, motion, x, y = result.shear, result.problem.motion, result.x, result.y[:, None]
    assert shear is not None
    pressure, film = np.maximum(result.pressure, 0.0), result.film_thickness
    rolling = 0.5 * film * (_slope(pressure.T, result.y).T if y.size > 1 else 0.0 * pressure)
    free = np.where(meet, 0.0, area)
    power, (slid_x, slid_y) = 0.0, motion.sliding_field(x, y)
    sheared = np.where(meet, 0.0, shear.mid_film) * slid_x + shear.across * slid_y
    for number, sign in ((1, -1.0), (2, 1.0)):
        u, v = motion.field_of(number, x, y)
        along = getattr(shear, f"surface_{number}") - np.where(meet, shear.mid_film, 0.0)
        sideways = np.where(meet, 0.0, shear.across) + sign * rolling
        power += sign * float(np.sum(area * (along * u + sideways * v)))
    found = {
        "across": float(np.sum(free * shear.across)) / result.load,
        "rolling_across": float(np.sum(area * rolling)) / result.load,
    }
    if motion.spin_1 or motion.spin_2:
        turning = x * shear.across - y * shear.mid_film
        found["drilling_moment"] = float(np.sum(free * turning))
    return (power, -float(np.sum(free * sheared))), found


def under_pressure(result: Solution) -> Array:
    """Return the area of the cell of each node that is under pressure [m^2], (ny, nx)."""
    area = np.outer(cell_widths(result.y), cell_widths(result.x))
    return area * wet_part(result.scaled.pressure)


def cell_widths(axis: Array) -> Array:
    """Return the width of the cell around each node of ``axis``, a half cell at the ends.

    A single row stands for one metre of a line contact.
    """
    if axis.size == 1:
        return np.ones(1)
    widths = np.gradient(axis)
    widths[[0, -1]] *= 0.5
    return np.asarray(widths)


def slope_across(result: Solution, field: Array, edge_order: Literal[1, 2] = 1) -> Array:
    """Return the derivative of a field along y, with what lies beyond the ends of a piece.

    Parameters
    ----------
    result : Solution
        Gives the lines, and how they go on.
    field : (ny, nx) array
        Values at the nodes; even about mirrors.
    edge_order : {1, 2}
        Order of the differences on edges.

    Returns
    -------
    (ny, nx) array
        In the unit of the field over metres; zero of a line contact.
    """
    y, shape = result.y, result.groups.shape
    if y.size == 1:
        return np.zeros_like(field)
    found = np.asarray(np.gradient(field, y, axis=0, edge_order=edge_order))
    if shape.goes_on:
        last = field[1] - field[-2]
        found[[0, -1]] = last / (2.0 * (y[1] - y[0])) if shape.wraps else 0.0
    return found


def _slope(field: Array, x: Array) -> Array:
    """Return the derivative along x, zero on the edges, where no film is under pressure."""
    slope = np.zeros_like(field)
    np.subtract(field[:, 2:], field[:, :-2], out=slope[:, 1:-1])
    slope *= 0.5 * (x.size - 1) / float(x[-1] - x[0])
    return slope


def rubbing_motion(result: Solution, carried: Array) -> tuple[float, float]:
    """Return how solids rub: the part of their friction in one direction [-], and the speed [m/s].

    Parameters
    ----------
    result : Solution
        With the motion of its contact.
    carried : (ny, nx) array
        Load of each node on solids [N].
    """
    motion, whole = result.problem.motion, float(carried.sum()) or 1.0
    if motion.is_plain:
        return float(motion.slides), abs(motion.speed_1 - motion.speed_2)
    along, across = motion.sliding_field(result.x, result.y[:, None])
    forces = (float((carried * part).sum()) / whole for part in sliding_direction(result))
    speed = float((carried * np.hypot(along, across)).sum()) / whole
    return math.hypot(*forces), speed


def rubbing_moment(result: Solution, friction: Array) -> float | None:
    """Return the moment of solids that rub on surface 1, about the normal at the centre [N m].

    None without spin.

    Parameters
    ----------
    result : Solution
        With the motion of its contact.
    friction : (ny, nx) array
        Friction of each node [N], against the local sliding.
    """
    motion = result.problem.motion
    if motion.spin_1 == 0.0 == motion.spin_2:
        return None
    along, across = sliding_direction(result)
    return float((friction * (result.y[:, None] * along - result.x * across)).sum())


def sliding_direction(result: Solution) -> tuple[Array, Array]:
    """Return the direction of u_1 - u_2, (ny, nx) along x and y; zero where nothing slides."""
    along, across = result.problem.motion.sliding_field(result.x, result.y[:, None])
    speed = np.hypot(along, across)
    first, second = (
        np.divide(part, speed, out=np.zeros_like(speed), where=speed > 0.0)
        for part in (along, across)
    )
    return first, second
