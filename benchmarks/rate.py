"""Convergence rate: reduction of the error of H per V(2,2) cycle after full multigrid."""

from itertools import pairwise

import numpy as np
from tests.reference import DOMAIN, moes_contact

from benchmarks.measure import multigrid
from benchmarks.table import Table
from tehl.api.problem import ContactProblem
from tehl.base.typing import Array
from tehl.contact.options import Options
from tehl.solver.cycle.film_solver import FilmSolver

CASES = ((20, 10), (57.21, 10.52), (100, 12.04), (200, 10), (500, 10), (1000, 10))
SIZES = (129, 257, 513)
CYCLES = 5
MORE_CYCLES = 20
"""Further cycles, which give the converged solution of the same grid."""
RADIUS = 1.2


def one_cycle(run: FilmSolver) -> Array:
    """Run one cycle from the finest level; return the film inside r < 1.2."""
    run.hierarchy.cycle(run.levels)
    return film_inside(run)


def film_inside(run: FilmSolver) -> Array:
    """Return the film at the nodes with X^2 + Y^2 < 1.2^2."""
    run.finest.update()
    grid = run.finest.grid
    inside = grid.x[None, :] ** 2 + grid.y[:, None] ** 2 < RADIUS**2
    return run.finest.film.h[inside]


def errors_by_cycle(problem: ContactProblem, points: int) -> list[float]:
    """Return the RMS error of H after full multigrid and after each of five more cycles.

    Full multigrid takes the two cycles per grid that the default accuracy needs at least; the
    error is against the converged solution of the same grid.
    """
    run = multigrid(problem, Options(points=points, domain=DOMAIN, max_cycles=2))
    run.solve(force=True)
    films = [film_inside(run), *(one_cycle(run) for _ in range(CYCLES))]
    for _ in range(MORE_CYCLES):
        converged = one_cycle(run)
    return [float(np.sqrt(np.mean((film - converged) ** 2))) for film in films]


def mean_rate(errors: list[float]) -> float:
    """Return the geometric mean of the reduction per cycle."""
    return (errors[-1] / errors[0]) ** (1.0 / (len(errors) - 1))


def table(*, quick: bool = False) -> Table:
    """Return rates by case and grid."""
    sizes = (129,) if quick else SIZES
    made = Table(
        title="Rate per V(2,2), cycles 1-5 after full multigrid, RMS error of H in r < 1.2",
        columns=("M", "L", *(f"{n}^2" for n in sizes), "cycle by cycle on the finest"),
    )
    for load, speed in CASES:
        errors = [errors_by_cycle(moes_contact(load, speed), n) for n in sizes]
        last = errors[-1]
        steps = [f"{b / a:.2f}" for a, b in pairwise(last)]
        made.rows.append((load, speed, *(f"{mean_rate(e):.3f}" for e in errors), " ".join(steps)))
    return made
