"""Stress below the surfaces of a result: loads on both bodies, numbers, files, runs in time."""

import csv
import math
from dataclasses import replace

import numpy as np
import pytest

import tehl
from tehl.base.errors import InputError
from tehl.contact.boundary_contact import ContactFilm
from tehl.contact.stress import Stress
from tehl.io.export import export
from tehl.post.stress.below import March, stress_below
from tehl.post.stress.loads import loads_on, on_even_lines
from tehl.post.stress.moving import frame_loads, moving_stress
from tehl.post.stress.numbers import PressureBar, stress_numbers
from tehl.post.traction import cell_widths
from tehl.result.fields import FilmContact, FilmShear
from tests.fixtures_result import CASE, make_result
from tests.fixtures_rough import PRESSURE, WAVELENGTH, make_rough
from tests.fixtures_transient import make_transient
from tests.reference import moes_contact


def stressed(result, **settings):
    """Return a result with its stress."""
    return result.with_stress(**settings or {"body": "both"})


def scaled_pressure(result, factor):
    return replace(result, scaled=replace(result.scaled, pressure=factor * result.scaled.pressure))


def make_dry(points, case=CASE):
    """Return a film whose pressure is that of the dry contact."""
    film = make_result(points, case=case)
    x, y = film.scaled.x, film.scaled.y[:, None]
    return replace(
        film, scaled=replace(film.scaled, pressure=film.problem.shape.dry_pressure(x, y))
    )


@pytest.fixture(scope="module")
def dry():
    return make_dry(193)


@pytest.fixture(scope="module")
def found(dry):
    return stressed(dry)


def test_a_dry_smooth_contact_has_ratios_of_one_and_the_stresses_of_hertz(found):
    scales, numbers = found.scales, found.stress_numbers
    assert [one.body for one in numbers.bodies] == [1, 2]
    for one in numbers.bodies:
        assert one.shear / scales.hertz_pressure == pytest.approx(0.310021, rel=5e-3)
        assert one.shear_depth / scales.half_width_x == pytest.approx(0.480865, abs=5e-3)
        assert one.von_mises / scales.hertz_pressure == pytest.approx(0.620041, rel=5e-3)
        assert one.shear_ratio == pytest.approx(1.0, abs=1e-6)
        assert one.dang_van_ratio == pytest.approx(1.0, abs=1e-6)
        assert one.life_ratio == pytest.approx(1.0, abs=1e-5)
        assert abs(one.shear_x) < 0.05 * scales.half_width_x
        assert one.shear_error < 5e-3
        assert one.life_ratio_error < 0.1
    assert numbers.remarks == ()


def test_the_bar_of_a_narrow_spike_fades_with_the_depth():
    """A line on 1025 nodes, whose spike errs by 38 %, has the shear stress of 8193 to 0.1 %."""
    assert PressureBar(0.4, math.inf).at(1e-4) == pytest.approx(0.4)
    assert PressureBar(0.4, 1e-6).at(1e-6) == pytest.approx(0.2)
    assert PressureBar(0.4, 1e-6).at(1e-4) == pytest.approx(0.8e-2 / math.pi, rel=1e-3)


def test_the_bar_of_the_shear_stress_of_a_line_holds_its_direct_integral():
    """Of strips of uniform pressure (Johnson 1985, section 2.5), without shear: it rolls."""
    contact = {"type": "line", "radius": 0.01, "moes_load": 50.0, "moes_speed": 10.0}
    given = moes_contact(50.0, 10.0).model_dump(exclude_none=True)
    line = tehl.ContactProblem.model_validate(given | {"contact": contact, "stress": {}})
    result = tehl.solve(line)
    half, unit = 0.5 * (result.x[1] - result.x[0]), result.scales.half_width_x
    x, z = (
        unit * np.linspace(-0.3, 0.3, 61)[:, None, None],
        unit * np.linspace(0.6, 1.0, 81)[:, None],
    )
    ends = x - result.x + half, x - result.x - half
    turned, slip = (
        (one(ends[0]) - one(ends[1])) @ result.pressure[0] / math.pi
        for one in (lambda s: s * z / (s**2 + z**2), lambda s: z**2 / (s**2 + z**2))
    )
    largest = float(np.hypot(turned, slip).max())  # (sigma_x - sigma_z)/2 and tau_zx
    found = result.stress_numbers.worse
    assert largest == pytest.approx(0.3003 * result.scales.hertz_pressure, rel=0.03)
    assert found.shear == pytest.approx(largest, rel=found.shear_error)
    assert found.shear_error < 5e-3


