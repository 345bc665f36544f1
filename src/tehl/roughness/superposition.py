"""Sums of surfaces, and what a case file may state under ``roughness``."""

import math
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from tehl.base.typing import Array, np
from tehl.roughness.features import Bump, Dimple, Pocket, Ridge
from tehl.roughness.formula import Formula
from tehl.roughness.map import Map
from tehl.roughness.model import Roughness, RoughnessModel, Smooth
from tehl.roughness.random import Random
from tehl.roughness.waves import (
    Crossed,
    HarmonicModel,
    Wave,
    WaveVector,
    are_even,
    root_mean_square,
)


class _Added(Roughness):
    """Several surfaces on top of each other."""

    parts: tuple[Roughness, ...]

    @property
    def summands(self) -> tuple[Any, ...]:
        """Return the parts."""
        return self.parts

    @property
    def is_smooth(self) -> bool:
        """Return whether all parts are smooth."""
        return all(part.is_smooth for part in self.parts)

    @property
    def is_even_in_y(self) -> bool:
        """Return whether the parts mirror at y = 0; waves may do so together."""
        return are_even(self._harmonics) and all(part.is_even_in_y for part in self._others)

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return the shortest wavelengths of all parts along x and along y [m]."""
        pairs = (part.shortest_wavelengths for part in self.parts)
        along, across = zip((math.inf, math.inf), *pairs, strict=True)
        return min(along), min(across)

    @property
    def shortest_wavelength(self) -> float:
        """Return the shortest wavelength of all parts [m]."""
        return min((part.shortest_wavelength for part in self.parts), default=math.inf)

    @property
    def rms(self) -> float:
        """Return the root mean square height Sq [m]; that of equal harmonics with their phases."""
        return math.hypot(root_mean_square(self._harmonics), *(part.rms for part in self._others))

    def _at_rest(self, x: Array, y: Array) -> Array:
        total = np.zeros(np.broadcast_shapes(x.shape, y.shape))
        for part in self.parts:
            total += part.height(x, y)
        return total

    def resolved_on(self, dx: float, dy: float) -> Roughness:
        """Return the sum of the parts as a mesh carries them."""
        return Superposition(tuple(part.resolved_on(dx, dy) for part in self.parts))

    @property
    def _harmonics(self) -> list[WaveVector]:
        waves = (part for part in self.parts if isinstance(part, HarmonicModel))
        return [component for wave in waves for component in wave.components]

    @property
    def _others(self) -> list[Roughness]:
        return [part for part in self.parts if not isinstance(part, HarmonicModel)]


@dataclass(frozen=True)
class Superposition(_Added):
    """The sum of surfaces of any kind, also as a mesh carries them."""

    parts: tuple[Roughness, ...]


_Single = Smooth | Wave | Crossed | Ridge | Bump | Dimple | Pocket | Formula | Random | Map
OneRoughness = Annotated[_Single, Field(discriminator="type")]
"""A surface that is not a sum."""


class Sum(_Added, RoughnessModel):
    """The sum of several surfaces; in a case file, a list of tables."""

    type: Literal["sum"] = "sum"
    parts: tuple[OneRoughness, ...]
    """What is added."""

    def fits(self, width: float, length: float) -> tuple[str, ...]:
        """Return what is unusual about the parts for a contact."""
        return tuple(line for part in self.parts for line in part.fits(width, length))


def _as_table(value: Any) -> Any:
    """Return a list as the table of a sum, anything else unchanged."""
    return {"type": "sum", "parts": value} if isinstance(value, list | tuple) else value


_Table = Annotated[_Single | Sum, Field(discriminator="type")]
AnyRoughness = Annotated[
    _Table, BeforeValidator(_as_table, json_schema_input_type=_Table | list[_Table])
]
"""Type of the field ``roughness``: a table, or a list of tables that are added."""
