"""Compiled Reynolds operator: flow properties, residual, hybrid line relaxation.

Dimensionless, fields of shape (ny, nx), x along entrainment; ``p, h`` pressure and film,
``eps = rho h^3/(eta lambda)`` the conductance, ``rho`` the density. With ``mirror`` row 0 is the
symmetry line y = 0 and stands for its own mirror image; otherwise row 0 is an edge with p = 0.
The discrete operator is ``L(p) = (eps p_x)_x + (eps p_y)_y - (rho h)_x``.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from tehl.typing import Array, FlagArray

Span = tuple[int, int]

LANES = 8  # lines of one colour that are solved side by side
PASSES = 6  # of the policy iteration, before clipping
CHUNK = 32  # nodes copied at a time, so that their cells stay in the first cache
EAST, ACROSS, SQUEEZE, RHO, DIPOLE, REST, P, STATE, BAND = range(9)
UP1, UP2, U, FIELDS = BAND + 6, BAND + 7, BAND + 8, BAND + 9


class Mesh(NamedTuple):
    """What the stencils need to know of the grid.

    ``cx = 1/dx^2``, ``cy = 1/(kappa dy)^2``; ``w0, w1, w2`` weigh rho h of a node and
    of its upstream neighbours: the wedge, or in a step of time what of wedge and squeeze is not
    history; ``mirror`` is 1 when row 0 is a symmetry line.
    """

    cx: float
    cy: float
    w0: float
    w1: float
    w2: float
    mirror: int


class Film(NamedTuple):
    """Pressure, film and the frozen flow properties on one grid, each (ny, nx).

    ``eps_x, eps_y`` are the conductances along x and y: ``eps`` itself, unless the film thins in
    shear. Then they are the larger ones of a small change of the pressure gradient, the sliding
    speed being kept, and the right-hand side takes the difference back (`tangent_source`).
    """

    p: Array
    h: Array
    eps: Array
    rho: Array
    drho: Array
    eps_x: Array
    eps_y: Array


class Relaxation(NamedTuple):
    """Setting and workspace of the line relaxation.

    ``point[m]`` and ``dipole[m]``: film at distance m along the line per unit change of a point
    and of a dipole; ``kind`` (ny, nx) marks the dipoles; ``delta`` (ny, nx) stores them until both
    colours are done; ``frozen`` (ny, nx) marks nodes that keep their pressure; ``steep`` (ny, nx)
    is what the change of conductance adds to the diagonal (`stiffen`).
    """

    xi: float
    omega_point: float
    omega_dipole: float
    point: Array
    dipole: Array
    kind: FlagArray
    delta: Array
    frozen: FlagArray
    steep: Array


@njit(cache=True, fastmath={"contract"})
def line_properties(film: Film, table: Array, step: float, floor: float, j: int) -> None:
    """Fill ``eps, rho, drho`` of line ``j``; see `properties`."""
    p, h, eps, rho, drho = film.p[j], film.h[j], film.eps[j], film.rho[j], film.drho[j]
    flat, last, per_step = table.ravel(), table.shape[0] - 2, 1.0 / step
    for i in range(p.shape[0]):
        x = p[i] * per_step
        x = 0.0 if x <= 0.0 else x
        k = int(min(x, last))
        t = min(x - k, 1.0)
        s = 1.0 - t
        near = flat[4 * k : 4 * k + 8]
        low, high = (
            near[0] + t * (near[1] + 2.0 * near[0]),
            near[4] + s * (2.0 * near[4] - near[5]),
        )
        thick = max(h[i], floor)
        eps[i] = (s * s * low + t * t * high) * (thick * thick * thick)
        low, high = (
            near[2] + t * (near[3] + 2.0 * near[2]),
            near[6] + s * (2.0 * near[6] - near[7]),
        )
        rho[i] = s * s * low + t * t * high
        drho[i] = (s * near[3] + t * near[7]) * per_step


@njit(cache=True)
def properties(film: Film, table: Array, step: float, floor: float) -> None:
    """Fill ``eps, rho, drho`` from ``p, h`` by cubic Hermite interpolation in ``table``.

    Columns of ``table``: rho/(eta lambda), its slope times ``step``, rho, its slope times
    ``step``. The film enters with no less than ``floor``.
    """
    for j in range(film.p.shape[0]):
        line_properties(film, table, step, floor, j)


class Factors(NamedTuple):
    """What heat and shear thinning make of the flow, each (ny, nx).

    The mobility becomes ``rest`` plus ``mobility`` times the isothermal Newtonian one, and that
    along x and y ``stretch_x`` and ``stretch_y`` times as much; the density ``density`` times its
    own.
    """

    rest: Array
    mobility: Array
    density: Array
    stretch_x: Array
    stretch_y: Array


class Heated(NamedTuple):
    """What the energy equation says of the flow, each (ny, nx).

    ``mobility``, rho/(eta lambda), and ``density`` of the heated, sheared film, scaled as those of
    the table of `properties`; ``steep`` the part of the mobility that follows the isothermal one;
    ``stretch_x, stretch_y`` as in `Factors`.
    """

    mobility: Array
    density: Array
    steep: Array
    stretch_x: Array
    stretch_y: Array


@njit(cache=True)
def factors_of(heated: Heated, film: Film, table: Array, step: float, factors: Factors) -> None:
    """Fill ``factors`` at the pressures ``film.p``; ``eps, rho, drho`` are lost."""
    for j in range(film.p.shape[0]):
        line_properties(film, table, step, 0.0, j)
        for i in range(film.p.shape[1]):
            mobility, steep = heated.mobility[j, i], heated.steep[j, i]
            factors.rest[j, i] = mobility * (1.0 - steep)
            factors.mobility[j, i] = mobility * steep / film.eps[j, i]
            factors.density[j, i] = heated.density[j, i] / film.rho[j, i]
            factors.stretch_x[j, i] = heated.stretch_x[j, i]
            factors.stretch_y[j, i] = heated.stretch_y[j, i]


@njit(cache=True)
def heated_properties(
    film: Film, factors: Factors, table: Array, step: float, floor: float
) -> None:
    """Fill ``eps, rho, drho, eps_x, eps_y`` of the heated, sheared film; see `properties`."""
    for j in range(film.p.shape[0]):
        line_properties(film, table, step, floor, j)
        scale_line(film, factors, floor, j)


@njit(cache=True, fastmath={"contract"})
def scale_line(film: Film, factors: Factors, floor: float, j: int) -> None:
    """Turn isothermal Newtonian properties of line ``j`` into those of the heated film."""
    h, eps, rho, drho = film.h[j], film.eps[j], film.rho[j], film.drho[j]
    rest, mobility, density = factors.rest[j], factors.mobility[j], factors.density[j]
    for i in range(h.shape[0]):
        thick = max(h[i], floor)
        eps[i] = mobility[i] * eps[i] + rest[i] * (thick * thick * thick)
        rho[i] *= density[i]
        drho[i] *= density[i]
    eps_x, eps_y = film.eps_x[j], film.eps_y[j]
    stretch_x, stretch_y = factors.stretch_x[j], factors.stretch_y[j]
    for i in range(h.shape[0]):
        eps_x[i] = stretch_x[i] * eps[i]
        eps_y[i] = stretch_y[i] * eps[i]


@njit(cache=True)
def tangent_source(film: Film, mesh: Mesh, out: Array) -> None:
    """Write what ``eps_x`` and ``eps_y`` add to L(p) over ``eps`` at the present pressure.

    Zero on the edges.
    """
    ny, nx = film.p.shape
    out[:] = 0.0
    half_x, half_y = 0.5 * mesh.cx, 0.5 * mesh.cy
    for j in range(0 if mesh.mirror else 1, ny - 1):
        south = j - 1 if j > 0 else 1
        p, more = film.p[j], film.eps_x[j] - film.eps[j]
        p_n, p_s, more_y = film.p[j + 1], film.p[south], film.eps_y[j] - film.eps[j]
        more_n = film.eps_y[j + 1] - film.eps[j + 1]
        more_s = film.eps_y[south] - film.eps[south]
        for i in range(1, nx - 1):
            east, west = more[i] + more[i + 1], more[i] + more[i - 1]
            north, back = more_y[i] + more_n[i], more_y[i] + more_s[i]
            flow_y = north * (p_n[i] - p[i]) - back * (p[i] - p_s[i])
            out[j, i] = half_x * (east * (p[i + 1] - p[i]) - west * (p[i] - p[i - 1]))
            out[j, i] += half_y * flow_y


@njit(cache=True, fastmath={"contract"})
def line_operator(film: Film, mesh: Mesh, j: int, out: Array) -> None:
    """Write L(p) on line ``j`` to ``out`` (nx,); the ends are not touched.

    Slices named after the compass start at the neighbour of node 1.
    """
    nx = film.p.shape[1]
    south = j - 1 if j > 0 else 1
    p_w, p, p_e = film.p[j, :-2], film.p[j, 1:-1], film.p[j, 2:]
    eps_w, eps_x, eps_e = film.eps_x[j, :-2], film.eps_x[j, 1:-1], film.eps_x[j, 2:]
    p_n, p_s = film.p[j + 1, 1:-1], film.p[south, 1:-1]
    eps_n, eps_y, eps_s = film.eps_y[j + 1, 1:-1], film.eps_y[j, 1:-1], film.eps_y[south, 1:-1]
    half_x, half_y = 0.5 * mesh.cx, 0.5 * mesh.cy
    target = out[1:-1]
    for i in range(nx - 2):
        east, west = eps_x[i] + eps_e[i], eps_x[i] + eps_w[i]
        north, back = eps_y[i] + eps_n[i], eps_y[i] + eps_s[i]
        flow_x = east * (p_e[i] - p[i]) - west * (p[i] - p_w[i])
        flow_y = north * (p_n[i] - p[i]) - back * (p[i] - p_s[i])
        target[i] = half_x * flow_x + half_y * flow_y
    subtract_wedge(film.rho[j], film.h[j], mesh, out)


@njit(cache=True, fastmath={"contract"})
def subtract_wedge(rho: Array, h: Array, mesh: Mesh, out: Array) -> None:
    """Subtract the upstream difference of rho h along a line; node 1 continues rho h linearly."""
    w0, w1, w2 = mesh.w0, mesh.w1, mesh.w2
    out[1] -= (w0 - w2) * rho[1] * h[1] + (w1 + 2.0 * w2) * rho[0] * h[0]
    rho_c, rho_w, rho_ww = rho[2:-1], rho[1:-2], rho[:-3]
    h_c, h_w, h_ww = h[2:-1], h[1:-2], h[:-3]
    target = out[2:-1]
    for i in range(target.shape[0]):
        target[i] -= w0 * rho_c[i] * h_c[i] + w1 * rho_w[i] * h_w[i] + w2 * rho_ww[i] * h_ww[i]


@njit(cache=True)
def operator(film: Film, mesh: Mesh, out: Array) -> None:
    """Write L(p) to ``out`` (ny, nx), zero on the edges."""
    ny = film.p.shape[0]
    out[:] = 0.0
    for j in range(0 if mesh.mirror else 1, ny - 1):
        line_operator(film, mesh, j, out[j])


@njit(cache=True, fastmath={"contract"})
def line_diagonal(film: Film, mesh: Mesh, self_film: float, j: int, out: Array) -> None:
    """Write ``-dL/dp`` on the diagonal of line ``j``; ``self_film``: dh/dp of a point on itself."""
    south = j - 1 if j > 0 else 1
    eps_w, eps_x, eps_e = film.eps_x[j, :-2], film.eps_x[j, 1:-1], film.eps_x[j, 2:]
    eps_n, eps_y, eps_s = film.eps_y[j + 1, 1:-1], film.eps_y[j, 1:-1], film.eps_y[south, 1:-1]
    rho, drho, h = film.rho[j, 1:-1], film.drho[j, 1:-1], film.h[j, 1:-1]
    half_x, half_y = 0.5 * mesh.cx, 0.5 * mesh.cy
    target = out[1:-1]
    for i in range(target.shape[0]):
        target[i] = half_x * (2.0 * eps_x[i] + eps_e[i] + eps_w[i])
        target[i] += half_y * (2.0 * eps_y[i] + eps_n[i] + eps_s[i])
    for i in range(target.shape[0]):
        target[i] += mesh.w0 * (drho[i] * h[i] + rho[i] * self_film)


@njit(cache=True)
def diagonal(film: Film, mesh: Mesh, self_film: float, out: Array) -> None:
    """Write ``-dL/dp`` on the diagonal to ``out`` (ny, nx), zero on the edges."""
    out[:] = 0.0
    for j in range(0 if mesh.mirror else 1, film.p.shape[0] - 1):
        line_diagonal(film, mesh, self_film, j, out[j])


@njit(cache=True, fastmath={"contract", "reassoc"}, error_model="numpy")
def line_norm(p: Array, rhs: Array, diagonal: Array, out: Array) -> tuple[float, int]:
    """Turn L(p) in ``out`` to ``rhs - L(p)``, zero where cavitated; return sum and count.

    The sum is of ``|r|`` over the size of the local diagonal, over nodes that are wet or ought to
    be; where the film is negative, on the way to a solution, the diagonal may be too.
    """
    total, count = 0.0, 0
    for i in range(1, p.shape[0] - 1):
        r = rhs[i] - out[i]
        counts = p[i] > 0.0 or r < 0.0
        total += abs(r / diagonal[i]) if counts else 0.0
        count += 1 if counts else 0
        out[i] = r if p[i] > 0.0 else 0.0
    return total, count


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
        line_total, line_count = line_norm(film.p[j], rhs[j], diagonal, out[j])
        weight = 1 if (mesh.mirror and j == 0) else 1 + mesh.mirror
        total += weight * line_total
        count += weight * line_count
    return total / max(count, 1)


@njit(cache=True)
def mark_dipoles(film: Film, mesh: Mesh, relaxation: Relaxation) -> None:
    """Mark the nodes that relax as dipoles: small conductance all round, nothing cavitated."""
    ny, nx = film.p.shape
    p, eps_x, eps_y, kind = film.p, film.eps_x, film.eps_y, relaxation.kind
    limit = relaxation.xi / max(mesh.cx, mesh.cy)
    kind[:] = 0
    for j in range(0 if mesh.mirror else 1, ny - 1):
        south = j - 1 if j > 0 else 1
        for i in range(1, nx - 1):
            along = max(eps_x[j, i], eps_x[j, i - 1], eps_x[j, i + 1])
            across = max(eps_y[j, i], eps_y[south, i], eps_y[j + 1, i])
            smallest = min(p[j, i], p[j, i - 1], p[j, i + 1], p[south, i], p[j + 1, i])
            if max(along, across) <= limit and smallest > 0.0:
                kind[j, i] = 1


@njit(cache=True)
def stiffen(film: Film, mesh: Mesh, table: Array, step: float, out: Array) -> None:
    """Write to ``out`` what the change of conductance with pressure adds to the diagonal.

    Where the pressure rises to a neighbour by many times the pressure that thickens the oil by a
    factor of e, the flow between both follows the conductance of the lower one, and that much more
    steeply than the difference of pressure. Columns of ``table`` as in `properties`.
    """
    ny, nx = film.p.shape
    last = table.shape[0] - 2
    out[:] = 0.0
    for j in range(0 if mesh.mirror else 1, ny - 1):
        south = j - 1 if j > 0 else 1
        for i in range(1, nx - 1):
            p = film.p[j, i]
            k = int(min(p / step, last))
            decay = max(-table[k, 1] / (table[k, 0] * step), 0.0)
            along = max(film.p[j, i - 1] - p, 0.0) + max(film.p[j, i + 1] - p, 0.0)
            across = max(film.p[south, i] - p, 0.0) + max(film.p[j + 1, i] - p, 0.0)
            slope = mesh.cx * film.eps_x[j, i] * along + mesh.cy * film.eps_y[j, i] * across
            out[j, i] = 0.5 * decay * slope


class Batch(NamedTuple):
    """Lines of one colour that are solved side by side, and their workspace.

    Line ``first + 2 lane`` has lane ``lane`` of ``lanes``; ``rest`` (LANES, nx) holds the
    residuals; ``cells`` is flat: value ``field`` of node i is the LANES numbers that start at
    ``((i + 3) FIELDS + field) LANES``. Lanes lie side by side so that each step of the elimination
    is one vector instruction.
    """

    first: int
    lanes: int
    rest: Array
    cells: Array


@njit(cache=True)
def at(node: int, field: int) -> int:
    """Return where a field begins in a slice of cells, ``node`` counted from the slice's start."""
    return (node * FIELDS + field) * LANES


