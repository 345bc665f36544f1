"""Run the cases of a study that are not finished yet; expect their time, memory and disk."""

import math
import time
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Protocol

from tehl.base.errors import InputError
from tehl.base.lazy import lazy
from tehl.contact.options import Options
from tehl.estimate.cpu_time import expected_seconds
from tehl.estimate.memory import available_memory, needed_memory
from tehl.estimate.nodes import finest_grid, planned
from tehl.estimate.scaling import ScaledProblem
from tehl.kernels.cache import is_cold
from tehl.report.transient_plan import transient_plan
from tehl.studies.case import Case, Row, retried
from tehl.studies.engines import (
    Engine,
    Files,
    Make,
    Solve,
    WorkerDied,
    engine_of,
    solve_in_turn,
    work,
)
from tehl.studies.store import Store

if TYPE_CHECKING:
    from tehl.kernels import warmup
else:
    warmup = lazy("tehl.kernels.warmup")

_DIED = (
    "the process that solved this case died, and died again with no other case in work; the "
    "system may have ended it for lack of memory"
)


class StudyMonitor(Protocol):
    """What a study reports to."""

    def message(self, text: str) -> None:
        """Take a message to the user."""

    def begin(self, total: int, reused: int) -> None:
        """Receive the size of a study that begins.

        Parameters
        ----------
        total : int
            Cases of the study.
        reused : int
            Those that the store had finished before.
        """

    def finished(self, case: Case, row: Row) -> None:
        """Receive a finished case.

        Parameters
        ----------
        case : Case
            As it was solved, perhaps with the settings of a retry.
        row : Row
            Its numbers, or its failure.
        """


class Quiet(StudyMonitor):
    """Discards all reports."""


QUIET = Quiet()  # type: ignore[abstract]  # its methods are empty on purpose


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """What a run of a study did."""

    total: int
    """Different cases, by their keys."""
    equal: int
    """Further rows of the study that equal one of them."""
    reused: int
    """Cases that were finished before."""
    converged: int
    """Converged cases, those of before included."""
    uncertain: int
    """Those of them whose minimum film is uncertain, as their rows say."""
    failed: tuple[tuple[Case, Row], ...]
    """Failed cases of this and earlier runs in the order of the study; no row has a summary."""
    retried: tuple[tuple[Case, Row], ...]
    """Converged cases that took the settings of hints, in this and earlier runs."""
    cpu_seconds: float
    """Of the solves of this run."""
    wall_seconds: float
    """Of this run."""


