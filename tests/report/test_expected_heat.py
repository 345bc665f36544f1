"""Expected temperatures: limits that can be worked out by hand."""

import math
from typing import Any

import pytest

from tehl.api.problem import ContactProblem
from tehl.estimate.film_formulas import expected_film
from tehl.estimate.inlet_heating import inlet_heating_factor
from tehl.estimate.scaling import ScaledProblem
from tehl.report.expected_heat import ASSUMED_TRACTION, ExpectedHeat, body_effect, expected_heat
from tests.cases import ball_tables

STEEL = {"k": 46.0, "rho": 7850.0, "c": 470.0}


def problem(slip: float = 0.5, speed: float = 1.5, **changes: Any) -> ContactProblem:
    contact = {"radius": 0.02, "load": 80, "entrainment_speed": speed, "slide_roll_ratio": slip}
    tables = ball_tables(contact=contact, lubricant="mineral-oil") | changes
    return ContactProblem.model_validate(tables)


def heat(slip: float = 0.5, speed: float = 1.5, **changes: Any) -> ExpectedHeat:
    return heat_of(problem(slip, speed, **changes))


def heat_of(case: ContactProblem) -> ExpectedHeat:
    scaled = ScaledProblem.of(case)
    expected = expected_heat(scaled, body_effect(scaled))
    assert expected is not None
    return expected


def test_without_sliding_there_is_no_heat():
    assert heat(0.0).power == 0
    assert heat(0.0).largest == 0


def test_the_rises_of_a_known_stress_are_those_of_tian_and_kennedy():
    # A limiting stress far below the Newtonian one makes the heat known beforehand.
    shear = {"law": "limiting", "stress": "10 MPa"}
    case = problem(lubricant={"name": "mineral-oil", "shear": shear})
    expected = heat_of(case)
    flux = 1e7 * 0.75
    diffusivity = STEEL["k"] / (STEEL["rho"] * STEEL["c"])
    width = case.hertz.half_width_x
    resistance = [
        2.32 * width / (46 * math.sqrt(math.pi * (1.234 + speed * width / (2 * diffusivity))))
        for speed in (1.875, 1.125)
    ]
    film = expected_film(ScaledProblem.of(case))
    across = film * (inlet_heating_factor(case) or 1.0) / 0.14
    into_first = flux * (0.5 * across + resistance[1]) / (across + sum(resistance))
    rises = resistance[0] * into_first, resistance[1] * (flux - into_first)
    assert expected.surface_1 == pytest.approx(rises[0], rel=1e-3)
    assert expected.surface_2 == pytest.approx(rises[1], rel=1e-3)
    middle = sum(rises) / 2 + 1.5 * flux * across / 8
    assert expected.mid_film == pytest.approx(middle, rel=1e-3)
    assert expected.power == pytest.approx(flux * math.pi * width**2, rel=1e-3)


def test_the_direction_of_sliding_does_not_count_between_equal_solids():
    there, back = heat(0.5), heat(-0.5)
    assert there.mid_film == pytest.approx(back.mid_film, rel=1e-9)
    assert there.surface_1 == pytest.approx(back.surface_2, rel=1e-9)


def test_heat_limits_the_traction_and_a_shear_law_limits_it_more():
    eyring = {"name": "mineral-oil", "shear": {"law": "eyring", "stress": "5 MPa"}}
    assert 0.01 < heat(lubricant=eyring).traction < heat().traction < 0.2
    assert heat(1.5).traction < heat(0.5).traction


def test_an_oil_of_constant_viscosity_has_an_assumed_traction():
    expected = heat(lubricant=ball_tables()["lubricant"])
    assert expected.assumed
    assert expected.traction == ASSUMED_TRACTION


def test_warm_solids_warm_the_film_even_in_rolling():
    warm = {"material": "steel", "temperature": "60 degC"}
    expected = heat(0.0, thermal={}, surface_1=warm, surface_2=warm)
    assert expected.mid_film == pytest.approx(20.0)
    assert expected.surface_1 == pytest.approx(0.0, abs=1e-9)
