"""Predictor of the pressure in a time step: exact for growth and for motion at any speed."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tehl.solver.transient.predictor import Predictor

X = np.linspace(-3.0, 3.0, 129)
SPACING = X[1] - X[0]
STEADY = np.full((5, X.size), 2.0)


def bump(centre: float) -> np.ndarray:
    across = (np.arange(5) - 1.0)[:, None]
    return 0.5 * np.exp(-(((X - centre) / 0.4) ** 2)) * np.exp(-((across / 3.0) ** 2))


def error(at, stride: int = 1, steps: int = 5) -> float:
    """Return the error of the prediction of step ``steps`` if ``at(n)`` is added at step n."""
    predictor = Predictor(STEADY, stride)
    for step in range(1, steps):
        predictor.note(STEADY + at(step))
    return float(np.abs(predictor.onward() - STEADY - at(steps)).max())


def straight(at) -> float:
    """Return the error of linear extrapolation in time."""
    return float(np.abs(2 * at(4) - at(3) - at(5)).max())


def test_a_constant_pressure_is_predicted_exactly():
    assert error(lambda n: 0.0 * n) == 0.0


def moving(speed: float):
    """Return a bump that moves by ``speed`` nodes per step."""
    return lambda step: bump(-1.0 + step * speed * SPACING)


@pytest.mark.parametrize("shape", [moving(0.0), moving(1.0)])
@pytest.mark.parametrize("rate", [0.8, 1.25])
def test_exponential_growth_and_decay_are_predicted_exactly(shape, rate):
    assert error(lambda n: rate**n * shape(n)) < 1e-10


@pytest.mark.parametrize("shape", [moving(0.0), moving(1.0)])
def test_quadratic_growth_is_predicted_better_than_by_linear_extrapolation(shape):
    def at(n):
        return (1.0 + 0.3 * n + 0.1 * n**2) * shape(n)

    assert error(at) < 0.5 * straight(at)


@given(speed=st.floats(0.0, 2.0), stride=st.sampled_from([1, 2]))
def test_a_feature_of_any_speed_is_predicted_better_than_by_linear_extrapolation(speed, stride):
    def at(n):
        return bump(-1.0 + n * speed * stride * SPACING)

    assert error(at, stride) <= max(0.02 * straight(at), 2e-6)


def test_two_features_of_different_speeds_are_predicted_together():
    def at(n):
        return bump(-1.0 + 1.25 * n * SPACING) - 0.5 * bump(1.0 + n * SPACING)

    assert error(at) < 0.02 * straight(at)


@pytest.mark.parametrize("steps", [2, 3])
def test_the_first_steps_are_predicted_by_linear_extrapolation(steps):
    assert error(lambda n: 0.1 * n * bump(0.0), steps=steps) < 1e-12


def test_cavities_stay_and_no_pressure_is_negative():
    predictor, steady = Predictor(STEADY, 1), STEADY.copy()
    for step in range(1, 6):
        pressure = np.maximum(steady - 0.38 * step * bump(0.0) / 0.5, 0.0)
        pressure[:, 100:] = 0.0
        predictor.note(pressure)
    onward = predictor.onward()
    assert onward.min() == 0.0
    assert not onward[:, 100:].any()
    assert np.all(onward[pressure == 0.0] == 0.0)


def test_a_grid_with_fewer_nodes_than_the_furthest_shift_is_predicted_too():
    predictor = Predictor(STEADY[:, :5], 8)
    for step in range(1, 6):
        predictor.note(STEADY[:, :5] + 0.1 * step)
    assert predictor.onward() == pytest.approx(STEADY[:, :5] + 0.6)


@pytest.mark.parametrize("kind", ["random", "smooth"])
def test_a_sudden_change_after_quiet_steps_is_predicted_by_linear_extrapolation(kind):
    random = np.random.default_rng(5)

    def residue(n):
        return random.standard_normal(STEADY.shape) if kind == "random" else 0.3**n * bump(1.0)

    predictor, load = Predictor(STEADY, 1), bump(0.0)
    for step in range(1, 6):
        predictor.note(STEADY + 1e-8 * residue(step))
    for step in range(1, 5):
        predictor.note(STEADY + 0.01 * step * load)
        assert predictor.onward() == pytest.approx(STEADY + 0.01 * (step + 1) * load, abs=0.016)
