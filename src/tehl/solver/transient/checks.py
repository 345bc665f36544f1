"""What a transient run is refused for before it begins, and how it is said that it ended early."""

import math

import numpy as np

from tehl.duration import misplaced
from tehl.errors import InputError
from tehl.grid import Grid
from tehl.operators.heights import MovingHeights, check_nodes, rounded_up
from tehl.result import Status
from tehl.scaling import ScaledProblem
from tehl.solver.level import Level
from tehl.solver.transient.step import StepError
from tehl.transient import Transient

LEAST_STEPS = 4.0
"""Steps of time in which a wave passes, below which they take it for another one."""
ROUNDING = 1e-9
SETTLED = 1e-6
"""Change of P in the last cycle of a step below which it has all but settled."""
MISSED = 0.25
"""Part of all of its change by which the load of the nearest step may be off that of a peak."""


def check_stride(transient: Transient, grid: Grid) -> None:
    """Refuse steps that are long beside the domain.

    Raises
    ------
    InputError
        If two of them pass an eighth of it.
    """
    longest = max((grid.nx - 1) // 16, 1)
    if transient.stride > longest:
        raise InputError(
            f"transient.stride = {transient.stride} is too long for {grid.nx} nodes: take "
            f"{longest} or less"
        )


def check_waves(heights: MovingHeights, grid: Grid, stride: int) -> None:
    """Refuse waves that the grid, or the steps of time, would take for others.

    Raises
    ------
    InputError
        If fewer than `LEAST_NODES` fall on the shortest, or fewer than `LEAST_STEPS` on the time in
        which it passes.
    """
    along, across = heights.wavelengths
    check_nodes(min(along / grid.dx, across / grid.dy))
    for name, waves in zip(("surface_1", "surface_2"), heights.waves_per_step, strict=True):
        part = waves * stride * grid.dx
        if part * LEAST_STEPS > 1.0 + ROUNDING:
            smaller = f", or transient.stride (now {stride}) smaller" if stride > 1 else ""
            raise InputError(
                f"{name} moves by {part:.3g} of its shortest wave in a step of time, which would "
                f"take it for another one: numerics.points must be "
                f"{rounded_up(part * LEAST_STEPS)} times as many at least{smaller}"
            )


def check_places(scaled: ScaledProblem, seconds: float) -> None:
    """Refuse roughness that never comes into the contact, or that is there at once.

    Raises
    ------
    InputError
        If it does not, within ``seconds``, or stands in the contact where the film is smooth.
    """
    sentence = misplaced(scaled, seconds)
    if sentence is not None:
        raise InputError(sentence)


def check_load(transient: Transient, seconds: float) -> None:
    """Refuse a load that rises and falls again between two steps of ``seconds``.

    Raises
    ------
    InputError
        If the step nearest to one of its times is off by more than `MISSED` of the whole change.
    """
    levels = plateaus(transient.load)
    if not levels:
        return
    loads = [load for *_, load in levels]
    change = max(loads) - min(loads)
    for before, (first, last, load), after in zip(levels, levels[1:], levels[2:], strict=False):
        turns = (load - before[2]) * (load - after[2]) > 0
        steps = [round(time / seconds) * seconds for time in (first, last)]
        seen = math.ceil(first / seconds) * seconds <= last
        missed = min(abs(load - transient.load_at(time)) for time in steps)
        if turns and not seen and missed > MISSED * change:
            raise InputError(
                f"transient.load = {load:g} at {first:g} s comes and goes between two steps of "
                f"{seconds:.3g} s, which do not see it: take more numerics.points, or let it last "
                "longer"
            )


def plateaus(table: tuple[tuple[float, float], ...]) -> list[tuple[float, float, float]]:
    """Return from when to when a load keeps each value of its table, and that value."""
    found: list[tuple[float, float, float]] = []
    for time, load in table:
        first = found.pop()[0] if found and found[-1][2] == load else time
        found.append((first, time, load))
    return found


def failed(error: StepError, seconds: float, level: Level, transient: Transient) -> Status:
    """Return the status of a run whose step did not settle."""
    return Status(
        kind="diverged" if error.cause == "diverged" else "stalled",
        cause="step_not_settled",
        message=(
            f"The step to {seconds:.4g} s did not settle on {level.grid.nx} x {level.grid.ny} "
            f"nodes: the last change of P is {error.change:.2g}. What came before is kept."
        ),
        hint=_remedy(error, transient),
    )


def _remedy(error: StepError, transient: Transient) -> str:
    """Return what to try where a step did not settle: its surfaces, or what was asked of it."""
    if error.cause == "stalled" and transient.tolerance < error.change < SETTLED:
        return (
            f"The pressure has all but settled: let transient.tolerance (now "
            f"{transient.tolerance:g}) be {SETTLED:g} or more."
        )
    return (
        "Take lower or longer asperities, more nodes (numerics.points), or more cycles per step "
        "(transient.max_cycles)."
    )


def touching(seconds: float, level: Level, *, rough: bool) -> Status:
    """Return the status of a run whose surfaces would touch."""
    grid, h = level.grid, level.film.h
    row, column = np.unravel_index(int(np.argmin(h)), h.shape)
    if not rough:
        return Status(
            kind="not_converged",
            cause="film_not_positive",
            message=(
                f"At {seconds:.4g} s the film is not positive: smallest H = {h.min():.3g} at "
                f"X = {grid.x[column]:.3g}, Y = {grid.y[row]:.3g}, though nothing is rough: the "
                "load grows too fast or beyond the domain. What came before is kept."
            ),
            hint="Let the load grow more slowly or less, or take more nodes (numerics.points).",
        )
    return Status(
        kind="not_converged",
        cause="asperity_contact",
        message=(
            f"At {seconds:.4g} s the film is not positive: smallest H = {h.min():.3g} at "
            f"X = {grid.x[column]:.3g}, Y = {grid.y[row]:.3g}. On {grid.nx} x {grid.ny} nodes "
            "asperities would touch there, which a film that carries all of the load cannot "
            "describe; one grid does not tell whether they do on a finer one. What came before is "
            "kept."
        ),
        hint=(
            f"See whether numerics.points = {2 * max(grid.nx, grid.ny) - 1} finds a film; else "
            "take lower or longer asperities, or more speed."
        ),
    )
