"""``tehl animate``: a stored transient run as a moving picture."""

from pathlib import Path
from typing import Annotated

import typer


def animate(
    stored: Annotated[
        Path, typer.Argument(metavar="RESULT", help="File of a transient run (.nc).")
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="File: .gif, .mp4 or .html; RESULT.gif if left out."),
    ] = None,
    per_second: Annotated[
        int, typer.Option("--fps", min=1, max=100, help="Moments shown in a second.")
    ] = 10,
    dpi: Annotated[int, typer.Option(min=30, max=600, help="Dots per inch.")] = 100,
) -> None:
    """Show a transient run as a moving picture; nothing is compiled or solved.

    It shows the fields that the run has kept (transient.frames of its case).
    """
    from tehl.io.atomic import check_writable
    from tehl.io.store import load_as
    from tehl.plots.animation import animate as draw
    from tehl.plots.animation import check_format
    from tehl.transient_result import TransientResult

    target = stored.with_suffix(".gif") if output is None else output
    check_format(target)
    check_writable(target, sources=(stored,))
    draw(load_as(TransientResult, stored), target, per_second=per_second, dpi=dpi)
    typer.echo(target)
