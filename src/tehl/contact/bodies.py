"""Radii and speeds of the two surfaces, and the reduced radii of the contact."""

import math
from dataclasses import dataclass

from tehl.base.errors import InputError
from tehl.base.typing import Array


@dataclass(frozen=True, kw_only=True, slots=True)
class Radii:
    """Radii of curvature of a surface, or of a reduced contact."""

    x: float
    y: float
    """Along and across entrainment [m]; infinite for a flat, negative for a hollow surface."""
    twist: float = 0.0
    """Mixed curvature t of the gap x^2/(2 R_x) + t x y + y^2/(2 R_y) of a contact [1/m]."""

    def turned(self, angle: float) -> "Radii":
        """Return the curvature of the gap along and across an entrainment at an angle to x.

        Parameters
        ----------
        angle : float
            From the x axis of this gap, which has no twist, counter-clockwise [rad].
        """
        cosine, sine = direction(angle)
        if sine == 0.0 or self.x == self.y:
            return self
        if cosine == 0.0:
            return Radii(x=self.y, y=self.x)
        first, second = 1.0 / self.x, 1.0 / self.y
        return Radii(
            x=1.0 / (first * cosine**2 + second * sine**2),
            y=1.0 / (first * sine**2 + second * cosine**2),
            twist=(second - first) * sine * cosine,
        )

    def principal(self) -> tuple["Radii", float]:
        """Return the gap along its axes, the smaller radius first, and the angle of that [rad].

        The angle is that from x, counter-clockwise.
        """
        first, second = 1.0 / self.x, 1.0 / self.y
        most = 0.5 * (first + second) + math.hypot(0.5 * (first - second), self.twist)
        least = (first * second - self.twist**2) / most
        angle = 0.5 * math.atan2(2.0 * self.twist, first - second)
        return Radii(x=1.0 / most, y=1.0 / least), angle


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


def direction(angle: float) -> tuple[float, float]:
    """Return cosine and sine of an angle [rad]; those of quarter turns, to rounding, are exact."""
    quarters = angle / (0.5 * math.pi)
    nearest = round(quarters)
    # "90 deg" is read to 15 digits
    if abs(quarters - nearest) < 1e-12:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[nearest % 4]
    return math.cos(angle), math.sin(angle)


@dataclass(frozen=True, kw_only=True, slots=True)
class Motion:
    """Velocities of the two surfaces, in their plane: x along the entrainment at the centre."""

    entrainment_speed: float
    """u_m, the size of (u_1 + u_2) / 2 at the centre [m/s]."""
    slide_roll_ratio: float = 0.0
    """Size of u_1 - u_2 at the centre over u_m, with the sign of its direction [-]."""
    sliding_angle: float = 0.0
    """Direction of u_1 - u_2 at the centre from x towards y [rad]."""
    spin_1: float = 0.0
    spin_2: float = 0.0
    """Angular velocities of the surfaces about z, from x to y [rad/s]."""

    @property
    def sliding_ratio(self) -> tuple[float, float]:
        """Return both components of (u_1 - u_2) / u_m at the centre."""
        cosine, sine = direction(self.sliding_angle)
        return self.slide_roll_ratio * cosine, self.slide_roll_ratio * sine

    @property
    def is_plain(self) -> bool:
        """Whether both surfaces move along x alone."""
        return self.spin_1 == 0.0 == self.spin_2 and self.sliding_ratio[1] == 0.0

    @property
    def slides(self) -> bool:
        """Whether the surfaces slide anywhere."""
        return self.slide_roll_ratio != 0.0 or self.spin_1 != self.spin_2

    @property
    def mean_spin(self) -> float:
        """Return the spin of the entrainment, (omega_1 + omega_2) / 2 [rad/s]."""
        return 0.5 * (self.spin_1 + self.spin_2)

    @property
    def speed_1(self) -> float:
        """Return the speed of surface 1, at z = 0, along x at the centre [m/s]."""
        return self.entrainment_speed * (1.0 + 0.5 * self.sliding_ratio[0])

    @property
    def speed_2(self) -> float:
        """Return the speed of surface 2, at z = h, along x at the centre [m/s]."""
        return self.entrainment_speed * (1.0 - 0.5 * self.sliding_ratio[0])

    @property
    def sliding_speed(self) -> float:
        """Return the size of u_1 - u_2 at the centre, of the sign of the slide-roll ratio [m/s]."""
        return self.entrainment_speed * self.slide_roll_ratio

    def speed_of(self, surface: int) -> float:
        """Return the speed along x of surface 1 or 2 at the centre [m/s].

        Raises InputError for any other number.
        """
        if surface not in (1, 2):
            raise InputError(f"surface = {surface}: must be 1 or 2")
        return self.speed_1 if surface == 1 else self.speed_2

    def velocity_of(self, surface: int) -> tuple[float, float]:
        """Return the velocity of surface 1 or 2 at the centre, along x and y [m/s].

        Raises InputError for any other number, as `speed_of`.
        """
        sign = 1.0 if surface == 1 else -1.0
        return self.speed_of(surface), 0.5 * sign * self.entrainment_speed * self.sliding_ratio[1]

    def field_of(self, surface: int, x: Array, y: Array) -> tuple[Array, Array]:
        """Return the velocity field of surface 1 or 2, ``u - omega y`` and ``v + omega x`` [m/s].

        Parameters
        ----------
        surface : int
            1 or 2.
        x, y : Array
            Places that broadcast, (nx,) and (ny, 1) [m].
        """
        (u, v), spin = self.velocity_of(surface), self.spin_1 if surface == 1 else self.spin_2
        zero = 0.0 * (x + y)
        return u - spin * y + zero, v + spin * x + zero

    def sliding_field(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Return the field of u_1 - u_2, along x and y [m/s].

        Parameters
        ----------
        x, y : Array
            Places that broadcast, (nx,) and (ny, 1) [m].
        """
        first, second = self.field_of(1, x, y), self.field_of(2, x, y)
        return first[0] - second[0], first[1] - second[1]
