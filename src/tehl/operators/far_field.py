"""Pressure far from the contact: its values on the edges of the grid, and the load outside.

Far away the gap is that of rigid paraboloids, G = g(a) r^2 / 2 with
g(a) = cos^2 a + 2 t cos a sin a + D sin^2 a in polar coordinates around the contact (t = 0 unless
the ellipse is at an angle to the entrainment), and the oil is ambient. There
P = 8 lambda f(a) / r^3 solves the Reynolds equation with complementarity if

    (g^3 f')' - 9 g^3 f = cos a + t sin a,    f >= 0

(docs/theory/numerics.md on the domain). For a circular contact f = A cosh 3 (pi - a) - cos(a) / 10
up to tan a = 3, where the oil cavitates; the second term alone is the pressure of a rigid sphere
without cavitation. Nearer, with the film H in place of the gap, P = 2 lambda r g^2 f / H^2, which
is exact for the second term.
"""

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np
from scipy.linalg import solve_banded

from tehl.base.typing import Array, BoolArray
from tehl.contact.moment import STEADY, Moment
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups
from tehl.operators.upstream import EdgeSlopes, UpstreamField

ANGLES, COARSER_ANGLES = 1025, (65, 257)
"""Nodes of f over the angle; the error of its values is below 1e-4 of its maximum. Fewer, on which
the cavitation front is found first: it moves by some nodes per step."""
Edge = tuple[slice, int] | tuple[int, slice]
"""Index of the nodes on one edge."""


class Gap(NamedTuple):
    """Gap of rigid paraboloids by direction."""

    ratio: float
    """D = R_x / R_y."""
    twist: float = 0.0
    """t, half of the mixed curvature over that along x."""

    def angles(self, nodes: int) -> Array:
        """Return ``nodes`` angles from downstream to upstream; with twist on to downstream again.

        A turn begins where the gap opens most along the entrainment: the oil is cavitated there.
        """
        if self.twist == 0.0:
            return np.linspace(0.0, np.pi, nodes)
        return np.arctan(self.twist) + np.linspace(0.0, 2.0 * np.pi, 2 * nodes - 1)

    def growth(self, angle: Array) -> Array:
        """Return g at some angles."""
        cosine, sine = np.cos(angle), np.sin(angle)
        growth: Array = cosine**2 + self.ratio * sine**2
        return growth + 2.0 * self.twist * cosine * sine if self.twist else growth

    def opening(self, angle: Array) -> Array:
        """Return dg/da at some angles."""
        double = 2.0 * angle
        return np.asarray((self.ratio - 1.0) * np.sin(double) + 2.0 * self.twist * np.cos(double))

    def place(self, x: float | Array, y: float | Array) -> Array:
        """Return the angles of places within the range of `angles`.

        Parameters
        ----------
        x, y : float or Array
            X and kappa Y, which broadcast.
        """
        at = np.arctan2(y, x)
        start = np.arctan(self.twist)
        return start + np.mod(at - start, 2.0 * np.pi) if self.twist else np.abs(at)

    def radii(self, angle: Array, x: tuple[float, float], y: tuple[float, float]) -> Array:
        """Return the radii of rays at the edges of a rectangle, (sides, n).

        Parameters
        ----------
        angle : (n,) array
            Of `angles`: without twist there are rays on both sides of the line y = 0.
        x, y : (float, float)
            Edges, X and kappa Y.
        """
        if self.twist:
            return self.rays(angle, x, y)[None]
        cosine, sine = np.cos(angle), np.sin(angle)
        along = np.where(cosine < 0.0, *x) / np.where(np.abs(cosine) < 1e-12, 1e-12, cosine)
        sides = np.array([[-y[0]], [y[1]]]) / np.maximum(sine, 1e-12)
        return np.asarray(np.minimum(along, sides))

    def rays(self, angle: Array, x: tuple[float, float], y: tuple[float, float]) -> Array:
        """Return the radii of rays at the edges of a rectangle, (n,), for any angles."""
        cosine, sine = np.cos(angle), np.sin(angle)
        along = np.where(cosine < 0.0, *x) / np.where(np.abs(cosine) < 1e-12, 1e-12, cosine)
        across = np.where(sine < 0.0, *y) / np.where(np.abs(sine) < 1e-12, 1e-12, sine)
        return np.asarray(np.minimum(np.abs(along), np.abs(across)))


def gap_of(groups: Groups, curvature: float = 1.0) -> Gap:
    """Return the rigid gap far from a contact, over its curvature along x."""
    return Gap(groups.radius_ratio / curvature, groups.twist / groups.ellipticity / curvature)


