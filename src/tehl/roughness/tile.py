"""Heights on a lattice, the smooth surface between its points, and what a mesh can carry of it.

A tile is what random surfaces and measured maps become: heights at equal distances, a cubic
B-spline through them, and a rule for what lies beyond its edges. Waves that a mesh cannot carry are
filtered off: those of four mesh widths and more pass, those of two and less do not, with a cosine
between.
"""

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy import fft, ndimage

from tehl.base.typing import Array, IntArray
from tehl.roughness.model import Edge, Roughness, direction

PASS_BAND, STOP_BAND = 0.25, 0.5
"""Waves per mesh width up to which all of a wave passes, and from which nothing does."""

Pair = tuple[float, float]


@dataclass(frozen=True, kw_only=True, eq=False)
class Tile(Roughness):
    """Heights on a lattice; they count as even in y only when smooth."""

    heights: Array = field(repr=False)
    """[m], (ny, nx)."""
    pixel: Pair
    """Distances (dx, dy) of the lattice [m]."""
    centre: Pair = (0.0, 0.0)
    """Middle (x, y) of the tile in the coordinates of the body [m]."""
    angle: float = 0.0
    """By which the rows are turned against x [rad], as the crests of a wave are."""
    edge: Edge = "periodic"
    """What lies beyond the edges. Heights that are to be flat there must end at zero."""
    covered: float | None = None
    """Points without a flat rim, over which Sq is taken, not a whole number where they were of
    another lattice; None is all."""

    @property
    def size(self) -> Pair:
        """Return the lengths of the edges [m]."""
        ny, nx = self.heights.shape
        return nx * self.pixel[0], ny * self.pixel[1]

    @property
    def is_smooth(self) -> bool:
        """Return whether the height is zero everywhere."""
        return not self.rms > 0

    @cached_property
    def rms(self) -> float:
        """Root mean square height Sq, without a flat rim [m]."""
        count = self.covered or self.heights.size
        return math.sqrt(float(np.sum(np.square(self.heights))) / count)

    @property
    def shortest_wavelengths(self) -> Pair:
        """Return the wavelengths 2 pi Sq / Sq' along x and along y [m]."""
        return self._wavelengths[:2]

    @property
    def shortest_wavelength(self) -> float:
        """Return the wavelength 2 pi Sq / Sq' where it is shortest [m]."""
        return self._wavelengths[2]

    def _at_rest(self, x: Array, y: Array) -> Array:
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
    def _coefficients(self) -> Array:
        """Coefficients of the B-spline, with a row and a column of zeros for what lies outside."""
        mode = "grid-wrap" if self.edge == "periodic" else "reflect"
        return np.pad(ndimage.spline_filter(self.heights, order=3, mode=mode), ((0, 1), (0, 1)))

    def resolved_on(self, dx: float, dy: float) -> "Tile":
        """Return the tile without the waves that a mesh cannot carry.

        The tile itself is returned when it has nothing shorter. For a rotated tile the larger mesh
        width counts along both axes.
        """
        cosine, sine = direction(self.angle)
        radial = sine != 0 and cosine != 0
        mesh = (max(dx, dy),) * 2 if radial else (dx, dy) if sine == 0 else (dy, dx)
        if all(0.5 * step / own <= PASS_BAND for step, own in zip(mesh, self.pixel, strict=True)):
            return self
        if self.edge == "flat":
            x, y = (
                math.ceil(6 * step / own)  # filtered heights fade into a flat rim
                for step, own in zip(mesh, self.pixel, strict=True)
            )
            if _is_roomy(self.heights.shape, (x, y)):
                return self._coarsened(mesh, (x, y), radial=radial)
            rimmed = np.pad(self.heights, ((y, y), (x, x)))
            tile = replace(self, heights=rimmed, covered=self.covered or self.heights.size)
        else:
            tile = self
        return replace(tile, heights=tile._low_passed(mesh, radial=radial))

    def _low_passed(self, mesh: Pair, *, radial: bool) -> Array:
        """Return the heights without waves that are short for a mesh [m].

        ``radial``: a wave is judged by its length, not by that along x and that along y.
        """
        (ny, nx), (width, height) = self.heights.shape, self.size
        if self.edge == "periodic":
            x, y = fft.rfftfreq(nx) * nx / width, np.abs(fft.fftfreq(ny)) * ny / height
            spectrum = fft.rfft2(self.heights) * response(x, y, mesh, radial=radial)
            return fft.irfft2(spectrum, (ny, nx))
        x, y = np.arange(nx) / (2.0 * width), np.arange(ny) / (2.0 * height)
        spectrum = fft.dctn(self.heights, type=2) * response(x, y, mesh, radial=radial)
        return fft.idctn(spectrum, type=2)

    def _coarsened(self, mesh: Pair, rim: tuple[int, int], *, radial: bool) -> "Tile":
        """Return the filtered tile with its rim on a lattice of a part of the mesh.

        A map whose points are nanometres apart would have, on a mesh of micrometres, a rim too
        large for any memory. So the few waves that pass are summed over the heights alone.
        """
        shape = self.heights.shape[::-1]
        whole = [count + 2 * points for count, points in zip(shape, rim, strict=True)]
        lengths = [count * step for count, step in zip(whole, self.pixel, strict=True)]
        kept, (nx, ny) = (
            [
                min(count, math.ceil(per_mesh * length / step))
                for count, length, step in zip(whole, lengths, mesh, strict=True)
            ]
            for per_mesh in (2.0 * STOP_BAND, 16)  # points per mesh width of a coarsened tile
        )
        along, across = (_cosines(kept[k], shape[k], rim[k], whole[k]) for k in (0, 1))
        x, y = (np.arange(kept[k]) / (2.0 * lengths[k]) for k in (0, 1))
        spectrum = (across @ self.heights @ along.T) * response(x, y, mesh, radial=radial)
        spectrum *= nx * ny / (whole[0] * whole[1])
        heights = fft.idctn(np.pad(spectrum, ((0, ny - kept[1]), (0, nx - kept[0]))), type=2)
        pixel = (lengths[0] / nx, lengths[1] / ny)
        covered = (self.covered or self.heights.size) * math.prod(self.pixel) / math.prod(pixel)
        return replace(self, heights=heights, pixel=pixel, covered=covered)

    @cached_property
    def _wavelengths(self) -> tuple[float, float, float]:
        """Wavelengths 2 pi Sq / Sq' along x, along y and where it is shortest [m].

        Sq' is the root mean square slope in that direction, so this is the wave that is as steep
        as the surface. Infinite where the surface does not change.
        """
        wrap = "wrap" if self.edge == "periodic" else "edge"
        heights = np.pad(self.heights, ((0, 1), (0, 1)), mode=wrap)  # type: ignore[call-overload]
        x, y = np.diff(heights, axis=1) / self.pixel[0], np.diff(heights, axis=0) / self.pixel[1]
        xx, yy = float(np.mean(x[:-1] ** 2)), float(np.mean(y[:, :-1] ** 2))
        xy = float(np.mean((x[:-1] + x[1:]) * (y[:, :-1] + y[:, 1:]))) / 4.0
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


