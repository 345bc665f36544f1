"""Reference runs of a steady case, without heat or with smooth surfaces, and comparisons."""

from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from tehl.api.results import Result, TransientResult, load_as
from tehl.base.errors import FileFormatError
from tehl.io.summary import plain, roughness_block
from tehl.post import micro_film, thermal_effect
from tehl.post.roughness import RoughFilm, rough_film

ISOTHERMAL, SMOOTH = "without heat", "with smooth surfaces"
REFERENCES = {ISOTHERMAL: thermal_effect.isothermal_reference, SMOOTH: micro_film.smooth_reference}
"""Reference runs, and what makes their cases; an InputError without heat or roughness."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Comparisons:
    """What heat and roughness change; None where no reference run was made or it did not converge.

    ``rough_film`` are the numbers of the rough film with the film ``smooth`` between smooth
    surfaces subtracted, ``blocks`` extra blocks of the summary.
    """

    heat: thermal_effect.ThermalEffect | None = None
    roughness: micro_film.RoughnessEffect | None = None
    rough_film: RoughFilm | None = None
    smooth: Result | None = None
    blocks: dict[str, Any] = field(default_factory=dict)


def compare(result: Result, references: dict[str, Result | None]) -> Comparisons:
    """Compare a converged result with its reference runs; None is one that did not converge."""
    cold, smooth = references.get(ISOTHERMAL), references.get(SMOOTH)
    heat = None if cold is None else thermal_effect.thermal_effect(result, cold)
    roughness = None if smooth is None else micro_film.roughness_effect(result, smooth)
    rough = None if smooth is None else rough_film(result, smooth)
    blocks: dict[str, Any] = {}
    if ISOTHERMAL in references:
        blocks["thermal_effect"] = heat and asdict(heat)
    if SMOOTH in references:
        blocks["roughness_effect"] = roughness and asdict(roughness)
    if rough is not None:
        blocks["roughness"] = roughness_block(rough)
    return Comparisons(
        heat=heat, roughness=roughness, rough_film=rough, smooth=smooth, blocks=plain(blocks)
    )


def smooth_file(stored: Path) -> Path:
    """Return the file of the smooth reference run that belongs to a result file."""
    return stored.with_name(f"{stored.stem}.smooth.nc")


def smooth_beside(stored: Path, result: Result | TransientResult) -> Result | None:
    """Return the smooth reference run stored beside a result, None if there is none that fits."""
    path = smooth_file(stored)
    if not isinstance(result, Result) or result.heights is None or not path.is_file():
        return None
    try:
        smooth = load_as(Result, path)
    except FileFormatError:
        return None
    return smooth if micro_film.is_reference(result, smooth) else None
