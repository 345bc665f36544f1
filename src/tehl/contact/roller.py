r"""The shape of a roller of finite length on a raceway.

In the units of the line contact under its mean load, b along x and half the length along y,

.. math:: H = H_{00} + \frac{X^2}{2} + g(Y) + K P, \qquad \int\!\!\int P\, dX dY = \pi, \quad
          |Y| \le 1,

with g from profile and tilt. Where the moment of the load about x is stated, g has the tilt of the
dry contact with that moment, and that of the film follows. Beyond its ends there is no roller and
no pressure; both bodies are half-spaces there too. A piece of a longer one goes on, mirrored at its
ends or repeating itself.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

from tehl.base.typing import Array, np
from tehl.contact.bodies import Radii
from tehl.contact.hertz import HertzContact
from tehl.contact.options import ROLLER_ENDS
from tehl.contact.profile import Profile, Tabulated
from tehl.contact.shape import LINE, Line

Ends = Literal["open", "mirrored", "periodic"]
"""What lies beyond both ends of a roller: nothing, its image at each, or itself again."""

LARGEST_TILT = 0.05
"""Largest tilt of a roller [rad]: real ones have 0.0001 to 0.005."""
SLICES = 201
"""Slices of a dry roller."""
ENDS = (-1.0, 1.0)
"""Both ends of a roller, in half its length."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Roller(Line):
    """A roller, whose slices are lines of different loads."""

    length: float
    """Of the contact [m]."""
    profile: Profile | None = None
    """How it drops towards its ends; None is straight."""
    goes_on: bool = False
    """Whether it is a piece of a longer one."""
    wraps: bool = False
    """Whether that is this piece again and again, else mirrored at its ends."""
    tilt: float = 0.0
    """Angle by which the gap opens along y [rad]."""
    moment: float | None = None
    """Moment of the load about x [N m], positive if positive y carries more: `under` then sets the
    tilt of dry slices. None states the tilt."""
    force: float = math.nan
    half_width: float = math.nan
    amplitude: float = math.nan
    film_unit: float = math.nan
    """Load [N], and of it b, 2 w/(pi E') and b^2/R [m]: set by `under`."""

    load = math.pi
    area = 4.0
    sides = ROLLER_ENDS

    def under(self, load: float, radii: Radii, modulus: float) -> "Roller":
        """Return the roller under a load.

        Parameters
        ----------
        load, radii, modulus : float, Radii, float
            Load [N], reduced radii [m], and E' [Pa].
        """
        width = self.hertz(load, radii, modulus).half_width_x
        found = replace(
            self,
            force=load,
            half_width=width,
            amplitude=2.0 * load / (self.length * math.pi * modulus),
            film_unit=width**2 / radii.x,
        )
        return found if self.moment is None else replace(found, tilt=_dry_tilt(found))

    @property
    def scaled_moment(self) -> float:
        """Return the integral of Y P for the stated moment [-]."""
        return self.load * (self.moment or 0.0) / (0.5 * self.length * self.force)

    @property
    def tilt_unit(self) -> float:
        """Return the tilt by which the gap opens by one at Y = 1 [rad]."""
        return 2.0 * self.film_unit / self.length

    @property
    def is_even(self) -> bool:
        """Whether it is symmetric about y = 0."""
        even = not isinstance(self.profile, Tabulated) or self.profile.is_even
        return even and self.tilt == 0.0 and not self.moment

    def drop(self, y: Array) -> Array:
        """Return how far the profile drops at Y [m]."""
        no_profile = np.zeros_like(y)
        return no_profile if self.profile is None else self.profile.drop(y, self)

    @property
    def drops(self) -> list[float]:
        """How far it drops at both ends [m]."""
        return [float(drop) for drop in self.drop(np.array(ENDS))]

    def rise(self, y: Array) -> Array:
        """Return g at Y [-]."""
        drop: Array = 0.5 * self.length * self.tilt * y
        return (drop + self.drop(np.clip(y, -1.0, 1.0))) / self.film_unit

    def gap(self, x: Array, y: Array) -> Array:
        """Return X^2/2 + g(Y)."""
        return 0.5 * x**2 + self.rise(y)

    def radius_squared(self, x: Array, y: Array) -> Array:
        """Return X^2 over the load of the slice, one on the rim; infinite where none carries."""
        share = np.ones_like(y) if self.goes_on else self.share(y)
        loaded = share > 0.0
        found: Array = np.where(loaded, x**2 / np.where(loaded, share, 1.0), np.inf)
        return found

    @property
    def widest(self) -> float:
        """Half-width of the slice that carries most, over that of the mean load [-]."""
        return math.sqrt(float(self._shares.max()))

    @property
    def loaded_part(self) -> float:
        """Part of the length whose slices carry load [-]."""
        return float((self._shares > 0.0).mean())

    @property
    def _shares(self) -> Array:
        return self.share(np.linspace(-1.0, 1.0, SLICES))

    def share(self, y: Array) -> Array:
        """Return the load of slices at Y over the mean one, if each deflects by itself [-].

        By C times its load, in units of b^2/R with C = (1 + 2 ln 4 kappa c)/4 and c the part of the
        length that touches.
        """
        rises = self.rise(np.linspace(-1.0, 1.0, SLICES))

        def compliance(high: float) -> float:
            touching = 2.0 * self.length / self.half_width * float((rises < high).mean())
            return 0.25 * (1.0 + 2.0 * math.log(max(touching, 1.0)))

        low, high = float(rises.min()), float(rises.max()) + compliance(math.inf)
        for _ in range(60):
            middle = 0.5 * (low + high)
            mean = float(np.maximum(middle - rises, 0.0).mean()) / compliance(middle)
            low, high = (middle, high) if mean < 1.0 else (low, middle)
        return np.maximum(high - self.rise(y), 0.0) / compliance(high)

    def dry_pressure(self, x: Array, y: Array) -> Array:
        """Return that of slices of `share`, sqrt(f - X^2)."""
        return np.sqrt(np.maximum(0.0, self.share(y) - x**2))

    def dry_gap(self, x: Array, y: Array) -> Array:
        """Return the gap of such slices."""
        share = np.maximum(self.share(y), 1e-6)
        return share * LINE.dry_gap(x / np.sqrt(share), 0.0 * y)

    def grown(self, load: float, curvature: float) -> tuple[float, float]:
        """Return the same width: which part of its profile is loaded follows from no power."""
        del curvature
        return 1.0, load

    def hertz(self, load: float, radii: Radii, modulus: float) -> HertzContact:
        """Return the line contact under the mean load."""
        line = LINE.hertz(load / self.length, radii, modulus)
        half = 0.5 * self.length
        return replace(line, half_width_y=half, ellipticity=half / line.half_width_x)

    def load_of_pressure(self, pressure: float, radii: Radii, modulus: float) -> float:
        """Return the load [N] of the largest dry pressure under the mean load [Pa]."""
        return self.length * LINE.load_of_pressure(pressure, radii, modulus)

    def load_unit(self, radius: float, modulus: float) -> float:
        """Return E' R_x times the length [N]."""
        return modulus * radius * self.length


@lru_cache(maxsize=16)
def _dry_tilt(roller: Roller) -> float:
    """Return the tilt with which the slices of a roller under its load carry its moment [rad].

    It is `LARGEST_TILT` at most.
    """
    y = np.linspace(-1.0, 1.0, SLICES)
    wanted = roller.scaled_moment / roller.load

    def excess(tilt: float) -> float:
        share = replace(roller, tilt=tilt).share(y)
        return float((share * y).mean() / share.mean()) - wanted

    if abs(excess(0.0)) < 1e-12:  # rounding
        return 0.0
    low, high = -LARGEST_TILT, LARGEST_TILT
    for _ in range(28):  # to 4e-10 rad
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) > 0.0 else (low, middle)
    return 0.5 * (low + high)