@njit(cache=True)
def wet_range(p: Array, frozen: Array, rest: Array) -> tuple[int, int]:
    """Return the first and last node of a line that may change: the others are cavitated or kept.

    The range is empty, (nx, 0), when there is none.
    """
    nx = p.shape[0]
    for low in range(1, nx - 1):
        if not (p[low] >= 0.0 and (frozen[low] or (p[low] == 0.0 and rest[low] >= 0.0))):
            break
    else:
        return nx, 0
    for high in range(nx - 2, low - 1, -1):
        if not (p[high] >= 0.0 and (frozen[high] or (p[high] == 0.0 and rest[high] >= 0.0))):
            break
    return low, high


@njit(cache=True)
def load_line(
    film: Film, mesh: Mesh, relaxation: Relaxation, batch: Batch, lane: int, span: Span
) -> None:
    """Write what the system of one line needs of nodes ``span[0] .. span[1] - 1`` to its lane."""
    a, b = span
    j = batch.first + 2 * lane
    south = j - 1 if j > 0 else 1
    eps_x, eps_e = film.eps_x[j, a:b], film.eps_x[j, a + 1 : b + 1]
    eps_y, eps_n, eps_s = film.eps_y[j, a:b], film.eps_y[j + 1, a:b], film.eps_y[south, a:b]
    p, rho, h, drho = film.p[j, a:b], film.rho[j, a:b], film.h[j, a:b], film.drho[j, a:b]
    kind, frozen = relaxation.kind[j, a:b], relaxation.frozen[j, a:b]
    steep = relaxation.steep[j, a:b]
    rest = batch.rest[lane, a:b]
    half_x, half_y = 0.5 * mesh.cx, 0.5 * mesh.cy
    cells = batch.cells[at(a + 3, 0) + lane :]
    for i in range(b - a):
        cells[at(i, EAST)] = half_x * (eps_x[i] + eps_e[i])
        cells[at(i, ACROSS)] = half_y * (2.0 * eps_y[i] + eps_n[i] + eps_s[i]) + steep[i]
        cells[at(i, SQUEEZE)] = drho[i] * h[i]
        cells[at(i, RHO)] = rho[i]
        cells[at(i, DIPOLE)] = kind[i]
        cells[at(i, REST)] = rest[i]
        cells[at(i, P)] = p[i]
        dry = 1.0 if p[i] <= 0.0 and rest[i] >= 0.0 else 0.0
        cells[at(i, STATE)] = 2.0 if frozen[i] else dry


