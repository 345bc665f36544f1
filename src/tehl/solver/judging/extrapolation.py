"""Richardson extrapolation of fields on two grids: f + (f_h - f_2h) / 3 of second-order values."""

from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, TypeVar

import numpy as np

from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.operators.energy import FilmState
from tehl.result.fields import Fields, HeatBalance
from tehl.result.solution import Extras
from tehl.solver.cycle.level import Level
from tehl.solver.judging.measures import tilt_of
from tehl.solver.judging.outputs import (
    film_asperities,
    film_contact,
    film_heat,
    film_oil,
    film_shear,
    newtonian_shear,
)
from tehl.solver.judging.richardson import WEIGHT, extrapolated_field

AnyFields = TypeVar("AnyFields")

ODD = ("across",)
"""Fields with another sign beyond a line of symmetry along x."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Outputs:
    """Fields of a film on one grid, on the rows that it stores or, `unfolded`, on all."""

    fields: Fields
    extras: Extras = Extras()  # noqa: RUF009 (frozen)


def outputs_of(
    level: Level, scaled: ScaledProblem, state: FilmState | None, *, valid: bool = True
) -> Outputs:
    """Return the fields of a level, on the rows that its grid stores.

    Parameters
    ----------
    level, scaled : Level, ScaledProblem
        The grid with its film up to date, and the contact.
    state : FilmState or None
        Temperature and stress of a heated or thinning film.
    valid : bool
        Whether the film is one that has stresses and temperatures.
    """
    grid, shear, heat = level.grid, None, None
    if valid and level.film.h.min() > 0.0:
        if not scaled.problem.is_coupled:
            shear = newtonian_shear(level, scaled)
        elif state is not None and state.grid == grid:
            shear, heat = film_shear(state), film_heat(state)
    full = replace(grid, mirror=False)
    return Outputs(
        fields=Fields(
            x=full.x,
            y=full.y,
            pressure=np.maximum(level.film.p, 0.0),
            film=level.film.h.copy(),
        ),
        extras=Extras(
            shear=shear,
            heat=heat,
            asperities=film_asperities(level, scaled),
            contact=film_contact(level, scaled),
            oil=film_oil(level, scaled),
            tilt=tilt_of(level),
        ),
    )


def extrapolated(fine: Outputs, coarse: Outputs) -> Outputs:
    """Return the fields of the finer of two grids plus a third of their difference.

    The difference at the nodes of the coarser grid is interpolated linearly: it is of second order,
    so that the error is of fourth. Where the oil is stays that of the finer grid: its edge moves.

    Parameters
    ----------
    fine, coarse : Outputs
        On grids of one domain, whose intervals differ by a factor of two.
    """
    found = _combined(fine, coarse)
    return replace(found, extras=replace(found.extras, oil=fine.extras.oil))


def _combined(fine: AnyFields, coarse: AnyFields) -> AnyFields:
    """Return the fields, all arrays with the nodes of a grid on their last axes, of a dataclass."""
    changes = {}
    for one in fields(fine):  # type: ignore[arg-type]
        value, before = getattr(fine, one.name), getattr(coarse, one.name)
        if is_dataclass(value) and before is not None:
            changes[one.name] = _combined(value, before)
        elif isinstance(value, np.ndarray) and value.ndim > 1:
            changes[one.name] = extrapolated_field(value, before)
        elif isinstance(fine, HeatBalance):
            changes[one.name] = value + WEIGHT * (value - before)
    return replace(fine, **changes)  # type: ignore[type-var]


def unfolded(found: AnyFields, grid: Grid) -> AnyFields:
    """Return fields, all arrays with the nodes of a grid on their last axes, on the full domain.

    Parameters
    ----------
    found : Outputs or dataclass
        On the rows that a grid stores.
    grid : Grid
        That grid.
    """
    if not grid.mirror:
        return found
    changes: dict[str, Any] = {}
    for one in fields(found):  # type: ignore[arg-type]
        value = getattr(found, one.name)
        if is_dataclass(value):
            changes[one.name] = unfolded(value, grid)
        elif isinstance(value, np.ndarray) and value.ndim > 1:
            image = value[..., :0:-1, :]
            image = -image if one.name in ODD else image
            changes[one.name] = np.concatenate([image, value], axis=-2)
    return replace(found, **changes)  # type: ignore[type-var]
