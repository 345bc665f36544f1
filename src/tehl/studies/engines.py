"""Where cases are solved: here, in processes of this machine, or on a running dask cluster.

The seam is :class:`concurrent.futures.Executor`; an engine says how to get one, how many cases to
have in it, and how to leave it.
"""

import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing.connection import wait
from multiprocessing.context import BaseContext
from typing import Any, Protocol

from tehl import __version__
from tehl.errors import InputError

ONE_THREAD = (
    "NUMBA_NUM_THREADS",
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
)
"""What keeps a worker on its one core; read when the libraries are loaded."""
_READY = "tehl.studies.ready"
"""Loaded once by the server that workers are forked from."""
_OF_WORKERS = dict.fromkeys((*ONE_THREAD, "PYTHONSAFEPATH"), "1")
"""Their environment; the last keeps a random.py in the current folder from being the library's."""
_WAITING = 2
"""Tasks that a pool holds for each worker: one in work and one at hand."""
_GRACE = 10.0
"""Seconds that a worker has to end."""
_LEAST_ON_CLUSTER, _CONNECT = 64, 30.0
"""Tasks that a cluster is given at least, so that it can grow; seconds to find its scheduler."""
_TASK, _TASK_HERE = 1.0, 0.2
"""Seconds of solving that are worth a message through the scheduler of a cluster, or to a process
of this machine."""


class Engine(Protocol):
    """A place to solve cases."""

    @property
    def local(self) -> bool:
        """Whether workers are processes that the caller has to warm the kernels for."""
        ...

    @property
    def task_seconds(self) -> float:
        """Seconds of solving that cases are put together for; zero if each goes by itself."""
        ...

    def executor(self) -> Executor:
        """Return a fresh executor."""
        ...

    def workers(self) -> int:
        """Return how many cases are solved at a time, now; zero before a cluster has grown."""
        ...

    def window(self, workers: int) -> int:
        """Return how many tasks to have in the executor at a time, for so many workers."""
        ...

    def leave(self, executor: Executor, *, at_once: bool) -> None:
        """End an executor; ``at_once`` gives up what is in work."""
        ...


@contextmanager
def engine_of(
    jobs: int, cases: int, scheduler: str | None = None, *, forked: bool = False
) -> Iterator[Engine]:
    """Yield the engine for a number of workers, or of a running dask cluster.

    Parameters
    ----------
    jobs : int
        Workers on this machine; one solves in this process.
    cases : int
        No more workers than these are begun.
    scheduler : str or None
        Address of a dask scheduler, ``"tcp://host:8786"``; ``jobs`` does not count then.
    forked : bool
        As in :func:`tehl.studies.run`.

    Raises
    ------
    InputError
        If the number of workers cannot be.
    OSError
        If no scheduler answers.
    ModuleNotFoundError
        If dask is not installed.
    """
    if scheduler is not None:
        with _cluster(scheduler) as engine:
            yield engine
        return
    if not jobs >= 1:
        raise InputError(f"jobs = {jobs} must be at least 1")
    if jobs == 1:
        yield Serial()
        return
    with _environment(_OF_WORKERS):
        yield Pool(min(jobs, cases), forked=forked)


class Serial:
    """The process that calls, one case after the other."""

    local, task_seconds = True, 0.0

    def executor(self) -> Executor:
        """Return an executor that works when it is asked to."""
        return _Here()

    def workers(self) -> int:
        """Return one."""
        return 1

    def window(self, workers: int) -> int:
        """Return as many tasks as workers."""
        return workers

    def leave(self, executor: Executor, *, at_once: bool) -> None:
        """Do nothing: there is nothing left over."""


class _Here(Executor):
    """An executor without workers."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call ``fn`` now."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


class Pool:
    """Fresh processes of this machine, one thread each.

    Each loads the solver itself; ``forked``, on Linux, from a server, a fresh process of one thread
    that has loaded it with the kernels of Newtonian films. Python has one such server per program.
    """

    local, task_seconds = True, _TASK_HERE

    def __init__(self, jobs: int, *, forked: bool = False) -> None:
        self.jobs = jobs
        self.forked = forked and sys.platform == "linux"  # elsewhere libraries do not bear it

    def executor(self) -> Executor:
        """Return a pool; its processes begin when they are needed."""
        context = multiprocessing.get_context("forkserver" if self.forked else "spawn")
        if self.forked:
            _begin_server(context)
        return ProcessPoolExecutor(self.jobs, mp_context=context, initializer=begin_worker)

    def workers(self) -> int:
        """Return the number of processes."""
        return self.jobs

    def window(self, workers: int) -> int:
        """Return two tasks per worker."""
        return _WAITING * workers

    def leave(self, executor: Executor, *, at_once: bool) -> None:
        """End the processes, by force if it has to be at once."""
        processes = list((getattr(executor, "_processes", None) or {}).values())
        executor.shutdown(wait=not at_once, cancel_futures=True)
        if at_once:
            for process in processes:
                process.terminate()
            for process in processes:
                process.join(_GRACE)


def _begin_server(context: BaseContext) -> None:
    """Begin the server of workers, if it does not run; Ctrl-C is not for it."""
    from multiprocessing import forkserver, resource_tracker  # noqa: PLC0415 (not on every system)

    context.set_forkserver_preload([_READY])
    resource_tracker.ensure_running()  # it lets signals through again when it begins
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        forkserver.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def begin_worker() -> None:
    """Leave Ctrl-C to the parent, and end when the parent is gone, however it went."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: int) -> None:
    wait([sentinel])
    os._exit(1)


class Cluster:
    """A running dask cluster."""

    local, task_seconds = False, _TASK

    def __init__(self, client: Any) -> None:
        self.client = client

    def executor(self) -> Executor:
        """Return the executor of the client."""
        executor: Executor = self.client.get_executor(pure=False)
        return executor

    def workers(self) -> int:
        """Return the threads that the cluster has now."""
        return sum(self.client.nthreads().values())

    def window(self, workers: int) -> int:
        """Return three tasks per thread, and enough to make a cluster grow."""
        return max(3 * workers, _LEAST_ON_CLUSTER)

    def leave(self, executor: Executor, *, at_once: bool) -> None:
        """Withdraw what is not done; the cluster goes on."""
        executor.shutdown(wait=not at_once)


@contextmanager
def _cluster(address: str) -> Iterator[Cluster]:
    from distributed import Client  # noqa: PLC0415 (an extra, and a second of import)

    try:
        client = Client(address, timeout=_CONNECT)
    except (OSError, ValueError) as error:  # the time ran out, or that is no address
        raise OSError(f"no dask scheduler answers at {address} ({error})") from None
    with client:
        _check_versions(client)
        yield Cluster(client)


def _check_versions(client: Any) -> None:
    """Refuse workers that have another version: their answers would be kept under a wrong name."""
    others = {version for version in client.run(version_here).values() if version != __version__}
    if others:
        raise OSError(
            f"workers of the cluster have tehl {', '.join(sorted(others))}, this is {__version__}: "
            "install the same version everywhere"
        )


def version_here() -> str:
    """Return the version of this package in the process that asks."""
    return __version__


@contextmanager
def _environment(values: dict[str, str]) -> Iterator[None]:
    """Set variables of the environment for a while."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
