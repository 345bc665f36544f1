"""Heated films against an independent solver, and the balance of their heat."""

from functools import cache

import pytest

from tehl.api.results import Result
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.solver.judging.richardson import estimate
from tests.reference import DOMAIN, heated_contact, heated_numbers, read

HEATED = read("thermal")
INDEPENDENT = HEATED["independent"]["case"]
GRIDS = (129, 257, 513)
TOLERANCE = 1e-5
"""Heat of the backflow in the inlet converges slowly in pure rolling; it changes H by 1e-6."""


def name(case: dict) -> str:
    return f"{case['reynolds']},SRR={case['slide_roll_ratio']:g}"


@cache
def film(reynolds: str, slide_roll_ratio: float, points: int) -> Result:
    problem = heated_contact(slide_roll_ratio, reynolds=reynolds)
    options = Options(points=points, domain=DOMAIN, accuracy="tight", tolerance=TOLERANCE)
    return solve(problem, options)


def film_of(case: dict, points: int) -> Result:
    return film(case["reynolds"], case["slide_roll_ratio"], points)


def test_the_groups_are_those_of_the_reference():
    groups, there = film_of(INDEPENDENT[0], 129).groups, HEATED["groups"]
    assert (there["M"], there["L"]) == pytest.approx((groups.M, groups.L), rel=1e-12)
    assert groups.lambda_bar == pytest.approx(there["lambda_bar"], rel=1e-12)


@pytest.mark.parametrize("points", [129, pytest.param(257, marks=pytest.mark.slow)])
@pytest.mark.parametrize("case", INDEPENDENT, ids=name)
def test_the_heated_film_is_that_of_the_independent_solver_on_the_same_grid(case, points):
    found, there = heated_numbers(film_of(case, points)), case[f"on_{points}"]
    # two schemes of second order whose energy equations differ in their upstream differences
    assert found["h_central"] == pytest.approx(there["h_central"], rel=1e-4)
    assert found["p_central"] == pytest.approx(there["p_central"], rel=3e-4)
    assert found["h_minimum"] == pytest.approx(there["h_minimum"], rel=3e-4)
    assert found["mid_film_rise"] == pytest.approx(there["mid_film_rise"], rel=1e-3, abs=1e-3)
    for part in ("surface_1", "mid_film"):
        key = f"traction_{part}"
        assert found[key] == pytest.approx(there[key], rel=1e-3, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("case", INDEPENDENT, ids=name)
@pytest.mark.parametrize(
    ("quantity", "tolerance", "absolute"),
    [
        ("h_central", 2e-3, 0.0),
        ("h_minimum", 2e-3, 0.0),
        ("mid_film_rise", 1e-2, 0.01),
        ("traction_surface_1", 1.5e-2, 2e-5),
        ("traction_mid_film", 1.5e-2, 2e-5),
    ],
)
def test_three_grids_extrapolate_to_the_heated_film(case, quantity, tolerance, absolute):
    values = tuple(heated_numbers(film_of(case, points))[quantity] for points in GRIDS)
    found = estimate(values, domain=0.0)
    assert found.value == pytest.approx(case[quantity]["value"], rel=tolerance, abs=absolute)


@pytest.mark.slow
@pytest.mark.parametrize("points", GRIDS)
@pytest.mark.parametrize("case", INDEPENDENT, ids=name)
def test_the_heat_is_balanced(case, points):
    heat = film_of(case, points).heat
    assert heat is not None
    # 3e-4 is the error of nine layers at the walls, which does not decrease with the mesh width
    assert abs(heat.balance.error) < 2e-3
