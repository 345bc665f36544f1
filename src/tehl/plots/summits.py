"""Map of the pressure that asperities finer than the grid carry."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tehl.base.errors import InputError
from tehl.plots.frame import MAP, colour_axes, figure_of, map_axes, window_part, window_places
from tehl.post.summits import load_sharing
from tehl.result.solution import Solution


def asperity_map(result: Solution, *, ax: Axes | None = None, title: bool | None = True) -> Figure:
    """Draw the pressure of the asperities [MPa] as a map, averaged over many of them.

    Parameters
    ----------
    result : Solution
        With a law of asperities.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.

    Raises
    ------
    InputError
        If the case has no asperities, or the solve diverged.
    """
    found, shared = result.asperities, load_sharing(result)
    if found is None or shared is None:
        raise InputError("the result has no asperities to draw: the case states none, or diverged")
    note = (
        f"asperities carry {100 * shared.share:.3g} % of the load on "
        f"{100 * shared.area_part:.2g} % of the Hertz area"
    )
    axes = map_axes(result, note, ax=ax, title=title)
    pressure = found.pressure[window_part(result)] * 1e-6
    top = float(np.max(pressure, initial=0.0, where=np.isfinite(pressure)))
    span = (0.0, top if top > 0 else 1.0)
    mesh = axes.pcolormesh(*window_places(result), pressure, cmap="cividis", clim=span, **MAP)
    label = "pressure of the asperities [MPa]"
    figure_of(axes).colorbar(mesh, cax=colour_axes(axes), label=label)
    return figure_of(axes)
