"""Stiffness and damping of circular films over M, L and frequency, as a table, and its error.

``python -m benchmarks.stiffness_table`` solves the contacts that ``film_stiffness.csv`` in
``src/tehl/estimate`` does not have yet, and appends them. With ``check`` it solves contacts between
them, and prints how far the interpolation of `tehl.film_stiffness` is from them.
"""

import csv
import sys
from itertools import product
from pathlib import Path

import numpy as np
from tests.reference import moes_contact

from benchmarks.table import Table
from tehl.api.problem import ContactProblem
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.estimate.scaling import scales
from tehl.estimate.stiffness import stiffness_by_table

TABLE = Path(__file__).parents[1] / "src" / "tehl" / "estimate" / "film_stiffness.csv"
COLUMNS = ("M", "L", "omega", "k", "c", "k_error", "c_error")
LOADS = tuple(float(f"{10.0 ** (1.0 + number / 4.0):.6g}") for number in range(8))
SPEEDS = (1.0, 1.6, 2.5, 4.0, 6.3, 10.0, 14.0, 20.0)
OMEGAS = tuple(np.geomspace(0.03, 30.0, 25).tolist())
DIGITS = (6, 5, 5, 2, 2)
"""Digits of omega, k, c and both bars: four of k would be as coarse as its bar."""
OPTIONS = Options(points=257)
CHECKED, SEED = 10, 7
"""Contacts between those of the table, and the seed that draws them."""
BANDS = ((0.0, 1.0), (1.0, 3.0), (3.0, 10.0), (10.0, 30.0))


def solved(load: float, speed: float, omegas: tuple[float, ...]) -> np.ndarray:
    """Return omega, k, c and both error bars of a contact, dimensionless, (5, n)."""
    problem = moes_contact(load, speed)
    time = scales(problem).half_width_x / scales(problem).speed
    hertz = [omega / (2.0 * np.pi * time) for omega in omegas]
    tables = problem.model_dump(exclude_none=True) | {"dynamics": {"frequencies": hertz}}
    result = solve(ContactProblem.model_validate(tables), OPTIONS)
    film, one = result.dynamics, result.scales
    assert film is not None
    unit = one.hertz_pressure * one.half_width_x * one.half_width_y / one.film_thickness
    stiffness, bar = film.stiffness / unit, film.stiffness_error / unit
    damping, wide = (part / (unit * time) for part in (film.damping, film.damping_error))
    return np.array([(0.0, *omegas), stiffness, damping, bar, wide])


def write() -> None:
    """Append the contacts that the table does not have."""
    lines = TABLE.read_text(encoding="utf-8").splitlines() if TABLE.exists() else []
    known = {tuple(line.split(",")[:2]) for line in lines}
    with TABLE.open("a", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        if not lines:
            writer.writerow(COLUMNS)
        for load, speed in product(LOADS, SPEEDS):
            place = f"{load:g}", f"{speed:g}"
            if place not in known:
                for row in solved(load, speed, OMEGAS).T:
                    digits = zip(row, DIGITS, strict=True)
                    writer.writerow((*place, *(f"{value:.{most}g}" for value, most in digits)))
                file.flush()


def check() -> Table:
    """Return the differences of the interpolation to contacts between those of the table."""
    draw = np.random.default_rng(SEED)
    found: list[np.ndarray] = []
    for _ in range(CHECKED):
        load, speed = np.exp(draw.uniform(np.log((LOADS[0], 1.0)), np.log((LOADS[-1], 20.0))))
        omegas = tuple(np.sort(np.exp(draw.uniform(np.log(0.03), np.log(30.0), 40)))[::4].tolist())
        omega, k, c, k_bar, c_bar = solved(load, speed, omegas)
        by_table = stiffness_by_table(load, speed, omega)
        far = abs(by_table.stiffness / k - 1.0), abs(by_table.damping - c)
        bars = by_table.stiffness_error + k_bar, by_table.damping_error + c_bar
        within = abs(by_table.stiffness - k) <= bars[0], far[1] <= bars[1]
        found.append(np.array([omega, far[0], far[1] / c, omega * far[1] / k, *within]))
    every = np.concatenate(found, axis=1)
    rows = []
    for low, high in BANDS:
        part = every[:, (every[0] >= low) & (every[0] < high)]
        numbers = (np.percentile(100.0 * part[k], p) for k in (1, 2, 3) for p in (50, 95, 100))
        rows.append((f"{low:g} to {high:g}", *numbers, *(100.0 * part[4:].mean(axis=1))))
    names = (
        f"{name}, {part}" for name in ["k", "c", "Omega*c/k"] for part in ("50 %", "95 %", "all")
    )
    return Table(
        title=f"Interpolated film_stiffness.csv, {CHECKED} contacts between, differences in %",
        columns=("Omega", *names, "k within bars", "c within bars"),
        rows=rows,
    )


if __name__ == "__main__":
    sys.stdout.write(check().text()) if "check" in sys.argv else write()
