"""Speed of this machine: the CPU time of a piece of work over that on a reference machine."""

import time
from functools import cache

import numpy as np

FIELD, TRANSFORMS = (41, 161), 8
"""Shape of the field that is transformed, as deflections are, and how often."""
COARSE_FIELD, OPERATIONS = (21, 41), 20
"""Shape of that of a coarse grid, and operations on it beside each transform."""
TRIALS, REFERENCE_TIME = 5, 0.9e-3
"""Pieces of work, of which the median counts: cores share their units with other programs. And the
CPU time of one on the machine on which the constants of `tehl.estimate.cpu_time` were measured, an
AMD EPYC with AVX-512 without other programs [s]."""


@cache
def machine_factor() -> float:
    """Return the CPU time of this machine over that of the reference [-], measured once."""
    work = _Work()
    work.seconds()  # the first transform takes longer
    return float(np.median([work.seconds() for _ in range(TRIALS)])) / REFERENCE_TIME


class _Work:
    """Transforms and short operations, of which solves of small grids consist."""

    def __init__(self) -> None:
        self.field = np.ones(FIELD)
        self.transform = np.empty(FIELD, complex)
        self.convolved = np.empty((FIELD[0], 2 * (FIELD[1] - 1)))
        self.small = np.ones(COARSE_FIELD)

    def seconds(self) -> float:
        """Return the CPU time of one piece of work [s]."""
        started, period = time.process_time(), 2 * (FIELD[1] - 1)
        for _ in range(TRANSFORMS):
            np.fft.rfft(self.field, period, out=self.transform)
            np.fft.irfft(self.transform, period, out=self.convolved)
            for _ in range(OPERATIONS):
                np.add(self.small, self.small, out=self.small)
                np.multiply(self.small, 0.5, out=self.small)
        return time.process_time() - started
