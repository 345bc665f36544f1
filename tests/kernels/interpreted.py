"""Kernels and their helpers as plain Python, as with ``NUMBA_DISABLE_JIT=1``.

Numba gives helpers no wrapper for Python, and takes seconds to compile one for a test.
"""

import importlib
import sys
from functools import cache
from types import ModuleType
from unittest.mock import patch

from numba import config

import tehl
from tehl.kernels import lanes, raw

SHARED = {lanes.__name__, raw.__name__}
"""Modules that know the types of the compiler, which are registered once."""


@cache
def interpreted(name: str) -> ModuleType:
    """Return a second copy of a module of `tehl.kernels`, of which nothing is compiled."""
    package = "tehl.kernels"
    others = {one: module for one, module in sys.modules.items() if one not in SHARED}
    compiled = {one: module for one, module in others.items() if one.startswith(package)}
    try:
        for one in compiled:
            del sys.modules[one]
        with patch.object(config, "DISABLE_JIT", 1):
            return importlib.import_module(f"{package}.{name}")
    finally:
        for one in [*sys.modules]:
            if one.startswith(package) and one not in SHARED:
                del sys.modules[one]
        sys.modules.update(compiled)
        tehl.kernels = compiled[package]
