"""Where cases are solved: in this process, in processes of this machine, or on a dask cluster.

An engine takes functions, each under a ticket, and returns in any order each ticket with what its
function gave: a value, the error that it raised, or :class:`WorkerDied`. What runs in a worker
stands at the end.
"""

import multiprocessing
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future
from concurrent.futures import wait as wait_for
from contextlib import closing, contextmanager, suppress
from dataclasses import replace
from multiprocessing import parent_process, resource_tracker
from multiprocessing.connection import Connection, wait
from pathlib import Path
from threading import Lock, Thread
from typing import TYPE_CHECKING, Any

from tehl.api.results import ConvergenceError, Result, TransientResult, load_as
from tehl.base.errors import InputError, TehlError
from tehl.base.lazy import lazy
from tehl.base.version import __version__
from tehl.result.solution import Cost
from tehl.studies.case import Case, Row, row_of

if TYPE_CHECKING:
    from tehl.api import solvers
else:
    solvers = lazy("tehl.api.solvers")

Ticket = Any
Finished = list[tuple[Ticket, Any]]

_THREADS = ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
_ENVIRONMENT = dict.fromkeys((*_THREADS, "PYTHONSAFEPATH"), "1")
"""Of workers: one thread; a random.py in the current folder does not shadow the library's."""
_STARTING = Lock()
"""Held while the environment of the program is that of workers."""
_CONNECT = 30.0
"""Seconds to find a scheduler."""
_NO_WORKER = (
    "no worker process starts, or each ends at once: there may be too little memory for this "
    "number of jobs; and a script that solves with jobs > 1 must do its work below "
    'if __name__ == "__main__":'
)


class WorkerDied(Exception):  # noqa: N818 (an event)
    """The process ended while it solved."""


class Stopped(Exception):  # noqa: N818 (an event)
    """A pool was stopped by another thread."""


class Engine:
    """A place to solve cases; this one is the calling process."""

    local = True
    """Whether workers share the compiled kernels of this machine."""
    task_seconds = 0.0
    """Seconds of solving worth a message to a worker: quick cases are bundled up to it."""
    ahead, least = 1, 1
    """Tasks that are submitted at a time: per worker, and at least."""

    def __init__(self) -> None:
        self._finished: Finished = []

    def workers(self) -> int:
        """Return the number of cases that are solved at a time, 0 before a cluster has grown."""
        return 1

    def submit(self, ticket: Ticket, function: Callable[..., Any], *arguments: Any) -> None:
        """Call a function now, or as soon as a worker is idle.

        Parameters
        ----------
        ticket : Ticket
            Returned with the result.
        function : callable
            Importable by workers, so a function of a module.
        *arguments
            Must be picklable.
        """
        self._finished.append((ticket, attempt(function, *arguments)))

    def take(self) -> Finished:
        """Wait until some of what was submitted is finished; return it."""
        finished, self._finished = self._finished, []
        return finished

    def close(self) -> None:
        """End the workers, busy or idle."""


@contextmanager
def engine_of(
    jobs: int, cases: int, scheduler: str | None = None, *, forked: bool = False
) -> Iterator[Engine]:
    """Yield the engine for a number of workers, or of a running dask cluster.

    Parameters
    ----------
    jobs, cases : int
        Workers on this machine, at most one for each of the cases; 1 solves in this process.
    scheduler : str or None
        Address of a dask scheduler, ``"tcp://host:8786"``; overrides ``jobs``.
    forked : bool
        As in :func:`tehl.studies.run`.
    """
    if scheduler is not None:
        with _client(scheduler) as client, closing(_Cluster(client)) as cluster:
            yield cluster
        return
    if not jobs >= 1:
        raise InputError(f"jobs = {jobs} must be at least 1")
    with closing(Engine() if jobs == 1 else Pool(min(jobs, cases), forked=forked)) as engine:
        yield engine


class Pool(Engine):
    """Processes of this machine.

    Each has its own connection and one task at a time, so a crash loses one task only. Each loads
    the solver itself or, ``forked`` on Linux, is forked from a server of one thread that has loaded
    it with the kernels of Newtonian films: Python's ``forkserver``, one per program.
    """

    task_seconds = 0.2

    def __init__(self, jobs: int, *, forked: bool = False) -> None:
        self._jobs, self._idle = jobs, list[WorkerProcess]()
        self._busy: dict[Connection, tuple[WorkerProcess, Ticket]] = {}
        self._stopped, self._stopper = multiprocessing.Pipe(duplex=False)
        forked = forked and sys.platform == "linux"  # elsewhere libraries do not survive a fork
        self._context: Any = multiprocessing.get_context("forkserver" if forked else "spawn")
        if forked:
            self._context.set_forkserver_preload(["tehl.studies.ready"])

    def workers(self) -> int:
        """Return the number of processes."""
        return self._jobs

    def submit(self, ticket: Ticket, function: Callable[..., Any], *arguments: Any) -> None:
        """Send a task to an idle process."""
        if not self._idle:
            self._idle = self._started(self._jobs - len(self._busy))
        worker = self._idle.pop()
        with suppress(ConnectionError):  # take() finds a worker that has died since
            worker.connection.send((function, *arguments))
        self._busy[worker.connection] = worker, ticket

    def take(self) -> Finished:
        """Wait until some workers have finished or died; return their tasks, or raise `Stopped`."""
        finished: Finished = []
        for connection in wait([*self._busy, self._stopped]):
            if connection is self._stopped:
                raise Stopped
            assert isinstance(connection, Connection)
            worker, ticket = self._busy.pop(connection)
            try:
                finished.append((ticket, connection.recv()))
                self._idle.append(worker)
            except (EOFError, OSError):
                end([worker])
                finished.append((ticket, WorkerDied()))
        return finished

    def stop(self) -> None:
        """End a run from another thread; the pool can only be closed then."""
        self._stopper.send(None)

    @property
    def is_stopped(self) -> bool:
        """Whether :meth:`stop` was called."""
        return self._stopped.poll()

    def close(self) -> None:
        """End the processes."""
        end([*self._idle, *(worker for worker, _ in self._busy.values())])
        self._idle, self._busy = [], {}

    def _started(self, count: int) -> list["WorkerProcess"]:
        """Start workers side by side; return them when each has reported that it is ready."""
        for _ in range(3):
            workers = list[WorkerProcess]()
            try:
                with undisturbed():
                    workers += (WorkerProcess(self._context, serve) for _ in range(count))
                for worker in workers:
                    worker.connection.recv()
            except (EOFError, ConnectionError):
                end(workers)
                time.sleep(0.1)  # for a crashed fork server to end
            else:
                return workers
        raise OSError(_NO_WORKER)


