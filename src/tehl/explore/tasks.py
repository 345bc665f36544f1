"""Longer jobs of the page: transient runs, files to download, measured surfaces."""

import io
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import Result, TransientResult
from tehl.base.errors import InputError
from tehl.base.lazy import lazy
from tehl.base.typing import Array, SingleArray
from tehl.contact.options import Options
from tehl.explore.jobs import Cycles, Desk, Note, with_stiffness
from tehl.explore.shown import Maps, maps_of
from tehl.plots.frame import window_part
from tehl.result.transient import StepReport
from tehl.roughness import Map
from tehl.roughness.preview import preview, view

if TYPE_CHECKING:
    from tehl import plots
    from tehl.api import solvers
    from tehl.report import page as pages
else:
    solvers = lazy("tehl.api.solvers")
    plots = lazy("tehl.plots")
    pages = lazy("tehl.report.page")


@dataclass(frozen=True, slots=True)
class Movie:
    """A transient run: its maps at the stored times, and numbers at each step."""

    maps: Maps
    """At time zero."""
    times: Array
    """Of the frames [us]."""
    film: SingleArray
    pressure: SingleArray
    """(frames, ny, nx) in the window [nm], [GPa]."""
    history: tuple[Array, Array, Array]
    """Time [us], central and minimum film [nm] at each step."""
    words: str


class Steps(Cycles):
    """Monitor of a transient run."""

    def step(self, report: StepReport) -> None:
        """Note a time step."""
        self.check()
        self.send(Note(f"step {report.step} of {report.steps}"))


@dataclass(frozen=True, slots=True)
class Transient:
    """Solve a transient case."""

    tables: dict[str, Any]

    def __call__(self, desk: Desk) -> Iterator[Movie]:
        """Yield the run."""
        problem, options = case_from_tables(self.tables)
        yield movie_of(_transient(problem, options, desk))


def _transient(problem: ContactProblem, options: Options, desk: Desk) -> TransientResult:
    desk.send(Note("the steady film at time zero"))
    found = solvers.solve_transient(problem, options, monitor=Steps(desk.connection, desk.send))
    if not isinstance(found, TransientResult):
        raise InputError("the film at the start did not converge")
    return found


def movie_of(run: TransientResult) -> Movie:
    """Return the frames of a transient run in the window around the contact."""
    rows, columns = window_part(run.start)
    frames, history = run.frames, run.history
    return Movie(
        maps=replace(maps_of(run.start), minimum=()),
        times=history.time[frames.step] * 1e6,
        film=(frames.film[:, rows, columns] * 1e9).astype(np.float32),
        pressure=(frames.pressure[:, rows, columns] * 1e-9).astype(np.float32),
        history=(history.time * 1e6, history.film_central * 1e9, history.film_minimum * 1e9),
        words=run.status.message or run.status.outcome,
    )


@dataclass(frozen=True, slots=True)
class Saved:
    """A file to download."""

    name: str
    content: bytes


@dataclass(frozen=True, slots=True)
class Export:
    """Solve a case, and make a file of the result.

    ``kind`` is "nc", "html", or the name and format of a picture such as "film.png".
    """

    tables: dict[str, Any]
    kind: str
    stem: str

    def __call__(self, desk: Desk) -> Iterator[Saved]:
        """Yield the file."""
        problem, options = case_from_tables(self.tables)
        if self.kind.startswith("dynamics."):
            problem = with_stiffness(self.tables)
        result: Result | TransientResult
        if problem.transient is None:
            result = desk.result(problem, options)
        else:
            result = _transient(problem, options, desk)
        desk.send(Note("writing the file"))
        yield Saved(f"{self.stem}.{self.kind.replace('film.', '')}", _content(result, self.kind))


def _content(result: Result | TransientResult, kind: str) -> bytes:
    if kind == "nc":
        with tempfile.TemporaryDirectory(prefix="tehl-") as folder:
            path = Path(folder) / "result.nc"
            result.save(path)
            return path.read_bytes()
    if kind == "html":
        return pages.report_text(result).encode("utf-8")

    name, _, ending = kind.partition(".")
    if isinstance(result, Result) and name == "stress" and result.stress is None:
        result = result.with_stress()
    pictures = plots.pictures_of(result)
    if isinstance(result, Result):
        pictures = pictures | plots.INTERFEROGRAMS
    draw = pictures.get(name) or next(iter(pictures.values()))
    buffer = io.BytesIO()
    draw(result).savefig(buffer, format=ending, dpi=200)
    return buffer.getvalue()


@dataclass(frozen=True, slots=True)
class Heights:
    """A measured surface before it is used."""

    x: Array
    y: Array
    values: Array
    """Places [um] and heights [nm]."""
    words: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Look:
    """Read and level a measured surface."""

    settings: dict[str, Any]

    def __call__(self, desk: Desk) -> Iterator[Heights]:
        """Yield the levelled heights."""
        del desk
        found = preview(Map(**self.settings))
        seen = view(found)
        # points of a preview along an axis
        rows, columns = (max(1, count // 220) for count in seen.values.shape)
        values = np.ascontiguousarray(seen.values[::rows, ::columns]) * 1e9
        (left, right), (bottom, top) = seen.window
        numbers_of = found.statistics
        size = found.heights.size
        yield Heights(
            x=np.linspace(left, right, values.shape[1]) * 1e6,
            y=np.linspace(bottom, top, values.shape[0]) * 1e6,
            values=values.astype(np.float32),
            words=(
                f"{size[0] * 1e6:.4g} × {size[1] * 1e6:.4g} µm, "
                f"{found.heights.values.shape[1]} × {found.heights.values.shape[0]} points",
                f"Sq = {numbers_of.sq * 1e9:.4g} nm, Sa = {numbers_of.sa * 1e9:.4g} nm, "
                f"Sz = {numbers_of.sz * 1e9:.4g} nm",
                *found.heights.notes,
                *found.sentences,
            ),
        )
