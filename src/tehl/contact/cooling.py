r"""Thermal resistance of a rotating body: the table ``cooling`` of a surface.

The heat of the contact enters along a circle of radius r that passes it with the speed u, once in
the time P = 2 pi r / u. The body is as warm as its track when it enters the contact again, warmed
by all earlier passes. Each is an instantaneous source along the track [1]_, and their sum is

.. math:: R = R_\mathrm{body} + \frac{1}{4 \pi^2 k r} \Bigl[ \ln \frac{c L^2}{\kappa P} + \gamma
          + S\Bigl(\frac{a_y^2}{5 \kappa P}\Bigr) \Bigr], \qquad
          S(e) = \lim_{N \to \infty} \Bigl( \sum_{n=1}^{N} \frac{1}{\sqrt{n (n + e)}} - \ln N
          \Bigr),

with the width of the track by the variance of its heat over y, a_y^2 / 5 of a Hertz contact and
a_y^2 / 3 of the even heat of a roller, and

==========  ==================================  =============================================
half-space  :math:`c L^2 = 16 r^2`              :math:`R_\mathrm{body} = 0`
disc        :math:`c L^2 = t^2 / (4 \pi^2)`     fin [2]_ of thickness t cooled on both faces
ball        :math:`c L^2 = 0.0597 r^2`          :math:`1 / (4 \pi r^2 h)`
==========  ==================================  =============================================

where ln 0.0597 = 4 ln 2 - 2 pi (1 - ln 2) - 4 G, with Catalan's constant G, follows from Neumann's
function of the sphere. The fin has ``m = sqrt(2 h / (k t))`` and no flux through its rim at b:

.. math:: R_\mathrm{body} = \frac{I_0(m r)}{2 \pi k t} \Bigl[ K_0(m r) + \frac{K_1(m b)}{I_1(m b)}
          I_0(m r) \Bigr].

References
----------
.. [1] H. S. Carslaw and J. C. Jaeger, Conduction of Heat in Solids, 2nd ed. (1959), 10.2-10.3.
.. [2] K. A. Gardner, Trans. ASME 67 (1945), 621-631.
"""

import math
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, NamedTuple

from pydantic import Field, model_validator

from tehl.base.lazy import lazy
from tehl.base.table import Table
from tehl.base.typing import np
from tehl.base.units import HeatTransfer, Length
from tehl.contact.materials import Solid

if TYPE_CHECKING:
    from typing import Self

    from scipy import special
else:
    special = lazy("scipy.special")

SUMMED_PASSES = 100
"""Terms of the sum S; the rest is an integral, with an error below 1e-5."""
OF_ELLIPSE, OF_ROLLER = 1.0 / 5.0, 1.0 / 3.0
"""Variance of the heat across the track over a_y^2, a_y half of the length of a roller."""
LARGEST_BIOT = 0.3
"""h L / k up to which discs and balls hold."""


class _Shape(NamedTuple):
    """A body: radius of its track [m], c L^2 [m^2], Biot number [-], R_body [K/W]."""

    track: float
    depth_squared: float
    biot: float
    whole: float


class _Body(Table):
    """Base of the bodies."""

    synonyms: ClassVar = {"heat_transfer": "h htc coefficient heat_transfer_coefficient"}

    def _shape(self, conductivity: float) -> _Shape:
        raise NotImplementedError

    def resistance(
        self, solid: Solid, speed: float, width: float, variance: float = OF_ELLIPSE
    ) -> float:
        """Return the rise of the track over the oil per heat that enters [K/W].

        Parameters
        ----------
        solid : Solid
            With its thermal properties.
        speed, width : float
            Of its surface [m/s], and half-width a_y of the contact [m].
        variance : float
            Of its heat over y, over a_y^2 [-].

        Raises
        ------
        ValueError
            If the formula does not hold; the message continues a sentence that names the body.
        """
        conductivity, diffusivity = solid.conductivity or math.nan, solid.diffusivity or math.nan
        shape = self._shape(conductivity)
        if not speed:
            raise ValueError("needs a rotating body, and this surface is at rest")
        if not 2.0 * width < shape.track:
            raise ValueError(
                f"has a track of radius {shape.track:g} m: it must exceed twice the half-width "
                f"a_y = {width:.3g} m of the contact"
            )
        if not shape.biot <= LARGEST_BIOT:
            raise ValueError(
                f"has a Biot number h L / k of {shape.biot:.2g}: it must be at most "
                f"{LARGEST_BIOT:g}, that of a body of nearly one temperature"
            )
        spread = diffusivity * 2.0 * math.pi * shape.track / abs(speed)
        logarithms = (
            math.log(shape.depth_squared / spread)
            + np.euler_gamma
            + _passes(variance * width**2 / spread)
        )
        if not logarithms > 0.0:
            raise ValueError(
                f"turns too slowly, u = {speed:g} m/s: heat reaches all of the body within a turn"
            )
        return shape.whole + logarithms / (4.0 * math.pi**2 * conductivity * shape.track)


