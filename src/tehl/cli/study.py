"""``tehl study``: many cases, in parallel, resumable, one table."""

from pathlib import Path
from typing import Annotated

import typer

from tehl.cli.ending import NOT_CONVERGED


def study(  # noqa: PLR0913, PLR0917 (the options of the command)
    source: Annotated[
        Path,
        typer.Argument(
            metavar="STUDY", help="Study file, or the folder of a study.", show_default=False
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Folder; STUDY here if left out."),
    ] = None,
    jobs: Annotated[
        str | None,
        typer.Option("--jobs", "-j", metavar="N", help="Processes; one per core if left out."),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler", metavar="ADDRESS", help="Running dask cluster, tcp://HOST:8786."
        ),
    ] = None,
    overrides: Annotated[
        list[str],
        typer.Option("--set", metavar="KEY=VALUE", help="Override a key of the base case."),
    ] = [],  # noqa: B006 (typer reads the default, nothing writes it)
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Estimate time, memory and disk; solve nothing.")
    ] = False,
    retry_failed: Annotated[
        bool, typer.Option("--retry-failed", help="Solve failed cases again.")
    ] = False,
    replace: Annotated[
        bool, typer.Option("--replace", help="Replace another study in the folder.")
    ] = False,
    table_only: Annotated[
        bool, typer.Option("--table", help="Write the table of what is finished; solve nothing.")
    ] = False,
    plots: Annotated[
        list[str],
        typer.Option(
            "--plot",
            metavar="x=X,y=Y,hue=H",
            help="Draw columns of the table of what is finished, or moes; solve nothing.",
        ),
    ] = [],  # noqa: B006
    yes: Annotated[bool, typer.Option("--yes", help="Accept any number of cases.")] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the outcome as one JSON object.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show no progress.")] = False,
) -> None:
    """Solve the cases of a study that are not finished yet; write their table.

    The same command continues a study that was interrupted. Exit code 0: all cases converged;
    1: some failed and are named; 2: bad input, nothing is solved; 3: the environment failed, what
    is finished is kept.
    """
    from tehl.cli.study_job import StudyJob, run

    job = StudyJob(
        source=source,
        output=output,
        jobs=jobs,
        scheduler=scheduler,
        overrides=overrides,
        dry_run=dry_run,
        retry_failed=retry_failed,
        replace=replace,
        table_only=table_only,
        plots=plots,
        unlimited=yes,
        as_json=as_json,
        quiet=quiet,
    )
    if not run(job):
        raise typer.Exit(NOT_CONVERGED)
