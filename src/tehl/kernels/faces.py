"""The stencil of the Reynolds operator, and what the faces between its cells conduct."""

from math import sqrt
from typing import NamedTuple

from tehl.base.typing import Array
from tehl.kernels.compiled import helper
from tehl.kernels.properties import Film

CLOSED, WRAPPED = 2, 4
"""Added to ``mirror`` where no oil flows through the ends: their rows are inner ones. So they are
where the film goes on with that of the other end, for which both are added: the last row is the
first one again."""
STEADILY, IN_TIME = 1, 2
MARK_SECOND_ORDER, MARK_THIRD_ORDER = 1, 2
"""Marks of the nodes that pass on oil with second and with third order where it is conserved."""
MOST_OPENING, NO_FILM = 100.0, 1e-30
"""Largest ratio of the films of two lines of a roller in the mean of their conductances, as
iterates may have none; and what keeps it finite."""


class Stencil(NamedTuple):
    """Weights of the differences on one grid.

    ``cx = 1/dx^2``, ``cy = 1/(kappa dy)^2``; ``w0, w1, w2`` weigh rho h of a node and of its
    upstream neighbours: the wedge, in a time step wedge and squeeze at the new time; ``mirror`` is
    1 if row 0 is a symmetry line, 2 where the ends are closed (3 with both), and 6 where the film
    wraps; ``conserves`` is `STEADILY` or `IN_TIME` if oil is conserved in cavities too. In a time
    step what a cell holds does not depend on the present of others.
    ``third`` is zero, or 1/3 of ``1/dx``: the weight of the third difference that makes a wedge of
    second order one of third order. From column ``fore`` on, behind the centre, half of it is
    added: all of it overshoots at the pressure spike. ``geometric`` is 1, or -1 where the film
    moves against x, if the conductance along x has geometric means: with a wedge of third order,
    and in the time steps from its film.
    ``arithmetic`` is the part of the arithmetic mean of the conductance along y beside the
    geometric one: a third makes it nearly a logarithmic one, on rollers that of the mobilities
    (`opening_power`). Relaxation keeps the wedge of second order, which has the larger diagonal.
    """

    cx: float
    cy: float
    w0: float
    w1: float
    w2: float
    mirror: int
    conserves: int = 0
    third: float = 0.0
    fore: int = 0
    arithmetic: float = 1.0
    geometric: int = 0


@helper
def both(stencil: Stencil, here: float, there: float, opening: float) -> float:
    """Return twice the conductance of the face between two nodes of a column.

    ``opening`` is that of `opening_power`.
    """
    if stencil.arithmetic < 1.0:
        geometric = 2.0 * sqrt(here * there)
        apart = opening * here + there / opening
        return geometric + stencil.arithmetic * (apart - geometric)
    return here + there


@helper
def opening_power(stencil: Stencil, here: float, there: float) -> float:
    """Return (H_there/H_here)^3/2 of the films of two nodes of a roller's column, else 1.

    With it the mean of both mobilities is logarithmic, and that of the cubes of both films is
    geometric (docs/theory/rollers.md, the solver).
    """
    if stencil.mirror < CLOSED:
        return 1.0
    ratio = (abs(there) + NO_FILM) / (abs(here) + NO_FILM)
    ratio = min(max(ratio, 1.0 / MOST_OPENING), MOST_OPENING)
    return ratio * sqrt(ratio)


@helper
def both_y(film: Film, stencil: Stencil, eps_y: Array, node: tuple[int, int], row: int) -> float:
    """Return twice the conductance of the face between a node and that of another row."""
    j, i = node
    opening = opening_power(stencil, film.h[j, i], film.h[row, i])
    return both(stencil, eps_y[j, i], eps_y[row, i], opening)


@helper
def slope_y(film: Film, stencil: Stencil, node: tuple[int, int], row: int) -> float:
    """Return by what `both_y` grows with the conductance of its node.

    That of other contacts than rollers counts as an arithmetic mean.
    """
    j, i = node
    if stencil.mirror < CLOSED:
        return 1.0
    opening = opening_power(stencil, film.h[j, i], film.h[row, i])
    ratio = sqrt(film.eps_y[row, i] / film.eps_y[j, i])
    return ratio + stencil.arithmetic * (opening - ratio)


@helper
def both_x(stencil: Stencil, west: float, east: float) -> float:
    """Return twice the conductance of the face between two nodes along x.

    Where it rises along the flow, behind the pressure spike, the geometric mean would be too small:
    a steep fall of the pressure is met by the logarithmic mean, here within 2 % up to a factor of
    10: (2 sqrt(a b) + (a + b)/2)/3.
    """
    if stencil.geometric:
        geometric = 2.0 * sqrt(west * east)
        rises = stencil.geometric * (east - west) > 0.0
        return geometric + (west + east - geometric) / 3.0 if rises else geometric
    return west + east


@helper
def third_beyond(stencil: Stencil, i: int, di: int) -> float:
    """Return the weight of the third difference at the face downstream of column i."""
    if di > 0:
        return stencil.third if i > stencil.fore else 0.5 * stencil.third
    return third_at(stencil, i)


@helper
def third_at(stencil: Stencil, i: int) -> float:
    """Return the weight of the third difference at the east face of column i."""
    return stencil.third if i < stencil.fore else 0.5 * stencil.third
