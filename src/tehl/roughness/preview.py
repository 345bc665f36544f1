"""Summary of a measured surface: its statistics, what a mesh carries of it, where it lies."""

from dataclasses import dataclass

import numpy as np

from tehl.base.typing import Array
from tehl.roughness.files.raw import RawMap, shown
from tehl.roughness.loading import raw_map
from tehl.roughness.map import Map
from tehl.roughness.model import Extent, direction
from tehl.roughness.prepare import Heights, note_on_form
from tehl.roughness.statistics import Spectrum, Statistics, share_beyond, spectrum, statistics

_PER_PICTURE = 900
"""Most points of a picture along an axis."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Mesh:
    """A grid of the solver: mesh widths, half-widths of the contact [m], nodes; along x and y."""

    spacing: tuple[float, float]
    half_widths: tuple[float, float]
    points: tuple[int, int]
    skew: float = 0.0
    """s of the rim of the contact, X^2 - 2 s X Y + Y^2 = 1 - s^2 in half-widths."""
    straight: bool = False
    """Whether the rim is a rectangle, that of a line or a roller."""

    @property
    def axes(self) -> tuple[float, float]:
        """Axes of the contact along x and y [m]; zero of a line, which takes y = 0."""
        first, second = (2.0 * half for half in self.half_widths)
        return first, 0.0 if self.points[1] == 1 else second


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Preview:
    """What a file holds, and what the solver makes of it."""

    surface: Map
    """How it is prepared and placed."""
    file: str
    """Name of the file."""
    raw: RawMap
    heights: Heights
    """Heights of the file, and as prepared."""
    statistics: Statistics
    spectrum: Spectrum
    """Of the prepared heights."""
    mesh: Mesh | None
    """The grid that is compared."""
    lost: float | None
    """Share of the variance that the mesh cannot carry."""
    sentences: tuple[str, ...]
    """What is unusual about the map, alone and for the contact."""

    @property
    def missing(self) -> int:
        """Return the number of points of the file without a height, removed spikes not counted."""
        return int(np.sum(~np.isfinite(self.raw.heights)))


def preview(surface: Map, mesh: Mesh | None = None) -> Preview:
    """Return the summary of a measured surface.

    Parameters
    ----------
    surface : Map
        Read and prepared here.
    mesh : Mesh or None
        Mesh of a contact, whose half-widths and filtering the summary compares with.

    Raises
    ------
    InputError
        As :meth:`tehl.roughness.Map.load`.
    """
    heights = surface.load()
    values, pixel = heights.values, heights.pixel
    return Preview(
        surface=surface,
        file=shown(surface.file),
        raw=raw_map(surface),
        heights=heights,
        statistics=statistics(values, pixel, heights.measured),
        spectrum=spectrum(values, pixel),
        mesh=mesh,
        lost=None if mesh is None else share_beyond(values, pixel, mesh.spacing),
        sentences=(
            note_on_form(heights, surface.level) if mesh is None else surface.fits(*mesh.axes)
        ),
    )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class View:
    """Heights in a window [m], rows along x, and the edges of the window in the contact [m].

    ``corners``, (4, 2), are those of the map [m]; None where the window is the map itself.
    """

    values: Array
    window: Extent
    corners: Array | None = None

    @property
    def size(self) -> tuple[float, float]:
        """Return the lengths of the window along x and y [m]."""
        (left, right), (bottom, top) = self.window
        return right - left, top - bottom


def view(found: Preview) -> View:
    """Return the heights of a map where it lies at time zero.

    Without a contact beside it, and neither turned nor moved, these are the points of the map.
    Otherwise they are what the contact gets, with what lies beyond the edges of the map.
    """
    surface = found.surface
    if found.mesh is None and not any((surface.rotate, surface.x, surface.y)):
        values = found.heights.values
        steps = [max(1, count // _PER_PICTURE) for count in values.shape]
        return View(values=values[:: steps[0], :: steps[1]], window=surface.box)
    window = _window(found)
    middles = []
    for (start, end), step in zip(window, found.heights.pixel, strict=True):
        count = int(np.clip(round((end - start) / step), 2, _PER_PICTURE))
        middles.append(start + (np.arange(count) + 0.5) * (end - start) / count)
    values = surface.height(middles[0][None, :], middles[1][:, None])
    cosine, sine = direction(surface.rotate)
    signs = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
    turn = np.array([[cosine, -sine], [sine, cosine]])  # by which x and y are those of the map
    corners = (signs * found.heights.size) @ turn + (surface.x, surface.y)
    return View(values=values, window=window, corners=corners)


def _window(found: Preview) -> Extent:
    """Return a window around the map, and around the contact unless the map would be a dot."""
    box = found.surface.box
    if found.mesh is None:
        return box
    halves = [1.05 * half for half in found.mesh.half_widths]
    x, y = (
        (min(start, -half), max(end, half)) for (start, end), half in zip(box, halves, strict=True)
    )
    longest = [max(end - start for start, end in one) for one in ((x, y), box)]
    return (x, y) if longest[0] <= 5.0 * longest[1] else box  # else the map would be a dot
