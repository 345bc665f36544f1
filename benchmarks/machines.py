"""Contacts as machines have them: which reach the default error, at what cost, and if bars hold.

``python -m benchmarks.machines --contacts 300 --seed 1`` draws raceways of ball bearings, crowned
gear teeth and cams, traction drives and test rigs, some heated, with asperities or short of oil,
and solves each from the defaults within ``--limit`` seconds, in a warm process. ``--judge N``
solves N of those that converge again on a grid twice as fine, and a domain twice as large, and
compares with their bars.
``--any`` draws contacts of any direction and shape instead, and asks for an error of 2 %; a
transient run has to end. ``--tables`` draws point contacts with all tables of a case at once.
``--rollers`` draws rollers of bearings, gears and cams, and asks for the error of their default.
``--points N`` solves on a grid of N x N nodes instead of to an error.
"""

import argparse
import json
import math
import resource
import sys
import time
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import any_contacts, rollers
from benchmarks.coverage import bars, values
from benchmarks.measure import attempt
from benchmarks.table import Cell, Table
from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import ConvergenceError, Result
from tehl.api.solvers import solve_transient
from tehl.base.errors import InputError
from tehl.base.units import percentage
from tehl.contact.options import USUAL_ERROR, Domain, Options
from tehl.estimate.cpu_time import expected_seconds
from tehl.estimate.film_formulas import inlet_stress
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.settled import ROLLER_ERROR
from tehl.report.plausibility import UNPHYSICAL_STRESS

BALLS = ((8, 22), (15, 35), (20, 47), (30, 62), (50, 90), (40, 90), (60, 130), (100, 215))
"""Bore and outside diameter of deep groove bearings [mm]: a ball has about 0.3 of the difference,
and runs on the mean of both."""
OILS = ((10, 2.6), (32, 5.4), (68, 8.7), (150, 14.7), (320, 24.0), (460, 30.0))
"""Kinematic viscosities at 40 and 100 degC of ISO grades [mm^2/s]."""
KINDS = {
    "inner ring": 0.35,
    "outer ring": 0.2,
    "gear tooth": 0.12,
    "cam": 0.08,
    "traction drive": 0.1,
    "test rig": 0.15,
}
"""Kinds of contacts, and how often they are drawn."""
FEATURES = {"thermal": 0.4, "asperities": 0.3, "supply": 0.15}
"""Tables of a case, and how often they are drawn."""
RANGES = {
    "gear tooth": ((3, 40), (60, 600), (0.6, 1.8), (0.3, 20), (0.01, 0.9), (0.1, 0.6)),
    "cam": ((4, 40), (100, 800), (0.3, 1.2), (0.2, 8), (0.2, 1.9), (0.05, 0.4)),
    "traction drive": ((15, 60), (15, 200), (0.8, 3.0), (2, 40), (1e-3, 0.1), (0.02, 0.1)),
    "test rig": ((5, 13), (5, 13), (0.3, 1.2), (0.005, 5), (1e-3, 1.9), (0.005, 0.05)),
}
"""Radii along and across [mm], Hertz pressure [GPa], speed [m/s], sliding, roughness Ra [um]."""
LARGEST_JUDGE, LARGEST_LINE = 1025, 8193
"""Most nodes along one direction of a grid that judges, and of one of a line contact."""
ANY_ERROR = 0.02
"""Error asked for with ``--any``."""


