"""What a study shows while it runs, on stderr: a live view, plain lines or nothing."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress

    from tehl.studies import Case, Row, StudyMonitor

EVERY = 10.0
"""Seconds between two plain lines."""
SHOWN = 20
"""Failures that are told one by one."""


@contextmanager
def study_progress(*, quiet: bool) -> Iterator["StudyMonitor"]:
    """Yield the monitor for a study: a live view on a terminal, else lines."""
    import sys

    from tehl.studies.monitor import QUIET

    if quiet:
        yield QUIET
    elif sys.stderr is None or not sys.stderr.isatty():
        yield Lines()
    else:
        with _live() as monitor:
            yield monitor


class Tally:
    """Counts of a study, and what follows from them.

    Attributes
    ----------
    total, reused, done, failed : int
        Cases: all, finished before, finished now, and of those without an answer.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.total = self.reused = self.done = self.failed = 0
        self.clock, self.start = clock, clock()

    def begin(self, total: int, reused: int) -> None:
        """Take the number of cases."""
        self.total, self.reused, self.start = total, reused, self.clock()

    def count(self, row: "Row") -> None:
        """Count a finished case."""
        self.done += 1
        self.failed += not row.converged

    @property
    def open(self) -> int:
        """Cases still to be finished."""
        return self.total - self.reused - self.done

    @property
    def rate(self) -> float:
        """Cases per second of this run."""
        return self.done / max(self.clock() - self.start, 1e-9)

    @property
    def words(self) -> str:
        """The counts in a line."""
        text = f"{self.reused + self.done} of {self.total} cases"
        if self.done:
            text += f", {self.rate:.3g} per second, {duration(self.open / self.rate)} left"
        return f"{text}, {self.failed} without an answer" if self.failed else text


def duration(seconds: float) -> str:
    """Return a time in words: 40 s, 12 min, 3.5 h."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def failure(case: "Case", row: "Row") -> str:
    """Return the name of a case and why it has no answer."""
    cause = (row.cause or row.status).replace("_", " ")
    return f"no answer: {case.name}: {cause}"


class Lines:
    """A monitor that writes a plain line now and then, and one for each of the first failures."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.tally, self._told = Tally(clock), 0.0

    def message(self, text: str) -> None:
        """Write ``text``."""
        typer.echo(text, err=True)

    def begin(self, total: int, reused: int) -> None:
        """Write how many cases there are."""
        self.tally.begin(total, reused)
        self._told = self.tally.start
        typer.echo(f"{total} cases, {reused} of them finished before", err=True)

    def finished(self, case: "Case", row: "Row") -> None:
        """Count the case; write a line if it is time."""
        self.tally.count(row)
        if not row.converged and self.tally.failed <= SHOWN:
            typer.echo(failure(case, row), err=True)
        now = self.tally.clock()
        if now - self._told >= EVERY or not self.tally.open:
            self._told = now
            typer.echo(self.tally.words, err=True)


class Live:
    """A monitor that keeps one line on the terminal up to date."""

    def __init__(self, progress: "Progress") -> None:
        self._progress, self.tally = progress, Tally()
        self._task = progress.add_task("", total=None, words="")

    @property
    def console(self) -> "Console":
        """Where the line is."""
        return self._progress.console

    def message(self, text: str) -> None:
        """Write ``text`` above the line."""
        self.console.print(text, markup=False)

    def begin(self, total: int, reused: int) -> None:
        """Show how many cases there are."""
        self.tally.begin(total, reused)
        self._show()

    def finished(self, case: "Case", row: "Row") -> None:
        """Count the case, and name it if it has no answer."""
        self.tally.count(row)
        if not row.converged and self.tally.failed <= SHOWN:
            self.message(failure(case, row))
        self._show()

    def _show(self) -> None:
        done = self.tally.reused + self.tally.done
        self._progress.update(
            self._task, total=self.tally.total, completed=done, words=self.tally.words
        )


@contextmanager
def _live() -> Iterator[Live]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    columns = (BarColumn(bar_width=20), TextColumn("{task.fields[words]}"))
    with Progress(*columns, console=Console(stderr=True), refresh_per_second=4) as progress:
        yield Live(progress)
