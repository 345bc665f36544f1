"""What a solve shows while it runs, on stderr: a live table, plain lines or nothing."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from rich.live import Live
    from rich.table import Table

    from tehl.result import CycleReport
    from tehl.solver.monitor import Monitor

_COLUMNS = (
    "grid",
    "cycle",
    "residual",
    "change",
    "load error",
    "H central",
    "H min",
    "sweeps",
)
_WARMING = "dT [K]"
"""Column of thermal runs: the largest change of the temperature in a cycle."""
COMPILE_SECONDS = 60
"""What compiling the kernels takes on a common machine, roughly."""


@contextmanager
def progress(*, quiet: bool, thermal: bool = False, coupled: bool = False) -> Iterator["Monitor"]:
    """Yield the monitor for a run: a table on a terminal, else lines; warn when kernels are cold.

    Parameters
    ----------
    quiet : bool
        Show nothing.
    thermal : bool
        Show how the temperature changes.
    coupled : bool
        The film is heated or thins in shear, which takes more kernels.
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
        yield Lines(thermal=thermal)
        return
    with _live(thermal=thermal) as monitor:
        yield monitor


class Lines:
    """A monitor that writes one plain line per cycle."""

    def __init__(self, *, thermal: bool = False) -> None:
        self._started, self._thermal = False, thermal

    def message(self, text: str) -> None:
        """Write ``text``."""
        typer.echo(text, err=True)

    def cycle(self, report: "CycleReport") -> None:
        """Write the numbers of a cycle, below a heading when it is the first."""
        if not self._started:
            typer.echo(_line(columns(thermal=self._thermal)), err=True)
            self._started = True
        typer.echo(_line(cells(report, thermal=self._thermal)), err=True)


class LiveTable:
    """A monitor that adds one row per cycle to a table on the terminal."""

    def __init__(self, table: "Table", live: "Live", *, thermal: bool) -> None:
        self._table, self._live, self._thermal = table, live, thermal
        self._grid: tuple[int, int] | None = None

    def message(self, text: str) -> None:
        """Write ``text`` above the table."""
        self._live.console.print(text, markup=False)

    def cycle(self, report: "CycleReport") -> None:
        """Add a row; a rule parts it from the row of another grid."""
        if self._grid not in (None, report.points):
            self._table.add_section()
        self._grid = report.points
        self._table.add_row(*cells(report, thermal=self._thermal))
        self._live.refresh()


@contextmanager
def _live(*, thermal: bool) -> Iterator[LiveTable]:
    from rich import box
    from rich.console import Console
    from rich.live import Live
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD)
    for name in columns(thermal=thermal):
        table.add_column(name, justify="left" if name == "sweeps" else "right")
    console = Console(stderr=True)
    with Live(table, console=console, auto_refresh=False, vertical_overflow="visible") as live:
        yield LiveTable(table, live, thermal=thermal)


def columns(*, thermal: bool) -> tuple[str, ...]:
    """Return the names of the columns."""
    return (*_COLUMNS[:-1], _WARMING, _COLUMNS[-1]) if thermal else _COLUMNS


def cells(report: "CycleReport", *, thermal: bool = False) -> tuple[str, ...]:
    """Return the numbers of a cycle as words, in the order of the columns."""
    warming = (f"{report.temperature_change:.2e}",) if thermal else ()
    return (
        "{} x {}".format(*report.points),
        str(report.cycle),
        f"{report.residual:.2e}",
        f"{report.change:.2e}",
        f"{report.load_error:.1e}",
        f"{report.film_central:.6f}",
        f"{report.film_minimum:.6f}",
        *warming,
        report.smoother,
    )


def _line(words: tuple[str, ...]) -> str:
    widths = (11, 6, 10, 12, 11, 10, 10, 9)
    numbers = zip(words[:-1], widths, strict=False)
    return " ".join(f"{word:>{width}}" for word, width in numbers) + f"  {words[-1]}"
