"""Multilevel multi-integration (MLMI) of the elastic deflection in O(n log n) operations.

Brandt and Lubrecht, J. Comput. Phys. 90, 1990. The kernel is smooth except near its singularity, so
the sum  w = K P  is evaluated on a coarser grid and corrected locally:

    P_c = I^T P,   w_c = K_c P_c,   w = I w_c + (K - I K_c I^T) P,

with sixth-order interpolation I along one axis at a time, K_c the kernel at the coarse nodes, and
the correction K - I K_c I^T restricted to a patch around each node. The patch grows on coarser
grids, because an error made there contributes as much as one made on the finest.
"""

from dataclasses import dataclass

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.kernels import summation
from tehl.kernels.summation import Box
from tehl.operators.influence import Influence, dense_matrix

ALONG, ACROSS = 8, 2
"""Patch half-widths on the finest grid, along the axis that is halved and across it."""
LUMPING_DISTANCE = 40
"""Nodes beyond the patch of which the corrections are lumped."""
PAD = 24
"""Ghost rows and columns of the work arrays on each side."""
STEPS = (1, 3, 5)
WEIGHTS = (150.0 / 256.0, -25.0 / 256.0, 3.0 / 256.0)
"""Sixth-order interpolation of a midpoint: offsets to both sides, in fine mesh widths, weights."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Stage:
    """One grid of the summation: range of its nodes, sources, and sums."""

    box: Box
    source: Array
    total: Array

    def nodes(self, array: Array) -> Array:
        """Return the part of a padded array from node (0, 0) to the last node."""
        box = self.box
        return array[box.oy : box.oy + box.j1 + 1, box.ox : box.ox + box.i1 + 1]

    def load(self, pressure: Array) -> None:
        """Copy nodal sources, with their image before a mirror line."""
        self.nodes(self.source)[:] = pressure
        if self.box.mirror:
            below = self.source[: self.box.oy]
            below[:] = self.source[2 * self.box.oy : self.box.oy : -1]


@dataclass(frozen=True, slots=True)
class RowHalving:
    """A step to a grid of half the rows, with the patch corrections (rows, columns)."""

    patch: Array
    folds: Array

    def gather(self, fine: Stage, coarse: Stage) -> None:
        """Restrict the sources: P_c = I^T P.

        Parameters
        ----------
        fine : Stage
            Grid whose ``source`` is read.
        coarse : Stage
            Grid with half the rows; its ``source`` is overwritten.
        """
        summation.gather_rows(fine.source, fine.box, coarse.source, coarse.box)

    def spread(self, fine: Stage, coarse: Stage) -> None:
        """Interpolate the sums and add the patch corrections: w = I w_c + (K - I K_c I^T) P.

        Parameters
        ----------
        fine : Stage
            Grid whose ``total`` is overwritten, from its ``source`` and the coarse sums.
        coarse : Stage
            Grid with half the rows, with its ``total``.
        """
        grids = (fine.box, coarse.total, coarse.box, fine.total)
        summation.spread_rows(fine.source, self.patch, self.folds, *grids)


@dataclass(frozen=True, slots=True)
class ColumnHalving:
    """A step to a grid of half the columns, with the patch corrections (rows, columns)."""

    patch: Array
    columns: summation.Columns

    def gather(self, fine: Stage, coarse: Stage) -> None:
        """Restrict the sources: P_c = I^T P."""
        summation.split_columns(fine.source, fine.box, self.columns)
        summation.gather_columns(self.columns, fine.box, coarse.source, coarse.box)

    def spread(self, fine: Stage, coarse: Stage) -> None:
        """Interpolate the sums and add the patch corrections: w = I w_c + (K - I K_c I^T) P."""
        grids = (fine.box, coarse.total, coarse.box, fine.total)
        summation.spread_columns(self.columns, self.patch, *grids)


def _halve(patch: Array, axis: int, fine: Stage, coarse: Stage) -> RowHalving | ColumnHalving:
    """Return the step from ``fine`` to ``coarse``, which has half the nodes along ``axis``."""
    if axis == 0:
        return RowHalving(patch, summation.row_folds(patch, fine.box))
    columns = summation.columns_of(patch, fine.source.shape, fine.box, coarse.box)
    return ColumnHalving(patch, columns)


class MultilevelDeformation:
    """Elastic deflection by multilevel multi-integration.

    Parameters
    ----------
    grid : Grid
        Grid of the pressure.
    influence : Influence
        Influence at (row, column) offsets of the finest grid.
    """

    def __init__(self, grid: Grid, influence: Influence) -> None:
        ny, nx = grid.shape
        self.stages = [_stage(0, ny - 1, 0, nx - 1, grid.mirror)]
        self.halvings: list[RowHalving | ColumnHalving] = []
        stride, halved = [1, 1], [0, 0]
        while _count(self.stages[-1].box) > 400:  # a sum over fewer is direct
            axis, fine = _finer_axis(influence, stride), self.stages[-1]
            # an error on a coarse grid weighs as much as one on the finest: the patch grows,
            # within the ghost rows
            growth = min(2 * halved[axis], 10)
            patch = _patch_corrections(influence, (axis, stride[0], stride[1]), growth)
            self.stages.append(_coarser(fine.box, axis))
            self.halvings.append(_halve(patch, axis, fine, self.stages[-1]))
            stride[axis] *= 2
            halved[axis] += 1
        last = self.stages[-1].box
        nodes = (last.j1 - last.j0 + 1, last.i1 - last.i0 + 1)
        self.matrix = dense_matrix(nodes, grid.mirror, influence, (stride[0], stride[1]))
        self.flat = np.zeros(nodes[0] * nodes[1])

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``."""
        finest, last = self.stages[0], self.stages[-1]
        finest.load(pressure)
        steps = list(zip(self.halvings, self.stages[:-1], self.stages[1:], strict=True))
        for halving, fine, coarse in steps:
            halving.gather(fine, coarse)
        summation.direct(self.matrix, last.source, last.box, last.total, self.flat)
        for halving, fine, coarse in reversed(steps):
            halving.spread(fine, coarse)
        out[:] = finest.nodes(finest.total)


