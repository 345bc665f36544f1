"""Load or compile the kernels before a clock starts."""

from functools import cache

from tehl.grid import Grid
from tehl.operators.film import hertz_pressure
from tehl.operators.flow import flow_table
from tehl.options import Domain, Options
from tehl.problem import ContactProblem
from tehl.scaling import groups, scales
from tehl.solver.fas import Cycle, cycle
from tehl.solver.multigrid import Multigrid
from tehl.solver.smoother import FAST

CASE = {
    "contact": {"radius": 0.01, "moes_load": 20, "moes_speed": 10},
    "surface_1": {"material": "steel"},
    "surface_2": {"material": "steel"},
    "lubricant": {
        "viscosity": {"law": "roelands", "eta_0": 0.04, "alpha": 22e-9},
        "density": {"law": "dowson-higginson", "rho_0": 890},
    },
}
"""A light contact that every kernel of the default solver has to do with."""


@cache
def warm_up() -> None:
    """Run one cycle once per process, so that the cost of a result is that of solving."""
    problem = ContactProblem.model_validate(CASE)
    domain = Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))
    case_groups = groups(problem)
    flow = flow_table(problem, scales(problem), case_groups)
    grid = Grid(nx=129, ny=129, domain=domain, mirror=True)
    run = Multigrid(grid, case_groups, flow, Options(), FAST)
    run.finest.pose_problem()
    run.finest.film.p[:] = hertz_pressure(grid)
    cycle(run.levels, run.coarsest.step, Cycle(kind="V", pre_sweeps=1, post_sweeps=0), extra=0)
    run.finest.update()
    run.finest.evaluate_residual()
