"""Time, work in FFT units, memory, and how they grow with the grid."""

import json
import math
import statistics
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path

from tests.reference import DOMAIN, moes_contact

from benchmarks.measure import fft_unit
from benchmarks.table import Table
from tehl.api.problem import ContactProblem
from tehl.api.solvers import solve
from tehl.contact.options import Options

ROOT = Path(__file__).parents[1]
SIZES = (129, 257, 513, 1025)
REPEATS = {129: 15, 257: 9, 513: 7, 1025: 5}
MEMORY_SCRIPT = """
import json, sys
from pathlib import Path
from tehl.contact.options import Options
from tehl.api.solvers import solve
from tests.reference import DOMAIN, moes_contact

def peak():  # of this program alone: ru_maxrss would start at that of the parent
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return int(status.split("VmHWM:")[1].split()[0]) / 1024.0

solve(moes_contact(20, 10), Options(points=65, domain=DOMAIN))
before = peak()
solve(moes_contact(200, 10), Options(points=int(sys.argv[1]), domain=DOMAIN))
print(json.dumps([before, peak() - before]))
"""


def solve_and_unit(problem: ContactProblem, points: int) -> tuple[float, float, float]:
    """Return median CPU seconds of a whole solve, of the FFT unit, and of their ratio.

    Solves and units alternate, so that a busy machine slows both; compiling is not counted.
    """
    options = Options(points=points, domain=DOMAIN)
    solve(problem, options)
    pairs = []
    for _ in range(REPEATS[points]):
        start = time.process_time()
        solve(problem, options)
        pairs.append((time.process_time() - start, fft_unit(points)))
    spent, unit = (statistics.median(column) for column in zip(*pairs, strict=True))
    return spent, unit, statistics.median(mine / fft for mine, fft in pairs)


def memory(points: int) -> tuple[float, float] | tuple[None, None]:
    """Return MB after import and warm-up, and the peak of a solve above it, in a new process.

    Requires ``/proc``; None on other systems.
    """
    if not Path("/proc/self/status").exists():
        return None, None
    command = [sys.executable, "-c", MEMORY_SCRIPT, str(points)]
    run = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT)
    before, above = json.loads(run.stdout)
    return before, above


def table(*, quick: bool = False) -> Table:
    """Return solve time and memory at M = 200, L = 10 by grid, and at 513 for other loads."""
    made = Table(
        title="Speed: default accuracy, X in [-4.5, 1.5], Y in [-3, 3], L = 10, one thread",
        columns=("M", "points", "CPU s", "FFT ms", "work", "us/node", "MB above warm process"),
    )
    sizes = (129, 257) if quick else SIZES
    cases = [(200.0, n) for n in sizes] + ([] if quick else [(20.0, 513), (1000.0, 513)])
    seconds = {}
    for load, points in cases:
        spent, unit, work = solve_and_unit(moes_contact(load, 10.0), points)
        seconds[load, points] = spent
        above = memory(points)[1] if load == 200.0 else None
        made.rows.append((load, points, spent, 1e3 * unit, work, 1e6 * spent / points**2, above))
    exponents = [
        math.log(seconds[200.0, b] / seconds[200.0, a]) / math.log((b / a) ** 2)
        for a, b in pairwise(sizes)
    ]
    shown = ", ".join(f"{exponent:.2f}" for exponent in exponents)
    made.notes.append(f"exponent of CPU seconds against unknowns, grid to grid: {shown}")
    return made
