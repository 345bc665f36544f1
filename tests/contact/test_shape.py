"""Shapes of contacts against closed forms: dry gap, dry pressure, load."""

import math

import numpy as np
import pytest

from tehl.contact.bodies import Radii
from tehl.contact.hertz import elliptic_b_d
from tehl.contact.profile import Crown
from tehl.contact.roller import Roller
from tehl.contact.shape import LINE, Ellipse

CIRCLE = Ellipse(ellipticity=1.0, radius_ratio=1.0)
AXES = Radii(x=0.01, y=0.03)
TURNED = Ellipse.of(AXES.turned(math.radians(30)))


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


def test_the_contact_of_a_roller_is_that_of_its_slices():
    crown = Crown(shape="crown", radius=6.0)
    shape = Roller(length=0.01, profile=crown).under(2000.0, Radii(x=0.01, y=math.inf), 2.2e11)
    x, y = np.linspace(-1.2, 1.2, 61), np.linspace(-1.0, 1.0, 41)[:, None]
    inside = shape.radius_squared(x, y) < 1.0
    assert np.array_equal(inside, shape.dry_pressure(x, y) > 0.0)
    assert inside[20].sum() > inside[2].sum() > 0  # the middle carries more


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


@pytest.mark.parametrize("shape", [CIRCLE, LINE, TURNED])
def test_the_dry_pressure_carries_the_load(shape):
    x = np.linspace(-1, 1, 4001)
    y = np.zeros(1) if shape is LINE else x[::5]
    cell = (x[1] - x[0]) * (1.0 if shape is LINE else y[1] - y[0])
    carried = shape.dry_pressure(x[None, :], y[:, None]).sum() * cell
    assert carried == pytest.approx(shape.load, rel=2e-4)


def on_axes(x: np.ndarray, y: np.ndarray, angle: float) -> tuple[np.ndarray, np.ndarray]:
    """Places [m] along the axes of an ellipse whose axis of radius_x lies at -angle from x."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return x * cosine - y * sine, x * sine + y * cosine


@pytest.mark.parametrize("degrees", [30.0, -75.0, 120.0])
def test_a_turned_ellipse_is_the_one_on_its_axes(degrees):
    angle, load, modulus = math.radians(degrees), 50.0, 2.2e11
    own, radii = Ellipse.of(AXES), AXES.turned(angle)
    dry, found, shape = (
        own.hertz(load, AXES, modulus),
        own.hertz(load, radii, modulus),
        Ellipse.of(radii),
    )
    x, y = np.random.default_rng(1).uniform(-2.0, 2.0, (2, 50))
    along, across = on_axes(x * found.half_width_x, y * found.half_width_y, angle)
    first, second = along / dry.half_width_x, across / dry.half_width_y
    unit = dry.half_width_x**2 / AXES.x / (found.half_width_x**2 / radii.x)
    assert shape.gap(x, y) == pytest.approx(own.gap(first, second) * unit, rel=1e-10)
    assert shape.dry_pressure(x, y) == pytest.approx(own.dry_pressure(first, second), abs=1e-8)
    gap = own.dry_gap(first, second)
    assert shape.dry_gap(x, y) == pytest.approx(gap * unit, abs=1e-10)
    assert found.pressure == pytest.approx(dry.pressure)
    assert sorted(found.axes[:2]) == pytest.approx([dry.half_width_x, dry.half_width_y])
    assert math.sin(found.axes[2] + angle) == pytest.approx(0.0, abs=1e-12)
    # its rim touches the edges of its half-widths
    rim = np.linspace(0.0, 7.0, 10000)
    place = on_axes(dry.half_width_x * np.cos(rim), dry.half_width_y * np.sin(rim), -angle)
    assert max(place[0]) == pytest.approx(found.half_width_x, rel=1e-6)
    assert max(place[1]) == pytest.approx(found.half_width_y, rel=1e-6)
    assert shape.load_of_pressure(found.pressure, radii, modulus) == pytest.approx(load)


def test_turns_by_quarters_and_of_circles_are_exact():
    assert AXES.turned(math.radians(180)) == AXES
    assert AXES.turned(math.radians(-90)) == AXES.turned(math.pi / 2) == Radii(x=0.03, y=0.01)
    circle = Radii(x=0.01, y=0.01)
    assert circle.turned(0.7) == circle
    one, other = AXES.turned(0.4), AXES.turned(-0.4)
    assert (one.x, one.y, one.twist) == (other.x, other.y, -other.twist)


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


@pytest.mark.parametrize(
    ("shape", "radii"), [(CIRCLE, Radii(x=0.01, y=0.01)), (TURNED, None), (LINE, AXES)]
)
def test_the_dry_contact_grows_as_that_of_hertz(shape, radii):
    radii = radii or AXES.turned(math.radians(30))
    after = Radii(x=radii.x / 2.2, y=radii.y / 2.2, twist=2.2 * radii.twist)
    one, other = shape.hertz(100.0, radii, 2e11), shape.hertz(35.0, after, 2e11)
    width, pressure = shape.grown(0.35, 2.2)
    assert other.half_width_x == pytest.approx(width * one.half_width_x, rel=1e-9)
    assert other.pressure == pytest.approx(pressure * one.pressure, rel=1e-9)
