"""Each physics with each other on small grids: what converges, and what is refused and why.

``python -m benchmarks.pairs`` solves each pair on 65 x 65 and 129 x 129 nodes, and each physics
alone in all other ways: certified, in a study, on the page, with a report. It prints a line per
outcome, then the tables. ``--only heat spin`` leaves pairs without one of them out,
``--processes 2`` solves as many at a time, and ``--store FILE`` keeps the outcomes: the same
command then goes on where it was ended.
"""

import argparse
import json
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import suppress
from dataclasses import asdict, dataclass
from itertools import combinations, combinations_with_replacement
from pathlib import Path
from typing import Any

from benchmarks.table import Table
from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import ConvergenceError, Result, TransientResult
from tehl.api.solvers import certify, certify_transient, solve, solve_transient
from tehl.base.errors import InputError
from tehl.cli.text import as_text
from tehl.contact.options import Options
from tehl.estimate.settled import settled
from tehl.explore.jobs import Ask, Desk, Part
from tehl.explore.tasks import Transient
from tehl.report.page import report_text
from tehl.result.solution import Status
from tehl.solver.judging.certify import certifiable
from tehl.studies.file import study

Tables = dict[str, Any]

WAVE = {"type": "wave", "amplitude": "0.1 um", "wavelength": "120 um", "angle": "90 deg"}
FEATURES: dict[str, Tables] = {
    "heat": {"thermal": {}},
    "thinning": {"lubricant": {"shear": {"law": "eyring", "stress": "5 MPa"}}},
    "standing": {"surface_1": {"roughness": WAVE}},
    "moving": {"surface_2": {"roughness": WAVE}, "transient": {"duration": "3 ms"}},
    "starved": {"supply": {"layer": "0.4 um"}},
    "conserving": {"cavitation": {"model": "conserving"}},
    "asperities": {
        "asperities": {
            "model": "greenwood-tripp",
            "rms": "0.1 um",
            "summit_radius": "20 um",
            "summit_density": "2e10 1/m^2",
        }
    },
    "boundary": {"contact_film": {"thickness": "60 nm"}},
    "load": {"transient": {"duration": "3 ms", "load": [["0 ms", 1.0], ["3 ms", 1.2]]}},
    "across": {"contact": {"sliding_angle": "60 deg"}},
    "spin": {"contact": {"spin_1": 400.0}},
}
"""Tables of each physics, laid over `BASE`."""
BALL: Tables = {"radius": "20 mm", "load": "10 N"}
SHAPES: dict[str, Tables] = {
    "ellipse": {
        "radius_x": "20 mm", "radius_y": "40 mm", "entrainment_angle": "30 deg", "load": "10 N"
    },
    "line": {"type": "line", "radius": "20 mm", "hertz_pressure": "0.3 GPa"},
    "roller": {
        "type": "roller", "radius": "20 mm", "length": "1 mm", "hertz_pressure": "0.3 GPa",
        "profile": {"shape": "logarithmic"},
    },
}  # fmt: skip
"""Table ``contact`` of other shapes than that of a ball on a disc."""
NAMES = (*FEATURES, *SHAPES)
"""All that is paired."""
BASE: Tables = {
    "contact": {"entrainment_speed": "0.4 m/s", "slide_roll_ratio": 0.3},
    "surface_1": {"material": "steel"},
    "surface_2": {"material": "steel"},
    "lubricant": {
        "viscosity": {"law": "roelands", "eta_0": "0.04 Pa s", "alpha": "22 1/GPa",
                      "gamma": "0.04 1/K"},
        "density": {"law": "dowson-higginson", "rho_0": "890 kg/m^3"},
        "conductivity": "0.14 W/(m K)",
        "heat_capacity": "2000 J/(kg K)",
    },
}  # fmt: skip


def contact(*features: str) -> ContactProblem:
    """Return a ball on a disc, or a named shape, with some of `FEATURES`."""
    return case_from_tables(tables_of(*features))[0]


