"""Which contacts converge from a cold start, and whether the stated error bars hold.

A result is *wrong* if its status is converged and its film differs from that of the twice finer
grid by more than its own error bar (discretisation and iteration).
"""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tests.reference import moes_contact

from benchmarks.table import Cell, Table
from tehl.options import Options
from tehl.problem import ContactProblem
from tehl.result import ConvergenceError, Result
from tehl.solver import solve

LOADS = (5, 10, 20, 50, 100, 200, 500, 1000, 2000)
SPEEDS = (1, 2, 5, 10, 15, 20)
ELLIPSE_LOADS = (100, 500)
RADIUS_RATIOS = (0.5, 1.0, 2.0, 5.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """One contact on a grid and on the twice finer one."""

    load: float
    speed: float
    ratio: float
    result: Result
    finer: Result

    def excess(self, name: str) -> float:
        """Return the difference to the finer film over the stated error bars; above 1 is wrong."""
        values = [getattr(run.film_scaled, name) for run in (self.result, self.finer)]
        if self.result.errors is None:
            return float("nan")
        bar = getattr(self.result.errors, f"discretisation_{name}")
        bar += getattr(self.result.errors, f"iteration_{name}")
        return abs(values[1] - values[0]) / (bar * abs(values[0]))

    @property
    def judged(self) -> bool:
        """Whether both runs converged, so that the bar can be checked."""
        return self.result.status.converged and self.finer.status.converged

    @property
    def wrong(self) -> bool:
        """Whether a converged film lies outside its error bar."""
        return self.judged and not (self.excess("central") <= 1 and self.excess("minimum") <= 1)

    def row(self) -> tuple[Cell, ...]:
        """Return the cells of the table."""
        result, errors = self.result, self.result.errors
        film = result.film_scaled
        checks = (self.excess("central"), self.excess("minimum")) if self.judged else (None, None)
        return (
            self.load,
            self.speed,
            self.ratio,
            result.status.cause or result.status.kind,
            f"{film.central:.5f}",
            f"{film.minimum:.5f}",
            100 * errors.discretisation_central if errors else None,
            100 * errors.discretisation_minimum if errors else None,
            *checks,
            len([r for r in result.history if r.points[0] == result.scaled.x.size]),
            result.history[-1].smoother if result.history else None,
            result.cost.cpu_seconds,
            self.finer.status.cause or self.finer.status.kind,
            "WRONG" if self.wrong else "",
        )


COLUMNS = (
    "M", "L", "ry/rx", "status", "H_central", "H_min", "bar_c %", "bar_m %", "off_c/bar",
    "off_m/bar", "cycles", "smoother", "CPU s", "twice finer", "",
)  # fmt: skip


def attempt(problem: ContactProblem, options: Options) -> Result:
    """Return the result, also of a run that did not converge."""
    try:
        return solve(problem, options)
    except ConvergenceError as error:
        return error.result


def contacts(*, quick: bool) -> Iterator[tuple[float, float, float]]:
    """Yield M, L and radius_y / radius_x of the sweep."""
    loads, speeds = ((5, 100, 1000), (2, 10)) if quick else (LOADS, SPEEDS)
    for load in loads:
        for speed in speeds:
            yield load, speed, 1.0
    for load in ELLIPSE_LOADS:
        for ratio in (0.5, 2.0) if quick else RADIUS_RATIOS:
            yield load, 10, ratio


def outcomes(cases: Iterable[tuple[float, float, float]], points: int) -> Iterator[Outcome]:
    """Solve each contact on ``points`` and on twice as many intervals, both with the defaults."""
    for load, speed, ratio in cases:
        problem = moes_contact(load, speed, radius_ratio=ratio)
        runs = [attempt(problem, Options(points=n)) for n in (points, 2 * points - 1)]
        yield Outcome(load=load, speed=speed, ratio=ratio, result=runs[0], finer=runs[1])


def table(points: int, *, quick: bool = False) -> Table:
    """Return the sweep on ``points`` x ``points`` nodes."""
    made = Table(title=f"Robustness, {points} x {points} nodes, defaults, cold", columns=COLUMNS)
    found = list(outcomes(contacts(quick=quick), points))
    made.rows.extend(outcome.row() for outcome in found)
    counts = Counter(o.result.status.cause or o.result.status.kind for o in found)
    made.notes.append("status: " + ", ".join(f"{n} {name}" for name, n in counts.most_common()))
    wrong = [o for o in found if o.wrong]
    judged = sum(o.judged for o in found)
    made.notes.append(f"wrong: {len(wrong)} of {judged} that converged on both grids")
    return made
