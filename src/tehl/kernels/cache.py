"""Whether the kernels have been compiled before: looks at files, imports nothing heavy."""

import os
from pathlib import Path

_FOLDER = Path(__file__).parent


HEATED = ("energy.py", "trail.py")
"""The kernels that only heated and shear-thinning films need."""


def is_cold(*, coupled: bool) -> bool:
    """Return True when a kernel file has no compiled index newer than itself.

    Those of heated and shear-thinning films count where ``coupled``.

    Numba keeps an index (``.nbi``) per compiled function, in ``__pycache__`` beside the source or
    under ``NUMBA_CACHE_DIR``.
    """
    indices = list(_indices())
    return any(
        not any(
            index.name.startswith(f"{source.stem}.")
            and index.stat().st_mtime >= source.stat().st_mtime
            for index in indices
        )
        for source in _FOLDER.glob("*.py")
        if "@njit" in source.read_text(encoding="utf-8")
        and source.name not in ("cache.py", "gauss_seidel.py")
        and (coupled or source.name not in HEATED)
    )


def _indices() -> list[Path]:
    stated = os.environ.get("NUMBA_CACHE_DIR")
    if stated:
        return [p for p in Path(stated).rglob("*.nbi") if "kernels" in p.parent.name]
    beside = list((_FOLDER / "__pycache__").glob("*.nbi"))
    return beside or list((Path.home() / ".cache" / "numba").rglob("*.nbi"))
