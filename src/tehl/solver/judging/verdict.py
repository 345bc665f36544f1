"""Judgement of a finished run: converged, or why not.

A status has the name of its cause for programs, a message with the numbers, and a hint with an
action.
"""

import math
from dataclasses import replace

import numpy as np

from tehl.base.units import percentage
from tehl.base.wording import grid_size
from tehl.estimate.domain import domain_error
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.starvation import is_starved
from tehl.operators.energy import FilmState
from tehl.result.bars import ErrorEstimate
from tehl.result.solution import Hint, Status
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.level import Level
from tehl.solver.judging.balance import LARGEST_MISSING_OIL
from tehl.solver.judging.convergence import LARGEST_LOAD_ERROR
from tehl.solver.judging.diagnosis import (
    LESS_ROUGH,
    cause_by_the_oil,
    diverged,
    error_setting,
    grid_hint,
    not_reached,
    thinnest,
)
from tehl.solver.judging.ends import missed_at_ends, pressed_at_end, thinnest_at_end
from tehl.solver.judging.film_errors import misses_ends
from tehl.solver.judging.film_summary import film_summary
from tehl.solver.judging.goal import TOO_THIN
from tehl.solver.judging.measures import is_resolved, is_thinnest_at_end
from tehl.solver.judging.outputs import asperity_balance, contact_balance, heat_balance

CONVERGED = Status(kind="converged")
TOO_COARSE = ("grid_too_coarse", "film_not_positive")
"""Causes that a finer grid removes."""
LARGEST_FILM_BAR = 0.5
"""Relative discretisation error of the film beyond which a grid is too coarse."""
UNKNOWN_MINIMUM_ERROR = 1.0
"""Relative error of the minimum between rough surfaces beyond which its value is not known. It is
one spot beside an asperity: the rest of the film may be accurate, so the result is valid."""
BELOW_FLOOR = 0.5
"""Least film between rough surfaces over the floor of the conductance: a thinner one flows as if it
were another film."""
HINTED_FILM_ERROR = 0.5
"""Relative error of the minimum film at which the hint to a finer grid aims."""
LARGEST_DOMAIN_ERROR = 0.1
"""Estimated part of the central film beyond which a domain is too small."""
NEGATIVE = 1e-3
"""Pressure of the oil below zero that is accepted between asperities [-]: an iteration error."""
STARVED = 0.9
"""Film over fully flooded film below which an edge is too close."""
LARGEST_COOLING = 5.0
"""Largest temperature of a film below that of all that enters it and expands adiabatically [K]."""
LARGEST_MISSING_HEAT = 0.3
"""Largest error of the heat balance over the heat that is turned over. In pure rolling, with little
heat, the backflow in the inlet stores some for many sweeps."""


def verdict(run: FilmSolver, *, reached: bool) -> Status:
    """Judge the last state of a run that stayed finite, with its film up to date.

    Parameters
    ----------
    run : FilmSolver
        With its finest level and error estimates.
    reached : bool
        Whether the cycles met the stopping criterion.
    """
    film, errors = run.finest.film, run.errors()
    finite = np.isfinite(film.p).all() and np.isfinite(film.h).all()
    if not (finite and film.p.min() >= -NEGATIVE):
        return diverged(run)
    another = run.roughness.is_rough or is_starved(run.hierarchy.scaled) or run.leads_away()
    if not reached and another:  # another strategy may converge on this grid
        return not_reached(run)
    found = _rough_status(run, errors) if run.roughness.is_rough else _smooth_status(run, errors)
    if found.cause in TOO_COARSE and run.goal.obstacle:
        return replace(found, message=f"{found.message} But {run.goal.obstacle}.")
    # a grid too coarse explains cycles that do not converge
    if found.converged and not reached:
        return not_reached(run)
    for judge in (_load_status, _oil_status, _heat_status, _domain_status, _error_status):
        if found.converged and not (status := judge(run)).converged:
            return status
    return found


def _failed(cause: str, message: str, hint: Hint) -> Status:
    return Status(kind="not_converged", cause=cause, message=message, hint=hint)


