"""A transient run as a moving picture: the film from above, and the line y = 0 below."""

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, HTMLWriter
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tehl.errors import InputError
from tehl.io.atomic import replacing
from tehl.plots.frame import MICRO, colour_axes, dress_contact, span_part, window
from tehl.plots.transient import CentreLines, time_unit, transient_figure
from tehl.transient_result import TransientResult
from tehl.typing import Array, IntArray

FORMATS = (".gif", ".mp4", ".html")
"""Endings of moving pictures."""
MOST = 200
"""Moments of a moving picture that shows the line y = 0 alone."""
_UPPER, _LOWER = (0.13, 0.41, 0.69, 0.51), (0.13, 0.07, 0.75, 0.255)
"""Places of map and lines in the picture."""
_LARGEST_PAGE = 200.0
"""Size of the pictures in a page [MB]."""


def animate(
    run: TransientResult, path: str | Path, *, per_second: int = 10, dpi: int = 100
) -> None:
    """Write a transient run as a moving picture; whole, or not at all.

    It shows the fields that the run has kept (``transient.frames``): film thickness, and below it
    film, pressure and the rough body along y = 0. A run that has kept fewer than two shows that
    line at all steps.

    Parameters
    ----------
    run : TransientResult
        What to show.
    path : str or Path
        The file, whose ending says the format: ``.gif``, ``.html`` (a page with buttons, without
        other files) or ``.mp4``, for which the program ffmpeg has to be installed.
    per_second : int
        Moments shown in a second.
    dpi : int
        Dots per inch.

    Raises
    ------
    InputError
        If the ending is of no known format, ffmpeg is missing, or the file cannot be written.
    """
    ending = check_format(path)
    if not per_second > 0:
        raise InputError(f"per_second = {per_second} must be positive: 10 moments are usual")
    movie = Movie(run, dpi=dpi)
    with replacing(path) as temporary:
        made = temporary.with_suffix(ending)  # the writers tell a format by the ending
        try:
            if ending == ".gif":
                _write_gif(movie, made, per_second)
            else:
                _write(movie, made, _WRITERS[ending](per_second))
            made.replace(temporary)
        finally:
            made.unlink(missing_ok=True)


def _write_gif(movie: "Movie", path: Path, per_second: int) -> None:
    """Write the moments by Pillow itself: matplotlib would draw each of them three times."""
    from PIL import Image  # noqa: PLC0415 (0.1 s, for this format only)

    pictures = [Image.fromarray(movie.pixels(number)) for number in range(len(movie.steps))]
    first, *others = pictures
    first.save(path, save_all=True, append_images=others, duration=round(1e3 / per_second), loop=0)


def _write(movie: "Movie", path: Path, writer: AbstractMovieWriter) -> None:
    with writer.saving(movie.picture, str(path), movie.picture.dpi):
        for number in range(len(movie.steps)):
            movie.show(number)
            writer.grab_frame()


def _page(per_second: int) -> HTMLWriter:
    return HTMLWriter(
        fps=per_second, embed_frames=True, default_mode="loop", embed_limit=_LARGEST_PAGE
    )


_WRITERS: dict[str, Callable[[int], AbstractMovieWriter]] = {
    ".html": _page,
    ".mp4": lambda per_second: FFMpegWriter(fps=per_second),
}


def check_format(path: str | Path) -> str:
    """Return the ending of a moving picture that can be made here.

    Raises
    ------
    InputError
        If it is of no known format, or needs a program that is not installed.
    """
    ending = Path(path).suffix.lower()
    if ending not in FORMATS:
        raise InputError(f"output {path}: a moving picture ends in {', '.join(FORMATS)}")
    if ending == ".mp4" and shutil.which("ffmpeg") is None:
        raise InputError(
            f"output {path}: mp4 is made by the program ffmpeg, which is not installed; .gif and "
            ".html need nothing else"
        )
    return ending


class Movie:
    """One figure that shows any of the moments of a run.

    Parameters
    ----------
    run : TransientResult
        What to show.
    dpi : int
        Dots per inch.
    """

    def __init__(self, run: TransientResult, *, dpi: int = 100) -> None:
        self.run, self.lines = run, CentreLines(run)
        self.has_fields = run.frames.step.size >= 2
        self.steps = run.frames.step if self.has_fields else _thinned(len(run.history.time))
        self.picture = transient_figure(run, (6.2, 7.4 if self.has_fields else 3.4))
        self.picture.set_dpi(dpi)
        self.canvas = FigureCanvasAgg(self.picture)
        if self.has_fields:
            self.picture.set_layout_engine("none")
            self.field = _FieldMap(self.picture, self.picture.add_axes(_UPPER), run)
            self.lower = self.picture.add_axes(_LOWER)
        else:
            self.lower = self.picture.add_subplot()
        lower = self.lower
        self.moving = self.lines.draw(lower, int(self.steps[0]))
        lower.set_xlabel("x along entrainment [µm]  (y = 0)")
        self.caption = lower.set_title(" ", fontsize=9, loc="left")
        self.show(0)
        self.picture.draw_without_rendering()
        self.picture.set_layout_engine("none")  # panels that jump would be all that one sees

    def show(self, number: int) -> None:
        """Show one moment."""
        step = int(self.steps[number])
        factor, unit = time_unit(self.run)
        self.caption.set_text(f"t = {self.run.history.time[step] * factor:.4g} {unit}")
        self.lines.move(self.moving, step)
        if self.has_fields:
            self.field.show(number)

    def pixels(self, number: int) -> NDArray[np.uint8]:
        """Return one moment as a picture, (rows, columns, 3)."""
        self.show(number)
        self.canvas.draw()
        return np.asarray(self.canvas.buffer_rgba())[..., :3].copy()


class _FieldMap:
    """The film from above."""

    def __init__(self, picture: Figure, axes: Axes, run: TransientResult) -> None:
        self.run = run
        (west, east), (south, north) = window(run.start)
        scaled = run.start.scaled
        self.part = (span_part(scaled.y, south, north), span_part(scaled.x, west, east))
        x, y = run.x[self.part[1]] * MICRO, run.y[self.part[0]] * MICRO
        films = run.frames.film[:, *self.part]
        inside = np.hypot(scaled.x[None, self.part[1]], scaled.y[self.part[0], None]) < 0.8
        low, high = float(films.min()) * MICRO, float(films[:, inside].max()) * MICRO
        self.image = axes.imshow(
            films[0] * MICRO,
            extent=_edges(x) + _edges(y),
            origin="lower",
            interpolation="bilinear",
            vmin=low,
            vmax=high + 0.15 * (high - low),
        )
        dress_contact(axes, run.start)
        picture.colorbar(self.image, cax=colour_axes(axes), extend="max", label="film h [µm]")

    def show(self, number: int) -> None:
        """Show one of the kept fields."""
        self.image.set_data(self.run.frames.film[number][self.part] * np.float32(MICRO))


def _edges(axis: Array) -> tuple[float, float]:
    """Return where the cells of the first and of the last node end."""
    half = 0.5 * float(axis[1] - axis[0])
    return float(axis[0]) - half, float(axis[-1]) + half


def _thinned(count: int) -> IntArray:
    """Return all steps, or two hundred at even distances."""
    return np.unique(np.linspace(0, count - 1, min(count, MOST)).round().astype(np.int64))
