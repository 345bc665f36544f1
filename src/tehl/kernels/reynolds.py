"""Discrete Reynolds operator: its values, its diagonal, its residual.

With mobility and density frozen in ``eps`` and ``rho`` the steady Reynolds equation is

    L(p) = (eps p_x)_x + (eps p_y)_y / kappa^2 - (rho h)_x = 0   where p > 0,

with central differences of second order, the conductance of a face being the mean of both nodes,
and an upstream difference of the wedge (Venner and Lubrecht 2000, chapter 6). With ``mirror`` row 0
is the symmetry line y = 0; otherwise it is an edge with p = 0. Fields are those of
`tehl.kernels.properties`.
"""

from typing import NamedTuple

from tehl.kernels.compiled import helper, kernel, summing_helper
from tehl.kernels.properties import Film
from tehl.kernels.raw import raw
from tehl.typing import Array, FlagArray


class Stencil(NamedTuple):
    """Weights of the differences on one grid.

    ``cx = 1/dx^2``, ``cy = 1/(kappa dy)^2``; ``w0, w1, w2`` weigh rho h of a node and of its
    upstream neighbours: the wedge, in a time step wedge and squeeze at the new time; ``mirror`` is
    1 if row 0 is a symmetry line.
    """

    cx: float
    cy: float
    w0: float
    w1: float
    w2: float
    mirror: int


@helper
def row_below(j: int) -> int:
    """Return the row south of row ``j``: that of row 0 is the mirror image of row 1."""
    return j - 1 if j > 0 else 1


@helper
def clear(field: Array | FlagArray) -> None:
    """Fill a field with zeros."""
    ny, nx = field.shape
    for j in range(ny):
        for i in range(nx):
            field[j, i] = 0


@helper
def line_operator(film: Film, stencil: Stencil, j: int, out: Array, row: int) -> None:
    """Write L(p) on line ``j`` to ``row`` of ``out``; the ends are not touched."""
    p, eps_x, eps_y, nx = film.p, film.eps_x, film.eps_y, film.p.shape[1]
    south, north = row_below(j), j + 1
    half_x, half_y = 0.5 * stencil.cx, 0.5 * stencil.cy
    for i in range(1, nx - 1):
        east, west = eps_x[j, i] + eps_x[j, i + 1], eps_x[j, i] + eps_x[j, i - 1]
        upper, lower = eps_y[j, i] + eps_y[north, i], eps_y[j, i] + eps_y[south, i]
        flow_x = east * (p[j, i + 1] - p[j, i]) - west * (p[j, i] - p[j, i - 1])
        flow_y = upper * (p[north, i] - p[j, i]) - lower * (p[j, i] - p[south, i])
        out[row, i] = half_x * flow_x + half_y * flow_y
    _subtract_wedge(film, stencil, j, out, row)


@helper
def _subtract_wedge(film: Film, stencil: Stencil, j: int, out: Array, row: int) -> None:
    """Subtract the upstream difference of rho h along a line; node 1 continues rho h linearly."""
    rho, h, nx = film.rho, film.h, film.p.shape[1]
    w0, w1, w2 = stencil.w0, stencil.w1, stencil.w2
    out[row, 1] -= (w0 - w2) * rho[j, 1] * h[j, 1] + (w1 + 2.0 * w2) * rho[j, 0] * h[j, 0]
    for i in range(2, nx - 1):
        upstream = w1 * rho[j, i - 1] * h[j, i - 1]
        farther = w2 * rho[j, i - 2] * h[j, i - 2]
        out[row, i] -= w0 * rho[j, i] * h[j, i] + upstream + farther


@kernel
def operator(film: Film, stencil: Stencil, out: Array) -> None:
    """Write L(p) to ``out`` (ny, nx), zero on the edges."""
    film, out = raw((film, out))
    clear(out)
    for j in range(0 if stencil.mirror else 1, film.p.shape[0] - 1):
        line_operator(film, stencil, j, out, j)


