"""Asperities that are finer than the grid: the ``[asperities]`` table of a case.

Those of a measured patch follow from its dry contact (`tehl.patch`), or by a law:

Greenwood and Tripp [1]_: summits of radius beta with Gaussian heights of standard deviation sigma,
eta of them per area. At a separation h of the mean planes they carry

    p_a = 16 sqrt(2) pi / 15 (eta beta sigma)^2 sqrt(sigma/beta) E* F_(5/2)(h/sigma)

on a part of the area of pi^2 (eta beta sigma)^2 F_2(h/sigma), with 1/E* the sum of (1 - nu^2)/E and

    F_n(u) = (2 pi)^(-1/2) int_u^inf (s - u)^n exp(-s^2/2) ds.

Flow through the gap [2]_: the conductance is that of a smooth gap times

    phi = 1 - 0.9 exp(-0.56 h/sigma)

for isotropic roughness and h > sigma/2. The oil between Gaussian surfaces fills a mean gap of
``h Phi(h/sigma) + sigma phi(h/sigma)``, Phi and phi the Gaussian distribution and its density.

References
----------
.. [1] J. A. Greenwood and J. H. Tripp, Proc. IMechE 185 (1970), 625-633.
.. [2] N. Patir and H. S. Cheng, J. Lubrication Technology 100 (1978), 12-17.
"""

import math
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from tehl.base.table import Table
from tehl.base.typing import np
from tehl.base.units import Height, Quantity, SummitRadius
from tehl.contact.boundary_contact import Friction
from tehl.roughness.map import Map

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

    from tehl.base.typing import Array
    from tehl.patch.curves import PatchCurves

SummitDensity = Annotated[float, Quantity("a number per area", "1/m^2", '"1e10 1/m^2"')]

LARGEST_SEPARATION, LOG_STEP = 8.0, 0.02
"""Separation over sigma beyond which no area is in contact, and step of a spline up to there."""
LARGEST_GAP_OVER_SIGMA = 35.0
"""Gap over sigma from which no asperity touches."""
LARGEST_DEPTH_OVER_SIGMA = 30.0
"""Depth over sigma from which F_n is its power of the depth."""
DENSE, STEEP = (1e-5, 5.0), (1e-6, 0.5)
"""Limits of eta beta sigma and of sigma over beta: surfaces have 0.03 to 0.06, and 1e-4 to 1e-2."""
LEAST_GAP = 0.5
"""Least h/sigma of the flow factors; below it the channel narrows with the mean gap."""
POOLS_CLOSE = 0.25
"""Change of h/sigma below it by which the part of the oil that pools do not hold falls to 1/e: six
Gaussian patches hold 0.93, 0.97 and 0.996 of the mean gap at 0.5, 0.25 and 0."""


class _Summits(Table):
    """Base of the models of asperities."""

    synonyms: ClassVar = {"friction": "mu friction_coefficient", "rms": "sigma sq rq"}

    friction: Annotated[Friction, Field(le=2.0)] = 0.1
    """Friction coefficient of asperities that touch [-]."""


class GreenwoodTripp(_Summits):
    """Spherical summits with Gaussian heights, which carry load where the film is thin."""

    model: Literal["greenwood-tripp"]
    """How their pressure follows from the separation of the mean planes."""
    rms: Height | None = None
    """Standard deviation sigma of the heights of both surfaces together [m]; None is that of the
    stated ``rms_roughness`` of both."""
    summit_radius: SummitRadius
    """Radius beta of a summit [m]."""
    summit_density: SummitDensity
    """Summits per area, eta [1/m^2]."""

    def fault(self, sigma: float) -> str:
        """Return what is wrong with summits on heights of ``sigma`` [m]; nothing if all is well."""
        numbers = (
            ("summit_density x summit_radius x rms", self.load_factor(sigma), DENSE, "0.05"),
            ("rms / summit_radius", sigma / self.summit_radius, STEEP, "0.001"),
        )
        for name, value, (least, most), usual in numbers:
            if not least <= value <= most:
                limits = f"between {least:g} and {most:g}, usual is {usual}"
                return f"{name} = {value:.4g} must be {limits}"
        return ""

    def load_factor(self, sigma: float) -> float:
        """Return eta beta sigma [-]."""
        return self.summit_density * self.summit_radius * sigma

    def pressure(self, gap: "Array", sigma: float, modulus: float) -> "Array":
        """Return the pressure that the asperities carry [Pa].

        Parameters
        ----------
        gap : array
            Separation of the mean planes over sigma [-].
        sigma, modulus : float
            Standard deviation of the heights [m], and E' [Pa].
        """
        return self.unit(sigma, modulus) * self.load(gap)

    def load(self, gap: "Array") -> "Array":
        """Return the pressure over `unit` at gaps over sigma [-]."""
        return gaussian_integral(2.5, gap)

    def mean_gap(self, gap: "Array") -> "Array":
        """Return the mean gap over sigma [-]."""
        return mean_gap(gap)

    def channel(self, gap: "Array") -> "Array":
        """Return the thickness of a smooth gap that conducts as much, over sigma [-]."""
        return channel(gap)

    def carried(self, gap: "Array") -> "Array":
        """Return what a rough surface carries beside the gap, Phi_s over the mean gap [-]."""
        return shear_flow(gap) / mean_gap(gap)

    def unit(self, sigma: float, modulus: float) -> float:
        """Return the pressure over F_(5/2) for sigma [m] and E' [Pa]: in Pa.

        Parameters
        ----------
        sigma : float
            Rms height of both surfaces together [m].
        modulus : float
            E' [Pa], twice the contact modulus.
        """
        steep = math.sqrt(sigma / self.summit_radius)
        factor = 16.0 * math.sqrt(2.0) * math.pi / 15.0 * self.load_factor(sigma) ** 2
        return factor * steep * 0.5 * modulus

    def spots(self, gap: "Array", sigma: float) -> "tuple[Array, Array]":
        """Return the part of the area in which asperities touch, and their spots per area.

        Parameters
        ----------
        gap : Array
            Separations of the mean planes over sigma [-].
        sigma : float
            Rms height of both surfaces together [m].

        Returns
        -------
        part : Array
            Real over nominal area [-], at most one, in the shape of ``gap``.
        spots : Array
            4 pi eta^2 beta sigma F_1 [1/m^2].
        """
        factor, (number, part) = self.load_factor(sigma), _on_map(gap)
        part *= (math.pi * factor) ** 2
        return np.minimum(part, 1.0), 4.0 * math.pi * self.summit_density * factor * number


