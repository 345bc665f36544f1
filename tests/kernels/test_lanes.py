"""Raw arrays, records and lanes: compiled they compute what numpy does."""

from typing import NamedTuple

import numpy as np
import pytest
from numba import njit

from tehl.base.typing import Array, Records
from tehl.kernels.lanes import (
    LANES,
    any_of,
    greater,
    largest,
    lesser,
    log,
    lookup,
    power_of_two,
    root,
    truncate,
    where,
)
from tehl.kernels.raw import lanes, raw

CELL = np.dtype([("u", float, LANES), ("table", float, (3, LANES))])


class Parts(NamedTuple):
    """One of everything."""

    x: Array
    cells: Records
    flags: Array
    table: Array


def arithmetic(parts, out):
    """Every operation on lanes, one per row of the result."""
    parts, out = raw((parts, out))
    a, b, number = parts.x[0, lanes(0)], parts.x[1, lanes(3)], parts.x[1, 2]
    rows = lanes(8)
    out[0, rows] = a + b * number
    out[1, rows] = (a - 1) / (2.0 + abs(b))
    out[2, rows] = -a
    out[3, rows] = where((a > b) & (b <= number), root(abs(a)), log(abs(b)))
    out[4, rows] = lesser(a, number)
    out[5, rows] = greater(a, b)
    out[6, rows] = truncate(3.0 * a) * power_of_two(truncate(3.0 * a) + 6755399441055744.0)
    out[7, rows] = 1.5 if any_of(a == parts.x[0, lanes(0)]) and not any_of(a < -1e9) else 0.0
    out[8, rows] = largest(a) + a[3]
    first, second, third, fourth = lookup(parts.table, truncate(abs(b)))
    out[9, rows] = first + 10.0 * second + 100.0 * third + 1000.0 * fourth
    here, last = parts.cells[1], parts.cells.shape[0] - 1
    here.u = a * b
    parts.cells[last].u = 2.0
    here.table[2, lanes(0)] = here.u + parts.cells[last].u
    here.table[0, 5] = number
    out[10, rows] = here.table[2, lanes(0)] + parts.flags[1]
    row = parts.x[1]
    out[11, rows] = row[lanes(1)] + row.shape[0]


def inputs():
    random = np.random.default_rng(2)
    return Parts(
        x=random.uniform(-4.0, 4.0, (2, 12)),
        cells=np.zeros(3, CELL).view(np.recarray),
        flags=np.array([0, 1, 2], np.uint8),
        table=random.random((8, 2)),
    )


def test_compiled_lanes_compute_what_numpy_does():
    here, there, found, exact = inputs(), inputs(), np.zeros((12, 20)), np.zeros((12, 20))
    njit(arithmetic)(here, found)
    arithmetic(there, exact)
    np.testing.assert_allclose(found, exact, rtol=1e-14)
    assert found[:, 8:16].all()
    assert not found[:, :8].any()
    for name in CELL.names:
        np.testing.assert_allclose(here.cells[name], there.cells[name], rtol=1e-14)


def test_the_other_operand_is_taken_where_the_first_is_nan():
    @njit
    def both(x, out):
        x, out = raw((x, out))
        out[0, lanes(0)] = lesser(x[lanes(0)], 1.0)
        out[1, lanes(0)] = greater(x[lanes(0)], 1.0)

    out = np.zeros((2, LANES))
    both(np.full(LANES, np.nan), out)
    assert (out == 1.0).all()


def test_arrays_that_are_not_contiguous_are_refused():
    @njit
    def first(x):
        return raw(x)[0, 0]

    assert first(np.ones((2, 3))) == 1.0
    with pytest.raises(Exception, match="contiguous"):
        first(np.ones((2, 3)).T)
