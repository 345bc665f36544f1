"""Jacobian of the discrete Reynolds operator as sparse matrices, nodes numbered row by row.

Changes v of the pressures and c of the rigid approach change the film by K v + c, with the elastic
deflection K, and the operator L of `tehl.kernels.reynolds` by

    L_P v + L_H (K v + c)                            (docs/theory/numerics-rough.md, Newton).

L_P and L_H are sparse; K couples all nodes and is applied, never assembled.
"""

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_matrix, kron

from tehl.base.typing import Array, BoolArray, IntArray
from tehl.estimate.grid import Grid
from tehl.kernels.faces import CLOSED, MARK_THIRD_ORDER, MOST_OPENING, NO_FILM, Stencil
from tehl.kernels.properties import Film
from tehl.operators.turning import Entrainment


class Neighbours(NamedTuple):
    """Matrices that select a neighbour of each inner node; rows of edge nodes are zero.

    ``upstream`` is the upstream difference of the wedge, ``open_west`` the part of the west faces
    through which a pressure flows: none between a partly filled cell and the film behind it.
    """

    here: csr_matrix
    east: csr_matrix
    west: csr_matrix
    north: csr_matrix
    south: csr_matrix
    upstream: csr_matrix
    open_west: Array | float = 1.0

    def at(self, nodes: IntArray) -> "Neighbours":
        """Return those of some nodes only."""
        west = np.broadcast_to(self.open_west, self.here.shape[0])[nodes]
        return Neighbours._make((*(matrix[nodes] for matrix in self[:-1]), west))


class Cavity(NamedTuple):
    """Partly filled nodes of a film that conserves oil, (n,) each.

    ``full`` is one where the gap is full, ``ahead`` one at partly filled nodes with film behind
    them: no pressure flow enters them, as the film begins there (docs/theory/dynamics.md).
    """

    full: Array
    ahead: Array

    @classmethod
    def of(cls, film: Film) -> "Cavity":
        """Return the partly filled nodes of a film."""
        partial = film.partial > 0
        behind = np.cumsum(film.p[:, ::-1] > 0.0, axis=1)[:, ::-1] > 0
        return cls(*(one.astype(float).ravel() for one in (~partial, partial & behind)))

    def open_faces(self, there: csr_matrix, way: int) -> Array:
        """Return one at the faces to ``there`` with pressure flow, zero where the film begins.

        Parameters
        ----------
        there : csr_matrix
            Selects the neighbours.
        way : int
            1 to the east, -1 to the west, 0 along y.
        """
        here = self.ahead if way >= 0 else 0.0 * self.ahead
        beyond = there @ self.ahead if way <= 0 else 0.0 * self.ahead
        return np.asarray((1.0 - here) * (1.0 - beyond))


def neighbour(
    grid: Grid,
    inner: BoolArray,
    rows: int,
    columns: int,
    weight: float = 1.0,
    *,
    closed: bool = False,
) -> csr_matrix:
    """Return the matrix that selects a neighbour of each inner node, times ``weight``.

    Parameters
    ----------
    grid : Grid
        On mirrored grids rows before y = 0 are those behind it; a single row is its own neighbour.
    inner : array of bool, ``grid.shape``
        Nodes that are not on an edge.
    rows, columns : int
        Offset of the neighbour.
    weight : float
        Factor on all entries.
    closed : bool
        Whether rows beyond the first and last one are those before it: no oil flows through the
        ends of a roller. Where the film wraps they are those of the other end.
    """
    ny, nx = grid.shape
    j, i = np.nonzero(inner)
    there = np.abs(j + rows) if grid.mirror or closed else j + rows if ny > 1 else j
    if grid.wraps:
        there = j + rows
        there += (ny - 1) * ((there < 0).astype(int) - (there >= ny))
    elif closed:
        there = ny - 1 - np.abs(ny - 1 - there)
    column = i + columns
    inside = (there >= 0) & (there < ny) & (column >= 0) & (column < nx)
    places = (j[inside] * nx + i[inside], there[inside] * nx + column[inside])
    weights = np.full(places[0].size, weight)
    return csr_matrix((weights, places), shape=(ny * nx, ny * nx))


