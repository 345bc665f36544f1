r"""Text files of the rigs of PCS Instruments, MTM (traction) and EHD2 (film), as rows of a list.

A file has steps, ``Step type\tFILM``, each with a table of its own: headings with units, parted by
tabs, then a row per point. The layout is that of the files in the tests of the Python package
``tribology`` (M. Ploss, github.com/moritzploss/tribology).
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal

from tehl.base.atomic import shortened
from tehl.base.encoding import encoding_of
from tehl.base.errors import InputError
from tehl.base.lists import LARGEST_LIST

Probe = Literal["lube", "pot"]
"""Where the rig measures the temperature: in the oil at the contact, or in the pot around it."""
_COLUMNS = (
    *("Rolling Speed (mm/s)", "SRR (%)", "Ball Load (N)", "Lube Temp (°C)"),
    *("Average Film (nm)", "Traction Coeff (-)"),
)
_STEP = re.compile(r"^Step type\t\s*([^\t\r\n]*)", re.MULTILINE)
_CURVES = ("FILM", "TRACTION", "STRIBECK")
"""Last words of the types of steps whose rows are points of a curve; timed steps are not."""
_PROBES: dict[Probe, re.Pattern[str]] = {
    probe: re.compile(rf"{probe}\b.*\btemp\b.*", re.IGNORECASE) for probe in ("lube", "pot")
}

Row = tuple[int, dict[str, str]]
"""Number of a line, and its cells by heading."""


def rig_lines(path: Path, probe: Probe | None = None) -> list[tuple[int, list[Any]]] | None:
    """Return the points of a file of a rig, headings first; None if it is not such a file.

    Parameters
    ----------
    path : Path
        Text of an MTM or EHD2, UTF-8, UTF-16 or of an older Windows.
    probe : {"lube", "pot"} or None
        Which temperature is that of the oil; that of the lubricant where it has one if left out.

    Raises
    ------
    InputError
        If it has no film, traction or Stribeck step, or both temperatures differ by more than 20 K
        and ``probe`` is left out.
    """
    text = _text(path)
    if text is None or _STEP.search(text) is None:
        return None
    kinds: set[str] = set()
    rows = list(_rows(text, kinds))
    if not rows:
        found = f"its steps are {', '.join(sorted(kinds))}" if kinds else "it has none"
        raise InputError(
            f"{shortened(path)}: needs a film, traction or Stribeck step with points; {found}"
        )
    lines = [(number, _cells(cells, number, path, probe)) for number, cells in rows]
    return [(0, list(_COLUMNS)), *lines]


def _text(path: Path) -> str | None:
    """Return the text of a file; None if it is missing, too large or not a text."""
    try:
        if path.stat().st_size > LARGEST_LIST:
            return None
        content = path.read_bytes()
    except OSError:
        return None
    try:
        return content.decode(encoding_of(content[:3]))
    except UnicodeDecodeError:
        return content.decode("cp1252", errors="replace")


def _rows(text: str, kinds: set[str]) -> Iterator[Row]:
    """Yield the points of the steps with curves; ``kinds`` receives the types of all steps."""
    headings: list[str] | None = None
    is_curve = False
    for number, line in enumerate(text.splitlines(), 1):
        cells = [cell.strip() for cell in line.split("\t")]
        if match := _STEP.match(line):
            kinds.add(match[1].strip())
            is_curve = match[1].strip().upper().split("_")[-1] in _CURVES
            headings = None
        elif is_curve and any(cell.startswith("Rolling Speed (") for cell in cells):
            headings = cells
        elif headings is not None and re.match(r"-?[\d.]", line):
            pairs = list(zip(headings, cells, strict=False))
            yield number, {name: cell for name, cell in reversed(pairs) if cell}
        else:
            headings = None


def _cells(found: dict[str, str], number: int, path: Path, probe: Probe | None) -> list[Any]:
    """Return the cells of `_COLUMNS`, None where the row has none."""
    degrees = {
        name: next((found[key] for key in found if pattern.fullmatch(key)), None)
        for name, pattern in _PROBES.items()
    }
    lube, pot = degrees["lube"], degrees["pot"]
    if probe is None and lube and pot and abs(float(lube) - float(pot)) > 20.0:  # one in air
        raise InputError(
            f"{shortened(path)}: line {number}: the probe of the lubricant has {lube} °C and that "
            f"of the pot {pot} °C: state which is that of the oil, lube or pot (--probe pot)"
        )
    known = found | {"Lube Temp (°C)": (lube or pot) if probe is None else degrees[probe]}
    return [known.get(name) for name in _COLUMNS]
