"""Explanation of rough surfaces before the solve."""

import json
import math
from typing import Any

import numpy as np
import pytest

from tehl.api.problem import case_from_tables
from tehl.base.errors import InputError
from tehl.report.explain import Explanation, as_summary, as_text, explain
from tests.cases import ball_tables

WAVE = {"type": "wave", "amplitude": "50 nm", "wavelength": "80 um", "angle": "0 deg"}


def explained(roughness: Any, **tables: Any) -> Explanation:
    """Return the explanation of the ball on a disc that has heights."""
    surface = {"material": "steel", "roughness": roughness}
    return explain(*case_from_tables(ball_tables(surface_2=surface) | tables))


def test_smooth_surfaces_have_no_section():
    case = explain(*case_from_tables(ball_tables()))
    assert case.roughness is None
    assert "Roughness" not in as_text(case)
    assert as_summary(case)["roughness"] is None


def test_a_wave_has_its_sq_slope_and_lambda_central():
    case = explained(WAVE)
    found = case.roughness
    assert found.sq[0] == 0.0
    # 5.5 waves in the contact, so that the mean is not quite zero
    assert found.composite == pytest.approx(50e-9 / math.sqrt(2), rel=0.02)
    assert found.steepest == pytest.approx(2 * math.pi * 50e-9 / 80e-6, rel=0.02)
    # pi E* A / wavelength over root two, E* = E'/2
    pressure = math.pi * 0.5 * case.scaled.problem.reduced_modulus * 50e-9 / 80e-6
    assert found.flattening == pytest.approx(pressure / math.sqrt(2), rel=0.02)
    assert "Sa                    surface 1 0 nm   surface 2 31." in as_text(case)
    assert case.lambda_central == pytest.approx(case.central_film / found.composite)
    assert case.questions == ()
    json.dumps(as_summary(case), allow_nan=False)


@pytest.mark.parametrize(("rms", "is_asked"), [(40e-9, False), (100e-9, True)])
def test_a_random_surface_that_hardly_flattens_is_reported(rms: float, is_asked: bool):
    case = explained({"type": "random", "rms": rms, "correlation_length": "15 um", "seed": 2})
    assert ("Hertz pressures (rms over the contact)" in as_text(case)) == is_asked


def test_the_proposed_nodes_put_eight_and_sixteen_on_a_wave():
    found = explained(WAVE, numerics={"points": 257}).roughness
    for points, wanted in ((found.points_to_converge, 8), (found.points_to_resolve, 16)):
        there = explained(WAVE, numerics={"points": points}).roughness.points_per_wave
        assert there >= wanted
    assert found.points_per_wave == pytest.approx(
        explained(WAVE, numerics={"points": 513}).roughness.points_per_wave / 2
    )


def test_theory_flattens_a_transverse_wave_and_leaves_a_longitudinal_one_to_the_inlet():
    _, across = explained(WAVE).roughness.waves[0]
    assert across.film_ratio == pytest.approx(
        1 - across.pressure / across.elastic_pressure, rel=1e-3
    )
    along = explained(WAVE | {"angle": "90 deg"})
    assert along.roughness.waves[0][1].left_to_inlet
    assert "depends on the inlet" in as_text(along)
    assert "% left in the film" in as_text(explained(WAVE))


@pytest.mark.parametrize(
    "tables",
    [
        {"thermal": {}, "lubricant": "mineral-oil"},
        {"lubricant": ball_tables()["lubricant"] | {"shear": {"law": "eyring", "stress": "5 MPa"}}},
    ],
)
def test_heated_or_shear_thinning_films_have_no_theory_of_waves(tables):
    case = explained(WAVE, **tables)
    shown = as_text(case)
    assert "% left in the film" not in shown
    assert "no theory of its amplitude in the film: it covers isothermal Newtonian films" in shown
    assert as_summary(case)["roughness"]["waves"][0]["film_ratio"] is None
    steep = explained(WAVE | {"amplitude": "0.5 um"}, **tables)
    assert any("flattening a wave needs" in question for question in steep.questions)
    assert "depends on the inlet" in as_text(explained(WAVE | {"angle": "90 deg"}, **tables))


def test_the_text_states_whether_the_roughness_stands_or_moves():
    assert "quasi-steady" in as_text(explained(WAVE))
    assert "moves with its surfaces" in as_text(explained(WAVE, transient={}))


