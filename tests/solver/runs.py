"""Runs of the solver that several tests share, each done once."""

from functools import cache

import pytest
from benchmarks.any_contacts import contact

from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.api.solvers import solve
from tehl.base.typing import Array
from tehl.contact.options import Options
from tehl.estimate.nodes import finest_grid
from tehl.estimate.scaling import ScaledProblem
from tehl.operators.energy import FilmState
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.ladder import SMOOTH
from tehl.solver.cycle.relaxation import FAST
from tests.reference import DOMAIN, moes_contact

TIGHT = {"accuracy": "tight", "domain": DOMAIN}


def tight(points: int | tuple[int, int], **changes: object) -> Options:
    """Return options of a run to 1e-6 on the domain of most published films."""
    return Options.model_validate({"points": points, **TIGHT, **changes})


@cache
def film_of(load: float, speed: float, options: Options, radius_ratio: float = 1.0) -> Result:
    """Return the result of a contact given by M and L."""
    return solve(moes_contact(load, speed, radius_ratio=radius_ratio), options)


def multigrid(problem: ContactProblem, options: Options) -> FilmSolver:
    """Return the hierarchy that `solve` would cycle on."""
    scaled = ScaledProblem.of(problem)
    grid = finest_grid(scaled, options)
    return FilmSolver(Hierarchy.on(grid, scaled, options, FAST), SMOOTH[0])


def mixed_line(**changes: object) -> ContactProblem:
    """Return a flooded line, M = 29 and L = 0.5, whose asperities carry most of the load."""
    drawn = contact(431, 30)[2]  # with a dent and scarce oil
    smooth = drawn.surface_2.model_copy(update={"roughness": drawn.surface_1.roughness})
    return drawn.model_copy(update={"surface_2": smooth, "supply": None} | changes)


def rubbed_states(monkeypatch: pytest.MonkeyPatch) -> list[FilmState]:
    """Return the list to which films whose solids rub are added as they do."""
    states, rub = list[FilmState](), FilmState.rub

    def note(self: FilmState, *given: Array) -> None:
        rub(self, *given)
        states.append(self)

    monkeypatch.setattr(FilmState, "rub", note)
    return states