def too_coarse(points: tuple[int, int], scaled: ScaledProblem, error: float) -> Status:
    """Return ``grid_too_coarse``: the error of the film is too large.

    Parameters
    ----------
    points, scaled : (int, int), ScaledProblem
        Nodes (nx, ny) of the finest grid, and the contact.
    error : float
        Relative error of the film [-].
    """
    size = "above 100 %" if error > 1.0 else f"{100 * error:.0f} %"
    return _failed(
        "grid_too_coarse",
        f"The grid of {grid_size(points)} is too coarse for the film: its estimated "
        f"relative error is {size}.",
        grid_hint(points, scaled),
    )


def _smooth_status(run: FilmSolver, errors: ErrorEstimate | None) -> Status:
    """Judge whether the film between smooth surfaces is positive and resolved by the grid."""
    level, points = run.finest, run.finest.grid.points
    smallest = level.film.h.min()
    if not is_resolved(level):
        least = f"thinner than its equations are solved for, H = {level.equations.floor:.3g},"
        return _failed(
            "film_not_positive",
            f"The discrete film is {'not positive' if smallest <= 0.0 else least} on "
            f"{grid_size(points)} (smallest H = {smallest:.3g}): the grid is too coarse for the "
            "film.",
            grid_hint(points, run.hierarchy.scaled),
        )
    if errors is None:
        return CONVERGED
    error = errors.discretisation_central
    if errors.minimum_has_limit:
        error = max(error, errors.discretisation_minimum)
    if error > LARGEST_FILM_BAR:
        return too_coarse(points, run.hierarchy.scaled, error)
    return _ends_status(run, errors)


def _ends_status(run: FilmSolver, errors: ErrorEstimate) -> Status:
    """Return ``converged``, with a warning where the ends of a roller leave a value open."""
    level = run.finest
    if misses_ends(level, run.hierarchy):
        return missed_at_ends(level)
    if is_thinnest_at_end(level):
        return thinnest_at_end(level, is_pressed=not errors.pressure_has_limit)
    is_open = not (errors.minimum_has_limit and errors.pressure_has_limit)
    return pressed_at_end(level, thins=not errors.minimum_has_limit) if is_open else CONVERGED


def _rough_status(run: FilmSolver, errors: ErrorEstimate | None) -> Status:
    """Judge whether the film between rough surfaces is positive and resolved by the grid.

    The error of its minimum counts relative to the smooth film.
    """
    level = run.finest
    if level.equations.solids.contact_film is None and not is_film(level, errors):
        return _no_film_status(run, errors)
    if errors is None:
        return CONVERGED
    if errors.iteration_minimum >= 1.0:
        return not_reached(run)  # further cycles might make the minimum negative
    error = errors.discretisation_minimum if errors.minimum_has_limit else 0.0
    part = run.minimum_part()
    if not max(part * error, errors.discretisation_central) <= LARGEST_FILM_BAR:
        largest = max(error, errors.discretisation_central)
        return too_coarse(level.grid.points, run.hierarchy.scaled, largest)
    if error > UNKNOWN_MINIMUM_ERROR:
        return _minimum_open(level, error)
    return _ends_status(run, errors)


def _minimum_open(level: Level, error: float) -> Status:
    """Return ``converged`` with a warning: the relative ``error`` of the minimum exceeds one."""
    smallest, x, y = thinnest(level)
    factor = 2 ** math.ceil(0.5 * math.log2(error / HINTED_FILM_ERROR))  # of second order
    nodes = factor * (max(level.grid.points) - 1) + 1
    return Status(
        kind="converged",
        message=(
            f"The minimum film, at X = {x:.3g}, Y = {y:.3g} (half-widths), has a relative error of "
            f"about {100 * error:.0f} % on {grid_size(level.grid.points)}: it is thin, at "
            f"most about H = {(1.0 + error) * smallest:.2g}, but its value is not known."
        ),
        hint=Hint(
            f"at second order this would reduce the error of the minimum to "
            f"{100 * HINTED_FILM_ERROR:.0f} %.",
            {"numerics.points": nodes},
        ),
    )


def is_film(level: Level, errors: ErrorEstimate | None) -> bool:
    """Whether the film between rough surfaces is positive, between the nodes too.

    A film slightly below the floor of the conductance is accepted if the floor is within its error.

    Parameters
    ----------
    level : Level
        Finest level.
    errors : ErrorEstimate or None
        Its relative error of the minimum widens the acceptance, None does not.
    """
    smallest, bar = float(level.film.h.min()), 0.0
    if errors is not None:
        bar = errors.discretisation_minimum
    within = (1.0 + bar) * smallest > level.equations.floor
    thick = smallest > BELOW_FLOOR * level.equations.floor
    return thick and within and film_summary(level.grid, level.film.h).minimum > 0.0


