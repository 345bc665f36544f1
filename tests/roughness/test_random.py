"""Random surfaces."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy import fft

from tehl.base.errors import InputError
from tehl.roughness import Random, Sum, Wave

LENGTH = 2e-5
GAUSSIAN = Random(rms=1e-7, correlation_length=LENGTH, seed=1)
ROLLED = Random(rms=1e-7, spectrum="self-affine", roll_off=1e-4, hurst=0.7, seed=1)


def one_period(surface, points=512, period=None):
    """Return heights on a lattice of ``points`` per period, unlike the surface's own."""
    x, y = (np.arange(points) * period / points for period in period or surface.period)
    return surface.height(x[None, :], y[:, None])


def correlation(heights):
    found = fft.irfft2(np.abs(fft.rfft2(heights)) ** 2, heights.shape)
    return found / found[0, 0]


@pytest.mark.parametrize("surface", [GAUSSIAN, ROLLED])
def test_the_rms_is_the_stated_one(surface):
    heights = one_period(surface, 1024)
    assert heights.mean() == pytest.approx(0, abs=1e-3 * surface.rms)
    assert heights.std() == pytest.approx(surface.rms, rel=1e-3)


@pytest.mark.parametrize(("along", "across"), [(LENGTH, LENGTH), (4e-5, 1e-5)])
def test_the_correlation_lengths_are_the_stated_ones(along, across):
    surface = Random(
        rms=1e-7, correlation_length=along, correlation_length_y=across, skewness=0, seed=5
    )
    found = correlation(one_period(surface))
    # lattice: half a correlation length, so the 1/e point is the second; 65000 / 4 independent
    # cells leave about one percent of sampling error
    assert found[0, 2] == pytest.approx(math.exp(-1), abs=0.02)
    assert found[2, 0] == pytest.approx(math.exp(-1), abs=0.02)


def test_a_self_affine_spectrum_falls_with_its_exponent():
    power = np.abs(fft.rfft2(one_period(ROLLED, 1024))) ** 2
    waves = np.hypot(fft.rfftfreq(1024), fft.fftfreq(1024)[:, None]) * 1024
    number = waves * 1e-4 / ROLLED.period[0]

    def density(low, high):
        return power[(number > low) & (number < high)].mean()

    # a hundred waves in the smallest ring: ten percent
    assert density(0.5, 0.7) / density(0.7, 0.95) == pytest.approx(1, rel=0.3)
    assert density(2.0, 2.2) / density(8.0, 8.8) == pytest.approx(4**3.4, rel=0.1)
    assert density(17.0, 20.0) < 1e-4 * density(15.0, 15.9)


def test_turning_swaps_the_axes():
    lay = Random(rms=1e-7, correlation_length=4e-5, correlation_length_y=1e-5)
    turned = lay.model_copy(update={"angle": math.pi / 2})
    x = np.linspace(-1e-4, 1e-4, 7)[None, :]
    y = np.linspace(-1e-4, 1e-4, 5)[:, None]
    np.testing.assert_allclose(turned.height(x, y), lay.height(-y, x), atol=1e-15)
    assert turned.shortest_wavelengths == pytest.approx(lay.shortest_wavelengths[::-1])


def test_the_seed_decides_the_surface():
    x, y = np.linspace(-1e-4, 1e-4, 9)[None, :], np.zeros((1, 1))
    again = Random(**GAUSSIAN.model_dump())
    np.testing.assert_array_equal(again.height(x, y), GAUSSIAN.height(x, y))
    other = GAUSSIAN.model_copy(update={"seed": 2})
    assert np.abs(other.height(x, y) - GAUSSIAN.height(x, y)).max() > 1e-8


@settings(max_examples=20, deadline=None)
@given(st.floats(-7, 7), st.floats(0, 1e-3), st.floats(-2, 2))
def test_the_surface_is_the_same_on_every_grid_and_travels(angle, time, speed):
    surface = GAUSSIAN.model_copy(update={"angle": angle})
    x, y = np.linspace(-3e-4, 3e-4, 33)[None, :], np.linspace(-2e-4, 3e-4, 17)[:, None]
    fine = surface.height(x, y, time, speed)
    np.testing.assert_array_equal(surface.height(x[:, ::4], y[::2], time, speed), fine[::2, ::4])
    np.testing.assert_array_equal(surface.height(x - speed * time, y), fine)
    scattered = surface.height(*(part.ravel() for part in np.broadcast_arrays(x, y)), time, speed)
    np.testing.assert_allclose(scattered.reshape(fine.shape), fine, atol=1e-20)


