"""Colour maps of the page: a field as a PNG with held colours, contour lines, a colour bar."""

import base64
import io
import math
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import count
from typing import Any

import numpy as np
from contourpy import LineType, contour_generator
from matplotlib import colormaps
from PIL import Image

from tehl.base.typing import Array
from tehl.contact.hertz import axes_of
from tehl.explore.axes import Frame, Picture, Scale, number_text, svg, text, ticks, turned
from tehl.explore.shown import Deep, Maps, Section, Shown, Span
from tehl.plots.frame import film_span, stretched_label

_LEFT_MARGIN, _RIGHT_MARGIN, _TOP_MARGIN, _BOTTOM_MARGIN, _BARE_MARGIN = (
    58.0,
    84.0,
    26.0,
    46.0,
    14.0,
)
"""Margins in pixels; the last one at the right without a colour bar."""
_X_LABEL = "x along entrainment [µm]"
_NUMBERS = count()
"""For names of gradients: one in a hidden drawing has no effect on another."""
_CLEAR = 255
"""The last of the colours, which is transparent where a map has no colour for large values."""
_CONTOURED = 128
"""Points along an axis on which contour lines are traced."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Range of a colour scale."""

    low: float
    high: float
    is_log: bool = False

    def joined(self, other: "Limits") -> "Limits":
        """Return the range that has both."""
        return replace(self, low=min(self.low, other.low), high=max(self.high, other.high))


@dataclass(frozen=True, slots=True)
class Look:
    """How a field is drawn."""

    limits: Limits
    levels: list[float]
    """Of the contour lines."""
    colours: str
    """Name of the colour map."""
    label: str
    bar: bool = True
    """Whether a colour bar stands at its right."""
    opens: bool = False
    """Whether what is larger than the limits has no colour: the ground of the page."""


def film_limits(maps: Maps) -> Limits:
    """Return the colours of a film: from just below its minimum to 1.6 times the centre."""
    low, central = film_span(maps.film, maps.central)
    return Limits(0.95 * low, 1.6 * central, True)


def pressure_limits(maps: Maps) -> Limits:
    """Return the colours of a pressure."""
    return Limits(0.0, max(maps.top, 1e-6))


def section_limits(section: Section) -> Limits:
    """Return the colours of a temperature rise."""
    return Limits(min(float(section.rise.min()), 0.0), max(float(section.rise.max()), 1e-3))


def film_picture(
    maps: Maps, limits: Limits, size: tuple[float, float], *, bar: bool = True
) -> Picture:
    """Draw the film with contour lines, Hertz contact and minimum; ``bar`` adds its colours.

    The gap around the contact, above the limits, is the ground of the page.
    """
    levels = [level for level in ticks(limits.low, limits.high, 9) if level > limits.low]
    opens = bool(maps.film.max() > limits.high)
    look = Look(limits, levels, "viridis", "film thickness [nm]", bar, opens)
    return _map(maps, maps.film, look, size)


def pressure_picture(
    maps: Maps, limits: Limits, size: tuple[float, float], *, bar: bool = True
) -> Picture:
    """Draw the pressure with contour lines and the Hertz contact; ``bar`` adds its colours."""
    look = Look(limits, ticks(limits.low, limits.high, 8)[1:], "cividis", "pressure [GPa]", bar)
    return _map(replace(maps, minimum=()), maps.pressure, look, size)


def fringes_picture(shown: Shown, size: tuple[float, float]) -> Picture:
    """Draw the interferogram, which has no colour bar."""
    maps, fringes = shown.maps, shown.fringes
    assert fringes is not None
    frame = _frame(maps.window, maps.stretch, size, _BARE_MARGIN)
    buffer = io.BytesIO()
    Image.fromarray(fringes).save(buffer, "PNG", compress_level=1)
    parts = frame.svg(_X_LABEL, "y [µm]") + _contact(frame, maps)
    overlay = svg(frame.width, frame.height, parts, "interferogram in white light")
    return Picture(frame, overlay, _uri(buffer))


