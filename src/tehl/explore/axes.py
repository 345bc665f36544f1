"""Axes of the pictures on the page: places of ticks, scales from data to pixels, SVG of a frame."""

import math
from dataclasses import dataclass
from html import escape

import numpy as np

from tehl.base.typing import Array

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
_TICK_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class Scale:
    """Maps a range of data to a range of pixels, linear or logarithmic."""

    low: float
    high: float
    start: float
    end: float
    """Pixels of ``low`` and ``high``."""
    is_log: bool = False

    def __call__(self, value: float) -> float:
        """Return the pixel of a value."""
        return float(self.pixels(np.array(value)))

    def pixels(self, values: Array) -> Array:
        """Return the pixels of values."""
        if self.is_log:
            part = np.log(np.maximum(values, 1e-300) / self.low) / math.log(self.high / self.low)
        else:
            part = (values - self.low) / (self.high - self.low)
        return np.asarray(self.start + part * (self.end - self.start), dtype=float)

    def data(self, pixel: float) -> float:
        """Return the value at a pixel."""
        part = (pixel - self.start) / (self.end - self.start)
        if self.is_log:
            return float(self.low * (self.high / self.low) ** part)
        return float(self.low + part * (self.high - self.low))

    def ticks(self, count: int) -> list[float]:
        """Return about ``count`` round values inside."""
        if self.is_log and self.high / self.low > 8.0:
            return log_ticks(self.low, self.high, count)
        return ticks(self.low, self.high, count)


def ticks(low: float, high: float, count: int) -> list[float]:
    """Return about ``count`` round values from ``low`` to ``high``."""
    if not (math.isfinite(low) and math.isfinite(high) and high > low):
        return []
    rough = (high - low) / max(count, 1)
    power = 10.0 ** math.floor(math.log10(rough))
    step = min((s * power for s in _STEPS), key=lambda s: abs(math.log(s / rough)))
    first = math.ceil(low / step - _TICK_ROUNDING)
    last = math.floor(high / step + _TICK_ROUNDING)
    return [number * step for number in range(first, last + 1)]


def log_ticks(low: float, high: float, count: int) -> list[float]:
    """Return powers of ten, and twice and five times them where there is room."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    for factors in ((1, 2, 5), (1,)):
        found = [f * 10.0**p for p in powers for f in factors]
        found = [value for value in found if low * 0.999 <= value <= high * 1.001]
        if len(found) <= count + 2:
            return found
    return found[:: max(1, math.ceil(len(found) / count))]


def number_text(value: float) -> str:
    """Return the label of a tick: 0.01, 250, 2e-05."""
    text = f"{value:.4g}" if abs(value) >= _TICK_ROUNDING else "0"
    if 1e4 <= abs(value) < 1e6:
        text = f"{value:.0f}"
    return text.replace("e-0", "e-").replace("e+0", "e").replace("-", "−")


@dataclass(frozen=True, slots=True)
class Frame:
    """A plot inside a picture: its scales, and the size of the picture in pixels."""

    x: Scale
    y: Scale
    width: float
    height: float

    @property
    def place(self) -> tuple[float, float, float, float]:
        """Left, top, width and height of the plot in pixels."""
        return self.x.start, self.y.end, self.x.end - self.x.start, self.y.start - self.y.end

    def svg(self, x_label: str, y_label: str, *, grid: bool = False, colour: str = "ink") -> str:
        """Return ticks and labels below and at the left; ``colour`` is that of the y axis."""
        left, right, bottom, top = self.x.start, self.x.end, self.y.start, self.y.end
        rectangle = 'x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"'.format(*self.place)
        parts = [f'<rect {rectangle} class="frame"/>']
        for value in self.x.ticks(max(3, int((right - left) / 75))):
            at = self.x(value)
            if grid:
                parts.append(_line(at, bottom, at, top, "grid"))
            parts.append(_line(at, bottom, at, bottom + 4, "tick"))
            parts.append(text(at, bottom + 17, number_text(value)))
        parts += self.y_ticks(left, -1, grid=grid, colour=colour)
        parts.append(text(0.5 * (left + right), bottom + 36, x_label, "label"))
        parts.append(turned(left - 44, 0.5 * (bottom + top), y_label, f"label {colour}"))
        return "".join(parts)

    def y_ticks(self, at: float, side: int, *, grid: bool, colour: str) -> list[str]:
        """Return the ticks of the y axis at one side, -1 the left."""
        parts, anchor = [], "end" if side < 0 else "start"
        for value in self.y.ticks(max(3, int((self.y.start - self.y.end) / 45))):
            y = self.y(value)
            if grid:
                parts.append(_line(self.x.start, y, self.x.end, y, "grid"))
            parts.append(_line(at, y, at + 4 * side, y, "tick"))
            parts.append(text(at + 7 * side, y + 4, number_text(value), colour, anchor))
        return parts

    def path(self, x: Array, y: Array, style: str) -> str:
        """Return a polyline through points; it is interrupted where a value is not finite."""
        px, py = self.x.pixels(x), self.y.pixels(y)
        pieces, pen = [], "M"
        for one, two in zip(px.tolist(), py.tolist(), strict=True):
            if not (math.isfinite(one) and math.isfinite(two)):
                pen = "M"
                continue
            pieces.append(f"{pen}{one:.1f} {two:.1f}")
            pen = "L"
        return f'<path d="{"".join(pieces)}" class="{style}"/>'


@dataclass(frozen=True, slots=True)
class Picture:
    """A drawing and its scales, over a PNG of colours in their place where it is a map."""

    frame: Frame
    overlay: str
    image: str = ""


def _line(x1: float, y1: float, x2: float, y2: float, style: str) -> str:
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" class="{style}"/>'


def text(x: float, y: float, words: str, style: str = "", anchor: str = "middle") -> str:
    """Return words at a place."""
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" class="{style}">'
        f"{escape(words)}</text>"
    )


def turned(x: float, y: float, words: str, style: str) -> str:
    """Return words that read upwards."""
    return (
        f'<text transform="translate({x:.1f} {y:.1f}) rotate(-90)" text-anchor="middle" '
        f'class="{style}">{escape(words)}</text>'
    )


def keys(left: float, step: float, *names: tuple[str, str]) -> str:
    """Return the names of lines of some styles in a row at the top, ``step`` pixels apart."""
    parts = []
    for number, (name, style) in enumerate(names):
        at = left + step * number
        parts.append(f'<path d="M{at} 12h22" class="line {style}"/>')
        parts.append(text(at + 28, 16, name, "small", "start"))
    return "".join(parts)


def svg(width: float, height: float, parts: str, title: str) -> str:
    """Return a drawing with its title for screen readers."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
        f'viewBox="0 0 {width:.0f} {height:.0f}" role="img" aria-label="{escape(title)}">'
        f"{parts}</svg>"
    )
