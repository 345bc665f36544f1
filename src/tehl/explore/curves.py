"""Line charts of the page: film and pressure on the centre lines, and swept quantities."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tehl.explore.axes import Frame, Picture, Scale, keys, svg, turned
from tehl.explore.shown import Line, Lines, Shown

_CURVE_LEFT, _CURVE_RIGHT, _CURVE_TOP, _CURVE_BOTTOM = 62.0, 62.0, 28.0, 46.0
_SPARE_RATIO = 1.3
"""Ends of an axis of frequencies over the first and the last one."""
_NEAR_PIXELS = 30.0
"""Pixels from the pointer within which a swept value is read."""


@dataclass(frozen=True, slots=True)
class Point:
    """A swept value; ``y`` is None where the solve did not converge."""

    x: float
    y: float | None
    error: float = 0.0
    """Relative error bar [-]."""


def line_charts(
    shown: Shown, size: tuple[float, float], top: tuple[float, float], other: Shown | None = None
) -> list[Picture]:
    """Draw film and pressure along x and along y, those of another state fainter.

    ``top`` are the ends of the scales of film and pressure.
    """
    height = max(190.0, 0.5 * size[1])
    labels = ("x along entrainment [µm], y = 0", "y [µm], x = 0")
    faint = (None, None) if other is None else (other.lines.x, other.lines.y)
    charts = []
    for number, line in enumerate((shown.lines.x, shown.lines.y)):
        x = Scale(*shown.maps.window[number], _CURVE_LEFT, size[0] - _CURVE_RIGHT)
        charts.append(_centre_line((line, faint[number]), labels[number], x, height, top))
    return charts


def line_tops(lines: Lines) -> tuple[float, float]:
    """Return the ends of the scales of film and pressure."""
    _, film, pressure, hertz = lines.x
    middle = float(np.median(film[hertz > 0])) if (hertz > 0).any() else float(film.max())
    return 3.0 * max(middle, 1e-3), 1.12 * max(float(pressure.max()), float(hertz.max()), 1e-6)


def values_on_line(lines: Lines, charts: Sequence[Picture], right: float, down: float) -> str:
    """Return film and pressure on a centre line at a pixel of its charts, one below the other."""
    for name, line, chart in zip("xy", (lines.x, lines.y), charts, strict=True):
        if down < chart.frame.height:
            place, film, pressure, hertz = line
            at = chart.frame.x.data(right)
            if not place[0] <= at <= place[-1]:
                return ""
            h, p, dry = (float(np.interp(at, place, one)) for one in (film, pressure, hertz))
            return f"{name} = {at:.0f} µm:  h = {h:.4g} nm,  p = {p:.3g} GPa,  Hertz {dry:.3g} GPa"
        down -= chart.frame.height
    return ""


def nearest(points: Sequence[Point], frame: Frame, right: float) -> Point | None:
    """Return the swept value nearest to a pixel along x, None if none is near."""
    known = [point for point in points if point.y is not None]
    found = min(known, key=lambda point: abs(frame.x(point.x) - right), default=None)
    return found if found is not None and abs(frame.x(found.x) - right) < _NEAR_PIXELS else None


def _centre_line(
    lines: tuple[Line, Line | None], label: str, x: Scale, height: float, top: tuple[float, float]
) -> Picture:
    size, low = (x.end + _CURVE_RIGHT, height), height - _CURVE_BOTTOM
    of_film = Frame(x, Scale(0.0, top[0], low, _CURVE_TOP), *size)
    of_pressure = Frame(x, Scale(0.0, top[1], low, _CURVE_TOP), *size)
    parts = of_film.svg(label, "film [nm]", grid=True, colour="film")
    parts += "".join(of_pressure.y_ticks(x.end, 1, grid=False, colour="pressure"))
    parts += turned(x.end + 48, 0.5 * (low + _CURVE_TOP), "pressure [GPa]", "label pressure")
    names = [("film", "film"), ("pressure", "pressure"), ("Hertz", "dashed pressure")]
    for line, style in ((lines[1], "faint "), (lines[0], "")):
        if line is None:
            continue
        place, film, pressure, hertz = line
        if not style:
            parts += of_pressure.path(place, hertz, "line dashed pressure")
        clipped = np.where(pressure <= top[1], pressure, np.nan)
        parts += of_pressure.path(place, clipped, f"line {style}pressure")
        clipped = np.where(film <= top[0], film, np.nan)
        parts += of_film.path(place, clipped, f"line {style}film")
    if lines[1] is not None:
        names.append(("pinned, fainter", "faint film"))
    parts += keys(x.start, 82, *names)
    return Picture(of_film, svg(*size, parts, f"film and pressure over {label}"))


def swept_chart(
    points: Sequence[Point],
    labels: tuple[str, str],
    size: tuple[float, float],
    span: tuple[float, float],
    here: Point | None = None,
) -> Picture:
    """Draw a swept quantity with error bars, and the present state; ``span`` is the x axis."""
    known = [point for point in points if point.y is not None]
    wide = span[0] > 0 and span[1] / span[0] > 8.0
    values = [at * (1 + side * one.error) for one in known if (at := one.y) for side in (-1, 1)]
    values += [here.y] if here is not None and here.y is not None else []
    y = _y_scale(values, size)
    frame = Frame(Scale(*span, _CURVE_LEFT, size[0] - 24, wide), y, *size)
    parts = frame.svg(*labels, grid=True)
    xs, ys = np.array([p.x for p in known]), np.array([p.y for p in known], dtype=float)
    order = np.argsort(xs)
    parts += frame.path(xs[order], ys[order], "line film")
    parts += "".join(_mark(frame, point) for point in known)
    for point in points:
        if point.y is None:
            at = frame.x(point.x)
            parts += f'<path d="M{at - 4:.1f} {y.start - 10:.1f}l8 8m0 -8l-8 8" class="minimum"/>'
    if here is not None and here.y is not None and span[0] <= here.x <= span[1]:
        parts += (
            f'<circle cx="{frame.x(here.x):.1f}" cy="{frame.y(here.y):.1f}" r="7" class="here"/>'
        )
    return Picture(frame, svg(*size, parts, f"{labels[1]} over {labels[0]}"))


def response_charts(shown: Shown, size: tuple[float, float]) -> list[Picture]:
    """Draw stiffness and damping over frequency, with their error bars, one below the other."""
    film, height = shown.dynamics, max(190.0, 0.5 * size[1])
    if film is None:
        return []
    part, per = (1e-3, " per mm") if shown.is_line else (1.0, "")
    stiffness, damping = f"stiffness{per} [N/µm]", f"damping{per} [N s/m]"
    columns = (
        (stiffness, film.stiffness * 1e-6 * part, film.stiffness_error * 1e-6 * part),
        (damping, film.damping * part, film.damping_error * part),
    )
    low, high = film.frequency[film.frequency > 0.0][[0, -1]]
    span = (low / _SPARE_RATIO, high * _SPARE_RATIO)
    charts = []
    for name, values, errors in columns:
        points = [
            Point(at, value, error / abs(value))
            for at, value, error in zip(film.frequency, values, errors, strict=True)
            if at > 0.0
        ]
        charts.append(swept_chart(points, ("frequency [Hz]", name), (size[0], height), span))
    return charts


def values_at_frequency(shown: Shown, charts: Sequence[Picture], right: float) -> str:
    """Return stiffness and damping at the frequency nearest to a pixel."""
    film = shown.dynamics
    if film is None:
        return ""
    places = np.array([abs(charts[0].frame.x(at) - right) for at in film.frequency if at > 0.0])
    if places.min() > _NEAR_PIXELS:
        return ""
    number = int(places.argmin()) + film.frequency.size - places.size
    frequency, k, c = (one[number] for one in (film.frequency, film.stiffness, film.damping))
    part, per = (1e-3, ", per mm") if shown.is_line else (1.0, "")
    k, c = k * 1e-6 * part, c * part
    return f"{frequency:.4g} Hz:  k = {k:.4g} N/µm,  c = {c:.4g} N s/m{per}"


def _y_scale(values: list[float], size: tuple[float, float]) -> Scale:
    low, high = (min(values), max(values)) if values else (0.0, 1.0)
    is_log = low > 0 and high / low > 30.0
    if is_log:
        low, high = low / 1.2, high * 1.2
    else:
        room = 0.08 * (high - low) or 0.1 * abs(high) or 1.0
        low = 0.0 if 0 <= low < 0.45 * high else low - room
        high += room
    return Scale(low, high, size[1] - _CURVE_BOTTOM, _CURVE_TOP, is_log)


def _mark(frame: Frame, point: Point) -> str:
    assert point.y is not None
    x, y = frame.x(point.x), frame.y(point.y)
    parts = f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.2" class="point"/>'
    low, high = (frame.y(point.y * (1 + side * point.error)) for side in (-1, 1))
    if math.isfinite(low) and abs(low - high) > 7:
        parts += f'<path d="M{x:.1f} {low:.1f}V{high:.1f}" class="whisker"/>'
    return parts
