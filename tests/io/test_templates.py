"""Each template is a case."""

import tomllib
from pathlib import Path

import pytest

from tehl.api.problem import ContactProblem, case_from_tables, read_case_and_options
from tehl.base.errors import InputError
from tehl.contact.heat import FilmEnergy
from tehl.io.templates import template_text, templates
from tehl.report.explain import explain


@pytest.mark.parametrize("name", list(templates()))
def test_every_template_is_a_case(name: str, tmp_path: Path):
    path = tmp_path / "case.toml"
    path.write_text(template_text(name), encoding="utf-8")
    problem, options = read_case_and_options(path)
    assert problem.title
    assert options.target == 0.02
    assert 0.3e9 < problem.hertz.pressure < 2e9


@pytest.mark.parametrize(
    "name", ["ball-on-disc", "moes", "rough", "thermal", "dimple", "data-sheet", "passing-dent"]
)
def test_a_template_does_not_look_odd(name: str):
    problem, options = case_from_tables(tomllib.loads(template_text(name)))
    assert explain(problem, options).questions == ()


def test_thermal_templates_are_thermal_and_the_dimple_has_a_surface_at_rest():
    def problem(name: str) -> ContactProblem:
        return case_from_tables(tomllib.loads(template_text(name)))[0]

    assert all(isinstance(problem(n).heat, FilmEnergy) for n in ("thermal", "dimple", "data-sheet"))
    assert problem("dimple").motion.speed_2 == 0
    sheet = problem("data-sheet")
    assert sheet.inlet_temperature == pytest.approx(353.15)
    assert sheet.lubricant.viscosity.law == "walther"


def test_the_titles_are_sentences():
    assert all(len(title) > 20 for title in templates().values())


def test_an_unknown_template_lists_the_known():
    with pytest.raises(InputError, match="did you mean moes"):
        template_text("mose")
