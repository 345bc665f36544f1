"""Load the kernels before a clock starts, and compile those that are not in the cache.

Numba compiles one function at a time, so further processes compile into the same cache, each the
longest kernel that is left. They are started as ``python -c``: unlike a process pool that needs
no ``if __name__ == "__main__"`` in the user's script. Where none can be started, this process
compiles all.
"""

import logging
import os
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable
from contextlib import ExitStack, suppress
from functools import cache as memoized
from pathlib import Path
from threading import Lock, Thread
from typing import NamedTuple

from numba import config

from tehl.kernels import cache
from tehl.kernels.samples import COUPLED, ISOTHERMAL, Sample

SERVE = (
    "import sys; sys.path.insert(0, sys.argv[1]); from tehl.kernels.warmup import serve; serve()"
)
PARTS = dict(zip(cache.PARTS, (ISOTHERMAL, COUPLED), strict=True))
UNCOMPILED_FACTOR = 2.0
"""Expected times over those of the samples until the first kernel is compiled."""
_LOG = logging.getLogger(__name__)


class Progress(NamedTuple):
    """Kernels compiled and in total, those being compiled, and estimated time left [s]."""

    done: int
    total: int
    names: tuple[str, ...]
    seconds_left: float


Report = Callable[[Progress], None]


def silent(progress: Progress) -> None:
    """Discard a report."""
    del progress


def warm_up(*, coupled: bool, report: Report = silent) -> None:
    """Load the kernels of a solve, once per process; compile those that are not in the cache.

    Parameters
    ----------
    coupled : bool
        Include the kernels of heated and shear-thinning films.
    report : callable
        Receives the progress whenever a kernel begins or ends.
    """
    if config.DISABLE_JIT:
        return
    try:
        _prepare(report, coupled=coupled)
    except Exception:  # a damaged file of the cache may raise anything
        cache.clear()
        _prepare(report, coupled=coupled)


def _prepare(report: Report, *, coupled: bool) -> None:
    missing = cache.missing(coupled=coupled)
    if missing:
        Compilation([sample for part in missing for sample in PARTS[part]], report).run()
    for part in cache.needed(coupled=coupled):
        _load(part)
    for part in missing:
        cache.mark_compiled(part)
    if missing:
        cache.remove_old()


@memoized
def _load(part: str) -> None:
    for sample in PARTS[part]:
        sample.compile()


class Compilation:
    """Kernels to compile in this process and others.

    Parameters
    ----------
    samples : list of Sample
        The kernels.
    report : callable
        Receives the progress.
    """

    def __init__(self, samples: list[Sample], report: Report) -> None:
        self.waiting = deque(sorted(samples, key=lambda sample: -sample.seconds))
        self.total, self.weight = len(samples), sum(sample.seconds for sample in samples)
        self.processes = min(_processors(), self.total) if _can_start() else 1
        self.report, self.lock = report, Lock()
        self.running: dict[str, float] = {}  # start times
        self.done, self.finished, self.spent = 0, 0.0, 0.0

    def run(self) -> None:
        """Compile them all."""
        _LOG.info("compiling %d kernels in %d processes", self.total, self.processes)
        with ExitStack() as stack:
            threads = []
            for _ in range(self.processes - 1):
                process = _start()
                stack.callback(_end, process)
                threads.append(Thread(target=self._work, args=(_compiler_in(process),)))
            for thread in threads:
                thread.start()
            self._work(_compile_here)
            for thread in threads:
                thread.join()
            self._work(_compile_here)  # what a process that ended early left

    def _work(self, compile_one: Callable[[Sample], bool]) -> None:
        """Compile one kernel after the other until none is left, or one could not be compiled."""
        with suppress(IndexError):
            while True:
                sample = self.waiting.popleft()
                self._begin(sample)
                compiled = compile_one(sample)
                self._end(sample, compiled=compiled)
                if not compiled:
                    return

    def _begin(self, sample: Sample) -> None:
        with self.lock:
            self.running[sample.name] = time.monotonic()
            self._report()

    def _end(self, sample: Sample, *, compiled: bool) -> None:
        with self.lock:
            seconds = time.monotonic() - self.running.pop(sample.name)
            if compiled:
                self.done += 1
                self.finished, self.spent = self.finished + sample.seconds, self.spent + seconds
                self._report()
            else:
                self.waiting.append(sample)

    def _report(self) -> None:
        """Report progress; the time left follows from the pace of the kernels that are compiled."""
        now, pace = time.monotonic(), self.spent / self.finished if self.done else UNCOMPILED_FACTOR
        left = pace * (self.weight - self.finished) - sum(now - t for t in self.running.values())
        seconds = max(left, 0.0) / self.processes
        self.report(Progress(self.done, self.total, tuple(self.running), seconds))


def _compile_here(sample: Sample) -> bool:
    sample.compile()
    return True


def _processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _can_start() -> bool:
    """Return whether ``sys.executable`` is a Python interpreter, and there is a shared cache."""
    interpreter = Path(sys.executable or "").stem.lower().startswith(("python", "pypy"))
    return interpreter and not getattr(sys, "frozen", False) and cache.folder() is not None


def _start() -> "subprocess.Popen[str]":
    return subprocess.Popen(
        [sys.executable, "-c", SERVE, str(cache.SOURCE.parents[1])],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
    )


def _end(process: "subprocess.Popen[str]") -> None:
    """Kill ``process``; `communicate` closes also a pipe whose reader has ended before."""
    process.kill()
    process.communicate()


def _compiler_in(process: "subprocess.Popen[str]") -> Callable[[Sample], bool]:
    """Return the function that compiles a kernel in ``process``; it returns False on failure."""
    given, result = process.stdin, process.stdout

    def compile_there(sample: Sample) -> bool:
        if given is None or result is None:
            return False
        with suppress(OSError, ValueError):  # the process ended
            given.write(f"{sample.name}\n")
            given.flush()
            return result.readline().strip() == sample.name
        return False

    return compile_there


def serve() -> None:
    """Compile the kernels named on stdin, and print each name when done: the other process."""
    samples = {sample.name: sample for sample in (*ISOTHERMAL, *COUPLED)}
    for line in sys.stdin:
        samples[line.strip()].compile()
        sys.stdout.write(line)
        sys.stdout.flush()
