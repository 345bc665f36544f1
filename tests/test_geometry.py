"""Reduced radii."""

import math

import pytest

from tehl.geometry import Radii, reduced_radii, reduced_radius


def test_curvatures_add():
    assert reduced_radius(0.02, 0.03) == pytest.approx(0.012)
    assert reduced_radius(0.02, math.inf) == pytest.approx(0.02)


def test_a_ball_in_a_groove_is_a_contact():
    assert reduced_radius(0.01, -0.02) == pytest.approx(0.02)


def test_flat_on_flat_is_refused():
    with pytest.raises(ValueError, match="flat on flat"):
        reduced_radius(math.inf, math.inf)


@pytest.mark.parametrize(("first", "second"), [(0.01, -0.01), (0.02, -0.01), (-0.01, math.inf)])
def test_surfaces_that_do_not_curve_apart_are_refused(first: float, second: float):
    with pytest.raises(ValueError, match="do not curve apart"):
        reduced_radius(first, second)


def test_both_directions_are_reduced():
    roller = reduced_radii(Radii(x=0.01, y=0.1), Radii(x=math.inf, y=math.inf))
    assert (roller.x, roller.y) == (pytest.approx(0.01), pytest.approx(0.1))