@njit(cache=True, fastmath={"contract"})
def fill_band(batch: Batch, mesh: Mesh, relaxation: Relaxation, low: int, high: int) -> None:
    """Fill ``BAND + s + 3``: change of L at i per unit change of the unknown at i + s.

    The column follows the type of the unknown: a point changes p at one node, a dipole at its
    four neighbours too; both change the film along the line.
    """
    cells, lanes = batch.cells, batch.lanes
    p0, p1, p2, p3, p4 = first_five(relaxation.point)
    d0, d1, d2, d3, d4 = first_five(relaxation.dipole)
    d0, d1, d2, d3, d4 = d0 - p0, d1 - p1, d2 - p2, d3 - p3, d4 - p4
    for i in range(low, high + 1):
        w0, w1, w2 = mesh.w0, mesh.w1, mesh.w2
        if i == 1:
            w0, w1, w2 = w0 - w2, w1 + 2.0 * w2, 0.0
        c = cells[at(i, 0) : at(i + 6, 0)]
        for k in range(lanes):
            # dL/dp at i-2, i-1, i, i+1 and dL/dh at i-2, i-1, i
            east, west, across = c[at(3, EAST) + k], c[at(2, EAST) + k], c[at(3, ACROSS) + k]
            a_ww = -w2 * c[at(1, SQUEEZE) + k]
            a_w = west - w1 * c[at(2, SQUEEZE) + k]
            a_c = -east - west - across - w0 * c[at(3, SQUEEZE) + k]
            b_ww, b_w, b_c = (
                -w2 * c[at(1, RHO) + k],
                -w1 * c[at(2, RHO) + k],
                -w0 * c[at(3, RHO) + k],
            )
            # columns of points, then what a dipole at i + s changes in them
            c[at(3, BAND) + k] = (
                b_ww * p1
                + b_w * p2
                + b_c * p3
                + c[at(0, DIPOLE) + k] * (b_ww * d1 + b_w * d2 + b_c * d3 - 0.25 * a_ww)
            )
            c[at(3, BAND + 1) + k] = (
                a_ww
                + b_ww * p0
                + b_w * p1
                + b_c * p2
                + c[at(1, DIPOLE) + k] * (b_ww * d0 + b_w * d1 + b_c * d2 - 0.25 * a_w)
            )
            c[at(3, BAND + 2) + k] = (
                a_w
                + b_ww * p1
                + b_w * p0
                + b_c * p1
                + c[at(2, DIPOLE) + k] * (b_ww * d1 + b_w * d0 + b_c * d1 - 0.25 * (a_ww + a_c))
            )
            c[at(3, BAND + 3) + k] = (
                a_c
                + b_ww * p2
                + b_w * p1
                + b_c * p0
                + c[at(3, DIPOLE) + k]
                * (b_ww * d2 + b_w * d1 + b_c * d0 - 0.25 * (a_w + east + across))
            )
            c[at(3, BAND + 4) + k] = (
                east
                + b_ww * p3
                + b_w * p2
                + b_c * p1
                + c[at(4, DIPOLE) + k] * (b_ww * d3 + b_w * d2 + b_c * d1 - 0.25 * a_c)
            )
            c[at(3, BAND + 5) + k] = (
                b_ww * p4
                + b_w * p3
                + b_c * p2
                + c[at(5, DIPOLE) + k] * (b_ww * d4 + b_w * d3 + b_c * d2 - 0.25 * east)
            )


