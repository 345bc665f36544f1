"""Helpers of the kernels have no wrapper for Python; tests call them through a kernel."""

from collections.abc import Callable
from typing import Any

from numba import njit

from tehl.kernels.raw import raw


def from_python(helper: Callable[..., Any]) -> Callable[..., Any]:
    """Return a compiled function that calls a helper with raw arrays."""

    @njit(error_model="numpy")
    def call(*arguments):
        return helper(*raw(arguments))

    return call
