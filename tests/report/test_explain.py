"""Explanation of a case before it is solved."""

import copy
import json
import math
import re
import tomllib
from dataclasses import replace
from typing import Any

import pytest

from tehl import InputError, solve
from tehl.api.problem import case_from_tables
from tehl.contact.options import Options
from tehl.estimate.duration import extremes_of
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.nodes import finest_grid
from tehl.estimate.scaling import ScaledProblem
from tehl.io.templates import template_text
from tehl.report.explain import Explanation, as_summary, as_text, explain
from tehl.report.readable import length
from tests.cases import ball_tables


def explained(change: str = "", value: Any = None, **tables: Any) -> Explanation:
    """Return the explanation of the ball on the disc with one key changed."""
    case = copy.deepcopy(ball_tables(**tables))
    if change:
        node: Any = case
        *path, last = change.split(".")
        for name in path:
            node = node.setdefault(name, {})
        node[last] = value
    return explain(*case_from_tables(case))


def test_a_usual_case_is_plausible():
    assert explained().questions == ()


def test_the_numbers_are_those_of_the_case():
    case = explained()
    assert case.scaled.groups.M == pytest.approx(75.6, abs=0.1)
    assert case.central_film == pytest.approx(
        expected_central_film(case.scaled.groups) * case.scaled.scales.film_thickness
    )
    # |u| a / (2 diffusivity) with the diffusivity of steel, 46 / (7850 * 470) m^2/s
    assert case.peclet[0] == pytest.approx(1.5 * 219.7e-6 / (2 * 1.2468e-5), rel=1e-3)
    assert case.lambda_central is case.lambda_minimum is case.lubrication is None
    assert case.domain == case.recommended_domain
    assert case.memory > 0
    assert case.seconds > 0


@pytest.mark.parametrize(
    ("rms", "words"),
    [
        (0.05, "full film (at least 3"),
        (0.2, "mixed lubrication (1 to 3"),
        (2.0, "boundary lubrication (below 1"),
    ],
)
def test_a_roughness_gives_lambda_by_both_films_and_the_regime_in_words(rms, words):
    case = explained("surface_1.rms_roughness", f"{rms} um")
    minimum = next(film.minimum_m for film in case.films if film.valid and film.minimum_m)
    assert case.lambda_central == pytest.approx(case.central_film / (rms * 1e-6))
    assert case.lambda_minimum == pytest.approx(minimum / (rms * 1e-6))
    shown = (
        f"{case.lambda_central:.3g} by the central film, {case.lambda_minimum:.3g} by the minimum"
    )
    assert f"{shown} film: {words}, Tallian 1967)\n" in as_text(case)


def test_lambda_between_asperities_is_that_of_smooth_surfaces_and_the_load_decides_the_regime():
    problem, options = case_from_tables(tomllib.loads(template_text("mixed")))
    case = explain(problem, options)
    shown = f"{case.lambda_minimum:.3g} by the minimum film of smooth surfaces: mixed lubrication"
    assert f"{shown}, as asperities carry {100.0 * case.share:.3g} %" in as_text(case)


def steel(**odd: float) -> dict[str, float]:
    """Return the table of a steel with other values."""
    usual = {"density": 7850, "heat_capacity": 470, "conductivity": 46}
    return {"young_modulus": 2.06e11, "poisson_ratio": 0.3} | usual | odd


