"""Profiles beside the dry contact, and the flow of oil."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.post.film import mass_flow, profile_x, profile_y
from tehl.post.traction import under_pressure


def test_profiles_run_through_the_centre(result):
    along, across = profile_x(result), profile_y(result)
    assert along.at == across.at == 0.0
    middle = int(np.argmin(np.abs(result.scaled.x)))
    assert along.film_thickness[middle] == pytest.approx(result.central_film_thickness)
    assert along.hertz_pressure.max() == pytest.approx(result.scales.hertz_pressure)
    assert np.array_equal(across.pressure, result.pressure[:, middle])
    assert across.dry_gap.shape == result.y.shape


def test_the_pressurised_area_is_that_of_the_circle_in_which_pressure_falls_to_zero(result):
    inside = np.maximum(1.0 - np.add.outer(result.scaled.y**2, result.scaled.x**2), 0.0)
    smooth = replace(result, scaled=replace(result.scaled, pressure=inside**2))
    circle = np.pi * result.scales.half_width_x**2
    assert under_pressure(smooth).sum() == pytest.approx(circle, rel=0.03)


def test_without_pressure_the_surfaces_carry_the_mass(result):
    film = np.full_like(result.scaled.film, 0.1)
    fields = replace(result.scaled, film=film, pressure=np.zeros_like(film))
    flow = mass_flow(replace(result, scaled=fields))
    thickness = 0.1 * result.scales.film_thickness
    assert flow.forward == pytest.approx(890 * 1.5 * thickness * np.ptp(result.y))
    assert flow.sideways == pytest.approx(0.0)


def test_mass_that_leaves_sideways_is_counted(result):
    """p = p0 (1 - Y^2/9), weak: side flow is 2 rho h^3/(12 eta) (2 p0/(3 a)) per length."""
    film = np.full_like(result.scaled.film, 0.1)
    profile = 1e-6 * (1 - result.scaled.y[:, None] ** 2 / 9)
    fields = replace(result.scaled, film=film, pressure=profile + 0 * film)
    flow = mass_flow(replace(result, scaled=fields))
    scales = result.scales
    slope = 1e-6 * scales.hertz_pressure * (2 / 3) / scales.half_width_y
    side = 2 * 890 * (0.1 * scales.film_thickness) ** 3 / (12 * 0.04) * slope
    assert flow.sideways[-1] == pytest.approx(side * np.ptp(result.x), rel=1e-4)
    assert flow.full.all()
    assert flow.imbalance == pytest.approx(flow.sideways[-2] / flow.forward[0], rel=0.1)


def test_the_imbalance_covers_full_sections_only(result):
    flow = mass_flow(result)
    assert not flow.full.any()
    assert flow.imbalance == 0.0
