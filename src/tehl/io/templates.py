"""The commented cases that ``tehl new`` prints."""

import difflib
from pathlib import Path

from tehl.errors import InputError

_NAMES = (
    "ball-on-disc",
    "moes",
    "gear-ellipse",
    "rough",
    "thermal",
    "dimple",
    "data-sheet",
    "passing-dent",
)


def templates() -> dict[str, str]:
    """Return the first comment line of each template, by name."""
    return {name: _text(name).splitlines()[0].lstrip("# ") for name in _NAMES}


def template_text(name: str) -> str:
    """Return a commented case file.

    Raises
    ------
    InputError
        If there is no such template; the message lists those there are.
    """
    if name in _NAMES:
        return _text(name)
    close = difflib.get_close_matches(name, _NAMES, n=1)
    guess = f"did you mean {close[0]}? " if close else ""
    raise InputError(f"{name} is no template: {guess}known are {', '.join(_NAMES)}")


def _text(name: str) -> str:
    return (Path(__file__).with_name("cases") / f"{name}.toml").read_text(encoding="utf-8")