def tables_of(*features: str) -> Tables:
    """Return the tables of a ball on a disc, or of a named shape, with some of `FEATURES`."""
    tables = BASE
    for name in features:
        tables = _laid_over(tables, FEATURES.get(name, {}))
    shape = next((SHAPES[name] for name in features if name in SHAPES), BALL)
    return _laid_over(tables, {"contact": shape})


def _laid_over(below: Tables, above: Tables) -> Tables:
    both = dict(below)
    for key, value in above.items():
        old = below.get(key)
        nested = isinstance(old, dict) and isinstance(value, dict)
        both[key] = _laid_over(old, value) if nested else value
    return both


class Quiet:
    """A connection of the page that listens to nothing."""

    def send(self, message: object) -> None:
        """Drop a message."""

    def poll(self) -> bool:
        """Say that nothing has come."""
        return False


def _solved(features: tuple[str, ...], options: Options) -> str | None:
    """Solve, and write the text that the command prints."""
    found = _result(features, options)
    as_text(found)
    return _fault(found.status)


def _reported(features: tuple[str, ...], options: Options) -> str | None:
    """Solve, and write the report with its pictures, which take longer than most solves."""
    found = _result(features, options)
    report_text(found, dpi=30)
    return _fault(found.status)


def _result(features: tuple[str, ...], options: Options) -> Result | TransientResult:
    problem = contact(*features)
    return (solve if problem.transient is None else solve_transient)(problem, options)


def _certified(features: tuple[str, ...], options: Options) -> str | None:
    problem = contact(*features)
    work = certify if problem.transient is None else certify_transient
    return _fault(work(problem, certifiable(settled(problem, options))).status)


def _studied(features: tuple[str, ...], options: Options) -> str | None:
    (row,) = study(
        contact(*features), {"contact.entrainment_speed": ["0.38 m/s"]}, options
    ).itertuples()
    return None if row.status == "converged" else row.message


def _on_the_page(features: tuple[str, ...], options: Options) -> str | None:
    """Solve as the page does: the film at time zero, and the movie of a transient run."""
    tables, desk = tables_of(*features) | {"numerics": {"points": options.points}}, Desk(Quiet())
    ends = [one.shown.outcome for one in desk.solve(Ask(tables=tables)) if is_last(one)]
    words = [end.words for end in ends if not end.converged]
    if "transient" in tables:
        words += [one.words for one in Transient(tables)(desk) if one.words != "converged"]
    return next(iter(words), None)


def is_last(message: object) -> bool:
    """Whether a message of the page is the result on the grid of the case."""
    return isinstance(message, Part) and message.final


def _fault(status: Status) -> str | None:
    return None if status.converged else status.message


