"""Settings that work where a solve failed: they are tried before a hint names them."""

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial

from tehl.base.errors import TehlError
from tehl.base.units import percentage
from tehl.base.wording import grid_size
from tehl.contact.options import Domain, Options
from tehl.contact.problem import ContactProblem
from tehl.estimate.nodes import FAMILIES, planned
from tehl.estimate.scaling import ScaledProblem
from tehl.result.solution import Hint, Settings, Solution, settings_text
from tehl.solver.cost import LEAST_SECONDS, working_time
from tehl.solver.judging.diagnosis import THINNING, error_setting
from tehl.solver.monitor import Monitor

ERRORS = (0.5, 0.2, 0.05)
"""Relative errors of the film that are tried, coarsest first; the smallest that works is named."""
TRIAL_TIME_FACTOR = 3.0
"""Time for the trials over that of the failed solve, up to ``numerics.max_time``."""
Solve = Callable[[ContactProblem, Options], Solution]
SolveOn = Callable[[tuple[int, int]], Solution]
Reached = tuple[tuple[int, int], float]
"""Nodes (nx, ny) and relative error of a film that converged."""
OTHER_GRIDS, LEAST_TRIAL = 2, 0.2
"""Other numbers of nodes that are tried, and least time for that over that of the failed solve:
the sums of a roller on 321 x 321 nodes alone take a sixth of it."""


def meets(found: Solution, error: float) -> bool:
    """Return whether a film converged to a relative error [-]."""
    return found.status.converged and found.errors is not None and found.errors.film() <= error


def solved_on_other_nodes(
    failed: Solution, solve: SolveOn, monitor: Monitor, end: float
) -> Solution | None:
    """Return the film from slightly more nodes on, if one converges there; the best of them.

    On some grids, coarser ones of their hierarchy included, the discrete equations have no
    solution, or one that the cycles do not find, and on others of nearly the same mesh width they
    have one.

    Parameters
    ----------
    failed, monitor, end
        As in `working_hint`.
    solve : callable
        Returns the result of the contact, converged or not, that begins with nodes (nx, ny) and
        may go on to finer grids until the time is over.
    """
    if failed.status.kind not in ("diverged", "stalled") or not failed.history:
        return None
    scaled = ScaledProblem.of(failed.problem)
    lines, nodes = planned(scaled, failed.options).shape
    keeps = scaled.groups.ellipticity < 1.0 or failed.problem.contact.has_lines
    part = (lines - 1) / (nodes - 1)
    part = part if keeps or part > 1.0 else 1.0
    best, least = None, math.inf
    for more in [one for one in sorted(FAMILIES) if one > nodes][:OTHER_GRIDS]:
        if end - working_time() < LEAST_TRIAL * failed.cost.wall_seconds:
            break
        points = (more, 1 if failed.problem.contact.is_line else round(part * (more - 1)) + 1)
        monitor.message(f"trying {grid_size(points)}")
        with suppress(TehlError):
            found = solve(points)
            if meets(found, failed.options.target):
                return found
            error = math.inf if found.errors is None else found.errors.film()
            if found.status.cause == "error_not_reached" and error < least:
                best, least = found, error
    return best


def working_hint(
    failed: Solution, solve: Solve, monitor: Monitor, end: float, reached: Reached | None = None
) -> Hint:
    """Return a hint to settings with which a failed contact converges; without any if none does.

    Parameters
    ----------
    failed : Solution
        The result that did not converge, whose error decides the number of nodes.
    solve : callable
        Returns the result of a contact, converged or not.
    monitor : Monitor
        Receives what is tried.
    end : float
        When ``numerics.max_time`` is over, on the clock of `working_time` [s].
    reached : Reached or None
        The film that converged on the way: nothing worse is named.
    """
    now = working_time()
    enough = now + TRIAL_TIME_FACTOR * failed.cost.wall_seconds
    found, is_short = None, end < enough
    end = max(min(enough, end), now + LEAST_SECONDS)
    least = math.inf if reached is None else reached[1]
    for trials in _trials(failed, least):
        hopeless: set[tuple[int, int]] = set()
        for settings, problem, options in trials:
            if end <= working_time():
                break
            # what fails on a grid for a larger error fails there for a smaller one
            grid = planned(ScaledProblem.of(problem), options).shape
            if grid in hopeless:
                continue
            monitor.message(f"trying a hint: {settings_text(settings)}")
            left = min(_time_of_trial(failed, end), options.max_time)
            limited = options.model_copy(update={"max_time": left})
            works = _tried(settings, partial(solve, problem, limited))
            hopeless |= set() if works else {grid}
            found = works or found
        if found is not None:
            return found
    if reached is not None:
        return _reached(failed.status.hint, reached)
    if is_short and end <= working_time():
        return _untried(failed)
    other = "; lower or longer asperities may" if failed.problem.is_rough else ""
    return Hint(f"No setting is known with which this contact converges{other}.")


