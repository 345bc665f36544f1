"""A transient run as an animation: a map of the film or of stresses above, the line y = 0 below."""

import base64
import io
import json
import shutil
from html import escape
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
from matplotlib.animation import FFMpegWriter
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.image import AxesImage
from numpy.typing import NDArray
from PIL import Image

from tehl.base.atomic import replacing
from tehl.base.errors import InputError
from tehl.plots.arrows import MICRO
from tehl.plots.frame import ALONG_X, colour_bar, dress_contact, figure, window_part, window_places
from tehl.plots.stress import section_image, section_rows
from tehl.plots.transient import CentreLines, time_unit
from tehl.post.stress.moving import moving_stress
from tehl.result.transient import TransientSolution

FORMATS = (".gif", ".mp4", ".html")
MOST_MOMENTS = 200
"""Largest number of moments in an animation of the line y = 0 alone."""
_UPPER, _LOWER = (0.13, 0.41, 0.69, 0.51), (0.13, 0.07, 0.75, 0.255)
_SECTION, _BELOW = (0.13, 0.48, 0.69, 0.4), (0.13, 0.08, 0.75, 0.3)
"""Axes of map and lines, and of section and lines: left, bottom, width and height in parts of the
picture."""


def animate(
    run: TransientSolution,
    path: str | Path,
    *,
    per_second: int = 10,
    dpi: int = 100,
    stress: int | None = None,
) -> None:
    """Write a transient run as an animation; whole, or not at all.

    It shows the stored fields (``transient.frames``): film thickness, and below it film, pressure
    and the rough body along y = 0. Of a line contact, and with fewer than two stored fields, it
    shows that line at all steps.

    Parameters
    ----------
    run : TransientSolution
        What to show.
    path : str or Path
        The file; its extension selects the format: ``.gif``, ``.html`` (a self-contained page
        with buttons) or ``.mp4``, which needs the program ffmpeg.
    per_second : int
        Moments per second.
    dpi : int
        Dots per inch.
    stress : {1, 2} or None
        Body whose largest shear stress on y = 0 is shown in place of the film.

    Raises
    ------
    InputError
        If the extension is not supported, ffmpeg is missing, or the file cannot be written.
    """
    ending = check_format(path)
    if not per_second > 0:
        raise InputError(f"per_second = {per_second}: must be positive, typically 10")
    movie = Movie(run, dpi=dpi, stress=stress)
    with replacing(path) as temporary:
        made = temporary.with_suffix(ending)  # the writers choose the format by the extension
        try:
            _write(movie, made, per_second)
            made.replace(temporary)
        finally:
            made.unlink(missing_ok=True)


def _write(movie: "Movie", path: Path, per_second: int) -> None:
    numbers = range(len(movie.steps))
    if path.suffix == ".gif":  # with Pillow: the writer of matplotlib draws each moment three times
        first, *others = (Image.fromarray(movie.pixels(number)) for number in numbers)
        duration = round(1e3 / per_second)
        first.save(path, save_all=True, append_images=others, duration=duration, loop=0)
        return
    if path.suffix == ".html":
        path.write_text(_page(movie, per_second), encoding="utf-8")
        return
    writer = FFMpegWriter(fps=per_second)
    with writer.saving(movie.picture, str(path), movie.picture.dpi):
        for number in numbers:
            movie.show(number)
            writer.grab_frame()


def _page(movie: "Movie", per_second: int) -> str:
    """Return a page with all moments inside, which needs no network."""
    moments = []
    for number in range(len(movie.steps)):
        buffer = io.BytesIO()
        Image.fromarray(movie.pixels(number)).save(buffer, format="png", optimize=True)
        moments.append(base64.b64encode(buffer.getvalue()).decode("ascii"))
    title = escape(movie.run.start.problem.title or "Lubricated contact")
    page = Template(Path(__file__).with_name("movie.html").read_text(encoding="utf-8"))
    pause = round(1e3 / per_second)
    return page.substitute(title=title, moments=json.dumps(moments), pause=pause)


