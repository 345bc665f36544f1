"""Run the cases of a study that are not finished yet."""

import time
from collections import deque
from collections.abc import Iterable, Mapping
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from contextlib import AbstractContextManager, suppress
from dataclasses import dataclass, replace
from pathlib import Path

from tehl.errors import InputError
from tehl.kernels.cache import is_cold
from tehl.studies.case import Case
from tehl.studies.engines import Engine, engine_of
from tehl.studies.monitor import QUIET, StudyMonitor
from tehl.studies.neighbours import Neighbours
from tehl.studies.row import Row
from tehl.studies.store import Store
from tehl.studies.work import Task, in_turn, work

_MOST_TOGETHER = 32
"""Cases in a task: all of them are solved one by one if its worker dies."""
_SHARES = 4
"""Tasks that are left for each worker at least, so that all are done at about the same time."""
_KILLED = "KilledWorker"
"""What a cluster calls the error of a task whose workers died again and again."""
_NOT_BEGUN = (BrokenExecutor, EOFError, ConnectionError)
"""Errors of a task given to a pool with a dead worker, or to one whose server died just now."""
_TRIES, _WHILE = 2, 0.1
"""How often workers are begun anew, and how long a server that is dying has to be dead [s]."""
_DIED = (
    "the process that solved this case died, and died again when it solved nothing else; the "
    "system may have ended it for lack of memory"
)
_NO_WORKER = (
    "no worker process begins, or each ends at once: there may be too little memory for so many "
    "jobs; and a script that solves with jobs > 1 must do its work below "
    'if __name__ == "__main__":'
)


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """What a run of a study did.

    Attributes
    ----------
    total : int
        Different cases, by what they ask.
    reused : int
        Cases that were finished before.
    converged : int
        Cases with an answer, those of before included.
    uncertain : int
        Those of them whose minimum film is hardly known; their rows say so.
    failed : tuple of (Case, Row)
        Cases without an answer, those of before included, in the order of the study; their rows
        are without numbers.
    cpu_seconds : float
        Of the solves of this run.
    wall_seconds : float
        Of this run.
    """

    total: int
    reused: int
    converged: int
    uncertain: int
    failed: tuple[tuple[Case, Row], ...]
    cpu_seconds: float
    wall_seconds: float


def run(  # noqa: PLR0913 (keywords with defaults)
    cases: Iterable[Case],
    store: Store,
    *,
    jobs: int = 1,
    scheduler: str | None = None,
    retry_failed: bool = False,
    warm_start: bool = False,
    forked: bool = False,
    monitor: StudyMonitor = QUIET,
) -> Outcome:
    """Solve the cases that the store does not have yet, and keep each when its task is finished.

    A task is one case, or some quick ones for a worker, 0.2 seconds in all (on a cluster a second).

    A case without an answer is a row with its cause; it is not tried again unless asked for.

    Parameters
    ----------
    cases : iterable of Case
        The study; cases that ask the same are solved once.
    store : Store
        Where finished cases are kept.
    jobs : int
        Processes on this machine; 1 solves in this process. With more, a script needs
        ``if __name__ == "__main__":`` around its work.
    scheduler : str or None
        Address of a running dask cluster to solve on instead.
    retry_failed : bool
        Solve those again that have no answer.
    warm_start : bool
        Start cases of ``accuracy = "tight"`` from the nearest finished one. It takes a store that
        keeps fields, saves work where neighbours have nearly the same film, and gives the same
        answers to the tolerance, no longer to the last digit.
    forked : bool
        On Linux, fork the processes from one that has loaded the solver, which saves two seconds of
        a core for each. It is Python's ``forkserver``, which stays until the program ends and
        serves all of it: for programs that have no other use for it.
    monitor : StudyMonitor
        Told of each case.

    Raises
    ------
    InputError
        If jobs or the folder of the store cannot be.
    OSError
        If rows or fields cannot be written, or no worker begins; what is finished is kept.
    """
    start = time.perf_counter()
    every = {case.key: case for case in cases}
    done = store.finished(every.values())
    if retry_failed:
        done = {key: row for key, row in done.items() if row.converged}
    waiting = [case for key, case in every.items() if key not in done]
    monitor.begin(len(every), len(done))
    known = _finished(every.values(), done, store) if warm_start else None
    place = engine_of(jobs, len(waiting), scheduler, forked=forked)
    solved = _solve(waiting, store, place, known, monitor) if waiting else {}
    rows = done | solved
    return Outcome(
        total=len(every),
        reused=len(done),
        converged=sum(row.converged for row in rows.values()),
        uncertain=sum(row.converged and row.hint is not None for row in rows.values()),
        failed=tuple((every[key], rows[key]) for key in every if not rows[key].converged),
        cpu_seconds=sum(row.cost.cpu_seconds for row in solved.values()),
        wall_seconds=time.perf_counter() - start,
    )