def _reached(stated: Hint | None, reached: Reached) -> Hint:
    """Return the hint to an error that was reached; the one ``stated`` where none is as large."""
    (nx, ny), error = reached
    settings = error_setting(error)
    if not settings and stated is not None and stated.advice:
        return stated
    return Hint(f"{grid_size((nx, ny))} converged.", settings)


def _untried(failed: Solution) -> Hint:
    """Return the hint where the time to try settings was over: that to a likely cause, if known."""
    status = failed.status
    named = status.kind == "diverged" and status.cause != "diverged"
    if status.hint is not None and (named or _names_law(failed)):
        return status.hint
    return Hint("The time to try other settings was over: more numerics.max_time tries more.")


def _names_law(failed: Solution) -> bool:
    """Return whether the likely cause is a law of the oil: one without thinning, or Barus'."""
    hint = failed.status.hint
    return hint is not None and any(key.startswith("lubricant.") for key in hint.settings)


def _time_of_trial(failed: Solution, end: float) -> float:
    """Return the time for one trial [s]: that of the failed solve, which tried all strategies.

    All that is left where a law of the oil is the likely cause: such solves diverge at once.
    """
    left = end - working_time()
    if _names_law(failed):
        return left
    return min(left, max(failed.cost.wall_seconds, LEAST_SECONDS))


def _tried(settings: Settings, solve: Callable[[], Solution]) -> Hint | None:
    """Return a hint to settings, None if they do not converge."""
    try:
        result = solve()
    except TehlError:
        return None
    if not result.status.converged or result.errors is None:
        return None
    (ny, nx), error = result.scaled.film.shape, result.errors.film()
    advice = f"{grid_size((nx, ny))} then converge to an error of {percentage(error)}."
    return Hint(advice, settings)


Trial = tuple[Settings, ContactProblem, Options]


def _trials(failed: Solution, least: float) -> list[Iterator[Trial]]:
    """Return what is tried, in this order; ``least``: the error that was reached."""
    others = [_errors(failed, least), _other_physics(failed)]
    if _names_law(failed):  # no error makes up for such an oil
        others.reverse()
    return [_default_domain(failed), *others]


def _default_domain(failed: Solution) -> Iterator[Trial]:
    """Yield the default domain in place of a stated one."""
    if isinstance(failed.options.domain, Domain):
        options = failed.options.model_copy(update={"domain": "auto", "edges": "auto"})
        stated = ("domain", "edges") if failed.options.edges != "auto" else ("domain",)
        yield {f"numerics.{name}": False for name in stated}, failed.problem, options


def _errors(failed: Solution, least: float) -> Iterator[Trial]:
    """Yield larger errors to reach, up to the one that was reached, ``least``.

    From a grid that led to the reached one they would lead there again.
    """
    ended = failed.status.cause == "error_not_reached"
    solved = {one.points for one in failed.history} if ended else set()
    scaled = ScaledProblem.of(failed.problem)
    for error in ERRORS:
        options = failed.options.model_copy(update={"error": error})
        if failed.options.target < error < least and planned(scaled, options).points not in solved:
            yield {"numerics.error": percentage(error)}, failed.problem, options


def _other_physics(failed: Solution) -> Iterator[Trial]:
    """Yield laws of usual oils: Newtonian stresses or Barus' viscosities may have no solution.

    Barus' law grows by the same factor for each further pressure; with Roelands' law and the same
    constants a heated circle of silicon nitride (1.6 GPa, M = 186) converges at once.
    """
    lubricant = failed.problem.lubricant
    changes: list[Settings] = []
    if lubricant.shear.law == "newtonian" and failed.problem.is_coupled:
        changes.append({"lubricant.shear": THINNING})
    if lubricant.viscosity.law == "barus":
        changes.append({"lubricant.viscosity.law": "roelands"})
    both = {key: value for one in changes for key, value in one.items()}
    for settings in (both, *changes) if len(changes) == 2 else changes:
        tables = failed.problem.model_dump(exclude_none=True)
        if "lubricant.shear" in settings:
            tables["lubricant"]["shear"] = THINNING
        if "lubricant.viscosity.law" in settings:
            tables["lubricant"]["viscosity"]["law"] = "roelands"
        yield settings, ContactProblem.model_validate(tables), failed.options