def check_format(path: str | Path) -> str:
    """Return the extension of an animation that can be written here.

    Raises InputError if the format is not supported, or needs a program that is not installed.
    """
    ending = Path(path).suffix.lower()
    if ending not in FORMATS:
        raise InputError(
            f"output {path}: format not supported; an animation ends in {', '.join(FORMATS)}"
        )
    if ending == ".mp4" and shutil.which("ffmpeg") is None:
        raise InputError(
            f"output {path}: mp4 needs the program ffmpeg, which is not installed; .gif and .html "
            "do not"
        )
    return ending


class Movie:
    """One figure that can show each moment of a run, with the map of the film if it is stored.

    With ``stress`` it shows the section y = 0 of that body in place of the map.
    """

    def __init__(
        self, run: TransientSolution, *, dpi: int = 100, stress: int | None = None
    ) -> None:
        self.run, count = run, len(run.history.time)
        is_map = stress is not None or not run.start.problem.contact.is_line
        has_fields = is_map and run.frames.step.size >= 2
        shown = np.unique(
            np.linspace(0, count - 1, min(count, MOST_MOMENTS)).round().astype(np.int64)
        )
        self.steps = run.frames.step if has_fields else shown
        height = 3.4 if not has_fields else 7.4 if stress is None else 6.2
        self.picture = figure(run, (6.2, height))
        self.picture.set_dpi(dpi)
        self.canvas = FigureCanvasAgg(self.picture)
        self.image: AxesImage | None = None
        self._section = None if stress is None else moving_stress(run, stress)
        if has_fields:
            self.picture.set_layout_engine("none")
            upper = self.picture.add_axes(_UPPER if stress is None else _SECTION)
            if self._section is None:
                self.image = _film_image(upper, run)
            else:
                self.image = section_image(upper, run, self._section, 0)
                colour_bar(upper, self.image, f"largest shear stress, body {stress} [GPa]")
        place = _LOWER if stress is None else _BELOW
        lower = self.picture.add_axes(place) if has_fields else self.picture.add_subplot()
        self.lines = CentreLines(run, lower)
        lower.set_xlabel(ALONG_X)
        self.caption = lower.set_title(" ", fontsize=9, loc="left")
        self.show(0)
        self.picture.draw_without_rendering()
        self.picture.set_layout_engine("none")  # else the panels move from moment to moment

    def show(self, number: int) -> None:
        """Show one moment."""
        step = int(self.steps[number])
        factor, unit = time_unit(self.run)
        self.caption.set_text(f"t = {self.run.history.time[step] * factor:.4g} {unit}")
        self.lines.show(step)
        if self.image is not None:
            self.image.set_data(self._shown(number))

    def _shown(self, number: int) -> NDArray[Any]:
        """Return what the upper map shows of one moment, in the unit of its colours."""
        if self._section is None:
            film = self.run.frames.film[number][window_part(self.run.start)]
            return np.asarray(film * np.float32(MICRO))
        return section_rows(self.run, self._section, number)

    def pixels(self, number: int) -> NDArray[np.uint8]:
        """Return one moment as a picture, (rows, columns, 3)."""
        self.show(number)
        self.canvas.draw()
        return np.asarray(self.canvas.buffer_rgba())[..., :3].copy()


def _film_image(axes: Axes, run: TransientSolution) -> AxesImage:
    """Draw the map of the first stored film, in colours that fit all of them."""
    scaled, (rows, columns) = run.start.scaled, window_part(run.start)
    films = run.frames.film[:, rows, columns]
    at = run.start.groups.shape.radius_squared(scaled.x[columns], scaled.y[rows, None])
    inside = at < 0.8**2
    low, high = float(films.min()) * MICRO, float(films[:, inside].max()) * MICRO
    edges = []
    for axis in window_places(run.start):
        half = 0.5 * float(axis[1] - axis[0])
        edges += [float(axis[0]) - half, float(axis[-1]) + half]
    style: dict[str, Any] = {"origin": "lower", "interpolation": "bilinear", "extent": edges}
    top = high + 0.15 * (high - low)
    image = axes.imshow(films[0] * MICRO, vmin=low, vmax=top, **style)
    dress_contact(axes, run.start)
    colour_bar(axes, image, "film h [µm]", extend="max")
    return image
