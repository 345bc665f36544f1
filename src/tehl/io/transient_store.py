"""Transient runs on disk (NetCDF-4) and as datasets, there and back without loss."""

from pathlib import Path
from typing import TYPE_CHECKING

from tehl.errors import FileFormatError
from tehl.io import content, store
from tehl.io.transient_content import COORDINATES, KIND, attributes, rebuild, variables
from tehl.result import Result
from tehl.transient_result import TransientResult

if TYPE_CHECKING:
    import xarray as xr


def to_dataset(run: TransientResult) -> "xr.Dataset":
    """Return ``run`` as a dataset.

    Parameters
    ----------
    run : TransientResult
        What a transient run returned or :func:`load` read.

    Returns
    -------
    xarray.Dataset
        Numbers of each step over ``time``, the line y = 0 over ``(time, x)``, fields at chosen
        instants over ``(frame, y, x)``, and all that the steady film of the beginning has;
        ``units`` and ``long_name`` on each variable.
    """
    return store.dataset(variables(run), attributes(run), COORDINATES)


def save(run: TransientResult, path: str | Path) -> None:
    """Write ``run`` to a NetCDF-4 file; whole, or not at all.

    Parameters
    ----------
    run : TransientResult
        The run, to its end or not; the file says which.
    path : str or Path
        The file; an older one is replaced.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    store.write(path, variables(run), attributes(run))


def load(path: str | Path) -> Result | TransientResult:
    """Read what a solve or a transient run has stored; nothing is compiled for it.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Result or TransientResult
        As the file says; equal to the one saved, its fields bit by bit.

    Raises
    ------
    InputError
        If there is no such file.
    FileFormatError
        If it is truncated, foreign or of a format that this version does not know.
    """
    source = Path(path)
    arrays, attrs = store.read(source)
    kind = attrs.get("tehl_kind", store.STEADY)
    if kind == KIND:
        return store.rebuilt(source, arrays, attrs, rebuild)
    if kind != store.STEADY:
        raise FileFormatError(
            f"{source} is a tehl result of the kind {kind!r}; this tehl reads {store.STEADY} and "
            f"{KIND}"
        )
    return store.rebuilt(source, arrays, attrs, content.rebuild)


def load_transient(path: str | Path) -> TransientResult:
    """Read a transient run.

    Parameters
    ----------
    path : str or Path
        The file.

    Raises
    ------
    InputError
        If there is no such file.
    FileFormatError
        If it is no file of this package, or that of a steady film.
    """
    run = load(path)
    if isinstance(run, TransientResult):
        return run
    raise FileFormatError(f"{path} holds a steady film: there is nothing that moves in time")
