"""Receivers of the reports of a solve: protocols, and those that discard or record it."""

from typing import Protocol

from tehl.result.solution import CycleReport
from tehl.result.transient import StepReport


class Monitor(Protocol):
    """Receives the reports of a steady solve."""

    def message(self, text: str) -> None:
        """Receive a message for people."""

    def cycle(self, report: CycleReport) -> None:
        """Receive the report of one cycle."""


class StepMonitor(Monitor, Protocol):
    """Receives the reports of a transient run."""

    def step(self, report: StepReport) -> None:
        """Receive the report of one time step."""


class Silent(StepMonitor):
    """Discards all reports."""


SILENT = Silent()  # type: ignore[abstract]  # its methods are empty on purpose


class Recorder:
    """Records the reports of cycles, and passes everything on to ``monitor``."""

    def __init__(self, monitor: Monitor) -> None:
        self.reports: list[CycleReport] = []
        self._monitor = monitor
        self.message = monitor.message

    def cycle(self, report: CycleReport) -> None:
        """Record the report and pass it on."""
        self.reports.append(report)
        self._monitor.cycle(report)