class HalfSpace(_Body):
    """A rotating body so large that its far side is as cold as the oil."""

    body: Literal["half-space"]
    """Shape of the body."""
    track_radius: Length
    """Radius r of the circle that passes the contact [m]."""

    def _shape(self, conductivity: float) -> _Shape:
        del conductivity
        return _Shape(self.track_radius, 16.0 * self.track_radius**2, 0.0, 0.0)


class Disc(_Body):
    """A disc that is cooled on both faces and touched on one of them."""

    body: Literal["disc"]
    """Shape of the body."""
    track_radius: Length
    radius: Length
    thickness: Length
    """Radius r of the circle that passes the contact, radius b and thickness t [m]."""
    heat_transfer: HeatTransfer
    """Coefficient h of both faces [W/m^2/K]."""

    @model_validator(mode="after")
    def _track_on_disc(self) -> "Self":
        if not self.track_radius <= self.radius:
            raise ValueError(
                f"track_radius = {self.track_radius:g} m must be at most the radius of the disc, "
                f"{self.radius:g} m"
            )
        return self

    def _shape(self, conductivity: float) -> _Shape:
        thickness, transfer = self.thickness, self.heat_transfer
        slope = math.sqrt(2.0 * transfer / (conductivity * thickness))
        track, rim = slope * self.track_radius, slope * self.radius
        # exponentially scaled Bessel functions do not overflow
        back = special.k1e(rim) / special.i1e(rim) * math.exp(2.0 * (track - rim))
        fin = special.i0e(track) * (special.k0e(track) + back * special.i0e(track))
        return _Shape(
            self.track_radius,
            (thickness / (2.0 * math.pi)) ** 2,
            transfer * thickness / conductivity,
            float(fin) / (2.0 * math.pi * conductivity * thickness),
        )


class Ball(_Body):
    """A ball that is cooled all around and touched along a great circle."""

    body: Literal["ball"]
    """Shape of the body."""
    radius: Length
    """Radius r [m]."""
    heat_transfer: HeatTransfer
    """Coefficient h of its surface [W/m^2/K]."""

    def _shape(self, conductivity: float) -> _Shape:
        radius, transfer = self.radius, self.heat_transfer
        ln_2, catalan = math.log(2.0), 0.915965594177219
        depth = math.exp(4.0 * ln_2 - 2.0 * math.pi * (1.0 - ln_2) - 4.0 * catalan)
        return _Shape(
            radius,
            depth * radius**2,
            transfer * radius / conductivity,
            1.0 / (4.0 * math.pi * radius**2 * transfer),
        )


Cooling = Annotated[HalfSpace | Disc | Ball, Field(discriminator="body")]
"""A rotating body whose thermal resistance is estimated."""


def _passes(wide: float) -> float:
    """Return S of a track by the variance of its heat over kappa P [-]."""
    wide = max(wide, 1e-12)
    terms = [1.0 / math.sqrt(n * (n + wide)) for n in range(1, SUMMED_PASSES + 1)]
    rest = math.log(4.0 / wide) - 2.0 * math.asinh(math.sqrt(SUMMED_PASSES / wide))
    return math.fsum(terms) - 0.5 * terms[-1] + rest
