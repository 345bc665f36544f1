"""Recompute the paper: ``python -m paper -o DIR [NAME ...]``."""

import argparse
import sys
from pathlib import Path

from paper.reproduce import reproduce
from tehl import InputError
from tehl.studies import Case, Row


class Progress:
    """Prints a line on stderr for each finished run."""

    def __init__(self) -> None:
        self.total, self.done = 0, 0

    def message(self, text: str) -> None:
        """Print a remark."""
        print(text, file=sys.stderr)  # noqa: T201

    def begin(self, total: int, reused: int) -> None:
        """Print how much is to be solved."""
        self.total, self.done = total, reused
        self.message(f"{total} runs, {reused} of them solved before")

    def finished(self, case: Case, row: Row) -> None:
        """Print a finished run."""
        self.done += 1
        cause = "" if row.cause is None else f": {row.cause.replace('_', ' ')}"
        outcome = f"{row.status.replace('_', ' ')}{cause}"
        seconds = f"{row.cost.wall_seconds:.1f} s"
        self.message(f"{self.done:4d}/{self.total}  {case.name}  {outcome}  {seconds}")


def main() -> int:
    """Run the command; return 0, or 2 for bad input."""
    parser = argparse.ArgumentParser(
        prog="python -m paper",
        description="Solve, draw and judge the tables, figures and conclusions of the paper. "
        "Solved runs are kept in DIR: a second run only draws.",
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="such as T2 F7 C4; all if none")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="DIR")
    parser.add_argument("--points", type=int, metavar="N", help="nodes per direction of fine grids")
    parser.add_argument("--jobs", type=int, metavar="N", help="processes; one per processor")
    parser.add_argument("-q", "--quiet", action="store_true", help="show no progress")
    given = parser.parse_args()
    options = {} if given.quiet else {"monitor": Progress()}
    try:
        page, _ = reproduce(
            given.output, given.names, points=given.points, jobs=given.jobs, **options
        )
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)  # noqa: T201
        return 2
    print(page)  # noqa: T201
    return 0


if __name__ == "__main__":
    sys.exit(main())
