"""Judgement of a finished run: converged, or which status of `tehl.solver.statuses`."""

from dataclasses import replace

import numpy as np

from tehl.domain import domain_error
from tehl.operators.energy import FilmState
from tehl.result import ErrorEstimate, Status
from tehl.solver.diagnosis import LikelyCause, grid_hint, likely_cause
from tehl.solver.film_solver import FilmSolver
from tehl.solver.film_summary import film_summary
from tehl.solver.level import Level
from tehl.solver.outputs import heat_balance
from tehl.solver.statuses import (
    CONVERGED,
    LESS_ROUGH,
    asperity_contact,
    domain_too_small,
    edge_status,
    film_not_positive,
    heat_not_balanced,
    minimum_open,
    no_film,
    thinnest,
    too_coarse,
)

LARGEST_BAR = 0.5
"""Relative discretisation error of the film beyond which a grid is too coarse."""
OPEN = 1.0
"""Relative error of the minimum between rough surfaces beyond which its value is not known. It is
one spot beside an asperity: the rest of the film may be accurate, so the result is valid."""
BELOW_FLOOR = 0.5
"""Least film between rough surfaces over the floor of the conductance: a thinner one flows as if it
were another film."""
LARGEST_DOMAIN_ERROR = 0.1
"""Estimated part of the central film beyond which a domain is too small."""
LARGEST_COOLING = 5.0
"""Largest temperature of a film below that of all that enters it and expands adiabatically [K]."""
LARGEST_MISSING_HEAT = 0.3
"""Largest error of the heat balance over the heat that is turned over. In pure rolling, with little
heat, the backflow in the inlet stores some for many sweeps."""


def verdict(run: FilmSolver, reached: bool, errors: ErrorEstimate | None) -> Status:
    """Judge the last state of a run that stayed finite.

    Parameters
    ----------
    run : FilmSolver
        After its last cycle, with the film up to date.
    reached : bool
        Whether the cycles met the stopping criterion.
    errors : ErrorEstimate or None
        Estimated errors of the film.
    """
    film = run.finest.film
    if not (np.isfinite(film.p).all() and np.isfinite(film.h).all() and film.p.min() >= 0):
        return diverged(run)
    if not reached and run.roughness.is_rough:  # another strategy may converge on this grid
        return _not_reached(run)
    found = _film_status(run, errors)  # a grid too coarse explains cycles that do not converge
    if not found.converged:
        return found
    if not reached:
        return _not_reached(run)
    rest = _heat_status(run)
    rest = _domain_status(run) if rest.converged else rest
    return found if rest.converged else rest


def _film_status(run: FilmSolver, errors: ErrorEstimate | None) -> Status:
    """Judge whether the film is positive, and whether the grid resolves it."""
    level, groups = run.finest, run.groups
    if run.roughness.is_rough and not is_film(level, errors):
        return _no_film_status(run, errors)
    if run.roughness.is_rough and errors is not None and errors.iteration_minimum >= 1.0:
        return _not_reached(run)  # further cycles might make the minimum negative
    if not run.roughness.is_rough and not level.film.h.min() > level.equations.floor:
        return film_not_positive(level, groups)
    return _resolution_status(run, errors)


def is_film(level: Level, errors: ErrorEstimate | None) -> bool:
    """Whether the film between rough surfaces is positive, between the nodes too.

    A film slightly below the floor of the conductance is accepted if the floor is within its error.
    """
    smallest, bar = float(level.film.h.min()), 0.0
    if errors is not None:
        bar = errors.discretisation_minimum
    within = (1.0 + bar) * smallest > level.equations.floor
    thick = smallest > BELOW_FLOOR * level.equations.floor
    return thick and within and film_summary(level.grid, level.film.h).minimum > 0.0


def _no_film_status(run: FilmSolver, errors: ErrorEstimate | None) -> Status:
    """Return asperity contact, or a grid too coarse if the error leaves doubt."""
    if errors is not None and errors.discretisation_minimum > OPEN:
        status = too_coarse(run.finest.grid, run.groups, errors.discretisation_minimum)
        return replace(status, message=f"{status.message} {no_film(run.finest)}.")
    return asperity_contact(run.finest)


def touching(run: FilmSolver, part: float) -> Status:
    """Return the status of a film that is not positive with only ``part`` of the heights."""
    status = _no_film_status(run, run.errors())
    message = f"{status.message} The film shown has {100 * part:.0f} % of the heights."
    return replace(status, message=message)


def _resolution_status(run: FilmSolver, errors: ErrorEstimate | None) -> Status:
    """Judge whether the grid resolves the film.

    Between rough surfaces the error of the minimum counts relative to the smooth film.
    """
    level, groups = run.finest, run.groups
    if errors is None:
        return CONVERGED
    error, part = errors.discretisation_minimum, 1.0
    if run.roughness.is_rough:
        part = float(level.film.h.min()) / run.hierarchy.expected_film
    if not max(part * error, errors.discretisation_central) <= LARGEST_BAR:
        return too_coarse(level.grid, groups, max(error, errors.discretisation_central))
    return minimum_open(level, error) if run.roughness.is_rough and error > OPEN else CONVERGED


