"""Results on disk (NetCDF-4) and as datasets, steady and transient, both ways without loss."""

import io
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from tehl.base.atomic import replacing, shortened
from tehl.base.errors import FileFormatError, InputError
from tehl.base.version import __version__
from tehl.io.content import (
    FORMAT_VERSION,
    KINDS,
    Arrays,
    Attributes,
    Variable,
    attributes,
    missing_law,
    rebuild,
    variables,
)
from tehl.io.summary import plain
from tehl.io.tables import COORDINATES
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution

if TYPE_CHECKING:
    import h5netcdf
    import xarray as xr

SUFFIXES = ("", ".nc", ".nc4", ".cdf", ".h5", ".hdf5")
"""Of names of result files."""
Kind = TypeVar("Kind", Solution, TransientSolution)

_HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"


def to_dataset(result: Solution | TransientSolution) -> "xr.Dataset":
    """Return a result as a dataset.

    Fields are over ``(y, x)``, temperature over ``(zeta, y, x)``, multigrid cycles over ``cycle``;
    of a transient result these are those of its start, and it has the numbers of each step over
    ``time``, the line y = 0 over ``(time, x)`` and frames over ``(frame, y, x)``. Each variable has
    ``units`` and ``long_name``; inputs, groups, status, definitions and versions are attributes.
    """
    import xarray as xr  # noqa: PLC0415 (1 s of import, not needed to save or load)

    packed = {
        v.name: (v.dims, v.data, {"units": v.units, "long_name": v.long_name})
        for v in variables(result)
    }
    coords = {name: packed.pop(name) for name in COORDINATES if name in packed}
    return xr.Dataset(packed, coords=coords, attrs=attributes(result))


def check_name(path: str | Path) -> None:
    """Check that the name of a result file is one of NetCDF or HDF5, or has no suffix.

    Parameters
    ----------
    path : str or Path
        The file.

    Raises
    ------
    InputError
        If it is that of another format, which the file would not be.
    """
    name = Path(path)
    if name.suffix.lower() not in SUFFIXES:
        raise InputError(
            f"output {shortened(path)}: results are NetCDF files, such as "
            f"{name.with_suffix('.nc').name}; tehl export writes them as CSV, VTK or npz"
        )


def save(
    result: Solution | TransientSolution, path: str | Path, *, extra: dict[str, Any] | None = None
) -> None:
    """Write a result to a NetCDF-4 file; an error leaves no partial file.

    Parameters
    ----------
    result : Solution or TransientSolution
        Converged or not; the file says which.
    path : str or Path
        The file; an existing one is replaced.
    extra : dict, optional
        Extra blocks for the summary in the file, such as comparisons with reference runs.

    Raises
    ------
    InputError
        If the file cannot be written there, has the suffix of another format, or ``extra`` is not
        plain data.
    """
    check_name(path)
    attrs = attributes(result)
    if extra:
        attrs["summary"] = _extended(attrs["summary"], extra)
    with replacing(path) as temporary:
        temporary.write_bytes(_image(variables(result), attrs))


def _extended(summary: str, extra: dict[str, Any]) -> str:
    """Return a summary with extra blocks; raise InputError if JSON cannot hold them."""
    try:
        return json.dumps(json.loads(summary) | plain(extra), allow_nan=False)
    except RecursionError:
        raise InputError("extra blocks of a result are nested too deeply") from None
    except (TypeError, ValueError) as error:
        raise InputError(
            f"extra blocks of a result are not plain data: {_first_line(error)}; give numbers, "
            "texts, lists and tables"
        ) from None


def _image(arrays: Iterable[Variable], attrs: Mapping[str, Any]) -> bytes:
    """Return the content of the file; built in memory because HDF5 crashes on a full disk."""
    import h5netcdf  # noqa: PLC0415 (0.1 s)

    image = io.BytesIO()
    with h5netcdf.File(image, "w") as file:
        file.attrs.update(attrs)
        for variable in arrays:
            for name, size in zip(variable.dims, variable.data.shape, strict=True):
                if name not in file.dimensions:
                    file.dimensions[name] = size
            _write(file, variable)
            named = {"units": variable.units, "long_name": variable.long_name}
            if variable.dims[-2:] == ("y", "x"):
                named["coordinates"] = "X Y"  # as CF names auxiliary coordinates
            file.variables[variable.name].attrs.update(named)
    return image.getvalue()


def _write(file: "h5netcdf.File", variable: Variable) -> None:
    import h5py  # noqa: PLC0415 (0.1 s)

    dims, data = variable.dims, variable.data
    kind, packing = data.dtype, dict[str, Any]()
    if data.dtype.kind == "U":
        kind, data = h5py.string_dtype(), data.astype(object)
    elif data.ndim > 1:
        chunks = (1, *data.shape[1:]) if dims[0] == "frame" else data.shape
        packing = {"compression": "gzip", "compression_opts": 1, "shuffle": True}
        packing |= {"chunks": chunks, "fletcher32": True}
    file.create_variable(variable.name, dims, kind, data=data, **packing)


