"""A transient run before it is computed: duration, steps, cost, resolution of its waves."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from tehl.base.units import percentage
from tehl.contact.moment import SAMPLES, courses_of, moments_of
from tehl.contact.options import Options
from tehl.estimate.duration import (
    MOST_FOR_COURSES,
    bend_between,
    duration_of,
    misplaced,
    number_of_steps,
    stride_on,
)
from tehl.estimate.halving import halvings, parts_of_run
from tehl.estimate.in_time import PART_IN_STEP
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.schedule import schedule_of
from tehl.report.roughness import RESOLVES

LARGEST_BEND = 0.01
"""Part of its largest value by which what changes in time may be off a straight line within a step:
half of the usual error of a film."""
BYTES_IN_STEP = 96
"""Memory of a step per node along x: pressure, film and two heights on the line y = 0, and copies
of them that are written (3585 nodes: 1.2 GB after 3,800 steps)."""
OF_LINE, OF_COUPLED_LINE = (0.004, 4e-6), (0.004, 1.6e-5)
"""CPU time of a time step of a line contact, and per node, on one core of a usual machine [s]: 161
to 3585 nodes."""
OF_POINTS, OF_TOUCHING, COUPLED = (0.01, 7.5e-7), (0.08, 1.5e-5), 2.2
"""The same of other contacts, per node of half the domain: it doubles where no half is its mirror
image. Touching through a boundary film takes more, and heat or thinning some times as much. Of 14
runs, five of them of lines, twelve take half to twice that."""
CYCLES_OF_STRIDE, USUAL_STRIDE = 0.37, 2
"""Part by which a step costs more per mesh width that it passes beyond two, as more cycles follow:
gears on 1281 and 2049 nodes, heated, and 3585, Newtonian, with a stride of four take 49, 58 and
31 ms, planned as 43, 64 and 32."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TransientPlan:
    """Duration, steps, cost and resolution of a transient run."""

    duration_s: float
    step_s: float
    """[s]."""
    steps: int
    """Number of time steps."""
    halved_s: tuple[float, ...]
    """Times from which on the nodes along x are halved, as the contact has grown [s]."""
    seconds: float
    """Estimated CPU time [s]."""
    distance: float
    """Distance that the mean of both surfaces moves on [a_x]."""
    speeds_m_s: tuple[tuple[float, float, float], ...]
    """Of each surface at the start, the least and the largest [m/s]."""
    points_per_wave: tuple[float | None, ...]
    """Mesh widths on the shortest wave of each surface, along the axis that has fewer [-]; None for
    a smooth one."""
    shift_per_step: tuple[float, float]
    """Mesh widths that each surface moves on per step at the most [-]; the mean moves by
    ``stride`` at the stated speed."""
    changes: tuple[tuple[str, float, float], ...]
    """Keys of what changes in time, with the least and the largest number."""
    questions: tuple[str, ...]
    """What is not plausible."""