@njit(cache=True)
def first_five(values: Array) -> tuple[float, float, float, float, float]:
    """Return the first five numbers of an array."""
    return values[0], values[1], values[2], values[3], values[4]


@njit(cache=True, fastmath={"contract"}, error_model="numpy")
def eliminate(batch: Batch, low: int, high: int) -> None:
    """Eliminate downstream without pivoting: u_i + up1 u_{i+1} + up2 u_{i+2} = U on return.

    Where the state is 1 the row reads u = -p, where it is 2 it reads u = 0.
    """
    cells, lanes = batch.cells, batch.lanes
    for i in range(low, high + 1):
        c = cells[at(i, 0) : at(i + 4, 0)]
        for k in range(lanes):
            state = c[at(3, STATE) + k]
            free = state == 0.0
            l3, l2, l1 = c[at(3, BAND) + k], c[at(3, BAND + 1) + k], c[at(3, BAND + 2) + k]
            diagonal, y = c[at(3, BAND + 3) + k], c[at(3, REST) + k]
            y -= l3 * c[at(0, U) + k]
            l2 -= l3 * c[at(0, UP1) + k]
            l1 -= l3 * c[at(0, UP2) + k]
            y -= l2 * c[at(1, U) + k]
            l1 -= l2 * c[at(1, UP1) + k]
            diagonal -= l2 * c[at(1, UP2) + k]
            y -= l1 * c[at(2, U) + k]
            diagonal -= l1 * c[at(2, UP1) + k]
            up1 = c[at(3, BAND + 4) + k] - l1 * c[at(2, UP2) + k]
            inverse = 1.0 / (diagonal if free else 1.0)
            fixed = -c[at(3, P) + k] if state == 1.0 else 0.0
            c[at(3, UP1) + k] = up1 * inverse if free else 0.0
            c[at(3, UP2) + k] = c[at(3, BAND + 5) + k] * inverse if free else 0.0
            c[at(3, U) + k] = y * inverse if free else fixed


