"""Arrows on a map of a contact: entrainment, velocities of surfaces that spin, sliding."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import AbstractPathEffect, withStroke

from tehl.base.typing import Array
from tehl.result.solution import Solution

MICRO, NANO = 1e6, 1e9
ARROWS = 5
"""Velocities along each axis of a map of surfaces that spin."""


def entrainment_arrow(axes: Axes) -> None:
    """Draw the direction of entrainment, in one size on all maps."""
    place: dict[str, Any] = {"xycoords": "axes points", "zorder": 6}
    style = {"arrowstyle": "-|>", "color": "white", "lw": 1.6, "shrinkA": 0, "shrinkB": 0}
    arrow: Any = axes.annotate("", (46, 9), (6, 9), arrowprops=style, **place)
    arrow.arrow_patch.set_path_effects(outline("0.15", 3.2))
    words = axes.annotate("oil enters", (6, 15), color="white", fontsize=8, **place)
    words.set_path_effects(outline("0.15", 2.4))


def outline(colour: str, width: float) -> list[AbstractPathEffect]:
    """Return path effects that keep a thin line or a text legible on any ground.

    Parameters
    ----------
    colour : str
        Of the halo, as matplotlib names it.
    width : float
        Of the halo together with what it surrounds [point].
    """
    return [withStroke(linewidth=width, foreground=colour)]


def spinning_arrows(axes: Axes, result: Solution) -> None:
    """Draw the mean velocities of surfaces that spin.

    Parameters
    ----------
    axes : Axes
        Of a map in micrometres.
    result : Solution
        With the motion of its surfaces.
    """
    motion = result.problem.motion
    x, y = _arrow_places(axes)
    u = motion.entrainment_speed - motion.mean_spin * y / MICRO
    _arrows(axes, (u, motion.mean_spin * x / MICRO), "white")


def sliding_arrows(axes: Axes, result: Solution) -> None:
    """Draw the sliding velocities u_1 - u_2 on a map, where they are not all along x.

    Parameters
    ----------
    axes : Axes
        Of a map in micrometres.
    result : Solution
        With the motion of its surfaces.
    """
    if not result.problem.motion.is_plain:
        x, y = _arrow_places(axes)
        _arrows(axes, result.problem.motion.sliding_field(x / MICRO, y / MICRO), "tab:orange")


def _arrow_places(axes: Axes) -> tuple[Array, Array]:
    places = (np.linspace(*span, ARROWS + 2)[1:-1] for span in (axes.get_xlim(), axes.get_ylim()))
    x, y = np.meshgrid(*places)
    return x, y


def _arrows(axes: Axes, field: tuple[Array, Array], colour: str) -> None:
    fastest = float(np.hypot(*field).max()) or 1.0
    style: dict[str, Any] = {"color": colour, "width": 0.003, "headwidth": 4.0, "zorder": 4}
    # length of the longest arrow over the distance of arrows along x
    style |= {"angles": "xy", "pivot": "mid", "scale": fastest * ARROWS / 0.5}
    arrows = axes.quiver(*_arrow_places(axes), *field, **style)
    arrows.set_path_effects(outline("0.3", 0.9))