# ---- the spline between the points

Support = list[tuple[IntArray, Array]]
"""Indices of the four lattice points around each place, and the weights of their splines."""


def _support(place: Array, count: int, edge: Edge) -> Support:
    """Return which points carry each ``place``, counted in pixels, and with what weight."""
    first = np.floor(np.clip(place, -1e15, 1e15)).astype(np.int64)
    t = place - first
    weights = (
        (1.0 - t) ** 3 / 6.0,
        2.0 / 3.0 - t**2 * (1.0 - 0.5 * t),
        2.0 / 3.0 - (1.0 - t) ** 2 * 0.5 * (1.0 + t),
        t**3 / 6.0,
    )
    return [(_inside(first + k - 1, count, edge), weight) for k, weight in enumerate(weights)]


def _inside(index: IntArray, count: int, edge: Edge) -> IntArray:
    """Return indices into the lattice; ``count`` is the row or column of zeros."""
    if edge == "periodic":
        return index % count
    if edge == "mirror":
        folded = index % (2 * count)
        return np.minimum(folded, 2 * count - 1 - folded)
    return np.where((index >= 0) & (index < count), index, count)


def _on_a_mesh(coefficients: Array, rows: Support, columns: Support) -> Array:
    """Return the spline where rows and columns of a mesh cross: one axis after the other."""
    across = np.zeros((rows[0][0].shape[0], coefficients.shape[1]))
    for row, weight in rows:
        across += weight * coefficients[row[:, 0]]
    total = np.zeros((across.shape[0], columns[0][0].shape[1]))
    for column, weight in columns:
        total += weight * across[:, column[0]]
    return total


# ---- the filter of a mesh


def _is_roomy(shape: tuple[int, ...], rim: tuple[int, int]) -> bool:
    """Return whether a rim of these widths makes a tile too large, which is then coarsened.

    Its points are then beyond four times those without rim, and beyond four millions.
    """
    ny, nx = shape
    return (ny + 2 * rim[1]) * (nx + 2 * rim[0]) > max(4 * ny * nx, 4_000_000)


def _cosines(waves: int, count: int, rim: int, whole: int) -> Array:
    """Return the first rows of a cosine transform of ``whole`` points, where it is not flat."""
    places = (np.arange(count) + rim + 0.5) / whole
    return 2.0 * np.cos(np.pi * np.arange(waves)[:, None] * places)


def response(x: Array, y: Array, mesh: Pair, *, radial: bool) -> Array:
    """Return which part of the amplitude of each wave a mesh lets pass.

    Parameters
    ----------
    x, y : (nx,) array, (ny,) array
        Waves per metre along x and y.
    mesh : (float, float)
        Mesh widths [m].
    radial : bool
        Whether a wave is judged by its length, not by that along x and that along y.
    """
    y = y[:, None]
    parts = [np.hypot(x, y) * mesh[0]] if radial else [x * mesh[0], y * mesh[1]]
    beyond = (np.clip((part - PASS_BAND) / (STOP_BAND - PASS_BAND), 0.0, 1.0) for part in parts)
    return np.asarray(math.prod(np.cos(0.5 * np.pi * part) ** 2 for part in beyond))
