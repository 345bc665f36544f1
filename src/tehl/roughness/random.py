"""Random surfaces by their spectrum."""

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from tehl.base.errors import InputError
from tehl.base.typing import Array, np
from tehl.base.units import Angle, Height, Number, PositiveNumber
from tehl.roughness.model import (
    TileModel,
    Wavelength,
    check_slope,
    direction,
    wavelength_of,
    with_rms,
)

if TYPE_CHECKING:
    from tehl.roughness.tile import Tile

_LATTICE_POINTS = 1024
_WIDE_RANGE, _LARGEST_RANGE = 16.0, 64.0
_LENGTHS = ("correlation_length", "roll_off")
_LEAST_LENGTHS = 4
"""Fewest correlation or roll-off lengths after which a surface repeats along y."""
_SHORTEST_LENGTH, _LONGEST_LENGTH = 1e-12, 1e6
_LARGEST_KURTOSIS = 20.0

Seed = Annotated[int, Field(strict=True, ge=0, le=2**53)]


class Spectral(TileModel):
    """The spectrum of a `Random` surface, and the lattice that resolves it."""

    type: Literal["random"] = "random"
    rms: Height
    """Sq [m]; a period of the surface has it exactly."""
    ra: Height | None = None
    """Ra or Sa [m], instead of Sq: of Gaussian heights, Sq = Sa sqrt(pi/2)."""
    spectrum: Literal["gaussian", "self-affine"] = "gaussian"
    """Shape of the spectrum."""
    correlation_length: Wavelength | None = None
    correlation_length_y: Wavelength | None = None
    """l_u and l_v [m], where the autocorrelation is 1/e, along x and y when ``angle`` is zero; only
    the first is needed for equal ones. Gaussian spectra only."""
    roll_off: Wavelength | None = None
    roll_off_y: Wavelength | None = None
    """lambda_u and lambda_v [m], above which the spectrum is flat; only the first is needed for
    equal ones. Self-affine spectra only."""
    cut_off: Wavelength | None = None
    """Shortest wavelength [m], at least ``roll_off/64``; ``roll_off/16`` if left out. It is as much
    shorter along v as ``roll_off_y`` is."""
    hurst: PositiveNumber = 0.8
    """Hurst exponent H [-]."""

    @model_validator(mode="before")
    @classmethod
    def _convert_ra(cls, stated: Any) -> Any:
        return with_rms(stated, "ra", "rms")

    @model_validator(mode="after")
    def _must_have_a_spectrum(self) -> Self:
        needed, foreign = _LENGTHS if self.spectrum == "gaussian" else reversed(_LENGTHS)
        others = [foreign, f"{foreign}_y", *(["cut_off"] if self.spectrum == "gaussian" else [])]
        for key in others:
            if getattr(self, key) is not None:
                raise ValueError(
                    f'{key} does not apply to the spectrum "{self.spectrum}", which takes {needed}'
                )
        if getattr(self, needed) is None:
            raise ValueError(f'{needed} is missing: give a length such as "20 um"')
        self._check_lengths(needed)
        check_slope(self.rms, **dict(zip((needed, f"{needed}_y"), self._lengths, strict=True)))
        return self

    def _check_lengths(self, needed: str) -> None:
        for key, length in zip((needed, f"{needed}_y"), self._lengths, strict=True):
            if not _SHORTEST_LENGTH <= length <= _LONGEST_LENGTH:
                raise ValueError(
                    f"{key} = {length:g} m must lie between {_SHORTEST_LENGTH:g} m and "
                    f"{_LONGEST_LENGTH:g} m"
                )
        if not self.hurst <= 1.0:
            raise ValueError(f"hurst = {self.hurst:g} must not be larger than 1")
        if not 1.0 <= self._band <= _LARGEST_RANGE:
            raise ValueError(
                f"cut_off = {self.cut_off:g} m must lie between roll_off/{_LARGEST_RANGE:g} and "
                f"roll_off = {self.roll_off:g} m"
            )

    @property
    def _lengths(self) -> tuple[float, float]:
        """Return correlation or roll-off lengths along u and v [m]."""
        along, across = self.correlation_length, self.correlation_length_y
        if self.spectrum != "gaussian":
            along, across = self.roll_off, self.roll_off_y
        return along or 0.0, across or along or 0.0

    @property
    def _band(self) -> float:
        """Return the ratio of roll-off and cut-off, one for a Gaussian spectrum."""
        if self.spectrum == "gaussian" or self.roll_off is None:
            return 1.0
        return self.roll_off / self.cut_off if self.cut_off is not None else _WIDE_RANGE

    @property
    def lattice(self) -> tuple[tuple[int, int], tuple[float, float]]:
        """Return points along u and v, and pixels [m], of the lattice."""
        # four points per correlation length or cut-off
        along, across = (length / self._band / 4 for length in self._lengths)
        points = _LATTICE_POINTS if self._band <= _WIDE_RANGE else 2 * _LATTICE_POINTS
        return (points, points), (along, across)

    @property
    def period(self) -> tuple[float, float]:
        """Return the distances after which the surface repeats, along u and v [m]."""
        (columns, rows), (along, across) = self.lattice
        return columns * along, rows * across

    @property
    def is_smooth(self) -> bool:
        """Return whether Sq is zero."""
        return self.rms == 0

    @property
    def _slopes(self) -> tuple[float, float]:
        """Return mean square slopes over the mean square height, along u and v [1/m^2]."""
        if self.is_smooth:
            return 0.0, 0.0
        first, second = self._lengths
        if self.spectrum == "gaussian":
            return 2.0 / first**2, 2.0 / second**2
        band, hurst = self._band, self.hurst
        steep = 2.0 - 2.0 * hurst
        tail = math.log(band) if steep < 1e-6 else (band**steep - 1.0) / steep
        variance = 0.5 + (1.0 - band ** (-2.0 * hurst)) / (2.0 * hurst)
        square = 0.5 * (0.25 + tail) / variance * (2.0 * math.pi) ** 2
        return square / first**2, square / second**2

    def density(self, along: Array, across: Array) -> Array:
        """Return the power spectral density, one at zero.

        Parameters
        ----------
        along, across : Array
            Wave numbers along both axes of the lay [rad/m], broadcast against each other.
        """
        first, second = self._lengths
        if self.spectrum == "gaussian":
            return np.exp(-((along * first) ** 2 + (across * second) ** 2) / 4.0)
        number = np.hypot(along * first, across * second) / (2.0 * np.pi)
        falling = np.maximum(number, 1.0) ** (-2.0 * (1.0 + self.hurst))
        return np.where(number <= self._band, falling, 0.0)