def _no_film_status(run: FilmSolver, errors: ErrorEstimate | None) -> Status:
    """Return asperity contact, or a grid too coarse if the error leaves doubt."""
    (nx, ny), floor = run.finest.grid.points, run.finest.equations.floor
    if errors is not None and errors.discretisation_minimum > UNKNOWN_MINIMUM_ERROR:
        status = too_coarse((nx, ny), run.hierarchy.scaled, errors.discretisation_minimum)
        return replace(status, message=f"{status.message} {no_film(run.finest)}.")
    thin = int(np.count_nonzero(run.finest.film.h <= floor))
    message = (
        f"{no_film(run.finest)}, on {grid_size((nx, ny))} of which {thin} are below "
        f"H = {floor:.2g}. Asperities would touch there, which a film that carries the whole "
        "load does not describe."
    )
    oil = cause_by_the_oil(run.hierarchy.scaled)
    if oil is None:
        return _failed("asperity_contact", message, LESS_ROUGH)
    return _failed("asperity_contact", f"{message} Likely cause: {oil.message}", oil.hint)


def no_film(level: Level) -> str:
    """Return the value of the smallest film, its place, and what is wrong with it."""
    smallest, x, y = thinnest(level)
    how = "not positive"
    if smallest > 0.0:
        how = f"thinner than H = {level.equations.floor:.2g}, the floor of the conductance"
    return (
        f"The film is {how}: smallest H = {smallest:.3g} at X = {x:.3g}, Y = {y:.3g} (half-widths)"
    )


def touching(run: FilmSolver, part: float) -> Status:
    """Return the status of a film that is positive only with lower heights.

    Parameters
    ----------
    run : FilmSolver
        Stopped while heights were raised.
    part : float
        Part of the heights that the film shown has, 0 to 1.
    """
    status = _no_film_status(run, run.errors())
    message = f"{status.message} The film shown has {100 * part:.0f} % of the heights."
    return replace(status, message=message)


def _domain_status(run: FilmSolver) -> Status:
    """Judge whether a domain with zero pressure on its edges is large enough and fully flooded."""
    grid, groups = run.finest.grid, run.groups
    if is_starved(run.hierarchy.scaled):
        return _inlet_status(run)
    if run.finest.far_field is not None:
        return CONVERGED
    left_out = domain_error(groups, grid.domain)
    if left_out > LARGEST_DOMAIN_ERROR:
        return _failed(
            "domain_too_small",
            f"At M = {groups.M:.4g} the contact is nearly rigid and carries load far outside the "
            f"domain: the film may be {100 * left_out:.0f} % too thin.",
            Hint(
                "the default domain has the pressure of the far field on its edges.",
                {"numerics.domain": False, "numerics.edges": False},
            ),
        )
    return _edge_status(run)


def _inlet_status(run: FilmSolver) -> Status:
    """Judge whether the film of a starved contact begins within the domain."""
    grid, film = run.finest.grid, run.finest.film
    if not film.p[int(np.argmin(np.abs(grid.y))), 1] > 0.0:
        return CONVERGED
    return _failed(
        "inlet_too_short",
        f"The gap is full at the inlet edge X = {grid.domain.x[0]:.3g}: the meniscus of the "
        "supply lies upstream of it (unit: Hertz half-widths).",
        Hint("the default domain holds all of the film.", {"numerics.domain": False}),
    )


