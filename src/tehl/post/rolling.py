"""Rolling friction and moments of a line contact or a roller.

The pressure lies upstream of the middle, by a shift e: the load makes the moment w e about it. The
flow by the pressure balances it with a force F on each surface, w e = 2 F R (docs/theory/line.md).
Much of it comes from the oil upstream, whose part outside of the grid is added.
"""

from dataclasses import dataclass

import numpy as np

from tehl.contact.options import Domain
from tehl.estimate.grid import Grid
from tehl.estimate.spin import slowing
from tehl.operators.upstream import Lines, rolling
from tehl.post.stress.loads import whole_pressure
from tehl.post.traction import cell_widths
from tehl.result.solution import Solution


@dataclass(frozen=True, kw_only=True, slots=True)
class Rolling:
    """Rolling friction of a roller, or of one metre of a line contact."""

    force: float
    """F on each surface, against its motion [N]."""
    power: float
    """By rolling, 2 F u_m [W]."""
    moment: float
    """Moment w e = 2 F R of the pressure about the middle [N m]."""
    shift: float
    """Distance e of the pressure centre upstream of the middle [m]."""
    tail_share: float
    """Part of the force by the oil upstream of the grid [-]."""
    closure_error: float
    """Moment of the pressure over that by the flow, on the grid, less one [-]."""
    T: float
    """F/(E' R) W^(-3/2) [-]: the T* of published formulas."""
    tilting: float | None
    """Moment of the load about x [N m], positive if positive y carries more; None if symmetric."""
    tilt: float | None
    """Tilt of a roller that follows from that moment [rad]; None where it is stated."""


def rolling_friction(result: Solution) -> Rolling | None:
    """Return the rolling friction of a line or roller; None for ellipses and without a film."""
    problem = result.problem
    if not problem.contact.has_lines or not result.scaled.film.min() > 0.0:
        return None
    scales, groups, here = result.scales, result.groups, result.scaled
    ends = Domain.model_construct(x=(float(here.x[0]), float(here.x[-1])), y=groups.shape.sides)
    grid = Grid(nx=here.x.size, ny=here.y.size, domain=ends, mirror=False)
    widths = cell_widths(here.y) if grid.ny > 1 else grid.widths
    oil, scaled = None, result.scaled_problem
    if result.oil is None or result.oil.fill[0, 0] == 1.0:  # it reaches further upstream
        peaks = result.pressure.argmax(axis=1)[:, None]
        largest = np.take_along_axis(result.pressure, peaks, axis=1)
        density = problem.lubricant.density.density(largest, scales.temperature) / scales.density
        oil = (density * np.take_along_axis(here.film, peaks, axis=1))[:, 0]
    slower = slowing(scaled, here.y)
    between, whole = here.film, whole_pressure(result) / scales.hertz_pressure
    if result.asperities is not None:
        between = result.asperities.separation / scales.film_thickness
    lines = Lines(here.x, here.pressure, between, widths, slower, whole)
    flow, ratio, tail = rolling(lines, oil, scaled.entering, scaled.moment)
    force = 0.5 * flow * scales.hertz_pressure * scales.film_thickness * scales.half_width_y
    area = scales.half_width_x**2 * scales.half_width_y
    arm = flow / scaled.moment.curvature * scales.hertz_pressure * area
    load = problem.shape.load_unit(problem.radius_x, problem.reduced_modulus)
    return Rolling(
        force=force,
        power=2.0 * force * problem.entrainment_speed,
        moment=arm,
        shift=arm / result.load,
        tail_share=tail / flow if flow else 0.0,
        closure_error=ratio - 1.0,
        T=force / load * groups.W**-1.5,
        tilting=_tilting(result) if problem.has_tilting_moment else None,
        tilt=result.tilt,
    )


def _tilting(result: Solution) -> float:
    """Return the moment of the load on a roller about x [N m]."""
    rows, y = whole_pressure(result) @ cell_widths(result.x), result.y
    faces = np.concatenate([y[:1], 0.5 * (y[1:] + y[:-1]), y[-1:]])
    # of width times middle of each cell
    return float(rows @ (0.5 * np.diff(faces**2)))
