"""Repeated passes of a starved contact: the oil that leaves it comes back to its inlet.

The film is that of a steady contact in each pass. Between two passes a part of the layer may be
lost, and oil flows back or is supplied (docs/theory/starvation.md).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.options import Domain, Options
from tehl.contact.problem import ContactProblem
from tehl.contact.supply import Supply
from tehl.estimate.starvation import Flooded
from tehl.post.starvation import meniscus
from tehl.result.fields import PassHistory
from tehl.result.solution import ConvergenceError, Cost, Hint, Solution, Status
from tehl.result.transient import TIME_OVER
from tehl.solver.cost import end_of_time, working_time
from tehl.solver.monitor import SILENT, Monitor
from tehl.solver.steady import TOO_COARSE, try_strategies

FULL_GAP_INLET_DISTANCE = 1.0
"""Inlet distance where the gap is full at the inlet edge [m]."""
RESOLVED_INLET_DISTANCE = 0.25
"""Inlet distance over the mesh width below which the film no longer follows the law of side flow;
a steel ball on glass is within 8 % of it there (docs/validation.md)."""
COLUMNS = ("time", "film_central", "film_minimum", "entering", "leaving", "inlet_distance")


@dataclass(frozen=True, kw_only=True, slots=True)
class PassState:
    """State after a pass, from which the next one follows."""

    rows: tuple[tuple[float, ...], ...]
    """Of the history, a row per pass: `COLUMNS`."""
    y: Array
    layer: Array
    """Oil that comes to the next pass [m], over y [m], (ny,) each."""
    points: tuple[int, int]
    edges: tuple[float, float, float, float]
    """Nodes, and edges x, y of the domain [half-widths]."""
    flooded: Flooded | None
    """The flooded contact."""
    cost: Cost = field(default_factory=lambda: Cost(cpu_seconds=0.0, wall_seconds=0.0))


Keep = Callable[[PassState], None]


def forget(state: PassState) -> None:
    """Keep nothing."""
    del state


def solve_passes(
    problem: ContactProblem,
    options: Options | None = None,
    *,
    monitor: Monitor = SILENT,
    resume: PassState | None = None,
    keep: Keep = forget,
) -> Solution:
    """Solve the passes of a starved contact; return the film of the last one with their history.

    Parameters
    ----------
    problem : ContactProblem
        With ``supply.passes`` and ``supply.track``.
    options : Options
        The first pass reaches their error; the others take its grid, a finer one where the film
        becomes too thin for it.
    monitor : Monitor
        Receives the reports of the first pass, and a message for each pass.
    resume : PassState
        Where an earlier run ended.
    keep : callable
        Receives the state after each pass.

    Raises
    ------
    ConvergenceError
        When a pass does not converge, or a stated ``max_time`` is over; its ``result`` is that
        pass with the history before it.
    InputError
        When the case states no passes.
    """
    options, supply = options or Options(), problem.supply
    until = end_of_time(options)
    if supply is None or supply.passes is None:
        raise InputError("supply.passes is missing: state how often the surfaces pass the contact")
    state, result = resume, None
    for number in range(len(state.rows) if state else 0, supply.passes):
        if result is not None and state is not None and working_time() > until:
            raise _time_over(result.but(problem=problem, passes=_history(state), cost=state.cost))
        result = _one_pass(problem, options, state, monitor if number == 0 else SILENT, until)
        state = _after(result, problem, supply, state)
        if not result.status.converged:
            raise ConvergenceError(
                f"pass {number + 1}: {result.status.message or 'not converged'}",
                result.but(problem=problem, passes=_history(state)),
            )
        if number + 1 < supply.passes:
            keep(state)
        monitor.message(
            f"pass {number + 1} of {supply.passes}: {1e9 * result.film.central:.4g} nm central film"
        )
    assert result is not None
    assert state is not None
    history = _history(state)
    return result.but(
        problem=problem,
        passes=history,
        cost=state.cost,
        status=_judged(result, history),
    )


def _one_pass(
    problem: ContactProblem,
    options: Options,
    state: PassState | None,
    monitor: Monitor,
    until: float,
) -> Solution:
    """Return the film of the next pass, of the first one without a state."""
    if state is None:
        return try_strategies(problem, options, monitor=monitor, rough=True, until=until)[1]
    profile = tuple(zip(state.y.tolist(), state.layer.tolist(), strict=True))
    supply = Supply.model_construct(profile=profile)
    problem = problem.model_copy(update={"supply": supply})
    left, right, low, high = state.edges
    domain = Domain.model_construct(x=(left, right), y=(low, high))
    options = options.model_copy(update={"domain": domain}).on_points(*state.points)
    for _ in range(3):  # the grid is refined twice where the film becomes too thin for it
        _, result = try_strategies(
            problem,
            options,
            monitor=monitor,
            rough=True,
            flooded=state.flooded,
            until=until,
        )
        if result.status.cause not in TOO_COARSE:
            break
        ny, nx = options.shape
        # few lines are enough for an even layer, but not for the oil that the passes push aside
        options = (
            options.on_points(nx, nx) if ny < nx else options.on_points(2 * nx - 1, 2 * ny - 1)
        )
    return result


def _after(
    result: Solution, problem: ContactProblem, supply: Supply, before: PassState | None
) -> PassState:
    """Return the state after a pass: oil that leaves, less losses, with what comes back."""
    seconds = supply.pass_seconds(problem.entrainment_speed)
    rows = before.rows if before else ()
    middle, scaled = int(np.argmin(np.abs(result.y))), result.scaled
    oil, supplied = result.oil, result.supplied
    assert oil is not None
    assert supplied is not None
    row = (
        len(rows) * seconds,
        result.film.central,
        result.film.minimum,
        float(oil.entering[middle]),
        float(oil.leaving[middle]),
        _inlet_distance(result, middle),
    )
    layer = oil.leaving.copy()
    layer[[0, -1]] = oil.entering[[1, -2]]  # the edges of the domain pass nothing on
    layer = np.maximum((1.0 - supply.loss) * layer + supply.replenishment * seconds, 0.0)
    film, mass = supplied.flooded_film, supplied.flooded_oil
    flooded = None
    if film is not None and mass is not None:
        flooded = Flooded(film=film, oil=mass, error=supplied.flooded_error)
    cost = Cost(cpu_seconds=result.cost.cpu_seconds, wall_seconds=result.cost.wall_seconds)
    return PassState(
        rows=(*rows, row),
        y=result.y.copy(),
        layer=layer,
        points=(scaled.x.size, scaled.y.size),
        edges=(scaled.x[0], scaled.x[-1], scaled.y[0], scaled.y[-1]),
        flooded=flooded,
        cost=cost if before is None else before.cost + cost,
    )


def _inlet_distance(result: Solution, row: int) -> float:
    """Return the distance of the meniscus to the Hertz contact on a line [m]."""
    distance = (-meniscus(result)[row] - 1.0) * result.scales.half_width_x
    return float(np.nan_to_num(distance, nan=FULL_GAP_INLET_DISTANCE))


def resolved(history: PassHistory, mesh: float) -> int:
    """Return the number of passes before the meniscus is too near for the grid.

    Parameters
    ----------
    history : PassHistory
        All passes.
    mesh : float
        Mesh width along x [m].
    """
    near = np.nonzero(history.inlet_distance < RESOLVED_INLET_DISTANCE * mesh)[0]
    return int(near[0]) if near.size else history.time.size


def _time_over(result: Solution) -> ConvergenceError:
    """Return the error of passes that end with ``result``, since their time is over."""
    supply, history = result.problem.supply, result.passes
    assert supply is not None
    assert history is not None
    message = (
        f"numerics.max_time = {result.options.max_time:g} s is over after {history.time.size} of "
        f"{supply.passes} passes. The passes until then are kept."
    )
    hint = Hint(
        "Take a longer numerics.max_time, fewer supply.passes or fewer nodes (numerics.points)."
    )
    status = Status(kind="not_converged", cause=TIME_OVER, message=message, hint=hint)
    return ConvergenceError(message, result.but(status=status))


def _judged(result: Solution, history: PassHistory) -> Status:
    """Return the status of the last pass, with a warning if the side flow is not resolved."""
    mesh = float(result.x[1] - result.x[0])
    first = resolved(history, mesh) + 1
    if first > history.time.size:
        return result.status
    return Status(
        kind="converged",
        cause="side_flow_not_resolved",
        message=(
            f"From pass {first} on the meniscus is nearer to the Hertz contact than "
            f"{1e6 * RESOLVED_INLET_DISTANCE * mesh:.2g} um, a quarter of a mesh width: the "
            "rim, where oil is thin enough to flow aside, is not resolved, and the film does not "
            "follow the law of side flow."
        ),
        hint=Hint("for films as thin as this tehl layer has the law of side flow."),
    )


def _history(state: PassState) -> PassHistory:
    columns = dict(zip(COLUMNS, np.array(state.rows).T, strict=True))
    return PassHistory(number=np.arange(1.0, len(state.rows) + 1.0), **columns)


def pack(state: PassState) -> dict[str, Array]:
    """Return a state as arrays by name."""
    known = state.flooded
    flooded = (known.film, known.oil, known.error) if known else (np.nan, np.nan, np.nan)
    numbers = (*state.points, *state.edges, *flooded)
    return {
        "rows": np.array(state.rows),
        "y": state.y,
        "layer": state.layer,
        "numbers": np.array((*numbers, state.cost.cpu_seconds, state.cost.wall_seconds)),
    }


def unpack(arrays: Mapping[str, Array]) -> PassState:
    """Return the state of arrays that `pack` returned.

    Raises InputError if an array is missing or does not fit.
    """
    try:
        nx, ny, *edges, film, oil, error, cpu, wall = arrays["numbers"].tolist()
        state = PassState(
            rows=tuple(tuple(row) for row in arrays["rows"].tolist()),
            y=arrays["y"],
            layer=arrays["layer"],
            points=(int(nx), int(ny)),
            edges=(edges[0], edges[1], edges[2], edges[3]),
            flooded=None if np.isnan(film) else Flooded(film=film, oil=oil, error=error),
            cost=Cost(cpu_seconds=cpu, wall_seconds=wall),
        )
    except (KeyError, ValueError, IndexError) as fault:
        raise InputError(f"the checkpoint is damaged ({fault}): remove it to start anew") from fault
    if state.y.shape != state.layer.shape or not np.isfinite(state.layer).all():
        raise InputError("the checkpoint is damaged (its layer of oil): remove it to start anew")
    return state
