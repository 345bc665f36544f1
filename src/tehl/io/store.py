"""Results on disk (NetCDF-4) and as datasets, there and back without loss."""

import io
import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from tehl.errors import FileFormatError, InputError
from tehl.io.atomic import check_writable, replacing
from tehl.io.content import READABLE, Variable, attributes, rebuild, variables
from tehl.io.summary import plain, summary
from tehl.result import Result

if TYPE_CHECKING:
    import h5netcdf
    import xarray as xr

__all__ = ["check_writable", "load", "save", "to_dataset"]

STEADY = "steady"
"""Kind of a file that holds a steady film; those of older versions do not say."""
Made = TypeVar("Made")

_COORDINATES = ("x", "y", "X", "Y", "zeta", "cycle")
_HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"


def to_dataset(result: Result) -> "xr.Dataset":
    """Return ``result`` as a dataset.

    Parameters
    ----------
    result : Result
        What a solve returned or :func:`load` read.

    Returns
    -------
    xarray.Dataset
        Fields over ``(y, x)``, temperature over ``(zeta, y, x)``, history over ``cycle``;
        ``units`` and ``long_name`` on each variable; inputs, groups, status, definitions and
        versions as attributes.
    """
    return dataset(variables(result), attributes(result), _COORDINATES)


def dataset(
    arrays: Iterable[Variable], attrs: Mapping[str, str | int], coordinates: Iterable[str]
) -> "xr.Dataset":
    """Return arrays and attributes as a dataset; ``coordinates`` are those among the arrays."""
    import xarray as xr  # noqa: PLC0415 (a second of import that saving and loading do without)

    packed = {
        v.name: (v.dims, v.data, {"units": v.units, "long_name": v.long_name}) for v in arrays
    }
    coords = {name: packed.pop(name) for name in coordinates if name in packed}
    return xr.Dataset(packed, coords=coords, attrs=dict(attrs))


def save(result: Result, path: str | Path, *, extra: dict[str, Any] | None = None) -> None:
    """Write ``result`` to a NetCDF-4 file; whole, or not at all.

    Parameters
    ----------
    result : Result
        The result, converged or not; the file says which.
    path : str or Path
        The file; an older one is replaced.
    extra : dict, optional
        Blocks to add to the summary in the file: what else was learnt beside the result.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    attrs = attributes(result)
    if extra:
        attrs["summary"] = json.dumps(plain(summary(result) | extra), allow_nan=False)
    write(path, variables(result), attrs)


def write(path: str | Path, arrays: Iterable[Variable], attrs: Mapping[str, str | int]) -> None:
    """Write arrays and attributes to a NetCDF-4 file; whole, or not at all.

    Parameters
    ----------
    path : str or Path
        The file; an older one is replaced.
    arrays : iterable of Variable
        What it holds; none of them is empty.
    attrs : mapping
        Its attributes.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    with replacing(path) as temporary:
        temporary.write_bytes(_image(arrays, attrs))


def _image(arrays: Iterable[Variable], attrs: Mapping[str, str | int]) -> bytes:
    """Return the content of the file; made in memory, as HDF5 does not survive a full disk."""
    import h5netcdf  # noqa: PLC0415 (0.1 s)

    image = io.BytesIO()
    with h5netcdf.File(image, "w") as file:
        file.attrs.update(attrs)
        for variable in arrays:
            for name, size in zip(variable.dims, variable.data.shape, strict=True):
                if name not in file.dimensions:
                    file.dimensions[name] = size
            _write(file, variable.name, variable.dims, variable.data)
            file.variables[variable.name].attrs.update(_attributes(variable))
    return image.getvalue()


def _attributes(variable: Variable) -> dict[str, str]:
    """Return the attributes of a variable; fields name their scaled coordinates as CF does."""
    named = {"units": variable.units, "long_name": variable.long_name}
    return {**named, "coordinates": "X Y"} if variable.dims[-2:] == ("y", "x") else named


def _write(file: "h5netcdf.File", name: str, dims: tuple[str, ...], data: NDArray[Any]) -> None:
    import h5py  # noqa: PLC0415 (0.1 s)

    if data.dtype.kind == "U":
        file.create_variable(name, dims, h5py.string_dtype(), data=data.astype(object))
    elif data.ndim < 2:
        file.create_variable(name, dims, data.dtype, data=data)
    else:
        file.create_variable(
            name,
            dims,
            data.dtype,
            data=data,
            chunks=(1, *data.shape[1:]) if dims[0] == "frame" else data.shape,
            compression="gzip",
            compression_opts=1,
            shuffle=True,
            fletcher32=True,
        )


