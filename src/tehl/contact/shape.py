r"""Shapes of contacts: undeformed gap, dry contact, load, and the groups that follow.

A shape is all that the equations know about it, in the units of its dry contact: X and Y in its
half-widths, P in its largest pressure, H in a_x^2/R_x. The influence of a cell and the far field
are in `tehl.operators.influence` and `tehl.operators.far_field`.
"""

import math
from dataclasses import dataclass
from typing import Protocol

from tehl.base.typing import Array, np
from tehl.contact.bodies import Radii
from tehl.contact.hertz import HertzContact, axes_of, ellipticity, hertz_contact, load_of_pressure
from tehl.contact.options import LINE_WIDTH


class Shape(Protocol):
    """What the equations ask a shape for."""

    @property
    def load(self) -> float:
        """Integral of the dry pressure over X and Y [-]."""

    @property
    def area(self) -> float:
        """Area of the dry contact over X and Y [-]."""

    @property
    def across(self) -> float:
        """Curvature of the gap along Y, over that along X [-]."""

    @property
    def as_line(self) -> bool:
        """Whether its middle is a line contact under the mean load: film formulas, inlet."""

    @property
    def goes_on(self) -> bool:
        """Whether it goes on beyond its sides."""

    @property
    def wraps(self) -> bool:
        """Whether it does so with what is within the other side, else mirrored at each."""

    @property
    def sides(self) -> tuple[float, float]:
        """Side edges of the domain of a line or of a roller, in half-widths."""

    @property
    def widest(self) -> float:
        """Half-width of the slice of a roller that carries most, over that of the mean load [-]."""

    def gap(self, x: Array, y: Array) -> Array:
        """Return the undeformed gap H [-] at X, Y that broadcast."""

    def radius_squared(self, x: Array, y: Array) -> Array:
        """Return a quadratic form of X, Y that broadcast, one on the rim of the contact [-]."""

    def dry_pressure(self, x: Array, y: Array) -> Array:
        """Return the dry pressure P [-] at X, Y that broadcast."""

    def dry_gap(self, x: Array, y: Array) -> Array:
        """Return the gap H of the dry contact [-] at X, Y that broadcast; zero in the contact."""

    def grown(self, load: float, curvature: float) -> tuple[float, float]:
        """Return half-width and largest pressure of the dry contact at another moment [-].

        Parameters
        ----------
        load, curvature : float
            Load and 1/R_x there; all four are over those of this contact.
        """

    def hertz(self, load: float, radii: Radii, modulus: float) -> HertzContact:
        """Return the dry contact under a load [N], for reduced radii [m] and E' [Pa]."""

    def load_of_pressure(self, pressure: float, radii: Radii, modulus: float) -> float:
        """Return the load [N] of a largest dry pressure [Pa]."""

    def load_unit(self, radius: float, modulus: float) -> float:
        """Return the load [N] of W = 1, for R_x [m] and E' [Pa]."""

    @property
    def speed_power(self) -> float:
        """Power of 1/(2 U) in the Moes load, M = W (2 U)^-power."""

    def ratio_squared(self, load: float, factor: float) -> float:
        """Return (a_x/R_x)^2 [-] for W and the factor before the sum of the deflection."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Ellipse:
    """Circle or ellipse, with axes along and across the entrainment or at an angle to it.

    Half-widths are the largest x and y of its rim, X^2 - 2 s X Y + Y^2 = 1 - s^2.
    """

    ellipticity: float
    """kappa = a_y/a_x."""
    radius_ratio: float
    """D = R_x/R_y."""
    skew: float = 0.0
    twist: float = 0.0
    """s of the rim, and C of the gap X^2/2 + C X Y + D kappa^2 Y^2/2; zero on the axes."""

    speed_power = 0.75
    as_line = goes_on = wraps = False
    sides = LINE_WIDTH
    widest = 1.0

    @classmethod
    def of(cls, radii: Radii) -> "Ellipse":
        """Return the shape of a contact with these reduced radii [m]."""
        if radii.twist == 0.0:
            return cls(ellipticity=ellipticity(radii.x, radii.y), radius_ratio=radii.x / radii.y)
        dry = _turned_contact(1.0, radii, 1.0)
        return cls(
            ellipticity=dry.ellipticity,
            radius_ratio=radii.x / radii.y,
            skew=dry.skew,
            twist=radii.twist * radii.x * dry.ellipticity,
        )

    @property
    def narrowing(self) -> float:
        """Return sqrt(1 - s^2): the half-width of the row Y = 0, one on the axes."""
        return math.sqrt(1.0 - self.skew**2)

    @property
    def load(self) -> float:
        """Return 2 pi/3, less the part by which a turned ellipse fills its half-widths less."""
        return 2.0 * math.pi / 3.0 * self.narrowing

    @property
    def area(self) -> float:
        """Return pi, less by the same part."""
        return math.pi * self.narrowing

    @property
    def across(self) -> float:
        """Return D kappa^2."""
        return self.radius_ratio * self.ellipticity**2

    def gap(self, x: Array, y: Array) -> Array:
        """Return X^2/2 + C X Y + D kappa^2 Y^2/2."""
        gap = 0.5 * x**2 + 0.5 * self.across * y**2
        return gap + self.twist * x * y if self.twist else gap

    def radius_squared(self, x: Array, y: Array) -> Array:
        """Return (X^2 - 2 s X Y + Y^2)/(1 - s^2): one on the rim of the contact."""
        if self.skew == 0.0:
            return x**2 + y**2
        return (x**2 - 2.0 * self.skew * x * y + y**2) / (1.0 - self.skew**2)

    def dry_pressure(self, x: Array, y: Array) -> Array:
        """Return the square root of one less `radius_squared`, zero outside the contact."""
        if self.skew == 0.0:
            return np.sqrt(np.maximum(0.0, 1.0 - x**2 - y**2))
        return np.sqrt(np.maximum(0.0, 1.0 - self.radius_squared(x, y)))

    def _on_axes(self, x: Array, y: Array) -> tuple["Ellipse", Array, Array, float]:
        """Return the same ellipse on its axes, X and Y there, and its unit of H over this one."""
        kappa, d = self.ellipticity, self.radius_ratio
        radii, angle = Radii(x=1.0, y=1.0 / d, twist=self.twist / kappa).principal()
        short, long, _ = axes_of(1.0, kappa, self.skew)
        y = kappa * y
        cosine, sine = math.cos(angle), math.sin(angle)
        along, across = x * cosine + y * sine, y * cosine - x * sine
        turned = Ellipse(ellipticity=long / short, radius_ratio=radii.x / radii.y)
        return turned, along / short, across / long, short**2 / radii.x

    def dry_gap(self, x: Array, y: Array) -> Array:
        r"""Return the gap of the dry Hertz contact, as H = h R_x / a_x^2 [-]; zero in the contact.

        .. math:: H = \frac{1}{J} \int_0^t \left[\frac{X^2}{1+s^2}
                  + \frac{\kappa^2 Y^2}{\kappa^2+s^2} - 1\right]
                  \frac{ds}{\sqrt{(1+s^2)(\kappa^2+s^2)}}, \quad
                  J = 2\int_0^\infty \frac{ds}{(1+s^2)^{3/2}\sqrt{\kappa^2+s^2}}

        with t the confocal coordinate of the point. Gauss-Legendre on 48 points in arctan s.

        References
        ----------
        Johnson (1985), Contact Mechanics, section 3.5 (potential of an ellipsoidal pressure).
        """
        if self.skew:
            turned, x, y, unit = self._on_axes(x, y)
            return unit * turned.dry_gap(x, y)
        k2 = self.ellipticity**2
        x2, y2 = np.broadcast_arrays(np.square(x), k2 * np.square(y))
        half = 0.5 * (x2 + y2 - 1.0 - k2)
        confocal = half + np.sqrt(np.maximum(half**2 - k2 + k2 * x2 + y2, 0.0))
        end = np.arctan(np.sqrt(np.maximum(confocal, 0.0)))
        nodes, weights = np.polynomial.legendre.leggauss(48)
        gap = np.zeros(end.shape)
        for node, weight in zip(0.5 * (nodes + 1.0), 0.5 * weights, strict=True):
            s2 = np.tan(end * node) ** 2
            bracket = x2 / (1.0 + s2) + y2 / (k2 + s2) - 1.0
            gap += weight * bracket * np.sqrt((1.0 + s2) / (k2 + s2))
        # J with s = tan(angle), smooth and periodic
        angle = (np.arange(512) + 0.5) * (np.pi / 1024)
        cosine, sine = np.cos(angle) ** 2, np.sin(angle) ** 2
        return gap * end / (np.pi * np.mean(cosine / np.sqrt(k2 * cosine + sine)))

    def grown(self, load: float, curvature: float) -> tuple[float, float]:
        """Return half-width and pressure: load ~ p b^2, and deflection p b ~ gap c b^2."""
        width = math.cbrt(load / curvature)
        return width, curvature * width

    def hertz(self, load: float, radii: Radii, modulus: float) -> HertzContact:
        """Return the dry contact."""
        if radii.twist:
            return _turned_contact(load, radii, modulus)
        return hertz_contact(load, radii.x, radii.y, modulus)

    def load_of_pressure(self, pressure: float, radii: Radii, modulus: float) -> float:
        """Return the load [N]."""
        if radii.twist:
            radii, _ = radii.principal()
        return load_of_pressure(pressure, radii.x, radii.y, modulus)

    def load_unit(self, radius: float, modulus: float) -> float:
        """Return E' R_x^2 [N]."""
        return modulus * radius**2

    def ratio_squared(self, load: float, factor: float) -> float:
        """Return (a_x/R_x)^2 [-] for W = w/(E' R_x^2) and 2 Pi/pi."""
        kappa = self.ellipticity * self.narrowing
        return math.cbrt(3.0 * load / (math.pi**2 * kappa * factor)) ** 2


