"""Discrete Reynolds operator: its values, its diagonal, its residual.

With mobility and density frozen in ``eps`` and ``rho`` the steady Reynolds equation is

    L(p) = (eps p_x)_x + (eps p_y)_y / kappa^2 - (rho h)_x = 0   where p > 0,

with central differences of second order, the conductance of a face being the mean of both nodes,
and an upstream difference of the wedge (Venner and Lubrecht 2000, chapter 6). Where the wedge is of
third order the mean is geometric: the conductance varies exponentially with the pressure, by
factors from node to node. Where oil flows obliquely it is logarithmic along y: by a geometric mean
less flows out through a face the more the pressure falls, beyond 2/alpha, and relaxation at the
steep side of a turned ellipse hardly converges; so do the ends of rollers, where the film opens by
many films from line to line besides: there the mean of the mobilities is logarithmic, that of the
cubes of the films geometric. Where the surfaces spin the wedge is
(u rho h)_x + (v rho h)_y / kappa with u(y) and v(x), each upstream by its sign
(docs/theory/directions.md). With ``mirror`` row 0 is the symmetry line y = 0; otherwise it is an
edge with p = 0. Fields are those of `tehl.kernels.properties`.
"""

from tehl.base.typing import Array, FlagArray
from tehl.kernels.compiled import helper, kernel, summing_helper
from tehl.kernels.faces import (
    CLOSED,
    MARK_THIRD_ORDER,
    STEADILY,
    WRAPPED,
    Stencil,
    both_x,
    both_y,
    third_at,
    third_beyond,
)
from tehl.kernels.properties import Film
from tehl.kernels.raw import raw
from tehl.kernels.turning import crossing, subtract_curved_flux


@helper
def row_below(j: int, ny: int, mirror: int) -> int:
    """Return the row south of row ``j``: that of row 0 is the mirror image of row 1.

    Where the film wraps, row 0 is the last one too, and the row before that is south of it. A line
    contact has one row of ``ny``, which is its own neighbour on both sides.
    """
    end = ny - 2 if mirror >= WRAPPED else min(1, ny - 1)
    return j - 1 if j > 0 else end


@helper
def row_above(j: int, ny: int, mirror: int) -> int:
    """Return the row north of row ``j``: beyond the last one is the mirror image of others.

    Where the film wraps it is row 1.
    """
    end = 1 if mirror >= WRAPPED else max(ny - 2, 0)
    return j + 1 if j + 1 < ny else end


@helper
def inner_end(ny: int, mirror: int) -> int:
    """Return the row before which the inner rows end: the edge, if there is more than one."""
    return ny if mirror >= CLOSED else max(ny - 1, 1)


@helper
def join_ends(field: Array, mirror: int) -> None:
    """Make the last row the first one where the film wraps: rounding would part them."""
    if mirror >= WRAPPED:
        for i in range(field.shape[1]):
            field[field.shape[0] - 1, i] = field[0, i]


@helper
def sides(film: Film, stencil: Stencil, j: int) -> tuple[float, float]:
    """Return half the weights of the differences from row ``j`` to the rows south and north."""
    half = 0.5 * stencil.cy
    if film.south.shape[0] > 0:
        return half * film.south[j], half * film.north[j]
    return half, half


@helper
def clear(field: Array | FlagArray) -> None:
    """Fill a field with zeros."""
    ny, nx = field.shape
    for j in range(ny):
        for i in range(nx):
            field[j, i] = 0


@helper
def line_operator(film: Film, stencil: Stencil, j: int, out: Array, place: tuple[int, int]) -> None:
    """Write L(p) on line ``j`` to ``out``; ``place``: row there, and the node before which to end.

    The ends of the line are not touched.
    """
    _line_flow(film, stencil, j, out, place)
    if film.speed.shape[0] > 0:
        if stencil.conserves == STEADILY:
            subtract_curved_flux(film, stencil, j, out, place)
            return
        for i in range(1, place[1]):
            out[place[0], i] -= curved_wedge(film, stencil, j, i)
    elif stencil.conserves == STEADILY:
        _subtract_flux(film, stencil, j, out, place)
    else:
        _subtract_wedge(film, stencil, j, out, place)


