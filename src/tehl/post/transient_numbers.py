"""Numbers of a transient result: friction, power and lambda over time, late extremes, patches."""

from contextlib import suppress

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.base.units import percentage
from tehl.contact.moment import slides_ever, timeline
from tehl.estimate.duration import whole_passing
from tehl.estimate.scaling import ScaledProblem
from tehl.post.boundary_contact import largest_patches, touching, why_unknown
from tehl.post.roughness import rough_film
from tehl.result.transient import TransientSolution

OF_PASSING, LEAST_OF_PASSING = 3.0, 0.02
"""Error of the least film over time over its second difference from step to step, and least one
that is named. Five lines whose speed, direction or load changes at once, on 129 to 513 nodes, err
by 0.03 to 0.7 times that, which is 0.1 to 4 %, one minimum by 3 times 0.07 %. The central film of a
ball that stops and starts is 31.8, 29.1 and 27.8 nm on 129, 193 and 257 nodes per direction: by an
order of two it errs by 20 and 12 % on the first ones, where that is 20 and 12 %."""
NARROW_BEND = 0.1
"""Second difference of the pressure over the largest one, above which its spike is too narrow for
the mesh: those of the same lines have 0.7 to 1.1, and grow by 4 to 45 % on finer grids."""


def friction(run: TransientSolution) -> Array | None:
    """Friction of film and solid contact together over the load at that time, positive [-].

    None without asperities or a boundary film, and where the share of these is not known.
    """
    problem = run.start.problem
    without = problem.asperities is None and problem.contact_film is None
    if without or (problem.contact_film is not None and why_share_unknown(run)):
        return None
    slides = slides_ever(problem)
    film = np.hypot(run.history.traction, run.history.traction_across)
    return film + (run.history.solid_friction if slides else 0.0)


def lambda_central(run: TransientSolution) -> Array | None:
    """Central film at each time over Sq of both surfaces [-].

    None between smooth surfaces, and where the film has the roughness.
    """
    rough = rough_film(run.start) if run.start.heights is None else None
    return None if rough is None else run.history.film_central / rough.composite


def sliding_power(run: TransientSolution) -> Array | None:
    """Power by sliding at each time, of film and solid contact [W], of one metre of a line contact.

    That of the forces and of the drilling moment at mid-film. None where nothing slides, and where
    the friction of solids is not known, or their surfaces spin.
    """
    problem, history = run.start.problem, run.history
    turning = problem.motion.spin_1 - problem.motion.spin_2
    known = friction(run) is not None
    has_solids = problem.asperities is not None or problem.contact_film is not None
    if not (slides_ever(problem) or turning) or (has_solids and (turning or not known)):
        return None
    moments = list(map(timeline(problem), history.time))
    along, across = np.array([(one.sliding, one.across) for one in moments]).T
    force = history.traction * along + history.traction_across * across
    if known:
        force = force - history.solid_friction * np.hypot(along, across)
    load = problem.load * history.load * problem.entrainment_speed
    return np.asarray(-load * force - turning * history.drilling_moment)


def unresolved(run: TransientSolution) -> dict[str, str]:
    """Return what grid and steps do not resolve of extremes over time, sentences by their names.

    A film that is thin for a few steps only, as where a motion begins again, errs by about
    `OF_PASSING` times its second difference. A spike of the pressure on y = 0 that is one node wide
    is higher on finer grids. Empty of certified runs, whose extremes have error bars.
    """
    if run.uncertainty:
        return {}
    found, history = {}, run.history
    for name, values in (
        ("film_minimum", history.film_minimum),
        ("film_central_least", history.film_central),
    ):
        error = OF_PASSING * _bend(values, int(values.argmin()))
        if error > LEAST_OF_PASSING:
            found[name] = f"passes within a few steps, so that it errs by about {percentage(error)}"
    line = run.profiles.pressure[int(history.pressure_max.argmax())]
    if _bend(line, int(line.argmax())) > NARROW_BEND:
        found["pressure_max"] = "the spike is narrower than the mesh and may be higher"
    return found


def _bend(values: Array, place: int) -> float:
    """Return the second difference at a place over the value there [-]; zero at both ends."""
    if not 0 < place < values.size - 1:
        return 0.0
    before, here, after = values[place - 1 : place + 2]
    return float(abs(before - 2.0 * here + after) / here)


def late_extremes(run: TransientSolution) -> tuple[str, ...]:
    """Extremes that grew by 1 % in the last tenth of a run whose duration is not stated.

    They may grow in a longer one: a periodic or mirrored map goes on to pass the contact.
    """
    transient, time = run.start.problem.transient, run.history.time
    if transient is None or transient.duration is not None or time.size < 20:
        return ()
    early = time <= 0.9 * time[-1]
    extremes = (
        ("minimum film", "film_minimum", -run.history.film_minimum),
        ("largest pressure", "pressure_max", run.history.pressure_max),
    )
    bars = {name: one.uncertainty for name, one in run.uncertainty.items()}
    return tuple(
        words
        for words, name, values in extremes
        if values.max() - values[early].max() > max(0.01 * abs(values.max()), bars.get(name, 0.0))
    )


def longer_duration(run: TransientSolution) -> float | None:
    """Duration to state where the default one ended early [s]; None where it did not.

    It lasts until maps that repeat at their edges have passed whole, or twice as long where
    extremes changed at the end.
    """
    transient, end = run.start.problem.transient, float(run.history.time[-1])
    if transient is None or transient.duration is not None or not run.status.converged:
        return None
    needed = 2.0 * end if late_extremes(run) else 0.0
    with suppress(InputError):  # the file of a map that a stored result need not have
        needed = max(needed, whole_passing(ScaledProblem.of(run.start.problem)))
    return needed if needed > (1.0 + 1e-9) * end else None


def patch_cells(run: TransientSolution) -> float:
    """Largest mean diameter, or width, of patches of contact in the frames [mesh widths].

    Zero where surfaces do not touch through a boundary film in any of them.
    """
    film, frames, shape = run.start.problem.contact_film, run.frames, run.start.groups.shape
    if film is None:
        return 0.0
    return largest_patches(film.thickness, frames.film, frames.pressure, wraps=shape.wraps)


def why_share_unknown(run: TransientSolution) -> str:
    """Why the share where surfaces touch means nothing, in words; empty if it is known."""
    start = touching(run.start)
    return why_unknown(patch_cells(run), start.share_error if start else 0.0)
