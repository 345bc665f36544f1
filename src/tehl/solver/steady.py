"""Solve a steady contact: choose the grid, try the strategies, judge, assemble the result."""

import platform
from dataclasses import replace
from datetime import UTC, datetime
from functools import cache, partial
from importlib.metadata import PackageNotFoundError, version

from tehl.base.errors import InputError
from tehl.base.units import percentage
from tehl.base.wording import grid_size
from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.estimate.domain import domain_of
from tehl.estimate.film_formulas import check_film
from tehl.estimate.memory import check_memory
from tehl.estimate.nodes import finest_grid, planned
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.settled import is_smooth, settled
from tehl.estimate.starvation import FORMULA_ERROR, Flooded, check_supply, part_passed_on
from tehl.kernels.warmup import warm_up
from tehl.operators.heights import check_ends, heights_of, units_of
from tehl.operators.resolution import resolution_of
from tehl.result.fields import SurfaceHeights
from tehl.result.solution import (
    ConvergenceError,
    Cost,
    CycleReport,
    Provenance,
    Solution,
    Supplied,
)
from tehl.solver.attempts import NO_MEMORY, Attempt, Climb
from tehl.solver.cost import Clock, end_of_time, working_time
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.ladder import Strategy, ladder
from tehl.solver.cycle.level import Level
from tehl.solver.judging.film_summary import central_value, film_summary
from tehl.solver.judging.goal import Goal
from tehl.solver.judging.outputs import oil_balance
from tehl.solver.judging.remedy import Reached, Solve, meets, solved_on_other_nodes, working_hint
from tehl.solver.judging.verdict import TOO_COARSE
from tehl.solver.monitor import SILENT, Monitor, Recorder
from tehl.solver.physics.dynamics import with_dynamics

WITHOUT_ERROR = (NO_MEMORY, "error_not_reached", *TOO_COARSE)
"""Causes of failure for which a larger error may converge."""
OF_RUN = 2.5
"""How many times as much of its error the flooded film of a run counts as passed on: it is one
solve, and a run on half the mesh width takes eight times as long. A circle (M = 825, ratio 0.52)
starts on 449 nodes per direction with it, and on 769 without."""


def solve(
    problem: ContactProblem,
    options: Options | None = None,
    *,
    guess: Solution | None = None,
    monitor: Monitor = SILENT,
    until: float | None = None,
) -> Solution:
    """Solve a steady contact between bodies of stated temperatures, by full multigrid.

    Parameters, result and errors are those of `tehl.solver.physics.bodies.solve`.
    """
    options = settled(problem, options or Options())
    others = (
        (problem.transient is not None, "transient: the case is not steady", "solve_transient"),
        (problem.has_passes, "supply.passes: the case has several films", "solve_passes"),
    )
    for is_another, why, function in others:
        if is_another:
            raise InputError(
                f"{why}; solve it with tehl.{function} (the command tehl solve does so by itself)"
            )
    warm_up(coupled=problem.is_coupled)
    until = end_of_time(options) if until is None else until
    attempt, result = try_strategies(
        problem, options, monitor=monitor, rough=True, guess=guess, until=until
    )
    if not result.status.converged:
        status = result.status
        unsure = status.kind in ("diverged", "stalled") or status.cause in WITHOUT_ERROR
        if options.points == "auto" and unsure:
            reached = attempt.reached_before
            del attempt  # frees its grids
            result = _after_failure(result, reached, monitor, until)
    if not result.status.converged:
        raise ConvergenceError(result.status.message or "not converged", result)
    return result


def _after_failure(
    failed: Solution, reached: Reached | None, monitor: Monitor, end: float
) -> Solution:
    """Return the film on other nodes if it converges there, else as `_hinted`.

    Nothing is tried after ``end`` on the clock of `working_time`.

    A coarser film that converged on the way, on the nodes and with the error of ``reached``, takes
    the place of the failed one.
    """

    def attempt(problem: ContactProblem, options: Options) -> Solution:
        return try_strategies(problem, options, monitor=monitor, rough=True)[1]

    def on_nodes(nodes: tuple[int, int]) -> Solution:
        return try_strategies(
            failed.problem,
            failed.options,
            monitor=monitor,
            rough=True,
            flooded=_known_flooded(failed),
            until=end,
            nodes=nodes,
        )[1]

    on_others = solved_on_other_nodes(failed, on_nodes, monitor, end)
    if on_others is not None:
        return _in_place_of(failed, on_others)
    if failed.status.cause == "error_not_reached" and failed.errors is not None:
        reached = failed.scaled.film.shape[::-1], failed.errors.film()
    failed = _hinted(failed, reached, attempt, monitor, end)
    is_best = failed.status.converged or failed.status.cause == "error_not_reached"
    if reached is None or is_best:
        return failed
    (nx, ny), error = reached
    again = failed.options.on_points(nx, ny)
    left = max(end - working_time(), 0.0)
    kept = attempt(failed.problem, again.model_copy(update={"max_time": left}))
    if not kept.status.converged:
        return failed
    text = f"The film on {grid_size((nx, ny))} is kept; its error is about {percentage(error)}."
    status = replace(failed.status, kind="not_converged", message=f"{failed.status.message} {text}")
    return _in_place_of(failed, kept).but(status=status)


