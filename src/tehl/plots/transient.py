"""Pictures of a transient run: its history, the line y = 0 over time, and a few moments."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tehl.base.typing import Array
from tehl.plots.arrows import MICRO, outline
from tehl.plots.frame import ALONG_X, FILM, GIGA, GREEN, PLAIN, PRESSURE, WINDOW, figure, span_part
from tehl.post.transient import distances, envelope, passing_features
from tehl.post.transient_numbers import why_share_unknown
from tehl.result.transient import HistoryBars, TransientSolution

_MOMENTS = 4
"""Moments in one picture."""
_FILM_AXIS_HEIGHT = 2.2
"""Height of the film axis, over the largest film in the contact."""
INSIDE = 0.8
"""Half-widths that count as well inside the contact."""


def time_unit(run: TransientSolution) -> tuple[float, str]:
    """Return the factor from seconds to a fitting unit, and that unit."""
    # short runs are in microseconds
    return (1e3, "ms") if run.history.time[-1] >= 2e-3 else (1e6, "µs")


def history(run: TransientSolution, *, title: bool | None = True) -> Figure:
    """Draw film, pressure, traction, and rise, load, motion and radius if they change, over time.

    The upper axis is the distance that the mean of both surfaces moves, where its speed is
    constant. Bands are the error bars of a certified run.

    Parameters
    ----------
    run : TransientSolution
        Of a transient contact.
    title : bool or None
        Whether the figure has a title.
    """
    factor, unit = time_unit(run)
    numbers, time = run.history, run.history.time * factor
    curves = [
        ("largest pressure [GPa]", numbers.pressure_max * GIGA, PRESSURE),
        ("traction at mid-film [-]", numbers.traction, GREEN),
    ]
    problem = run.start.problem
    if problem.contact.has_lines:
        metre = "/m" if problem.contact.is_line else ""
        curves.append((f"rolling moment\n[N mm{metre}]", 1e3 * numbers.rolling_moment, "#3b6ea5"))
    if numbers.temperature_rise.max() > 0:
        curves.append(("largest rise [K]", numbers.temperature_rise, "#8a1c7c"))
    if numbers.asperity_load.max() > 0:
        curves.append((_carried_by(run), numbers.asperity_load, "#b8560f"))
    mean = problem.entrainment_speed
    force, newtons = ("load [N/mm]", 1e-3) if problem.contact.is_line else ("load [N]", 1.0)
    curves += [
        (label, values, "0.2")
        for label, values in (
            (force, numbers.load * problem.load * newtons),
            ("entrainment [m/s]", numbers.speed * mean),
            ("sliding [m/s]", numbers.sliding * mean),
            ("radius [mm]", 1e3 * numbers.radius * problem.radius_x),
        )
        if np.ptp(values) > 0
    ]
    picture = figure(run, (7.0, 1.8 + 1.6 * (1 + len(curves))), title=title)
    panels = picture.subplots(1 + len(curves), sharex=True)
    panels[0].plot(time, numbers.film_central * MICRO, color=FILM, label="central")
    panels[0].plot(time, numbers.film_minimum * MICRO, color=FILM, ls="--", label="minimum")
    panels[0].set_ylabel("film h [µm]")
    panels[0].legend(ncols=2, **PLAIN)
    for axes, (label, values, colour) in zip(panels[1:], curves, strict=True):
        axes.plot(time, values, color=colour)
        axes.set_ylabel(label)
    if run.bars is not None:
        _draw_error_bars(panels, run, run.bars)
    for axes in panels:
        axes.grid(lw=0.3)
        axes.margins(x=0)
    panels[-1].set_xlabel(f"time [{unit}]")
    if np.ptp(numbers.speed) == 0.0:
        _add_distance_axis(panels[0], run, factor)
    picture.align_ylabels(panels)
    return picture


def _carried_by(run: TransientSolution) -> str:
    """Return what carries the load beside the film, and whether the grid resolves it."""
    if run.start.problem.contact_film is None:
        return "asperities [of the load]"
    known = "\n(not resolved)" if why_share_unknown(run) else ""
    return f"where surfaces touch\n[of the load]{known}"


def _add_distance_axis(axes: Axes, run: TransientSolution, factor: float) -> None:
    scale = run.start.scales.speed / run.start.scales.half_width_x / factor
    there_and_back: Any = (lambda time: time * scale, lambda distance: distance / scale)
    distance = axes.secondary_xaxis("top", functions=there_and_back)
    distance.set_xlabel(r"$u_m t / a$", fontsize=8)
    distance.tick_params(labelsize=8)


def _draw_error_bars(panels: Sequence[Axes], run: TransientSolution, bars: HistoryBars) -> None:
    """Fill the error bars around film and largest pressure of a certified run."""
    time = bars.time * time_unit(run)[0]
    for axes, name, unit, colour in (
        (panels[0], "film_central", MICRO, FILM),
        (panels[0], "film_minimum", MICRO, FILM),
        (panels[1], "pressure_max", GIGA, PRESSURE),
    ):
        middle = np.interp(bars.time, run.history.time, getattr(run.history, name))
        low, high = ((middle + sign * getattr(bars, name)) * unit for sign in (-1, 1))
        axes.fill_between(time, low, high, color=colour, alpha=0.25, lw=0)


def space_time(run: TransientSolution, *, title: bool | None = True) -> Figure:
    """Draw film and pressure along y = 0 over place and time.

    Lines are the paths of points on both surfaces (and of the oil between them, dotted, at the mean
    speed, where the speeds differ).

    Parameters
    ----------
    run : TransientSolution
        With pressure and film along y = 0 at each step.
    title : bool or None
        Whether the figure has a title.
    """
    factor, unit = time_unit(run)
    part = _window(run)
    x, time = run.x[part] * MICRO, run.history.time * factor
    film, pressure = run.profiles.film[:, part] * MICRO, run.profiles.pressure[:, part] * GIGA
    picture = figure(run, (8.4, 4.8), title=title)
    left, right = picture.subplots(1, 2, sharey=True)
    low, high = float(film.min()), _largest_inside(run, run.profiles.film)
    top = high + 0.25 * (high - low)
    style: dict[str, Any] = {"shading": "nearest", "rasterized": True}
    mesh = left.pcolormesh(x, time, film.clip(low, top), vmin=low, vmax=top, **style)
    picture.colorbar(mesh, ax=left, location="bottom", extend="max", label="film h [µm]")
    mesh = right.pcolormesh(x, time, pressure, cmap="magma", **style)
    picture.colorbar(mesh, ax=right, location="bottom", label="pressure p [GPa]")
    left.set_ylabel(f"time [{unit}]")
    for axes in (left, right):
        axes.set(xlabel=ALONG_X, xlim=(x[0], x[-1]))
        axes.xaxis.set_major_locator(MaxNLocator(6))
        _draw_paths(axes, run, factor)
    left.legend(loc="lower right", fontsize=7, facecolor="0.78", edgecolor="none")
    return picture


def _draw_paths(axes: Axes, run: TransientSolution, factor: float) -> None:
    """Draw the paths of points that meet at x = 0 when the first feature is there."""
    time, (mean, first, second) = run.history.time, distances(run)
    half_way = 0.5 * float(time[-1])
    middle = next((passing for _, passing in passing_features(run)), half_way)
    ways = {"surface 1": (first, "-"), "surface 2": (second, "--")}
    if (first == second).all():
        ways = {"both surfaces": (first, "-")}
    else:
        ways["mean"] = (mean, ":")
    limits, effects = axes.get_xlim(), outline("0.2", 1.8)
    for label, (way, style) in ways.items():
        place = (way - np.interp(middle, time, way)) * MICRO
        inside = (place > limits[0]) & (place < limits[1])
        line = axes.plot(place[inside], time[inside] * factor, color="white", ls=style, lw=0.9)[0]
        line.set(label=label, path_effects=effects)


def moments(
    run: TransientSolution, times: Sequence[float] | None = None, *, title: bool | None = True
) -> Figure:
    """Draw pressure and film along y = 0 at several moments, above the undeformed rough body.

    The steady film at the start is dotted. Below zero, on the scale of the film, are the heights of
    both bodies together.

    Parameters
    ----------
    run : TransientSolution
        With pressure and film along y = 0 at each step.
    times : sequence of float or None
        Rounded to steps [s]; None takes four while the roughness passes.
    title : bool or None
        Whether the figure has a title.
    """
    reached, (factor, unit) = run.history.time, time_unit(run)
    steps = moments_of(run)
    if times is not None:
        steps = [int(np.argmin(np.abs(reached - time))) for time in times]
    picture = figure(run, (7.2, 0.9 + 1.75 * len(steps)), title=title)
    panels = picture.subplots(len(steps), 1, sharex=True, squeeze=False)[:, 0]
    for axes, step in zip(panels, steps, strict=True):
        CentreLines(run, axes).show(step)
        axes.set_title(f"t = {reached[step] * factor:.4g} {unit}", fontsize=8, loc="left", pad=3)
    panels[-1].set_xlabel(f"{ALONG_X}   dotted: at the start; grey: the surfaces")
    return picture


def moments_of(run: TransientSolution) -> list[int]:
    """Return equidistant steps at which there is roughness inside the contact."""
    inside = np.abs(run.start.scaled.x) <= 1.0
    heights = (run.profiles.height_1 + run.profiles.height_2)[:, inside]
    present = np.ptp(heights, axis=1)
    steps = np.flatnonzero(present >= 0.5 * present.max())
    first, last = int(steps[0]), int(steps[-1])
    every = np.linspace(first, last, _MOMENTS + 2)[1:-1]
    return sorted({round(step) for step in (every if last - first > _MOMENTS else (first, last))})


class CentreLines:
    """Pressure, film and the rough body along y = 0 in one panel, at any step on the same scales.

    The film is at the left, the pressure at the right; what the steady start has is dotted.
    """

    def __init__(self, run: TransientSolution, axes: Axes) -> None:
        self.lines, self.part = run.profiles, _window(run)
        self.x, right = run.x[self.part] * MICRO, axes.twinx()
        self.heights = (self.lines.height_1 + self.lines.height_2)[:, self.part] * MICRO
        top = _FILM_AXIS_HEIGHT * _largest_inside(run, self.lines.film)
        self.ground = -0.08 * top - float(self.heights.max())
        self.bottom = -0.16 * top - float(np.ptp(self.heights))
        largest = 1.08 * float(self.lines.pressure.max()) * GIGA
        start: dict[str, Any] = {"lw": 0.8, "ls": ":"}
        axes.plot(self.x, self.lines.film[0, self.part] * MICRO, color=FILM, **start)
        right.plot(self.x, self.lines.pressure[0, self.part] * GIGA, color=PRESSURE, **start)
        axes.set(xlim=(self.x[0], self.x[-1]), ylim=(self.bottom, top))
        right.set_ylim(self.bottom / top * largest, largest)
        axes.axhline(0.0, color="0.4", lw=0.5)
        axes.set_ylabel("film h [µm]", color=FILM, fontsize=8)
        right.set_ylabel("pressure p [GPa]", color=PRESSURE, fontsize=8)
        for one, end in ((axes, top), (right, largest)):
            ticks = MaxNLocator(4).tick_values(0.0, end)
            one.set_yticks([tick for tick in ticks if 0.0 <= tick <= end])
            one.tick_params(labelsize=8)
        self.body = axes.fill_between(self.x, self.bottom, self.x, color="0.72", lw=0)
        self.edge = axes.plot([], [], color="0.3", lw=0.8)[0]
        self.film = axes.plot([], [], color=FILM, lw=1.4)[0]
        self.pressure = right.plot([], [], color=PRESSURE, lw=1.2)[0]

    def show(self, step: int) -> None:
        """Show the state at a step."""
        profile = self.ground + self.heights[step]
        around = (np.r_[self.x, self.x[::-1]], np.r_[profile, np.full_like(profile, self.bottom)])
        self.body.set_verts([np.column_stack(around)])
        self.edge.set_data(self.x, profile)
        self.film.set_data(self.x, self.lines.film[step, self.part] * MICRO)
        self.pressure.set_data(self.x, self.lines.pressure[step, self.part] * GIGA)


def _window(run: TransientSolution) -> slice:
    return span_part(run.start.scaled.x, WINDOW[0])


def _largest_inside(run: TransientSolution, film: Array) -> float:
    """Return the largest film [um] well inside the contact, of (steps, x) or (x,) along y = 0.

    The contact of each step is as wide as load and radius have it; of (x,), all of them contain it.
    """
    power = 0.5 if run.start.problem.contact.has_lines else 1.0 / 3.0
    width = (run.history.load * run.history.radius) ** power
    width = width[:, None] if film.ndim > 1 else width.min()
    inside = np.abs(run.start.scaled.x) < INSIDE * width
    return float(film[inside].max()) * MICRO


def passage(run: TransientSolution, *, title: bool | None = True) -> Figure:
    """Draw the range of film and pressure along y = 0 over the run.

    Parameters
    ----------
    run : TransientSolution
        With pressure and film along y = 0 at each step.
    title : bool or None
        Whether the figure has a title.
    """
    found, start, part = envelope(run), run.profiles, _window(run)
    x = found.x[part] * MICRO
    picture = figure(run, (7.0, 6.2), title=title)
    upper, lower = picture.subplots(2, 1, sharex=True)
    for axes, span, first, colour, unit in (
        (upper, (found.pressure_least, found.pressure_largest), start.pressure[0], PRESSURE, GIGA),
        (lower, (found.film_least, found.film_largest), start.film[0], FILM, MICRO),
    ):
        low, high = (limit[part] * unit for limit in span)
        style: dict[str, Any] = {"color": colour, "alpha": 0.3, "lw": 0}
        axes.fill_between(x, low, high, label="least to largest of the run", **style)
        axes.plot(x, first[part] * unit, color=colour, lw=1.3, label="steady film at the start")
        axes.grid(axis="y", lw=0.3)
        axes.legend(**PLAIN)
    lower.set_ylim(0.0, _FILM_AXIS_HEIGHT * _largest_inside(run, found.film_largest))
    upper.set(ylabel="pressure p [GPa]", xlim=(x[0], x[-1]))
    upper.set_ylim(bottom=0.0)
    lower.set(ylabel="film h [µm]", xlabel=ALONG_X)
    return picture
