"""Spots on which summits touch: their number, area and flash temperature."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import dblquad

from tehl.contact.bodies import Motion
from tehl.post.summit_spots import _flash_rises
from tests.reference import touching_contact


@pytest.mark.parametrize("gap", [-1.0, 0.5, 2.0])
def test_number_and_area_of_the_spots_are_those_of_pairs_of_paraboloids(gap):
    problem = touching_contact(100.0, 8.0, 0.5)
    law, sigma = problem.asperities, problem.asperity_rms
    beta, eta = law.summit_radius, law.summit_density

    def pairs(value) -> float:
        """Return the integral over sums of heights s and distances r, r^2 < 4 beta (s - h)."""

        def density(t: float, s: float) -> float:  # t = r^2 / (4 beta sigma)
            return value(s - gap - t) * math.exp(-0.5 * s * s) / math.sqrt(2.0 * math.pi)

        area = 4.0 * math.pi * beta * sigma  # 2 pi r dr
        return eta**2 * area * dblquad(density, gap, gap + 12.0, 0.0, lambda s: s - gap)[0]

    at = np.array([gap])
    area, number = law.spots(at, sigma)
    assert number == pytest.approx(pairs(lambda depth: depth**0), rel=1e-6)
    # two equal spheres of radius beta that are pressed together by w touch on pi beta w / 2
    touching = pairs(lambda depth: 0.5 * math.pi * beta * sigma * depth)
    assert area == pytest.approx(touching, rel=1e-6)


def contact(first: float, second: float) -> SimpleNamespace:
    """Return a contact of steel bodies that move at two speeds [m/s]."""
    material = SimpleNamespace(conductivity=46.0, diffusivity=1.2e-5)
    speed = 0.5 * (first + second)
    motion = Motion(entrainment_speed=speed, slide_roll_ratio=(first - second) / speed)
    surfaces = tuple(SimpleNamespace(material=SimpleNamespace(**vars(material))) for _ in "12")
    problem = SimpleNamespace(surfaces=surfaces, motion=motion)
    return SimpleNamespace(problem=problem, x=np.zeros(1), y=np.zeros(1))


def test_flash_temperatures_have_their_exact_limits():
    stress, radius = np.array([[1e8]]), np.array([[2e-6]])
    slow = _flash_rises(contact(1e-6, 0.0), stress, radius)[0, 0]
    assert slow == pytest.approx(0.5 * stress[0, 0] * 1e-6 * radius[0, 0] / 46.0, rel=1e-3)
    # a fast surface is a half-space heated for the time 2 a / u
    fast = _flash_rises(contact(5e3, 3e3), stress, radius)[0, 0]
    flux = stress[0, 0] * 2e3
    ways = [
        2.0 * flux / 46.0 * math.sqrt(1.2e-5 * 2.0 * radius[0, 0] / speed / math.pi)
        for speed in (5e3, 3e3)
    ]
    assert fast == pytest.approx(1.0 / sum(1.0 / way for way in ways), rel=1e-2)


def test_a_surface_without_thermal_properties_has_no_flash_temperature():
    found = contact(1.0, 0.0)
    found.problem.surfaces[1].material.conductivity = None
    assert _flash_rises(found, np.ones((1, 1)), np.ones((1, 1))) is None
