"""Files appear whole or not at all."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tehl.errors import InputError


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path beside ``path``; it takes the place of ``path`` when all went well.

    On any exception, an interrupt included, the temporary file goes away and ``path`` stays as
    it was.

    Parameters
    ----------
    path : str or Path
        The file to appear.

    Raises
    ------
    InputError
        If the folder of ``path`` cannot take files.
    """
    target = Path(path)
    check_writable(target)
    temporary = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        yield temporary
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def check_writable(path: str | Path) -> None:
    """Refuse an output file that could not be written, before any work is done for it.

    Parameters
    ----------
    path : str or Path
        The file to be written later.

    Raises
    ------
    InputError
        If ``path`` is a folder or write-protected, or its folder is missing or takes no files.
    """
    target = Path(path)
    folder = target.parent
    if target.is_dir():
        raise InputError(f"output {target} is a folder; give a file name, such as {target}/out.nc")
    if not folder.is_dir():
        raise InputError(f"output {target}: the folder {folder} does not exist")
    if target.exists() and not os.access(target, os.W_OK):
        raise InputError(f"output {target} is write-protected")
    _check_folder(folder)


def check_folder(folder: str | Path) -> None:
    """Refuse an output folder that could not be made or written; make nothing yet.

    Parameters
    ----------
    folder : str or Path
        The folder to hold files later; missing parents are allowed.

    Raises
    ------
    InputError
        If a file is in the way or the place takes no files.
    """
    place = Path(folder)
    while not place.exists():
        place = place.parent
    if not place.is_dir():
        raise InputError(f"output folder {folder}: {place} is a file")
    _check_folder(place)


def _check_folder(folder: Path) -> None:
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise InputError(f"cannot write into {folder.resolve()}: {error.strerror}") from None
