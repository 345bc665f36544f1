"""Heights on a lattice, and the smooth surface between its points.

A tile is what random surfaces and measured maps become: heights at equal distances, a cubic
B-spline through them, and a rule for what lies beyond its edges.
"""

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from tehl.roughness.lowpass import KEPT, is_roomy, low_passed, low_passed_with_room, room
from tehl.roughness.protocol import direction

if TYPE_CHECKING:
    from tehl.typing import Array, IntArray

Edge = Literal["periodic", "mirror", "flat"]
"""What lies beyond the edges: the tile again, its mirror image, or nothing."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Tile:
    """Heights on a lattice.

    Attributes
    ----------
    heights : (ny, nx) array
        [m]
    pixel : (dx, dy)
        Distances of the lattice [m].
    centre : (x, y)
        Where the middle of the tile lies in the coordinates of the body [m].
    angle : float
        By which the rows are turned against x [rad], as the crests of a wave are.
    edge : {"periodic", "mirror", "flat"}
        What lies beyond the edges. Heights that are to be flat there must end at zero.
    covered : float or None
        Points that are no flat rim, over which Sq is taken, no whole number where they were of
        another lattice; None is all.
    """

    heights: "Array" = field(repr=False)
    pixel: tuple[float, float]
    centre: tuple[float, float] = (0.0, 0.0)
    angle: float = 0.0
    edge: Edge = "periodic"
    covered: float | None = None

    @property
    def size(self) -> tuple[float, float]:
        """Return the lengths of the edges [m]."""
        ny, nx = self.heights.shape
        return nx * self.pixel[0], ny * self.pixel[1]

    def at(self, x: "Array", y: "Array") -> "Array":
        """Return the heights [m] at ``x`` and ``y`` [m] of the body, which broadcast."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        cosine, sine = direction(self.angle)
        x, y = x - self.centre[0], y - self.centre[1]
        along = x * cosine - y * sine if sine else x * cosine
        across = y * cosine + x * sine if sine else y * cosine
        ny, nx = self.heights.shape
        columns = _support(along / self.pixel[0] + 0.5 * (nx - 1), nx, self.edge)
        rows = _support(across / self.pixel[1] + 0.5 * (ny - 1), ny, self.edge)
        if sine == 0 and x.ndim == y.ndim == 2 and x.shape[0] == 1 and y.shape[1] == 1:
            return _on_a_mesh(self._coefficients, rows, columns)
        total = np.zeros(np.broadcast_shapes(x.shape, y.shape))
        for row, of_row in rows:
            for column, of_column in columns:
                total += of_row * of_column * self._coefficients[row, column]
        return total

    @cached_property
    def _coefficients(self) -> "Array":
        """Coefficients of the B-spline, with a row and a column of zeros for what lies outside."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)
        from scipy import ndimage  # noqa: PLC0415

        mode = "grid-wrap" if self.edge == "periodic" else "reflect"
        inside = ndimage.spline_filter(self.heights, order=3, mode=mode)
        return np.pad(inside, ((0, 1), (0, 1)))

    def filtered(self, dx: float, dy: float) -> "Tile":
        """Return the tile without the waves that a mesh of ``dx`` by ``dy`` [m] cannot carry.

        Waves of four mesh widths and more pass whole, those of two and less not at all, with a
        cosine between; the tile itself is returned when it has nothing shorter.
        """
        cosine, sine = direction(self.angle)
        turned = sine != 0 and cosine != 0
        mesh = (max(dx, dy),) * 2 if turned else (dx, dy) if sine == 0 else (dy, dx)
        if all(0.5 * step / own <= KEPT for step, own in zip(mesh, self.pixel, strict=True)):
            return self
        if self.edge == "flat" and is_roomy(self.heights.shape, room(self.pixel, mesh)):
            return self._coarsened(mesh, radial=turned)
        tile = self._with_room(mesh) if self.edge == "flat" else self
        heights = low_passed(
            tile.heights, tile.size, mesh, periodic=self.edge == "periodic", radial=turned
        )
        return replace(tile, heights=heights)

    def _with_room(self, mesh: tuple[float, float]) -> "Tile":
        """Return the tile with a flat rim, into which filtered heights fade."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        x, y = room(self.pixel, mesh)
        covered = self.covered or self.heights.size
        return replace(self, heights=np.pad(self.heights, ((y, y), (x, x))), covered=covered)

    def _coarsened(self, mesh: tuple[float, float], *, radial: bool) -> "Tile":
        """Return the filtered tile with its rim on a lattice of a part of the mesh.

        A map whose points are nanometres apart has, on a mesh of micrometres, a rim of as many
        points as no memory holds.
        """
        heights, pixel = low_passed_with_room(self.heights, self.pixel, mesh, radial=radial)
        area = (self.covered or self.heights.size) * self.pixel[0] * self.pixel[1]
        return replace(self, heights=heights, pixel=pixel, covered=area / (pixel[0] * pixel[1]))

    @cached_property
    def mean_square(self) -> float:
        """Mean square height, without a flat rim [m^2]."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        return float(np.sum(np.square(self.heights))) / (self.covered or self.heights.size)

    @cached_property
    def wavelengths(self) -> tuple[float, float, float]:
        """Wavelengths 2 pi Sq / Sq' along x, along y and where it is shortest [m].

        Sq' is the root mean square slope in that direction, so this is the wave that is as steep
        as the surface. Infinite where the surface does not change.
        """
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        (xx, xy), (_, yy) = self._slopes()
        cosine, sine = direction(self.angle)
        turn = np.array([[cosine, sine], [-sine, cosine]])
        slopes = turn @ np.array([[xx, xy], [xy, yy]]) @ turn.T
        height = float(np.mean(np.square(self.heights)))
        steepest = float(np.linalg.eigvalsh(slopes)[-1])
        along, across, least = (
            2.0 * math.pi * math.sqrt(height / square) if square > 0 else math.inf
            for square in (float(slopes[0, 0]), float(slopes[1, 1]), steepest)
        )
        return along, across, least

    def _slopes(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the mean products of the slopes along rows and columns [-]."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        wrap = "wrap" if self.edge == "periodic" else "edge"
        heights = np.pad(self.heights, ((0, 1), (0, 1)), mode=wrap)  # type: ignore[call-overload]
        x, y = np.diff(heights, axis=1) / self.pixel[0], np.diff(heights, axis=0) / self.pixel[1]
        both = float(np.mean((x[:-1] + x[1:]) * (y[:, :-1] + y[:, 1:]))) / 4.0
        return (float(np.mean(x[:-1] ** 2)), both), (both, float(np.mean(y[:, :-1] ** 2)))


Support = list[tuple["IntArray", "Array"]]
"""Indices of the four lattice points around each place, and the weights of their splines."""


def _support(place: "Array", count: int, edge: Edge) -> Support:
    """Return which points carry each ``place``, counted in pixels, and with what weight."""
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

    first = np.floor(np.clip(place, -1e15, 1e15)).astype(np.int64)
    t = place - first
    weights = (
        (1.0 - t) ** 3 / 6.0,
        2.0 / 3.0 - t**2 * (1.0 - 0.5 * t),
        2.0 / 3.0 - (1.0 - t) ** 2 * 0.5 * (1.0 + t),
        t**3 / 6.0,
    )
    return [(_inside(first + k - 1, count, edge), weight) for k, weight in enumerate(weights)]


def _inside(index: "IntArray", count: int, edge: Edge) -> "IntArray":
    """Return indices into the lattice; ``count`` is the row or column of zeros."""
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

    if edge == "periodic":
        return index % count
    if edge == "mirror":
        folded = index % (2 * count)
        return np.minimum(folded, 2 * count - 1 - folded)
    return np.where((index >= 0) & (index < count), index, count)


def _on_a_mesh(coefficients: "Array", rows: Support, columns: Support) -> "Array":
    """Return the spline where rows and columns of a mesh cross: one axis after the other."""
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

    across = np.zeros((rows[0][0].shape[0], coefficients.shape[1]))
    for row, weight in rows:
        across += weight * coefficients[row[:, 0]]
    total = np.zeros((across.shape[0], columns[0][0].shape[1]))
    for column, weight in columns:
        total += weight * across[:, column[0]]
    return total