def _finer_axis(influence: Influence, stride: list[int]) -> int:
    """Return the axis with the smaller mesh width, which is halved next.

    The interpolation error along an axis decays with the distance in mesh widths of that axis; this
    choice keeps the patch narrow across it.
    """
    return int(influence.dy * stride[0] > 1.001 * influence.dx * stride[1])


def _stage(j0: int, j1: int, i0: int, i1: int, mirror: bool) -> Stage:
    """Return an empty grid of nodes j0..j1 by i0..i1 in padded arrays."""
    box = Box(j0, j1, i0, i1, PAD - j0, PAD - i0, int(mirror))
    shape = (box.oy + j1 + PAD + 1, box.ox + i1 + PAD + 1)
    return Stage(box=box, source=np.zeros(shape), total=np.zeros(shape))


def _coarser(box: Box, axis: int) -> Stage:
    """Return the grid with ``axis`` halved, large enough to interpolate every node of ``box``."""
    if axis == 1:
        return _stage(box.j0, box.j1, *_halved(box.i0, box.i1), mirror=bool(box.mirror))
    first, last = _halved(box.j0, box.j1)
    return _stage(0 if box.mirror else first, last, box.i0, box.i1, mirror=bool(box.mirror))


def _halved(first: int, last: int) -> tuple[int, int]:
    """Return the range of coarse nodes from which the odd nodes of first..last are interpolated."""
    lowest_odd, highest_odd = first + (first + 1) % 2, last - (last + 1) % 2
    return min((lowest_odd - 5) // 2, -(-first // 2)), max((highest_odd + 5) // 2, last // 2)


def _count(box: Box) -> int:
    return (box.j1 - box.j0 + 1) * (box.i1 - box.i0 + 1)


def _patch_corrections(influence: Influence, step: tuple[int, int, int], growth: int) -> Array:
    """Return the kernel less its interpolation at offsets along and across the halved axis.

    ``step`` is that axis, and the strides along rows and columns of this grid on the finest one;
    ``growth`` nodes are added to both half-widths of the patch, by which the corrections are.
    """
    axis, row_stride, column_stride = step
    reach, width = ALONG + growth + 1, ACROSS + growth + 1
    nodes = np.arange(reach + LUMPING_DISTANCE)
    along = np.arange(nodes.size + STEPS[-1] + 0.0)[:, None]
    across = np.arange(width + LUMPING_DISTANCE + 0.0)[None, :]
    rows, columns = (along, across) if axis == 0 else (across, along)
    kernel = influence(rows * row_stride, columns * column_stride)
    missed = kernel[nodes]
    for k, w in zip(STEPS, WEIGHTS, strict=True):
        missed -= w * (kernel[nodes + k] + kernel[np.abs(nodes - k)])
    patch = _lumped(missed, reach, width)
    return np.ascontiguousarray(patch if axis == 0 else patch.T)


def _lumped(missed: Array, reach: int, width: int) -> Array:
    """Return the patch, with the sum of what is outside at its middle.

    Even and odd offsets apart: each connects nodes of another parity, and for smooth sources what
    is left out would be a ripple of the deflection from node to node, which the pressure of a stiff
    contact must balance.
    """
    # both signs of an offset
    counts = np.outer(*(np.where(np.arange(n) > 0, 2.0, 1.0) for n in missed.shape))
    outside = missed * counts
    outside[:reach, :width] = 0.0
    patch = missed[:reach, :width].copy()
    patch[0, 0] += outside[::2].sum()
    patch[1, 0] += 0.5 * outside[1::2].sum()
    return patch
