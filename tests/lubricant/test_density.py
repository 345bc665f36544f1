"""Density laws."""

import numpy as np
import pytest

from tehl.lubricant import ConstantDensity, DowsonHigginson

PRESSURE = np.array([0.0, 5e8, 2e9])


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