def run(  # noqa: PLR0913 (keywords with defaults)
    cases: Iterable[Case],
    store: Store,
    *,
    jobs: int = 1,
    scheduler: str | None = None,
    retry_failed: bool = False,
    warm_start: bool = False,
    forked: bool = False,
    engine: Engine | None = None,
    make: Make | None = None,
    monitor: StudyMonitor = QUIET,
) -> Outcome:
    """Solve the cases that the store does not have yet; keep them as tasks are finished.

    A task is one case, or several quick ones: 0.2 seconds of solving, on a cluster one second. A
    failed case is a row with its cause; it is retried on request only.

    Parameters
    ----------
    cases : iterable of Case
        The study; cases with the same key are solved once.
    store : Store
        Where finished cases are kept.
    jobs : int
        Processes on this machine; 1 solves in this process. With more, a script needs
        ``if __name__ == "__main__":`` around its work.
    scheduler : str or None
        Address of a running dask cluster to solve on instead.
    retry_failed : bool
        Solve failed cases again, with the numerical settings that their hints name.
    warm_start : bool
        Start cases of ``accuracy = "tight"`` from the nearest finished one. It takes a store that
        keeps fields, saves work where neighbours have nearly the same film, and gives the same
        results to the tolerance, no longer to the last digit.
    forked : bool
        On Linux, fork the processes from one that has loaded the solver (Python's ``forkserver``,
        which serves the whole program): it saves two seconds of a core for each.
    engine : Engine or None
        An engine to solve on, which stays open, instead of ``jobs`` or a ``scheduler``.
    make : callable or None
        Makes the row of a result in the worker; :func:`~tehl.studies.case.row_of` if left out.
    monitor : StudyMonitor
        Takes the reports.

    Raises
    ------
    InputError
        If jobs or the folder of the store are not valid.
    OSError
        If rows or fields cannot be written, or no worker starts; what is finished is kept.
    """
    start = time.perf_counter()
    cases = list(cases)
    every = {case.key: case for case in cases}
    done = store.finished(every.values())
    if retry_failed:
        failed = {key: row for key, row in done.items() if not row.converged}
        every |= {key: retried(every[key], row) for key, row in failed.items()}
        done = {key: row for key, row in done.items() if row.converged}
    waiting = [case for key, case in every.items() if key not in done]
    monitor.begin(len(every), len(done))
    neighbours = None
    if warm_start:
        if store.keep != "fields":
            raise InputError('a warm start takes a store that keeps the fields: keep = "fields"')
        neighbours = Neighbours(every[key] for key, row in done.items() if row.converged)
    place = (
        nullcontext(engine) if engine else engine_of(jobs, len(waiting), scheduler, forked=forked)
    )
    solve = work if make is None else partial(work, make=make)
    solved = _Run(waiting, store, neighbours, monitor, solve).solve(place) if waiting else {}
    rows = done | solved
    return Outcome(
        total=len(every),
        equal=len(cases) - len(every),
        reused=len(done),
        converged=sum(row.converged for row in rows.values()),
        uncertain=sum(row.converged and row.hint is not None for row in rows.values()),
        failed=tuple((every[key], rows[key]) for key in every if not rows[key].converged),
        retried=tuple(
            (every[key], row) for key, row in rows.items() if row.converged and row.retry_settings
        ),
        cpu_seconds=sum(row.cost.cpu_seconds for row in solved.values()),
        wall_seconds=time.perf_counter() - start,
    )


class Neighbours:
    """Finished cases by their labels.

    Cases are neighbours if they have the same labels, the same words among them, and the same
    number of nodes; their distance is that of the logarithms of their numbers.
    """

    def __init__(self, finished: Iterable[Case] = ()) -> None:
        self._cases: dict[object, list[tuple[tuple[float, ...], Case]]] = {}
        for case in finished:
            self.add(case)

    def add(self, case: Case) -> None:
        """Take a converged case."""
        kind, place = _kind_and_place(case)
        self._cases.setdefault(kind, []).append((place, case))

    def nearest(self, case: Case) -> Case | None:
        """Return the nearest finished case, None where there is none of its kind."""
        kind, place = _kind_and_place(case)
        known = self._cases.get(kind)
        return min(known, key=lambda one: math.dist(place, one[0]))[1] if known else None


def _kind_and_place(case: Case) -> tuple[object, tuple[float, ...]]:
    values = case.labels.values()
    words = tuple(value for value in values if isinstance(value, str))
    # on this scale equal ratios are equal steps, far from zero
    # labels below 1e-12 are next to zero
    place = tuple(math.asinh(value / 1e-12) for value in values if not isinstance(value, str))
    return (tuple(case.labels), words, case.options.points), place


