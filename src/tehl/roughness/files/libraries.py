"""Formats that a library reads: numpy arrays, NetCDF (xarray), instruments (SurfaceTopography)."""

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from tehl.errors import InputError
from tehl.roughness.files.raw import HDF5, RawMap, check_bytes, check_count, check_hdf5, step

_READERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}
_ENGINES = {HDF5: "h5netcdf", b"CDF\x01": "scipy", b"CDF\x02": "scipy"}
_SAME = """
al3d bcr datx ezd frt gwy ibw jpk lext mdt mi mnt nms opd opdx os3d plu plux qep sdf sur tmd zmg zon
"""
_OTHERS = {"bcrf": "bcr", "nid": "ezd", "spm": "di", "vk4": "vk", "vk6": "vk", "vk7": "vk"}
FORMATS = dict(sorted(({name: name for name in _SAME.split()} | _OTHERS).items()))
"""Reader of SurfaceTopography by the ending of the file; no other is tried."""


def _short(error: Exception) -> str:
    return " ".join(str(error).split())[:100]


def read_npy(path: Path) -> RawMap:
    """Return the heights of a ``.npy`` file; objects are never unpickled.

    Raises InputError if it is not a table of real numbers, or holds less than its header claims.
    """
    with path.open("rb") as file:
        try:
            version = np.lib.format.read_magic(file)
            shape, _, dtype = _READERS[version](file)
            claimed = str(shape)[:60]
        except Exception:  # the header is parsed as Python literals, with all that may go wrong
            raise InputError("is not a file of numpy: its header cannot be read") from None
        if dtype.kind not in "fiu":
            words = {"O": "objects", "c": "complex numbers", "b": "truth values", "V": "records"}
            kind = words.get(dtype.kind, "text" if dtype.kind in "SU" else "times")
            raise InputError(f"holds {kind}, but heights are real numbers")
        if not all(type(side) is int and side >= 0 for side in shape):
            raise InputError(
                f"is not a file of numpy: its header claims a table of shape {claimed}"
            )
        check_count(shape)
        needed = math.prod(shape) * dtype.itemsize
        check_bytes(path.stat().st_size - file.tell(), needed, shape)
    with np.errstate(over="ignore"):  # wider numbers than these become infinite: missing points
        heights = np.load(path, allow_pickle=False).astype(np.float64)
    return RawMap(heights=heights, kind="numpy array")


def read_instrument(path: Path) -> RawMap:
    """Return the heights of a file of an instrument.

    Raises InputError if SurfaceTopography is not installed, or cannot read the file.
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
            is_hdf5 = file.read(len(HDF5)) == HDF5  # as datx is
        if is_hdf5:
            check_hdf5(path)
        reader = open_topography(str(path), format=FORMATS[path.suffix[1:].lower()])
        check_count(tuple(reader.channels[0].nb_grid_pts))
        found = reader.topography()
        heights = np.ma.filled(np.ma.asarray(found.heights(), dtype=np.float64), np.nan).T
        size = found.physical_sizes
    except InputError:
        raise
    except Exception as error:  # its readers raise any exception
        raise InputError(f"cannot be read by SurfaceTopography: {_short(error)}") from None
    check_count(heights.shape)
    ny, nx = heights.shape
    return RawMap(
        heights=np.ascontiguousarray(heights),
        kind=f"{path.suffix[1:].lower()}, read by SurfaceTopography",
        unit=found.unit,
        pixel=None if size is None else (float(size[0]) / nx, float(size[1]) / ny),
        pixel_units=(found.unit, found.unit),
    )


# ---- NetCDF


def read_netcdf(path: Path, variable: str | None) -> RawMap:
    """Return the heights of a NetCDF file, version 3 or 4.

    The file has one variable of two dimensions, or several of which ``variable`` names one. Its
    attribute ``units`` and coordinates count; the last dimension, or the one called x, is x.
    Coordinates may fall, as y does in the order of images. Raises InputError if the file cannot be
    read, or it is not clear what the heights are.
    """
    import xarray as xr  # noqa: PLC0415 (a second, for this format only)

    with path.open("rb") as file:
        engine = _ENGINES.get(file.read(4))
    if engine is None:
        raise InputError("is not a NetCDF file")
    try:
        if engine == "h5netcdf":
            check_hdf5(path)
        with (
            warnings.catch_warnings(action="ignore"),  # of HDF5 without names of dimensions
            xr.open_dataset(path, engine=engine, decode_times=False, cache=False) as data,
        ):
            return _map_of(_chosen(data, variable))
    except InputError:
        raise
    except Exception as error:  # the libraries below raise any exception
        raise InputError(
            f"cannot be read as NetCDF, it is truncated or damaged: {_short(error)}"
        ) from None


def _chosen(data: Any, name: str | None) -> Any:
    """Return the variable with the heights."""
    tables = {
        str(key): one
        for key, one in data.data_vars.items()
        if one.ndim == 2 and one.dtype.kind in "fiu"
    }
    listed = (", ".join([*tables][:8]) + (", ..." if len(tables) > 8 else "")) or "none"
    if name is not None and name not in tables:
        raise InputError(f'has no table of heights called "{name}": it has {listed}')
    if name is None and not tables:
        raise InputError("has no variable of two dimensions with real numbers")
    if name is None and len(tables) > 1:
        raise InputError(f'has {listed}: say which are the heights, variable = "..."')
    return tables[name or next(iter(tables))]


def _map_of(found: Any) -> RawMap:
    check_count(found.shape)
    if {"x", "y"} == set(found.dims):
        found = found.transpose("y", "x")
    steps: list[float | None] = []
    units: list[str | None] = []
    for dim, axis in zip(found.dims, "yx", strict=True):
        if dim not in found.coords:
            steps.append(None)
            units.append(None)
            continue
        along = np.asarray(found.coords[dim].values, dtype=np.float64)
        if along[-1:] < along[:1]:  # as rows of images
            found, along = found.isel({dim: slice(None, None, -1)}), along[::-1]
        steps.append(step(along, axis))
        units.append(_unit(found.coords[dim]))
    return RawMap(
        heights=np.asarray(found.values, dtype=np.float64),
        kind=f"NetCDF, variable {found.name}",
        unit=_unit(found),
        pixel=(steps[1], steps[0]) if steps[0] and steps[1] else None,
        pixel_units=(units[1], units[0]),
    )


def _unit(variable: Any) -> str | None:
    unit = variable.attrs.get("units", variable.attrs.get("unit"))
    return unit.strip() or None if isinstance(unit, str) else None