class Random(Spectral):
    r"""A random surface with a given spectrum and distribution of heights.

    The power spectral density is, with wave numbers :math:`q_u` and :math:`q_v` along and across
    the lay,

    .. math:: C \sim \exp\{-(q_u^2 l_u^2 + q_v^2 l_v^2)/4\} \quad\text{("gaussian")}

    so that the autocorrelation is :math:`\exp\{-(u/l_u)^2 - (v/l_v)^2\}`, or with
    :math:`\kappa^2 = (q_u^2 \lambda_u^2 + q_v^2 \lambda_v^2)/4\pi^2`

    .. math:: C \sim 1,\ \kappa < 1; \quad \kappa^{-2(1+H)},\ \kappa \ge 1 \quad
              \text{("self-affine")}

    up to the cut-off [2]_. The surface is defined on its own lattice and repeats: it is the same
    on every mesh.

    References
    ----------
    .. [1] M. C. Jones and A. Pewsey, Sinh-arcsinh distributions, Biometrika 96 (2009), 761-780.
    .. [2] T. D. B. Jacobs, T. Junge and L. Pastewka, Quantitative characterization of surface
       topography using spectral analysis, Surf. Topogr.: Metrol. Prop. 5 (2017), 013001.
    """

    angle: Angle = 0.0
    """By which the lay is turned [rad], as the crests of a wave are."""
    seed: Seed = 0
    """The same number gives the same surface."""
    repeat_y: Wavelength | None = None
    """Distance after which it repeats along y [m], such as the length of a piece with periodic
    ends; that of its own lattice, 256 correlation lengths, if left out."""
    skewness: Number = 0.0
    kurtosis: PositiveNumber = 3.0
    """Ssk and Sku [-]; 0 and 3 is a Gaussian distribution of heights. Others are made by a monotone
    transformation [1]_ of a Gaussian surface; a period meets them to 1e-3. They change the
    autocorrelation a little."""

    @model_validator(mode="after")
    def _moments_must_be_possible(self) -> Self:
        if self.ra is not None and (self.skewness, self.kurtosis) != (0.0, 3.0):
            raise ValueError("ra holds for Gaussian heights: with skewness or kurtosis state rms")
        most = math.sqrt((_LARGEST_KURTOSIS - 2.1) / 1.5)
        if not abs(self.skewness) <= most:
            raise ValueError(
                f"skewness = {self.skewness:g} cannot be made: it must lie between -{most:.3g} and "
                f"{most:.3g}"
            )
        least = 2.1 + 1.5 * self.skewness**2
        if not least <= self.kurtosis <= _LARGEST_KURTOSIS:
            raise ValueError(
                f"kurtosis = {self.kurtosis:g} with skewness = {self.skewness:g} cannot be made: "
                f"it must lie between {least:.3g} and {_LARGEST_KURTOSIS:g}"
            )
        return self

    @model_validator(mode="after")
    def _must_repeat_on_its_lattice(self) -> Self:
        if self.repeat_y is None:
            return self
        (_, most), (_, pixel) = super().lattice
        least = _LEAST_LENGTHS * self._lengths[1]
        if self.angle != 0.0:
            raise ValueError(
                "repeat_y and angle exclude each other: a turned lay repeats obliquely"
            )
        if not least <= self.repeat_y <= most * pixel:
            raise ValueError(
                f"repeat_y = {self.repeat_y:g} m: must be at least {_LEAST_LENGTHS} correlation or "
                f"roll-off lengths along y, {least:g} m, and at most {most * pixel:g} m"
            )
        return self

    @property
    def lattice(self) -> tuple[tuple[int, int], tuple[float, float]]:
        """Return points along u and v, and pixels [m], of the lattice."""
        (columns, rows), (along, across) = super().lattice
        if self.repeat_y is not None:
            rows = math.ceil(self.repeat_y / across * (1.0 - 1e-9))
            across = self.repeat_y / rows
        return (columns, rows), (along, across)

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return the wavelengths 2 pi Sq / Sq' along x and along y [m].

        Sq' is the root mean square slope of the spectrum in that direction. Of a Gaussian spectrum
        it is 4.4 correlation lengths; 61 % of the variance have shorter waves, 5 % those below 1.8.
        """
        along, across = self._slopes
        cosine, sine = (value**2 for value in direction(self.angle))
        squares = (along * cosine + across * sine, along * sine + across * cosine)
        return wavelength_of(math.sqrt(squares[0])), wavelength_of(math.sqrt(squares[1]))

    @property
    def shortest_wavelength(self) -> float:
        """Return the wavelength 2 pi Sq / Sq' where it is shortest [m]."""
        return wavelength_of(math.sqrt(max(self._slopes)))

    @property
    def _tile(self) -> "Tile":
        return _tile_of(self)

    def fits(self, width: float, length: float) -> tuple[str, ...]:
        """Return a sentence if the surface repeats within a contact."""
        if not min(self.period) < math.hypot(width, length) or self.is_smooth:
            return ()
        along, across = (period * 1e6 for period in self.period)
        return (
            f"the random surface repeats after {along:.3g} x {across:.3g} um, within a contact of "
            f"{width * 1e6:.3g} x {length * 1e6:.3g} um: it has very short waves",
        )


