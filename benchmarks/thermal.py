"""Cost and convergence of heated and shear-thinning films.

A result is *wrong* as in `benchmarks.robustness`: its status is converged and its film differs from
that of the grid twice as fine by more than its own error bar.
"""

import multiprocessing
import statistics
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

from tests.reference import DOMAIN, heated_contact

from benchmarks.robustness import Outcome, attempt
from benchmarks.table import Cell, Table
from tehl.operators.energy import FilmState
from tehl.options import Options
from tehl.problem import ContactProblem
from tehl.result import Result
from tehl.solver import solve, with_work
from tehl.solver.hierarchy import Hierarchy
from tehl.solver.level import Level

EYRING = {"law": "eyring", "stress": 10e6}
LAWS: dict[str, dict[str, Any] | None] = {
    "newtonian": None,
    "eyring 5 MPa": {"law": "eyring", "stress": 5e6},
    "eyring 10 MPa": EYRING,
    "carreau": {"law": "carreau", "modulus": 6e6, "exponent": 0.42},
}
SOLIDS = (("steel", "steel"), ("steel", "glass"), ("silicon-nitride", "steel"))
HERTZ = (0.4e9, 0.6e9, 0.8e9, 1.0e9, 1.3e9)
SLIDES = (0.0, 0.1, -0.1, 0.5, -0.5, 1.0, -1.0, 1.9, -1.9)
HEAVY = (500.0, 1000.0)
HEAVY_SLIDES, HEAVY_SIZES = (0.5, 1.0), (257, 513)
SPEED_LOAD, SPEED_SLIDE = 100.0, 0.5
REPEATS = {257: 5, 513: 3, 1025: 1}


# ---- cost


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


def speed(*, quick: bool = False) -> Table:
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
            (points, outcome(run), run.cost.cpu_seconds, run.cost.work, 100 * share, 100 * finest,
             cycles(run),
             reference.cost.work, f"{run.film_scaled.central:.5f}", *heat_cells(run))
        )  # fmt: skip
    made.notes.append("sweeps: part of the CPU seconds that went into the energy equation")
    made.notes.append("finest: the same on the finest grid alone, of its sweeps and cycles")
    return made


def outcome(run: Result) -> str:
    """Return the status or the cause of failure of a run."""
    return run.status.cause or run.status.kind


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


# ---- robustness


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """One contact of the sweep; the load is a Hertz pressure [Pa] or a Moes number."""

    law: str
    slide: float
    solids: tuple[str, str] = SOLIDS[0]
    hertz: float | None = None
    moes: float | None = None
    points: int

    @property
    def problem(self) -> ContactProblem:
        """Return the contact, without any optional key."""
        load = {"moes_load": self.moes} if self.hertz is None else {"hertz_pressure": self.hertz}
        return heated_contact(
            self.slide, shear=LAWS[self.law], solids=self.solids, sources="auto", **load
        )

    @property
    def cells(self) -> tuple[Cell, ...]:
        """Return the first cells of its row."""
        load = f"M = {self.moes:g}" if self.hertz is None else f"{self.hertz / 1e9:g} GPa"
        return self.law, "/".join(self.solids), load, self.slide, self.points


@dataclass(frozen=True, kw_only=True, slots=True)
class Judged:
    """One contact with its outcome."""

    case: Case
    status: str
    row: tuple[Cell, ...]
    judged: bool = False
    wrong: bool = False


COLUMNS = (
    "law", "solids", "load", "SRR", "points", "status", "smoother", "cycles", "CPU s", "M",
    "H_central", "H_min", "bar_m %", "rise K", "traction", "missing %", "twice finer", "off/bar",
    "rise off %", "",
)  # fmt: skip


