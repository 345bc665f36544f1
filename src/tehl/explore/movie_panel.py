"""The view of a transient run: a movie of the film with a slider for the time."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from nicegui import ui

from tehl.base.wording import duration
from tehl.explore.axes import Frame, Scale, keys, svg
from tehl.explore.colour_map import film_limits, film_picture
from tehl.explore.elements import Drawing, button, main_button
from tehl.explore.job_panel import JobPanel
from tehl.explore.tab import Tab
from tehl.explore.tasks import Movie, Transient
from tehl.explore.worker import Solver


class Player:
    """A bar with a slider and a button that moves it through the frames of a movie.

    Parameters
    ----------
    draw : callable
        Draws the frame of the slider.
    """

    def __init__(self, draw: Callable[[], None]) -> None:
        self.frames = 1
        with ui.element("div").classes("movie-time") as self.place:
            self.play = button("", self._toggle, icon="play_arrow", name="play or pause")
            self.slider = ui.slider(min=0, max=1, step=1, value=0)
            self.slider.props('aria-label="time"').classes("grow")
            self.slider.on_value_change(draw)
            self.clock = ui.label("").classes("clock")
        self.timer = ui.timer(0.12, self._next, active=False)  # seconds between two frames

    @property
    def frame(self) -> int:
        """The frame of the slider."""
        return min(int(self.slider.value), self.frames - 1)

    def rewind(self, frames: int) -> None:
        """Go to the first frame of a movie."""
        self.frames = frames
        self.slider.props(f"max={frames - 1}")
        self.slider.set_value(0)

    def pause(self) -> None:
        """Stay at a frame."""
        self.timer.deactivate()
        self.play.props("icon=play_arrow")

    def _toggle(self) -> None:
        if self.timer.active:
            self.pause()
        else:
            self.timer.activate()
            self.play.props("icon=pause")

    def _next(self) -> None:
        self.slider.set_value((self.frame + 1) % self.frames)


class MoviePanel(JobPanel):
    """The movie of a tab, solved in the background."""

    def __init__(self, tab: Tab, background: Solver) -> None:
        super().__init__(tab, background, "run")
        self.movie: Movie | None = None
        self.text, self.size = "", (720.0, 560.0)
        with ui.element("div").classes("movie") as self.place:
            with ui.element("div").classes("movie-bar"):
                self.run = main_button("Solve the run", self.start, icon="play_arrow")
                self.halt = button("Cancel", self.cancel)
                self.halt.set_visibility(False)
                self.state = ui.label("").classes("status-words")
            self.player = Player(self.draw)
            self.drawing = Drawing()
            self.history = ui.html("", sanitize=False).classes("drawing")
        self.place.set_visibility(False)
        tab.listeners.append(self._hear)

    def _hear(self, topic: str) -> None:
        if topic in ("picture", "controls", "explained") and self.tab.view == "movie":
            self.show()

    def show(self) -> None:
        """Show the panel."""
        self.place.set_visibility(self.tab.view == "movie")
        if self.tab.view != "movie":
            self.player.pause()
            return
        problem = self.tab.problem
        is_transient = problem is not None and problem.transient is not None
        self.run.set_visibility(is_transient and not self.halt.visible)
        self.player.place.set_visibility(self.movie is not None)
        if not is_transient:
            self.state.set_text(
                "This contact is steady. Give a surface a dent or a wave under “Surfaces” and let "
                "it move along, or take the template passing-dent."
            )
        elif self.movie is None and not self.halt.visible:
            found = self.tab.explained
            self.state.set_text(
                "" if found is None else f"takes about {duration(max(1.0, found.seconds))}"
            )
        elif self.text != self.tab.case.text:
            self.state.set_text("The case has changed since this run was solved.")
        self.draw()

    def start(self) -> None:
        """Solve the run in the background."""
        if self.submit(lambda: Transient(self.tab.tables)):
            self.text = self.tab.case.text
            self.halt.set_visibility(True)
            self.run.set_visibility(False)
            self._say("starting")

    def _take(self, movie: Movie) -> None:
        self.movie = movie
        self.state.set_text(movie.words)
        self.player.rewind(len(movie.times))
        self.player.place.set_visibility(True)
        self.draw()

    def _end(self, *, cancelled: bool) -> None:
        self.halt.set_visibility(False)
        self.run.set_visibility(True)
        if cancelled:
            self.state.set_text("cancelled")

    def resize(self, width: float, height: float) -> None:
        """Draw in another size."""
        self.size = (width, height)
        self.draw()

    def draw(self) -> None:
        """Draw the film at the time of the slider; the colours are those of the whole run."""
        movie = self.movie
        if movie is None or self.tab.view != "movie":
            return
        frame = self.player.frame
        maps = replace(movie.maps, film=movie.film[frame], pressure=movie.pressure[frame])
        limits = replace(film_limits(movie.maps), low=0.95 * max(_least(movie), 1e-3))
        size = (self.size[0], max(280.0, self.size[1] - 210.0))
        self.drawing.show(film_picture(maps, limits, size))
        self.history.set_content(_history_drawing(movie, frame, (self.size[0], 170.0)))
        self.player.clock.set_text(f"{movie.times[frame]:.0f} µs")


def _least(movie: Movie) -> float:
    positive = movie.film[movie.film > 0]
    return float(positive.min()) if positive.size else 1.0


def _history_drawing(movie: Movie, frame: int, size: tuple[float, float]) -> str:
    """Draw central and minimum film over time, and where the movie is."""
    time, central, minimum = movie.history
    top = 1.1 * float(np.nanmax(central))
    axes = Frame(
        Scale(float(time[0]), float(time[-1]), 62.0, size[0] - 24.0),
        Scale(0.0, top, size[1] - 46.0, 24.0),
        *size,
    )
    parts = axes.svg("time [µs]", "film [nm]", grid=True)
    parts += axes.path(time, central, "line film") + axes.path(time, minimum, "line pressure")
    at = axes.x(float(movie.times[frame]))
    parts += f'<path d="M{at:.1f} {axes.y.start}V{axes.y.end}" class="now"/>'
    parts += keys(62, 130, ("central film", "film"), ("minimum film", "pressure"))
    return svg(*size, parts, "central and minimum film over time")
