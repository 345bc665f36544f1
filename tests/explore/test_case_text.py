"""The text of a case changes key by key, and fits into an address."""

import hashlib

import pytest

pytest.importorskip("tomlkit", reason="needs pip install 'tehl[explore]'")

from tehl.api.problem import case_from_tables
from tehl.api.solvers import solve
from tehl.base.errors import InputError
from tehl.explore.case_text import CaseText, template_case
from tehl.io.templates import template_text, templates

BALL = template_text("ball-on-disc")


@pytest.mark.parametrize("name", templates())
def test_an_address_reproduces_the_exact_text(name):
    case = CaseText(template_text(name))
    assert CaseText.unpacked(case.packed).text == case.text
    assert case.packed.replace("-", "").replace("_", "").isalnum()


def test_a_change_of_a_key_keeps_comments_order_and_all_other_keys():
    case = CaseText(BALL)
    case.set("contact.load", "85 N")
    assert case.text == BALL.replace('load = "80 N"', 'load = "85 N"')


def test_keys_without_a_control_survive_a_change():
    case = CaseText(template_text("moes"))
    case.set("contact.slide_roll_ratio", 0.5)
    assert case.get("numerics.domain.x") == [-4.5, 1.5]
    assert case.get("contact.slide_roll_ratio") == 0.5


def test_a_named_oil_becomes_its_laws_when_one_of_them_is_edited():
    case = CaseText(template_text("bearing"))
    before = case_from_tables(case.tables)[0]
    case.set("lubricant.viscosity.nu_40", "70 mm^2/s")
    after = case_from_tables(case.tables)[0]
    assert after.lubricant.viscosity.nu_40 == pytest.approx(70e-6)
    assert after.lubricant.viscosity.nu_100 == before.lubricant.viscosity.nu_100
    assert after.inlet_temperature == before.inlet_temperature
    assert case.get("lubricant.name") is None


def test_a_named_solid_becomes_its_properties_when_one_of_them_is_edited():
    case = CaseText(BALL)
    case.set("surface_1.material.young_modulus", "300 GPa")
    material = case_from_tables(case.tables)[0].surface_1.material
    assert material.young_modulus == 300e9
    assert material.conductivity == 46.0


def test_number_of_nodes_and_error_replace_each_other():
    case = CaseText(BALL)
    case.set("numerics.points", 257)
    assert case.get("numerics.points") == 257
    assert case.get("numerics.error") is None
    case.set("numerics.error", "1 %")
    assert case.get("numerics.points") is None


def test_the_first_sliding_of_the_page_has_a_friction_that_an_oil_can_transmit():
    case = template_case("ball-on-disc")
    case.set("contact.slide_roll_ratio", 0.02)
    case.set("numerics.points", 65)
    problem, options = case_from_tables(case.tables)
    found = solve(problem, options).traction
    assert found.credible
    assert 0.02 < abs(found.mid_film) < 0.06
    assert template_case("bearing").text == template_text("bearing")


@pytest.mark.parametrize("packed", ["x", "!!!", "AAAA", "eJwDAA"])
def test_a_damaged_address_is_a_sentence(packed):
    with pytest.raises(InputError, match="damaged"):
        CaseText.unpacked(packed + "zz")


def test_an_address_cannot_unpack_to_a_huge_text():
    huge = CaseText("#" * 150_000)
    with pytest.raises(InputError):
        CaseText("#" * 250_000)
    assert len(CaseText.unpacked(huge.packed).text) == 150_000


def test_a_case_that_is_too_long_for_an_address_has_no_link():
    noise = hashlib.shake_256().hexdigest(70_000)
    assert CaseText(BALL).link.startswith("/?case=")
    assert CaseText(f"# {noise}").link == ""


def test_text_that_is_not_toml_names_the_line():
    with pytest.raises(InputError, match="line 1"):
        CaseText("load = = 3")


def test_tables_nested_too_deeply_are_refused():
    with pytest.raises(InputError, match="nested too deeply"):
        CaseText("a = " + "[" * 5000)