def neighbours_of(
    grid: Grid, stencil: Stencil, entrainment: Entrainment | None = None
) -> Neighbours:
    """Return the neighbours of the inner nodes.

    The difference upstream is that of a film whose cavities do not conserve oil.

    Parameters
    ----------
    grid : Grid
        On mirrored grids the row y = 0 is an inner one.
    stencil : Stencil
        Its ``w0``, ``w1``, ``w2`` are the weights of the wedge.
    entrainment : Entrainment or None
        Mean speeds where the surfaces spin.
    """
    inner = np.zeros(grid.shape, bool)
    inner[grid.inner] = True
    if entrainment is None or not entrainment.speed.size:
        upstream = _difference(grid, stencil, inner, (0, -1))
    else:
        speed, drift = np.broadcast_arrays(entrainment.speed[:, None], entrainment.drift)
        ways = ((0, -1, speed), (0, 1, -speed), (-1, 0, drift), (1, 0, -drift))
        upstream = sum(
            rows(np.maximum(size, 0.0).ravel()) @ _difference(grid, stencil, inner, (dj, di))
            for dj, di, size in ways
        )
    return Neighbours(
        here=neighbour(grid, inner, 0, 0),
        east=neighbour(grid, inner, 0, 1),
        west=neighbour(grid, inner, 0, -1),
        north=neighbour(grid, inner, 1, 0, closed=grid.is_closed),
        south=neighbour(grid, inner, -1, 0, closed=grid.is_closed),
        upstream=upstream,
    )


def _difference(grid: Grid, stencil: Stencil, inner: BoolArray, way: tuple[int, int]) -> csr_matrix:
    """Return the upstream difference of rho H; ``way``: rows and columns upstream.

    At the first node rho H continues linearly. Through a closed end comes what its line passes on.
    """
    (dj, di), inner = way, inner.copy()
    if dj and grid.is_closed:
        inner[0 if dj < 0 else -1] = False
    first = inner.copy()
    edge = (
        (slice(2, None) if dj < 0 else slice(-2) if dj > 0 else slice(None)),
        (slice(2, None) if di < 0 else slice(-2) if di > 0 else slice(None)),
    )
    first[edge] = False
    others = inner & ~first
    upstream = sum(
        (
            neighbour(grid, others, dj, di, stencil.w1),
            neighbour(grid, others, 2 * dj, 2 * di, stencil.w2),
            neighbour(grid, first, 0, 0, stencil.w0 - stencil.w2),
            neighbour(grid, first, dj, di, stencil.w1 + 2.0 * stencil.w2),
        ),
        neighbour(grid, others, 0, 0, stencil.w0),
    )
    if stencil.third > 0.0:
        upstream = upstream + _third_difference(grid, stencil, inner, way)
    return upstream


def _third_difference(
    grid: Grid, stencil: Stencil, inner: BoolArray, way: tuple[int, int]
) -> csr_matrix:
    """Return what makes the wedge one of third order: differences of t (m(i+1) - 2 m(i) + m(i-1)).

    ``t`` is the weight at the face downstream of node i; the first face of a line has none, nor has
    the last one of a column, beyond a closed end.
    """
    dj, di = way
    weight = np.full(grid.shape, stencil.third)
    weight[:, slice(stencil.fore + 1) if di > 0 else slice(stencil.fore, None)] *= 0.5
    weight[[0, -1] if dj else slice(None), (0 if di < 0 else -1) if di else slice(None)] = 0.0
    every = np.ones(grid.shape, bool)
    here, west = neighbour(grid, every, 0, 0), neighbour(grid, every, dj, di)
    bent = rows(weight.ravel()) @ (neighbour(grid, every, -dj, -di) - 2.0 * here + west)
    return csr_matrix(neighbour(grid, inner, 0, 0) @ (here - west) @ bent)


