"""Dry contacts against the exact ellipse, tabulated with complete elliptic integrals."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tehl.contact.hertz import elliptic_b_d, ellipticity, hertz_contact, load_of_pressure

# Ry/Rx, k, E, K, a_x, a_y, p_h, approach for Rx = w = E' = 1. Exact; evaluated to the digits shown
# with independent software.
TABLE = [
    (1.0, 1.000000, 1.570796, 1.570796, 1.144714, 1.144714, 0.364374, 1.310371),
    (1.25, 1.160357, 1.464272, 1.689724, 1.102181, 1.278924, 0.338722, 1.261660),
    (1.5, 1.310103, 1.391138, 1.789765, 1.067593, 1.398657, 0.319760, 1.221958),
    (2.0, 1.585802, 1.297152, 1.952114, 1.013641, 1.607433, 0.293038, 1.159694),
    (3.0, 2.071990, 1.200181, 2.188272, 0.939667, 1.946980, 0.260979, 1.073275),
    (5.0, 2.890181, 1.120520, 2.493744, 0.851344, 2.460537, 0.227933, 0.967817),
    (10.0, 4.499447, 1.059884, 2.914203, 0.742283, 3.339862, 0.192594, 0.833226),
    (20.0, 6.928681, 1.029576, 3.334189, 0.646557, 4.479785, 0.164846, 0.710730),
]
DIGITS = 1.2e-6


@pytest.mark.parametrize("row", TABLE)
def test_the_ellipse_meets_the_table(row: tuple[float, ...]):
    ratio, k, _, _, a_x, a_y, pressure, approach = row
    contact = hertz_contact(1.0, 1.0, ratio, 1.0)
    assert contact.ellipticity == pytest.approx(k, abs=DIGITS)
    assert contact.half_width_x == pytest.approx(a_x, abs=DIGITS)
    assert contact.half_width_y == pytest.approx(a_y, abs=DIGITS)
    assert contact.pressure == pytest.approx(pressure, abs=DIGITS)
    assert contact.approach == pytest.approx(approach, abs=DIGITS)


@pytest.mark.parametrize("row", TABLE)
def test_the_elliptic_integrals_meet_the_table(row: tuple[float, ...]):
    _, k, second, first, *_ = row
    parameter = 1.0 - 1.0 / k**2
    b, d = elliptic_b_d(parameter)
    assert b + d == pytest.approx(first, abs=3 * DIGITS)
    assert b + (1 - parameter) * d == pytest.approx(second, abs=3 * DIGITS)


def test_the_circle_has_its_closed_form():
    load, radius, modulus = 80.0, 0.02, 226e9
    contact = hertz_contact(load, radius, radius, modulus)
    half_width = (1.5 * load * radius / modulus) ** (1 / 3)
    assert contact.half_width_x == pytest.approx(half_width, rel=1e-13)
    assert contact.half_width_y == pytest.approx(half_width, rel=1e-13)
    assert contact.pressure == pytest.approx(1.5 * load / (math.pi * half_width**2), rel=1e-13)
    assert contact.approach == pytest.approx(half_width**2 / radius, rel=1e-13)
    assert contact.mean_pressure == pytest.approx(2 / 3 * contact.pressure)


def test_no_digits_are_lost_next_to_the_circle():
    # For a small difference of radii k = (Ry/Rx)^(2/3) to first order.
    assert ellipticity(1.0, 1.0 + 1e-9) - 1.0 == pytest.approx(2e-9 / 3, rel=1e-5)


@given(st.floats(min_value=0.01, max_value=100.0), st.floats(min_value=0.1, max_value=1e4))
def test_turning_the_axes_turns_the_ellipse(ratio: float, load: float):
    wide = hertz_contact(load, 0.01, 0.01 * ratio, 2e11)
    slim = hertz_contact(load, 0.01 * ratio, 0.01, 2e11)
    assert wide.half_width_x == pytest.approx(slim.half_width_y, rel=1e-12)
    assert wide.pressure == pytest.approx(slim.pressure, rel=1e-12)
    assert wide.ellipticity * slim.ellipticity == pytest.approx(1.0, rel=1e-12)
    assert (wide.ellipticity >= 1.0) == (ratio >= 1.0)


@given(st.floats(min_value=0.05, max_value=20.0), st.floats(min_value=1e7, max_value=5e9))
def test_a_pressure_gives_the_load_that_gives_the_pressure(ratio: float, pressure: float):
    load = load_of_pressure(pressure, 0.02, 0.02 * ratio, 2.26e11)
    contact = hertz_contact(load, 0.02, 0.02 * ratio, 2.26e11)
    assert contact.pressure == pytest.approx(pressure, rel=1e-12)
