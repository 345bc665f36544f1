"""The JSON summary: keys of the contract, SI against scaled values, never NaN."""

import json
import math
from dataclasses import replace

import pytest

from tehl.io.summary import summary
from tehl.result.families import moes_film_factor

KEYS = {
    "groups": "M L U W G lambda_bar alpha_bar hertz_pressure_pa hertz_half_width_m",
    "film": "h_min_m h_central_m H_min H_min_node H_central H_min_moes H_central_moes minimum_at",
    "pressure": "max_pa P_max P_central",
    "convergence": "cycles residual load_error heat_balance_error",
    "cost": "points cpu_seconds wall_seconds work",
    "laws": "viscosity density shear reynolds",
}


@pytest.mark.parametrize("block", KEYS)
def test_the_agreed_keys_are_there(result, block):
    assert set(KEYS[block].split()) <= set(summary(result)[block])


def test_error_bars_of_the_film_are_the_sum_of_their_parts(result):
    errors = summary(result)["errors"]
    assert errors["central"] == pytest.approx(1e-3 + 1e-4)
    assert errors["minimum"] == pytest.approx(4e-3 + 2e-4)


def test_temperature_and_traction_do_not_apply(result):
    content = summary(result)
    assert content["temperature"] is None
    assert content["traction"] is None
    assert content["heat"] is None
    assert content["convergence"]["heat_balance_error"] is None
    assert content["laws"]["reynolds"] == "isothermal"


THERMAL_KEYS = {
    "temperature": "film_rise_max_k mid_film_rise_central_k surface_1_rise_max_k "
    "surface_2_rise_max_k film_rise_max_at mean_rise_central_k inlet_k",
    "traction": "surface_1 mid_film surface_2 sliding rolling closure_error friction_power_w "
    "sliding_power_w",
    "heat": "shear_w compression_w surface_1_w surface_2_w carried_out_w solid_peclet sources",
}


@pytest.mark.parametrize("block", THERMAL_KEYS)
def test_the_keys_of_a_thermal_run_are_there(thermal, block):
    assert set(THERMAL_KEYS[block].split()) <= set(summary(thermal)[block])


def test_the_numbers_of_a_thermal_run_are_those_of_the_result(thermal):
    content = summary(thermal)
    assert content["temperature"]["film_rise_max_k"] == thermal.temperature.film_rise_max
    assert content["traction"]["surface_1"] == thermal.traction.surface_1
    assert content["heat"]["sources"] == ["line", "full"]
    assert content["convergence"]["heat_balance_error"] == thermal.heat.balance.error
    json.dumps(content, allow_nan=False)


def test_traction_needs_no_heat(sheared):
    content = summary(sheared)
    assert content["traction"]["mid_film"] < 0
    assert content["temperature"] is None


def test_error_bars_of_heat_and_traction_mirror_theirs(certified, thermal):
    bar = certified.uncertainty["film_central"]
    names = ("film_rise_max", "traction_mid_film")
    blocks = summary(replace(thermal, uncertainty=dict.fromkeys(names, bar)))["uncertainty"]
    assert blocks["temperature"]["film_rise_max_k"]["value"] == 0.101
    assert blocks["traction"]["mid_film"]["uncertainty"] == 0.002


def test_film_in_metres_and_in_units_of_moes(result):
    film, scales = summary(result)["film"], result.scales
    assert film["h_central_m"] == pytest.approx(0.1 * scales.half_width_x**2 / 0.02)
    expected = (1.5 * result.groups.M) ** (2 / 3)
    assert moes_film_factor(result) == pytest.approx(expected)


def test_pressure_at_the_centre_is_that_of_hertz(result):
    assert summary(result)["pressure"]["P_central"] == pytest.approx(1.0)


def test_numbers_that_are_not_finite_become_null(stalled):
    film = replace(stalled.film_scaled, minimum=math.nan)
    content = summary(replace(stalled, film_scaled=film))
    assert content["film"]["H_min"] is None
    assert content["film"]["h_min_m"] is None
    json.dumps(content, allow_nan=False)


def test_a_failure_names_cause_and_hint(stalled):
    content = summary(stalled)
    assert content["status"] == "stalled"
    assert content["cause"] == "grid_too_coarse"
    assert content["hint"] == "take points = 513"


def test_error_bars_mirror_the_values(certified):
    content = summary(certified)
    blocks = content["uncertainty"]
    for block, key in (("film", "H_min"), ("film", "h_central_m"), ("pressure", "max_pa")):
        assert set(blocks[block][key]) >= {"value", "uncertainty", "observed_order", "values"}
    ratio = blocks["film"]["h_min_m"]["uncertainty"] / blocks["film"]["H_min"]["uncertainty"]
    assert ratio == pytest.approx(certified.scales.film_thickness)


def test_a_plain_result_has_no_error_bars(result):
    assert "uncertainty" not in summary(result)


def test_cycles_are_those_of_the_finest_grid(result):
    assert summary(result)["convergence"]["cycles"] == 3
