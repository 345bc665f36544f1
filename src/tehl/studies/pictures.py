"""Which pictures of its table a study wants."""

from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from tehl.errors import InputError

Range = tuple[float, float]
_KEYS = ("x", "y", "z", "hue", "style", "log", "map", "overlay", "file", "format")


class Picture(BaseModel):
    """Curves over a column of the table, or a map over two.

    Attributes
    ----------
    x, y : str or None
        Columns; the last part of a dotted name will do where it tells them apart. A minus before
        ``y`` turns its sign.
    z : str or None
        Column to draw as a contour map over x and y.
    hue, style : str or None
        Columns that tell the curves apart, by colour and by line.
    log : {"", "x", "y", "xy"}
        Axes with a logarithmic scale.
    x_range, y_range : (float, float) or None
        What the axes show, in the unit that they show.
    map : {"moes"} or None
        A ready picture instead: how far film formulas are off over M and L.
    overlay : str or None
        A CSV file with measured points: columns x and y, and if known their error and name.
    format : {"png", "pdf", "svg"}
        Of the file.
    file : str or None
        Name of the picture without its ending.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    x: str | None = None
    y: str | None = None
    z: str | None = None
    hue: str | None = None
    style: str | None = None
    log: Literal["", "x", "y", "xy"] = ""
    x_range: Range | None = None
    y_range: Range | None = None
    map: Literal["moes"] | None = None
    overlay: str | None = None
    format: Literal["png", "pdf", "svg"] = "png"
    file: Annotated[str, Field(pattern=r"^[A-Za-z0-9._-]+$")] | None = None

    @model_validator(mode="after")
    def _must_say_what(self) -> Self:
        if self.map is None and (self.x is None or self.y is None):
            raise ValueError("needs x and y, or map")
        return self

    @property
    def stem(self) -> str:
        """Name of the file without its ending."""
        if self.file or self.map:
            return self.file or f"{self.map}_map"
        over = "_over_".join(str(part).lstrip("-") for part in (self.z, self.y, self.x) if part)
        return over.replace(".", "_").replace(" ", "_").replace("/", "_")


def picture_of(words: str) -> Picture:
    """Return the picture that ``x=...,y=...,hue=...`` asks for; one word alone is a ready one.

    Raises
    ------
    InputError
        If it is none; the message says what would be.
    """
    stated = {}
    for part in (words if "=" in words else f"map={words}").split(","):
        key, equals, value = (piece.strip() for piece in part.partition("="))
        if not equals or not value or key not in _KEYS:
            raise InputError(
                f'"{part}" is no part of a picture: give x=COLUMN,y=COLUMN, and if wanted '
                "hue=COLUMN, style=COLUMN, z=COLUMN, log=x, y or xy, overlay=FILE.csv"
            )
        stated[key] = value
    try:
        return Picture.model_validate(stated)
    except ValueError:
        raise InputError(
            f'"{words}" is no picture: give x=COLUMN,y=COLUMN, or moes for the map of formulas'
        ) from None
