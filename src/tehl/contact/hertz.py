r"""Dry contact of two elastic solids (Hertz), exact for any ellipse.

With :math:`m = 1 - 1/k^2`, ``k >= 1`` the ratio of the long to the short half-width, and the
integrals

.. math:: B = \int_0^{\pi/2} \frac{\cos^2 t}{\sqrt{1 - m \sin^2 t}} dt, \qquad
          D = \int_0^{\pi/2} \frac{\sin^2 t}{\sqrt{1 - m \sin^2 t}} dt

the radii obey :math:`R_{long}/R_{short} = k^2 B / D`. Written with B and D
(:math:`K = B + D`, :math:`E = B + (1-m) D`) nothing cancels at the circle, where both are
:math:`\pi/4`.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache


@dataclass(frozen=True, kw_only=True, slots=True)
class HertzContact:
    """Dry contact, along and across entrainment."""

    half_width_x: float
    half_width_y: float
    """a_x and a_y [m]: the largest x and y, on an ellipse at an angle not on its axes."""
    pressure: float
    """Largest pressure p_h [Pa]."""
    approach: float
    """Approach of the bodies [m]; not a number for a line."""
    ellipticity: float
    """kappa = a_y / a_x [-]; infinite for a line."""
    skew: float = 0.0
    """s of the rim X^2 - 2 s X Y + Y^2 = 1 - s^2 in these half-widths; zero on the axes [-]."""

    def turned(self, angle: float) -> "HertzContact":
        """Return the same contact with its x axis at an angle to x.

        Parameters
        ----------
        angle : float
            Counter-clockwise [rad]; this contact has no skew.
        """
        first, second = self.half_width_x**2, self.half_width_y**2
        cosine, sine = math.cos(angle), math.sin(angle)
        along = math.sqrt(first * cosine**2 + second * sine**2)
        across = math.sqrt(first * sine**2 + second * cosine**2)
        return replace(
            self,
            half_width_x=along,
            half_width_y=across,
            ellipticity=across / along,
            skew=(first - second) * sine * cosine / (along * across),
        )

    @property
    def axes(self) -> tuple[float, float, float]:
        """Half-axes [m], the smaller first unless they lie along x and y; the angle of that [rad].

        The angle is that from x, counter-clockwise.
        """
        return axes_of(self.half_width_x, self.half_width_y, self.skew)

    @property
    def mean_pressure(self) -> float:
        """Return two thirds of the largest pressure, pi/4 of that of a line [Pa]."""
        return self.pressure * (math.pi / 4.0 if math.isinf(self.ellipticity) else 2.0 / 3.0)


def axes_of(half_width_x: float, half_width_y: float, skew: float) -> tuple[float, float, float]:
    """Return the half-axes of an ellipse and the angle of the first, as `HertzContact.axes`.

    Parameters
    ----------
    half_width_x, half_width_y, skew : float
        Its largest x and y, and s of its rim.
    """
    if skew == 0.0:
        return half_width_x, half_width_y, 0.0
    along, across, mixed = half_width_x**2, half_width_y**2, skew * half_width_x * half_width_y
    long = math.sqrt(0.5 * (along + across) + math.hypot(0.5 * (along - across), mixed))
    area = half_width_x * half_width_y * math.sqrt(1.0 - skew**2)
    return area / long, long, 0.5 * math.atan2(-2.0 * mixed, across - along)


def elliptic_b_d(parameter: float) -> tuple[float, float]:
    """Return the complete elliptic integrals B and D of ``parameter`` m, 0 <= m < 1.

    By the arithmetic-geometric mean; neither loses digits at m = 0.
    """
    a, b = 1.0, math.sqrt(1.0 - parameter)
    ratio = 0.5  # sum of 2^(n-1) c_n^2 / m over the steps n
    c_squared = 1.0  # c_n^2 / m
    weight = 0.5
    for _ in range(40):
        mean = 0.5 * (a + b)
        c_squared = c_squared**2 * parameter / (16.0 * mean**2)
        a, b = mean, math.sqrt(a * b)
        weight *= 2.0
        ratio += weight * c_squared
        if weight * c_squared < 1e-17:
            break
    complete = math.pi / (2.0 * a)
    return complete * (1.0 - ratio), complete * ratio


def ellipticity(radius_x: float, radius_y: float) -> float:
    """Return kappa = a_y / a_x of a contact with reduced radii ``radius_x``, ``radius_y`` [m].

    Parameters
    ----------
    radius_x, radius_y : float
        Reduced radii along and across the entrainment [m], positive and finite.

    Returns
    -------
    float
        Above one if the contact is wider across the entrainment, ``radius_y > radius_x``.
    """
    if radius_y < radius_x:
        return 1.0 / _axis_ratio(radius_x / radius_y)
    return _axis_ratio(radius_y / radius_x)


@lru_cache(maxsize=256)  # a solve needs the same contact some ten times
def _axis_ratio(radius_ratio: float) -> float:
    """Solve ``k^2 B/D = radius_ratio`` for k >= 1 by bisection in ln k."""
    low, high = 0.0, math.log(radius_ratio)
    for _ in range(60):
        middle = 0.5 * (low + high)
        b, d = elliptic_b_d(-math.expm1(-2.0 * middle))
        low, high = (middle, high) if b / d * math.exp(2 * middle) < radius_ratio else (low, middle)
    return math.exp(0.5 * (low + high))


def hertz_contact(
    load: float, radius_x: float, radius_y: float, reduced_modulus: float
) -> HertzContact:
    """Return the dry contact under ``load``.

    Parameters
    ----------
    load : float
        Normal load [N].
    radius_x, radius_y : float
        Reduced radii along and across entrainment [m].
    reduced_modulus : float
        E' with ``2/E' = (1-nu_1^2)/E_1 + (1-nu_2^2)/E_2`` [Pa].

    References
    ----------
    .. [1] K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, chapter 4.
    """
    kappa = ellipticity(radius_x, radius_y)
    k = max(kappa, 1.0 / kappa)
    b, d = elliptic_b_d(1.0 - 1.0 / k**2)
    mean_radius = 1.0 / (1.0 / radius_x + 1.0 / radius_y)
    second_kind = b + d / k**2
    long = math.cbrt(6.0 * k**2 * second_kind * mean_radius * load / (math.pi * reduced_modulus))
    short = long / k
    half_width_x, half_width_y = (short, long) if kappa >= 1.0 else (long, short)
    return HertzContact(
        half_width_x=half_width_x,
        half_width_y=half_width_y,
        pressure=1.5 * load / (math.pi * half_width_x * half_width_y),
        approach=3.0 * load * (b + d) / (math.pi * reduced_modulus * long),
        ellipticity=kappa,
    )


def load_of_pressure(
    pressure: float, radius_x: float, radius_y: float, reduced_modulus: float
) -> float:
    """Return the load [N] under which the Hertz pressure is ``pressure`` [Pa].

    Parameters
    ----------
    pressure : float
        Largest pressure [Pa].
    radius_x, radius_y, reduced_modulus : float
        As in `hertz_contact`.
    """
    under_one_newton = hertz_contact(1.0, radius_x, radius_y, reduced_modulus).pressure
    return (pressure / under_one_newton) ** 3