class _Run:
    """The cases on their way through an engine.

    The cases of a worker that crashes are suspects: each is solved again with no other in work, and
    fails if its worker crashes again. (A cluster does not report which of the tasks that it had
    sent to a worker was in work.)
    """

    def __init__(
        self,
        cases: list[Case],
        store: Store,
        neighbours: Neighbours | None,
        monitor: StudyMonitor,
        solve_case: Solve,
    ) -> None:
        self.waiting, self.suspects = deque(cases), deque[Case]()
        self.store, self.neighbours, self.monitor = store, neighbours, monitor
        self.solve_case = solve_case
        self.submitted, self.alone = 0, False
        self.seconds, self.solved = 0.0, 0
        self.rows: dict[str, Row] = {}

    def solve(self, place: AbstractContextManager[Engine]) -> dict[str, Row]:
        """Solve all; return the rows by key, without summaries."""
        with place as engine:  # a cluster that is gone leaves no store behind
            self.store.prepare()
            self.store.sweep(self.waiting)
            if engine.local:
                _compile_once(self.waiting, self.monitor)
            while self.waiting or self.suspects or self.submitted:
                self._submit(engine)
                self._take(engine)
        return self.rows

    def _submit(self, engine: Engine) -> None:
        """Fill the window of the engine with tasks; suspects one by one."""
        if self.submitted and (self.alone or self.suspects):
            return
        self.alone = bool(self.suspects)
        queue = self.suspects if self.alone else self.waiting
        workers = engine.workers()
        window = 1 if self.alone else max(engine.ahead * workers, engine.least)
        while queue and self.submitted < window:
            cases = [queue.popleft() for _ in range(self._task_size(engine, workers))]
            task = [(case, self._files(case)) for case in cases]
            engine.submit(cases, solve_in_turn, self.solve_case, task, engine.task_seconds)
            self.submitted += 1

    def _task_size(self, engine: Engine, workers: int) -> int:
        """Return the number of cases of the next task; those that take too long come back."""
        in_order = self.neighbours is not None and engine.local  # each starts from the one before
        if self.alone or in_order or not self.solved:
            return 1
        quick = int(engine.task_seconds * self.solved / max(self.seconds, 1e-9))
        # four tasks are left for each worker, so that all end at about the same time
        share = len(self.waiting) // (4 * max(workers, 1))
        return max(1, min(quick, share, 32))  # cases of a task

    def _files(self, case: Case) -> Files:
        """Return where a worker writes the fields of a case, and finds those to start from."""
        if self.store.keep != "fields":
            return None, None
        guess = None if self.neighbours is None else self.neighbours.nearest(case)
        path = self.store.fields_path
        return path(case).absolute(), None if guess is None else path(guess).absolute()

    def _take(self, engine: Engine) -> None:
        """Wait for tasks; keep their rows. Fields that were not written end the run afterwards."""
        errors = []
        for cases, found in engine.take():
            self.submitted -= 1
            if isinstance(found, list):
                self._keep(cases, found)
                self.waiting.extendleft(reversed(cases[len(found) :]))
            elif not isinstance(found, WorkerDied):
                errors.append(found)
            elif self.alone:
                died = Row(key="", status="failed", cause="worker_died", message=_DIED)
                self._keep(cases, [replace(died, key=case.key) for case in cases])
            else:
                self.suspects.extend(cases)
        for error in errors:
            raise error

    def _keep(self, cases: list[Case], rows: list[Row]) -> None:
        self.store.put(*rows)
        for case, row in zip(cases, rows, strict=False):
            if row.has_fields:  # the time of a case rejected at once is not typical
                self.seconds += row.cost.wall_seconds
                self.solved += 1
            self.rows[case.key] = replace(row, summary={})  # thousands would fill the memory
            if self.neighbours is not None and row.converged:
                self.neighbours.add(case)
            self.monitor.finished(case, row)


def _compile_once(cases: Iterable[Case], monitor: StudyMonitor) -> None:
    """Compile in this process what all workers would compile at the same time."""
    coupled = any(case.problem.is_coupled for case in cases)
    if not is_cold(coupled=coupled):
        return

    monitor.message("compiling the kernels once, which takes 10 to 60 s")
    warmup.warm_up(coupled=coupled)


# ---- forecast

