"""A study in one call."""

import pytest

import tehl
from tehl.base.errors import InputError
from tehl.io.templates import template_text
from tests.study.contacts import QUICK, problem

AXES = {"contact.moes_load": [5.0, 6.0], "contact.moes_speed": [10.0, 12.0]}


def test_a_problem_along_axes_is_a_table_and_a_dataset(tmp_path):
    frame = tehl.study(problem(), AXES, QUICK, store=tmp_path)
    assert list(frame["status"]) == ["converged"] * 4
    assert frame.attrs["units"]["film.h_min_m"] == "m"
    grid = frame.set_index(list(AXES)).to_xarray()
    film = grid["film.H_central_moes"]
    assert dict(film.sizes) == {"contact.moes_load": 2, "contact.moes_speed": 2}
    assert float(film.sel({"contact.moes_load": 5.0, "contact.moes_speed": 12.0})) > float(
        film.sel({"contact.moes_load": 5.0, "contact.moes_speed": 10.0})
    )
    again = tehl.study(problem(), AXES, QUICK, store=tmp_path)
    assert again.equals(frame)  # with the seconds of the first time


def test_nothing_is_left_behind_without_a_store(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    tehl.study(problem(), {"contact.moes_load": [5.0]}, QUICK)
    assert list(tmp_path.iterdir()) == []


def test_the_module_has_the_parts():
    assert tehl.studies.study is tehl.study
    assert all(getattr(tehl.studies, name) is not None for name in tehl.studies.__all__)


def test_a_study_file_gives_its_cases(tmp_path):
    (tmp_path / "case.toml").write_text(template_text("moes"), encoding="utf-8")
    axis = '[[axes]]\npath = "contact.moes_load"\nname = "M"\nvalues = [5, 6]\n'
    file = tmp_path / "study.toml"
    file.write_text(f'case = "case.toml"\n{axis}', encoding="utf-8")
    study = tehl.studies.study_of(tehl.studies.read_study(file))
    assert [case.labels for case in study.cases] == [{"M": 5.0}, {"M": 6.0}]


def test_an_axis_without_values_is_rejected():
    with pytest.raises(InputError, match="empty list"):
        tehl.study(problem(), {"contact.moes_load": []}, QUICK)
