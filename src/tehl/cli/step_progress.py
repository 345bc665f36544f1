"""What a transient run shows while it goes on, on stderr: a live table, plain lines or nothing."""

import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer

from tehl.cli.progress import COMPILE_SECONDS

if TYPE_CHECKING:
    from rich.console import Group
    from rich.live import Live

    from tehl.result import CycleReport
    from tehl.scaling import Scales
    from tehl.solver.monitor import StepMonitor
    from tehl.transient_result import StepReport

COLUMNS = ("step", "time [us]", "cycles", "change", "h min [nm]", "h cent [nm]", "p max [GPa]")
LEFT = "left [s]"
"""Last column: what the run still takes, by the clock."""
LINES = 20
"""Plain lines of a run."""
ROWS = 10
"""Steps that the live table shows."""


class Clock:
    """Estimates how long a run still takes, from the steps that it has watched."""

    def __init__(self) -> None:
        self._first: tuple[int, float] | None = None

    def left(self, report: "StepReport") -> float | None:
        """Return the seconds that are left after a step, None at the first one."""
        now = time.monotonic()
        if self._first is None or report.step <= self._first[0]:  # the first, or of another run
            self._first = (report.step, now)
            return None
        step, then = self._first
        return (now - then) / (report.step - step) * (report.steps - report.step)


def cells(report: "StepReport", units: "Scales", left: float | None) -> tuple[str, ...]:
    """Return the numbers of a step as words, in the order of the columns."""
    film, pressure = units.film_thickness * 1e9, units.hertz_pressure * 1e-9
    return (
        f"{report.step}/{report.steps}",
        f"{report.time * 1e6:.1f}",
        str(report.cycles),
        f"{report.change:.1e}",
        f"{report.film_minimum * film:.1f}",
        f"{report.film_central * film:.1f}",
        f"{report.pressure_max * pressure:.4f}",
        "" if left is None else f"{left:.0f}",
    )


@contextmanager
def step_progress(
    units: "Scales", *, quiet: bool, coupled: bool = False
) -> Iterator["StepMonitor"]:
    """Yield the monitor for a transient run; warn when kernels are cold.

    Parameters
    ----------
    units : Scales
        Of the film and the pressure.
    quiet : bool
        Show nothing.
    coupled : bool
        The film thins in shear, which takes more kernels.
    """
    import sys

    from tehl.kernels.cache import is_cold
    from tehl.solver.monitor import SILENT

    if quiet:
        yield SILENT
        return
    if is_cold(coupled=coupled):
        typer.echo(f"compiling once, about {COMPILE_SECONDS} s", err=True)
    if sys.stderr is None or not sys.stderr.isatty():
        yield StepLines(units)
        return
    from rich.console import Console
    from rich.live import Live

    with Live(console=Console(stderr=True), auto_refresh=False) as live:
        yield LiveSteps(units, live)


class StepLines:
    """A monitor that writes about twenty plain lines in a run."""

    def __init__(self, units: "Scales") -> None:
        self._units, self._clock = units, Clock()
        self._part: int | None = None
        self._steady = False

    def message(self, text: str) -> None:
        """Write ``text``."""
        typer.echo(text, err=True)

    def cycle(self, report: "CycleReport") -> None:
        """Say once that the steady film of the beginning is being found."""
        del report
        if not self._steady:
            typer.echo("the steady film at time zero", err=True)
        self._steady = True

    def step(self, report: "StepReport") -> None:
        """Write the numbers of a step, unless the last line is too near."""
        left, part = self._clock.left(report), report.step * LINES // report.steps
        if self._part is None:
            typer.echo(_line((*COLUMNS, LEFT)), err=True)
        elif part == self._part:
            return
        self._part = part
        typer.echo(_line(cells(report, self._units, left)), err=True)


class LiveSteps:
    """A monitor that shows the last steps and a bar on the terminal."""

    def __init__(self, units: "Scales", live: "Live") -> None:
        self._units, self._live, self._clock = units, live, Clock()
        self._rows: deque[tuple[str, ...]] = deque(maxlen=ROWS)

    def message(self, text: str) -> None:
        """Write ``text`` above the table."""
        self._live.console.print(text, markup=False)

    def cycle(self, report: "CycleReport") -> None:
        """Show where the steady film of the beginning is."""
        from rich.text import Text

        nodes = "{} x {}".format(*report.points)
        text = f"steady film at time zero: {nodes}, cycle {report.cycle}, {report.residual:.1e}"
        self._live.update(Text(text), refresh=True)

    def step(self, report: "StepReport") -> None:
        """Add the numbers of a step."""
        self._rows.append(cells(report, self._units, self._clock.left(report)))
        self._live.update(self._table(report.step, report.steps), refresh=True)

    def _table(self, step: int, steps: int) -> "Group":
        from rich import box
        from rich.console import Group
        from rich.progress_bar import ProgressBar
        from rich.table import Table

        table = Table(box=box.SIMPLE_HEAD)
        for name in (*COLUMNS, LEFT):
            table.add_column(name, justify="right")
        for row in self._rows:
            table.add_row(*row)
        return Group(table, ProgressBar(total=steps, completed=step, width=60))


def _line(words: tuple[str, ...]) -> str:
    widths = (11, 11, 7, 9, 11, 12, 12, 9)
    return " ".join(f"{word:>{width}}" for word, width in zip(words, widths, strict=True))
