"""Cost of a result: seconds, and their number in units of one FFT deformation on the same grid."""

import time
from dataclasses import replace

import numpy as np

from tehl.result import Result
from tehl.solution import NO_COST, Cost

REPEATS = 20


class Clock:
    """Measures the cost from now on, in addition to that of earlier parts of a resumed run."""

    def __init__(self) -> None:
        self.before = NO_COST
        self._wall, self._cpu = time.perf_counter(), time.process_time()

    def cost(self) -> Cost:
        """Return the cost so far."""
        return self.before + Cost(
            cpu_seconds=time.process_time() - self._cpu,
            wall_seconds=time.perf_counter() - self._wall,
        )


def fft_seconds(nx: int, ny: int) -> float:
    """Return the CPU seconds of one zero-padded FFT deformation on ``nx`` by ``ny`` nodes.

    Real transform, product with a given spectrum, inverse; full domain, period of twice the
    intervals, float64, one thread, reused buffers; median of `REPEATS`.
    """
    shape = (2 * (ny - 1), 2 * (nx - 1))
    padded, spectrum = np.zeros(shape), np.ones((shape[0], shape[1] // 2 + 1))
    transform, convolved = np.zeros(spectrum.shape, complex), np.zeros(shape)
    padded[:ny, :nx] = 1.0
    seconds = []
    for _ in range(REPEATS + 1):
        start = time.process_time()
        np.fft.rfft2(padded, out=transform)
        transform *= spectrum
        np.fft.ifft(transform, axis=0, out=transform)
        np.fft.irfft(transform, shape[1], axis=1, out=convolved)
        seconds.append(time.process_time() - start)
    return float(np.median(seconds[1:]))


def with_work(result: Result) -> Result:
    """Return ``result`` with ``cost.work``: its CPU seconds in units of `fft_seconds`."""
    ny, nx = result.scaled.pressure.shape
    work = result.cost.cpu_seconds / fft_seconds(nx, ny)
    return replace(result, cost=replace(result.cost, work=work))
