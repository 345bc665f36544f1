"""Imported by the server of workers and by nobody else.

What each worker needs is loaded here, before they are forked.
"""

import atexit
import os
import sys
from contextlib import suppress
from types import TracebackType

from tehl.solver.warmup import warm_up


def tell(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Tell nothing: the program says so if a worker that it waits for does not begin."""
    del kind, error, trace


sys.excepthook = tell
atexit.register(os._exit, 0)  # nothing of it is to be kept, and whoever reads its output waits

with suppress(Exception):  # whoever solves meets it again, and tells it with the case
    warm_up(coupled=False)