def _turned_contact(load: float, radii: Radii, modulus: float) -> HertzContact:
    """Return the dry contact whose axes are those of a gap with twist."""
    on_axes, angle = radii.principal()
    return hertz_contact(load, on_axes.x, on_axes.y, modulus).turned(angle)


@dataclass(frozen=True, slots=True)
class Line:
    """Line contact without ends: nothing changes along Y, and all loads are those of one metre.

    Its half-width along Y is one metre, its nodes are one row, whose cell has the width one.
    """

    load = 0.5 * math.pi
    area = 2.0
    speed_power = 0.5
    across = 0.0
    as_line, goes_on, wraps = True, False, False
    sides = LINE_WIDTH

    @property
    def widest(self) -> float:
        """All slices are alike."""
        return 1.0

    def gap(self, x: Array, y: Array) -> Array:
        """Return X^2/2."""
        return 0.5 * x**2 + 0.0 * y

    def radius_squared(self, x: Array, y: Array) -> Array:
        """Return X^2 + Y^2 as on an ellipse, with Y in metres."""
        return x**2 + y**2

    def dry_pressure(self, x: Array, y: Array) -> Array:
        """Return sqrt(1 - X^2), zero outside the contact."""
        return np.sqrt(np.maximum(0.0, 1.0 - x**2)) + 0.0 * y

    def dry_gap(self, x: Array, y: Array) -> Array:
        """Return (X sqrt(X^2 - 1) - arcosh X)/2 of |X| > 1.

        References
        ----------
        Johnson (1985), Contact Mechanics, section 4.2.
        """
        x = np.maximum(np.abs(x), 1.0)
        return 0.5 * (x * np.sqrt(x**2 - 1.0) - np.arccosh(x)) + 0.0 * y

    def grown(self, load: float, curvature: float) -> tuple[float, float]:
        """Return half-width and pressure: load ~ p b, and deflection p b ~ gap c b^2."""
        width = math.sqrt(load / curvature)
        return width, curvature * width

    def hertz(self, load: float, radii: Radii, modulus: float) -> HertzContact:
        """Return the dry contact under a load per length [N/m]; its approach is not known."""
        half_width = math.sqrt(8.0 * load * radii.x / (math.pi * modulus))
        return HertzContact(
            half_width_x=half_width,
            half_width_y=1.0,
            pressure=2.0 * load / (math.pi * half_width),
            approach=math.nan,
            ellipticity=math.inf,
        )

    def load_of_pressure(self, pressure: float, radii: Radii, modulus: float) -> float:
        """Return the load of one metre [N]."""
        return 2.0 * math.pi * radii.x * pressure**2 / modulus

    def load_unit(self, radius: float, modulus: float) -> float:
        """Return E' R_x of one metre [N]."""
        return modulus * radius

    def ratio_squared(self, load: float, factor: float) -> float:
        """Return (b/R_x)^2 [-] for W = w/(E' R_x) of the load per length w, and 2 Pi/pi."""
        return 4.0 * load / (math.pi**2 * factor)


LINE = Line()
