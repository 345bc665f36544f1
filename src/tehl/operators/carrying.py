"""Fields that a motion in the plane carries along, by cubic interpolation where each node was.

Motions along x alone have `tehl.operators.reynolds.carried`.
"""

import numpy as np
from scipy.sparse import csr_array

from tehl.base.typing import Array, BoolArray
from tehl.estimate.grid import Grid
from tehl.estimate.ways import Way

INNER = [5, 6, 9, 10]
"""Places, in a cubic of 4 x 4 nodes, of those around."""


class Carrier:
    """Carries fields on the full domain of one grid.

    Parameters
    ----------
    x, y : Array
        Nodes [a_x]; those along x are uniform.
    period : int
        Rows after which the film repeats itself along y; zero if it does not.
    """

    def __init__(self, x: Array, y: Array, period: int = 0) -> None:
        self.x, self.y, self.period = x, y, period
        self._last: tuple[Way, csr_array] | None = None

    def carried(self, field: Array, way: Way, limited: BoolArray | None = None) -> Array:
        """Return a field after a motion; beyond the edges it is as there.

        Parameters
        ----------
        field : Array
            Nodal values, (ny, nx).
        way : Way
            Of the motion.
        limited : (ny, nx) array of bool or None
            Where fronts of oil stay monotone: no value leaves those of the nodes around.
        """
        matrix = self.matrix(way)
        found = matrix @ field.ravel()
        if limited is not None:
            here = limited.ravel()
            near = field.ravel()[matrix.indices.reshape(found.size, -1)[here][:, INNER]]
            found[here] = np.clip(found[here], near.min(axis=1), near.max(axis=1))
        return np.asarray(found.reshape(field.shape))

    def matrix(self, way: Way) -> csr_array:
        """Return the interpolation of a field before a motion, (ny nx, ny nx)."""
        same = 1e-9 * (self.x[1] - self.x[0])
        if self._last is None or max(abs(np.subtract(way, self._last[0]))) > same:
            self._last = way, self._matrix(way)
        return self._last[1]

    def entering(self, way: Way) -> csr_array:
        """Return the same of a field that is zero beyond the edges."""
        return self._matrix(way, empty=True)

    def _matrix(self, way: Way, *, empty: bool = False) -> csr_array:
        x, y, shape = self.x, self.y, (self.y.size, self.x.size)
        there = np.broadcast_arrays(*way.back(x[None, :], y[:, None]))
        columns, along, outside = _cubic(x, there[0])
        if y.size == 1:
            rows, across = np.zeros((1, *shape), int), np.ones((1, *shape))
        elif self.period:
            rows, across = _cubic_uniform((there[1] - y[0]) / (y[1] - y[0]))
            rows = rows % self.period
        else:
            rows, across, aside = _cubic(y, there[1])
            outside = outside | aside
        weights = across[:, None] * along[None]
        if empty:
            weights = np.where(outside, 0.0, weights)
        nodes = rows[:, None] * x.size + columns[None]
        count, size = len(rows) * len(columns), x.size * y.size
        ends = count * np.arange(size + 1)
        by_node = (part.reshape(count, size).T.ravel() for part in (weights, nodes))
        return csr_array((*by_node, ends), shape=(size, size))


def carrier_of(grid: Grid, stretch: float) -> Carrier:
    """Return the carrier of a grid that has no symmetry line.

    Parameters
    ----------
    grid, stretch : Grid, float
        Nodes, and kappa = a_y/a_x.
    """
    y = stretch * grid.y if grid.ny > 1 else np.zeros(1)
    return Carrier(grid.x, y, grid.shape[0] - 1 if grid.wraps else 0)


