"""Everything in one go: solve what is missing, draw, judge, write."""

import multiprocessing
import os
import time
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from tehl.errors import InputError
from tehl.io.atomic import check_folder, replacing
from tehl.options import Options
from tehl.reproduce.book import Book
from tehl.reproduce.figures import FigureSpec, figures
from tehl.reproduce.findings import Findings, findings
from tehl.reproduce.series import all_series, runs_of
from tehl.reproduce.wishes import wishes
from tehl.studies import Store, StudyMonitor, run, table
from tehl.studies.runner import QUIET

CASES, MEASURES, FIGURES = "cases", "measures", "figures"
"""Folders of the results, of what was measured in them, and of the figures."""
_CHUNK = 8
"""Results measured by one task."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where the results are, for a process of its own.

    Attributes
    ----------
    directory : str
        The folder of everything.
    points : int or None
        Nodes of the fine grids, where they were asked for.
    series : tuple of str
        Names of the series that were computed.
    """

    directory: str
    points: int | None
    series: tuple[str, ...]

    def book(self) -> Book:
        """Return the book of what is there."""
        known, folder = all_series(), Path(self.directory)
        store = Store(folder / CASES, keep="fields")
        runs = [run for name in self.series for run in runs_of(known[name], self.points)]
        return Book(store, known, runs, folder / MEASURES)


def reproduce(
    directory: str | Path,
    *,
    only: Iterable[str] = (),
    points: int | None = None,
    jobs: int | None = None,
    monitor: StudyMonitor = QUIET,
) -> Path:
    """Reproduce the founding paper into a folder; return its page.

    What was solved before is not solved again: a second run only draws and judges.

    Parameters
    ----------
    directory : str or Path
        Folder of results, figures and page; made if it is missing.
    only : iterable of str
        Names of tables, figures or statements; all if left out.
    points : int or None
        Nodes per direction of all fine grids, in place of those of the series files.
    jobs : int or None
        Processes; as many as there are processors if left out.
    monitor : StudyMonitor
        Told how far it is.

    Returns
    -------
    Path
        The page, ``index.html``.

    Raises
    ------
    InputError
        If a name is not known, the grid cannot be, or the folder cannot be written.
    """
    start = time.perf_counter()
    wanted, jobs = wishes(only), jobs or os.cpu_count() or 1
    folder = Path(directory)
    _check(folder, points)
    place = Place(str(folder), points, wanted.series)
    book = place.book()
    outcome = run((one.case for one in book.runs), book.store, jobs=jobs, monitor=monitor)
    monitor.message("measuring")
    _measure(place, book, jobs)
    monitor.message("drawing")
    _draw(place, wanted.figures, jobs)
    _book.cache_clear()
    book = place.book()
    found = findings(book, wanted, seconds=time.perf_counter() - start, reused=outcome.reused)
    return _write(folder, book, found)


def _check(folder: Path, points: int | None) -> None:
    check_folder(folder)
    if points is not None:
        try:
            Options(points=points)
        except ValueError as error:
            why = str(error.errors()[0]["msg"]) if hasattr(error, "errors") else str(error)
            raise InputError(f"--points {points}: {why.removeprefix('Value error, ')}") from None
    folder.mkdir(parents=True, exist_ok=True)


def _measure(place: Place, book: Book, jobs: int) -> None:
    """Measure what was not measured yet, several results at a time."""
    todo = [n for n, one in enumerate(book.runs) if not book.is_measured(one)]
    if todo:
        chunks = [todo[k : k + _CHUNK] for k in range(0, len(todo), _CHUNK)]
        _all(jobs, [(measure_some, place, tuple(chunk)) for chunk in chunks])


def measure_some(place: Place, numbers: tuple[int, ...]) -> None:
    """Measure some of the runs, for a process of its own."""
    book = place.book()
    for number in numbers:
        book.measures(book.runs[number])


def _draw(place: Place, specs: tuple[FigureSpec, ...], jobs: int) -> None:
    _all(jobs, [(draw_one, place, spec.name) for spec in specs])


def draw_one(place: Place, name: str) -> None:
    """Draw one figure, for a process of its own."""
    from tehl.reproduce.draw.gallery import draw  # noqa: PLC0415 (a second of import)

    draw(figures()[name], _book(place), Path(place.directory) / FIGURES)


@lru_cache(maxsize=1)
def _book(place: Place) -> Book:
    """Return the book of a process that draws: figures of a series share their results."""
    return place.book()


def _all(jobs: int, tasks: list[tuple[Any, ...]]) -> None:
    """Do all tasks, in processes of their own if there are several jobs."""
    workers = min(jobs, len(tasks))
    if workers <= 1:
        for work, *arguments in tasks:
            work(*arguments)
        return
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(workers, mp_context=context) as pool:
        futures = [pool.submit(*task) for task in tasks]
        try:
            for future in as_completed(futures):
                future.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _write(folder: Path, book: Book, found: Findings) -> Path:
    """Write the page, the same as Markdown, and the numbers of all runs."""
    from tehl.reproduce.page import page  # noqa: PLC0415
    from tehl.reproduce.text import text  # noqa: PLC0415

    texts = {
        "index.html": page(found, folder / FIGURES),
        "reproduce.md": text(found),
        "runs.csv": table([one.case for one in book.runs], book.store).to_csv(index=False),
    }
    for name, content in texts.items():
        with replacing(folder / name) as temporary:
            temporary.write_text(content, encoding="utf-8")
    return folder / "index.html"