def jacobian(
    film: Film,
    stencil: Stencil,
    neighbours: Neighbours,
    by_pressure: Array,
    by_film: Array,
    cavity: Cavity | None = None,
) -> tuple[csr_matrix, csr_matrix]:
    """Return L_P and L_H, the derivatives of L by the pressures and by the films of all nodes.

    Parameters
    ----------
    film : Film
        Present state, with conductance and density up to date.
    stencil : Stencil
        Weights of the operator.
    neighbours : Neighbours
        Of `neighbours_of`.
    by_pressure, by_film : (ny, nx) array
        Derivatives of the conductance eps.
    cavity : Cavity or None
        Where the gap is partly filled: there the unknown is the oil instead of the pressure.
    """
    n, p = neighbours, film.p.ravel()
    flow, opening = csr_matrix(n.here.shape), csr_matrix(n.here.shape)
    parting, gap = csr_matrix(n.here.shape), film.h.ravel()
    # face flow (eps_here + eps_there)/2 (P_there - P_here): derivatives by P, then by eps
    for there, half, eps, way in _sides(film, stencil, n):
        step = there - n.here
        weight = half if cavity is None else half * cavity.open_faces(there, way)
        gaps = n.here @ gap, there @ gap
        power = _opening_power(stencil, *gaps, way)
        flow = flow + rows(weight * _both(stencil, n.here @ eps, there @ eps, way, power)) @ step
        pressed = weight * (step @ p)
        if _is_arithmetic(stencil, way):
            opening = opening + rows(pressed) @ (there + n.here)
        else:  # of the secant conductance: the tangent one differs where the film thins
            both = n.here @ film.eps.ravel(), there @ film.eps.ravel()
            here, beyond = _slopes(stencil, *both, way, power)
            opening = opening + rows(pressed * beyond) @ there + rows(pressed * here) @ n.here
            if stencil.mirror >= CLOSED and way == 0:
                parts = 1.5 * stencil.arithmetic * pressed * (power * both[0] - both[1] / power)
                near, far = (parts / np.where(one > 0.0, one, np.inf) for one in gaps)
                parting = parting + rows(far) @ there - rows(near) @ n.here
    # wedge rho H: rho by the film, drho/dP H by the pressure
    thicker, denser = film.rho.ravel(), (film.drho * film.h).ravel()
    slope = by_pressure.ravel()
    if cavity is not None:
        flow, slope, thicker = flow @ rows(cavity.full), slope * cavity.full, thicker * cavity.full
        denser = np.where(cavity.full > 0.0, denser, 1.0)
    pressed = flow + opening @ rows(slope) - n.upstream @ rows(denser)
    opened = opening @ rows(by_film.ravel()) - n.upstream @ rows(thicker)
    opened = opened + (parting @ rows(film.opening.ravel()) if film.opening.size else parting)
    return csr_matrix(pressed), csr_matrix(opened)


def _sides(
    film: Film, stencil: Stencil, n: Neighbours
) -> tuple[tuple[csr_matrix, Array | float, Array, int], ...]:
    """Return the neighbour, weight, conductance and way along x of the four faces of a cell."""
    eps_x, eps_y = film.eps_x.ravel(), film.eps_y.ravel()
    half_x, half_y = 0.5 * stencil.cx, 0.5 * stencil.cy
    south, north = (
        half_y * (n.here @ np.repeat(one, film.p.shape[1])) if one.size else half_y
        for one in (film.south, film.north)
    )
    return ((n.east, half_x, eps_x, 1), (n.west, half_x * n.open_west, eps_x, -1),
            (n.north, north, eps_y, 0), (n.south, south, eps_y, 0))  # fmt: skip


def _opening_power(stencil: Stencil, here: Array, there: Array, way: int) -> Array:
    """Return (H_there/H_here)^3/2 as `tehl.kernels.faces.opening_power` has it."""
    if way or stencil.mirror < CLOSED:
        return np.ones(here.shape)
    ratio = (np.abs(there) + NO_FILM) / (np.abs(here) + NO_FILM)
    return np.asarray(np.clip(ratio, 1.0 / MOST_OPENING, MOST_OPENING) ** 1.5)


def _both(stencil: Stencil, here: Array, there: Array, way: int, power: Array) -> Array:
    """Return twice the conductance of faces, as `tehl.kernels.faces` has it."""
    if _is_arithmetic(stencil, way):
        return there + here
    geometric, apart = 2.0 * np.sqrt(here * there), power * here + there / power
    return geometric + _arithmetic(stencil, here, there, way) * (apart - geometric)


def _is_arithmetic(stencil: Stencil, way: int) -> bool:
    return not stencil.geometric if way else stencil.arithmetic == 1.0


def _arithmetic(stencil: Stencil, here: Array, there: Array, way: int) -> Array:
    """Return the part of the arithmetic mean beside the geometric one."""
    rises = np.where(way * stencil.geometric * (there - here) > 0.0, 1.0 / 3.0, 0.0)
    return rises if way else np.full(here.shape, stencil.arithmetic)


def _slopes(
    stencil: Stencil, here: Array, there: Array, way: int, power: Array
) -> tuple[Array, Array]:
    """Return the derivatives of twice a conductance, not of an arithmetic mean, by both nodes'."""
    part = _arithmetic(stencil, here, there, way)
    inside = (here > 0.0) & (there > 0.0)  # rows of edge nodes are zero
    ratio = np.sqrt(np.where(inside, there, 1.0) / np.where(inside, here, 1.0))
    first, second = ratio, 1.0 / ratio
    return first + part * (power - first), second + part * (1.0 / power - second)


