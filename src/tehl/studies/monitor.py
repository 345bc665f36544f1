"""Who is told what while a study runs."""

from typing import Protocol

from tehl.studies.case import Case
from tehl.studies.row import Row


class StudyMonitor(Protocol):
    """What a study reports to."""

    def message(self, text: str) -> None:
        """Take a remark for people."""
        ...

    def begin(self, total: int, reused: int) -> None:
        """Take the number of cases, and how many of them were finished before."""
        ...

    def finished(self, case: Case, row: Row) -> None:
        """Take a case that has just been finished."""
        ...


class Quiet:
    """Nobody is told anything."""

    def message(self, text: str) -> None:
        """Drop the remark."""

    def begin(self, total: int, reused: int) -> None:
        """Drop the numbers."""

    def finished(self, case: Case, row: Row) -> None:
        """Drop the case."""


QUIET = Quiet()