@helper
def _line_flow(film: Film, stencil: Stencil, j: int, out: Array, place: tuple[int, int]) -> None:
    """Write the pressure flow into each cell of line ``j`` to ``out``."""
    p, eps_x, eps_y, (row, end) = film.p, film.eps_x, film.eps_y, place
    south = row_below(j, p.shape[0], stencil.mirror)
    north = row_above(j, p.shape[0], stencil.mirror)
    half_x, (half_s, half_n) = 0.5 * stencil.cx, sides(film, stencil, j)
    for i in range(1, end):
        east = both_x(stencil, eps_x[j, i], eps_x[j, i + 1])
        west = both_x(stencil, eps_x[j, i - 1], eps_x[j, i])
        upper = both_y(film, stencil, eps_y, (j, i), north)
        lower = both_y(film, stencil, eps_y, (j, i), south)
        flow_x = east * (p[j, i + 1] - p[j, i]) - west * (p[j, i] - p[j, i - 1])
        flow_y = half_n * upper * (p[north, i] - p[j, i]) - half_s * lower * (p[j, i] - p[south, i])
        out[row, i] = half_x * flow_x + flow_y


@helper
def _subtract_wedge(
    film: Film, stencil: Stencil, j: int, out: Array, place: tuple[int, int]
) -> None:
    """Subtract the upstream difference of rho h along a line; node 1 continues rho h linearly."""
    rho, h, (row, end) = film.rho, film.h, place
    w0, w1, w2 = stencil.w0, stencil.w1, stencil.w2
    out[row, 1] -= (w0 - w2) * rho[j, 1] * h[j, 1] + (w1 + 2.0 * w2) * rho[j, 0] * h[j, 0]
    for i in range(2, end):
        upstream = w1 * rho[j, i - 1] * h[j, i - 1]
        farther = w2 * rho[j, i - 2] * h[j, i - 2]
        out[row, i] -= w0 * rho[j, i] * h[j, i] + upstream + farther
    if stencil.third > 0.0:
        _subtract_third(film, stencil, j, out, place)


@helper
def curved_wedge(film: Film, stencil: Stencil, j: int, i: int) -> float:
    """Return the wedge at a node where the surfaces spin."""
    u, v = film.speed[j], film.drift[j, i]
    found = abs(u) * _difference(film, stencil, (j, i), (0, -1 if u > 0.0 else 1))
    return found + abs(v) * _difference(film, stencil, (j, i), (-1 if v > 0.0 else 1, 0))


@helper
def _difference(film: Film, stencil: Stencil, node: tuple[int, int], way: tuple[int, int]) -> float:
    """Return the upstream difference of rho h at a node; ``way``: rows and columns upstream.

    The first node continues rho h linearly. Through a closed end comes what its line passes on.
    """
    rho, h, (ny, nx), (j, i), (dj, di) = film.rho, film.h, film.p.shape, node, way
    if not 0 <= j + dj < ny:
        return 0.0
    here, west = rho[j, i] * h[j, i], rho[j + dj, i + di] * h[j + dj, i + di]
    far_j, far_i, curved = j + 2 * dj, i + 2 * di, 0.0
    if stencil.third > 0.0 and 0 <= j - dj < ny:  # at closed ends nothing is downstream
        after = rho[j - dj, i - di] * h[j - dj, i - di]
        curved = third_beyond(stencil, i, di) * (after - 2.0 * here + west)
    if far_j < 0 or far_j >= ny or far_i < 0 or far_i >= nx:
        w0, w1 = stencil.w0 - stencil.w2, stencil.w1 + 2.0 * stencil.w2
        return w0 * here + w1 * west + curved
    far = rho[far_j, far_i] * h[far_j, far_i]
    if stencil.third > 0.0:
        curved -= third_beyond(stencil, i + di, di) * (here - 2.0 * west + far)
    return stencil.w0 * here + stencil.w1 * west + stencil.w2 * far + curved


