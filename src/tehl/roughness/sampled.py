"""A surface as one mesh carries it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from tehl.roughness.protocol import Roughness
from tehl.roughness.tile import Tile

if TYPE_CHECKING:
    from tehl.typing import Array


@dataclass(frozen=True, slots=True, eq=False)
class Sampled:
    """Heights of a tile, moved with their surface.

    Attributes
    ----------
    tile : Tile
        The heights.
    """

    tile: Tile

    @property
    def is_smooth(self) -> bool:
        """Return whether the height is zero everywhere."""
        return not self.tile.mean_square > 0

    @property
    def is_even_in_y(self) -> bool:
        """Return whether the surface is smooth: heights on a lattice are not mirrored exactly."""
        return self.is_smooth

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return the wavelengths 2 pi Sq / Sq' along x and along y [m]."""
        return self.tile.wavelengths[:2]

    @property
    def shortest_wavelength(self) -> float:
        """Return the wavelength 2 pi Sq / Sq' where it is shortest [m]."""
        return self.tile.wavelengths[2]

    @property
    def rms(self) -> float:
        """Return the root mean square height Sq [m]."""
        return self.tile.mean_square**0.5

    def height(self, x: "Array", y: "Array", time: float = 0.0, speed: float = 0.0) -> "Array":
        """Return the heights [m], as :meth:`tehl.roughness.Wave.height`."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        along = np.asarray(x, dtype=np.float64) - speed * time
        return self.tile.at(along, np.asarray(y, dtype=np.float64))

    def resolved_on(self, dx: float, dy: float) -> Roughness:
        """Return the surface without the waves that a mesh of ``dx`` by ``dy`` [m] cannot carry."""
        return Sampled(self.tile.filtered(dx, dy))
