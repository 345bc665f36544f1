"""Pictures of the table of a study."""

from pathlib import Path
from typing import TYPE_CHECKING

from tehl.errors import InputError
from tehl.io.atomic import replacing
from tehl.studies.pictures import Picture

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

DPI = 200


def draw(picture: Picture, table: "pd.DataFrame") -> "Figure":
    """Return a picture of a table.

    Raises
    ------
    InputError
        If a column is missing or there is nothing to draw.
    """
    from tehl.plots.table_curves import curves, overlay  # noqa: PLC0415 (matplotlib)
    from tehl.plots.table_maps import contour_map, moes_map  # noqa: PLC0415

    if picture.map is not None:
        return moes_map(table)
    x, y = str(picture.x), str(picture.y)
    if picture.z is not None:
        return contour_map(table, x, y, picture.z, picture.log)
    figure = curves(table, x, y, picture.hue, picture.style, picture.log)
    if picture.overlay is not None:
        overlay(figure, table, x, y, path=Path(picture.overlay))
    figure.axes[0].set(xlim=picture.x_range, ylim=picture.y_range)
    return figure


def save(picture: Picture, table: "pd.DataFrame", folder: Path) -> Path:
    """Draw a picture into a folder; return its file, which appears whole or not at all.

    Raises
    ------
    InputError
        As :func:`draw`.
    """
    figure, path = draw(picture, table), folder / f"{picture.stem}.{picture.format}"
    with replacing(path) as temporary:
        figure.savefig(temporary, dpi=DPI, format=picture.format)
    return path


def save_pictures(
    pictures: tuple[Picture, ...], table: "pd.DataFrame", folder: Path
) -> tuple[list[Path], list[str]]:
    """Draw pictures into a folder; return their files, and why others were not drawn."""
    written, complaints = [], []
    for picture in pictures:
        try:
            written.append(save(picture, table, folder))
        except InputError as error:
            complaints.append(f"picture {picture.stem}: {error}")
    return written, complaints
