"""What a run in time is refused for before it begins, and how it is said that it ended early."""

import numpy as np

from tehl.errors import InputError
from tehl.grid import Grid
from tehl.operators.heights import MovingHeights
from tehl.result import Status
from tehl.solver.level import Level
from tehl.solver.stepper import StepError
from tehl.transient import Transient

LEAST_NODES = 4.0
"""Nodes on a wave below which a grid takes it for another one."""
LOOKS, UNSEEN = 41, 1e-9
"""Instants at which it is looked whether there is roughness in the contact, and heights that are
none [a_x^2/R_x]."""


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


def check_waves(heights: MovingHeights, grid: Grid) -> None:
    """Refuse waves that the grid would take for others.

    Raises
    ------
    InputError
        If fewer than `LEAST_NODES` fall on the shortest.
    """
    along, across = heights.wavelengths
    nodes = min(along / grid.dx, across / grid.dy)
    if nodes < LEAST_NODES:
        raise InputError(
            f"the shortest wave of the surfaces has {nodes:.2g} nodes of the grid, which would "
            f"take it for another one: numerics.points must be {LEAST_NODES / nodes:.2g} times as "
            "many at least, and four times that for a good answer"
        )


def check_arrival(heights: MovingHeights, grid: Grid, duration: float) -> None:
    """Refuse roughness that never comes into the contact.

    Raises
    ------
    InputError
        If it is rough nowhere in the contact at any of many instants.
    """
    if not heights.is_rough:
        return
    inside = np.hypot(grid.x[None, :], grid.y[:, None]) < 1.0
    for seconds in np.linspace(0.0, duration, LOOKS):
        if max(np.abs(one[inside]).max() for one in heights.at(float(seconds))) > UNSEEN:
            return
    raise InputError(
        f"the roughness of the surfaces does not come into the contact within {duration:.3g} s: "
        "look at its place (x) and at transient.duration"
    )


def failed(error: StepError, seconds: float, level: Level) -> Status:
    """Return the status of a run whose step did not settle."""
    return Status(
        kind="diverged" if error.cause == "diverged" else "stalled",
        cause="step_not_settled",
        message=(
            f"The step to {seconds:.4g} s did not settle on {level.grid.nx} x {level.grid.ny} "
            f"nodes: the last change of P is {error.change:.2g}. What came before is kept."
        ),
        hint=(
            "Take lower or longer asperities, more nodes (numerics.points), or more cycles per "
            "step (transient.max_cycles)."
        ),
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
            f"X = {grid.x[column]:.3g}, Y = {grid.y[row]:.3g}. Asperities would touch there, which "
            "a film that carries all of the load cannot describe. What came before is kept."
        ),
        hint="Take lower or longer asperities, more speed, or more nodes (numerics.points).",
    )
