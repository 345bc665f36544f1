"""The full moving source against exact temperatures of the half-space."""

import numpy as np
import pytest

from tehl.operators.full_source import WRAPS, FullSource

PER_DISTANCE = 1.0 / (2.0 * np.pi)


def resting_hertz(dx):
    """Error of the rise under q = sqrt(1 - r^2) at rest: pi/4 (1 - r^2/2) inside the circle."""
    x, y = np.arange(-2.0, 2.0 + 1e-9, dx), np.arange(0.0, 2.0 + 1e-9, dx)
    square = x[None] ** 2 + y[:, None] ** 2
    flux = np.sqrt(np.maximum(0.0, 1.0 - square))
    rise = FullSource(flux.shape, True, (dx, dx), (0.0, 0.0), PER_DISTANCE).rise(flux)
    return float(np.abs(rise - np.pi / 4 * (1 - square / 2))[square <= 1].max())


def test_a_surface_at_rest_warms_as_the_exact_solution_under_a_hertzian_flux():
    errors = [resting_hertz(dx) for dx in (0.1, 0.05, 0.025)]
    assert errors[2] < 2e-3
    # order 1.5 or near: the flux has a root at the edge
    assert errors[0] / errors[1] > 2.2
    assert errors[1] / errors[2] > 2.2


@pytest.mark.parametrize("dy", [0.05, 0.5])
@pytest.mark.parametrize(("peclet", "mean"), [(5.0, 5.419579), (20.0, 10.651751)])
def test_a_moving_band_has_the_mean_temperature_of_the_table_on_long_cells_too(peclet, mean, dy):
    """Exact band at finite speed, theta = pi k u T / (2 kappa q); a band 16 widths long."""
    dx = 0.05
    x, y = np.arange(-3.0, 3.0 + 1e-9, dx), np.arange(0.0, 8.0 + 1e-9, dy)
    inside = np.where(np.isclose(np.abs(x), 1.0), 0.5, np.abs(x) < 1.0)
    flux = np.tile(inside, (len(y), 1))
    rise = FullSource(flux.shape, True, (dy, dx), (peclet, 0.0), PER_DISTANCE).rise(flux)[0]
    theta = np.pi * peclet * rise
    assert float((theta * inside).sum()) * dx / 2.0 == pytest.approx(mean, rel=5e-3)


@pytest.mark.parametrize("peclet", [0.5, 5.0])
def test_a_source_between_mirrors_is_that_of_a_row_of_images(peclet):
    flux = np.random.default_rng(3).random((9, 17))
    cell, velocity = (0.05, 0.1), (peclet, 0.0)
    found = FullSource(flux.shape, 2, cell, velocity, 1.0).rise(flux)
    row = np.tile(np.concatenate([flux, flux[-2:0:-1]]), (81, 1))  # 40 periods on each side
    whole = FullSource(row.shape, 0, cell, velocity, 1.0).rise(row)[40 * 16 : 40 * 16 + 9]
    np.testing.assert_allclose(found, whole, rtol=0.0, atol=5e-4 * found.max())


@pytest.mark.parametrize("peclet", [0.5, 5.0])
def test_a_source_that_wraps_is_that_of_a_row_of_images(peclet):
    flux = np.random.default_rng(3).random((13, 17))
    flux[-1] = flux[0]
    cell, velocity = (0.05, 0.1), (peclet, 0.0)
    found = FullSource(flux.shape, WRAPS, cell, velocity, 1.0).rise(flux)
    row = np.tile(flux[:-1], (81, 1))  # 40 periods on each side
    whole = FullSource(row.shape, 0, cell, velocity, 1.0).rise(row)[40 * 12 : 40 * 12 + 13]
    np.testing.assert_allclose(found, whole, rtol=0.0, atol=5e-4 * found.max())
    assert np.array_equal(found[-1], found[0])


@pytest.mark.parametrize("velocity", [(5.0, 2.0), (5.0, -8.0), (0.5, 0.5)])
def test_heat_that_leaves_one_end_comes_back_at_the_other(velocity):
    flux = np.random.default_rng(3).random((13, 17))
    flux[-1] = flux[0]
    cell = (0.05, 0.1)
    found = FullSource(flux.shape, WRAPS, cell, velocity, 1.0).rise(flux)
    row = np.tile(flux[:-1], (161, 1))  # 80 periods on each side
    whole = FullSource(row.shape, 0, cell, velocity, 1.0).rise(row)[80 * 12 : 80 * 12 + 13]
    np.testing.assert_allclose(found, whole, rtol=0.0, atol=1e-3 * found.max())
    assert np.array_equal(found[-1], found[0])


def test_the_heat_of_a_surface_that_runs_backwards_goes_the_other_way():
    flux = np.random.default_rng(3).random((9, 17))
    forward = FullSource(flux.shape, True, (0.2, 0.1), (4.0, 0.0), 1.0).rise(flux)
    backward = FullSource(flux.shape, True, (0.2, 0.1), (-4.0, 0.0), 1.0).rise(flux[:, ::-1])
    # the period of twice the intervals folds the two ends of a line onto each other
    np.testing.assert_allclose(backward[:, ::-1][:, 1:-1], forward[:, 1:-1], rtol=1e-10)
