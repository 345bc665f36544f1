"""Reference runs of a steady case, without heat or with smooth surfaces, and comparisons."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tehl.errors import FileFormatError
from tehl.io.store import load_as
from tehl.io.summary import plain, roughness_block
from tehl.post import micro_film, thermal_effect
from tehl.post.roughness import RoughFilm, rough_film
from tehl.problem import ContactProblem
from tehl.result import Result
from tehl.transient_result import TransientResult

ISOTHERMAL, SMOOTH = "without heat", "with smooth surfaces"
"""Reference runs."""


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


def reference_cases(
    problem: ContactProblem, *, isothermal: bool, smooth: bool
) -> dict[str, ContactProblem]:
    """Return the cases to solve for comparison, by the name of the reference run.

    Parameters
    ----------
    problem : ContactProblem
        The case itself.
    isothermal, smooth : bool
        Leave out its heat; leave out its roughness.

    Raises
    ------
    InputError
        If the case has no heat or no roughness to leave out.
    """
    cases = {}
    if isothermal:
        cases[ISOTHERMAL] = thermal_effect.isothermal_reference(problem)
    if smooth:
        cases[SMOOTH] = micro_film.smooth_reference(problem)
    return cases


def compare(
    result: Result,
    cases: dict[str, ContactProblem],
    solve: Callable[[ContactProblem, str], Result | None],
) -> Comparisons:
    """Solve the reference cases and compare a result with them.

    Parameters
    ----------
    result : Result
        Of the case itself, converged.
    cases : dict
        What :func:`reference_cases` returned.
    solve : callable
        Returns the result of a case, given its name too; None if it did not converge.
    """
    found = {name: solve(case, name) for name, case in cases.items()}
    cold, smooth = found.get(ISOTHERMAL), found.get(SMOOTH)
    heat = None if cold is None else thermal_effect.thermal_effect(result, cold)
    roughness = None if smooth is None else micro_film.roughness_effect(result, smooth)
    rough = None if smooth is None else rough_film(result, smooth)
    blocks: dict[str, Any] = {}
    if ISOTHERMAL in cases:
        blocks["thermal_effect"] = heat and thermal_effect.effect_block(heat)
    if SMOOTH in cases:
        blocks["roughness_effect"] = roughness and micro_film.effect_block(roughness)
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
