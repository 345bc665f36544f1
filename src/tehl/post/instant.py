"""One instant of a transient run as a film of its own: all that reads steady films reads it too."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tehl.errors import InputError
from tehl.fields import Fields, FilmSummary, SurfaceHeights
from tehl.grid import Grid
from tehl.operators.heights import MovingHeights
from tehl.options import Domain
from tehl.post.micro_film import smooth_twin

if TYPE_CHECKING:
    from tehl.result import Result
    from tehl.transient_result import TransientResult


def film_at(run: "TransientResult", frame: int = -1) -> "Result":
    """Return the film of a kept field.

    With it the functions of `tehl.post.roughness`, `tehl.post.micro_film` and `tehl.plots` tell of
    an instant what they tell of a steady film: lambda ratio, distribution, area below a threshold,
    ripples.

    Parameters
    ----------
    run : TransientResult
        With fields (``transient.frames``).
    frame : int
        Which of them; negative ones count from the last.

    Returns
    -------
    Result
        Pressure, film and heights of that instant, in the precision of the fields, and the smallest
        film of a node as its minimum. It has no temperatures and stresses, no error bars and no
        cycles; its question is that of the run.

    Raises
    ------
    InputError
        If there is no such field.
    """
    frames, start = run.frames, run.start
    count = len(frames.step)
    if not -count <= frame < count:
        raise InputError(f"frame = {frame}: the run keeps {count} fields (transient.frames)")
    units, x, y = start.scales, start.scaled.x, start.scaled.y
    film = np.asarray(frames.film[frame], np.float64) / units.film_thickness
    pressure = np.asarray(frames.pressure[frame], np.float64) / units.hertz_pressure
    scaled = Fields(x=x, y=y, pressure=pressure, film=film)
    row, column = np.unravel_index(int(np.argmin(film)), film.shape)
    return replace(
        start,
        scaled=scaled,
        rigid_approach=float(run.history.rigid_approach[frames.step[frame]]),
        film_scaled=FilmSummary(
            central=scaled.at_origin(film),
            minimum=float(film.min()),
            minimum_node=float(film.min()),
            minimum_at=(float(x[column]), float(y[row])),
        ),
        heights=_heights(run, frame),
        history=(),
        errors=None,
        uncertainty={},
        shear=None,
        heat=None,
    )


def smooth_start(run: "TransientResult") -> "Result | None":
    """Return the film of smooth surfaces that a run began with: the twin of each instant.

    None if it did not begin with smooth surfaces, or under another load than that of the contact.
    """
    transient, problem = run.start.problem.transient, run.start.problem
    begun = transient is not None and transient.start == "smooth" and transient.load_at(0.0) == 1.0
    if not begun or not problem.is_rough:
        return None
    return replace(run.start, problem=smooth_twin(problem))


def _heights(run: "TransientResult", frame: int) -> SurfaceHeights | None:
    """Return the heights of both surfaces, from the field of both together where one is smooth."""
    problem = run.start.problem
    if not problem.is_rough or problem.transient is None:
        return None
    together = np.asarray(run.frames.height[frame], np.float64)
    flat = np.zeros_like(together)
    if problem.surface_2.roughness.is_smooth:
        return SurfaceHeights(surface_1=together, surface_2=flat)
    if problem.surface_1.roughness.is_smooth:
        return SurfaceHeights(surface_1=flat, surface_2=together)
    x, y = run.start.scaled.x, run.start.scaled.y
    domain = Domain(x=(float(x[0]), float(x[-1])), y=(float(y[0]), float(y[-1])))
    grid = Grid(nx=x.size, ny=y.size, domain=domain, mirror=False)
    entrance = problem.transient.entrance if problem.transient.start == "smooth" else None
    units = run.start.scales
    moving = MovingHeights(run.start.scaled_problem, grid, entrance)
    first, second = moving.at(float(run.history.time[run.frames.step[frame]]))
    return SurfaceHeights(
        surface_1=first * units.film_thickness, surface_2=second * units.film_thickness
    )
