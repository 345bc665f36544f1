"""One run at a time in the folder of a study."""

import errno
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

LOCK = "study.lock"
"""Held while a study runs; the system lets go of it when the program ends, however it ends."""
_TAKEN = (errno.EAGAIN, errno.EACCES)


@contextmanager
def only_run_in(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder of a study, which exists.

    Where the system knows no locks, nothing is held.

    Raises
    ------
    OSError
        If another run holds it.
    """
    with (folder / LOCK).open("ab") as file:
        if not _locked(file):
            raise OSError(
                f"another tehl study runs in {folder}: wait until it ends, or take another folder "
                "with -o"
            )
        yield


def _locked(file: IO[bytes]) -> bool:
    """Take the lock; return False if another has it."""
    try:
        import fcntl  # noqa: PLC0415 (not on Windows)
    except ModuleNotFoundError:
        return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        return error.errno not in _TAKEN  # some file systems of networks know no locks
    return True