LINE = {"radius_x": "20 mm", "radius_y": "20 m", "load": "8 kN", "entrainment_speed": "1.5 m/s"}
ODD = [
    ("contact.load", "20 kN", "Hertz pressure"),
    ("contact.load", "1e-3 N", "Hertz pressure"),
    ("contact.radius", 20, "reduced radius_x"),
    ("contact.entrainment_speed", "1500 m/s", "entrainment speed"),
    ("contact.slide_roll_ratio", 3, "opposite"),
    ("contact.slide_roll_ratio", 0.5, "Newtonian"),
    ("contact.slide_roll_ratio", 0.01, "oils thin from shear stresses of some 5 MPa on"),
    ("lubricant.viscosity.eta_0", "40 Pa s", "eta_0"),
    ("lubricant.viscosity.alpha", "220 1/GPa", "alpha"),
    ("lubricant.density.rho_0", 0.89, "rho_0"),
    ("surface_1.rms_roughness", "1 um", "asperities"),
    ("surface_1.rms_roughness", "1 mm", "roughness Sq = 1000 um: typical values are 0 to 100 um"),
    ("surface_1.material", {"young_modulus": 2e8, "poisson_ratio": 0.3}, "young_modulus"),
    ("contact.entrainment_speed", "0.1 mm/s", "continuum"),
    ("numerics.points", 33, "coarse"),
    ("contact", LINE, "line contact"),
    ("surface_1.material", steel(density=7.8), "surface_1 density = 7.8 kg/m^3"),
    ("surface_2.material", steel(density=78500), "= 78500 kg/m^3"),
    ("surface_1.material", steel(heat_capacity=0.47), "in kJ/kg/K?"),
    ("surface_2.material", steel(heat_capacity=120), "surface_2 density times heat_capacity"),
    ("surface_2.material", steel(conductivity=46000), "surface_2 conductivity = 46000"),
    ("lubricant", {"name": "mineral-oil", "heat_capacity": 2}, "Most oils have 2000"),
    (
        "lubricant",
        {"name": "mineral-oil", "shear": {"law": "limiting", "stress": "5 MPa"}},
        "limiting shear stress",
    ),
    ("numerics.domain", {"x": [-1.5, 1.5], "y": [-3, 3]}, "inlet edge"),
    ("numerics.domain", {"x": [-4.5, 1.01], "y": [-3, 3]}, "outlet edge"),
    ("numerics.domain", {"x": [-4.5, 1.5], "y": [-1.1, 3]}, "side edge"),
    ("numerics.domain", {"x": [-4.5, 1.5], "y": [-2.4, 2.4]}, "zero pressure on its edges"),
]


HOT = {"lubricant": "mineral-oil", "thermal": {}}
ODD_HEAT = [
    ("thermal", {"scheme": "uniform", "layers": 9}, "few for uniform layers"),
    ("thermal", {"sources": "line"}, "Peclet number of surface_2 is 0"),
    ("thermal", {"temperature": "230 degC"}, "temperature of the oil at the inlet"),
    ("lubricant", {"name": "mineral-oil", "conductivity": 14}, "lubricant.conductivity"),
    ("lubricant", {"name": "mineral-oil", "heat_capacity": 2}, "lubricant.heat_capacity"),
    ("contact.load", "120 N", "Eyring"),
    ("surface_1.temperature", "80 degC", "40 K above the oil at the inlet"),
    ("surface_2.temperature", "-10 degC", "beyond 40 K a run may not converge"),
]


@pytest.mark.parametrize(("change", "value", "words"), ODD_HEAT)
def test_an_implausible_thermal_case_is_reported(change: str, value: object, words: str):
    contact = ball_tables()["contact"] | {"slide_roll_ratio": 2}
    case = explained(change, value, contact=contact, **HOT)
    assert any(words in question for question in case.questions)


def test_little_sliding_that_no_oil_can_stand_asks_for_a_shear_law():
    ring = {"radius": "5 mm", "load": "60 N", "entrainment_speed": 3, "slide_roll_ratio": 0.015}
    case = explained(contact=ring, lubricant="mineral-oil")
    assert case.heat.traction > 0.1
    assert any("state an Eyring or limiting shear stress" in one for one in case.questions)


def test_a_usual_thermal_case_is_plausible():
    eyring = {"name": "mineral-oil", "shear": {"law": "eyring", "stress": "5 MPa"}}
    contact = ball_tables()["contact"] | {"slide_roll_ratio": 0.5}
    assert explained(contact=contact, lubricant=eyring, thermal={}).questions == ()


@pytest.mark.parametrize(("stress", "is_asked"), [("5 MPa", False), ("1 GPa", True)])
def test_an_oil_that_carries_more_than_its_pressure_is_reported(stress: str, is_asked: bool):
    """Not only a Newtonian one: a law that hardly thins gives such stresses too."""
    oil = {"name": "mineral-oil", "shear": {"law": "eyring", "stress": stress}}
    contact = ball_tables()["contact"] | {"slide_roll_ratio": 0.5, "load": "200 N"}
    questions = explained(contact=contact, lubricant=oil, thermal={}).questions
    assert any("times the pressure before heat" in text for text in questions) == is_asked


