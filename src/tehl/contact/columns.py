"""Two columns of a CSV file, with their units if the header has them."""

import re
from pathlib import Path


def read_columns(
    path: Path, names: tuple[str, str], header: str
) -> tuple[list[tuple[float, float]], tuple[str, str] | None]:
    """Return the pairs of numbers of a CSV file, and the units of both columns if it has a header.

    Parameters
    ----------
    path : Path
        The file.
    names : (str, str)
        What its columns have, for messages.
    header : str
        A header that is right, for messages.

    Raises
    ------
    ValueError
        If it is not a file of two columns of numbers.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")[:1_000_000]  # characters that are read
    except (OSError, UnicodeDecodeError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "not a text file"
        raise ValueError(f"cannot be read ({reason})") from None
    rows = [
        re.split(r"[;,\t]|\s+(?!\[)", line.strip()) for line in text.splitlines() if line.strip()
    ]
    units = None
    if rows and "[" in "".join(rows[0]):
        found = re.findall(r"\[([^\]]*)\]", ",".join(rows.pop(0)))
        if len(found) != len(names):
            raise ValueError(f"has a header without both units, such as: {header}")
        units = (found[0].strip(), found[1].strip())
    wrong = f"is not a CSV file of two columns of numbers, {names[0]} and {names[1]}"
    try:
        pairs = [tuple(float(cell) for cell in row if cell) for row in rows]
    except ValueError:
        raise ValueError(wrong) from None
    if not pairs or any(len(pair) != len(names) for pair in pairs):
        raise ValueError(wrong)
    return [(first, second) for first, second in pairs], units