@helper
def _node_diagonal(film: Film, stencil: Stencil, self_film: float, j: int, i: int) -> float:
    """Return ``-dL/dp`` of a node with itself; ``self_film``: dh/dp of a point on itself."""
    eps_x, eps_y, south = film.eps_x, film.eps_y, row_below(j)
    flow = 0.5 * stencil.cx * (2.0 * eps_x[j, i] + eps_x[j, i + 1] + eps_x[j, i - 1])
    flow += 0.5 * stencil.cy * (2.0 * eps_y[j, i] + eps_y[j + 1, i] + eps_y[south, i])
    return flow + stencil.w0 * (film.drho[j, i] * film.h[j, i] + film.rho[j, i] * self_film)


@kernel
def diagonal(film: Film, stencil: Stencil, self_film: float, out: Array) -> None:
    """Write ``-dL/dp`` on the diagonal to ``out`` (ny, nx), zero on the edges."""
    film, out = raw((film, out))
    clear(out)
    ny, nx = film.p.shape
    for j in range(0 if stencil.mirror else 1, ny - 1):
        for i in range(1, nx - 1):
            out[j, i] = _node_diagonal(film, stencil, self_film, j, i)


@summing_helper
def _line_norm(
    film: Film, stencil: Stencil, self_film: float, j: int, rest: Array
) -> tuple[float, int]:
    """Return sum and count of the scaled residual of line ``j``; see `residual`.

    Before convergence the diagonal may be negative, where the film is negative.
    """
    total, count = 0.0, 0
    for i in range(1, film.p.shape[1] - 1):
        r = rest[j, i]
        counts = film.p[j, i] > 0.0 or r < 0.0
        total += abs(r / _node_diagonal(film, stencil, self_film, j, i)) if counts else 0.0
        count += 1 if counts else 0
    return total, count


@kernel
def residual(film: Film, stencil: Stencil, rhs: Array, self_film: float, out: Array) -> float:
    """Write ``rhs - L(p)`` to ``out``, zero where cavitated; return its scaled mean.

    The mean is of ``|r|`` over the local diagonal, over nodes that are wet or will be
    (p > 0 or r < 0).

    Parameters
    ----------
    film, stencil : Film, Stencil
        State, and weights of the operator.
    rhs, out : array (ny, nx)
        Right-hand side, and residual.
    self_film : float
        dh/dp of a node with itself [-].
    """
    film, rhs, out = raw((film, rhs, out))
    total, count = 0.0, 0
    clear(out)
    ny, nx = film.p.shape
    for j in range(0 if stencil.mirror else 1, ny - 1):
        line_operator(film, stencil, j, out, j)
        for i in range(1, nx - 1):
            out[j, i] = rhs[j, i] - out[j, i]
        line_total, line_count = _line_norm(film, stencil, self_film, j, out)
        for i in range(1, nx - 1):
            out[j, i] = out[j, i] if film.p[j, i] > 0.0 else 0.0
        weight = 1 if (stencil.mirror and j == 0) else 1 + stencil.mirror
        total += weight * line_total
        count += weight * line_count
    return total / max(count, 1)


@kernel
def tangent_source(film: Film, stencil: Stencil, out: Array) -> None:
    """Write L(p) with ``eps_x, eps_y`` less L(p) with ``eps`` to ``out``, zero on the edges.

    It is the right-hand side f of the tangent equation (docs/theory/numerics-thermal.md, stress).
    """
    film, out = raw((film, out))
    clear(out)
    p, eps, eps_x, eps_y = film.p, film.eps, film.eps_x, film.eps_y
    ny, nx = p.shape
    half_x, half_y = 0.5 * stencil.cx, 0.5 * stencil.cy
    for j in range(0 if stencil.mirror else 1, ny - 1):
        south, north = row_below(j), j + 1
        for i in range(1, nx - 1):
            more = eps_x[j, i] - eps[j, i]
            east = more + (eps_x[j, i + 1] - eps[j, i + 1])
            west = more + (eps_x[j, i - 1] - eps[j, i - 1])
            more = eps_y[j, i] - eps[j, i]
            upper = more + (eps_y[north, i] - eps[north, i])
            lower = more + (eps_y[south, i] - eps[south, i])
            flow_x = east * (p[j, i + 1] - p[j, i]) - west * (p[j, i] - p[j, i - 1])
            flow_y = upper * (p[north, i] - p[j, i]) - lower * (p[j, i] - p[south, i])
            out[j, i] = half_x * flow_x + half_y * flow_y
