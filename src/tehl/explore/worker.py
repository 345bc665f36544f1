"""The process that solves for the page: the newest request wins, and a new process replaces it."""

import asyncio
import multiprocessing
from collections import OrderedDict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from threading import Condition, Thread
from typing import Any

from tehl.explore.jobs import Ask, End, Failure, Note, serve
from tehl.studies.engines import WorkerProcess, end, undisturbed

DIED = (
    "The process that solves has ended, perhaps for lack of memory. A new one has been started: "
    "change a value or solve again."
)
_GRACE = 3.0
"""Seconds for a cancelled job to end before its process is killed."""
_COMPILING = "compiling"

Receive = Callable[[Any], None]


@dataclass(slots=True, eq=False)
class Request:
    """A job of an owner, and the function that receives its messages in the loop of the page."""

    owner: str
    job: Any
    receive: Receive
    is_busy: bool = False
    """Whether it must not be killed: it compiles."""

    @property
    def is_quick(self) -> bool:
        """Whether it ends before cancelling it would save anything."""
        return isinstance(self.job, Ask) and self.job.quick


class Solver:
    """One warm worker process, and a queue in which only the newest request of an owner waits.

    A thread talks to the process, so that the page never waits. Messages reach the page through
    ``loop``.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._waiting: OrderedDict[str, Request] = OrderedDict()
        self._running: Request | None = None
        self._worker: WorkerProcess | None = None
        self._changed = Condition()
        self._closed = False
        self._context: Any = multiprocessing.get_context("spawn")
        self._thread = Thread(target=self._work, daemon=True)

    def start(self) -> None:
        """Start the process before the first request."""
        if not self._thread.is_alive():
            self._thread.start()

    @property
    def pid(self) -> int | None:
        """Number of the process; None before it has started."""
        worker = self._worker
        return None if worker is None else worker.process.pid

    def submit(self, owner: str, job: Any, receive: Receive) -> None:
        """Perform a job as soon as the process is free; an older one of the owner is dropped.

        A running job of the owner is cancelled, unless it is a quick one: while a slider moves its
        result is shown, and then that of the newest place.
        """
        self.start()
        with self._changed:
            self._waiting[owner] = Request(owner, job, receive)
            running = self._running
            self._changed.notify()
        if running is not None and running.owner == owner and not running.is_quick:
            self._cancel(running)

    def cancel(self, owner: str) -> None:
        """Drop the waiting job of an owner, and cancel the running one."""
        with self._changed:
            self._waiting.pop(owner, None)
            running = self._running
        if running is not None and running.owner == owner:
            self._cancel(running)

    def close(self) -> None:
        """End the process, busy or idle."""
        with self._changed:
            self._closed = True
            self._waiting.clear()
            self._changed.notify()
            worker = self._worker
        if worker is not None:
            end([worker])

    def _cancel(self, running: Request) -> None:
        """Ask the process to end a job between two cycles; kill it if it does not."""
        worker = self._worker
        if worker is None:
            return
        with suppress(OSError, ValueError):
            worker.connection.send(None)
        self._loop.call_soon_threadsafe(
            lambda: self._loop.call_later(_GRACE, self._kill, running, worker)
        )

    def _kill(self, request: Request, worker: WorkerProcess) -> None:
        if self._running is request and not request.is_busy:
            worker.process.kill()

    # ---- in the thread

    def _work(self) -> None:
        with suppress(OSError):  # so that the first job finds it compiled; it is tried again then
            self._alive()
        while not self._closed:
            request = self._next()
            if request is None:
                return
            try:
                self._perform(request, self._alive())
            except OSError as error:  # no process can be started
                self._pass_on(request, Failure(str(error), again=True))
                self._pass_on(request, End())
            with self._changed:
                self._running = None

    def _alive(self) -> WorkerProcess:
        """Return the process, started again if it has ended."""
        worker = self._worker
        if worker is None or not worker.process.is_alive():
            if worker is not None:
                end([worker])
            with undisturbed():
                worker = self._worker = WorkerProcess(self._context, serve)
            with suppress(EOFError, OSError):
                worker.connection.recv()
        return worker

    def _next(self) -> Request | None:
        with self._changed:
            while not (self._waiting or self._closed):
                self._changed.wait()
            if self._closed:
                return None
            _, self._running = self._waiting.popitem(last=False)
            return self._running

    def _perform(self, request: Request, worker: WorkerProcess) -> None:
        """Send a job; pass its messages on until it ends or the process does."""
        try:
            worker.connection.send(request.job)
            while True:
                message = worker.connection.recv()
                request.is_busy = isinstance(message, Note) and message.text.startswith(_COMPILING)
                self._pass_on(request, message)
                if isinstance(message, End):
                    return
        except (EOFError, OSError):
            worker.process.join(_GRACE)  # the connection may end before the process
            if not self._closed:
                self._pass_on(request, Failure(DIED, again=True))
                self._pass_on(request, End())

    def _pass_on(self, request: Request, message: Any) -> None:
        with suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(request.receive, message)
