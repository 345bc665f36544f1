"""Solve a steady contact: choose grids and smoother, run, judge, and give the result."""

import platform
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import PackageNotFoundError, version

import numpy as np

from tehl.domain import recommended_domain
from tehl.errors import ConvergenceError, InputError
from tehl.grid import Grid, can_mirror
from tehl.memory import check_memory
from tehl.operators.flow import flow_table
from tehl.operators.heights import Heights, heights_of
from tehl.options import Domain, Options
from tehl.problem import ContactProblem
from tehl.result import (
    Cost,
    CycleReport,
    Fields,
    FilmHeat,
    FilmShear,
    Provenance,
    Result,
    Status,
    SurfaceHeights,
)
from tehl.scaling import ScaledProblem, Scales
from tehl.solver.film_numbers import film_summary
from tehl.solver.monitor import SILENT, Monitor
from tehl.solver.multigrid import Multigrid
from tehl.solver.outputs import film_heat, film_shear, newtonian_shear
from tehl.solver.rough_verdict import touching
from tehl.solver.smoother import (
    BROAD,
    CAREFUL,
    FAST,
    GENTLE,
    NEWTON,
    ROBUST,
    ROUGH,
    SETTINGS,
    Setting,
)
from tehl.solver.state import TouchingError
from tehl.solver.thermal import Coupling, FilmCoupling, Uncoupled
from tehl.solver.verdict import diverged, verdict
from tehl.solver.warmup import warm_up

GRID_CAUSES = ("grid_too_coarse", "domain_too_small", "inlet_too_short", "sides_too_close")
"""Causes that no other smoother cures."""
PACKAGES = ("tehl", "numpy", "scipy", "numba")


@dataclass(frozen=True, kw_only=True, slots=True)
class Attempt:
    """What one setting of the smoother reached, and whether its cycles got where they should."""

    run: Multigrid
    status: Status
    reached: bool

    @property
    def is_final(self) -> bool:
        """Whether no other setting would end otherwise."""
        touching = self.reached and self.status.cause == "asperity_contact"
        return self.status.converged or self.status.cause in GRID_CAUSES or touching


def solve(
    problem: ContactProblem,
    options: Options | None = None,
    *,
    guess: Result | None = None,
    monitor: Monitor = SILENT,
) -> Result:
    """Solve a steady contact by full multigrid.

    Parameters
    ----------
    problem : ContactProblem
        The contact in SI.
    options : Options
        How hard to try; the defaults if left out.
    guess : Result
        The film of a similar contact. The finest grid starts from it if ``options.accuracy`` is
        "tight" and it is much nearer to the answer than the film of the coarser grid; less exact
        runs are over before that counts. The answer is the same, to the tolerance.
    monitor : Monitor
        Told of each cycle.

    Returns
    -------
    Result
        Film, pressure and how well they are known.

    Raises
    ------
    ConvergenceError
        When the answer was not reached; its ``result`` is the last finite state, marked.
    InputError
        When the grid does not fit into the memory, or a measured surface cannot be read.
    """
    options = options or Options()
    if problem.transient is not None:
        raise InputError(
            "the case has a [transient] table: solve it with tehl.solve_transient (the command "
            "tehl solve does so by itself)"
        )
    check_memory(options, problem)
    _, result = solve_attempt(problem, options, monitor=monitor, rough=True, guess=guess)
    if not result.status.converged:
        raise ConvergenceError(result.status.message or "not converged", result)
    return result


def solve_attempt(
    problem: ContactProblem,
    options: Options,
    *,
    monitor: Monitor,
    rough: bool,
    guess: Result | None = None,
    load: float = 1.0,
) -> tuple[Attempt, Result]:
    """Return the best attempt at the steady film, and its result, converged or not.

    Parameters
    ----------
    problem, options, monitor, guess
        As in `solve`.
    rough : bool
        With the roughness of the surfaces, as they stand; without it they are smooth.
    load : float
        What the film carries, over the load of the contact [-].
    """
    warm_up(coupled=problem.is_coupled)
    wall, cpu = time.perf_counter(), time.process_time()
    scaled = ScaledProblem.of(problem)
    grid = finest_grid(scaled, options)
    heights = heights_of(scaled, grid) if rough else None
    history = _History(monitor)
    attempts = []
    for attempt in _attempts(scaled, options, history, grid, heights, _Given(guess, load)):
        attempts.append(attempt)
        if attempt.is_final:
            break
    best = min(attempts, key=_rank)
    result = _result(scaled, options, best, tuple(history.reports))
    surfaces = _surfaces(grid, heights, result.scales)
    cost = Cost(cpu_seconds=time.process_time() - cpu, wall_seconds=time.perf_counter() - wall)
    return best, replace(result, heights=surfaces, cost=cost)


@dataclass(frozen=True, slots=True)
class _Given:
    """The film of a similar contact, if there is one, and the load over that of the contact."""

    guess: Result | None
    load: float


class _History:
    """A monitor that keeps the reports and passes them on."""

    def __init__(self, monitor: Monitor) -> None:
        self.monitor = monitor
        self.reports: list[CycleReport] = []

    def message(self, text: str) -> None:
        """Pass the remark on."""
        self.monitor.message(text)

    def cycle(self, report: CycleReport) -> None:
        """Keep the report and pass it on."""
        self.reports.append(report)
        self.monitor.cycle(report)


def _surfaces(grid: Grid, heights: Heights | None, case_scales: Scales) -> SurfaceHeights | None:
    """Return the heights of both surfaces on the full grid [m]."""
    if heights is None:
        return None
    first, second = (
        grid.unfold(field) * case_scales.film_thickness
        for field in (heights.surface_1, heights.surface_2)
    )
    return SurfaceHeights(surface_1=first, surface_2=second)


