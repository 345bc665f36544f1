"""Results in the formats of other programs: CSV, npz, VTK and MATLAB files."""

import csv
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tehl.errors import InputError
from tehl.io.atomic import replacing
from tehl.io.content import variables
from tehl.io.summary import summary
from tehl.io.vtk import rectilinear_grid
from tehl.result import Result

What = Literal["lines", "fields"]

_HEADER = ("x_m", "y_m", "pressure_pa", "film_thickness_m", "X", "Y", "P", "H")


def write(result: Result, path: str | Path, kind: str) -> None:
    """Write ``result`` as ``kind``, with the defaults of that format.

    Parameters
    ----------
    result : Result
        What to write.
    path : str or Path
        The file; an older one is replaced.
    kind : {"csv", "npz", "vtk", "mat"}
        The format.

    Raises
    ------
    InputError
        If ``kind`` is unknown or the file cannot be written.
    """
    if kind not in WRITERS:
        raise InputError(f"unknown export format {kind!r}; known: {', '.join(WRITERS)}")
    WRITERS[kind](result, path)


def kind_of(path: str | Path | None, stated: str | None) -> str:
    """Return the format of an export, from what is stated and from the ending of its file.

    Parameters
    ----------
    path : str, Path or None
        The file; None when it gets the ending of its format.
    stated : {"csv", "npz", "vtk", "mat"} or None
        The format; None where the ending of the file tells it.

    Raises
    ------
    InputError
        If neither tells a format, or if they do not fit: programs choose a reader by the ending.
    """
    endings = ", ".join(SUFFIXES.values())
    if path is None:
        if stated is None:
            raise InputError(f"state a format (--to) or a file (-o) with the ending {endings}")
        return stated
    suffix = Path(path).suffix
    deduced = next((kind for kind, end in SUFFIXES.items() if end == suffix.lower()), None)
    if stated is None and deduced is not None:
        return deduced
    if stated is None and suffix.lower() in _OTHER_VTK:
        stated = "vtk"
    if stated is None:
        raise InputError(f"output {path}: its ending tells no format; state --to or use {endings}")
    if stated != deduced:
        why = " (an XML rectilinear grid)" if stated == "vtk" else ""
        raise InputError(
            f"output {path}: a file of format {stated}{why} ends in {SUFFIXES[stated]}"
        )
    return stated


def write_csv(result: Result, path: str | Path, *, what: What = "lines") -> None:
    """Write a table with one row per node, as any spreadsheet reads it.

    ``"lines"`` gives the two grid lines nearest to the axes, told apart by a column more: first
    ``line = x`` (along entrainment, Y = 0), then ``line = y`` (across, X = 0). ``"fields"`` gives
    all nodes in long form, x running fastest. Columns carry their unit in their name; X, Y, P and H
    are dimensionless. Numbers are written so that reading them gives back the same bits.

    Parameters
    ----------
    result : Result
        What to write.
    path : str or Path
        The file; an older one is replaced.
    what : {"lines", "fields"}
        Which nodes.
    """
    lines = what == "lines"
    header = ("line", *_HEADER) if lines else _HEADER
    rows = _line_rows(result) if lines else _rows(result, (slice(None), slice(None)))
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows(rows)


def _line_rows(result: Result) -> Iterator[tuple[Any, ...]]:
    row = int(np.argmin(np.abs(result.scaled.y)))
    column = int(np.argmin(np.abs(result.scaled.x)))
    for name, part in (
        ("x", (slice(row, row + 1), slice(None))),
        ("y", (slice(None), slice(column, column + 1))),
    ):
        yield from ((name, *numbers) for numbers in _rows(result, part))


def _rows(result: Result, part: tuple[slice, slice]) -> Iterator[tuple[Any, ...]]:
    x, y = np.meshgrid(result.x, result.y)
    scaled_x, scaled_y = np.meshgrid(result.scaled.x, result.scaled.y)
    fields = (x, y, result.pressure, result.film_thickness, scaled_x, scaled_y)
    columns = [
        field[part].ravel().tolist()
        for field in (*fields, result.scaled.pressure, result.scaled.film)
    ]
    return zip(*columns, strict=True)


def write_npz(result: Result, path: str | Path) -> None:
    """Write all arrays, and the summary as JSON text, for ``numpy.load``.

    Parameters
    ----------
    result : Result
        What to write.
    path : str or Path
        The file; an older one is replaced.
    """
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **_arrays(result))


def write_mat(result: Result, path: str | Path) -> None:
    """Write all arrays, and the summary as JSON text (``jsondecode``), for MATLAB and Octave.

    Names differ by case, as MATLAB allows: ``x`` is in metres, ``X`` in Hertz half-widths. Fields
    have rows along y.

    Parameters
    ----------
    result : Result
        What to write.
    path : str or Path
        The file; an older one is replaced.
    """
    from scipy.io import savemat  # noqa: PLC0415 (0.3 s, for this format only)

    with replacing(path) as temporary, temporary.open("wb") as file:
        savemat(file, _arrays(result), do_compression=True, oned_as="column")


def _arrays(result: Result) -> dict[str, NDArray[Any]]:
    arrays = {variable.name: variable.data for variable in variables(result)}
    return {**arrays, "summary": np.array(json.dumps(summary(result)))}


def write_vtk(result: Result, path: str | Path) -> None:
    """Write the fields as a VTK rectilinear grid (``.vtr``), which ParaView opens.

    The grid is the plane z = 0 with x and y in metres and four point arrays: ``pressure`` [Pa],
    ``film_thickness`` [m], ``P`` and ``H`` [-]. "Warp by scalar" raises a film to a surface.

    Parameters
    ----------
    result : Result
        What to write.
    path : str or Path
        The file, best with the ending ``.vtr``; an older one is replaced.
    """
    text = rectilinear_grid(
        (result.x, result.y, np.zeros(1)),
        {
            "pressure": result.pressure,
            "film_thickness": result.film_thickness,
            "P": result.scaled.pressure,
            "H": result.scaled.film,
        },
        field_data={"converged": float(result.status.converged)},
    )
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="ascii")


WRITERS: dict[str, Callable[[Result, str | Path], None]] = {
    "csv": write_csv,
    "npz": write_npz,
    "vtk": write_vtk,
    "mat": write_mat,
}

SUFFIXES = {"csv": ".csv", "npz": ".npz", "vtk": ".vtr", "mat": ".mat"}
_OTHER_VTK = (".vtk", ".vts", ".vti", ".vtu")
