"""Relaxation of the Reynolds equation: hybrid relaxation by lines along x, and by points.

Where the film conducts well, the points of a line change together (Gauss-Seidel by lines). In the
contact, where the elastic deflection dominates, nodes change as dipoles: the pressure rises at one
node and falls by a quarter at its four neighbours, which moves the film near it only (distributive
relaxation; Venner and Lubrecht 2000, chapters 6 and 7; docs/theory/relaxation.md). As the wedge
reaches two nodes upstream, the changes u of a line satisfy six-diagonal complementarity systems,

    r(i) - sum_s band_s(i) u(i + s) = 0,  s = -3 .. 2,      or >= 0 where p + u = 0.

Policy iteration solves them: solve, cavitate the nodes of negative pressure, free the cavitated
nodes with negative residual, and repeat. In practice it ends after a few passes; that it ends is
proven for tridiagonal M-matrices (Brennan and Schwartz 1977).

Eight lines of one colour are solved at once (`tehl.kernels.lanes`).
"""

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from tehl.base.typing import Array, FlagArray, IntArray, Records
from tehl.kernels.compiled import helper, kernel
from tehl.kernels.faces import IN_TIME, STEADILY, Stencil, both_x, both_y, slope_y
from tehl.kernels.lanes import LANES, any_of, where
from tehl.kernels.properties import Film, FlowTable
from tehl.kernels.raw import lanes, raw
from tehl.kernels.reynolds import (
    clear,
    curved_wedge,
    flux_weights,
    inner_end,
    join_ends,
    line_operator,
    row_above,
    row_below,
    sides,
)
from tehl.kernels.turning import crossing, is_second

Span = tuple[int, int]

PASSES = 6  # of the policy iteration, before clipping
FREE, CAVITATED, FROZEN, WAS_CAVITATED = 0.0, 1.0, 2.0, 3.0  # states of a node
FAR_WEDGE = 0.7  # part of the wedge of a wave of the pressure of lines, 1, that near nodes lack
MORE_ACROSS, SHORT_CELL = 1.5, 1.5
"""Part by which steps of points are longer where all flows across lines that crowd, and flow
across over that along from which they are: zebra sweeps are those of Gauss-Seidel there, and errors
that all lines share are in what they conduct along x. At lundberg ends, on cells a fifth as long as
wide, cycles leave 0.35 and 0.31 of the residual (M = 50 and 75), without it 0.40 and 0.43. Where
oil stiffens by the fall of the pressure (``stiffness``) longer steps alternate."""
NEGLIGIBLE_PART = 1e-2  # part of a change of the pressure that asperities take by the film it moves
EMPTY_MARGIN_NODES = 3  # empty nodes on both sides of a line
CHUNK = 32  # nodes copied at a time, so that they stay in the first cache
LOADED = ("east", "across", "mass_p", "rho", "dipole", "rest", "p", "state", "hardness")
EAST, ACROSS, MASS_P, RHO, DIPOLE, REST, P, STATE, HARDNESS = range(9)
"""Copied from the fields for each node: conductance to the east; that to both lines beside, with
``stiffness``; d(rho h)/dp, d(rho h)/dH, 1 for a dipole, residual, pressure, and its state; -dp_a/dH
of the asperities."""
BAND = ("west_3", "west_2", "west_1", "centre", "east_1", "east_2")
"""Coefficients of the unknowns at i - 3 .. i + 2."""
FLUX = ("own", "upstream", "farther", "back")
"""Where oil is conserved: weights of the mass of the node and of two nodes upstream in the
difference of the fluxes, and conductance to the west, zero behind a partly filled node. Where the
surfaces spin: weights of the wedge along x, and size of the drift."""
FIELDS = (*LOADED, *BAND, "up_1", "up_2", "u", *FLUX)
"""Fields of a node; ``up_1, up_2, u`` are the eliminated upper bands and the solution."""
U, OWN, UPSTREAM, FARTHER, BACK = (FIELDS.index(name) for name in ("u", *FLUX))
ALONG, ASIDE, FROM_SOUTH, FROM_NORTH = range(4)
"""Places in the parts of a dipole."""
NODE = np.dtype([(name, np.float64, (LANES,)) for name in FIELDS])


class Shapes(NamedTuple):
    """What changes of the pressure do to the film.

    ``point`` and ``dipole``: film at distances along a line per unit change of a point and of a
    dipole, of each line (`by_lanes`); ``parts``, of each line: by which its dipoles lower their
    neighbours along x and, in the mean, along y; by which those of the lines south and north lower
    it. ``curved`` (2, n) is the wedge along y of the film of a point and of a dipole, over rho and
    the drift, where the surfaces spin; lines of negative speed are then solved against x, in their
    direction.
    """

    point: Array
    dipole: Array
    parts: Array
    curved: Array = np.zeros((0, 0))


class Systems(NamedTuple):
    """Eight lines that are solved at once.

    ``rest`` (LANES, nx) holds their residuals, ``nodes`` (nx + 6,) their systems as records `NODE`;
    ``cells`` (nx + 6, FIELDS, LANES) is a view of ``nodes`` as numbers.
    """

    rest: Array
    nodes: Records
    cells: Array


