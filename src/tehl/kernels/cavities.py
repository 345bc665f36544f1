"""Partly filled cells of cavities, where oil is conserved: their marks, and the oil they pass."""

from tehl.base.typing import Array, FlagArray, IntArray
from tehl.kernels.compiled import helper, kernel
from tehl.kernels.faces import MARK_THIRD_ORDER, Stencil, both_x, both_y
from tehl.kernels.properties import Film
from tehl.kernels.raw import raw
from tehl.kernels.reynolds import (
    beyond,
    clear,
    inflow,
    inner_end,
    line_operator,
    row_above,
    row_below,
    sides,
)
from tehl.kernels.turning import flow_from, part_back, passed_on


@kernel
def mark_partial(film: Film, stencil: Stencil, rhs: Array, scratch: Array, ends: IntArray) -> None:
    """Mark cavitated nodes that stay partly filled: less oil comes than a full one would pass on.

    ``scratch`` is (1, nx), or (ny, nx) where the surfaces spin; nodes from ``ends[j]`` of line j on
    keep their mark.
    """
    film, rhs, scratch, ends = raw((film, rhs, scratch, ends))
    if film.speed.shape[0] > 0:
        _mark_curved(film, stencil, rhs, scratch, ends)
        return
    partial, p, nx = film.partial, film.p, film.p.shape[1]
    for j in range(0 if stencil.mirror else 1, inner_end(p.shape[0], stencil.mirror)):
        if ends[j] == 0:
            continue
        end, to = ends[j], nx if ends[j] == nx - 1 else ends[j]
        partial[j, 0] = film.layer[j] < film.rho[j, 0] * film.h[j, 0]
        for i in range(1, to):
            partial[j, i] = p[j, i] == 0.0
        line_operator(film, stencil, j, scratch, (0, end))
        for i in range(1, end):
            partial[j, i] = p[j, i] == 0.0 and rhs[j, i] - scratch[0, i] >= 0.0


@helper
def _mark_curved(film: Film, stencil: Stencil, rhs: Array, scratch: Array, ends: IntArray) -> None:
    """Mark the partly filled nodes where the surfaces spin, and fill them."""
    partial, p, (ny, nx) = film.partial, film.p, film.p.shape
    first, last = _inner_rows(ny, stencil.mirror)
    for j in range(ny):
        for i in range(nx):
            full = film.rho[j, i] * film.h[j, i]
            if j < first or j > last or i == 0 or i == nx - 1:
                partial[j, i] = film.layer[j] < full
                film.held[j, i] = min(film.layer[j], full)
            elif i < ends[j]:
                partial[j, i] = p[j, i] == 0.0
    fill(film, stencil)
    for j in range(first, last + 1):
        line_operator(film, stencil, j, scratch, (j, ends[j]))
    for j in range(first, last + 1):
        for i in range(1, ends[j]):
            partial[j, i] = p[j, i] == 0.0 and rhs[j, i] - scratch[j, i] >= 0.0
    fill(film, stencil)


@helper
def _inner_rows(ny: int, mirror: int) -> tuple[int, int]:
    """Return the first and last row that is on no edge: closed ends are none."""
    return 0 if mirror else 1, inner_end(ny, mirror) - 1


