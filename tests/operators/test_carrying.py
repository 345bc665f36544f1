"""Fields that a motion in the plane carries along."""

import numpy as np
import pytest

from tehl.contact.options import ROLLER_ENDS, Domain
from tehl.estimate.grid import Grid
from tehl.estimate.ways import Way, parts_of_step, steady_way, way_of
from tehl.operators.carrying import Carrier, divergence_of_full, slope_across

WAY = steady_way((1.0, 0.3), 0.7, 0.4)


def test_ways_add_up_and_come_back():
    half = steady_way((1.0, 0.3), 0.7, 0.2)
    np.testing.assert_allclose(half.after(half), WAY, atol=1e-14)
    np.testing.assert_allclose(WAY.since(half), half, atol=1e-14)
    np.testing.assert_allclose(
        way_of([(1.0, 0.3)] * len(parts_of_step()), 0.7, 0.4), WAY, atol=1e-12
    )
    undone = steady_way((1.0, 0.3), 0.7, -0.4).after(WAY)
    np.testing.assert_allclose(undone, 0.0, atol=1e-14)


def test_points_follow_the_velocity_field():
    """dx/dt = u - spin y, dy/dt = v + spin x."""
    brief = steady_way((1.0, 0.3), 0.7, 1e-6)
    x, y = brief.back(np.array([0.5]), np.array([-0.8]))
    assert (0.5 - x[0]) / 1e-6 == pytest.approx(1.0 + 0.7 * 0.8, rel=1e-5)
    assert (-0.8 - y[0]) / 1e-6 == pytest.approx(0.3 + 0.7 * 0.5, rel=1e-5)


@pytest.mark.parametrize("way", [Way(0.37, -0.21), WAY])
def test_a_field_is_carried_to_fourth_order_between_lines_that_crowd_too(way):
    errors = []
    for nodes in (41, 81):
        x, even = np.linspace(-3.0, 3.0, nodes), np.linspace(-3.0, 3.0, nodes)
        y = 1.2 * np.sinh(0.6 * even)
        bump = np.exp(-2.5 * x[None] ** 2 - 2.5 * (y[:, None] - 0.2) ** 2)
        there = way.back(x[None], y[:, None])
        wanted = np.exp(-2.5 * there[0] ** 2 - 2.5 * (there[1] - 0.2) ** 2)
        errors.append(np.abs(Carrier(x, y).carried(bump, way) - wanted).max())
    assert errors[1] < 2e-3
    assert np.log2(errors[0] / errors[1]) > 3.6


def test_a_film_that_wraps_comes_in_at_the_other_side():
    x, y = np.linspace(0.0, 2.0, 21), np.linspace(0.0, 1.0, 33)
    wave = np.cos(2.0 * np.pi * y)[:, None] * np.ones(21)
    found = Carrier(x, y, 32).carried(wave, Way(0.1, 1.3))
    wanted = np.cos(2.0 * np.pi * (y - 1.3))[:, None] * np.ones(21)
    np.testing.assert_allclose(found, wanted, atol=1e-4)


def test_nothing_enters_an_empty_domain():
    x = y = np.linspace(0.0, 1.0, 11)
    ones = np.ones((11, 11)).ravel()
    carrier = Carrier(x, y)
    found = (carrier.entering(Way(0.25, 0.0)) @ ones).reshape(11, 11)
    assert (found[:, :3] == 0.0).all()
    np.testing.assert_allclose(found[:, 3:], 1.0)
    np.testing.assert_allclose(carrier.matrix(Way(0.25, 0.0)) @ ones, 1.0)


@pytest.mark.parametrize("kind", ["point", "wraps", "crowds", "line"])
def test_full_nodes_pass_oil_to_full_nodes_alone(kind):
    sides = ROLLER_ENDS if kind == "crowds" else (-1.5, 1.5)
    grid = Grid(
        nx=33,
        ny=1 if kind == "line" else 25,
        domain=Domain(x=(-2.0, 1.5), y=sides),
        mirror=False,
        wraps=kind == "wraps",
        crowding=1.5 if kind == "crowds" else 0.0,
    )
    rng = np.random.default_rng(3)
    along, across = rng.standard_normal((2, *grid.shape))
    full = rng.random(grid.shape) < 0.7
    full[:, [0, -1]] = False
    if grid.wraps:  # its last row is the first one
        across[-1], along[-1], full[-1] = across[0], along[0], full[0]
    found = divergence_of_full((along, across), grid, 1.7, full)
    assert not found[~full].any()
    assert np.abs(grid.widths @ found).sum() > 1.0  # along x it is passed on
    assert (grid.widths @ found).sum() == pytest.approx(0.0, abs=1e-11)
    everywhere = divergence_of_full((along, across), grid, 1.7, np.full(grid.shape, True))
    usual = np.gradient(along, grid.dx, axis=1) + slope_across(across, grid, 1.7)
    if kind != "crowds":
        inside = (slice(None) if kind != "point" else slice(1, -1), slice(1, -1))
        np.testing.assert_allclose(everywhere[inside], usual[inside], atol=1e-12)
