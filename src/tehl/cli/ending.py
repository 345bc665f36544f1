"""Being stopped: Ctrl-C, a kill and a closed terminal unwind the stack."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import typer

INTERRUPTED = 128 + signal.SIGINT
"""Exit code after Ctrl-C; that of another signal is 128 and its number too, as in shells."""

_SIGNALS = ("SIGTERM", "SIGHUP")


@contextmanager
def ending_cleanly() -> Iterator[None]:
    """Let a signal that ends the program unwind the stack, so that no temporary file stays."""

    def end(number: int, _frame: object) -> None:
        raise SystemExit(128 + number)

    before = {}
    if threading.current_thread() is threading.main_thread():
        known = [getattr(signal, name) for name in _SIGNALS if hasattr(signal, name)]
        ignored = [number for number in known if signal.getsignal(number) == signal.SIG_IGN]
        before = {n: signal.signal(n, end) for n in known if n not in ignored}  # nohup stays
    try:
        yield
    except KeyboardInterrupt:
        typer.echo("tehl: interrupted", err=True)
        raise SystemExit(INTERRUPTED) from None
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
