"""Drag of the flooded oil around the loaded zone (docs/theory/traction.md).

On the grid it is the sum of the stresses outside of the loaded zone. Beyond the grid the oil is
ambient, the gap ``H = H_0 + c / r + g r^2 / 2``, of rigid paraboloids and the deflection by the
load, with H_0 and c from the film on the edges, and the pressure that of
`tehl.operators.far_field`, ``P = 2 lambda r g^2 f / H^2``.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.scaling import ScaledProblem
from tehl.result.fields import FilmShear
from tehl.result.solution import Solution

LARGEST_GAP = 0.125
"""Gap over R_x up to which the oil counts, x = R_x / 2 on the x axis: the gap of a circle is 7 %
larger than that of a parabola there."""
RAYS, RINGS = 257, 129
"""Nodes over half a turn and over the logarithm of the radius: the integrals change by 1e-4 with
twice as many."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Surroundings:
    """Drag of the oil under pressure around the loaded zone, over the load of the contact [-].

    It depends on the logarithm of the radius up to which the gap is full, so it is not part of the
    traction. Negative for SRR > 0 and ``surface_1 = mid_film - rolling``, as in `Traction`.
    """

    surface_1: float
    mid_film: float
    surface_2: float
    """Integral of tau_zx at z = 0, h/2 and h, over the load [-]."""
    friction_power: float
    """Power that the surfaces transfer to this oil [W]."""
    radius: float
    """Distance from the contact along x up to which it counts, R_x / 2 [m]."""


class _Rays(NamedTuple):
    """Polar coordinates beyond the grid, (rings, rays), around it or on one side of y = 0."""

    angle: Array
    """(rays,): From downstream to upstream, and on where they go round."""
    radius: Array


def surroundings(
    result: Solution, shear: FilmShear, area: Array, load: float
) -> Surroundings | None:
    """Return the drag of the oil around the loaded zone; None for starved or non-finite films.

    Parameters
    ----------
    result : Solution
        Pressure and film.
    shear : FilmShear
        Its stresses.
    area : (ny, nx) array
        Area of each node that is under pressure outside of the loaded zone [m^2].
    load : float
        Normal load [N].
    """
    problem, scales = result.problem, result.scales
    if (
        problem.supply is not None
        or problem.contact.has_lines
        or not np.isfinite(result.scaled.film).all()
    ):
        return None
    length = scales.half_width_x / scales.film_thickness  # a_x in units of the film: R_x / a_x
    outer = length * math.sqrt(2.0 * LARGEST_GAP)
    sliding, rolling = _beyond(result, outer)
    unit = scales.viscosity * scales.speed / scales.film_thickness
    unit *= scales.half_width_x * scales.half_width_y
    sliding *= -problem.slide_roll_ratio * unit
    rolling *= unit * 12.0 / result.groups.lambda_bar
    chosen = area > 0
    weights = area[chosen]
    grid = [
        np.sum(weights * one[chosen]) for one in (shear.surface_1, shear.mid_film, shear.surface_2)
    ]
    beyond = (sliding - rolling, sliding, sliding + rolling)
    first, middle, second = (float(near + far) for near, far in zip(grid, beyond, strict=True))
    motion = problem.motion
    return Surroundings(
        surface_1=first / load,
        mid_film=middle / load,
        surface_2=second / load,
        friction_power=second * motion.speed_2 - first * motion.speed_1,
        radius=outer * scales.half_width_x,
    )


def _beyond(result: Solution, outer: float) -> tuple[float, float]:
    """Integrate over the oil beyond the grid, over X and Y [-].

    Returns the integrals of ``eta_bar / H``, the mid-film stress at SRR = -1, and of
    ``H dP/dX / 2``; ``outer`` is the largest X.
    """
    from tehl.operators.far_field import angular_pressure, gap_of  # noqa: PLC0415 (scipy)

    scaled = ScaledProblem.of(result.solved_problem)
    groups, base_groups = scaled.entering, result.groups
    gap, stretch = gap_of(groups), groups.ellipticity
    base, lift = _far_gap(result)
    angles, pressures = angular_pressure(gap)
    totals = np.zeros(2)
    angle = gap.angles(RAYS)
    growth, (x, y) = gap.growth(angle), (result.scaled.x, stretch * result.scaled.y)
    last = outer / np.sqrt(growth)
    steps = np.linspace(0.0, 1.0, RINGS)[:, None]
    for edge in gap.radii(angle, (x[0], x[-1]), (y[0], y[-1])):
        first = np.minimum(edge, last)
        radius = first * (last / first) ** steps
        rays = _Rays(angle, radius)
        f = np.interp(angle, angles, pressures)
        film = base + lift / radius + 0.5 * growth * radius**2
        pressure = 2.0 * groups.lambda_bar * growth**2 * f * radius / film**2
        viscosity = result.problem.lubricant.viscosity.viscosity(
            result.scales.hertz_pressure * pressure, result.scales.temperature
        )
        entering = groups.lambda_bar / base_groups.lambda_bar / result.scales.viscosity
        stresses = (entering * viscosity / film, 0.5 * film * _slope_along_x(rays, pressure))
        measure = np.where(f > 0.0, radius**2, 0.0)  # r dr = r^2 d(ln r)
        for index, stress in enumerate(stresses):
            along = np.trapezoid(measure * stress, np.log(radius), axis=0)
            totals[index] += np.trapezoid(along, angle)
    sliding, rolling = totals / stretch
    return float(sliding), float(rolling)


def _slope_along_x(rays: _Rays, field: Array) -> Array:
    """Return the derivative along X of a field on rays that begin at different radii."""
    rings = np.linspace(0.0, 1.0, RINGS)
    log = np.log(rays.radius)
    by_ring, by_angle = np.gradient(field, rings, rays.angle)
    stretch, skew = np.gradient(log, rings, rays.angle)
    by_log = by_ring / np.maximum(stretch, 1e-12)
    around = by_angle - by_log * skew
    cosine, sine = np.cos(rays.angle), np.sin(rays.angle)
    return np.asarray((cosine * by_log - sine * around) / rays.radius)


def _far_gap(result: Solution) -> tuple[float, float]:
    """Return H_0 and c of the gap H_0 + c / r + g r^2 / 2, by the film on the edges upstream."""
    scaled, groups = result.scaled, result.groups
    x, y = np.meshgrid(scaled.x, groups.ellipticity * scaled.y)
    edge = np.zeros(x.shape, bool)
    edge[:, 0] = edge[0] = edge[-1] = True
    edge &= x < 0.0
    radius, raised = np.hypot(x, y)[edge], scaled.film[edge]
    rigid = 0.5 * (x**2 + groups.radius_ratio * y**2)
    if groups.twist:
        rigid += groups.twist / groups.ellipticity * x * y
    raised = raised - rigid[edge]
    # least squares for two unknowns, by hand: lstsq would start all threads of the BLAS
    inverse, mean = 1.0 / radius, float(raised.mean())
    spread = inverse - inverse.mean()
    lift = float((spread * raised).sum() / (spread**2).sum())
    return mean - lift * float(inverse.mean()), lift
