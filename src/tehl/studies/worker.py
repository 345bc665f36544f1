"""What runs in a worker: serve a connection, solve the cases of a task, return their rows."""

import os
import signal
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from multiprocessing import parent_process
from multiprocessing.connection import Connection, wait
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Any

from tehl.api.results import ConvergenceError, Result, load_as
from tehl.base.errors import InputError, TehlError
from tehl.base.lazy import lazy
from tehl.result.solution import Cost
from tehl.studies.case import Case, Row, row_of

if TYPE_CHECKING:
    from tehl.api import solvers
else:
    solvers = lazy("tehl.api.solvers")

Files = tuple[Path | None, Path | None]
"""Where the fields of a case go, and those of another case to start from."""
Solve = Callable[[Case, Path | None, Path | None], Row]


def serve(connection: Connection) -> None:
    """Report that the process is ready; then call each function received and return its outcome."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, which ends this one
    Thread(target=end_with_parent, daemon=True).start()
    with suppress(EOFError, ConnectionError):  # the parent is gone or has closed
        connection.send("ready")
        while True:
            connection.send(attempt(*connection.recv()))


def attempt(function: Callable[..., Any], *arguments: Any) -> Any:
    """Return what a function returns, or the error that it raises."""
    try:
        return function(*arguments)
    except Exception as error:
        return error


def end_with_parent() -> None:
    """End this process when its parent has ended, even during a solve."""
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(0)


def solve_in_turn(solve: Solve, task: list[tuple[Case, Files]], seconds: float) -> list[Row]:
    """Return the rows of the first cases of a task, of one at least.

    Parameters
    ----------
    solve : callable
        As :func:`work`.
    task : list of (Case, Files)
        The cases, and the files of their fields.
    seconds : float
        Time after which the remaining cases are left.

    Raises
    ------
    OSError, InputError
        If the fields of the first case cannot be written; a later one is left with those after it.
    """
    start, rows = time.perf_counter(), list[Row]()
    for case, files in task:
        if rows and time.perf_counter() - start > seconds:
            break
        try:
            rows.append(solve(case, *files))
        except (OSError, InputError):
            if not rows:
                raise
            break
    return rows


def work(case: Case, fields: Path | None, guess: Path | None = None) -> Row:
    """Return the row of a case; an error of the case is in the row.

    Parameters
    ----------
    case : Case
        What to solve.
    fields : Path or None
        File for the result, converged or not; None if only the row is wanted.
    guess : Path or None
        File with the result of a neighbour to start from.

    Raises
    ------
    OSError, InputError
        If the fields cannot be written, which is not an error of the case.
    """
    wall, cpu = time.perf_counter(), time.process_time()
    try:
        result = _solved(case, guess)
        row = row_of(case, result)
    except Exception as error:  # an error in one case must not end a thousand
        cost = Cost(cpu_seconds=time.process_time() - cpu, wall_seconds=time.perf_counter() - wall)
        return replace(_failed(case, error), cost=cost)
    if fields is not None:
        result.save(fields)
    return row


def _failed(case: Case, error: Exception) -> Row:
    status, cause, message = "failed", "error", f"{type(error).__name__}: {error}"
    if isinstance(error, InputError):
        status, cause, message = "bad_input", "bad_input", str(error)
    elif isinstance(error, MemoryError):
        cause, message = "out_of_memory", "not enough memory: take fewer points or fewer jobs"
    message = " ".join(message.split())
    return Row(
        key=case.key,
        status=status,
        cause=cause,
        message=message,
        retry_settings=case.retry_settings,
    )


def _solved(case: Case, guess: Path | None) -> Result:
    """Return the result, converged or not; a guess that cannot be read is ignored."""
    known = None
    if guess is not None:
        with suppress(TehlError):
            known = load_as(Result, guess)
    try:
        options = case.solved_options
        if case.certify:
            return solvers.certify(case.problem, options)
        if case.problem.has_passes:
            return solvers.solve_passes(case.problem, options)
        return solvers.solve(case.problem, options, guess=known)
    except ConvergenceError as error:
        return error.result