@lru_cache(maxsize=16)
def angular_pressure(gap: Gap) -> tuple[Array, Array]:
    """Return the angles of a gap, (n,), and the pressure f at them.

    The cavitation front follows from an active set: a node is wet as long as f > 0, a dry one
    becomes wet where its equation would raise f. It starts from that of fewer nodes.
    """
    angle = gap.angles(COARSER_ANGLES[0])
    found = angle, np.maximum(-_wedge(gap, angle), 0.0)
    for nodes in (*COARSER_ANGLES, ANGLES):
        angle, to_last, to_next, conductance = _angular_operator(gap, nodes)
        diagonal = -(to_next + to_last) - 9.0 * conductance
        source = _wedge(gap, angle)
        wet = np.interp(angle, *found) > 0.0
        for _ in range(200):
            f = _solve(to_last, diagonal, to_next, source, wet)
            inflow = to_next * np.append(f[1:], 0.0) + to_last * np.append(0.0, f[:-1])
            before, wet = wet, np.where(wet, f > 0.0, inflow > source)
            if np.array_equal(before, wet):
                break
        found = angle, np.where(wet, np.maximum(f, 0.0), 0.0)
    return found


@lru_cache(maxsize=16)
def angular_squeeze(gap: Gap) -> Array:
    """Return q at the angles of `angular_pressure`, zero where the oil is cavitated, (n,).

    Where the gap opens at a rate dH/dt the pressure changes by P = -lambda q(a) dH/dt / r^4, with
    (g^3 q')' - 8 g^3 q = -8.
    """
    angle, to_last, to_next, conductance = _angular_operator(gap, ANGLES)
    diagonal = -(to_next + to_last) - 8.0 * conductance
    wet = angular_pressure(gap)[1] > 0.0
    return _solve(to_last, diagonal, to_next, np.full(angle.size, -8.0), wet)


def _wedge(gap: Gap, angle: Array) -> Array:
    """Return cos a + t sin a."""
    source: Array = np.cos(angle)
    return source + gap.twist * np.sin(angle) if gap.twist else source


def _angular_operator(gap: Gap, nodes: int) -> tuple[Array, Array, Array, Array]:
    """Return the angles, both neighbours in (g^3 f')' and g^3, (n,) each."""
    angle = gap.angles(nodes)
    step = angle[1] - angle[0]
    conductance = gap.growth(angle) ** 3
    between = 0.5 * (conductance[1:] + conductance[:-1]) / step**2
    to_next, to_last = np.append(between, 0.0), np.append(0.0, between)
    to_next[0] *= 2.0  # both ends are symmetric, or cavitated
    to_last[-1] *= 2.0
    return angle, to_last, to_next, conductance


def _solve(to_last: Array, diagonal: Array, to_next: Array, source: Array, wet: BoolArray) -> Array:
    """Return f of the tridiagonal system at the ``wet`` nodes, zero elsewhere."""
    band = np.zeros((3, diagonal.size))
    band[0, 1:] = np.where(wet, to_next, 0.0)[:-1]
    band[1] = np.where(wet, diagonal, 1.0)
    band[2, :-1] = np.where(wet, to_last, 0.0)[1:]
    f: Array = solve_banded((1, 1), band, np.where(wet, source, 0.0))
    return f


def edges_of(grid: Grid, stretch: float) -> list[tuple[Edge, float | Array, float | Array]]:
    """Return the nodes of each edge of a grid, with X and ``stretch`` times Y there."""
    x, y, whole = grid.x, stretch * grid.y, slice(None)
    edges: list[tuple[Edge, float | Array, float | Array]] = [
        ((whole, 0), x[0], y),
        ((whole, -1), x[-1], y),
        ((-1, whole), x, y[-1]),
    ]
    return edges if grid.mirror else [*edges, ((0, whole), x, y[0])]


class Edges(Protocol):
    """The oil outside of a grid."""

    def set_edges(self, pressure: Array, film: Array) -> None:
        """Set the pressure on the edges for a film, (ny, nx)."""

    def load(self, film: Array, gap: Array) -> float:
        """Return the integral of P outside the grid [-], for film and undeformed gap."""
        ...


def slope_of(oil: Edges, film: Array, gap: Array) -> float:
    """Return the change of the load outside of a grid with the film [-], as of ``oil.load``."""
    step = 1e-4 * inlet_approach(film, gap)
    return (oil.load(film + step, gap) - oil.load(film - step, gap)) / (2.0 * step)


def inlet_approach(film: Array, gap: Array) -> float:
    """Return H_0, the mean difference of a film and the undeformed gap at the inlet edge [-]."""
    return max(float(np.mean(film[:, 0] - gap[:, 0])), 1e-9)


def far_field(
    grid: Grid, groups: Groups, moment: Moment = STEADY, slower: Array | float = 0.0
) -> Edges:
    """Return the pressure on the edges of a grid and the load outside of it.

    Parameters
    ----------
    grid : Grid
        Its edges.
    groups : Groups
        Shape, and lambda of the oil that enters.
    moment : Moment
        Speed, radius and load.
    slower : Array or float
        What spin takes from it on each row: oil outside of an ellipse does not depend on that
        (docs/theory/directions.md).
    """
    if moment.speed < 0.0:
        domain = grid.domain
        x, y = ((-high, -low) for low, high in (domain.x, domain.y))
        turned = replace(grid, domain=domain.model_copy(update={"x": x, "y": y}))
        forwards = far_field(turned, groups, replace(moment, speed=-moment.speed), -np.flip(slower))
        return Turned(forwards, 1 if grid.mirror else -1)
    if groups.shape.as_line:
        return UpstreamField(grid, groups, moment, slower)
    entering = replace(groups, lambda_bar=moment.speed * groups.lambda_bar)
    return FarField(grid, entering, moment.curvature)