def contact(seed: int, number: int) -> tuple[str, set[str], ContactProblem]:
    """Return kind, features and contact number ``number`` of a seed."""
    random = np.random.default_rng([seed, number])

    def between(low: float, high: float) -> float:
        return math.exp(random.uniform(math.log(low), math.log(high)))

    kind = str(random.choice(list(KINDS), p=list(KINDS.values())))
    surfaces: list[dict[str, Any]] = [{"material": "steel"}, {"material": "steel"}]
    if kind.endswith("ring"):
        bore, outside = BALLS[random.integers(len(BALLS))]
        ball, pitch = 3e-4 * (outside - bore), 5e-4 * (bore + outside)
        inner = kind.startswith("inner")
        surfaces[0] |= {"radius": ball / 2}
        surfaces[1] |= {
            "radius_x": (pitch - ball) / 2 if inner else -(pitch + ball) / 2,
            "radius_y": -ball * random.uniform(0.515, 0.535),
        }
        # n d_m from 10^4 to 6 10^5 mm/min; both rings entrain with a quarter of the shaft
        speed = between(1e4, 6e5) * 1e-3 / 60 * math.pi / 2 * (1 - (ball / pitch) ** 2)
        pressure, slip, finish = between(0.7, 2.6), between(1e-3, 0.1), (0.01, 0.06)
        stated = {}
    else:
        along, across, pressures, speeds, sliding, finish = RANGES[kind]
        radius = between(*along)
        wide = radius if kind == "test rig" else between(*across)
        stated = {"radius_x": 1e-3 * radius, "radius_y": 1e-3 * wide}
        pressure, speed, slip = between(*pressures), between(*speeds), between(*sliding)
    for one in surfaces:
        one["ra_roughness"] = 1e-6 * between(*finish)
    nu_40, nu_100 = OILS[random.integers(len(OILS))]
    case: dict[str, Any] = {
        "title": f"{kind} {number} of seed {seed}",
        "contact": stated
        | {
            "hertz_pressure": 1e9 * pressure,
            "entrainment_speed": speed,
            "slide_roll_ratio": slip,
        },
        "surface_1": surfaces[0],
        "surface_2": surfaces[1],
        "lubricant": {
            "viscosity": {
                "law": "walther",
                "nu_40": 1e-6 * nu_40,
                "nu_100": 1e-6 * nu_100,
                "alpha": 1e-9 * random.uniform(14, 24),
            },
            "density": {"law": "dowson-higginson", "rho_0": 880.0, "beta": 6.5e-4},
            "temperature": 273.15 + random.uniform(30, 110),
            "conductivity": 0.14,
            "heat_capacity": 2000.0,
            "shear": {"law": "eyring", "stress": 1e6 * between(2, 12)},
        },
    }
    case["lubricant"]["density"]["reference_temperature"] = 288.15
    features = {name for name, part in FEATURES.items() if random.random() < part}
    tables = {
        "thermal": {},
        "asperities": {
            "model": "greenwood-tripp",
            "summit_radius": 1e-6 * between(5, 50),
            "summit_density": between(2e9, 3e10),
        },
        "supply": {"ratio": random.uniform(0.2, 0.95)},
    }
    case |= {name: tables[name] for name in features}
    return kind, features, case_from_tables(case)[0]


def row(
    drawn: tuple[str, set[str], ContactProblem], number: int, options: Options, *, judge: bool
) -> dict[str, Any]:
    """Return how a contact ended, what it took, and how far it is from a finer grid."""
    kind, features, problem = drawn
    scaled, started = ScaledProblem.of(problem), time.process_time()
    groups = scaled.groups
    found: dict[str, Any] = {
        "number": number,
        "kind": kind,
        "features": sorted(features) or ["plain"],
        "M": groups.M,
        "L": groups.L,
        "ellipticity": groups.ellipticity,
        "stress": inlet_stress(scaled),
    }
    try:
        if problem.transient is not None:
            return found | _in_time(problem, options)
        result = attempt(problem, options)
    except InputError as error:
        return found | {"cause": "input", "message": str(error), "seconds": 0.0}
    status, errors = result.status, result.errors
    found |= {
        "cause": None if status.converged else status.cause or status.kind,
        "message": status.message,
        "hint": status.hint and str(status.hint),
        "seconds": time.process_time() - started,
        "points": result.scaled.x.size,
        "error": None if errors is None else max(errors.central, errors.minimum),
        "forecast": expected_seconds(ScaledProblem.of(problem), options),
        "peak_gb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6,
    }
    if judge and status.converged:
        found["off"] = _off(result)
    return found


def _in_time(problem: ContactProblem, options: Options) -> dict[str, Any]:
    """Return how a transient run ended, and what it took."""
    started = time.process_time()
    try:
        run = solve_transient(problem, options)
    except ConvergenceError as error:
        status = error.result.status
    else:
        status = run.status
    return {
        "cause": None if status.converged else status.cause or status.kind,
        "message": status.message,
        "hint": status.hint and str(status.hint),
        "seconds": time.process_time() - started,
    }


def _off(result: Result) -> dict[str, float]:
    """Return the differences to finer grids and larger domains over the bars, the largest each."""
    off: dict[str, float] = {}
    lines, sides = result.scaled.y.size, result.problem.shape.sides
    for wider in (1, 2):
        finer = 2 * wider * (result.scaled.x.size - 1) + 1
        if finer > (LARGEST_LINE if lines == 1 else LARGEST_JUDGE):
            continue
        x, y = (
            (wider * float(axis[0]), wider * float(axis[-1]))
            for axis in (result.scaled.x, result.scaled.y)
        )
        points: int | tuple[int, int] = finer
        if result.problem.contact.has_lines:
            points, y = (finer, max(2 * lines - 1, 1)), sides
        options = Options(points=points, extrapolate=True, domain=Domain(x=x, y=y))
        if result.problem.supply is None:
            options = options.model_copy(update={"edges": "far_field"})
        judge = attempt(result.problem, options)
        if not judge.status.converged:
            continue
        here, there = values(result), values(judge)
        for name, bar in bars(result).items():
            if name in there and bar:
                ratio = abs(here[name] - there[name]) / (bar * abs(here[name]))
                off[name] = max(off.get(name, 0.0), ratio)
    return off


