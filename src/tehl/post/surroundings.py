"""Drag of the flooded oil around the loaded zone (docs/theory/traction.md).

On the grid it is the sum of the stresses outside of the loaded zone. Beyond the grid the oil is
ambient, the gap ``H = H_0 + c / r + g r^2 / 2``, of rigid paraboloids and the deflection by the
load, with H_0 and c from the film on the edges, and the pressure that of
`tehl.operators.far_field`, ``P = 2 lambda r g^2 f / H^2``.
"""

from dataclasses import dataclass

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.scaling import ScaledProblem
from tehl.result.fields import FilmShear
from tehl.result.solution import Solution

RAYS, RINGS = 16, 12
"""Nodes of Gauss over each range of angles in which the integrals are smooth, and over the
logarithm of the radius: with twice as many they change by 1e-5."""


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
    outer = 0.5 * length  # x = R_x / 2, where the gap of a circle is 7 % above a parabola
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
    totals, (x, y) = np.zeros(2), (result.scaled.x, stretch * result.scaled.y)
    corners = gap.place(*np.meshgrid(x[[0, -1]], y[[0, -1]])).ravel()
    angle, widths = _rays(angles, pressures, corners)
    slopes = np.gradient(pressures, angles)
    f, turned = (np.interp(angle, angles, one) for one in (pressures, slopes))
    growth, opening = gap.growth(angle), gap.opening(angle)
    last = outer / np.sqrt(growth)
    places, parts = np.polynomial.legendre.leggauss(RINGS)
    steps, parts = 0.5 * (1.0 + places[:, None]), 0.5 * parts
    for edge in gap.radii(angle, (x[0], x[-1]), (y[0], y[-1])):
        first = np.minimum(edge, last)
        stretched = np.log(last / first)
        radius = first * np.exp(steps * stretched)
        film = base + lift / radius + 0.5 * growth * radius**2
        unit = 2.0 * groups.lambda_bar * growth * radius / film**2
        pressure = unit * growth * f
        # of P = 2 lambda r g^2 f / H^2: its changes with ln r and with the angle
        outwards = pressure * (1.0 - 2.0 * (growth * radius**2 - lift / radius) / film)
        around = unit * growth * turned
        around += unit * opening * f * (2.0 - growth * radius**2 / film)
        slope = (np.cos(angle) * outwards - np.sin(angle) * around) / radius
        viscosity = result.problem.lubricant.viscosity.viscosity(
            result.scales.hertz_pressure * pressure, result.scales.temperature
        )
        entering = groups.lambda_bar / base_groups.lambda_bar / result.scales.viscosity
        measure = stretched * radius**2 * parts[:, None] * widths  # r dr = r^2 d(ln r)
        stresses = (entering * viscosity / film, 0.5 * film * slope)
        totals += [float((measure * stress).sum()) for stress in stresses]
    sliding, rolling = totals / stretch
    return float(sliding), float(rolling)


def _rays(angles: Array, pressures: Array, corners: Array) -> tuple[Array, Array]:
    """Return angles at which the oil is not cavitated, and their weights in an integral.

    ``pressures`` are f by angle, as `tehl.operators.far_field.angular_pressure` returns it; the
    edge of the grid has kinks at ``corners``.
    """
    wet, root = np.flatnonzero(pressures > 0.0), np.sqrt(pressures)
    ends = []
    for node, inside in ((wet[0], 1), (wet[-1], -1)):
        end = angles[node]
        if 0 < node < len(angles) - 1:  # f leaves zero as a parabola
            rise = (root[node + inside] - root[node]) / (angles[node + inside] - end)
            end -= min(root[node] / abs(rise), abs(angles[node] - angles[node - inside])) * inside
        ends.append(end)
    quarters = 0.5 * np.pi * np.arange(1, 5)
    kinks = [one for one in (*corners, *quarters) if ends[0] < one < ends[1]]
    places, weights = np.polynomial.legendre.leggauss(RAYS)
    limits = np.unique([ends[0], *kinks, ends[1]])
    half = 0.5 * np.diff(limits)[:, None]
    return (limits[:-1, None] + half * (1.0 + places)).ravel(), (half * weights).ravel()


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
