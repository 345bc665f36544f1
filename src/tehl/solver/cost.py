"""Cost of a result: seconds, their limit, and their number in units of one FFT deformation."""

import math
import time
from dataclasses import replace
from typing import TypeVar

import numpy as np

from tehl.contact.options import Options
from tehl.kernels.compiled import seconds_compiling
from tehl.result.solution import NO_COST, Cost, Solution

Kind = TypeVar("Kind", bound=Solution)

LEAST_SECONDS = 1.0
"""Least time of a film, and of the trials of a hint after it [s]."""
SUFFICIENT_TIMING, LONGEST_TIMING = 0.06, 0.3
"""CPU seconds after which no further transform is timed, a few ticks of any CPU clock, and most
seconds on a busy machine."""
TIMED = 513
"""Most nodes per direction that are timed; the cost of larger grids grows as n log n."""


class Clock:
    """Measures the cost from now on, in addition to that of earlier parts of a resumed run.

    The time of this part is over at ``until``, on the clock of `working_time` [s].
    """

    def __init__(self, until: float = math.inf) -> None:
        self.before, self.until, self.start = NO_COST, until, 0.0
        self._wall, self._cpu = time.perf_counter(), time.process_time()

    def end_start(self) -> None:
        """Note that what comes before the steps of a run has ended: ``start`` is its time [s]."""
        self.start = time.perf_counter() - self._wall

    @property
    def is_over(self) -> bool:
        """Whether the time of this part is over."""
        return working_time() > self.until

    def cost(self) -> Cost:
        """Return the cost so far."""
        return self.before + Cost(
            cpu_seconds=time.process_time() - self._cpu,
            wall_seconds=time.perf_counter() - self._wall,
        )


def working_time() -> float:
    """Return the clock of all limits of time: wall time without that of compilation [s].

    Kernels that few contacts need are compiled when a solve first calls one (`samples.RARE`), each
    for seconds and only once.
    """
    return time.perf_counter() - seconds_compiling()


def end_of_time(options: Options) -> float:
    """Return when the time of a solve that begins now is over, on the clock of `working_time` [s].

    Never on stated nodes without a stated ``max_time``.

    Parameters
    ----------
    options : Options
        With the limit of the time, and the nodes.
    """
    is_limited = options.points == "auto" or "max_time" in options.model_fields_set
    return working_time() + options.max_time if is_limited else math.inf


def fft_seconds(nx: int, ny: int) -> float:
    """Return the CPU seconds of one zero-padded FFT deformation; zero if the clock did not tick.

    Real transform, product with a given spectrum, inverse; full domain, period of twice the
    intervals, float64, one thread, reused buffers; mean over one interval, as a CPU clock may tick
    at 16 ms.

    Parameters
    ----------
    nx, ny : int
        Nodes along x and y; beyond `TIMED` the time of a smaller transform is extrapolated.
    """
    if max(nx, ny) > TIMED:
        fewer = [min(n, TIMED) for n in (nx, ny)]
        growth = math.log(nx * ny) / math.log(math.prod(fewer))
        return fft_seconds(*fewer) * growth * (nx * ny) / math.prod(fewer)
    shape = (2 * (ny - 1) or 1, 2 * (nx - 1))
    padded, spectrum = np.zeros(shape), np.ones((shape[0], shape[1] // 2 + 1))
    transform, convolved = np.zeros(spectrum.shape, complex), np.zeros(shape)
    padded[:ny, :nx] = 1.0

    def deform() -> None:
        np.fft.rfft2(padded, out=transform)
        np.multiply(transform, spectrum, out=transform)
        np.fft.ifft(transform, axis=0, out=transform)
        np.fft.irfft(transform, shape[1], axis=1, out=convolved)

    deform()
    start, end, count = time.process_time(), time.perf_counter() + LONGEST_TIMING, 0
    while time.process_time() - start < SUFFICIENT_TIMING and time.perf_counter() < end:
        deform()
        count += 1
    return (time.process_time() - start) / max(count, 1)


def with_work(result: Kind) -> Kind:
    """Return ``result`` with ``cost.work``: its CPU seconds in units of `fft_seconds`.

    None where the clock is too coarse for that.
    """
    ny, nx = result.scaled.pressure.shape
    unit = fft_seconds(nx, ny)
    work = result.cost.cpu_seconds / unit if unit > 0.0 else None
    return result.but(cost=replace(result.cost, work=work))
