"""Solve, draw, judge and write: the whole paper or parts of it."""

import difflib
import multiprocessing
import os
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from itertools import repeat
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from paper.conclusions import CONCLUSIONS
from paper.draw import draw
from paper.figures import FIGURES
from paper.page import Report, html, pages
from paper.runs import SERIES, Runs
from paper.tables import SERIES_OF, make_table
from tehl import InputError, Options
from tehl.studies import Outcome, run, table

NAMES = (*SERIES_OF, *FIGURES, *CONCLUSIONS)
"""Tables, figures and conclusions, in the order of the paper."""


def choose(names: Iterable[str] = ()) -> tuple[str, ...]:
    """Return what names such as "T2", "f7" or "C4" stand for, all if there are none.

    Raises
    ------
    InputError
        If there is no such table, figure or conclusion.
    """
    wanted = [name.strip().upper() for name in names]
    for name in wanted:
        if name not in NAMES:
            near = difflib.get_close_matches(name, NAMES, n=1, cutoff=0.5)
            guess = f"did you mean {near[0]}? " if near else ""
            raise InputError(
                f"{name or '(nothing)'} is not a table, figure or conclusion: {guess}known are T1 "
                "to T3, F1 to F24, X1 to X4 (added figures), C1 to C5, P0 to P3 (added statements)"
            )
    return tuple(name for name in NAMES if not wanted or name in wanted)


def needed_series(names: Iterable[str]) -> tuple[str, ...]:
    """Return the series that tables, figures and conclusions need."""
    needed: set[str] = set()
    for name in names:
        if name in FIGURES:
            needed |= {FIGURES[name].series, *FIGURES[name].also}
        else:
            needed |= set(SERIES_OF[name] if name in SERIES_OF else CONCLUSIONS[name][1])
    return tuple(name for name in SERIES if name in needed)


def reproduce(
    directory: str | Path,
    names: Iterable[str] = (),
    *,
    points: int | None = None,
    jobs: int | None = None,
    **options: Any,
) -> tuple[Path, Outcome]:
    """Reproduce the paper into a folder; solved cases are kept there and not solved again.

    Parameters
    ----------
    directory : str or Path
        Folder of results, figures and pages; made if it is missing.
    names : iterable of str
        Tables, figures and conclusions; all if left out.
    points : int or None
        Nodes per direction of the fine grids, in place of those of the study files.
    jobs : int or None
        Processes; one per processor if left out.
    **options
        Of :func:`tehl.studies.run`, such as ``monitor``.

    Returns
    -------
    page : Path
        ``index.html``.
    outcome : Outcome
        What was solved.

    Raises
    ------
    InputError
        If a name is unknown, the grid cannot be coarsened, or the folder cannot be written.
    """
    chosen, folder, jobs = choose(names), Path(directory), jobs or os.cpu_count() or 1
    if points is not None:
        _check(points)
    runs = Runs(folder, needed_series(chosen), points)
    outcome = run(runs.cases, runs.store, jobs=jobs, **options)
    (folder / "figures").mkdir(parents=True, exist_ok=True)
    figures = [name for name in chosen if name in FIGURES]
    _draw(figures, runs, folder, points, jobs)
    report = Report(
        runs,
        [make_table(name, runs) for name in chosen if name in SERIES_OF],
        [(FIGURES[name], FIGURES[name].verdict(runs)) for name in figures],
        [CONCLUSIONS[name][0](name, runs) for name in chosen if name in CONCLUSIONS],
    )
    for name, text in (pages(report) | {"index.html": html(report, folder)}).items():
        (folder / name).write_text(text, encoding="utf-8")
    table(runs.cases, runs.store).to_csv(folder / "runs.csv", index=False)
    return folder / "index.html", outcome


def _check(points: int) -> None:
    try:
        Options(points=points)
    except ValidationError as error:
        why = error.errors()[0]["msg"].removeprefix("Value error, ")
        raise InputError(f"--points {points}: {why}") from None


def _draw(names: list[str], runs: Runs, folder: Path, points: int | None, jobs: int) -> None:
    """Draw figures, in processes of their own if there are several jobs.

    Parameters
    ----------
    names : list of str
        Which.
    runs : Runs
        Those of all figures.
    folder : Path
        Of the reproduction.
    points, jobs : int or None, int
        As in `reproduce`.
    """
    if min(jobs, len(names)) <= 1:
        for name in names:
            draw(FIGURES[name], runs, folder / "figures")
        return
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(jobs, len(names)), mp_context=context) as pool:
        list(pool.map(_draw_figure, names, repeat(folder), repeat(points)))


def _draw_figure(name: str, folder: Path, points: int | None) -> None:
    """Draw a figure from the results in ``folder``, in a process of its own."""
    figure = FIGURES[name]
    draw(figure, Runs(folder, [figure.series], points), folder / "figures")
