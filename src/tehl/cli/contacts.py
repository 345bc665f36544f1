"""``tehl contacts``: a spreadsheet of contacts in, the same with films, friction and bars out."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Exit, Option

from tehl.base.lazy import lazy
from tehl.cli.arguments import AsJson, Jobs, Quiet, Scheduler
from tehl.cli.ending import NOT_CONVERGED

if TYPE_CHECKING:
    from tehl.cli import contacts_job
else:
    contacts_job = lazy("tehl.cli.contacts_job")


def contacts(  # noqa: PLR0913 (the options of the command)
    table: Annotated[
        Path, Argument(metavar="TABLE", help="A row per contact: .csv, .xlsx or .parquet.")
    ],
    *,
    output: Annotated[
        Path, Option("-o", "--output", metavar="FILE", help="Answers: .xlsx, .csv or .parquet.")
    ],
    template: Annotated[
        Path | None,
        Option(
            "--template",
            metavar="CASE",
            help="Case file with what the rows do not state; the ball on a disc if left out.",
        ),
    ] = None,
    jobs: Jobs = None,
    scheduler: Scheduler = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Solve each row of a table of contacts; write the table with the answers beside it.

    Headings are keys of a case file or words for them, with a unit: load [N], speed [m/s],
    radius_1 [mm], p_h [GPa], temperature [degC], oil, sq_1 [um]. What they do not state is that of
    the template.

    The same command continues a list that was interrupted. Exit code 0: all rows converged; 1: some
    are wrong or failed, and are named; 2: bad input, nothing is solved.
    """
    if not contacts_job.run(table, output, template, jobs, scheduler, as_json=as_json, quiet=quiet):
        raise Exit(NOT_CONVERGED)
