"""All pictures of a result into a folder."""

from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from tehl.io.atomic import check_folder, replacing
from tehl.plots.history import residual_history
from tehl.plots.interferogram import Optics, interferogram
from tehl.plots.lines import centre_lines
from tehl.plots.maps import film_map, pressure_map, pressure_surface
from tehl.plots.shear import shear_stress_map
from tehl.plots.temperature import (
    mid_film_temperature,
    surface_heat,
    temperature_layers,
    temperature_section,
)
from tehl.result import Result

PICTURES: dict[str, Callable[[Result], Figure]] = {
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

SHEAR_PICTURES: dict[str, Callable[[Result], Figure]] = {"shear_stress": shear_stress_map}
"""Pictures of a film that slides."""

HEAT_PICTURES: dict[str, Callable[[Result], Figure]] = {
    "temperature": mid_film_temperature,
    "temperature_layers": temperature_layers,
    "temperature_section": temperature_section,
    "surface_heat": surface_heat,
}
"""Pictures of a thermal run."""


def pictures_of(result: Result) -> dict[str, Callable[[Result], Figure]]:
    """Return the pictures that ``result`` has, by name."""
    slides = result.shear is not None and result.problem.slide_roll_ratio != 0
    return {
        **PICTURES,
        **(SHEAR_PICTURES if slides else {}),
        **(HEAT_PICTURES if result.heat is not None else {}),
    }


def save_all(result: Result, folder: str | Path, *, dpi: int = 150) -> list[Path]:
    """Draw all pictures that ``result`` has as PNG files; each appears whole or not at all.

    Parameters
    ----------
    result : Result
        What to draw.
    folder : str or Path
        Where; made if it is missing.
    dpi : int
        Dots per inch.

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
        _save(draw(result), place / f"{name}.png", dpi)
        for name, draw in pictures_of(result).items()
    ]


def _save(picture: Figure, path: Path, dpi: int) -> Path:
    with replacing(path) as temporary:
        picture.savefig(temporary, dpi=dpi, format="png")
    return path