def _hinted(
    failed: Solution, reached: Reached | None, solve: Solve, monitor: Monitor, end: float
) -> Solution:
    """Return a failed film with a hint, or one that meets the goal on nodes for a larger error."""
    meeting: list[Solution] = []

    def trial(problem: ContactProblem, options: Options) -> Solution:
        found = solve(problem.model_copy(update={"dynamics": None}), options)
        mine = failed.options
        same = options.model_copy(update={"error": mine.error, "max_time": mine.max_time}) == mine
        if same and problem == failed.problem and meets(found, mine.target):
            meeting.append(found)
        return found

    hint = working_hint(failed, trial, monitor, end, reached)
    if meeting and failed.problem.dynamics is None:
        return _in_place_of(failed, meeting[-1])
    return failed.but(status=replace(failed.status, hint=hint))


def _in_place_of(failed: Solution, found: Solution) -> Solution:
    """Return what was found after a failure, with all cycles and the options of the user."""
    history, cost = failed.history + found.history, failed.cost + found.cost
    return found.but(options=failed.options, history=history, cost=cost)


def try_strategies(  # noqa: PLR0913 (one solve)
    problem: ContactProblem,
    options: Options,
    *,
    monitor: Monitor,
    rough: bool,
    guess: Solution | None = None,
    flooded: Flooded | None = None,
    passed_on: float | None = None,
    until: float | None = None,
    nodes: tuple[int, int] | None = None,
    tolerance: float = 0.0,
) -> tuple[Attempt, Solution]:
    """Try the strategies; return the best attempt at the steady film and its result.

    Parameters
    ----------
    problem, options, monitor, guess
        As in `solve`.
    rough : bool
        Whether the surfaces have their roughness, at time zero; else they are smooth.
    flooded : Flooded or None
        The flooded contact; None computes it if oil is supplied.
    until : float or None
        When the time is over, on the clock of `working_time` [s]; None is that of the options.
    nodes : (int, int) or None
        Nodes along x and y to begin with, in place of those planned for the error.
    passed_on, tolerance
        As in `Goal`.
    """
    warm_up(coupled=problem.is_coupled)
    until = end_of_time(options) if until is None else until
    options = settled(problem, options)
    flooded = flooded or flooded_film(problem, options, monitor, until)
    clock, history = Clock(), Recorder(monitor)
    scaled = ScaledProblem.of(problem)
    if flooded is not None:
        scaled = replace(scaled, flooded_oil=flooded.oil, flooded_error=flooded.error)
    goal = Goal(scaled, options, passed_on=passed_on, until=until, tolerance=tolerance)
    plan = planned(scaled, options, of_central=goal.of_central)
    plan = goal.fitting(plan if nodes is None else plan.on_points(*nodes))
    check_supply(scaled, domain_of(scaled, plan))
    check_film(scaled)
    if rough:
        check_ends(scaled, finest_grid(scaled, plan))
    check_memory(plan, problem)
    heights = cache(partial(heights_of, scaled) if rough else lambda _: None)
    # at other accuracies full multigrid is done before a better start saves a cycle
    start = guess if options.accuracy == "tight" else None

    def solver(hierarchy: Hierarchy, strategy: Strategy) -> FilmSolver:
        known = heights(hierarchy.finest.grid)
        return FilmSolver(
            hierarchy, strategy, heights=known, goal=goal, monitor=history, guess=start
        )

    rungs = ladder(scaled, options, rough=rough and problem.is_rough)
    best = Climb(scaled, goal, history, solver).best(plan, rungs)
    supplied = _supplied(best.run.finest, flooded)
    result = _result(best, options, tuple(history.reports), clock.cost()).but(supplied=supplied)
    if problem.dynamics is None or not best.status.converged:
        return best, result
    # last, as it overwrites the coarser levels
    monitor.message("stiffness and damping")
    return best, with_dynamics(result, best.run).but(cost=clock.cost())


