"""Measured surfaces: a file, the units it does not state, and how its heights are prepared."""

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self

from pydantic import ValidationInfo, field_validator, model_validator

from tehl.roughness.model import (
    BEYOND,
    ENDLESS,
    Edge,
    Extent,
    Lengths,
    LengthUnit,
    Position,
    Span,
    TileModel,
    Wavelength,
    direction,
)
from tehl.units import Angle, Height, PositiveNumber, Table

if TYPE_CHECKING:
    from tehl.roughness.prepare import Heights
    from tehl.roughness.tile import Tile

_COARSE = 10.0
_LARGE = 20.0


class Crop(Table):
    """A part of a map, in the coordinates of the file: from its first column and row."""

    x: Span | None = None
    y: Span | None = None
    """From and to [m]; None is all."""

    @model_validator(mode="after")
    def _must_rise(self) -> Self:
        for axis, span in (("x", self.x), ("y", self.y)):
            if span is not None and not 0.0 <= span[0] < span[1]:
                raise ValueError(f"{axis} must rise from zero or more, from the corner of the map")
        return self


class Map(TileModel):
    """A measured surface.

    The file is read when heights are first needed, so that a case can be stored and read again
    without it. Columns lie along x, rows along y, the first row at the least y. What is done goes
    in this order: transpose, flip, upside_down, crop, outliers, fill, level, lambda_c, lambda_s.
    """

    type: Literal["map"] = "map"
    file: str
    """Its path; the ending decides the format."""
    unit: LengthUnit | None = None
    """Of the heights; needed where the file does not say."""
    xy_unit: LengthUnit | None = None
    """Of x and y in the file; needed where it has them without a unit."""
    pixel: Lengths | None = None
    size: Lengths | None = None
    """Distances of the points or lengths of the edges along x and y [m], one number for both; one
    of the two is needed where the file does not say."""
    layout: Literal["auto", "matrix", "xyz"] = "auto"
    """What the numbers of a text are."""
    variable: str | None = None
    """Which variable of a NetCDF file."""
    transpose: bool = False
    flip_x: bool = False
    flip_y: bool = False
    upside_down: bool = False
    """Exchange rows and columns; reverse x or y; take depths as heights."""
    crop: Crop | None = None
    """The part to take, after these."""
    outliers: PositiveNumber | None = None
    """Standard deviations beyond which spikes become missing points."""
    fill: Literal["auto", "linear", "nearest", "refuse"] = "auto"
    """How missing points are filled; "auto" accepts at most 1 % of them."""
    level: Literal["none", "mean", "plane", "quadratic"] = "plane"
    """What is taken off."""
    lambda_c: Wavelength | None = None
    lambda_s: Wavelength | None = None
    """Longest and shortest waves that are kept [m], by Gaussian filters."""
    rotate: Angle = 0.0
    """Angle by which the rows are turned against x [rad], as the crests of a wave are."""
    x: Position = 0.0
    y: Position = 0.0
    """Where the middle of the map lies at time zero [m]."""
    outside: Edge = "flat"
    """What lies beyond the edges."""
    taper: Height | None = None
    """Over which heights fall to zero at the edges of a flat surrounding [m]; a tenth of the
    shorter edge if left out."""

    @field_validator("file", mode="after")
    @classmethod
    def _beside_the_case(cls, file: str, info: ValidationInfo) -> str:
        """Take a relative path from the folder that the context of the validation names."""
        context: Any = info.context
        folder = context.get("folder") if isinstance(context, dict) else None
        if not file.strip():
            raise ValueError('is not the name of a file: give one such as "surface.x3p"')
        known = Path(file).expanduser()
        return file if folder is None or known.is_absolute() else str(Path(folder) / known)

    @model_validator(mode="after")
    def _must_agree(self) -> Self:
        if self.pixel is not None and self.size is not None:
            raise ValueError("pixel and size say the same: give one of them")
        if self.taper is not None and self.outside != "flat":
            raise ValueError('taper counts for outside = "flat" only: leave it out')
        if None not in (self.lambda_s, self.lambda_c) and not self.lambda_s < self.lambda_c:  # type: ignore[operator]
            raise ValueError(
                f"lambda_s = {self.lambda_s:g} m must be shorter than lambda_c = "
                f"{self.lambda_c:g} m: what lies between them is kept"
            )
        return self

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
        """Return Sq of the prepared heights [m], before they are tapered."""
        return float(self.load().values.std())

    @property
    def fingerprint(self) -> str:
        """Return the SHA-256 sum of the file."""
        from tehl.roughness.loading import found_file  # noqa: PLC0415 (a case needs no scipy)

        with found_file(self).open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()

    def load(self) -> "Heights":
        """Return the prepared heights in metres, read once.

        Raises InputError if the file does not hold a map of a surface; the message names the file.
        """
        from tehl.roughness.loading import heights_of  # noqa: PLC0415

        return heights_of(self)

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
        from tehl.roughness.loading import tile_of  # noqa: PLC0415

        return tile_of(self)

    def fits(self, width: float, length: float) -> tuple[str, ...]:
        """Return sentences on what is unusual for a contact of ``width`` by ``length`` [m]."""
        from tehl.roughness.prepare import note_on_form  # noqa: PLC0415

        heights = self.load()
        extent = _turned(heights.size, self.rotate)
        sizes = (
            f"the map of {_micro(*extent)} and the contact of {_micro(width, length)} (along x and "
            "y)"
        )
        sentences = []
        if extent[0] < width or extent[1] < length:
            sentences.append(
                f"{sizes}: the map is smaller than the contact; {BEYOND[self.outside]}"
            )
        elif min(extent[0] / width, extent[1] / length) > _LARGE:
            sentences.append(f"{sizes}: only a small part of the map lies in the contact")
        if max(heights.pixel) > min(width, length) / _COARSE:
            sentences.append(
                f"the map has points {_micro(*heights.pixel)} apart and the contact measures "
                f"{_micro(width, length)}: that is too coarse to be roughness, check its size"
            )
        if abs(self.x) > 0.5 * (extent[0] + width) or abs(self.y) > 0.5 * (extent[1] + length):
            sentences.append(f"{sizes} do not touch at time zero: the map lies beside the contact")
        return (*sentences, *note_on_form(heights, self.level))


def _turned(size: tuple[float, float], angle: float) -> tuple[float, float]:
    """Return what a turned rectangle measures along x and y [m]."""
    cosine, sine = (abs(part) for part in direction(angle))
    return size[0] * cosine + size[1] * sine, size[0] * sine + size[1] * cosine


def _micro(first: float, second: float) -> str:
    return f"{first * 1e6:.4g} x {second * 1e6:.4g} um"
