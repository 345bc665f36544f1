"""Measuring: CPU seconds of one thread, medians of repeats, the FFT unit of work."""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import statistics
import time
from collections.abc import Callable

import numpy as np
from scipy import fft

from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError, Result
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.estimate.nodes import finest_grid
from tehl.estimate.scaling import ScaledProblem
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.ladder import Strategy
from tehl.solver.cycle.relaxation import FAST, Relaxation

FFT_REPEATS = 20


def cpu_seconds(action: Callable[[], object], repeats: int) -> float:
    """Return the median CPU seconds of ``action`` after one call that is not counted."""
    action()
    times = []
    for _ in range(repeats):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return statistics.median(times)


def fft_unit(points: int) -> float:
    """Return the CPU seconds of one FFT deformation on ``points`` x ``points`` nodes.

    rfft2, multiply, irfft2 of the full domain zero-padded to 2N, float64, one worker; spectrum and
    padded array are ready; median of 20. The lesser of scipy, which allocates its results, and
    numpy, which writes into ready buffers: on large grids the page faults of fresh arrays cost as
    much as the transform.
    """
    nodes = 2 * (points - 1)
    padded = np.random.default_rng(0).random((nodes, nodes))
    spectrum = np.ones((nodes, nodes // 2 + 1))
    half, whole = np.empty(spectrum.shape, complex), np.empty_like(padded)

    def by_scipy() -> None:
        transform = fft.rfft2(padded, workers=1)
        transform *= spectrum
        fft.irfft2(transform, padded.shape, workers=1, overwrite_x=True)

    def by_numpy() -> None:
        np.fft.rfft(padded, axis=1, out=half)
        np.fft.fft(half, axis=0, out=half)
        np.multiply(half, spectrum, out=half)
        np.fft.ifft(half, axis=0, out=half)
        np.fft.irfft(half, nodes, axis=1, out=whole)

    ways = [by_scipy, by_numpy] if np.lib.NumpyVersion(np.__version__) >= "2.0.0" else [by_scipy]
    return min(cpu_seconds(way, FFT_REPEATS) for way in ways)


def attempt(problem: ContactProblem, options: Options) -> Result:
    """Return the result, also of a run that did not converge."""
    try:
        return solve(problem, options)
    except ConvergenceError as error:
        return error.result


def multigrid(
    problem: ContactProblem, options: Options, relaxation: Relaxation = FAST
) -> FilmSolver:
    """Return the hierarchy that `tehl.solve` would cycle on."""
    scaled = ScaledProblem.of(problem)
    grid = finest_grid(scaled, options)
    hierarchy = Hierarchy.on(grid, scaled, options, relaxation)
    return FilmSolver(hierarchy, Strategy(relaxation=relaxation))
