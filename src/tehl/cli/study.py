"""``tehl study``: many cases, in parallel, resumable, one table."""

import json
import logging
import os
import shlex
from collections import Counter
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    import pandas as pd

    from tehl.studies import Outcome, Study
    from tehl.studies.pictures import Picture
    from tehl.studies.plan import Plan


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
    ] = [],  # noqa: B006 (typer reads the default, and nothing changes it)
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
    from tehl.studies.folder import check_same
    from tehl.studies.pictures import picture_of

    workers, pictures = _workers(jobs), tuple(picture_of(words) for words in plots)
    plan, folder = _plan(source, output, changes, unlimited=yes)
    _check_folder(folder, source)
    command = _Command(_study(plan, source), folder, workers, scheduler, as_json)
    if not replace or table_only or pictures:
        check_same(plan, folder)
    if dry_run:
        command.show_forecast()
    elif table_only or pictures:
        command.show_finished(pictures, whole=table_only)
    else:
        with _locked(folder):
            outcome = command.run(retry_failed=retry_failed, replace=replace, quiet=quiet)
            written = _write(command.table(), folder, plan.pictures)
        _show_outcome(outcome, written, as_json=as_json)
        if outcome.failed:
            raise typer.Exit(1)


def _workers(jobs: str | None) -> int:
    """Return the number of processes: as stated, or one per core of this process."""
    from tehl.errors import InputError

    if jobs is not None:
        number = int(jobs) if jobs.isascii() and jobs.isdigit() and len(jobs) < 7 else 0
        if number < 1:
            raise InputError(f"--jobs {jobs[:40]} must be a whole number of processes, 1 or more")
        return number
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return max(1, cores or 1)