def load(path: str | Path) -> Result:
    """Read a result that :func:`save` wrote; nothing is compiled for it.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Result
        Equal to the one saved, its fields bit by bit.

    Raises
    ------
    InputError
        If there is no such file.
    FileFormatError
        If it is truncated, foreign or of a format that this version does not know.
    """
    source = Path(path)
    arrays, attrs = read(source)
    if attrs.get("tehl_kind", STEADY) != STEADY:
        raise FileFormatError(
            f"{source} holds a transient film, not a steady one: tehl.load reads it, tehl plot and "
            "tehl animate show it"
        )
    return rebuilt(source, arrays, attrs, rebuild)


def read(source: Path) -> tuple[dict[str, NDArray[Any]], dict[str, Any]]:
    """Return arrays and attributes of a file of this package, by name.

    Raises
    ------
    InputError
        If there is no such file.
    FileFormatError
        If it is truncated, foreign or of a format that this version does not know.
    """
    _check_signature(source)
    arrays, attrs = _read(source)
    _check_version(source, attrs)
    return arrays, attrs


def rebuilt(
    source: Path,
    arrays: dict[str, NDArray[Any]],
    attrs: dict[str, Any],
    make: Callable[[dict[str, NDArray[Any]], dict[str, Any]], Made],
) -> Made:
    """Return what ``make`` makes of a file.

    Raises
    ------
    FileFormatError
        If something is missing or does not fit; the message names it.
    """
    try:
        return make(arrays, attrs)
    except KeyError as error:
        raise FileFormatError(f"{source} is not a whole tehl result: {error} is missing") from None
    except ValueError as error:
        raise FileFormatError(f"{source} is not a valid tehl result: {_reason(error)}") from None
    except (TypeError, AttributeError, IndexError) as error:
        raise _damaged(source, error) from None


def load_summary(path: str | Path) -> dict[str, Any]:
    """Read the summary of a result file, with the blocks that were added to it.

    Parameters
    ----------
    path : str or Path
        The file.

    Raises
    ------
    InputError
        If there is no such file.
    FileFormatError
        If it is no result file, or its summary cannot be read.
    """
    source = Path(path)
    _check_signature(source)
    attrs = _read(source)[1]
    try:
        content = json.loads(attrs.get("summary", "{}"))
    except (TypeError, ValueError) as error:
        raise _damaged(source, error) from None
    return content if isinstance(content, dict) else {}


def _check_signature(source: Path) -> None:
    if not source.is_file():
        raise InputError(f"there is no result file {source}")
    try:
        with source.open("rb") as file:
            start = file.read(len(_HDF5_SIGNATURE))
    except OSError as error:
        raise InputError(f"cannot read {source}: {error.strerror}") from None
    if not start:
        raise FileFormatError(f"{source} is empty, not a tehl result")
    if start != _HDF5_SIGNATURE:
        kind = "a NetCDF-3 file" if start.startswith(b"CDF") else "no NetCDF-4 file"
        raise FileFormatError(f"{source} is {kind}, not a tehl result")


def _read(source: Path) -> tuple[dict[str, NDArray[Any]], dict[str, Any]]:
    import h5py  # noqa: PLC0415 (0.1 s; h5netcdf complains on stderr of a broken file)

    try:
        with h5py.File(source, "r") as file:
            attrs = {name: _plain(value) for name, value in file.attrs.items()}
            arrays = {name: _array(data) for name, data in file.items()}
    except Exception as error:  # a broken file breaks these libraries in any way
        raise _damaged(source, error) from None
    if "tehl_format" not in attrs:
        raise FileFormatError(f"{source} is a NetCDF-4 file, but not a tehl result")
    return arrays, attrs


def _damaged(source: Path, error: Exception) -> FileFormatError:
    return FileFormatError(f"{source} is truncated or damaged: {_first_line(error)}")


def _array(data: Any) -> NDArray[Any]:
    return np.asarray(data[...] if data.dtype.kind != "O" else data.asstr()[...])


def _plain(value: Any) -> Any:
    """Return an attribute as h5netcdf wrote it, a number out of its array of one."""
    return value.item() if isinstance(value, np.ndarray) and value.size == 1 else value


def _check_version(source: Path, attrs: dict[str, Any]) -> None:
    try:
        version = int(attrs["tehl_format"])
    except (TypeError, ValueError) as error:
        raise _damaged(source, error) from None
    if version not in READABLE:
        raise FileFormatError(
            f"{source} is a tehl result of format {version} (by {attrs.get('source', 'tehl')}); "
            f"this tehl reads the formats {', '.join(map(str, READABLE))}"
        )


def _reason(error: ValueError) -> str:
    """Say what does not fit in one line; pydantic lists its complaints."""
    complaints = getattr(error, "errors", None)
    if complaints is None:
        return _first_line(error)
    first = complaints()[0]
    return f"{'.'.join(str(part) for part in first['loc'])}: {first['msg']}"


def _first_line(error: Exception) -> str:
    text = str(error.args[0]) if isinstance(error, KeyError) and error.args else str(error)
    return text.partition("\n")[0][:200]
