"""Two columns of a CSV file, with their units if the header has them."""

import math
import re
from pathlib import Path

from pydantic import ValidationInfo

from tehl.base.errors import InputError
from tehl.base.lists import lines_of_file
from tehl.base.table import folder_of
from tehl.base.units import Place, quantity


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
        If it is not a file of two columns of finite numbers.
    """
    wrong = f"is not a CSV file of two columns of numbers, {names[0]} and {names[1]}"
    try:
        lines = lines_of_file(path, "file of two columns")
    except InputError as error:
        raise ValueError(f"cannot be read ({error})") from None
    units = None
    if lines and "[" in "".join(lines[0]):
        found = re.findall(r"\[([^\]]*)\]", ",".join(lines.pop(0)))
        if len(found) != len(names):
            raise ValueError(f"has a header without both units, such as: {header}")
        units = (found[0].strip(), found[1].strip())
    try:
        pairs = [tuple(map(float, " ".join(line).split())) for line in lines]
    except ValueError:
        raise ValueError(wrong) from None
    if not pairs or any(len(pair) != len(names) for pair in pairs):
        raise ValueError(wrong)
    for pair in pairs:
        if not all(map(math.isfinite, pair)):
            raise ValueError(f"has the line {pair[0]:g}, {pair[1]:g}; both numbers must be finite")
    return [(first, second) for first, second in pairs], units


def lengths_over_y(stated: object, info: ValidationInfo, name: str) -> object:
    """Return places y and lengths there [m] of the CSV file that a table names.

    Parameters
    ----------
    stated : object
        Name of the file, beside the case; anything else is returned as it is.
    info : ValidationInfo
        Of the table, with the folder of the case.
    name : str
        What the second column has, for messages.
    """
    if not isinstance(stated, str):
        return stated
    path = (folder_of(info) or Path()) / stated
    pairs, units = read_columns(path, ("y", name), f"y [mm], {name} [um]")
    first, second = (quantity(Place).parse(f"1 {unit}") for unit in units or ("m", "m"))
    return [(y * first, length * second) for y, length in pairs]
