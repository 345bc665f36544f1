"""Dimensionless groups against their closed forms and each other."""

import math
from dataclasses import fields

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tehl.api.problem import ContactProblem
from tehl.estimate.scaling import groups, scales
from tests.cases import ball_tables, moes_problem

# M, L, lambda_bar, alpha_bar of the circle: closed forms, to the digits shown.
CIRCLES = [
    (10, 10, 5.095414e-1, 7.85020),
    (20, 10, 2.022116e-1, 9.89063),
    (40, 12.04, 8.024774e-2, 15.00354),
    (57.21, 10.52, 4.979857e-2, 14.77022),
    (100, 10, 2.365082e-2, 16.91274),
    (200, 10, 9.385832e-3, 21.30871),
    (1000, 10, 1.097774e-3, 36.43739),
]


@pytest.mark.parametrize(("load", "speed", "lambda_bar", "alpha_bar"), CIRCLES)
def test_the_circle_meets_its_closed_forms(
    load: float, speed: float, lambda_bar: float, alpha_bar: float
):
    circle = groups(moes_problem(load, speed))
    assert circle.lambda_bar == pytest.approx(lambda_bar, rel=1e-6)
    assert circle.alpha_bar == pytest.approx(alpha_bar, rel=1e-6)
    assert circle.lambda_bar == pytest.approx((128 * math.pi**3 / (3 * load**4)) ** (1 / 3))
    assert circle.deflection_factor == pytest.approx(2 / math.pi**2)


@pytest.mark.parametrize(("ratio", "factor"), [(1.0, 1 / math.pi), (2.0, 0.28909)])
def test_the_deflection_factor_meets_known_ellipses(ratio: float, factor: float):
    ellipse = groups(moes_problem(100, 10, radius_x=0.02, radius_y=0.02 * ratio))
    assert ellipse.deflection_factor == pytest.approx(2 / math.pi * factor, rel=2e-5)


@given(
    ratio=st.floats(min_value=0.2, max_value=5),
    load=st.floats(min_value=5, max_value=2000),
    speed=st.floats(min_value=1, max_value=20),
    size=st.floats(min_value=1e-3, max_value=1.0),
    viscosity=st.floats(min_value=0.01, max_value=0.5),
)
def test_equal_groups_follow_from_different_si_inputs(
    ratio: float, load: float, speed: float, size: float, viscosity: float
):
    one = moes_problem(load, speed, radius_x=0.02, radius_y=0.02 * ratio)
    law = one.lubricant.viscosity.model_copy(update={"eta_0": viscosity})
    other = moes_problem(load, speed, radius_x=size, radius_y=size * ratio).model_copy(
        update={"lubricant": one.lubricant.model_copy(update={"viscosity": law})}
    )
    first, second = groups(one), groups(other)
    assert first.roller is second.roller is None
    for field in (one for one in fields(first) if one.name != "roller"):
        assert getattr(first, field.name) == pytest.approx(getattr(second, field.name), rel=1e-9)


@given(st.floats(min_value=0.05, max_value=20))
def test_the_load_integral_is_two_thirds_pi(ratio: float):
    tables = ball_tables()
    tables["contact"] = {"radius_x": 0.02, "radius_y": 0.02 * ratio, "load": 80}
    tables["contact"]["entrainment_speed"] = 1.5
    units = scales(ContactProblem.model_validate(tables))
    cell = units.hertz_pressure * units.half_width_x * units.half_width_y
    assert units.load / cell == pytest.approx(2 * math.pi / 3, rel=1e-12)


def test_the_scales_are_those_of_the_contact():
    problem = ContactProblem.model_validate(ball_tables())
    units = scales(problem)
    assert units.film_thickness == pytest.approx(problem.hertz.approach)  # a circle
    assert (units.viscosity, units.density, units.speed) == (0.04, 890.0, 1.5)
    assert (units.load, units.temperature) == (80.0, 313.15)
