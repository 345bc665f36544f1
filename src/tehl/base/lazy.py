"""Modules that are loaded when they are first used, so that commands start at once."""

from importlib import import_module
from types import ModuleType
from typing import Any


class _Lazy(ModuleType):
    """Stands for the module of its name."""

    def __getattr__(self, name: str) -> Any:
        return getattr(import_module(self.__name__), name)


def lazy(name: str) -> Any:
    """Return what stands for a module: its first use loads it.

    For types, the module is imported under ``if TYPE_CHECKING``.
    """
    return _Lazy(name)
