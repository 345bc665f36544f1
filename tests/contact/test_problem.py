"""The problem in SI, by any of its statements."""

import copy
import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from tehl.api.problem import ContactProblem
from tehl.base.errors import InputError
from tehl.contact.heat import FilmEnergy, source_form
from tehl.contact.tables import Surface
from tehl.estimate.scaling import groups
from tehl.lubricant import Barus
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
def test_a_problem_survives_json(contact: dict[str, Any]):
    stated = problem(contact=contact)
    assert ContactProblem.model_validate(stated.model_dump(mode="json")) == stated
    assert ContactProblem.model_validate(json.loads(stated.model_dump_json())) == stated


def test_a_flat_surface_and_a_named_oil_survive_json():
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
    assert problem().inlet_temperature == pytest.approx(313.15)


def hot(thermal: dict[str, Any] | None = None, **changes: Any) -> ContactProblem:
    return problem(lubricant="mineral-oil", thermal=thermal or {}, **changes)


def test_a_thermal_table_makes_a_heat_problem():
    heat = hot().heat
    assert isinstance(heat, FilmEnergy)
    assert (heat.temperature, heat.bulk_1, heat.bulk_2) == (313.15, 313.15, 313.15)
    assert (heat.reynolds, heat.layers, heat.scheme) == ("generalised", 9, "chebyshev")
    assert hot({"scheme": "uniform"}).heat.layers == 21  # type: ignore[union-attr]
    assert hot({"scheme": "uniform", "layers": 41}).heat.layers == 41  # type: ignore[union-attr]


def test_hot_inlets_have_more_layers():
    # 9 (loading / 5)^(1/4), rounded up to 4 n + 1
    loading = hot().thermal_loading / 1.5**2  # type: ignore[operator]
    found = []
    for wanted in (4.9, 20.0, 57.0, 2000.0):
        speed = math.sqrt(wanted / loading)
        heat = hot(contact={"radius": 0.01, "load": 50.0, "entrainment_speed": speed}).heat
        found.append(heat.layers)  # type: ignore[union-attr]
    assert found == [9, 13, 17, 21]


def test_solids_may_be_warmer_than_the_oil():
    warm = {"material": "steel", "temperature": "80 degC"}
    heat = hot({"temperature": "60 degC"}, surface_1=warm).heat
    assert isinstance(heat, FilmEnergy)
    assert (heat.temperature, heat.bulk_1, heat.bulk_2) == pytest.approx((333.15, 353.15, 333.15))


def test_the_oil_enters_at_the_stated_temperature_and_the_laws_keep_theirs():
    tables = ball_tables()
    tables["lubricant"]["viscosity"]["gamma"] = 0.042
    tables["lubricant"]["density"]["beta"] = 6.5e-4
    cold = ContactProblem.model_validate(tables)
    assert cold.ambient_viscosity == 0.04
    assert cold.pressure_coefficient == 22e-9
    assert cold.ambient_density == 890.0
    tables["lubricant"]["temperature"] = "80 degC"
    warm = ContactProblem.model_validate(tables)
    oil, none = warm.lubricant, np.zeros(1)
    assert warm.inlet_temperature == pytest.approx(353.15)
    assert warm.ambient_viscosity == pytest.approx(oil.viscosity.viscosity(none, 353.15)[0])
    assert warm.ambient_density == pytest.approx(oil.density.density(none, 353.15)[0])
    assert warm.ambient_viscosity < 0.3 * cold.ambient_viscosity
    assert warm.pressure_coefficient < cold.pressure_coefficient
    assert warm.temperature_coefficient < cold.temperature_coefficient
    assert warm.load == cold.load


def test_the_temperature_of_the_oil_is_stated_once():
    oil = {**ball_tables()["lubricant"], "temperature": 330.0}
    oil["viscosity"] = oil["viscosity"] | {"gamma": 0.04}
    oil |= {"conductivity": 0.14, "heat_capacity": 2000}
    assert problem(lubricant=oil, thermal={"temperature": 330.0}).inlet_temperature == 330.0
    with pytest.raises(ValidationError, match="conflict: both are the temperature"):
        problem(lubricant=oil, thermal={"temperature": 331.0})


def test_heat_needs_all_its_properties():
    rigid = {"young_modulus": 2e11, "poisson_ratio": 0.3}
    with pytest.raises(
        ValidationError,
        match=r"surface_2.material.density is missing.*kg/m\^3.*; missing too: .*2.material.cond",
    ):
        hot(surface_2={"material": rigid})
    with pytest.raises(ValidationError, match=r"lubricant.heat_capacity is missing.*J/kg/K"):
        problem(thermal={}, lubricant={**ball_tables()["lubricant"], "conductivity": 0.14})
    oil = {**ball_tables()["lubricant"], "conductivity": 0.14, "heat_capacity": 2000}
    with pytest.raises(ValidationError, match="add gamma"):
        problem(thermal={}, lubricant=oil)
    with pytest.raises(ValidationError, match='law = "walther"'):
        problem(thermal={}, lubricant=oil | {"viscosity": {"law": "constant", "eta_0": 0.04}})
    free = {"law": "tait-doolittle", "eta_0": 0.03, "B": 5, "occupied": 0.66, "bulk_modulus": 1e9}
    with pytest.raises(ValidationError, match="add expansion"):
        problem(thermal={}, lubricant=oil | {"viscosity": free})


