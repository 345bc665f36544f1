"""Being stopped: Ctrl-C, a kill and a closed terminal unwind the stack."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import typer

INTERRUPTED = 128 + signal.SIGINT
"""Exit code after Ctrl-C; that of another signal is 128 and its number too, as in shells."""

_SIGNALS = ("SIGTERM", "SIGHUP")


@contextmanager
def ending_cleanly() -> Iterator[None]:
    """Let a signal that ends the program unwind the stack, so that no temporary file stays."""
    ended: list[int] = []

    def end(number: int, _frame: object) -> None:
        ended.append(number)
        raise SystemExit(128 + number)

    before = {}
    if threading.current_thread() is threading.main_thread():
        known = [getattr(signal, name) for name in _SIGNALS if hasattr(signal, name)]
        ignored = [number for number in known if signal.getsignal(number) == signal.SIG_IGN]
        before = {n: signal.signal(n, end) for n in known if n not in ignored}  # nohup stays
    try:
        yield
    except KeyboardInterrupt:
        _tell("interrupted")
        raise SystemExit(INTERRUPTED) from None
    except SystemExit:
        if ended:
            _tell(f"ended by {signal.Signals(ended[0]).name}, no file is left half-written")
            raise SystemExit(128 + ended[0]) from None
        raise
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _tell(message: str) -> None:
    """Say why it ends; a terminal that is gone hears nothing."""
    with suppress(OSError):
        typer.echo(f"tehl: {message}", err=True)
