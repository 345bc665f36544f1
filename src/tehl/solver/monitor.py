"""Who is told what while the solver runs."""

from typing import Protocol

from tehl.result import CycleReport
from tehl.transient_result import StepReport


class Monitor(Protocol):
    """What a solve reports to."""

    def message(self, text: str) -> None:
        """Take a remark for people."""
        ...

    def cycle(self, report: CycleReport) -> None:
        """Take the report of one cycle."""
        ...


class StepMonitor(Monitor, Protocol):
    """What a transient run reports to."""

    def step(self, report: StepReport) -> None:
        """Take the report of one step of time."""
        ...


class Silent:
    """Nobody is told anything."""

    def message(self, text: str) -> None:
        """Drop the remark."""

    def cycle(self, report: CycleReport) -> None:
        """Drop the report."""

    def step(self, report: StepReport) -> None:
        """Drop the report."""


SILENT = Silent()