def section_picture(
    section: Section, maps: Maps, limits: Limits, size: tuple[float, float]
) -> Picture:
    """Draw the temperature rise in the plane y = 0, across the film."""
    width, height = size[0], min(size[1], 0.55 * size[0] + 60.0)
    x = Scale(*maps.window[0], _LEFT_MARGIN, width - _RIGHT_MARGIN)
    frame = Frame(x, Scale(0.0, 1.0, height - _BOTTOM_MARGIN, _TOP_MARGIN), width, height)
    axes = (section.x, np.linspace(0.0, 1.0, len(section.rise)))
    look = Look(limits, ticks(limits.low, limits.high, 9), "inferno", "rise over the inlet [K]")
    parts = _contours(section.rise, axes, frame, look.levels)
    for edge in (-maps.half_width, maps.half_width):
        at = frame.x(edge)
        parts += f'<path d="M{at:.1f} {frame.y.start}V{frame.y.end}" class="hertz"/>'
    parts += frame.svg(_X_LABEL, "z / h, from surface 1 to 2")
    return _coloured(section.rise, axes, frame, look, parts, "temperature rise across the film")


def stress_limits(found: Deep) -> Limits:
    """Return the colours of a shear stress."""
    return Limits(0.0, max(float(found.shear.max()), 1e-6))


def stress_picture(found: Deep, maps: Maps, limits: Limits, size: tuple[float, float]) -> Picture:
    """Draw the shear stress in the plane y = 0, below a surface, at one scale along x and z."""
    axes = (found.x, found.z)
    span = float(found.x[0]), float(found.x[-1])
    frame = _frame((span, (float(found.z[0]), 0.0)), 1.0, size, _RIGHT_MARGIN)
    levels = ticks(limits.low, limits.high, 8)[1:]
    look = Look(limits, levels, "viridis", "largest shear stress [GPa]")
    parts = _contours(found.shear, axes, frame, look.levels)
    for edge in (-maps.half_width, maps.half_width):
        at = frame.x(edge)
        parts += f'<path d="M{at:.1f} {frame.y.end}v14" class="hertz"/>'
    parts += text(frame.x.start, frame.y.end - 12, found.words, "small", "start")
    parts += frame.svg(_X_LABEL, "height from the surface [µm]")
    return _coloured(found.shear, axes, frame, look, parts, "shear stress on y = 0")


def heights_picture(
    axes: tuple[Array, Array], heights: Array, size: tuple[float, float]
) -> Picture:
    """Draw the heights of a measured surface [nm] over x and y [um]."""
    low, high = (float(value) for value in np.percentile(heights, (0.5, 99.5)))
    look = Look(
        Limits(low, high if high > low else low + 1.0), [], "viridis", "height outwards [nm]"
    )
    x, y = ((float(axis[0]), float(axis[-1])) for axis in axes)
    frame = _frame((x, y), 1.0, size, _RIGHT_MARGIN)
    parts = frame.svg(_X_LABEL, "y [µm]")
    return _coloured(heights, axes, frame, look, parts, "map of the heights")


def value_at(x_axis: Array, y_axis: Array, field: Array, x: float, y: float) -> float | None:
    """Return a field at a place between its nodes, None outside."""
    if not (x_axis[0] <= x <= x_axis[-1] and y_axis[0] <= y <= y_axis[-1]):
        return None
    return float(np.interp(y, y_axis, [np.interp(x, x_axis, row) for row in field]))


def _map(maps: Maps, field: Array, look: Look, size: tuple[float, float]) -> Picture:
    frame = _frame(maps.window, maps.stretch, size, _RIGHT_MARGIN if look.bar else _BARE_MARGIN)
    axes = (maps.x, maps.y)
    parts = _contours(field, axes, frame, look.levels) + _contact(frame, maps)
    parts += frame.svg(_X_LABEL, stretched_label("y [µm]", maps.stretch)) + _legend(frame, maps)
    return _coloured(field, axes, frame, look, parts, f"map of the {look.label}")


def _coloured(
    field: Array, axes: tuple[Array, Array], frame: Frame, look: Look, parts: str, title: str
) -> Picture:
    """Return a field in colours below a drawing, with its colour bar."""
    parts += _colour_bar(frame, look) if look.bar else ""
    overlay = svg(frame.width, frame.height, parts, title)
    return Picture(frame, overlay, _png(_resampled(field, axes, frame), look))


