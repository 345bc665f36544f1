"""Files of measured heights: one reader per format, chosen by the ending of the name."""

import stat
from pathlib import Path

from tehl.errors import InputError
from tehl.roughness.files.libraries import FORMATS, read_instrument, read_netcdf, read_npy
from tehl.roughness.files.raw import LARGEST_FILE, RawMap
from tehl.roughness.files.text import Layout, read_text
from tehl.roughness.files.x3p import read_x3p

__all__ = ["ENDINGS", "RawMap", "checked", "read"]

_TEXTS = ("csv", "txt", "asc", "dat", "xyz")
_NETCDF = ("nc", "nc4", "cdf")
ENDINGS = ("npy", *_TEXTS, *_NETCDF, "x3p", *FORMATS)
"""Endings of the files that can be read."""


def read(path: Path, *, layout: Layout = "auto", variable: str | None = None) -> RawMap:
    """Return the content of a file of heights. Nothing in it is ever executed.

    Parameters
    ----------
    path : Path
        The file, as :func:`checked` gives it.
    layout : {"auto", "matrix", "xyz"}
        What the numbers of a text file are.
    variable : str or None
        Which variable of a NetCDF file.

    Raises
    ------
    InputError
        If it does not hold a map; the message lacks the name of the file.
    """
    ending = path.suffix[1:].lower()
    if ending in _TEXTS:
        return read_text(path, "xyz" if ending == "xyz" and layout == "auto" else layout)
    if ending in _NETCDF:
        return read_netcdf(path, variable)
    reader = {"npy": read_npy, "x3p": read_x3p}.get(ending)
    if reader is None and ending not in FORMATS:
        raise InputError(
            f"has an ending that is not a format of heights: known are {', '.join(ENDINGS)}"
        )
    return (reader or read_instrument)(path)


def checked(file: str) -> Path:
    """Return the path of an existing file; raise InputError, without the name, for others."""
    path = Path(file).expanduser()
    try:
        found = path.stat()
    except FileNotFoundError:
        raise InputError("does not exist") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"cannot be read: {reason.lower()}") from None
    if stat.S_ISDIR(found.st_mode):
        raise InputError("is a folder, not a file of heights")
    if not stat.S_ISREG(found.st_mode):
        raise InputError("is not a regular file")
    if found.st_size == 0:
        raise InputError("is empty")
    if found.st_size > LARGEST_FILE:
        raise InputError(f"is larger than {LARGEST_FILE // 10**9} GB: crop the map before")
    return path