class SurfacePatch(_Summits):
    """Asperities of a measured patch: it is pressed flat, and oil flows through what is left."""

    model: Literal["surface"]
    """How their pressure follows from the separation of the mean planes."""
    map: Map
    """The measured patch, heights of both surfaces together: the other one is smooth. Of more than
    192 points along x or y the middle is taken; unless ``outside = "periodic"`` the patch is
    continued by its mirror image. The surface that states ``rms_roughness`` has it; both, in
    proportion to the squares, if both do. If none does, it carries no oil in sliding."""

    @model_validator(mode="after")
    def _check_place(self) -> "SurfacePatch":
        for name in ("x", "y", "rotate"):
            if getattr(self.map, name) != 0.0:
                raise ValueError(f"map.{name} does not apply to a patch, which has no place")
        return self

    @property
    def rms(self) -> float:
        """Return Sq of the patch that is taken [m]."""
        return float(_patch(self.map, self.map.stamp).std())

    @property
    def curves(self) -> "PatchCurves":
        """Return pressure, area and flow of the patch, computed once: it takes some seconds."""
        return _curves(self.map, self.map.stamp)

    def unit(self, sigma: float, modulus: float) -> float:
        """Return E*, the unit of `load`, for E' [Pa]; ``sigma`` is not used in any method."""
        del sigma
        return 0.5 * modulus

    def load(self, gap: "Array") -> "Array":
        """Return the pressure over E* at gaps over Sq [-]."""
        return self.curves.load(gap)

    def pressure(self, gap: "Array", sigma: float, modulus: float) -> "Array":
        """Return the pressure that the asperities carry at gaps over Sq, for E' [Pa]."""
        return self.unit(sigma, modulus) * self.load(gap)

    def spots(self, gap: "Array", sigma: float) -> "tuple[Array, Array]":
        """Return the part of the area in which asperities touch, and their spots per area.

        Returns
        -------
        part : Array
            Touching over nominal area [-], in the shape of ``gap``.
        spots : Array
            Connected groups of touching pixels [1/m^2].
        """
        del sigma
        return self.curves.touching(gap), self.curves.spots(gap)

    def mean_gap(self, gap: "Array") -> "Array":
        """Return the mean gap over Sq: the distance of the deformed mean planes [-]."""
        return self.curves.mean_gap(gap)

    def channel(self, gap: "Array") -> "Array":
        """Return the thickness of a smooth gap that conducts as much along x, over Sq [-]."""
        return self.curves.conducts(gap)

    def across(self, gap: "Array") -> "Array":
        """Return the conductance along y over that along x [-]."""
        return self.curves.conducts_across(gap)

    def carried(self, gap: "Array") -> "Array":
        """Return what a rough surface carries beside the gap, Phi_s over the mean gap [-]."""
        return self.curves.carries(gap)


Asperities = Annotated[GreenwoodTripp | SurfacePatch, Field(discriminator="model")]
"""Asperities finer than the grid, which carry part of the load where the film is thin."""


