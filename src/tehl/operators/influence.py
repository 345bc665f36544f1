"""Deflection of the elastic half-space by a uniform pressure on one mesh cell, in closed form.

Love 1929; Johnson 1985, Contact Mechanics, eqs 3.25 and 2.24. Each node carries a uniform pressure
over its own cell, so the only error of the discrete deflection is that of the stepped pressure.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from tehl.base.typing import Array
from tehl.contact.shape import LINE
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Influence:
    """Deflection at node offsets (dj, di) per unit pressure on one cell; at (0, 0) ``self_film``.

    Parameters
    ----------
    dx, dy : float
        Cell sides [a_x].
    factor : float
        2 Pi / pi of the integral in docs/theory/model.md; its kappa is in ``dy`` = kappa dY [-].
    """

    def __init__(self, dx: float, dy: float, factor: float) -> None:
        self.dx, self.dy, self.factor = dx, dy, factor
        self.self_film = float(self(0, 0))

    def __call__(self, dj: "ArrayLike | slice", di: "ArrayLike | slice") -> Array:
        """Return the influence at offsets of ``dj`` rows and ``di`` columns; slices are ranges."""
        rows, columns = _offsets(dj), _offsets(di)
        x, y = np.broadcast_arrays(self.dx * columns, self.dy * rows)
        east, west = x + 0.5 * self.dx, x - 0.5 * self.dx
        north, south = y + 0.5 * self.dy, y - 0.5 * self.dy
        cell = _corner(east, north) - _corner(west, north)
        cell += _corner(west, south) - _corner(east, south)
        return self.factor * cell

    def table(self, rows: int, columns: int) -> Array:
        """Return the influence at offsets 0 to ``rows`` - 1 and 0 to ``columns`` - 1.

        The same as a call, but with one evaluation per corner, which four cells share.

        Parameters
        ----------
        rows, columns : int
            Number of offsets along y and along x.
        """
        u = self.dx * (np.arange(columns + 1.0) - 0.5)
        v = self.dy * (np.arange(rows + 1.0) - 0.5)[:, None]
        cells: Array = np.diff(np.diff(_corner(u, v), axis=0), axis=1)
        return self.factor * cells

    def between(self, grid: Grid) -> Array:
        """Return the influence of the cells of lines that crowd, (to, from, column offset).

        Those of the ends have half a width; on half a domain with the mirror image.
        """
        places = self.dy / grid.dy * grid.y
        lines = self.on_lines(grid, places, self.dy / grid.dy * grid.faces)
        if grid.mirror:
            lines[:, 1:] += self.on_lines(grid, -places, self.dy / grid.dy * grid.faces[1:])
        return np.ascontiguousarray(reciprocal(lines.transpose(2, 0, 1), grid).transpose(1, 2, 0))

    def on_lines(self, grid: Grid, places: Array, faces: Array, stride: int = 1) -> Array:
        """Return the influence of cells on places at some of the offsets along x.

        Before `reciprocal`: at the node, wherever it lies in its cell.

        Parameters
        ----------
        grid : Grid
            Its columns.
        places, faces : Array
            y of the places, and of the faces between the cells [a_x].
        stride : int
            Distance of the offsets, from zero to the width of the grid [mesh widths].

        Returns
        -------
        array (places, faces - 1, offsets)
        """
        v = (faces - places[:, None])[:, :, None]
        if stride == 1:
            corners = _corner(self.dx * (np.arange(grid.nx + 1.0) - 0.5), v)
            cells: Array = np.diff(np.diff(corners, axis=2), axis=1)
        else:
            x = self.dx * np.arange(0.0, grid.nx, stride)
            cells = np.diff(_corner(x + 0.5 * self.dx, v) - _corner(x - 0.5 * self.dx, v), axis=1)
        return self.factor * cells

    def beside(self, grid: Grid, reach: int, columns: int) -> Array:
        """Return the influence of lines that crowd on those near them.

        Parameters
        ----------
        grid : Grid
            Its lines.
        reach, columns : int
            Most lines between both, and offsets along them from zero on.

        Returns
        -------
        array (2 reach + 1, rows, columns)
            Of the lines to the south, of itself, and of those to the north; zero beyond ends. Lines
            beyond a symmetry line count as others.
        """
        stretch, y, faces = self.dy / grid.dy, grid.y, grid.faces
        images = np.zeros(0), np.zeros(0)
        if grid.mirror:
            images = -faces[:1:-1], -y[:0:-1]
        faces, first = np.concatenate([images[0], faces]), images[1].size
        u = self.dx * (np.arange(columns + 1.0) - 0.5)
        found = np.zeros((2 * reach + 1, y.size, columns))
        for number, offset in enumerate(range(-reach, reach + 1)):
            of = first + np.arange(y.size) + offset
            inside = (of >= 0) & (of < faces.size - 1)
            low, high = (
                _corner(u, (stretch * (faces[of[inside] + end] - y[inside]))[:, None])
                for end in (0, 1)
            )
            found[number, inside] = self.factor * np.diff(high - low, axis=1)
        return found


class LineInfluence(Influence):
    """Influence in a line contact: -ln x^2 in place of 1/r; other rows than its own have none.

    Parameters
    ----------
    dx, factor : float
        Width of a cell [b], and 2 Pi / pi [-].
    """

    def __init__(self, dx: float, factor: float) -> None:
        super().__init__(dx, math.inf, factor)

    def __call__(self, dj: "ArrayLike | slice", di: "ArrayLike | slice") -> Array:
        """Return the influence at offsets of ``dj`` rows and ``di`` columns; slices are ranges."""
        x, row = self.dx * _offsets(di), _offsets(dj)
        cell = -2.0 * (_end(x + 0.5 * self.dx) - _end(x - 0.5 * self.dx))
        found: Array = np.where(row == 0.0, self.factor * cell, 0.0)
        return found

    def table(self, rows: int, columns: int) -> Array:
        """Return the influence at offsets 0 to ``rows`` - 1 and 0 to ``columns`` - 1."""
        return self(np.arange(rows)[:, None], np.arange(columns)[None, :])


class PeriodicInfluence(Influence):
    """Influence of a cell and its images, where all goes on along y, mirrored or wrapping.

    Together the lines of a period are a `LineInfluence`, which fixes the constant of the sum.

    Parameters
    ----------
    dx, dy, factor : float
        As of `Influence`.
    lines : int
        Lines of a period: twice the distance of mirrors, and that of ends which wrap.
    """

    IMAGES = 8
    """Images on each side that are summed one by one: the others, as points, by an integral."""

    def __init__(self, dx: float, dy: float, factor: float, lines: int) -> None:
        self.lines = lines
        super().__init__(dx, dy, factor)

    def __call__(self, dj: "ArrayLike | slice", di: "ArrayLike | slice") -> Array:
        """Return the influence at offsets of ``dj`` rows and ``di`` columns; slices are ranges."""
        rows, columns = np.broadcast_arrays(_offsets(dj), _offsets(di))
        images = self.lines * np.arange(-self.IMAGES, self.IMAGES + 1.0)
        near = sum(super(PeriodicInfluence, self).__call__(rows + far, columns) for far in images)
        return np.asarray(near + self._far(rows, columns))

    def _far(self, rows: Array, columns: Array) -> Array:
        r"""Return the influence of the images beyond.

        With D their distance, from m = n + 1 on, and Y = (n + 1/2) D + y

        .. math:: \sum \frac{1}{\sqrt{x^2 + (m D + y)^2}} =
                  -\frac{1}{D} \ln(Y + \sqrt{x^2 + Y^2}) - \frac{D Y}{24 (x^2 + Y^2)^{3/2}},

        less a constant.
        """
        distance, far = self.dy * self.lines, np.zeros(rows.shape)
        for sign in (-1.0, 1.0):
            y = (self.IMAGES + 0.5) * distance + sign * self.dy * rows
            r = np.hypot(self.dx * columns, y)
            far -= np.log(y + r) / distance + distance * y / (24.0 * r**3)
        return self.factor * self.dx * self.dy * far

    def table(self, rows: int, columns: int) -> Array:
        """Return the influence at offsets 0 to ``rows`` - 1 and 0 to ``columns`` - 1."""
        offsets = np.arange(rows)
        found = self._far(*np.broadcast_arrays(offsets[:, None], np.arange(columns)))
        whole = super().table(rows + self.IMAGES * self.lines, columns)
        for image in range(-self.IMAGES, self.IMAGES + 1):
            found += whole[np.abs(offsets + image * self.lines)]
        return np.asarray(found)

    def matrix(self, grid: Grid) -> Array:
        """Return the film at each node per unit pressure of each node and its images, (n, n).

        The first row of a film that wraps has all of the line that is its last one too.
        """
        ny, nx = grid.shape
        rows, i = np.arange(ny), np.arange(nx)
        table = self.table(ny, nx)
        apart = np.abs(rows[:, None] - rows)
        lines = table[np.minimum(apart, self.lines - apart)]
        if grid.wraps:
            lines[:, -1] = 0.0
        else:
            images = rows[:, None] + rows[1:-1]  # those of the sides are their own
            lines[:, 1:-1] += table[np.minimum(images, self.lines - images)]
        blocks = lines[:, :, np.abs(i[:, None] - i)].transpose(0, 2, 1, 3)
        return np.asarray(blocks.reshape(2 * (ny * nx,)))


def reciprocal(lines: Array, grid: Grid) -> Array:
    """Return influences of lines that crowd whose work on each other is the same both ways.

    So the deflection makes no moment. Those on the ends, which are not in the middle of their
    cells, stay as they are.

    Parameters
    ----------
    lines : (n, rows, rows) array
        Influence on each line of each other one (`Influence.on_lines`), or parts of it.
    grid : Grid
        With the widths of the lines.
    """
    work = lines * grid.widths[:, None]
    found = 0.5 * (work + work.transpose(0, 2, 1)) / grid.widths[:, None]
    ends = [-1] if grid.mirror else [0, -1]
    found[:, ends] = lines[:, ends]
    return np.asarray(found)


def _end(x: Array) -> Array:
    """Antiderivative of ln |x|; x is not zero, as the ends of cells lie between nodes."""
    found: Array = x * (np.log(np.abs(x)) - 1.0)
    return found


def _offsets(nodes: "ArrayLike | slice") -> Array:
    if isinstance(nodes, slice):
        return np.arange(nodes.start, nodes.stop, dtype=float)
    return np.asarray(nodes, dtype=float)


def _corner(u: Array, v: Array) -> Array:
    """Antiderivative of 1/r over both coordinates; u is not zero, v is only at ends."""
    least = np.where(v == 0.0, 1.0, np.abs(v))
    return u * np.arcsinh(v / np.abs(u)) + v * np.arcsinh(u / least)


def influence_of(grid: Grid, groups: Groups) -> Influence:
    """Return the influence function of one cell of ``grid``.

    Parameters
    ----------
    grid : Grid
        Its mesh widths are in Hertz half-widths.
    groups : Groups
        Shape, of which kappa stretches the widths along y, and the factor 2 Pi / pi.
    """
    if groups.shape is LINE:
        return LineInfluence(grid.dx, groups.deflection_factor)
    if groups.shape.goes_on:
        dy, lines = groups.ellipticity * grid.dy, (grid.shape[0] - 1) * (1 if grid.wraps else 2)
        return PeriodicInfluence(grid.dx, dy, groups.deflection_factor, lines)
    return Influence(grid.dx, groups.ellipticity * grid.dy, groups.deflection_factor)


def matrix_of(grid: Grid, influence: Influence) -> Array:
    """Return the film at each node of a grid per unit pressure of each node, (n, n).

    Parameters
    ----------
    grid, influence : Grid, Influence
        The nodes, and the influence at their offsets.
    """
    if grid.crowding:
        lines, i = influence.between(grid), np.arange(grid.nx)
        blocks = lines[:, :, np.abs(i[:, None] - i)].transpose(0, 2, 1, 3)
        return blocks.reshape(2 * (lines.shape[0] * grid.nx,))
    if isinstance(influence, PeriodicInfluence):
        return influence.matrix(grid)
    found = dense_matrix(grid.shape, grid.mirror, influence)
    if grid.is_closed:  # as in `tehl.operators.deformation.BetweenEnds`
        found[:, -grid.nx :] *= 0.5
        found[:, : grid.nx] *= 1.0 if grid.mirror else 0.5
    return found


def dense_matrix(
    shape: tuple[int, int], mirror: bool, influence: Influence, stride: tuple[int, int] = (1, 1)
) -> Array:
    """Return the influence of node k on node m, nodes numbered row by row, (n, n).

    Parameters
    ----------
    shape : (int, int)
        Rows and columns of nodes.
    mirror : bool
        Row 0 is a symmetry line; the mirror image of each node is included.
    influence : Influence
        Influence at node offsets.
    stride : (int, int)
        Rows and columns of ``influence`` per row and column of the nodes.
    """
    ny, nx = shape
    rows, columns = np.arange(2 * ny - 1)[:, None], np.arange(nx)[None, :]
    table = influence(stride[0] * rows, stride[1] * columns)
    i = np.arange(nx)
    lines = table[:, np.abs(i[:, None] - i)]  # of one line on another, by distance
    matrix = np.empty((ny, nx, ny, nx))
    for row in range(ny):
        for other in range(ny):
            block = matrix[row, :, other]
            block[:] = lines[abs(row - other)]
            if mirror and other:
                block += lines[row + other]
    return matrix.reshape(ny * nx, ny * nx)