def cases(points: int, *, quick: bool) -> Iterator[Case]:
    """Yield the contacts of the sweep, those of one law together."""
    laws = ("newtonian", "eyring 10 MPa") if quick else tuple(LAWS)
    hertz = HERTZ[::2] if quick else HERTZ
    slides = (0.0, 0.5, -1.9) if quick else SLIDES
    for law in laws:
        for solids in SOLIDS[:2] if quick else SOLIDS:
            for pressure in hertz:
                for slide in slides:
                    yield Case(law=law, slide=slide, solids=solids, hertz=pressure, points=points)
    for load in () if quick else HEAVY:
        for slide in HEAVY_SLIDES:
            for size in HEAVY_SIZES:
                yield Case(law="eyring 10 MPa", slide=slide, moes=load, points=size)


def judge(case: Case, *, finer: bool) -> Judged:
    """Solve a case with the defaults, optionally also on twice as many intervals."""
    try:
        run = attempt(case.problem, Options(points=case.points))
        twice = attempt(case.problem, Options(points=2 * case.points - 1)) if finer else None
    except Exception as error:  # a sweep of hundreds of cases continues after a crash
        status = f"crashed: {type(error).__name__}"
        blanks = (None,) * (len(COLUMNS) - len(case.cells) - 1)
        return Judged(case=case, status=status, row=(*case.cells, status, *blanks))
    film, errors, rise = run.film_scaled, run.errors, heat_cells(run)
    row: tuple[Cell, ...] = (
        *case.cells, outcome(run), run.history[-1].smoother if run.history else None, cycles(run),
        run.cost.cpu_seconds, run.groups.M, f"{film.central:.5f}", f"{film.minimum:.5f}",
        100 * errors.discretisation_minimum if errors else None, *rise,
    )  # fmt: skip
    if twice is None:
        return Judged(case=case, status=outcome(run), row=(*row, None, None, None, ""))
    pair = Outcome(load=run.groups.M, speed=run.groups.L, ratio=1.0, result=run, finer=twice)
    off: Cell = None
    if pair.judged:
        off = max(pair.excess("central"), pair.excess("minimum"))
    there, warmer = heat_cells(twice)[0], None
    if isinstance(rise[0], float) and isinstance(there, float):
        warmer = 100 * (rise[0] / there - 1.0)
    row = (*row, outcome(twice), off, warmer, "WRONG" if pair.wrong else "")
    return Judged(case=case, status=outcome(run), row=row, judged=pair.judged, wrong=pair.wrong)


def judged_by(wanted: Iterable[Case], jobs: int, *, finer: bool) -> Iterator[Judged]:
    """Yield the outcomes in order, solved by ``jobs`` processes."""
    work = partial(judge, finer=finer)
    if jobs == 1:
        yield from map(work, wanted)
        return
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        yield from pool.imap(work, wanted)


def robustness(points: int, *, quick: bool = False, finer: bool = False, jobs: int = 1) -> Table:
    """Return which heated contacts converge on ``points`` x ``points`` nodes."""
    made = Table(
        title=f"Heat: robustness, {points} x {points} nodes, defaults, cold", columns=COLUMNS
    )
    found = list(judged_by(cases(points, quick=quick), jobs, finer=finer))
    made.rows.extend(one.row for one in found)
    for law in LAWS:
        made.notes.extend(count(law, [one for one in found if one.case.law == law]))
    return made


def count(law: str, found: list[Judged]) -> Iterator[str]:
    """Yield one line that counts the outcomes of a law."""
    if not found:
        return
    statuses = Counter(one.status for one in found)
    named = ", ".join(f"{number} {status}" for status, number in statuses.most_common())
    judged = [one for one in found if one.judged]
    wrong = sum(one.wrong for one in judged)
    verdict = f"; wrong: {wrong} of {len(judged)} judged" if judged else ""
    yield f"{law}: {len(found)} cases: {named}{verdict}"


def tables(
    points: int, *, quick: bool = False, finer: bool = False, jobs: int = 1
) -> Iterator[Table]:
    """Yield the cost and the robustness of heated films."""
    solve(speed_contact("generalised", EYRING), Options(points=129, domain=DOMAIN))
    yield speed(quick=quick)
    yield robustness(points, quick=quick, finer=finer, jobs=jobs)
