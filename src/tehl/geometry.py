"""Shape of the contact: two curved surfaces become one of reduced radius against a flat."""

import math
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class Radii:
    """Radii of curvature of a surface, or of a reduced contact.

    Attributes
    ----------
    x, y : float
        Along and across entrainment [m]; infinite for a flat, negative for a hollow surface.
    """

    x: float
    y: float


def reduced_radius(first: float, second: float) -> float:
    """Return R with ``1/R = 1/R_1 + 1/R_2`` [m].

    Parameters
    ----------
    first, second : float
        Radii in one direction [m]; infinite is flat, negative is hollow.

    Raises
    ------
    ValueError
        If the surfaces do not curve apart: then there is no point contact.
    """
    curvature = 1.0 / first + 1.0 / second
    if curvature == 0.0 and math.isinf(first):
        raise ValueError("flat on flat is no point contact: one radius must be finite")
    if not curvature > 0.0:
        raise ValueError(
            f"radii {first:g} m and {second:g} m do not curve apart: 1/R1 + 1/R2 must be positive"
        )
    return 1.0 / curvature


def reduced_radii(first: Radii, second: Radii) -> Radii:
    """Return the reduced radii of two surfaces; see :func:`reduced_radius` for what raises."""
    return Radii(x=reduced_radius(first.x, second.x), y=reduced_radius(first.y, second.y))