def _plan(
    source: Path, output: Path | None, changes: list[str], *, unlimited: bool
) -> tuple["Plan", Path]:
    """Return the plan and the folder of the study."""
    from tehl.errors import InputError
    from tehl.studies.file import read_study
    from tehl.studies.folder import load_plan

    if not source.is_dir():
        folder = Path(source.stem) if output is None else output
        return read_study(source, changes, unlimited=unlimited), folder
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


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Make the folder and keep other runs out of it; remove it if nothing came of it."""
    from tehl.studies.folder import LOCK, check_can_write, locked

    check_can_write(folder)
    missing = [place for place in (folder, *folder.parents) if not place.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    with locked(folder):
        try:
            yield
        finally:
            if missing and {path.name for path in folder.iterdir()} <= {LOCK}:
                (folder / LOCK).unlink(missing_ok=True)
                for place in missing:
                    with suppress(OSError):
                        place.rmdir()


@dataclass(frozen=True, slots=True)
class _Command:
    """A study, where its files are, and where it is solved."""

    study: "Study"
    folder: Path
    jobs: int
    scheduler: str | None
    as_json: bool

    def show_forecast(self) -> None:
        from tehl.cli.progress import duration
        from tehl.studies.folder import store_of
        from tehl.studies.forecast import forecast

        cases, plan = self.study.cases, self.study.plan
        with closing(store_of(plan, self.folder)) as store:
            finished = store.finished(cases)
        found = forecast(cases, finished, jobs=self.jobs, fields=plan.keep == "fields")
        if self.as_json:
            typer.echo(json.dumps(asdict(found) | {"jobs": self.jobs}))
            return
        cpu, wall = duration(found.cpu_seconds), duration(found.wall_seconds)
        typer.echo(plan.title or "Study")
        typer.echo(f"  cases         {found.cases}, from {cases[0].name} to {cases[-1].name}")
        typer.echo(f"  to be solved  {found.open}")
        typer.echo(f"  time          about {wall} on {self.jobs} cores, {cpu} of computing")
        typer.echo(f"  disk          about {found.disk_bytes / 1e6:.3g} MB in {self.folder}")
        typer.echo(f"  memory        about {found.memory_bytes / 1e6:.3g} MB besides the program")

    def table(self) -> "pd.DataFrame":
        """Return the table of what is finished."""
        from tehl.studies import table
        from tehl.studies.folder import store_of

        with closing(store_of(self.study.plan, self.folder)) as store:
            return table(self.study.cases, store, self.study.units)

    def show_finished(self, pictures: tuple["Picture", ...], *, whole: bool) -> None:
        """Draw pictures of what is finished; write its ``whole`` table too."""
        from tehl.errors import InputError
        from tehl.studies.folder import check_can_write
        from tehl.studies.pictures import save
        from tehl.studies.tables import OPEN

        frame = self.table()
        if (frame["status"] == OPEN).all():
            raise InputError(f"no case of the study is finished yet in {self.folder}")
        check_can_write(self.folder)
        files = [str(save(one, frame, self.folder)) for one in pictures]
        if whole:
            written = _write(frame, self.folder, self.study.plan.pictures)
            files += [*written["table"], *written["pictures"]]
        counts = {str(key): int(n) for key, n in frame["status"].value_counts().items()}
        found = {"cases": len(frame), "status": counts, "files": files}
        typer.echo(json.dumps(found) if self.as_json else "\n".join(files))
        if whole and counts.keys() - {"converged", OPEN}:
            raise typer.Exit(1)

    def run(self, *, retry_failed: bool, replace: bool, quiet: bool) -> "Outcome":
        """Solve what is not finished; on an interrupt show how to continue."""
        from tehl.cli.progress import study_progress
        from tehl.studies import run
        from tehl.studies.folder import PLAN, check_same, remove_outcome, save_plan, store_of

        cases, plan = self.study.cases, self.study.plan
        with closing(store_of(plan, self.folder)) as store:
            self._check_resources(store.finished(cases))
            if replace:
                remove_outcome(self.folder)
            else:
                check_same(plan, self.folder)  # again, now that the folder is locked
            is_new = save_plan(plan, self.folder)
            try:
                with study_progress(quiet=quiet) as monitor:
                    return run(
                        cases,
                        store,
                        jobs=self.jobs,
                        scheduler=self.scheduler,
                        retry_failed=retry_failed,
                        warm_start=plan.warm_start,
                        forked=True,
                        monitor=monitor,
                    )
            except (KeyboardInterrupt, SystemExit, OSError):
                if store.exists:
                    scheduler = () if self.scheduler is None else ("--scheduler", self.scheduler)
                    again = shlex.join(["tehl", "study", str(self.folder), *scheduler])
                    typer.echo(f"tehl: finished cases are kept; continue with: {again}", err=True)
                elif is_new:
                    (self.folder / PLAN).unlink()
                raise

    def _check_resources(self, finished: dict[str, Any]) -> None:
        """Refuse workers that do not fit into the memory of this machine."""
        from tehl.studies.forecast import check_memory_of, forecast

        if self.scheduler is None:
            needs = forecast(self.study.cases, finished, jobs=self.jobs, fields=False)
            check_memory_of(needs, self.jobs)
        else:
            logging.disable()  # dask's own reports of a lost scheduler; ours is one sentence


def _write(
    frame: "pd.DataFrame", folder: Path, pictures: tuple["Picture", ...]
) -> dict[str, list[str]]:
    """Write table and pictures; return the files by kind. A picture that fails is a warning."""
    from tehl.errors import InputError
    from tehl.studies.folder import write_table
    from tehl.studies.pictures import save

    written = {"table": [str(path) for path in write_table(frame, folder)], "pictures": []}
    for picture in pictures:
        try:
            written["pictures"].append(str(save(picture, frame, folder)))
        except InputError as error:
            typer.echo(f"tehl: picture {Path(picture.file_name).stem}: {error}", err=True)
    return written


def _show_outcome(outcome: "Outcome", written: dict[str, list[str]], *, as_json: bool) -> None:
    from tehl.cli.progress import SHOWN, duration

    if as_json:
        words = ("status", "cause", "message", "hint")
        failed = [
            {"name": case.name} | {key: getattr(row, key) for key in words}
            for case, row in outcome.failed
        ]
        found = {
            "status": "not_converged" if failed else "converged",
            "cases": outcome.total,
            "reused": outcome.reused,
            "converged": outcome.converged,
            "failed": failed,
            "cpu_seconds": outcome.cpu_seconds,
            "wall_seconds": outcome.wall_seconds,
        }
        typer.echo(json.dumps(found | written))
        return
    typer.echo(
        f"{outcome.converged} of {outcome.total} cases converged, {outcome.reused} were finished "
        f"before; {duration(outcome.wall_seconds)}"
    )
    if outcome.uncertain:
        typer.echo(
            f"  {outcome.uncertain} of them with an uncertain minimum film: see the messages in "
            "the table"
        )
    for case, row in outcome.failed[:SHOWN]:
        typer.echo(f"  failed: {case.name}: {row.message or row.cause}")
    if len(outcome.failed) > SHOWN:
        typer.echo(f"  and {len(outcome.failed) - SHOWN} more, see the table")
    hints = Counter(row.hint for _, row in outcome.failed if row.hint)
    for hint, count in hints.most_common(SHOWN):
        typer.echo(f"  hint: {hint}" if count == 1 else f"  hint for {count} of them: {hint}")
    for path in (*written["table"], *written["pictures"]):
        typer.echo(f"written: {path}", err=True)
