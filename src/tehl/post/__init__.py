"""What is computed from a result, with one subject per module, which is loaded on first use."""

from importlib import import_module
from types import ModuleType

__all__ = [
    "film",
    "heat",
    "micro_film",
    "roughness",
    "thermal_effect",
    "traction",
    "transient",
    "waves",
]


def __getattr__(name: str) -> ModuleType:
    """Load a module."""
    if name not in __all__:
        raise AttributeError(f"module 'tehl.post' has no attribute {name!r}")
    return import_module(f"tehl.post.{name}")


def __dir__() -> list[str]:
    """List the modules, loaded or not."""
    return sorted(__all__)
