"""Error bars of a steady result, from three grids and one larger domain."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Generic, NoReturn, TypeVar

from tehl.contact.options import Domain, Options, can_be_halved, check_certifiable
from tehl.contact.problem import ContactProblem
from tehl.estimate.settled import settled
from tehl.operators.heights import UnresolvedError
from tehl.post.following import Following
from tehl.result import registry
from tehl.result.bars import ErrorEstimate, Estimate
from tehl.result.solution import NO_COST, ConvergenceError, Cost, Hint, Solution, Status
from tehl.solver.cost import end_of_time
from tehl.solver.judging.measures import SPIKE_FROM, spike_of
from tehl.solver.judging.richardson import (
    LESS_REGULAR,
    RESIDUE,
    estimate,
    spike_reach,
    with_growing_spike,
)
from tehl.solver.judging.verdict import LARGEST_FILM_BAR, TOO_COARSE, too_coarse
from tehl.solver.monitor import SILENT, Monitor
from tehl.solver.physics.bodies import solve

LARGER_DOMAIN_FACTOR = 2
"""Size of the larger domain over that of the result."""
JUDGED = ("film_central", "film_minimum")
"""Values whose error bars decide whether the grid is too coarse; small temperatures do not."""
WITHOUT_FIRST = "The first grid is left out: each bar is the full change between the other two."

AnyResult = TypeVar("AnyResult")
ZERO_TRACTION = 1e-6
"""Coefficient below which a traction is zero by symmetry, without a bar."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Companion(Generic[AnyResult]):
    """A run beside the finest one: how it ended, and its result if the error bars use it."""

    ending: str
    result: AnyResult | None = None
    cost: Cost = NO_COST


def certify(
    problem: ContactProblem, options: Options | None = None, *, monitor: Monitor = SILENT
) -> Solution:
    """Solve on three grids and on a larger domain; return the finest result with error bars.

    Parameters
    ----------
    problem : ContactProblem
        The contact in SI.
    options : Options
        Of the finest grid, which a first solve finds if ``points`` is left out; the two others have
        a half and a quarter of its intervals. All converge to ``options.tolerance``, so that only
        the discretisation differs.
    monitor : Monitor
        Receives the report of each cycle.

    Returns
    -------
    Solution
        Of the finest grid, with ``uncertainty``.

    Raises
    ------
    ConvergenceError
        When the finest grid or one that its error bars need did not converge, or when the bars are
        too wide. Its ``result`` is that of the finest grid.
    InputError
        When the grid cannot be halved twice.
    """
    options, known = options or Options(), None
    until = end_of_time(options) if "max_time" in options.model_fields_set else None
    if problem.contact.has_lines:
        options = settled(problem, options)
    if options.points == "auto":
        monitor.message("certify: number of nodes")
        known = solve(problem, options, monitor=monitor, until=until)
        options = certifiable(known.grid_options)
    options = options.model_copy(update={"accuracy": "tight", "extrapolate": False})
    check_certifiable(options)
    monitor.message("certify: grid 1 of 3")
    first = _companion(problem, halved(options, 2), monitor, until)
    monitor.message("certify: grid 2 of 3")
    middle = _companion(problem, halved(options, 1), monitor, until)
    monitor.message("certify: grid 3 of 3")
    finest = solve(problem, options, guess=known, monitor=monitor, until=until)
    monitor.message("certify: larger domain")
    wide = _companion(problem, widened(options, finest), monitor, until)
    finest = finest.but(cost=finest.cost + first.cost + middle.cost + wide.cost)
    result = _with_bars(
        finest,
        first.result,
        _needed(finest, middle, "the next coarser grid"),
        _needed(finest, wide, "the larger domain"),
    )
    message = _message(first, middle, finest, wide)
    if finest.status.cause is not None:  # the largest pressure has no limit
        message = f"{message} {finest.status.message}"
    result = result.but(status=replace(finest.status, message=message, hint=None))
    worst = widest(result.uncertainty, JUDGED)
    if worst > LARGEST_FILM_BAR:
        _reject(result, too_coarse_to_certify(result, worst))
    return result


def _message(
    first: Companion[Solution],
    middle: Companion[Solution],
    finest: Solution,
    wide: Companion[Solution],
) -> str:
    """Return how each run ended, and what follows for the bars."""
    message = message_on([first.ending, middle.ending, _ending(finest)], wide.ending)
    if first.result is None:
        return f"{message} {WITHOUT_FIRST}"
    if _is_coarse(first.result.status) or not first.result.status.converged:
        message += (
            " Where the first grid hides the order of the scheme, a bar is the full change between "
            "the other two."
        )
    return message


