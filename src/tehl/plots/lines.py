"""Pressure and film on the two centre lines, over the dry Hertz contact."""

from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tehl.plots.frame import GIGA, MICRO, WINDOW, figure
from tehl.post.film import Profile, profile_x, profile_y
from tehl.result import Result

_PRESSURE, _FILM = "#1f4e9c", "#c2410c"


def centre_lines(result: Result) -> Figure:
    """Draw pressure and film along x (y = 0) and along y (x = 0), with the dry contact dashed.

    Parameters
    ----------
    result : Result
        What to draw.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels, each with the pressure [GPa] and the film [um] on twin axes.
    """
    picture = figure(result, (7.2, 7.2))
    upper, lower = picture.subplots(2, 1)
    _panel(upper, result, profile_x(result), WINDOW[0])
    _panel(lower, result, profile_y(result), WINDOW[1])
    upper.set_xlabel("x along entrainment [µm]  (y = 0)")
    lower.set_xlabel("y [µm]  (x = 0)")
    lower.legend(
        handles=_curves(upper),
        loc="upper center",
        bbox_to_anchor=(0.5, -0.15),
        ncols=4,
        fontsize=8,
        frameon=False,
    )
    return picture


def _panel(axes: Axes, result: Result, profile: Profile, window: tuple[float, float]) -> None:
    place = profile.coordinate * MICRO
    axes.plot(
        place, profile.hertz_pressure * GIGA, color="0.45", lw=1.0, ls="--", label="dry Hertz"
    )
    axes.plot(place, profile.pressure * GIGA, color=_PRESSURE, lw=1.4, label="pressure")
    axes.set_ylabel("pressure p [GPa]", color=_PRESSURE)
    axes.set_ylim(bottom=0.0)
    inside = (profile.scaled_coordinate >= window[0]) & (profile.scaled_coordinate <= window[1])
    axes.set_xlim(place[inside][0], place[inside][-1])
    film = axes.twinx()
    film.plot(place, profile.dry_gap * MICRO, color=_FILM, lw=0.8, ls=":", label="dry gap")
    film.plot(place, profile.film_thickness * MICRO, color=_FILM, lw=1.4, label="film")
    film.set_ylabel("film h [µm]", color=_FILM)
    central = result.film.central * MICRO
    film.set_ylim(0.0, 4.0 * central if central > 0 else None)
    axes.set_zorder(film.get_zorder() + 1)
    axes.patch.set_visible(False)


def _curves(axes: Axes) -> list[Any]:
    return [line for twin in axes.figure.axes[:1] + axes.figure.axes[2:3] for line in twin.lines]