def _frame(
    window: tuple[Span, Span], stretch: float, size: tuple[float, float], right_margin: float
) -> Frame:
    """Return the scales of a map as large as fits."""
    (left, right), (bottom, top) = window
    shape = (top - bottom) / (right - left) * stretch
    width = min(
        size[0] - _LEFT_MARGIN - right_margin, (size[1] - _TOP_MARGIN - _BOTTOM_MARGIN) / shape
    )
    full = _TOP_MARGIN + width * shape + _BOTTOM_MARGIN
    return Frame(
        Scale(left, right, _LEFT_MARGIN, _LEFT_MARGIN + width),
        Scale(bottom, top, full - _BOTTOM_MARGIN, _TOP_MARGIN),
        _LEFT_MARGIN + width + right_margin,
        full,
    )


def _resampled(field: Array, axes: tuple[Array, Array], frame: Frame) -> Array:
    """Return a field at the pixels of its image, from the top down."""
    *_, width, height = frame.place
    fewer = max(1.0, width / 400.0)  # the browser draws it wider, smoothly
    columns, rows = max(2, round(width / fewer)), max(2, round(height / fewer))
    along = np.linspace(frame.x.low, frame.x.high, columns)
    down = np.linspace(frame.y.high, frame.y.low, rows)
    return np.asarray(_weights(axes[1], down) @ field @ _weights(axes[0], along).T)


def _weights(nodes: Array, places: Array) -> Array:
    """Return the matrix of cubic convolution from nodes to places (Keys 1981, a = -1/2)."""
    return _cached_weights(nodes.tobytes(), places.tobytes(), nodes.dtype.str)


@lru_cache(maxsize=16)
def _cached_weights(nodes: bytes, places: bytes, kind: str) -> Array:
    axis = np.frombuffer(nodes, dtype=kind).astype(float)
    at = np.interp(np.frombuffer(places), axis, np.arange(len(axis)))
    first = np.clip(np.floor(at), 0, len(axis) - 2).astype(int)
    found = np.zeros((len(at), len(axis)), dtype=np.float32)
    for shift in (-1, 0, 1, 2):
        distance = np.abs(at - (first + shift))
        near = 1.5 * distance**3 - 2.5 * distance**2 + 1.0
        far = -0.5 * distance**3 + 2.5 * distance**2 - 4.0 * distance + 2.0
        weight = np.where(distance <= 1.0, near, np.where(distance < 2.0, far, 0.0))
        np.add.at(found, (np.arange(len(at)), np.clip(first + shift, 0, len(axis) - 1)), weight)
    return found.astype(float)


def _png(pixels: Array, look: Look) -> str:
    """Return an image of 256 colours as the address of its data."""
    limits = look.limits
    scale = Scale(limits.low, limits.high, 0.0, _CLEAR, limits.is_log)
    indices = np.clip(scale.pixels(pixels), 0.0, _CLEAR)
    if look.opens:
        indices = np.where(pixels > limits.high, _CLEAR, np.minimum(indices, _CLEAR - 1))
    image = Image.fromarray(indices.astype(np.uint8), "P")
    image.putpalette(_palette(look.colours))
    buffer = io.BytesIO()
    clear = {"transparency": _CLEAR} if look.opens else {}
    image.save(buffer, "PNG", compress_level=1, **clear)
    return _uri(buffer)


@lru_cache(maxsize=4)
def _palette(colours: str) -> bytes:
    table = colormaps[colours](np.linspace(0.0, 1.0, 256))[:, :3]
    return (255.0 * table).round().astype(np.uint8).tobytes()


def _uri(buffer: io.BytesIO) -> str:
    return "data:image/png;base64," + base64.b64encode(buffer.getvalue()).decode("ascii")


def _contours(field: Array, axes: tuple[Array, Array], frame: Frame, levels: list[float]) -> str:
    """Return contour lines as one path."""
    x = np.linspace(max(axes[0][0], frame.x.low), min(axes[0][-1], frame.x.high), _CONTOURED)
    y = np.linspace(max(axes[1][0], frame.y.low), min(axes[1][-1], frame.y.high), _CONTOURED)
    fine = _weights(axes[1], y) @ field @ _weights(axes[0], x).T
    tracer = contour_generator(x, y, fine, line_type=LineType.Separate)
    parts = []
    for level in levels:
        lines: Any = tracer.lines(level)
        for line in lines:
            if len(line) < 6:
                continue
            points = np.stack([frame.x.pixels(line[:, 0]), frame.y.pixels(line[:, 1])], axis=1)
            words = " ".join(f"{a:.1f} {b:.1f}" for a, b in points.tolist())
            parts.append(f"M{words}")
    return f'<path d="{"".join(parts)}" class="contour"/>'


