"""Stopping on a small change, as much of the literature does."""

import pytest

from tehl.api.results import ConvergenceError
from tehl.api.solvers import solve
from tehl.contact.options import Domain, Options
from tests.cases import moes_problem

DOMAIN = Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))
CHANGE = Options(points=65, domain=DOMAIN, accuracy="change", smoother="fast")


def test_cycles_end_when_one_changes_the_pressure_by_a_ten_thousandth():
    result = solve(moes_problem(40.0, 10.0), CHANGE)
    last, before = result.history[-1], result.history[-2]
    assert last.mean_change <= 1e-4 < before.mean_change
    assert result.status.converged


def test_it_takes_more_cycles_than_the_discretisation_error_needs():
    usual = CHANGE.model_copy(update={"accuracy": "discretisation"})
    problem = moes_problem(40.0, 10.0)
    assert solve(problem, usual).history[-1].cycle < solve(problem, CHANGE).history[-1].cycle


def test_too_few_cycles_are_reported_at_this_accuracy_too():
    options = CHANGE.model_copy(update={"max_cycles": 1})
    with pytest.raises(ConvergenceError) as caught:
        solve(moes_problem(40.0, 10.0), options)
    status = caught.value.result.status
    assert (status.kind, status.cause) == ("not_converged", "too_few_cycles")
    assert "accuracy" in str(status.hint)
