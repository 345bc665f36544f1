"""Axes of a study: values, grids, zips, samples, and what stands in the table."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from openpyxl import Workbook

from tehl.base.errors import InputError
from tehl.studies import Axis, Sample, cases_of
from tehl.studies.axes import block_of, block_of_file
from tehl.studies.plan import changed
from tests.study.contacts import QUICK, problem


def values(axis: Axis) -> list:
    return [setting.value for setting in axis.settings()]


def test_linspace_has_both_ends_and_equal_steps():
    assert values(Axis(path="a", linspace=(0, 1, 5))) == [0, 0.25, 0.5, 0.75, 1]
    assert values(Axis(path="a", linspace=(1, 5, 5))) == [1, 2, 3, 4, 5]
    assert values(Axis(path="a", linspace=(0, 0.3, 4))) == [0, 0.1, 0.2, 0.3]


def test_geomspace_keeps_its_unit():
    assert values(Axis(path="a", geomspace=("0.1 m/s", "10 m/s", 3))) == [
        "0.1 m/s",
        "1.0 m/s",
        "10.0 m/s",
    ]


@settings(deadline=None)
@given(
    low=st.floats(1e-9, 1e9),
    ratio=st.floats(1.001, 1e6),
    count=st.integers(2, 40),
    geometric=st.booleans(),
)
def test_spaced_values_rise_from_one_end_to_the_other(low, ratio, count, geometric):
    high = low * ratio
    kind = "geomspace" if geometric else "linspace"
    found = values(Axis(path="a", **{kind: (low, high, count)}))
    assert found[0] == pytest.approx(low, rel=1e-11)  # twelve digits
    assert found[-1] == pytest.approx(high, rel=1e-11)
    if ratio ** (1 / count) > 1 + 1e-9:
        assert all(a < b for a, b in pairwise(found))
    if geometric and count > 2:
        steps = np.diff(np.log(found))
        assert steps == pytest.approx(math.log(ratio) / (count - 1), rel=1e-6)


@pytest.mark.parametrize("method", ["latin-hypercube", "sobol", "random"])
def test_a_sample_lies_in_its_box_and_follows_its_seed(method):
    axes = [Axis(path="a", uniform=("1 N", "2 N")), Axis(path="b", loguniform=(1, 1000))]

    def drawn(seed: int) -> list[tuple]:
        block = block_of(axes, Sample(method=method, number=20, seed=seed))
        return [tuple(setting.value for setting in row) for row in block.rows]

    assert drawn(1) == drawn(1)
    assert drawn(1) != drawn(2)
    assert len(set(drawn(1))) == 20
    for force, number in drawn(1):
        assert 1 <= float(force.removesuffix(" N")) <= 2
        assert 1 <= number <= 1000


@settings(deadline=None)
@given(number=st.integers(2, 40), seed=st.integers(0, 1000))
def test_a_latin_hypercube_has_one_point_in_each_part_of_each_axis(number, seed):
    places = Sample(number=number, seed=seed).places(3)
    parts = np.sort(np.floor(places * number), axis=0)
    assert (parts == np.arange(number)[:, None]).all()


def test_the_last_axis_is_the_fastest():
    axes = {"contact.moes_load": [5.0, 6.0], "contact.moes_speed": [5.0, 10.0, 15.0]}
    study = cases_of(problem(), axes, QUICK)
    found = [tuple(case.labels.values()) for case in study.cases]
    assert found == [(5, 5), (5, 10), (5, 15), (6, 5), (6, 10), (6, 15)]
    assert study.cases[4].problem.contact.moes_speed == 10.0
    assert study.units == {"contact.moes_load": "1", "contact.moes_speed": "1"}


def test_labels_are_in_si_with_their_unit():
    base = problem().model_copy(
        update={"contact": problem().contact.model_copy(update={"moes_load": None, "load": 10.0})}
    )
    study = cases_of(base, {"contact.radius": ["10 mm", 0.02]}, QUICK)
    assert [case.labels["contact.radius"] for case in study.cases] == [0.01, 0.02]
    assert study.units["contact.radius"] == "m"


def test_tables_are_values_and_names_distinguish_them():
    laws = [{"law": "newtonian"}, {"law": "eyring", "stress": "5 MPa"}]
    study = cases_of(problem(), {"lubricant.shear": laws}, QUICK)
    assert [case.labels["lubricant.shear"] for case in study.cases] == ["newtonian", "eyring"]
    named = Axis(path="lubricant.shear", name="oil", values=laws, names=["N", "E"])
    study = cases_of(problem(), [named], QUICK)
    assert [case.name for case in study.cases] == ["oil = N", "oil = E"]


def test_zipped_axes_go_together():
    axes = [
        Axis(path="contact.moes_load", values=[5, 6], zip="pair"),
        Axis(path="contact.moes_speed", values=[1, 2, 3]),
        Axis(path="numerics.points", values=[33, 65], zip="pair"),
    ]
    study = cases_of(problem(), axes)
    found = {(c.labels["contact.moes_load"], c.options.points) for c in study.cases}
    assert found == {(5.0, 33), (6.0, 65)}
    assert len(study.cases) == 6


def test_cases_of_the_same_name_are_numbered():
    study = cases_of(problem(), {"contact.moes_load": [5.0, 5.0 + 1e-9]}, QUICK)
    assert [case.name for case in study.cases] == ["moes_load = 5", "moes_load = 5 (2)"]
    assert study.cases[0].key != study.cases[1].key


def test_false_leaves_a_key_out_and_a_name_becomes_a_table():
    base = {"lubricant": "mineral-oil", "thermal": {"layers": 9}}
    assert changed(base, "thermal", value=False) == {"lubricant": "mineral-oil"}
    sheared = changed(base, "lubricant.shear", {"law": "newtonian"})
    assert sheared["lubricant"] == {"oil": "mineral-oil", "shear": {"law": "newtonian"}}
    assert base == {"lubricant": "mineral-oil", "thermal": {"layers": 9}}


@settings(deadline=None)
@given(
    path=st.lists(st.sampled_from("abc"), min_size=1, max_size=4).map(".".join),
    value=st.integers(),
)
def test_a_change_is_found_where_it_was_made(path, value):
    node = changed({"a": {"a": {}}, "c": {}}, path, value)
    for key in path.split("."):
        node = node[key]
    assert node == value


def test_a_switch_may_be_false_and_another_key_is_left_out_by_it():
    cases = cases_of(problem(), {"numerics.extrapolate": [True, False]}, QUICK)
    assert [case.options.extrapolate for case in cases.cases] == [True, False]
    assert changed({"contact": {}}, "thermal.layers", value=False) == {"contact": {}}


@pytest.mark.parametrize(
    ("axes", "words"),
    [
        ({"contact.lod": [1]}, "contact.lod is not a known key; did you mean"),
        ({"contact.radius": ["5 N"]}, 'contact.radius = "5 N": has the unit of a force'),
        ({"contact.radius": []}, "empty list of values"),
        ({"title": ["a"]}, "axis title: changes no result"),
        ({"surface_1.material.young_modulus.x": [1]}, "goes through young_modulus"),
    ],
)
def test_an_invalid_axis_is_reported_in_one_sentence(axes, words):
    with pytest.raises(InputError, match=words.replace("(", r"\(")) as error:
        cases_of(problem(), axes, QUICK)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
@pytest.mark.parametrize("mark", [";", "\t"])
def test_a_list_of_cases_may_be_that_of_a_spreadsheet(tmp_path, mark, encoding):
    rows = (
        ("name", "contact.load [N]", "contact.slide_roll_ratio", "title"),
        ("first, light", "1,5", "-0,25", "a, b"),
        ("second", "1,5e2", "0.5", "2,5 x"),
    )
    path = tmp_path / "list.csv"
    path.write_text("\n".join(mark.join(row) for row in rows), encoding=encoding)
    found = block_of_file(path)
    assert found.titles == ("first, light", "second")
    assert [[one.value for one in row] for row in found.rows] == [
        ["1.5 N", -0.25, "a, b"],
        ["1.5e2 N", 0.5, "2.5 x"],
    ]


def test_a_list_of_cases_may_be_an_excel_sheet(tmp_path):
    book = Workbook()
    book.active.append(["name", "contact.load [N]", "surface_1.material"])
    book.active.append(["light", 1.5, None])
    book.active.append(["heavy", 150, "glass"])
    book.save(tmp_path / "list.xlsx")
    found = block_of_file(tmp_path / "list.xlsx")
    assert found.titles == ("light", "heavy")
    assert [[one and one.value for one in row] for row in found.rows] == [
        ["1.5 N", None],
        ["150 N", "glass"],
    ]


def test_one_text_is_no_list_of_values():
    """Its letters were taken as values."""
    with pytest.raises(InputError, match=r'axis contact.load = "100 N": must be a list'):
        cases_of(problem(), {"contact.load": "100 N"})
