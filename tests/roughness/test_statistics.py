"""Numbers that describe a surface."""

import math

import numpy as np
import pytest

from tehl.roughness import Random
from tehl.roughness.statistics import share_beyond, spectrum, statistics

PIXEL = (1e-6, 2e-6)


def sine(nx=400, ny=300, waves=10):
    x = (np.arange(nx) + 0.5) * PIXEL[0]
    return np.tile(1e-7 * np.cos(2 * np.pi * waves * x / (nx * PIXEL[0])), (ny, 1))


def test_a_sine_has_the_parameters_of_a_sine():
    found = statistics(sine() + 3.0, PIXEL)
    assert found.sq == pytest.approx(1e-7 / math.sqrt(2), rel=1e-6)
    assert found.sa == pytest.approx(2e-7 / math.pi, rel=1e-2)
    assert found.sz == pytest.approx(2e-7, rel=1e-2)
    assert found.ssk == pytest.approx(0, abs=1e-6)
    assert found.sku == pytest.approx(1.5, rel=1e-6)
    assert found.sdq == pytest.approx(2 * np.pi / 4e-5 * found.sq, rel=5e-3)
    # cos(2 pi u / 40 um) = 1/e; between points of 1 um the correlation is taken as straight
    assert found.correlation_lengths[0] == pytest.approx(
        4e-5 * math.acos(1 / math.e) / (2 * np.pi), rel=2e-2
    )
    assert found.correlation_lengths[1] == math.inf


def test_points_that_were_not_measured_do_not_count():
    heights, measured = sine(), np.ones((300, 400), bool)
    measured[100:140, 200:280] = False
    filled = np.where(measured, heights, 1e-6)
    found, whole = statistics(filled, PIXEL, measured), statistics(heights, PIXEL)
    assert (found.sq, found.sa, found.sz, found.sku) == pytest.approx(
        (whole.sq, whole.sa, whole.sz, whole.sku), rel=1e-9
    )


def test_the_correlation_lengths_of_a_random_surface_are_found():
    surface = Random(rms=1e-7, correlation_length=2e-5, correlation_length_y=4e-5, seed=3)
    x = np.arange(800) * 2e-6
    found = statistics(surface.height(x[None, :], x[:, None]), (2e-6, 2e-6))
    # 80 x 40 cells: a few percent
    assert found.correlation_lengths == pytest.approx((2e-5, 4e-5), rel=0.1)
    assert found.sku == pytest.approx(3, abs=0.3)


def test_the_spectrum_integrates_to_the_variance_and_has_the_stated_shape():
    surface = Random(rms=1e-7, spectrum="self-affine", roll_off=1e-4, hurst=0.7, seed=2)
    x = np.arange(512) * 1.5e-6
    heights = surface.height(x[None, :], x[:, None])
    found = spectrum(heights, (1.5e-6, 1.5e-6))
    q = found.wave_number
    variance = np.trapezoid(found.density * q, q) / (2 * np.pi)
    assert variance == pytest.approx(heights.var(), rel=0.15)  # rings of a few waves at long ones
    band = (q > 2 * np.pi / 8e-5) & (q < 2 * np.pi / 8e-6)
    slope = np.polyfit(np.log(q[band]), np.log(found.density[band]), 1)[0]
    assert slope == pytest.approx(-2 * (1 + 0.7), abs=0.15)


def test_the_lost_share_is_that_of_short_waves():
    heights = sine(waves=10) + 2 * sine(waves=100)  # 40 um and 4 um
    assert share_beyond(heights, PIXEL, (1e-6, 1e-6)) == pytest.approx(0, abs=1e-12)
    assert share_beyond(heights, PIXEL, (2.1e-6, 1e-6)) == pytest.approx(0.8, rel=1e-6)
    assert share_beyond(heights, PIXEL, (1e-6, 1e-3)) == pytest.approx(0, abs=1e-12)
    assert share_beyond(heights, PIXEL, (1e-4, 1e-4)) == pytest.approx(1, rel=1e-6)
    assert share_beyond(0 * heights, PIXEL, (1e-6, 1e-6)) == 0
