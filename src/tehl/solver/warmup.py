"""Load or compile the kernels before a clock starts."""

from functools import cache

from tehl.grid import Grid
from tehl.operators.flow import flow_table
from tehl.options import Domain, Options
from tehl.problem import ContactProblem
from tehl.scaling import groups, scales
from tehl.solver.monitor import SILENT
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
    """Run a small solve once per process, so that the cost of a result is that of solving."""
    problem = ContactProblem.model_validate(CASE)
    options = Options(points=65, domain=Domain(x=(-4.5, 1.5), y=(-3.0, 3.0)), max_cycles=1)
    case_groups = groups(problem)
    flow = flow_table(problem, scales(problem), case_groups)
    grid = Grid(nx=65, ny=65, domain=Domain(x=(-4.5, 1.5), y=(-3.0, 3.0)), mirror=True)
    Multigrid(grid, case_groups, flow, options, FAST).solve(SILENT, patient=True)
