"""Features that stand alone: ridges and grooves, bumps and dents, dimples, pockets."""

import math
from typing import ClassVar, Literal, Self

from pydantic import model_validator

from tehl.base.typing import Array, np
from tehl.base.units import Angle
from tehl.roughness.model import (
    ENDLESS,
    Extent,
    Position,
    RoughnessModel,
    SignedHeight,
    Wavelength,
    check_slope,
    direction,
)

_TEN = math.log(10.0)


class FeatureModel(RoughnessModel):
    """Base of the features, round if not stated otherwise.

    ``LENGTH`` is the field with the length of their slopes. Over it, ``SHORTEST`` is the wavelength
    that a mesh must carry to represent the feature, where its spectrum has fallen to half of its
    height, and ``REACH`` the distance from the middle where 2 % of the height are left.
    """

    LENGTH: ClassVar[str] = "width"
    SHORTEST: ClassVar[float] = 0.5
    REACH: ClassVar[float] = 0.5
    rms: ClassVar[float] = 0.0  # one feature has no share of an infinite surface

    amplitude: SignedHeight
    """Height of the top [m]; negative is a depression."""
    x: Position = 0.0
    y: Position = 0.0
    """Where it stands at time zero [m]; a point of the crest of a ridge."""

    @model_validator(mode="after")
    def _must_be_shallow(self) -> Self:
        check_slope(self.amplitude, **{self.LENGTH: self._length})
        return self

    @property
    def _length(self) -> float:
        return float(getattr(self, self.LENGTH))

    @property
    def is_smooth(self) -> bool:
        """Return whether the feature has no height."""
        return self.amplitude == 0

    @property
    def is_even_in_y(self) -> bool:
        """Return whether the feature mirrors at y = 0."""
        return self.y == 0 or self.is_smooth

    @property
    def shortest_wavelength(self) -> float:
        """Return the wavelength that a mesh must carry to represent the feature [m]."""
        return math.inf if self.is_smooth else self.SHORTEST * self._length

    def extent(self, length: float) -> Extent:
        """Return where the feature stands at time zero along x and along y [m]."""
        del length
        reach = self.REACH * self._length
        return (self.x - reach, self.x + reach), (self.y - reach, self.y + reach)

    def _squared_distance(self, x: Array, y: Array) -> Array:
        """Return the squared distance from the middle, in lengths [-]."""
        return ((x - self.x) ** 2 + (y - self.y) ** 2) / self._length**2


class Bump(FeatureModel):
    r"""A Gaussian bump, or with a negative amplitude a dent.

    .. math:: s = A \exp\{-r^2/r_0^2\}
    """

    LENGTH = "radius"
    SHORTEST = 4.0
    REACH = 2.0

    type: Literal["bump"] = "bump"
    radius: Wavelength
    """r_0 [m], where the height is A/e."""

    def _at_rest(self, x: Array, y: Array) -> Array:
        return self.amplitude * np.exp(-self._squared_distance(x, y))


class Dimple(FeatureModel):
    r"""The dimple of the micro-texture literature, a cosine that dies out.

    .. math:: s = A \, 10^{-10 (r/w)^2} \cos(2\pi r/w)

    With a negative amplitude it is a dent with the rim of displaced material around it. It goes
    through zero at w/4, and less than a third of a percent is left beyond w/2.

    References
    ----------
    .. [1] C. H. Venner and A. A. Lubrecht, Multilevel Methods in Lubrication, Elsevier, 2000.
    .. [2] L. Mourier, D. Mazuyer, A. A. Lubrecht and C. Donnet, Tribology International 39 (2006),
       1745-1756.
    """

    type: Literal["dimple"] = "dimple"
    width: Wavelength
    """w [m]."""

    def _at_rest(self, x: Array, y: Array) -> Array:
        return self.amplitude * _damped_cosine(self._squared_distance(x, y))


