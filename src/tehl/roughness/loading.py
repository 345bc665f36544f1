"""A map from its file to prepared heights."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.roughness.files import RawMap, checked, read
from tehl.roughness.files.raw import shown
from tehl.roughness.map_settings import MapFile, MapSettings, PreparedMap
from tehl.roughness.model import BEYOND, metres
from tehl.roughness.prepare import (
    RELATIVE_ROUNDING,
    Heights,
    filled,
    gaussian_mean,
    levelled,
    tapered,
    without_outliers,
)
from tehl.roughness.tile import Tile

_LEAST_POINTS = 4
_LEAST_SQ, _LARGEST_SQ = 1e-12, 10e-6
_PHASES = ("rad", "radian", "radians", "waves", "wave", "fringes", "fringe", "fr", "wv")


@contextmanager
def _naming(surface: MapFile) -> Iterator[None]:
    """Put the name of the file before errors."""
    try:
        yield
    except InputError as error:
        raise InputError(f"map {shown(surface.file)} {error}") from None


def raw_map(surface: MapFile) -> RawMap:
    """Return the content of the file of a map; errors name the file."""
    path = checked(surface.file)
    with _naming(surface):
        return read(path, layout=surface.layout, variable=surface.variable, form=surface.format)


def heights_of(surface: MapSettings) -> Heights:
    """Return the prepared heights of a map, read once as long as its file does not change."""
    return _loaded(surface, stamp_of(surface))


def tile_of(surface: MapSettings) -> Tile:
    """Return the heights of a map with what lies beyond their edges, as :func:`heights_of`."""
    return _tile(surface, stamp_of(surface))


def stamp_of(surface: MapFile) -> tuple[int, int]:
    """Return what changes when a file does: its size and when it was written."""
    state = checked(surface.file).stat()
    return state.st_size, state.st_mtime_ns


@lru_cache(maxsize=4)
def _loaded(surface: MapSettings, stamp: object) -> Heights:
    del stamp
    raw = raw_map(surface)
    notes: list[str] = []
    with _naming(surface):
        factor = _factor(surface, raw, notes)
        highest = _highest(raw.heights, factor)
        pixel = _pixel(surface, raw, notes)
        heights = _cropped(surface, *_oriented(surface, raw.heights * factor, pixel))
        heights = _whole(surface, heights, notes)
        values = levelled(heights.values, surface.level, heights.measured)
        heights = replace(heights, values=_filtered(surface, values, heights, notes))
        _check_heights(surface, heights, highest * factor)
    fades = ", heights fall to zero before" if surface.outside == "flat" else ""
    notes.append(f"{BEYOND[surface.outside]}{fades}")
    return replace(heights, notes=tuple(notes))


@lru_cache(maxsize=4)
def _tile(surface: MapSettings, stamp: object) -> Tile:
    heights = _loaded(surface, stamp)
    values = heights.values
    if surface.outside == "flat":
        width = 0.1 * min(heights.size) if surface.taper is None else surface.taper
        values = tapered(heights, width)
    return Tile(
        heights=values,
        pixel=heights.pixel,
        centre=(surface.x, surface.y),
        angle=surface.rotate,
        edge=surface.outside,
        covered=heights.values.size,
    )


def _highest(heights: Array, factor: float) -> float:
    """Return the largest number of a file; reject too few points and absurd heights."""
    ny, nx = heights.shape
    if min(ny, nx) < _LEAST_POINTS:
        raise InputError(
            f"has {nx} x {ny} points, but a map has at least {_LEAST_POINTS} x {_LEAST_POINTS}"
        )
    if not np.isfinite(heights).any():
        raise InputError("has no point with a height")
    highest = float(np.abs(heights[np.isfinite(heights)]).max())
    if not highest <= 1.0 / factor:  # a metre
        raise InputError(
            f"has heights up to {highest:.3g} times {factor:g} m: it is damaged, marks missing "
            "points by a number, or has another unit"
        )
    return highest


# ---- units


def _factor(surface: MapFile, raw: RawMap, notes: list[str]) -> float:
    """Return the factor from the heights of the file to metres."""
    stated = surface.unit or raw.unit
    if stated is None:
        raise InputError('does not state the unit of its heights: give unit = "um"')
    _compare("heights are", surface.unit, raw.unit, notes)
    return _metres(stated, "heights", "unit")


def _compare(what: str, stated: str | None, found: str | None, notes: list[str]) -> None:
    """Add a note where a case states another unit than the file."""
    if stated and found and metres(found) != metres(stated):
        notes.append(f"its {what} taken in {stated}, though the file says {found}")


def _metres(unit: str, what: str, key: str) -> float:
    factor = metres(unit)
    if factor is None and unit.lower() in _PHASES:
        raise InputError(
            f"has its {what} in {unit}, a phase: state the height of one, which is wavelength / "
            f'(4 pi) for a radian in reflection, {key} = "50.4 nm"'
        )
    if factor is None:
        raise InputError(
            f'has the unit {unit[:20]!r} for its {what}, which is not a length: give {key} = "um"'
        )
    return factor


def _pixel(surface: MapFile, raw: RawMap, notes: list[str]) -> tuple[float, float]:
    """Return the distances of the points of the file [m]."""
    ny, nx = raw.heights.shape
    pixel = surface.pixel
    if surface.size is not None:
        pixel = (surface.size[0] / nx, surface.size[1] / ny)
    if pixel is None:
        pixel = _pixel_of_file(surface, raw, notes)
    elif raw.pixel is not None:
        factors = [metres(unit or surface.xy_unit or "") for unit in raw.pixel_units]
        own = [step * (factor or math.nan) for step, factor in zip(raw.pixel, factors, strict=True)]
        if None not in factors and not np.allclose(pixel, own, rtol=1e-3, atol=0.0):
            first, second = (f"{x * 1e6:.4g} and {y * 1e6:.4g} um" for x, y in (pixel, own))
            notes.append(f"its points are taken {first} apart, though the file says {second}")
    size = (nx * pixel[0], ny * pixel[1])
    if not (max(size) <= 1.0 and min(pixel) >= 1e-10):
        raise InputError(
            f"has a size of {size[0]:.3g} x {size[1]:.3g} m with points {min(pixel):.3g} m "
            "apart, which is not that of a measured surface: check unit, xy_unit, pixel and size"
        )
    return pixel


def _pixel_of_file(surface: MapFile, raw: RawMap, notes: list[str]) -> tuple[float, float]:
    """Return the distances that the file has, each in its own unit or both in the one stated."""
    if raw.pixel is None:
        raise InputError(
            "does not state how far its points are apart: give pixel = "
            '"2 um", or size = ["1 mm", "1 mm"]'
        )
    if surface.xy_unit is None and None in raw.pixel_units:
        half = f" along {'xy'[raw.pixel_units.index(None)]}" if any(raw.pixel_units) else ""
        raise InputError(
            f"has points {raw.pixel[0]:g} and {raw.pixel[1]:g} apart along x and y, but does not "
            f'state their unit{half}: give xy_unit = "um"'
        )
    for axis, unit in zip("xy", raw.pixel_units, strict=True):
        _compare(f"{axis} is", surface.xy_unit, unit, notes)
    x, y = (
        step * _metres(surface.xy_unit or unit or "", axis, "xy_unit")
        for step, unit, axis in zip(raw.pixel, raw.pixel_units, "xy", strict=True)
    )
    return x, y


# ---- shape


def _oriented(surface: PreparedMap, values: Array, pixel: tuple[float, float]) -> tuple[Array, Any]:
    if surface.transpose:
        values, pixel = values.T, (pixel[1], pixel[0])
    values = values[:, ::-1] if surface.flip_x else values
    values = values[::-1] if surface.flip_y else values
    return -values if surface.upside_down else values, pixel


def _cropped(surface: PreparedMap, values: Array, pixel: tuple[float, float]) -> Heights:
    values = np.where(np.isfinite(values), values, np.nan)
    if surface.crop is None:
        return Heights(values=values, pixel=pixel, measured=np.isfinite(values))
    parts = []
    for axis, count, step in zip("yx", values.shape, pixel[::-1], strict=True):
        span = getattr(surface.crop, axis)
        first, last = (0, count) if span is None else (round(end / step) for end in span)
        if not first + _LEAST_POINTS <= last <= count:
            raise InputError(
                f"measures {count * step * 1e6:.4g} um along {axis}, where crop leaves fewer than "
                f"{_LEAST_POINTS} points or goes beyond"
            )
        parts.append(slice(first, last))
    values = values[parts[0], parts[1]]
    if not np.isfinite(values).any():
        raise InputError("has no point with a height where crop leaves it")
    return Heights(values=values, pixel=pixel, measured=np.isfinite(values))


# ---- heights


def _whole(surface: PreparedMap, heights: Heights, notes: list[str]) -> Heights:
    """Return heights without spikes and gaps."""
    values, spikes = heights.values, 0
    gaps = int(np.isnan(values).sum())
    if surface.outliers is not None:
        values, spikes = without_outliers(values, surface.outliers)
        notes.append(f"{spikes} spikes ({100 * spikes / values.size:.2g} %) were removed")
    whole = filled(values, surface.fill, spikes)
    if gaps:
        notes.append(f"{gaps} missing points ({100 * gaps / values.size:.2g} %) were filled")
    return replace(heights, values=whole, measured=np.isfinite(values), spikes=spikes)


def _filtered(surface: PreparedMap, values: Array, heights: Heights, notes: list[str]) -> Array:
    for key, cut_off in (("lambda_c", surface.lambda_c), ("lambda_s", surface.lambda_s)):
        if cut_off is None:
            continue
        if cut_off > 2.0 * min(heights.size):
            raise InputError(
                f"measures {heights.size[0] * 1e6:.4g} x {heights.size[1] * 1e6:.4g} um, too "
                f"little for {key} = {cut_off * 1e6:.4g} um"
            )
        mean = gaussian_mean(values, heights.pixel, cut_off)
        if key == "lambda_s" and cut_off < 2.0 * min(heights.pixel):
            notes.append("lambda_s is finer than the points of the map and does nothing")
        values = values - mean if key == "lambda_c" else mean
    return values


def _check_heights(surface: PreparedMap, heights: Heights, highest: float) -> None:
    """Reject heights that are constant or outside the physical range; ``highest`` in [m]."""
    if not np.ptp(heights.values[heights.measured]) > RELATIVE_ROUNDING * highest:
        raise InputError("is constant: it has no roughness")
    off, how = heights.sq, f'after level = "{surface.level}"'
    if not off >= _LEAST_SQ:
        has_filters = surface.lambda_c is not None or surface.lambda_s is not None
        filters = ", and do lambda_c and lambda_s leave any" if has_filters else ""
        raise InputError(
            f"has Sq = {off:.3g} m {how}, less than {_LEAST_SQ:g} m and than is measured, where "
            f"the largest number of the file is {highest:.3g} m: is the unit right{filters}?"
        )
    if not off <= _LARGEST_SQ:
        raise InputError(
            f"has Sq = {off * 1e6:.3g} um {how}, more than {_LARGEST_SQ * 1e6:g} um and than a "
            "lubricated contact has: is the unit right, and is its form taken off?"
        )
