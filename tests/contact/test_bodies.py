"""Reduced radii, speeds of the surfaces, and the height of a smooth one."""

import math

import numpy as np
import pytest

from tehl.base.units import Direction, quantity
from tehl.contact.bodies import Motion, reduced_radius
from tehl.roughness import Smooth


def test_curvatures_add():
    assert reduced_radius(0.02, 0.03) == pytest.approx(0.012)
    assert reduced_radius(0.02, math.inf) == pytest.approx(0.02)


def test_a_ball_in_a_groove_is_a_contact():
    assert reduced_radius(0.01, -0.02) == pytest.approx(0.02)


def test_flat_on_flat_is_rejected():
    with pytest.raises(ValueError, match="flat on flat"):
        reduced_radius(math.inf, math.inf)


@pytest.mark.parametrize(("first", "second"), [(0.01, -0.01), (0.02, -0.01), (-0.01, math.inf)])
def test_surfaces_that_do_not_curve_apart_are_rejected(first: float, second: float):
    with pytest.raises(ValueError, match="do not curve apart"):
        reduced_radius(first, second)


@pytest.mark.parametrize("slip", [-2.0, -0.25, 0.0, 1.0, 3.0])
def test_the_speeds_have_the_stated_mean_and_slide_roll_ratio(slip: float):
    motion = Motion(entrainment_speed=1.5, slide_roll_ratio=slip)
    assert (motion.speed_1 + motion.speed_2) / 2 == pytest.approx(1.5)
    assert (motion.speed_1 - motion.speed_2) / 1.5 == pytest.approx(slip)
    assert motion.sliding_speed == pytest.approx(motion.speed_1 - motion.speed_2)


def test_velocities_differ_by_the_sliding_in_its_direction_and_turn_with_the_spin():
    motion = Motion(
        entrainment_speed=2.0,
        slide_roll_ratio=0.5,
        sliding_angle=math.radians(30.0),
        spin_1=10.0,
        spin_2=-20.0,
    )
    first, second = (np.array(motion.velocity_of(surface)) for surface in (1, 2))
    assert 0.5 * (first + second) == pytest.approx([2.0, 0.0])
    assert first - second == pytest.approx([math.cos(math.pi / 6), 0.5])
    u, v = motion.field_of(2, np.array([0.0, 1e-3]), np.array([[0.0], [2e-3]]))
    assert u - second[0] == pytest.approx(np.array([[0.0, 0.0], [0.04, 0.04]]))
    assert v - second[1] == pytest.approx(np.array([[0.0, -0.02], [0.0, -0.02]]))
    assert not motion.is_plain
    assert motion.mean_spin == -5.0


@pytest.mark.parametrize(("degrees", "ratio"), [(0, (1, 0)), (90, (0, 1)), (180, (-1, 0))])
def test_quarter_turns_are_exact(degrees: float, ratio: tuple[float, float]):
    angle = quantity(Direction).parse(f"{degrees} deg")
    motion = Motion(entrainment_speed=1.0, slide_roll_ratio=1.0, sliding_angle=angle)
    assert motion.sliding_ratio == ratio
    assert motion.is_plain == (degrees != 90)


def test_a_smooth_surface_has_zero_height_in_the_shape_of_its_points():
    x, y = np.linspace(-1, 1, 5), np.linspace(-1, 1, 3)[:, None]
    height = Smooth().height(x, y, 2.0)
    assert height.shape == (3, 5)
    assert not height.any()