class LineRelaxation(NamedTuple):
    """Settings and workspace of the line relaxation.

    ``kind`` (ny, nx) marks the dipoles; ``delta`` (ny, nx) stores them until both colours are
    done; ``frozen`` (ny, nx) marks nodes of fixed pressure; ``stiffness`` (ny, nx) is the
    contribution of the change of conductance to the diagonal (`stiffen`). From node ``ends[j]``
    (ny,) on, all of line j is frozen. ``touches`` is 1 with asperities finer than the grid.
    ``apart`` is 1 on a roller whose lines are far apart: then it matters to a node what flows to
    the lines beside, not how well they conduct or if they are cavitated, and points have the wedge
    of the deflection from afar, which the systems lack, on their diagonal (docs/theory/rollers.md).
    """

    xi: float
    omega_point: float
    omega_dipole: float
    shapes: Shapes
    systems: Systems
    kind: FlagArray
    delta: Array
    frozen: FlagArray
    stiffness: Array
    ends: IntArray
    touches: int = 0
    apart: int = 0


def by_lanes(lines: Array) -> Array:
    """Return values (ny, m) of lines by colour, value and lane: lines of one colour are in turn."""
    ny, count = lines.shape
    found = np.zeros((2, count, (ny + 1) // 2 + LANES))
    for colour in range(2):
        own = lines[colour::2].T
        found[colour, :, : own.shape[1]] = own
    return found


def empty_systems(nx: int) -> Systems:
    """Return the systems of lines of ``nx`` nodes."""
    cells = np.zeros((nx + 2 * EMPTY_MARGIN_NODES, len(FIELDS), LANES))
    nodes = cells.reshape(-1).view(NODE).view(np.recarray)
    return Systems(np.zeros((LANES, nx)), nodes, cells)


@helper
def mark_dipoles(film: Film, stencil: Stencil, relaxation: LineRelaxation) -> None:
    """Mark the nodes that relax as dipoles: small conductance all round, nothing cavitated."""
    ny = film.p.shape[0]
    p, eps_x, eps_y, kind = film.p, film.eps_x, film.eps_y, relaxation.kind
    limit = relaxation.xi / max(stencil.cx, stencil.cy)
    clear(kind)
    for j in range(0 if stencil.mirror else 1, inner_end(ny, stencil.mirror)):
        south, north = row_below(j, ny, stencil.mirror), row_above(j, ny, stencil.mirror)
        half_s, half_n = sides(film, stencil, j)
        for i in range(1, relaxation.ends[j]):
            along = max(eps_x[j, i], eps_x[j, i - 1], eps_x[j, i + 1])
            smallest = min(abs(p[j, i]), abs(p[j, i - 1]), abs(p[j, i + 1]))
            if relaxation.apart:
                faces = max(half_s**2 * eps_y[south, i], half_n**2 * eps_y[north, i])
                across = 2.0 * sqrt(eps_y[j, i] * faces) / stencil.cx
            else:
                across = max(eps_y[j, i], eps_y[south, i], eps_y[north, i])
                smallest = min(smallest, abs(p[south, i]), abs(p[north, i]))
            if max(along, across) <= limit and smallest > 0.0:
                kind[j, i] = 1


@kernel
def stiffen(film: Film, stencil: Stencil, flow: FlowTable, whole: int, out: Array) -> None:
    """Write the contribution of the change of conductance with pressure to the diagonal to ``out``.

    Along y, and if ``whole`` is 1 along x too.

    Where the pressure rises to a neighbour by many times the pressure 1/alpha that thickens the oil
    by a factor of e, the flow between both depends on the conductance of the lower one more than on
    the pressure difference.
    """
    film, flow, out = raw((film, flow, out))
    ny, nx = film.p.shape
    table, step = flow.mobility, flow.step
    last = table.shape[0] - 2
    clear(out)
    for j in range(0 if stencil.mirror else 1, inner_end(ny, stencil.mirror)):
        south, north = row_below(j, ny, stencil.mirror), row_above(j, ny, stencil.mirror)
        half_s, half_n = sides(film, stencil, j)
        for i in range(1, nx - 1):
            p = film.p[j, i]
            k = int(min(p / step, last)) if p > 0.0 else 0
            decay = max(-table[k, 1] / (table[k, 0] * step), 0.0)
            below = half_s * max(film.p[south, i] - p, 0.0)
            above = half_n * max(film.p[north, i] - p, 0.0)
            across = below * slope_y(film, stencil, (j, i), south)
            across += above * slope_y(film, stencil, (j, i), north)
            slope = film.eps_y[j, i] * across
            if whole:
                along = max(film.p[j, i - 1] - p, 0.0) + max(film.p[j, i + 1] - p, 0.0)
                slope += 0.5 * stencil.cx * film.eps_x[j, i] * along
            out[j, i] = decay * slope


@helper
def wet_range(film: Film, relaxation: LineRelaxation, j: int, slot: int) -> Span:
    """Return the first and last node of a line not cavitated or frozen; (nx, 0) if none."""
    p, frozen, rest, end = film.p, relaxation.frozen, relaxation.systems.rest, relaxation.ends[j]
    low = 1
    while low < end and (frozen[j, low] or (p[j, low] == 0.0 and rest[slot, low] >= 0.0)):
        low += 1
    if low >= end:
        return p.shape[1], 0
    high = end - 1
    while high > low and (frozen[j, high] or (p[j, high] == 0.0 and rest[slot, high] >= 0.0)):
        high -= 1
    return low, high


@helper
def _load_line(
    film: Film, stencil: Stencil, relaxation: LineRelaxation, place: Span, span: Span
) -> None:
    """Copy the fields of a span of nodes to a lane of the systems; ``place``: line and lane."""
    j, lane = place
    if film.speed.shape[0] > 0:
        _load_curved(film, stencil, relaxation, place, span)
        return
    ny = film.p.shape[0]
    rows = row_below(j, ny, stencil.mirror), row_above(j, ny, stencil.mirror)
    for i in range(span[0], span[1]):
        _load_node(film, stencil, relaxation, (j, i), (i + EMPTY_MARGIN_NODES, lane), rows)
    if stencil.conserves == STEADILY:
        _load_flux(film, stencil, relaxation, place, span)


@helper
def _load_node(
    film: Film, stencil: Stencil, relaxation: LineRelaxation, node: Span, place: Span, rows: Span
) -> None:
    """Copy the fields of a node to a place, record and lane; ``rows``: south and north of it."""
    (j, i), (at, lane) = node, place
    south, north = rows
    eps_x, eps_y, systems = film.eps_x, film.eps_y, relaxation.systems
    cells, rest = systems.cells, systems.rest
    half_x, (half_s, half_n) = 0.5 * stencil.cx, sides(film, stencil, j)
    cells[at, EAST, lane] = half_x * both_x(stencil, eps_x[j, i], eps_x[j, i + 1])
    across = half_n * both_y(film, stencil, eps_y, (j, i), north)
    across += half_s * both_y(film, stencil, eps_y, (j, i), south)
    cells[at, ACROSS, lane] = across + relaxation.stiffness[j, i]
    if relaxation.apart and not relaxation.kind[j, i]:
        cells[at, ACROSS, lane] += FAR_WEDGE
    cells[at, MASS_P, lane] = film.drho[j, i] * film.h[j, i]
    cells[at, RHO, lane] = film.rho[j, i]
    cells[at, DIPOLE, lane] = relaxation.kind[j, i]
    cells[at, REST, lane] = rest[lane, i]
    cells[at, P, lane] = film.p[j, i]
    state = CAVITATED if film.p[j, i] == 0.0 and rest[lane, i] >= 0.0 else FREE
    cells[at, STATE, lane] = FROZEN if relaxation.frozen[j, i] else state
    if relaxation.touches:
        cells[at, RHO, lane] *= film.opening[j, i]
        cells[at, HARDNESS, lane] = film.stiffness[j, i]


@helper
def is_reversed(film: Film, j: int) -> bool:
    """Return whether the oil of a line moves against x."""
    return film.speed.shape[0] > 0 and film.speed[j] < 0.0


@helper
def _load_curved(
    film: Film, stencil: Stencil, relaxation: LineRelaxation, place: Span, span: Span
) -> None:
    """Copy the fields of a line that spins along its flow, with the weights of the wedge.

    That along y moves with the node: with ``across`` it is part of the diagonal.
    """
    (j, lane), cells, nx = place, relaxation.systems.cells, film.p.shape[1]
    size, back = abs(film.speed[j]), is_reversed(film, j)
    for k in range(span[0], span[1]):
        i, at = nx - 1 - k if back else k, k + EMPTY_MARGIN_NODES
        inside = min(i, nx - 2)  # the east of the last node is not used
        rows = (
            row_below(j, film.p.shape[0], stencil.mirror),
            row_above(j, film.p.shape[0], stencil.mirror),
        )
        _load_node(film, stencil, relaxation, (j, inside), (at, lane), rows)
        if back:
            _load_reversed(film, stencil, relaxation, (j, i), (at, lane))
        drift = crossing(film, stencil, j, i)
        cells[at, ACROSS, lane] += drift * stencil.w0 * cells[at, MASS_P, lane]
        first = k == 1
        w0 = stencil.w0 - stencil.w2 if first else stencil.w0
        w1 = stencil.w1 + 2.0 * stencil.w2 if first else stencil.w1
        w2 = 0.0 if first else stencil.w2
        if stencil.conserves == STEADILY and 1 <= k < nx - 1:
            w0, w1, w2 = _curved_weights(film, stencil, (j, i), (1 if back else -1, k))
            if film.partial[j, i] and not film.partial[j, i - 1 if back else i + 1]:
                cells[at, EAST, lane] = 0.0  # it comes back, in this line or the next one
        cells[at, OWN, lane] = size * w0
        cells[at, UPSTREAM, lane] = size * w1
        cells[at, FARTHER, lane] = size * w2
        cells[at, BACK, lane] = drift


@helper
def _curved_weights(
    film: Film, stencil: Stencil, node: Span, way: Span
) -> tuple[float, float, float]:
    """Return the weights of the oil flux at a node; ``way``: columns upstream, and its place."""
    (j, i), (di, k) = node, way
    far = i + 2 * di if k > 1 else i + di
    partial = film.partial[j, i] > 0, film.partial[j, i + di] > 0, film.partial[j, far] > 0
    second = is_second(film, node, (0, di))
    before = is_second(film, (j, i + di), (0, di)) if k > 1 else False
    return flux_weights(stencil, partial, (second, before), k)


@helper
def _load_reversed(
    film: Film, stencil: Stencil, relaxation: LineRelaxation, node: Span, place: Span
) -> None:
    """Correct what `_load_node` copied for a line against x: its east is the west."""
    (j, i), (at, lane), cells = node, place, relaxation.systems.cells
    west, here = film.eps_x[j, max(i - 1, 0)], film.eps_x[j, i]
    cells[at, EAST, lane] = 0.5 * stencil.cx * both_x(stencil, west, here)
    cells[at, MASS_P, lane] = film.drho[j, i] * film.h[j, i]
    cells[at, RHO, lane] = film.rho[j, i]


@helper
def _load_flux(
    film: Film, stencil: Stencil, relaxation: LineRelaxation, place: Span, span: Span
) -> None:
    """Copy the weights of the oil flux at a span of nodes to a lane."""
    (j, lane), cells, partial, second = place, relaxation.systems.cells, film.partial, film.second
    rate, half = stencil.w0 - stencil.w2, 0.5 * stencil.cx
    for i in range(max(span[0], 1), span[1]):
        at, far = i + EMPTY_MARGIN_NODES, max(i - 2, 0)
        if i > 1 and second[j, i] and second[j, i - 1]:  # most nodes: a film far around
            cells[at, OWN, lane] = 1.5 * rate
            cells[at, UPSTREAM, lane] = -2.0 * rate
            cells[at, FARTHER, lane] = 0.5 * rate
            cells[at, BACK, lane] = half * both_x(stencil, film.eps_x[j, i - 1], film.eps_x[j, i])
            continue
        here, west, farther = partial[j, i] > 0, partial[j, i - 1] > 0, partial[j, far] > 0
        orders = second[j, i] > 0, second[j, i - 1] > 0
        w0, w1, w2 = flux_weights(stencil, (here, west, farther), orders, i)
        back = half * both_x(stencil, film.eps_x[j, i - 1], film.eps_x[j, i])
        cells[at, OWN, lane] = w0
        cells[at, UPSTREAM, lane] = w1
        cells[at, FARTHER, lane] = w2
        cells[at, BACK, lane] = 0.0 if west and not here else back


@helper
def _leave_out(cells: Array, lane: int, span: Span) -> None:
    """Fix the nodes of a lane that holds no line."""
    for i in range(span[0], span[1]):
        cells[i + EMPTY_MARGIN_NODES, STATE, lane] = FROZEN


@helper
def _fill_band(relaxation: LineRelaxation, stencil: Stencil, first: int, i: int) -> None:
    """Fill the coefficients of node ``i``: change of L there per unit change of each unknown.

    ``first`` is the first line of the batch.
    """
    if relaxation.shapes.curved.shape[0] > 0:
        here = relaxation.systems.nodes[i + 3]
        weights = here.own, here.upstream, here.farther
        _fill_row(relaxation, (first, i), weights, relaxation.systems.nodes[i + 2].east)
        _add_drift(relaxation, i)
        return
    if stencil.conserves == STEADILY:
        here = relaxation.systems.nodes[i + 3]
        weights = here.own, here.upstream, here.farther
        _fill_row(relaxation, (first, i), weights, here.back)
        return
    w0, w1, w2 = stencil.w0, stencil.w1, stencil.w2
    if i == 1:
        w0, w1, w2 = w0 - w2, w1 + 2.0 * w2, 0.0
    _fill_row(relaxation, (first, i), (w0, w1, w2), relaxation.systems.nodes[i + 2].east)


@helper
def _shape(field: Array, first: int) -> tuple[Any, Any, Any, Any, Any]:
    """Return the film of the lines of a batch at distances 0 to 4 along them."""
    of_colour, at = field[first % 2], lanes(first // 2)
    return of_colour[0, at], of_colour[1, at], of_colour[2, at], of_colour[3, at], of_colour[4, at]


@helper
def _fill_row(
    relaxation: LineRelaxation, place: Span, weights: tuple[Any, Any, Any], west_east: Any
) -> None:
    """Fill the coefficients of node ``i``.

    The column follows the type of the unknown: a point changes p at one node, a dipole at its
    four neighbours too; both change the film along the line.

    Parameters
    ----------
    relaxation : LineRelaxation
        Settings and systems.
    place : (int, int)
        First line of the batch, and number of the node.
    weights : three floats or lanes
        Of the mass of the node and of the two nodes upstream.
    west_east : lanes
        Conductance to the west.
    """
    (first, i), nodes = place, relaxation.systems.nodes
    p, d = _shape(relaxation.shapes.point, first), _shape(relaxation.shapes.dipole, first)
    parts, at = relaxation.shapes.parts[first % 2], lanes(first // 2)
    along, aside = parts[ALONG, at], parts[ASIDE, at]
    d0, d1, d2, d3, d4 = d[0] - p[0], d[1] - p[1], d[2] - p[2], d[3] - p[3], d[4] - p[4]
    w0, w1, w2 = weights
    farthest, far, west, here, east, beyond = (
        nodes[i], nodes[i + 1], nodes[i + 2], nodes[i + 3], nodes[i + 4], nodes[i + 5]
    )  # fmt: skip
    # dL/dp at i-2, i-1, i, i+1 and dL/dh at i-2, i-1, i
    a_ww, a_w, a_e = -w2 * far.mass_p, west_east - w1 * west.mass_p, here.east
    a_c = -a_e - west_east - here.across - w0 * here.mass_p
    b_ww, b_w, b_c = -w2 * far.rho, -w1 * west.rho, -w0 * here.rho
    # column of a point at i + s, then the difference if the node relaxes as a dipole
    change = b_ww * d1 + b_w * d2 + b_c * d3 - along * a_ww
    here.west_3 = b_ww * p[1] + b_w * p[2] + b_c * p[3] + farthest.dipole * change
    change = b_ww * d0 + b_w * d1 + b_c * d2 - along * a_w
    here.west_2 = a_ww + b_ww * p[0] + b_w * p[1] + b_c * p[2] + far.dipole * change
    change = b_ww * d1 + b_w * d0 + b_c * d1 - along * (a_ww + a_c)
    here.west_1 = a_w + b_ww * p[1] + b_w * p[0] + b_c * p[1] + west.dipole * change
    change = b_ww * d2 + b_w * d1 + b_c * d0
    change = change - along * (a_w + a_e) - aside * here.across
    here.centre = a_c + b_ww * p[2] + b_w * p[1] + b_c * p[0] + here.dipole * change
    change = b_ww * d3 + b_w * d2 + b_c * d1 - along * a_c
    here.east_1 = a_e + b_ww * p[3] + b_w * p[2] + b_c * p[1] + east.dipole * change
    change = b_ww * d4 + b_w * d3 + b_c * d2 - along * a_e
    here.east_2 = b_ww * p[4] + b_w * p[3] + b_c * p[2] + beyond.dipole * change
    if relaxation.touches:
        around = far.hardness + west.hardness + here.hardness + east.hardness
        if any_of(around * p[0] > NEGLIGIBLE_PART):
            hardness = a_ww * far.hardness, a_w * west.hardness
            slopes = *hardness, a_c * here.hardness, a_e * east.hardness
            _add_asperities(relaxation, place, slopes)


@helper
def _add_drift(relaxation: LineRelaxation, i: int) -> None:
    """Add the wedge along y of the film that the unknowns of the line move."""
    nodes, p, d = relaxation.systems.nodes, relaxation.shapes.curved[0], relaxation.shapes.curved[1]
    farthest, far, west, here, east, beyond = (
        nodes[i], nodes[i + 1], nodes[i + 2], nodes[i + 3], nodes[i + 4], nodes[i + 5]
    )  # fmt: skip
    moved = here.back * here.rho
    here.west_3 -= moved * (p[3] + farthest.dipole * (d[3] - p[3]))
    here.west_2 -= moved * (p[2] + far.dipole * (d[2] - p[2]))
    here.west_1 -= moved * (p[1] + west.dipole * (d[1] - p[1]))
    here.centre -= moved * (p[0] + here.dipole * (d[0] - p[0]))
    here.east_1 -= moved * (p[1] + east.dipole * (d[1] - p[1]))
    here.east_2 -= moved * (p[2] + beyond.dipole * (d[2] - p[2]))


@helper
def _add_asperities(
    relaxation: LineRelaxation, place: Span, slopes: tuple[Any, Any, Any, Any]
) -> None:
    """Add the change of the oil pressure as asperities take some: p = P - p_a(H).

    ``slopes`` are dL/dp times -dp_a/dH at nodes i - 2 .. i + 1; ``place`` as in `_fill_row`.
    """
    (first, i), nodes = place, relaxation.systems.nodes
    p, d = _shape(relaxation.shapes.point, first), _shape(relaxation.shapes.dipole, first)
    e_ww, e_w, e_c, e_e = slopes
    farthest, far, west, here, east, beyond = (
        nodes[i], nodes[i + 1], nodes[i + 2], nodes[i + 3], nodes[i + 4], nodes[i + 5]
    )  # fmt: skip
    change = e_ww * (d[1] - p[1]) + e_w * (d[2] - p[2]) + e_c * (d[3] - p[3]) + e_e * (d[4] - p[4])
    here.west_3 += e_ww * p[1] + e_w * p[2] + e_c * p[3] + e_e * p[4] + farthest.dipole * change
    change = e_ww * (d[0] - p[0]) + e_w * (d[1] - p[1]) + e_c * (d[2] - p[2]) + e_e * (d[3] - p[3])
    here.west_2 += e_ww * p[0] + e_w * p[1] + e_c * p[2] + e_e * p[3] + far.dipole * change
    change = e_ww * (d[1] - p[1]) + e_w * (d[0] - p[0]) + e_c * (d[1] - p[1]) + e_e * (d[2] - p[2])
    here.west_1 += e_ww * p[1] + e_w * p[0] + e_c * p[1] + e_e * p[2] + west.dipole * change
    change = e_ww * (d[2] - p[2]) + e_w * (d[1] - p[1]) + e_c * (d[0] - p[0]) + e_e * (d[1] - p[1])
    here.centre += e_ww * p[2] + e_w * p[1] + e_c * p[0] + e_e * p[1] + here.dipole * change
    change = e_ww * (d[3] - p[3]) + e_w * (d[2] - p[2]) + e_c * (d[1] - p[1]) + e_e * (d[0] - p[0])
    here.east_1 += e_ww * p[3] + e_w * p[2] + e_c * p[1] + e_e * p[0] + east.dipole * change
    change = e_ww * (d[4] - p[4]) + e_w * (d[3] - p[3]) + e_c * (d[2] - p[2]) + e_e * (d[1] - p[1])
    here.east_2 += e_ww * p[4] + e_w * p[3] + e_c * p[2] + e_e * p[1] + beyond.dipole * change


@helper
def _eliminate(nodes: Records, i: int) -> None:
    """Eliminate upstream unknowns: u_i + up_1 u_{i+1} + up_2 u_{i+2} = ``u`` of the record.

    No pivoting. Where a node is cavitated the row reads u = -p, where it is kept u = 0.
    """
    far, west_2, west, here = nodes[i], nodes[i + 1], nodes[i + 2], nodes[i + 3]
    free = here.state == FREE
    l_3 = here.west_3
    l_2 = here.west_2 - l_3 * far.up_1
    l_1 = here.west_1 - l_3 * far.up_2 - l_2 * west_2.up_1
    diagonal = here.centre - l_2 * west_2.up_2 - l_1 * west.up_1
    inverse = 1.0 / where(free, diagonal, 1.0)
    rest = here.rest - l_3 * far.u - l_2 * west_2.u - l_1 * west.u
    here.up_1 = where(free, (here.east_1 - l_1 * west.up_2) * inverse, 0.0)
    here.up_2 = where(free, here.east_2 * inverse, 0.0)
    here.u = where(free, rest * inverse, where(here.state == CAVITATED, -here.p, 0.0))


@helper
def band_solve(nodes: Records, low: int, high: int) -> None:
    """Solve the six-diagonal systems of all lanes for ``u`` on low..high, zero beside them."""
    for beside in (low, low + 1, low + 2, high + 4, high + 5, high + 6):
        node = nodes[beside]
        node.up_1 = 0.0
        node.up_2 = 0.0
        node.u = 0.0
    for i in range(low, high + 1):
        _eliminate(nodes, i)
    for i in range(high + EMPTY_MARGIN_NODES, low + EMPTY_MARGIN_NODES - 1, -1):
        here = nodes[i]
        here.u = here.u - (here.up_1 * nodes[i + 1].u + here.up_2 * nodes[i + 2].u)


@helper
def _cavitate(nodes: Records, i: int) -> tuple[bool, bool]:
    """Cavitate the free lanes of negative pressure at node i.

    Return whether there was one, and whether any lane was cavitated already.
    """
    here = nodes[i + EMPTY_MARGIN_NODES]
    negative = (here.state == FREE) & (here.u < -here.p)
    cavitated = here.state == CAVITATED
    here.state = where(negative, CAVITATED, where(cavitated, WAS_CAVITATED, here.state))
    return any_of(negative), any_of(cavitated)


@helper
def _refill(nodes: Records, i: int) -> bool:
    """Free the cavitated lanes with negative residual at node i; return whether there was one."""
    far, west_2, west = nodes[i], nodes[i + 1], nodes[i + 2]
    here, east, east_2 = nodes[i + 3], nodes[i + 4], nodes[i + 5]
    rest = here.rest - here.west_3 * far.u - here.west_2 * west_2.u - here.west_1 * west.u
    rest = rest - here.centre * here.u - here.east_1 * east.u - here.east_2 * east_2.u
    cavitated = here.state == WAS_CAVITATED
    refills = cavitated & (rest < 0.0)
    here.state = where(refills, FREE, where(cavitated, CAVITATED, here.state))
    return any_of(refills)


@helper
def complementarity(nodes: Records, span: Span, last: int) -> Span:
    """Solve the lines with p + u >= 0 by policy iteration over the cavitated nodes.

    Nodes outside low..high are cavitated with p = 0 or kept; the range grows as nodes are
    freed and is returned. ``last`` is the last inner node.
    """
    low, high = span
    for _ in range(PASSES):
        band_solve(nodes, low, high)
        changed = False
        for i in range(max(low - 2, 1), min(high + 3, last) + 1):
            negative, cavitated = _cavitate(nodes, i)
            changed = changed or negative
            if cavitated and _refill(nodes, i):
                low, high, changed = min(low, i), max(high, i), True
        if not changed:
            return low, high
    band_solve(nodes, low, high)
    return low, high


@helper
def _store_line(film: Film, relaxation: LineRelaxation, place: Span, span: Span) -> None:
    """Apply the solution of a line: points at once, dipoles to ``delta``."""
    (j, lane), cells = place, relaxation.systems.cells
    if is_reversed(film, j):
        for k in range(span[0], span[1]):
            node = j, film.p.shape[1] - 1 - k
            _store_node(film, relaxation, node, cells[k + EMPTY_MARGIN_NODES, U, lane])
        return
    for i in range(span[0], span[1]):
        u = cells[i + EMPTY_MARGIN_NODES, U, lane]
        if relaxation.apart and film.south.shape[0] > 0 and not relaxation.kind[j, i]:
            across = cells[i + EMPTY_MARGIN_NODES, ACROSS, lane] - FAR_WEDGE
            along = 2.0 * cells[i + EMPTY_MARGIN_NODES, EAST, lane]
            more = across - SHORT_CELL * along - relaxation.stiffness[j, i]
            u *= 1.0 + (MORE_ACROSS * more / (across + along) if more > 0.0 else 0.0)
        _store_node(film, relaxation, (j, i), u)


@helper
def _store_node(film: Film, relaxation: LineRelaxation, node: Span, u: float) -> None:
    """Apply the change ``u`` of a node."""
    p, (j, i) = film.p, node
    moved = 0.0 if u <= -p[j, i] else p[j, i] + relaxation.omega_point * u
    dipole = relaxation.omega_dipole * max(u, -p[j, i])
    relaxation.delta[j, i] = dipole if relaxation.kind[j, i] else 0.0
    p[j, i] = p[j, i] if relaxation.kind[j, i] else moved


@helper
def _residual_of_line(
    film: Film, stencil: Stencil, rhs: Array, relaxation: LineRelaxation, place: tuple[int, int]
) -> None:
    """Write ``rhs - L(p)`` of a line to a row of ``rest``; ``place``: the numbers of both."""
    (j, slot), rest = place, relaxation.systems.rest
    line_operator(film, stencil, j, rest, (slot, relaxation.ends[j]))
    for i in range(1, relaxation.ends[j]):
        rest[slot, i] = rhs[j, i] - rest[slot, i]


@helper
def set_up(
    film: Film, stencil: Stencil, relaxation: LineRelaxation, batch: Span, span: Span
) -> None:
    """Fill the systems of a batch of lines, chunk by chunk; ``batch``: first line and count."""
    (first, count), (low, high), nx = batch, span, film.p.shape[1]
    end = min(high + EMPTY_MARGIN_NODES, nx - 1)
    for start in range(max(low - EMPTY_MARGIN_NODES, 0), end, CHUNK):
        stop = min(start + CHUNK, end)
        for lane in range(count):
            _load_line(film, stencil, relaxation, (first + 2 * lane, lane), (start, stop))
        for lane in range(count, LANES):
            _leave_out(relaxation.systems.cells, lane, (start, stop))
        ready = high if stop == end else stop - EMPTY_MARGIN_NODES
        for i in range(max(start - EMPTY_MARGIN_NODES + 1, low), ready + 1):
            _fill_band(relaxation, stencil, first, i)


@helper
def relax_batch(
    film: Film, stencil: Stencil, rhs: Array, relaxation: LineRelaxation, batch: Span
) -> None:
    """Relax up to eight lines of one colour; ``batch``: number of the first line, and count."""
    (first, count), nx = batch, film.p.shape[1]
    low, high = nx, 0
    for lane in range(count):
        _residual_of_line(film, stencil, rhs, relaxation, (first + 2 * lane, lane))
        line_low, line_high = wet_range(film, relaxation, first + 2 * lane, lane)
        if is_reversed(film, first + 2 * lane) and line_low <= line_high:
            line_low, line_high = nx - 1 - line_high, nx - 1 - line_low
        low, high = min(low, line_low), max(high, line_high)
    if low > high:
        return
    # the range of the unknowns may grow by two nodes upstream and three downstream in each pass
    span = max(low - 2 * PASSES, 1), min(high + 3 * PASSES, nx - 2)
    set_up(film, stencil, relaxation, batch, span)
    low, high = complementarity(relaxation.systems.nodes, (low, high), nx - 2)
    for lane in range(count):
        _store_line(film, relaxation, (first + 2 * lane, lane), (low, high + 1))


@kernel
def relax_lines(film: Film, stencil: Stencil, rhs: Array, relaxation: LineRelaxation) -> None:
    """Perform one zebra sweep over the lines along x (Venner and Lubrecht 2000, chapter 6).

    Points change at once, dipoles after both colours.

    Parameters
    ----------
    film, stencil : Film, Stencil
        State, of which the pressure is relaxed, and weights of the operator.
    rhs : array (ny, nx)
        Right-hand side of the Reynolds equation.
    relaxation : LineRelaxation
        Settings and scratch arrays.
    """
    film, rhs, relaxation = raw((film, rhs, relaxation))
    first, ny = 0 if stencil.mirror else 1, film.p.shape[0]
    mark_dipoles(film, stencil, relaxation)
    clear(relaxation.delta)
    for colour in range(2):
        for j in range(first + colour, inner_end(ny, stencil.mirror), 2 * LANES):
            count = min(LANES, (inner_end(ny, stencil.mirror) + 1 - j) // 2)
            relax_batch(film, stencil, rhs, relaxation, (j, count))
    add_dipoles(film, relaxation, stencil)
    join_ends(film.p, stencil.mirror)


@helper
def add_dipoles(film: Film, relaxation: LineRelaxation, stencil: Stencil) -> None:
    """Add the stored dipoles to ``p`` and clip at zero unless asperities carry.

    Where lines are apart, and in a time step that conserves oil, nodes without pressure take
    nothing from other lines: the least pressure fills the gap, and cycles take it back.
    """
    mirror, alone = stencil.mirror, relaxation.apart or stencil.conserves == IN_TIME
    p, delta, ends, (ny, nx) = film.p, relaxation.delta, relaxation.ends, film.p.shape
    parts = relaxation.shapes.parts
    touches = film.stiffness.shape[0] > 0
    for j in range(0 if mirror else 1, inner_end(ny, mirror)):
        south, north = row_below(j, ny, mirror), row_above(j, ny, mirror)
        colour, slot, end = j % 2, j // 2, max(ends[j], ends[south], ends[north])
        along, below = parts[colour, ALONG, slot], parts[colour, FROM_SOUTH, slot]
        above = parts[colour, FROM_NORTH, slot]
        for i in range(1, min(end + 1, nx - 1)):
            around = along * (delta[j, i - 1] + delta[j, i + 1])
            if not alone or p[j, i] != 0.0:
                around += below * delta[south, i] + above * delta[north, i]
            changed = p[j, i] + delta[j, i] - around
            p[j, i] = changed if touches else max(changed, 0.0)


@kernel
def relax_points(film: Film, stencil: Stencil, rhs: Array, self_film: Array, omega: float) -> None:
    """Relax point by point (Gauss-Seidel with under-relaxation ``omega``).

    Each node in turn changes so that its residual vanishes, with the film of the last evaluation.
    It diverges where the deflection dominates (docs/theory/relaxation.md).

    Parameters
    ----------
    film, stencil : Film, Stencil
        State, of which the pressure is relaxed, and weights of the operator.
    rhs : array (ny, nx)
        Right-hand side of the Reynolds equation.
    self_film : array (n,)
        Film at a distance of m nodes per unit pressure.
    omega : float
        Under-relaxation [-].
    """
    film, rhs, self_film = raw((film, rhs, self_film))
    ny, nx = film.p.shape
    p, eps_x, eps_y, rho, h = film.p, film.eps_x, film.eps_y, film.rho, film.h
    for j in range(0 if stencil.mirror else 1, inner_end(ny, stencil.mirror)):
        south, upper = row_below(j, ny, stencil.mirror), row_above(j, ny, stencil.mirror)
        for i in range(1, nx - 1):
            east = 0.5 * stencil.cx * (eps_x[j, i] + eps_x[j, i + 1])
            west = 0.5 * stencil.cx * (eps_x[j, i] + eps_x[j, i - 1])
            north = 0.5 * stencil.cy * (eps_y[j, i] + eps_y[upper, i])
            below = 0.5 * stencil.cy * (eps_y[j, i] + eps_y[south, i])
            mass, mass_w = rho[j, i] * h[j, i], rho[j, i - 1] * h[j, i - 1]
            if film.speed.shape[0] > 0:
                wedge = curved_wedge(film, stencil, j, i)
            elif i == 1:
                wedge = (stencil.w0 - stencil.w2) * mass + (stencil.w1 + 2.0 * stencil.w2) * mass_w
            else:
                mass_ww = rho[j, i - 2] * h[j, i - 2]
                wedge = stencil.w0 * mass + stencil.w1 * mass_w + stencil.w2 * mass_ww
            flow = east * (p[j, i + 1] - p[j, i]) + west * (p[j, i - 1] - p[j, i])
            flow += north * (p[upper, i] - p[j, i])
            flow += below * (p[south, i] - p[j, i])
            slope = -(east + west + north + below)
            slope -= stencil.w0 * rho[j, i] * self_film[0]
            slope -= stencil.w1 * rho[j, i - 1] * self_film[1]
            if film.speed.shape[0] > 0:
                slope -= stencil.w0 * crossing(film, stencil, j, i) * rho[j, i] * self_film[0]
            p[j, i] = max(p[j, i] + omega * (rhs[j, i] - flow + wedge) / slope, 0.0)
    join_ends(p, stencil.mirror)