@njit(cache=True, fastmath={"contract"})
def substitute(batch: Batch, low: int, high: int) -> None:
    """Turn ``U`` into the solution, from the last node back to the first."""
    cells, lanes = batch.cells, batch.lanes
    for i in range(high, low - 1, -1):
        c = cells[at(i + 3, 0) : at(i + 6, 0)]
        for k in range(lanes):
            c[at(0, U) + k] -= (
                c[at(0, UP1) + k] * c[at(1, U) + k] + c[at(0, UP2) + k] * c[at(2, U) + k]
            )


@njit(cache=True)
def band_solve(batch: Batch, low: int, high: int) -> None:
    """Solve the six-diagonal systems of all lanes for ``U`` on low..high, zero beside them."""
    cells = batch.cells
    for i in range(low, low + 3):
        cells[at(i, UP1) : at(i + 1, 0)] = 0.0
    for i in range(high + 4, high + 7):
        cells[at(i, UP1) : at(i + 1, 0)] = 0.0
    eliminate(batch, low, high)
    substitute(batch, low, high)


@njit(cache=True)
def dry_out(batch: Batch, i: int) -> tuple[int, int]:
    """Cavitate the free lanes of negative pressure at node i.

    Return 1 or 0 for: whether there was one, and whether any lane was cavitated before.
    """
    cells, lanes = batch.cells, batch.lanes
    changed, cavitated = 0, 0
    c = cells[at(i + 3, 0) : at(i + 4, 0)]
    for k in range(lanes):
        state = c[at(0, STATE) + k]
        to_dry = int(state == 0.0) & int(c[at(0, U) + k] < -c[at(0, P) + k])
        c[at(0, STATE) + k] = 1.0 if to_dry else (3.0 if state == 1.0 else state)
        changed |= to_dry
        cavitated |= int(state == 1.0)
    return changed, cavitated