def reached(rows: list[dict[str, Any]], error: float = USUAL_ERROR) -> Table:
    """Return how many contacts of each kind and with each feature reached an error.

    Parameters
    ----------
    rows : list of dict
        Of `row`.
    error : float
        That they were asked for [-].
    """
    made = Table(
        title=f"Contacts that reach {percentage(error)} ({len(rows)} random contacts)",
        columns=("contacts", "reached", "CPU s, median", "95 %", "largest", "forecast / actual"),
    )
    groups = {"all": rows}
    for one in rows:
        for name in (one["kind"], *one["features"]):
            groups.setdefault(name, []).append(one)
    for name, some in groups.items():
        good = [one for one in some if one["cause"] is None]
        seconds = np.array([one["seconds"] for one in good] or [math.nan])
        ratios = np.array([one["forecast"] / one["seconds"] for one in good if "forecast" in one])
        cells: list[Cell] = [name, f"{len(good)} of {len(some)}"]
        cells += [float(np.median(seconds)), float(np.quantile(seconds, 0.95))]
        made.rows.append(
            (*cells, float(seconds.max()), float(np.median(ratios)) if ratios.size else "")
        )
    peaks = [one["peak_gb"] for one in rows if "peak_gb" in one]
    made.notes.append(f"peak memory of the process {max(peaks, default=0.0):.2g} GB")
    failed = [one for one in rows if one["cause"] is not None]
    silent = sum(not one.get("hint") and one["cause"] != "input" for one in failed)
    strained = sum(one.get("stress", 0.0) > UNPHYSICAL_STRESS for one in failed)
    made.notes.append(
        f"{len(failed)} failed, {silent} of them without a hint, {strained} with oils that would "
        "carry more than their pressure, of which `tehl explain` warns"
    )
    made.notes.extend(map(_failure, failed))
    return made


def _failure(one: dict[str, Any]) -> str:
    """Return a line about a contact that failed."""
    best = "-" if one.get("error") is None else f"{one['error']:.2g}"
    return (
        f"contact {one['number']} ({one['kind']}, {', '.join(one['features'])}; "
        f"M = {one['M']:.0f}, L = {one['L']:.3g}, a_y/a_x = {one['ellipticity']:.3g}): "
        f"{one['cause']}, reached {best}; {one.get('hint')}"
    )


def judged(rows: list[dict[str, Any]]) -> Table:
    """Return how the differences to finer grids and larger domains compare with the bars."""
    made = Table(
        title="Differences to finer grids and larger domains over the error bars",
        columns=("value", "judged", "in 1 bar, %", "in 2 bars, %", "median", "largest"),
    )
    names = sorted({name for one in rows for name in one.get("off", {})})
    for name in names:
        off = np.array([one["off"][name] for one in rows if name in one.get("off", {})])
        parts = (100.0 * float((off <= bound).mean()) for bound in (1.0, 2.0))
        made.rows.append((name, off.size, *parts, float(np.median(off)), float(off.max())))
    return made


def warm(options: Options) -> None:
    """Solve a contact with each feature: the first one of a process loads what it needs."""
    for name in FEATURES:
        found = (contact(1, number) for number in count())
        attempt(next(one for _, features, one in found if features == {name}), options)


def main() -> None:
    """Solve the contacts, and print the tables."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.machines", description=__doc__)
    parser.add_argument("--contacts", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--limit", type=float, default=60.0, help="seconds of a contact")
    parser.add_argument("--judge", type=int, default=0, help="contacts to judge")
    parser.add_argument("--json", type=Path, help="file for the rows")
    parser.add_argument("--any", action="store_true", help="of any direction and shape")
    parser.add_argument("--tables", action="store_true", help="with all tables at once")
    parser.add_argument("--rollers", action="store_true", help="of finite length, with ends")
    parser.add_argument("--points", type=int, help="nodes along x and y")
    parser.add_argument("--first", type=int, default=0, help="number of the first contact")
    asked = parser.parse_args()
    draw, error = (any_contacts.contact, ANY_ERROR) if asked.any else (contact, None)
    if asked.tables:
        draw, error = partial(any_contacts.contact, tables_at_once=True), ANY_ERROR
    if asked.rollers:
        draw, error = rollers.contact, ROLLER_ERROR
    options = Options(error=error, max_time=asked.limit)
    if asked.points is not None:
        options = Options(points=asked.points, max_time=asked.limit)
    warm(options)
    rows = []
    for number in range(asked.first, asked.first + asked.contacts):
        judge = number - asked.first < asked.judge
        rows.append(row(draw(asked.seed, number), number, options, judge=judge))
        if asked.json is not None:
            asked.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")
    for table in (reached(rows, error or USUAL_ERROR), judged(rows)):
        if table.rows:
            sys.stdout.write(table.text() + "\n")


if __name__ == "__main__":
    main()
