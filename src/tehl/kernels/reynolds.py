"""Compiled Reynolds operator: flow properties, residual, hybrid line relaxation.

Dimensionless, fields of shape (ny, nx), x along entrainment; ``p, h`` pressure and film,
``eps = rho h^3/(eta lambda)`` the conductance, ``rho`` the density. With ``mirror`` row 0 is the
symmetry line y = 0 and stands for its own mirror image; otherwise row 0 is an edge with p = 0.
The discrete operator is ``L(p) = (eps p_x)_x + (eps p_y)_y - (rho h)_x``.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from tehl.typing import Array


class Mesh(NamedTuple):
    """What the stencils need to know of the grid.

    ``cx = 1/dx^2``, ``cy = 1/(kappa dy)^2``; ``w0, w1, w2`` are the upstream wedge weights over
    dx; ``mirror`` is 1 when row 0 is a symmetry line.
    """

    cx: float
    cy: float
    w0: float
    w1: float
    w2: float
    mirror: int


class Film(NamedTuple):
    """Pressure, film and the frozen flow properties on one grid, each (ny, nx)."""

    p: Array
    h: Array
    eps: Array
    rho: Array
    drho: Array


class Relaxation(NamedTuple):
    """Setting and workspace of the line relaxation.

    ``point[m]`` and ``dipole[m]``: film at distance m along the line per unit change of a point
    and of a dipole; ``kind`` (ny, nx) marks the dipoles; ``delta`` (ny, nx) stores them until both
    colours are done; ``frozen`` (ny, nx) marks nodes that keep their pressure; ``band`` (6, nx)
    and ``state`` (nx,) belong to one line.
    """

    xi: float
    omega_point: float
    omega_dipole: float
    point: Array
    dipole: Array
    kind: Array
    delta: Array
    frozen: Array
    band: Array
    state: Array


@njit(cache=True)
def properties(film: Film, table: Array, step: float, floor: float) -> None:
    """Fill ``eps, rho, drho`` from ``p, h`` by cubic Hermite interpolation in ``table``.

    Columns of ``table``: rho/(eta lambda), its slope times ``step``, rho, its slope times
    ``step``. The film enters with no less than ``floor``.
    """
    ny, nx = film.p.shape
    last = table.shape[0] - 2
    for j in range(ny):
        for i in range(nx):
            h = max(film.h[j, i], floor)
            if film.p[j, i] <= 0.0:
                film.eps[j, i] = table[0, 0] * h * h * h
                film.rho[j, i] = table[0, 2]
                film.drho[j, i] = table[0, 3] / step
                continue
            x = film.p[j, i] / step
            k = min(int(x), last)
            t = min(x - k, 1.0)
            s = 1.0 - t
            a0, b0 = s * s * (1.0 + 2.0 * t), s * s * t
            a1, b1 = t * t * (1.0 + 2.0 * s), -t * t * s
            low, high = table[k], table[k + 1]
            film.eps[j, i] = (a0 * low[0] + b0 * low[1] + a1 * high[0] + b1 * high[1]) * h * h * h
            film.rho[j, i] = a0 * low[2] + b0 * low[3] + a1 * high[2] + b1 * high[3]
            film.drho[j, i] = (s * low[3] + t * high[3]) / step


@njit(cache=True)
def line_operator(film: Film, mesh: Mesh, j: int, out: Array) -> None:
    """Write L(p) on line ``j`` to ``out`` (nx,); the ends are not touched."""
    nx = film.p.shape[1]
    p, eps = film.p[j], film.eps[j]
    south = j - 1 if j > 0 else 1
    p_n, p_s, eps_n, eps_s = film.p[j + 1], film.p[south], film.eps[j + 1], film.eps[south]
    rho, h = film.rho[j], film.h[j]
    half_x, half_y = 0.5 * mesh.cx, 0.5 * mesh.cy
    for i in range(1, nx - 1):
        flow_x = (eps[i] + eps[i + 1]) * (p[i + 1] - p[i]) - (eps[i] + eps[i - 1]) * (
            p[i] - p[i - 1]
        )
        flow_y = (eps[i] + eps_n[i]) * (p_n[i] - p[i]) - (eps[i] + eps_s[i]) * (p[i] - p_s[i])
        out[i] = half_x * flow_x + half_y * flow_y
    out[1] -= (mesh.w0 - mesh.w2) * (rho[1] * h[1] - rho[0] * h[0])
    for i in range(2, nx - 1):
        out[i] -= (
            mesh.w0 * rho[i] * h[i]
            + mesh.w1 * rho[i - 1] * h[i - 1]
            + mesh.w2 * rho[i - 2] * h[i - 2]
        )


@njit(cache=True)
def operator(film: Film, mesh: Mesh, out: Array) -> None:
    """Write L(p) to ``out`` (ny, nx), zero on the edges."""
    ny, nx = film.p.shape
    out[:] = 0.0
    for j in range(0 if mesh.mirror else 1, ny - 1):
        line_operator(film, mesh, j, out[j])


@njit(cache=True)
def line_diagonal(film: Film, mesh: Mesh, self_film: float, j: int, out: Array) -> None:
    """Write ``-dL/dp`` on the diagonal of line ``j``; ``self_film = dh/dp`` of a point on itself."""
    nx = film.p.shape[1]
    eps = film.eps[j]
    south = j - 1 if j > 0 else 1
    eps_n, eps_s = film.eps[j + 1], film.eps[south]
    for i in range(1, nx - 1):
        out[i] = (
            0.5 * mesh.cx * (2.0 * eps[i] + eps[i + 1] + eps[i - 1])
            + 0.5 * mesh.cy * (2.0 * eps[i] + eps_n[i] + eps_s[i])
            + mesh.w0 * (film.drho[j, i] * film.h[j, i] + film.rho[j, i] * self_film)
        )


@njit(cache=True)
def residual(film: Film, mesh: Mesh, rhs: Array, self_film: float, out: Array) -> float:
    """Write ``rhs - L(p)`` to ``out``, zero where cavitated; return its scaled mean.

    The mean is of ``|r|`` over the local diagonal, over nodes that are wet or ought to be
    (p > 0 or r < 0).
    """
    ny, nx = film.p.shape
    diagonal = np.empty(nx)
    total, count = 0.0, 0
    out[:] = 0.0
    for j in range(0 if mesh.mirror else 1, ny - 1):
        line_operator(film, mesh, j, out[j])
        line_diagonal(film, mesh, self_film, j, diagonal)
        weight = 1 if (mesh.mirror and j == 0) else 1 + mesh.mirror
        for i in range(1, nx - 1):
            r = rhs[j, i] - out[j, i]
            out[j, i] = r
            if film.p[j, i] > 0.0:
                total += weight * abs(r) / diagonal[i]
                count += weight
            elif r < 0.0:
                total -= weight * r / diagonal[i]
                count += weight
                out[j, i] = 0.0
            else:
                out[j, i] = 0.0
    return total / max(count, 1)


@njit(cache=True)
def mark_dipoles(film: Film, mesh: Mesh, relaxation: Relaxation) -> None:
    """Mark the nodes that relax as dipoles: small conductance all round, nothing cavitated."""
    ny, nx = film.p.shape
    p, eps, kind = film.p, film.eps, relaxation.kind
    limit = relaxation.xi / max(mesh.cx, mesh.cy)
    kind[:] = 0
    for j in range(0 if mesh.mirror else 1, ny - 1):
        south = j - 1 if j > 0 else 1
        for i in range(1, nx - 1):
            largest = max(eps[j, i], eps[j, i - 1], eps[j, i + 1], eps[south, i], eps[j + 1, i])
            smallest = min(p[j, i], p[j, i - 1], p[j, i + 1], p[south, i], p[j + 1, i])
            if largest <= limit and smallest > 0.0:
                kind[j, i] = 1


@njit(cache=True)
def line_matrix(film: Film, mesh: Mesh, relaxation: Relaxation, j: int) -> None:
    """Fill ``band[s + 3, i]``: change of L at i per unit change of the unknown at i + s.

    The column follows the type of the unknown: a point changes p at one node, a dipole at its
    four neighbours too; both change the film along the line.
    """
    nx = film.p.shape[1]
    band, kind = relaxation.band, relaxation.kind[j]
    point, dipole = relaxation.point, relaxation.dipole
    eps, rho, h, drho = film.eps[j], film.rho[j], film.h[j], film.drho[j]
    south = j - 1 if j > 0 else 1
    eps_n, eps_s = film.eps[j + 1], film.eps[south]
    for i in range(1, nx - 1):
        w0, w1, w2 = mesh.w0, mesh.w1, mesh.w2
        far = i - 2
        if i == 1:
            w0, w1, w2, far = w0 - w2, w2 - w0, 0.0, 0
        east = 0.5 * mesh.cx * (eps[i] + eps[i + 1])
        west = 0.5 * mesh.cx * (eps[i] + eps[i - 1])
        across = 0.5 * mesh.cy * (2.0 * eps[i] + eps_n[i] + eps_s[i])
        # dL/dp at i-2, i-1, i, i+1 and dL/dh at i-2, i-1, i
        a_ww = -w2 * drho[far] * h[far]
        a_w = west - w1 * drho[i - 1] * h[i - 1]
        a_c = -east - west - across - w0 * drho[i] * h[i]
        b_ww, b_w, b_c = -w2 * rho[far], -w1 * rho[i - 1], -w0 * rho[i]
        for s in range(-3, 3):
            k = i + s
            if k < 1 or k > nx - 2:
                band[s + 3, i] = 0.0
            elif kind[k]:
                value = b_ww * dipole[abs(s + 2)] + b_w * dipole[abs(s + 1)] + b_c * dipole[abs(s)]
                if s == -3:
                    value -= 0.25 * a_ww
                elif s == -2:
                    value += a_ww - 0.25 * a_w
                elif s == -1:
                    value += a_w - 0.25 * (a_ww + a_c)
                elif s == 0:
                    value += a_c - 0.25 * (a_w + east + across)
                elif s == 1:
                    value += east - 0.25 * a_c
                else:
                    value -= 0.25 * east
                band[s + 3, i] = value
            else:
                value = b_ww * point[abs(s + 2)] + b_w * point[abs(s + 1)] + b_c * point[abs(s)]
                if s == -2:
                    value += a_ww
                elif s == -1:
                    value += a_w
                elif s == 0:
                    value += a_c
                elif s == 1:
                    value += east
                band[s + 3, i] = value


@njit(cache=True)
def band_solve(band: Array, state: Array, p: Array, rhs: Array, work: Array, u: Array) -> None:
    """Solve the six-diagonal system for ``u``, eliminating downstream without pivoting.

    Where ``state`` is 1 the row reads u = -p, where it is 2 it reads u = 0; ``work`` is (2, nx).
    """
    nx = p.shape[0]
    a1, b1, y1 = 0.0, 0.0, 0.0  # upper coefficients and right-hand side of rows i-1, i-2, i-3
    a2, b2, y2 = 0.0, 0.0, 0.0
    a3, b3, y3 = 0.0, 0.0, 0.0
    for i in range(1, nx - 1):
        if state[i]:
            up1, up2, y = 0.0, 0.0, -p[i] if state[i] == 1 else 0.0
        else:
            l3, l2, l1 = band[0, i], band[1, i], band[2, i]
            d, up1, up2, y = band[3, i], band[4, i], band[5, i], rhs[i]
            y -= l3 * y3
            l2 -= l3 * a3
            l1 -= l3 * b3
            y -= l2 * y2
            l1 -= l2 * a2
            d -= l2 * b2
            y -= l1 * y1
            d -= l1 * a1
            up1 -= l1 * b1
            inverse = 1.0 / d
            up1 *= inverse
            up2 *= inverse
            y *= inverse
        work[0, i], work[1, i], u[i] = up1, up2, y
        a3, b3, y3 = a2, b2, y2
        a2, b2, y2 = a1, b1, y1
        a1, b1, y1 = up1, up2, y
    u[nx - 1] = 0.0
    u1, u2 = 0.0, 0.0
    for i in range(nx - 2, 0, -1):
        u[i] -= work[0, i] * u1 + work[1, i] * u2
        u2, u1 = u1, u[i]


@njit(cache=True)
def line_complementarity(
    band: Array, state: Array, p: Array, rhs: Array, work: Array, u: Array
) -> None:
    """Solve the line with p + u >= 0 by policy iteration over the cavitated nodes."""
    nx = p.shape[0]
    for i in range(1, nx - 1):
        if state[i] != 2:
            state[i] = 1 if (p[i] <= 0.0 and rhs[i] >= 0.0) else 0
    for _ in range(6):
        band_solve(band, state, p, rhs, work, u)
        changed = False
        for i in range(1, nx - 1):
            if state[i] == 0:
                if u[i] < -p[i]:
                    state[i] = 1
                    changed = True
            elif state[i] == 1:
                r = rhs[i]
                for s in range(max(-3, 1 - i), min(3, nx - 1 - i)):
                    r -= band[s + 3, i] * u[i + s]
                if r < 0.0:
                    state[i] = 0
                    changed = True
        if not changed:
            return
    band_solve(band, state, p, rhs, work, u)
    for i in range(1, nx - 1):
        u[i] = max(u[i], -p[i])


@njit(cache=True)
def relax_lines(film: Film, mesh: Mesh, rhs: Array, relaxation: Relaxation) -> None:
    """One zebra sweep over the lines along x: points at once, dipoles after both colours."""
    ny, nx = film.p.shape
    first = 0 if mesh.mirror else 1
    mark_dipoles(film, mesh, relaxation)
    r, u, work = np.empty(nx), np.zeros(nx), np.empty((2, nx))
    delta = relaxation.delta
    delta[:] = 0.0
    for colour in range(2):
        for j in range(first + colour, ny - 1, 2):
            line_operator(film, mesh, j, r)
            for i in range(1, nx - 1):
                r[i] = rhs[j, i] - r[i]
            line_matrix(film, mesh, relaxation, j)
            p = film.p[j]
            for i in range(1, nx - 1):
                relaxation.state[i] = 2 if relaxation.frozen[j, i] else 0
            line_complementarity(relaxation.band, relaxation.state, p, r, work, u)
            for i in range(1, nx - 1):
                if relaxation.kind[j, i]:
                    delta[j, i] = relaxation.omega_dipole * u[i]
                elif u[i] <= -p[i]:
                    p[i] = 0.0
                else:
                    p[i] += relaxation.omega_point * u[i]
    add_dipoles(film.p, delta, mesh.mirror)


@njit(cache=True)
def add_dipoles(p: Array, delta: Array, mirror: int) -> None:
    """Add the stored dipoles to ``p`` and clip at zero."""
    ny, nx = p.shape
    for j in range(0 if mirror else 1, ny - 1):
        south = j - 1 if j > 0 else 1
        for i in range(1, nx - 1):
            around = delta[j, i - 1] + delta[j, i + 1] + delta[south, i] + delta[j + 1, i]
            p[j, i] = max(p[j, i] + delta[j, i] - 0.25 * around, 0.0)