@helper
def _subtract_third(
    film: Film, stencil: Stencil, j: int, out: Array, place: tuple[int, int]
) -> None:
    """Subtract the difference of third (m(i+1) - 2 m(i) + m(i-1)) between the faces of each cell.

    It adds to the flux 3/2 m(i) - 1/2 m(i-1) of the mass m = rho h what makes it one of third
    order; the first face of a line has none.
    """
    rho, h, (row, end) = film.rho, film.h, place
    before, curved = rho[j, 0] * h[j, 0], 0.0
    mass = rho[j, 1] * h[j, 1]
    for i in range(1, end):
        after = rho[j, i + 1] * h[j, i + 1]
        bent = third_at(stencil, i) * (after - 2.0 * mass + before)
        out[row, i] -= bent - curved
        before, mass, curved = mass, after, bent


@helper
def _subtract_flux(
    film: Film, stencil: Stencil, j: int, out: Array, place: tuple[int, int]
) -> None:
    """Subtract the difference of the oil fluxes through both faces of each cell of a line.

    A film node passes on 3/2 m(i) - 1/2 m(i-1) of its mass m = rho h, with a third of the second
    difference added where the wedge is of third order, or m(i) next to a partly filled node; a
    partly filled one passes on all that flows in. The value there is that of the
    node if it were full: above zero, the cell fills. No pressure flow leaves a film upstream into a
    partly filled cell: it would come back at once. (docs/theory/starvation.md)
    """
    p, rho, h, eps_x, (row, end) = film.p, film.rho, film.h, film.eps_x, place
    partial, rate, half_x = film.partial, stencil.w0 - stencil.w2, 0.5 * stencil.cx
    before, flux = inflow(film, stencil, j)
    for i in range(1, end):
        mass = rho[j, i] * h[j, i]
        full = mass
        if film.second[j, i]:
            full += beyond(film, stencil, (j, i), before)
        if partial[j, i]:
            gained = out[row, i]
            if not partial[j, i + 1]:
                east = half_x * both_x(stencil, eps_x[j, i], eps_x[j, i + 1])
                gained -= east * (p[j, i + 1] - p[j, i])
            out[row, i] -= rate * (full - flux)
            flux += gained / rate
            before = flux
            continue
        if partial[j, i - 1]:
            west = half_x * both_x(stencil, eps_x[j, i - 1], eps_x[j, i])
            out[row, i] += west * (p[j, i] - p[j, i - 1])
        out[row, i] -= rate * (full - flux)
        before, flux = mass, full


@helper
def beyond(film: Film, stencil: Stencil, node: tuple[int, int], before: float) -> float:
    """Return the flux through the east face of a node less its mass; ``before``: mass upstream."""
    j, i = node
    mass = film.rho[j, i] * film.h[j, i]
    found = 0.5 * (mass - before)
    if film.second[j, i] == MARK_THIRD_ORDER:
        curved = film.rho[j, i + 1] * film.h[j, i + 1] - 2.0 * mass + before
        found += third_at(stencil, i) / (stencil.w0 - stencil.w2) * curved
    return found


@helper
def inflow(film: Film, stencil: Stencil, j: int) -> tuple[float, float]:
    """Return mass at the first node of a line, and oil flux into the second cell."""
    if film.partial[j, 0]:
        return film.layer[j], film.layer[j]
    mass = film.rho[j, 0] * film.h[j, 0]
    if stencil.w2 > 0.0 and not film.partial[j, 1]:  # the mass continues linearly upstream
        return mass, 0.5 * (mass + film.rho[j, 1] * film.h[j, 1])
    return mass, mass


@helper
def flux_weights(
    stencil: Stencil, partial: tuple[bool, bool, bool], second: tuple[bool, bool], i: int
) -> tuple[float, float, float]:
    """Return the weights of m(i), m(i-1), m(i-2) in the difference of the fluxes at node i.

    Parameters
    ----------
    stencil : Stencil
        Weights of the differences.
    partial : (bool, bool, bool)
        Whether nodes i, i - 1 and i - 2 are partly filled: the oil they hold does not follow from
        their film.
    second : (bool, bool)
        Whether nodes i and i - 1 pass on oil with second order.
    i : int
        Number of the node.
    """
    rate = stencil.w0 - stencil.w2
    own = 1.5 * rate if second[0] else rate
    if i == 1:
        ghost = stencil.w2 > 0.0 and not (partial[0] or partial[1])
        west = 0.0 if partial[1] else -0.5 * rate if second[0] else 0.0
        if ghost:
            return own - 0.5 * rate, west - 0.5 * rate, 0.0
        return own, west if partial[1] else west - rate, 0.0
    if partial[1]:
        return own, 0.0, 0.0
    west = 1.5 * rate if second[1] else rate
    west = -west - 0.5 * rate if second[0] else -west
    far = 0.5 * rate if second[1] and not partial[2] else 0.0
    return own, west, far


