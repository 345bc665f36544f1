"""Compiled transfer between grids: full weighting, injection, guarded bilinear correction.

Fine fields are (ny, nx), coarse ones ((ny+1)/2, (nx+1)/2); with ``mirror`` row 0 is a symmetry
line and row -1 equals row 1.
"""

from numba import njit

from tehl.typing import Array, FlagArray


@njit(cache=True)
def weigh(fine: Array, j: int, i: int) -> float:
    """Full weighting of ``fine`` at fine node (j, i)."""
    south = j - 1 if j > 0 else 1
    return (
        0.25 * fine[j, i]
        + 0.125 * (fine[j, i - 1] + fine[j, i + 1] + fine[south, i] + fine[j + 1, i])
        + 0.0625
        * (fine[south, i - 1] + fine[south, i + 1] + fine[j + 1, i - 1] + fine[j + 1, i + 1])
    )


@njit(cache=True)
def restrict_residual(fine: Array, mirror: int, coarse: Array) -> None:
    """Full weighting of the residual, zero on the edges."""
    ny, nx = coarse.shape
    coarse[:] = 0.0
    for j in range(0 if mirror else 1, ny - 1):
        for i in range(1, nx - 1):
            coarse[j, i] = weigh(fine, 2 * j, 2 * i)


@njit(cache=True)
def restrict_pressure(fine: Array, mirror: int, coarse: Array) -> None:
    """Full weighting where all nine fine values are positive, injection elsewhere."""
    ny, nx = coarse.shape
    coarse[:] = 0.0
    for j in range(0 if mirror else 1, ny - 1):
        for i in range(1, nx - 1):
            fj, fi = 2 * j, 2 * i
            south = fj - 1 if fj > 0 else 1
            smallest = fine[fj, fi]
            for row in (south, fj, fj + 1):
                for column in range(fi - 1, fi + 2):
                    smallest = min(smallest, fine[row, column])
            coarse[j, i] = weigh(fine, fj, fi) if smallest > 0.0 else fine[fj, fi]


@njit(cache=True)
def correct(p: Array, coarse: Array, before: Array, mirror: int, part: float, limit: float) -> None:
    """Add ``part`` of the bilinear interpolation of ``coarse - before`` to the wet nodes of ``p``.

    A node is left alone when any coarse node it would use was cavitated: no correction crosses
    the cavitation front. None changes by more than ``limit`` times its pressure.
    """
    ny, nx = p.shape
    for j in range(0 if mirror else 1, ny - 1):
        low_j = j // 2
        high_j = low_j + (j % 2)
        for i in range(1, nx - 1):
            if p[j, i] <= 0.0:
                continue
            low_i = i // 2
            high_i = low_i + (i % 2)
            total = 0.0
            wet = True
            for row, column in (
                (low_j, low_i),
                (low_j, high_i),
                (high_j, low_i),
                (high_j, high_i),
            ):
                if before[row, column] <= 0.0:
                    wet = False
                total += coarse[row, column] - before[row, column]
            if wet:
                largest = limit * p[j, i]
                change = min(max(part * 0.25 * total, -largest), largest)
                p[j, i] = max(p[j, i] + change, 0.0)


@njit(cache=True)
def freeze(
    fine: Array, fine_frozen: FlagArray, coarse: Array, mirror: int, limit: float, out: FlagArray
) -> None:
    """Mark coarse nodes beside a cavity and of low pressure: they keep it on the coarse grid.

    Beside a cavity: one of the nine fine nodes is cavitated or frozen itself.
    """
    ny, nx = coarse.shape
    out[:] = 0
    for j in range(0 if mirror else 1, ny - 1):
        for i in range(1, nx - 1):
            if coarse[j, i] > limit:
                continue
            fj, fi = 2 * j, 2 * i
            for row in (fj - 1 if fj > 0 else 1, fj, fj + 1):
                for column in range(fi - 1, fi + 2):
                    if fine[row, column] <= 0.0 or fine_frozen[row, column]:
                        out[j, i] = 1
