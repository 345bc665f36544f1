"""Stress below a surface in a transient run, at each of its stored fields."""

from dataclasses import dataclass

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.stress import Stress
from tehl.post.stress.below import Case, Grid, March, poisson_ratio
from tehl.post.stress.loads import SurfaceLoads, parts_of_cells
from tehl.post.stress.measures import Worst, largest_shear
from tehl.post.stress.window import cut, depths_of, middle_row, window_of
from tehl.post.traction import LARGEST_CREDIBLE, sliding_direction, slope_across
from tehl.post.transient import film_at
from tehl.result.transient import TransientSolution


@dataclass(frozen=True, kw_only=True, slots=True)
class MovingStress:
    """Largest shear stresses below one surface over time."""

    time: Array
    """(nf,): Of the fields [s]."""
    depth: Array
    x: Array
    """(nz,) and (nx,): Of the plane y = 0 [m]."""
    plane: Array
    """(nf, nz, nx): Largest shear stress on y = 0 [Pa]."""
    shear: Array
    von_mises: Array
    """(nf, nz): Largest at each depth, anywhere in the plane of the film [Pa]."""


def moving_stress(
    run: TransientSolution, body: int = 1, settings: Stress | None = None
) -> MovingStress:
    """Return the stress below a surface at each stored field of a transient run.

    Parameters
    ----------
    run : TransientSolution
        With fields stored by ``transient.frames``.
    body : {1, 2}
        Below which surface.
    settings : Stress or None
        The table ``[stress]``; that of the case by default, or the defaults.

    Raises
    ------
    InputError
        If the run has no stored fields, or there is no such body.
    """
    frames, start = run.frames, run.start
    if not frames.step.size:
        raise InputError("the result has no fields (transient.frames = 0), so no stresses")
    if body not in (1, 2):
        raise InputError(f"body = {body}: must be 1 or 2")
    settings = settings or start.problem.stress or Stress()
    window = window_of(start, frames.pressure.max(axis=0))
    depths = depths_of(film_at(run), settings, window)
    march = March(depths, settings, start.scales.hertz_pressure)
    ratio, columns = poisson_ratio(start, body), window.columns
    kept = slice(0, columns.stop - columns.start)
    grid = Grid(window.spacing, kept, middle_row(start, window), 0, start.problem.contact.ends)
    planes, largest = [], []
    for number in range(frames.step.size):
        case = Case(cut(frame_loads(run, number, body), window), ratio)
        marched = march.through([case], grid, 1)
        planes.append(largest_shear(marched.along[0]))
        largest.append(marched.found[0])
    worst = np.array(largest)
    return MovingStress(
        time=run.history.time[frames.step],
        depth=depths,
        x=start.x[columns],
        plane=np.array(planes),
        shear=worst[..., Worst._fields.index("shear")],
        von_mises=worst[..., Worst._fields.index("von_mises")],
    )


def frame_loads(run: TransientSolution, frame: int, body: int) -> SurfaceLoads:
    """Return the loads on a body at a stored field.

    The stress at mid-film is that of the field. A run without [stress] has stored only its traction
    coefficient over time: that has the distribution of the pressure. The rolling part is exact. The
    load of asperities finer than the grid, and their friction, have the distribution of the
    pressure too. A traction that no oil can carry is left out.

    Parameters
    ----------
    run : TransientSolution
        With stored fields.
    frame : int
        Number of the field.
    body : {1, 2}
        Below which surface.
    """
    film, problem, step = film_at(run, frame), run.start.problem, run.frames.step[frame]
    pressure = np.maximum(film.pressure, 0.0)
    traction, share = run.history.traction[step], run.history.asperity_load[step]
    total = pressure / (1.0 - share) if problem.asperities is not None else pressure
    stored, sign = run.frames.stress, 1.0 if body == 1 else -1.0
    sliding = traction * total if stored is None else np.where(pressure > 0.0, stored[frame], 0.0)
    across = run.history.traction_across[step]
    sideways = across * total
    if not np.hypot(traction, across) <= LARGEST_CREDIBLE:
        sliding, sideways = np.zeros_like(total), np.zeros_like(total)
    rubbed = 0.0 * total
    if problem.asperities is not None:
        rubbed += problem.asperities.friction * share * total
    if problem.contact_film is not None:
        rubbed += (
            problem.contact_film.friction * total * problem.contact_film.meets(film.film_thickness)
        )
    towards_x, towards_y = sliding_direction(film)
    sliding, sideways = sliding - towards_x * rubbed, sideways - towards_y * rubbed
    along_y, along_x = slope_across(film, pressure), np.gradient(pressure, film.x, axis=1)
    half = 0.5 * film.film_thickness
    part = parts_of_cells(film)
    pushed_x, pushed_y = sign * sliding - half * along_x, sign * sideways - half * along_y
    return SurfaceLoads(part * total, part * pushed_x, part * pushed_y)
