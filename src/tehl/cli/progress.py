"""What a run shows on stderr: a live view on a terminal, plain lines elsewhere, or nothing."""

import math
import sys
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any

import typer
from rich import box
from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.markup import escape
from rich.progress import BarColumn, Progress, ProgressColumn, Task, TextColumn
from rich.progress_bar import ProgressBar
from rich.table import Column, Table
from rich.text import Text

from tehl.base.wording import duration
from tehl.cli.lazily import kernel_cache, monitors, runner, scaling, warmup

if TYPE_CHECKING:
    from tehl.contact.problem import ContactProblem
    from tehl.estimate.scaling import Scales
    from tehl.kernels.warmup import Progress as CompileProgress
    from tehl.result.solution import CycleReport
    from tehl.result.transient import StepReport
    from tehl.studies import Case, Row, StudyMonitor

Columns = dict[str, tuple[int, str]]
"""By heading: the width, and the words, a template for a report and other numbers."""
_HEAT = "dT [K]"
"""Column of heated films: the largest change of the temperature in a cycle."""
_CYCLE: Columns = {
    "grid": (11, "{0.points[0]} x {0.points[1]}"),
    "cycle": (5, "{0.cycle}"),
    "residual": (8, "{0.residual:.2e}"),
    "change": (8, "{0.change:.2e}"),
    "load err": (8, "{0.load_error:.1e}"),
    "H cent": (8, "{0.film_central:.6f}"),
    "H min": (8, "{0.film_minimum:.6f}"),
    _HEAT: (8, "{0.temperature_change:.2e}"),
    "sweeps": (7, "{0.smoother}"),
}
_STEP: Columns = {
    "step": (9, "{0.step}/{0.steps}"),
    "time [us]": (9, "{time:.1f}"),
    "cycles": (6, "{0.cycles}"),
    "change": (7, "{0.change:.1e}"),
    "h min [nm]": (10, "{minimum:.1f}"),
    "h cent [nm]": (11, "{central:.1f}"),
    "p max [GPa]": (11, "{pressure:.4f}"),
    "left [s]": (8, "{left}"),
}
_SILENT = 2.0
"""Seconds after which a live view that does not change shows the time."""
MOST_NAMED_CASES = 20
"""Failed cases that are named."""


@contextmanager
def progress(problem: "ContactProblem", *, quiet: bool) -> Iterator[Any]:
    """Yield the monitor of a solve: a row per multigrid cycle, of a transient run per time step."""
    if quiet:
        yield monitors.SILENT
        return
    compile_kernels(coupled=problem.is_coupled)
    shown: Callable[[_Ticking | None], Any]
    if problem.transient is None:
        shown = partial(_CycleProgress, thermal=problem.thermal is not None)
    else:
        shown = partial(_StepProgress, units=scaling.scales(problem))
    if not _is_terminal():
        yield shown(None)
        return
    view, console = _Ticking(), Console(stderr=True)
    with Live(view, console=console, refresh_per_second=1, vertical_overflow="visible") as live:
        view.live = live
        try:
            yield shown(view)
        finally:
            view.stop()


@contextmanager
def busy(what: str, *, quiet: bool) -> Iterator[None]:
    """Show on a terminal that ``what`` is being done."""
    if quiet or not _is_terminal():
        yield
    else:
        with Console(stderr=True).status(escape(what)):
            yield


@contextmanager
def study_progress(
    expected: Mapping[str, float] | None = None, *, quiet: bool
) -> Iterator["StudyMonitor"]:
    """Yield the monitor of a study: a bar, or a line now and then; ``expected`` as below."""
    if quiet:
        yield runner.QUIET
    elif not _is_terminal():
        yield StudyProgress(None, expected)
    else:
        columns = (BarColumn(bar_width=20), TextColumn("{task.description}"))
        with Progress(*columns, console=Console(stderr=True), refresh_per_second=4) as bar:
            yield StudyProgress(bar, expected)


