"""Heights without the waves that a mesh cannot carry."""

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tehl.typing import Array

KEPT, LOST = 0.25, 0.5
"""Waves per mesh width up to which all of a wave passes, and from which nothing does."""
_FADED = 6
_ROOM, _TIMES = 4_000_000, 4
_PER_MESH = 16

Pair = tuple[float, float]


def low_passed(
    heights: "Array", size: Pair, mesh: Pair, *, periodic: bool, radial: bool
) -> "Array":
    """Return heights with their short waves taken away [m].

    Parameters
    ----------
    heights : (ny, nx) array
        [m]
    size, mesh : (x, y)
        Lengths of the edges, and mesh widths [m].
    periodic : bool
        Whether the heights repeat beyond their edges; they are mirrored otherwise.
    radial : bool
        Whether a wave is judged by its length and not by that along x and that along y, which
        asks for equal mesh widths.
    """
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)
    from scipy import fft  # noqa: PLC0415

    (ny, nx), (width, height) = heights.shape, size
    if periodic:
        spectrum = fft.rfft2(heights)
        x, y = fft.rfftfreq(nx) * nx / width, np.abs(fft.fftfreq(ny)) * ny / height
        spectrum *= _response(x, y, mesh, radial=radial)
        return fft.irfft2(spectrum, (ny, nx))
    spectrum = fft.dctn(heights, type=2)
    x, y = np.arange(nx) / (2.0 * width), np.arange(ny) / (2.0 * height)
    spectrum *= _response(x, y, mesh, radial=radial)
    return fft.idctn(spectrum, type=2)


def room(pixel: Pair, mesh: Pair) -> tuple[int, int]:
    """Return the points of the flat rim along x and y into which filtered heights fade."""
    x, y = (math.ceil(_FADED * step / own) for step, own in zip(mesh, pixel, strict=True))
    return x, y


def is_roomy(shape: tuple[int, ...], rim: tuple[int, int]) -> bool:
    """Return whether heights with a rim of so many points are many times the heights themselves."""
    ny, nx = shape
    return (ny + 2 * rim[1]) * (nx + 2 * rim[0]) > max(_TIMES * ny * nx, _ROOM)


def low_passed_with_room(
    heights: "Array", pixel: Pair, mesh: Pair, *, radial: bool
) -> tuple["Array", Pair]:
    """Return what :func:`low_passed` makes of heights with a flat rim, on a coarser lattice.

    The few waves that pass are summed over the heights alone, so that neither the rim nor
    anything else of their pixel is ever stored.

    Parameters
    ----------
    heights : (ny, nx) array
        [m], which end at zero.
    pixel, mesh : (dx, dy)
        [m]
    radial : bool
        As of :func:`low_passed`.

    Returns
    -------
    heights : Array
        Over the same lengths as those with their rim, sixteen points per mesh width or more [m].
    pixel : (dx, dy)
        Of these [m].
    """
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)
    from scipy import fft  # noqa: PLC0415

    rim = room(pixel, mesh)
    whole = [count + 2 * points for count, points in zip(reversed(heights.shape), rim, strict=True)]
    lengths = [count * step for count, step in zip(whole, pixel, strict=True)]
    kept = [
        min(count, math.ceil(2.0 * LOST * length / step))
        for count, length, step in zip(whole, lengths, mesh, strict=True)
    ]
    across, along = (
        _cosines(kept[axis], heights.shape[1 - axis], rim[axis], whole[axis]) for axis in (1, 0)
    )
    x, y = (np.arange(kept[axis]) / (2.0 * lengths[axis]) for axis in (0, 1))
    spectrum = (across @ heights @ along.T) * _response(x, y, mesh, radial=radial)
    nx, ny = (
        min(count, math.ceil(_PER_MESH * length / step))
        for count, length, step in zip(whole, lengths, mesh, strict=True)
    )
    spectrum *= nx * ny / (whole[0] * whole[1])
    filtered = fft.idctn(np.pad(spectrum, ((0, ny - kept[1]), (0, nx - kept[0]))), type=2)
    return filtered, (lengths[0] / nx, lengths[1] / ny)


def _cosines(waves: int, count: int, rim: int, whole: int) -> "Array":
    """Return the first rows of a cosine transform of ``whole`` points, where it is not flat."""
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

    places = (np.arange(count) + rim + 0.5) / whole
    return 2.0 * np.cos(np.pi * np.arange(waves)[:, None] * places)


def _response(x: "Array", y: "Array", mesh: Pair, *, radial: bool) -> "Array":
    """Return which part of each wave passes, by its waves per metre along x and y."""
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

    if radial:
        return _passed(np.hypot(x, y[:, None]) * mesh[0])
    return _passed(x * mesh[0]) * _passed(y * mesh[1])[:, None]


def _passed(frequency: "Array") -> "Array":
    """Return which part of a wave passes, by waves per mesh width."""
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

    beyond = np.clip((frequency - KEPT) / (LOST - KEPT), 0.0, 1.0)
    return np.cos(0.5 * np.pi * beyond) ** 2
