"""Linear response of a steady film to small harmonic changes of the approach and of the speed.

The bodies move apart by d e^(i Omega t), and the speed changes by s e^(i Omega t)
(docs/theory/dynamics.md):

    L_P P_1 + L_H H_1 - i Omega (rho' H P_1 + rho H_1) = s (rho H)_x,    H_1 = d + K P_1,

with P_1 = 0 on the edges and in cavities, which stay where they are. L_P and L_H are those of
`tehl.operators.jacobian`: at Omega = 0 the response is the derivative of the discrete steady film.
With A = L_P + L_H K, B = rho' H + rho K and the source a + i Omega b, P_1 = Q + i Omega R, where

    A Q = a,    (A - i Omega B) R = b + B Q,

so that damping keeps its digits at low frequencies. `tehl.solver.physics.frequencies` solves them.
"""

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_matrix

from tehl.base.typing import Array, BoolArray
from tehl.operators.far_field import FarField
from tehl.operators.jacobian import (
    Cavity,
    Neighbours,
    flux_difference,
    jacobian,
    neighbours_of,
    rows,
)
from tehl.operators.upstream import EdgeSlopes, UpstreamField
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.linearised import conductance_slopes
from tehl.solver.physics.cavity import oil_flow


class Coefficients(NamedTuple):
    """Coefficients of the equations at all nodes, row by row: L_P, L_H, and (n,) each.

    ``density`` and ``denser`` are those of B by the film and by the pressure, ``wedge`` the source
    (rho H)_x of the speed.
    """

    by_pressure: csr_matrix
    by_film: csr_matrix
    density: Array
    denser: Array
    wedge: Array


class FilmResponse:
    """The linear equations of a film, each scaled by the sum of its coefficients.

    Parameters
    ----------
    level : Level
        With its steady film up to date.
    stored : array of ``grid.shape`` or None
        Density of the oil in a cell over that of the flux, in a heated film; None is one.
    """

    def __init__(self, level: Level, stored: Array | None = None) -> None:
        self.level = level
        neighbours = neighbours_of(level.grid, level.stencil, level.equations.entrainment)
        film, far = level.film, level.far_field
        inner = neighbours.here.diagonal() > 0.0
        self.unknown = self.carries = inner & (film.p > 0.0).ravel()
        ones = np.ones(inner.size)
        found = self._coefficients(neighbours, ones if stored is None else stored.ravel())
        self.outside = None
        self.face: Face | None = None
        if far is not None:
            assert isinstance(far, FarField | UpstreamField)  # steady, without spin
            self.outside = far.slopes(film.h, level.equations.gap)
            edge = (film.p > 0.0).ravel() & ~inner & (self.outside.by_film != 0.0).ravel()
            self.unknown = self.carries = self.unknown | edge
            found = _with_edges(found, edge.astype(float), film.p.ravel(), self.outside)
            if self.outside.by_flux.any():
                self.face = first_faces(level)
                found = _with_flux(found, self.outside.by_flux, self.face, level.grid.dx)
        near = level.equations.influence.self_film
        size = np.asarray(abs(found.by_pressure).sum(1) + near * abs(found.by_film).sum(1)).ravel()
        scale = np.where(self.unknown, 1.0 / np.where(self.unknown, size, 1.0), 0.0)
        kept = rows(self.unknown.astype(float))
        self.by_pressure = csr_matrix(rows(scale) @ found.by_pressure @ kept)
        self.by_film = csr_matrix(rows(scale) @ found.by_film)
        self.density, self.denser = scale * found.density, scale * found.denser
        self.wedge = scale * found.wedge

    def _coefficients(self, neighbours: Neighbours, part: Array) -> "Coefficients":
        """Return the coefficients at the inner nodes; ``part`` is that of ``stored``, (n,)."""
        level, cavity = self.level, None
        film, stencil = level.film, level.stencil
        oil = (film.rho * film.h).ravel()
        density, denser = film.rho.ravel() * part, (film.drho * film.h).ravel() * part
        if stencil.conserves:  # at partly filled nodes the unknown is the oil
            cavity = Cavity.of(film)
            partly = (cavity.full == 0.0) & (neighbours.here.diagonal() > 0.0)
            self.unknown = self.carries | partly
            flux = flux_difference(film, stencil, level.grid)
            neighbours, oil = neighbours._replace(upstream=flux), oil_flow(level)[0].ravel()
            density, denser = density * cavity.full, np.where(cavity.full > 0.0, denser, 1.0)
        slopes = conductance_slopes(level)
        by_pressure, by_film = jacobian(film, stencil, neighbours, *slopes, cavity)
        if cavity is not None:
            along, swept = moving_front(level)
            by_pressure, denser = csr_matrix(by_pressure + along), denser + swept
        return Coefficients(by_pressure, by_film, density, denser, neighbours.upstream @ oil)

    def parts(self, change: Array) -> tuple[Array, Array]:
        """Return A and B times changes of the unknowns, real or complex, (n,)."""
        film = self.deflection(change)
        steady = self.by_pressure @ change + self.by_film @ film
        return steady, self.denser * change + self.density * film

    def deflection(self, change: Array) -> Array:
        """Return K times the changes of the pressures, (n,)."""
        pressure = np.where(self.carries, change, 0.0)
        real = self._deflected(pressure.real)
        return real + 1j * self._deflected(pressure.imag) if np.iscomplexobj(pressure) else real

    def _deflected(self, pressure: Array) -> Array:
        shape = self.level.grid.shape
        film = np.empty(shape)
        of = np.ascontiguousarray(pressure).reshape(shape)
        self.level.equations.deformation.deflect(of, film)
        return film.ravel()

    def product(self, omega: float, change: Array) -> Array:
        """Return (A - i Omega B) times a change; identity where nothing is unknown."""
        inside = np.where(self.unknown, change, 0.0)
        steady, stored = self.parts(inside)
        flow = steady - 1j * omega * stored if omega else steady
        return np.where(self.unknown, flow, change)


