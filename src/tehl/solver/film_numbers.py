"""Central and minimum film from the nodes of a grid."""

import numpy as np

from tehl.grid import Grid
from tehl.result import FilmSummary
from tehl.typing import Array


def central_value(grid: Grid, field: Array) -> float:
    """Return ``field`` at X = Y = 0: the node there, else cubic interpolation."""
    columns, column_weights = _lagrange(grid.x, grid.dx)
    if grid.mirror:
        return float(field[0, columns] @ column_weights)
    rows, row_weights = _lagrange(grid.y, grid.dy)
    return float(row_weights @ field[np.ix_(rows, columns)] @ column_weights)


def _lagrange(nodes: Array, spacing: float) -> tuple[Array, Array]:
    """Nodes next to 0 and their weights: one where it is a node, else four, to third order."""
    place = -float(nodes[0]) / spacing
    nearest = round(place)
    if abs(place - nearest) < 1e-9:
        return np.array([nearest]), np.ones(1)
    first = int(np.clip(np.floor(place) - 1, 0, len(nodes) - 4))
    offsets = place - first - np.arange(4.0)
    weights = np.array(
        [np.prod([offsets[m] / (k - m) for m in range(4) if m != k]) for k in range(4)]
    )
    return first + np.arange(4), weights


def film_summary(grid: Grid, film: Array) -> FilmSummary:
    """Return central and minimum film; the minimum by a quadratic through its neighbours.

    Parameters
    ----------
    grid : Grid
        Where ``film`` lives.
    film : array of ``grid.shape``
        H [-].
    """
    j, i = np.unravel_index(int(film.argmin()), film.shape)
    node = float(film[j, i])
    value, (shift_y, shift_x) = node, (0.0, 0.0)
    patch = _patch(film, int(j), int(i), grid.mirror)
    if patch is not None:
        value, (shift_y, shift_x) = quadratic_minimum(patch)
    return FilmSummary(
        central=central_value(grid, film),
        minimum=min(value, node),
        minimum_node=node,
        minimum_at=(
            float(grid.x[i] + shift_x * grid.dx),
            abs(float(grid.y[j] + shift_y * grid.dy))
            if grid.mirror
            else float(grid.y[j] + shift_y * grid.dy),
        ),
    )


def _patch(film: Array, j: int, i: int, mirror: bool) -> Array | None:
    """Three by three nodes around (j, i), None where they do not exist."""
    ny, nx = film.shape
    rows = [abs(j - 1), j, j + 1] if mirror else [j - 1, j, j + 1]
    if rows[0] < 0 or rows[2] >= ny or i < 1 or i > nx - 2:
        return None
    return film[np.ix_(rows, [i - 1, i, i + 1])]


def quadratic_minimum(patch: Array) -> tuple[float, tuple[float, float]]:
    """Return the minimum of the least-squares quadratic through 3 x 3 values, and where it is.

    The quadratic goes through the central value in the mean; where it has no minimum within one
    mesh width, the central value is returned.
    """
    y, x = np.mgrid[-1.0:2.0, -1.0:2.0]
    basis = np.stack([np.ones(9), x.ravel(), y.ravel(), *_squares(x.ravel(), y.ravel())], axis=1)
    weights = np.sqrt(np.array([1, 2, 1, 2, 4, 2, 1, 2, 1.0]))
    c, cx, cy, cxx, cxy, cyy = np.linalg.lstsq(
        basis * weights[:, None], patch.ravel() * weights, rcond=None
    )[0]
    hessian = np.array([[2 * cxx, cxy], [cxy, 2 * cyy]])
    node = float(patch[1, 1])
    if not (hessian[0, 0] > 0 and np.linalg.det(hessian) > 0):
        return node, (0.0, 0.0)
    shift = -np.linalg.solve(hessian, [cx, cy])
    if not np.abs(shift).max() <= 1.0:
        return node, (0.0, 0.0)
    depth = 0.5 * (cx * shift[0] + cy * shift[1])
    return node + float(depth), (float(shift[1]), float(shift[0]))


def _squares(x: Array, y: Array) -> tuple[Array, Array, Array]:
    return x * x, x * y, y * y