@lru_cache(maxsize=4)
def _tile_of(surface: Random) -> "Tile":
    """Return one period of a random surface."""
    from scipy import fft  # noqa: PLC0415 (a case needs no scipy)

    from tehl.roughness.tile import Tile  # noqa: PLC0415

    (columns, rows), pixel = surface.lattice
    noise = np.random.default_rng(surface.seed).standard_normal((rows, columns))
    along, across = (2.0 * np.pi / step for step in pixel)
    density = surface.density(
        along * fft.rfftfreq(columns), across * fft.fftfreq(rows)[:, np.newaxis]
    )
    density[0, 0] = 0.0
    heights = fft.irfft2(fft.rfft2(noise) * np.sqrt(density), (rows, columns))
    heights /= np.sqrt(np.mean(np.square(heights)))
    if (surface.skewness, surface.kurtosis) != (0.0, 3.0):
        heights = _with_moments(heights, surface.skewness, surface.kurtosis)
    return Tile(heights=surface.rms * heights, pixel=pixel, angle=surface.angle)


def _with_moments(heights: Array, skewness: float, kurtosis: float) -> Array:
    r"""Return heights with given moments by a monotone transformation: each peak stays one.

    .. math:: t(z) = \sinh\frac{\operatorname{arsinh} z + \epsilon}{\delta}

    with the two parameters that these heights need, not those of a Gaussian distribution. Mean and
    mean square stay zero and one.
    """
    from scipy.optimize import least_squares  # noqa: PLC0415

    count, edges = np.histogram(heights, bins=4001)
    places, share = 0.5 * (edges[1:] + edges[:-1]), count / count.sum()

    def transformed(heights: Array, parameters: Array) -> Array:
        return np.sinh((np.arcsinh(heights) + parameters[0]) * np.exp(-parameters[1]))

    def missed(parameters: Array) -> Array:
        changed = transformed(places, parameters)
        off = changed - np.sum(share * changed)
        off /= np.sqrt(np.sum(share * off**2))
        return np.array([np.sum(share * off**3) - skewness, np.sum(share * off**4) - kurtosis])

    fits = [
        least_squares(missed, (start * np.sign(skewness), 0.0), bounds=([-30, -3], [30, 3]))
        for start in ((0.0, 1.0, 3.0) if skewness else (0.0,))
    ]
    best = min(fits, key=lambda fit: float(fit.cost))
    if not np.abs(best.fun).max() < 1e-3:  # of skewness and kurtosis [-]
        raise InputError(
            f"kurtosis = {kurtosis:g} with skewness = {skewness:g} cannot be made of these heights"
        )
    changed = transformed(heights, best.x)
    changed -= changed.mean()
    return changed / np.sqrt(np.mean(np.square(changed)))
