"""Checks of a transient problem on its grid and time steps, before the run.

Each raises `InputError` with the key, its value, what is wrong, and what is expected.
"""

import numpy as np

from tehl.base.errors import InputError
from tehl.contact.shape import LINE
from tehl.contact.transient import Transient
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.schedule import Schedule
from tehl.operators.heights import MovingHeights, check_nodes, rounded_up

LEAST_STEPS = 4.0
"""Time steps per passing wave below which the wave is aliased."""
TIME_ROUNDING = 1e-9


def check_stride(transient: Transient, grid: Grid, schedule: Schedule) -> None:
    """Check that two time steps pass at most an eighth of the domain.

    Parameters
    ----------
    transient : Transient
        Its ``stride`` is the time step in mesh widths over u_m.
    grid : Grid
        With the number of nodes along x.
    schedule : Schedule
        With the largest speed.

    Raises
    ------
    InputError
        If the stride is too long; the message has the longest one.
    """
    fastest = max(abs(one.speed) for one in schedule.moments)
    longest = max(int((grid.nx - 1) // 16 / max(fastest, 1.0)), 1)
    if transient.stride > longest:
        raise InputError(
            f"transient.stride = {transient.stride}: too long for {grid.nx} nodes; take {longest} "
            "or less"
        )


def check_size(scaled: ScaledProblem, grid: Grid, schedule: Schedule) -> None:
    """Check that the contact stays within the domain.

    Parameters
    ----------
    scaled, grid, schedule : ScaledProblem, Grid, Schedule
        Shape, domain, and loads and radii over time.

    Raises
    ------
    InputError
        If its half-width reaches an edge.
    """
    power = 0.5 if scaled.groups.shape is LINE else 1.0 / 3.0
    largest = max((one.load / one.curvature) ** power for one in schedule.moments)
    room = min(-grid.domain.x[0], grid.domain.x[1])
    if largest >= room:
        raise InputError(
            f"transient: the contact grows to {largest:.3g} half-widths of the one stated, beyond "
            f"the edge of the domain at {room:.3g}: state its largest load and radius in "
            "[contact], or a larger numerics.domain"
        )


def check_waves(heights: MovingHeights, grid: Grid, schedule: Schedule, stride: int) -> None:
    """Check that neither the grid nor the time steps alias the waves of the surfaces.

    Parameters
    ----------
    heights, grid, schedule : MovingHeights, Grid, Schedule
        Surfaces, the finest grid, and speeds over time.
    stride : int
        Mesh widths that the mean motion passes per step.
    """
    along, across = heights.wavelengths
    check_nodes(min(along / grid.dx, across / grid.largest_dy))
    fastest = np.abs([one.speeds for one in schedule.moments]).max(axis=0)
    for name, waves, speed in zip(
        ("surface_1", "surface_2"), heights.waves_per_length, fastest, strict=True
    ):
        part = waves * speed * stride * grid.dx
        if part * LEAST_STEPS > 1.0 + TIME_ROUNDING:
            smaller = f", or reduce transient.stride (now {stride})" if stride > 1 else ""
            raise InputError(
                f"{name}.roughness: moves by {part:.3g} of its shortest wave per time step and "
                "would be aliased; increase numerics.points by a factor of at least "
                f"{rounded_up(part * LEAST_STEPS)}{smaller}"
            )