def test_a_thermal_problem_survives_json():
    table = {"value": "0.154 W/m/K", "slope": "1.4 1/GPa", "saturation": "0.34 1/GPa"}
    oil = {**ball_tables()["lubricant"], "conductivity": table, "heat_capacity": 2000}
    oil["viscosity"] = oil["viscosity"] | {"gamma": 0.04}
    oil["shear"] = {"law": "eyring", "stress": "5 MPa"}
    stated = problem(lubricant=oil, thermal={"temperature": "50 degC", "sources": "full"})
    assert ContactProblem.model_validate(json.loads(stated.model_dump_json())) == stated


def test_a_slow_or_backward_surface_takes_the_full_source():
    slow, fast = problem(contact={"radius": 0.02, "load": 80, "entrainment_speed": 4}).solid_peclet
    assert slow == fast == pytest.approx(4 * 219.7e-6 / (2 * 1.2468e-5), rel=1e-3)
    contact = {"radius": 0.02, "load": 80, "entrainment_speed": 4, "slide_roll_ratio": 3}
    assert problem(contact=contact).solid_peclet[1] < 0  # type: ignore[operator]
    forms = [source_form("auto", peclet) for peclet in (100.0, 29.0, 0.0, -100.0)]
    assert forms == ["line", "full", "full", "full"]
    assert source_form("line", 0.0) == "line"


def test_roughnesses_add_in_quadrature():
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
    ("contact.load", 1e300, "far outside the physical range"),
    ("contact.entrainment_speed", 1e-200, "far outside the physical range"),
    ("contact.slide_roll_ratio", 1e300, "over their mean, at most 1e\\+06"),
    ("surface_1.radius", 0.01, "stated twice"),
    ("surface_1.radius_x", 0.01, "both radius_x and radius_y"),
    ("surface_1.roughness", {"type": "wave"}, "amplitude"),
    ("surface_1.temperature", 300.0, "surface_1.temperature has an effect in thermal runs only"),
    ("thermal", {"layers": 21}, "lubricant.conductivity is missing"),
    ("lubricant.temperature", 40, "kelvin"),
    ("lubricant.temperature", 350.0, "add gamma"),
    ("transient", {}, "nothing changes with time"),
    ("transient", {"load": [[1e-3, 1.0], [1e-3, 2.0]]}, "times that increase"),
    ("transient", {"load": [[0.0, 100.0]]}, "below 10 times"),
    ("transient", {"load": "120 N/mm"}, "is not a formula: .* those with a unit are for tables"),
    ("transient", {"load": [[0.0, "2 m/s"]]}, 'as "80 N", or a force per length such as'),
    ("transient", {"load": [[0.0, "20 N/mm"]]}, 'transient.load: a value has .* as "80 N"'),
]


@pytest.mark.parametrize(("key", "value", "words"), IMPOSSIBLE)
def test_an_invalid_problem_is_rejected(key: str, value: object, words: str):
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
def test_invalid_bodies_are_rejected(first: str, second: str | None, words: str):
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
def test_numbers_that_overflow_are_rejected(load: str, value: float):
    tables = ball_tables(contact={"radius": 0.02, load: value, "entrainment_speed": 1.0})
    with pytest.raises(ValidationError, match="far outside the physical range"):
        ContactProblem.model_validate(tables)


def test_a_line_contact_is_rejected():
    radii = {"radius_x": 0.02, "radius_y": 200.0}
    tables = ball_tables(contact=radii | {"load": 80, "entrainment_speed": 1})
    with pytest.raises(ValidationError, match="line contact"):
        ContactProblem.model_validate(tables)


def test_ra_of_a_surface_becomes_rq():
    found = Surface.model_validate({"material": "100Cr6", "ra_roughness": "0.1 um"})
    assert found.rms_roughness == pytest.approx(0.1253e-6, rel=1e-3)
    assert Surface.model_validate_json(found.model_dump_json()) == found
    with pytest.raises(InputError, match="states ra_roughness and rms_roughness"):
        Surface(material="steel", ra_roughness=1e-7, rms_roughness=1e-7)


class Thinner(Barus):
    """A law of a user."""

    def viscosity(self, pressure, temperature):
        return 0.5 * super().viscosity(pressure, temperature)


def test_a_law_of_ones_own_is_refused_as_its_file_would_hold_another_oil():
    tables = ball_tables()
    tables["lubricant"] |= {"viscosity": Thinner(eta_0=0.04, alpha=2.2e-8)}
    with pytest.raises(ValueError, match=r"lubricant.viscosity = Thinner: own classes are not"):
        ContactProblem.model_validate(tables)