def compile_kernels(*, coupled: bool) -> None:
    """Compile the kernels that are not in the cache, and show which, and how long it takes.

    Parameters
    ----------
    coupled : bool
        Include the kernels of heated and shear-thinning films.
    """
    if not kernel_cache.is_cold(coupled=coupled):
        return

    if not _is_terminal():
        typer.echo("compiling the kernels once, which takes 10 to 60 s", err=True)
        warmup.warm_up(coupled=coupled)
        return
    # characters beside a bar of 20 and the time left, in a line of 80
    beside = Column(no_wrap=True, overflow="ellipsis", max_width=47)
    words = TextColumn("{task.description}", table_column=beside)
    columns = (BarColumn(bar_width=20), _CountDown(), words)
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=None)

        def report(now: "CompileProgress") -> None:
            words = f"compiling once, {now.done} of {now.total} done, now {', '.join(now.names)}"
            end = time.monotonic() + now.seconds_left
            bar.update(task, total=now.total, completed=now.done, description=words, end=end)

        warmup.warm_up(coupled=coupled, report=report)


class _CountDown(ProgressColumn):
    """The time until the task's field ``end``."""

    def render(self, task: Task) -> Text:
        """Return the time left, empty before the first report."""
        end = task.fields.get("end")
        return Text("" if end is None else f"{max(end - time.monotonic(), 0.0):.0f} s left")


def _is_terminal() -> bool:
    return sys.stderr is not None and sys.stderr.isatty()


class _Ticking:
    """A live view above the time since it last changed: a sweep of a large grid takes a while."""

    live: Live

    def __init__(self) -> None:
        self._view: RenderableType = ""
        self._since = time.monotonic()

    def __rich__(self) -> RenderableType:
        seconds = time.monotonic() - self._since
        if not _SILENT < seconds < math.inf:
            return self._view
        return Group(self._view, Text(f"working, {seconds:.0f} s"))

    @property
    def console(self) -> Console:
        """The console of the view."""
        return self.live.console

    def update(self, view: RenderableType) -> None:
        """Show another view at once."""
        self._view, self._since = view, time.monotonic()
        self.live.refresh()

    def stop(self) -> None:
        """Show no more time."""
        self._since = -math.inf


class _Shown:
    """Messages and rows on stderr: in a live view if there is one, else as plain lines."""

    def __init__(self, view: Any, columns: Columns) -> None:  # of rich, or None
        self._view, self._columns = view, columns

    def message(self, text: str) -> None:
        """Show a message, above the live view."""
        if self._view is None:
            typer.echo(text, err=True)
        else:
            self._view.console.print(text, markup=False)

    def _cells(self, *reports: object, **numbers: object) -> list[str]:
        return [words.format(*reports, **numbers) for _, words in self._columns.values()]

    def _line(self, cells: Iterable[str]) -> None:
        widths = (width for width, _ in self._columns.values())
        self.message(" ".join(f"{c:>{width}}" for c, width in zip(cells, widths, strict=True)))

    def _table(self) -> Table:
        table = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False)
        for name, (width, _) in self._columns.items():
            table.add_column(escape(name), justify="right", min_width=width)
        return table


class _CycleProgress(_Shown):
    def __init__(self, live: _Ticking | None, *, thermal: bool = False) -> None:
        super().__init__(live, {k: v for k, v in _CYCLE.items() if thermal or k != _HEAT})
        self._rows = None if live is None else self._table()
        self._grid: tuple[int, int] | None = None

    def cycle(self, report: "CycleReport") -> None:
        """Show a cycle: the first below a heading, the first of each finer grid below a rule."""
        if self._rows is None:
            if self._grid is None:
                self._line(self._columns)
            self._line(self._cells(report))
        else:
            if self._grid not in (None, report.points):
                self._rows.add_section()
            self._rows.add_row(*self._cells(report))
            self._view.update(self._rows)
        self._grid = report.points