def _edge_status(run: FilmSolver) -> Status:
    """Return ``inlet_too_short`` or ``sides_too_close`` if an edge starves the contact.

    The film decreases as ``((X - 1)/(m* - 1))^0.29`` if the meniscus is nearer than
    ``m* = 1 + 3.06 H_c^0.58`` (Hamrock and Dowson 1977, part IV, for the inlet; applied to the
    sides too).
    """
    # the central film may lie in a dent; the oil that the contact needs follows from the formula
    central = (
        run.hierarchy.expected_film if run.roughness.is_rough else run.traces[-1].central.values[-1]
    )
    domain = run.finest.grid.domain
    needed = 1.0 + 3.06 * max(central, 0.0) ** 0.58
    edges = (
        ("inlet_too_short", "inlet edge at X", domain.x[0]),
        ("sides_too_close", "side edge at Y", domain.y[0]),
        ("sides_too_close", "side edge at Y", domain.y[1]),
    )
    for cause, name, place in edges[: 3 if run.finest.grid.edge_rows else 1]:
        distance = abs(place)
        if distance < needed and ((distance - 1.0) / (needed - 1.0)) ** 0.29 < STARVED:
            return _failed(
                cause,
                f"The {name} = {place:.3g} starves the contact (M = {run.groups.M:.4g}): a fully "
                f"flooded film needs {needed:.2g} or more (unit: Hertz half-widths).",
                Hint("the default domain is large enough.", {"numerics.domain": False}),
            )
    return CONVERGED


def _load_status(run: FilmSolver) -> Status:
    """Judge whether the stored pressure carries the load."""
    error = run.finest.load_error()
    return not_reached(run) if abs(error) > LARGEST_LOAD_ERROR else CONVERGED


def _oil_status(run: FilmSolver) -> Status:
    """Judge whether a film that shares its load conserves oil: its flow follows from what touches.

    A film that carries all converges by its residual.
    """
    level = run.finest
    if level.equations.solids.asperities is not None:
        missing = asperity_balance(level)
    elif level.equations.solids.contact_film is not None:
        missing = contact_balance(level)
    else:
        return CONVERGED
    if missing <= LARGEST_MISSING_OIL:
        return CONVERGED
    return _failed(
        "oil_not_balanced",
        f"The oil of the film does not balance on {grid_size(level.grid.points)}: "
        f"the mass-balance error is {percentage(missing)} of the inflow.",
        grid_hint(level.grid.points, run.hierarchy.scaled),
    )


def _error_status(run: FilmSolver) -> Status:
    """Judge whether the film is as accurate as stated."""
    errors, goal = run.errors(), run.goal
    if not goal.is_open or errors is None or goal.is_met(errors, run.minimum_part()):
        return CONVERGED
    nodes = grid_size(run.finest.grid.points)
    settings = error_setting(errors.film(run.minimum_part()))
    minimum, target = " film", percentage(run.options.target)
    if errors.minimum_has_limit:
        minimum = f" and {percentage(errors.minimum)} of the minimum film"
    return _failed(
        "error_not_reached",
        f"The error bars on {nodes} are {percentage(errors.central)} of the central{minimum}, "
        f"above numerics.error = {target}: {goal.obstacle or 'the next grid does not converge'}.",
        Hint(settings=settings) if settings else Hint(goal.advice or TOO_THIN),
    )


def _heat_status(run: FilmSolver) -> Status:
    """Judge the temperatures: finite, not too far below what enters, and their heat in balance."""
    state = run.coupling.state
    if state is None:
        return CONVERGED
    temperature = state.temperature
    entering = min(state.film.scaled.scales.temperature, *(side.bulk for side in state.film.sides))
    missing = heat_balance(state).error if state.model.terms.heat else 0.0
    if not np.isfinite(temperature).all():
        message = "The temperature of the film is not finite."
    elif temperature.min() < entering - LARGEST_COOLING - _adiabatic_cooling(state):
        message = (
            f"The film is {entering - temperature.min():.3g} K colder than all that enters it, "
            "more than adiabatic expansion explains."
        )
    elif abs(missing) > LARGEST_MISSING_HEAT:
        message = f"The heat of the film does not balance: {100 * missing:.3g} % of it is missing."
    else:
        return CONVERGED
    return _failed(
        "heat_not_balanced",
        message,
        Hint("Take more nodes (numerics.points), more layers (thermal.layers), or less sliding."),
    )


def _adiabatic_cooling(state: FilmState) -> float:
    """Return the cooling of oil that expands from p_h without conduction [K]."""
    terms, inlet = state.model.terms, state.film.scaled.scales.temperature
    if not terms.peclet > 0:
        return 0.0
    ambient = state.film.scaled.problem.lubricant.density.ambient
    expansion = 1.0 - ambient(inlet + 1.0) / ambient(inlet)
    return expansion * inlet * terms.compression / terms.peclet
