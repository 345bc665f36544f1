"""The folder with the machine code of the kernels; imports nothing heavy.

Numba's cache does not notice changes of functions in other files that a kernel calls. So each state
of the source has a folder of its own, named by a hash of all kernel files.
"""

import hashlib
import os
import shutil
import sys
import tempfile
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path

SOURCE = Path(__file__).parent
PARTS = ("isothermal", "coupled")
"""Groups of kernels: all films need the first, heated and shear-thinning ones both."""


@cache
def folder() -> Path | None:
    """Return the folder of this source, None if no place is writable.

    It is under ``NUMBA_CACHE_DIR``, else beside the source, else in the user's cache.
    """
    stated = os.environ.get("NUMBA_CACHE_DIR")
    places = [Path(stated)] if stated else [SOURCE / "__pycache__", _user_cache()]
    for place in places:
        try:
            path = place / f"{_installation()}-{_source_hash()}"
            path.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=path):
                return path
        except OSError:
            continue
    return None


def needed(*, coupled: bool) -> tuple[str, ...]:
    """Return the parts that a film needs; ``coupled`` if it is heated or thins in shear."""
    return PARTS if coupled else PARTS[:1]


def missing(*, coupled: bool) -> list[str]:
    """Return those parts that are not compiled."""
    return [part for part in needed(coupled=coupled) if not _mark(part).exists()]


def is_cold(*, coupled: bool) -> bool:
    """Return whether a solve has to compile."""
    return bool(missing(coupled=coupled))


def mark_compiled(part: str) -> None:
    """Record that one of `PARTS` is compiled by this Python and this numba.

    Nothing is recorded where a newer source has removed the folder while this process runs.
    """
    if folder() is not None:
        with suppress(FileNotFoundError):
            _mark(part).touch()


def clear() -> None:
    """Remove the machine code of the present source, for example if a file is damaged."""
    present = folder()
    for path in present.rglob("*") if present else ():
        if path.is_file():
            path.unlink()


def remove_old() -> None:
    """Remove the folders of earlier source of this installation."""
    present = folder()
    if present is None:
        return
    for old in present.parent.glob(f"{_installation()}-*"):
        if old != present:
            shutil.rmtree(old, ignore_errors=True)


def _mark(part: str) -> Path:
    place = folder() or SOURCE / "nowhere"
    return place / f"{part}-{sys.implementation.cache_tag}-{_compiler()}"


@cache  # reading the metadata takes a millisecond
def _compiler() -> str:
    return version("numba")


@cache
def _source_hash() -> str:
    digest = hashlib.sha256()
    for path in sorted(SOURCE.rglob("*.py")):
        digest.update(path.relative_to(SOURCE).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _installation() -> str:
    """Return a name unique to this copy of the package."""
    return f"tehl-{hashlib.sha256(str(SOURCE).encode()).hexdigest()[:8]}"


def _user_cache() -> Path:
    """Return the folder for caches of this user."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData/Local")) / "tehl"
    if sys.platform == "darwin":
        return Path.home() / "Library/Caches/tehl"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "tehl"