class Pocket(FeatureModel):
    r"""The smooth pocket of laser-textured surfaces, a cosine under a Gaussian.

    .. math:: s = A \cos\frac{\pi r}{2b} \, \exp\{-2 (r/b)^2\}

    It goes through zero at b; beyond, less than 2 % of A are left.
    """

    LENGTH = "radius"
    SHORTEST = 1.7
    REACH = 0.93

    type: Literal["pocket"] = "pocket"
    radius: Wavelength
    """b [m]."""

    def _at_rest(self, x: Array, y: Array) -> Array:
        square = self._squared_distance(x, y)
        return self.amplitude * np.exp(-2.0 * square) * np.cos(0.5 * np.pi * np.sqrt(square))


class Ridge(FeatureModel):
    r"""A straight ridge, or with a negative amplitude a groove or scratch.

    .. math:: s = A \exp\{-(2t/b)^2\} \quad\text{or}\quad
              s = \frac{A}{2} \left(1 + \cos\frac{2\pi t}{b}\right),\ |t| < b/2
              \quad\text{or}\quad s = A \, 10^{-10 (t/b)^2} \cos\frac{2\pi t}{b}

    with t the distance from the crest.

    References
    ----------
    .. [1] C. H. Venner and A. A. Lubrecht, Numerical simulation of a transverse ridge in a circular
       EHL contact under rolling/sliding, J. Tribol. 116 (1994), 751-761.
    """

    type: Literal["ridge"] = "ridge"
    width: Wavelength
    """b [m]: of a Gaussian profile where the height is A/e, of a cosine from foot to foot, of a
    damped cosine as of :class:`Dimple`."""
    angle: Angle = 0.0
    """[rad]; zero is transverse: the crest along y, across the entrainment."""
    profile: Literal["gaussian", "cosine", "damped"] = "gaussian"
    """Shape across the crest, in the order of the formulas; "damped" is that of [1]_."""

    @property
    def is_even_in_y(self) -> bool:
        """Return whether the ridge runs across, or along the line y = 0."""
        cosine, sine = direction(self.angle)
        return sine == 0 or (cosine == 0 and self.y == 0) or self.is_smooth

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return the shortest wavelengths along x and along y [m]."""
        cosine, sine = (abs(part) for part in direction(self.angle))
        shortest = self.shortest_wavelength
        return (
            shortest / cosine if cosine else math.inf,
            shortest / sine if sine else math.inf,
        )

    @property
    def shortest_wavelength(self) -> float:
        """Return the wavelength across the crest that a mesh must carry [m]."""
        if self.is_smooth:
            return math.inf
        return {"gaussian": 2.0, "cosine": 1.0, "damped": 0.5}[self.profile] * self.width

    def extent(self, length: float) -> Extent:
        """Return where the ridge runs at time zero between y = -``length`` and ``length`` [m]."""
        cosine, sine = direction(self.angle)
        if not cosine:
            return ENDLESS
        reach = (1.0 if self.profile == "gaussian" else 0.5) * self.width / abs(cosine)
        ends = [self.x + sine / cosine * (y - self.y) for y in (-length, length)]
        return (min(ends) - reach, max(ends) + reach), ENDLESS[1]

    def _at_rest(self, x: Array, y: Array) -> Array:
        cosine, sine = direction(self.angle)
        across = ((x - self.x) * cosine - (y - self.y) * sine) / self.width
        if self.profile == "gaussian":
            return self.amplitude * np.exp(-((2.0 * across) ** 2))
        if self.profile == "damped":
            return self.amplitude * _damped_cosine(across**2)
        inside = np.minimum(np.abs(across), 0.5)
        return 0.5 * self.amplitude * (1.0 + np.cos(2.0 * np.pi * inside))


def _damped_cosine(square: Array) -> Array:
    """Return the cosine that dies out, by the squared distance in widths."""
    return np.exp(-10.0 * _TEN * square) * np.cos(2.0 * np.pi * np.sqrt(square))
