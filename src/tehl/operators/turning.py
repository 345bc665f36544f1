"""Surfaces that spin: their mean speeds, and the wedge of the oil that they carry along y.

Both are those of `tehl.kernels.turning` (docs/theory/directions.md, spin).
"""

from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import slowing, spin_number
from tehl.kernels.faces import Stencil
from tehl.kernels.properties import Film
from tehl.kernels.reynolds import operator
from tehl.operators.influence import Influence
from tehl.operators.reynolds import INFLUENCE_NODES


class Entrainment(NamedTuple):
    """Mean speeds of the surfaces, as `tehl.kernels.properties.Film` has them."""

    speed: Array
    drift: Array


ALONG_X = Entrainment(np.zeros(0), np.zeros((0, 0)))
"""That of surfaces that do not spin; and in a time step, which follows the oil."""


def entrainment(grid: Grid, scaled: ScaledProblem) -> Entrainment:
    """Return the mean speeds of surfaces that spin; without elements if they do not.

    With the spin S = omega a_x/u_m of the mean motion and the speed u_0 of the moment they are
    u = u_0 - S kappa Y along x and v = S X along y. The end lines of a roller have half a width, so
    that what enters there counts twice (docs/theory/rollers.md, spin).

    Parameters
    ----------
    grid, scaled : Grid, ScaledProblem
        Nodes, and the contact with its motion.
    """
    if (spin := spin_number(scaled)) == 0.0:
        return ALONG_X
    across = grid.dx / (scaled.groups.ellipticity * grid.dy)
    close = grid.dy / np.gradient(grid.y) if grid.crowding else np.ones(grid.shape[0])
    drift = spin * across * close[:, None] * grid.x
    if grid.is_closed:
        drift[0] *= np.where(drift[0] > 0.0, 2.0, 1.0)
        drift[-1] *= np.where(drift[-1] < 0.0, 2.0, 1.0)
    return Entrainment(scaled.moment.speed - slowing(scaled, grid.y), drift)


def turning_wedge(mass: Array, ways: Entrainment, stencil: Stencil, marks: Film) -> Array:
    """Return the upstream difference of the mass rho H where the surfaces spin, zero on the edges.

    Parameters
    ----------
    mass : (ny, nx) array
        rho H, or the oil of partly filled nodes [-].
    ways : Entrainment
        Mean speeds of the surfaces.
    stencil : Stencil
        Weights of the steady operator.
    marks : Film
        Its ``partial`` and ``second``, if it has them, choose the orders of the fluxes; its
        ``layer`` enters through closed ends, as far as its film at the end passes it on.
    """
    nothing = np.zeros_like(mass)
    film = Film(nothing, mass, nothing, np.ones_like(mass), *(nothing,) * 3, **ways._asdict())
    if marks.partial.size:
        second = np.where(marks.partial > 0, 0, marks.second).astype(np.uint8)
        film = film._replace(partial=marks.partial, second=second, held=mass)
    found = np.empty_like(mass)
    operator(film, stencil, found)
    found = -found
    if marks.layer.size:
        for end, after, inwards in ((0, 1, 1.0), (-1, -2, -1.0)):
            drift = np.maximum(inwards * ways.drift[end], 0.0)
            found[end] += drift * _end_loss(mass, stencil, marks, (end, after))
    return found


def _end_loss(mass: Array, stencil: Stencil, marks: Film, rows: tuple[int, int]) -> Array:
    """Return what an end line passes on beyond what enters there, over its speed, (nx,).

    ``rows``: that line and the next one. As of `tehl.kernels.turning.passed_on`.
    """
    (end, after), full, own = rows, marks.rho * marks.h, marks.partial[rows[0]] > 0
    second = (marks.second[after] > 0) & (marks.partial[after] == 0) & (stencil.w2 > 0.0)
    passed = np.where(second, 0.5 * (full[end] + full[after]), full[end])
    lost = np.where(own, mass[end], passed) - np.minimum(marks.layer[end], passed)
    lost[[0, -1]] = 0.0
    return np.asarray((stencil.w0 - stencil.w2) * lost)


def curved_influence(influence: Influence, stencil: Stencil, parts: tuple[float, float]) -> Array:
    """Return the wedge along y, over rho and drift, of the film of a point and a dipole, (2, n).

    Parameters
    ----------
    influence, stencil : Influence, Stencil
        Of the grid.
    parts : (float, float)
        As of `line_influence`.
    """
    along, aside = parts
    columns = np.abs(np.arange(-1, INFLUENCE_NODES + 1))
    table = influence(np.arange(4)[:, None], columns)  # rows at distances 0 to 3
    point, beyond = table[:3, 1:-1], table[1:4, 1:-1]
    before = table[[1, 0, 1], 1:-1]
    dipole = point - along * (table[:3, :-2] + table[:3, 2:]) - aside * (before + beyond)
    weights = np.array([stencil.w0, stencil.w1, stencil.w2])[:, None]
    return np.array([(weights * film).sum(axis=0) for film in (point, dipole)])