def test_a_line_contact_has_one_radius_of_the_bodies_or_reduced():
    tables = ball_tables(
        contact={"type": "line", "load_per_length": "100 N/mm", "entrainment_speed": 1.0},
        surface_1={"material": "steel", "radius": 0.01},
        surface_2={"material": "steel", "radius": -0.02},
    )
    problem = ContactProblem.model_validate(tables)
    assert (problem.radius_x, problem.radius_y) == (pytest.approx(0.02), math.inf)
    assert problem.load == 1e5
    reduced = {"type": "line", "hertz_pressure": "1 GPa", "entrainment_speed": 1.0}
    by_pressure = ContactProblem.model_validate(ball_tables(contact=reduced | {"radius": 0.02}))
    assert by_pressure.hertz.pressure == pytest.approx(1e9, rel=1e-12)
    with pytest.raises(ValidationError, match="radius is missing"):
        ContactProblem.model_validate(ball_tables(contact=reduced))
    pair = {"radius_x": 0.02, "radius_y": 1.0}
    for radii in (pair, {"radius_x": 0.02}, {"radius": 0.02} | pair):
        with pytest.raises(ValidationError, match=r"radius_x.*: a line contact takes radius"):
            ContactProblem.model_validate(ball_tables(contact=reduced | radii))


@pytest.mark.parametrize(
    "stated",
    [
        {"thermal_resistance": 5.0},
        {"cooling": {"body": "half-space", "track_radius": 0.02}},
    ],
)
def test_the_body_of_a_line_contact_has_no_resistance_from_its_track(stated):
    contact = {"type": "line", "load_per_length": "100 N/mm", "entrainment_speed": 1.0}
    surface = {"material": "steel"} | stated
    tables = ball_tables(contact=contact | {"radius": 0.02}, surface_2=surface, thermal={})
    tables["lubricant"] = "mineral-oil"
    key = rf"surface_2\.{next(iter(stated))}"
    with pytest.raises(ValidationError, match=rf'contact.type = "line" and {key} exclude each'):
        ContactProblem.model_validate(tables)


def test_velocities_state_entrainment_and_sliding_by_size_and_direction():
    ellipse = {"radius_x": 0.01, "radius_y": 0.02, "load": 80.0}
    both = {"velocity_1": ["3 m/s", "1 m/s"], "velocity_2": [2.0, 3.0]}
    found = problem(contact=ellipse | both)
    angle, size = found.contact.entrainment_angle, math.hypot(2.5, 2.0)
    assert (found.entrainment_speed, angle) == pytest.approx((size, math.atan2(2.0, 2.5)))
    for surface, stated in ((1, (3.0, 1.0)), (2, (2.0, 3.0))):
        u, v = found.motion.velocity_of(surface)
        turned = (
            u * math.cos(angle) - v * math.sin(angle),
            u * math.sin(angle) + v * math.cos(angle),
        )
        assert turned == pytest.approx(stated)
    assert ContactProblem.model_validate(found.model_dump()) == found
    along = problem(contact=ellipse | {"velocity_1": [1.0, 2.0], "velocity_2": [3.0, 6.0]})
    assert along.slide_roll_ratio == pytest.approx(-1.0)
    assert along.motion.is_plain


@pytest.mark.parametrize(
    ("stated", "why"),
    [
        ({"velocity_2": None}, "velocity_1 alone"),
        ({"slide_roll_ratio": 0.1}, "leave out slide_roll_ratio"),
        ({"sliding_angle": 0.1}, "leave out sliding_angle"),
        ({"moes_speed": 3.0}, "leave out moes_speed"),
        ({"velocity_1": [-2.0, 0.0]}, "drags no oil in"),
        ({"velocity_1": ["2 mm", 0.0]}, "a speed such as"),
        (
            {"type": "line", "load": None, "hertz_pressure": 1e9, "velocity_1": [2, 1]},
            "at an angle",
        ),
    ],
)
def test_velocities_that_are_stated_twice_or_make_no_entrainment_are_refused(stated, why):
    contact = {"radius": 0.01, "load": 80.0, "velocity_1": [3.0, 0.0], "velocity_2": [2.0, 0.0]}
    with pytest.raises(ValidationError, match=why):
        problem(contact=contact | stated)


@pytest.mark.parametrize(
    ("motion", "tables", "why"),
    [
        (
            {"sliding_angle": 1.0},
            {"supply": {"layer": 1e-6, "passes": 3, "track": 0.2}},
            "return along x alone",
        ),
        ({"spin_1": 900.0}, {"thermal": {}}, r"computed up to [\d.e+]+ rad/s, 0.8 u/a_y"),
    ],
)
def test_what_surfaces_that_slide_across_or_spin_cannot_have_is_refused(motion, tables, why):
    oil = ball_tables()["lubricant"] | {"conductivity": 0.14, "heat_capacity": 2000.0}
    oil["viscosity"] = oil["viscosity"] | {"gamma": 0.04}
    contact = {"radius": 0.02, "load": 80, "entrainment_speed": 0.2} | motion
    with pytest.raises(ValidationError, match=why):
        problem(contact=contact | {"slide_roll_ratio": 0.2}, lubricant=oil, **tables)
