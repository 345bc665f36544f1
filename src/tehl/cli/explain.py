"""``tehl explain``: the answer before the solve."""

from pathlib import Path
from typing import Annotated

import typer


def explain(
    case: Annotated[Path, typer.Argument(help="Case file.", show_default=False)],
    changes: Annotated[
        list[str], typer.Option("--set", metavar="KEY=VALUE", help="Change a key of the case.")
    ] = [],  # noqa: B006 (typer reads the default, nobody writes it)
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Show what a case means: Hertz, groups, formulas, odd values."""
    import json

    from tehl.io.case import read_case_and_options
    from tehl.report import explain as report

    explanation = report.explain(*read_case_and_options(case, changes))
    if as_json:
        typer.echo(json.dumps(report.as_summary(explanation)))
    else:
        typer.echo(report.as_text(explanation))
