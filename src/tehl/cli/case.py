"""``tehl new``, ``explain`` and ``schema``: case files before they are solved."""

import json
from typing import Annotated

import typer

from tehl.cli.arguments import AsJson, CaseFile, Overrides
from tehl.cli.lines import show


def _templates(incomplete: str) -> list[tuple[str, str]]:
    """Return the templates and their titles, of which the shell completes a name."""
    from tehl.io.templates import templates

    known = templates() | templates("studies")
    return [(name, title) for name, title in known.items() if name.startswith(incomplete)]


def new(
    template: Annotated[
        str, typer.Argument(help="Name of the template.", autocompletion=_templates)
    ] = "ball-on-disc",
    show_list: Annotated[bool, typer.Option("--list", help="List the templates.")] = False,
) -> None:
    """Print a commented case or study file to edit."""
    from tehl.io.templates import template_text, templates

    if not show_list:
        typer.echo(template_text(template), nl=False)
        return
    for name, title in templates().items():
        show(f"{name:<16}  {title}")
    for name, title in templates("studies").items():
        show(f"{name:<16}  {title} (a study)")


def explain(case: CaseFile, *, overrides: Overrides, as_json: AsJson = False) -> None:
    """Show what a case means: Hertz, groups, formulas, unusual values."""
    from tehl.io.case import read_case_and_options
    from tehl.report.explain import as_summary, as_text
    from tehl.report.explain import explain as explained

    explanation = explained(*read_case_and_options(case, overrides))
    if as_json:
        typer.echo(json.dumps(as_summary(explanation)))
    else:
        show(as_text(explanation))


def schema() -> None:
    """Print the JSON schema of the case file, for editors."""
    from tehl.io.case import case_schema

    typer.echo(json.dumps(case_schema(), indent=2, ensure_ascii=False))
