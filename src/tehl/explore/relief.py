"""The film in three dimensions, as a figure that can be turned."""

import base64
import math
from typing import Any

import numpy as np

from tehl.explore.colour_map import Limits
from tehl.explore.shown import Maps
from tehl.typing import Array

_POINTS = 90
"""Points along an axis that are sent."""
_SHADES = 12


def relief_figure(maps: Maps, limits: Limits, size: tuple[float, float]) -> dict[str, Any]:
    """Return the film as a surface, cut off above the colours of its map."""
    rows, columns = (max(1, round(count / _POINTS)) for count in maps.film.shape)
    x, y, film = maps.x[::columns], maps.y[::rows], maps.film[::rows, ::columns]
    axis = {
        "color": "#7a818c",
        "gridcolor": "rgba(128,128,128,.25)",
        "backgroundcolor": "rgba(0,0,0,0)",
    }
    surface = {
        "type": "surface",
        "x": _packed(x),
        "y": _packed(y),
        "z": _packed(np.minimum(film, limits.high)),
        "cmin": limits.low,
        "cmax": limits.high,
        "colorscale": _log_colours(limits),
        "colorbar": {"title": {"text": "film [nm]"}, "thickness": 13, "len": 0.7},
        "hovertemplate": "x %{x:.0f} µm, y %{y:.0f} µm, h %{z:.4g} nm<extra></extra>",
    }
    scene = {
        "xaxis": {"title": {"text": "x [µm]"}, **axis},
        "yaxis": {"title": {"text": "y [µm]"}, **axis},
        "zaxis": {"title": {"text": "h [nm]"}, "range": [0, limits.high], **axis},
        "aspectmode": "manual",
        "aspectratio": {"x": 1.2, "y": 1.1, "z": 0.55},
        "camera": {"eye": {"x": -1.25, "y": -1.35, "z": 0.95}},
    }
    layout = {
        "width": size[0],
        "height": size[1],
        "margin": {"l": 0, "r": 0, "t": 0, "b": 0},
        "paper_bgcolor": "rgba(0,0,0,0)",
        "font": {"color": "#7a818c", "size": 12},
        "scene": scene,
        "uirevision": "held",
    }
    return {"data": [surface], "layout": layout, "config": {"displayModeBar": False}}


def _packed(values: Array) -> dict[str, Any]:
    """Return an array as plotly reads it from base64."""
    plain = np.ascontiguousarray(values, dtype="<f4")
    found: dict[str, Any] = {"dtype": "f4", "bdata": base64.b64encode(plain.tobytes()).decode()}
    if plain.ndim > 1:
        found["shape"] = ",".join(map(str, plain.shape))
    return found


def _log_colours(limits: Limits) -> list[list[Any]]:
    """Return the colours of the map, which are logarithmic, over a linear scale."""
    from matplotlib import colormaps  # noqa: PLC0415 (with the first relief)

    found = []
    for k in range(_SHADES + 1):
        part = k / _SHADES
        value = limits.low * (limits.high / limits.low) ** part
        at = (value - limits.low) / (limits.high - limits.low)
        red, green, blue, _ = (round(255 * c) for c in colormaps["viridis"](part))
        found.append([min(max(at, 0.0), 1.0), f"rgb({red},{green},{blue})"])
    assert math.isclose(found[-1][0], 1.0, abs_tol=1e-9)
    return found
