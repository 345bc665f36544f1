"""Pictures of a transient run: its numbers, what happens along y = 0, and a few moments."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from tehl.io.atomic import check_folder
from tehl.plots.frame import GIGA, MICRO, WINDOW, banner, outline, span_part
from tehl.plots.save import save_picture
from tehl.post.transient import envelope, speed_of
from tehl.transient_result import TransientResult

if TYPE_CHECKING:
    from tehl.typing import Array

PRESSURE, FILM, BODY = "#1f4e9c", "#c2410c", "0.72"
"""Colours of the curves, and of the rough body."""
MOMENTS = 4
"""Moments that one picture shows."""
_TALLEST = 2.2
"""Films that fit into a picture, over the largest one in the contact."""
_MILLISECOND = 2e-3
"""Duration from which on times are in milliseconds [s]."""


def transient_figure(run: TransientResult, size: tuple[float, float]) -> Figure:
    """Return an empty figure under the title of ``run``, with a banner if it has no end."""
    problem, groups = run.start.problem, run.start.groups
    title = fill(problem.title, 80).replace("$", r"\$") or "Lubricated point contact"
    about = (
        f"M = {groups.M:.4g}, L = {groups.L:.4g}, "
        f"$p_h$ = {run.start.scales.hertz_pressure * GIGA:.3g} GPa, "
        f"SRR = {problem.slide_roll_ratio:g}"
    )
    picture = Figure(figsize=size, layout="constrained")
    picture.suptitle(f"{title}\n{about}", fontsize=9)
    banner(picture, run.status)
    return picture


def time_unit(run: TransientResult) -> tuple[float, str]:
    """Return the factor from seconds to the unit in which times read well, and that unit."""
    return (1e3, "ms") if run.history.time[-1] >= _MILLISECOND else (1e6, "µs")


def history(run: TransientResult) -> Figure:
    """Draw film, largest pressure, traction, and rise and load if they change, over the time.

    Parameters
    ----------
    run : TransientResult
        What to draw.

    Returns
    -------
    matplotlib.figure.Figure
        Panels above each other; the upper axis tells how far the mean of both surfaces has moved.
        Bands are the error bars of a certified run.
    """
    factor, unit = time_unit(run)
    told, time = run.history, run.history.time * factor
    curves = [
        ("largest pressure [GPa]", told.pressure_max * GIGA, PRESSURE),
        ("traction at mid-film [-]", told.traction, "#3f7d20"),
    ]
    if told.temperature_rise.max() > 0:
        curves.append(("largest rise [K]", told.temperature_rise, "#8a1c7c"))
    if np.ptp(told.load) > 0:
        curves.append(("load [N]", told.load * run.start.problem.load, "0.2"))
    picture = transient_figure(run, (7.0, 1.8 + 1.6 * (1 + len(curves))))
    panels = picture.subplots(1 + len(curves), sharex=True)
    panels[0].plot(time, told.film_central * MICRO, color=FILM, label="central")
    panels[0].plot(time, told.film_minimum * MICRO, color=FILM, ls="--", label="smallest")
    panels[0].set_ylabel("film h [µm]")
    panels[0].legend(fontsize=8, ncols=2, frameon=False)
    for axes, (label, values, colour) in zip(panels[1:], curves, strict=True):
        axes.plot(time, values, color=colour)
        axes.set_ylabel(label)
    _bands(panels[:2], run, factor)
    panels[-1].set_xlabel(f"time [{unit}]")
    for axes in panels:
        axes.grid(lw=0.3)
        axes.margins(x=0)
    _distance_axis(panels[0], run, factor)
    picture.align_ylabels(panels)
    return picture


def _bands(panels: Sequence[Axes], run: TransientResult, factor: float) -> None:
    """Fill the error bars around film and largest pressure of a certified run."""
    bars, told = run.bars, run.history
    if bars is None:
        return
    for axes, name, unit, colour in (
        (panels[0], "film_central", MICRO, FILM),
        (panels[0], "film_minimum", MICRO, FILM),
        (panels[1], "pressure_max", GIGA, PRESSURE),
    ):
        middle = np.interp(bars.time, told.time, getattr(told, name))
        width, time = getattr(bars, name), bars.time * factor
        low, high = (middle - width) * unit, (middle + width) * unit
        axes.fill_between(time, low, high, color=colour, alpha=0.25, lw=0)


def _distance_axis(axes: Axes, run: TransientResult, factor: float) -> None:
    """Add an axis above with the way of the mean motion in half-widths."""
    scale = run.start.scales.speed / run.start.scales.half_width_x / factor
    there_and_back: Any = (lambda time: time * scale, lambda distance: distance / scale)
    other = axes.secondary_xaxis("top", functions=there_and_back)
    other.set_xlabel(r"$u_m t / a$", fontsize=8)
    other.tick_params(labelsize=8)


def space_time(run: TransientResult) -> Figure:
    """Draw film and pressure along y = 0 over place and time.

    Lines show how points of both surfaces move on (and the oil between them, dotted, at the mean
    speed, where they differ).

    Parameters
    ----------
    run : TransientResult
        What to draw.
    """
    factor, unit = time_unit(run)
    part = _window(run)
    x, time = run.x[part] * MICRO, run.history.time * factor
    film, pressure = run.profiles.film[:, part] * MICRO, run.profiles.pressure[:, part] * GIGA
    picture = transient_figure(run, (8.4, 4.8))
    left, right = picture.subplots(1, 2, sharey=True)
    contact = np.abs(run.start.scaled.x[part]) < 0.8
    low, high = float(film.min()), float(film[:, contact].max())
    top = high + 0.25 * (high - low)
    mesh = left.pcolormesh(
        x, time, film.clip(low, top), shading="nearest", rasterized=True, vmin=low, vmax=top
    )
    picture.colorbar(mesh, ax=left, location="bottom", extend="max", label="film h [µm]")
    mesh = right.pcolormesh(x, time, pressure, shading="nearest", cmap="magma", rasterized=True)
    picture.colorbar(mesh, ax=right, location="bottom", label="pressure p [GPa]")
    left.set_ylabel(f"time [{unit}]")
    for axes in (left, right):
        axes.set(xlabel="x along entrainment [µm]  (y = 0)", xlim=(x[0], x[-1]))
        axes.xaxis.set_major_locator(MaxNLocator(6))
        _paths(axes, run, factor)
    left.legend(loc="lower right", fontsize=7, facecolor="0.78", edgecolor="none")
    return picture


def _paths(axes: Axes, run: TransientResult, factor: float) -> None:
    """Draw the paths of points that are in the middle together, when a feature is there."""
    motion, time = run.start.problem.motion, run.history.time
    middle = _time_of_passing(run)
    speeds = {"surface 1": (motion.speed_1, "-"), "surface 2": (motion.speed_2, "--")}
    if motion.slide_roll_ratio == 0:
        speeds = {"both surfaces": (motion.speed_1, "-")}
    else:
        speeds["mean"] = (motion.entrainment_speed, ":")
    limits = axes.get_xlim()
    for label, (speed, style) in speeds.items():
        place = speed * (time - middle) * MICRO
        inside = (place > limits[0]) & (place < limits[1])
        axes.plot(
            place[inside],
            time[inside] * factor,
            color="white",
            ls=style,
            lw=0.9,
            label=label,
            path_effects=outline("0.2", 1.8),
        )


def _time_of_passing(run: TransientResult) -> float:
    """Return when the first single feature is in the middle, half of the run without one [s]."""
    problem = run.start.problem
    for number, surface in ((1, problem.surface_1), (2, problem.surface_2)):
        place, speed = getattr(surface.roughness, "x", None), speed_of(run, number)
        if place is not None and speed != 0:
            return -float(place) / speed
    return 0.5 * float(run.history.time[-1])


def moments(run: TransientResult, times: Sequence[float] | None = None) -> Figure:
    """Draw pressure and film along y = 0 at several moments, above the rough body as it is.

    Parameters
    ----------
    run : TransientResult
        What to draw.
    times : sequence of float
        Moments [s], the nearest steps are taken; if left out, four while the roughness passes.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each moment; the steady film of the beginning is dotted. Below zero, on the
        scale of the film, are the heights of both bodies together before they are deformed.
    """
    steps = moments_of(run) if times is None else [_step(run, time) for time in times]
    factor, unit = time_unit(run)
    picture = transient_figure(run, (7.2, 0.9 + 1.75 * len(steps)))
    panels = picture.subplots(len(steps), 1, sharex=True, squeeze=False)[:, 0]
    lines = CentreLines(run)
    for axes, step in zip(panels, steps, strict=True):
        lines.draw(axes, step)
        time = run.history.time[step]
        axes.set_title(f"t = {time * factor:.4g} {unit}", fontsize=8, loc="left", pad=3)
    panels[-1].set_xlabel("x along entrainment [µm]  (y = 0)")
    return picture


def moments_of(run: TransientResult, count: int = MOMENTS) -> list[int]:
    """Return steps at even distances, while there is roughness inside the contact."""
    inside = np.abs(run.start.scaled.x) <= 1.0
    heights = (run.profiles.height_1 + run.profiles.height_2)[:, inside]
    present = np.ptp(heights, axis=1)
    steps = np.flatnonzero(present >= 0.5 * present.max())
    first, last = int(steps[0]), int(steps[-1])
    every = np.linspace(first, last, count + 2)[1:-1] if last - first > count else (first, last)
    return sorted({round(float(step)) for step in every})


def _step(run: TransientResult, time: float) -> int:
    return int(np.argmin(np.abs(run.history.time - time)))


class CentreLines:
    """Draws pressure, film and the rough body along y = 0, at any step on the same scales."""

    def __init__(self, run: TransientResult) -> None:
        self.run, self.part = run, _window(run)
        self.x = run.x[self.part] * MICRO
        lines = run.profiles
        self.heights = (lines.height_1 + lines.height_2)[:, self.part] * MICRO
        inside = np.abs(run.start.scaled.x) < 0.8
        self.top = _TALLEST * float(lines.film[:, inside].max()) * MICRO
        deepest = float(np.ptp(self.heights))
        self.ground = -0.08 * self.top - float(self.heights.max())
        self.bottom = -0.16 * self.top - deepest
        self.largest = 1.08 * float(lines.pressure.max()) * GIGA

    def draw(self, axes: Axes, step: int) -> "MovingLines":
        """Draw one step, film at the left and pressure at the right; return what moves."""
        lines, part = self.run.profiles, self.part
        right = axes.twinx()
        axes.plot(self.x, lines.film[0, part] * MICRO, color=FILM, lw=0.8, ls=":")
        right.plot(self.x, lines.pressure[0, part] * GIGA, color=PRESSURE, lw=0.8, ls=":")
        axes.set(xlim=(self.x[0], self.x[-1]), ylim=(self.bottom, self.top))
        share = self.bottom / (self.top - self.bottom)
        right.set_ylim(share / (1.0 + share) * self.largest, self.largest)
        axes.axhline(0.0, color="0.4", lw=0.5)
        axes.set_ylabel("film h [µm]", color=FILM, fontsize=8)
        right.set_ylabel("pressure p [GPa]", color=PRESSURE, fontsize=8)
        _only_positive(axes, self.top)
        _only_positive(right, self.largest)
        moving = MovingLines(
            body=axes.fill_between(self.x, self.bottom, self.x, color=BODY, lw=0),
            edge=axes.plot([], [], color="0.3", lw=0.8)[0],
            film=axes.plot([], [], color=FILM, lw=1.4)[0],
            pressure=right.plot([], [], color=PRESSURE, lw=1.2)[0],
        )
        self.move(moving, step)
        return moving

    def move(self, moving: "MovingLines", step: int) -> None:
        """Show another step."""
        lines, part = self.run.profiles, self.part
        profile = self.ground + self.heights[step]
        around = (np.r_[self.x, self.x[::-1]], np.r_[profile, np.full_like(profile, self.bottom)])
        moving.body.set_verts([np.column_stack(around)])
        moving.edge.set_data(self.x, profile)
        moving.film.set_data(self.x, lines.film[step, part] * MICRO)
        moving.pressure.set_data(self.x, lines.pressure[step, part] * GIGA)


@dataclass(frozen=True, slots=True)
class MovingLines:
    """What changes from step to step in a picture of :class:`CentreLines`."""

    body: PolyCollection
    edge: Line2D
    film: Line2D
    pressure: Line2D


def _only_positive(axes: Axes, largest: float) -> None:
    """Put ticks where there are films and pressures, and none below."""
    ticks = MaxNLocator(4).tick_values(0.0, largest)
    axes.set_yticks([tick for tick in ticks if 0.0 <= tick <= largest])
    axes.tick_params(labelsize=8)


def _window(run: TransientResult) -> slice:
    return span_part(run.start.scaled.x, *WINDOW[0])


def passage(run: TransientResult) -> Figure:
    """Draw between which limits film and pressure along y = 0 have been.

    Parameters
    ----------
    run : TransientResult
        What to draw.
    """
    found, part = envelope(run), _window(run)
    x = found.x[part] * MICRO
    picture = transient_figure(run, (7.0, 6.2))
    upper, lower = picture.subplots(2, 1, sharex=True)
    bands: tuple[tuple[Axes, Array, Array, Array, str, float], ...] = (
        (
            upper,
            found.pressure_least,
            found.pressure_largest,
            run.profiles.pressure[0],
            PRESSURE,
            GIGA,
        ),
        (lower, found.film_least, found.film_largest, run.profiles.film[0], FILM, MICRO),
    )
    for axes, least, largest, start, colour, unit in bands:
        low, high = least[part] * unit, largest[part] * unit
        band = "least to largest of the passage"
        axes.fill_between(x, low, high, color=colour, alpha=0.3, lw=0, label=band)
        axes.plot(x, start[part] * unit, color=colour, lw=1.3, label="at the beginning, steady")
        axes.grid(axis="y", lw=0.3)
        axes.legend(fontsize=8, frameon=False)
    inside = np.abs(run.start.scaled.x) < 0.8
    lower.set_ylim(0.0, _TALLEST * float(found.film_largest[inside].max()) * MICRO)
    upper.set(ylabel="pressure p [GPa]", xlim=(x[0], x[-1]))
    upper.set_ylim(bottom=0.0)
    lower.set(ylabel="film h [µm]", xlabel="x along entrainment [µm]  (y = 0)")
    return picture


PICTURES: dict[str, Callable[[TransientResult], Figure]] = {
    "history": history,
    "space_time": space_time,
    "moments": moments,
    "passage": passage,
}
"""Pictures of a transient run, by name."""


def save_transient(run: TransientResult, folder: str | Path, *, dpi: int = 150) -> list[Path]:
    """Draw all pictures of a transient run as PNG files; each appears whole or not at all.

    Parameters
    ----------
    run : TransientResult
        What to draw.
    folder : str or Path
        Where; made if it is missing.
    dpi : int
        Dots per inch.

    Returns
    -------
    list of Path
        The files, in the order of drawing.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    place = Path(folder)
    check_folder(place)
    place.mkdir(parents=True, exist_ok=True)
    return [save_picture(draw(run), place / f"{name}.png", dpi) for name, draw in PICTURES.items()]
