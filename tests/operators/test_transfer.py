"""Interpolation of a pressure to the next finer grid."""

import numpy as np
import pytest

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


@pytest.mark.parametrize("mirror", [True, False])
def test_the_refined_pressure_is_not_negative_and_vanishes_on_the_edges(mirror):
    coarse, fine = (grid_of(n, n, mirror=mirror) for n in (17, 33))
    refined = refine(np.random.default_rng(2).random(coarse.shape), fine)
    assert refined.min() >= 0.0
    edges = [refined[-1], refined[:, 0], refined[:, -1]] + ([] if mirror else [refined[0]])
    assert all((edge == 0.0).all() for edge in edges)
