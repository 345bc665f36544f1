"""Cost of asperities: a standing wave and a passing dent, in FFT units.

Amplitudes are in units of a^2/R, lengths in half-widths a; the unit of work is
`benchmarks.measure.fft_unit`.
"""

import statistics
import time
import tomllib
from collections.abc import Iterator

from tests.reference import DOMAIN

from benchmarks.measure import attempt, fft_unit
from benchmarks.rough import CONTACTS, wave
from benchmarks.table import Cell, Table
from tehl import solve_transient
from tehl.api.problem import case_from_tables
from tehl.api.results import TransientResult
from tehl.contact.options import Options
from tehl.io.templates import template_text

SHAPE = (0.03, 0.5, 45)
"""Amplitude, wavelength and angle of the standing wave."""
SLIDES = (0.0, 0.5)
STEPS = 400
"""Number of steps that the cost is stated for."""
REPEATS = 3


def standing_row(load: float, speed: float, points: int) -> tuple[Cell, ...]:
    """Solve the film of a standing wave and return its row."""
    problem = wave(load, speed, SHAPE).problem()
    options = Options(points=points, domain=DOMAIN)
    attempt(problem, options)  # compiles
    runs, seconds, work = [], [], []
    for _ in range(REPEATS):
        start = time.process_time()
        runs.append(attempt(problem, options))
        seconds.append(time.process_time() - start)
        work.append(seconds[-1] / fft_unit(points))
    last, status = runs[-1].history[-1], runs[-1].status
    return (load, speed, status.cause or status.kind, last.smoother, last.cycle,
            statistics.median(seconds), statistics.median(work))  # fmt: skip


def passing_row(slide: float, run: TransientResult, unit: float) -> tuple[Cell, ...]:
    """Return the row of a passing dent: the cost of its steps, without the steady start.

    Parameters
    ----------
    slide : float
        Slide to roll ratio [-].
    run : TransientResult
        The run.
    unit : float
        CPU seconds of an FFT on its grid.
    """
    cycles = run.history.cycles[1:]
    per_step = (run.cost.cpu_seconds - run.start.cost.cpu_seconds) / len(cycles)
    return (slide, run.status.cause or run.status.kind, len(cycles), float(cycles.mean()),
            int(cycles.max()), per_step / unit, STEPS * per_step,
            run.start.cost.cpu_seconds)  # fmt: skip


def dent(slide: float, points: int) -> TransientResult:
    """Solve the passing dent of the template."""
    given = tomllib.loads(template_text("passing-dent"))
    changed = {"contact": {"slide_roll_ratio": slide}, "numerics": {"points": points}}
    return solve_transient(
        *case_from_tables(given | {key: given[key] | new for key, new in changed.items()})
    )


def tables(points: int, *, quick: bool = False) -> Iterator[Table]:
    """Yield a table of standing waves and one of a passing dent."""
    amplitude, length, angle = SHAPE
    grid = f"{points} x {points} nodes, one thread"
    standing = Table(
        title=f"Asperities: a standing wave, {amplitude:g} a^2/R, {length:g} a, {angle} deg, "
        f"{grid}",
        columns=("M", "L", "status", "smoother", "cycles", "CPU s", "work"),
    )
    for load, speed in CONTACTS[:1] if quick else CONTACTS:
        standing.rows.append(standing_row(load, speed, points))
    yield standing
    passing = Table(
        title=f"Asperities: a passing dent, tehl new passing-dent, {grid}",
        columns=("SRR", "status", "steps", "cycles per step", "at most", "work per step",
                 f"CPU s of {STEPS} steps", "CPU s of the start"),
    )  # fmt: skip
    for slide in SLIDES[:1] if quick else SLIDES:
        passing.rows.append(passing_row(slide, dent(slide, points), fft_unit(points)))
    yield passing