@pytest.mark.parametrize(("skewness", "kurtosis"), [(-1.5, 6.0), (0.5, 3.0), (0.0, 2.3), (0, 9)])
def test_skewness_and_kurtosis_are_the_stated_ones(skewness, kurtosis):
    surface = GAUSSIAN.model_copy(update={"skewness": skewness, "kurtosis": kurtosis})
    scaled = one_period(surface, 512) / surface.rms
    assert (scaled**2).mean() == pytest.approx(1, rel=2e-3)
    assert (scaled**3).mean() == pytest.approx(skewness, abs=5e-3)
    assert (scaled**4).mean() == pytest.approx(kurtosis, rel=5e-3)
    # the autocorrelation stays Gaussian within a few percent of a correlation length
    assert correlation(one_period(surface))[0, 2] == pytest.approx(math.exp(-1), abs=0.06)


@pytest.mark.parametrize(
    "surface",
    [
        GAUSSIAN,
        ROLLED,
        GAUSSIAN.model_copy(update={"correlation_length_y": 1e-5, "angle": 0.5}),
        ROLLED.model_copy(update={"roll_off_y": 5e-5, "hurst": 1.0, "angle": 1.0}),
    ],
)
def test_wavelengths_are_those_of_the_slopes(surface):
    x = np.linspace(-3e-4, 3e-4, 1201)  # half a micrometre
    heights = surface.height(x[None, :], x[:, None])
    scale = 2 * math.pi * heights.std()
    found = [scale / (np.diff(heights, axis=axis) / 5e-7).std() for axis in (1, 0)]
    # a patch of a few dozen cells
    assert found == pytest.approx(surface.shortest_wavelengths, rel=0.12)
    assert surface.shortest_wavelength <= min(surface.shortest_wavelengths)


@pytest.mark.parametrize(
    "spectrum",
    [
        {"correlation_length": 30e-6},
        {"correlation_length": 60e-6, "correlation_length_y": 17e-6},
        {"spectrum": "self-affine", "roll_off": 40e-6},
    ],
)
def test_a_surface_repeats_after_the_stated_distance(spectrum):
    surface = Random(rms=1e-7, seed=3, repeat_y=0.2e-3, **spectrum)
    assert surface.period[1] == pytest.approx(0.2e-3, rel=1e-12)
    x, y = np.linspace(-1e-3, 1e-3, 200)[None], np.linspace(0.0, 0.2e-3, 641)[:, None]
    for shown in (surface, surface.resolved_on(4e-6, 3e-6), surface.resolved_on(15e-6, 10e-6)):
        here = shown.height(x, y)
        for way in (-0.2e-3, 0.4e-3):
            np.testing.assert_allclose(shown.height(x, y + way), here, atol=1e-14)
    along, across = surface.shortest_wavelengths
    free = Random(rms=1e-7, seed=3, **spectrum)
    assert (along, across) == free.shortest_wavelengths
    # a narrow strip has few waves along y
    slopes = np.gradient(surface.height(x, y), y[1, 0], axis=0)
    assert 2.0 * np.pi * 1e-7 / slopes.std() == pytest.approx(across, rel=0.15)


def test_a_mesh_gets_the_waves_that_it_can_carry():
    fine, coarse = ROLLED.resolved_on(5e-7, 5e-7), ROLLED.resolved_on(1e-5, 1e-5)
    x = np.linspace(-3e-4, 3e-4, 61)
    np.testing.assert_array_equal(
        fine.height(x[None, :], x[:, None]), ROLLED.height(x[None, :], x[:, None])
    )
    assert coarse.rms < 0.97 * ROLLED.rms
    assert coarse.shortest_wavelength > 4e-5
    once_more = coarse.resolved_on(1e-5, 1e-5)
    assert once_more.rms == pytest.approx(coarse.rms, rel=0.02)  # the cosine between acts twice


