"""The key of a case: all that the result depends on, and nothing else."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tehl.api.problem import ContactProblem
from tehl.contact.options import Options
from tehl.studies import Case
from tehl.studies import case as case_module
from tests.cases import ball_tables
from tests.study.contacts import QUICK, problem

CASE = Case("one", problem(), QUICK)


def ball(**contact) -> Case:
    stated = {"radius": "20 mm", "load": "80 N", "entrainment_speed": "1.5 m/s"} | contact
    return Case("ball", ContactProblem.model_validate(ball_tables(contact=stated)), QUICK)


def test_a_key_has_64_hexadecimal_digits():
    assert len(CASE.key) == 64
    assert int(CASE.key, 16) > 0


@settings(deadline=None)
@given(name=st.text(max_size=20), labels=st.dictionaries(st.text(max_size=5), st.floats()))
def test_name_and_labels_do_not_count(name, labels):
    assert Case(name, CASE.problem, QUICK, labels).key == CASE.key


@pytest.mark.parametrize(
    "stated",
    [{"load": 80.0}, {"load": "0.08 kN"}, {"radius": "0.02 m"}, {"slide_roll_ratio": 0}],
)
def test_another_way_to_write_the_same_contact_does_not_count(stated):
    assert ball(**stated).key == ball().key


def test_the_title_does_not_count():
    titled = problem().model_copy(update={"title": "another"})
    assert Case("one", titled, QUICK).key == CASE.key


def test_problem_options_and_certification_count():
    others = [
        replace(CASE, problem=problem(load=5.001)),
        replace(CASE, options=Options(points=129)),
        replace(CASE, certify=True),
    ]
    assert len({CASE.key, *(other.key for other in others)}) == 4


def test_the_version_of_the_solver_counts(monkeypatch):
    monkeypatch.setattr(case_module, "SOLVER_VERSION", 10**6)
    assert replace(CASE, name="two").key != CASE.key


def test_a_measured_surface_counts_by_what_its_file_holds(tmp_path):
    def mapped(file: str) -> str:
        rough = {"type": "map", "file": str(tmp_path / file), "unit": "um", "pixel": "1 um"}
        surface = {"material": "steel", "roughness": rough}
        return Case("map", problem(surface_2=surface), QUICK).key

    for file, text in (("a.csv", "1,2\n3,4\n"), ("b.csv", "1,2\n3,4\n"), ("c.csv", "1,2\n3,5\n")):
        (tmp_path / file).write_text(text)
    assert mapped("a.csv") == mapped("b.csv")
    assert mapped("a.csv") != mapped("c.csv")
    (tmp_path / "a.csv").write_text("9,2\n3,4,5\n")
    assert mapped("a.csv") != mapped("b.csv")
