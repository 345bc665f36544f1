"""All pictures of a result, steady or transient, by name and into a folder."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from tehl.io.atomic import check_folder, replacing
from tehl.plots import transient
from tehl.plots.convergence import residual_history
from tehl.plots.interferogram import Optics, interferogram
from tehl.plots.lines import centre_lines, film_distribution, pressure_surface, rough_centre_line
from tehl.plots.maps import (
    film_map,
    heights_map,
    micro_film_map,
    pressure_map,
    shear_stress_map,
)
from tehl.plots.temperature import (
    mid_film_temperature,
    surface_heat,
    temperature_layers,
    temperature_section,
)
from tehl.result import Result
from tehl.transient_result import TransientResult

Pictures = dict[str, Callable[[Any], Figure]]
"""Functions that draw a result, by name."""

PICTURES: Pictures = {
    "film": film_map,
    "pressure": pressure_map,
    "pressure_surface": pressure_surface,
    "centre_lines": centre_lines,
    "residuals": residual_history,
    **{
        f"interferogram_{light}": partial(interferogram, optics=Optics(light=light))
        for light in ("white", "dichromatic", "monochromatic")
    },
}
"""Pictures of every steady result."""
SHEAR_PICTURES: Pictures = {"shear_stress": shear_stress_map}
"""Pictures of a film that slides."""
HEAT_PICTURES: Pictures = {
    "temperature": mid_film_temperature,
    "temperature_layers": temperature_layers,
    "temperature_section": temperature_section,
    "surface_heat": surface_heat,
}
"""Pictures of a thermal result."""
TRANSIENT_PICTURES: Pictures = {
    "history": transient.history,
    "space_time": transient.space_time,
    "moments": transient.moments,
    "passage": transient.passage,
}
"""Pictures of a transient result."""


def pictures_of(result: Result | TransientResult, smooth: Result | None = None) -> Pictures:
    """Return the functions that draw ``result``, by name, in the order of drawing.

    ``smooth`` is the smooth reference run on the same grid, for pictures of ripples.
    """
    if isinstance(result, TransientResult):
        return TRANSIENT_PICTURES
    slides = result.shear is not None and result.problem.slide_roll_ratio != 0
    return {
        **PICTURES,
        **_rough_pictures(result, smooth),
        **(SHEAR_PICTURES if slides else {}),
        **(HEAT_PICTURES if result.heat is not None else {}),
    }


def _rough_pictures(result: Result, smooth: Result | None) -> Pictures:
    """Return the pictures of a film between surfaces that are not ideally smooth."""
    if result.roughness is None:
        return {}
    heights: Pictures = {
        "heights": heights_map,
        "micro_film": partial(micro_film_map, smooth=smooth),
        "rough_centre_line": partial(rough_centre_line, smooth=smooth),
    }
    return (heights if result.heights is not None else {}) | {
        "film_distribution": film_distribution
    }


def save_all(
    result: Result | TransientResult,
    folder: str | Path,
    *,
    dpi: int = 150,
    smooth: Result | None = None,
) -> list[Path]:
    """Draw all pictures of ``result`` as PNG files; each appears whole or not at all.

    Parameters
    ----------
    result : Result or TransientResult
        What to draw.
    folder : str or Path
        Where; made if it is missing.
    dpi : int
        Dots per inch.
    smooth : Result or None
        Smooth reference run on the same grid, for pictures of ripples.

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
    paths = []
    for name, draw in pictures_of(result, smooth).items():
        paths.append(place / f"{name}.png")
        with replacing(paths[-1]) as temporary:
            draw(result).savefig(temporary, dpi=dpi, format="png")
    return paths
