"""``tehl plot``: pictures from a stored result."""

from pathlib import Path
from typing import Annotated

import typer


def plot(
    stored: Annotated[Path, typer.Argument(metavar="RESULT", help="Result file (.nc).")],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Folder; RESULT_plots if left out."),
    ] = None,
    dpi: Annotated[int, typer.Option(min=30, max=1200, help="Dots per inch.")] = 150,
) -> None:
    """Draw all pictures of a stored result; nothing is compiled or solved."""
    from tehl.cli.twins import smooth_beside
    from tehl.io.atomic import check_folder
    from tehl.io.store import load
    from tehl.plots.save import save_all
    from tehl.plots.transient import save_transient
    from tehl.transient_result import TransientResult

    folder = stored.with_name(f"{stored.stem}_plots") if output is None else output
    check_folder(folder)
    result = load(stored)
    if isinstance(result, TransientResult):
        for path in save_transient(result, folder, dpi=dpi):
            typer.echo(path)
        return
    for path in save_all(result, folder, dpi=dpi, smooth=smooth_beside(stored, result)):
        typer.echo(path)
