"""A transient run before it is made: duration, steps, cost, and how well it follows its waves."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from tehl.domain import recommended_domain
from tehl.duration import duration_of, misplaced, number_of_steps
from tehl.options import Domain, Options
from tehl.problem import ContactProblem, Surface
from tehl.scaling import ScaledProblem

SECONDS_PER_STEP = 0.014
SECONDS_PER_NODE = 1.7e-6
SECONDS_COUPLED = 1.0e-5
"""Time of a step, and more by node of the finest full grid, on one core of a usual machine."""
FEWEST_POINTS = 16.0
"""Points per wave below which the amplitude of a wave that passes is off by some per cent."""
LARGEST_PART = 0.25
"""Of its shortest wave that a surface may move by in a step."""
FARTHEST = 1.0
"""Mesh widths per step by which a surface may run ahead of the mean motion or fall behind."""

_UNITS = ((1.0, 1.0, "s"), (1e-3, 1e3, "ms"), (0.0, 1e6, "us"))


@dataclass(frozen=True, kw_only=True, slots=True)
class TimePlan:
    """What a transient run will do.

    Attributes
    ----------
    duration, step : float
        [s].
    steps : int
        Of time.
    seconds : float
        Estimated CPU time [s].
    distance : float
        How far the mean of both surfaces moves on [a_x].
    speeds : (float, float)
        Of both surfaces [m/s].
    points_per_wave : (float, float)
        Mesh widths on the shortest wave of each surface, along the axis that has fewer [-];
        infinite for a smooth one.
    shift : (float, float)
        Mesh widths that each surface moves on in a step [-]; the mean moves by ``stride``.
    questions : tuple of str
        What looks odd.
    """

    duration: float
    step: float
    steps: int
    seconds: float
    distance: float
    speeds: tuple[float, float]
    points_per_wave: tuple[float, float]
    shift: tuple[float, float]
    questions: tuple[str, ...]


def time_plan(problem: ContactProblem, options: Options) -> TimePlan | None:
    """Return what a transient run will do, None for a steady case."""
    transient = problem.transient
    if transient is None:
        return None
    scaled, motion = ScaledProblem.of(problem), problem.motion
    units = scaled.scales
    stated = options.domain if isinstance(options.domain, Domain) else None
    domain = stated or recommended_domain(scaled.groups)
    nodes_y, nodes_x = options.shape
    dx = (domain.x[1] - domain.x[0]) / (nodes_x - 1) * units.half_width_x
    dy = (domain.y[1] - domain.y[0]) / (nodes_y - 1) * units.half_width_y
    step = transient.stride * dx / units.speed
    duration = duration_of(scaled)
    steps = number_of_steps(scaled, step)
    cost = SECONDS_COUPLED if problem.is_coupled else SECONDS_PER_NODE
    points = [
        _points_per_wave(one.roughness.shortest_wavelengths, dx, dy) for one in _both(problem)
    ]
    shifts = [transient.stride * speed / units.speed for speed in (motion.speed_1, motion.speed_2)]
    first, second = points
    return TimePlan(
        duration=duration,
        step=step,
        steps=steps,
        seconds=(SECONDS_PER_STEP + cost * nodes_x * nodes_y) * steps,
        distance=duration * units.speed / units.half_width_x,
        speeds=(motion.speed_1, motion.speed_2),
        points_per_wave=(first, second),
        shift=(shifts[0], shifts[1]),
        questions=tuple(_questions(problem, points, shifts)),
    )


def _both(problem: ContactProblem) -> tuple[Surface, Surface]:
    return problem.surface_1, problem.surface_2


def _points_per_wave(waves: tuple[float, float], dx: float, dy: float) -> float:
    return min(waves[0] / dx, waves[1] / dy)


def _questions(problem: ContactProblem, points: list[float], shifts: list[float]) -> Iterator[str]:
    """Yield what a careful reader would ask, a sentence each."""
    stride = problem.transient.stride if problem.transient else 1
    scaled = ScaledProblem.of(problem)
    sentence = misplaced(scaled, duration_of(scaled))
    if sentence is not None:
        yield sentence
    for name, one, shift in zip(("surface_1", "surface_2"), points, shifts, strict=True):
        if one < FEWEST_POINTS:
            yield (
                f"{name} has {one:.3g} points on its shortest wave, which flattens it by more than "
                f"the film does: take {FEWEST_POINTS:g} or more (numerics.points)"
            )
        apart = abs(shift - stride)
        if math.isfinite(one) and apart > FARTHEST:
            where = "ahead of" if shift > stride else "behind"
            yield (
                f"{name} moves {apart:.2g} mesh widths per step {where} the mean motion, and its "
                f"asperities jump: take a smaller transient.stride (now {stride})"
            )
        if shift > LARGEST_PART * one:
            yield (
                f"{name} moves by {shift / one:.2g} of its shortest wave in a step, which solve "
                "refuses above a quarter, or filters off a measured or random surface"
            )


def as_lines(plan: TimePlan) -> Iterator[str]:
    """Yield what is said of a transient run, in lines of plain text."""
    yield "Time"
    yield _row(
        "duration",
        f"{seconds_in_words(plan.duration)}: the mean of both surfaces moves on by "
        f"{plan.distance:.3g} half-widths",
    )
    yield _row("steps", f"{plan.steps} of {seconds_in_words(plan.step)}")
    yield _row("time of the run", f"about {plan.seconds:.2g} s once loaded")
    for number in (0, 1):
        waves = plan.points_per_wave[number]
        rough = f"{waves:.3g} points per wave" if math.isfinite(waves) else "smooth"
        yield _row(
            f"surface {number + 1}",
            f"{plan.speeds[number]:.4g} m/s, {plan.shift[number]:.3g} mesh widths per step, "
            f"{rough}",
        )


def as_summary(plan: TimePlan) -> dict[str, object]:
    """Return what is said of a transient run as JSON can hold it."""
    return {
        "duration_s": plan.duration,
        "step_s": plan.step,
        "steps": plan.steps,
        "seconds": plan.seconds,
        "distance": plan.distance,
        "speeds_m_s": list(plan.speeds),
        "points_per_wave": [one if math.isfinite(one) else None for one in plan.points_per_wave],
        "shift_per_step": list(plan.shift),
    }


def seconds_in_words(seconds: float) -> str:
    """Return a time as people say it: microseconds below a thousandth of a second."""
    factor, unit = next((f, unit) for limit, f, unit in _UNITS if abs(seconds) >= limit)
    return f"{seconds * factor:.4g} {unit}"


def _row(name: str, value: str) -> str:
    return f"  {name:<22}{value}"