@pytest.mark.parametrize("criterion", ["orthogonal-shear", "dang-van"])
def test_the_life_falls_as_a_power_of_the_stress(dry, criterion):
    more = stressed(scaled_pressure(dry, 1.1), criterion=criterion, stress_exponent=9.0)
    # 1e-4: single precision, to the power of 9
    expected = 1.1 ** (-9.0 * 0.9)
    assert more.stress_numbers.worse.life_ratio == pytest.approx(expected, rel=1e-4)


def test_without_stress_above_the_fatigue_limit_there_is_no_life_to_compare(dry):
    numbers = stressed(dry, body=1, fatigue_limit=1e9).stress_numbers
    assert numbers.worse.life_ratio is None
    assert numbers.worse.life_ratio_error is None


def with_traction(result, coefficient):
    """Return a film whose shear stress is proportional to its pressure, without rolling."""
    stress, nothing = coefficient * result.pressure, np.zeros_like(result.pressure)
    shear = FilmShear(
        surface_1=stress,
        mid_film=stress,
        surface_2=stress,
        across=nothing,
        thinning=nothing + 1.0,
    )
    return replace(result, shear=shear)


def test_the_film_pulls_both_bodies_in_opposite_directions(dry):
    film = with_traction(dry, -0.08)
    pull, push = loads_on(film, 1), loads_on(film, 2)
    np.testing.assert_allclose(pull.traction_x, -0.08 * dry.pressure)
    np.testing.assert_allclose(push.traction_x, -pull.traction_x)
    slope = np.gradient(dry.pressure, dry.y, axis=0)
    np.testing.assert_allclose(
        pull.traction_y, np.where(dry.pressure > 0, -0.5 * dry.film_thickness * slope, 0.0)
    )
    np.testing.assert_allclose(push.traction_y, pull.traction_y)  # both are the rolling part
    first, second = stressed(film).stress_numbers.bodies
    assert first.traction == pytest.approx(-0.08, rel=1e-6)
    # mirrored but for the rolling part along y, as the film is thinner downstream
    assert first.shear == pytest.approx(second.shear, rel=1e-5)
    assert first.shear_x == pytest.approx(-second.shear_x)
    assert first.shear_x < 0 < second.shear_x  # behind it, the body is compressed along x
    assert first.life_ratio < 1.0


def test_bodies_that_only_roll_are_computed_once_and_each_has_its_stress(dry, monkeypatch):
    seen = []
    through = March.through
    monkeypatch.setattr(March, "through", lambda *args: seen.append(len(args[1])) or through(*args))
    both = stressed(with_traction(dry, 0.0)).stress
    assert seen == [2, 2]  # one body and the dry contact, on both grids
    second = stressed(with_traction(dry, 0.0), body=2).stress
    for name in ("shear", "zx", "floor", "dang_van", "shear_coarse"):
        np.testing.assert_array_equal(getattr(both, name)[1], getattr(second, name)[0])
        np.testing.assert_array_equal(getattr(both, name)[0], getattr(both, name)[1])


def test_a_traction_that_no_oil_can_carry_is_left_out_and_said(dry):
    numbers = stressed(with_traction(dry, -0.3), body=1).stress_numbers
    assert numbers.worse.traction == 0.0
    assert numbers.traction_left_out
    assert any("left out" in remark for remark in numbers.remarks)


def test_contact_carries_load_and_rubs_in_place_of_the_film(dry):
    film = with_traction(dry, -0.05)
    thin = np.where(dry.scaled.x > 0, 2e-9, film.film_thickness) / dry.scales.film_thickness
    solid = np.where(dry.scaled.x > 0, 1e8, 0.0) * np.ones_like(dry.pressure)
    touching = replace(
        film,
        scaled=replace(film.scaled, film=thin),
        contact=FilmContact(pressure=solid, balance=np.zeros(())),
        problem=film.problem.model_copy(
            update={"contact_film": ContactFilm(thickness=2e-9, friction=0.12)}
        ),
    )
    loads = loads_on(touching, 1)
    np.testing.assert_allclose(loads.pressure, dry.pressure + solid)
    inside = dry.pressure > 0
    right = inside & (dry.scaled.x > 0)
    left = inside & (dry.scaled.x <= 0)
    np.testing.assert_allclose(loads.traction_x[right], -0.12 * (dry.pressure + solid)[right])
    np.testing.assert_allclose(loads.traction_x[left], -0.05 * dry.pressure[left])


