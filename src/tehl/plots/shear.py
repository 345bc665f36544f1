"""How strongly a film is sheared."""

import numpy as np
from matplotlib.figure import Figure

from tehl.errors import InputError
from tehl.plots.frame import (
    MICRO,
    colour_axes,
    contact_axes,
    entrainment_arrow,
    inner_levels,
    legend_above,
    map_figure,
    window_part,
)
from tehl.result import Result

SHEAR_COLOURS = "cividis"


def shear_stress_map(result: Result) -> Figure:
    """Draw the magnitude of the shear stress at mid-film as a map.

    Parameters
    ----------
    result : Result
        With shear stresses.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, in micrometres and megapascals.

    Raises
    ------
    InputError
        If the result has no shear stresses.
    """
    shear, traction = result.shear, result.traction
    if shear is None or traction is None:
        raise InputError("the result has no shear stresses to draw")
    note = (
        f"SRR = {result.problem.slide_roll_ratio:.4g}; traction {traction.mid_film:.4g} "
        f"at mid-film, {traction.surface_1:.4g} and {traction.surface_2:.4g} on surfaces 1 and 2"
    )
    picture = map_figure(result, note)
    axes = contact_axes(picture, result)
    part = window_part(result)
    x, y = result.x[part[1]] * MICRO, result.y[part[0]] * MICRO
    stress = np.hypot(shear.mid_film, shear.across)[part] * 1e-6
    top = float(np.max(stress, initial=0.0, where=np.isfinite(stress)))
    levels = inner_levels(0.0, top)
    mesh = axes.pcolormesh(x, y, stress, shading="gouraud", cmap=SHEAR_COLOURS, rasterized=True)
    mesh.set_clim(0.0, top if top > 0 else 1.0)
    lines = axes.contour(x, y, stress, levels=levels, colors="black", linewidths=0.6)
    entrainment_arrow(axes)
    legend_above(axes)
    bar = picture.colorbar(
        mesh, cax=colour_axes(axes), label="size of the shear stress at mid-film [MPa]"
    )
    if levels.size:
        bar.add_lines(lines)
    bar.set_ticks([0.0, *levels])
    return picture
