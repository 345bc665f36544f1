"""The numbers of a state beside those of a pinned one."""

from dataclasses import replace

import pytest

pytest.importorskip("nicegui", reason="needs pip install 'tehl[explore]'")

import tehl
from tehl.api.problem import case_from_tables
from tehl.explore.jobs import facts
from tehl.explore.number_panel import number_html
from tehl.explore.numbers import Number, numbers, value_of
from tehl.io.case import tables_of_text
from tehl.io.templates import template_text
from tehl.report.explain import explain


@pytest.mark.parametrize(
    ("unit", "words"), [("nm", "−20.0 % from pinned 50"), ("°C", "−10.0 K from pinned 50")]
)
def test_a_temperature_changes_by_kelvins_and_another_quantity_by_a_share(unit, words):
    one = Number(key="a", name="a", symbol="a", value=40.0, unit=unit)
    assert words in number_html(one, replace(one, value=50.0))


def test_a_number_by_formula_is_marked_and_keeps_its_height():
    one = Number(key="a", name="a", symbol="a", value=40.0, unit="nm", by_formula=True)
    assert "by formula" in number_html(one, None)
    assert "error-bar" in number_html(one, None)


def test_an_error_far_above_the_value_has_no_digits():
    one = Number(key="a", name="a", symbol="a", value=40.0, unit="nm", error=5.9e5)
    shown = number_html(one, None)
    assert shown.count("error above 1000 %") == 1
    assert "±" not in shown


def touching(points):
    """Return a contact through a boundary film on a grid."""
    tables = tables_of_text(template_text("boundary-film"))
    tables["contact"]["slide_roll_ratio"] = 1e-5
    tables["numerics"] = {"points": points}
    return case_from_tables(tables)


def test_a_share_that_a_coarse_grid_does_not_know_is_not_shown():
    problem, options = touching(65)
    with pytest.raises(tehl.ConvergenceError) as coarse:  # its numbers are shown all the same
        tehl.solve(problem, options)
    found = numbers(coarse.value.result, explain(problem, options))
    assert value_of(found, "h_central").value > 0.0
    for key in ("load_share", "friction", "power"):
        assert value_of(found, key).value is None
        assert value_of(found, key).remark.startswith("not known: ")


def test_surfaces_that_touch_add_to_friction_and_power():
    problem, options = touching(129)
    result = tehl.solve(problem, options)
    found = numbers(result, explain(problem, options))
    share = value_of(found, "load_share").value
    assert share == pytest.approx(100.0 * result.touching.share)
    assert share > 0.0
    assert value_of(found, "friction").value == result.touching.friction is not None
    power = result.traction.friction_power + result.touching.power_boundary
    assert value_of(found, "power").value == pytest.approx(power)


def test_power_and_load_of_a_line_are_those_of_a_length():
    problem, options = case_from_tables(tables_of_text(template_text("line")))
    explanation = explain(problem, options)
    power = value_of(numbers(tehl.solve(problem, options), explanation), "power")
    assert power.value > 0.0
    assert power.remark == "of one metre"
    words = dict(facts(explanation))
    assert words["load"] == "100 N/mm"
    assert "a_y / a_x" not in words
