"""Values extrapolated from the two finest grids: of higher order, and one with the fields."""

from functools import cache

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.api.solvers import certify, solve
from tehl.contact.options import Options
from tehl.result.fields import Fields
from tehl.solver.judging.extrapolation import Outputs, extrapolated
from tehl.solver.judging.richardson import extrapolated_field
from tehl.solver.monitor import SILENT
from tehl.solver.steady import try_strategies
from tests.reference import heated_contact, moes_contact


def sampled(nodes: int) -> Outputs:
    """Return fields on [-1, 1]^2 with an error of second order; the film has a dry half."""
    x = np.linspace(-1.0, 1.0, nodes)
    error = (2.0 / (nodes - 1)) ** 2
    height = 2.0 + x[None, :] * x[:, None] + error * (1.0 + x)[None, :]
    pressure = np.where(x[None, :] > 0, height, 0.0)
    return Outputs(fields=Fields(x=x, y=x, pressure=pressure, film=height + 0 * x[:, None]))


def test_an_error_of_second_order_vanishes_and_zeros_remain():
    found = extrapolated(sampled(65), sampled(33)).fields
    x = found.x
    exact = 2.0 + x[None, :] * x[:, None]
    assert found.film == pytest.approx(exact, abs=1e-14)
    assert (found.pressure[:, x <= 0] == 0).all()
    assert found.pressure[:, x > 0.05] == pytest.approx(exact[:, x > 0.05], abs=1e-14)


def test_an_error_along_x_vanishes_on_grids_with_the_same_lines():
    fine, coarse = (np.ones((5, 1)) * sampled(nodes).fields.film[:1] for nodes in (65, 33))
    exact = np.tile(2.0 - np.linspace(-1.0, 1.0, 65), (5, 1))
    assert extrapolated_field(fine, coarse) == pytest.approx(exact, abs=1e-14)


@cache
def fine_film(case: ContactProblem) -> Result:
    return solve(case, Options(points=769, extrapolate=True))


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize(
    ("case", "nodes"),
    [
        (moes_contact(200.0, 10.0), 193),
        # three grids are heated
        pytest.param(heated_contact(0.5), 257, marks=pytest.mark.slow),
    ],
)
def test_an_eighth_of_the_nodes_gives_the_film_of_a_fine_grid(case, nodes, order):
    higher = Options(points=nodes, extrapolate=True, wedge_order=order)
    coarse, plain = (solve(case, one) for one in (higher, Options(points=nodes)))
    fine = fine_film(case)
    assert coarse.errors.extrapolated or order == 3
    assert not plain.errors.extrapolated
    for name in ("central", "minimum"):
        there = getattr(fine.film_scaled, name)
        error, without = (
            abs(getattr(one.film_scaled, name) / there - 1.0) for one in (coarse, plain)
        )
        assert error < 0.3 * without
        assert error < getattr(coarse.errors, name) < getattr(plain.errors, name)
    # pressure of the extrapolated field carries the load
    x, y, scaled = coarse.scaled.x, coarse.scaled.y, coarse.scaled
    load = np.trapezoid(np.trapezoid(scaled.pressure, x, axis=1), y)
    full = np.trapezoid(np.trapezoid(fine.scaled.pressure, fine.scaled.x, axis=1), fine.scaled.y)
    assert load == pytest.approx(full, rel=2e-3)
    if coarse.heat is not None:
        there = fine.traction.mid_film
        without, off = (abs(one.traction.mid_film / there - 1.0) for one in (plain, coarse))
        assert off < min(without, coarse.errors.traction_mid_film)
        assert coarse.heat.balance.error == pytest.approx(0.0, abs=1e-3)


def test_without_extrapolation_and_on_stated_nodes_the_film_is_that_of_the_grid():
    case = moes_contact(20.0, 10.0)
    plain = solve(case, Options(extrapolate=False))
    assert plain.options.target == 0.02
    stated = solve(case, Options(points=plain.scaled.x.size))
    assert not stated.errors.extrapolated
    assert (stated.scaled.film == plain.scaled.film).all()


def test_error_bars_of_certified_values_need_no_extrapolated_grids():
    found = certify(moes_contact(20.0, 10.0), Options(points=129, extrapolate=True))
    assert not found.errors.extrapolated
    known = solve(moes_contact(20.0, 10.0), Options(error=0.002))
    bar = found.uncertainty["film_central"]
    reach = bar.uncertainty + known.errors.central * bar.value
    assert abs(bar.value - known.film_scaled.central) < reach


def test_an_attempt_at_rest_keeps_its_result_and_frees_its_grids():
    """It waits so while another grid is tried."""
    options = Options(points=257, extrapolate=True, wedge_order=2)
    attempt, result = try_strategies(heated_contact(0.5), options, monitor=SILENT, rough=True)
    finest, resting = attempt.run.finest, attempt.at_rest()
    assert resting.run.levels == [finest]
    assert resting.run.coupling.state is None
    kept, errors = resting.outputs(), resting.run.errors()
    assert errors == result.errors
    assert errors.extrapolated
    for one in ("pressure", "film"):
        assert getattr(kept.fields, one).tolist() == getattr(result.scaled, one).tolist()
    assert kept.extras.heat.temperature.tolist() == result.heat.temperature.tolist()
