"""Who is told what while the solver runs."""

from typing import Protocol

from tehl.result import CycleReport


class Monitor(Protocol):
    """What a solve reports to."""

    def message(self, text: str) -> None:
        """Take a remark for people."""
        ...

    def cycle(self, report: CycleReport) -> None:
        """Take the report of one cycle."""
        ...


class Silent:
    """Nobody is told anything."""

    def message(self, text: str) -> None:
        """Drop the remark."""

    def cycle(self, report: CycleReport) -> None:
        """Drop the report."""


SILENT = Silent()