def _finished(cases: Iterable[Case], done: Mapping[str, Row], store: Store) -> Neighbours:
    """Return the cases with an answer to start from."""
    if store.keep != "fields":
        raise InputError('a warm start takes a store that keeps the fields: keep = "fields"')
    return Neighbours(case for case in cases if case.key in done and done[case.key].converged)


def _solve(
    cases: list[Case],
    store: Store,
    place: AbstractContextManager[Engine],
    known: Neighbours | None,
    monitor: StudyMonitor,
) -> dict[str, Row]:
    with place as engine:  # a cluster that is gone leaves nothing
        store.prepare()
        store.sweep(cases)
        if engine.local:
            _warm(cases, monitor)
        return _Run(cases, store, engine, known, monitor).go()


def _warm(cases: list[Case], monitor: StudyMonitor) -> None:
    """Compile in this process what workers would all compile at the same time."""
    coupled = any(case.problem.is_coupled for case in cases)
    if not is_cold(coupled=coupled):
        return
    from tehl.solver.warmup import warm_up  # noqa: PLC0415 (not needed once it is compiled)

    monitor.message("compiling once, about a minute")
    warm_up(coupled=coupled)


class _Run:
    """The cases on their way through an engine.

    A worker that dies takes the work of its pool along, or, on a cluster, what waited for it. Then
    each case that was concerned is solved alone, so that the one that kills its worker is known by
    doing it twice. Where a message costs as much as a quick case, several cases make a task.
    """

    def __init__(
        self,
        cases: list[Case],
        store: Store,
        engine: Engine,
        known: Neighbours | None,
        monitor: StudyMonitor,
    ) -> None:
        self.waiting, self.suspects = deque(cases), deque[Case]()
        self.store, self.engine, self.monitor = store, engine, monitor
        self.known = known
        self.running: dict[Future[list[Row]], list[Case]] = {}
        self.seconds, self.solved = 0.0, 0
        self.alone = False
        self.rows: dict[str, Row] = {}
        self.folder = store.fields_folder.resolve() if store.keep == "fields" else None

    def go(self) -> dict[str, Row]:
        """Solve all; return the rows by key."""
        executor = self.engine.executor()
        try:
            while self.waiting or self.suspects or self.running:
                self._fill(executor)
                if not self._take():
                    self.engine.leave(executor, at_once=True)
                    executor = self._renewed()
        except BaseException:
            self._keep_finished()
            self.engine.leave(executor, at_once=True)
            raise
        self.engine.leave(executor, at_once=False)
        return self.rows

    def _fill(self, executor: Executor) -> None:
        """Give the executor as many tasks as it should have; suspects one by one."""
        if self.running and (self.alone or self.suspects):
            return
        self.alone = bool(self.suspects)
        if self.alone:
            self._submit(executor, [self.suspects.popleft()])
            return
        workers = self.engine.workers()
        window = self.engine.window(workers)
        while self.waiting and len(self.running) < window:
            count = min(self._together(workers), len(self.waiting))
            self._submit(executor, [self.waiting.popleft() for _ in range(count)])

    def _together(self, workers: int) -> int:
        """Return how many of the next cases make a task; what takes too long comes back undone."""
        in_order = self.known is not None and self.engine.local  # each starts from the one before
        if in_order or not (self.engine.task_seconds and self.solved):
            return 1
        quick = int(self.engine.task_seconds * self.solved / max(self.seconds, 1e-9))
        share = len(self.waiting) // (_SHARES * max(workers, 1))
        return max(1, min(quick, share, _MOST_TOGETHER))

    def _submit(self, executor: Executor, cases: list[Case]) -> None:
        try:
            tasks = [self._task(case) for case in cases]
            future = executor.submit(in_turn, work, tasks, self.engine.task_seconds)
        except _NOT_BEGUN as error:
            future = Future()
            future.set_exception(BrokenExecutor(str(error)))
        self.running[future] = cases

    def _task(self, case: Case) -> Task:
        """Return a case with the files that its worker leaves or finds."""
        guess = None if self.known is None else self.known.nearest(case)
        return case, self._path(case), None if guess is None else self._path(guess)

    def _path(self, case: Case) -> Path | None:
        """Return where a worker finds or leaves the fields of a case; None if nobody keeps them."""
        return None if self.folder is None else self.folder / self.store.fields_path(case).name

    def _take(self) -> bool:
        """Keep what is finished, once something is; return False when workers have died."""
        done, _ = wait(self.running, return_when=FIRST_COMPLETED)
        broken = any(isinstance(_error(future), BrokenExecutor) for future in done)
        if broken:
            done, _ = wait(self.running)  # all of a broken pool are done at once
        dead = []
        for future in [future for future in self.running if future in done]:
            if _is_death(_error(future)):
                dead.extend(self.running.pop(future))
                continue
            rows = _rows(future)
            self._keep(self.running[future], rows)
            self.waiting.extendleft(reversed(self.running.pop(future)[len(rows) :]))
        if self.alone:
            self._keep(dead, [_died(case) for case in dead])
        else:
            self.suspects.extend(dead)
        return not broken

    def _keep(self, cases: list[Case], rows: list[Row]) -> None:
        """Keep the rows of the first of some cases."""
        if rows:
            self.store.put(*rows)
        for case, row in zip(cases, rows, strict=False):
            if row.has_fields:  # what was refused at once tells nothing of the others
                self.seconds += row.cost.wall_seconds
                self.solved += 1
            self.rows[case.key] = replace(row, summary={})  # thousands of them need their room
            if self.known is not None and row.converged:
                self.known.add(case)
            self.monitor.finished(case, row)

    def _renewed(self) -> Executor:
        """Return a fresh executor whose workers begin."""
        for _ in range(_TRIES):
            executor = self.engine.executor()
            with suppress(*_NOT_BEGUN):
                executor.submit(int).result()
                return executor
            self.engine.leave(executor, at_once=True)
            time.sleep(_WHILE)
        raise OSError(_NO_WORKER)

    def _keep_finished(self) -> None:
        """Keep what was finished when the run was stopped, as far as it can be kept."""
        for future, cases in self.running.items():
            if future.done() and _error(future) is None:
                for case, row in zip(cases, future.result(), strict=False):
                    if case.key in self.rows:
                        continue
                    with suppress(OSError):
                        self.store.put(row)
                        self.monitor.finished(case, row)


def _error(future: "Future[list[Row]]") -> BaseException | None:
    """Return the error of a future that is done."""
    try:
        return future.exception()
    except CancelledError as error:
        return error


def _is_death(error: BaseException | None) -> bool:
    """Whether an error says that a worker died."""
    return isinstance(error, BrokenExecutor) or type(error).__name__ == _KILLED


def _rows(future: "Future[list[Row]]") -> list[Row]:
    """Return the rows of a task that is done.

    Raises
    ------
    OSError
        If the cluster is gone, or the fields could not be written.
    """
    error = _error(future)
    if error is None:
        return future.result()
    if isinstance(error, CancelledError):
        raise OSError("the cluster has dropped its work: its scheduler is gone") from None
    raise error


def _died(case: Case) -> Row:
    return Row(key=case.key, status="failed", cause="worker_died", message=_DIED)