LEAST_FINISHED = 3
"""Finished cases that show how fast this machine is, and how long the others take."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Forecast:
    """Estimates of a study: times of the open cases, disk of all, memory of all workers at most."""

    cases: int
    open: int
    cpu_seconds: float
    wall_seconds: float
    disk_bytes: float
    memory_bytes: float
    is_calibrated: bool
    """Whether finished cases show how fast this machine solves these contacts."""


def forecast(
    cases: Sequence[Case], finished: Mapping[str, Row], *, jobs: int, fields: bool
) -> Forecast:
    """Return the estimates for a study.

    Parameters
    ----------
    cases : sequence of Case
        All cases of the study.
    finished : mapping of str to Row
        Finished cases by key; their times calibrate the estimate for the others.
    jobs, fields : int, bool
        Number of workers, and whether fields are kept.
    """
    every = {case.key: case for case in cases}
    waiting = [case for key, case in every.items() if key not in finished]
    known = {key: row.cost.cpu_seconds for key, row in finished.items() if row.cost.cpu_seconds > 0}
    estimated = sum(_seconds(every[key]) for key in known)
    slowness = sum(known.values()) / estimated if len(known) >= LEAST_FINISHED else 1.0
    seconds = [slowness * _seconds(case) for case in waiting]
    workers = max(1, min(jobs, len(waiting)))
    row = 3_500  # bytes
    disk = sum(row + (_field_bytes(case) if fields else 0) for case in every.values())
    needs = sorted((needed_memory(_plan(case), case.problem) for case in waiting), reverse=True)
    longest = max(sum(seconds) / workers, max(seconds, default=0.0))
    return Forecast(
        cases=len(every),
        open=len(waiting),
        cpu_seconds=sum(seconds),
        wall_seconds=longest + (3.0 if waiting else 0.0),  # until workers solve
        disk_bytes=disk,
        memory_bytes=sum(needs[:workers]),
        is_calibrated=len(known) >= LEAST_FINISHED,
    )


def expected_times(cases: Sequence[Case], finished: Mapping[str, Row]) -> dict[str, float]:
    """Return the CPU seconds to expect of the unfinished cases, by their keys.

    Parameters
    ----------
    cases : sequence of Case
        All of the study; equal ones count once.
    finished : Mapping
        Rows by key.
    """
    every = {case.key: case for case in cases}
    return {key: _seconds(case) for key, case in every.items() if key not in finished}


def check_memory_of(forecast: Forecast, jobs: int) -> None:
    """Check that all workers together fit into the available memory.

    Parameters
    ----------
    forecast : Forecast
        With the memory of all workers together [byte].
    jobs : int
        Number of workers; a single one is not checked.

    Raises
    ------
    InputError
        If they need more memory than is available.
    """
    available = available_memory()
    if available is None or forecast.memory_bytes <= available or jobs < 2:
        return
    raise InputError(
        f"{jobs} workers take about {forecast.memory_bytes / 1e9:.2g} GB of memory together, and "
        f"{available / 1e9:.2g} GB are available: take fewer --jobs or fewer points"
    )


def _plan(case: Case) -> Options:
    """Return the options of a case with the number of nodes to expect."""
    return planned(ScaledProblem.of(case.problem), case.options)


def _seconds(case: Case) -> float:
    scaled, options = ScaledProblem.of(case.problem), _plan(case)
    seconds = expected_seconds(scaled, case.options) + 0.025  # beside the solve
    grid, scales = finest_grid(scaled, options), scaled.scales
    mesh = grid.dx * scales.half_width_x, grid.dy * scales.half_width_y
    halves = case.options.points == "auto" and not case.certify
    if in_time := transient_plan(scaled, options, mesh, halves=halves):
        seconds += in_time.seconds
    return seconds * (3.5 if case.certify else 1.0)  # over the finest grid, to tight tolerances


def _field_bytes(case: Case) -> int:
    """Return the size of a file of fields, compressed: by node, and of what is beside."""
    heat = case.problem.heat
    layers = 0 if heat is None else heat.layers + 2
    return (37 + 8 * layers) * math.prod(_plan(case).shape) + 25_000
