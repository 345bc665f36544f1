"""Load or compile the kernels before a clock starts."""

from functools import cache
from typing import Any

import numpy as np

from tehl.grid import Grid
from tehl.kernels import energy, reynolds
from tehl.operators.energy import FilmState, HeatedFilm
from tehl.operators.film import hertz_pressure
from tehl.operators.flow import flow_table
from tehl.operators.influence import influence_of
from tehl.operators.multilevel import MultilevelDeformation
from tehl.operators.reynolds import stencil
from tehl.operators.trail import Trail
from tehl.options import Domain, Options
from tehl.problem import ContactProblem
from tehl.scaling import ScaledProblem
from tehl.solver.fas import Cycle, cycle
from tehl.solver.hierarchy import Hierarchy
from tehl.solver.relaxation import FAST

CASE: dict[str, Any] = {
    "contact": {"radius": 0.01, "moes_load": 20, "moes_speed": 10},
    "surface_1": {"material": "steel"},
    "surface_2": {"material": "steel"},
    "lubricant": {
        "viscosity": {"law": "roelands", "eta_0": 0.04, "alpha": 22e-9},
        "density": {"law": "dowson-higginson", "rho_0": 890},
    },
}
"""A light contact that every kernel of the default solver has to do with."""
DOMAIN = Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))


COUPLED_CASE = CASE | {
    "contact": {"radius": 0.01, "moes_load": 20, "moes_speed": 10, "slide_roll_ratio": 0.1},
    "lubricant": CASE["lubricant"] | {"shear": {"law": "eyring", "stress": 5e6}},
}


def warm_up(*, coupled: bool) -> None:
    """Run one cycle once per process, so that the cost of a result is that of solving.

    Parameters
    ----------
    coupled : bool
        A heated or shear-thinning film is to be solved: its kernels too.
    """
    _one_cycle()
    if coupled:
        _one_sweep()


@cache
def _one_sweep() -> None:
    """Evaluate a sheared film once."""
    scaled = ScaledProblem.of(ContactProblem.model_validate(COUPLED_CASE))
    grid = Grid(nx=33, ny=33, domain=DOMAIN, mirror=True)
    state = FilmState(grid, HeatedFilm(scaled), 2)
    state.set_film(hertz_pressure(grid), np.ones(grid.shape))
    state.sweep(1)
    energy.sweep_back(state.known)
    Trail(np.ones((5, energy.BLOCK)), 0.1, 1.0)
    film = reynolds.Film(*(np.ones(grid.shape) for _ in range(7)))
    flow = flow_table(scaled)
    factors, heated = reynolds.Factors(*film[:5]), reynolds.Heated(*film[:5])
    reynolds.factors_of(heated, film, flow.table, flow.step, factors)
    reynolds.heated_properties(film, factors, flow.table, flow.step, 0.0)
    reynolds.tangent_source(film, stencil(grid, scaled.groups, 2), np.empty(grid.shape))


@cache
def _one_cycle() -> None:
    scaled = ScaledProblem.of(ContactProblem.model_validate(CASE))
    grid = Grid(nx=129, ny=129, domain=DOMAIN, mirror=True)
    run = Hierarchy.on(grid, scaled, Options(), FAST)
    run.finest.pose_problem()
    run.finest.set_state(hertz_pressure(grid), 0.0)
    cycle(run.levels, run.coarsest.step, Cycle(kind="V", pre_sweeps=1, post_sweeps=0), extra=0)
    run.finest.update()
    run.finest.evaluate_residual()
    far = MultilevelDeformation(grid, influence_of(grid, scaled.groups))  # of finer grids
    far.deflect(run.finest.film.p, np.empty(grid.shape))
