"""The truth about a run: whether its result may be believed, and if not, why and what to try."""

import numpy as np

from tehl.domain import domain_error
from tehl.grid import Grid
from tehl.operators.energy import FilmState
from tehl.options import Domain
from tehl.result import ErrorEstimate, Result, Status
from tehl.scaling import Groups
from tehl.solver.film_solver import FilmSolver
from tehl.solver.level import Level
from tehl.solver.outputs import heat_balance
from tehl.solver.rough_verdict import (
    LESS_ROUGH,
    VAGUE,
    is_film,
    no_film_before,
    no_film_status,
    vague_status,
)
from tehl.solver.suspects import Suspect, coarse_status, grid_hint, suspect

LARGEST_BAR = 0.5
"""Relative discretisation error of the film beyond which a grid is called too coarse."""
CONVERGED = Status(kind="converged")
LARGEST_DOMAIN_ERROR = 0.1
"""Estimated part of the central film beyond which a domain is called too small."""
LARGEST_COOLING = 5.0
"""How much colder than by adiabatic expansion of all that enters a film may get [K]."""
LARGEST_MISSING_HEAT = 0.3
"""Part of the heat that may be missing: in pure rolling, where there is little of it, the backflow
in the inlet keeps some for long."""
STARVED = 0.9
"""Film over fully flooded film below which an edge is called too close."""


def verdict(run: FilmSolver, cycled_out: bool, errors: ErrorEstimate | None) -> Status:
    """Judge the last state of a run that stayed finite.

    Parameters
    ----------
    run : Multigrid
        After its last cycle, film up to date.
    cycled_out : bool
        Whether the cycles ended without reaching what was asked.
    errors : ErrorEstimate or None
        Estimated errors of the film.
    """
    film = run.finest.film
    if not (np.isfinite(film.p).all() and np.isfinite(film.h).all() and film.p.min() >= 0):
        return diverged(run)
    if cycled_out and run.roughness.is_rough:  # another strategy may converge on this grid
        return _not_reached(run)
    found = _film_status(run, errors)
    if not found.converged:
        return found
    if cycled_out:
        return _not_reached(run)
    rest = _heat_status(run)
    rest = _domain_status(run) if rest.converged else rest
    return found if rest.converged else rest


def _film_status(run: FilmSolver, errors: ErrorEstimate | None) -> Status:
    """Judge whether there is a film, and whether the grid resolves it."""
    level, groups = run.finest, run.groups
    if run.roughness.is_rough and not is_film(level, errors):
        return no_film_status(run, errors)
    if run.roughness.is_rough and errors is not None and errors.iteration_minimum >= 1.0:
        return _not_reached(run)  # further cycles might take it away
    if not run.roughness.is_rough and not level.film.h.min() > level.equations.floor:
        return _film_not_positive(level, groups)
    return _resolution_status(run, errors)


def _resolution_status(run: FilmSolver, errors: ErrorEstimate | None) -> Status:
    """Judge whether the grid resolves the film.

    Between rough surfaces the error of the minimum counts as a part of the film that smooth ones
    would have.
    """
    level, groups = run.finest, run.groups
    if errors is None:
        return CONVERGED
    error, part = errors.discretisation_minimum, 1.0
    if run.roughness.is_rough:
        part = float(level.film.h.min()) / run.hierarchy.expected_film
    if not max(part * error, errors.discretisation_central) <= LARGEST_BAR:
        return coarse_status(level.grid, groups, max(error, errors.discretisation_central))
    return vague_status(level, error) if run.roughness.is_rough and error > VAGUE else CONVERGED


def _domain_status(run: FilmSolver) -> Status:
    """Judge the domain: whether it is large enough, and leaves the contact flooded."""
    level, groups = run.finest, run.groups
    left_out = domain_error(groups, level.grid.domain)
    if left_out > LARGEST_DOMAIN_ERROR:
        return _domain_too_small(groups, left_out)
    # in a dent the film says nothing of the oil that the contact needs
    central = (
        run.hierarchy.expected_film if run.roughness.is_rough else run.traces[-1].central.values[-1]
    )
    return edge_status(level.grid, groups, central)


def _heat_status(run: FilmSolver) -> Status:
    """Judge the temperatures: finite, nowhere far below what enters, and their heat in balance."""
    state = run.coupling.state
    if state is None:
        return CONVERGED
    temperature = state.temperature
    entering = min(state.scales.temperature, *(side.bulk for side in state.sides))
    missing = heat_balance(state).error if state.model.terms.heat else 0.0
    if not np.isfinite(temperature).all():
        message = "The temperature of the film is not finite."
    elif temperature.min() < entering - LARGEST_COOLING - _adiabatic_cooling(state):
        message = (
            f"The film gets {entering - temperature.min():.3g} K colder than all that enters it, "
            "which expansion does not explain."
        )
    elif abs(missing) > LARGEST_MISSING_HEAT:
        message = f"The heat of the film does not balance: {100 * missing:.3g} % of it is missing."
    else:
        return CONVERGED
    return Status(
        kind="not_converged",
        cause="heat_not_balanced",
        message=message,
        hint="Take more nodes (numerics.points) or more layers (thermal.layers), or less sliding.",
    )


def _adiabatic_cooling(state: FilmState) -> float:
    """Return by how much oil cools that expands from p_h and conducts no heat [K]."""
    terms, inlet = state.model.terms, state.scales.temperature
    if not terms.peclet > 0:
        return 0.0
    ambient = state.problem.lubricant.density.ambient
    expansion = 1.0 - ambient(inlet + 1.0) / ambient(inlet)
    return expansion * inlet * terms.compression / terms.peclet


