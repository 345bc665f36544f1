"""Imported by the server of workers and by nobody else.

What each worker needs is loaded here, before they are forked.
"""

import signal
from contextlib import suppress

signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the program that began the server

from tehl.solver.warmup import warm_up  # noqa: E402 (it takes a second)

with suppress(Exception):  # whoever solves meets it again, and tells it with the case
    warm_up(coupled=False)