def flux_difference(
    film: Film,
    stencil: Stencil,
    grid: Grid,
    onward: IntArray | None = None,
    nodes: IntArray | None = None,
) -> csr_matrix:
    """Return the matrix of the wedge by fluxes of oil through cell faces, over the oil at nodes.

    A full node passes on 3/2 m(i) - 1/2 m(i-1) of its mass m where its order is two, with a third
    of the second difference where it is three, else m(i), as a partly filled one does; into the
    second node of a line flows their mean if the wedge is of second order.

    Parameters
    ----------
    film : Film
        With ``partial`` and ``second``.
    stencil : Stencil
        Weights of the operator.
    grid : Grid
        On mirrored grids the row y = 0 is an inner one.
    onward : array of int, ``grid.shape``, or None
        Column of the node whose flux each node passes on, -1 for none; itself if None.
    nodes : array of int or None
        Nodes of the rows; all if None.
    """
    nx, marks = grid.nx, np.where(film.partial > 0, 0, film.second)
    bent = np.zeros(grid.shape)
    if stencil.third > 0.0:
        bent[marks == MARK_THIRD_ORDER] = stencil.third * grid.dx
        bent[:, stencil.fore :] *= 0.5
    steep = np.where(marks > 0, 0.5, 0.0)
    west, here, east = bent - steep, 1.0 + steep - 2.0 * bent, bent
    if stencil.w2 > 0.0:
        full = (film.partial[:, 0] == 0) & (film.partial[:, 1] == 0)
        here[full, 0] = east[full, 0] = 0.5
    inner = np.zeros(grid.shape, bool)
    inner[grid.inner] = True
    of = np.arange(inner.size) if nodes is None else nodes
    row = np.nonzero(inner.ravel()[of])[0]
    j, i = np.divmod(of[row], nx)
    parts = []
    for column, sign in ((i, 1.0), (i - 1, -1.0)):
        source = column if onward is None else onward[j, column]
        for weight, step in ((west, -1), (here, 0), (east, 1)):
            there, size = source + step, sign / grid.dx * weight[j, source]
            kept = (source >= 0) & (there >= 0) & (there < nx) & (size != 0.0)
            parts.append((size[kept], row[kept], (j * nx + there)[kept]))
    sizes, rows_of, columns = (np.concatenate(part) for part in zip(*parts, strict=True))
    return csr_matrix((sizes, (rows_of, columns)), shape=(of.size, inner.size))


def rows(weights: Array) -> csr_matrix:
    """Return the diagonal matrix of ``weights``."""
    size = weights.size
    return csr_matrix((weights, np.arange(size), np.arange(size + 1)), shape=(size, size))


def interpolation(fine: Grid, coarse: Grid) -> csr_matrix:
    """Return the matrix of bilinear interpolation from a coarser grid of the same domain.

    Parameters
    ----------
    fine, coarse : Grid
        Of the same domain; the coarse one may be any number of halvings below. Where the film
        wraps its first row counts for the last one too, which has no weight.

    Returns
    -------
    csr_matrix
        Of shape (ny nx of ``fine``, ny nx of ``coarse``).
    """
    across, along = (_between(nf, nc) for nf, nc in zip(fine.shape, coarse.shape, strict=True))
    if coarse.wraps:
        rows_of = np.arange(coarse.shape[0]) % (coarse.shape[0] - 1)
        ring = (np.ones(rows_of.size), (np.arange(rows_of.size), rows_of))
        across = across @ csr_matrix(ring, shape=(rows_of.size, rows_of.size))
    return csr_matrix(kron(across, along))


def _between(fine: int, coarse: int) -> csr_matrix:
    """Return the matrix of linear interpolation from ``coarse`` to ``fine`` nodes of a line."""
    if fine == 1:  # of a line contact
        return csr_matrix(np.ones((1, 1)))
    place = np.arange(fine) * ((coarse - 1) / (fine - 1))
    low = np.minimum(place.astype(int), coarse - 2)
    part, node = place - low, np.arange(fine)
    weights = np.concatenate([1.0 - part, part])
    places = (np.concatenate([node, node]), np.concatenate([low, low + 1]))
    return csr_matrix((weights, places), shape=(fine, coarse))
