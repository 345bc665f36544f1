"""Pictures of a result; each function returns a matplotlib figure and touches no global state.

A notebook shows the figure when it is the value of a cell. Functions that draw one axes take
``ax``, those of a result ``title=False``. Pictures of one result are also here by name, to draw all
of them.
"""

from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from tehl.base.atomic import check_folder, replacing
from tehl.base.errors import InputError
from tehl.plots.animation import animate
from tehl.plots.convergence import residual_history
from tehl.plots.dynamics import dynamics_curves
from tehl.plots.fit import oil_fit
from tehl.plots.frame import lay_out, write_png
from tehl.plots.interferogram import Optics, interferogram
from tehl.plots.lines import centre_lines, film_distribution, pressure_surface, rough_centre_line
from tehl.plots.maps import (
    asperity_map,
    contact_map,
    film_map,
    heights_map,
    micro_film_map,
    pressure_map,
    shear_stress_map,
)
from tehl.plots.oil import oil_map, pass_history
from tehl.plots.stress import moving_section, stress_planes, stress_section
from tehl.plots.surface import surface_preview
from tehl.plots.table_curves import curves
from tehl.plots.table_maps import contour_map, film_deviations, moes_map
from tehl.plots.temperature import (
    mid_film_temperature,
    surface_heat,
    temperature_layers,
    temperature_section,
)
from tehl.plots.traction import traction_curve
from tehl.plots.transient import history, moments, passage, space_time
from tehl.post.boundary_contact import touching
from tehl.post.roughness import rough_film
from tehl.post.starvation import starvation
from tehl.post.summits import load_sharing
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution

__all__ = [
    "Optics",
    "animate",
    "asperity_map",
    "centre_lines",
    "contact_map",
    "contour_map",
    "curves",
    "dynamics_curves",
    "film_deviations",
    "film_distribution",
    "film_map",
    "heights_map",
    "history",
    "interferogram",
    "micro_film_map",
    "mid_film_temperature",
    "moes_map",
    "moments",
    "moving_section",
    "oil_fit",
    "oil_map",
    "pass_history",
    "passage",
    "pictures_of",
    "pressure_map",
    "pressure_surface",
    "residual_history",
    "rough_centre_line",
    "save_all",
    "shear_stress_map",
    "space_time",
    "stress_planes",
    "stress_section",
    "surface_heat",
    "surface_preview",
    "temperature_layers",
    "temperature_section",
    "traction_curve",
]

Pictures = dict[str, Callable[..., Figure]]
"""Functions that draw a result, by name."""

PICTURES: Pictures = {
    "film": film_map,
    "pressure": pressure_map,
    "pressure_surface": pressure_surface,
    "centre_lines": centre_lines,
    "residuals": residual_history,
}
"""Pictures of every steady result."""
OF_A_LINE = (
    *("centre_lines", "rough_centre_line", "film_distribution", "temperature_section"),
    *("dynamics", "stress", "moving_stress", "residuals", "history", "space_time", "moments"),
)
"""Pictures of a line contact: curves along x and sections."""
INTERFEROGRAMS: Pictures = {
    f"interferogram_{light}": partial(interferogram, optics=Optics(light=light))
    for light in ("white", "dichromatic", "monochromatic")
}
"""Pictures of a film under a transparent surface."""


def pictures_of(result: Solution | TransientSolution, smooth: Solution | None = None) -> Pictures:
    """Return the functions that draw a result, by name, in the order of drawing.

    Parameters
    ----------
    result : Solution or TransientSolution
        What it has decides which pictures there are.
    smooth : Solution or None
        Smooth reference run on the same grid, for pictures of ripples.
    """
    if isinstance(result, TransientSolution):
        found, problem = _of_motion(result), result.start.problem
    else:
        found, problem = _of_film(result, smooth), result.problem
    if problem.contact.is_line:
        return {name: draw for name, draw in found.items() if name in OF_A_LINE}
    return found


