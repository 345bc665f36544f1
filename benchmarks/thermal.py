"""Cost of heated and shear-thinning films."""

import statistics
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from tests.reference import DOMAIN, heated_contact

from benchmarks.measure import attempt
from benchmarks.table import Cell, Table
from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.api.solvers import with_work
from tehl.contact.options import Options
from tehl.operators.energy import FilmState
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.level import Level

EYRING = {"law": "eyring", "stress": 10e6}
SPEED_LOAD, SPEED_SLIDE = 100.0, 0.5
REPEATS = {257: 5, 513: 3, 1025: 1}


@dataclass(slots=True)
class Clock:
    """CPU seconds since it was started: all energy sweeps, and the work on the finest grid."""

    sweeps: float = 0.0
    finest_sweeps: float = 0.0
    finest_cycles: float = 0.0


@contextmanager
def timed_parts(points: int) -> Iterator[Clock]:
    """Time energy sweeps and multigrid cycles inside the block."""
    clock, sweep, cycle = Clock(), FilmState.sweep, Hierarchy.cycle

    def timed_sweep(self: FilmState, *args: Any, **names: Any) -> float:
        start = time.process_time()
        change = sweep(self, *args, **names)
        seconds = time.process_time() - start
        clock.sweeps += seconds
        clock.finest_sweeps += seconds if self.grid.nx == points else 0.0
        return change

    def timed_cycle(self: Hierarchy, levels: Sequence[Level]) -> None:
        start = time.process_time()
        cycle(self, levels)
        if levels[-1].grid.nx == points:
            clock.finest_cycles += time.process_time() - start

    FilmState.sweep = timed_sweep  # type: ignore[method-assign]
    Hierarchy.cycle = timed_cycle  # type: ignore[method-assign]
    try:
        yield clock
    finally:
        FilmState.sweep = sweep  # type: ignore[method-assign]
        Hierarchy.cycle = cycle  # type: ignore[method-assign]


def speed_contact(reynolds: str | None, shear: dict[str, Any] | None) -> ContactProblem:
    """Return M = 100, SRR 0.5 with the oil of the heated reference films."""
    return heated_contact(SPEED_SLIDE, reynolds=reynolds, shear=shear, moes_load=SPEED_LOAD)


def cost(problem: ContactProblem, points: int) -> tuple[Result, float, float]:
    """Return a result with its median cost, and the parts of it spent in energy sweeps.

    The first is that of all CPU seconds, the second that of sweeps and cycles on the finest grid.
    """
    options = Options(points=points, domain=DOMAIN)
    attempt(problem, options)
    runs, shares, finest = [], [], []
    for _ in range(REPEATS[points]):
        with timed_parts(points) as clock:
            runs.append(with_work(attempt(problem, options)))
        shares.append(clock.sweeps / runs[-1].cost.cpu_seconds)
        finest.append(clock.finest_sweeps / (clock.finest_sweeps + clock.finest_cycles))
    runs.sort(key=lambda run: run.cost.cpu_seconds)
    return runs[len(runs) // 2], statistics.median(shares), statistics.median(finest)


def table(*, quick: bool = False) -> Table:
    """Return the cost of a heated, thinning film and of an isothermal Newtonian one by grid."""
    made = Table(
        title="Heat: cost at M = 100, SRR 0.5, Eyring 10 MPa, X in [-4.5, 1.5], Y in [-3, 3]",
        columns=(
            "points", "status", "CPU s", "work", "sweeps %", "finest %", "cycles",
            "isothermal work", "H_central", "mid-film rise K", "traction", "heat missing %",
        ),
    )  # fmt: skip
    for points in (257,) if quick else REPEATS:
        run, share, finest = cost(speed_contact("generalised", EYRING), points)
        reference, _, _ = cost(speed_contact(None, None), points)
        made.rows.append(
            (points, run.status.cause or run.status.kind, run.cost.cpu_seconds, run.cost.work,
             100 * share, 100 * finest, cycles(run), reference.cost.work,
             f"{run.film_scaled.central:.5f}", *heat_cells(run))
        )  # fmt: skip
    made.notes.append("sweeps: part of the CPU seconds that went into the energy equation")
    made.notes.append("finest: the same on the finest grid alone, of its sweeps and cycles")
    return made


def cycles(run: Result) -> int:
    """Return the cycles on the finest grid."""
    return len([report for report in run.history if report.points[0] == run.scaled.x.size])


def heat_cells(run: Result) -> tuple[Cell, Cell, Cell]:
    """Return mid-film rise [K], traction coefficient and error of the heat balance [%]."""
    temperature, traction, heat = run.temperature, run.traction, run.heat
    return (
        temperature.mid_film_rise_central if temperature else None,
        traction.mid_film if traction else None,
        100 * heat.balance.error if heat else None,
    )