@pytest.mark.parametrize("slip", [0.0, 0.5])
def test_a_missing_thermal_table_is_reported_when_the_film_gets_warm(slip: float):
    contact = ball_tables()["contact"] | {"slide_roll_ratio": slip}
    case = explained(contact=contact, lubricant="mineral-oil")
    assert any("[thermal] is missing" in question for question in case.questions) == (slip > 0)


def test_the_heat_of_a_case_is_in_its_summary():
    contact = ball_tables()["contact"] | {"slide_roll_ratio": 2}
    case = explained(contact=contact, **HOT)
    summary = json.loads(json.dumps(as_summary(case), allow_nan=False))
    assert summary["thermal_loading"] == pytest.approx(0.04 * 0.042 * 1.5**2 / 0.14)
    assert [factor["formula"] for factor in summary["inlet_factors"]] == [
        "Murch-Wilson",
        "Wilson-Sheu",
        "Gupta",
    ]
    assert summary["temperature_law"] == "roelands, S0"
    assert summary["sources"] == ["full", "full"]
    assert summary["solid_peclet"][1] == 0
    assert summary["expected_heat"]["mid_film"] > 5
    assert "(full source)" in as_text(case)


def test_a_solid_without_thermal_properties_has_no_expected_heat():
    rigid = {"young_modulus": 2e11, "poisson_ratio": 0.3}
    case = explained("surface_1.material", rigid)
    assert case.heat is None
    assert case.sources == (None, "full")
    assert "not stated" in as_text(case)


@pytest.mark.parametrize(("change", "value", "words"), ODD)
def test_an_implausible_value_is_reported(change: str, value: object, words: str):
    assert any(words in question for question in explained(change, value).questions)


def test_a_film_thicker_than_the_bodies_is_reported_and_not_solved():
    tables = copy.deepcopy(ball_tables())
    tables["contact"]["entrainment_speed"] = 1500.0
    tables["lubricant"]["viscosity"]["eta_0"] = 40.0
    problem, options = case_from_tables(tables)
    assert any("smaller reduced radius" in text for text in explain(problem, options).questions)
    with pytest.raises(InputError, match=r"contact: the film to expect, .* mm, is .* check the"):
        solve(problem, options)


def test_a_ball_that_ends_before_its_inlet_begins_is_reported():
    contact = {"load": "80 N", "entrainment_speed": 1.5}
    ball, socket = ({"material": "steel", "radius": radius} for radius in (0.02, -0.02001))
    case = explained(contact=contact, surface_1=ball, surface_2=socket)
    assert any("but a body has a radius of 20 mm" in text for text in case.questions)
    ring = {"material": "steel", "radius": -0.03}
    assert explained(contact=contact, surface_1=ball, surface_2=ring).questions == ()


def test_oil_that_is_too_cold_is_named_with_its_temperature_and_viscosity():
    tables = copy.deepcopy(ball_tables())
    tables["lubricant"] |= {"name": "mineral-oil", "temperature": "-60 degC"}
    del tables["lubricant"]["viscosity"], tables["lubricant"]["density"]
    problem, options = case_from_tables(tables)
    words = f"oil at the inlet, -60 degC, its viscosity there, {problem.ambient_viscosity:.4g} Pa s"
    assert any(words in text for text in explain(problem, options).questions)
    with pytest.raises(InputError, match=words):
        solve(problem, options)


@pytest.mark.parametrize(("load", "speed"), [(2000, 20), (20000, 10)])
def test_an_extreme_pressure_is_reported(load: float, speed: float):
    contact = {"radius": "20 mm", "moes_load": load, "moes_speed": speed}
    case = explained(contact=contact)
    assert case.scaled.problem.hertz.pressure > 2e9
    assert case.questions
    assert f"M = {load:g}   L = {speed}" in as_text(case)  # not 2e+04


