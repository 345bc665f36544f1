"""The command ``tehl``: one small file per subcommand, loaded without the machinery behind it."""

import json
import sys
from importlib import import_module
from typing import NoReturn

import typer

from tehl.errors import ConvergenceError, FileFormatError, InputError

COMMANDS = ("new", "explain", "solve", "plot", "export", "report", "doctor", "schema")
"""Module of this package, function in it and word on the command line; in the order of the help."""

NOT_CONVERGED, BAD_INPUT, ENVIRONMENT = 1, 2, 3
"""Exit codes; 0 is success."""

_HELP = "Thermal elastohydrodynamic lubrication of point contacts."
_EPILOG = "Begin: tehl new > case.toml, then tehl explain case.toml, then tehl solve case.toml."


def application() -> typer.Typer:
    """Return the command with all its subcommands."""
    app = typer.Typer(
        name="tehl",
        help=_HELP,
        epilog=_EPILOG,
        no_args_is_help=True,
        add_completion=False,
        rich_markup_mode=None,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(invoke_without_command=True)(_common)
    for name in COMMANDS:
        app.command(name)(getattr(import_module(f"tehl.cli.{name}"), name))
    return app


def main() -> NoReturn:
    """Run the command; every error raised on purpose becomes a line and an exit code."""
    try:
        application()()
    except (InputError, FileFormatError) as error:
        _fail(str(error), "bad_input", BAD_INPUT)
    except ConvergenceError as error:
        _fail(str(error), error.result.status.kind, NOT_CONVERGED)
    except OSError as error:
        _fail(str(error), "environment", ENVIRONMENT)
    raise SystemExit(0)


def _fail(message: str, status: str, code: int) -> NoReturn:
    """Tell what went wrong on stderr, with ``--json`` also as an object on stdout, and exit."""
    typer.echo(f"tehl: {message}", err=True)
    if "--json" in sys.argv[1:]:
        typer.echo(json.dumps({"status": status, "message": message}))
    raise SystemExit(code)


def _common(
    version: bool = typer.Option(False, "--version", help="Print the version and exit."),
) -> None:
    if version:
        from tehl import __version__

        typer.echo(f"tehl {__version__}")
        raise typer.Exit
