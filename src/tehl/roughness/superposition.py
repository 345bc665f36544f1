"""Several surfaces on top of each other."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tehl.roughness.protocol import Roughness
from tehl.roughness.waves import HarmonicModel, WaveVector, are_even, root_mean_square

if TYPE_CHECKING:
    from tehl.typing import Array


@dataclass(frozen=True, slots=True)
class Superposition:
    """The sum of surfaces of any kind.

    Attributes
    ----------
    parts : tuple of Roughness
        What is added.
    """

    parts: tuple[Roughness, ...]

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
        pairs = [part.shortest_wavelengths for part in self.parts]
        along, across = zip(*pairs, strict=True) if pairs else ((), ())
        return min(along, default=math.inf), min(across, default=math.inf)

    @property
    def shortest_wavelength(self) -> float:
        """Return the shortest wavelength of all parts [m]."""
        return min((part.shortest_wavelength for part in self.parts), default=math.inf)

    @property
    def rms(self) -> float:
        """Return the root mean square height Sq [m]; that of equal harmonics with their phases."""
        return math.hypot(root_mean_square(self._harmonics), *(part.rms for part in self._others))

    def height(self, x: "Array", y: "Array", time: float = 0.0, speed: float = 0.0) -> "Array":
        """Return the sum of the heights [m], as :meth:`tehl.roughness.Wave.height`."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        total = np.zeros(np.broadcast_shapes(np.shape(x), np.shape(y)))
        for part in self.parts:
            total += part.height(x, y, time, speed)
        return total

    def resolved_on(self, dx: float, dy: float) -> Roughness:
        """Return the sum of the parts as a mesh of ``dx`` by ``dy`` [m] carries them."""
        return Superposition(tuple(part.resolved_on(dx, dy) for part in self.parts))

    @property
    def _harmonics(self) -> list[WaveVector]:
        waves = [part for part in self.parts if isinstance(part, HarmonicModel)]
        return [component for wave in waves for component in wave.components]

    @property
    def _others(self) -> list[Roughness]:
        return [part for part in self.parts if not isinstance(part, HarmonicModel)]