def test_residual_stress_acts_along_the_surface(dry, found):
    profile = ((0.0, -3e8), (1e-4, -1e8))
    pressed = stressed(dry, body=1, residual=profile)
    depth, added = pressed.stress.depth, pressed.stress.xx[0] - found.stress.xx[0]
    expected = np.interp(depth, [0.0, 1e-4], [-3e8, -1e8])[:, None] + np.zeros_like(added)
    np.testing.assert_allclose(added, expected, rtol=1e-3)
    np.testing.assert_allclose(pressed.stress.zz[0], found.stress.zz[0], rtol=1e-5)
    assert pressed.stress_numbers.worse.dang_van < 0.9 * found.stress_numbers.worse.dang_van
    assert pressed.stress_numbers.worse.dang_van_ratio == pytest.approx(1.0, abs=1e-6)


def test_a_wave_is_forgotten_with_depth_as_its_fourier_series_says():
    rough, smooth = stressed(make_rough(), body=1), stressed(make_result(193), body=1)
    shallowest = 2.0 * (rough.x[1] - rough.x[0])
    assert rough.stress.depth[0] == pytest.approx(shallowest)
    assert "twice" in rough.stress_numbers.remarks[0]
    assert rough.stress_numbers.worse.shear_ratio > 1.0
    middle = int(np.argmin(np.abs(rough.stress.x)))
    here = rough.stress.depth < 0.25 * rough.scales.half_width_x
    added = (rough.stress.zz - smooth.stress.zz)[0, here, middle]
    reach = 2.0 * math.pi / (WAVELENGTH * rough.scales.half_width_x) * rough.stress.depth[here]
    expected = -PRESSURE * rough.scales.hertz_pressure * (1.0 + reach) * np.exp(-reach)
    # the ripple ends at P = 0.1 and has eight nodes per wave
    np.testing.assert_allclose(added, expected, atol=0.04 * PRESSURE * rough.scales.hertz_pressure)


def test_a_slender_smooth_contact_is_resolved_by_its_finer_mesh_width():
    contact = {k: v for k, v in CASE["contact"].items() if k != "radius"}
    case = CASE | {"contact": contact | {"radius_x": 0.005, "radius_y": 0.1}}
    slender = stressed(make_dry(65, case), body=1)
    steps = slender.x[1] - slender.x[0], slender.y[1] - slender.y[0]
    assert slender.stress.depth[0] == pytest.approx(2.0 * min(steps))
    assert slender.stress_numbers.worse.shear_ratio == pytest.approx(1.0, abs=1e-6)


def test_a_roller_is_compared_with_its_dry_slices():
    contact = {"type": "roller", "radius": "10 mm", "length": "10 mm", "moes_load": 50.0}
    rolling = tehl.solve(
        tehl.ContactProblem(
            contact=contact | {"moes_speed": 10.0, "profile": {"shape": "logarithmic"}},
            surface_1={"material": "steel"},
            surface_2={"material": "steel"},
            lubricant="mineral-oil",
        ),
        tehl.Options(points=(129, 65)),
    )
    even = on_even_lines(rolling)
    loads = [cell_widths(one.scaled.y) @ one.scaled.pressure for one in (even, rolling)]
    assert np.diff(even.scaled.y) == pytest.approx(1 / 32)
    assert loads[0] == pytest.approx(loads[1], abs=0.01 * loads[1].max())
    body = stress_numbers(rolling.with_stress(depths=10, body=1)).of(1)
    assert body.shear_ratio == pytest.approx(1.0, abs=0.1)
    assert 0.2 < body.life_ratio < 5.0


def test_the_file_keeps_the_stress_and_exports_it(found, tmp_path):
    found.save(tmp_path / "film.nc")
    back = tehl.load(tmp_path / "film.nc")
    np.testing.assert_array_equal(back.stress.zx, found.stress.zx)
    assert stress_numbers(back) == found.stress_numbers
    block = found.summary()["stress"]
    assert block["shear_max_pa"] == found.stress_numbers.worse.shear
    assert block["body_2"]["von_mises_max_pa"] == found.stress_numbers.of(2).von_mises
    assert make_result().summary()["stress"] is None
    export(found, tmp_path / "depths.csv", what="depths")
    export(found, tmp_path / "section.csv", what="section")
    with (tmp_path / "depths.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == found.stress.shear.size
    assert float(rows[3]["shear_max_pa"]) == found.stress.shear[0, 3]
    with (tmp_path / "section.csv").open(encoding="utf-8") as file:
        assert sum(1 for _ in file) == 1 + found.stress.zz.size


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"residual": [["20 um", "-300 MPa"], ["10 um", "0 MPa"]]}, "depths that increase"),
        ({"body": 3}, "known are 1, 2, both"),
        ({"depths": 4}, "a whole number from 8 to 200"),
        ({"residual": [["20 um", "-300 nm"]]}, "stress"),
        ({"exponent": 9}, "did you mean"),
    ],
)
def test_mistakes_of_the_table_name_key_and_remedy(settings, words):
    with pytest.raises(InputError, match=words):
        tehl.ContactProblem(**CASE, stress=settings)