@helper
def fill(film: Film, stencil: Stencil) -> None:
    """Fill the partly filled nodes with the oil that flows in, downstream from node to node.

    Without the flow from a film that is downstream along x, of which a part comes back at once.
    Rows that move against x, and columns against y, the other way round; rows of both ways lie
    beside each other, so that a second time brings what has come from there. Where all rows move
    along x, all upstream is known at once.
    """
    (ny, nx), rate = film.p.shape, stencil.w0 - stencil.w2
    first, last = _inner_rows(ny, stencil.mirror)
    reverses = False
    for j in range(first, last + 1):
        reverses = reverses or film.speed[j] < 0.0
    for number in range(4 if reverses else 1):
        back = number % 2 == 1
        for column in range(1, nx - 1):
            i = nx - 1 - column if back else column
            is_northward = film.drift[ny // 2, i] > 0.0
            for row in range(first, last + 1):
                j = row if is_northward else ny - 1 - row
                u, v = film.speed[j], film.drift[j, i]
                if not film.partial[j, i] or (u < 0.0) != back:
                    continue
                along, across = (0, 1 if back else -1), (-1 if v > 0.0 else 1, 0)
                inflow_x = passed_on(film, stencil, (j, i + along[1]), along, False)
                inflow_y = passed_on(film, stencil, (j + across[0], i), across, False)
                gained, _ = _flow_into(film, stencil, j, i)
                if not film.partial[j, i - along[1]]:
                    gained -= flow_from(film, stencil, j, i, -along[1])
                total = abs(u) * inflow_x + abs(v) * inflow_y + gained
                film.held[j, i] = total / (rate * max(abs(u) + abs(v), 1e-12))


@helper
def _begins(film: Film, mirror: int, j: int, i: int) -> bool:
    """Return whether a film may begin at a node: beside a partly filled one that is upstream."""
    partial = film.partial
    found = partial[j, i - 1] > 0
    if film.speed.shape[0] > 0:
        ny = partial.shape[0]
        south, north = row_below(j, ny, mirror), row_above(j, ny, mirror)
        found = found or partial[j, i + 1] + partial[south, i] + partial[north, i] > 0
    return found


@kernel
def keep_to_fronts(film: Film, mirror: int, width: int, frozen: FlagArray, ends: IntArray) -> None:
    """Freeze the nodes farther than ``width`` nodes from where a film begins.

    ``ends`` (ny,) are the nodes from which on all of a line are frozen.
    """
    film, frozen, ends = raw((film, frozen, ends))
    partial, (ny, nx) = film.partial, film.p.shape
    for j in range(ny):
        ends[j] = 0
        for i in range(nx):
            frozen[j, i] = 1
    for j in range(0 if mirror else 1, inner_end(ny, mirror)):
        for i in range(1, nx - 1):
            if partial[j, i] > 0 or not _begins(film, mirror, j, i):
                continue
            end = min(i + width + 1, nx - 1)
            for row in range(max(j - width, 0), min(j + width + 1, ny)):
                ends[row] = max(ends[row], end)
                for column in range(max(i - width, 0), end):
                    frozen[row, column] = 0


@kernel
def mark_second_order(film: Film, stencil: Stencil) -> None:
    """Mark the nodes with two film nodes upstream, if the wedge is of second order.

    With a third one downstream they pass on oil with third order, if the wedge is of that.
    """
    film, _ = raw((film, film.p))
    second, order = film.second, 1 if stencil.w2 == 0.0 else 2
    order = 3 if stencil.third > 0.0 else order
    ny, nx = film.p.shape
    if film.speed.shape[0] > 0:  # each direction has its own nodes upstream
        for j in range(ny):
            for i in range(nx):
                second[j, i] = order - 1
        return
    for j in range(ny):
        _mark_line(film, j, order)


@helper
def _mark_line(film: Film, j: int, order: int) -> None:
    """Mark the nodes of a line."""
    partial, second, nx = film.partial, film.second, film.p.shape[1]
    second[j, 0] = 0
    second[j, 1] = order > 1 and not partial[j, 0]
    for i in range(2, nx):
        second[j, i] = order > 1 and not (partial[j, i - 1] or partial[j, i - 2])
    if order > 2:
        for i in range(2, nx - 1):
            if second[j, i] and not (partial[j, i] or partial[j, i + 1]):
                second[j, i] = MARK_THIRD_ORDER


@kernel
def oil_flow(film: Film, stencil: Stencil, held: Array, passed: Array) -> None:
    """Write the oil at each node, and the flux through the face to the east, wedge and pressure.

    Parameters
    ----------
    film, stencil : Film, Stencil
        State, and weights of the operator.
    held, passed : array (ny, nx)
        rho h, or less where partly filled; flux through the east face of each cell, zero at the
        last node and on edge lines.
    """
    film, held, passed = raw((film, held, passed))
    clear(passed)
    if film.speed.shape[0] > 0:
        _curved_oil_flow(film, stencil, held, passed)
    else:
        _straight_oil_flow(film, stencil, held, passed)


@helper
def _straight_oil_flow(film: Film, stencil: Stencil, held: Array, passed: Array) -> None:
    """Write it line by line."""
    ny, nx = film.p.shape
    rate = stencil.w0 - stencil.w2
    for j in range(ny):
        for i in range(nx):
            held[j, i] = film.rho[j, i] * film.h[j, i]
    for j in range(0 if stencil.mirror else 1, inner_end(ny, stencil.mirror)):
        before, flux = inflow(film, stencil, j)
        held[j, 0] = before
        passed[j, 0] = flux - _face_flow(film, stencil, j, 0) / rate
        for i in range(1, nx - 1):
            mass = held[j, i]
            if film.partial[j, i]:
                gained, back = _flow_into(film, stencil, j, i)
                held[j, i] = flux + gained / rate
                flux += (gained - back) / rate
                before = flux
            else:
                flux = mass
                if film.second[j, i]:
                    flux += beyond(film, stencil, (j, i), before)
                before = mass
            passed[j, i] = flux - _face_flow(film, stencil, j, i) / rate
        if film.partial[j, nx - 1]:
            held[j, nx - 1] = flux


@helper
def _curved_oil_flow(film: Film, stencil: Stencil, held: Array, passed: Array) -> None:
    """Write the same where the surfaces spin."""
    (ny, nx), rate = film.p.shape, stencil.w0 - stencil.w2
    first, last = _inner_rows(ny, stencil.mirror)
    for j in range(ny):
        u = film.speed[j]
        for i in range(nx):
            full = film.rho[j, i] * film.h[j, i]
            held[j, i] = film.held[j, i] if film.partial[j, i] else full
            after = i + 1 if u > 0.0 else i - 1
            inside = first <= j <= last and 0 < i < nx - 1
            if inside and film.partial[j, i] and not film.partial[j, after]:
                comes_back = flow_from(film, stencil, j, i, after - i)
                held[j, i] += comes_back / (rate * (abs(u) + abs(film.drift[j, i])))
    for j in range(first, last + 1):
        u = film.speed[j]
        for i in range(nx - 1):
            from_, way = (i, (0, -1)) if u > 0.0 else (i + 1, (0, 1))
            moved = abs(u) * passed_on(film, stencil, (j, from_), way, False) / rate
            pressed = flow_from(film, stencil, j, i, 1) / rate
            if film.partial[j, from_] and not film.partial[j, 2 * i + 1 - from_]:
                pressed *= 1.0 - part_back(film, j, from_)
            passed[j, i] = (moved if u > 0.0 else -moved) - pressed


@helper
def _face_flow(film: Film, stencil: Stencil, j: int, i: int) -> float:
    """Return the pressure flow upstream through the east face; none into a partly filled cell."""
    if film.partial[j, i]:
        return 0.0
    eps = both_x(stencil, film.eps_x[j, i], film.eps_x[j, i + 1])
    return 0.5 * stencil.cx * eps * (film.p[j, i + 1] - film.p[j, i])


@helper
def _flow_into(film: Film, stencil: Stencil, j: int, i: int) -> tuple[float, float]:
    """Return the pressure flow into a partly filled cell, and what of it comes back downstream."""
    p, eps_x, eps_y = film.p, film.eps_x, film.eps_y
    south = row_below(j, p.shape[0], stencil.mirror)
    north, here = row_above(j, p.shape[0], stencil.mirror), film.p[j, i]
    half_x, (half_s, half_n) = 0.5 * stencil.cx, sides(film, stencil, j)
    gained = half_n * both_y(film, stencil, eps_y, (j, i), north) * (p[north, i] - here)
    gained += half_s * both_y(film, stencil, eps_y, (j, i), south) * (p[south, i] - here)
    gained += half_x * both_x(stencil, eps_x[j, i - 1], eps_x[j, i]) * (p[j, i - 1] - here)
    from_east = half_x * both_x(stencil, eps_x[j, i], eps_x[j, i + 1]) * (p[j, i + 1] - here)
    back = 0.0 if film.partial[j, i + 1] else from_east
    return gained + from_east, back
