"""Pressure far from an ellipse that spins: limits, symmetry, and the load by decades."""

import numpy as np
import pytest

from tehl.operators.far_field import Gap, angular_pressure
from tehl.operators.far_spin import far_pressure

TURN = np.linspace(0.0, 2.0 * np.pi, 128, endpoint=False)


def ring(gap: Gap, speed: float, spin: float, radius: float, reach: float = 1e6):
    """Return f on one ring, (128,)."""
    return far_pressure(gap, speed, spin, (1.0, reach))((np.log(radius) + 0.0 * TURN, TURN))


@pytest.mark.parametrize("gap", [Gap(0.5), Gap(2.0), Gap(0.6, 0.3)])
def test_without_spin_it_is_that_of_the_entrainment(gap):
    angle, known = angular_pressure(gap)
    known = np.interp(gap.place(np.cos(TURN), np.sin(TURN)), angle, known)
    assert ring(gap, 1.0, 0.0, 10.0) == pytest.approx(known, abs=3e-3 * known.max())


@pytest.mark.parametrize("ratio", [0.35, 0.8, 3.0])
def test_by_spin_alone_each_ring_has_the_load_of_the_closed_form(ratio):
    """4/3 of that without cavitation, times 1.2234; 8 f / r^2 per radian and logarithm of r."""
    far = ring(Gap(ratio), 0.0, 1.0, 1000.0, 1e8) / 1000.0
    load = 8.0 * 2.0 * np.pi * float(far.mean())
    assert load == pytest.approx(1.6312 * abs(1.0 - ratio) / (ratio * (1.0 + ratio)), rel=5e-3)
    assert far == pytest.approx(np.roll(far, 64), abs=1e-6 * far.max())  # half a turn


def test_the_opposite_spin_has_the_mirrored_pressure():
    one, other = (ring(Gap(0.4), 1.0, spin, 20.0) for spin in (0.2, -0.2))
    assert np.roll(other[::-1], 1) == pytest.approx(one, abs=1e-9 * one.max())


def test_reversed_motion_has_the_pressure_turned_by_half_a_turn():
    one, other = (ring(Gap(0.4, 0.2), speed, 0.2, 20.0) for speed in (1.0, -1.0))
    assert np.roll(other, 64) == pytest.approx(one, abs=1e-9 * one.max())


def test_without_cavitation_it_is_the_closed_form_in_its_lobes():
    """XE / G^2 is a bound from below where both move oil in: cavitation takes suction away."""
    ratio = 0.5
    far = ring(Gap(ratio), 0.0, 1.0, 100.0, 1e8) / 100.0
    growth = np.cos(TURN) ** 2 + ratio * np.sin(TURN) ** 2
    whole = np.cos(TURN) * np.sin(TURN) / growth**2 * (1.0 - ratio) / (6.0 * (1.0 + ratio))
    assert np.all(far > whole - 1e-3 * whole.max())


def test_the_oil_ends():
    pressure = far_pressure(Gap(0.5), 1.0, 0.3, (2.0, 30.0))
    assert pressure((np.log(30.0), 1.0)) == pressure((np.log(50.0), 1.0)) == 0.0
    assert pressure((np.log(10.0), 4.0)) > 0.0
