"""Profiles and fields of a transient result: beside a moving surface, over time, at one time."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.options import Domain
from tehl.estimate.duration import Part, parts_of
from tehl.estimate.grid import Grid
from tehl.estimate.schedule import Schedule, schedule_of
from tehl.operators.heights import MovingHeights
from tehl.post.micro_film import smooth_reference
from tehl.result.fields import Fields, FilmSummary, SurfaceHeights
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution


@dataclass(frozen=True, kw_only=True, slots=True)
class MovingProfiles:
    """The line y = 0 in the frame of a surface."""

    offset: Array
    """(n,): Distance along x from the moving place [m]."""
    place: Array
    """(nt,): Where that place is at each step [m]."""
    pressure: Array
    film: Array
    height: Array
    """(nt, n): [Pa], [m] and the height of that surface [m]; NaN outside the domain."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Envelope:
    """Least and largest values along y = 0 over time, (nx,) each."""

    x: Array
    """[m]."""
    film_least: Array
    film_largest: Array
    """[m]."""
    pressure_least: Array
    pressure_largest: Array
    """[Pa]."""


def moving_profiles(
    run: TransientSolution, surface: int, *, start: float | None = None, reach: float | None = None
) -> MovingProfiles:
    """Return the profiles along y = 0 around a place that moves with a surface.

    Parameters
    ----------
    run : TransientSolution
        With the profiles along y = 0 at each step.
    surface : {1, 2}
        Which surface.
    start : float
        Where the place is at time zero [m]; by default the place of the feature of the surface, 0
        without one.
    reach : float
        Length of the profiles on either side of it [m]; by default a half-width of the contact.

    Returns
    -------
    MovingProfiles
        Interpolated linearly between the nodes.

    Raises
    ------
    InputError
        If the surface has several features, or one away from y = 0, and ``start`` is not given.
    """
    run.start.problem.motion.speed_of(surface)  # there are two
    x = run.x
    start = _place_of_feature(run, surface) if start is None else start
    reach = run.start.scales.half_width_x if reach is None else reach
    if not reach > 0:
        raise InputError(f"reach = {reach} m: must be positive")
    count = round(reach / (x[1] - x[0]))
    offset = np.linspace(-reach, reach, 2 * max(count, 1) + 1)
    place = start + distances(run)[surface]
    lines = (run.profiles.pressure, run.profiles.film, getattr(run.profiles, f"height_{surface}"))
    pressure, film, height = (
        np.stack(
            [
                np.interp(here + offset, x, line, left=np.nan, right=np.nan)
                for here, line in zip(place, lines_in_time, strict=True)
            ]
        )
        for lines_in_time in lines
    )
    return MovingProfiles(offset=offset, place=place, pressure=pressure, film=film, height=height)


def distances(run: TransientSolution) -> Array:
    """Return how far mean motion, surface 1 and surface 2 have moved along x at each step [m].

    (3, nt).
    """
    motion, travelled = run.start.problem.motion, _schedule(run).travelled
    if travelled is not None:
        return np.asarray(run.start.scales.half_width_x * travelled)
    speeds = motion.entrainment_speed, motion.speed_1, motion.speed_2
    return np.outer(speeds, run.history.time)


def way(run: TransientSolution) -> float:
    """Return the way of the mean of both surfaces along x, there and back [Hertz half-widths]."""
    return float(np.abs(np.diff(distances(run)[0])).sum() / run.start.scales.half_width_x)


def _schedule(run: TransientSolution) -> Schedule:
    """Return what was known of the steps of a run."""
    start, units = run.start, run.start.scales
    step = run.time_step * units.speed / units.half_width_x
    return schedule_of(start.scaled_problem, step, run.history.time.size - 1)


def _place_of_feature(run: TransientSolution, surface: int) -> float:
    """Return the place of the feature of a surface at time zero [m].

    Raises InputError if it has several, or one away from y = 0.
    """
    name = f"surface_{surface}"
    parts = [one for one in parts_of(run.start.scaled_problem) if one.surface == name]
    features = [one for one in parts if not one.is_endless]
    if not features:
        return 0.0
    if len(features) > 1:
        raise InputError(f"{name} has {len(features)} features: state the place to follow, start")
    feature = features[0].roughness
    y, (first, last) = float(getattr(feature, "y", 0.0)), features[0].extent[1]
    if not abs(y) <= 0.25 * (last - first):
        raise InputError(
            f"the {feature.type} of {name} is at y = {y:g} m, but profiles are stored along y = 0 "
            "only: use the fields (tehl.post.transient.film_at)"
        )
    return float(getattr(feature, "x", 0.0))


