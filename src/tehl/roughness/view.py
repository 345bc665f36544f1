"""A measured surface as a picture shows it: where it lies beside the contact."""

from dataclasses import dataclass

import numpy as np

from tehl.roughness.map import Map
from tehl.roughness.preview import Preview
from tehl.roughness.protocol import Extent, direction
from tehl.typing import Array

_PER_PICTURE = 900
_WIDEST = 5.0
"""How many times as large as a map its picture may be; beyond, the map would be a dot."""
_MARGIN = 1.05


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class View:
    """Heights in a window.

    Attributes
    ----------
    values : (ny, nx) array
        Heights [m], rows along x.
    window : ((left, right), (bottom, top))
        The edges [m], in the coordinates of the contact.
    corners : (4, 2) array or None
        x and y of the corners of the map, where the window is not the map itself [m].
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

    Parameters
    ----------
    found : Preview
        The map, and perhaps a contact.
    """
    surface = found.surface
    if found.mesh is None and not any((surface.rotate, surface.x, surface.y)):
        values = found.heights.values
        steps = [max(1, count // _PER_PICTURE) for count in values.shape]
        return View(values=values[:: steps[0], :: steps[1]], window=surface.box)
    window = _window(found)
    x, y = (_places(*ends, step) for ends, step in zip(window, found.heights.pixel, strict=True))
    return View(
        values=surface.height(x[None, :], y[:, None]), window=window, corners=_corners(surface)
    )


def _window(found: Preview) -> Extent:
    """Return a window around the map, and around the contact unless the map would be a dot."""
    box = found.surface.box
    if found.mesh is None:
        return box
    halves = [_MARGIN * half for half in found.mesh.half_widths]
    x, y = (
        (min(start, -half), max(end, half)) for (start, end), half in zip(box, halves, strict=True)
    )
    return (x, y) if _longest((x, y)) <= _WIDEST * _longest(box) else box


def _longest(box: Extent) -> float:
    return max(end - start for start, end in box)


def _places(start: float, end: float, step: float) -> Array:
    """Return the middles of the pixels of a picture, the points of the map where they suffice."""
    count = int(np.clip(round((end - start) / step), 2, _PER_PICTURE))
    return start + (np.arange(count) + 0.5) * (end - start) / count


def _corners(surface: Map) -> Array:
    """Return x and y of the corners of a map [m]."""
    cosine, sine = direction(surface.rotate)
    along, across = (0.5 * length for length in surface.load().size)
    own = np.array([(-along, -across), (along, -across), (along, across), (-along, across)])
    turn = np.array([[cosine, -sine], [sine, cosine]])  # by which x and y are those of the map
    return own @ turn + (surface.x, surface.y)
