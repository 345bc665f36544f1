"""Pictures of rough contacts: what must be drawn is drawn."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import QuadMesh

from tehl import plots
from tehl.base.errors import InputError
from tehl.plots import PICTURES, pictures_of
from tests.fixtures_result import CASE
from tests.plots.test_pictures import texts

OURS = ("heights", "micro_film", "rough_centre_line", "film_distribution")


def test_only_rough_results_have_pictures_of_roughness(rough, result):
    assert set(pictures_of(rough)) - set(PICTURES) == set(OURS)
    assert list(pictures_of(result)) == list(PICTURES)


def test_a_stated_roughness_has_a_distribution_and_no_heights(result):
    stated = {"surface_1": {"material": "steel", "rms_roughness": 3e-8}}
    problem = result.problem.model_validate({**CASE, **stated})
    found = set(pictures_of(replace(result, problem=problem))) - set(PICTURES)
    assert found == {"film_distribution"}


@pytest.mark.parametrize("name", OURS)
def test_each_picture_names_the_case_and_its_groups(rough, name):
    words = texts(pictures_of(rough)[name](rough))
    assert "Wavy ball on disc" in words
    assert "M = 75.6" in words


def test_the_map_of_heights_shows_them_in_nanometres(rough):
    figure = plots.heights_map(rough)
    mesh = next(iter(figure.axes[0].findobj(QuadMesh)))
    assert mesh.get_array().max() == pytest.approx(1e9 * rough.heights.together.max(), rel=1e-6)
    assert "Sq = " in texts(figure)


def test_ripples_are_those_of_the_reference_run_if_there_is_one(rough, smooth):
    with_reference, without = plots.micro_film_map(rough, smooth), plots.micro_film_map(rough)
    assert "less that of smooth surfaces" in texts(with_reference)
    assert "less its long waves" in texts(without)
    # without the reference run ripples outside the contact are left blank
    assert not np.ma.getmaskarray(with_reference.axes[0].findobj(QuadMesh)[0].get_array()).any()
    assert np.ma.getmaskarray(without.axes[0].findobj(QuadMesh)[0].get_array()).any()


def test_the_centre_line_shows_the_surface_and_the_smooth_film(rough, smooth):
    upper, lower = plots.rough_centre_line(rough, smooth).axes[:2]
    assert len(upper.lines) == len(plots.rough_centre_line(rough).axes[0].lines) + 1
    assert "smooth" in upper.get_title()
    assert np.abs(lower.lines[0].get_ydata()).max() == pytest.approx(
        1e9 * np.abs(rough.heights.together).max(), rel=1e-2
    )


def test_the_distribution_marks_sq(rough):
    assert "Sq of both surfaces" in texts(plots.film_distribution(rough))


@pytest.mark.parametrize(
    "draw",
    [plots.heights_map, plots.micro_film_map, plots.rough_centre_line, plots.film_distribution],
)
def test_a_smooth_result_raises_an_input_error(result, draw):
    with pytest.raises(InputError, match=r"smooth|rough"):
        draw(result)


def test_pictures_use_the_reference_run_that_is_given(rough, smooth, tmp_path, monkeypatch):
    monkeypatch.setattr("tehl.plots.PICTURES", {})
    paths = plots.save_all(rough, tmp_path, dpi=40, pictures=pictures_of(rough, smooth))
    assert [path.stem for path in paths] == list(OURS)
