"""Steady films between bodies whose temperatures follow from the heat of the contact.

The film is that of a contact between bodies of stated temperatures, solved anew until each body
passes on the heat that enters it (docs/theory/thermal.md on temperatures of the bodies).
"""

from dataclasses import replace

from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.estimate.bodies import RUNAWAY, NotBalancedError, balanced
from tehl.post.bodies import heat_into_bodies
from tehl.result.solution import ConvergenceError, Cost, Hint, Solution, Status
from tehl.solver import steady
from tehl.solver.cost import end_of_time
from tehl.solver.monitor import SILENT, Monitor

HINT = Hint(
    "Lower the thermal resistance of the bodies, the sliding or the load; or state the temperature "
    "of the bodies."
)
FILM_CAUSES = ("error_not_reached",)
"""Causes of failure of films whose heat is as good as their error bars."""


def solve(
    problem: ContactProblem,
    options: Options | None = None,
    *,
    guess: Solution | None = None,
    monitor: Monitor = SILENT,
    until: float | None = None,
) -> Solution:
    """Solve a steady contact by full multigrid.

    Parameters
    ----------
    problem : ContactProblem
        The contact in SI. Temperatures of bodies with a thermal resistance are computed.
    options : Options
        Numerical options; the defaults if left out.
    guess : Solution
        The film of a similar contact. The finest grid starts from it if ``options.accuracy`` is
        "tight" and its residual is much smaller than that of the interpolated coarser film; at
        other accuracies it saves nothing. The result is the same, to the tolerance.
    monitor : Monitor
        Receives the report of each cycle, and a message for each film between bodies whose
        temperatures are computed; cycles of the first of them only.
    until : float
        When the time is over, on the clock of `working_time` [s]; that of the options if left
        out.

    Returns
    -------
    Solution
        Film and pressure with estimated errors.

    Raises
    ------
    ConvergenceError
        When the solver did not converge; its ``result`` is the last finite state.
    InputError
        When the grid does not fit into the memory, or a measured surface cannot be read.
    """
    if not problem.computes_bodies:
        return steady.solve(problem, options, guess=guess, monitor=monitor, until=until)
    films = _Films(problem, options, guess, monitor, until)
    try:
        bodies = balanced(problem, films.heats)
    except NotBalancedError as error:
        raise films.failure(error) from None
    if problem.dynamics is not None:
        films.contact = problem
        films.heats(*bodies)
    result = films.result
    if not result.status.converged:
        raise ConvergenceError(result.status.message or "not converged", result)
    return result


class _Films:
    """The films of a contact, one for each pair of temperatures of its bodies."""

    def __init__(
        self,
        problem: ContactProblem,
        options: Options | None,
        guess: Solution | None,
        monitor: Monitor,
        until: float | None,
    ) -> None:
        self.until = end_of_time(options or Options()) if until is None else until
        self.problem, self.options, self.monitor = problem, options, monitor
        self.contact = problem.model_copy(update={"dynamics": None})  # those of the last are kept
        self.guess, self.cost = guess, Cost(cpu_seconds=0.0, wall_seconds=0.0)
        self.last: ConvergenceError | None = None
        self.is_begun = False

    def heats(self, first: float, second: float) -> tuple[float, float] | None:
        """Return the heat into both bodies at their temperatures [W]; None if the film fails."""
        between = self.contact.with_bodies(first, second)
        self.last, cycles = None, SILENT if self.is_begun else self.monitor
        try:
            found = steady.solve(
                between, self.options, guess=self.guess, monitor=cycles, until=self.until
            )
        except ConvergenceError as error:
            self.last, found = error, error.result
        self.cost += found.cost
        self.result = found.but(problem=self.problem, bodies=(first, second), cost=self.cost)
        if found.heat is None or not (found.status.converged or found.status.cause in FILM_CAUSES):
            if self.last is not None and not self.is_begun:
                raise ConvergenceError(str(self.last), self.result) from None
            return None
        self.guess, self.is_begun = found, True
        heat = heat_into_bodies(self.result)
        self.monitor.message(
            f"bodies at {first - 273.15:.4g} and {second - 273.15:.4g} degC: "
            f"{heat[0]:.4g} and {heat[1]:.4g} W"
        )
        return heat

    def failure(self, error: NotBalancedError) -> ConvergenceError:
        """Return why the bodies are not balanced: the status of a film that failed, if one did."""
        status = self.result.status
        if self.last is None or error.cause == RUNAWAY:
            status = Status(kind="not_converged", cause=error.cause, message=str(error), hint=HINT)
        else:
            status = replace(status, message=f"{error} {status.message}")
        return ConvergenceError(str(status.message), self.result.but(status=status))
