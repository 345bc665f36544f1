"""The statuses of results that are not plainly converged: one function per cause.

Each has the name of the cause for programs, a message with the numbers, and a hint with an action.
"""

import math

import numpy as np

from tehl.grid import Grid
from tehl.options import Domain
from tehl.result import Result, Status
from tehl.scaling import Groups
from tehl.solver.diagnosis import grid_hint
from tehl.solver.film_summary import film_summary
from tehl.solver.level import Level
from tehl.transient import Transient

CONVERGED = Status(kind="converged")
KNOWN = 0.5
"""Relative error of the minimum film at which the hint to a finer grid aims."""
STARVED = 0.9
"""Film over fully flooded film below which an edge is too close."""
NEARLY_CONVERGED = 1e-6
"""Change of P in the last cycle of a time step that only a tight tolerance rejects."""
LESS_ROUGH = "Take lower or longer asperities, a higher speed, or more nodes (numerics.points)."


def _failed(cause: str, message: str, hint: str) -> Status:
    return Status(kind="not_converged", cause=cause, message=message, hint=hint)


def too_coarse(grid: Grid, groups: Groups, error: float) -> Status:
    """Return ``grid_too_coarse``: the error of the film is too large.

    Parameters
    ----------
    grid : Grid
        The finest grid.
    groups : Groups
        Dimensionless groups.
    error : float
        Relative error of the film [-].
    """
    size = "above 100 %" if error > 1.0 else f"{100 * error:.0f} %"
    return _failed(
        "grid_too_coarse",
        f"The grid of {grid.nx} x {grid.ny} nodes is too coarse for the film: its estimated "
        f"relative error is {size}.",
        f"Take {grid_hint(grid, groups)}.",
    )


def too_coarse_to_certify(result: Result, error: float) -> Status:
    """Return ``grid_too_coarse`` for a certified result with a relative error bar ``error``."""
    x, y = result.scaled.x, result.scaled.y
    domain = Domain(x=(float(x[0]), float(x[-1])), y=(float(y[0]), float(y[-1])))
    return too_coarse(Grid(nx=x.size, ny=y.size, domain=domain, mirror=False), result.groups, error)


def not_certified(result: Result, why: str) -> Status:
    """Return ``not_certified``: the finest grid converged, but has no error bar."""
    nodes = 2 * max(result.scaled.x.size, result.scaled.y.size) - 1
    return _failed(
        "not_certified",
        f"The finest grid converged, but has no error bar: {why}",
        f"Take numerics.points = {nodes}, or solve without certifying.",
    )


def film_not_positive(level: Level, groups: Groups) -> Status:
    """Return ``film_not_positive``: the discrete film of a smooth contact is negative."""
    grid = level.grid
    return _failed(
        "film_not_positive",
        f"The discrete film is not positive on {grid.nx} x {grid.ny} nodes (smallest H = "
        f"{level.film.h.min():.3g}): the grid is too coarse for the film.",
        f"Take {grid_hint(grid, groups)}.",
    )


def asperity_contact(level: Level) -> Status:
    """Return ``asperity_contact``: the film between rough surfaces vanishes somewhere."""
    grid, floor = level.grid, level.equations.floor
    thin = int(np.count_nonzero(level.film.h <= floor))
    return _failed(
        "asperity_contact",
        f"{no_film(level)}, on {grid.nx} x {grid.ny} nodes of which {thin} are below "
        f"H = {floor:.2g}. Asperities would touch there, which a film that carries the whole "
        "load does not describe.",
        LESS_ROUGH,
    )


def no_film(level: Level) -> str:
    """Return the value of the smallest film, its place, and what is wrong with it."""
    smallest, x, y = thinnest(level)
    how = "not positive"
    if smallest > 0.0:
        how = f"thinner than H = {level.equations.floor:.2g}, the floor of the conductance"
    return (
        f"The film is {how}: smallest H = {smallest:.3g} at X = {x:.3g}, Y = {y:.3g} (half-widths)"
    )


def thinnest(level: Level) -> tuple[float, float, float]:
    """Return the smallest film of a level, between its nodes too, and its X and Y."""
    found = film_summary(level.grid, level.film.h)
    node = float(level.film.h.min())
    return (min(found.minimum, node), *found.minimum_at)


def minimum_open(level: Level, error: float) -> Status:
    """Return ``converged`` with a warning: the relative ``error`` of the minimum exceeds one."""
    grid, (smallest, x, y) = level.grid, thinnest(level)
    factor = 2 ** math.ceil(0.5 * math.log2(error / KNOWN))  # of second order
    nodes = factor * (max(grid.nx, grid.ny) - 1) + 1
    return Status(
        kind="converged",
        message=(
            f"The minimum film, at X = {x:.3g}, Y = {y:.3g} (half-widths), has a relative error of "
            f"about {100 * error:.0f} % on {grid.nx} x {grid.ny} nodes: it is thin, at most about "
            f"H = {(1.0 + error) * smallest:.2g}, but its value is not known."
        ),
        hint=(
            f"If the minimum matters, take numerics.points = {nodes}, which at second order would "
            f"reduce its error to {100 * KNOWN:.0f} %."
        ),
    )