def _rank(attempt: Attempt) -> tuple[bool, bool, bool]:
    """Return what puts the best attempt first: final, got there, or at least finite."""
    return not attempt.is_final, not attempt.reached, attempt.status.kind == "diverged"


def _attempts(
    scaled: ScaledProblem,
    options: Options,
    monitor: Monitor,
    grid: Grid,
    heights: Heights | None,
    given: "_Given",
) -> Iterator[Attempt]:
    """Yield the outcome of each setting worth trying, the most promising first."""
    flow = flow_table(scaled)
    attempts = _settings(scaled.problem, options, rough=heights is not None)
    for number, (setting, ramped) in enumerate(attempts):
        if number:
            how = ", sliding step by step" if ramped else ""
            newton = "Newton's method, which takes a while"
            name = newton if setting.rough.newton else f"the {setting.name} smoother"
            monitor.message(f"falling back to {name}{how}")
        follow = setting.rough.follow if heights is not None else 1.0
        coupling = coupling_of(scaled, options, ramped=ramped, follow=follow)
        run = Multigrid(grid, scaled, flow, options, setting, coupling)
        run.carry(given.load)
        if heights is not None:
            run.roughen(heights)
        run.guess = given.guess if options.accuracy == "tight" else None
        relaxing = [one for one, _ in attempts[number + 1 :] if not one.rough.newton]
        yield _run(run, monitor, patient=not relaxing)


def _settings(
    problem: ContactProblem, options: Options, *, rough: bool
) -> list[tuple[Setting, bool]]:
    """Return the settings of the smoother to try, and whether sliding is raised step by step."""
    if options.smoother != "auto":
        return [(SETTINGS[options.smoother], False)]
    if rough:
        relaxations = [(ROUGH, False), (CAREFUL, False), (GENTLE, False)]
        # heat follows Newton's steps no better than cycles, at ten times the cost
        return relaxations if problem.is_coupled else [*relaxations, (NEWTON, False)]
    if not problem.is_coupled:
        return [(FAST, False), (ROBUST, False)]
    attempts = [(BROAD, False), (ROBUST, False)]
    return [*attempts, (ROBUST, True)] if problem.slide_roll_ratio else attempts


def _run(run: Multigrid, monitor: Monitor, *, patient: bool) -> Attempt:
    """Run and judge; a value that is not finite ends the run."""
    with np.errstate(all="ignore"):  # a run away is judged below, not warned of on the way
        try:
            reached = run.solve(monitor, patient=patient)
        except TouchingError as error:
            return Attempt(run=run, status=touching(run, error.part), reached=True)
        except ArithmeticError:
            run.salvage()
            return Attempt(run=run, status=diverged(run), reached=False)
    return Attempt(run=run, status=verdict(run, not reached, run.errors()), reached=reached)


def coupling_of(
    scaled: ScaledProblem, options: Options, *, ramped: bool, follow: float = 1.0
) -> Coupling:
    """Return what acts on the film besides pressure and elasticity."""
    if not scaled.problem.is_coupled:
        return Uncoupled()
    return FilmCoupling(scaled, options, ramped=ramped, follow=follow)


def finest_grid(scaled: ScaledProblem, options: Options) -> Grid:
    """Return the grid of the answer: the stated or proposed domain, half of it if symmetric."""
    domain = options.domain
    if not isinstance(domain, Domain):
        domain = recommended_domain(scaled.groups)
    ny, nx = options.shape
    halves = options.half_domain == "auto" and scaled.problem.is_even_in_y
    return Grid(nx=nx, ny=ny, domain=domain, mirror=halves and can_mirror(options.shape, domain))


def _result(
    scaled: ScaledProblem,
    options: Options,
    attempt: Attempt,
    history: tuple[CycleReport, ...],
) -> Result:
    """Return what was found; its cost is not known yet."""
    run = attempt.run
    level, grid = run.finest, run.finest.grid
    full = Grid(nx=grid.nx, ny=grid.ny, domain=grid.domain, mirror=False)
    shear, heat = _stress_and_heat(attempt)
    return Result(
        problem=scaled.problem,
        options=options,
        scales=scaled.scales,
        groups=scaled.groups,
        scaled=Fields(
            x=full.x,
            y=full.y,
            pressure=grid.unfold(level.film.p),
            film=grid.unfold(level.film.h),
        ),
        rigid_approach=level.rigid_approach,
        film_scaled=film_summary(grid, level.film.h),
        status=attempt.status,
        history=history,
        errors=run.errors(),
        cost=Cost(cpu_seconds=0.0, wall_seconds=0.0),
        provenance=provenance(),
        shear=shear,
        heat=heat,
    )


def _stress_and_heat(attempt: Attempt) -> tuple[FilmShear | None, FilmHeat | None]:
    """Return stresses and temperatures; nothing where there is no credible film."""
    run = attempt.run
    if attempt.status.kind == "diverged" or run.finest.film.h.min() <= 0.0:
        return None, None
    if isinstance(run.coupling, FilmCoupling):
        state = run.coupling.state
        if state is None or state.grid != run.finest.grid:
            return None, None
        return film_shear(state), film_heat(state)
    return newtonian_shear(run.finest, run.scaled), None


def provenance() -> Provenance:
    """Return the versions at work and the time."""
    return Provenance(
        versions=dict(versions()), created=datetime.now(UTC).isoformat(timespec="seconds")
    )


@cache
def versions() -> dict[str, str]:
    """Return the versions of Python and of the packages at work."""
    found = {"python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "unknown"
    return found
