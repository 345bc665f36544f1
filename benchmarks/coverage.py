"""Random contacts from the defaults: which reach their error, if bars hold and hints work.

``python -m benchmarks.coverage --contacts 1000 --seed 1`` prints which contacts of each class
converge to it, with the causes of the others, and how the times compare with those of
``tehl explain``. ``--judge`` solves each that converges again on a grid four times
as fine, twice if that takes more than 1025 nodes or 513 of a heated one, and prints how the
differences compare with the error bars. ``--follow`` solves each that fails again with the
settings of its hint. ``--minutes`` bounds the time.
"""

import argparse
import json
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measure import attempt
from benchmarks.random_contacts import contact
from benchmarks.table import Cell, Table
from tehl.api.problem import case_from_tables
from tehl.api.results import Result
from tehl.base.errors import InputError
from tehl.contact.options import Options
from tehl.estimate.cpu_time import expected_seconds
from tehl.estimate.scaling import ScaledProblem, groups
from tehl.io.case import changed
from tehl.post.following import Following
from tehl.result.registry import named

CLASSES = ("isothermal", "thinning", "heated", "rough")
RANGES = (("M < 7", 0.0, 7.0), ("M 7-500", 7.0, 500.0), ("M > 500", 500.0, np.inf))
NAMES = (
    *("film_central", "film_minimum", "pressure_max", "traction_mid_film", "film_rise_max"),
    *("heat_shear", "heat_surface_2", "ripple_film", "ripple_pressure"),
)
FINEST, FINEST_HEATED, AFFORDABLE = 1025, 513, 2049
"""Most nodes of a judge that is four times as fine, and of any judge."""
FACTOR = 2.0
"""Factor within which the times of nine of ten contacts should be."""


def values(result: Result) -> dict[str, float]:
    """Return the values of a result that have error bars."""
    numbers = Following(result).numbers
    found = {name: numbers.get(named(name).path) for name in NAMES}
    return {name: value for name, value in found.items() if value is not None}


def bars(result: Result) -> dict[str, float]:
    """Return the relative error bars of a result."""
    errors = result.errors
    if errors is None:
        return {}
    found = {name: errors.of(name) for name in NAMES}
    if not errors.spike_resolved:  # stated instead of a bar
        del found["pressure_max"]
    return {name: bar for name, bar in found.items() if bar is not None}


def row(task: tuple[int, int, float, bool, bool]) -> dict[str, Any]:
    """Solve contact ``number`` of a seed with a limit of time [s]; judge or follow on request."""
    seed, number, limit, judge, follow = task
    problem, kind = contact(seed, number)
    found: dict[str, Any] = {"number": number, "class": kind, "M": groups(problem).M}
    began, options = time.process_time(), Options(max_time=limit)
    try:
        result = attempt(problem, options)
    except InputError as error:
        return found | {"cause": "input", "message": str(error), "seconds": 0.0}
    status = result.status
    found |= {
        "cause": status.cause,
        "message": status.message,
        "hint": status.hint and str(status.hint),
        "nodes": result.scaled.x.size,
        "seconds": time.process_time() - began,
        "bars": bars(result),
    }
    if status.converged:
        expected = expected_seconds(ScaledProblem.of(problem), options)
        found["time"] = result.cost.cpu_seconds / expected
    if judge and status.converged:
        found["off"] = _off(result, result.scaled.x.size, heated=kind == "heated")
    if follow and not status.converged:
        found["followed"] = _followed(result)
    return found


def _followed(result: Result) -> str:
    """Return how a contact ends with the settings of its hint, or that the hint has none."""
    settings = result.status.hint.settings if result.status.hint else {}
    if not settings:
        return "no setting"
    tables = result.problem.model_dump(exclude_none=True)
    tables["numerics"] = result.options.model_dump(exclude_defaults=True)
    for path, value in settings.items():
        tables = changed(tables, path, value)
    try:
        status = attempt(*case_from_tables(tables)).status
    except InputError as error:
        return f"input: {error}"
    return status.cause or status.kind


def _off(result: Result, nodes: int, *, heated: bool) -> dict[str, float]:
    """Return the differences to a finer grid over the error bars; none if that did not converge."""
    finer = 4 * (nodes - 1) + 1
    if finer > (FINEST_HEATED if heated else FINEST):
        finer = 2 * (nodes - 1) + 1
    if finer > AFFORDABLE:
        return {}
    try:
        combined = result.errors is not None and result.errors.extrapolated
        # of second order, which stated nodes have, it would err by more than what it judges
        judge = attempt(result.problem, Options(points=finer, extrapolate=combined, wedge_order=3))
    except InputError:
        return {}
    here, there, known = values(result), values(judge), bars(result)
    return {
        name: abs(here[name] - there[name]) / (bar * abs(here[name]))
        for name, bar in known.items()
        if name in there and judge.status.converged
    }


