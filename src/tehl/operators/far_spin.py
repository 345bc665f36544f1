"""Pressure far from an ellipse that spins: on the edges of the grid, and the load outside of it.

With the gap G = g(a) r^2 / 2 of `tehl.operators.far_field` and the mean velocity
(u - Sigma E, Sigma X), E = kappa Y, the wedge is r (u cos a + u t sin a + Sigma r g' / 2): that by
spin grows with the radius. The Reynolds equation for P = 8 lambda f / r^3 is then

    g^3 f_ss + (g^3 f_a)_a - 9 g^3 f = u (cos a + t sin a) + Sigma r g' / 2,    f >= 0,

s = ln r (docs/theory/directions.md). Rings of the same growth carry the same load by spin, so there
is oil out to a radius, where f = 0. Nearer, with the film H in place of the gap,
P = 2 lambda r g^2 f / H^2, which is exact without cavitation.
"""

import math
from functools import lru_cache

import numpy as np
from scipy.interpolate import RegularGridInterpolator
from scipy.sparse import csr_array, diags_array, eye_array, kron
from scipy.sparse.linalg import splu

from tehl.base.typing import Array, BoolArray
from tehl.contact.moment import Moment
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups, ScaledProblem
from tehl.estimate.spin import flooded_reach, load_per_e_fold, slowing, spin_number
from tehl.operators.far_field import Edge, Edges, Gap, edges_of, far_field, gap_of, inlet_approach

TURNS, RING_STEP, INNERMOST, PER_RAY, MOST_ROUNDS = (32, 128), 0.25, 0.5, 12, 50
"""Nodes over a turn, few at first, step of ln r, radius of the first ring over the least distance
of the edges, places along a ray, and most steps to find the wet nodes."""


def _operator(gap: Gap, radius: Array, nodes: int) -> csr_array:
    """Return the left side of the equation on rings times angles, f = 0 beyond the last one.

    At the first ring f no longer changes: what is wrong with that falls as 1 / r^6.6 in P.
    """
    angle, step = np.linspace(0.0, 2.0 * np.pi, nodes, endpoint=False, retstep=True)
    at, between = gap.growth(angle) ** 3, gap.growth(angle + 0.5 * step) ** 3 / step**2
    before = np.roll(between, 1)
    around = diags_array(
        [-before - between - 9.0 * at, between[:-1], between[:-1], between[-1:], between[-1:]],
        offsets=[0, 1, -1, nodes - 1, 1 - nodes],
    )
    rings = radius.size
    out = diags_array([1.0, -2.0, 1.0], offsets=[-1, 0, 1], shape=(rings, rings)).tolil()
    out[0, 0] = -1.0
    return csr_array(kron(eye_array(rings), around) + kron(out / RING_STEP**2, diags_array(at)))


