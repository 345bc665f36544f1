"""Shear laws: one form, ``y = s F(s)``, of which the solver tabulates ``ln F``."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from tehl.lubricant import Carreau, Eyring, Limiting, Newtonian

Law = Newtonian | Eyring | Carreau | Limiting
LAWS: list[Law] = [
    Newtonian(),
    Eyring(stress=5e6),
    Carreau(modulus=6e6, exponent=0.42),
    Carreau(modulus=6e6, exponent=0.01),
    Carreau(modulus=6e6, exponent=1.0),
    Limiting(stress=1e7, slope=0.04),
]
THINNING = [law for law in LAWS if not law.is_newtonian]


@pytest.mark.parametrize("law", LAWS)
@given(exponent=st.floats(min_value=-12, max_value=8))
def test_stress_times_thinning_is_the_rate(law: Law, exponent: float):
    rate = np.array([10.0**exponent])
    stress = law.stress_at(rate)
    assert np.log(stress) + law.log_thinning(stress) == pytest.approx(np.log(rate), abs=1e-10)


@pytest.mark.parametrize("law", LAWS)
def test_thinning_begins_at_one_and_grows(law: Law):
    stress = np.concatenate([[0.0], np.logspace(-12, np.log10(2 * law.largest_stress), 4000)])
    log_thinning = law.log_thinning(stress)
    assert np.isfinite(log_thinning).all()
    assert log_thinning.min() >= 0
    assert log_thinning[0] == pytest.approx(0, abs=1e-200)
    assert (np.diff(log_thinning) >= -1e-15).all()


@pytest.mark.parametrize("law", THINNING[:-1])
def test_the_table_reaches_the_largest_rates(law: Law):
    s = np.array(law.largest_stress)
    assert np.log(s) + law.log_thinning(s) > math.log(0.99e8)


@pytest.mark.parametrize("law", THINNING)
def test_the_thinning_has_no_kink(law: Law):
    # The slope changes by no more than its own size over a hundredth of a decade, also where the
    # power series ends and where the straight line begins.
    s = np.logspace(-4, math.log10(1.05 * law.largest_stress), 1500)
    h = 1e-6 * s
    slope = (law.log_thinning(s + h) - law.log_thinning(s - h)) / (2 * h)
    jumps = np.abs(np.diff(np.log(slope)))
    assert jumps[s[1:] < 0.9].max() < 0.05
    for place in (0.05, 0.9999, 1e-3):
        low, high = law.log_thinning(np.array([place * (1 - 1e-12), place * (1 + 1e-12)]))
        assert low == pytest.approx(high, rel=1e-7, abs=1e-13)


def test_each_law_is_its_formula():
    rate = np.array([0.3, 3.0, 50.0])
    assert Eyring(stress=5e6).stress_at(rate) == pytest.approx(np.arcsinh(rate))
    carreau = Carreau(modulus=6e6, exponent=0.42)
    assert carreau.stress_at(rate) == pytest.approx(rate * (1 + rate**2) ** -0.29)
    assert Limiting(stress=1e7).stress_at(rate[:2]) == pytest.approx(1 - np.exp(-rate[:2]))
    assert Newtonian().stress_at(rate) == pytest.approx(rate)


@pytest.mark.parametrize("law", LAWS)
def test_one_stress_is_that_of_an_array(law: Law):
    scale = law.stress_scale(np.array([3e8]))[0]
    for rate in (1e-3, 1.0, 5.0):
        expected = scale * law.stress_at(np.array([rate]))[0]
        assert law.thinned(rate * scale, 3e8) == pytest.approx(expected, rel=1e-12)


def test_small_stresses_follow_the_series():
    s = np.array([1e-6, 1e-4, 1e-2])
    assert Eyring(stress=1e6).log_thinning(s) == pytest.approx(s**2 / 6, rel=1e-4)
    assert Limiting(stress=1.0).log_thinning(s) == pytest.approx(s / 2 + 5 * s**2 / 24, rel=1e-4)
    carreau = Carreau(modulus=1.0, exponent=0.5)
    assert carreau.log_thinning(s) == pytest.approx(s**2 / 4, rel=1e-3)


def test_the_stress_stays_near_the_limit_which_grows_with_pressure():
    law = Limiting(slope=0.04)
    pressure = np.array([0.0, 1e9])
    assert law.stress_scale(pressure) == pytest.approx([1e5, 4e7])
    assert law.stress_at(np.array([1e4, 1e8])) == pytest.approx([1.006, 1.015], abs=1e-3)
    assert law.stress_at(np.array([1e24])) == pytest.approx(1.048, abs=1e-3)


@pytest.mark.parametrize("law", LAWS)
def test_scales_have_the_shape_of_the_pressure_and_no_stress_overflows(law: Law):
    scale = law.stress_scale(np.zeros((2, 3)))
    assert scale.shape == (2, 3)
    assert (scale > 0).all()
    assert np.isfinite(law.log_thinning(np.array([1e6, 1e12]))).all()
    assert np.isfinite(law.stress_at(np.array([0.0, 1e15]))).all()


@pytest.mark.parametrize(
    "parts", [{"law": Carreau, "modulus": 1e6, "exponent": 0.0}, {"law": Limiting}]
)
def test_an_impossible_law_is_rejected(parts: dict[str, object]):
    law = parts.pop("law")
    with pytest.raises(ValidationError):
        law.model_validate(parts)  # type: ignore[attr-defined]
