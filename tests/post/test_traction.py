"""Traction from shear stresses: closed forms, signs and the balance of forces."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ellipe

import tehl
from tehl.contact.options import Domain
from tehl.contact.supply import Supply
from tehl.operators.loaded_zone import zone_part
from tehl.post import surroundings
from tehl.post.traction import under_pressure
from tests.cases import moes_problem
from tests.fixtures_result import CASE, make_result
from tests.fixtures_thermal import with_shear


def test_without_stresses_there_is_no_traction(result):
    assert result.traction is None


def test_a_stress_proportional_to_pressure_is_the_coefficient(sheared):
    zone = zone_part(sheared.scaled.x, sheared.scaled.y)
    carried = np.sum(sheared.pressure * zone * under_pressure(sheared)) / sheared.scales.load
    assert sheared.traction.mid_film == pytest.approx(-0.05 * carried, rel=1e-12)
    assert sheared.traction.mid_film * 80.0 == pytest.approx(-0.05 * carried * 80.0)


def test_surfaces_differ_by_twice_the_rolling_part(sheared):
    found = sheared.traction
    assert found.surface_2 - found.surface_1 == pytest.approx(2 * found.rolling)
    assert found.surface_1 + found.surface_2 == pytest.approx(2 * found.mid_film)


def test_stresses_out_of_balance_are_reported(sheared):
    honest = sheared.traction.closure_error
    shear = replace(sheared.shear, surface_2=sheared.shear.surface_2 + 0.01 * sheared.pressure)
    found = replace(sheared, shear=shear).traction
    assert found.closure_error > honest + 0.1


def test_both_forms_of_the_rolling_part_agree_on_a_fine_grid():
    """p and h of one smooth case: the forms differ by the error of central differences."""

    def gap(points: int) -> float:
        coarse = make_result(points)
        x, y = np.meshgrid(coarse.scaled.x, coarse.scaled.y)
        pressure = np.maximum(1 - x**2 - y**2, 0) ** 3
        film = 0.1 * np.exp(-0.3 * x) + 0 * y
        fields = replace(coarse.scaled, pressure=pressure, film=film)
        found = with_shear(replace(coarse, scaled=fields)).traction
        assert found.rolling > 0
        return abs(found.rolling / found.rolling_by_film - 1)

    assert gap(129) < 0.3 * gap(65) < 0.01


def test_friction_power_is_sliding_and_rolling(sheared):
    found, motion = sheared.traction, sheared.problem.motion
    sliding = -found.mid_film * found.load * motion.sliding_speed
    rolling = 2 * found.rolling * found.load * motion.entrainment_speed
    assert found.friction_power == pytest.approx(sliding + rolling)
    assert found.sliding_power == pytest.approx(sliding)
    assert found.friction_power > 0


@pytest.mark.parametrize("ratio", [1.0, 3.0])
def test_the_drilling_moment_of_coulomb_friction_on_a_hertz_contact_is_the_closed_one(ratio):
    """(3/8) mu w a E(e), 3 pi/16 mu w a of a circle (Lutz 1955; Johnson 1985, section 8.3)."""
    radii = {"radius_x": 0.02, "radius_y": ratio * 0.02}
    motion = {"load": 80.0, "entrainment_speed": 1.5, "spin_1": 10.0, "spin_2": -10.0}
    result = make_result(129, case=CASE | {"contact": radii | motion})
    hertz = result.problem.hertz
    x, y = hertz.half_width_x * result.scaled.x, hertz.half_width_y * result.scaled.y[:, None]
    square = (x / hertz.half_width_x) ** 2 + (y / hertz.half_width_y) ** 2
    pressure = np.sqrt(np.maximum(1.0 - square, 0.0))
    stress = 0.05 * hertz.pressure * pressure / np.maximum(np.hypot(x, y), 1e-12)
    shear = replace(with_shear(result).shear, mid_film=stress * y, across=-stress * x)
    fields = replace(result.scaled, pressure=pressure)
    found = replace(result, shear=shear, scaled=fields).traction
    long = max(hertz.half_width_x, hertz.half_width_y)
    short = min(hertz.half_width_x, hertz.half_width_y)
    limit = 0.375 * 0.05 * result.load * long * ellipe(1.0 - (short / long) ** 2)
    assert -found.drilling_moment == pytest.approx(limit, rel=2e-3)
    assert found.size < 1e-9


def test_a_traction_beyond_that_of_oils_is_not_credible(sheared):
    assert sheared.traction.credible
    shear = replace(sheared.shear, mid_film=3 * sheared.shear.mid_film)
    assert not replace(sheared, shear=shear).traction.credible


def test_spin_alone_shears_no_oil_harder_than_it_can_carry():
    """Its forces cancel out, not those at each place."""
    radii = {"radius_x": 0.02, "radius_y": 0.02}
    motion = {"load": 80.0, "entrainment_speed": 1.5, "spin_1": 10.0, "spin_2": -10.0}
    result = make_result(65, case=CASE | {"contact": radii | motion})
    x, y = result.x, result.y[:, None]
    for friction, is_credible in ((0.08, True), (0.3, False)):
        stress = friction * result.pressure / np.maximum(np.hypot(x, y), 1e-12)
        shear = replace(with_shear(result).shear, mid_film=stress * y, across=-stress * x)
        found = replace(result, shear=shear).traction
        assert found.size < 1e-3
        assert found.sheared == pytest.approx(friction, rel=0.05)
        assert found.credible is is_credible


def test_stresses_outside_the_pressurised_film_do_not_count(sheared):
    dry = under_pressure(sheared) == 0
    shear = replace(sheared.shear, mid_film=np.where(dry, np.nan, sheared.shear.mid_film))
    found = replace(sheared, shear=shear).traction
    assert found.mid_film == sheared.traction.mid_film


@pytest.fixture(scope="module")
def thick_films():
    """M = 5, L = 5 at one mesh width, on the default domain and one twice as large."""
    problem = moes_problem(5.0, 5.0)
    contact = problem.contact.model_copy(update={"slide_roll_ratio": 0.25})
    problem = problem.model_copy(update={"contact": contact})
    domain = Domain(x=(-6.8, 3.09), y=(-5.1, 5.1))
    wide = Domain(x=(-13.6, 6.18), y=(-10.2, 10.2))
    return [
        tehl.solve(problem, tehl.Options(points=n, domain=one, edges="far_field"))
        for n, one in ((129, domain), (257, wide))
    ]


def test_friction_of_a_thick_film_does_not_depend_on_the_domain(thick_films):
    near, wide = (one.traction for one in thick_films)
    # over the whole domain it is 27 % larger on the wider one
    for name in ("mid_film", "surface_1", "surface_2"):
        assert getattr(near, name) == pytest.approx(getattr(wide, name), rel=0.004), name


def test_the_drag_of_the_surroundings_does_not_depend_on_the_domain(thick_films):
    near, wide = (one.traction.surroundings for one in thick_films)
    for name in ("mid_film", "surface_1", "surface_2", "friction_power"):
        assert getattr(near, name) == pytest.approx(getattr(wide, name), rel=0.004), name
    # half of R_x, up to which the gap counts
    assert near.radius == pytest.approx(0.5 * thick_films[0].problem.radius_x)
    # most of it is drag on both surfaces: three times that of the loaded zone
    assert 2.5 < near.mid_film / thick_films[0].traction.mid_film < 4.0


@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_the_drag_of_the_surroundings_does_not_depend_on_its_nodes(monkeypatch, angle):
    """A ball on a raceway, whose gap hardly opens along y."""
    radii = {"radius_x": 0.01, "radius_y": 0.2, "entrainment_angle": angle}
    problem = moes_problem(10.0, 5.0, **radii)
    result = tehl.solve(problem, tehl.Options(points=65))
    outer = 100.0
    found = surroundings._beyond(result, outer)
    monkeypatch.setattr(surroundings, "RAYS", 3 * surroundings.RAYS)
    monkeypatch.setattr(surroundings, "RINGS", 3 * surroundings.RINGS)
    assert found == pytest.approx(surroundings._beyond(result, outer), rel=1e-4)


def test_starved_films_have_no_flooded_surroundings(sheared):
    supply = Supply(ratio=0.5)
    starved = replace(sheared, problem=sheared.problem.model_copy(update={"supply": supply}))
    assert starved.traction.surroundings is None
