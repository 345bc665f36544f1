"""Transfer between grids: full weighting, injection, bilinear interpolation of corrections.

Venner and Lubrecht 2000, chapters 3 and 6; docs/theory/numerics.md on cavitation.

Fine fields are (ny, nx), coarse ones ((ny+1)/2, (nx+1)/2) or as many along one axis; with
``mirror`` row 0 is a symmetry line and row -1 equals row 1.
"""

from tehl.base.typing import Array, FlagArray
from tehl.kernels.compiled import helper, kernel
from tehl.kernels.faces import CLOSED, WRAPPED
from tehl.kernels.raw import raw
from tehl.kernels.reynolds import clear, inner_end, row_above, row_below


@helper
def steps(fine: Array, coarse: Array) -> tuple[int, int]:
    """Return the rows and columns of ``fine`` per row and column of ``coarse``, one or two."""
    rows = 1 if fine.shape[0] == coarse.shape[0] else 2
    return rows, 1 if fine.shape[1] == coarse.shape[1] else 2


@helper
def beside(
    j: int, i: int, step: tuple[int, int], rows: tuple[int, int]
) -> tuple[int, int, int, int]:
    """Return the rows south and north and the columns west and east of a node.

    They are its own where none are left out. ``rows``: their number and ``mirror``.
    """
    ny, mirror = rows
    south, north = (j, j) if step[0] == 1 else (row_below(j, ny, mirror), row_above(j, ny, mirror))
    return south, north, i + 1 - step[1], i - 1 + step[1]


@helper
def _weigh(fine: Array, mirror: int, j: int, i: int, step: tuple[int, int]) -> float:
    """Full weighting of ``fine`` at fine node (j, i)."""
    south, north, west, east = beside(j, i, step, (fine.shape[0], mirror))
    return (
        0.25 * fine[j, i]
        + 0.125 * (fine[j, west] + fine[j, east] + fine[south, i] + fine[north, i])
        + 0.0625 * (fine[south, west] + fine[south, east] + fine[north, west] + fine[north, east])
    )


@kernel
def restrict_residual(fine: Array, mirror: int, coarse: Array) -> None:
    """Full weighting of the residual, zero on the edges."""
    fine, coarse = raw((fine, coarse))
    ny, nx = coarse.shape
    step = steps(fine, coarse)
    clear(coarse)
    for j in range(0 if mirror else 1, inner_end(ny, mirror)):
        for i in range(1, nx - 1):
            coarse[j, i] = _weigh(fine, mirror, step[0] * j, step[1] * i, step)


@kernel
def keep_residual(fine: Array, coarse: Array, mirror: int) -> None:
    """Enlarge residuals that full weighting would give to cavitated coarse nodes in part.

    All of an imbalance of the flux must reach the coarse film: where it begins, its pressure
    follows from the flux.

    Parameters
    ----------
    fine : array (ny, nx)
        Residual, changed in place.
    coarse : array (ny // 2 + 1, nx // 2 + 1)
        Pressure of the coarse grid.
    mirror : int
        1 if row 0 is the symmetry line.
    """
    fine, coarse = raw((fine, coarse))
    (ny, nx), step = fine.shape, steps(fine, coarse)
    for j in range(0 if mirror else 1, inner_end(ny, mirror)):
        low_j, high_j = j // step[0], j // step[0] + j % step[0]
        for i in range(1, nx - 1):
            low_i, high_i = i // step[1], i // step[1] + i % step[1]
            wet = 0.0
            for row in (low_j, high_j):
                for column in (low_i, high_i):
                    wet += 0.25 if coarse[row, column] > 0.0 else 0.0
            if wet > 0.0:
                fine[j, i] /= wet


@kernel
def restrict_pressure(fine: Array, mirror: int, coarse: Array) -> None:
    """Full weighting where all nine fine values are positive, injection elsewhere and on edges."""
    fine, coarse = raw((fine, coarse))
    (ny, nx), step = coarse.shape, steps(fine, coarse)
    for j in range(ny):
        for i in range(nx):
            fj, fi = step[0] * j, step[1] * i
            if j == inner_end(ny, mirror) or i == 0 or i == nx - 1 or (j == 0 and mirror == 0):
                coarse[j, i] = fine[fj, fi]
                continue
            # at the ends of a roller the pressure is steep: that of the end alone
            is_end = j == ny - 1 or (j == 0 and not mirror % CLOSED)
            near = (1, step[1]) if is_end and mirror < WRAPPED else step
            south, north, west, east = beside(fj, fi, near, (fine.shape[0], mirror))
            smallest = abs(fine[fj, fi])
            for row in (south, fj, north):
                for column in (west, fi, east):
                    smallest = min(smallest, abs(fine[row, column]))
            coarse[j, i] = _weigh(fine, mirror, fj, fi, near) if smallest > 0.0 else fine[fj, fi]


