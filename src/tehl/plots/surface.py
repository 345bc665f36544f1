"""A measured surface: its map, its heights and its spectrum."""

from itertools import product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.ticker import FuncFormatter, MaxNLocator

from tehl.plots.arrows import MICRO, outline
from tehl.plots.frame import BLUE, ORANGE, PLAIN, STEPS, Picture, contact_rim
from tehl.roughness.preview import Mesh, Preview, View, view

_SLENDER_MAP = 2.0


def surface_preview(preview: Preview, *, title: bool | None = True) -> Figure:
    """Draw a measured surface after its preparation.

    The picture has the map with the contact, rotated and shifted as stated, the distribution of
    heights, and the power spectral density with the waves that the mesh loses.

    Parameters
    ----------
    preview : Preview
        With the mesh of a contact, or without one.
    title : bool or None
        Whether the figure names file and statistics above.
    """
    picture, seen = Picture(figsize=(10.5, 5.4), layout="constrained"), view(preview)
    width, height = seen.size
    if width > _SLENDER_MAP * height:
        parts = picture.subfigures(2, 1, squeeze=False, height_ratios=[0.8, 1.0])[:, 0]
        panels = parts[1].subplots(1, 2)
    else:
        slender = height > _SLENDER_MAP * width
        shares = [0.62 if slender else 1.35, 1.0]
        parts = picture.subfigures(1, 2, squeeze=False, width_ratios=shares)[0]
        panels = parts[1].subplots(2, 1)
        if slender:
            picture.set_figwidth(8.0)
    found, name = preview.statistics, preview.file.rpartition("/")[2].replace("$", r"\$")
    heights = ", ".join(
        f"{word} = {_height(value)}"
        for word, value in (("Sq", found.sq), ("Sa", found.sa), ("Sz", found.sz))
    )
    shape = f"Ssk = {found.ssk:.2f}, Sku = {found.sku:.2f}"
    if title:
        picture.suptitle(f"{name}\n{heights}, {shape}", fontsize=9)
    _draw_map(parts[0].add_subplot(), preview, seen)
    _draw_heights(panels[0], preview)
    _draw_spectrum(panels[1], preview)
    return picture


def _height(metres: float) -> str:
    return f"{metres * 1e9:.3g} nm" if abs(metres) < 1e-7 else f"{metres * 1e6:.3g} µm"


def _height_unit(preview: Preview) -> tuple[float, str]:
    return (1e9, "nm") if preview.statistics.sq < 3e-8 else (MICRO, "µm")