def load(path: str | Path) -> Solution | TransientSolution:
    """Read a result that :func:`save` wrote, with its fields bit by bit: see `tehl.load`."""
    source = Path(path)
    arrays, attrs = _read(source)
    _check_kind(source, attrs)
    try:
        if law := missing_law(attrs):
            raise FileFormatError(f"{source} has {law}: install it to read this file")
        return rebuild(arrays, attrs)
    except KeyError as error:
        raise FileFormatError(
            f"{source} is an incomplete tehl result: {error} is missing{_writer(attrs)}"
        ) from None
    except ValueError as error:
        raise FileFormatError(
            f"{source} is not a valid tehl result: {_reason(error)}{_writer(attrs)}"
        ) from None
    except (TypeError, AttributeError, IndexError, RecursionError) as error:
        raise _damaged(source, error) from None


def load_as(kind: type[Kind], path: str | Path) -> Kind:
    """Read a `Solution` or a `TransientSolution`: see `tehl.load`; another kind is an error."""
    result = load(path)
    if isinstance(result, kind):
        return result
    wanted, found = KINDS if kind is Solution else KINDS[::-1]
    raise FileFormatError(f"{path} holds a {found} result; expected a {wanted} one")


def load_summary(path: str | Path) -> dict[str, Any]:
    """Read the summary of a result file, with its extra blocks; raise as :func:`load`."""
    source = Path(path)
    attrs = _read(source)[1]
    try:
        content = json.loads(attrs.get("summary", "{}"))
    except (TypeError, ValueError, RecursionError) as error:
        raise _damaged(source, error) from None
    return content if isinstance(content, dict) else {}


def _read(source: Path) -> tuple[Arrays, Attributes]:
    """Return arrays and attributes of a result file of any version, by name."""
    import h5py  # noqa: PLC0415 (0.1 s; h5netcdf prints to stderr on a broken file)

    _check_signature(source)
    try:
        with h5py.File(source, "r") as file:
            attrs = {name: _plain(value) for name, value in file.attrs.items()}
            arrays = {
                name: np.asarray(data.asstr()[...] if data.dtype.kind == "O" else data[...])
                for name, data in file.items()
            }
    except Exception as error:  # on a broken file these libraries raise anything
        raise _damaged(source, error) from None
    if "tehl_format" not in attrs:
        raise FileFormatError(f"{source} is a NetCDF-4 file, but not a tehl result")
    return arrays, attrs


def _check_signature(source: Path) -> None:
    if source.is_dir():
        raise InputError(f"{shortened(source)} is a folder; expected a result file such as film.nc")
    if not source.is_file():
        raise InputError(f"result file {shortened(source)} does not exist")
    try:
        with source.open("rb") as file:
            start = file.read(len(_HDF5_SIGNATURE))
    except OSError as error:
        raise InputError(f"cannot read {source}: {error.strerror}") from None
    if not start:
        raise FileFormatError(f"{source} is empty, not a tehl result")
    if start != _HDF5_SIGNATURE:
        kind = "a NetCDF-3 file" if start.startswith(b"CDF") else "not a NetCDF-4 file"
        raise FileFormatError(f"{source} is {kind}, so not a tehl result")


def _check_kind(source: Path, attrs: Attributes) -> None:
    """Raise if this version cannot read the format or the kind of the file."""
    try:
        version = int(attrs["tehl_format"])
    except (TypeError, ValueError) as error:
        raise _damaged(source, error) from None
    if version != FORMAT_VERSION:
        raise FileFormatError(
            f"{source} is a tehl result of format {version} (by {attrs.get('source', 'tehl')}); "
            f"this tehl reads format {FORMAT_VERSION}"
        )
    if attrs.get("tehl_kind") not in KINDS:
        raise FileFormatError(
            f"{source} is a tehl result of kind {attrs.get('tehl_kind')!r}; "
            f"expected {' or '.join(KINDS)}"
        )


def _plain(value: Any) -> Any:
    """Return an attribute as h5netcdf wrote it; a number comes as an array of one."""
    return value.item() if isinstance(value, np.ndarray) and value.size == 1 else value


def _damaged(source: Path, error: Exception) -> FileFormatError:
    return FileFormatError(f"{source} is truncated or damaged: {_first_line(error)}")


def _writer(attrs: Attributes) -> str:
    """Return the version that wrote a file in words, if it is another one than this."""
    own, writer = f"tehl {__version__}", attrs.get("source", "")
    return "" if writer == own else f" (written by {writer}, this is {own})"


def _reason(error: ValueError) -> str:
    """Return what does not fit in one line; pydantic gives a list of errors."""
    errors = getattr(error, "errors", None)
    if errors is None:
        return _first_line(error)
    first = errors()[0]
    return ": ".join(filter(None, (".".join(map(str, first["loc"])), first["msg"])))


def _first_line(error: Exception) -> str:
    text = str(error.args[0]) if isinstance(error, KeyError) and error.args else str(error)
    return text.partition("\n")[0][:200]
