"""Speed of this machine: the CPU time of a piece of work over that on a reference machine."""

import time
from functools import cache

import numpy as np

REFERENCE_TIME = 0.9e-3
"""CPU time of a piece of work on the machine on which the constants of `tehl.estimate.cpu_time`
were measured, an AMD EPYC with AVX-512 without other programs [s]."""


@cache
def machine_factor() -> float:
    """Return the CPU time of this machine over that of the reference [-], measured once."""
    work = _Work()
    work.seconds()  # the first transform takes longer
    # the median, as cores share their units with other programs
    return float(np.median([work.seconds() for _ in range(5)])) / REFERENCE_TIME


class _Work:
    """Transforms and short operations, of which solves of small grids consist."""

    def __init__(self) -> None:
        self.field = np.ones((41, 161))  # of deflections
        self.transform = np.empty((41, 161), complex)
        self.convolved = np.empty((41, 320))
        self.small = np.ones((21, 41))  # of a coarse grid

    def seconds(self) -> float:
        """Return the CPU time of one piece of work [s]."""
        started = time.process_time()
        for _ in range(8):
            np.fft.rfft(self.field, 320, out=self.transform)
            np.fft.irfft(self.transform, 320, out=self.convolved)
            for _ in range(20):
                np.add(self.small, self.small, out=self.small)
                np.multiply(self.small, 0.5, out=self.small)
        return time.process_time() - started
