"""Inlet heating factors against the published expressions."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tehl.api.problem import ContactProblem
from tehl.estimate.inlet_heating import (
    gupta,
    inlet_factors,
    inlet_heating_factor,
    murch_wilson,
    wilson_sheu,
)
from tests.cases import ball_tables


def test_inlet_heating_thins_the_film_more_with_speed_and_slip():
    def factor(speed: float, slip: float) -> float | None:
        contact = {"radius": 0.02, "load": 80, "entrainment_speed": speed}
        return inlet_heating_factor(
            ContactProblem.model_validate(
                ball_tables(contact=contact | {"slide_roll_ratio": slip}, lubricant="mineral-oil")
            )
        )

    slow, fast, sliding = factor(0.1, 0), factor(20, 0), factor(20, 0.5)
    assert slow is not None
    assert fast is not None
    assert sliding is not None
    assert 1 > slow > fast > sliding > 0
    # Wilson and Sheu, pure rolling: 1 / (1 + 0.241 L^0.64) with L = eta_0 gamma u^2 / k.
    assert fast == pytest.approx(1 / (1 + 0.241 * (0.04 * 0.042 * 400 / 0.14) ** 0.64))
    assert factor(1, 3.0) is None
    assert inlet_heating_factor(ContactProblem.model_validate(ball_tables())) is None


def test_the_inlet_factors_are_their_published_forms():
    # Murch and Wilson also write 3.94 / (3.94 + L^0.62)
    assert murch_wilson(2.0) == pytest.approx(3.94 / (3.94 + 2**0.62), rel=2e-3)
    assert wilson_sheu(1.0, 0.0) == pytest.approx(1 / 1.241)
    assert wilson_sheu(1.0, 2.0) == pytest.approx(1 / (1 + 0.241 * 15.8))
    # sliding with a surface at rest leaves about a fifth of the film of rolling, at high L
    assert wilson_sheu(20.0, -2.0) / wilson_sheu(20.0, 0.0) == pytest.approx(0.2, abs=0.12)
    assert gupta(1.0, 0.5, 0.004) == pytest.approx(
        (1 - 13.2 * 0.004) / (1 + 0.213 * (1 + 2.23 * 0.5**0.83))
    )


@given(loading=st.floats(min_value=1e-4, max_value=1.0))
def test_the_inlet_factors_of_rolling_agree_within_their_scatter(loading: float):
    rolling = wilson_sheu(loading, 0.0)
    assert murch_wilson(loading) == pytest.approx(rolling, rel=0.02)
    assert gupta(loading, 0.0, 0.003) == pytest.approx(rolling, rel=0.1)


def test_the_inlet_factors_report_where_they_do_not_hold():
    def remarks(slip: float, speed: float = 2.0) -> list[bool]:
        contact = {"radius": 0.02, "load": 80, "entrainment_speed": speed}
        tables = ball_tables(contact=contact | {"slide_roll_ratio": slip}, lubricant="mineral-oil")
        factors = inlet_factors(ContactProblem.model_validate(tables))
        return [bool(factor.remarks) for factor in factors]

    assert remarks(0.0) == [False, False, False]
    assert remarks(0.5) == [True, False, False]
    assert remarks(3.0) == [True, True, True]
    assert remarks(0.0, speed=1000.0) == [False, False, True]
    assert inlet_factors(ContactProblem.model_validate(ball_tables())) == ()


def test_the_thermal_loading_is_taken_at_the_inlet():
    cold = ContactProblem.model_validate(ball_tables(lubricant="mineral-oil"))
    oil = {"name": "mineral-oil", "temperature": "80 degC"}
    warm = ContactProblem.model_validate(ball_tables(lubricant=oil))
    assert cold.thermal_loading == pytest.approx(0.04 * 0.042 * 1.5**2 / 0.14)
    assert warm.thermal_loading < 0.3 * cold.thermal_loading  # type: ignore[operator]
