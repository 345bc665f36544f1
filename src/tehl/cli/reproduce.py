"""``tehl reproduce``: the founding paper, each table and figure beside ours."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from tehl.studies import Case, Row


def reproduce(
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder of results and page.")
    ],
    only: Annotated[
        str | None,
        typer.Option("--only", metavar="NAMES", help="Some tables, figures, statements: T2,F7,C4."),
    ] = None,
    points: Annotated[
        int | None,
        typer.Option("--points", metavar="N", help="Nodes per direction of all fine grids."),
    ] = None,
    jobs: Annotated[
        int | None, typer.Option("--jobs", min=1, help="Processes; one per processor if left out.")
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show no progress.")] = False,
) -> None:
    """Solve, draw and judge every table and figure of the founding paper.

    Minutes the first time; what is solved is kept in DIR, so that the next run only draws.
    """
    from tehl.reproduce import reproduce as make
    from tehl.studies.runner import QUIET

    names = [] if only is None else only.split(",")
    monitor = QUIET if quiet else _Progress()
    page = make(output, only=names, points=points, jobs=jobs, monitor=monitor)
    typer.echo(page)


class _Progress:
    """A line for each finished case, on stderr."""

    def __init__(self) -> None:
        self.total, self.done = 0, 0

    def message(self, text: str) -> None:
        """Show a remark."""
        typer.echo(text, err=True)

    def begin(self, total: int, reused: int) -> None:
        """Show how much is to be done."""
        self.total, self.done = total, reused
        typer.echo(f"{total} contacts, {reused} of them solved before", err=True)

    def finished(self, case: "Case", row: "Row") -> None:
        """Show a finished case."""
        self.done += 1
        cause = "" if row.cause is None else f": {row.cause.replace('_', ' ')}"
        outcome = f"{row.status.replace('_', ' ')}{cause}"
        typer.echo(
            f"{self.done:4d}/{self.total}  {case.name}  {outcome}  {row.cost.wall_seconds:.1f} s",
            err=True,
        )
