"""Bodies warmer than the oil, and heat that does not balance."""

import pytest

import tehl.solver.verdict as judge
from tehl.errors import ConvergenceError
from tehl.options import Options
from tehl.problem import ContactProblem
from tehl.result import Result
from tehl.solver import solve
from tests.reference import heated_contact


def warmer(kelvin: float) -> ContactProblem:
    """The heated reference contact with a surface 1 above the oil."""
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


def test_heat_that_does_not_balance_is_no_answer(monkeypatch):
    monkeypatch.setattr(judge, "LARGEST_MISSING_HEAT", 1e-9)
    with pytest.raises(ConvergenceError, match="does not balance") as told:
        solve(heated_contact(0.5), Options(points=65))
    result = told.value.result
    assert isinstance(result, Result)
    assert result.status.cause == "heat_not_balanced"