WAYS: dict[str, Callable[[tuple[str, ...], Options], str | None]] = {
    "solve": _solved,
    "report": _reported,
    "certify": _certified,
    "study": _studied,
    "page": _on_the_page,
}
"""Ways to a result; each returns a sentence if it did not converge."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Task:
    """A pair of physics, or one alone, solved in one of the `WAYS`."""

    features: tuple[str, ...]
    points: int
    way: str = "solve"


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """How a task ended, in words, and its CPU time [s]."""

    task: Task
    words: str
    seconds: float

    def line(self) -> str:
        """Return the outcome as a line of text."""
        task = self.task
        who = " + ".join(dict.fromkeys(task.features))
        return f"{who:24s} {task.way:8s} {task.points:4d} {self.seconds:7.2f} s  {self.words}"


def outcome(features: tuple[str, ...], points: int, way: str = "solve") -> str:
    """Solve a contact with some features; return "works", or why not in words.

    Parameters
    ----------
    features : tuple of str
        Of `NAMES`.
    points : int
        Nodes per direction.
    way : str
        Of `WAYS`.
    """
    try:
        message = WAYS[way](features, Options(points=points))
    except InputError as error:
        return f"refused: {error}"
    except ConvergenceError as error:
        message = str(error)
    return f"fails: {message}" if message else "works"


def measured(task: Task) -> Outcome:
    """Return how a task ends."""
    started = time.process_time()
    words = outcome(task.features, task.points, task.way)
    return Outcome(task=task, words=words, seconds=time.process_time() - started)


def tasks(points: int, only: tuple[str, ...] = ()) -> list[Task]:
    """Return the tasks of a table: pairs of different shapes are none.

    Parameters
    ----------
    points : int
        Nodes per direction.
    only : tuple of str
        Of `NAMES`: pairs with one of them; all if empty.
    """
    pairs = combinations_with_replacement(NAMES, 2)
    apart = set(combinations(SHAPES, 2))
    found = [Task(features=pair, points=points) for pair in pairs if pair not in apart]
    ways = (way for way in WAYS if way != "solve")
    found += [Task(features=(name,), points=points, way=way) for way in ways for name in NAMES]
    return [task for task in found if not only or set(only) & set(task.features)]


def outcomes(asked: list[Task], processes: int) -> Iterator[Outcome]:
    """Yield how tasks end, as they do."""
    if processes == 1:
        yield from map(measured, asked)
        return
    with ProcessPoolExecutor(processes) as pool:
        for one in as_completed([pool.submit(measured, task) for task in asked]):
            yield one.result()


def table(found: list[Outcome], points: int) -> Table:
    """Return a row for each physics, a column for each one and for each further way."""
    words = {
        (frozenset(one.task.features), one.task.way): one.words
        for one in found
        if one.task.points == points
    }
    ways = [way for way in WAYS if way != "solve"]
    rows = {
        name: [words.get((frozenset((name, other)), "solve"), "-") for other in NAMES]
        + [words.get((frozenset((name,)), way), "-") for way in ways]
        for name in NAMES
    }
    notes = sorted(set(words.values()) - {"works"})
    return Table(
        title=f"Physics that work together, {points} x {points} nodes",
        columns=("physics", *NAMES, *ways),
        rows=[
            (name, *(notes.index(text) + 1 if text in notes else text for text in row))
            for name, row in rows.items()
        ],
        notes=[f"{number}: {note}" for number, note in enumerate(notes, start=1)],
    )


def stored(file: Path) -> list[Outcome]:
    """Return the outcomes that a file has, but for lines that were cut."""
    found = []
    for line in file.read_text(encoding="utf-8").splitlines() if file.exists() else ():
        with suppress(json.JSONDecodeError):
            row = json.loads(line)
            row["task"]["features"] = tuple(row["task"]["features"])
            found.append(Outcome(**row | {"task": Task(**row["task"])}))
    return found


def main() -> None:
    """Solve what is asked for, and print each outcome, then the tables."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.pairs", description=__doc__)
    parser.add_argument("--points", type=int, nargs="+", default=[65, 129], help="nodes")
    parser.add_argument("--only", nargs="+", default=(), choices=NAMES, metavar="NAME")
    parser.add_argument("--processes", type=int, default=1, help="that solve at a time")
    parser.add_argument("--store", type=Path, help="file that keeps the outcomes")
    given = parser.parse_args()
    asked = [task for points in given.points for task in tasks(points, tuple(given.only))]
    found = [one for one in (stored(given.store) if given.store else ()) if one.task in asked]
    done = {one.task for one in found}
    for one in outcomes([task for task in asked if task not in done], given.processes):
        found.append(one)
        sys.stdout.write(one.line() + "\n")
        sys.stdout.flush()
        if given.store:
            with given.store.open("a", encoding="utf-8") as file:
                file.write(json.dumps(asdict(one)) + "\n")
    for points in given.points:
        sys.stdout.write(table(found, points).text() + "\n")


if __name__ == "__main__":
    main()
