"""``tehl new``, ``explain`` and ``schema``: case files before they are solved."""

import json
from typing import Annotated

import typer

from tehl.cli.arguments import AsJson, CaseFile, Overrides
from tehl.cli.lazily import case_files, case_templates, explanations, problems
from tehl.cli.lines import show


def _templates(incomplete: str) -> list[tuple[str, str]]:
    """Return the templates and their titles, of which the shell completes a name."""
    known = case_templates.templates() | case_templates.templates("studies")
    return [(name, title) for name, title in known.items() if name.startswith(incomplete)]


def new(
    template: Annotated[
        str, typer.Argument(help="Name of the template.", autocompletion=_templates)
    ] = "ball-on-disc",
    show_list: Annotated[bool, typer.Option("--list", help="List the templates.")] = False,
) -> None:
    """Print a commented case or study file to edit."""
    if not show_list:
        typer.echo(case_templates.template_text(template), nl=False)
        return
    for name, title in case_templates.templates().items():
        show(f"{name:<16}  {title}")
    for name, title in case_templates.templates("studies").items():
        show(f"{name:<16}  {title} (a study)")


def explain(case: CaseFile, *, overrides: Overrides, as_json: AsJson = False) -> None:
    """Show what a case means: Hertz, groups, formulas, unusual values."""
    explanation = explanations.explain(*problems.read_case_and_options(case, overrides))
    if as_json:
        typer.echo(json.dumps(explanations.as_summary(explanation)))
    else:
        show(explanations.as_text(explanation))


def schema() -> None:
    """Print the JSON schema of the case file, for editors."""
    typer.echo(json.dumps(case_files.case_schema(), indent=2, ensure_ascii=False))
