"""Map of the pressure where surfaces touch through a boundary film."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tehl.base.errors import InputError
from tehl.plots.frame import MAP, colour_axes, figure_of, map_axes, window_part, window_places
from tehl.post.boundary_contact import touching, touching_nodes
from tehl.result.solution import Solution


def contact_map(result: Solution, *, ax: Axes | None = None, title: bool | None = True) -> Figure:
    """Draw the pressure of film and contact together [GPa] where the surfaces touch, as a map.

    Parameters
    ----------
    result : Solution
        With a boundary film.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.

    Raises
    ------
    InputError
        If the case states no boundary film, or the solve diverged.
    """
    found, shared = result.contact, touching(result)
    if found is None or shared is None:
        raise InputError("the result has no contact to draw: the case states none, or diverged")
    note = f"the surfaces touch on {100 * shared.area_part:.2g} % of the Hertz area"
    if shared.patches is None:
        note = "the surfaces touch nowhere"
    axes = map_axes(result, note, ax=ax, title=title)
    both = (result.pressure + found.pressure) * 1e-9
    part = window_part(result)
    shown = np.where(touching_nodes(result), both, np.nan)[part]
    top = float(np.max(shown, initial=0.0, where=np.isfinite(shown)))
    span = (0.0, top if top > 0 else 1.0)
    mesh = axes.pcolormesh(*window_places(result), shown, cmap="cividis", clim=span, **MAP)
    label = "pressure where surfaces touch [GPa]"
    figure_of(axes).colorbar(mesh, cax=colour_axes(axes), label=label)
    return figure_of(axes)