class WorkerProcess:
    """A process that ends with the program, and the connection to it."""

    def __init__(self, context: Any, serve: Callable[[Connection], None]) -> None:
        self.connection, theirs = context.Pipe()
        with theirs:
            self.process = context.Process(target=serve, args=(theirs,), daemon=True)
            self.process.start()


def end(workers: list[WorkerProcess]) -> None:
    """Terminate workers, busy or idle, and wait until they have ended."""
    for worker in workers:
        worker.connection.close()
        worker.process.terminate()
    for worker in workers:
        worker.process.join(10.0)  # seconds for a terminated worker to end


@contextmanager
def undisturbed() -> Iterator[None]:
    """Give the environment of workers to what is started, and keep Ctrl-C from it."""
    with _STARTING:
        before = {name: os.environ[name] for name in _ENVIRONMENT if name in os.environ}
        os.environ.update(_ENVIRONMENT)
        if sys.platform != "win32":
            resource_tracker.ensure_running()  # unblocks the signal when it starts
            mask = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        try:
            yield
        finally:
            if sys.platform != "win32":
                signal.pthread_sigmask(signal.SIG_SETMASK, mask)
            for name in _ENVIRONMENT:
                del os.environ[name]
            os.environ.update(before)


class _Cluster(Engine):
    """A running dask cluster; 64 tasks make it grow if it can."""

    local, task_seconds, ahead, least = False, 1.0, 3, 64

    def __init__(self, client: Any) -> None:
        self._client, self._executor = client, client.get_executor(pure=False)
        self._futures: dict[Future[Any], Ticket] = {}

    def workers(self) -> int:
        """Return the number of threads of the cluster at present."""
        return sum(self._client.nthreads().values())

    def submit(self, ticket: Ticket, function: Callable[..., Any], *arguments: Any) -> None:
        self._futures[self._executor.submit(function, *arguments)] = ticket

    def take(self) -> Finished:
        done, _ = wait_for(self._futures, return_when=FIRST_COMPLETED)
        return [(self._futures.pop(future), attempt(_value, future)) for future in done]

    def close(self) -> None:
        """Withdraw the tasks; the cluster stays."""
        self._executor.shutdown(wait=False)


def _value(future: Future[Any]) -> Any:
    if future.cancelled():
        raise OSError("the cluster has dropped its tasks: the scheduler is gone")
    if type(future.exception()).__name__ == "KilledWorker":  # four workers died of it in turn
        raise WorkerDied
    return future.result()


@contextmanager
def _client(address: str) -> Iterator[Any]:
    """Connect to a cluster whose workers have this version: others would mislabel their rows."""
    from distributed import Client  # noqa: PLC0415 (an extra, and a second of import)

    try:
        client = Client(address, timeout=_CONNECT)
    except (OSError, ValueError) as error:  # timed out, or an invalid address
        raise OSError(f"no dask scheduler replies at {address} ({error})") from None
    with client:
        if others := set(client.run(_version).values()) - {__version__}:
            raise OSError(
                f"workers of the cluster have tehl {', '.join(sorted(others))}, this is "
                f"{__version__}: install the same version everywhere"
            )
        yield client


def _version() -> str:
    return __version__


# ---- in a worker

Files = tuple[Path | None, Path | None]
"""Where the fields of a case go, and those of another case to start from."""
Solve = Callable[[Case, Path | None, Path | None], Row]
Make = Callable[[Case, Any], Row]
"""Makes the row of a result, steady or transient as the case is."""


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


def work(case: Case, fields: Path | None, guess: Path | None = None, *, make: Make = row_of) -> Row:
    """Return the row of a case; an error of the case is in the row.

    Parameters
    ----------
    case : Case
        What to solve.
    fields : Path or None
        File for the result, converged or not; None if only the row is wanted.
    guess : Path or None
        File with the result of a neighbour to start from.
    make : callable
        Makes the row of a result.

    Raises
    ------
    OSError, InputError
        If the fields cannot be written, which is not an error of the case.
    """
    wall, cpu = time.perf_counter(), time.process_time()
    try:
        result = _solved(case, guess)
        row = make(case, result)
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


def _solved(case: Case, guess: Path | None) -> Result | TransientResult:
    """Return the result, converged or not; a guess that cannot be read is ignored.

    That of a transient run whose start did not converge is the steady one.
    """
    known = None
    if guess is not None:
        with suppress(TehlError):
            known = load_as(Result, guess)
    try:
        options = case.solved_options
        if case.problem.transient is not None:
            in_time = solvers.certify_transient if case.certify else solvers.solve_transient
            return in_time(case.problem, options)
        if case.certify:
            return solvers.certify(case.problem, options)
        if case.problem.has_passes:
            return solvers.solve_passes(case.problem, options)
        return solvers.solve(case.problem, options, guess=known)
    except ConvergenceError as error:
        return error.result
