"""Film of starved circular contacts over the supply, as a table.

``python -m benchmarks.starvation_table`` solves each contact to 0.5 % and writes
``src/tehl/estimate/starvation.csv``, which ``tehl explain`` reads.
"""

import csv
from itertools import product
from pathlib import Path

from tests.reference import moes_contact

from tehl.api.problem import case_from_tables
from tehl.api.solvers import solve
from tehl.contact.options import Options

TABLE = Path(__file__).parents[1] / "src" / "tehl" / "estimate" / "starvation.csv"
LOADS, SPEEDS = (20.0, 50.0, 100.0, 200.0, 500.0), (5.0, 8.0, 12.0)
RATIOS = (0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0)
OPTIONS = Options(error=0.005)


def row(load: float, speed: float, ratio: float) -> tuple[str, ...]:
    """Return M, L, r, the film over the flooded one and the error bar of both together."""
    tables = moes_contact(load, speed).model_dump(exclude_none=True)
    result = solve(case_from_tables(tables | {"supply": {"ratio": ratio}})[0], OPTIONS)
    starved = result.starvation
    assert starved is not None
    place = (f"{number:g}" for number in (load, speed, ratio))
    return *place, f"{starved.degree:.4f}", f"{starved.degree_error:.4f}"


def main() -> None:
    """Write the table."""
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("M", "L", "r", "degree", "error"))
        for place in product(LOADS, SPEEDS, RATIOS):
            writer.writerow(row(*place))
            file.flush()


if __name__ == "__main__":
    main()
