"""Write files atomically, and check outputs before any work is done for them."""

import glob
import os
import stat
import tempfile
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tehl.base.errors import InputError

_NAME_LETTERS = 40
"""Letters of a file in the name of its temporary one."""


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path beside ``path``, which replaces ``path`` unless there is an exception.

    On any exception, an interrupt included, the temporary file is removed and ``path`` is
    unchanged. A link stays a link: the file that it points to is replaced. A folder that is not
    writable is an InputError, a full disk an OSError with the name of the file.
    """
    check_writable(path)
    target = Path(os.path.realpath(path))
    temporary = target.with_name(f".{target.name[:_NAME_LETTERS]}.{uuid.uuid4().hex[:12]}.part")
    try:
        yield temporary
        temporary.replace(target)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def remove_with_parts(path: str | Path) -> None:
    """Remove a file if it exists, and temporary files left by a killed program."""
    target = Path(os.path.realpath(path))
    target.unlink(missing_ok=True)
    if len(target.name) > _NAME_LETTERS:  # others may begin with the same letters
        return
    for part in target.parent.glob(f".{glob.escape(target.name)}.*.part"):
        part.unlink(missing_ok=True)


def check_writable(path: str | Path, *, sources: tuple[str | Path, ...] = ()) -> None:
    """Check that an output file can be written, before any work for it.

    Parameters
    ----------
    path : str or Path
        The output; a link is followed.
    sources : tuple of str or Path
        Inputs of the same command, which must not be overwritten.

    Raises
    ------
    InputError
        If it is one of the sources, not a regular file or write-protected, or if its folder is
        missing or not writable.
    """
    _check_kind(path)  # an invalid name too
    shown, target = shortened(path), Path(os.path.realpath(path))
    if not target.parent.is_dir():
        raise InputError(f"output {shown}: the folder {shortened(target.parent)} does not exist")
    if target.exists():
        if not os.access(target, os.W_OK):
            raise InputError(f"output {shown} is write-protected")
        for source in sources:
            if Path(source).exists() and target.samefile(source):
                raise InputError(f"output {shown} is the same file as the input {source}")
    _check_takes_files(target.parent)


def _check_kind(path: str | Path) -> None:
    """Raise if something other than a regular file exists there, or the name is invalid."""
    shown = shortened(path)
    try:
        mode = Path(path).stat().st_mode
    except FileNotFoundError:
        return
    except (OSError, ValueError) as error:
        raise InputError(f"output {shown} cannot be written: {_reason(error)}") from None
    if stat.S_ISDIR(mode):
        raise InputError(f"output {shown} is a folder; give a file name, such as {shown}/out.nc")
    if not stat.S_ISREG(mode):
        kinds = {stat.S_IFCHR: "device", stat.S_IFBLK: "device", stat.S_IFIFO: "pipe"}
        kind = kinds.get(stat.S_IFMT(mode), "socket")
        raise InputError(f"output {shown} is a {kind}, not a file")


def check_folder(folder: str | Path) -> None:
    """Raise an InputError if an output folder could not be made or written; make nothing yet."""
    _check_takes_files(check_place(folder))


def check_place(folder: str | Path) -> Path:
    """Return the existing part of the path of a folder; raise an InputError if it is a file."""
    place, shown = Path(folder), shortened(folder)
    if "\0" in str(folder):
        raise InputError(f"output folder {shown} cannot be made: its name holds a NUL")
    try:
        while not place.exists():
            if place.is_symlink():
                raise InputError(f"output folder {shown}: {shortened(place)} is a broken link")
            place = place.parent
    except (OSError, ValueError) as error:
        raise InputError(f"output folder {shown} cannot be made: {_reason(error)}") from None
    if not place.is_dir():
        raise InputError(f"output folder {shown}: {shortened(place)} is a file")
    return place


def _check_takes_files(folder: Path) -> None:
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        place = shortened(folder.resolve())
        raise InputError(f"cannot write into {place}: {error.strerror}") from None


def _reason(error: Exception) -> str:
    return str(getattr(error, "strerror", None) or error).lower()


def shortened(path: str | Path) -> str:
    """Return a path for a message: on one line, its middle left out when it is long."""
    text = "".join(c if c.isprintable() else "?" for c in str(path))
    return text if len(text) <= 160 else f"{text[:60]}...{text[-80:]}"
