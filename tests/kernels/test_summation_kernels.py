"""Steps of the multilevel summation against sums by definition.

A patch that reaches every source makes one halving exact, so the tests ask for round-off.
"""

import numpy as np
import pytest

from tehl.kernels import summation
from tehl.kernels.summation import Box
from tehl.operators.multilevel import Stage
from tests.kernels.interpreted import interpreted

WEIGHTS = np.array([3.0, -25.0, 150.0, 150.0, -25.0, 3.0]) / 256.0
OFFSETS = np.array([-5, -3, -1, 1, 3, 5])
PAD = 60


def kernel(rows, columns):
    """Smooth away from the origin, peaked at it; cells are not square."""
    return 1.0 / np.sqrt(0.3 + rows**2 + 0.49 * columns**2)


def box_of(j0, j1, i0, i1, mirror):
    box = Box(j0, j1, i0, i1, PAD - j0, PAD - i0, int(mirror))
    return box, np.zeros((j1 - j0 + 1 + 2 * PAD, i1 - i0 + 1 + 2 * PAD))


def influence_matrix(box, row_step, column_step):
    rows, columns = np.meshgrid(
        row_step * np.arange(box.j0, box.j1 + 1),
        column_step * np.arange(box.i0, box.i1 + 1),
        indexing="ij",
    )
    rows, columns = rows.ravel(), columns.ravel()
    across = columns[:, None] - columns
    matrix = kernel(rows[:, None] - rows, across)
    if box.mirror:
        matrix += np.where(rows > 0, kernel(rows[:, None] + rows, across), 0.0)
    return matrix


def loaded(box, u, p):
    """Sources of a grid, in the array ``u``."""
    stage = Stage(box=box, source=u, total=np.zeros_like(u))
    stage.load(p)
    return stage


def corrections(axis, reach, side):
    d, q = np.arange(reach + 1)[:, None], np.arange(side + 1)[None, :]

    def value(along):
        return kernel(along, q) if axis == 0 else kernel(q, along)

    interpolated = sum(w * value(d + k) for w, k in zip(WEIGHTS, OFFSETS, strict=True))
    missed = value(d) - interpolated
    return np.ascontiguousarray(missed if axis == 0 else missed.T)


def halved(last):
    """Coarse nodes needed to interpolate all nodes 0..last."""
    return -3, (last + 6) // 2


def sum_by_one_halving(p, axis, mirror):
    """Sum with one coarser grid and patches that leave nothing out."""
    ny, nx = p.shape
    fine, u = box_of(0, ny - 1, 0, nx - 1, mirror)
    finest = loaded(fine, u, p)
    farthest = 2 * ny + 8 if axis == 0 else nx + 8
    if axis == 0:
        first, last = halved(ny - 1)
        coarse, coarse_u = box_of(0 if mirror else first, last, 0, nx - 1, mirror)
        summation.gather_rows(u, fine, coarse_u, coarse)
        matrix = influence_matrix(coarse, 2, 1)
        table = corrections(0, farthest, nx)
    else:
        coarse, coarse_u = box_of(0, ny - 1, *halved(nx - 1), mirror)
        matrix = influence_matrix(coarse, 1, 2)
        table = corrections(1, farthest, 2 * ny)
        columns = summation.columns_of(table, u.shape, fine, coarse)
        summation.split_columns(u, fine, columns)
        summation.gather_columns(columns, fine, coarse_u, coarse)
    coarse_w = np.zeros_like(coarse_u)
    summation.direct(matrix, coarse_u, coarse, coarse_w, np.zeros(len(matrix)))
    if axis == 0:
        folds = summation.row_folds(table, fine)
        summation.spread_rows(u, table, folds, fine, coarse_w, coarse, finest.total)
    else:
        summation.spread_columns(columns, table, fine, coarse_w, coarse, finest.total)
    return finest.nodes(finest.total)


@pytest.mark.parametrize("mirror", [False, True])
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("shape", [(9, 13), (7, 10), (6, 9)])
def test_a_halving_with_complete_patches_equals_the_sum_by_definition(shape, axis, mirror):
    p = np.random.default_rng(1).random(shape)
    box, _ = box_of(0, shape[0] - 1, 0, shape[1] - 1, mirror)
    expected = (influence_matrix(box, 1, 1) @ p.ravel()).reshape(shape)
    np.testing.assert_allclose(sum_by_one_halving(p, axis, mirror), expected, rtol=1e-12)


def test_the_direct_sum_is_a_matrix_product():
    rng = np.random.default_rng(2)
    box, u = box_of(-1, 2, 0, 4, mirror=False)
    p, matrix = rng.random((4, 5)), rng.random((20, 20))
    u[PAD : PAD + 4, PAD : PAD + 5] = p
    w = np.zeros_like(u)
    summation.direct(matrix, u, box, w, np.zeros(20))
    total = w[PAD : PAD + 4, PAD : PAD + 5].ravel()
    np.testing.assert_allclose(total, matrix @ p.ravel(), rtol=1e-13)


def test_loading_sources_reflects_them_about_the_mirror_line():
    p = np.arange(12.0).reshape(3, 4)
    box, u = box_of(0, 2, 0, 3, mirror=True)
    loaded(box, u, p)
    np.testing.assert_array_equal(u[PAD - 2 : PAD + 3, PAD : PAD + 4], np.vstack([p[:0:-1], p]))
    assert u.sum() == p.sum() + p[1:].sum()


def test_gathering_keeps_the_total_of_the_sources():
    p = np.random.default_rng(3).random((11, 15))
    fine, u = box_of(0, 10, 0, 14, mirror=False)
    loaded(fine, u, p)
    coarse, coarse_u = box_of(*halved(10), 0, 14, mirror=False)
    summation.gather_rows(u, fine, coarse_u, coarse)
    np.testing.assert_allclose(coarse_u.sum(), p.sum(), rtol=1e-13)


def test_weighted_sums_of_rows_take_every_step_th_row():
    rng, weigh = np.random.default_rng(4), interpreted("summation").weigh
    rows, table = rng.random((10, 6)), rng.random((9, 3))
    for first, step in ((0, 1), (1, 2)):
        weigh(rows, table, 1, (first, step))
        np.testing.assert_allclose(rows[9], table[first::step, 1] @ rows[first:9:step], rtol=1e-13)