def domain_too_small(groups: Groups, left_out: float) -> Status:
    """Return ``domain_too_small``: the domain truncates ``left_out`` of the film."""
    return _failed(
        "domain_too_small",
        f"At M = {groups.M:.4g} the contact is nearly rigid and carries load far outside the "
        f"domain: the film may be {100 * left_out:.0f} % too thin.",
        "Increase numerics.domain and numerics.points in proportion, or use the formula of "
        "Nijenbanning, Venner and Moes in `tehl explain`, which covers rigid contacts.",
    )


def edge_status(grid: Grid, groups: Groups, central: float) -> Status:
    """Return ``inlet_too_short`` or ``sides_too_close`` if an edge starves the contact.

    The film decreases as ``((X - 1)/(m* - 1))^0.29`` if the meniscus is nearer than
    ``m* = 1 + 3.06 H_c^0.58`` (Hamrock and Dowson 1977, part IV, for the inlet; applied to the
    sides too).

    Parameters
    ----------
    grid : Grid
        Its domain is judged.
    groups : Groups
        Dimensionless groups.
    central : float
        Central film H_c [-].
    """
    needed = 1.0 + 3.06 * max(central, 0.0) ** 0.58
    edges = (
        ("inlet_too_short", "inlet edge at X", grid.domain.x[0]),
        ("sides_too_close", "side edge at Y", grid.domain.y[0]),
        ("sides_too_close", "side edge at Y", grid.domain.y[1]),
    )
    for cause, name, place in edges:
        distance = abs(place)
        if distance < needed and ((distance - 1.0) / (needed - 1.0)) ** 0.29 < STARVED:
            return _failed(
                cause,
                f"The {name} = {place:.3g} starves the contact (M = {groups.M:.4g}): a fully "
                f"flooded film needs {needed:.2g} or more (unit: Hertz half-widths).",
                "Remove numerics.domain: the default domain is large enough.",
            )
    return CONVERGED


def heat_not_balanced(message: str) -> Status:
    """Return ``heat_not_balanced``: the temperatures of the film cannot be right."""
    return _failed(
        "heat_not_balanced",
        message,
        "Take more nodes (numerics.points), more layers (thermal.layers), or less sliding.",
    )


def step_not_settled(
    cause: str, change: float, seconds: float, grid: Grid, transient: Transient
) -> Status:
    """Return ``step_not_settled``: a time step did not converge.

    Parameters
    ----------
    cause : {"diverged", "stalled"}
        How it failed.
    change : float
        Change of P in its last cycle [-].
    seconds : float
        Time at the end of the step [s].
    grid, transient : Grid, Transient
        Finest grid, and settings of the step.
    """
    hint = (
        "Take lower or longer asperities, more nodes (numerics.points), or more cycles per step "
        "(transient.max_cycles)."
    )
    if cause == "stalled" and transient.tolerance < change < NEARLY_CONVERGED:
        hint = (
            f"Set transient.tolerance = {NEARLY_CONVERGED:g} or more (now "
            f"{transient.tolerance:g}): the pressure has nearly converged."
        )
    return Status(
        kind="diverged" if cause == "diverged" else "stalled",
        cause="step_not_settled",
        message=(
            f"The time step to {seconds:.4g} s did not converge on {grid.nx} x {grid.ny} nodes: "
            f"the last change of P is {change:.2g}. The steps before it are kept."
        ),
        hint=hint,
    )


def touching_in_time(seconds: float, level: Level, *, rough: bool) -> Status:
    """Return ``asperity_contact``, or ``film_not_positive`` of smooth surfaces, at a time.

    Parameters
    ----------
    seconds : float
        Time [s].
    level : Level
        The film at that time.
    rough : bool
        Whether the surfaces are rough.
    """
    grid, h = level.grid, level.film.h
    row, column = np.unravel_index(int(np.argmin(h)), h.shape)
    where = (
        f"At {seconds:.4g} s the film is not positive: smallest H = {h.min():.3g} at "
        f"X = {grid.x[column]:.3g}, Y = {grid.y[row]:.3g}"
    )
    if not rough:
        return _failed(
            "film_not_positive",
            f"{where}, between smooth surfaces: the load grows too fast, or beyond the domain. "
            "The steps before it are kept.",
            "Let the load grow more slowly or less, or take more nodes (numerics.points).",
        )
    return _failed(
        "asperity_contact",
        f"{where}. On {grid.nx} x {grid.ny} nodes asperities would touch there, which a film "
        "that carries the whole load does not describe; on a finer grid they may not. The "
        "steps before it are kept.",
        f"Take numerics.points = {2 * max(grid.nx, grid.ny) - 1} to see whether a finer grid "
        "has a film, else lower or longer asperities, or a higher speed.",
    )
