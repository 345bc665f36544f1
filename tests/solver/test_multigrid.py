"""Multigrid efficiency on small grids: rate of the cycle, and accuracy of full multigrid."""

import numpy as np
import pytest

from tehl.api.solvers import solve
from tehl.contact.options import Options
from tests.reference import DOMAIN, moes_contact
from tests.solver.runs import film_of, multigrid, tight

LARGEST_RATE = {20.0: 0.25, 200.0: 0.3}
"""RMS error of the film in the contact per V(2,2); measured 0.1 to 0.25 on these grids."""


def film_errors(load: float, points: int) -> list[float]:
    """RMS error of H in r < 1.2 after full multigrid and after each of five more cycles."""
    run = multigrid(moes_contact(load, 10.0), Options(points=points, domain=DOMAIN, max_cycles=2))
    run.solve(force=True)
    grid = run.finest.grid
    inside = grid.x[None, :] ** 2 + grid.y[:, None] ** 2 < 1.2**2
    films = []
    for _ in range(21):
        run.finest.update()
        films.append(run.finest.film.h[inside])
        run.hierarchy.cycle(run.levels)
    return [float(np.sqrt(np.mean((film - films[-1]) ** 2))) for film in films[:6]]


@pytest.mark.parametrize("load", [20.0, 200.0])
@pytest.mark.parametrize("points", [65, 129])
def test_each_cycle_reduces_the_error_by_the_same_factor_on_every_grid(load, points):
    errors = film_errors(load, points)
    assert (errors[-1] / errors[0]) ** (1 / 5) < LARGEST_RATE[load]


@pytest.mark.parametrize("load", [20.0, 200.0])
def test_full_multigrid_stops_below_the_discretisation_error(load):
    default = solve(moes_contact(load, 10.0), Options(points=129, domain=DOMAIN))
    exact, finer = (film_of(load, 10.0, tight(n)).film_scaled for n in (129, 257))
    for name in ("central", "minimum"):
        iteration = abs(getattr(default.film_scaled, name) - getattr(exact, name))
        discretisation = 4 / 3 * abs(getattr(exact, name) - getattr(finer, name))
        assert iteration < discretisation / 3


@pytest.mark.parametrize("load", [20.0, 200.0])
def test_the_error_bar_contains_the_finer_film(load):
    coarse, fine = (
        solve(moes_contact(load, 10.0), Options(points=n, domain=DOMAIN)) for n in (129, 257)
    )
    assert coarse.errors is not None
    for name in ("central", "minimum"):
        bar = getattr(coarse.errors, f"discretisation_{name}")
        bar += getattr(coarse.errors, f"iteration_{name}")
        value, finer = getattr(coarse.film_scaled, name), getattr(fine.film_scaled, name)
        assert abs(finer - value) < bar * value


def test_residual_change_and_load_error_reach_the_tolerance():
    run = film_of(200.0, 10.0, tight(129))
    last = run.history[-1]
    assert max(last.residual, last.change, abs(last.load_error)) <= run.options.tolerance
    assert last.points == (129, 129)


def test_the_history_contains_every_grid_from_coarse_to_fine():
    points = [report.points[0] for report in film_of(20.0, 10.0, tight(129)).history]
    assert sorted(set(points)) == [33, 65, 129]
    assert points == sorted(points)
