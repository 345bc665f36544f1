"""Bodies warmer than the oil, and a heat balance that does not close."""

import pytest

import tehl.solver.judging.verdict as judge
from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError, Result
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tests.reference import heated_contact


def warmer(kelvin: float) -> ContactProblem:
    """Return the heated reference contact with surface 1 warmer than the oil."""
    case = heated_contact(0.5).model_dump(exclude_none=True)
    case["surface_1"]["temperature"] = 313.0 + kelvin
    return ContactProblem.model_validate(case)


def test_a_warm_body_warms_the_film_within_bounds_and_thins_it():
    warm, even = (solve(warmer(kelvin), Options(points=129)) for kelvin in (30.0, 0.0))
    assert warm.heat is not None
    assert even.heat is not None
    assert warm.heat.temperature.min() > 313.0 - 1.0
    assert warm.heat.temperature.max() < even.heat.temperature.max() + 30.0
    assert warm.film_scaled.central < even.film_scaled.central
    assert abs(warm.heat.balance.error) < 0.15


def test_a_heat_balance_that_does_not_close_is_a_failure(monkeypatch):
    monkeypatch.setattr(judge, "LARGEST_MISSING_HEAT", 1e-9)
    with pytest.raises(ConvergenceError, match="does not balance") as caught:
        solve(heated_contact(0.5), Options(points=65))
    result = caught.value.result
    assert isinstance(result, Result)
    assert result.status.cause == "heat_not_balanced"
