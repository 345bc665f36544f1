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
    """Write one self-contained HTML page: inputs, groups, pictures, formulas, convergence.

    Of steady results; tehl plot and tehl animate show transient runs.
    """
    from tehl.cli.twins import smooth_beside
    from tehl.io.atomic import check_writable
    from tehl.io.store import load_as, load_summary
    from tehl.post import micro_film, thermal_effect
    from tehl.report.html import write_report
    from tehl.result import Result

    path = stored.with_suffix(".html") if output is None else output
    check_writable(path, sources=(stored,))
    result = load_as(Result, stored)
    summary = load_summary(stored)
    write_report(
        result,
        path,
        effect=thermal_effect.stored_effect(summary),
        roughness=micro_film.stored_effect(summary),
        smooth=smooth_beside(stored, result),
    )
    typer.echo(path)
