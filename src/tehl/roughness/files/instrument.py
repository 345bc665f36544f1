"""Files of instruments, through the package SurfaceTopography where it is installed."""

from pathlib import Path

import numpy as np

from tehl.errors import InputError
from tehl.roughness.files.hdf5 import MAGIC, check_hdf5
from tehl.roughness.files.raw import RawMap, check_count

FORMATS = {
    "al3d": "al3d",
    "bcr": "bcr",
    "bcrf": "bcr",
    "datx": "datx",
    "ezd": "ezd",
    "frt": "frt",
    "gwy": "gwy",
    "ibw": "ibw",
    "jpk": "jpk",
    "lext": "lext",
    "mdt": "mdt",
    "mi": "mi",
    "mnt": "mnt",
    "nid": "ezd",
    "nms": "nms",
    "opd": "opd",
    "opdx": "opdx",
    "os3d": "os3d",
    "plu": "plu",
    "plux": "plux",
    "qep": "qep",
    "sdf": "sdf",
    "spm": "di",
    "sur": "sur",
    "tmd": "tmd",
    "vk4": "vk",
    "vk6": "vk",
    "vk7": "vk",
    "zmg": "zmg",
    "zon": "zon",
}
"""Reader by the ending of the file; only these are ever tried."""


def read_instrument(path: Path) -> RawMap:
    """Return the heights of a file of an instrument.

    Raises
    ------
    InputError
        If SurfaceTopography is not installed, or cannot read the file.
    """
    try:
        from SurfaceTopography.IO import open_topography  # noqa: PLC0415 (an extra, one second)
    except ModuleNotFoundError:
        raise InputError(
            f"is a .{path.suffix[1:]} file, which SurfaceTopography reads: install it with "
            'pip install "tehl[surfaces]"'
        ) from None
    try:
        with path.open("rb") as file:
            is_hdf5 = file.read(len(MAGIC)) == MAGIC  # as datx is
        if is_hdf5:
            check_hdf5(path)
        reader = open_topography(str(path), format=FORMATS[path.suffix[1:].lower()])
        check_count(tuple(reader.channels[0].nb_grid_pts))
        found = reader.topography()
        heights = np.ma.filled(np.ma.asarray(found.heights(), dtype=np.float64), np.nan).T
        size = found.physical_sizes
    except InputError:
        raise
    except Exception as error:  # each of its readers raises whatever it meets
        reason = " ".join(str(error).split())[:100]
        raise InputError(f"cannot be read by SurfaceTopography: {reason}") from None
    check_count(heights.shape)
    ny, nx = heights.shape
    pixel = None if size is None else (float(size[0]) / nx, float(size[1]) / ny)
    return RawMap(
        heights=np.ascontiguousarray(heights),
        kind=f"{path.suffix[1:].lower()}, read by SurfaceTopography",
        unit=found.unit,
        pixel=pixel,
        pixel_units=(found.unit, found.unit),
    )
