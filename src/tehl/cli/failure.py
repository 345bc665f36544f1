"""What is said on stderr of a film that is no answer."""

from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from tehl.result import Status


def explain_failure(status: "Status", failure: str | None = None) -> None:
    """Say how a run ended that has no answer, and what to try.

    Parameters
    ----------
    status : Status
        Of the run.
    failure : str or None
        What is said if the status has no message.
    """
    typer.echo(f"tehl: not an answer ({status.kind}): {status.message or failure}", err=True)
    if status.hint:
        typer.echo(f"hint: {status.hint}", err=True)
