"""Radii and speeds of the two surfaces, and the reduced radii of the contact."""

import math
from dataclasses import dataclass

from tehl.base.errors import InputError


@dataclass(frozen=True, kw_only=True, slots=True)
class Radii:
    """Radii of curvature of a surface, or of a reduced contact."""

    x: float
    y: float
    """Along and across entrainment [m]; infinite for a flat, negative for a hollow surface."""


def reduced_radius(first: float, second: float) -> float:
    """Return R with ``1/R = 1/R_1 + 1/R_2`` [m].

    Parameters
    ----------
    first, second : float
        Radii of both surfaces in one plane [m]; infinite is flat, negative is hollow.

    Raises
    ------
    ValueError
        If the surfaces do not curve apart, so that they have no contact.
    """
    curvature = 1.0 / first + 1.0 / second
    if curvature == 0.0 and math.isinf(first):
        raise ValueError("flat on flat is not a contact: one radius must be finite")
    if not curvature > 0.0:
        raise ValueError(
            f"radii {first:g} m and {second:g} m do not curve apart: 1/R1 + 1/R2 must be positive"
        )
    return 1.0 / curvature


def reduced_radii(first: Radii, second: Radii) -> Radii:
    """Return the reduced radii of two surfaces.

    Parameters
    ----------
    first, second : Radii
        Radii along x and y of each surface [m], with the signs of :func:`reduced_radius`.

    Raises
    ------
    ValueError
        If the surfaces do not curve apart along x or along y.
    """
    return Radii(x=reduced_radius(first.x, second.x), y=reduced_radius(first.y, second.y))


@dataclass(frozen=True, kw_only=True, slots=True)
class Motion:
    """Speeds of the two surfaces along x."""

    entrainment_speed: float
    """u_m = (u_1 + u_2) / 2 [m/s]."""
    slide_roll_ratio: float = 0.0
    """(u_1 - u_2) / u_m [-]."""

    @property
    def speed_1(self) -> float:
        """Return the speed of surface 1, at z = 0 [m/s]."""
        return self.entrainment_speed * (1.0 + 0.5 * self.slide_roll_ratio)

    @property
    def speed_2(self) -> float:
        """Return the speed of surface 2, at z = h [m/s]."""
        return self.entrainment_speed * (1.0 - 0.5 * self.slide_roll_ratio)

    @property
    def sliding_speed(self) -> float:
        """Return u_1 - u_2 [m/s]."""
        return self.entrainment_speed * self.slide_roll_ratio

    def speed_of(self, surface: int) -> float:
        """Return the speed of surface 1 or 2 [m/s]; raise InputError for any other number."""
        if surface not in (1, 2):
            raise InputError(f"surface = {surface}: must be 1 or 2")
        return self.speed_1 if surface == 1 else self.speed_2