@lru_cache(maxsize=16)
def far_pressure(
    gap: Gap, speed: float, spin: float, radii: tuple[float, float]
) -> RegularGridInterpolator:
    """Return f over the logarithm of the radius and the angle within (0, 2 pi).

    A node is wet as long as f > 0, a dry one becomes wet where its equation would raise f.

    Parameters
    ----------
    gap : Gap
        The rigid gap.
    speed, spin : float
        Entrainment speed u along x over that of the contact, and Sigma [-].
    radii : (float, float)
        The first ring, and where the oil ends.
    """
    rings = max(math.ceil(math.log(radii[1] / radii[0]) / RING_STEP), 2)
    logarithm = math.log(radii[1]) - RING_STEP * np.arange(rings, 0, -1)
    radius = np.exp(logarithm)[:, None]
    wet: BoolArray | None = None
    f = np.zeros(0)
    for nodes in TURNS:
        angle = np.linspace(0.0, 2.0 * np.pi, nodes, endpoint=False)
        source = speed * (np.cos(angle) + gap.twist * np.sin(angle))
        source = (source + 0.5 * spin * radius * gap.opening(angle)).ravel()
        whole = _operator(gap, radius, nodes)
        if wet is None:
            wet = source < 0.0
        else:
            wet = np.repeat(wet.reshape(rings, -1), nodes // TURNS[0], axis=1).ravel()
        for _ in range(MOST_ROUNDS):
            f = np.zeros(source.size)
            inner = whole[wet][:, wet].tocsc()
            f[wet] = splu(inner, permc_spec="MMD_AT_PLUS_A").solve(source[wet])
            before, wet = wet, np.where(wet, f > 0.0, whole @ f > source)
            if np.array_equal(before, wet):
                break
    table = np.maximum(f, 0.0).reshape(rings, -1)
    table = np.pad(np.append(table, table[:, :1], axis=1), ((0, 1), (0, 0)))
    place = np.append(logarithm, math.log(radii[1])), np.linspace(0.0, 2.0 * np.pi, TURNS[-1] + 1)
    return RegularGridInterpolator(place, table, bounds_error=False, fill_value=0.0)


class FarSpin:
    """Pressure on the edges of ``grid``, and the load outside of it, as those of `FarField`.

    Parameters
    ----------
    grid : Grid
        Its edges.
    groups : Groups
        Lambda, radius ratio and ellipticity.
    moment, spin : Moment, float
        Speed and radius; and spin of `far_pressure`.
    reach : float
        Radius where the oil ends [a_x].
    """

    def __init__(
        self, grid: Grid, groups: Groups, moment: Moment, spin: float, *, reach: float
    ) -> None:
        gap, amplitude = gap_of(groups, moment.curvature), 2.0 * groups.lambda_bar
        x, y = grid.x, groups.ellipticity * grid.y
        nearest = min(float(np.abs(one[[0, -1]]).min()) for one in (x, y))
        f = far_pressure(gap, moment.speed, spin, (INNERMOST * nearest, max(reach, nearest)))
        self.edges: list[tuple[Edge, Array]] = []
        for edge, along, across in edges_of(grid, groups.ellipticity):
            at, radius = np.mod(np.arctan2(across, along), 2.0 * np.pi), np.hypot(along, across)
            there = f((np.log(radius), at))
            self.edges.append((edge, amplitude * radius * gap.growth(at) ** 2 * there))
        # the load outside: r dr = r^2 d(ln r) along rays, by Gauss
        angle, step = np.linspace(0.0, 2.0 * np.pi, TURNS[-1], endpoint=False, retstep=True)
        place, weight = np.polynomial.legendre.leggauss(PER_RAY)
        start = gap.rays(angle, (x[0], x[-1]), (y[0], y[-1]))
        length = np.log(np.maximum(reach / start, 1.0))
        radius = start * np.exp(0.5 * (1.0 + place[:, None]) * length)
        there = f((np.log(radius), np.broadcast_to(angle, radius.shape)))
        there *= 0.5 * weight[:, None] * length * step / groups.ellipticity
        growth = gap.growth(angle)
        self.rigid = 0.5 * moment.curvature * growth * radius**2
        self.weight = amplitude * radius**3 * growth**2 * there

    def set_edges(self, pressure: Array, film: Array) -> None:
        """Set the pressure on the edges for a film, as `FarField.set_edges`."""
        for edge, amplitude in self.edges:
            pressure[edge] = amplitude / film[edge] ** 2

    def load(self, film: Array, gap: Array) -> float:
        """Return the integral of P outside the grid [-], as `FarField.load`."""
        return float((self.weight / (inlet_approach(film, gap) + self.rigid) ** 2).sum())


def oil_outside(grid: Grid, scaled: ScaledProblem, moment: Moment) -> Edges:
    """Return the pressure on the edges of a grid and the load outside of it.

    Parameters
    ----------
    grid, scaled : Grid, ScaledProblem
        Its edges, and the contact.
    moment : Moment
        Speed, radius and load.
    """
    groups = scaled.entering
    if load_per_e_fold(scaled) == 0.0:
        return far_field(grid, groups, moment, slowing(scaled, grid.y))
    return FarSpin(grid, groups, moment, spin_number(scaled), reach=flooded_reach(scaled))
