"""The form of a body that is left in a map is reported."""

import numpy as np
import pytest

from tehl.roughness import Map
from tehl.roughness.prepare import form_of
from tests.roughness.files import relief

NY, NX, PIXEL = 48, 64, 2e-6
ROUGH = 2e-9 * relief(NY, NX, sq=1.0)
X = (np.arange(NX) - 0.5 * (NX - 1))[None, :] * PIXEL
Y = (np.arange(NY) - 0.5 * (NY - 1))[:, None] * PIXEL


def stated(folder, heights, **keys):
    np.save(folder / "map.npy", heights)
    return Map.model_validate(
        {"file": str(folder / "map.npy"), "unit": "m", "pixel": "2 um", **keys}
    )


def notes(folder, heights, **keys):
    return [one for one in stated(folder, heights, **keys).fits(9e-5, 9e-5) if "form" in one]


def test_the_radius_of_a_ball_is_found_and_reported(tmp_path):
    ball = ROUGH - (X**2 + Y**2) / (2 * 20e-3)
    (note,) = notes(tmp_path, ball)
    assert 'radii of 20 mm along x and of 20 mm along y (level = "plane")' in note
    assert note.endswith('take it off, level = "quadratic"')
    assert notes(tmp_path, ball, level="quadratic") == []
    found = form_of(stated(tmp_path, ball).load())
    assert found.curvatures == pytest.approx((-50.0, -50.0), rel=0.02)
    assert found.sq_without == pytest.approx(stated(tmp_path, ball, level="quadratic").rms)


@pytest.mark.parametrize("level", ["none", "mean", "plane"])
def test_a_roller_bends_along_one_axis_even_if_tilted(tmp_path, level):
    (note,) = notes(tmp_path, ROUGH - Y**2 / (2 * 10e-3) + 1e-3 * X, level=level)
    assert "bends with a radius of 10 mm along y (level" in note


def test_a_saddle_across_the_axes_is_reported_as_one(tmp_path):
    assert "twisted as a saddle" in notes(tmp_path, ROUGH + 30.0 * X * Y)[0]


def test_the_form_that_a_filter_leaves_counts(tmp_path):
    ball = ROUGH - (X**2 + Y**2) / (2 * 20e-3)
    assert notes(tmp_path, ball, lambda_s="10 um")
    assert notes(tmp_path, ball, lambda_c="30 um") == []


@pytest.mark.parametrize(
    "heights",
    [
        ROUGH,
        ROUGH + 1e-3 * X,
        ROUGH - (X**2 + Y**2) / (2 * 2.0),
        -1e-7 * np.exp(-(X**2 + Y**2) / 16e-6**2),
        1e-7 * np.cos(2 * np.pi * X / 100e-6) + 0.0 * Y,
    ],
    ids=["rough", "tilted", "hardly bent", "dent", "wave"],
)
def test_roughness_is_not_a_form(tmp_path, heights):
    assert notes(tmp_path, heights) == []
    assert notes(tmp_path, heights, level="none") == []
