"""``tehl schema``: the JSON schema of the case file."""

import typer


def schema() -> None:
    """Print the JSON schema of the case file, for editors."""
    import json

    from tehl.io.case import case_schema

    typer.echo(json.dumps(case_schema(), indent=2, ensure_ascii=False))
