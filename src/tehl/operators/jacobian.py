"""Jacobian of the discrete Reynolds operator as sparse matrices, nodes numbered row by row.

Changes v of the pressures and c of the rigid approach change the film by K v + c, with the elastic
deflection K, and the operator L of `tehl.kernels.reynolds` by

    L_P v + L_H (K v + c)                            (docs/theory/numerics-rough.md, Newton).

L_P and L_H are sparse; K couples all nodes and is applied, never assembled.
"""

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_matrix, diags, kron

from tehl.base.typing import Array, BoolArray
from tehl.estimate.grid import Grid
from tehl.kernels.properties import Film
from tehl.kernels.reynolds import Stencil


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


def neighbour(
    grid: Grid, inner: BoolArray, rows: int, columns: int, weight: float = 1.0
) -> csr_matrix:
    """Return the matrix that selects a neighbour of each inner node, times ``weight``.

    Parameters
    ----------
    grid : Grid
        On mirrored grids rows before y = 0 are those behind it.
    inner : array of bool, ``grid.shape``
        Nodes that are not on an edge.
    rows, columns : int
        Offset of the neighbour.
    weight : float
        Factor on all entries.
    """
    ny, nx = grid.shape
    j, i = np.nonzero(inner)
    there = np.abs(j + rows) if grid.mirror else j + rows
    column = i + columns
    inside = (there >= 0) & (there < ny) & (column >= 0) & (column < nx)
    places = (j[inside] * nx + i[inside], there[inside] * nx + column[inside])
    weights = np.full(places[0].size, weight)
    return csr_matrix((weights, places), shape=(ny * nx, ny * nx))


def neighbours_of(grid: Grid, stencil: Stencil) -> Neighbours:
    """Return the neighbours of the inner nodes.

    The second-order wedge of node 1 needs a node before the first: rho H continues linearly there.

    Parameters
    ----------
    grid : Grid
        On mirrored grids the row y = 0 is an inner one.
    stencil : Stencil
        Its ``w0``, ``w1``, ``w2`` are the weights of the wedge.
    """
    inner = np.zeros(grid.shape, bool)
    inner[(0 if grid.mirror else 1) : -1, 1:-1] = True
    first = inner.copy()
    first[:, 2:] = False
    others = inner & ~first
    upstream = sum(
        (
            neighbour(grid, others, 0, -1, stencil.w1),
            neighbour(grid, others, 0, -2, stencil.w2),
            neighbour(grid, first, 0, 0, stencil.w0 - stencil.w2),
            neighbour(grid, first, 0, -1, stencil.w1 + 2.0 * stencil.w2),
        ),
        neighbour(grid, others, 0, 0, stencil.w0),
    )
    return Neighbours(
        here=neighbour(grid, inner, 0, 0),
        east=neighbour(grid, inner, 0, 1),
        west=neighbour(grid, inner, 0, -1),
        north=neighbour(grid, inner, 1, 0),
        south=neighbour(grid, inner, -1, 0),
        upstream=upstream,
    )


def jacobian(
    film: Film, stencil: Stencil, neighbours: Neighbours, by_pressure: Array, by_film: Array
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
    """
    n, (p, eps_x, eps_y) = neighbours, (field.ravel() for field in (film.p, film.eps_x, film.eps_y))
    half_x, half_y = 0.5 * stencil.cx, 0.5 * stencil.cy
    sides = ((n.east, half_x, eps_x), (n.west, half_x * n.open_west, eps_x),
             (n.north, half_y, eps_y), (n.south, half_y, eps_y))  # fmt: skip
    flow, opening = csr_matrix(n.here.shape), csr_matrix(n.here.shape)
    # face flow (eps_here + eps_there)/2 (P_there - P_here): derivatives by P, then by eps
    for there, half, conductance in sides:
        step = there - n.here
        flow = flow + rows(half * ((there + n.here) @ conductance)) @ step
        opening = opening + rows(half * (step @ p)) @ (there + n.here)
    # wedge rho H: rho by the film, drho/dP H by the pressure
    thicker, denser = film.rho.ravel(), (film.drho * film.h).ravel()
    pressed = flow + opening @ rows(by_pressure.ravel()) - n.upstream @ rows(denser)
    opened = opening @ rows(by_film.ravel()) - n.upstream @ rows(thicker)
    return csr_matrix(pressed), csr_matrix(opened)


def rows(weights: Array) -> csr_matrix:
    """Return the diagonal matrix of ``weights``."""
    return diags(weights, format="csr")


def interpolation(fine: Grid, coarse: Grid) -> csr_matrix:
    """Return the matrix of bilinear interpolation from a coarser grid of the same domain.

    Parameters
    ----------
    fine, coarse : Grid
        Of the same domain; the coarse one may be any number of halvings below.

    Returns
    -------
    csr_matrix
        Of shape (ny nx of ``fine``, ny nx of ``coarse``).
    """
    lines = (_between(nf, nc) for nf, nc in zip(fine.shape, coarse.shape, strict=True))
    return csr_matrix(kron(*lines))


def _between(fine: int, coarse: int) -> csr_matrix:
    """Return the matrix of linear interpolation from ``coarse`` to ``fine`` nodes of a line."""
    place = np.arange(fine) * ((coarse - 1) / (fine - 1))
    low = np.minimum(place.astype(int), coarse - 2)
    part, node = place - low, np.arange(fine)
    weights = np.concatenate([1.0 - part, part])
    places = (np.concatenate([node, node]), np.concatenate([low, low + 1]))
    return csr_matrix((weights, places), shape=(fine, coarse))
