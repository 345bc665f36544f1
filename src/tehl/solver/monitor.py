"""Receivers of the reports of a solve: protocols, and those that discard, record or end it."""

import time
from typing import Protocol

from tehl.base.errors import TehlError
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


class TimeIsOverError(TehlError):
    """A solve has taken the time that it was given."""


class Deadline:
    """Passes everything on to ``monitor``; ends the solve at the first cycle after ``seconds``."""

    def __init__(self, monitor: Monitor, seconds: float) -> None:
        self._monitor, self._end = monitor, time.perf_counter() + seconds
        self.message = monitor.message

    def cycle(self, report: CycleReport) -> None:
        """Pass the report on; raise TimeIsOverError if the time is over."""
        self._monitor.cycle(report)
        if time.perf_counter() > self._end:
            raise TimeIsOverError("the time is over")
