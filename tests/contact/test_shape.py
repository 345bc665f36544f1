"""Shapes of contacts against closed forms: dry gap, dry pressure, load."""

import math

import numpy as np
import pytest

from tehl.contact.bodies import Radii
from tehl.contact.hertz import elliptic_b_d
from tehl.contact.shape import LINE, Ellipse

CIRCLE = Ellipse(ellipticity=1.0, radius_ratio=1.0)


def gap_of_circle(r: np.ndarray) -> np.ndarray:
    """Johnson (1985), section 3.4: gap outside the contact of a sphere, in a^2/R."""
    rise = (2 - r**2) * np.arcsin(1 / r) + np.sqrt(r**2 - 1)
    return -1 + r**2 / 2 + rise / np.pi


def test_the_dry_gap_of_a_circle_is_that_of_hertz():
    r = np.linspace(1.001, 5, 40)
    assert CIRCLE.dry_gap(0.6 * r, 0.8 * r) == pytest.approx(gap_of_circle(r), abs=1e-12)


@pytest.mark.parametrize("ellipticity", [0.3, 1.0, 2.5])
def test_the_dry_gap_closes_in_the_contact(ellipticity):
    angle = np.linspace(0, 7, 30)
    radius = np.linspace(0, 1, 30)
    shape = Ellipse(ellipticity=ellipticity, radius_ratio=1.0)
    gap = shape.dry_gap(radius * np.cos(angle), radius * np.sin(angle))
    assert np.abs(gap).max() < 1e-12


@pytest.mark.parametrize("kappa", [0.5, 1.6, 4.0])
def test_far_away_the_dry_gap_is_the_undeformed_one(kappa):
    """H -> X^2/2 + D kappa^2 Y^2/2 - approach + load term; D from the second difference."""
    k = max(kappa, 1 / kappa)
    b, d = elliptic_b_d(1 - 1 / k**2)
    radius_ratio = 1 / (k**2 * b / d) if kappa >= 1 else k**2 * b / d
    y = np.array([200.0, 201.0, 202.0])
    shape = Ellipse(ellipticity=kappa, radius_ratio=radius_ratio)
    curvature = np.diff(shape.dry_gap(np.zeros(3), y), 2)[0]
    assert curvature == pytest.approx(shape.across, rel=1e-4)


@pytest.mark.parametrize("shape", [CIRCLE, LINE])
def test_the_dry_pressure_carries_the_load(shape):
    x = np.linspace(-1, 1, 4001)
    y = np.zeros(1) if shape is LINE else x[::5]
    cell = (x[1] - x[0]) * (1.0 if shape is LINE else y[1] - y[0])
    carried = shape.dry_pressure(x[None, :], y[:, None]).sum() * cell
    assert carried == pytest.approx(shape.load, rel=1e-4)


def test_the_dry_gap_of_a_line_opens_as_the_surfaces_curve_less_what_they_bend():
    # the slope of the deflection of sqrt(1 - X^2) outside of it is -(X - sqrt(X^2 - 1))
    x = np.linspace(-3.0, 3.0, 6001)
    slope = np.gradient(LINE.dry_gap(x, np.zeros(1)), x)
    exact = np.sign(x) * np.sqrt(np.maximum(x**2 - 1.0, 0.0))
    assert np.abs(slope - exact).max() < 0.02  # the slope rises like a root at |X| = 1
    assert np.abs(slope - exact)[(np.abs(x) > 1.5) & (np.abs(x) < 2.9)].max() < 1e-6


def test_a_dry_line_is_that_of_hertz():
    """Johnson (1985), eqs 4.43 and 4.45, with E' = 2 E*."""
    load, radius, modulus = 2e5, 0.02, 2.26e11
    contact = LINE.hertz(load, Radii(x=radius, y=math.inf), modulus)
    assert contact.half_width_x == pytest.approx(math.sqrt(8 * load * radius / math.pi / modulus))
    assert contact.pressure == pytest.approx(math.sqrt(load * modulus / (2 * math.pi * radius)))
    assert contact.pressure == pytest.approx(modulus * contact.half_width_x / (4 * radius))
    again = LINE.load_of_pressure(contact.pressure, Radii(x=radius, y=math.inf), modulus)
    assert again == pytest.approx(load)
