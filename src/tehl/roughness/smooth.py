"""The absence of roughness."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tehl.typing import Array


@dataclass(frozen=True, kw_only=True, slots=True)
class Smooth:
    """A surface without roughness."""

    def height(self, x: "Array", y: "Array", time: float = 0.0) -> "Array":
        """Return zeros of the broadcast shape of ``x`` and ``y`` [m]."""
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        del time
        return np.zeros(np.broadcast_shapes(np.shape(x), np.shape(y)))
