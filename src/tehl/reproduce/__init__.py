"""The founding paper of this package, reproduced and judged.

::

    from tehl.reproduce import reproduce
    page = reproduce("out", jobs=2)
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tehl.reproduce.everything import reproduce

__all__ = ["reproduce"]


def __getattr__(name: str) -> Any:
    """Load the machinery only when it is asked for."""
    if name != "reproduce":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return import_module(f"{__name__}.everything").reproduce
