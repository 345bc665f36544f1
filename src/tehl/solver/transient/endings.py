"""Why a transient run ended before its end: a step did not settle, no time, no film."""

import math

import numpy as np

from tehl.base.wording import grid_size
from tehl.contact.moment import frozen
from tehl.contact.options import Options
from tehl.estimate.scaling import ScaledProblem
from tehl.result.solution import Hint, Status
from tehl.result.transient import TIME_OVER
from tehl.solver.cost import Clock
from tehl.solver.cycle.level import Level
from tehl.solver.judging.diagnosis import cause_by_the_oil
from tehl.solver.transient.step import StepError, Stepper

SPARE_TIME = 1.5
"""Time that a hint gives to the steps over what they take so far: later ones may take longer."""
NEARLY_CONVERGED = 1e-6
"""Change of P in the last cycle of a time step that only a tight tolerance rejects."""


def step_not_settled(stepper: Stepper, error: StepError, seconds: float) -> Status:
    """Return ``step_not_settled`` of a time step that did not converge.

    Parameters
    ----------
    stepper : Stepper
        With the levels of the run, its tolerance and its moments.
    error : StepError
        With its cause and the last change of the pressure.
    seconds : float
        End of the step [s].
    """
    points, tolerance = stepper.solver.finest.grid.points, stepper.transient.tolerance
    problem = stepper.solver.hierarchy.scaled.problem
    other = "lower or longer asperities, " if problem.is_rough else ""
    hint = Hint(
        f"Take {other}more nodes (numerics.points), or more cycles per step (transient.max_cycles)."
    )
    # short waves of the film grow at stresses that no oil bears, and finer meshes have them
    moving = (one for one in stepper.schedule.moments if one.speed > 0.0)
    fastest = max(moving, key=lambda one: math.hypot(one.sliding, one.across))
    sheared = ScaledProblem.of(frozen(problem, fastest))
    oil, likely = cause_by_the_oil(sheared, waves=problem.is_rough), ""
    if oil is not None:
        hint, likely = oil.hint, f" Likely cause: {oil.message}"
    if error.cause == "stalled" and tolerance < error.change < NEARLY_CONVERGED:
        hint = Hint(
            f"the pressure has nearly converged (now {tolerance:g}).",
            {"transient.tolerance": NEARLY_CONVERGED},
        )
    return Status(
        kind=error.cause,
        cause="step_not_settled",
        message=(
            f"The time step to {seconds:.4g} s did not converge on {grid_size(points)}: "
            f"the last change of P is {error.change:.2g}. The steps before it are kept."
            f"{likely}"
        ),
        hint=hint,
    )


def time_over(options: Options, clock: Clock, ended: tuple[int, int], seconds: float) -> Status:
    """Return ``time_over`` of a run; the hint is to the time that it takes.

    Parameters
    ----------
    options, clock : Options, Clock
        With the limit of the time, and the time of the run so far.
    ended : (int, int)
        Steps that ended, and all of the run.
    seconds : float
        Time step [s].
    """
    advice, settings = "Take a longer numerics.max_time, or ", {}
    steps, of_all = ended
    if steps:
        spent = clock.cost().wall_seconds
        needed = clock.start + SPARE_TIME * (spent - clock.start) * of_all / steps
        unit = 10.0 ** (math.floor(math.log10(needed)) - 1)
        settings = {"numerics.max_time": f"{unit * math.ceil(needed / unit):g} s"}
        advice = "the run takes less at its speed so far; or take "
    return Status(
        kind="not_converged",
        cause=TIME_OVER,
        message=(
            f"numerics.max_time = {options.max_time:g} s is over at "
            f"{steps * seconds:.4g} of {of_all * seconds:.4g} s of the run. The "
            "steps until then are kept."
        ),
        hint=Hint(
            f"{advice}a larger transient.stride, fewer nodes (numerics.points) or a shorter "
            "transient.duration.",
            settings,
        ),
    )


def no_film(level: Level, seconds: float, *, rough: bool) -> Status:
    """Return ``asperity_contact`` of rough surfaces, or ``film_not_positive`` of smooth ones.

    Parameters
    ----------
    level, seconds : Level, float
        With the film, and its time [s].
    rough : bool
        Whether the surfaces are.
    """
    grid, h = level.grid, level.film.h
    row, column = np.unravel_index(int(np.argmin(h)), h.shape)
    how = "not positive" if h.min() <= 0.0 else "thinner than its equations are solved for"
    where = (
        f"At {seconds:.4g} s the film is {how}: smallest H = {h.min():.3g} at "
        f"X = {grid.x[column]:.3g}, Y = {grid.y[row]:.3g}"
    )
    if rough:
        cause = "asperity_contact"
        message = (
            f"{where}. On {grid_size(grid.points)} asperities would touch there, which a "
            "film that carries the whole load does not describe; on a finer grid they may "
            "not. The steps before it are kept."
        )
        hint = Hint(
            "a finer grid may have a film; else take lower or longer asperities, or a higher "
            "speed.",
            {"numerics.points": 2 * max(grid.points) - 1},
        )
    else:
        cause = "film_not_positive"
        message = (
            f"{where}, between smooth surfaces: the load grows too fast, or beyond the domain, "
            "or no oil comes. The steps before it are kept."
        )
        hint = Hint("Let load or speed change less, or take more nodes (numerics.points).")
    return Status(kind="not_converged", cause=cause, message=message, hint=hint)
