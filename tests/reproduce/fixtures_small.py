"""A small reproduction, made once: the paper's grid is what it is, the fine grids are coarse."""

from pathlib import Path

import pytest

from tehl.reproduce.book import Book
from tehl.reproduce.everything import Place, reproduce
from tehl.reproduce.wishes import wishes

POINTS = 65
NAMES = ("T1", "T2", "F3", "F7")
SLIDING = ("T3", "C4", "C5", "P0", "P2")


class Heard:
    """What a run of the command has told."""

    def __init__(self) -> None:
        self.total = self.reused = self.finished_now = 0

    def message(self, text: str) -> None:
        """Drop the remark."""

    def begin(self, total: int, reused: int) -> None:
        """Keep the numbers."""
        self.total, self.reused = total, reused

    def finished(self, case: object, row: object) -> None:
        """Count the case."""
        del case, row
        self.finished_now += 1


@pytest.fixture(scope="session")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a small reproduction."""
    folder = tmp_path_factory.mktemp("reproduced")
    reproduce(folder, only=NAMES, points=POINTS, jobs=1)
    return folder


@pytest.fixture(scope="session")
def sliding(tmp_path_factory: pytest.TempPathFactory) -> Book:
    """Return the book of the contacts in which sliding varies, on small grids."""
    folder = tmp_path_factory.mktemp("sliding")
    reproduce(folder, only=SLIDING, points=POINTS, jobs=2)
    return book_of(folder, SLIDING)


def book_of(folder: Path, names: tuple[str, ...] = NAMES) -> Book:
    """Return the book of a small reproduction."""
    return Place(str(folder), POINTS, wishes(names).series).book()