def test_resolved_on_a_mesh_a_surface_has_no_aliases():
    power = np.abs(fft.rfft2(one_period(ROLLED, 1024))) ** 2
    mesh = ROLLED.period[0] / 64
    coarse = ROLLED.resolved_on(mesh, mesh)
    heights = one_period(coarse, 64, ROLLED.period)
    whole = np.abs(fft.rfft2(heights)) ** 2 * 16**4
    # waves of four mesh widths and more come through as they are
    np.testing.assert_allclose(whole[1:16, 1:16], power[1:16, 1:16], rtol=1e-3)


def test_a_sum_is_resolved_part_by_part():
    wave = Wave(amplitude=1e-7, wavelength=1e-4)
    total = Sum(parts=(wave, ROLLED)).resolved_on(1e-5, 1e-5)
    x = np.linspace(-1e-4, 1e-4, 11)[None, :]
    expected = wave.height(x, x.T) + ROLLED.resolved_on(1e-5, 1e-5).height(x, x.T)
    np.testing.assert_allclose(total.height(x, x.T), expected, atol=1e-20)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({}, "correlation_length is missing"),
        ({"spectrum": "self-affine"}, "roll_off is missing"),
        ({"correlation_length": 1e-5, "roll_off": 1e-4}, "roll_off does not apply"),
        ({"correlation_length": 1e-5, "cut_off": 1e-6}, "cut_off does not apply"),
        ({"spectrum": "self-affine", "roll_off": 1e-4, "cut_off": 1e-6}, "between roll_off/64"),
        ({"spectrum": "self-affine", "roll_off": 1e-4, "cut_off": 1e-3}, "between roll_off/64"),
        ({"spectrum": "self-affine", "roll_off": 1e-4, "hurst": 1.2}, "not be larger than 1"),
        ({"correlation_length": 1e-5, "kurtosis": 1.5}, "must lie between 2.1 and 20"),
        ({"correlation_length": 1e-5, "skewness": 3}, "must lie between 15.6"),
        ({"correlation_length": 1e-5, "skewness": 1e200}, r"skewness = 1e\+200 .* -3.45 and 3.45"),
        ({"correlation_length": 1e200}, r"correlation_length = 1e\+200 m must lie between"),
        ({"correlation_length": 1e-5, "correlation_length_y": 1e-200}, "1e-12 m and 1e[+]06 m"),
        ({"spectrum": "self-affine", "roll_off": 1e200}, r"roll_off = 1e\+200 m must lie between"),
        ({"correlation_length": 1e-7}, "not small beside correlation_length"),
        ({"correlation_length": 1e-5, "seed": -1}, "whole number from 0"),
        ({"correlation_length": 1e-5, "seed": 1.5}, "whole number from 0"),
        ({"correlation_length": 1e-5, "repeat_y": 3e-5}, "at least 4 correlation"),
        ({"correlation_length": 1e-5, "repeat_y": 3e-3}, "at most 0.00256 m"),
        ({"correlation_length": 1e-5, "repeat_y": 1e-4, "angle": 0.1}, "repeats obliquely"),
    ],
)
def test_wrong_spectra_are_reported(keys, words):
    with pytest.raises(InputError, match=words):
        Random(rms=1e-7, **keys)


def test_ra_is_that_of_gaussian_heights():
    found = Random.model_validate({"type": "random", "ra": "50 nm", "correlation_length": "20 um"})
    assert found.rms == pytest.approx(62.67e-9, rel=1e-4)
    x = np.arange(1500) * 5e-6
    assert np.abs(found.height(x[None, :], x[:, None])).mean() == pytest.approx(50e-9, rel=0.02)
    assert Random.model_validate_json(found.model_dump_json()) == found
    for keys, words in (
        ({"rms": "60 nm"}, "states ra and rms"),
        ({"kurtosis": 4}, "Gaussian heights"),
        ({"ra": "1 N"}, "unit of a force"),
    ):
        with pytest.raises(ValidationError, match=words):
            Random.model_validate({"ra": "50 nm", "correlation_length": "20 um"} | keys)
