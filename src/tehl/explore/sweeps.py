"""Sweeps of the page: studies in memory, solved by processes of their own."""

import asyncio
import os
from dataclasses import dataclass
from typing import Any

from tehl.api.problem import case_from_tables
from tehl.api.results import Result
from tehl.base.errors import TehlError
from tehl.explore.jobs import End, Failure, Note, steady
from tehl.explore.numbers import Number, numbers
from tehl.explore.worker import GRACE_SECONDS, Queue, Request
from tehl.io.case import changed
from tehl.report.explain import explain
from tehl.studies.case import Case, Row
from tehl.studies.engines import Pool, Stopped
from tehl.studies.runner import StudyMonitor, run
from tehl.studies.store import Memory


@dataclass(frozen=True, slots=True)
class Swept:
    """One case of a sweep; without numbers if it did not converge."""

    x: float
    numbers: tuple[Number, ...]
    words: str


@dataclass(frozen=True, slots=True)
class Sweep:
    """Solve a case for each value of a key."""

    tables: dict[str, Any]
    path: str
    values: tuple[tuple[float, str | float], ...]
    """Places of the values, and what the case states for each."""

    def case(self, x: float, stated: str | float) -> Case:
        """Return the steady case at a value."""
        problem, options = case_from_tables(changed(self.tables, self.path, stated))
        return Case(f"{self.path} = {stated}", steady(problem), options, {self.path: x})


@dataclass(frozen=True, kw_only=True, slots=True)
class NumbersRow(Row):
    """The outcome of a case as the page shows it."""

    numbers: tuple[Number, ...] = ()
    words: str = ""


def _point_of(case: Case, result: Result) -> NumbersRow:
    """Return the numbers of a result, none if it did not converge."""
    status = result.status
    found = explain(case.problem, case.options)
    return NumbersRow(
        key=case.key,
        status=status.kind,
        numbers=numbers(result, found) if status.converged else (),
        words=status.message or status.outcome,
        cost=result.cost,
    )


class _Pool(Pool):
    """Workers that find the kernels compiled by the worker of the page, or compile them."""

    local = False


class Sweeps(Queue):
    """A thread that performs sweeps one after the other; their cases are solved side by side.

    Converged cases are kept in memory, so a sweep of more points does not solve them again.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        super().__init__(loop)
        self._memory = Memory()
        self._pool: _Pool | None = None

    def _stop(self, request: Request) -> None:
        request.is_cancelled = True
        if self._pool is not None:
            self._pool.stop()

    def _perform(self, request: Request) -> None:
        """Pass on each case of a sweep as it is solved."""
        sweep, places, mistake = request.job, dict[str, list[float]](), None
        cases = list[Case]()
        try:
            for x, stated in sweep.values:
                cases.append(sweep.case(x, stated))
                places.setdefault(cases[-1].key, []).append(x)
        except TehlError as error:
            mistake = error
        monitor = _Points(self, request, places)
        self._memory.forget_failed()
        for row in self._memory.rows(cases).values():
            monitor.show(row)
        try:
            pool = self._ready_pool()
            if not request.is_cancelled:
                run(cases, self._memory, engine=pool, make=_point_of, monitor=monitor)
        except Stopped:
            pass
        except Exception:
            self._drop_pool()  # its tasks are not those of the next sweep
            raise
        if mistake is not None and not request.is_cancelled:
            self.pass_on(request, Failure(str(mistake)))
        self.pass_on(request, End(cancelled=request.is_cancelled))

    def _ready_pool(self) -> _Pool:
        """Return the pool, a new one if it was stopped."""
        if self._pool is not None and self._pool.is_stopped:
            self._drop_pool()
        if self._pool is None:
            self._pool = _Pool(min(4, max(1, (os.cpu_count() or 1) - 1)))
        return self._pool

    def _drop_pool(self) -> None:
        if self._pool is not None:
            self._pool.close()
        self._pool = None

    def _end(self) -> None:
        with self._changed:
            if self._running is not None:
                self._stop(self._running)
        if self._thread.is_alive():
            self._thread.join(GRACE_SECONDS)
        self._drop_pool()


class _Points(StudyMonitor):
    """Passes the cases of a sweep on to the page."""

    def __init__(self, sweeps: Sweeps, request: Request, places: dict[str, list[float]]) -> None:
        self.sweeps, self.request, self.places = sweeps, request, places

    def message(self, text: str) -> None:
        self.sweeps.pass_on(self.request, Note(text))

    def begin(self, total: int, reused: int) -> None:
        del total, reused

    def finished(self, case: Case, row: Row) -> None:
        del case
        self.show(row)

    def show(self, row: Row) -> None:
        """Pass the row of a case on, at each of its places."""
        for x in self.places[row.key]:
            if isinstance(row, NumbersRow):
                swept = Swept(x, row.numbers, row.words)
            else:
                swept = Swept(x, (), row.message or row.status)
            self.sweeps.pass_on(self.request, swept)