def _with_edges(
    inner: Coefficients, edge: Array, pressure: Array, slopes: EdgeSlopes
) -> Coefficients:
    """Return the coefficients with the far field on the edges: u - (E + i Omega S) H_1 = s P."""
    return Coefficients(
        csr_matrix(inner.by_pressure + rows(edge)),
        csr_matrix(inner.by_film - rows(edge * slopes.by_film.ravel())),
        (1.0 - edge) * inner.density + edge * slopes.by_rate.ravel(),
        (1.0 - edge) * inner.denser,
        inner.wedge + edge * pressure,
    )


class Face(NamedTuple):
    """Flux of the oil through the first face of each line, to first order.

    Its changes by pressure and film at all nodes, (lines, n), and rho H there less the flux.
    """

    by_pressure: csr_matrix
    by_film: csr_matrix
    spare: Array


def first_faces(level: Level) -> Face:
    """Return the fluxes through the first faces of the lines of a level."""
    film, dx, lines = level.film, level.grid.dx, np.arange(level.grid.shape[0])
    eps, slope = 0.5 * (film.eps[:, 0] + film.eps[:, 1]), (film.p[:, 1] - film.p[:, 0]) / dx
    # eps is as H^3
    by_film = 0.5 * film.rho[:, :2] - 1.5 * film.eps[:, :2] / film.h[:, :2] * slope[:, None]
    pressed = np.stack([eps / dx, -eps / dx], axis=1)
    nodes = lines[:, None] * level.grid.nx + np.arange(2)
    shape = (lines.size, film.p.size)
    first, second = (
        csr_matrix((one.ravel(), (np.repeat(lines, 2), nodes.ravel())), shape=shape)
        for one in (pressed, by_film)
    )
    return Face(first, second, eps * slope)


