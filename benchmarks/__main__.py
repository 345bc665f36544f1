"""``python -m benchmarks [TOPIC ...] [--quick] [--points N] [--json FILE]``."""

import argparse
import json
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

from benchmarks import deformation, domain, rate, robustness, speed
from benchmarks.table import Table

TOPICS: dict[str, Callable[..., Table]] = {
    "speed": speed.table,
    "rate": rate.table,
    "deformation": deformation.table,
    "domain": domain.table,
    "robustness": robustness.table,
}
BY_DEFAULT = ("speed", "rate", "deformation")


def arguments() -> argparse.Namespace:
    """Return what was asked on the command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("topics", nargs="*", help=f"of {', '.join(TOPICS)}")
    parser.add_argument("--quick", action="store_true", help="small grids, few cases")
    parser.add_argument("--points", type=int, default=257, help="grid of the robustness sweep")
    parser.add_argument("--json", type=Path, help="also write the tables to this file")
    asked = parser.parse_args()
    for topic in asked.topics:
        if topic not in TOPICS:
            parser.error(f"no topic {topic!r}: choose from {', '.join(TOPICS)}")
    return asked


def main() -> None:
    """Measure what was asked and print one table per topic."""
    asked = arguments()
    tables = []
    for topic in asked.topics or BY_DEFAULT:
        make = TOPICS[topic]
        if topic == "robustness":
            make = partial(make, asked.points)
        table = make(quick=asked.quick)
        tables.append(table.as_dict())
        sys.stdout.write(table.text() + "\n")
        sys.stdout.flush()
    if asked.json is not None:
        asked.json.write_text(json.dumps(tables, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
