"""Fixtures for all tests."""

import signal

from tests.fixtures_result import certified, result, stalled
from tests.fixtures_rough import rough, smooth
from tests.fixtures_thermal import sheared, thermal

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # in the background of a shell: the programs that tests start would inherit it, and never end
    signal.signal(signal.SIGINT, signal.default_int_handler)

__all__ = ["certified", "result", "rough", "sheared", "smooth", "stalled", "thermal"]