def slope_across(field: Array, grid: Grid, stretch: float) -> Array:
    """Return the central difference of a field along y, (ny, nx) [1/a_x]; zero of a line.

    Parameters
    ----------
    field : Array
        Nodal values, (ny, nx).
    grid, stretch : Grid, float
        Nodes, and kappa = a_y/a_x.
    """
    if grid.ny == 1:
        return np.zeros_like(field)
    y = stretch * grid.y
    if grid.wraps:
        south, north = grid.beyond(field, 1)
        wider = np.concatenate([south, field, north])
        return np.asarray(np.gradient(wider, float(y[1] - y[0]), axis=0)[1:-1])
    return np.asarray(np.gradient(field, y, axis=0))


def divergence_of_full(
    flux: tuple[Array, Array], grid: Grid, stretch: float, full: BoolArray
) -> Array:
    """Return the divergence of a flux that passes faces between full nodes alone, (ny, nx).

    What full nodes pass on together is what they get, as partly filled ones pass on nothing else.

    Parameters
    ----------
    flux : (Array, Array)
        Nodal values along x and y, (ny, nx).
    grid, stretch : Grid, float
        Nodes of a contact that has no symmetry line, and kappa = a_y/a_x.
    full : Array
        Which nodes are full of oil, (ny, nx).
    """
    (along, across), filled = flux, full.astype(float)
    found = _divergence(along.T, filled.T, np.full(grid.nx, grid.dx)).T
    if grid.ny == 1:
        return found
    if not grid.wraps:
        return found + _divergence(across, filled, stretch * np.diff(grid.faces))
    # the last row is the first one
    cells = np.full(grid.ny + 2, stretch * grid.dy)
    south, north = grid.beyond(across, 1)
    before, behind = grid.beyond(filled, 1)
    wider = np.concatenate([south, across, north]), np.concatenate([before, filled, behind])
    return found + _divergence(*wider, cells)[1:-1]


def _divergence(flux: Array, filled: Array, cells: Array) -> Array:
    """Return the divergence along the first axis, of cells with those widths; none at its ends."""
    faces = np.zeros((len(flux) + 1, *flux.shape[1:]))
    faces[1:-1] = 0.5 * filled[1:] * filled[:-1] * (flux[1:] + flux[:-1])
    return np.asarray(np.diff(faces, axis=0) / cells[:, None])


def _cubic(nodes: Array, places: Array) -> tuple[Array, Array, BoolArray]:
    """Return nodes and weights, (4, ...), at places, and which are outside.

    Beyond the ends of the nodes their values go on.
    """
    ends = nodes[1] - nodes[0], nodes[-1] - nodes[-2]
    reach = np.arange(1.0, 4.0)
    wider = np.concatenate([nodes[0] - ends[0] * reach[::-1], nodes, nodes[-1] + ends[1] * reach])
    rounding = 1e-9 * min(ends)
    outside = (places < nodes[0] - rounding) | (places > nodes[-1] + rounding)
    here = np.clip(places, wider[1], wider[-2])
    first = np.clip(np.searchsorted(wider, here, side="right") - 2, 0, wider.size - 4)
    known = wider[first[None] + np.arange(4).reshape(4, *(1,) * places.ndim)]
    weights = np.ones_like(known)
    for one in range(4):
        for other in range(4):
            if other != one:
                weights[one] *= (here - known[other]) / (known[one] - known[other])
    near = first[None] + np.arange(4).reshape(4, *(1,) * places.ndim) - reach.size
    return np.clip(near, 0, nodes.size - 1), weights, outside


def _cubic_uniform(places: Array) -> tuple[Array, Array]:
    """Return nodes and weights, (4, ...), of uniform nodes without ends, at places in widths."""
    first = np.floor(places).astype(int) - 1
    t = places - first - 1.0
    weights = np.array(
        [
            -t * (t - 1.0) * (t - 2.0) / 6.0,
            (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
            -(t + 1.0) * t * (t - 2.0) / 2.0,
            (t + 1.0) * t * (t - 1.0) / 6.0,
        ]
    )
    return first[None] + np.arange(4).reshape(4, *(1,) * places.ndim), weights