def _draw_map(axes: Axes, preview: Preview, seen: View) -> None:
    width, height = seen.size
    (left, right), (bottom, top) = seen.window
    factor, unit = _height_unit(preview)
    few = preview.heights.values.ravel()
    few = few[:: max(1, few.size // 10**6)]  # enough for percentiles
    low, high = np.percentile(few, [0.1, 99.9]) * factor
    extent = (left * MICRO, right * MICRO, bottom * MICRO, top * MICRO)
    style: dict[str, Any] = {"origin": "lower", "interpolation": "nearest", "cmap": "viridis"}
    image = axes.imshow(seen.values * factor, extent=extent, vmin=low, vmax=high, **style)
    axes.set(xlabel="x along entrainment [µm]", ylabel="y [µm]")
    for axis, slender in ((axes.xaxis, height / width), (axes.yaxis, width / height)):
        axis.set_major_locator(MaxNLocator(2 if slender > _SLENDER_MAP else 6, steps=STEPS))
    where = "bottom" if 1.4 * height < width <= _SLENDER_MAP * height else "right"
    label = f"height outwards [{unit}]"
    bar: dict[str, Any] = {"extend": "both", "aspect": 35, "shrink": 0.9}
    axes.figure.colorbar(image, ax=axes, location=where, label=label, **bar)
    labels = []
    if preview.mesh is not None:
        labels.append(_draw_contact(axes, preview.mesh))
    if seen.corners is not None:
        corners = {tuple(corner) for corner in np.round(seen.corners * 1e9)}
        window = {tuple(np.round(np.array(place) * 1e9)) for place in product(*seen.window)}
        if corners != window:  # the map is a part of its window, or rotated in it
            edges = Polygon(seen.corners * MICRO, fill=False, color="white", lw=0.8)
            axes.add_patch(edges).set_path_effects(outline("0.2", 1.6))
            labels.append("thin: edges of the map")
    axes.set_title(", ".join(labels), fontsize=8)


def _draw_contact(axes: Axes, mesh: Mesh) -> str:
    """Draw the contact within the present limits; return its caption."""
    limits = axes.get_xlim(), axes.get_ylim()
    half_x, half_y = (MICRO * half for half in mesh.half_widths)
    style: dict[str, Any] = {"color": "white", "ls": "--", "lw": 1.3}
    rim = contact_rim((half_x, half_y), mesh.skew, straight=mesh.straight, **style)
    axes.add_patch(rim).set_path_effects(outline("0.2", 2.4))
    axes.set(xlim=limits[0], ylim=limits[1])
    reaches = zip(limits, (half_x, half_y), strict=True)
    inside = all(low <= -half and half <= high for (low, high), half in reaches)
    return "dashed: Hertz contact" + ("" if inside else ", cut off by this picture")


def _draw_heights(axes: Axes, preview: Preview) -> None:
    factor, unit = _height_unit(preview)
    off = (preview.heights.values - preview.heights.values.mean()).ravel() * factor
    sq = preview.statistics.sq * factor
    reach = float(np.clip(np.abs(off).max(), 3.5 * sq, 8.0 * sq))
    axes.hist(off, bins=81, range=(-reach, reach), density=True, color="#9db8dc")
    places = np.linspace(-reach, reach, 300)
    normal = np.exp(-0.5 * (places / sq) ** 2) / (sq * np.sqrt(2.0 * np.pi))
    axes.plot(places, normal, color="0.25", lw=1.0, ls="--", label="normal, same Sq")
    axes.set(xlabel=f"height outwards [{unit}]", ylabel=f"share [1/{unit}]", xlim=(-reach, reach))
    axes.set(yscale="log", ylim=(3e-5 / sq, 2.0 / sq))
    axes.legend(loc="upper left", **PLAIN)


def _draw_spectrum(axes: Axes, preview: Preview) -> None:
    found, mesh = preview.spectrum, preview.mesh
    seen = found.density > 0
    lengths, density = 2.0 * np.pi / found.wave_number * MICRO, found.density[seen] * MICRO**4
    axes.loglog(lengths[seen], density, color=BLUE, lw=1.3)
    axes.set(xlabel="wavelength [µm]", ylabel="power density [µm$^4$]")
    axes.xaxis.set_major_formatter(FuncFormatter(lambda length, _: f"{length:g}"))
    axes.set_ylim(1e-12, 1.0)
    if density.size:  # without the rounding errors of filtered waves
        top = density.max()
        axes.set_ylim(max(0.5 * density.min(), 1e-12 * top), 3.0 * top)
    axes.invert_xaxis()
    axes.grid(which="major", lw=0.3)
    if mesh is None or preview.lost is None:
        return
    cut_off = 4.0 * max(mesh.spacing) * MICRO
    longest, shortest = axes.get_xlim()
    if cut_off > shortest:
        axes.axvspan(min(cut_off, longest), shortest, color=ORANGE, alpha=0.15, lw=0)
        axes.axvline(cut_off, color=ORANGE, lw=1.0)
    axes.set_xlim(max(longest, 1.1 * cut_off), shortest)
    nodes = "{} x {} nodes".format(*mesh.points)
    lost = f"lost on {nodes}: {100 * preview.lost:.2g} % of Sq²"
    axes.set_title(lost, fontsize=8, color=ORANGE)
