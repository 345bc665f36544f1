"""Waves of the surfaces in film and pressure: known ripples are found again."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.contact.heat import Thermal
from tehl.contact.transient import Transient
from tehl.post.waves import wave_notes, wave_responses
from tehl.result.fields import SurfaceHeights
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


def test_ripples_of_an_oblique_wave_are_separated_from_its_streaks(rough, smooth):
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
    # the Hertz pressure is not a parabola: one per cent of the ripple
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


RANDOM = {"type": "random", "rms": 1e-9, "correlation_length": 1e-5}


def with_surface(rough: Result, roughness: dict[str, Any]) -> Result:
    """Return a result whose case states another surface than the one its heights are of."""
    surface = rough.problem.surface_2.model_validate({"material": "steel", "roughness": roughness})
    return replace(rough, problem=rough.problem.model_copy(update={"surface_2": surface}))


def with_lubricant(rough: Result, **changes: Any) -> Result:
    """Return a result whose case has another oil."""
    oil = {**rough.problem.lubricant.model_dump(mode="json"), **changes}
    case = rough.problem.model_dump(mode="json") | {"lubricant": oil}
    return replace(rough, problem=ContactProblem.model_validate(case))


@pytest.mark.parametrize("degrees", [0.0, 30.0, 45.0, -70.0])
def test_an_unstated_wave_is_found(smooth, degrees):
    rough = make_rough(angle=math.radians(degrees))
    (stated,) = wave_responses(rough, smooth)
    (found,) = wave_responses(with_surface(rough, RANDOM), smooth)
    assert found.wavelength == pytest.approx(stated.wavelength, rel=1e-3)
    assert math.degrees(found.angle) == pytest.approx(degrees, abs=0.05)
    assert found.film_ratio == pytest.approx(stated.film_ratio, rel=0.01)
    assert found.theory.film_ratio == pytest.approx(stated.theory.film_ratio, rel=0.01)


def test_broad_band_heights_have_a_note_instead_of_waves(rough):
    noise = np.random.default_rng(1).standard_normal(rough.film_thickness.shape)
    heights = SurfaceHeights(surface_1=0.0 * noise, surface_2=1e-8 * noise)
    random = with_surface(replace(rough, heights=heights), RANDOM)
    assert wave_responses(random) == ()
    (note,) = wave_notes(random)
    assert "no wave stands out" in note
    dent = {"type": "bump", "amplitude": -1e-7, "radius": 2e-5}
    assert wave_notes(with_surface(rough, dent)) == ()


@pytest.mark.parametrize("angle", [89.0, 91.0])
def test_a_wave_that_hardly_turns_in_the_middle_is_left_to_the_inlet(smooth, angle):
    (wave,) = wave_responses(make_rough(angle=math.radians(angle)), smooth)
    assert wave.theory.left_to_inlet
    assert wave.carried_amplitude == 0.0


def test_streaks_too_wide_for_the_middle_are_part_of_the_background(smooth):
    (wave,) = wave_responses(make_rough(angle=math.radians(2.0)), smooth)
    assert wave.carried_amplitude == 0.0
    assert wave.film_ratio == pytest.approx(LEFT, rel=0.01)


def test_theory_is_omitted_with_a_note_for_shear_thinning_or_heated_oil(rough, smooth):
    eyring = with_lubricant(rough, shear={"law": "eyring", "stress": 5e6})
    (wave,) = wave_responses(eyring, smooth)
    assert wave.theory.film_ratio is wave.theory.pressure is None
    assert wave.theory.elastic_pressure > 0
    assert wave.film_ratio == pytest.approx(LEFT)
    assert wave_notes(eyring)[0].endswith("shear-thinning (eyring)")
    heated = replace(rough, problem=rough.problem.model_copy(update={"thermal": Thermal()}))
    assert wave_responses(heated, smooth)[0].theory.film_ratio is None
    assert wave_notes(heated)[0].endswith("heated")
    assert wave_notes(rough) == ()


def test_waves_left_to_the_inlet_need_no_theory():
    along = with_lubricant(make_rough(angle=0.5 * math.pi), shear={"law": "eyring", "stress": 5e6})
    assert wave_responses(along)[0].theory.left_to_inlet
    assert wave_notes(along) == ()


def test_a_wave_that_is_too_long_is_named(rough):
    long = {"type": "wave", "amplitude": 1e-8, "wavelength": 0.54 * rough.scales.half_width_x}
    result = with_surface(rough, long)
    assert wave_responses(result) == ()
    (note,) = wave_notes(result)
    assert "1.48 waves where |X|, |Y| < 0.4, and it takes 1.5" in note
    assert result.roughness.wave_notes == (note,)


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
