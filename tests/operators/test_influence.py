"""Influence of one cell against its closed forms."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tehl.operators.influence import (
    Influence,
    LineInfluence,
    PeriodicInfluence,
    dense_matrix,
    influence_of,
)
from tests.operators.contacts import contact_groups, grid_of
from tests.reference import read

SIDES = st.floats(1e-3, 1.0)
OFFSETS = st.integers(0, 400)
ROUNDING = 1e-12
"""Four antiderivatives of the size of the offset are subtracted; 400 cells leave 1e-12."""


def test_a_square_cell_deflects_its_own_centre_by_four_d_asinh_one():
    side = 0.037
    expected = 4.0 * side * np.arcsinh(1.0)
    assert float(Influence(side, side, 1.0)(0, 0)) == pytest.approx(expected, rel=1e-14)


def test_lines_between_mirrors_are_together_a_line_contact():
    columns, lines = np.arange(60), 32
    mirrored = PeriodicInfluence(0.05, 0.04, 1.0, lines)
    table = mirrored.table(lines // 2 + 1, columns.size)
    # the difference of two lines is that of as many images as one likes
    many = 60 * lines
    direct = Influence(0.05, 0.04, 1.0).table(lines // 2 + 1 + many, columns.size)
    rows = np.arange(lines // 2 + 1)
    images = sum(direct[np.abs(rows + image)] for image in range(-many, many + 1, lines))
    assert table[1:] - table[0] == pytest.approx(images[1:] - images[0], abs=2e-6)
    whole = np.concatenate([table, table[-2:0:-1]]).sum(axis=0)
    assert whole == pytest.approx(LineInfluence(0.05, 1.0)(0, columns), abs=3e-7)


def test_a_square_cell_has_the_published_deflection():
    cited = read("exact")["square_cell"]["centre_over_half_side"]
    assert float(Influence(2.0, 2.0, 1.0)(0, 0)) == pytest.approx(cited, abs=5e-9)  # its digits


@given(SIDES, SIDES, OFFSETS, OFFSETS)
def test_influence_is_positive_and_symmetric(dx, dy, dj, di):
    influence = Influence(dx, dy, 1.0)
    here = float(influence(dj, di))
    assert here > 0.0
    for other in (influence(-dj, di), influence(dj, -di), influence(-dj, -di)):
        assert float(other) == pytest.approx(here, rel=1e-7)  # rounding at 400 cells away


@given(SIDES, SIDES, st.integers(10, 400), st.integers(10, 400))
def test_far_away_a_cell_acts_like_a_point_load(dx, dy, dj, di):
    distance = np.hypot(di * dx, dj * dy)
    exact = float(Influence(dx, dy, 1.0)(dj, di))
    # the first term left out is (d / r)^2 / 12 for the longer side d
    assert exact == pytest.approx(dx * dy / distance, rel=(max(dx, dy) / distance) ** 2 / 6 + 1e-7)


@given(SIDES, SIDES)
def test_exchanging_the_axes_transposes_the_influence(dx, dy):
    offsets = np.arange(6)
    one = Influence(dx, dy, 1.0)(offsets[:, None], offsets[None, :])
    other = Influence(dy, dx, 1.0)(offsets[:, None], offsets[None, :])
    np.testing.assert_allclose(one, other.T, rtol=ROUNDING, atol=ROUNDING * one.max())


def test_four_cells_add_up_to_one_of_twice_the_sides():
    fine, coarse = Influence(0.1, 0.07, 1.0), Influence(0.2, 0.14, 1.0)
    # seen from two coarse cells away: fine cells lie 3.5 and 4.5 of their sides off
    parts = sum(float(fine(dj, di)) for dj in (3.5, 4.5) for di in (3.5, 4.5))
    assert parts == pytest.approx(float(coarse(2, 2)), rel=ROUNDING)


def test_the_dense_matrix_of_half_a_domain_acts_like_the_full_one():
    numbers = contact_groups()
    half, full = (grid_of(9, 9, mirror=mirror) for mirror in (True, False))
    pressure = np.random.default_rng(1).random(half.shape)
    by_half = dense_matrix(half.shape, True, influence_of(half, numbers)) @ pressure.ravel()
    by_full = (
        dense_matrix(full.shape, False, influence_of(full, numbers)) @ half.unfold(pressure).ravel()
    )
    np.testing.assert_allclose(
        by_half.reshape(half.shape), by_full.reshape(full.shape)[4:], rtol=ROUNDING
    )


@given(SIDES, SIDES)
def test_a_table_equals_single_evaluations(dx, dy):
    influence = Influence(dx, dy, 1.3)
    called = influence(np.arange(7)[:, None], np.arange(9)[None, :])
    np.testing.assert_allclose(influence.table(7, 9), called, rtol=0, atol=ROUNDING * called.max())


@pytest.mark.parametrize("mirror", [True, False])
def test_the_dense_matrix_has_the_influence_of_each_node_on_each(mirror):
    influence = Influence(0.2, 0.15, 1.0)
    matrix = dense_matrix((3, 4), mirror, influence, (2, 3))
    for m, (j, i) in enumerate(np.ndindex(3, 4)):
        for n, (b, a) in enumerate(np.ndindex(3, 4)):
            expected = float(influence(2 * (j - b), 3 * (i - a)))
            expected += float(influence(2 * (j + b), 3 * (i - a))) if mirror and b else 0.0
            assert matrix[m, n] == pytest.approx(expected, rel=1e-9)