def _domain_status(run: FilmSolver) -> Status:
    """Judge whether the domain is large enough, and the contact fully flooded."""
    level, groups = run.finest, run.groups
    left_out = domain_error(groups, level.grid.domain)
    if left_out > LARGEST_DOMAIN_ERROR:
        return domain_too_small(groups, left_out)
    # the central film may lie in a dent; the oil that the contact needs follows from the formula
    central = (
        run.hierarchy.expected_film if run.roughness.is_rough else run.traces[-1].central.values[-1]
    )
    return edge_status(level.grid, groups, central)


def _heat_status(run: FilmSolver) -> Status:
    """Judge the temperatures: finite, not too far below what enters, and their heat in balance."""
    state = run.coupling.state
    if state is None:
        return CONVERGED
    temperature = state.temperature
    entering = min(state.scales.temperature, *(side.bulk for side in state.sides))
    missing = heat_balance(state).error if state.model.terms.heat else 0.0
    if not np.isfinite(temperature).all():
        return heat_not_balanced("The temperature of the film is not finite.")
    if temperature.min() < entering - LARGEST_COOLING - _adiabatic_cooling(state):
        return heat_not_balanced(
            f"The film is {entering - temperature.min():.3g} K colder than all that enters it, "
            "more than adiabatic expansion explains."
        )
    if abs(missing) > LARGEST_MISSING_HEAT:
        return heat_not_balanced(
            f"The heat of the film does not balance: {100 * missing:.3g} % of it is missing."
        )
    return CONVERGED


def _adiabatic_cooling(state: FilmState) -> float:
    """Return the cooling of oil that expands from p_h without conduction [K]."""
    terms, inlet = state.model.terms, state.scales.temperature
    if not terms.peclet > 0:
        return 0.0
    ambient = state.problem.lubricant.density.ambient
    expansion = 1.0 - ambient(inlet + 1.0) / ambient(inlet)
    return expansion * inlet * terms.compression / terms.peclet


def diverged(run: FilmSolver) -> Status:
    """Return the status of a run that diverged, with its likely cause."""
    grid, groups = run.finest.grid, run.groups
    what = (
        f"The iteration diverged on {grid.nx} x {grid.ny} nodes at M = {groups.M:.4g}, "
        f"L = {groups.L:.4g}."
    )
    found, other = _likely_cause(run), _smoother_hint(run)
    if found is None:
        hint = (
            other
            or (LESS_ROUGH if run.roughness.is_rough else "")
            or (
                f"Take {grid_hint(grid, groups)}, or approach the case in steps from less load, "
                "less sliding or a thicker film: it has no evident cause of failure."
            )
        )
        return Status(kind="diverged", cause="diverged", message=what, hint=hint)
    message = f"{what} Likely cause: {found.message}"
    return Status(kind="diverged", cause=found.cause, message=message, hint=other or found.hint)


def _not_reached(run: FilmSolver) -> Status:
    """Return the status of a run whose cycles stalled, or ended before they converged."""
    options, reports = run.options, run.traces[-1].reports
    last = reports[-1]
    numbers = {
        "residual": last.residual,
        "change per cycle": last.change,
        "load error": abs(last.load_error),
    }
    worst = max(numbers, key=lambda name: numbers[name])
    wanted = (
        f"the tolerance is {options.tolerance:.1e}"
        if options.accuracy == "tight"
        else "the film still changes by more than a third of its discretisation error"
    )
    message = (
        f"After {len(reports)} cycles on {last.points[0]} x {last.points[1]} nodes the "
        f"{worst} is {numbers[worst]:.1e}; {wanted}."
    )
    hint = "Increase numerics.max_cycles."
    if options.accuracy == "change":
        hint = "Remove numerics.accuracy: a small change per cycle is not an error estimate."
    if options.accuracy == "change" or len(reports) >= options.max_cycles * run.strategy.patience:
        return Status(kind="not_converged", cause="too_few_cycles", message=message, hint=hint)
    found, hint = _likely_cause(run), f"Take {grid_hint(run.finest.grid, run.groups)}."
    if found is not None:
        message, hint = f"{message} Likely cause: {found.message}", found.hint
    return Status(
        kind="stalled", cause="stalled", message=message, hint=_smoother_hint(run) or hint
    )


def _likely_cause(run: FilmSolver) -> LikelyCause | None:
    """Return the likely cause of a failed run: the coarser film, or the contact."""
    if not run.coarser_film_is_negative:
        return likely_cause(run.finest.grid, run.hierarchy.scaled)
    level = run.levels[-2]
    smallest, x, y = thinnest(level)
    return LikelyCause(
        cause="grid_too_coarse",
        message=(
            f"The film of the next coarser grid, of {level.grid.nx} x {level.grid.ny} nodes, is "
            f"not positive (smallest H = {smallest:.3g} at X = {x:.3g}, Y = {y:.3g} half-widths), "
            "so it is not a start for this one."
        ),
        hint=LESS_ROUGH,
    )


def _smoother_hint(run: FilmSolver) -> str:
    """Return the hint to remove a stated smoother, empty if the default was used."""
    tried = run.options.smoother
    if tried == "gauss-seidel":
        return (
            "Remove numerics.smoother: plain Gauss-Seidel diverges on any grid where the elastic "
            "deflection dominates."
        )
    if tried in ("auto", "robust"):
        return ""
    return "Remove numerics.smoother: the default falls back to more robust settings."