def _with_flux(inner: Coefficients, by_flux: Array, face: Face, dx: float) -> Coefficients:
    """Return the coefficients with the change of the pressures at the inlet edge by the fluxes."""
    lines = np.arange(by_flux.size)
    first = lines * (inner.density.size // lines.size)
    shape = (inner.density.size, lines.size)
    edge = csr_matrix((-by_flux, (first, lines)), shape=shape)
    density, wedge = inner.density.copy(), inner.wedge.copy()
    density[first] += 0.5 * dx * by_flux  # the flux at the edge, half a mesh width upstream
    wedge[first] += by_flux * face.spare
    return Coefficients(
        csr_matrix(inner.by_pressure + edge @ face.by_pressure),
        csr_matrix(inner.by_film + edge @ face.by_film),
        density,
        inner.denser,
        wedge,
    )


def moving_front(level: Level) -> tuple[csr_matrix, Array]:
    """Return flow along the fronts where a film begins, and oil that they sweep, by the pressure.

    Where the pressure rises by P_1 a front x = f(y) moves by -P_1/P_x. Oil that flows along the
    front, and the gap between the layer ahead of it and the film, make the flux into the film

        -d/dy (eps f' P_1) - i Omega eps (1 + f'^2) P_1    per length along y

    (docs/theory/dynamics.md, starved films). The matrix over all nodes and the array, (n,), belong
    to the first node of the film on each line.
    """
    film, grid = level.film, level.grid
    wet, lines = film.p > 0.0, np.arange(grid.shape[0])
    begins = wet[:, 1:] & ~wet[:, :-1] & (film.partial[:, :-1] > 0)
    has: BoolArray = np.asarray(begins.any(axis=1))
    first = np.minimum(np.argmax(begins, axis=1) + 1, grid.nx - 2)
    has[list(grid.edge_rows)] = False
    here, node = film.p[lines, first], lines * grid.nx + first
    rise = np.where(has, film.p[lines, first + 1] - here, 1.0)
    place = grid.x[first] - grid.dx * np.clip(here / np.where(rise > 0.0, rise, np.inf), 0.0, 1.0)
    width = level.equations.groups.ellipticity * grid.dy
    eps = film.eps[lines, first]
    both = has[1:] & has[:-1]
    slope = np.where(both, np.diff(place) / width, 0.0)
    # line by line: half the flux of both lines through each face between them
    low, high = node[:-1][both], node[1:][both]
    flow = 0.5 * slope[both] / (grid.dx * width)
    first_image, last_image = grid.mirror or grid.is_closed, grid.is_closed
    times = np.ones(lines.size)  # images beyond a line bring as much again
    if not grid.wraps:
        times[0], times[-1] = 1.0 + first_image, 1.0 + last_image
    entries = [
        (row, column, sign * flow * eps[at][both])
        for row, sign in ((low, -times[:-1][both]), (high, times[1:][both]))
        for column, at in ((low, slice(None, -1)), (high, slice(1, None)))
    ]
    row, column, value = (np.concatenate(part) for part in zip(*entries, strict=True))
    if grid.wraps:  # both ends are one line: what one gets the other does
        other = np.where(row == node[0], node[-1], np.where(row == node[-1], node[0], -1))
        ends = other >= 0
        row, column = np.append(row, other[ends]), np.append(column, column[ends])
        value = np.append(value, value[ends])
    along = csr_matrix((value, (row, column)), shape=(wet.size, wet.size))
    none = np.zeros(1)
    before = np.append(-slope[:1] if first_image and slope.size else none, slope)
    after = np.append(slope, -slope[-1:] if last_image and slope.size else none)
    if grid.wraps:
        before[0], after[-1] = slope[-1], slope[0]
    mean, swept = 0.5 * (before + after), np.zeros(wet.size)
    swept[node[has]] = (eps * (1.0 + mean**2) / grid.dx)[has]
    return along, swept
