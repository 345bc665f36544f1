"""All pictures of a result into a folder."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from tehl.io.atomic import check_folder, replacing
from tehl.plots.history import residual_history
from tehl.plots.interferogram import Optics, interferogram
from tehl.plots.lines import centre_lines
from tehl.plots.maps import film_map, pressure_map, pressure_surface
from tehl.plots.roughness import (
    film_distribution,
    heights_map,
    micro_film_map,
    rough_centre_line,
)
from tehl.plots.shear import shear_stress_map
from tehl.plots.temperature import (
    mid_film_temperature,
    surface_heat,
    temperature_layers,
    temperature_section,
)
from tehl.result import Result

Picture = Callable[[Result], Figure]

PICTURES: dict[str, Picture] = {
    "film": film_map,
    "pressure": pressure_map,
    "pressure_surface": pressure_surface,
    "centre_lines": centre_lines,
    "residuals": residual_history,
    "interferogram_white": lambda result: interferogram(result, Optics(light="white")),
    "interferogram_dichromatic": lambda result: interferogram(result, Optics(light="dichromatic")),
    "interferogram_monochromatic": lambda result: interferogram(
        result, Optics(light="monochromatic")
    ),
}

"""Pictures that every result has, by name."""

SHEAR_PICTURES: dict[str, Picture] = {"shear_stress": shear_stress_map}
"""Pictures of a film that slides."""

HEAT_PICTURES: dict[str, Picture] = {
    "temperature": mid_film_temperature,
    "temperature_layers": temperature_layers,
    "temperature_section": temperature_section,
    "surface_heat": surface_heat,
}
"""Pictures of a thermal run."""


def rough_pictures(result: Result, smooth: Result | None) -> dict[str, Picture]:
    """Return the pictures of a film between surfaces that are not ideally smooth, by name."""
    if result.roughness is None:
        return {}
    heights: dict[str, Picture] = {
        "heights": heights_map,
        "micro_film": partial(micro_film_map, smooth=smooth),
        "rough_centre_line": partial(rough_centre_line, smooth=smooth),
    }
    stands = result.heights is not None
    return {**(heights if stands else {}), "film_distribution": film_distribution}


def pictures_of(result: Result, smooth: Result | None = None) -> dict[str, Picture]:
    """Return the pictures that ``result`` has, by name.

    Parameters
    ----------
    result : Result
        What to draw.
    smooth : Result or None
        The film between smooth surfaces on the same grid, for pictures of ripples.
    """
    slides = result.shear is not None and result.problem.slide_roll_ratio != 0
    return {
        **PICTURES,
        **rough_pictures(result, smooth),
        **(SHEAR_PICTURES if slides else {}),
        **(HEAT_PICTURES if result.heat is not None else {}),
    }


def save_all(
    result: Result, folder: str | Path, *, dpi: int = 150, smooth: Result | None = None
) -> list[Path]:
    """Draw all pictures that ``result`` has as PNG files; each appears whole or not at all.

    Parameters
    ----------
    result : Result
        What to draw.
    folder : str or Path
        Where; made if it is missing.
    dpi : int
        Dots per inch.
    smooth : Result or None
        The film between smooth surfaces on the same grid, for pictures of ripples.

    Returns
    -------
    list of Path
        The files, in the order of drawing.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    place = Path(folder)
    check_folder(place)
    place.mkdir(parents=True, exist_ok=True)
    return [
        save_picture(draw(result), place / f"{name}.png", dpi)
        for name, draw in pictures_of(result, smooth).items()
    ]


def save_picture(picture: Figure, path: Path, dpi: int) -> Path:
    """Write a figure as a PNG file, whole or not at all; return its path."""
    with replacing(path) as temporary:
        picture.savefig(temporary, dpi=dpi, format="png")
    return path
