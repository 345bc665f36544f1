"""The command ``tehl``: one small file per subcommand, loaded without the machinery behind it."""

import json
import os
import sys
from contextlib import suppress
from importlib import import_module
from typing import Any, NoReturn

import typer

from tehl.errors import ConvergenceError, TehlError

COMMANDS = (
    "new",
    "explain",
    "solve",
    "study",
    "reproduce",
    "plot",
    "animate",
    "export",
    "report",
    "surface",
    "doctor",
    "schema",
)
"""Module of this package, function in it and word on the command line; in the order of the help."""

NOT_CONVERGED, BAD_INPUT, ENVIRONMENT = 1, 2, 3
"""Exit codes; 0 is success."""
NO_READER = 141
"""Exit code when nobody reads the output any more, as shells have it."""

_HELP = "Elastohydrodynamic lubrication of point contacts by full multigrid."
_EPILOG = "Begin: tehl new > case.toml, then tehl explain case.toml, then tehl solve case.toml."
_WrongCommandLine: Any = typer.BadParameter.__mro__[2]
"""Base of what a wrong command line raises; typer does not export it."""


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
        code = _run()
    except BrokenPipeError:
        _drop_output()
        raise SystemExit(NO_READER) from None
    except (_WrongCommandLine, TehlError, MemoryError, OSError, ModuleNotFoundError) as error:
        _fail(*_told(error))
    raise SystemExit(code)


def _run() -> int:
    """Return the exit code of the command."""
    from tehl.cli.ending import INTERRUPTED, ending_cleanly

    with ending_cleanly():
        try:
            code = application()(prog_name="tehl", standalone_mode=False)
        except SystemExit as end:
            if isinstance(end.__context__, BrokenPipeError):  # typer takes it and ends with 1
                raise end.__context__ from None
            raise
        if code == INTERRUPTED:  # what typer makes of Ctrl-C
            raise KeyboardInterrupt
        _flush()
    return code if isinstance(code, int) else 0


def _told(error: BaseException) -> tuple[str, str, int]:
    """Return message, status and exit code of an error."""
    if isinstance(error, _WrongCommandLine):
        return _usage(error), "bad_input", BAD_INPUT
    if isinstance(error, ConvergenceError):
        return str(error), error.result.status.kind, NOT_CONVERGED
    if isinstance(error, TehlError):
        return str(error), "bad_input", BAD_INPUT
    if isinstance(error, OSError):
        return _system_words(error), "environment", ENVIRONMENT
    if isinstance(error, ModuleNotFoundError):
        return f"{error.name} is not installed; see tehl doctor", "environment", ENVIRONMENT
    return "not enough memory: take fewer points", "environment", ENVIRONMENT


def _fail(message: str, status: str, code: int) -> NoReturn:
    """Tell what went wrong on stderr, with ``--json`` also as an object on stdout, and exit."""
    message = " ".join(message.split())
    with suppress(OSError):
        typer.echo(f"tehl: {message}", err=True)
    if "--json" in sys.argv[1:]:
        with suppress(OSError):
            typer.echo(json.dumps({"status": status, "message": message}))
            _flush()
    _drop_output()
    raise SystemExit(code)


def _usage(error: Any) -> str:
    """Return what is wrong with a command line in one sentence; without arguments, the help."""
    message = " ".join(error.format_message().split()).removesuffix(".")
    if len(sys.argv) == 1:
        error.show()
        raise SystemExit(BAD_INPUT)
    command = error.ctx.command_path if getattr(error, "ctx", None) else "tehl"
    short = message if len(message) <= 300 else f"{message[:297]}..."
    return f"{short}; see {command} --help"


def _system_words(error: OSError) -> str:
    reason = error.strerror or str(error)
    return f"{error.filename}: {reason}" if error.filename else reason


def _flush() -> None:
    """Write what waits for stdout now, while a failure can still be told."""
    if sys.stdout is not None:
        sys.stdout.flush()


def _drop_output() -> None:
    """Let nothing be written at exit to a pipe without a reader or a full disk."""
    try:
        _flush()
    except OSError:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())


def _common(
    version: bool = typer.Option(False, "--version", help="Print the version and exit."),
) -> None:
    if version:
        from tehl import __version__

        typer.echo(f"tehl {__version__}")
        raise typer.Exit
