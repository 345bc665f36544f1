"""Benchmarks: ``python -m benchmarks [TOPIC ...] [--quick] [--points N] [--json FILE]``."""

import argparse
import json
import sys
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

from benchmarks import (
    asperities,
    deformation,
    directions,
    domain,
    line_page,
    mixed,
    order,
    rate,
    rough,
    speed,
    thermal,
    touching,
    waves,
)
from benchmarks.table import Table

TOPICS: dict[str, Callable[..., Table | Iterable[Table]]] = {
    "speed": speed.table,
    "rate": rate.table,
    "deformation": deformation.table,
    "domain": domain.table,
    "order": order.table,
    "heat": thermal.table,
    "waves": waves.table,
    "rough": rough.tables,
    "asperities": asperities.tables,
    "mixed": mixed.table,
    "touching": touching.tables,
    "rolling": line_page.tables,
    "directions": directions.tables,
}
BY_DEFAULT = ("speed", "rate", "deformation")


def arguments() -> argparse.Namespace:
    """Return the arguments of the command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("topics", nargs="*", help=f"of {', '.join(TOPICS)}")
    parser.add_argument("--quick", action="store_true", help="small grids, few cases")
    parser.add_argument("--points", type=int, default=257, help="grid of the sweeps")
    parser.add_argument("--json", type=Path, help="also write the tables to this file")
    given = parser.parse_args()
    for topic in given.topics:
        if topic not in TOPICS:
            parser.error(f"no topic {topic!r}: choose from {', '.join(TOPICS)}")
    return given


def main() -> None:
    """Measure the given topics and print one table each."""
    given = arguments()
    tables = []
    for topic in given.topics or BY_DEFAULT:
        make = TOPICS[topic]
        if topic in ("rough", "asperities", "mixed", "touching"):
            make = partial(make, given.points)
        made = make(quick=given.quick)
        for table in [made] if isinstance(made, Table) else made:
            tables.append(table.as_dict())
            sys.stdout.write(table.text() + "\n")
            sys.stdout.flush()
    if given.json is not None:
        given.json.write_text(json.dumps(tables, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
