"""A thermal film beside its isothermal reference run."""

from dataclasses import asdict, replace

import pytest

from tehl.api.problem import ContactProblem
from tehl.base.errors import InputError
from tehl.io.store import load_summary, save
from tehl.io.summary import from_block
from tehl.post.thermal_effect import (
    ThermalEffect,
    isothermal_reference,
    thermal_effect,
)
from tests.fixtures_result import CASE


@pytest.fixture(scope="module")
def warm() -> ContactProblem:
    oil = {**CASE["lubricant"], "conductivity": 0.14, "heat_capacity": 2000.0}
    oil["viscosity"] = {**oil["viscosity"], "gamma": 0.042}
    hot = {"surface_1": {"material": "steel", "temperature": 350.0}}
    return ContactProblem.model_validate(
        {**CASE, **hot, "lubricant": oil, "thermal": {"temperature": 333.15}}
    )


def test_the_reference_run_is_an_isothermal_case(warm):
    reference = isothermal_reference(warm)
    assert ContactProblem.model_validate(reference.model_dump(mode="json")) == reference
    assert reference.thermal is None
    assert reference.inlet_temperature == warm.inlet_temperature == 333.15
    assert reference.ambient_viscosity == warm.ambient_viscosity < 0.04
    assert isothermal_reference(warm).contact == warm.contact


def test_a_case_without_heat_has_no_reference_run(result):
    with pytest.raises(InputError, match=r"\[thermal\]"):
        isothermal_reference(result.problem)


def test_the_effect_is_thermal_over_isothermal(result, warm):
    numbers = replace(result.film_scaled, central=0.09, minimum=0.03)
    hot = replace(result, problem=warm, film_scaled=numbers)
    effect = thermal_effect(hot, result)
    assert effect.central == pytest.approx(0.09 / result.film_scaled.central)
    assert effect.minimum == pytest.approx(0.03 / result.film_scaled.minimum)
    assert effect.isothermal_h_central_m == result.film.central
    assert "Wilson-Sheu" in [factor.formula for factor in effect.inlet_factors]


def test_the_effect_survives_a_file(result, warm, tmp_path):
    effect = thermal_effect(replace(result, problem=warm), result)
    save(result, tmp_path / "warm.nc", extra={"thermal_effect": asdict(effect)})
    block = load_summary(tmp_path / "warm.nc")["thermal_effect"]
    assert from_block(ThermalEffect, block) == effect
