"""Work for the page in a thread of its own: the newest request wins; a process that solves."""

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
GRACE_SECONDS = 3.0
"""Seconds for a cancelled job to end before its process is killed, and for a stopped sweep."""
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
    is_cancelled: bool = False

    @property
    def is_quick(self) -> bool:
        """Whether it ends before cancelling it would save anything."""
        return isinstance(self.job, Ask) and self.job.quick


class Queue:
    """A thread that performs jobs, of which only the newest of an owner waits.

    Messages reach the page through ``loop``. A kind of queue says how a job is performed and
    stopped.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._waiting: OrderedDict[str, Request] = OrderedDict()
        self._running: Request | None = None
        self._changed = Condition()
        self._closed = False
        self._thread = Thread(target=self._work, daemon=True)

    def start(self) -> None:
        """Start the thread before the first request."""
        if not self._thread.is_alive():
            self._thread.start()

    def submit(self, owner: str, job: Any, receive: Receive) -> None:
        """Perform a job as soon as the thread is free; an older one of the owner is dropped.

        A running job of the owner is stopped, unless it is a quick one: while a slider moves its
        result is shown, and then that of the newest place.
        """
        self.start()
        with self._changed:
            self._waiting[owner] = Request(owner, job, receive)
            running = self._running
            if running is not None and running.owner == owner and not running.is_quick:
                self._stop(running)
            self._changed.notify()

    def cancel(self, owner: str) -> None:
        """Drop the waiting job of an owner, and stop the running one."""
        with self._changed:
            self._waiting.pop(owner, None)
            running = self._running
            if running is not None and running.owner == owner:
                self._stop(running)

    def close(self) -> None:
        """End the work, also while a job is performed."""
        with self._changed:
            self._closed = True
            self._waiting.clear()
            self._changed.notify()
        self._end()

    def pass_on(self, request: Request, message: Any) -> None:
        """Give a message to the page."""
        with suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(request.receive, message)

    def _work(self) -> None:
        while (request := self._next()) is not None:
            try:
                self._perform(request)
            except Exception as error:  # such as no process; the thread goes on
                self.pass_on(request, Failure(str(error), again=True))
                self.pass_on(request, End())
            with self._changed:
                self._running = None

    def _next(self) -> Request | None:
        with self._changed:
            while not (self._waiting or self._closed):
                self._changed.wait()
            if self._closed:
                return None
            _, self._running = self._waiting.popitem(last=False)
            return self._running

    def _perform(self, request: Request) -> None:
        """Perform a job in the thread; its last message is an `End`."""

    def _stop(self, request: Request) -> None:
        """Stop a running job, from another thread."""

    def _end(self) -> None:
        """End the processes, busy or idle."""


class Solver(Queue):
    """One warm worker process."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        super().__init__(loop)
        self._worker: WorkerProcess | None = None
        self._context: Any = multiprocessing.get_context("spawn")

    @property
    def pid(self) -> int | None:
        """Number of the process; None before it has started."""
        worker = self._worker
        return None if worker is None else worker.process.pid

    def _stop(self, request: Request) -> None:
        """Ask the process to end a job between two cycles; kill it if it does not."""
        worker = self._worker
        if worker is None:
            return
        with suppress(OSError, ValueError):
            worker.connection.send(None)
        self._loop.call_soon_threadsafe(
            lambda: self._loop.call_later(GRACE_SECONDS, self._kill, request, worker)
        )

    def _kill(self, request: Request, worker: WorkerProcess) -> None:
        if self._running is request and not request.is_busy:
            worker.process.kill()

    def _end(self) -> None:
        if self._worker is not None:
            end([self._worker])

    # ---- in the thread

    def _work(self) -> None:
        with suppress(OSError):  # so that the first job finds it compiled; it is tried again then
            self._alive()
        super()._work()

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

    def _perform(self, request: Request) -> None:
        """Send a job; pass its messages on until it ends or the process does."""
        worker = self._alive()
        try:
            worker.connection.send(request.job)
            while True:
                message = worker.connection.recv()
                request.is_busy = isinstance(message, Note) and message.text.startswith(_COMPILING)
                self.pass_on(request, message)
                if isinstance(message, End):
                    return
        except (EOFError, OSError):
            worker.process.join(GRACE_SECONDS)  # the connection may end before the process
            if not self._closed:
                self.pass_on(request, Failure(DIED, again=True))
                self.pass_on(request, End())
