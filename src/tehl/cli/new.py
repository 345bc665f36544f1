"""``tehl new``: a commented case or study to edit."""

from typing import Annotated

import typer


def new(
    template: Annotated[str, typer.Argument(help="Which template.")] = "ball-on-disc",
    show_list: Annotated[bool, typer.Option("--list", help="List the templates.")] = False,
) -> None:
    """Print a commented case or study file to edit."""
    from tehl.io.templates import study_templates, template_text, templates

    if show_list:
        for name, title in templates().items():
            typer.echo(f"{name:<14} {title}")
        for name, title in study_templates().items():
            typer.echo(f"{name:<14} {title} (a study)")
        return
    typer.echo(template_text(template), nl=False)