def test_a_stated_domain_is_used_as_given():
    case = explained("numerics.domain", {"x": [-2.0, 1.2], "y": [-1.5, 1.5]})
    assert case.domain.x == (-2.0, 1.2)
    assert case.recommended_domain.x[0] < -2.0


def test_the_summary_is_json_and_the_text_is_not_empty():
    for case in (explained(), explained("surface_1.rms_roughness", "0.3 um")):
        summary = json.loads(json.dumps(as_summary(case), allow_nan=False))
        assert summary["groups"]["M"] == pytest.approx(case.scaled.groups.M)
        assert len(summary["films"]) == len(case.films)
        assert len(as_text(case).splitlines()) > 20


def test_a_contact_that_no_formula_covers_is_reported(monkeypatch):
    case = explained()
    assert as_text(case).endswith("All values are plausible.")
    foreign = tuple(replace(film, remarks=("elsewhere",)) for film in case.films)
    monkeypatch.setattr(Explanation, "films", foreign)
    assert "no film formula" in as_text(case)


def test_an_ellipse_and_a_liquid_of_constant_viscosity_are_explained():
    ellipse = {"radius_x": "20 mm", "radius_y": "10 mm", "load": 50, "entrainment_speed": 1}
    case = explained("lubricant.viscosity", {"law": "constant", "eta_0": 0.04}, contact=ellipse)
    assert case.scaled.groups.ellipticity < 1
    assert as_text(case)


@pytest.mark.parametrize(
    ("metres", "text"), [(0.02, "20 mm"), (2.197e-4, "219.7 um"), (4.6e-7, "460 nm"), (0, "0 nm")]
)
def test_lengths_have_a_fitting_unit(metres: float, text: str):
    assert length(metres) == text


def with_bodies(first: str, second: str, slip: float = 0.5, **contact: object) -> Explanation:
    """A thermal case with both bodies at given temperatures."""
    whole = ball_tables()["contact"] | {"slide_roll_ratio": slip} | contact
    whole = {key: value for key, value in whole.items() if value is not None}
    bodies = {
        name: {"material": "steel", "temperature": temperature}
        for name, temperature in (("surface_1", first), ("surface_2", second))
    }
    return explained(contact=whole, **HOT, **bodies)


def test_bodies_as_warm_as_the_oil_have_no_effect():
    assert with_bodies("40 degC", "42 degC").bodies is None
    assert as_summary(with_bodies("40 degC", "40 degC"))["bodies"] is None


def test_the_film_between_warm_bodies_is_that_of_oil_at_their_mean_temperature():
    case = with_bodies("80 degC", "40 degC")
    assert case.bodies is not None
    as_warm = explained(lubricant={"name": "mineral-oil", "temperature": "60 degC"})
    assert case.bodies.central_film == pytest.approx(as_warm.central_film)
    assert case.bodies.ratio == pytest.approx(as_warm.central_film / case.central_film)
    assert case.bodies.ratio < 0.7
    assert json.loads(json.dumps(as_summary(case)))["bodies"]["surface_1"] == pytest.approx(40)


def test_domain_and_grid_between_cold_bodies_are_those_of_the_solve():
    case = with_bodies("0 degC", "0 degC")
    grid = finest_grid(case.scaled, case.options)
    assert case.domain == case.recommended_domain == grid.domain
    assert case.domain != with_bodies("40 degC", "40 degC").domain


def test_a_contact_by_moes_numbers_keeps_load_and_speed_between_warm_bodies():
    by_moes = {"load": None, "entrainment_speed": None, "moes_load": 100, "moes_speed": 10}
    case = with_bodies("80 degC", "80 degC", **by_moes)
    assert case.bodies is not None
    assert case.bodies.groups.W == pytest.approx(case.scaled.groups.W)
    assert case.bodies.groups.M > case.scaled.groups.M


def rises(case: Explanation) -> list[float]:
    """Return the rises that the text shows."""
    line = next(row for row in as_text(case).splitlines() if "expected rise" in row)
    return [float(number) for number in re.findall(r"(-?[\d.e+-]+) K", line)]


