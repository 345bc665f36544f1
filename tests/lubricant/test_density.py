"""Density laws."""

import numpy as np
import pytest

from tehl.lubricant import ConstantDensity, DensityLaw, DowsonHigginson, TaitDensity

PRESSURE = np.array([0.0, 5e8, 2e9])
TAIT = TaitDensity(
    rho_0=864.0, bulk_modulus=1.312e9, bulk_modulus_slope=11.74, expansion=8e-4, softening=6.3e-3
)
LAWS: list[DensityLaw] = [
    DowsonHigginson(rho_0=890.0, beta=6.5e-4),
    DowsonHigginson(rho_0=890.0, beta=1e-3, form="additive"),
    TAIT,
    ConstantDensity(rho_0=850.0),
]


def test_dowson_higginson_is_its_formula():
    law = DowsonHigginson(rho_0=890.0, beta=6.5e-4)
    growth = 1 + 0.6e-9 * PRESSURE / (1 + 1.7e-9 * PRESSURE)
    assert law.density(PRESSURE, 333.15) == pytest.approx(890.0 * growth * (1 - 6.5e-4 * 20))
    additive = law.model_copy(update={"form": "additive"})
    assert additive.density(PRESSURE, 333.15) == pytest.approx(890.0 * (growth - 6.5e-4 * 20))


def test_the_constants_are_free():
    law = DowsonHigginson(rho_0=870.0, slope=0.34 / 5.9e8, saturation=1 / 5.9e8)
    expected = 870.0 * (5.9e8 + 1.34 * PRESSURE) / (5.9e8 + PRESSURE)
    assert law.density(PRESSURE, 313.15) == pytest.approx(expected)


def test_a_constant_density_has_the_shape_of_its_arguments():
    law = ConstantDensity(rho_0=850.0)
    assert law.density(PRESSURE, 300.0).tolist() == [850.0] * 3
    assert law.ambient(400.0) == 850.0


@pytest.mark.parametrize("form", ["product", "additive"])
def test_the_ambient_density_is_the_law_without_pressure(form: str):
    law = DowsonHigginson.model_validate({"rho_0": 890, "beta": 6.5e-4, "form": form})
    assert law.ambient(350.0) == pytest.approx(law.density(np.zeros(1), 350.0)[0])


def test_tait_is_its_formula():
    modulus = 1.312e9 * np.exp(-6.3e-3 * 30.0)
    volume = (1 + 8e-4 * 30) * (1 - np.log(1 + 12.74 * PRESSURE / modulus) / 12.74)
    assert TAIT.density(PRESSURE, 343.15) == pytest.approx(864.0 / volume)
    slope = (TAIT.density(np.array([1e4]), 313.15)[0] / 864.0 - 1.0) / 1e4
    assert slope == pytest.approx(1 / 1.312e9, rel=1e-3)


@pytest.mark.parametrize("law", LAWS)
def test_the_laws_stay_positive_wherever_they_are_tabulated(law: DensityLaw):
    pressure = np.concatenate([[0.0], np.logspace(5, np.log10(4e10), 60)])
    temperature = np.linspace(200.0, 1500.0, 131)
    value = law.density(pressure[:, None], temperature[None, :])
    assert value.shape == (61, 131)
    assert np.isfinite(law.density(np.array([-1e6]), temperature)).all()  # where slopes are taken
    assert np.isfinite(value).all()
    assert value.min() > 0
    ambient = [law.ambient(t) for t in temperature]
    assert value[0] == pytest.approx(ambient)
    assert (np.diff(value, axis=0) >= -1e-9).all()
