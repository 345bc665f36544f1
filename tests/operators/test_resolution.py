"""Which part of the heights a grid carries."""

import math

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.operators.resolution import resolution_of
from tests.cases import ball_tables

WIDTH = 219.7e-6
LONG, SHORT = 25e-9, 68e-9


@pytest.fixture
def table(tmp_path):
    """Return a map of a long wave, and of one of 8 um along x and along y."""
    x = np.arange(800) * 1e-6
    short = 2 * np.cos(2 * np.pi * x / 8e-6) * np.cos(2 * np.pi * x / 8e-6)[:, None]
    heights = LONG * math.sqrt(2) * np.cos(2 * np.pi * x / 1e-4) + SHORT * short
    np.save(tmp_path / "map.npy", heights)
    return {"type": "map", "file": str(tmp_path / "map.npy"), "unit": "m", "pixel": "1 um"}


def problem(roughness, **tables):
    surface = {"material": "steel", "roughness": roughness}
    return ContactProblem.model_validate(ball_tables(surface_2=surface) | tables)


def test_the_part_of_the_variance_that_a_mesh_carries_is_that_of_its_long_waves(table):
    found = resolution_of(problem(table), (1e-5, 1e-5))
    assert found.sq == (0.0, pytest.approx(math.hypot(LONG, SHORT), rel=0.02))
    assert found.kept == (0.0, pytest.approx(LONG, rel=0.02))
    assert found.lost_share == pytest.approx(SHORT**2 / (LONG**2 + SHORT**2), rel=0.02)
    assert "nm Sq, and loses 88 % of the variance in waves too short" in found.warning


def test_a_fine_mesh_and_a_formula_lose_nothing(table):
    for roughness, step in (
        (table, 1e-6),
        ({"type": "wave", "amplitude": "50 nm", "wavelength": "80 um"}, 1e-5),
    ):
        found = resolution_of(problem(roughness), (step, step))
        assert found.kept == pytest.approx(found.sq, rel=1e-3)
        assert (found.lost_share, found.warning) == (pytest.approx(0, abs=1e-3), None)
    assert resolution_of(ContactProblem.model_validate(ball_tables()), (1e-5, 1e-5)) is None


def test_sa_of_a_wave_is_its_amplitude_over_half_pi():
    wave = {"type": "wave", "amplitude": "50 nm", "wavelength": "80 um"}
    found = resolution_of(problem(wave), (1e-5, 1e-5))
    assert found.sa == (0.0, pytest.approx(50e-9 * 2 / math.pi, rel=0.01))


@pytest.mark.parametrize("many", [False, True])
def test_a_moving_map_or_list_counts_as_it_passes_the_contact(table, many):
    upstream = table | {"x": "-2 mm"}
    bump = {"type": "bump", "amplitude": "0.1 um", "radius": "20 um", "x": "-5 mm"}
    roughness = [bump, upstream] if many else upstream
    moving = resolution_of(problem(roughness, transient={}), (1e-6, 1e-6))
    assert moving.sq[1] == pytest.approx(math.hypot(LONG, SHORT), rel=0.02)
    assert resolution_of(problem(roughness), (1e-6, 1e-6)).sq == (0.0, 0.0)


def test_long_steps_lose_waves_too(table):
    slow, fast = (
        resolution_of(problem(table, transient={"stride": stride}), (1e-6, 1e-6))
        for stride in (1, 8)
    )
    assert slow.lost_share < 1e-3
    assert fast.lost_share > 0.8
