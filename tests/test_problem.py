"""The question in SI, however it is stated."""

import copy
import json
import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from tehl.problem import ContactProblem
from tehl.scaling import groups
from tests.cases import ball_tables, moes_problem


def problem(**changes: Any) -> ContactProblem:
    return ContactProblem.model_validate(ball_tables(**changes))


CONTACTS: list[dict[str, Any]] = [
    {"radius": "20 mm", "load": "80 N", "entrainment_speed": "1.5 m/s"},
    {"radius": 0.02, "hertz_pressure": "0.8 GPa", "moes_speed": 12.04},
    {"radius_x": 0.02, "radius_y": 0.05, "moes_load": 100, "entrainment_speed": 2},
    {"radius_x": 0.02, "radius_y": 0.005, "moes_load": 57.21, "moes_speed": 10.52},
]


@pytest.mark.parametrize("contact", CONTACTS)
def test_a_problem_returns_from_json_as_it_was(contact: dict[str, Any]):
    stated = problem(contact=contact)
    assert ContactProblem.model_validate(stated.model_dump(mode="json")) == stated
    assert ContactProblem.model_validate(json.loads(stated.model_dump_json())) == stated


def test_a_flat_surface_and_a_named_oil_return_from_json():
    stated = problem(
        contact={"load": 80, "entrainment_speed": 1},
        surface_1={"material": "glass", "radius": "10 mm"},
        surface_2={"material": "steel", "radius_x": "inf", "radius_y": "-50 mm"},
        lubricant="mineral-oil",
    )
    again = ContactProblem.model_validate(json.loads(json.dumps(stated.model_dump(mode="json"))))
    assert again == stated
    assert math.isinf(again.surface_2.radius_x or 0.0)
    assert stated.radius_x == pytest.approx(0.01)
    assert stated.radius_y == pytest.approx(0.0125)


def test_ball_and_disc_are_the_reduced_contact():
    stated = {"load": "80 N", "entrainment_speed": "1.5 m/s"}
    bodies = problem(
        contact=stated,
        surface_1={"material": "steel", "radius": "20 mm"},
        surface_2={"material": "steel", "radius": "inf"},
    )
    assert groups(bodies) == groups(problem())


@given(
    load=st.floats(min_value=5, max_value=2000),
    speed=st.floats(min_value=1, max_value=20),
    ratio=st.floats(min_value=0.2, max_value=5),
)
def test_stated_moes_numbers_return_from_the_si_problem(load: float, speed: float, ratio: float):
    stated = moes_problem(load, speed, radius_x=0.02, radius_y=0.02 * ratio)
    in_si = stated.model_copy(
        update={
            "contact": stated.contact.model_copy(
                update={
                    "moes_load": None,
                    "moes_speed": None,
                    "load": stated.load,
                    "entrainment_speed": stated.entrainment_speed,
                }
            )
        }
    )
    again = groups(in_si)
    assert (again.M, again.L) == pytest.approx((load, speed), rel=1e-12)


def test_a_stated_hertz_pressure_is_the_hertz_pressure():
    contact = {"radius_x": 0.02, "radius_y": 0.07, "hertz_pressure": "1.2 GPa"}
    stated = problem(contact=contact | {"entrainment_speed": 1})
    assert stated.hertz.pressure == pytest.approx(1.2e9, rel=1e-12)


def test_the_temperature_of_the_film_is_that_of_the_viscosity():
    assert problem().heat.temperature == pytest.approx(313.15)


def test_roughnesses_add_as_squares():
    rough = problem(
        surface_1={"material": "steel", "rms_roughness": "0.3 um"},
        surface_2={"material": "steel", "rms_roughness": "0.4 um"},
    )
    assert rough.rms_roughness == pytest.approx(0.5e-6)


def test_a_problem_is_frozen():
    with pytest.raises(ValidationError):
        problem().title = "other"  # type: ignore[misc]


IMPOSSIBLE = [
    ("contact.hertz_pressure", 1e9, "only one"),
    ("contact.moes_speed", 10, "only one"),
    ("contact.load", None, "needs one of load"),
    ("contact.entrainment_speed", None, "needs one of entrainment_speed"),
    ("contact.radius_x", 0.01, "either radius or the pair"),
    ("contact.radius", None, "contact.radius is missing"),
    ("contact.load", 1e300, "beyond all measure"),
    ("contact.entrainment_speed", 1e-200, "beyond all measure"),
    ("surface_1.radius", 0.01, "stated twice"),
    ("surface_1.radius_x", 0.01, "both radius_x and radius_y"),
    ("surface_1.roughness", {"type": "wave"}, "not available"),
    ("surface_1.temperature", 300.0, "not available"),
    ("thermal", {"layers": 21}, "thermal runs are not available"),
    ("transient", {}, "transient runs are not available"),
]


@pytest.mark.parametrize(("key", "value", "words"), IMPOSSIBLE)
def test_an_impossible_question_is_refused(key: str, value: object, words: str):
    tables = copy.deepcopy(ball_tables())
    node: Any = tables
    *path, last = key.split(".")
    for name in path:
        node = node[name]
    node[last] = value
    with pytest.raises(ValidationError, match=words):
        ContactProblem.model_validate(tables)


@pytest.mark.parametrize(
    ("first", "second", "words"),
    [
        ("inf", "inf", "flat on flat"),
        ("10 mm", None, "surface_2.radius is missing"),
        ("10 mm", "-10 mm", "do not curve apart"),
    ],
)
def test_impossible_bodies_are_refused(first: str, second: str | None, words: str):
    tables = ball_tables(
        contact={"load": 80, "entrainment_speed": 1},
        surface_1={"material": "steel", "radius": first},
        surface_2={"material": "steel", "radius": second},
    )
    with pytest.raises(ValidationError, match=words):
        ContactProblem.model_validate(tables)


def test_a_moes_speed_needs_a_pressure_coefficient():
    tables = ball_tables(contact={"radius": 0.02, "load": 80, "moes_speed": 10})
    tables["lubricant"]["viscosity"] = {"law": "constant", "eta_0": 0.04}
    with pytest.raises(ValidationError, match="pressure coefficient"):
        ContactProblem.model_validate(tables)


@pytest.mark.parametrize(("load", "value"), [("hertz_pressure", 1e200), ("moes_load", 1e-299)])
def test_numbers_that_overflow_are_refused(load: str, value: float):
    tables = ball_tables(contact={"radius": 0.02, load: value, "entrainment_speed": 1.0})
    with pytest.raises(ValidationError, match="beyond all measure"):
        ContactProblem.model_validate(tables)


def test_a_line_contact_is_refused():
    radii = {"radius_x": 0.02, "radius_y": 200.0}
    tables = ball_tables(contact=radii | {"load": 80, "entrainment_speed": 1})
    with pytest.raises(ValidationError, match="line contact"):
        ContactProblem.model_validate(tables)
