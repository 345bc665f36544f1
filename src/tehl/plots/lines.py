"""Pressure and film on the two centre lines, over the dry Hertz contact."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tehl.plots.frame import GIGA, MICRO, WINDOW, Span, figure
from tehl.plots.temperature import temperature_lines
from tehl.post.film import Profile, profile_x, profile_y
from tehl.result import Result

PRESSURE, FILM = "#1f4e9c", "#c2410c"
"""Colours of pressure and film."""


def centre_lines(result: Result) -> Figure:
    """Draw pressure and film along x (y = 0) and along y (x = 0), with the dry contact dashed.

    Parameters
    ----------
    result : Result
        What to draw.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels, each with the pressure [GPa] and the film [um] on twin axes; for a thermal run
        two more beside them, with the temperature rises [K].
    """
    thermal = result.heat is not None
    picture = figure(result, (12.4, 7.2) if thermal else (7.2, 7.2))
    grid = picture.subplots(2, 2 if thermal else 1, squeeze=False)
    curves = _panel(grid[0, 0], result, profile_x(result), WINDOW[0])
    _panel(grid[1, 0], result, profile_y(result), WINDOW[1])
    legends = [curves]
    if thermal:
        legends.append(_heat_panels((grid[0, 1], grid[1, 1]), result))
    for column, handles in zip(grid.T, legends, strict=True):
        column[0].set_xlabel("x along entrainment [µm]  (y = 0)")
        column[1].set_xlabel("y [µm]  (x = 0)")
        column[1].legend(
            handles=handles,
            loc="upper center",
            bbox_to_anchor=(0.5, -0.15),
            ncols=4,
            fontsize=8,
            frameon=False,
        )
    return picture


def _heat_panels(panels: tuple[Axes, Axes], result: Result) -> list[Any]:
    """Draw the temperatures along both lines; return the curves of one panel."""
    row = int(np.argmin(np.abs(result.scaled.y)))
    column = int(np.argmin(np.abs(result.scaled.x)))
    along, across = panels
    temperature_lines(along, result.x * MICRO, (row, slice(None)), result)
    temperature_lines(across, result.y * MICRO, (slice(None), column), result)
    for axes, profile, window in (
        (along, profile_x(result), WINDOW[0]),
        (across, profile_y(result), WINDOW[1]),
    ):
        axes.set_xlim(_limits(profile, window))
        axes.grid(axis="y", lw=0.3)
    return list(along.lines)


def _limits(profile: Profile, window: Span) -> tuple[float, float]:
    inside = (profile.scaled_coordinate >= window[0]) & (profile.scaled_coordinate <= window[1])
    shown = profile.coordinate[inside] * MICRO
    return float(shown[0]), float(shown[-1])


def _panel(axes: Axes, result: Result, profile: Profile, window: Span) -> list[Any]:
    """Draw pressure and film along a line; return the curves."""
    place = profile.coordinate * MICRO
    axes.plot(
        place, profile.hertz_pressure * GIGA, color="0.45", lw=1.0, ls="--", label="dry Hertz"
    )
    axes.plot(place, profile.pressure * GIGA, color=PRESSURE, lw=1.4, label="pressure")
    axes.set_ylabel("pressure p [GPa]", color=PRESSURE)
    axes.set_ylim(bottom=0.0)
    axes.set_xlim(_limits(profile, window))
    film = axes.twinx()
    film.plot(place, profile.dry_gap * MICRO, color=FILM, lw=0.8, ls=":", label="dry gap")
    film.plot(place, profile.film_thickness * MICRO, color=FILM, lw=1.4, label="film")
    show_film_behind(axes, film, result, 4.0)
    return [*axes.lines, *film.lines]


def show_film_behind(axes: Axes, film: Axes, result: Result, most: float) -> None:
    """Give drawn axes of the film [um] up to ``most`` central films, behind the pressure's."""
    film.set_ylabel("film h [µm]", color=FILM)
    central = result.film.central * MICRO
    film.set_ylim(0.0, most * central if central > 0 else None)
    axes.set_zorder(film.get_zorder() + 1)
    axes.patch.set_visible(False)
