"""``tehl export``: a stored result in the formats of other programs."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class Kind(StrEnum):
    """Format to write."""

    csv = "csv"
    vtk = "vtk"
    npz = "npz"
    mat = "mat"


class What(StrEnum):
    """Nodes of a CSV table."""

    lines = "lines"
    fields = "fields"


def export(
    stored: Annotated[Path, typer.Argument(metavar="RESULT", help="Result file (.nc).")],
    to: Annotated[
        Kind | None, typer.Option("--to", help="Format; by the ending of -o if left out.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="File; beside RESULT if left out.")
    ] = None,
    what: Annotated[
        What, typer.Option(help="csv only: both centre lines, or all nodes of the fields.")
    ] = What.lines,
) -> None:
    """Write a stored steady result as CSV, VTK (ParaView), npz (numpy) or mat (MATLAB).

    VTK: the ending .vtr gives the plane of the film, .vts the film as a volume with its
    temperatures. Transient runs are not exported: tehl.load and xarray read them.
    """
    from tehl.io.atomic import check_writable
    from tehl.io.export import SUFFIXES, kind_of, write, write_csv
    from tehl.io.store import load

    kind = kind_of(output, None if to is None else to.value)
    path = stored.with_suffix(SUFFIXES[kind]) if output is None else output
    check_writable(path, sources=(stored,))
    result = load(stored)
    if kind == "csv":
        write_csv(result, path, what=what.value)
    else:
        write(result, path, kind)
    typer.echo(path)
