"""What a grid carries of the heights of both surfaces, and what it loses."""

import math
from dataclasses import dataclass

MOST_LOST = 0.1
"""Part of the variance of the heights that a grid may lose without a warning."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Resolution:
    """Which part of the heights in the contact a grid carries."""

    sq: tuple[float, float]
    """Root mean square height of each full surface where |X|, |Y| < 1, at the time when it passes
    the contact [m]."""
    sa: tuple[float, float]
    """Mean absolute height of the same [m]."""
    kept: tuple[float, float]
    """``sq`` without the waves that are too short for the grid [m]."""

    @property
    def lost_share(self) -> float:
        """Return the part of the variance of both surfaces that the grid does not carry [-]."""
        whole, kept = math.hypot(*self.sq), math.hypot(*self.kept)
        return 1.0 - (kept / whole) ** 2 if whole > 0 else 0.0

    @property
    def warning(self) -> str | None:
        """Return a sentence if more than `MOST_LOST` of the variance is lost."""
        if not self.lost_share > MOST_LOST:
            return None
        whole, kept = (1e9 * math.hypot(*one) for one in (self.sq, self.kept))
        return (
            f"the grid carries {kept:.3g} of {whole:.3g} nm Sq, and loses "
            f"{100.0 * self.lost_share:.0f} % of the variance in waves too short for it: take more "
            "nodes, or leave out short waves by lambda_s"
        )
