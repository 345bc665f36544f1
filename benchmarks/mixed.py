"""Cost of asperities finer than the grid, over that of the smooth contact.

CPU time of whole solves in pairs, smooth and mixed one after the other, and the median of their
ratios: a shared machine slows both alike.
"""

import statistics
import time
from itertools import product

from tests.reference import moes_contact, touching_contact

from benchmarks.measure import attempt
from benchmarks.table import Table
from tehl.api.problem import ContactProblem
from tehl.contact.options import Options

CONTACTS = ((20, 10), (75, 11), (100, 8), (200, 8))
"""Moes numbers M and L."""
RATIOS = (0.05, 0.2, 0.8, 3.0)
"""Smooth film by formula over sigma: lambda."""
PAIRS = 10


def seconds(problem: ContactProblem, options: Options) -> float:
    """Return the CPU time of a solve."""
    start = time.process_time()
    attempt(problem, options)
    return time.process_time() - start


def table(points: int, *, quick: bool = False) -> Table:
    """Return a row for each contact, and one of the medians."""
    options, pairs = Options(points=points), 1 if quick else PAIRS
    made = Table(
        title=f"Asperities finer than the grid: cost over that of the smooth contact, {points} x "
        f"{points} nodes, median of {pairs} pairs",
        columns=("M", "L", "lambda", "share", "status", "cycles", "smooth ms", "ratio"),
    )
    costs, contacts = [], list(product(CONTACTS, RATIOS))
    for (load, speed), ratio in contacts[1:2] if quick else contacts:
        smooth, mixed = moes_contact(load, speed), touching_contact(load, speed, ratio)
        attempt(smooth, options)  # compiles
        found = attempt(mixed, options)
        times = [(seconds(smooth, options), seconds(mixed, options)) for _ in range(pairs)]
        costs.append(statistics.median(both / alone for alone, both in times))
        shared = found.load_sharing
        made.rows.append(
            (load, speed, ratio, shared.share if shared else 0.0,
             found.status.cause or found.status.kind, found.history[-1].cycle,
             1e3 * statistics.median(alone for alone, _ in times), costs[-1])
        )  # fmt: skip
    made.rows.append(("median", "", "", "", "", "", "", statistics.median(costs)))
    return made