def flooded_film(
    problem: ContactProblem,
    options: Options,
    monitor: Monitor = SILENT,
    until: float | None = None,
) -> Flooded | None:
    """Solve the same contact, flooded and smooth, on the domain that it needs.

    Parameters
    ----------
    problem : ContactProblem
        Starved; None is returned if it states no supply.
    options : Options
        Of the starved solve; domain and edges are chosen anew.
    monitor : Monitor
        Receives the cycles.
    until : float or None
        As in `try_strategies`.

    Returns
    -------
    Flooded or None
        None also if cycles do not converge, or to no better film than that of the formula.
    """
    if problem.supply is None:
        return None
    changes = dict.fromkeys(("supply", "cavitation", "transient", "dynamics"))
    passed_on = part_passed_on(problem.supply) * (1.0 if problem.transient is None else OF_RUN)
    monitor.message("the fully flooded contact")
    same = problem.model_copy(update=changes)
    own: dict[str, object] = {"domain": "auto", "edges": "auto"}
    if not is_smooth(problem):  # this one is, and may be extrapolated
        own["extrapolate"] = None
    options = options.model_copy(update=own)
    attempt, result = try_strategies(
        same,
        options,
        monitor=SILENT,
        rough=False,
        passed_on=passed_on,
        until=until,
    )
    errors = result.errors
    is_known = attempt.reached and errors is not None and errors.central < FORMULA_ERROR
    if not (result.status.converged or is_known):
        return None
    grid, film = attempt.run.finest.grid, attempt.run.finest.film
    central = result.film_scaled.central
    return Flooded(
        film=central,
        oil=central_value(grid, film.rho) * central,
        error=0.0 if errors is None else errors.central,
    )


def _known_flooded(result: Solution) -> Flooded | None:
    """Return the flooded contact that a result knows."""
    known = result.supplied
    if known is None or known.flooded_film is None or known.flooded_oil is None:
        return None
    return Flooded(film=known.flooded_film, oil=known.flooded_oil, error=known.flooded_error)


def _supplied(level: Level, flooded: Flooded | None) -> Supplied | None:
    """Return the balance of the oil beside the flooded contact; None if it is not conserved."""
    if not level.stencil.conserves:
        return None
    return Supplied(
        flooded_film=None if flooded is None else flooded.film,
        flooded_oil=None if flooded is None else flooded.oil,
        flooded_error=0.0 if flooded is None else flooded.error,
        balance=oil_balance(level),
    )


def _surfaces(run: FilmSolver) -> SurfaceHeights | None:
    """Return the heights of both surfaces on the full grid [m]."""
    heights, unit = run.roughness.heights, run.hierarchy.scaled.scales.film_thickness
    if heights is None:
        return None
    first, second = (
        run.finest.grid.unfold(field) * unit for field in (heights.surface_1, heights.surface_2)
    )
    return SurfaceHeights(surface_1=first, surface_2=second)


def _result(
    attempt: Attempt, options: Options, history: tuple[CycleReport, ...], cost: Cost
) -> Solution:
    """Assemble the result of an attempt on the full domain."""
    run = attempt.run
    level, grid, scaled = run.finest, run.finest.grid, run.hierarchy.scaled
    found = attempt.outputs()
    return Solution(
        problem=scaled.problem,
        options=options,
        scales=scaled.scales,
        groups=scaled.groups,
        scaled=found.fields,
        rigid_approach=level.rigid_approach,
        film_scaled=film_summary(
            grid, found.fields.film[-grid.shape[0] :], level.equations.solids.contact_film
        ),
        status=attempt.status,
        history=history,
        errors=run.errors(),
        cost=cost,
        provenance=provenance(),
        extras=found.extras,
        heights=_surfaces(run),
        resolution=resolution_of(
            scaled.problem,
            (
                grid.dx * scaled.scales.half_width_x,
                grid.largest_dy * units_of(grid, scaled.scales)[1],
            ),
        ),
    )


def provenance() -> Provenance:
    """Return the versions of the software and the time."""
    return Provenance(
        versions=dict(_versions()), created=datetime.now(UTC).isoformat(timespec="seconds")
    )


@cache  # reading the metadata takes 3 ms, as long as a cycle on 257 nodes
def _versions() -> dict[str, str]:
    versions = {"python": platform.python_version()}
    for package in ("tehl", "numpy", "scipy", "numba"):
        try:
            versions[package] = version(package)
        except PackageNotFoundError:
            versions[package] = "unknown"
    return versions