def diverged(run: FilmSolver) -> Status:
    """Return the status of a run that ran away, with its likely cause if one is conspicuous."""
    grid, groups = run.finest.grid, run.groups
    what = (
        f"The iteration diverged on {grid.nx} x {grid.ny} nodes at M = {groups.M:.4g}, "
        f"L = {groups.L:.4g}."
    )
    found, other = _suspect(run), _smoother_hint(run)
    if found is None:
        hint = (
            other
            or (LESS_ROUGH if run.roughness.is_rough else "")
            or (
                f"Nothing about the case is conspicuous: take {grid_hint(grid, groups)}, or come "
                "nearer in steps, from less load, less sliding or a thicker film."
            )
        )
        return Status(kind="diverged", cause="diverged", message=what, hint=hint)
    message = f"{what} A likely cause: {found.message}"
    return Status(kind="diverged", cause=found.cause, message=message, hint=other or found.hint)


def _suspect(run: FilmSolver) -> Suspect | None:
    """Return what is conspicuous about a run that fails."""
    coarser = no_film_before(run)
    if coarser is not None:
        return coarser
    return suspect(run.finest.grid, run.hierarchy.scaled)


def _smoother_hint(run: FilmSolver) -> str:
    """Name the smoother that was not tried, if there is one."""
    tried = run.options.smoother
    if tried == "gauss-seidel":
        return (
            "Plain Gauss-Seidel fails where the deflection rules, on any grid: leave "
            "numerics.smoother out."
        )
    return "" if tried in ("auto", "robust") else "Leave numerics.smoother out: it then falls back."


def _film_not_positive(level: Level, groups: Groups) -> Status:
    grid = level.grid
    return Status(
        kind="not_converged",
        cause="film_not_positive",
        message=(
            f"The discrete film is not positive on {grid.nx} x {grid.ny} nodes: "
            f"smallest H = {level.film.h.min():.3g}; this grid is too coarse for the film."
        ),
        hint=f"Take {grid_hint(grid, groups)}.",
    )


def too_coarse(result: Result, error: float) -> Status:
    """Return the status of a certified result whose error bars are too wide to be of use."""
    x, y = result.scaled.x, result.scaled.y
    domain = Domain(x=(float(x[0]), float(x[-1])), y=(float(y[0]), float(y[-1])))
    return coarse_status(
        Grid(nx=x.size, ny=y.size, domain=domain, mirror=False), result.groups, error
    )


def not_certified(result: Result, why: str) -> Status:
    """Return the status of a finest grid that converged, but has no error bar, and why not."""
    nodes = 2 * max(result.scaled.x.size, result.scaled.y.size) - 1
    return Status(
        kind="not_converged",
        cause="not_certified",
        message=f"The finest grid converged, but no error bar follows from the others: {why}",
        hint=f"Take numerics.points = {nodes}, or solve without certifying.",
    )


def _not_reached(run: FilmSolver) -> Status:
    reports = run.traces[-1].reports
    last = reports[-1]
    worst = max(
        (("residual", last.residual), ("change per cycle", last.change),
         ("load error", abs(last.load_error))),
        key=lambda pair: pair[1],
    )  # fmt: skip
    stalled = len(reports) < run.options.max_cycles * run.strategy.patience
    wanted = (
        f"the tolerance is {run.options.tolerance:.1e}"
        if run.options.accuracy == "tight"
        else "the film still changes by more than a third of its discretisation error"
    )
    message = (
        f"After {len(reports)} cycles on {last.points[0]} x {last.points[1]} nodes the "
        f"{worst[0]} is {worst[1]:.1e}; {wanted}."
    )
    if run.options.accuracy == "change":
        hint = "Leave numerics.accuracy out: a small change in one cycle is no error estimate."
        return Status(kind="not_converged", cause="too_few_cycles", message=message, hint=hint)
    if not stalled:
        hint = "Raise numerics.max_cycles."
        return Status(kind="not_converged", cause="too_few_cycles", message=message, hint=hint)
    found, hint = _suspect(run), f"Take {grid_hint(run.finest.grid, run.groups)}."
    if found is not None:
        message, hint = f"{message} A likely cause: {found.message}", found.hint
    return Status(
        kind="stalled", cause="stalled", message=message, hint=_smoother_hint(run) or hint
    )


def _domain_too_small(groups: Groups, left_out: float) -> Status:
    return Status(
        kind="not_converged",
        cause="domain_too_small",
        message=(
            f"At M = {groups.M:.4g} the contact is nearly rigid and carries load far outside the "
            f"domain: the film may be {100 * left_out:.0f} % too thin."
        ),
        hint=(
            "Widen numerics.domain with numerics.points in proportion, or take the formula of "
            "Nijenbanning, Venner and Moes in `tehl explain`, which covers rigid contacts."
        ),
    )


def edge_status(grid: Grid, groups: Groups, central: float) -> Status:
    """Return converged, or which edge starves the contact.

    The film falls as ``((X - 1)/(m* - 1))^0.29`` once the meniscus is nearer than
    ``m* = 1 + 3.06 H_c^0.58`` (Hamrock and Dowson 1977, part IV, for the inlet; taken for the sides
    too).
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
            return Status(
                kind="not_converged",
                cause=cause,
                message=(
                    f"The {name} = {place:.3g} starves the contact (M = {groups.M:.4g}): a fully "
                    f"flooded film needs {needed:.2g} or more (unit: Hertz half-widths)."
                ),
                hint="Leave numerics.domain out: the default is wide enough.",
            )
    return CONVERGED