def _of_motion(result: TransientSolution) -> Pictures:
    """Return the functions that draw a transient result, by name."""
    moving: Pictures = {
        "history": history,
        "space_time": space_time,
        "moments": moments,
        "passage": passage,
    }
    has_stress = result.start.problem.stress is not None and result.frames.step.size
    return moving | ({"moving_stress": moving_section} if has_stress else {})


def _of_film(result: Solution, smooth: Solution | None) -> Pictures:
    """Return the functions that draw a steady result, by name."""
    found = dict(PICTURES)
    found |= _of_oil(result)
    if rough_film(result) is not None:
        if result.heights is not None:
            found["heights"] = heights_map
            found["micro_film"] = partial(micro_film_map, smooth=smooth)
            found["rough_centre_line"] = partial(rough_centre_line, smooth=smooth)
        found["film_distribution"] = film_distribution
    if result.shear is not None and result.problem.motion.slides:
        found["shear_stress"] = shear_stress_map
    if result.heat is not None:
        found["temperature"] = mid_film_temperature
        found["temperature_layers"] = temperature_layers
        found["temperature_section"] = temperature_section
        found["surface_heat"] = surface_heat
    if any(one.material.transparent for one in result.problem.surfaces):
        found |= INTERFEROGRAMS
    return found


def _of_oil(result: Solution) -> Pictures:
    """Return the functions that draw oil, contact, dynamics and stress, by name."""
    found: Pictures = {}
    if load_sharing(result) is not None:  # none if the run diverged
        found["asperities"] = asperity_map
    if touching(result) is not None:
        found["contact"] = contact_map
    if starvation(result) is not None:
        found["oil"] = oil_map
    if result.passes is not None:
        found["passes"] = pass_history
    if result.dynamics is not None:
        found["dynamics"] = dynamics_curves
    if result.stress is not None:
        found |= {"stress": stress_section, "stress_planes": stress_planes}
    return found


def chosen(pictures: Pictures, names: Iterable[str]) -> Pictures:
    """Return the named pictures, all without names.

    Parameters
    ----------
    pictures : dict
        Functions that draw, by name.
    names : iterable of str
        Wanted pictures in their order; none takes all.

    Raises
    ------
    InputError
        If a name is not among the pictures.
    """
    wanted = list(dict.fromkeys(names))
    for name in wanted:
        if name not in pictures:
            raise InputError(f"picture {name}: unknown; the result has {', '.join(pictures)}")
    return {name: pictures[name] for name in wanted} if wanted else pictures


def save_all(
    result: Solution | TransientSolution,
    folder: str | Path,
    *,
    pictures: Pictures | None = None,
    dpi: int = 150,
    ending: str = "png",
    title: bool = True,
) -> list[Path]:
    """Draw pictures of ``result`` as files; each appears whole or not at all.

    Parameters
    ----------
    result : Solution or TransientSolution
        What to draw.
    folder : str or Path
        Where; made if it is missing.
    pictures : dict or None
        Functions that draw, by name; all of :func:`pictures_of` by default.
    dpi : int
        Dots per inch.
    ending : {"png", "pdf", "svg"}
        Format.
    title : bool
        Whether the pictures have titles.

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
    wanted = pictures_of(result) if pictures is None else pictures
    paths = [place / f"{name}.{ending}" for name in wanted]
    for path, draw in zip(paths, wanted.values(), strict=True):
        save_picture(draw(result, title=title), path, dpi=dpi)
    return paths


def save_picture(picture: Figure, path: Path, *, dpi: int) -> None:
    """Write a picture in the format of the extension of ``path``, whole or not at all.

    Parameters
    ----------
    picture : Figure
        Any figure of matplotlib.
    path : Path
        Its extension is the format, such as .png, .svg or .pdf.
    dpi : int
        Pixels per inch of bitmaps.
    """
    with replacing(path) as temporary:
        if (ending := path.suffix[1:].lower()) == "png":
            write_png(picture, temporary, dpi)
        else:
            lay_out(picture)
            picture.savefig(temporary, dpi=dpi, format=ending)
