"""``tehl study``: many cases, in parallel, resumable, one table."""

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    import pandas as pd

    from tehl.studies import Outcome, Store
    from tehl.studies.pictures import Picture
    from tehl.studies.plan import Plan, Study


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
    changes: Annotated[
        list[str], typer.Option("--set", metavar="KEY=VALUE", help="Change a key of the base case.")
    ] = [],  # noqa: B006 (typer reads the default, nobody writes it)
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Tell what it would take and solve nothing.")
    ] = False,
    retry_failed: Annotated[
        bool, typer.Option("--retry-failed", help="Solve those again that have no answer.")
    ] = False,
    replace: Annotated[
        bool,
        typer.Option("--replace", help="Take the place of another study in the folder."),
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
    yes: Annotated[bool, typer.Option("--yes", help="Any number of cases is meant.")] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the outcome as one JSON object.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show no progress.")] = False,
) -> None:
    """Solve the cases of a study that are not finished yet; write their table.

    The same command goes on with a study that was interrupted. Exit code 0: all cases converged;
    1: some have no answer and are named; 2: bad input, nothing is solved; 3: the environment
    failed, what is finished is kept.
    """
    from tehl.studies.folder import check_same
    from tehl.studies.pictures import picture_of

    workers, pictures = _workers(jobs), tuple(picture_of(words) for words in plots)
    plan, folder = _plan(source, output, changes, yes=yes)
    _check_folder(folder, source)
    chosen = _study(plan, source)
    if not replace or table_only or pictures:
        check_same(plan, folder)
    if dry_run:
        _tell_forecast(chosen, folder, workers, as_json=as_json)
        return
    if table_only or pictures:
        _show(chosen, folder, pictures, whole=table_only, as_json=as_json)
        return
    wishes = _Wishes(
        jobs=workers,
        scheduler=scheduler,
        retry_failed=retry_failed,
        quiet=quiet,
        replace=replace,
    )
    with _alone(folder):
        outcome, store = _run(chosen, folder, wishes)
        written = _write(chosen, store, folder, plan.pictures)
    _tell(outcome, written, as_json=as_json)
    if outcome.failed:
        raise typer.Exit(1)


def _plan(
    source: Path, output: Path | None, changes: list[str], *, yes: bool
) -> tuple["Plan", Path]:
    """Return the plan and the folder of the study."""
    from tehl.errors import InputError
    from tehl.studies.file import read_study
    from tehl.studies.folder import load_plan

    if not source.is_dir():
        folder = Path(source.stem) if output is None else output
        return read_study(source, changes, huge=yes), folder
    if output is not None or changes:
        raise InputError(
            f"{source} is the folder of a study that is planned already: -o and --set go with a "
            "study file"
        )
    return load_plan(source), source


def _study(plan: "Plan", source: Path) -> "Study":
    """Return all cases, checked."""
    from tehl.errors import InputError
    from tehl.io.atomic import shortened
    from tehl.studies.plan import study_of

    try:
        return study_of(plan)
    except InputError as error:
        raise InputError(f"{shortened(source)}: {error}") from None


def _check_folder(folder: Path, source: Path) -> None:
    from tehl.errors import InputError
    from tehl.io.atomic import check_place

    check_place(folder)
    if folder.is_dir() and not (folder / "study.json").exists() and folder != source:
        foreign = [path.name for path in folder.iterdir() if path.name in ("table.csv", "fields")]
        if foreign:
            raise InputError(
                f"the folder {folder} has a {foreign[0]} that is not of a study: take another -o"
            )


def _workers(jobs: str | None) -> int:
    """Return how many processes to take: as stated, or one per core of this process."""
    import os

    from tehl.errors import InputError

    if jobs is not None:
        number = int(jobs) if jobs.isascii() and jobs.isdigit() and len(jobs) < 7 else 0
        if number < 1:
            raise InputError(f"--jobs {jobs[:40]} must be a whole number of processes, 1 or more")
        return number
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return max(1, cores or 1)


