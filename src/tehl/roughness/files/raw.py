"""Heights of a file before preparation, and checks that all readers share."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array

LARGEST_MAP = 36_000_000
"""Points of a map."""
LARGEST_FILE = 2 * 10**9
"""Bytes of a file."""
HDF5 = b"\x89HDF"
"""The first bytes of a file in HDF5."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RawMap:
    """Heights of a file in the units of the file."""

    heights: Array
    """(ny, nx): rows along x, their number growing with y; NaN where nothing was measured."""
    kind: str
    """What the file is, for people."""
    unit: str | None = None
    """Of the heights; None when the file does not say."""
    pixel: tuple[float, float] | None = None
    """Distances (dx, dy) of the points."""
    pixel_units: tuple[str | None, str | None] = (None, None)
    """Of the distances along x and y."""


def check_count(shape: tuple[int, ...]) -> None:
    """Reject a map that is too large for memory, before anything is allocated."""
    if len(shape) != 2:
        raise InputError(
            f"holds an array of shape {_times(shape)}, but heights are a table of rows and columns"
        )
    if math.prod(max(side, 1) for side in shape) > LARGEST_MAP:
        raise InputError(
            f"claims {_times(shape)} points: a map may have {LARGEST_MAP // 10**6} million, "
            "crop it before"
        )


def check_bytes(there: int, needed: int, shape: tuple[int, ...]) -> None:
    """Reject a file whose header claims more than it holds.

    Parameters
    ----------
    there, needed : int
        Bytes of the file, and of the points.
    shape : (ny, nx)
        Points that the header claims.
    """
    if there < needed:
        raise InputError(
            f"is truncated: {_times(shape)} points take {needed} bytes, and {there} are there"
        )


def step(places: Array, axis: str) -> float:
    """Return the distance of equidistant places.

    Parameters
    ----------
    places : Array
        Rising coordinates of one axis, in any unit.
    axis : str
        Its name, for messages.

    Raises
    ------
    InputError
        If there is one place only, or distances differ by more than 0.1 %.
    """
    distances = np.diff(places)
    if distances.size == 0:
        raise InputError(f"has one point along {axis}, which is not a map")
    mean = float(np.mean(distances))
    if not (mean > 0 and np.abs(distances - mean).max() <= 1e-3 * mean):
        raise InputError(f"has points along {axis} that do not follow at equal, rising distances")
    return mean


def check_hdf5(path: Path) -> None:
    """Reject HDF5 with data in other files; raise what h5py does where h5netcdf would warn."""
    import h5py  # noqa: PLC0415

    def leads_out(_: str, link: Any) -> bool | None:
        return isinstance(link, h5py.ExternalLink) or None

    def lies_outside(_: str, thing: Any) -> bool | None:
        is_table = isinstance(thing, h5py.Dataset)
        return (is_table and (thing.is_virtual or thing.external is not None)) or None

    with h5py.File(path, "r") as file:
        list(file.attrs.items())
        # neither follows an external link; both stop at the first True, and go on after None
        if file.visititems_links(leads_out) or file.visititems(lies_outside):
            raise InputError(
                "has data in another file (external storage, an external link or a virtual "
                "dataset), and a map is read from its own file only: copy all into one file"
            )


def shown(text: object, longest: int = 160) -> str:
    """Return a path or a text for a message: printable, its middle left out when it is long.

    Parameters
    ----------
    text : object
        Converted to text; characters that cannot be printed become question marks.
    longest : int
        Most characters.
    """
    line = "".join(c if c.isprintable() else "?" for c in str(text))
    return line if len(line) <= longest else f"{line[: longest // 2 - 3]}...{line[-longest // 2 :]}"


def _times(shape: tuple[int, ...]) -> str:
    sides = [str(count)[:20] for count in shape[:8]]
    return " x ".join(sides + ["..."] * (len(shape) > 8)) or "no"
