"""The grids of full multigrid for a contact, coarsest first."""

import math

from tehl.estimate.grid import Grid, coarsest_of, halved_grids, has_long_cells, long_grids
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.summits import shared_load

LEAST_GRIDS, LARGEST_DENSE = 3, 65
"""Grids that are kept, and most nodes along x of the coarsest, whose matrix is dense, where a wide
domain makes the coarsest grid too coarse for the pressure: its load then depends on the rigid
approach in another way, and the cycles diverge."""
LINE_COARSEST, ROLLER_COARSEST, LINE_DENSE = 0.15, 0.09, 129
"""Of a line contact and of a roller: mesh width of the coarsest grid over that of others, and most
nodes. From 0.1 half-widths on cycles of rollers diverge with a wedge of third order (M = 70). The
pressure bends the bodies far away, and a grid on which it has few nodes does not correct that: with
0.6 half-widths the cycles stall at 1e-5 (M = 40 to 240)."""


def levels_of(finest: Grid, scaled: ScaledProblem) -> tuple[list[Grid], bool]:
    """Return the grids of full multigrid, coarsest first, and whether their cells are long.

    Parameters
    ----------
    finest, scaled : Grid, ScaledProblem
        The grid of the result, and the contact: where film or asperities are thick, the coarsest
        grid may be coarser.
    """
    shape, ellipticity = scaled.groups.shape, scaled.groups.ellipticity
    high = scaled.problem.asperity_rms / scaled.scales.film_thickness
    # of the parabolic gap, where film or asperities are thick
    widest = max(1.0, math.sqrt(2.0 * max(shared_load(scaled).gap, high)))
    dense = LARGEST_DENSE
    if shape.as_line:
        widest *= ROLLER_COARSEST if finest.is_closed else LINE_COARSEST
        widest *= shape.widest
        dense = LINE_DENSE
    touches = scaled.problem.asperities is not None
    if has_long_cells(finest, ellipticity, touches=touches):
        return long_grids(finest, coarsest_of(finest, widest, goes_on=shape.goes_on)), True
    grids = halved_grids(finest)
    while grids[0].dx > widest and len(grids) > LEAST_GRIDS and grids[1].nx <= dense:
        del grids[0]
    return grids, False
