"""The absence of roughness."""

import math
from typing import TYPE_CHECKING, Literal

from tehl.roughness.protocol import RoughnessModel

if TYPE_CHECKING:
    from tehl.typing import Array


class Smooth(RoughnessModel):
    """A surface without roughness."""

    type: Literal["smooth"] = "smooth"

    @property
    def is_smooth(self) -> bool:
        """Return True."""
        return True

    @property
    def is_even_in_y(self) -> bool:
        """Return True."""
        return True

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return infinity along both axes [m]."""
        return math.inf, math.inf

    @property
    def shortest_wavelength(self) -> float:
        """Return infinity [m]."""
        return math.inf

    @property
    def rms(self) -> float:
        """Return zero [m]."""
        return 0.0

    def _at_rest(self, x: "Array", y: "Array") -> "Array":
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        return np.zeros(np.broadcast_shapes(x.shape, y.shape))