def test_rises_are_over_the_oil_at_the_inlet_without_sliding_too():
    assert rises(with_bodies("80 degC", "80 degC", slip=0.0)) == pytest.approx([40, 40, 40])


def test_hardly_any_sliding_shows_no_zeros():
    case = explained(contact=ball_tables()["contact"] | {"slide_roll_ratio": 1e-6}, **HOT)
    assert rises(case) == [0.1]
    assert "traction" not in as_text(case)


def test_a_stated_grid_is_shown_with_the_expected_one_and_its_error_in_question():
    case, usual = explained("numerics.points", 65), explained()
    assert case.expected_shape == usual.expected_shape == usual.options.shape
    nodes = case.expected_shape[0]
    assert f'65 x 65 nodes   numerics.error = "1 %" would take {nodes}' in as_text(case)
    question = next(text for text in case.questions if "coarse" in text)
    assert "numerics.points = 65: the expected error of the film is about 17 %" in question
    assert 'set numerics.error = "2 %" instead' in question
    assert explained("numerics.points", 513).questions == ()


def test_the_grid_to_expect_is_shown_with_the_error_to_reach():
    case = explained()
    assert case.follows
    assert "nodes   expected for an error of 1 %" in as_text(case)


def test_an_estimated_pressure_coefficient_is_shown():
    case = explained("lubricant.viscosity.alpha", "estimated")
    assert "estimated by Wooster's relation: within 20 %" in as_text(case)
    numbers = as_summary(case)
    assert numbers["pressure_coefficient_1_pa"] == pytest.approx(21.46e-9, rel=1e-3)
    assert numbers["pressure_coefficient_estimated"]
    assert "estimated by" not in as_text(explained())


def test_a_problem_explains_itself():
    case = explained()
    found = case.scaled.problem.explain(Options())
    assert found == case
    assert repr(found) == as_text(case)
    assert case.scaled.problem.explain().domain == explain(case.scaled.problem, Options()).domain


@pytest.mark.parametrize(("groove", "is_asked"), [("-4.95 mm", False), ("4.95 mm", True)])
def test_a_groove_without_its_minus_is_reported(groove: str, is_asked: bool):
    tables = tomllib.loads(template_text("bearing").replace("-4.95 mm", groove))
    asked = explain(*case_from_tables(tables)).questions
    words = "surface_2.radius_y = 4.95 mm: the surface is convex across the rolling direction"
    assert any(words in question for question in asked) == is_asked


def test_lambda_takes_the_first_formula_whose_range_has_the_contact():
    rough = {"rms_roughness": "0.1 um"}
    radii = {"radius_x": "20 mm", "radius_y": "8 mm"}
    case = ball_tables(surface_1={"material": "steel"} | radii | rough)
    del case["contact"]["radius"]
    case["surface_2"] = {"material": "steel", "radius": "inf"}
    slender = explain(*case_from_tables(case))
    assert slender.scaled.groups.radius_ratio > 1.0
    chosen = next(film for film in slender.films if film.formula == "Chittenden")
    assert slender.formula == "Chittenden"
    assert slender.central_film == chosen.central_m
    assert slender.lambda_central == pytest.approx(chosen.central_m / slender.composite)
    assert "with the film of Chittenden" in as_text(slender)
    assert as_summary(slender)["central_film_formula"] == "Chittenden"


def test_sharp_summits_are_not_plausible():
    def asked(radius):
        table = {"model": "greenwood-tripp", "rms": "0.1 um", "summit_radius": radius}
        case = explained("asperities", table | {"summit_density": "5e9 1/m^2"})
        return [text for text in case.questions if "asperities.rms / summit_radius" in text]

    assert asked("50 um") == []
    assert "summits this sharp would yield" in asked("5 um")[0]


def test_the_plan_of_a_line_has_one_row():
    case = explain(*case_from_tables(tomllib.loads(template_text("gear-mesh"))))
    assert (case.options.shape, case.expected_shape[0]) == ((1, 257), 1)
    assert f'257 nodes   numerics.error = "2 %" would take {case.expected_shape[1]}' in as_text(
        case
    )
    assert case.time.seconds < 2e-2 * case.time.steps  # much less than on 257 rows
    assert case.memory > 96 * 257 * case.time.steps  # the profiles of all steps are kept