@njit(cache=True, fastmath={"contract"})
def wet_again(batch: Batch, i: int) -> int:
    """Free the cavitated lanes (state 3) that lack oil at node i; return whether there was one."""
    cells, lanes = batch.cells, batch.lanes
    changed = 0
    c = cells[at(i, 0) : at(i + 6, 0)]
    for k in range(lanes):
        state = c[at(3, STATE) + k]
        rest = (
            c[at(3, REST) + k]
            - c[at(3, BAND) + k] * c[at(0, U) + k]
            - c[at(3, BAND + 1) + k] * c[at(1, U) + k]
            - c[at(3, BAND + 2) + k] * c[at(2, U) + k]
            - c[at(3, BAND + 3) + k] * c[at(3, U) + k]
            - c[at(3, BAND + 4) + k] * c[at(4, U) + k]
            - c[at(3, BAND + 5) + k] * c[at(5, U) + k]
        )
        to_wet = int(state == 3.0) & int(rest < 0.0)
        kept = 1.0 if state == 3.0 else state
        c[at(3, STATE) + k] = 0.0 if to_wet else kept
        changed |= to_wet
    return changed


@njit(cache=True)
def complementarity(batch: Batch, low: int, high: int, last: int) -> tuple[int, int]:
    """Solve the lines with p + u >= 0 by policy iteration over the cavitated nodes.

    Nodes outside low..high are cavitated with p = 0 or kept; the range grows as nodes get wet and
    is returned. ``last`` is the last node that is solved for.
    """
    for _ in range(PASSES):
        band_solve(batch, low, high)
        changed = 0
        for i in range(max(low - 2, 1), min(high + 3, last) + 1):
            dry, cavitated = dry_out(batch, i)
            changed |= dry
            if cavitated and wet_again(batch, i):
                low, high, changed = min(low, i), max(high, i), 1
        if not changed:
            return low, high
    band_solve(batch, low, high)
    return low, high