def robustness(rows: list[dict[str, Any]]) -> Table:
    """Return how many contacts of each class reached the error."""
    made = Table(
        title=f"Contacts that reach the default error ({len(rows)} random contacts)",
        columns=("class", *(name for name, _, _ in RANGES), "CPU s, median", "largest"),
    )
    for kind in CLASSES:
        cells: list[Cell] = [kind]
        every = [one for one in rows if one["class"] == kind]
        for _, low, high in RANGES:
            within = [one for one in every if low <= one["M"] < high]
            good = sum(one["cause"] is None for one in within)
            cells.append(f"{good} of {len(within)}")
        seconds = [one["seconds"] for one in every] or [0.0]
        made.rows.append((*cells, float(np.median(seconds)), max(seconds)))
    counts = Counter(one["cause"] or "converged" for one in rows)
    made.notes.append(", ".join(f"{count} {name}" for name, count in counts.most_common()))
    return made


def times(rows: list[dict[str, Any]]) -> Table:
    """Return how the CPU times of the contacts that converge compare with those expected."""
    made = Table(
        title=f"CPU times over those that tehl explain expects (within a factor of {FACTOR:g})",
        columns=("class", "contacts", "within, %", "median", "10 %", "90 %"),
    )
    for kind in ("all", *CLASSES):
        ratios = np.array(
            [one["time"] for one in rows if "time" in one and kind in ("all", one["class"])]
        )
        if ratios.size:
            within = 100.0 * float((np.abs(np.log(ratios)) <= np.log(FACTOR)).mean())
            quantiles = map(float, np.quantile(ratios, (0.5, 0.1, 0.9)))
            made.rows.append((kind, ratios.size, within, *quantiles))
    return made


def coverage(rows: list[dict[str, Any]]) -> Table:
    """Return how the differences to finer grids compare with the error bars."""
    made = Table(
        title="Differences to finer grids over the error bars",
        columns=("value", "judged", "in 1 bar, %", "in 2 bars, %", "median", "largest"),
    )
    for name in NAMES:
        off = np.array([one["off"][name] for one in rows if name in one.get("off", {})])
        if off.size:
            parts = (100.0 * float((off <= limit).mean()) for limit in (1.0, 2.0))
            made.rows.append((name, off.size, *parts, float(np.median(off)), float(off.max())))
    return made


def hints(rows: list[dict[str, Any]]) -> Table:
    """Return the hints that were followed, by cause, and the contacts where they failed."""
    followed = [one for one in rows if "followed" in one]
    worked = sum(one["followed"] == "converged" for one in followed)
    made = Table(
        title=f"Hints that worked when followed: {worked} of {len(followed)}",
        columns=("cause", "followed", "worked"),
    )
    for cause, count in Counter(one["cause"] for one in followed).most_common():
        ends = [one["followed"] for one in followed if one["cause"] == cause]
        made.rows.append((cause, count, ends.count("converged")))
    made.notes.extend(
        f"contact {one['number']}: {one['cause']}, then {one['followed']}; {one['hint']}"
        for one in followed
        if one["followed"] != "converged"
    )
    return made


def main() -> None:
    """Solve the contacts, and print the tables."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.coverage", description=__doc__)
    parser.add_argument("--contacts", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--judge", action="store_true", help="judge the error bars")
    parser.add_argument("--follow", action="store_true", help="follow the hints of failed contacts")
    parser.add_argument("--minutes", type=float, default=60.0, help="no contact begins later")
    parser.add_argument("--limit", type=float, default=60.0, help="numerics.max_time [s]")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--json", type=Path, help="also write a line for each contact")
    given = parser.parse_args()
    settings = (given.limit, given.judge, given.follow)
    tasks = ((given.seed, number, *settings) for number in range(given.contacts))
    rows, end = [], time.monotonic() + 60.0 * given.minutes
    with ProcessPoolExecutor(given.jobs) as pool:
        while time.monotonic() < end and (some := list(islice(tasks, given.jobs))):
            rows += pool.map(row, some)
            if given.json:
                given.json.write_text("".join(json.dumps(one) + "\n" for one in rows))
    tables = [robustness(rows), times(rows)]
    tables += [coverage(rows)] if given.judge else []
    tables += [hints(rows)] if given.follow else []
    sys.stdout.write("\n".join(table.text() for table in tables))


if __name__ == "__main__":
    main()
