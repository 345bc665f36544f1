"""Heights in NetCDF, as topography programs and xarray write them."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from tehl.errors import InputError
from tehl.roughness.files.hdf5 import MAGIC, check_hdf5
from tehl.roughness.files.raw import RawMap, check_count, step
from tehl.typing import Array

_ENGINES = {MAGIC: "h5netcdf", b"CDF\x01": "scipy", b"CDF\x02": "scipy"}


def read_netcdf(path: Path, variable: str | None) -> RawMap:
    """Return the heights of a NetCDF file, version 3 or 4.

    Parameters
    ----------
    path : Path
        With one variable of two dimensions, or several of which ``variable`` names one. Its
        attribute ``units`` and coordinates count; the last dimension, or the one called x, is x.
        Coordinates may fall, as y does in the order of images.
    variable : str or None
        Which one.

    Raises
    ------
    InputError
        If it cannot be read, or it is not clear what the heights are.
    """
    import xarray as xr  # noqa: PLC0415 (a second, for this format only)

    with path.open("rb") as file:
        engine = _ENGINES.get(file.read(4))
    if engine is None:
        raise InputError("is no NetCDF file")
    try:
        if engine == "h5netcdf":
            check_hdf5(path)
        with (
            warnings.catch_warnings(action="ignore"),  # of HDF5 without names of dimensions
            xr.open_dataset(path, engine=engine, decode_times=False, cache=False) as data,
        ):
            return _map_of(data, variable)
    except InputError:
        raise
    except Exception as error:  # the libraries below raise whatever they meet
        reason = " ".join(str(error).split())[:100]
        raise InputError(
            f"cannot be read as NetCDF, it is truncated or damaged: {reason}"
        ) from None


def _map_of(data: Any, name: str | None) -> RawMap:
    found = _chosen(data, name)
    check_count(found.shape)
    if {"x", "y"} == set(found.dims):
        found = found.transpose("y", "x")
    found = _rising(found)
    steps = [_step(found, dim, axis) for dim, axis in zip(found.dims, "yx", strict=True)]
    (dy, unit_y), (dx, unit_x) = steps
    return RawMap(
        heights=np.asarray(found.values, dtype=np.float64),
        kind=f"NetCDF, variable {found.name}",
        unit=_unit(found),
        pixel=(dx, dy) if dx and dy else None,
        pixel_units=(unit_x, unit_y),
    )


def _chosen(data: Any, name: str | None) -> Any:
    """Return the variable with the heights."""
    tables = {
        str(key): one for key, one in data.data_vars.items() if one.ndim == 2 and _is_real(one)
    }
    if name is not None:
        if name not in tables:
            raise InputError(f'has no table of heights called "{name}": it has {_listed(tables)}')
        return tables[name]
    if len(tables) != 1:
        raise InputError(
            f"has {_listed(tables)}: say which are the heights, variable = " + '"..."'
            if tables
            else "has no variable of two dimensions with real numbers"
        )
    return next(iter(tables.values()))


def _is_real(variable: Any) -> bool:
    return variable.dtype.kind in "fiu"


def _listed(tables: dict[str, Any]) -> str:
    names = list(tables)
    return ", ".join(names[:8]) + (", ..." if len(names) > 8 else "") or "none"


def _rising(found: Any) -> Any:
    """Return heights with the axes turned round along which the places fall, as rows of images."""
    falling = [dim for dim in found.dims if _falls(found, dim)]
    return found.isel({dim: slice(None, None, -1) for dim in falling})


def _falls(found: Any, dim: str) -> bool:
    if dim not in found.coords:
        return False
    places = _places(found, dim)
    return places.size > 1 and bool(places[0] > places[-1])


def _places(found: Any, dim: str) -> Array:
    return np.asarray(found.coords[dim].values, dtype=np.float64)


def _step(found: Any, dim: str, axis: str) -> tuple[float | None, str | None]:
    """Return the distance of the points along a dimension and its unit."""
    if dim not in found.coords:
        return None, None
    return step(_places(found, dim), axis), _unit(found.coords[dim])


def _unit(variable: Any) -> str | None:
    unit = variable.attrs.get("units", variable.attrs.get("unit"))
    return unit.strip() or None if isinstance(unit, str) else None