def test_a_load_that_changes_within_few_steps_is_reported():
    """Of stated nodes; others are as many as its course needs."""
    course = {"load": "1 + 0.3*sin(6.283*t/(0.1 ms))", "duration": "0.1 ms"}
    stated = explained(transient=course, numerics={"points": 65})
    assert any("off a straight line within one of" in one for one in stated.questions)
    chosen = explained(transient=course)
    assert not any("off a straight line" in one for one in chosen.questions)


def test_the_profile_of_a_roller_and_the_load_of_its_slices_are_shown():
    """Johns and Gohar: A ln(2 a/(0.6066 b)) at the ends; a tilt loads one of them."""
    case = tomllib.loads(template_text("roller"))
    case["contact"]["tilt"] = 0.0
    even = explain(*case_from_tables(case))
    roller = even.scaled.groups.roller
    amplitude = 2.0 * 2e3 / (0.01 * math.pi * even.scaled.problem.reduced_modulus)
    drop = amplitude * math.log(0.005 / (0.3033 * roller.half_width))
    profile = as_summary(even)["profile"]
    assert profile["drop_at_ends_m"] == pytest.approx([drop, drop])
    assert profile["largest_slice_over_hertz"] == pytest.approx(1.0, abs=0.03)
    assert f"profile               logarithmic   drops by {length(drop)} at its ends" in as_text(
        even
    )
    case["contact"]["tilt"] = "2 mrad"
    tilted = as_summary(explain(*case_from_tables(case)))["profile"]
    assert tilted["largest_slice_over_hertz"] > 1.3
    assert tilted["loaded_part"] < 0.8


def test_sliding_and_pressure_of_a_run_count_by_their_largest_values():
    """At its pitch point a pair of gears rolls; a small radius presses harder."""
    tables = {"contact": {"type": "line", "radius": "10 mm", "load_per_length": "300 N/mm"}}
    tables["contact"]["entrainment_speed"] = "2 m/s"
    course = {"duration": "1 ms", "slide_roll_ratio": [["0 ms", 0.8], ["1 ms", -0.8]]}
    assert not any("Newtonian film slides" in one for one in line_explained(tables).questions)
    sliding = line_explained(tables | {"transient": course})
    assert any("a Newtonian film slides at" in one for one in sliding.questions)
    course["radius"] = [["0 ms", 0.03], ["1 ms", 1.0]]
    pressed = line_explained(tables | {"transient": course})
    assert any("Hertz pressure = 6" in one for one in pressed.questions)


def line_explained(tables: dict[str, Any]) -> Explanation:
    """Return the explanation of a line contact of steel."""
    steel = {"material": "steel"}
    bodies = {"surface_1": steel, "surface_2": steel, "lubricant": {"name": "mineral-oil"}}
    return explain(*case_from_tables(bodies | tables))


def test_the_hertz_pressure_of_a_circle_grows_with_load_and_curvature():
    course = {"duration": "1 ms", "load": [["0 ms", 1.0], ["1 ms", 8.0]]}
    ball = ScaledProblem.of(case_from_tables(ball_tables(transient=course))[0])
    assert extremes_of(ball)[1] == pytest.approx(2.0 * ball.problem.hertz.pressure)


def test_a_roller_on_a_sharp_end_and_a_bump_beside_the_contact_are_named():
    tables = tomllib.loads(template_text("roller"))
    assert "sharp end" not in " ".join(explain(*case_from_tables(tables)).questions)
    tilted = tables | {"contact": tables["contact"] | {"tilt": "0.05 deg"}}
    asked = " ".join(explain(*case_from_tables(tilted)).questions)
    assert re.search("sharp end of the roller carries .* of the largest load", asked)
    bump = {"type": "bump", "amplitude": "1 um", "radius": "50 um"}
    for place, beside in (("0 mm", False), ("20 mm", True)):
        case = tables | {"surface_1": {"material": "steel", "roughness": bump | {"y": place}}}
        asked = " ".join(explain(*case_from_tables(case)).questions)
        assert ("the bump lies beside the contact" in asked) is beside
