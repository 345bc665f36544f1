"""Viscosity laws."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from tehl.lubricant import Barus, ConstantViscosity, Roelands
from tehl.lubricant.viscosity import LARGEST_EXPONENT

ROELANDS = Roelands(eta_0=0.04, alpha=2.2e-8, gamma=0.042)
BARUS = Barus(eta_0=0.04, alpha=2.2e-8, gamma=0.042)
AMBIENT = 313.15


def test_roelands_is_its_formula():
    pressure, temperature = np.array([0.0, 3e8, 1e9]), np.array([313.15, 350.0, 400.0])
    span = math.log(0.04) + 9.67
    z, s0 = 2.2e-8 * 1.96e8 / span, 0.042 * (AMBIENT - 138.0) / span
    theta = (temperature - 138.0) / (AMBIENT - 138.0)
    expected = 0.04 * np.exp(span * ((1.0 + 5.1e-9 * pressure) ** z * theta**-s0 - 1.0))
    assert ROELANDS.viscosity(pressure, temperature) == pytest.approx(expected, rel=1e-13)


def test_z_and_alpha_state_the_same_law():
    by_z = Roelands(eta_0=0.04, z=ROELANDS.pressure_index, S0=ROELANDS.temperature_index)
    assert by_z.pressure_coefficient == pytest.approx(2.2e-8)
    assert by_z.temperature_coefficient == pytest.approx(0.042)
    pressure = np.linspace(0.0, 2e9, 7)
    assert by_z.viscosity(pressure, 340.0) == pytest.approx(ROELANDS.viscosity(pressure, 340.0))


@pytest.mark.parametrize("law", [ROELANDS, BARUS])
def test_the_slopes_at_ambient_are_alpha_and_gamma(law: Roelands | Barus):
    tiny_p, tiny_t = 1e3, 1e-3
    ambient = law.viscosity(np.zeros(1), AMBIENT)[0]
    by_pressure = math.log(law.viscosity(np.array([tiny_p]), AMBIENT)[0] / ambient) / tiny_p
    by_heat = -math.log(law.viscosity(np.zeros(1), AMBIENT + tiny_t)[0] / ambient) / tiny_t
    assert ambient == pytest.approx(0.04)
    assert by_pressure == pytest.approx(2.2e-8, rel=1e-3)  # 5.1e-9 is 1/1.96e8 to 0.04 %
    assert by_heat == pytest.approx(0.042, rel=1e-4)


@pytest.mark.parametrize("law", [ROELANDS, BARUS, ConstantViscosity(eta_0=0.04)])
@given(pressure=st.floats(min_value=0.0, max_value=1e15))
def test_no_pressure_overflows(law: Roelands | Barus | ConstantViscosity, pressure: float):
    value = law.viscosity(np.full((2, 3), pressure), np.full((2, 3), AMBIENT))
    assert value.shape == (2, 3)
    assert np.isfinite(value).all()
    assert value.max() <= 0.04 * math.exp(LARGEST_EXPONENT) * (1 + 1e-9)
    assert value.min() >= 0.04 * (1 - 1e-9)


@pytest.mark.parametrize("law", [ROELANDS, BARUS, ConstantViscosity(eta_0=0.04)])
def test_the_arguments_are_left_as_they_are(law: Roelands | Barus | ConstantViscosity):
    pressure, temperature = np.array([0.0, 1e9]), np.array([AMBIENT, 330.0])
    law.viscosity(pressure, temperature)
    assert pressure.tolist() == [0.0, 1e9]
    assert temperature.tolist() == [AMBIENT, 330.0]


def test_a_law_without_temperature_ignores_it():
    law = Roelands(eta_0=0.04, alpha=2.2e-8)
    assert law.temperature_index == 0.0
    pressure = np.linspace(0.0, 1e9, 4)
    assert law.viscosity(pressure, 500.0) == pytest.approx(law.viscosity(pressure, AMBIENT))


@pytest.mark.parametrize(
    "parts",
    [
        {"eta_0": 0.04},
        {"eta_0": 0.04, "alpha": 2e-8, "z": 0.6},
        {"eta_0": 0.04, "alpha": 2e-8, "gamma": 0.04, "S0": 1.0},
        {"eta_0": 6e-5, "alpha": 2e-8},
        {"eta_0": 0.04, "alpha": 2e-8, "reference_temperature": 130.0},
        {"eta_0": float("nan"), "alpha": 2e-8},
    ],
)
def test_an_incomplete_or_impossible_roelands_law_is_refused(parts: dict[str, float]):
    with pytest.raises(ValidationError):
        Roelands.model_validate(parts)
