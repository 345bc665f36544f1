"""The commented cases and studies that ``tehl new`` prints."""

import difflib
from pathlib import Path

from tehl.errors import InputError

_CASES = (
    *("ball-on-disc", "moes", "gear-ellipse", "rough", "thermal", "dimple", "data-sheet"),
    "passing-dent",
)
_STUDIES = ("traction-curve", "film-vs-speed", "film-vs-load", "moes-map", "stribeck")


def templates() -> dict[str, str]:
    """Return the first comment line of each template of a case, by name."""
    return {name: _text(name).splitlines()[0].lstrip("# ") for name in _CASES}


def study_templates() -> dict[str, str]:
    """Return the first comment line of each template of a study, by name."""
    return {name: _text(name).splitlines()[0].lstrip("# ") for name in _STUDIES}


def template_text(name: str) -> str:
    """Return a commented case file or study file.

    Raises
    ------
    InputError
        If there is no such template; the message lists those there are.
    """
    known = (*_CASES, *_STUDIES)
    if name in known:
        return _text(name)
    close = difflib.get_close_matches(name, known, n=1)
    guess = f"did you mean {close[0]}? " if close else ""
    raise InputError(f"unknown template {name}: {guess}known are {', '.join(known)}")


def _text(name: str) -> str:
    folder = "studies" if name in _STUDIES else "cases"
    return (Path(__file__).with_name(folder) / f"{name}.toml").read_text(encoding="utf-8")
