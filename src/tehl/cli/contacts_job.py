"""One job of ``tehl contacts``: read, solve, write, say what happened."""

import json
from contextlib import closing
from pathlib import Path

import typer

from tehl.base.atomic import check_writable
from tehl.base.errors import InputError
from tehl.cli.lines import show
from tehl.cli.progress import MOST_NAMED_CASES, duration, study_progress
from tehl.cli.study_job import number_of_workers
from tehl.studies.answers import check_output, write_answers
from tehl.studies.contacts import TEMPLATE, Contacts, read_contacts
from tehl.studies.plan import locked
from tehl.studies.runner import Outcome, expected_times
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
    if not found.cases:
        raise InputError(f"{source}: no row can be solved; {found.wrong[0].message}")
    if template is None and not quiet:
        show(
            f"what the rows do not state is that of tehl new {TEMPLATE}; --template takes another "
            "case",
            err=True,
        )
    for row in found.wrong[:MOST_NAMED_CASES]:
        show(f"tehl: {row.message}", err=True)
    if len(found.wrong) > MOST_NAMED_CASES:
        show(f"tehl: and {len(found.wrong) - MOST_NAMED_CASES} more wrong rows", err=True)
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
    _show(found, outcome, output, as_json=as_json)
    return not (found.wrong or outcome.failed)


def _show(found: Contacts, outcome: Outcome, output: Path, *, as_json: bool) -> None:
    if as_json:
        numbers = {
            "rows": len(found.rows),
            "wrong": [row.message for row in found.wrong],
            "equal": outcome.equal,
            "reused": outcome.reused,
            "converged": outcome.converged,
            "failed": [
                {"name": case.name, "cause": row.cause, "message": row.message}
                for case, row in outcome.failed
            ],
            "cpu_seconds": outcome.cpu_seconds,
            "wall_seconds": outcome.wall_seconds,
            "table": str(output),
        }
        typer.echo(json.dumps(numbers))
        return
    show(
        f"{outcome.converged} of {outcome.total} contacts converged, {outcome.reused} were "
        f"finished before; {duration(outcome.wall_seconds)}"
    )
    if outcome.equal:
        show(f"  {outcome.equal} further rows equal others, and are solved once")
    if found.wrong:
        show(f"  {len(found.wrong)} of {len(found.rows)} rows are wrong, see the table")
    for case, row in outcome.failed[:MOST_NAMED_CASES]:
        show(f"  failed: {case.name}: {row.message or row.cause}")
    typer.echo(f"written: {output}", err=True)