def _contact(frame: Frame, maps: Maps) -> str:
    """Return the Hertz contact, the minimum film, and the arrow of entrainment."""
    rx = frame.x(maps.half_widths[0]) - frame.x(0.0)
    ry = frame.y(0.0) - frame.y(maps.half_widths[1])
    first, second, angle = axes_of(rx, ry, maps.skew)
    turn = "" if maps.skew == 0.0 else f" rotate({-math.degrees(angle):.2f})"
    place = f'transform="translate({frame.x(0.0):.1f} {frame.y(0.0):.1f}){turn}"'
    ring = f'<ellipse {place} rx="{first:.1f}" ry="{second:.1f}"'
    box = 'x="{0}" y="{1}" width="{2}" height="{3}" viewBox="{0} {1} {2} {3}"'.format(*frame.place)
    # that of a line has no end
    parts = [f'<svg {box}>{ring} class="rim"/>{ring} class="hertz"/></svg>']
    for x, y in maps.minimum:
        parts.append(_cross(frame.x(x), frame.y(y)))
    left, low = frame.x.start + 10, frame.y.start - 12
    arrow = f"M{left} {low}h34m-8 -5l8 5l-8 5"
    parts.append(f'<path d="{arrow}" class="halo"/><path d="{arrow}" class="arrow"/>')
    parts.append(text(left, low - 10, "oil enters", "on-map", "start"))
    return "".join(parts)


def _cross(x: float, y: float) -> str:
    cross = f"M{x - 5:.1f} {y:.1f}h10M{x:.1f} {y - 5:.1f}v10"
    return f'<path d="{cross}" class="halo"/><path d="{cross}" class="minimum"/>'


def _legend(frame: Frame, maps: Maps) -> str:
    """Return what dashed line and cross are, above the map."""
    y, left = frame.y.end - 12, frame.x.start
    parts = [f'<path d="M{left} {y - 4}h22" class="hertz-key"/>']
    parts.append(text(left + 28, y, "Hertz contact", "small", "start"))
    if maps.minimum:
        x = left + 130
        parts.append(f'<path d="M{x - 5} {y - 4}h10M{x} {y - 9}v10" class="minimum"/>')
        parts.append(text(x + 12, y, "minimum film", "small", "start"))
    return "".join(parts)


def _colour_bar(frame: Frame, look: Look) -> str:
    """Return the colour bar at the right."""
    limits = look.limits
    left, top, height = frame.x.end + 14, frame.y.end, frame.y.start - frame.y.end
    scale = Scale(limits.low, limits.high, top + height, top, limits.is_log)
    table = np.frombuffer(_palette(look.colours), dtype=np.uint8).reshape(-1, 3)[:: 255 // 15]
    stops = "".join(
        f'<stop offset="{k / (len(table) - 1):.3f}" stop-color="rgb({r},{g},{b})"/>'
        for k, (r, g, b) in enumerate(table.tolist())
    )
    name = f"bar-{look.colours}-{next(_NUMBERS)}"
    parts = [
        f'<defs><linearGradient id="{name}" x1="0" y1="1" x2="0" y2="0">{stops}'
        f'</linearGradient></defs><rect x="{left}" y="{top}" width="13" height="{height:.1f}" '
        f'fill="url(#{name})" class="bar"/>'
    ]
    for value in ticks(limits.low, limits.high, max(3, int(height / 40))):
        y = scale(value)
        parts.append(f'<path d="M{left + 13} {y:.1f}h4" class="tick"/>')
        parts.append(text(left + 20, y + 4, number_text(value), "", "start"))
    parts.append(turned(left + 62, top + 0.5 * height, look.label, "label"))
    if look.opens:
        parts.append(
            f'<path d="M{left} {top}l6.5 -11l6.5 11z" class="frame">'
            "<title>more has no colour</title></path>"
        )
    return "".join(parts)
