"""The commented cases and studies that ``tehl new`` prints."""

import difflib
from pathlib import Path

from tehl.base.errors import InputError

_NAMES = {
    "cases": (
        *("ball-on-disc", "moes", "bearing", "gear-ellipse", "line", "roller", "rough", "thermal"),
        *("dimple", "data-sheet", "passing-dent", "starved", "grease-decay", "mixed"),
        *("boundary-film", "gear-mesh", "cam", "reversal", "stress", "dynamics", "hypoid", "spin"),
        "rib",
    ),
    "studies": (
        *("traction-curve", "film-vs-speed", "film-vs-load", "moes-map", "stribeck"),
        "starvation-curve",
    ),
}
_FILES = {
    name: Path(__file__).with_name(kind) / f"{name}.toml"
    for kind, names in _NAMES.items()
    for name in names
}


def templates(kind: str = "cases") -> dict[str, str]:
    """Return the first comment line of each template of ``"cases"`` or ``"studies"``, by name."""
    return {name: template_text(name).splitlines()[0].lstrip("# ") for name in _NAMES[kind]}


def template_text(name: str) -> str:
    """Return a commented case file or study file; the InputError for another name lists all."""
    if name in _FILES:
        return _FILES[name].read_text(encoding="utf-8")
    close = difflib.get_close_matches(name, _FILES, n=1)
    guess = f"did you mean {close[0]}? " if close else ""
    raise InputError(f"unknown template {name}: {guess}known are {', '.join(_FILES)}")
