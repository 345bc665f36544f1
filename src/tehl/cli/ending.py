"""How the command ends: exit codes, one line per error, and signals that unwind the stack."""

import json
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any, NoReturn

import typer

from tehl.base.errors import TehlError
from tehl.cli.lines import show

NOT_CONVERGED, BAD_INPUT, ENVIRONMENT = 1, 2, 3
"""Exit codes; 0 is success."""
INTERRUPTED = 128 + signal.SIGINT
"""Exit code after Ctrl-C; after another signal 128 plus its number, as in shells."""
NO_READER = 141
"""Exit code when the reader of the output has closed the pipe, as in shells."""

_WrongCommandLine: Any = typer.BadParameter.__mro__[2]
"""Base of the errors of a wrong command line; typer does not export it."""
EXPECTED = (_WrongCommandLine, TehlError, MemoryError, OSError, ModuleNotFoundError)
_SIGNALS = ("SIGTERM", "SIGHUP")
_LONGEST_MESSAGE = 300
"""Characters of a message about the command line."""


def fail(error: BaseException) -> NoReturn:
    """Print an error to stderr, with ``--json`` also as an object to stdout, and exit."""
    message, status, code = _outcome(error)
    with suppress(OSError):
        show(f"tehl: {message}", err=True)
    if "--json" in sys.argv[1:]:
        with suppress(OSError):
            typer.echo(json.dumps({"status": status, "message": message}))
            flush()
    drop_output()
    raise SystemExit(code)


def _outcome(error: BaseException) -> tuple[str, str, int]:
    """Return the message in one line, status and exit code of an error."""
    message, status, code = str(error), "bad_input", BAD_INPUT
    if isinstance(error, _WrongCommandLine):
        message = _usage(error)
    elif not isinstance(error, TehlError):
        message, status, code = _lacking(error), "environment", ENVIRONMENT
    return " ".join(message.split()), status, code


def _lacking(error: BaseException) -> str:
    if isinstance(error, OSError):
        reason = error.strerror or str(error)
        return f"{error.filename}: {reason}" if error.filename else reason
    if isinstance(error, ModuleNotFoundError):
        return f"{error.name} is not installed; see tehl doctor"
    return "not enough memory: take fewer points"


def _usage(error: Any) -> str:
    """Return what is wrong with a command line in one sentence; without arguments, the help."""
    message = " ".join(error.format_message().split()).removesuffix(".")
    message = message.replace("Value error, ", "")  # of the library that reads the options
    if len(sys.argv) == 1:
        error.show()
        raise SystemExit(BAD_INPUT)
    command = error.ctx.command_path if getattr(error, "ctx", None) else "tehl"
    short = message if len(message) <= _LONGEST_MESSAGE else f"{message[: _LONGEST_MESSAGE - 3]}..."
    return f"{short}; see {command} --help"


def flush() -> None:
    """Write what is buffered for stdout now, while a failure can still be reported."""
    if sys.stdout is not None:
        sys.stdout.flush()


def drop_output() -> None:
    """Discard what is buffered if stdout is a closed pipe or a full disk."""
    try:
        flush()
    except OSError:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())


@contextmanager
def ending() -> Iterator[None]:
    """Let a signal that ends the program unwind the stack, so that no temporary file is left."""
    received: list[int] = []

    def end(number: int, _frame: object) -> None:
        received.append(number)
        raise SystemExit(128 + number)

    before, hook = {}, sys.unraisablehook
    sys.unraisablehook = partial(_raise_again, received, hook)
    if threading.current_thread() is threading.main_thread():
        known = [getattr(signal, name) for name in _SIGNALS if hasattr(signal, name)]
        ignored = [number for number in known if signal.getsignal(number) == signal.SIG_IGN]
        before = {n: signal.signal(n, end) for n in known if n not in ignored}  # nohup stays
    try:
        yield
    except KeyboardInterrupt:
        _report("interrupted")
        raise SystemExit(INTERRUPTED) from None
    except SystemExit:
        if received:
            _report(f"ended by {signal.Signals(received[0]).name}, no file is left half-written")
            raise SystemExit(128 + received[0]) from None
        raise
    finally:
        sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, handler)


def _raise_again(received: list[int], hook: Callable[[Any], object], unraisable: Any) -> None:
    """Signal again if a destructor, in which Python ignores exceptions, has received a signal."""
    if received and isinstance(unraisable.exc_value, SystemExit):
        # seconds after which a signal that a destructor has received is sent again
        threading.Timer(0.05, os.kill, (os.getpid(), received[-1])).start()
    else:
        hook(unraisable)


def _report(message: str) -> None:
    """Print why the program ends, unless the terminal is gone."""
    with suppress(OSError):
        show(f"tehl: {message}", err=True)
