"""Traction from shear stresses: closed forms, signs and the balance of forces."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.post.traction import under_pressure
from tests.fixtures_result import make_result
from tests.fixtures_thermal import with_shear


def test_without_stresses_there_is_no_traction(result):
    assert result.traction is None


def test_a_stress_proportional_to_pressure_is_the_coefficient(sheared):
    carried = np.sum(sheared.pressure * under_pressure(sheared)) / sheared.scales.load
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
    assert found.friction_power > 0


def test_a_traction_beyond_that_of_oils_is_not_credible(sheared):
    assert sheared.traction.credible
    shear = replace(sheared.shear, mid_film=3 * sheared.shear.mid_film)
    assert not replace(sheared, shear=shear).traction.credible


def test_stresses_outside_the_pressurised_film_do_not_count(sheared):
    dry = sheared.scaled.pressure <= 0
    shear = replace(sheared.shear, mid_film=np.where(dry, np.nan, sheared.shear.mid_film))
    found = replace(sheared, shear=shear).traction
    assert found.mid_film == sheared.traction.mid_film
