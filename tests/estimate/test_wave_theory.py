"""Theory of waves: published curves and limits of linear theory."""

import math

import pytest

from tehl.estimate.wave_theory import FlatFilm, amplitude_reduction, bulk_modulus, nabla_of
from tehl.roughness import Wave

FILM = FlatFilm(film=2e-7, bulk_modulus=1e10, viscosity=1e3, reduced_modulus=2.2e11)
WAVE = Wave(amplitude=1e-8, wavelength=5e-5)


def test_the_amplitude_reduction_is_the_published_curve():
    for nabla, ratio in ((0.5, 0.92700), (2.0, 0.73529), (10.0, 0.25)):
        assert amplitude_reduction(nabla) == pytest.approx(ratio, abs=1e-5)
    assert amplitude_reduction(10.0, ratio=2.0) == pytest.approx(
        amplitude_reduction(10.0 * math.exp(0.5))
    )


def test_nabla_is_the_wavelength_over_that_of_the_inlet():
    assert nabla_of(0.5, 200.0, 12.5) == pytest.approx(2.0)


def test_the_bulk_modulus_is_that_of_the_law(result):
    p, s, c = 0.8e9, 0.6e-9, 1.7e-9
    slope = s / (1 + c * p) ** 2
    expected = (1 + s * p / (1 + c * p)) / slope
    assert bulk_modulus(result.problem.lubricant.density, p, 313.15) == pytest.approx(
        expected, rel=1e-6
    )


def test_a_standing_wave_keeps_what_the_oil_is_compressed():
    (wave,) = WAVE.components
    theory = FILM.theory(wave, wave.amplitude, drift=(-1.0, 0.0))
    c = theory.compressibility
    assert c == pytest.approx(2e-7 * 2.2e11 * 2 * math.pi / 5e-5 / 4 / 1e10)
    assert theory.film_ratio == pytest.approx(c / (1 + c), rel=1e-3)  # Q is large, not infinite
    assert theory.pressure == pytest.approx(theory.elastic_pressure / (1 + c), rel=1e-3)


def test_a_wave_that_moves_with_the_mean_speed_is_left_to_the_inlet():
    (wave,) = WAVE.components
    theory = FILM.theory(wave, wave.amplitude, drift=(0.0, 0.0))
    assert theory.left_to_inlet
    assert theory.film_ratio == 1.0
    assert FILM.theory(wave, wave.amplitude, drift=(0.0, 0.0), holds=False).left_to_inlet


def test_where_the_theory_does_not_hold_only_the_elastic_pressure_is_known():
    (wave,) = WAVE.components
    theory = FILM.theory(wave, wave.amplitude, drift=(-1.0, 0.0), holds=False)
    assert theory.film_ratio is theory.pressure is None
    assert theory.elastic_pressure == pytest.approx(math.pi * 2.2e11 * 1e-8 / (2 * 5e-5))
