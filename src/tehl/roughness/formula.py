"""Surfaces by a formula of the user."""

import math
from functools import lru_cache
from typing import Literal, NamedTuple, Self

from pydantic import model_validator

from tehl.base.errors import InputError
from tehl.base.typing import Array, np
from tehl.roughness.expression import Place, read_formula
from tehl.roughness.model import RoughnessModel, Wavelength, check_slope

_SAMPLE_HALF_WIDTH, _DIFFERENCE_STEP, _SAMPLE_COUNT = 1e-3, 5e-8, 4096
"""Half-width of the square that is sampled, step of differences [m], and number of samples."""


class _Samples(NamedTuple):
    """What samples of a formula show: Sq [m], shortest wavelengths [m], whether it is even in y."""

    rms: float
    largest: float
    wavelengths: tuple[float, float]
    is_even_in_y: bool


class Formula(RoughnessModel):
    r"""A surface whose heights are a formula of x and y, such as ``0.2 um * cos(2*pi*x/(0.1 mm))``.

    Its names are x, y, :math:`r = \sqrt{x^2 + y^2}` and pi; numbers carry units. The shortest
    wavelength along an axis is estimated as :math:`2\pi \max|s'|/\max|s''|`, of samples up to 1 mm
    around the origin that are denser near it.
    """

    type: Literal["formula"] = "formula"
    formula: str
    """Heights, a length."""
    wavelength: Wavelength | None = None
    """Shortest wave that a mesh must carry [m]; estimated if left out."""

    @model_validator(mode="after")
    def _must_be_shallow(self) -> Self:
        try:
            found = _samples(self.formula)
        except InputError as error:
            raise ValueError(str(error)) from None
        check_slope(found.largest, wavelength=min(*found.wavelengths, 4.0 * _SAMPLE_HALF_WIDTH))
        return self

    @property
    def is_smooth(self) -> bool:
        """Return whether the formula is zero."""
        return _samples(self.formula).largest == 0.0

    @property
    def is_even_in_y(self) -> bool:
        """Return whether the samples mirror at y = 0."""
        return _samples(self.formula).is_even_in_y

    @property
    def rms(self) -> float:
        """Return Sq over 2 x 2 mm around the origin [m]."""
        return _samples(self.formula).rms

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return the shortest wavelengths along x and along y [m]."""
        if self.wavelength is not None and not self.is_smooth:
            return self.wavelength, self.wavelength
        return _samples(self.formula).wavelengths

    @property
    def shortest_wavelength(self) -> float:
        """Return the shortest wavelength along an axis [m]."""
        return min(self.shortest_wavelengths)

    def _at_rest(self, x: Array, y: Array) -> Array:
        return _heights(self.formula, x, y)


def _heights(formula: str, x: Array, y: Array) -> Array:
    """Return the heights [m] at x and y [m]; raise InputError where one is not finite."""
    with np.errstate(all="ignore"):
        found = np.asarray(read_formula(formula)(Place(x, y)), dtype=np.float64)
    heights = np.array(np.broadcast_to(found, np.broadcast_shapes(x.shape, y.shape)))
    if not np.isfinite(heights).all():
        place = np.unravel_index(int(np.argmin(np.isfinite(heights))), heights.shape)
        at_x, at_y = (float(np.broadcast_to(one, heights.shape)[place]) * 1e6 for one in (x, y))
        raise InputError(
            f"formula {formula!r} is not finite at x = {at_x:.4g} um, y = {at_y:.4g} um"
        )
    return heights


@lru_cache(maxsize=16)
def _samples(formula: str) -> _Samples:
    """Return what samples of a formula show."""
    random = np.random.default_rng(0)
    wide = random.uniform(-_SAMPLE_HALF_WIDTH, _SAMPLE_HALF_WIDTH, (2, _SAMPLE_COUNT))
    angle = random.uniform(0.0, 2.0 * np.pi, _SAMPLE_COUNT)
    near = np.geomspace(1e-3 * _SAMPLE_HALF_WIDTH, _SAMPLE_HALF_WIDTH, _SAMPLE_COUNT) * np.array(
        [np.cos(angle), np.sin(angle)]
    )
    x, y = np.concatenate([wide, near], axis=1)
    middle = _heights(formula, x, y)
    scale = float(np.abs(middle).max())
    waves = []
    for along, across in ((_DIFFERENCE_STEP, 0.0), (0.0, _DIFFERENCE_STEP)):
        before = _heights(formula, x - along, y - across)
        after = _heights(formula, x + along, y + across)
        slope = float(np.abs(after - before).max()) / (2.0 * _DIFFERENCE_STEP)
        bend = float(np.abs(after - 2.0 * middle + before).max()) / _DIFFERENCE_STEP**2
        rounding = 1e-9 * slope * _DIFFERENCE_STEP + 1e-13 * scale
        is_straight = bend * _DIFFERENCE_STEP**2 <= rounding
        waves.append(math.inf if is_straight else 2.0 * math.pi * slope / bend)
    mirrored = _heights(formula, x, -y)
    return _Samples(
        rms=float(middle[:_SAMPLE_COUNT].std()),
        largest=float(np.ptp(middle)) / 2.0 if np.ptp(middle) > 0 else scale,
        wavelengths=(waves[0], waves[1]),
        is_even_in_y=bool(np.abs(mirrored - middle).max() <= 1e-9 * scale),
    )