@lru_cache(maxsize=4)
def _patch(surface: Map, stamp: object) -> "Array":
    from tehl.patch.curves import periodic_patch  # noqa: PLC0415 (for measured patches only)

    del stamp
    return periodic_patch(surface.load().values, fits=surface.outside == "periodic")


@lru_cache(maxsize=4)
def _curves(surface: Map, stamp: object) -> "PatchCurves":
    from tehl.patch.curves import patch_curves  # noqa: PLC0415

    return patch_curves(_patch(surface, stamp), surface.load().pixel)


def gaussian_integral(n: float, gap: "Array") -> "Array":
    """Return F_n of Gaussian heights at gaps over sigma [-].

    By Whittaker's parabolic cylinder function, ``Gamma(n + 1) exp(-u^2/4) D_(-n-1)(u)`` over
    ``sqrt(2 pi)``.

    Parameters
    ----------
    n : float
        Power of the overlap: 1 for the number of spots, 2 for their area, 5/2 for the load.
    gap : Array
        Separations of the mean planes over sigma [-], of any shape and sign.
    """
    from scipy.special import pbdv  # noqa: PLC0415 (0.1 s, for cases with asperities only)

    near = np.clip(gap, -LARGEST_DEPTH_OVER_SIGMA, LARGEST_GAP_OVER_SIGMA)
    values, _ = pbdv(-n - 1.0, near)
    found = math.gamma(n + 1.0) / math.sqrt(2.0 * math.pi) * np.exp(-0.25 * near**2) * values
    # beyond, as the power that it tends to
    found *= (np.maximum(-gap, LARGEST_DEPTH_OVER_SIGMA) / LARGEST_DEPTH_OVER_SIGMA) ** n
    return np.where(gap < LARGEST_GAP_OVER_SIGMA, found, 0.0)


def _on_map(gap: "Array") -> "Array":
    """Return F_1 and F_2 to 1e-9, zero from `LARGEST_SEPARATION` on, (2, *shape of ``gap``).

    On all nodes of a grid the functions themselves take long.
    """
    near = gap < LARGEST_SEPARATION
    found = np.zeros((2, *gap.shape))
    values = np.exp(_logarithms()(np.maximum(gap[near], -LARGEST_DEPTH_OVER_SIGMA)))
    for each, value in zip(found, values, strict=True):
        each[near] = value
    return found


@cache
def _logarithms() -> "CubicSpline":
    """Return ln F_1 and ln F_2 as a spline of the separation."""
    from scipy.interpolate import CubicSpline  # noqa: PLC0415

    at = np.arange(-LARGEST_DEPTH_OVER_SIGMA, LARGEST_SEPARATION + LOG_STEP, LOG_STEP)
    return CubicSpline(at, np.log([gaussian_integral(n, at) for n in (1.0, 2.0)]), axis=1)


def mean_gap(gap: "Array") -> "Array":
    """Return the mean gap between Gaussian surfaces over sigma, positive [-].

    ``gap`` is the separation of the mean planes over sigma.
    """
    from scipy.special import erfcx  # noqa: PLC0415

    # h Phi + phi cancels far below zero: by the scaled error function of the depth
    deep = np.abs(gap)
    tail = np.exp(-0.5 * gap**2) / math.sqrt(2.0 * math.pi)
    tail = tail * (1.0 - deep * math.sqrt(0.5 * math.pi) * erfcx(deep / math.sqrt(2.0)))
    return np.maximum(gap, 0.0) + tail


def channel(gap: "Array") -> "Array":
    """Return the thickness of a smooth gap of the same conductance over sigma [-].

    ``(phi h^3)^(1/3)`` for h > sigma/2, below it in proportion to the mean gap.
    """
    inside = np.maximum(gap, LEAST_GAP)
    smooth = inside * (1.0 - 0.9 * np.exp(-0.56 * inside)) ** (1.0 / 3.0)
    return smooth * np.where(gap < LEAST_GAP, mean_gap(gap) / mean_gap(inside), 1.0)


def shear_flow(gap: "Array") -> "Array":
    """Return Phi_s of isotropic surfaces: what the rougher one carries beside the gap, over sigma.

    Patir and Cheng, J. Lubrication Technology 101 (1979), 220-230, table 1, for h > sigma/2; below
    it goes to the mean gap, as closed pools move with the rough surface. ``gap`` is the separation
    of the mean planes over sigma.
    """
    inside = np.maximum(gap, LEAST_GAP)
    near = 1.899 * inside**0.98 * np.exp(-0.92 * inside + 0.05 * np.minimum(inside, 5.0) ** 2)
    found = np.where(inside > 5.0, 1.126 * np.exp(-0.25 * inside), near)
    open_part = (1.0 - found / mean_gap(inside)) * np.exp((gap - inside) / POOLS_CLOSE)
    return np.where(gap < LEAST_GAP, mean_gap(gap) * (1.0 - open_part), found)