def test_a_bump_beside_a_stated_roughness_counts_both():
    surface = {"material": "steel", "rms_roughness": "30 nm"}
    bump = {"type": "bump", "amplitude": "0.2 um", "radius": "50 um"}
    case = explained(bump, surface_1=surface)
    assert case.roughness.sq[0] == 30e-9
    assert case.roughness.waves == ()
    assert case.lambda_central == pytest.approx(case.central_film / case.roughness.composite)


ODD = [
    (WAVE | {"wavelength": "30 um"}, {"numerics": {"points": 257}}, "nodes on the shortest wave"),
    (WAVE | {"amplitude": "2 um"}, {}, "slopes up to 0.16"),
    (WAVE | {"amplitude": "1 um"}, {}, "asperities may touch"),
    (WAVE | {"amplitude": "0.5 um"}, {}, "flattening a wave needs"),
    (
        {"type": "random", "rms": "1 nm", "correlation_length": "1 um"},
        {},
        "surface_2: the random surface repeats",
    ),
    (WAVE | {"wavelength": "1 um", "amplitude": "1 nm"}, {}, "more than 16385 nodes"),
]


@pytest.mark.parametrize(("roughness", "tables", "words"), ODD)
def test_implausible_heights_are_reported(roughness: Any, tables: Any, words: str):
    assert any(words in question for question in explained(roughness, **tables).questions)


def test_a_missing_map_raises_an_input_error():
    missing = {"type": "map", "file": "none.npy", "unit": "um", "pixel": "1 um"}
    with pytest.raises(InputError, match=r"none\.npy"):
        explained(missing)


def test_a_measured_surface_is_explained(tmp_path):
    x = np.linspace(0, 1e-3, 201)
    np.save(tmp_path / "wave.npy", np.tile(0.05 * np.cos(2 * np.pi * x / 1e-4), (201, 1)))
    table = {
        "type": "map", "file": str(tmp_path / "wave.npy"), "unit": "um", "pixel": "5 um",
        "level": "mean",
    }  # fmt: skip
    found = explained(table).roughness
    assert found.composite == pytest.approx(0.05e-6 / math.sqrt(2), rel=0.05)
    assert found.shortest_wave == pytest.approx(1e-4, rel=0.1)


@pytest.fixture
def noisy(tmp_path):
    """Return a map of which a usual grid loses most: waves of 100 um below those of 8 um."""
    x = np.arange(800) * 1e-6
    short = 2 * np.cos(2 * np.pi * x / 8e-6) * np.cos(2 * np.pi * x / 8e-6)[:, None]
    np.save(tmp_path / "a.npy", 0.035 * np.cos(2 * np.pi * x / 1e-4) + 0.068 * short)
    return {"type": "map", "file": str(tmp_path / "a.npy"), "unit": "um", "pixel": "1 um"}


def test_what_a_grid_loses_is_explained_and_lambda_is_that_of_the_full_surface(noisy):
    case = explained(noisy, numerics={"points": 257})
    assert case.roughness.composite == pytest.approx(72.3e-9, rel=0.03)
    assert case.lambda_central == pytest.approx(case.central_film / case.roughness.composite)
    assert any("of the variance in waves too short" in question for question in case.questions)
    assert "of the variance is lost" in as_text(case)
    block = as_summary(case)["roughness"]["resolution"]
    assert block["lost_share"] > 0.8
    json.dumps(block, allow_nan=False)


@pytest.mark.parametrize("wanted", ["points_to_converge", "points_to_resolve"])
def test_the_proposed_grid_of_a_map_does_not_move_away(noisy, wanted):
    proposed = getattr(explained(noisy).roughness, wanted)
    followed = explained(noisy, numerics={"points": proposed})
    assert getattr(followed.roughness, wanted) == proposed
    assert followed.roughness.resolution.lost_share < 0.02
    assert not [one for one in followed.questions if "shortest wave" in one or "variance" in one]


def test_what_begins_upstream_is_explained_as_it_passes(noisy):
    bump = {"type": "bump", "amplitude": "0.1 um", "radius": "60 um", "x": "-3 mm"}
    for roughness in (noisy | {"x": "-2 mm"}, [bump, noisy | {"x": "-2 mm"}]):
        case = explained(roughness, transient={})
        assert case.roughness.composite == pytest.approx(72.3e-9, rel=0.03)
        assert 1 < case.lambda_central < 100
        assert not [one for one in case.questions if "beside the contact" in one]
    standing = explained(noisy | {"x": "-2 mm"})
    assert (standing.roughness.composite, standing.lambda_central) == (0.0, None)
    assert any("lies beside the contact" in one for one in standing.questions)
