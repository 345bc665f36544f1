"""Search for waves in heights: all are found, without false ones."""

import math

import numpy as np
import pytest

from tehl.post.waves.search import distinct_waves
from tehl.roughness import Random, WaveVector

X, Y = np.linspace(-4.5, 1.5, 129), np.linspace(-3.0, 3.0, 129)


def is_short(wave: WaveVector) -> bool:
    return abs(wave.along) + abs(wave.across) > 1.5 * 2.0 * math.pi / 0.8


def wave(length: float, degrees: float, amplitude: float = 1.0) -> np.ndarray:
    angle, number = math.radians(degrees), 2.0 * math.pi / length
    x, y = np.meshgrid(X, Y)
    return amplitude * np.cos(number * (x * math.cos(angle) - y * math.sin(angle)) + 0.7)


def vectors(heights: np.ndarray) -> list[tuple[float, float]]:
    """Return wavelength and angle of the waves that stand out."""
    return [
        (
            2.0 * math.pi / found.number,
            (math.degrees(math.atan2(-found.across, found.along)) + 90.0) % 180.0 - 90.0,
        )
        for found in distinct_waves(X, Y, heights, is_short)
    ]


@pytest.mark.parametrize("length", [0.25, 0.36, 0.45])
@pytest.mark.parametrize("degrees", [0.0, 7.0, 30.0, -45.0, 80.0])
def test_a_wave_is_found_between_the_bins_under_noise_and_form(length, degrees):
    noise = np.random.default_rng(3).standard_normal((Y.size, X.size))
    form = 0.5 * X**2 - 0.3 * X * Y[:, None]
    ((found, angle),) = vectors(wave(length, degrees) + 0.1 * noise + form)
    assert found == pytest.approx(length, rel=0.01)
    assert angle == pytest.approx(degrees, abs=0.5)


def test_a_pure_wave_is_found_alone():
    assert vectors(1e-7 * wave(0.45, 30.0)) == [pytest.approx((0.45, 30.0), rel=1e-4)]


def test_a_wave_of_a_line_is_found_on_its_row():
    noise = 0.1 * np.random.default_rng(3).standard_normal((1, X.size))
    row = np.cos(2.0 * math.pi / 0.36 * X + 0.7)[None] + 0.5 * X**2 + noise
    (found,) = distinct_waves(X, np.zeros(1), row, is_short)
    assert 2.0 * math.pi / found.number == pytest.approx(0.36, rel=0.01)
    assert found.across == 0.0


def test_a_single_node_has_no_waves():
    coarse = np.array([-4.0, 0.0, 4.0])
    assert distinct_waves(coarse, coarse, np.eye(3), is_short) == []


def test_both_waves_of_a_cross_hatch_are_found():
    found = sorted(vectors(wave(0.3, 30.0) + 0.8 * wave(0.3, -30.0)))
    assert sorted(angle for _, angle in found) == pytest.approx([-30.0, 30.0], abs=0.01)


def test_a_wave_on_a_waviness_is_found_and_so_is_the_waviness():
    found = vectors(wave(0.25, 0.0, 0.2) + wave(0.9, 60.0))
    assert sorted(found) == [
        pytest.approx((0.25, 0.0), rel=1e-3),
        pytest.approx((0.9, 60.0), rel=1e-2),
    ]


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(
    "kind", [{"correlation_length": 0.1}, {"roll_off": 0.5, "spectrum": "self-affine"}]
)
def test_random_surfaces_have_none(seed, kind):
    surface = Random(rms=1e-3, seed=seed, **kind)
    resolved = surface.resolved_on(X[1] - X[0], Y[1] - Y[0])
    assert vectors(resolved.height(X[None, :], Y[:, None])) == []


def test_flat_heights_have_none():
    assert vectors(np.zeros((Y.size, X.size))) == []


@pytest.mark.parametrize("nodes", [4.2, 5.0])
def test_a_short_wave_on_a_very_fine_grid_is_not_aliased(nodes):
    axis = np.linspace(-4.5, 1.5, 2049)
    x, y = axis, np.linspace(-3.0, 3.0, 2049)
    length = nodes * (axis[1] - axis[0])
    heights = np.cos(2.0 * np.pi / length * x) * np.ones((y.size, 1))
    (found,) = distinct_waves(x, y, heights, is_short)
    assert 2.0 * np.pi / found.number == pytest.approx(length, rel=0.01)
    assert found.amplitude == pytest.approx(math.sqrt(2.0), rel=0.02)
