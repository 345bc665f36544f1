"""The film in three dimensions, as a figure that can be turned."""

import base64
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_hex

from tehl.base.typing import Array
from tehl.explore.colour_map import Limits
from tehl.explore.shown import Maps


def relief_figure(maps: Maps, limits: Limits, size: tuple[float, float]) -> dict[str, Any]:
    """Return the film as a surface, without what lies above the colours of its map."""
    x, y, film = _bowl(maps, limits.high)
    axis = {
        "color": "#7a818c",
        "gridcolor": "rgba(128,128,128,.25)",
        "backgroundcolor": "rgba(0,0,0,0)",
    }
    surface = {
        "type": "surface",
        "x": _packed(x),
        "y": _packed(y),
        "z": _packed(film),
        "lighting": {"ambient": 0.75, "diffuse": 0.35, "specular": 0.05, "roughness": 0.9},
        "cmin": limits.low,
        "cmax": limits.high,
        "colorscale": _log_colours(limits),
        "colorbar": {"title": {"text": "film [nm]"}, "thickness": 13, "len": 0.7},
        "hovertemplate": "x %{x:.0f} µm, y %{y:.0f} µm, h %{z:.4g} nm<extra></extra>",
    }
    away = 1.15 if size[0] > 560.0 else 1.4  # pixels; axes need room in a narrow one
    scene = {
        "xaxis": {"title": {"text": "x [µm]"}, **axis},
        "yaxis": {"title": {"text": "y [µm]"}, **axis},
        "zaxis": {"title": {"text": "h [nm]"}, "range": [0, limits.high], **axis},
        "aspectmode": "manual",
        "aspectratio": {"x": 1.2, "y": 1.1, "z": 0.55},
        "camera": {"eye": {"x": -1.25 * away, "y": -1.35 * away, "z": 0.95 * away}},
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


def _bowl(maps: Maps, top: float) -> tuple[Array, Array, Array]:
    """Return places [um] and film [nm] on rays that end where the film exceeds ``top``."""
    from scipy.ndimage import map_coordinates  # noqa: PLC0415 (with the first relief)

    angle = np.linspace(0.0, 2.0 * np.pi, 121)[:, None]
    ax, ay = maps.half_widths
    reach = np.full(angle.shape, np.inf)
    for edges, way in zip(maps.window, (ax * np.cos(angle), ay * np.sin(angle)), strict=True):
        edge = np.where(way > 0, edges[1], edges[0])
        reach = np.minimum(reach, np.abs(edge) / np.maximum(np.abs(way), 1e-9))

    def sampled(radius: Array) -> tuple[Array, Array, Array]:
        x, y = ax * radius * np.cos(angle), ay * radius * np.sin(angle)
        rows = np.interp(y, maps.y, np.arange(len(maps.y)))
        columns = np.interp(x, maps.x, np.arange(len(maps.x)))
        return x, y, map_coordinates(maps.film, (rows, columns), order=1)

    part = np.linspace(0.0, 1.0, 200)  # places among which the rim is found
    along = sampled(reach * part)[2]
    last = part.size - 1 - np.argmax((along <= top)[:, ::-1], axis=1)[:, None]
    after = np.minimum(last + 1, part.size - 1)
    low, high = (np.take_along_axis(along, place, axis=1) for place in (last, after))
    rim = part[last] + np.clip((top - low) / np.maximum(high - low, 1e-9), 0.0, 1.0) * part[1]
    x, y, film = sampled(reach * np.minimum(rim, 1.0) * np.linspace(0.0, 1.0, 48))
    return x, y, np.minimum(film, top)


def _packed(values: Array) -> dict[str, Any]:
    """Return an array as plotly reads it from base64."""
    plain = np.ascontiguousarray(values, dtype="<f4")
    found: dict[str, Any] = {"dtype": "f4", "bdata": base64.b64encode(plain.tobytes()).decode()}
    if plain.ndim > 1:
        found["shape"] = ",".join(map(str, plain.shape))
    return found


def _log_colours(limits: Limits) -> list[list[Any]]:
    """Return the colours of the map, which are logarithmic, over a linear scale."""
    ratio, parts = limits.high / limits.low, np.linspace(0.0, 1.0, 13).tolist()
    places = [(ratio**part - 1.0) / (ratio - 1.0) for part in parts]
    return [[at, to_hex(colormaps["viridis"](k))] for at, k in zip(places, parts, strict=True)]
