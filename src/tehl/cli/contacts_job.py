"""One job of ``tehl contacts``: read, solve, write, say what happened."""

from contextlib import closing
from pathlib import Path

import typer

from tehl.base.atomic import check_writable
from tehl.base.errors import InputError
from tehl.cli.lines import show
from tehl.cli.progress import MOST_NAMED_CASES, study_progress
from tehl.cli.study_job import as_json as as_json_of
from tehl.cli.study_job import number_of_workers, show_outcome
from tehl.studies.answers import check_output, write_answers
from tehl.studies.contacts import TEMPLATE, read_contacts
from tehl.studies.plan import locked
from tehl.studies.runner import expected_times
from tehl.studies.runner import run as solve
from tehl.studies.store import Store


def run(  # noqa: PLR0913 (the arguments of the command)
    source: Path,
    output: Path,
    template: Path | None,
    jobs: str | None,
    scheduler: str | None,
    *,
    as_json: bool,
    quiet: bool,
) -> bool:
    """Do what the arguments state; return whether all rows converged."""
    workers = number_of_workers(jobs)
    check_output(output)
    check_writable(output, sources=(source, *(() if template is None else (template,))))
    found = read_contacts(source, template)
    if template is None and not quiet:
        show(
            f"what the rows do not state is that of tehl new {TEMPLATE}; --template takes another "
            "case",
            err=True,
        )
    if found.carried and not quiet:
        show(f"columns that state nothing: {', '.join(found.carried)}", err=True)
    first = 0 if found.cases else 1  # that is the error
    for row in found.wrong[first:MOST_NAMED_CASES]:
        show(f"tehl: {row.message}", err=True)
    if len(found.wrong) > MOST_NAMED_CASES:
        show(f"tehl: and {len(found.wrong) - MOST_NAMED_CASES} more wrong rows", err=True)
    if not found.cases:
        raise InputError(f"{source}: no row can be solved; {found.wrong[0].message}")
    folder = output.with_name(f"{output.name}.contacts")
    with locked(folder), closing(Store(folder)) as store:
        try:
            expected = expected_times(found.cases, store.finished(found.cases))
            with study_progress(expected, quiet=quiet) as monitor:
                outcome = solve(
                    found.cases,
                    store,
                    jobs=workers,
                    scheduler=scheduler,
                    forked=True,
                    monitor=monitor,
                )
        except (KeyboardInterrupt, SystemExit, OSError):
            show(
                f"tehl: finished contacts are kept in {folder}; continue with the same command",
                err=True,
            )
            raise
        write_answers(found, store, output)
    if as_json:
        wrong = [row.message for row in found.wrong]
        typer.echo(as_json_of(outcome, rows=len(found.rows), wrong=wrong, table=str(output)))
    else:
        wrong_rows = f"wrong rows, see the table: {len(found.wrong)} of {len(found.rows)}"
        show_outcome(outcome, [str(output)], "contacts", wrong_rows if found.wrong else "")
    return not (found.wrong or outcome.failed)
