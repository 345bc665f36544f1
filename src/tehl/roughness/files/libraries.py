"""Formats that a library reads: numpy arrays, NetCDF (xarray), instruments (SurfaceTopography)."""

import math
import warnings
import zipfile
from pathlib import Path
from typing import IO, Any

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.roughness.files.raw import HDF5, RawMap, check_bytes, check_count, check_hdf5, shown, step

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
METROPRO = "metropro"
"""Reader of the binary ``.dat`` files of Zygo, which have the ending of texts."""
_MAGIC = tuple(b"\x88\x1b\x03" + last for last in (b"\x6f", b"\x70", b"\x71"))


def _short(error: Exception) -> str:
    return " ".join(str(error).split())[:100]


def is_metropro(path: Path) -> bool:
    """Return whether a file begins as those of Zygo MetroPro do."""
    with path.open("rb") as file:
        return file.read(4) in _MAGIC


def read_npy(path: Path) -> RawMap:
    """Return the heights of a ``.npy`` file; objects are never unpickled.

    Raises InputError if it is not a table of real numbers, or holds less than its header claims.
    """
    with path.open("rb") as file:
        return RawMap(heights=_array(file, path.stat().st_size), kind="numpy array")


def read_npz(path: Path, variable: str | None) -> RawMap:
    """Return the heights of a ``.npz`` archive.

    Parameters
    ----------
    path : Path
        Archive of arrays; only the chosen one is read.
    variable : str or None
        Name of the array of heights; None takes the only one.

    Raises
    ------
    InputError
        If it is not clear which array the heights are, and as :func:`read_npy`.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            sizes = {
                one.filename.removesuffix(".npy"): one.file_size
                for one in archive.infolist()
                if one.filename.endswith(".npy")
            }
            name = _named(list(sizes), variable, "array")
            with archive.open(f"{name}.npy") as file:
                heights = _array(file, sizes[name])
    except InputError:
        raise
    except Exception as error:  # as damaged archives raise
        raise InputError(f"is not a complete .npz file: {_short(error)}") from None
    return RawMap(heights=heights, kind=f"numpy archive, array {name}")


def _array(file: IO[bytes], size: int) -> Array:
    """Return the table of an open ``.npy`` file of ``size`` bytes."""
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
        raise InputError(f"is not a file of numpy: its header claims a table of shape {claimed}")
    check_count(shape)
    check_bytes(size - file.tell(), math.prod(shape) * dtype.itemsize, shape)
    file.seek(0)
    with np.errstate(over="ignore"):  # wider numbers than these become infinite: missing points
        return np.lib.format.read_array(file, allow_pickle=False).astype(np.float64)


def _named(names: list[str], wanted: str | None, kind: str) -> str:
    """Return the wanted one of several names, or the only one."""
    listed = (", ".join(names[:8]) + (", ..." if len(names) > 8 else "")) or "none"
    if wanted is not None and wanted not in names:
        raise InputError(f'has no {kind} of heights called "{shown(wanted, 40)}": it has {listed}')
    if wanted is None and len(names) != 1:
        raise InputError(f'has {listed}: say which are the heights, variable = "..."')
    return wanted or names[0]


def read_instrument(path: Path, name: str) -> RawMap:
    """Return the heights of a file of an instrument by a reader of SurfaceTopography.

    Parameters
    ----------
    path : Path
        File whose first channel has the heights.
    name : str
        Format as SurfaceTopography calls it.

    Raises
    ------
    InputError
        If SurfaceTopography is not installed, or cannot read the file.
    """
    try:
        with warnings.catch_warnings(action="ignore"):  # of its own optional libraries
            from SurfaceTopography.IO import open_topography  # noqa: PLC0415 (an extra, one second)
    except ModuleNotFoundError:
        raise InputError(
            f"is a file in the format {name}, which SurfaceTopography reads: install it with "
            'pip install "tehl[surfaces]"'
        ) from None
    try:
        with path.open("rb") as file:
            is_hdf5 = file.read(len(HDF5)) == HDF5  # as datx is
        if is_hdf5:
            check_hdf5(path)
        with warnings.catch_warnings(action="ignore"):
            reader = open_topography(str(path), format=name)
            check_count(tuple(reader.channels[0].nb_grid_pts))
            found = reader.topography()
            heights = np.ma.filled(np.ma.asarray(found.heights(), dtype=np.float64), np.nan).T
            size = found.physical_sizes if reader.channels[0].physical_sizes else None
    except InputError:
        raise
    except Exception as error:  # its readers raise any exception
        raise InputError(
            f"cannot be read by SurfaceTopography as {name}: {_short(error)}"
        ) from None
    check_count(heights.shape)
    ny, nx = heights.shape
    return RawMap(
        heights=np.ascontiguousarray(heights),
        kind=f"{name}, read by SurfaceTopography",
        unit=found.unit,
        pixel=None if size is None else (float(size[0]) / nx, float(size[1]) / ny),
        pixel_units=(found.unit, found.unit),
    )


# ---- NetCDF


def read_netcdf(path: Path, variable: str | None) -> RawMap:
    """Return the heights of a NetCDF file, version 3 or 4.

    The attribute ``units`` and the coordinates count; the last dimension, or the one called x, is
    x. Coordinates may fall, as y does in the order of images.

    Parameters
    ----------
    path : Path
        File with a variable of two dimensions.
    variable : str or None
        Name of the heights, if several variables have two dimensions.

    Raises
    ------
    InputError
        If the file cannot be read, or it is not clear what the heights are.
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
    if name is None and not tables:
        raise InputError("has no variable of two dimensions with real numbers")
    return tables[_named(list(tables), name, "table")]


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