class _StepProgress(_Shown):
    def __init__(self, live: _Ticking | None, units: "Scales") -> None:
        super().__init__(live, _STEP)
        self._units = units
        self._rows: deque[list[str]] = deque(maxlen=10)
        self._first: tuple[int, float] | None = None
        self._part: int | None = None
        self._steady = False

    def cycle(self, report: "CycleReport") -> None:
        """Show that the steady film at time zero is being solved."""
        if self._view is not None:
            state = "{0.points[0]} x {0.points[1]}, cycle {0.cycle}, {0.residual:.1e}"
            self._view.update(f"steady film at time zero: {state.format(report)}")
        elif not self._steady:
            self.message("the steady film at time zero")
        self._steady = True

    def step(self, report: "StepReport") -> None:
        """Show a step in the live view, or as a plain line once per twentieth of the run."""
        film, left = self._units.film_thickness * 1e9, self._left(report)
        cells = self._cells(
            report,
            time=report.time * 1e6,
            minimum=report.film_minimum * film,
            central=report.film_central * film,
            pressure=report.pressure_max * self._units.hertz_pressure * 1e-9,
            left="" if left is None else f"{left:.0f}",
        )
        part = report.step * 20 // report.steps
        if self._view is not None:
            self._rows.append(cells)
            self._show(report)
        elif part != self._part:
            if self._part is None:
                self._line(self._columns)
            self._line(cells)
        self._part = part

    def _show(self, report: "StepReport") -> None:
        table = self._table()
        for row in self._rows:
            table.add_row(*row)
        bar = ProgressBar(total=report.steps, completed=report.step, width=60)
        self._view.update(Group(table, bar))

    def _left(self, report: "StepReport") -> float | None:
        """Return the seconds that are left, from the steps since the first; None at that one."""
        now = time.monotonic()
        if self._first is None or report.step <= self._first[0]:  # the first, or of another run
            self._first = (report.step, now)
            return None
        step, then = self._first
        return (now - then) / (report.step - step) * (report.steps - report.step)


class StudyProgress(_Shown):
    """The monitor of a study; counts all cases, those finished before and now, and failed now.

    Parameters
    ----------
    bar : Progress or None
        Where they are shown; None is on plain lines.
    expected : mapping or None
        CPU seconds of the open cases to expect, by key: their ratios decide what is left. None
        takes all for equal.
    clock : callable
        Returns the seconds now.
    """

    def __init__(
        self,
        bar: Progress | None,
        expected: Mapping[str, float] | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(bar, {})
        self._expected = dict(expected or {})
        self._usual = sum(self._expected.values()) / len(self._expected) if expected else 1.0
        self._worked = self._work = 0.0
        self.total = self.reused = self.done = self.failed = 0
        self._clock = clock
        self._start = self._last = clock()
        self._task = None if bar is None else bar.add_task("", total=None)

    def begin(self, total: int, reused: int) -> None:
        """Show the number of cases."""
        self.total, self.reused = total, reused
        known = self._expected.values()
        self._work = sum(known) + self._usual * max(self.open - len(known), 0)
        self._start = self._last = self._clock()
        if self._task is None:
            self.message(f"{total} cases, {reused} of them finished before")
        self._show()

    def finished(self, case: "Case", row: "Row") -> None:
        """Count a case, and name it if it failed."""
        self.done += 1
        self._worked += self._expected.get(case.key, self._usual)
        self.failed += not row.converged
        if not row.converged and self.failed <= MOST_NAMED_CASES:
            cause = (row.cause or row.status).replace("_", " ")
            self.message(f"failed: {case.name}: {cause}")
        now = self._clock()
        # plain lines are 10 s apart
        if self._task is None and (now - self._last >= 10.0 or not self.open):
            self._last = now
            self.message(self.counts)
        self._show()

    def _show(self) -> None:
        if self._task is not None:
            done = self.total - self.open
            self._view.update(self._task, total=self.total, completed=done, description=self.counts)

    @property
    def open(self) -> int:
        """Cases that are not finished."""
        return self.total - self.reused - self.done

    @property
    def counts(self) -> str:
        """The counts in a line."""
        text = f"{self.total - self.open} of {self.total} cases"
        if self.done:
            rate = self.done / max(self._clock() - self._start, 1e-9)
            text += f", {rate:.3g} per second"
        if self.done >= runner.LEAST_FINISHED:
            pace = (self._clock() - self._start) / self._worked
            text += f", {duration(pace * max(self._work - self._worked, 0.0))} left"
        return f"{text}, {self.failed} failed" if self.failed else text
