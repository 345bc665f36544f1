"""How the surfaces move."""

from dataclasses import dataclass

from tehl.errors import InputError


@dataclass(frozen=True, kw_only=True, slots=True)
class Motion:
    """Speeds of the two surfaces along x.

    Attributes
    ----------
    entrainment_speed : float
        u_m = (u_1 + u_2) / 2 [m/s].
    slide_roll_ratio : float
        (u_1 - u_2) / u_m [-].
    """

    entrainment_speed: float
    slide_roll_ratio: float = 0.0

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