def test_a_passing_dent_is_followed_in_time():
    run = make_transient(points=65)
    settings = Stress(depths=10)
    seen = moving_stress(run, 1, settings)
    assert seen.plane.shape == (run.frames.step.size, 10, seen.x.size)
    np.testing.assert_array_equal(seen.time, run.history.time[run.frames.step])
    steady = stress_below(run.start, settings)
    assert seen.depth[0] >= steady.depth[0]
    assert seen.shear.max() == pytest.approx(float(steady.shear.max()), rel=0.5)
    loads = frame_loads(run, 0, 1)
    traction = run.history.traction[run.frames.step[0]]
    part = loads.traction_x.sum() / loads.pressure.sum()
    assert abs(traction) <= 0.1
    assert part == pytest.approx(traction, abs=2e-3)
    with pytest.raises(InputError, match="body = 3"):
        moving_stress(run, 3)
    with pytest.raises(InputError, match=r"transient\.frames"):
        moving_stress(make_transient(frames=False))


def test_tractions_that_no_oil_transmits_do_not_load_the_bodies():
    """Neither along x nor along y: what is left is the slope of the film."""
    run = make_transient(points=65)

    def loaded(traction: float, across: float):
        still = np.zeros_like(run.history.time)
        changes = {"traction": still + traction, "traction_across": still + across}
        return frame_loads(replace(run, history=replace(run.history, **changes)), 0, 1)

    none, small, wrong = loaded(0.0, 0.0), loaded(0.03, 0.04), loaded(-263.0, 0.04)
    difference = small.traction_y - none.traction_y
    np.testing.assert_allclose(difference, 0.04 * none.pressure, rtol=1e-9)
    np.testing.assert_array_equal(wrong.traction_x, none.traction_x)
    np.testing.assert_array_equal(wrong.traction_y, none.traction_y)


def test_a_run_in_time_stores_the_shear_stress_of_its_fields(tmp_path):
    """At time zero the loads are those of the steady film at the start, for a film that thins."""
    lubricant = CASE["lubricant"] | {"shear": {"law": "eyring", "stress": "8 MPa"}}
    contact = CASE["contact"] | {"slide_roll_ratio": 0.3}
    change = {"duration": "0.2 ms", "load": [["0 ms", 1.0], ["0.2 ms", 1.1]], "frames": 2}
    case = CASE | {"contact": contact, "lubricant": lubricant, "transient": change}
    problem = tehl.ContactProblem(**case, stress={"body": 2, "depths": 8})
    run = tehl.solve_transient(problem, tehl.Options(points=65))
    for body in (1, 2):
        still, first = loads_on(run.start, body), frame_loads(run, 0, body)
        largest = np.abs(still.traction_x).max()
        # 1e-5: single precision; along the film slopes are by differences
        np.testing.assert_allclose(first.pressure, still.pressure, rtol=1e-5)
        np.testing.assert_allclose(first.traction_x, still.traction_x, atol=0.02 * largest)
        assert first.traction_x.sum() == pytest.approx(still.traction_x.sum(), rel=1e-3)
    run.save(tmp_path / "run.nc")
    np.testing.assert_array_equal(tehl.load(tmp_path / "run.nc").frames.stress, run.frames.stress)
    without = replace(run, frames=replace(run.frames, stress=None))
    even = frame_loads(without, 0, 1)
    assert even.traction_x.sum() == pytest.approx(frame_loads(run, 0, 1).traction_x.sum(), rel=0.01)


def test_a_solve_computes_what_the_case_asks_for():
    """Film and pressure have the bits of a case without the table."""
    options = tehl.Options(points=65)
    plain = tehl.solve(tehl.ContactProblem(**CASE), options)
    asked = tehl.solve(tehl.ContactProblem(**CASE, stress={"body": 1, "depths": 8}), options)
    assert plain.stress is None
    np.testing.assert_array_equal(asked.pressure, plain.pressure)
    again = plain.with_stress(body=1, depths=8)
    np.testing.assert_array_equal(asked.stress.zz, again.stress.zz)
    assert 0.9 < asked.stress_numbers.worse.shear_ratio < 1.2
