"""Reading a transient run: profiles that move along, envelopes, what is left of a passing wave."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.api.results import TransientResult
from tehl.base.errors import InputError
from tehl.cli.text import as_text
from tehl.estimate.duration import PASSED_DISTANCE
from tehl.post.transient import envelope, largest_change, moving_profiles, passing_features
from tehl.post.waves import passing_wave
from tehl.report.page import report_text
from tests.fixtures_result import CASE, make_result
from tests.fixtures_transient import make_certified, make_transient, passing

LENGTH = 3e-4


def wave_case(**changes: float) -> dict:
    roughness = {"type": "wave", "amplitude": 1e-8, "wavelength": LENGTH} | changes
    surface = CASE["surface_1"] | {"roughness": roughness}
    return CASE | {"surface_1": surface, "transient": {"start": "standing"}}


def test_a_dent_is_at_rest_in_the_frame_of_its_surface():
    seen = moving_profiles(make_transient(points=65), 1, reach=1e-4)
    whole = ~np.isnan(seen.height).any(axis=1)
    assert whole.sum() > 10
    depth = seen.height[whole].min(axis=1)
    # 200 nm deep; a mesh of a fifth of its radius loses 2 % of it between two nodes
    np.testing.assert_allclose(depth, -2e-7, rtol=0.05)
    middle = seen.offset[seen.height[whole].argmin(axis=1)]
    assert np.abs(middle).max() <= 1.1 * (seen.offset[1] - seen.offset[0])


def test_a_dent_moves_in_the_frame_of_the_other_surface():
    run = make_transient(points=65)
    seen = moving_profiles(run, 2, start=-2e-4)
    assert seen.place[0] == -2e-4
    assert seen.place[-1] == pytest.approx(-2e-4 + 0.75 * 1.5 * run.history.time[-1])
    assert (seen.height[~np.isnan(seen.height)] == 0.0).all()


def carrying(*features: dict) -> TransientResult:
    """Return a run whose surface 1 carries them."""
    case = CASE | {"surface_1": CASE["surface_1"] | {"roughness": list(features)}}
    run = make_transient()
    start = make_result(case=case | {"transient": {}})
    return replace(run, start=replace(run.start, problem=start.problem))


def test_several_features_require_a_start():
    dent = {"type": "bump", "amplitude": -1e-7, "radius": 5e-5, "x": -6e-4}
    wave = {"type": "wave", "amplitude": 1e-8, "wavelength": LENGTH}
    assert moving_profiles(carrying(dent, wave), 1).place[0] == -6e-4
    two = carrying(dent, dent | {"x": -9e-4})
    with pytest.raises(InputError, match="surface_1 has 2 features: state the place"):
        moving_profiles(two, 1)
    assert moving_profiles(two, 1, start=-9e-4).place[0] == -9e-4


def test_a_feature_beside_the_line_of_the_profiles_is_rejected():
    dent = {"type": "bump", "amplitude": -1e-7, "radius": 5e-5, "x": -6e-4}
    with pytest.raises(InputError, match=r"is at y = 0\.0001 m, but profiles are stored"):
        moving_profiles(carrying(dent | {"y": 1e-4}), 1)
    assert moving_profiles(carrying(dent | {"y": 2e-5}), 1).place[0] == -6e-4


def test_profiles_outside_the_domain_are_nan():
    assert np.isnan(moving_profiles(make_transient(), 1).film[-1]).any()


@pytest.mark.parametrize(
    ("words", "call"),
    [
        ("surface = 3: must be 1 or 2", lambda run: moving_profiles(run, 3)),
        ("surface = 3: must be 1 or 2", lambda run: passing_wave(run, 3)),
        ("reach = -1.0 m: must be positive", lambda run: moving_profiles(run, 1, reach=-1.0)),
        ("no step lies between", lambda run: envelope(run, since=1.0)),
        ("surface_1 has no wave", lambda run: passing_wave(run, 1)),
    ],
)
def test_invalid_arguments_are_reported(words, call):
    with pytest.raises(InputError, match=words):
        call(make_transient())


def test_the_envelope_holds_all_profiles():
    run = make_transient()
    found = envelope(run)
    assert (found.film_least <= run.profiles.film).all()
    assert (found.film_largest >= run.profiles.film).all()
    late = envelope(run, since=float(run.history.time[-1]))
    np.testing.assert_array_equal(late.pressure_least, run.profiles.pressure[-1])


def test_the_largest_change_is_that_of_the_film_in_the_dent():
    run = make_transient()
    inside = np.abs(run.start.scaled.x) < 0.8
    changes = (run.profiles.film - run.profiles.film[0])[:, inside]
    found = largest_change(run, "film", 1)
    assert found.value - found.start == changes.max()
    assert found.x in run.x[inside]
    place = -2e-4 + run.start.problem.motion.speed_1 * found.time
    assert found.x == pytest.approx(place, abs=1e-4)  # the mesh width is 4e-5 m
    thinnest = largest_change(run, "film", -1)
    assert thinnest.value - thinnest.start == changes.min()


def test_a_feature_passes_the_centre_after_its_distance_over_its_speed():
    run = make_transient()
    ((part, time),) = passing_features(run)
    assert (part.surface, part.roughness.type) == ("surface_1", "bump")
    assert time == pytest.approx(2e-4 / run.start.problem.motion.speed_1)
    assert list(passing_features(passing(wave_case()))) == []


@pytest.mark.parametrize("phase", [0.0, 2.0])
def test_the_amplitude_of_a_passing_wave_is_found(phase):
    run = passing(wave_case(phase=phase), points=65, flattened=0.3)
    found = passing_wave(run, 1, x=2e-5)
    assert found.amplitude == pytest.approx(1e-8, rel=0.01)
    assert found.film_ratio == pytest.approx(0.7, rel=1e-6)
    assert abs(found.film_phase) < 1e-6
    assert abs(found.pressure_phase) < 1e-3  # the pressure changes between the nodes
    speed = run.start.problem.motion.speed_1
    assert found.steps_per_period == pytest.approx(LENGTH / speed / run.time_step)
    assert 1 <= found.periods <= 4


def test_a_run_that_ends_too_early_is_reported():
    case = wave_case()
    case["transient"] = {"entrance": 6.0}
    with pytest.raises(InputError, match=r"increase transient\.duration"):
        passing_wave(passing(case, points=65), 1)


def test_a_wave_of_too_few_steps_is_reported():
    with pytest.raises(InputError, match="8 or more; take more nodes"):
        passing_wave(passing(wave_case(wavelength=1e-4)), 1)


@pytest.mark.parametrize("degrees", [0.0, 30.0, 60.0])
def test_nabla_takes_the_shorter_wavelength(degrees):
    angle = math.radians(degrees)
    run = passing(wave_case(angle=angle, wavelength=LENGTH * math.cos(angle)), points=65)
    start = run.start
    shorter = LENGTH * min(1.0, 1.0 / math.tan(max(angle, 1e-9)))
    expected = shorter / start.scales.half_width_x * math.sqrt(start.groups.M / start.groups.L)
    assert passing_wave(run, 1).nabla == pytest.approx(expected)


def test_extremes_at_the_end_of_a_run_of_unstated_duration_are_named():
    run = make_transient()
    assert run.late_extremes == ()
    film = run.history.film_minimum.copy()
    film[-1] = 0.5 * film.min()
    late = replace(run, history=replace(run.history, film_minimum=film))
    assert late.late_extremes == ("minimum film",)
    assert late.longer_duration == pytest.approx(2.0 * run.history.time[-1])
    assert 'changed at the end of the run: take transient.duration = "' in as_text(late)
    assert late.summary()["time"]["late_extremes"] == ["minimum film"]
    certified = make_certified()
    bar = replace(certified.uncertainty["film_minimum"], uncertainty=film.max())
    assert replace(late, uncertainty={"film_minimum": bar}).late_extremes == ()


def test_extremes_that_grid_and_steps_do_not_resolve_are_named():
    run = make_transient()
    film, step = run.history.film_central.copy(), run.history.time.size // 2
    film[step - 1 : step + 2] *= 0.8
    film[step] *= 0.95  # 4/0.95 - 2 differences of 5 %
    lines = run.profiles.pressure.copy()
    lines[run.history.pressure_max.argmax(), lines.shape[1] // 2] = 3.0 * lines.max()
    sharp = replace(
        run,
        history=replace(run.history, film_central=film),
        profiles=replace(run.profiles, pressure=lines),
    )
    found = sharp.summary()["unresolved"]
    bend = abs(film[step - 1] - 2.0 * film[step] + film[step + 1]) / film[step]
    assert bend > 0.05
    words = f"passes within a few steps, so that it errs by about {300.0 * bend:.2g} %"
    assert found["film_central_least"] == words
    assert found["pressure_max"].startswith("the spike is narrower than the mesh")
    assert f"the least {words}\n  largest pressure" in as_text(sharp)
    assert f"Central film, least: {words}." in report_text(sharp)
    certified = make_certified().uncertainty
    assert replace(sharp, uncertainty=certified).summary()["unresolved"] == {}
    even = replace(run.history, film_central=0.0 * film + 1e-7, film_minimum=0.0 * film + 1e-7)
    flat = replace(run.profiles, pressure=0.0 * lines + 1e9)
    assert replace(run, history=even, profiles=flat).summary()["unresolved"] == {}


@pytest.mark.parametrize(
    ("outside", "stated"),
    [("periodic", {}), ("mirror", {}), ("flat", {}), ("periodic", {"duration": 1e-3})],
)
def test_a_map_that_repeats_passes_whole_in_the_duration_that_is_named(tmp_path, outside, stated):
    run = make_transient()
    np.save(tmp_path / "map.npy", np.sin(np.arange(400.0)) * np.ones((40, 1)))
    rough = {"type": "map", "file": str(tmp_path / "map.npy"), "unit": "nm", "pixel": 1e-5}
    tables = run.start.problem.model_dump(exclude_none=True)
    tables["surface_1"]["roughness"] = rough | {"outside": outside}
    tables["transient"] |= stated
    problem = ContactProblem.model_validate(tables)
    repeated = replace(run, start=replace(run.start, problem=problem))
    if outside == "flat" or stated:
        assert repeated.longer_duration is None
        return
    units, motion = run.start.scales, problem.motion
    slower = min(motion.speed_1, units.speed)
    distance = 400 * 1e-5 + (2.5 + PASSED_DISTANCE) * units.half_width_x
    assert repeated.longer_duration == pytest.approx(distance / slower)
    assert "repeats at its edges has not passed whole" in as_text(repeated)
    (tmp_path / "map.npy").unlink()
    assert repeated.longer_duration is None
