"""A quantity: a scalar of a result, its place in the summary, error bar, unit and words."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

Certified = Literal["", "film", "following", "shown"]
"""Whether a quantity has a bar in a certified result: as the film and the largest pressure, which
decide whether the grid is too coarse; as what follows from them less regularly; or only shown where
a result has it."""
UNITS = {
    "": (1.0, 0.0),
    "nm": (1e9, 0.0),
    "um": (1e6, 0.0),
    "MPa": (1e-6, 0.0),
    "GPa": (1e-9, 0.0),
    "K": (1.0, 0.0),
    "°C": (1.0, -273.15),
    "N": (1.0, 0.0),
    "W": (1.0, 0.0),
    "N/um": (1e-6, 0.0),
    "N/mm": (1e-3, 0.0),
    "N s/m": (1.0, 0.0),
    "N mm": (1e3, 0.0),
    "mrad": (1e3, 0.0),
    "%": (100.0, 0.0),
}
"""Units in which people read quantities: factor from SI, and what is added."""
SI = {
    "n_per_m": "N/m",
    "n_s_per_m": "N s/m",
    "n_s2_per_m": "N s^2/m",
    "n_m": "N m",
    "m_s": "m/s",
    **{"m2": "m^2", "m": "m", "pa": "Pa", "k": "K", "w": "W", "rad": "rad", "hz": "Hz", "s": "s"},
}
"""SI units by the endings of keys, of which the first counts."""


class Numbers(Protocol):
    """Numbers of a result by path: those of a stored row, or `registry.NumbersOf`."""

    def get(self, path: str, /) -> Any:
        """Return a number, None where the result does not have it."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """A scalar of a result, or a short list of them."""

    path: str
    """Place in the summary, block and key: ``"film.h_central_m"``. The key ends in its SI unit. A
    quantity without a block follows from others and is not in the summary; ``.0`` marks a list."""
    value: Callable[[Any], Any] | None = None
    """Value in SI from the owner of the block (`tehl.result.registry.OWNERS`), or from `Numbers`
    where there is no block; by default the attribute of the owner that is called as the key without
    its unit."""
    name: str = ""
    """Of the value that the solver measures on each grid, of its error bar, and of its estimate in
    a certified result; empty where there are none."""
    certified: Certified = ""
    error: Callable[[Numbers], float | None] | None = None
    """Relative error bar from the numbers; by default that of ``name``."""
    symbol: str = ""
    unit: str = ""
    """One of `UNITS`, in which people read it."""
    digits: str = "0.000"
    """Format in spreadsheets."""
    words: Mapping[str, str] = field(default_factory=dict)
    """What it is called where it is shown: ``axis`` of a picture, ``list`` of contacts, table of a
    study in a ``notebook``, ``line`` in Python, ``text`` of a terminal, ``report``, its table of
    ``rises``, live ``page``. Further ``key``, its key there if it is not that of the summary, and
    ``bar``, what follows a certified value in a text."""

    @property
    def block(self) -> str:
        """Block of the summary; empty for one that follows from others."""
        return self.path.removesuffix(".0").rpartition(".")[0]

    @property
    def key(self) -> str:
        """Key in its block."""
        return self.path.removesuffix(".0").rpartition(".")[2]

    @property
    def error_path(self) -> str:
        """Place of its relative error bar in the summary; empty without one."""
        return f"errors.{FILMS.get(self.name, self.name)}" if self.name else ""

    def shown(self, value: float) -> float:
        """Return a value in SI in ``unit``."""
        factor, offset = UNITS[self.unit]
        return value * factor + offset

    def of(self, owner: Any) -> Any:
        """Return its value from the owner of its block, in SI; None without one."""
        if owner is None:
            return None
        return getattr(owner, without_unit(self.key)) if self.value is None else self.value(owner)

    def error_in(self, numbers: Numbers) -> float | None:
        """Return its relative error bar from the numbers of a result; None if it is not known."""
        if self.error is not None:
            return self.error(numbers)
        return numbers.get(self.error_path) if self.name else None


def without_unit(key: str) -> str:
    """Return a key without the SI unit that it ends in."""
    return key.removesuffix(f"_{ending_of(key)}")


def ending_of(key: str) -> str:
    """Return the ending of a key that is its SI unit; empty without one."""
    return next((ending for ending in SI if key.endswith(f"_{ending}")), "")


FILMS = {"film_central": "central", "film_minimum": "minimum"}
"""Names of the error bars of the film in the summary."""
