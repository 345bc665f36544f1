"""What the header of a text of heights states: the unit, a conversion factor, sizes."""

import re

from tehl.roughness.model import metres

_LINE = re.compile(r"([A-Za-z][^:=]{0,40}?)\s*[:=]\s*(.{0,200})")
_LENGTH = re.compile(r"([+-]?\d*[.,]?\d+(?:[eE][+-]?\d+)?)\s*([^\W\d][^\s/;,]*)")
_KEYS = {
    "unit": r"(data|value|z|height|heights)?\s*units?",
    "factor": r"(conversion|scale|z)\s*(factor|scale)|conversion",
    "x": r"width|x\s*(length|size)|(length|size)\s*x",
    "y": r"height|y\s*(length|size)|(length|size)\s*y",
    "size": r"(scan\s*|image\s*)?size",
    "pixel": r"(pixel|x|lateral)\s*(size|step|pitch|distance|spacing|resolution)|pixel",
}


class Header:
    """Lines ``key: value`` before the numbers; keys that are not known do not count."""

    def __init__(self) -> None:
        self._found: dict[str, str] = {}

    def takes(self, line: str) -> bool:
        """Return whether a line is one of a header; keep its value."""
        match = _LINE.fullmatch(line.strip())
        if match is None:
            return False
        key, value = re.sub(r"[\s_-]+", " ", match[1].lower()), match[2].strip(" \t;,[]()\"'")
        for name, pattern in _KEYS.items():
            if re.fullmatch(pattern, key):
                self._found.setdefault(name, value)
        return True

    @property
    def unit(self) -> str | None:
        """Return the unit of the heights; where it is not a length, the length it stands for."""
        unit = self._found.get("unit") or None
        if unit is not None and metres(unit) is not None:
            return unit
        match = _LENGTH.search(self._found.get("factor", ""))
        per_unit = f"{match[1].replace(',', '.')} {match[2]}" if match else ""
        return unit if metres(per_unit) is None else per_unit

    def pixel(self, shape: tuple[int, ...]) -> tuple[float, float] | None:
        """Return the distances of (ny, nx) points along x and y [m], None if not stated."""
        steps = _lengths(self._found.get("pixel", ""))
        if steps:
            return steps[0], steps[-1]
        edges = _lengths(self._found.get("size", ""))
        if not edges:
            edges = [*_lengths(self._found.get("x", "")), *_lengths(self._found.get("y", ""))]
        return (edges[0] / shape[1], edges[1] / shape[0]) if len(edges) == 2 else None


def _lengths(text: str) -> list[float]:
    """Return the lengths with a unit in a text [m]; counts of points have none."""
    found = _LENGTH.findall(text)
    lengths = (metres(f"{number.replace(',', '.')} {unit}") for number, unit in found)
    return [length for length in lengths if length is not None]
