"""Multilevel multi-integration of the deflection: O(n log n) with local corrections.

The sum is done on ever coarser grids, halving one axis at a time; sources go down by the transpose
of sixth-order interpolation, sums come back by interpolation, and a patch of sources around each
node puts right what interpolation of the kernel gets wrong near its singularity (Brandt and
Lubrecht, J. Comput. Phys. 90, 1990). The patch grows on coarser grids, because an error made there
weighs as much as one made on the finest.
"""

from dataclasses import dataclass

import numpy as np

from tehl.grid import Grid
from tehl.kernels import summation
from tehl.kernels.summation import Box
from tehl.operators.influence import Influence, dense_matrix
from tehl.typing import Array

ALONG, ACROSS = 8, 2
"""Patch half-widths on the finest grid, along the axis that is halved and across it."""
SMALLEST = 400
"""Nodes at which the sum is done by definition."""
PAD = 24
STEPS = (1, 3, 5)
WEIGHTS = (150.0 / 256.0, -25.0 / 256.0, 3.0 / 256.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Stage:
    """One grid of the summation: where its nodes lie, its sources and its sums."""

    box: Box
    source: Array
    total: Array


@dataclass(frozen=True, kw_only=True, slots=True)
class Halving:
    """One step to a coarser grid: the axis (0: rows, 1: columns) and the patch corrections."""

    axis: int
    patch: Array
    even: Array
    odd: Array


class MultilevelDeformation:
    """Deflection by multilevel multi-integration.

    Parameters
    ----------
    grid : Grid
        Where the pressure lives.
    influence : Influence
        Influence at (row, column) offsets of the finest grid.
    """

    def __init__(self, grid: Grid, influence: Influence) -> None:
        ny, nx = grid.shape
        self.stages = [stage(0, ny - 1, 0, nx - 1, grid.mirror)]
        self.halvings: list[Halving] = []
        stride, halved = [1, 1], [0, 0]
        while _count(self.stages[-1].box) > SMALLEST:
            axis = finer_axis(influence, stride)
            patch = patch_corrections(influence, (axis, stride[0], stride[1]), halved[axis])
            columns = self.stages[-1].source.shape[1] // 2 + 2
            shape = (self.stages[-1].source.shape[0], columns) if axis == 1 else (0, 0)
            self.halvings.append(
                Halving(axis=axis, patch=patch, even=np.zeros(shape), odd=np.zeros(shape))
            )
            self.stages.append(coarser(self.stages[-1].box, axis))
            stride[axis] *= 2
            halved[axis] += 1
        last = self.stages[-1].box
        nodes = (last.j1 - last.j0 + 1, last.i1 - last.i0 + 1)
        self.matrix = dense_matrix(nodes, grid.mirror, influence, (stride[0], stride[1]))

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``."""
        stages, halvings = self.stages, self.halvings
        summation.load(pressure, stages[0].source, stages[0].box)
        for halving, fine, coarse in zip(halvings, stages, stages[1:], strict=False):
            gather(halving, fine, coarse)
        last = stages[-1]
        summation.direct(self.matrix, last.source, last.box, last.total)
        for halving, fine, coarse in reversed(
            list(zip(halvings, stages, stages[1:], strict=False))
        ):
            spread(halving, fine, coarse)
        summation.unload(stages[0].total, stages[0].box, out)


def finer_axis(influence: Influence, stride: list[int]) -> int:
    """Return the axis to halve: that of the smaller mesh width, so that the patch covers enough.

    What interpolation along an axis misses falls off with the distance in mesh widths of that
    axis; across it the patch then needs no more nodes.
    """
    return int(influence.dy * stride[0] > 1.001 * influence.dx * stride[1])


def gather(halving: Halving, fine: Stage, coarse: Stage) -> None:
    """Send the sources of ``fine`` to ``coarse``."""
    if halving.axis == 0:
        summation.gather_rows(fine.source, fine.box, coarse.source, coarse.box)
        return
    summation.split_columns(fine.source, fine.box, halving.even, halving.odd)
    summation.gather_columns(halving.even, halving.odd, fine.box, coarse.source, coarse.box)


def spread(halving: Halving, fine: Stage, coarse: Stage) -> None:
    """Bring the sums of ``coarse`` back to ``fine``, corrected near each node."""
    if halving.axis == 0:
        summation.spread_rows(
            fine.source, halving.patch, fine.box, coarse.total, coarse.box, fine.total
        )
        return
    summation.spread_columns(
        halving.even, halving.odd, halving.patch, fine.box, coarse.total, coarse.box, fine.total
    )


def stage(j0: int, j1: int, i0: int, i1: int, mirror: bool) -> Stage:
    """Return an empty grid of nodes j0..j1 by i0..i1 in padded arrays."""
    box = Box(j0, j1, i0, i1, PAD - j0, PAD - i0, int(mirror))
    shape = (box.oy + j1 + PAD + 1, box.ox + i1 + PAD + 1)
    return Stage(box=box, source=np.zeros(shape), total=np.zeros(shape))


def coarser(box: Box, axis: int) -> Stage:
    """Return the grid with ``axis`` halved, wide enough to interpolate every node of ``box``."""
    if axis == 1:
        return stage(box.j0, box.j1, *_halved(box.i0, box.i1), mirror=bool(box.mirror))
    first, last = _halved(box.j0, box.j1)
    return stage(0 if box.mirror else first, last, box.i0, box.i1, mirror=bool(box.mirror))


def _halved(first: int, last: int) -> tuple[int, int]:
    """Coarse nodes that the odd nodes of first..last are interpolated from."""
    lowest_odd, highest_odd = first + (first + 1) % 2, last - (last + 1) % 2
    return min((lowest_odd - 5) // 2, -(-first // 2)), max((highest_odd + 5) // 2, last // 2)


def _count(box: Box) -> int:
    return (box.j1 - box.j0 + 1) * (box.i1 - box.i0 + 1)


def patch_corrections(influence: Influence, step: tuple[int, int, int], growth: int) -> Array:
    """Return what the interpolated kernel misses at distance d along and q across the axis.

    Parameters
    ----------
    influence : Influence
        Influence at offsets of the finest grid.
    step : (axis, row stride, column stride)
        The axis that is halved and the strides of this grid on the finest one.
    growth : int
        Nodes added to both half-widths of the patch.
    """
    axis, row_stride, column_stride = step
    nodes = np.arange(ALONG + growth + 1)
    along = np.arange(ALONG + growth + STEPS[-1] + 1.0)[:, None]
    across = np.arange(ACROSS + growth + 1.0)[None, :]
    rows, columns = (along, across) if axis == 0 else (across, along)
    kernel = influence(rows * row_stride, columns * column_stride)
    missed = kernel[nodes]
    for k, w in zip(STEPS, WEIGHTS, strict=True):
        missed -= w * (kernel[nodes + k] + kernel[np.abs(nodes - k)])
    return np.ascontiguousarray(missed)
