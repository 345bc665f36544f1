"""``tehl study``: many cases, in parallel, resumable, one table."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Exit, Option

from tehl.base.lazy import lazy
from tehl.cli.arguments import AsJson, Jobs, Overrides, Quiet, Scheduler
from tehl.cli.ending import NOT_CONVERGED

if TYPE_CHECKING:
    from tehl.cli import study_job
else:
    study_job = lazy("tehl.cli.study_job")


def study(  # noqa: PLR0913 (the options of the command)
    source: Annotated[
        Path, Argument(metavar="STUDY", help="Study file, or the folder of a study.")
    ],
    *,
    output: Annotated[
        Path | None, Option("-o", "--output", metavar="DIR", help="Folder; STUDY here if left out.")
    ] = None,
    jobs: Jobs = None,
    scheduler: Scheduler = None,
    overrides: Overrides,
    dry_run: Annotated[
        bool, Option("--dry-run", help="Estimate time, memory and disk; solve nothing.")
    ] = False,
    retry_failed: Annotated[
        bool,
        Option(
            "--retry-failed", help="Solve failed cases again, with the settings of their hints."
        ),
    ] = False,
    replace: Annotated[
        bool, Option("--replace", help="Replace another study in the folder.")
    ] = False,
    table_only: Annotated[
        bool, Option("--table", help="Write the table of what is finished; solve nothing.")
    ] = False,
    plots: Annotated[
        list[str],
        Option(
            "--plot",
            metavar="x=X,y=Y,hue=H",
            help="Draw columns of the table of what is finished, or moes; solve nothing.",
            default_factory=list,
            show_default=False,
        ),
    ],
    sheet: Annotated[
        Path | None,
        Option(
            "--sheet",
            metavar="FILE",
            help="Write columns of what is finished, .csv or .xlsx; solve nothing.",
        ),
    ] = None,
    columns: Annotated[
        str | None,
        Option(
            metavar="NAME [UNIT],...",
            help='Columns of the sheet, "load [N], h_min_m [nm], max_pa [GPa]"; all if left out.',
        ),
    ] = None,
    yes: Annotated[bool, Option("--yes", help="Accept any number of cases.")] = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Solve the cases of a study that are not finished yet; write their table.

    The same command continues a study that was interrupted. Exit code 0: all cases converged;
    1: some failed and are named; 2: bad input, nothing is solved; 3: the environment failed, what
    is finished is kept.
    """
    arguments = locals()
    names = ("table_only", "plots", "sheet", "columns")
    wanted = study_job.Wanted(**{name: arguments.pop(name) for name in names})
    if not study_job.run(study_job.StudyJob(**arguments, wanted=wanted)):
        raise Exit(NOT_CONVERGED)
