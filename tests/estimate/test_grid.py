"""Grids and their halved_grids."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tehl.contact.options import Domain
from tehl.estimate.grid import (
    LEAST_LINES,
    Grid,
    can_mirror,
    coarsest_of,
    crowding,
    halved_grids,
)
from tests.reference import DOMAIN

COARSENABLE = st.builds(lambda n, k: n * 2**k + 1, st.integers(16, 31), st.integers(1, 4))


def grid(nx: int, ny: int, *, mirror: bool = True, domain: Domain = DOMAIN) -> Grid:
    return Grid(nx=nx, ny=ny, domain=domain, mirror=mirror)


def test_nodes_span_the_domain_and_the_mirrored_half_starts_on_the_axis():
    half, full = grid(129, 65), grid(129, 65, mirror=False)
    assert (full.x[0], full.x[-1]) == pytest.approx((-4.5, 1.5))
    assert (full.y[0], full.y[-1]) == pytest.approx((-3.0, 3.0))
    assert half.y[0] == 0.0
    np.testing.assert_allclose(half.y, full.y[32:], atol=1e-14)
    assert half.shape == (33, 129)


@given(COARSENABLE, COARSENABLE)
def test_each_grid_keeps_every_second_node_of_the_finer_one(nx, ny):
    full = grid(nx, ny, mirror=False)
    levels = halved_grids(full)
    assert levels[-1] is full
    for coarse, fine in pairwise(levels):
        np.testing.assert_allclose(coarse.x, fine.x[::2], atol=1e-12)
        np.testing.assert_allclose(coarse.y, fine.y[::2], atol=1e-12)


@given(COARSENABLE, COARSENABLE)
def test_every_mirrored_grid_has_a_row_on_the_axis(nx, ny):
    for level in halved_grids(grid(nx, ny)):
        assert (level.ny - 1) % 2 == 0
        assert level.shape[0] == (level.ny - 1) // 2 + 1


@given(COARSENABLE)
def test_unfolding_a_half_gives_a_symmetric_field(points):
    half = grid(points, points)
    field = np.random.default_rng(points).random(half.shape)
    full = half.unfold(field)
    np.testing.assert_array_equal(full, full[::-1])
    np.testing.assert_array_equal(full[half.shape[0] - 1 :], field)


def test_a_field_of_the_full_domain_unfolds_to_a_copy_of_itself():
    full = grid(17, 17, mirror=False)
    field = np.ones(full.shape)
    assert full.unfold(field) is not field
    np.testing.assert_array_equal(full.unfold(field), field)


def test_only_a_symmetric_domain_is_mirrored():
    assert can_mirror((129, 129), DOMAIN)
    assert not can_mirror((129, 129), Domain(x=(-4.5, 1.5), y=(-3.0, 2.5)))


def test_the_coarsest_grid_has_sixteen_to_thirty_one_intervals():
    assert [g.nx for g in halved_grids(grid(513, 513))] == [17, 33, 65, 129, 257, 513]
    assert halved_grids(grid(49 * 4 - 3, 193))[0].nx == 25


@pytest.mark.parametrize(("nx", "coarsest"), [(193, (25, 25)), (257, (17, 33)), (321, (21, 41))])
def test_long_cells_are_halved_to_a_matrix_of_a_few_hundred_nodes(nx, coarsest):
    found = coarsest_of(grid(nx, nx // 2 + 1), 1.0)
    assert found.points == coarsest
    assert found.shape[0] > LEAST_LINES


def test_lines_that_crowd_are_not_halved_to_few():
    finest = replace(grid(257, 129), crowding=2.0)
    assert coarsest_of(finest, 0.2).points == (33, 65)
    assert coarsest_of(replace(finest, nx=65, ny=65), 0.2).points == (33, 33)  # the third for bars


@pytest.mark.parametrize("mirror", [True, False])
def test_lines_crowd_at_the_ends_of_a_roller(mirror):
    ends = Domain.model_construct(x=(-3.0, 1.5), y=(-1.0, 1.0))
    part = 0.05
    lines = Grid(nx=33, ny=129, domain=ends, mirror=mirror, crowding=crowding(part))
    y = lines.y
    assert y[-1] - y[-2] == pytest.approx(part * lines.dy, rel=0.1)
    np.testing.assert_allclose(lines.coarser().y, y[::2], atol=1e-14)
    assert lines.widths.sum() == pytest.approx(2.0)
    # second differences of a parabola are exact, at ends and on the symmetry line too
    south, north = lines.across
    parabola = 0.5 * (y**2 if mirror else (y + 1.0) ** 2)
    below, above = np.append(parabola[1], parabola[:-1]), np.append(parabola[1:], parabola[-2])
    found = (south * (below - parabola) + north * (above - parabola)) / lines.dy**2
    np.testing.assert_allclose(found[:-1], 1.0, rtol=1e-9)
    towards_end = 0.5 * (1.0 - y) ** 2
    below = towards_end[-2] - towards_end[-1]
    assert (south[-1] + north[-1]) * below / lines.dy**2 == pytest.approx(1.0)


def test_lines_crowd_where_the_loaded_part_of_a_roller_ends():
    ends = Domain.model_construct(x=(-3.0, 1.5), y=(-1.0, 1.0))
    part, edges = 0.1, (0.9, 0.5)
    c = crowding(part, edges)
    lines = Grid(nx=33, ny=257, domain=ends, mirror=False, crowding=c, edges=edges)
    y, steps = lines.y, np.diff(lines.y)
    assert y[[0, 128, -1]].tolist() == [-1.0, 0.0, 1.0]
    np.testing.assert_allclose(lines.coarser().y, y[::2], atol=1e-12)
    for edge in (-0.9, 0.5):
        near = steps[np.abs(y[1:] - edge) < 0.03]
        assert near.min() < 1.3 * part * lines.dy
        assert near.min() < 0.2 * steps.max()
    outside = (y > 0.5).sum() / ((y > -0.4) & (y < 0.5)).sum()  # most lines are where load is
    assert outside < 0.6
    even, s = replace(lines, edges=(1.0, 1.0)), np.linspace(-1.0, 1.0, 257)
    width = 1.0 / np.tanh(c) - 1.0
    number = np.arcsinh((1.0 + even.y) / width) - np.arcsinh((1.0 - even.y) / width)
    np.testing.assert_allclose(number, np.arcsinh(2.0 / width) * s, atol=1e-9)
    # distances hardly change where the film is thinnest: by (1 + 0.5^2)^(1/2) = 1.12, and a little
    # by the other end
    for found in (lines, even):
        steps, places = np.diff(found.y), 0.5 * (found.y[1:] + found.y[:-1])
        inside = found.edges[1] - places
        near = steps[(inside > 0.0) & (inside < 0.5 * width)]
        assert near.size > 3
        assert near.max() < 1.2 * near.min()


@pytest.mark.parametrize("edges", [(1.0, 1.0), (0.9, 0.5)])
def test_waves_limit_how_far_apart_lines_that_crowd_are(edges):
    ends = Domain.model_construct(x=(-3.0, 1.5), y=(-1.0, 1.0))
    c = crowding(0.02, edges, most_apart=1.7)
    lines = Grid(nx=33, ny=513, domain=ends, mirror=False, crowding=c, edges=edges)
    assert lines.largest_dy == pytest.approx(1.7 * lines.dy, rel=0.01)
    assert crowding(0.02, edges) > c
    assert crowding(0.02, edges, most_apart=0.9) == 0.0
