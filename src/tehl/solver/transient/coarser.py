"""A film in time on a grid of half the nodes: what a run has at the nodes that both grids have."""

import numpy as np

from tehl.base.typing import Array
from tehl.operators.energy import FilmState
from tehl.operators.transfer import injected
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.start import pose_problem


def go_coarser(solver: FilmSolver) -> None:
    """Make the next coarser level the finest one, with the film of that at its nodes.

    Parameters
    ----------
    solver : FilmSolver
        Of a line, with two levels or more.
    """
    fine = solver.levels.pop()
    coarse, coupling = solver.finest, solver.coupling
    pressure, rigid, asperity = fine.state()
    pose_problem(coarse)
    if coupling.film is not None and coupling.state is not None and coarse.factors is not None:
        state = FilmState(
            coarse.grid, coupling.film, coupling.wedge_order, thorough=coupling.thorough
        )
        state.sweeps = coupling.state.sweeps
        for mine, theirs in zip(state.fields, coupling.state.fields, strict=True):
            if len(mine) > 1:  # those of time steps are still to come
                mine[:] = at_nodes(theirs, mine.shape, fine.grid.nx)
        coupling.take(solver.levels, (state, coarse.factors))
    coarse.set_state(injected(pressure, pressure[:, ::2]), rigid, asperity)
    coarse.update()


def at_nodes(field: Array, shape: tuple[int, ...], nodes: int) -> Array:
    """Return a field at the nodes of a coarser grid.

    Parameters
    ----------
    field : Array
        One axis may have ``nodes`` along x, and as many nodes beyond either edge.
    shape : tuple of int
        Its shape on the coarser grid, with half the intervals.
    nodes : int
        Along x.
    """
    fewer = (nodes - 1) // 2 + 1
    for axis, (many, few) in enumerate(zip(field.shape, shape, strict=True)):
        if many != few:
            beyond = (many - nodes) // 2
            at = beyond + 2 * (np.arange(few) - (few - fewer) // 2)
            field = field.take(np.clip(at, 0, many - 1), axis)
    return field