@njit(cache=True)
def store_line(film: Film, relaxation: Relaxation, batch: Batch, lane: int, span: Span) -> None:
    """Apply the solution of one line: points at once, dipoles to ``delta``."""
    j = batch.first + 2 * lane
    a, b = span
    p, kind, delta = film.p[j, a:b], relaxation.kind[j, a:b], relaxation.delta[j, a:b]
    cells = batch.cells[at(a + 3, U) + lane :]
    for i in range(b - a):
        u = cells[at(i, 0)]
        moved = 0.0 if u <= -p[i] else p[i] + relaxation.omega_point * u
        delta[i] = relaxation.omega_dipole * max(u, -p[i]) if kind[i] else 0.0
        p[i] = p[i] if kind[i] else moved


@njit(cache=True)
def relax_batch(film: Film, mesh: Mesh, rhs: Array, relaxation: Relaxation, batch: Batch) -> None:
    """Relax the lines of one batch."""
    nx = film.p.shape[1]
    low, high = nx, 0
    for lane in range(batch.lanes):
        j, rest = batch.first + 2 * lane, batch.rest[lane]
        line_operator(film, mesh, j, rest)
        for i in range(1, nx - 1):
            rest[i] = rhs[j, i] - rest[i]
        line_low, line_high = wet_range(film.p[j], relaxation.frozen[j], rest)
        low, high = min(low, line_low), max(high, line_high)
    if low > high:
        return
    # the range of the unknowns may grow by two nodes upstream and three downstream in each pass
    first, last = max(low - 2 * PASSES, 1), min(high + 3 * PASSES, nx - 2)
    filled = first
    for start in range(max(first - 3, 0), min(last + 3, nx - 1), CHUNK):
        stop = min(start + CHUNK, last + 3, nx - 1)
        for lane in range(batch.lanes):
            load_line(film, mesh, relaxation, batch, lane, (start, stop))
        ready = last if stop == min(last + 3, nx - 1) else stop - 3
        fill_band(batch, mesh, relaxation, filled, ready)
        filled = ready + 1
    low, high = complementarity(batch, low, high, nx - 2)
    for lane in range(batch.lanes):
        store_line(film, relaxation, batch, lane, (low, high + 1))