def _companion(
    problem: ContactProblem, options: Options, monitor: Monitor, until: float | None
) -> Companion[Solution]:
    """Solve on a coarser grid, which need not resolve the film but must converge."""
    try:
        result = solve(problem, options, monitor=monitor, until=until)
    except UnresolvedError as error:
        monitor.message(f"certify: {error}")
        return Companion(ending=f"{nodes_of(options)} too coarse for the roughness")
    except ConvergenceError as error:
        result = error.result
        monitor.message(f"certify: {result.status.message}")
    is_used = result.status.converged or (result.film_scaled.minimum > 0 and _has_converged(result))
    return Companion(ending=_ending(result), result=result if is_used else None, cost=result.cost)


def _ending(result: Solution) -> str:
    """Return the nodes of a run and how it ended."""
    coarse = _is_coarse(result.status)
    ending = "too coarse for the film" if coarse else result.status.outcome
    return f"{nodes_of(result.grid_options)} {ending}"


def _is_coarse(status: Status) -> bool:
    """Whether a grid resolves no film, or not its minimum."""
    return (status.is_vague and status.cause is None) or status.cause in TOO_COARSE


def _has_converged(result: Solution) -> bool:
    """Whether the cycles converged and only the grid is too coarse."""
    if result.status.cause != "grid_too_coarse" or result.status.kind == "diverged":
        return False
    last = result.history[-1]
    worst = max(last.residual, last.change, abs(last.load_error))
    return worst <= result.options.tolerance


def _needed(finest: Solution, run: Companion[Solution], what: str) -> Solution:
    """Return the result of a run that the bars need; raise with the finest one if it failed."""
    if run.result is None:
        _reject(finest, not_certified(finest, f"{what} failed ({run.ending})."))
    return run.result


def _reject(result: Solution, status: Status) -> NoReturn:
    raise ConvergenceError(str(status.message), result.but(status=status))


def not_certified(result: Solution, why: str) -> Status:
    """Return ``not_certified``: the finest grid converged, but has no error bar.

    Parameters
    ----------
    result : Solution
        Of the finest grid; the hint names half its mesh widths.
    why : str
        Which run failed and how.
    """
    nodes = 2 * max(result.scaled.x.size, result.scaled.y.size) - 1
    return Status(
        kind="not_converged",
        cause="not_certified",
        message=f"The finest grid converged, but has no error bar: {why}",
        hint=Hint("or solve without --certify.", {"numerics.points": nodes}),
    )


def too_coarse_to_certify(result: Solution, error: float) -> Status:
    """Return ``grid_too_coarse`` for a certified result with a wide error bar.

    Parameters
    ----------
    result : Solution
        Of the finest grid.
    error : float
        Relative error bar of the film [-].
    """
    return too_coarse((result.scaled.x.size, result.scaled.y.size), result.scaled_problem, error)


def widest(uncertainty: dict[str, Estimate], names: Iterable[str]) -> float:
    """Return the largest relative error bar [-].

    Parameters
    ----------
    uncertainty : dict
        Values with their bars, by name; an extrapolated zero has an infinite relative bar.
    names : iterable of str
        Those that are compared, if they have a limit.
    """
    bars = (uncertainty[name] for name in names if name in uncertainty)
    return max(abs(bar.uncertainty / bar.value) if bar.value else math.inf for bar in bars)


def message_on(grids: list[str], wide: str) -> str:
    """Return how the runs of a certified result ended.

    Parameters
    ----------
    grids : list of str
        How the run on each grid ended, the coarsest first.
    wide : str
        How the run on the larger domain ended.
    """
    return f"Grids of the error bars: {', '.join(grids)}; larger domain: {wide}."


def nodes_of(options: Options) -> str:
    """Return the nodes of the finest grid as text."""
    ny, nx = options.shape
    return f"{nx}" if ny == 1 else f"{nx} x {ny}"


