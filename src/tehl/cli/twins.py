"""The twins of a case, without heat or between smooth surfaces, and what they show."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tehl.post.micro_film import RoughnessEffect
    from tehl.post.roughness import RoughFilm
    from tehl.post.thermal_effect import ThermalEffect
    from tehl.problem import ContactProblem
    from tehl.result import Result

COLD, SMOOTH = "without heat", "between smooth surfaces"
"""What a twin is, in words."""

Solve = Callable[["ContactProblem", str], "Result | None"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Twins:
    """The twins that were asked for.

    Attributes
    ----------
    cold, smooth : ContactProblem or None
        The case without heat, and between smooth surfaces; None if nobody asked.
    """

    cold: "ContactProblem | None" = None
    smooth: "ContactProblem | None" = None

    @property
    def wanted(self) -> bool:
        """Return whether there is one."""
        return self.cold is not None or self.smooth is not None


@dataclass(frozen=True, kw_only=True, slots=True)
class Effects:
    """What the twins showed.

    Attributes
    ----------
    heat, roughness : ThermalEffect, RoughnessEffect or None
        The comparisons; None without a twin that has an answer.
    smooth : Result or None
        The film between smooth surfaces.
    blocks : dict
        What the summary says more for it.
    """

    heat: "ThermalEffect | None" = None
    roughness: "RoughnessEffect | None" = None
    rough_film: "RoughFilm | None" = None
    smooth: "Result | None" = None
    blocks: dict[str, Any] = field(default_factory=dict)


def twins_of(problem: "ContactProblem", *, cold: bool, smooth: bool) -> Twins:
    """Return the twins of a case that are asked for.

    Raises
    ------
    InputError
        If the case has no heat or no roughness to leave out.
    """
    from tehl.post.micro_film import smooth_twin
    from tehl.post.thermal_effect import isothermal_twin

    return Twins(
        cold=isothermal_twin(problem) if cold else None,
        smooth=smooth_twin(problem) if smooth else None,
    )


def effects_of(result: "Result", twins: Twins, solve: Solve) -> Effects:
    """Solve the twins and return what they show.

    Parameters
    ----------
    result : Result
        Of the case itself, converged.
    twins : Twins
        What to compare it with.
    solve : callable
        Returns the result of a twin, named in words; None when it has no answer.
    """
    cold = None if twins.cold is None else solve(twins.cold, COLD)
    smooth = None if twins.smooth is None else solve(twins.smooth, SMOOTH)
    found = dict(_found(result, cold, smooth))
    return Effects(**found, smooth=smooth, blocks=_blocks(twins, found))


def _found(
    result: "Result", cold: "Result | None", smooth: "Result | None"
) -> Iterator[tuple[str, Any]]:
    if cold is not None:
        from tehl.post.thermal_effect import thermal_effect

        yield "heat", thermal_effect(result, cold)
    if smooth is not None:
        from tehl.post.micro_film import roughness_effect
        from tehl.post.roughness import rough_film

        yield "roughness", roughness_effect(result, smooth)
        yield "rough_film", rough_film(result, smooth)


def _blocks(twins: Twins, found: dict[str, Any]) -> dict[str, Any]:
    """Return the blocks of the summary; null where a twin has no answer."""
    from tehl.io.summary import plain, roughness_block
    from tehl.post import micro_film, thermal_effect

    blocks: dict[str, Any] = {}
    if twins.cold is not None:
        heat = found.get("heat")
        blocks["thermal_effect"] = heat and thermal_effect.effect_block(heat)
    if twins.smooth is not None:
        rough = found.get("roughness")
        blocks["roughness_effect"] = rough and micro_film.effect_block(rough)
    if found.get("rough_film") is not None:
        blocks["roughness"] = roughness_block(found["rough_film"])
    plain_blocks: dict[str, Any] = plain(blocks)
    return plain_blocks


def smooth_file(stored: Path) -> Path:
    """Return where the film between smooth surfaces lies that belongs to a result file."""
    return stored.with_name(f"{stored.stem}.smooth.nc")


def smooth_beside(stored: Path, result: "Result") -> "Result | None":
    """Return the film between smooth surfaces beside a result file; None without one that fits."""
    from tehl.errors import FileFormatError
    from tehl.io.store import load_as
    from tehl.post.micro_film import is_twin
    from tehl.result import Result

    path = smooth_file(stored)
    if result.heights is None or not path.is_file():
        return None
    try:
        smooth = load_as(Result, path)
    except FileFormatError:
        return None
    return smooth if is_twin(result, smooth) else None
