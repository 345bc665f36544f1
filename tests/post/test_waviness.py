"""Waves of the surfaces in film and pressure: known ripples are found again."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tehl.post.waviness import bulk_modulus, wave_responses
from tehl.problem import ContactProblem
from tehl.result import SurfaceHeights
from tehl.transient import Transient
from tests.fixtures_result import CASE, make_result
from tests.fixtures_rough import (
    AMPLITUDE,
    ANGLE,
    CARRIED,
    LEFT,
    PRESSURE,
    WAVELENGTH,
    make_rough,
)


def test_ripples_of_an_oblique_wave_are_parted_from_the_streaks_it_leaves(rough, smooth):
    (wave,) = wave_responses(rough, smooth)
    unit, width = rough.scales.film_thickness, rough.scales.half_width_x
    assert wave.wavelength == pytest.approx(WAVELENGTH * width)
    assert wave.angle == pytest.approx(ANGLE)
    assert wave.amplitude == pytest.approx(AMPLITUDE * unit)
    # with the smooth film subtracted nothing else is left, but for rounding
    assert wave.film_ratio == pytest.approx(LEFT, rel=1e-9)
    assert wave.film_phase == pytest.approx(0.0, abs=1e-9)
    assert wave.carried_amplitude == pytest.approx(CARRIED * AMPLITUDE * unit)
    assert wave.pressure_amplitude == pytest.approx(PRESSURE * rough.scales.hertz_pressure)


def test_without_the_smooth_film_the_ripples_are_nearly_the_same(rough):
    (wave,) = wave_responses(rough)
    # the pressure of Hertz is no parabola: one per cent of the ripple
    assert wave.film_ratio == pytest.approx(LEFT, rel=0.01)
    assert wave.pressure_amplitude == pytest.approx(
        PRESSURE * rough.scales.hertz_pressure, rel=0.02
    )


def test_points_per_wave_are_those_of_the_axis_that_has_fewer(rough):
    (wave,) = wave_responses(rough)
    # a wave at 45 degrees is sqrt(2) times as long along each axis
    assert wave.points_per_wave == pytest.approx(math.sqrt(2) * WAVELENGTH * 192 / 6)


def test_a_transverse_wave_has_no_streaks():
    (wave,) = wave_responses(make_rough(angle=0.0))
    assert wave.carried_amplitude == 0.0
    assert wave.theory.film_ratio < 0.2


def test_theory_leaves_a_longitudinal_wave_to_the_inlet():
    (wave,) = wave_responses(make_rough(angle=0.5 * math.pi))
    assert wave.theory.film_ratio == 1.0
    assert wave.theory.pressure == 0.0


def test_theory_of_an_incompressible_film_flattens_all(rough):
    density = {"law": "constant", "rho_0": 890.0}
    oil = {**CASE["lubricant"], "density": density}
    case = rough.problem.model_dump(mode="json") | {"lubricant": oil}
    (wave,) = wave_responses(replace(rough, problem=ContactProblem.model_validate(case)))
    assert wave.theory.compressibility == 0.0
    assert wave.theory.film_ratio < 1e-3  # what the finite viscosity lets through
    assert wave.theory.pressure == pytest.approx(wave.theory.elastic_pressure, rel=1e-3)


def test_the_elastic_pressure_is_that_of_a_flattened_wave(rough):
    (wave,) = wave_responses(rough)
    expected = math.pi * rough.problem.reduced_modulus * wave.amplitude / (2 * wave.wavelength)
    assert wave.theory.elastic_pressure == pytest.approx(expected)


def test_the_bulk_modulus_is_that_of_the_law(result):
    p, s, c = 0.8e9, 0.6e-9, 1.7e-9
    slope = s / (1 + c * p) ** 2
    expected = (1 + s * p / (1 + c * p)) / slope
    assert bulk_modulus(result.problem.lubricant.density, p, 313.15) == pytest.approx(
        expected, rel=1e-6
    )


def test_the_strongest_waves_of_any_surface_are_found(rough):
    bumpy = {"type": "random", "rms": 1e-9, "correlation_length": 1e-5}
    surface = rough.problem.surface_2.model_validate({"material": "steel", "roughness": bumpy})
    problem = rough.problem.model_copy(update={"surface_2": surface})
    found = wave_responses(replace(rough, problem=problem))
    assert 1 <= len(found) <= 3
    # the lattice of the patch does not hold the wave itself, but one next to it
    assert found[0].wavelength == pytest.approx(WAVELENGTH * rough.scales.half_width_x, rel=0.15)


def test_waves_too_long_for_the_middle_and_smooth_surfaces_have_no_response(rough, result):
    long = {"type": "wave", "amplitude": 1e-8, "wavelength": 2.0 * rough.scales.half_width_x}
    surface = rough.problem.surface_2.model_validate({"material": "steel", "roughness": long})
    problem = rough.problem.model_copy(update={"surface_2": surface})
    assert wave_responses(replace(rough, problem=problem)) == ()
    assert wave_responses(result) == ()
    flat = np.zeros_like(rough.film_thickness)
    assert (
        wave_responses(replace(rough, heights=SurfaceHeights(surface_1=flat, surface_2=flat))) == ()
    )


def test_a_wave_that_moves_with_the_mean_speed_is_left_to_the_inlet_too(rough):
    rolling = rough.problem.contact.model_copy(update={"slide_roll_ratio": 0.0})
    moving = {"transient": Transient(), "contact": rolling}
    (wave,) = wave_responses(replace(rough, problem=rough.problem.model_copy(update=moving)))
    assert wave.theory.film_ratio == 1.0
    sliding = rough.problem.model_copy(update={"transient": Transient()})
    (wave,) = wave_responses(replace(rough, problem=sliding))
    assert wave.theory.film_ratio < 0.2


def test_both_waves_of_a_sum_are_found():
    smooth = make_rough(angle=0.0)
    other = make_rough(angle=0.5 * math.pi)
    surfaces = {"surface_1": other.problem.surface_2, "surface_2": smooth.problem.surface_2}
    both = replace(
        smooth,
        problem=smooth.problem.model_copy(update=surfaces),
        heights=SurfaceHeights(
            surface_1=other.heights.surface_2, surface_2=smooth.heights.surface_2
        ),
    )
    angles = sorted(wave.angle for wave in wave_responses(both))
    assert angles == pytest.approx([0.0, 0.5 * math.pi])
    assert make_result(65).roughness is None
