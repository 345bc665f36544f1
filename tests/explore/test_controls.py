"""Each control of each template states the value that it shows, and each choice gives a case."""

import pytest

pytest.importorskip("tomlkit", reason="needs pip install 'tehl[explore]'")

from tehl.api.problem import case_from_tables
from tehl.base.errors import InputError
from tehl.explore.case_text import CaseText, named_table
from tehl.explore.controls import groups, swept_knobs
from tehl.explore.knobs import Choice, Knob
from tehl.io.case import changed
from tehl.io.templates import template_text, templates


def controls_of(name):
    case = CaseText(template_text(name))
    problem = case_from_tables(case.tables)[0]
    return case, problem, [item for group in groups(case, problem) for item in group.items]


def choose(case, choice, option):
    case.update(choice.options[option][1])


def fault_of(tables):
    try:
        case_from_tables(tables)
    except InputError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("name", templates())
def test_a_knob_set_to_its_own_value_changes_nothing(name):
    case, problem, items = controls_of(name)
    for knob in (item for item in items if isinstance(item, Knob)):
        again = CaseText(case.text)
        again.set(knob.path, knob.stated(knob.number(knob.value, knob.unit), knob.unit))
        after = case_from_tables(again.tables)[0]
        assert after.load == pytest.approx(problem.load, rel=1e-5), knob.path
        assert after.ambient_viscosity == pytest.approx(problem.ambient_viscosity, rel=1e-5)
        low, high = knob.reach(knob.value)
        assert low <= knob.value <= high, knob.path


ALIKE = (
    *("bearing", "boundary-film", "data-sheet", "dimple", "dynamics", "grease-decay", "moes"),
    *("reversal", "rib", "rough", "stress"),
)
"""Templates whose choices are those of others, beside tables that state a number more."""


@pytest.mark.parametrize(
    "name",
    [pytest.param(one, marks=[pytest.mark.slow] * (one in ALIKE)) for one in templates()],
)
def test_a_choice_gives_a_valid_case_or_a_sentence(name):
    case, _, items = controls_of(name)
    for choice in (item for item in items if isinstance(item, Choice)):
        assert choice.value in choice.options
        for number, (_, values) in enumerate(choice.options.values()):
            tables = with_name(case.tables, values) if number > 1 else None
            if tables is None:
                again = CaseText(case.text)
                again.update(values)
                tables = again.tables
            assert len(fault_of(tables).splitlines()) <= 1


def with_name(tables, values):
    """Return tables with another oil or solid; None if the values are not those of its name.

    To write one name into the text is to write any, and takes most of the time.
    """
    path, name = next(iter(values.items()), ("", None))
    if not isinstance(name, str):
        return None
    if path == "lubricant" and values.keys() <= {path, "lubricant.shear"}:
        shear = values.get("lubricant.shear")
        return tables | {path: named_table(path, name) | {"shear": shear} if shear else name}
    return changed(tables, path, name) if path.endswith(".material") else None


def test_load_and_hertz_pressure_are_the_same_contact():
    case, problem, items = controls_of("ball-on-disc")
    choice = next(item for item in items if item.path.startswith("contact.load|"))
    choose(case, choice, "hertz_pressure")
    assert case.get("contact.load") is None
    assert case_from_tables(case.tables)[0].load == pytest.approx(problem.load, rel=1e-4)


@pytest.mark.parametrize("name", ["ball-on-disc", "hypoid", "line", "roller"])
def test_a_contact_becomes_a_line_a_roller_or_an_ellipse_under_the_same_pressure(name):
    case, problem, items = controls_of(name)
    choice = next(item for item in items if item.path == "contact.type")
    for option in ("point", "line", "roller"):
        again = CaseText(case.text)
        choose(again, choice, option)
        after = case_from_tables(again.tables)[0]
        assert after.contact.type == option
        assert after.hertz.pressure == pytest.approx(problem.hertz.pressure, rel=1e-4)
        shown = {item.path for group in groups(again, after) for item in group.items}
        assert ("contact.length" in shown) == ("contact.profile" in shown) == (option == "roller")
        assert ("contact.spin_1" in shown) == (option != "line")


def test_a_roller_becomes_a_piece_that_goes_on_or_tilts_by_a_moment():
    case, _, items = controls_of("roller")
    of_a_whole = {
        "contact.tilting_moment|tilt",
        "contact.tilt",
        "contact.tilting_moment",
        "contact.profile",
    }
    expected = {
        ("contact.ends", "mirrored"): set(),
        ("contact.ends", "periodic"): set(),
        ("contact.ends", "open"): of_a_whole - {"contact.tilting_moment"},
        ("contact.tilting_moment|tilt", "tilting_moment"): of_a_whole - {"contact.tilt"},
        ("contact.tilting_moment|tilt", "tilt"): of_a_whole - {"contact.tilting_moment"},
        ("contact.type", "point"): set(),
    }
    for (path, option), paths in expected.items():
        choose(case, next(item for item in items if item.path == path), option)
        problem = case_from_tables(case.tables)[0]
        items = [item for group in groups(case, problem) for item in group.items]
        assert {item.path for item in items} & of_a_whole == paths
        if option == "tilting_moment":
            assert problem.contact.tilting_moment == pytest.approx(0.02 * 2e3 * 0.01, rel=0.02)


def test_radii_of_both_bodies_become_the_reduced_radius():
    case, problem, items = controls_of("ball-on-disc")
    choice = next(item for item in items if item.path == "contact.radius|")
    choose(case, choice, "circle")
    assert case.get("surface_1.radius") is None
    assert case_from_tables(case.tables)[0].radius_x == pytest.approx(problem.radius_x)


def test_heat_can_be_switched_on_and_off():
    case, _, items = controls_of("gear-ellipse")
    choice = next(item for item in items if item.path == "thermal")
    choose(case, choice, "on")
    assert case_from_tables(case.tables)[0].thermal is not None
    choose(case, choice, "off")
    assert case_from_tables(case.tables)[0].thermal is None


def test_the_slider_of_a_concave_radius_is_logarithmic_and_keeps_its_sign():
    _, _, items = controls_of("ball-on-disc")
    knob = next(item for item in items if item.path == "surface_1.radius")
    reach = knob.reach(-0.0495)
    parts = [knob.part(value, reach) for value in (-0.495, -0.0495, -0.00495)]
    assert parts == pytest.approx([0.0, 0.5, 1.0])
    assert knob.at(0.505, reach) == pytest.approx(-0.0495, rel=0.03)
    assert all(knob.at(step / 200, reach) < 0 for step in range(201))
    for value in (-0.3, -0.02):
        assert knob.at(knob.part(value, reach), reach) == pytest.approx(value)


def test_temperatures_are_shown_in_degrees_and_stated_so():
    _, _, items = controls_of("thermal")
    knob = next(item for item in items if item.path == "thermal.temperature")
    assert knob.number(knob.value, "degC") == pytest.approx(40.0)
    assert knob.stated(45.0, "degC") == "45 degC"
    assert knob.si(45.0, "degC") == pytest.approx(318.15)


def test_an_estimated_pressure_coefficient_is_shown_as_its_value():
    case = CaseText(template_text("ball-on-disc"))
    case.set("lubricant.viscosity.alpha", "estimated")
    problem = case_from_tables(case.tables)[0]
    knob = swept_knobs(groups(case, problem))["lubricant.viscosity.alpha"]
    assert knob.value == problem.pressure_coefficient
