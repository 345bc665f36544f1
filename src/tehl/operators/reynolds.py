"""Discrete Reynolds equation: weights of the stencil, steady and in a time step.

(eps P_x)_x + (eps P_y)_y / kappa^2 - (rho H)_x - (rho H)_t = 0,  x, y, t in a_x, a_y, a_x/u_m.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups
from tehl.kernels.faces import CLOSED, IN_TIME, MARK_THIRD_ORDER, STEADILY, WRAPPED, Stencil
from tehl.kernels.properties import Film
from tehl.operators.influence import Influence

UPSTREAM = {1: (1.0, -1.0, 0.0), 2: (1.5, -2.0, 0.5)}
"""Weights of rho H of a node and of its upstream neighbours in the wedge, by its order [1/dx]."""
CUBIC = (-1, 0, 1, 2)
"""Nodes of the cubic interpolation, upstream of the node before the place."""
INFLUENCE_NODES = 8
"""Nodes along a line in the influence of one node, as the line relaxation uses it."""


def steady_stencil(
    grid: Grid,
    groups: Groups,
    wedge_order: int,
    *,
    conserves: bool = False,
    speed: float = 1.0,
    oblique: bool = False,
) -> Stencil:
    """Return the weights of the steady operator: central Poiseuille term, upstream wedge.

    Parameters
    ----------
    grid : Grid
        Its mesh widths are in Hertz half-widths.
    groups : Groups
        The ellipticity scales the differences along y.
    wedge_order : {1, 2, 3}
        Order of the upstream difference: (1, -1), (3/2, -2, 1/2) or (2, 3, -6, 1)/6 over dx, the
        last as the second one and a third difference, ``third``, with geometric means of the
        conductance, logarithmic ones along y if it is oblique.
        Those along y of rollers are always of the mobilities logarithmic and of the cubes of the
        films geometric: at their ends both change by orders of magnitude from line to line.
    conserves : bool
        Whether oil is conserved in cavities.
    speed : float
        Entrainment speed over that of the contact [-].
    oblique : bool
        Whether oil flows at an angle to the axes of the contact, or the surfaces spin.
    """
    weights = UPSTREAM[min(wedge_order, 2)]
    w0, w1, w2 = (speed * w / grid.dx for w in weights)
    return Stencil(
        cx=1.0 / grid.dx**2,
        cy=1.0 / (groups.ellipticity * grid.dy) ** 2,
        w0=w0,
        w1=w1,
        w2=w2,
        mirror=int(grid.mirror) + CLOSED * grid.is_closed + WRAPPED * grid.wraps,
        conserves=STEADILY if conserves else 0,
        third=speed / (3.0 * grid.dx) if wedge_order > 2 else 0.0,
        fore=int(np.searchsorted(grid.x, 0.0)),
        arithmetic=_arithmetic_part(wedge_order, is_closed=grid.is_closed, oblique=oblique),
        geometric=int(wedge_order > 2),
    )


def _arithmetic_part(wedge_order: int, *, is_closed: bool, oblique: bool) -> float:
    if wedge_order < 3 and not is_closed:
        return 1.0
    return 1.0 / 3.0 if oblique or is_closed else 0.0


def conductance(stencil: Stencil, here: Array, there: Array) -> Array:
    """Return the conductance of the faces between pairs of nodes of columns.

    Parameters
    ----------
    stencil : Stencil
        Decides the mean, as `tehl.kernels.faces` has it.
    here, there : Array
        eps = rho H^3/(eta lambda) [-] at the nodes on both sides of each face, of one shape.
    """
    arithmetic: Array = 0.5 * (here + there)
    geometric: Array = np.sqrt(here * there)
    return geometric + stencil.arithmetic * (arithmetic - geometric)


def of_second_order(stencil: Stencil) -> Stencil:
    """Return the weights of a wedge of second order at most; means on rollers stay as they are."""
    is_closed = stencil.mirror >= CLOSED
    return stencil._replace(
        third=0.0, arithmetic=stencil.arithmetic if is_closed else 1.0, geometric=0
    )


def step_stencil(stencil: Stencil, time_step: float) -> Stencil:
    """Return the weights of the Reynolds equation in a time step.

    Wedge and squeeze are one derivative of rho H along the mean motion, second-order backward:
    3/2 of rho H here and now, -2 and 1/2 of it one and two steps before at the nodes upstream
    (docs/theory/numerics-transient.md). Only the first is unknown. Its weight is the same on all
    grids, which take the same time step. Means of the conductance are those of the steady equation.

    Parameters
    ----------
    stencil : Stencil
        Weights of the steady equation on the grid.
    time_step : float
        Step [a_x / u_m].
    """
    conserves = IN_TIME if stencil.conserves else 0
    return stencil._replace(w0=1.5 / time_step, w1=0.0, w2=0.0, third=0.0, conserves=conserves)


def upstream(field: Array, nodes: int) -> Array:
    """Return a field upstream of each node; linear before the first node.

    Parameters
    ----------
    field : Array
        Nodal values, (ny, nx).
    nodes : int
        Distance along x in mesh widths, at least one.
    """
    shifted = np.empty_like(field)
    shifted[:, nodes:] = field[:, :-nodes]
    before = np.arange(-nodes, 0.0)
    shifted[:, :nodes] = field[:, :1] + before * (field[:, 1:2] - field[:, :1])
    return shifted


def carried(field: Array, distance: float, *, limited: bool = False) -> Array:
    """Return a field where it was a distance ago; linear beyond both edges.

    The weights are the same at all nodes, so that the sum over them is conserved.

    Parameters
    ----------
    field : Array
        Nodal values, (ny, nx).
    distance : float
        Along x in mesh widths; negative where the film moves against x.
    limited : bool
        Whether fronts of oil stay monotone, at second order; else by cubic interpolation.
    """
    if distance < 0.0:
        return carried(field[:, ::-1], -distance, limited=limited)[:, ::-1]
    whole = round(distance)
    if abs(distance - whole) < 1e-9:
        return upstream(field, whole) if whole else field.copy()
    nodes, s = int(distance), distance - int(distance)
    ghosts = nodes + len(CUBIC) - 1
    west = field[:, :1] + np.arange(-ghosts, 0.0) * (field[:, 1:2] - field[:, :1])
    east = field[:, -1:] + (field[:, -1:] - field[:, -2:-1])
    wider = np.concatenate([west, field, east], axis=1)
    if limited:  # what of each cell has passed its east face
        step = np.diff(wider, axis=1)
        behind, ahead = step[:, :-1], step[:, 1:]
        slope = (2.0 - s) / 3.0 * ahead + (1.0 + s) / 3.0 * behind
        most = 2.0 * np.minimum(np.abs(behind), np.abs(ahead))
        slope = np.where(
            behind * ahead > 0.0, np.sign(slope) * np.minimum(np.abs(slope), most), 0.0
        )
        cells = wider[:, 1:-1]
        flux = s * (cells + 0.5 * (1.0 - s) * slope)
        moved = cells[:, 1:] - np.diff(flux, axis=1)
        first = ghosts - nodes - 2
        return moved[:, first : first + field.shape[1]]
    found = np.zeros_like(field)
    for place, weight in zip(CUBIC, cubic_weights(s), strict=True):
        first = ghosts - nodes - place
        found += weight * wider[:, first : first + field.shape[1]]
    return found


def cubic_weights(part: float) -> list[float]:
    """Return the weights of the nodes at `CUBIC`, in mesh widths upstream, of a place between them.

    Parameters
    ----------
    part : float
        Distance of the place upstream [mesh widths].
    """
    return [
        math.prod((part - one) / (place - one) for one in CUBIC if one != place) for place in CUBIC
    ]


def steady_wedge(mass: Array, grid: Grid, order: int, *, backwards: bool = False) -> Array:
    """Return the upstream difference of the mass rho H along x, as the steady stencil takes it.

    Parameters
    ----------
    mass : (ny, nx) array
        rho H [-].
    grid : Grid
        Its nodes along x.
    order : {1, 2, 3}
        Order of the difference.
    backwards : bool
        Whether the film moves against x.
    """
    if backwards:
        return -_wedge_along(mass[:, ::-1], -grid.x[::-1], grid.dx, order)[:, ::-1]
    return _wedge_along(mass, grid.x, grid.dx, order)


def _wedge_along(mass: Array, x: Array, spacing: float, order: int) -> Array:
    """Return the upstream difference along rising ``x``."""
    if order == 1:
        return (mass - upstream(mass, 1)) / spacing
    found = (1.5 * mass - 2.0 * upstream(mass, 1) + 0.5 * upstream(mass, 2)) / spacing
    if order > 2:
        bent = np.zeros_like(mass)
        weight = np.where(x < 0.0, 1.0, 0.5)[1:-1] / (3.0 * spacing)
        bent[:, 1:-1] = weight * np.diff(mass, n=2, axis=1)
        found[:, 1:-1] += np.diff(bent, axis=1)[:, :-1]
    return found


def steady_flux(film: Film, held: Array, grid: Grid, order: int) -> Array:
    """Return the difference of the wedge fluxes along x where cavities conserve oil.

    As in `tehl.kernels.reynolds`, but with all pressure flows counted where they pass: a partly
    filled node passes on the oil that it holds.

    Parameters
    ----------
    film : Film
        With ``partial`` and ``second``.
    held : (ny, nx) array
        Oil at each node [-].
    grid : Grid
        Its nodes along x.
    order : int
        Order of the wedge.
    """
    passed = held.copy()
    passed[:, 1:] += np.where(film.second[:, 1:] > 0, 0.5, 0.0) * np.diff(held, axis=1)
    third = np.where(grid.x < 0.0, 1.0, 0.5) / 3.0 * (film.second == MARK_THIRD_ORDER)
    passed[:, 1:-1] += third[:, 1:-1] * np.diff(held, n=2, axis=1)
    passed = np.where(film.partial > 0, held, passed)
    full = (film.partial[:, 0] == 0) & (film.partial[:, 1] == 0)
    if order > 1:
        passed[full, 0] = 0.5 * (held[full, 0] + held[full, 1])
    difference = np.zeros_like(held)
    difference[:, 1:] = (passed[:, 1:] - passed[:, :-1]) / grid.dx
    return difference


def line_influence(
    influence: Influence, parts: tuple[float, float] = (0.25, 0.25)
) -> tuple[Array, Array]:
    """Return the film along a line per unit change of one node, and of a dipole.

    A dipole raises one node and lowers its neighbours: its far field decays fast, so that it
    changes the film locally (Venner and Lubrecht 2000, chapter 6).

    Parameters
    ----------
    influence : Influence
        Of one cell of the grid.
    parts : (float, float)
        By which each neighbour along x and along y is lowered, over the change of the node.

    Returns
    -------
    point, dipole : Array
        At offsets from zero along the line, (`INFLUENCE_NODES`,).
    """
    along, aside = parts
    line = influence(0, slice(0, INFLUENCE_NODES + 1))
    beside = influence(1, slice(0, INFLUENCE_NODES))
    point = line[:INFLUENCE_NODES]
    west = line[[1, *range(INFLUENCE_NODES - 1)]]
    dipole = point - along * (west + line[1:]) - 2.0 * aside * beside
    return point.copy(), dipole


class LineShapes(NamedTuple):
    """What the change of one node moves, of each line of a grid."""

    point: Array
    dipole: Array
    """Film at offsets from zero along the line per unit change of a node and of a dipole, (rows,
    `INFLUENCE_NODES`)."""
    parts: Array
    """By which dipoles lower their neighbours along x and, in the mean, along y, and are lowered by
    those of the lines south and north, (rows, 4)."""


def line_shapes(
    grid: Grid, influence: Influence, parts: tuple[float, float], lines: int = 0
) -> LineShapes:
    """Return what the change of one node moves on lines of a grid.

    Parameters
    ----------
    grid, influence : Grid, Influence
        Nodes, and the deflection per unit pressure.
    parts : (float, float)
        As of `line_influence`, where lines are uniform.
    lines : int
        Lines to each side that change with the line of a point.
    """
    if grid.crowding:
        return _crowded_shapes(grid, influence, lines)
    point, dipole = _uniform_shapes(influence, parts, lines)
    along, aside = parts
    every = np.array([along, aside, aside, aside])
    return LineShapes(*(np.tile(one, (grid.shape[0], 1)) for one in (point, dipole, every)))


@lru_cache(maxsize=64)
def _uniform_shapes(
    influence: Influence, parts: tuple[float, float], lines: int
) -> tuple[Array, Array]:
    """Return point and dipole of `line_shapes`, of any line, read-only."""
    point, dipole = line_influence(influence, parts)
    others = (influence(line + 1, slice(0, point.size)) for line in range(lines))
    point += 2.0 * sum(others, np.zeros(point.size))  # lines on both sides move along
    point.flags.writeable = dipole.flags.writeable = False
    return point, dipole


def _crowded_shapes(grid: Grid, influence: Influence, lines: int) -> LineShapes:
    """Return those of lines that crowd.

    With widths w, distances d of the lines south and north, and a the part along x, dipoles have
    no load, no moment, and the same second moment both ways: for the load m w of the neighbours

        2 a + m_S + m_N = 1,   m_S d_S = m_N d_N,   m_S d_S^2 + m_N d_N^2 = 2 a dx^2.

    At ends both neighbours are one.
    """
    reach = max(lines, 1)
    films = influence.beside(grid, reach, INFLUENCE_NODES + 1)
    y, cells = influence.dy / grid.dy * grid.y, np.diff(grid.faces)
    south, north = np.diff(y, prepend=2.0 * y[0] - y[1]), np.diff(y, append=2.0 * y[-1] - y[-2])
    per_distance = 1.0 / ((south + north) * (1.0 / grid.dx**2 + 1.0 / (south * north)))
    along = 0.5 * per_distance * (south + north) / grid.dx**2
    rows = np.arange(y.size)
    below, above = np.abs(rows - 1), y.size - 1 - np.abs(y.size - 2 - rows)
    lowers = np.array(  # the lines south and north, by its own dipole
        [per_distance / distance * cells for distance in (south, north)]
    ) / [cells[below], cells[above]]
    ends, aside = [-1] if grid.mirror else [0, -1], 0.5 * lowers.sum(axis=0)
    for end in ends:
        aside[end] *= 2.0
        lowers[:, end] = (0.0, aside[end]) if end == 0 else (aside[end], 0.0)
    lowered = np.array([lowers[1, below], lowers[0, above]])
    if grid.mirror:
        lowered[0, 0] = lowers[0, 1]
    for end in ends:
        lowered[:, end] = 0.5 * lowered[1 if end == 0 else 0, end]
    own, beside = films[reach][:, :INFLUENCE_NODES], films[[reach - 1, reach + 1], :, :-1]
    west = films[reach][:, [1, *range(INFLUENCE_NODES - 1)]]
    dipole = own - along[:, None] * (west + films[reach][:, 1:])
    dipole -= (lowers[:, :, None] * beside).sum(axis=0)
    point = films[reach - lines : reach + lines + 1, :, :-1].sum(axis=0)
    return LineShapes(point, dipole, np.array([along, aside, *lowered]).T)