def envelope(run: TransientSolution, *, since: float = 0.0, until: float = math.inf) -> Envelope:
    """Return the least and largest film and pressure along y = 0 over time.

    Parameters
    ----------
    run : TransientSolution
        With the profiles along y = 0 at each step.
    since, until : float
        First and last time [s].

    Raises
    ------
    InputError
        If no step lies between them.
    """
    inside = (run.history.time >= since) & (run.history.time <= until)
    if not inside.any():
        raise InputError(
            f"no step lies between {since:g} s and {until:g} s: the run ends at "
            f"{run.history.time[-1]:g} s"
        )
    film, pressure = run.profiles.film[inside], run.profiles.pressure[inside]
    return Envelope(
        x=run.x,
        film_least=film.min(axis=0),
        film_largest=film.max(axis=0),
        pressure_least=pressure.min(axis=0),
        pressure_largest=pressure.max(axis=0),
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class LargestChange:
    """Largest deviation from the steady film at the start, on y = 0 where |X| < 0.8."""

    start: float
    value: float
    """Film [m] or pressure [Pa] at the start, and where and when it deviates most."""
    x: float
    time: float
    """Where [m] and when [s]."""


def largest_change(run: TransientSolution, name: str, sign: int) -> LargestChange:
    """Return the largest change of a profile along y = 0 over the run.

    Parameters
    ----------
    run : TransientSolution
        Its first profile is the reference.
    name : {"film", "pressure"}
        Which profile.
    sign : {-1, 1}
        The largest decrease or the largest increase.
    """
    inside = np.flatnonzero(np.abs(run.start.scaled.x) < 0.8)  # half-widths
    values = getattr(run.profiles, name)[:, inside]
    step, node = np.unravel_index(int(np.argmax(sign * (values - values[0]))), values.shape)
    return LargestChange(
        start=float(values[0, node]),
        value=float(values[step, node]),
        x=float(run.x[inside[node]]),
        time=float(run.history.time[step]),
    )


def passing_features(run: TransientSolution) -> Iterator[tuple[Part, float]]:
    """Yield each dent, bump or ridge that moves, and when it is at x = 0 [s]."""
    for part in parts_of(run.start.scaled_problem):
        if not part.is_endless and part.speed != 0:
            yield part, -float(getattr(part.roughness, "x", 0.0)) / part.speed


def film_at(run: TransientSolution, frame: int = -1) -> Solution:
    """Return a stored field as a steady result.

    It has pressure, film and heights at that time in the precision of the fields, with the smallest
    nodal film as the minimum, and load and motion of that time; no temperatures, stresses, error
    bars and cycles. The functions of `tehl.post.roughness`, `tehl.post.micro_film` and `tehl.plots`
    take it.

    Parameters
    ----------
    run : TransientSolution
        With fields stored by ``transient.frames``.
    frame : int
        Number of the field; negative numbers count from the last one.

    Raises
    ------
    InputError
        If the field is not stored.
    """
    frames, start = run.frames, run.start
    count = len(frames.step)
    if not -count <= frame < count:
        raise InputError(f"frame = {frame}: the run has {count} stored fields (transient.frames)")
    units, x, y = start.scales, start.scaled.x, start.scaled.y
    film = np.asarray(frames.film[frame], np.float64) / units.film_thickness
    pressure = np.asarray(frames.pressure[frame], np.float64) / units.hertz_pressure
    scaled = Fields(x=x, y=y, pressure=pressure, film=film)
    row, column = np.unravel_index(int(np.argmin(film)), film.shape)
    return start.but(
        scaled=scaled,
        rigid_approach=float(run.history.rigid_approach[frames.step[frame]]),
        film_scaled=FilmSummary(
            central=scaled.at_origin(film),
            minimum=float(film.min()),
            minimum_node=float(film.min()),
            minimum_at=(float(x[column]), float(y[row])),
        ),
        heights=_heights(run, frame),
        time=float(run.history.time[frames.step[frame]]),
        history=(),
        errors=None,
        uncertainty={},
        shear=None,
        heat=None,
        stress=None,
    )


def smooth_start(run: TransientSolution) -> Solution | None:
    """Return the steady film of smooth surfaces at the start of a run, to compare its fields with.

    None if the run did not start from smooth surfaces under the load of the contact.
    """
    transient, problem = run.start.problem.transient, run.start.problem
    starts = transient is not None and transient.start == "smooth"
    starts = starts and run.start.load == run.start.scales.load
    if not starts or not problem.is_rough:
        return None
    return replace(run.start, problem=smooth_reference(problem))


def _heights(run: TransientSolution, frame: int) -> SurfaceHeights | None:
    """Return the heights of both surfaces at a stored field."""
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
    wraps = run.start.scaled_problem.groups.shape.wraps
    grid = Grid(nx=x.size, ny=y.size, domain=domain, mirror=False, wraps=wraps)
    entrance = problem.transient.entrance if problem.transient.start == "smooth" else None
    units = run.start.scales
    moving = MovingHeights(run.start.scaled_problem, grid, entrance)
    step = int(run.frames.step[frame])
    first, second = moving.at(float(run.history.time[step]), _schedule(run).places(step))
    return SurfaceHeights(
        surface_1=first * units.film_thickness, surface_2=second * units.film_thickness
    )