@kernel
def operator(film: Film, stencil: Stencil, out: Array) -> None:
    """Write L(p) to ``out`` (ny, nx), zero on the edges."""
    film, out = raw((film, out))
    clear(out)
    for j in range(0 if stencil.mirror else 1, inner_end(film.p.shape[0], stencil.mirror)):
        line_operator(film, stencil, j, out, (j, film.p.shape[1] - 1))


@helper
def _node_diagonal(film: Film, stencil: Stencil, self_film: float, j: int, i: int) -> float:
    """Return ``-dL/dp`` of a node with itself; ``self_film``: dh/dp of a point on itself."""
    eps_x, eps_y, ny = film.eps_x, film.eps_y, film.p.shape[0]
    south, north = row_below(j, ny, stencil.mirror), row_above(j, ny, stencil.mirror)
    along = both_x(stencil, eps_x[j, i], eps_x[j, i + 1]) + both_x(
        stencil, eps_x[j, i - 1], eps_x[j, i]
    )
    half_s, half_n = sides(film, stencil, j)
    across = half_n * both_y(film, stencil, eps_y, (j, i), north)
    across += half_s * both_y(film, stencil, eps_y, (j, i), south)
    flow = 0.5 * stencil.cx * along + across
    if film.speed.shape[0] > 0:
        w0 = stencil.w0 * (abs(film.speed[j]) + crossing(film, stencil, j, i))
        return flow + w0 * (film.drho[j, i] * film.h[j, i] + film.rho[j, i] * self_film)
    return flow + stencil.w0 * (film.drho[j, i] * film.h[j, i] + film.rho[j, i] * self_film)


@kernel
def diagonal(film: Film, stencil: Stencil, self_film: float, out: Array) -> None:
    """Write ``-dL/dp`` on the diagonal to ``out`` (ny, nx), zero on the edges."""
    film, out = raw((film, out))
    clear(out)
    ny, nx = film.p.shape
    for j in range(0 if stencil.mirror else 1, inner_end(ny, stencil.mirror)):
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
        counts = film.p[j, i] != 0.0 or r < 0.0
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
    for j in range(0 if stencil.mirror else 1, inner_end(ny, stencil.mirror)):
        line_operator(film, stencil, j, out, (j, film.p.shape[1] - 1))
        for i in range(1, nx - 1):
            out[j, i] = rhs[j, i] - out[j, i]
        line_total, line_count = _line_norm(film, stencil, self_film, j, out)
        for i in range(1, nx - 1):
            out[j, i] = out[j, i] if film.p[j, i] != 0.0 else 0.0
        is_end = j == 0 or (stencil.mirror >= CLOSED and j == ny - 1)
        weight = 1 if stencil.mirror == 0 or is_end else 2
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
    half_x = 0.5 * stencil.cx
    for j in range(0 if stencil.mirror else 1, inner_end(ny, stencil.mirror)):
        south, north = row_below(j, ny, stencil.mirror), row_above(j, ny, stencil.mirror)
        half_s, half_n = sides(film, stencil, j)
        for i in range(1, nx - 1):
            east = both_x(stencil, eps_x[j, i], eps_x[j, i + 1])
            east -= both_x(stencil, eps[j, i], eps[j, i + 1])
            west = both_x(stencil, eps_x[j, i - 1], eps_x[j, i])
            west -= both_x(stencil, eps[j, i - 1], eps[j, i])
            upper = both_y(film, stencil, eps_y, (j, i), north)
            upper -= both_y(film, stencil, eps, (j, i), north)
            lower = both_y(film, stencil, eps_y, (j, i), south)
            lower -= both_y(film, stencil, eps, (j, i), south)
            flow_x = east * (p[j, i + 1] - p[j, i]) - west * (p[j, i] - p[j, i - 1])
            flow_y = half_n * upper * (p[north, i] - p[j, i])
            flow_y -= half_s * lower * (p[j, i] - p[south, i])
            out[j, i] = half_x * flow_x + flow_y
