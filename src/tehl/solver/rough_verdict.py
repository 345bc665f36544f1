"""What counts as a film between rough surfaces, and what is said of one that is none or open."""

import math
from dataclasses import replace

import numpy as np

from tehl.result import ErrorEstimate, Status
from tehl.solver.film_solver import FilmSolver
from tehl.solver.film_summary import film_summary
from tehl.solver.level import Level
from tehl.solver.suspects import Suspect, coarse_status

KNOWN = 0.5
"""Relative error of the minimum that the hint to a finer grid aims at."""
VAGUE = 1.0
"""Relative error of the minimum between rough surfaces, one spot beside an asperity, beyond which
no more is known of it than that it is thin: that is told, and the rest of the film may be good."""
BELOW_FLOOR = 0.5
"""Least film between rough surfaces over the floor of the conductance: an oil that flows as if it
were thicker is another one."""
LESS_ROUGH = "Take lower or longer asperities, more speed, or more nodes (numerics.points)."


def is_film(level: Level, errors: ErrorEstimate | None) -> bool:
    """Whether there is a film between rough surfaces, around the smallest node too.

    One a little below the floor of the conductance is one if that floor is within its error.
    """
    smallest, bar = float(level.film.h.min()), 0.0
    if errors is not None:
        bar = errors.discretisation_minimum
    within = (1.0 + bar) * smallest > level.equations.floor
    thick = smallest > BELOW_FLOOR * level.equations.floor
    return thick and within and film_summary(level.grid, level.film.h).minimum > 0.0


def vague_status(level: Level, error: float) -> Status:
    """Return the status of a film whose minimum is not known to within itself."""
    grid, (smallest, x, y) = level.grid, thinnest(level)
    times = 2 ** math.ceil(0.5 * math.log2(error / KNOWN))  # of second order
    return Status(
        kind="converged",
        message=(
            f"The minimum film, at X = {x:.3g}, Y = {y:.3g} (half-widths), is uncertain by "
            f"about {error:.1f} times itself on {grid.nx} x {grid.ny} nodes: no more is known of "
            f"it than that it is thin, about H = {(1.0 + error) * smallest:.2g} at most."
        ),
        hint=(
            "Take a finer grid if the minimum matters: at second order numerics.points = "
            f"{times * (max(grid.nx, grid.ny) - 1) + 1} would give it to within half of itself."
        ),
    )


def touching(run: FilmSolver, part: float) -> Status:
    """Return the status of a film that fails with ``part`` of the heights already."""
    status = no_film_status(run, run.errors())
    message = f"{status.message} The film shown has {100 * part:.0f} % of the heights."
    return replace(status, message=message)


def no_film_status(run: FilmSolver, errors: ErrorEstimate | None) -> Status:
    """Judge what is no film between asperities: they touch, or the grid cannot tell."""
    if errors is not None and errors.discretisation_minimum > VAGUE:
        status = coarse_status(run.finest.grid, run.groups, errors.discretisation_minimum)
        return replace(status, message=f"{status.message} {no_film(run.finest)}.")
    return asperity_contact(run.finest)


def no_film_before(run: FilmSolver) -> Suspect | None:
    """Blame the film of the grid before the finest, if it has all heights and is not positive."""
    if not run.has_no_film_before:
        return None
    level = run.levels[-2]
    smallest, x, y = thinnest(level)
    return Suspect(
        cause="grid_too_coarse",
        message=(
            f"The film of the grid before, of {level.grid.nx} x {level.grid.ny} nodes, is not "
            f"positive (smallest H = {smallest:.3g} at X = {x:.3g}, Y = {y:.3g} half-widths), and "
            "is no start for this one."
        ),
        hint=LESS_ROUGH,
    )


def thinnest(level: Level) -> tuple[float, float, float]:
    """Return the smallest film of a level, between its nodes too, and X and Y of it."""
    found = film_summary(level.grid, level.film.h)
    node = float(level.film.h.min())
    return (min(found.minimum, node), *found.minimum_at)


def no_film(level: Level) -> str:
    """Say what is wrong with the smallest film, and where."""
    smallest, x, y = thinnest(level)
    how = "not positive"
    if smallest > 0.0:
        how = f"thinner than H = {level.equations.floor:.2g}, the least that this grid lets flow"
    where = f"X = {x:.3g}, Y = {y:.3g} (half-widths)"
    return f"The film found is {how}: smallest H = {smallest:.3g} at {where}"


def asperity_contact(level: Level) -> Status:
    """Name the place where the film of rough surfaces fails."""
    grid, floor = level.grid, level.equations.floor
    thin = int(np.count_nonzero(level.film.h <= floor))
    return Status(
        kind="not_converged",
        cause="asperity_contact",
        message=(
            f"{no_film(level)}, on {grid.nx} x {grid.ny} nodes of which {thin} are below "
            f"H = {floor:.2g}. Asperities would touch there, which a film that carries all "
            "of the load cannot describe."
        ),
        hint=LESS_ROUGH,
    )
