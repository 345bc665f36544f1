"""The command ``tehl``; subcommands load what they need when they run."""

from importlib import import_module
from typing import NoReturn

import typer

from tehl.base.version import __version__
from tehl.cli.ending import EXPECTED, INTERRUPTED, NO_READER, drop_output, ending, fail, flush

COMMANDS = {
    "new": "case",
    "explain": "case",
    "solve": "solve",
    "explore": "explore",
    "layer": "layer",
    "study": "study",
    "contacts": "contacts",
    "fit": "fit",
    "plot": "results",
    "animate": "results",
    "export": "results",
    "report": "results",
    "surface": "surface",
    "oils": "library",
    "solids": "library",
    "doctor": "doctor",
    "schema": "case",
}
"""Subcommands in the order of the help, and the module of this package with their function."""

_HELP = "Elastohydrodynamic lubrication of point and line contacts by full multigrid."
_EPILOG = "Begin: tehl new > case.toml, then tehl explain case.toml, then tehl solve case.toml."


def application() -> typer.Typer:
    """Return the command with all its subcommands."""
    app = typer.Typer(
        name="tehl",
        help=_HELP,
        epilog=_EPILOG,
        no_args_is_help=True,
        rich_markup_mode=None,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(invoke_without_command=True)(_common)
    for name, module in COMMANDS.items():
        app.command(name)(getattr(import_module(f"tehl.cli.{module}"), name))
    return app


def main() -> NoReturn:
    """Run the command; each expected error becomes one line and an exit code."""
    try:
        code = _run()
    except BrokenPipeError:
        drop_output()
        raise SystemExit(NO_READER) from None
    except EXPECTED as error:
        fail(error)
    raise SystemExit(code)


def _run() -> int:
    with ending():
        try:
            code = application()(prog_name="tehl", standalone_mode=False)
        except SystemExit as end:
            if isinstance(end.__context__, BrokenPipeError):  # typer catches it and exits with 1
                raise end.__context__ from None
            raise
        if code == INTERRUPTED:  # typer's code for Ctrl-C
            raise KeyboardInterrupt
        flush()
    return code if isinstance(code, int) else 0


def _common(
    version: bool = typer.Option(False, "--version", help="Print the version and exit."),
) -> None:
    if version:
        typer.echo(f"tehl {__version__}")
        raise typer.Exit
