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
    """Rows of a CSV table."""

    lines = "lines"
    fields = "fields"
    history = "history"


def export(
    stored: Annotated[Path, typer.Argument(metavar="RESULT", help="Result file (.nc).")],
    to: Annotated[
        Kind | None, typer.Option("--to", help="Format; by the ending of -o if left out.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="File; beside RESULT if left out.")
    ] = None,
    what: Annotated[
        What | None,
        typer.Option(
            help="csv only: centre lines (default), fields at all nodes, or the history of the "
            "cycles or time steps (default of a transient result)."
        ),
    ] = None,
) -> None:
    """Write a stored result as CSV, VTK (ParaView), npz (numpy) or mat (MATLAB).

    VTK: of a steady result the ending .vtr gives the plane of the film, .vts the film as a volume
    with its temperatures; of a transient result .pvd gives all frames, one .vtr file each.
    """
    from tehl.io.atomic import check_writable
    from tehl.io.export import ending_of
    from tehl.io.export import export as write
    from tehl.io.store import load

    result = load(stored)
    path = stored.with_suffix(ending_of(result, to)) if output is None else output
    check_writable(path, sources=(stored,))
    for written in write(result, path, to, what or ""):
        typer.echo(written)
