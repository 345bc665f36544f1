"""Speeds of the surfaces, and the objects that stand for absence."""

import numpy as np
import pytest

from tehl.motion import Motion
from tehl.roughness import Smooth


@pytest.mark.parametrize("slip", [-2.0, -0.25, 0.0, 1.0, 3.0])
def test_the_mean_speed_and_the_slide_roll_ratio_return(slip: float):
    motion = Motion(entrainment_speed=1.5, slide_roll_ratio=slip)
    assert (motion.speed_1 + motion.speed_2) / 2 == pytest.approx(1.5)
    assert (motion.speed_1 - motion.speed_2) / 1.5 == pytest.approx(slip)
    assert motion.sliding_speed == pytest.approx(motion.speed_1 - motion.speed_2)


def test_a_smooth_surface_has_zero_height_in_the_shape_of_its_points():
    x, y = np.linspace(-1, 1, 5), np.linspace(-1, 1, 3)[:, None]
    height = Smooth().height(x, y, 2.0)
    assert height.shape == (3, 5)
    assert not height.any()
