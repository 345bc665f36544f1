"""Measured surfaces: their heights, read when they are first needed, and where they lie."""

import hashlib
from typing import TYPE_CHECKING

from tehl.base.lazy import lazy
from tehl.roughness.map_settings import MapSettings
from tehl.roughness.model import BEYOND, ENDLESS, Extent, direction

if TYPE_CHECKING:
    from tehl.roughness import files, loading, prepare
    from tehl.roughness.prepare import Heights
    from tehl.roughness.tile import Tile
else:
    files = lazy("tehl.roughness.files")
    loading = lazy("tehl.roughness.loading")
    prepare = lazy("tehl.roughness.prepare")

_LARGE_RATIO = 20.0


class Map(MapSettings):
    """A measured surface.

    The file is read when heights are first needed, so that a case can be stored and read again
    without it. Columns lie along x, rows along y, the first row at the least y. What is done goes
    in this order: transpose, flip, upside_down, crop, outliers, fill, level, lambda_c, lambda_s.
    """

    @property
    def is_even_in_y(self) -> bool:
        """Return whether the prepared map mirrors at y = 0, neither turned nor moved."""
        if self.y != 0.0 or direction(self.rotate)[1] != 0.0:
            return False
        heights = self._tile.heights
        return float(abs(heights - heights[::-1]).max()) <= 1e-6 * self.rms

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return the wavelengths 2 pi Sq / Sq' along x and along y [m]."""
        return self._tile.shortest_wavelengths

    @property
    def shortest_wavelength(self) -> float:
        """Return the wavelength 2 pi Sq / Sq' where it is shortest [m]."""
        return self._tile.shortest_wavelength

    @property
    def rms(self) -> float:
        """Return Sq of the prepared heights [m], over measured points, before they are tapered."""
        return self.load().sq

    @property
    def fingerprint(self) -> str:
        """Return the SHA-256 sum of the file."""
        with files.checked(self.file).open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()

    @property
    def stamp(self) -> tuple[int, int]:
        """Return what changes when the file does: its size, and when it was written."""
        return loading.stamp_of(self)

    def load(self) -> "Heights":
        """Return the prepared heights in metres, read once.

        Raises InputError if the file does not hold a map of a surface; the message names the file.
        """
        return loading.heights_of(self)

    def extent(self, length: float) -> Extent:
        """Return where the map lies at time zero, without limits if it repeats [m]."""
        del length
        return self.box if self.outside == "flat" else ENDLESS

    @property
    def box(self) -> Extent:
        """Return from where to where the measured part lies along x and y at time zero [m]."""
        width, height = _turned(self.load().size, self.rotate)
        return (
            (self.x - 0.5 * width, self.x + 0.5 * width),
            (self.y - 0.5 * height, self.y + 0.5 * height),
        )

    @property
    def _tile(self) -> "Tile":
        return loading.tile_of(self)

    def fits(self, width: float, length: float) -> tuple[str, ...]:
        """Return sentences on what is unusual about the map for a contact or a line (length 0)."""
        heights = self.load()
        extent = _turned(heights.size, self.rotate)
        size = _micro(width, length) if length else f"{1e6 * width:.4g} um"
        sizes = f"the map of {_micro(*extent)} and the contact of {size} (along x and y)"
        sentences = []
        if extent[0] < width or extent[1] < length:
            sentences.append(
                f"{sizes}: the map is smaller than the contact; {BEYOND[self.outside]}"
            )
        elif extent[0] > _LARGE_RATIO * width and extent[1] > _LARGE_RATIO * length:
            sentences.append(f"{sizes}: only a small part of the map lies in the contact")
        if max(heights.pixel) > min(width, length or width) / 10.0:
            sentences.append(
                f"the map has points {_micro(*heights.pixel)} apart and the contact measures "
                f"{size}: that is too coarse to be roughness, check its size"
            )
        if abs(self.x) > 0.5 * (extent[0] + width) or abs(self.y) > 0.5 * (extent[1] + length):
            sentences.append(f"{sizes} do not touch at time zero: the map lies beside the contact")
        return (*sentences, *prepare.note_on_form(heights, self.level))


def _turned(size: tuple[float, float], angle: float) -> tuple[float, float]:
    """Return what a turned rectangle measures along x and y [m]."""
    cosine, sine = (abs(part) for part in direction(angle))
    return size[0] * cosine + size[1] * sine, size[0] * sine + size[1] * cosine


def _micro(first: float, second: float) -> str:
    return f"{first * 1e6:.4g} x {second * 1e6:.4g} um"
