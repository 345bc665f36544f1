"""Settings that work where a solve failed: they are tried before a hint names them."""

import time
from collections.abc import Callable, Iterator
from functools import partial

from tehl.errors import TehlError
from tehl.options import Domain, Options
from tehl.problem import ContactProblem
from tehl.result import Result
from tehl.solution import Hint, Settings, settings_text
from tehl.solver.monitor import Monitor
from tehl.units import percentage

ERRORS = (0.5, 0.2, 0.05)
"""Relative errors of the film that are tried, coarsest first; the smallest that works is named."""
THINNING = {"law": "eyring", "stress": "5 MPa"}
"""The shear law of a usual oil."""
LONGER = 3.0
"""Time for the trials over that of the failed solve, up to ``numerics.max_time``."""
LEAST_SECONDS = 1.0
"""Least time for the trials."""
Solve = Callable[[ContactProblem, Options], Result]


def working_hint(failed: Result, solve: Solve, monitor: Monitor) -> Hint:
    """Return a hint to settings with which a failed contact converges; without any if none does.

    Parameters
    ----------
    failed : Result
        The result that did not converge, whose error decides the number of nodes.
    solve : callable
        Returns the result of a contact, converged or not.
    monitor : Monitor
        Receives what is tried.
    """
    limit = min(LONGER * failed.cost.wall_seconds, failed.options.max_time)
    end = time.perf_counter() + max(limit, LEAST_SECONDS)
    found = None
    for trials in (_default_domain(failed), _errors(failed), _other_physics(failed)):
        for settings, problem, options in trials:
            left = end - time.perf_counter()
            if left <= 0.0:
                break
            monitor.message(f"trying a hint: {settings_text(settings)}")
            limited = options.model_copy(update={"max_time": min(left, options.max_time)})
            found = _tried(settings, partial(solve, problem, limited)) or found
        if found is not None:
            return found
    return Hint("No setting is known with which this contact converges.")


def _tried(settings: Settings, solve: Callable[[], Result]) -> Hint | None:
    """Return a hint to settings, None if they do not converge."""
    try:
        result = solve()
    except TehlError:
        return None
    if not result.status.converged or result.errors is None:
        return None
    (ny, nx), error = result.scaled.film.shape, max(result.errors.central, result.errors.minimum)
    advice = f"{nx} x {ny} nodes then converge to an error of {percentage(error)}."
    return Hint(advice, settings)


Trial = tuple[Settings, ContactProblem, Options]


def _default_domain(failed: Result) -> Iterator[Trial]:
    """Yield the default domain in place of a stated one."""
    if isinstance(failed.options.domain, Domain):
        options = failed.options.model_copy(update={"domain": "auto", "edges": "auto"})
        yield {"numerics.domain": False, "numerics.edges": False}, failed.problem, options


def _errors(failed: Result) -> Iterator[Trial]:
    """Yield larger errors to reach, that of the present hint included."""
    settings = failed.status.hint.settings if failed.status.hint else {}
    named = Options.model_validate({"error": settings.get("numerics.error", ERRORS[0])}).target
    for error in sorted({*ERRORS, named}, reverse=True):
        if error > failed.options.target:
            options = failed.options.model_copy(update={"error": error})
            yield {"numerics.error": percentage(error)}, failed.problem, options


def _other_physics(failed: Result) -> Iterator[Trial]:
    """Yield a Newtonian contact with a usual shear law: Newtonian stresses may have no solution."""
    if failed.problem.lubricant.shear.law != "newtonian" or not failed.problem.is_coupled:
        return
    tables = failed.problem.model_dump(exclude_none=True)
    tables["lubricant"]["shear"] = THINNING
    yield {"lubricant.shear": THINNING}, ContactProblem.model_validate(tables), failed.options
