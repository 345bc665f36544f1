"""Grids, axis 0 along y and axis 1 along x, and their hierarchy by halving.

They are uniform, but for the lines of some rollers.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from tehl.base.typing import Array
from tehl.contact.options import ROLLER_ENDS, Domain

LONG_STRETCH = 5.0
"""Length of a cell along y over that along x beyond which columns are halved before lines: an error
that changes from line to line is smooth along x there, and a grid with fewer lines lacks it."""
LEAST_INTERVALS, LEAST_OF_PIECE = 16, 4
"""Fewest intervals of a coarsest grid, and across one that goes on beyond its sides: there fewer
lines are coarser waves alone."""
SHORT_STRETCH, CROWDED_STRETCH = 0.5, 3.0
"""That length below which a cycle halves lines before columns; the second where lines crowd at the
ends of a roller, so that cells are never shorter than wide: on 65 x 257 nodes of a short one (12
widths, M = 142) each sweep doubles the error, as lines solved apart are coupled by flow across."""
LEAST_LINES, LEAST_CROWDED = 12, 24
"""Fewest stored intervals across a coarsest grid with long cells: with 253 unknowns for the 625 of
16 intervals, seven contacts of bearings take as many cycles. Where lines crowd at the ends of a
roller: with half as many the ends of lundberg profiles lack lines, and the cycles end at a residual
of 1e-5. Only beside columns that halve twice or more: bars compare three grids."""
END_CELL, SHORTEST_CELL, LEAST_PART = 5.2, 0.6, 0.002
"""Length of the cells where a roller ends or leaves the raceway over their width and the root of
the central film: the valley before a loaded end is as wide as 0.7 of that root. With 5 cycles of a
tilted logarithmic profile (M = 50) stall on 1025 x 513 nodes; with 6.5 the thinnest film errs by
4 % in place of 2 on 65 x 65 (M = 10), by 1 % in place of 0.3 on 257 x 129 (M = 50). Least length
over the width: with 0.3 those of heavy loads (M = 150) diverge. Least part of the mean distance of
lines that it may be."""
OUTSIDE_GROWTH, PLACING_HALVINGS = 3.0, 60
"""Growth of cells beyond the loaded part of a roller over that within it, as nothing flows there;
halvings that find a place or a width to rounding."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Grid:
    """Uniform nodes on a rectangle, or on its upper half if the contact is symmetric in y."""

    nx: int
    ny: int
    """Nodes per direction of the full domain; a line contact has one row."""
    domain: Domain
    """In Hertz half-widths."""
    mirror: bool
    """Only y >= 0 is stored; row 0 is the symmetry line."""
    wraps: bool = False
    """The film goes on beyond the last row with that of the first one, which it is again."""
    crowding: float = 0.0
    """c of the lines of a roller, which crowd at two places: their density is the sum of
    (w^2 + (Y - e)^2)^(-1/2) over both, w = 1/tanh(c) - 1, so that they are uniform about each;
    uniform everywhere if zero."""
    edges: tuple[float, float] = (1.0, 1.0)
    """e of both places: the loaded part is -e_1 < Y < e_2."""
    most_apart: float = math.inf
    """Largest distance of such lines in the loaded part over the mean one: waves limit it."""

    @property
    def dx(self) -> float:
        """Mesh width along x, in a_x."""
        return (self.domain.x[1] - self.domain.x[0]) / (self.nx - 1)

    @property
    def dy(self) -> float:
        """Mesh width along y, in a_y, the mean one; that of a single row is the whole width."""
        return (self.domain.y[1] - self.domain.y[0]) / max(self.ny - 1, 1)

    @property
    def largest_dy(self) -> float:
        """Largest distance of lines of the loaded part, in a_y."""
        if not self.crowding:
            return self.dy
        y, (below, above) = self.y, self.edges
        return float(np.diff(y[(y >= -below) & (y <= above)]).max())

    @property
    def points(self) -> tuple[int, int]:
        """Nodes (nx, ny) of the full domain."""
        return self.nx, self.ny

    @property
    def shape(self) -> tuple[int, int]:
        """Stored rows and columns."""
        return (self.ny // 2 + 1 if self.mirror else self.ny), self.nx

    @property
    def x(self) -> Array:
        """Coordinates of the columns, (nx,)."""
        return self.domain.x[0] + self.dx * np.arange(float(self.nx))

    @property
    def y(self) -> Array:
        """Coordinates of the stored rows."""
        start = 0.0 if self.mirror or self.ny == 1 else self.domain.y[0]
        found: Array = start + self.dy * np.arange(float(self.shape[0]))
        return _placed(self) if self.crowding else found

    @property
    def faces(self) -> Array:
        """Y of the faces of the cells of the stored rows, (rows + 1,); ends are faces."""
        y = self.y
        first = -0.5 * y[1] if self.mirror else y[0]
        return np.concatenate([[first], 0.5 * (y[1:] + y[:-1]), y[-1:]])

    @property
    def centres(self) -> Array:
        """Y of the middles of the cells of the stored rows, (rows,)."""
        faces = self.faces
        found: Array = 0.5 * (faces[1:] + faces[:-1])
        return found

    @property
    def inner(self) -> tuple[slice, slice]:
        """Rows and columns of the nodes that are on no edge; the row of a line is on none."""
        rows = slice(0 if self.mirror or self.ny == 1 else 1, max(self.shape[0] - 1, 1))
        return slice(None) if self.is_closed else rows, slice(1, self.nx - 1)

    @property
    def edge_rows(self) -> tuple[int, ...]:
        """Stored rows on side edges, where nothing is solved; lines and rollers have none."""
        if self.ny == 1 or self.is_closed:
            return ()
        return (-1,) if self.mirror else (0, -1)

    @property
    def is_closed(self) -> bool:
        """Whether it ends with a roller: its first and last lines have half a width and no edge."""
        return self.domain.y == ROLLER_ENDS and self.ny > 1

    @property
    def across(self) -> tuple[Array, Array]:
        """Weights of the differences to the rows south and north over uniform ones, (rows,) each.

        dy^2 over the width of the cell and the distance of the rows; without elements if uniform.
        At ends and symmetry lines both rows are one.
        """
        if self.crowding == 0.0:
            return np.zeros(0), np.zeros(0)
        steps, cells = np.diff(self.y), np.diff(self.faces)
        south = self.dy**2 / (cells * np.append(steps[:1], steps))
        north = self.dy**2 / (cells * np.append(steps, steps[-1:]))
        south[-1] *= 0.5  # the end counts twice, for its own half
        north[-1] *= 0.5
        if not self.mirror:
            south[0] *= 0.5
            north[0] *= 0.5
        return south, north

    @property
    def widths(self) -> Array:
        """Width that each stored line stands for, in a_y, (rows,): half of it on both ends."""
        if self.ny == 1:
            return np.array([self.dy])
        if self.crowding:
            found = np.diff(self.faces)
            found[1:] *= 2.0 if self.mirror else 1.0
            return found
        found = np.full(self.shape[0], (2.0 if self.mirror else 1.0) * self.dy)
        found[[0, -1]] *= 0.5
        return found

    def beyond(self, field: Array, rows: int) -> tuple[Array, Array]:
        """Return the rows of a field before its first one and behind its last one, from south on.

        None where the field ends, images at symmetry lines and closed ends, those of the other end
        where the film wraps.

        Parameters
        ----------
        field : Array
            Values of the stored rows, even about symmetry lines.
        rows : int
            On each side.
        """
        if self.wraps:
            return field[-1 - rows : -1], field[1 : rows + 1]
        before = field[rows:0:-1] if self.mirror or self.is_closed else field[:0]
        return before, field[-2 : -2 - rows : -1] if self.is_closed else field[:0]

    def unfold(self, field: Array) -> Array:
        """Return ``field`` on the full domain, (ny, nx)."""
        return np.concatenate([field[:0:-1], field]) if self.mirror else field.copy()

    def coarser(self) -> "Grid":
        """Return the grid of twice the mesh width."""
        return replace(self, nx=self.nx // 2 + 1, ny=self.ny // 2 + 1)

    def finer(self) -> "Grid":
        """Return the grid of half the mesh width."""
        return replace(self, nx=2 * self.nx - 1, ny=2 * self.ny - 1)

    def can_coarsen(self) -> bool:
        """Whether both directions halve to 16 intervals or more, and the half domain still can.

        A line contact halves along x alone.
        """
        intervals = (self.nx - 1, self.ny - 1) if self.ny > 1 else (self.nx - 1,)
        even = all(n % 2 == 0 and n // 2 >= 16 for n in intervals)
        return even and not (self.mirror and (self.ny - 1) // 2 % 2)


def can_mirror(shape: tuple[int, int], domain: Domain) -> bool:
    """Whether every grid of the hierarchy can store the upper half of ``domain`` only.

    ``shape`` is (ny, nx) of the finest grid; y = 0 must be a row of the coarsest one too.

    Parameters
    ----------
    shape : (int, int)
        Nodes (ny, nx) of the finest grid over the whole domain.
    domain : Domain
        Its edges along y must be symmetric.
    """
    ny, nx = shape
    coarsest = halved_grids(Grid(nx=nx, ny=ny, domain=domain, mirror=False))[0]
    return (coarsest.ny - 1) % 2 == 0 and domain.y[0] == -domain.y[1]


def crowding(
    part: float, edges: tuple[float, float] = (1.0, 1.0), most_apart: float = math.inf
) -> float:
    """Return c of lines that crowd where the loaded part of a roller ends; zero if they do not.

    Parameters
    ----------
    part : float
        Distance of lines there over that of uniform ones; `LEAST_PART` at least.
    edges, most_apart : (float, float), float
        As of `Grid`.
    """
    part, low, high = max(part, LEAST_PART), 0.0, 8.0
    if part >= 1.0 or most_apart <= 1.0:
        return 0.0
    for _ in range(PLACING_HALVINGS):
        found = 0.5 * (low + high)
        least, most = distances(found, edges)
        low, high = (found, high) if least > part and most < most_apart else (low, found)
    return low


def distances(crowding: float, edges: tuple[float, float]) -> tuple[float, float]:
    """Return the least and the largest distance of lines of the loaded part over the mean one.

    Parameters
    ----------
    crowding, edges : float, (float, float)
        As of `Grid`.
    """
    width = 2.0 / math.expm1(2.0 * crowding)
    below, middle, above = _number(np.array([-1.0, 0.0, 1.0]), width, edges)
    sides = np.array([middle - below, above - middle])
    density = 1.0 / width + 1.0 / math.hypot(width, sum(edges))
    rarest = 0.5 * (edges[1] - edges[0])  # there the fewest lines are, of those on its side of 0
    y = np.array([min(rarest, 0.0), max(rarest, 0.0)])
    rare = 1.0 / np.hypot(width, edges[1] - y) + 1.0 / np.hypot(width, edges[0] + y)
    return float(sides.min() / density), float((sides / rare).max())


def _number(y: Array, width: float, edges: tuple[float, float]) -> Array:
    """Return the number of a line at Y, not scaled: the integral of the density of lines.

    The sum of (w^2 + t^2)^(-1/2) over both places, t the distance from them within the loaded part
    and `OUTSIDE_GROWTH` times that outside of it. Differences between lines whose distance
    changes by the part r from one to the next err by r times their distance: with 1/(w + t) that is
    most where the film is thinnest.
    """

    def one(beyond: Array) -> Array:
        outside = np.arcsinh(OUTSIDE_GROWTH * np.maximum(beyond, 0.0) / width) / OUTSIDE_GROWTH
        return outside - np.arcsinh(np.maximum(-beyond, 0.0) / width)

    return one(y - edges[1]) - one(-y - edges[0])


@lru_cache(maxsize=64)
def _placed(grid: Grid) -> Array:
    """Return Y of the stored rows of a grid whose lines crowd, read-only.

    Half of the lines lie on each side of Y = 0, so that halved grids share their lines.
    """
    numbers = np.linspace(0.0 if grid.mirror else -1.0, 1.0, grid.shape[0])
    width, edges = 2.0 / math.expm1(2.0 * grid.crowding), grid.edges
    below, middle, above = _number(np.array([-1.0, 0.0, 1.0]), width, edges)
    wanted = middle + np.where(numbers < 0.0, middle - below, above - middle) * numbers
    low, high = np.minimum(np.sign(numbers), 0.0), np.maximum(np.sign(numbers), 0.0)
    for _ in range(PLACING_HALVINGS):
        y = 0.5 * (low + high)
        is_below = _number(y, width, edges) < wanted
        low, high = np.where(is_below, y, low), np.where(is_below, high, y)
    y = np.where(np.abs(numbers) == 1.0, numbers, 0.5 * (low + high))
    y.flags.writeable = False
    return y


def halved_grids(finest: Grid) -> list[Grid]:
    """Return the grids by halving, coarsest first."""
    grids = [finest]
    while grids[0].can_coarsen():
        grids.insert(0, grids[0].coarser())
    return grids


def coarsest_of(finest: Grid, widest: float, *, goes_on: bool = False) -> Grid:
    """Return the coarsest grid of one with long cells: another one than that of the result.

    Parameters
    ----------
    finest : Grid
        The grid of the result.
    widest : float
        Largest mesh width along x [half-widths], unless no grid is coarser.
    goes_on : bool
        Whether the contact goes on beyond its sides.
    """
    grid = finest
    while (half := halved(grid, (1, 0))) and (half.dx <= widest or grid is finest):
        grid = half
    is_fine = finest.crowding > 0.0 and 4 * (grid.nx - 1) < finest.nx
    least = LEAST_CROWDED if is_fine else LEAST_LINES
    least = LEAST_OF_PIECE // 2 if goes_on else least
    while (half := halved(grid, (0, 1))) and half.shape[0] > least:
        grid = half
    return grid


def halved(grid: Grid, axes: tuple[int, int]) -> Grid | None:
    """Return the grid with columns or lines halved, None if that leaves less than 16 intervals.

    Parameters
    ----------
    grid : Grid
        With intervals along x and y.
    axes : (int, int)
        1 for x and y if it is halved.
    """
    nx, ny = ((n - 1) >> axis for n, axis in zip(grid.points, axes, strict=True))
    odd = any((n - 1) % 2 and axis for n, axis in zip(grid.points, axes, strict=True))
    fewest = LEAST_OF_PIECE if grid.is_closed else LEAST_INTERVALS  # along y
    if odd or nx < LEAST_INTERVALS or ny < fewest or (grid.mirror and ny % 2):
        return None
    return replace(grid, nx=nx + 1, ny=ny + 1)


def has_long_cells(grid: Grid, ellipticity: float, *, touches: bool) -> bool:
    """Whether cycles halve columns before lines: on rollers, and on cells much longer along y.

    Parameters
    ----------
    grid : Grid
        The finest one.
    ellipticity : float
        a_y/a_x of the contact.
    touches : bool
        Asperities below the grid carry load, see `is_long` of the relaxation.
    """
    stretch = ellipticity * grid.dy / grid.dx
    return grid.is_closed or (grid.ny > 1 and stretch > LONG_STRETCH and not touches)


def long_grids(finest: Grid, coarsest: Grid, ellipticity: float | None = None) -> list[Grid]:
    """Return the grids where cells are long, coarsest first.

    The last ones of full multigrid differ by halving both columns and lines, so that they show the
    order of the errors; before them comes what is left of one of both. A cycle halves columns
    first, but lines where cells are shorter along y.

    Parameters
    ----------
    finest, coarsest : Grid
        The ends of the list.
    ellipticity : float or None
        a_y/a_x of the contact, for a cycle.
    """
    grids = [finest]
    while grids[0] != coarsest:
        columns, lines = (a > b for a, b in zip(grids[0].points, coarsest.points, strict=True))
        if ellipticity is not None and columns and lines:
            stretch = CROWDED_STRETCH if finest.crowding else SHORT_STRETCH
            columns = ellipticity * grids[0].dy >= stretch * grids[0].dx
            lines = not columns
        half = halved(grids[0], (int(columns), int(lines)))
        assert half is not None  # the coarsest grid follows by halving
        grids.insert(0, half)
    return grids