def transient_plan(
    scaled: ScaledProblem, options: Options, mesh: tuple[float, float], *, halves: bool
) -> TransientPlan | None:
    """Return the plan of a transient run, None for a steady case.

    Parameters
    ----------
    scaled : ScaledProblem
        With the surfaces, their speeds and the ``transient`` table.
    options : Options
        Its numerics.
    mesh : (float, float)
        Mesh widths of the finest grid along x and y [m].
    halves : bool
        Whether the run may go on with fewer nodes: where none are stated.
    """
    problem, units, transient = scaled.problem, scaled.scales, scaled.problem.transient
    if transient is None:
        return None
    (ny, nx), (dx, dy) = options.shape, mesh
    stride = stride_on(scaled, dx / units.half_width_x, PART_IN_STEP * options.target)
    step, duration = stride * dx / units.speed, duration_of(scaled)
    steps = number_of_steps(scaled, step)
    parts = 1 if options.half_domain == "auto" and problem.is_even_in_y else 2
    start, per_half = OF_TOUCHING if problem.contact_film is not None else OF_POINTS
    if problem.is_coupled and problem.contact_film is None:
        per_half *= COUPLED
    if problem.contact.is_line and problem.contact_film is None:
        (start, per_half), parts = (OF_COUPLED_LINE if problem.is_coupled else OF_LINE), 1
    cost = per_half * parts
    waves = (one.roughness.shortest_wavelengths for one in problem.surfaces)
    first, second = (min(wave[0] / dx, wave[1] / dy) for wave in waves)
    moments = moments_of(problem, duration)
    speeds = units.speed * np.array([one.speeds for one in moments])
    leads = np.abs(speeds - speeds.mean(axis=1, keepdims=True)).max(axis=0)
    shift, lead = (stride / units.speed * one for one in (np.abs(speeds).max(axis=0), leads))
    halved = halvings(scaled, options, (nx, None), stride, steps) if halves else ()
    seconds, limit = 0.0, options.max_time
    for nodes, widths, number in parts_of_run(nx, stride, steps, halved):
        longer = 1.0 + CYCLES_OF_STRIDE * max(widths - USUAL_STRIDE, 0)
        seconds += (start + cost * nodes * ny) * longer * number
    ends = (
        [f"numerics.max_time = {limit:g} s: the run takes about {seconds:.2g} s and may end early"]
        if "max_time" in options.model_fields_set and seconds > limit
        else []
    )
    return TransientPlan(
        duration_s=duration,
        step_s=step,
        steps=steps,
        halved_s=tuple(step * duration / steps for step in halved),
        seconds=seconds,
        distance=_distance(scaled, step, steps),
        speeds_m_s=tuple((float(one[0]), float(one.min()), float(one.max())) for one in speeds.T),
        points_per_wave=tuple(one if math.isfinite(one) else None for one in (first, second)),
        shift_per_step=(float(shift[0]), float(shift[1])),
        changes=tuple(_changes(scaled, duration)),
        questions=(
            *_questions(scaled, duration, (first, second), zip(shift, lead, strict=True)),
            *_jumps(scaled, steps),
            *ends,
        ),
    )


def _jumps(scaled: ScaledProblem, steps: int) -> Iterator[str]:
    """Yield what changes too fast for the time steps."""
    bend = bend_between(scaled, steps) if steps <= MOST_FOR_COURSES else 0.0
    if bend > LARGEST_BEND:
        yield (
            f"what changes in time is up to {percentage(bend)} off a straight line within one of "
            f"{steps} time steps, and the film is as far behind; take more numerics.points: a step "
            "moves by mesh widths"
        )


def _distance(scaled: ScaledProblem, step: float, steps: int) -> float:
    """Return the way of the mean of both surfaces, there and back [a_x]; ``step`` in [s]."""
    unit = scaled.scales.half_width_x / scaled.scales.speed
    travelled = schedule_of(scaled, step / unit, steps).travelled
    if travelled is None:
        return duration_of(scaled) / unit
    return float(np.abs(np.diff(travelled[0])).sum())


def _changes(scaled: ScaledProblem, duration: float) -> Iterator[tuple[str, float, float]]:
    """Yield each key of ``[transient]`` that changes, with the least and largest number."""
    for key, course in courses_of(scaled.problem).items():
        values = [course.at(duration * n / SAMPLES) for n in range(SAMPLES + 1)]
        values += [value for time, value in course.table if 0.0 <= time <= duration]
        yield key, min(values), max(values)


def _questions(
    scaled: ScaledProblem,
    duration: float,
    points: tuple[float, float],
    shifts: Iterable[tuple[float, float]],
) -> Iterator[str]:
    """Yield what is not plausible, a sentence each.

    ``points`` and ``shifts`` are of each surface: on its shortest wave; and mesh widths per step at
    the most, of itself and away from the mean motion.
    """
    stride = scaled.problem.transient.stride if scaled.problem.transient else 1
    sentence = misplaced(scaled, duration)
    if sentence is not None:
        yield sentence
    for name, one, (shift, lead) in zip(("surface_1", "surface_2"), points, shifts, strict=True):
        if one < RESOLVES:
            yield (
                f"{name} has {one:.3g} points on its shortest wave: the grid flattens the wave "
                f"more than the film does; take {RESOLVES} or more (numerics.points)"
            )
        if math.isfinite(one) and lead > 1.0:
            yield (
                f"{name} moves {lead:.2g} mesh widths per step away from the mean motion, so its "
                f"asperities jump: take a smaller transient.stride (now {stride})"
            )
        if shift > 0.25 * one:
            yield (
                f"{name} moves by {shift / one:.2g} of its shortest wave per step: solve accepts "
                "at most a quarter, and filters such waves off a measured or random surface"
            )