@kernel
def correct(
    p: Array, coarse: Array, before: Array, mirror: int, bounds: tuple[float, float, float]
) -> None:
    """Add a part of the bilinear interpolation of ``coarse - before`` to the wet nodes of ``p``.

    A node keeps its pressure if any coarse node around it was cavitated: no correction crosses the
    cavitation front.

    Parameters
    ----------
    p : array (ny, nx)
        Pressure of the fine grid.
    coarse, before : array (ny // 2 + 1, nx // 2 + 1)
        Pressure of the coarse grid, and its value before the coarse solve.
    mirror : int
        1 if row 0 is the symmetry line.
    bounds : (float, float, float)
        Factor on the correction; its largest size, over the pressure; least pressure, zero but
        where asperities carry: there an error of both together is one of the oil [-].
    """
    part, limit, least = bounds
    p, coarse, before = raw((p, coarse, before))
    (ny, nx), step = p.shape, steps(p, coarse)
    for j in range(0 if mirror else 1, inner_end(ny, mirror)):
        low_j = j // step[0]
        high_j = low_j + (j % step[0])
        for i in range(1, nx - 1):
            if p[j, i] == 0.0:
                continue
            low_i = i // step[1]
            high_i = low_i + (i % step[1])
            total = 0.0
            wet = True
            for row in (low_j, high_j):
                for column in (low_i, high_i):
                    if before[row, column] == 0.0:
                        wet = False
                    total += coarse[row, column] - before[row, column]
            if wet:
                largest = limit * abs(p[j, i])
                change = min(max(part * 0.25 * total, -largest), largest)
                p[j, i] = max(p[j, i] + change, least)


@kernel
def correct_fronts(
    p: Array, coarse: Array, before: Array, mirror: int, part: float, limit: float
) -> None:
    """Correct the nodes that have both wet and cavitated coarse nodes around them.

    Where a film begins downstream of a cavity its flux is given, not its pressure: it changes in
    proportion to the pressure of the wet coarse nodes. ``part`` and ``limit`` are the first two
    bounds of `correct`.
    """
    p, coarse, before = raw((p, coarse, before))
    (ny, nx), step = p.shape, steps(p, coarse)
    for j in range(0 if mirror else 1, inner_end(ny, mirror)):
        low_j, high_j = j // step[0], j // step[0] + j % step[0]
        for i in range(1, nx - 1):
            low_i, high_i = i // step[1], i // step[1] + i % step[1]
            total, known, wet = 0.0, 0.0, 0
            for row in (low_j, high_j):
                for column in (low_i, high_i):
                    if before[row, column] > 0.0:
                        total += coarse[row, column] - before[row, column]
                        known += before[row, column]
                        wet += 1
            if 0 < wet < 4:
                largest = min(limit, 1.0) * p[j, i]
                p[j, i] += min(max(part * total / known * p[j, i], -largest), largest)


@kernel
def freeze(
    fine: Array, fine_frozen: FlagArray, coarse: Array, mirror: int, limit: float, out: FlagArray
) -> None:
    """Mark coarse nodes below ``limit`` beside a cavity, whose pressure the coarse grid keeps.

    Beside a cavity: one of the nine fine nodes is cavitated or frozen.

    Parameters
    ----------
    fine, fine_frozen : array (ny, nx)
        Pressure and marks of the fine grid.
    coarse, out : array (ny // 2 + 1, nx // 2 + 1)
        Pressure and marks of the coarse grid.
    mirror : int
        1 if row 0 is the symmetry line.
    limit : float
        Largest pressure of a marked node [-].
    """
    fine, fine_frozen, coarse, out = raw((fine, fine_frozen, coarse, out))
    (ny, nx), step = coarse.shape, steps(fine, coarse)
    clear(out)
    for j in range(0 if mirror else 1, inner_end(ny, mirror)):
        for i in range(1, nx - 1):
            if coarse[j, i] > limit:
                continue
            fj, fi = step[0] * j, step[1] * i
            south, north, west, east = beside(fj, fi, step, (fine.shape[0], mirror))
            for row in (south, fj, north):
                for column in (west, fi, east):
                    if fine[row, column] == 0.0 or fine_frozen[row, column]:
                        out[j, i] = 1
