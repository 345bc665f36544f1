"""The unit of work: one FFT deformation on the same grid, measured on this machine."""

import time
from dataclasses import replace

import numpy as np
from scipy import fft

from tehl.result import Result

REPEATS = 20


def fft_seconds(nx: int, ny: int) -> float:
    """Return the CPU seconds of one zero-padded FFT deformation on ``nx`` by ``ny`` nodes.

    Real transform, product with a ready spectrum, inverse; full domain, period of twice the
    intervals, float64, one worker, buffers reused; median of twenty.
    """
    shape = (2 * (ny - 1), 2 * (nx - 1))
    padded, spectrum = np.zeros(shape), np.ones((shape[0], shape[1] // 2 + 1))
    padded[:ny, :nx] = 1.0
    seconds = []
    for _ in range(REPEATS + 1):
        start = time.process_time()
        transform = fft.rfft2(padded, workers=1)
        transform *= spectrum
        fft.irfft2(transform, shape, overwrite_x=True, workers=1)
        seconds.append(time.process_time() - start)
    return float(np.median(seconds[1:]))


def with_work(result: Result) -> Result:
    """Return ``result`` with ``cost.work``: its CPU seconds in units of `fft_seconds`."""
    ny, nx = result.scaled.pressure.shape
    work = result.cost.cpu_seconds / fft_seconds(nx, ny)
    return replace(result, cost=replace(result.cost, work=work))