def _again(folder: Path, scheduler: str | None) -> str:
    """Return the command that goes on, whatever was changed."""
    import shlex

    words = ["tehl", "study", str(folder)]
    words += [] if scheduler is None else ["--scheduler", scheduler]
    return shlex.join(words)


@dataclass(frozen=True, kw_only=True, slots=True)
class _Wishes:
    """How to run a study, as the command line says it."""

    jobs: int
    scheduler: str | None
    retry_failed: bool
    quiet: bool
    replace: bool


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Make the folder and keep other runs out of it; without an outcome it goes away again."""
    from tehl.studies.folder import check_can_write
    from tehl.studies.lock import LOCK, only_run_in

    check_can_write(folder)
    missing = [place for place in (folder, *folder.parents) if not place.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    with only_run_in(folder):
        try:
            yield
        finally:
            if missing and {path.name for path in folder.iterdir()} <= {LOCK}:
                _remove(folder / LOCK, missing)


def _remove(lock: Path, folders: list[Path]) -> None:
    lock.unlink(missing_ok=True)
    for folder in folders:
        with suppress(OSError):
            folder.rmdir()


def _run(chosen: "Study", folder: Path, wishes: _Wishes) -> tuple["Outcome", "Store"]:
    import logging

    from tehl.cli.study_progress import study_progress
    from tehl.studies import run
    from tehl.studies.folder import PLAN, check_same, forget_outcome, save_plan, store_of
    from tehl.studies.forecast import check_memory_of, forecast

    store = store_of(chosen.plan, folder)
    if wishes.scheduler is None:
        finished = store.finished(chosen.cases)
        needs = forecast(chosen.cases, finished, jobs=wishes.jobs, fields=False)
        check_memory_of(needs, wishes.jobs)
    else:  # what the cluster says of a scheduler that is gone, we say in a sentence
        logging.disable()
    if wishes.replace:
        forget_outcome(folder)
    else:
        check_same(chosen.plan, folder)  # again, now that nobody else changes it
    is_new = save_plan(chosen.plan, folder)
    try:
        with study_progress(quiet=wishes.quiet) as monitor:
            outcome = run(
                chosen.cases,
                store,
                jobs=wishes.jobs,
                scheduler=wishes.scheduler,
                retry_failed=wishes.retry_failed,
                warm_start=chosen.plan.warm_start,
                forked=True,
                monitor=monitor,
            )
    except (KeyboardInterrupt, SystemExit, OSError):
        if store.is_begun:
            again = _again(folder, wishes.scheduler)
            typer.echo(f"tehl: finished cases are kept; go on with: {again}", err=True)
        elif is_new:
            (folder / PLAN).unlink()
        raise
    finally:
        store.close()
    return outcome, store


def _write(
    chosen: "Study", store: "Store", folder: Path, pictures: tuple["Picture", ...]
) -> dict[str, Any]:
    """Write table and pictures; return the files by kind."""
    frame = _table(chosen, store)
    store.close()
    return _write_frame(frame, folder, pictures)


def _write_frame(
    frame: "pd.DataFrame", folder: Path, pictures: tuple["Picture", ...]
) -> dict[str, Any]:
    from tehl.studies.draw import save_pictures
    from tehl.studies.folder import write_table

    written: dict[str, Any] = {"table": write_table(frame, folder)}
    written["pictures"], complaints = save_pictures(pictures, frame, folder)
    for complaint in complaints:
        typer.echo(f"tehl: {complaint}", err=True)
    return written


def _table(chosen: "Study", store: "Store") -> "pd.DataFrame":
    from tehl.studies import table

    return table(chosen.cases, store, chosen.units)


def _show(
    chosen: "Study", folder: Path, pictures: tuple["Picture", ...], *, whole: bool, as_json: bool
) -> None:
    """Draw what is asked for, or write table and pictures of what is finished; solve nothing."""
    import json

    from tehl.errors import InputError
    from tehl.studies.draw import save
    from tehl.studies.folder import check_can_write, store_of

    store = store_of(chosen.plan, folder)
    frame = _table(chosen, store)
    store.close()
    if (frame["status"] == "open").all():
        raise InputError(f"no case of the study is finished yet in {folder}")
    check_can_write(folder)
    files = [save(one, frame, folder) for one in pictures]
    if whole or not pictures:
        written = _write_frame(frame, folder, chosen.plan.pictures)
        files += [*written["table"], *written["pictures"]]
    counts = {str(key): int(n) for key, n in frame["status"].value_counts().items()}
    if as_json:
        typer.echo(json.dumps({"cases": len(frame), "status": counts, "files": _words(files)}))
    else:
        typer.echo("\n".join(_words(files)))
    if whole and counts.keys() - {"converged", "open"}:
        raise typer.Exit(1)


def _words(paths: list[Path]) -> list[str]:
    return [str(path) for path in paths]


def _tell_forecast(chosen: "Study", folder: Path, jobs: int, *, as_json: bool) -> None:
    import json
    from dataclasses import asdict

    from tehl.cli.study_progress import duration
    from tehl.studies.folder import store_of
    from tehl.studies.forecast import forecast

    store = store_of(chosen.plan, folder)
    finished = store.finished(chosen.cases)
    found = forecast(chosen.cases, finished, jobs=jobs, fields=chosen.plan.keep == "fields")
    store.close()
    if as_json:
        typer.echo(json.dumps(asdict(found) | {"jobs": jobs}))
        return
    first, last = chosen.cases[0].name, chosen.cases[-1].name
    rows = (
        ("cases", f"{found.cases}, from {first} to {last}"),
        ("to be solved", f"{found.open}"),
        ("time", f"about {duration(found.wall_seconds)} on {jobs} cores, "
         f"{duration(found.cpu_seconds)} of computing"),
        ("disk", f"about {found.disk_bytes / 1e6:.3g} MB in {folder}"),
        ("memory", f"about {found.memory_bytes / 1e6:.3g} MB besides the program"),
    )  # fmt: skip
    typer.echo(chosen.plan.title or "Study")
    for name, value in rows:
        typer.echo(f"  {name:<14}{value}")


def _tell(outcome: "Outcome", written: dict[str, Any], *, as_json: bool) -> None:
    import json

    from tehl.cli.study_progress import SHOWN, duration

    if as_json:
        failed = [
            {"name": case.name}
            | {key: getattr(row, key) for key in ("status", "cause", "message", "hint")}
            for case, row in outcome.failed
        ]
        counts = {
            "status": "converged" if not failed else "not_converged",
            "cases": outcome.total,
            "reused": outcome.reused,
            "converged": outcome.converged,
            "failed": failed,
            "cpu_seconds": outcome.cpu_seconds,
            "wall_seconds": outcome.wall_seconds,
        }
        typer.echo(json.dumps(counts | {kind: _words(p) for kind, p in written.items()}))
        return
    typer.echo(
        f"{outcome.converged} of {outcome.total} cases converged, {outcome.reused} were finished "
        f"before; {duration(outcome.wall_seconds)}"
    )
    if outcome.uncertain:
        typer.echo(
            f"  {outcome.uncertain} of them with a minimum film that is hardly known: see the "
            "messages in the table"
        )
    for case, row in outcome.failed[:SHOWN]:
        typer.echo(f"  no answer: {case.name}: {row.message or row.cause}")
    if len(outcome.failed) > SHOWN:
        typer.echo(f"  and {len(outcome.failed) - SHOWN} more, see the table")
    hints = Counter(row.hint for _, row in outcome.failed if row.hint)
    for hint, count in hints.most_common(SHOWN):
        typer.echo(f"  hint: {hint}" if count == 1 else f"  hint for {count} of them: {hint}")
    for path in (*written["table"], *written["pictures"]):
        typer.echo(f"written: {path}", err=True)