def halved(options: Options, times: int) -> Options:
    """Return options of a coarser grid.

    Parameters
    ----------
    options : Options
        With the nodes stated, (n - 1) divisible by 2^times.
    times : int
        How often the number of intervals is halved.
    """
    ny, nx = ((n - 1) // 2**times + 1 for n in options.shape)
    return options.on_points(nx, ny)


def certifiable(options: Options) -> Options:
    """Return options of a grid that can be halved twice, of twice the intervals where necessary."""
    while not can_be_halved(options, 2):
        ny, nx = options.shape
        options = options.on_points(2 * nx - 1, 2 * ny - 1)
    return options


def widened(options: Options, finest: Solution) -> Options:
    """Return options of the larger domain, on twice the mesh width.

    Parameters
    ----------
    options : Options
        Of the certified run.
    finest : Solution
        Its domain is enlarged by `LARGER_DOMAIN_FACTOR`, its number of nodes is kept.
    """
    x, y = (
        (LARGER_DOMAIN_FACTOR * float(edges[0]), LARGER_DOMAIN_FACTOR * float(edges[-1]))
        for edges in (finest.scaled.x, finest.scaled.y)
    )
    edges = "far_field" if options.has_far_field else "zero"
    shape = finest.problem.shape
    y = shape.sides if shape.as_line else y
    return options.model_copy(update={"domain": Domain(x=x, y=y), "edges": edges})


def _with_bars(
    finest: Solution, first: Solution | None, middle: Solution, wide: Solution
) -> Solution:
    """Return the finest result with its error bars; the first grid may be missing."""
    used = [run for run in (first, middle, finest) if run is not None]
    runs, wider = [_quantities(run) for run in used], _quantities(wide)
    following = {one.name for one in registry.certified("following")}
    # the larger domain has the mesh of the middle grid: their difference is due to the domain
    uncertainty = {
        name: estimate(
            tuple(run[name] for run in runs),
            domain=abs(wider[name] - runs[-2][name]),
            residue=LESS_REGULAR if name in following else RESIDUE,
        )
        for name in wider
    }
    highest = uncertainty["pressure_max"]
    uncertainty["pressure_max"] = with_growing_spike(highest, reach_of_spike(used))
    if finest.problem.contact.type == "roller" and finest.errors is not None:
        # before its ends the film shows one order on fine grids alone: the bar of the solve too
        least, bar = uncertainty["film_minimum"], finest.errors.of("film_minimum") or 0.0
        larger = max(least.uncertainty, bar * abs(least.value))
        uncertainty["film_minimum"] = replace(least, uncertainty=larger)
    return finest.but(uncertainty=with_limits(uncertainty, finest.errors))


def with_limits(
    uncertainty: dict[str, Estimate], errors: ErrorEstimate | None
) -> dict[str, Estimate]:
    """Return the error bars without those of values that have no limit at the ends of a roller.

    Parameters
    ----------
    uncertainty : dict
        Values with their bars, by name.
    errors : ErrorEstimate or None
        Of the finest grid.
    """
    limits = (
        {}
        if errors is None
        else {"film_minimum": errors.minimum_has_limit, "pressure_max": errors.pressure_has_limit}
    )
    return {name: bar for name, bar in uncertainty.items() if limits.get(name, True)}


def _quantities(result: Solution) -> dict[str, float]:
    """Return the values that get error bars: of film, pressure, heat, traction and load share."""
    found = {
        "film_central": result.film_scaled.central,
        "film_minimum": result.film_scaled.minimum,
        "pressure_max": float(result.scaled.pressure.max()),
    }
    following = Following(result)
    coupled = result.problem.is_coupled and result.problem.motion.slides
    for one in registry.certified("following"):
        value = following.numbers.get(one.path)
        # the traction of a Newtonian film follows from the spike, which no grid resolves
        stress = coupled and abs(value or 0.0) > ZERO_TRACTION
        if value is not None and (stress or one.block != "traction"):
            found[one.name] = value
    if following.touching is not None:  # known or not: with its bar it is
        found[registry.at("touching.share").name] = following.touching.share
    return found


def reach_of_spike(runs: Sequence[Solution]) -> float:
    """Return the pressure that the spike may have on finer grids than the last of some [-]."""
    spikes = []
    for run in runs:
        x, y = run.scaled.x[run.scaled.x > SPIKE_FROM], run.scaled.y[:, None]
        pressure = run.scaled.pressure[:, -x.size :]
        spikes.append(spike_of(pressure, run.groups.shape.dry_pressure(x, y)))
    last = spikes[-1]
    return spike_reach(last["spike"], [one["excess"] for one in spikes], last["narrow"])
