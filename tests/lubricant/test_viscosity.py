"""Viscosity laws."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from tehl.base.errors import InputError
from tehl.lubricant import (
    Barus,
    ConstantViscosity,
    Roelands,
    RoelandsExponential,
    TaitDoolittle,
    ViscosityLaw,
    ViscosityModel,
    Walther,
)
from tehl.lubricant.law import LARGEST_LAW_EXPONENT

ROELANDS = Roelands(eta_0=0.04, alpha=2.2e-8, gamma=0.042)
BARUS = Barus(eta_0=0.04, alpha=2.2e-8, gamma=0.042)
EXPONENTIAL = RoelandsExponential(eta_0=0.04, alpha=2.2e-8, gamma=0.042)
WALTHER = Walther(nu_40=68e-6, nu_100=8.7e-6, alpha=2.3e-8, density=870.0)
# Squalane at 298 K after Liu and others, Front. Manuf. Technol. 2 (2023) 1029860; fall of the
# bulk modulus after Bair, Tribology Letters 22 (2006) 197; expansion of the occupied part assumed.
DOOLITTLE = TaitDoolittle(
    eta_0=0.0276,
    B=5.258,
    occupied=0.6633,
    occupied_expansion=-4.5e-4,
    bulk_modulus=1.312e9,
    bulk_modulus_slope=11.74,
    expansion=8e-4,
    softening=6.3e-3,
    reference_temperature=298.15,
)
LAWS: list[ViscosityLaw] = [
    ROELANDS,
    EXPONENTIAL,
    BARUS,
    WALTHER,
    DOOLITTLE,
    ConstantViscosity(eta_0=0.04),
]
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


@pytest.mark.parametrize("law", LAWS)
@given(pressure=st.floats(min_value=0.0, max_value=1e15))
def test_no_pressure_overflows(law: ViscosityLaw, pressure: float):
    value = law.viscosity(np.full((2, 3), pressure), np.full((2, 3), law.reference_temperature))
    assert value.shape == (2, 3)
    assert np.isfinite(value).all()
    assert value.max() <= law.eta_0 * math.exp(LARGEST_LAW_EXPONENT) * (1 + 1e-9)
    assert value.min() >= law.eta_0 * (1 - 1e-9)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("temperature", [300.0, 360.0])
def test_coefficients_without_a_formula_are_differences(law, temperature):
    by_pressure = ViscosityModel.pressure_coefficient_at(law, temperature)
    # Roelands' rounded constants: 5.1e-9 times 1.96e8 is 0.9996
    assert by_pressure == pytest.approx(law.pressure_coefficient_at(temperature), rel=5e-4)
    by_heat = ViscosityModel.temperature_coefficient_at(law, temperature)
    assert by_heat == pytest.approx(law.temperature_coefficient_at(temperature), rel=1e-6)


@pytest.mark.parametrize("law", LAWS)
def test_the_laws_stay_positive_wherever_they_are_tabulated(law: ViscosityLaw):
    pressure = np.concatenate([[0.0], np.logspace(5, np.log10(4e10), 60)])
    temperature = np.linspace(200.0, 1500.0, 131)
    value = law.viscosity(pressure[:, None], temperature[None, :])
    assert value.shape == (61, 131)
    assert np.isfinite(law.viscosity(np.array([-1e6]), temperature)).all()  # where slopes are taken
    assert np.isfinite(value).all()
    assert value.min() > 0
    assert (np.diff(np.log(value), axis=0) >= -1e-9).all()
    below = temperature < 500
    assert (np.diff(np.log(value[:1, below]), axis=1) <= 1e-12).all()


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("temperature", [273.15, 313.15, 298.15, 380.0])
def test_the_ambient_values_are_those_of_the_law_at_zero_pressure(
    law: ViscosityLaw, temperature: float
):
    def log_viscosity(pressure: float, at: float) -> float:
        return math.log(law.viscosity(np.array([pressure]), np.array([at]))[0])

    ambient = log_viscosity(0.0, temperature)
    by_pressure = (log_viscosity(1e4, temperature) - ambient) / 1e4
    by_heat = (log_viscosity(0, temperature - 0.01) - log_viscosity(0, temperature + 0.01)) / 0.02
    assert math.log(law.ambient(temperature)) == pytest.approx(ambient, abs=1e-12)
    assert law.pressure_coefficient_at(temperature) == pytest.approx(by_pressure, rel=1e-3)
    assert law.temperature_coefficient_at(temperature) == pytest.approx(by_heat, rel=1e-5)


@pytest.mark.parametrize("law", LAWS)
@given(pressure=st.floats(0, 4e9), temperature=st.floats(250, 500))
def test_one_value_is_that_of_an_array(law: ViscosityLaw, pressure: float, temperature: float):
    value = law.viscosity(np.array([pressure]), np.array([temperature]))[0]
    assert law.viscosity(pressure, temperature) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("law", LAWS)
def test_values_at_the_reference_are_the_stated_ones(law: ViscosityLaw):
    at = law.reference_temperature
    assert law.ambient(at) == pytest.approx(law.eta_0, rel=1e-12)
    assert law.pressure_coefficient_at(at) == law.pressure_coefficient
    assert law.temperature_coefficient_at(at) == pytest.approx(law.temperature_coefficient)


@pytest.mark.parametrize("law", [ROELANDS, EXPONENTIAL, BARUS])
def test_values_at_the_reference_temperature_are_exact(law: ViscosityLaw):
    assert law.ambient(AMBIENT) == 0.04
    assert law.pressure_coefficient_at(AMBIENT) == 2.2e-8


def test_the_exponential_law_is_its_formula():
    pressure, temperature = np.array([0.0, 3e8, 1e9]), np.array([313.15, 350.0, 400.0])
    span = math.log(0.04) + 9.67
    growth = span * ((1 + 5.1e-9 * pressure) ** (2.2e-8 * 1.96e8 / span) - 1)
    expected = 0.04 * np.exp(growth - 0.042 * (temperature - AMBIENT))
    assert EXPONENTIAL.viscosity(pressure, temperature) == pytest.approx(expected, rel=1e-12)
    by_z = RoelandsExponential(eta_0=0.04, z=EXPONENTIAL.pressure_index, gamma=0.042)
    assert by_z.pressure_coefficient == pytest.approx(2.2e-8)
    assert by_z.viscosity(pressure, temperature) == pytest.approx(expected)


def test_every_law_names_its_fall_with_temperature():
    names = [law.temperature_law for law in LAWS]
    assert names[:4] == ["roelands, S0", "roelands, gamma", "barus, gamma", "walther, ASTM D341"]
    assert names[4:] == ["tait-doolittle, free volume", "constant, no temperature"]
    assert Roelands(eta_0=0.04, alpha=2e-8).temperature_law == "roelands, no temperature"


def test_walther_meets_its_two_points_and_the_line_between_them():
    points = np.log10([313.15, 373.15]), np.log10(np.log10([68.7, 9.4]))
    slope, offset = np.polyfit(*points, 1)
    between = 10**10 ** (offset + slope * np.log10(333.15)) - 0.7
    for temperature, nu in ((313.15, 68.0), (333.15, between), (373.15, 8.7)):
        density = 870.0 / (1 + 6.5e-4 * (temperature - 313.15))
        assert WALTHER.ambient(temperature) == pytest.approx(nu * 1e-6 * density, rel=1e-12)


@pytest.mark.parametrize(
    ("forty", "hundred", "sixty"), [(68, 8.6, 28.65), (30, 5.23, 14.53), (120, 20.9, 59.51)]
)
def test_walther_is_near_the_german_form(forty: float, hundred: float, sixty: float):
    # mm^2/s at 60 degC by DIN 51563, which adds 0.8 instead of 0.7 (the package libvisc)
    law = Walther(nu_40=forty * 1e-6, nu_100=hundred * 1e-6, alpha=2e-8, density=1e3, expansion=0)
    assert law.ambient(333.15) * 1e3 == pytest.approx(sixty, rel=7e-3)


def test_walther_keeps_z_and_lets_alpha_fall_with_temperature():
    hot = WALTHER.model_copy(update={"alpha_temperature": 373.15})
    assert hot.pressure_coefficient_at(373.15) == 2.3e-8
    assert WALTHER.pressure_coefficient_at(373.15) < 2.3e-8 < hot.pressure_coefficient
    by_z = Walther(nu_40=68e-6, nu_100=8.7e-6, z=WALTHER.pressure_index, density=870.0)
    assert by_z.pressure_coefficient == pytest.approx(2.3e-8)


def test_walther_without_a_density_is_an_error():
    with pytest.raises(InputError, match="density"):
        Walther(nu_40=68e-6, nu_100=8.7e-6, alpha=2e-8).ambient(300.0)


def test_doolittle_is_its_formula():
    pressure, warmer = 5e8, 40.0
    modulus = 1.312e9 * math.exp(-6.3e-3 * warmer)
    volume = (1 + 8e-4 * warmer) * (1 - math.log(1 + 12.74 * pressure / modulus) / 12.74)
    occupied = 0.6633 * (1 - 4.5e-4 * warmer)
    exponent = 5.258 * (occupied / (volume - occupied) - 0.6633 / (1 - 0.6633))
    value = DOOLITTLE.viscosity(np.array([pressure]), 298.15 + warmer)[0]
    assert value == pytest.approx(0.0276 * math.exp(exponent), rel=1e-12)
    # B R_0 / (K_0 (1 - R_0)^2) = 23.4 1/GPa; measured on squalane: 18 to 22 1/GPa at 40 degC
    assert DOOLITTLE.pressure_coefficient == pytest.approx(23.45e-9, rel=1e-3)


@pytest.mark.parametrize("law", LAWS)
def test_the_arguments_are_not_changed(law: ViscosityLaw):
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
def test_an_incomplete_or_impossible_roelands_law_is_rejected(parts: dict[str, float]):
    with pytest.raises(ValidationError):
        Roelands.model_validate(parts)


@pytest.mark.parametrize(
    "parts",
    [
        {"nu_40": 68e-6, "nu_100": 8.7e-6},
        {"nu_40": 68e-6, "nu_100": 8.7e-6, "alpha": 2e-8, "z": 0.6},
        {"nu_40": 8.7e-6, "nu_100": 68e-6, "alpha": 2e-8},
        {"nu_40": 68, "nu_100": 8.7, "alpha": 2e-8},
    ],
)
def test_an_impossible_data_sheet_is_rejected(parts: dict[str, float]):
    with pytest.raises(ValidationError):
        Walther.model_validate(parts)
