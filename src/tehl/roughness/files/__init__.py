"""Files of measured heights: one reader per format, chosen by the ending of the name."""

import stat
from pathlib import Path

from tehl.base.errors import InputError
from tehl.roughness.files.libraries import (
    FORMATS,
    METROPRO,
    is_metropro,
    read_instrument,
    read_netcdf,
    read_npy,
    read_npz,
)
from tehl.roughness.files.raw import LARGEST_FILE, RawMap, shown
from tehl.roughness.files.text import Layout, read_text
from tehl.roughness.files.x3p import read_x3p

__all__ = ["ENDINGS", "INSTRUMENTS", "RawMap", "checked", "read"]

_OWN = {
    **dict.fromkeys(("csv", "txt", "asc", "dat", "xyz"), "text"),
    **dict.fromkeys(("nc", "nc4", "cdf"), "netcdf"),
    **{name: name for name in ("npy", "npz", "x3p")},
}
ENDINGS = (*_OWN, *FORMATS)
"""Endings of the files that can be read."""
INSTRUMENTS = tuple(sorted({*FORMATS.values(), METROPRO}))
"""Formats that SurfaceTopography reads."""


def read(
    path: Path, *, layout: Layout = "auto", variable: str | None = None, form: str = "auto"
) -> RawMap:
    """Return the content of a file of heights. Nothing in it is ever executed.

    Parameters
    ----------
    path : Path
        The file, as :func:`checked` gives it.
    layout : {"auto", "matrix", "xyz"}
        What the numbers of a text file are.
    variable : str or None
        Which variable of a NetCDF file, or array of an npz file.
    form : str
        Format to read it as; "auto" is that of its ending.

    Raises
    ------
    InputError
        If it does not hold a map; the message lacks the name of the file.
    """
    name = _format_of(path) if form == "auto" else form
    if name in INSTRUMENTS:
        return read_instrument(path, name)
    as_columns = layout == "auto" and path.suffix.lower() == ".xyz"
    readers = {
        "text": lambda: read_text(path, "xyz" if as_columns else layout),
        "netcdf": lambda: read_netcdf(path, variable),
        "npy": lambda: read_npy(path),
        "npz": lambda: read_npz(path, variable),
        "x3p": lambda: read_x3p(path),
    }
    return readers[name]()


def _format_of(path: Path) -> str:
    """Return the format of a file by its ending, and whether a .dat file is one of Zygo's."""
    ending = path.suffix[1:].lower()
    name = _OWN.get(ending) or FORMATS.get(ending)
    if name is None:
        raise InputError(
            f"has an ending that is not a format of heights: known are {', '.join(ENDINGS)}; or "
            'state one, format = "text"'
        )
    return METROPRO if name == "text" and is_metropro(path) else name


def checked(file: str) -> Path:
    """Return the path of an existing file; the InputError of another one names it."""
    path, name = Path(file).expanduser(), f"map {shown(file)}"
    try:
        found = path.stat()
    except FileNotFoundError:
        folder = shown(path.absolute().parent)
        raise InputError(f'no map "{shown(path.name)}" in {folder}') from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{name} cannot be read: {reason.lower()}") from None
    if stat.S_ISDIR(found.st_mode):
        raise InputError(f"{name} is a folder, not a file of heights")
    if not stat.S_ISREG(found.st_mode):
        raise InputError(f"{name} is not a regular file")
    if found.st_size == 0:
        raise InputError(f"{name} is empty")
    if found.st_size > LARGEST_FILE:
        raise InputError(f"{name} is larger than {LARGEST_FILE // 10**9} GB: crop the map before")
    return path
