"""Interpolation of a pressure to the next finer grid."""

import numpy as np
import pytest

from tehl.kernels.faces import CLOSED
from tehl.kernels.transfer import restrict_pressure
from tehl.operators.transfer import refine
from tests.operators.contacts import grid_of


@pytest.mark.parametrize("mirror", [True, False])
def test_a_cubic_is_interpolated_exactly_away_from_the_edges(mirror):
    coarse, fine = (grid_of(n, n, mirror=mirror) for n in (17, 33))

    def cubic(grid):
        x, y = grid.x[None, :], np.abs(grid.y[:, None])
        return 40.0 + x**3 - x * y**2

    refined = refine(cubic(coarse), fine)
    inner = np.s_[0 if mirror else 4 : -4, 3:-3]
    np.testing.assert_allclose(refined[inner], cubic(fine)[inner], rtol=1e-12)


@pytest.mark.parametrize("mirror", [CLOSED, CLOSED + 1])
def test_the_end_of_a_roller_is_restricted_by_itself(mirror):
    fine = np.random.default_rng(5).uniform(1.0, 2.0, (9, 17))
    coarse = np.zeros((5, 9))
    restrict_pressure(fine, mirror, coarse)
    along = 0.5 * fine[:, 2:-1:2] + 0.25 * (fine[:, 1:-2:2] + fine[:, 3::2])
    weighted = 0.5 * along[::2]
    weighted[1:-1] += 0.25 * (along[1:-2:2] + along[3::2])
    weighted[0] += 0.5 * along[1]
    weighted[-1] = along[-1]
    if mirror == CLOSED:
        weighted[0] = along[0]
    np.testing.assert_allclose(coarse[:, 1:-1], weighted, rtol=1e-12)


@pytest.mark.parametrize("mirror", [True, False])
def test_the_refined_pressure_is_not_negative_and_vanishes_on_the_edges(mirror):
    coarse, fine = (grid_of(n, n, mirror=mirror) for n in (17, 33))
    refined = refine(np.random.default_rng(2).random(coarse.shape), fine)
    assert refined.min() >= 0.0
    edges = [refined[-1], refined[:, 0], refined[:, -1]] + ([] if mirror else [refined[0]])
    assert all((edge == 0.0).all() for edge in edges)
