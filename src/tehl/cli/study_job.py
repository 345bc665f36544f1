"""One job of ``tehl study``: the forecast, the run, what is written and printed."""

import json
import logging
import os
import shlex
import signal
import sys
from collections import Counter
from collections.abc import Iterable, Mapping
from contextlib import closing, suppress
from dataclasses import asdict, dataclass
from importlib import import_module
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING

import typer

from tehl.base.atomic import check_place, check_writable, shortened
from tehl.base.errors import InputError
from tehl.base.wording import duration
from tehl.cli.lines import show
from tehl.cli.progress import MOST_NAMED_CASES, study_progress
from tehl.result.solution import settings_text
from tehl.studies.case import Row
from tehl.studies.file import read_study
from tehl.studies.output import Picture, check_sheet, picture_of, save, write_sheet
from tehl.studies.plan import (
    PLAN,
    TABLE,
    Plan,
    Study,
    check_can_write,
    check_same,
    load_plan,
    locked,
    remove_outcome,
    save_plan,
    store_of,
    study_of,
    write_table,
)
from tehl.studies.runner import Outcome, check_memory_of, expected_times, forecast
from tehl.studies.runner import run as solve
from tehl.studies.tables import OPEN, table

if TYPE_CHECKING:
    import pandas as pd

Written = dict[str, list[str]]
"""Names of files by their kind."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Wanted:
    """What is made of the cases that are finished; nothing is solved if any of it is stated."""

    table_only: bool
    plots: list[str]
    sheet: Path | None
    columns: str | None

    @property
    def is_stated(self) -> bool:
        """Whether anything of it is stated."""
        return self.table_only or bool(self.plots) or self.sheet is not None

    def check_sheet(self, source: Path) -> None:
        """Check that the sheet, if any, can be written, and is not the study in ``source``."""
        if self.sheet is not None:
            check_sheet(self.sheet)
            check_writable(self.sheet, sources=(source,))
        elif self.columns is not None:
            raise InputError("--columns chooses those of a sheet: give --sheet FILE.csv or .xlsx")

    @property
    def chosen_columns(self) -> list[str]:
        """Columns of the sheet, all if none are stated."""
        return [part.strip() for part in (self.columns or "").split(",") if part.strip()]


@dataclass(frozen=True, kw_only=True, slots=True)
class StudyJob:
    """Arguments of the command."""

    source: Path
    output: Path | None
    jobs: str | None
    scheduler: str | None
    overrides: list[str]
    dry_run: bool
    retry_failed: bool
    replace: bool
    wanted: Wanted
    yes: bool
    as_json: bool
    quiet: bool


def run(job: StudyJob) -> bool:
    """Do what the arguments state; return whether no case failed.

    Invalid study, folder or arguments are an InputError before anything is solved; a folder in use
    or not writable, or workers that do not start, an OSError, and finished cases are kept.
    """
    workers = number_of_workers(job.jobs)
    pictures = [picture_of(words) for words in job.wanted.plots]
    job.wanted.check_sheet(job.source)
    plan, folder = _plan(job)
    _check_folder(folder, job.source)
    try:
        study = study_of(plan)
    except InputError as error:
        raise InputError(f"{shortened(job.source)}: {error}") from None
    if job.wanted.is_stated or not job.replace:
        check_same(plan, folder)
    if job.dry_run:
        _show_forecast(study, folder, workers, as_json=job.as_json)
        return True
    if job.wanted.is_stated:
        return _show_finished(study, folder, pictures, job)
    with locked(folder):
        outcome = _solved(study, folder, workers, job)
        written = _write(_table(study, folder), folder, plan.pictures)
    if job.as_json:
        typer.echo(as_json(outcome, **written))
    else:
        show_outcome(outcome, [*written["table"], *written["pictures"]], "cases")
    return not outcome.failed


def number_of_workers(jobs: str | None) -> int:
    """Return the number of processes: as stated, or one per core of this process."""
    if jobs is not None:
        number = int(jobs) if jobs.isascii() and jobs.isdigit() and len(jobs) < 7 else 0
        if number < 1:
            raise InputError(f"--jobs {jobs[:40]} must be a whole number of processes, 1 or more")
        return number
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return max(1, cores or 1)


def _plan(job: StudyJob) -> tuple[Plan, Path]:
    source, output = job.source, job.output
    if not source.is_dir():
        folder = Path(source.stem) if output is None else output
        return read_study(source, job.overrides, unlimited=job.yes), folder
    if output is not None or job.overrides:
        raise InputError(
            f"{source} is the folder of a study that is planned already: -o and --set go with a "
            "study file"
        )
    return load_plan(source), source


def _check_folder(folder: Path, source: Path) -> None:
    """Raise if a folder has a table or fields that are not of a study."""
    check_place(folder)
    if folder.is_dir() and not (folder / PLAN).exists() and folder != source:
        foreign = [path.name for path in folder.iterdir() if path.name in (TABLE, "fields")]
        if foreign:
            raise InputError(
                f"the folder {folder} has a {foreign[0]} that is not of a study: take another -o"
            )


def _solved(study: Study, folder: Path, workers: int, job: StudyJob) -> Outcome:
    """Solve what is not finished; on an interrupt show how to continue."""
    plan = study.plan
    with closing(store_of(plan, folder)) as store:
        finished = store.finished(study.cases)
        _check_resources(study, finished, workers, job.scheduler)
        if job.replace:
            remove_outcome(folder)
        else:
            check_same(plan, folder)  # again, now that the folder is locked
        is_new = save_plan(plan, folder)
        Thread(target=_load_late, args=(bool(plan.pictures),), daemon=True).start()
        try:
            expected = expected_times(study.cases, {} if job.replace else finished)
            with study_progress(expected, quiet=job.quiet) as monitor:
                return solve(
                    study.cases,
                    store,
                    jobs=workers,
                    scheduler=job.scheduler,
                    retry_failed=job.retry_failed,
                    warm_start=plan.warm_start,
                    forked=True,
                    monitor=monitor,
                )
        except (KeyboardInterrupt, SystemExit, OSError):
            if store.exists:
                scheduler = () if job.scheduler is None else ("--scheduler", job.scheduler)
                again = shlex.join(["tehl", "study", str(folder), *scheduler])
                show(f"tehl: finished cases are kept; continue with: {again}", err=True)
            elif is_new:
                (folder / PLAN).unlink()
            raise


def _load_late(pictures: bool) -> None:
    """Load what writes the table and the pictures while the workers start.

    An error there is one of the table or the picture. Signals are those of the main thread.
    """
    if sys.platform != "win32":
        signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())
    names = ["tehl.studies.frame", *(["tehl.plots.table_curves"] if pictures else [])]
    for name in names:
        with suppress(ImportError):
            import_module(name)


def _check_resources(
    study: Study, finished: Mapping[str, Row], workers: int, scheduler: str | None
) -> None:
    """Raise if the workers do not fit into the memory of this machine."""
    if scheduler is None:
        check_memory_of(forecast(study.cases, finished, jobs=workers, fields=False), workers)
    else:
        logging.disable()  # dask's own reports of a lost scheduler; ours is one sentence


def _table(study: Study, folder: Path) -> "pd.DataFrame":
    with closing(store_of(study.plan, folder)) as store:
        frame = table(study.cases, store, study.units)
    frame.attrs["title"] = study.plan.title
    return frame


def _write(frame: "pd.DataFrame", folder: Path, pictures: tuple[Picture, ...]) -> Written:
    """Write table and pictures; return the files by kind. A picture that fails is a warning."""
    written: Written = {"table": [str(path) for path in write_table(frame, folder)], "pictures": []}
    for picture in pictures:
        try:
            written["pictures"].append(str(save(picture, frame, folder)))
        except InputError as error:
            show(f"tehl: picture {Path(picture.file_name).stem}: {error}", err=True)
    return written


def _show_finished(study: Study, folder: Path, pictures: list[Picture], job: StudyJob) -> bool:
    """Draw pictures of what is finished, write its table if stated; return whether none failed."""
    frame = _table(study, folder)
    if (frame["status"] == OPEN).all():
        raise InputError(f"no case of the study is finished yet in {folder}")
    check_can_write(folder)
    files = [str(save(one, frame, folder)) for one in pictures]
    if (sheet := job.wanted.sheet) is not None:
        write_sheet(frame, sheet, job.wanted.chosen_columns)
        files.append(str(sheet))
    if job.wanted.table_only:
        written = _write(frame, folder, study.plan.pictures)
        files += [*written["table"], *written["pictures"]]
    counts = {str(key): int(n) for key, n in frame["status"].value_counts().items()}
    found = {"cases": len(frame), "status": counts, "files": files}
    typer.echo(json.dumps(found) if job.as_json else "\n".join(files))
    return not (job.wanted.table_only and counts.keys() - {"converged", OPEN})


def _show_forecast(study: Study, folder: Path, workers: int, *, as_json: bool) -> None:
    cases, plan = study.cases, study.plan
    with closing(store_of(plan, folder)) as store:
        finished = store.finished(cases)
    found = forecast(cases, finished, jobs=workers, fields=plan.keep == "fields")
    if as_json:
        typer.echo(json.dumps(asdict(found) | {"jobs": workers}))
        return
    cpu, wall = duration(found.cpu_seconds), duration(found.wall_seconds)
    show(plan.title or "Study")
    show(f"  cases         {found.cases}, from {cases[0].name} to {cases[-1].name}")
    show(f"  to be solved  {found.open}")
    known = "hard ones take up to ten times as long; the progress shows what is left"
    if found.is_calibrated:
        known = "by the cases finished so far"
    show(f"  time          about {wall} on {workers} cores, {cpu} of computing; {known}")
    show(f"  disk          about {found.disk_bytes / 1e6:.3g} MB in {folder}")
    show(f"  memory        about {found.memory_bytes / 1e6:.3g} MB besides the program")


def as_json(outcome: Outcome, **others: object) -> str:
    """Return what a run did as one JSON object, with ``others``."""
    failed = [
        {
            "name": case.name,
            "status": row.status,
            "cause": row.cause,
            "message": row.message,
            "hint": row.hint and str(row.hint),
        }
        for case, row in outcome.failed
    ]
    retried = [
        {"name": case.name, "retry_settings": dict(row.retry_settings)}
        for case, row in outcome.retried
    ]
    counts = ("equal", "reused", "converged", "cpu_seconds", "wall_seconds")
    found = {
        "status": "not_converged" if failed else "converged",
        "cases": outcome.total,
        "failed": failed,
        "retried": retried,
        **{name: getattr(outcome, name) for name in counts},
    }
    return json.dumps(found | others)


def show_outcome(outcome: Outcome, written: Iterable[str], what: str, remark: str = "") -> None:
    """Print what a run of cases did.

    Parameters
    ----------
    outcome : Outcome
        Counts, failures with their hints, and retries.
    written : iterable of str
        Names of the files.
    what, remark : str
        What a case is called, and a sentence on those that are not solved.
    """
    show(
        f"{outcome.converged} of {outcome.total} {what} converged, {outcome.reused} were finished "
        f"before; {duration(outcome.wall_seconds)}"
    )
    uncertain, more = outcome.uncertain, len(outcome.failed) - MOST_NAMED_CASES
    lines = [
        f"rows that equal others and are solved with them: {outcome.equal}"
        if outcome.equal
        else "",
        f"{uncertain} of them with an uncertain minimum film or pressure: see the table"
        if uncertain
        else "",
        remark,
    ]
    lines += [
        f"failed: {case.name}: {row.message or row.cause}"
        for case, row in outcome.failed[:MOST_NAMED_CASES]
    ]
    lines.append(f"and {more} more, see the table" if more > 0 else "")
    lines += [
        f"converged on retry: {case.name}: {settings_text(row.retry_settings)}"
        for case, row in outcome.retried[:MOST_NAMED_CASES]
    ]
    hints = Counter(str(row.hint) for _, row in outcome.failed if row.hint)
    lines += [
        f"hint: {hint}" if count == 1 else f"hint for {count} of them: {hint}"
        for hint, count in hints.most_common(MOST_NAMED_CASES)
    ]
    for line in filter(None, lines):
        show(f"  {line}")
    for path in written:
        typer.echo(f"written: {path}", err=True)
