"""Loaded by the server that workers are forked from, and by nothing else.

It loads the solver and its kernels once for all workers.
"""

import atexit
import os
import sys
from contextlib import suppress

import tehl.api.solvers  # noqa: F401 (loaded for all workers)
from tehl.kernels.warmup import warm_up

sys.excepthook = lambda *_: None  # the program reports a worker that does not start
atexit.register(os._exit, 0)  # ends at once: readers of its output wait for its end

with suppress(Exception):  # a solve meets the error again and reports it with its case
    warm_up(coupled=False)
