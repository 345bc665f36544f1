"""``tehl report``: a stored result as one page."""

from pathlib import Path
from typing import Annotated

import typer


def report(
    stored: Annotated[Path, typer.Argument(metavar="RESULT", help="Result file (.nc).")],
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="HTML file; beside RESULT if left out.")
    ] = None,
) -> None:
    """Write one self-contained HTML page: inputs, groups, pictures, formulas, convergence."""
    from tehl.io.store import load
    from tehl.report.html import write_report

    result = load(stored)
    path = stored.with_suffix(".html") if output is None else output
    write_report(result, path)
    typer.echo(path)
