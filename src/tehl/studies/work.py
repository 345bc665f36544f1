"""What a worker does: solve one case, keep its fields, tell the rest as a row."""

import time
from collections.abc import Callable
from pathlib import Path

from tehl.errors import ConvergenceError, InputError, TehlError
from tehl.result import Cost, Result
from tehl.studies.case import Case
from tehl.studies.row import Row, row_of

Task = tuple[Case, Path | None, Path | None]
"""A case, a file for its fields and one to start from."""


def in_turn(
    solve: Callable[[Case, Path | None, Path | None], Row], tasks: list[Task], seconds: float
) -> list[Row]:
    """Return the rows of some cases, one after the other, of the first one at least.

    After so many seconds, or where the fields of a case cannot be written, the others are left.
    """
    start, rows = time.perf_counter(), list[Row]()
    for task in tasks:
        if rows and time.perf_counter() - start > seconds:
            break
        try:
            rows.append(solve(*task))
        except (OSError, InputError):
            if not rows:
                raise
            break  # it is told when that case is the first of a task
    return rows


def work(case: Case, fields: Path | None, guess: Path | None = None) -> Row:
    """Return the row of a case; whatever goes wrong with the case is in the row.

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
        If the fields cannot be written; that is no fault of the case.
    """
    start = time.perf_counter(), time.process_time()
    try:
        result = _solved(case, guess)
        row = row_of(case.key, result)
    except InputError as error:
        return _without_result(case, "bad_input", "bad_input", str(error), start)
    except MemoryError:
        words = "not enough memory: take fewer points or fewer jobs"
        return _without_result(case, "failed", "out_of_memory", words, start)
    except Exception as error:  # a fault in one case must not end a thousand
        words = f"{type(error).__name__}: {error}"
        return _without_result(case, "failed", "error", words, start)
    if fields is not None:
        result.save(fields)
    return row


def _solved(case: Case, guess: Path | None) -> Result:
    """Return the result, also when it is no answer."""
    from tehl import solver  # noqa: PLC0415 (whoever reads a store compiles nothing)

    try:
        if case.certify:
            return solver.certify(case.problem, case.options)
        known = None if guess is None else _loaded(guess)
        return solver.solve(case.problem, case.options, guess=known)
    except ConvergenceError as error:
        return error.result


def _loaded(guess: Path) -> Result | None:
    """Return a result to start from; a file that cannot be read is no reason to fail."""
    from tehl.io.store import load_as  # noqa: PLC0415 (HDF5, for warm starts only)

    try:
        return load_as(Result, guess)
    except TehlError:
        return None


def _without_result(
    case: Case, status: str, cause: str, message: str, start: tuple[float, float]
) -> Row:
    wall, cpu = start
    cost = Cost(
        cpu_seconds=time.process_time() - cpu,
        wall_seconds=time.perf_counter() - wall,
    )
    message = " ".join(message.split())
    return Row(key=case.key, status=status, cause=cause, message=message, cost=cost)
