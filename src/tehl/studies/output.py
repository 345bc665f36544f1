"""What is made of the table of a study: pictures, and sheets of chosen columns and units."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from tehl.base.atomic import replacing
from tehl.base.errors import InputError
from tehl.base.lazy import lazy
from tehl.base.lists import check_format
from tehl.base.table import Table
from tehl.base.units import Quantity
from tehl.studies.tables import missing_column

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from tehl import plots
    from tehl.plots import table_columns, table_curves, table_maps
else:
    plots = lazy("tehl.plots")
    table_curves = lazy("tehl.plots.table_curves")
    table_maps = lazy("tehl.plots.table_maps")
    table_columns = lazy("tehl.plots.table_columns")

Range = tuple[float, float]


class Columns(Table):
    """Columns of the table that a picture shows."""

    x: str | None = None
    y: str | None = None
    z: str | None = None
    hue: str | None = None
    style: str | None = None


class Picture(Columns):
    """Curves over a column of the table, or a map over two; the user guide explains the keys."""

    log: Literal["", "x", "y", "xy"] = ""
    x_range: Range | None = None
    y_range: Range | None = None
    map: Literal["moes"] | None = None
    overlay: str | None = None
    title: str | None = None
    format: Literal["png", "pdf", "svg"] = "png"
    file: Annotated[str, Field(pattern=r"^[A-Za-z0-9._-]+$")] | None = None

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.map is None and (self.x is None or self.y is None):
            raise ValueError("needs x and y, or map")
        return self

    @property
    def file_name(self) -> str:
        """Name of the file."""
        over = "_over_".join(str(part).lstrip("-") for part in (self.z, self.y, self.x) if part)
        plain = over.translate(str.maketrans(". /", "___"))
        stem = self.file or (f"{self.map}_map" if self.map else plain)
        return f"{stem}.{self.format}"


def picture_of(words: str) -> Picture:
    """Return the picture that ``x=...,y=...,hue=...`` states; one word alone is a ready one."""
    stated = {}
    for part in (words if "=" in words else f"map={words}").split(","):
        key, _, value = (piece.strip() for piece in part.partition("="))
        if not value or key not in Picture.model_fields or key.endswith("_range"):
            raise InputError(
                f'"{part}" is not part of a picture: give x=COLUMN,y=COLUMN, and optionally '
                "hue=COLUMN, style=COLUMN, z=COLUMN, log=x, y or xy, overlay=FILE.csv"
            )
        stated[key] = value
    try:
        return Picture.model_validate(stated)
    except ValueError:
        raise InputError(
            f'"{words}" is not a picture: give x=COLUMN,y=COLUMN, or moes for the map of formulas'
        ) from None


def checked_pictures(
    pictures: Sequence[Picture], labels: Sequence[str], folder: Path
) -> tuple[Picture, ...]:
    """Return the pictures of a study, identical ones once.

    Parameters
    ----------
    pictures : sequence of Picture
        As the study file states them.
    labels, folder : sequence of str, Path
        Names of the axes, and where paths of overlays begin.

    Raises
    ------
    InputError
        If the table will not have a column, or two pictures have one file.
    """
    numbers: dict[str, int] = {}
    different = tuple(dict.fromkeys(pictures))
    for picture in different:
        number, file = pictures.index(picture) + 1, picture.file_name
        for key in Columns.model_fields:
            name = getattr(picture, key)
            missing = None if name is None else missing_column(labels, name)
            if missing is not None:
                raise InputError(f'pictures[{number}].{key} = "{name}": {missing}')
        if file in numbers:
            raise InputError(
                f"pictures[{numbers[file]}] and pictures[{number}] would both be {file}: give one "
                'of them another name, file = "other"'
            )
        numbers[file] = number
    return tuple(
        one.model_copy(update={"overlay": one.overlay and str(folder / one.overlay)})
        for one in different
    )


def draw(picture: Picture, table: "pd.DataFrame") -> "Figure":
    """Draw a table.

    Parameters
    ----------
    picture : Picture
        Columns, ranges and title.
    table : DataFrame
        Of a study, with title and units in ``attrs``.

    Raises
    ------
    InputError
        If a column is missing, or no case converged.
    """
    if picture.map is not None:
        return table_maps.moes_map(table)
    x, y = str(picture.x), str(picture.y)
    title = table.attrs.get("title") if picture.title is None else picture.title
    if picture.z is not None:
        return table_maps.contour_map(table, x, y, picture.z, picture.log, title=title)
    figure = table_curves.curves(table, x, y, picture.hue, picture.style, picture.log, title=title)
    if picture.overlay is not None:
        table_curves.overlay(figure, table, x, y, path=Path(picture.overlay))
    figure.axes[0].set(xlim=picture.x_range, ylim=picture.y_range)
    return figure


def save(picture: Picture, table: "pd.DataFrame", folder: Path) -> Path:
    """Draw a picture into a folder and return its file.

    Parameters
    ----------
    picture, table : Picture, pandas.DataFrame
        What to draw, and the table of a study.
    folder : Path
        Where the file appears, whole or not at all.
    """
    path = folder / picture.file_name
    plots.save_picture(draw(picture, table), path, dpi=200)
    return path


# ---- sheets


def check_sheet(path: Path) -> None:
    """Raise if the format of a sheet is not supported, or needs a package that is missing."""
    check_format(path, (".csv", ".xlsx"), "a sheet")


def sheet(table: "pd.DataFrame", columns: Sequence[str]) -> "pd.DataFrame":
    """Return columns of a table in chosen units, each named with its unit in brackets.

    Parameters
    ----------
    table : pandas.DataFrame
        As :func:`tehl.studies.table` returns it.
    columns : sequence of str
        Names, of which the last part suffices, perhaps with a unit: ``"film.h_min_m [nm]"``,
        ``"max_pa [GPa]"``, ``"inlet_k [degC]"``. Without any all columns, in SI.

    Raises
    ------
    InputError
        If a column is missing or has another kind of unit.
    """
    units, found = table.attrs.get("units", {}), {}
    for wanted in columns or list(table.columns):
        name, _, bracket = (part.strip() for part in wanted.partition("["))
        full = table_columns.find_column(table, name)
        si, unit = units.get(full, "1"), bracket.rstrip("] ")
        factor, offset = _conversion(full, si, unit) if unit else (1.0, 0.0)
        shown = unit or si
        values = (table[full] - offset) / factor if unit else table[full]
        found[full if shown == "1" else f"{full} [{shown}]"] = values
    return type(table)(found)


def _conversion(name: str, si: str, unit: str) -> tuple[float, float]:
    """Return factor and offset to SI of a unit of a column."""
    if si == "1":
        raise InputError(f"column {name} [{unit}]: has no unit; leave out the brackets")
    quantity = Quantity(name=f"the unit of {name}", unit=si, example=f"1 {si}", sign="any")
    try:
        one, two = (quantity.parse(f"{number} {unit}") for number in (1, 2))  # not 0 K
    except ValueError as error:
        raise InputError(f"column {name} [{unit}]: {error}") from None
    zero = 2.0 * one - two
    if zero and "rise" in name:
        raise InputError(f"column {name} [{unit}]: is a difference; state it in K")
    return two - one, zero


def write_sheet(table: "pd.DataFrame", path: Path, columns: Sequence[str]) -> None:
    """Write columns of a table as CSV or Excel.

    Parameters
    ----------
    table : DataFrame
        Of a study, in SI.
    path : Path
        Ends in .csv or .xlsx; written whole or not at all.
    columns : sequence of str
        Names, each perhaps with a unit such as ``film.central [nm]``.
    """
    check_sheet(path)
    found = sheet(table, columns)
    with replacing(path) as temporary:
        if path.suffix.lower() == ".csv":
            found.to_csv(temporary, index=False)
        else:
            with temporary.open("wb") as file:  # pandas rejects a path of another ending
                found.to_excel(file, index=False, engine="openpyxl")
