"""Temperatures along the paths of a surface against the integral over them."""

import numpy as np
import pytest

from tehl.operators.full_source import FullSource
from tehl.operators.stream_source import StreamSource


def flux_at(x, y):
    return np.exp(-4.0 * ((x + 0.3) ** 2 + 1.5 * (y - 0.1) ** 2))


def exact(x, y, slope, spin):
    """2 int q ds over the root s of the time that a point has been on its way."""
    roots = np.linspace(0.0, np.sqrt(8.0), 2001)
    time = roots**2
    if spin:
        middle, angle = np.array([-slope / spin, 1.0 / spin]), -spin * time
        along, across = x - middle[0], y - middle[1]
        path = middle[:, None] + [
            np.cos(angle) * along - np.sin(angle) * across,
            np.sin(angle) * along + np.cos(angle) * across,
        ]
    else:
        path = np.array([x - time, y - slope * time])
    values = flux_at(*path)
    return 2.0 * (values.sum() - 0.5 * (values[0] + values[-1])) * roots[1]


@pytest.mark.parametrize(("slope", "spin"), [(0.0, 0.0), (1.0, 0.0), (0.2, 0.5), (-0.5, -0.5)])
def test_heat_follows_the_paths_of_the_surface_with_second_order(slope, spin):
    errors = []
    for nodes in (37, 73):
        x, y = np.linspace(-3.0, 1.5, nodes), np.linspace(-2.0, 2.0, nodes)
        flux = flux_at(x[:, None], y)
        rise = StreamSource(x, y, 1.0, slope, spin).rise(flux)
        near = np.argwhere((np.abs(x) < 1.2)[:, None] & (np.abs(y) < 1.2))[:: nodes // 2]
        errors.append(max(abs(rise[i, j] - exact(x[i], y[j], slope, spin)) for i, j in near))
    assert errors[0] < 0.02
    assert errors[1] < 0.36 * errors[0]


def test_the_full_source_turns_with_the_velocity():
    axis = np.linspace(-1.0, 1.0, 21)
    flux, cell = flux_at(axis, axis[:, None]), (0.1, 0.1)
    along = FullSource(flux.shape, False, cell, (12.0, 5.0), 1.0).rise(flux)
    across = FullSource(flux.shape, False, cell, (5.0, 12.0), 1.0).rise(flux.T)
    # the period of twice the intervals folds the ends of a line onto each other
    np.testing.assert_allclose(across.T, along, rtol=1e-6)


def test_the_full_source_tends_to_the_paths_at_high_peclet_numbers():
    slope, axis = 0.5, np.linspace(-2.0, 1.5, 141)
    flux, cell = flux_at(axis, axis[:, None]), (axis[1] - axis[0],) * 2
    paths = StreamSource(axis, axis, 1.0, slope, 0.0).rise(flux.T).T
    errors = []
    for peclet in (30.0, 120.0):
        # in units of the line along x, whose factor is the root of 2 pi/Pe here
        full = FullSource(flux.shape, False, cell, (peclet, slope * peclet), 1.0).rise(flux)
        errors.append(np.abs(np.sqrt(peclet / (2.0 * np.pi)) * full - paths).max() / paths.max())
    assert errors[1] < 0.5 * errors[0] < 0.05
