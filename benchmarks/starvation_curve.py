"""The central film of a starved circular contact over that of the flooded one: a table.

``python -m benchmarks.starvation_curve -o src/tehl/starvation.csv`` solves each contact and supply
on two grids, extrapolates both films, and writes the part with an error bar. ``tehl explain``
interpolates in the table.
"""

import argparse
import csv
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tehl.io.case import case_from_tables
from tehl.options import Options
from tehl.solver.steady import solve

LOADS, SPEEDS = (20.0, 50.0, 100.0, 200.0, 500.0), (5.0, 8.0, 12.0)
SUPPLIES = (0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0, 10.0)
COLUMNS = ("M", "L", "r", "part", "error")
NODES = {20.0: 257, 50.0: 257, 100.0: 257, 200.0: 385, 500.0: 513}


def moes_case(load: float, speed: float) -> dict[str, Any]:
    """Return steel on steel with the oil of the reference films."""
    return {
        "contact": {"radius": 0.02, "moes_load": load, "moes_speed": speed},
        "surface_1": {"material": "steel"},
        "surface_2": {"material": "steel"},
        "lubricant": {
            "viscosity": {"law": "roelands", "eta_0": 0.04, "alpha": 22e-9},
            "density": {
                "law": "dowson-higginson",
                "rho_0": 890.0,
                "slope": 0.6e-9,
                "saturation": 1.7e-9,
            },
        },
    }


def part(load: float, speed: float, supply: float, nodes: int) -> float:
    """Return the starved over the flooded central film on one grid."""
    problem, _ = case_from_tables(moes_case(load, speed) | {"supply": {"ratio": supply}})
    found = solve(problem, Options(points=nodes, accuracy="tight", tolerance=1e-6)).starvation
    assert found is not None
    assert found.degree is not None
    return found.degree


def rows() -> Iterator[tuple[float, float, float, float, float]]:
    """Yield the rows: the part extrapolated, and two thirds of the last change as its error."""
    for load in LOADS:
        for speed in SPEEDS:
            for supply in SUPPLIES:
                nodes = NODES[load]
                coarse, fine = (part(load, speed, supply, n) for n in (nodes, 2 * nodes - 1))
                change = fine - coarse
                yield load, speed, supply, fine + change / 3.0, max(abs(change) / 1.5, 1e-4)


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", type=Path, required=True)
    output = parser.parse_args().output
    with output.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for row in rows():
            digits = max(1, 1 - math.floor(math.log10(row[4])))
            table.writerow(
                (*(f"{one:g}" for one in row[:3]), *(f"{x:.{digits}f}" for x in row[3:]))
            )
            file.flush()


if __name__ == "__main__":
    main()