class Turned:
    """The oil outside where the film moves against x: that of the contact turned by half a turn.

    ``step`` along the rows is -1, or 1 where they hold one half of a symmetric contact.
    """

    def __init__(self, forwards: Edges, step: int) -> None:
        self.forwards, self.turn = forwards, (slice(None, None, step), slice(None, None, -1))

    def set_edges(self, pressure: Array, film: Array) -> None:
        """Set the pressure on the edges for a film, (ny, nx)."""
        self.forwards.set_edges(pressure[self.turn], film[self.turn])

    def load(self, film: Array, gap: Array) -> float:
        """Return the integral of P outside the grid [-], for film and undeformed gap."""
        return self.forwards.load(film[self.turn], gap[self.turn])


class FarField:
    """Pressure on the edges of ``grid``, and the load outside of it.

    Parameters
    ----------
    grid : Grid
        Its edges.
    groups : Groups
        Lambda, radius ratio and ellipticity.
    curvature : float
        1/R_x over that of the contact [-].
    """

    def __init__(self, grid: Grid, groups: Groups, curvature: float = 1.0) -> None:
        self.groups = groups
        gap, stretch = gap_of(groups, curvature), groups.ellipticity
        angle, f = angular_pressure(gap)
        squeeze = groups.lambda_bar * angular_squeeze(gap)
        # each edge with 2 lambda r g^2 f and lambda g^2 q / 4 at its nodes
        self.edges: list[tuple[Edge, Array]] = []
        self.squeezed: list[Array] = []
        for edge, along, across in edges_of(grid, stretch):
            at = gap.place(along, across)
            shape = gap.growth(at) ** 2
            wedge = np.interp(at, angle, f) * shape
            radius = np.hypot(along, across)
            self.edges.append((edge, 2.0 * groups.lambda_bar * radius * wedge))
            self.squeezed.append(0.25 * shape * np.interp(at, angle, squeeze))
        # the load outside, ray by ray where the oil is not cavitated
        wet = f > 0.0
        self.growth = curvature * gap.growth(angle[wet])
        low, high = grid.domain.y
        radii = gap.radii(angle, grid.domain.x, (stretch * low, stretch * high))
        self.radius = np.ascontiguousarray(radii[:, wet])
        width = np.full(angle.size, angle[1] - angle[0])
        width[[0, -1]] *= 0.5
        self.weight = 8.0 * groups.lambda_bar / stretch / curvature**2 * (f * width)[wet]
        self.squeeze_weight = 0.25 * (squeeze * width)[wet] * self.growth / stretch

    def set_edges(self, pressure: Array, film: Array) -> None:
        """Set the pressure on the edges for a film.

        Parameters
        ----------
        pressure : Array
            P [-], (ny, nx); its edge nodes are overwritten.
        film : Array
            H [-], (ny, nx), positive on the edges.
        """
        for edge, amplitude in self.edges:
            pressure[edge] = amplitude / film[edge] ** 2

    def load(self, film: Array, gap: Array) -> float:
        """Return the integral of P outside the grid [-].

        Along each ray from radius R on, with H = H_0 + g r^2 / 2 and s^2 = 2 H_0 / g,

            int P r dr = 8 lambda f (acot(R / s) / (2 s) + R / (2 (R^2 + s^2))).

        Parameters
        ----------
        film, gap : array of the shape of the grid
            H and the undeformed gap.
        """
        base = inlet_approach(film, gap)
        s, r = np.sqrt(2.0 * base / self.growth), self.radius
        rays = np.arctan2(s, r) / (2.0 * s) + 0.5 * r / (r**2 + s**2)
        return float((self.weight * rays).sum())

    def slopes(self, film: Array, gap: Array) -> EdgeSlopes:
        """Return the changes by a uniform change of a film and by its rate, as of `load`."""
        by_film, by_rate = np.zeros_like(film), np.zeros_like(film)
        for (edge, amplitude), squeezed in zip(self.edges, self.squeezed, strict=True):
            by_film[edge] = -2.0 * amplitude / film[edge] ** 3
            by_rate[edge] = -squeezed / film[edge] ** 2
        base = inlet_approach(film, gap)
        outside = base + 0.5 * self.growth * self.radius**2
        return EdgeSlopes(
            by_film=by_film,
            by_rate=by_rate,
            load_by_film=np.full(len(film), slope_of(self, film, gap) / len(film)),
            load_by_rate=-float((self.squeeze_weight / outside).sum()),
            by_flux=np.zeros(len(film)),
            load_by_flux=np.zeros(len(film)),
        )
