"""What a case states about a measured surface: its file and how its heights are prepared."""

from pathlib import Path
from typing import Literal, Self

from pydantic import ValidationInfo, field_validator, model_validator

from tehl.base.table import Table, folder_of
from tehl.base.units import Angle, Height, PositiveNumber
from tehl.roughness.model import Edge, Lengths, LengthUnit, Position, Span, TileModel, Wavelength

_First = Literal["al3d", "bcr", "datx", "di", "ezd", "frt", "gwy", "ibw", "jpk", "lext", "mdt"]
_Rest = Literal["metropro", "mi", "mnt", "nms", "opd", "opdx", "os3d", "plu", "plux", "qep", "sdf"]
_Last = Literal["sur", "tmd", "vk", "zmg", "zon"]
_Format = Literal["auto", "npy", "npz", "text", "netcdf", "x3p", _First, _Rest, _Last]


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


class MapFile(TileModel):
    """The file of a map, and how it is read."""

    type: Literal["map"] = "map"
    file: str
    """Its path; the ending decides the format, and the first bytes that of a .dat file."""
    format: _Format = "auto"
    """Format to read it as, whatever its ending: one of tehl's own readers or of
    SurfaceTopography's."""
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
    """Which variable of a NetCDF file, or array of an npz file."""

    @field_validator("file", mode="after")
    @classmethod
    def _beside_the_case(cls, file: str, info: ValidationInfo) -> str:
        """Take a relative path from the folder that the context of the validation names."""
        folder = folder_of(info)
        if not file.strip():
            raise ValueError('is not the name of a file: give one such as "surface.x3p"')
        known = Path(file).expanduser()
        return file if folder is None or known.is_absolute() else str(folder / known)

    @model_validator(mode="after")
    def _must_have_one_size(self) -> Self:
        if self.pixel is not None and self.size is not None:
            raise ValueError("pixel and size say the same: give one of them")
        return self


class PreparedMap(MapFile):
    """A map and how its heights are prepared, in the order of the keys."""

    transpose: bool = False
    flip_x: bool = False
    flip_y: bool = False
    upside_down: bool = False
    """Exchange rows and columns; reverse x or y; take depths as heights."""
    crop: Crop | None = None
    """The part to take."""
    outliers: PositiveNumber | None = None
    """Standard deviations beyond which spikes become missing points."""
    fill: Literal["auto", "linear", "nearest", "refuse"] = "auto"
    """How missing points are filled; "auto" accepts at most 1 % of them."""
    level: Literal["none", "mean", "plane", "quadratic"] = "plane"
    """What is taken off."""
    lambda_c: Wavelength | None = None
    lambda_s: Wavelength | None = None
    """Longest and shortest waves that are kept [m], by Gaussian filters."""

    @model_validator(mode="after")
    def _must_keep_waves(self) -> Self:
        if None not in (self.lambda_s, self.lambda_c) and not self.lambda_s < self.lambda_c:  # type: ignore[operator]
            raise ValueError(
                f"lambda_s = {self.lambda_s:g} m must be shorter than lambda_c = "
                f"{self.lambda_c:g} m: what lies between them is kept"
            )
        return self


class MapSettings(PreparedMap):
    """The settings of a map, without the file being read: its heights, and where they lie."""

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

    @model_validator(mode="after")
    def _must_fade_into_a_flat(self) -> Self:
        if self.taper is not None and self.outside != "flat":
            raise ValueError('taper counts for outside = "flat" only: leave it out')
        return self