@njit(cache=True)
def relax_lines(film: Film, mesh: Mesh, rhs: Array, relaxation: Relaxation) -> None:
    """One zebra sweep over the lines along x: points at once, dipoles after both colours."""
    ny, nx = film.p.shape
    first = 0 if mesh.mirror else 1
    mark_dipoles(film, mesh, relaxation)
    rest, cells = np.zeros((LANES, nx)), np.zeros(at(nx + 6, 0))
    relaxation.delta[:] = 0.0
    for colour in range(2):
        for j in range(first + colour, ny - 1, 2 * LANES):
            lanes = min(LANES, (ny - j) // 2)
            batch = Batch(j, lanes, rest, cells)
            relax_batch(film, mesh, rhs, relaxation, batch)
    add_dipoles(film.p, relaxation.delta, mesh.mirror)


@njit(cache=True)
def add_dipoles(p: Array, delta: Array, mirror: int) -> None:
    """Add the stored dipoles to ``p`` and clip at zero."""
    ny, nx = p.shape
    for j in range(0 if mirror else 1, ny - 1):
        south = j - 1 if j > 0 else 1
        for i in range(1, nx - 1):
            around = delta[j, i - 1] + delta[j, i + 1] + delta[south, i] + delta[j + 1, i]
            p[j, i] = max(p[j, i] + delta[j, i] - 0.25 * around, 0.0)
