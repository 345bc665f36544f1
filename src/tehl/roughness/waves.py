"""Harmonic surfaces: one wave, and two that cross."""

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple, Self

from pydantic import model_validator

from tehl.base.typing import Array, np
from tehl.base.units import Angle, Height
from tehl.roughness.model import RoughnessModel, Wavelength, check_slope, direction, wavelength_of

_EQUAL_WAVES = 1e-9


class WaveVector(NamedTuple):
    """One harmonic, ``amplitude cos(along x + across y + phase)``."""

    amplitude: float
    """[m], not negative."""
    along: float
    across: float
    """Wave numbers along x and y [rad/m]."""
    phase: float
    """[rad]."""

    @property
    def number(self) -> float:
        """Return the wave number across the crests [rad/m]."""
        return math.hypot(self.along, self.across)

    def rate(self, velocity: tuple[float, float]) -> float:
        """Return the frequency at a place that it passes with a velocity [m/s], signed [rad/s]."""
        return self.along * velocity[0] + self.across * velocity[1]

    @property
    def wavelength(self) -> float:
        """Return the distance of the crests [m]."""
        return 2.0 * math.pi / self.number

    @property
    def angle(self) -> float:
        """Return the angle as cases state it, between -pi/2 and pi/2 [rad]."""
        backwards = self.along < 0 or (self.along == 0 and self.across > 0)
        sign = -1.0 if backwards else 1.0
        return math.atan2(-sign * self.across, sign * self.along)


class HarmonicModel(RoughnessModel):
    """Base of the surfaces that are a few harmonics."""

    @property
    def components(self) -> tuple[WaveVector, ...]:
        """Return the harmonics whose sum the surface is."""
        raise NotImplementedError

    @property
    def is_smooth(self) -> bool:
        """Return whether all amplitudes are zero."""
        return not self._present

    @property
    def is_even_in_y(self) -> bool:
        """Return whether each harmonic, or a pair of them, mirrors at y = 0."""
        return are_even(self._present)

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return the shortest wavelengths along x and along y [m]."""
        numbers = ((abs(wave.along), abs(wave.across)) for wave in self._present)
        along, across = zip((0.0, 0.0), *numbers, strict=True)
        return wavelength_of(max(along)), wavelength_of(max(across))

    @property
    def shortest_wavelength(self) -> float:
        """Return the shortest distance between crests [m]."""
        return wavelength_of(max((wave.number for wave in self._present), default=0.0))

    @property
    def rms(self) -> float:
        """Return the root mean square height Sq of the infinite surface [m]."""
        return root_mean_square(self._present)

    @property
    def _present(self) -> list[WaveVector]:
        return [wave for wave in self.components if wave.amplitude > 0]

    def _at_rest(self, x: Array, y: Array) -> Array:
        total = np.zeros(np.broadcast_shapes(x.shape, y.shape))
        for wave in self._present:
            total += wave.amplitude * np.cos(wave.along * x + wave.across * y + wave.phase)
        return total


class Wave(HarmonicModel):
    r"""A wave over the whole surface.

    .. math:: s = A \cos\left(\frac{2\pi}{\lambda} (x \cos\varphi - y \sin\varphi) + \psi\right)
    """

    type: Literal["wave"] = "wave"
    amplitude: Height
    """A [m], from the mean to a crest."""
    wavelength: Wavelength
    """lambda [m], across the crests."""
    angle: Angle = 0.0
    """phi [rad]; zero is transverse: crests along y, across the entrainment."""
    phase: Angle = 0.0
    """psi [rad]; zero puts a crest at the origin."""

    @model_validator(mode="after")
    def _must_be_shallow(self) -> Self:
        check_slope(self.amplitude, wavelength=self.wavelength)
        return self

    @property
    def components(self) -> tuple[WaveVector, ...]:
        """Return the one harmonic."""
        return (_wave_vector(self.amplitude, self.wavelength, self.angle, self.phase),)


class Crossed(HarmonicModel):
    r"""Two waves that cross, as their sum or as their product.

    .. math:: s = A \cos\theta_1 + A_2 \cos\theta_2 \quad\text{or}\quad
              s = A \cos\theta_1 \cos\theta_2, \qquad
              \theta_i = \frac{2\pi}{\lambda_i}(x\cos\varphi_i - y\sin\varphi_i) + \psi_i

    The product with ``angle = 0`` is the isotropic pattern ``A cos(2 pi x/lambda) cos(2 pi
    y/lambda)`` for which amplitude reduction is published [1]_.

    References
    ----------
    .. [1] C. H. Venner and A. A. Lubrecht, Proc. IMechE Part J 214 (2000), 43-62.
    """

    type: Literal["crossed"] = "crossed"
    amplitude: Height
    """A [m]."""
    wavelength: Wavelength
    """Of the first wave [m]."""
    angle: Angle = 0.0
    phase: Angle = 0.0
    """Of the first wave [rad]."""
    amplitude_2: Height | None = None
    """A_2 [m]; None is that of the first wave. The product has one amplitude only."""
    wavelength_2: Wavelength | None = None
    """[m]; None is that of the first wave."""
    angle_2: Angle | None = None
    """[rad]; None is at right angles to the first wave."""
    phase_2: Angle = 0.0
    """[rad]"""
    form: Literal["sum", "product"] = "sum"
    """How the waves combine."""

    @model_validator(mode="after")
    def _must_be_shallow(self) -> Self:
        if self.form == "product" and self.amplitude_2 is not None:
            raise ValueError(
                "amplitude_2 does not apply to a product, which has one amplitude: leave it out or "
                'use form = "sum"'
            )
        check_slope(self.amplitude, wavelength=self.wavelength)
        if self.amplitude_2 is not None:
            check_slope(self.amplitude_2, wavelength_2=self.wavelength_2 or self.wavelength)
        return self

    @property
    def components(self) -> tuple[WaveVector, ...]:
        """Return the harmonics; those of a product run along the sum and difference of both."""
        first = _wave_vector(self.amplitude, self.wavelength, self.angle, self.phase)
        second = _wave_vector(
            self.amplitude if self.amplitude_2 is None else self.amplitude_2,
            self.wavelength if self.wavelength_2 is None else self.wavelength_2,
            self.angle + 0.5 * math.pi if self.angle_2 is None else self.angle_2,
            self.phase_2,
        )
        return (first, second) if self.form == "sum" else _product(first, second)


def _product(first: WaveVector, second: WaveVector) -> tuple[WaveVector, ...]:
    (amplitude, *one), (_, *other) = first, second
    return tuple(
        WaveVector(0.5 * amplitude, *(a + sign * b for a, b in zip(one, other, strict=True)))
        for sign in (1.0, -1.0)
    )


def _wave_vector(amplitude: float, wavelength: float, angle: float, phase: float) -> WaveVector:
    """Return the harmonic with crests ``wavelength`` [m] apart, turned by ``angle`` [rad]."""
    cosine, sine = direction(angle)
    number = 2.0 * math.pi / wavelength
    return WaveVector(amplitude, number * cosine, -number * sine, phase)


def are_even(waves: Sequence[WaveVector]) -> bool:
    """Return whether a sum of harmonics mirrors at y = 0."""
    spectrum = _spectrum(waves)
    mirrored = _spectrum([wave._replace(across=-wave.across) for wave in waves])
    largest = max((wave.amplitude for wave in waves), default=0.0)
    differences = (spectrum.get(key, 0j) - mirrored.get(key, 0j) for key in spectrum | mirrored)
    return all(abs(difference) <= _EQUAL_WAVES * largest for difference in differences)


def _spectrum(waves: Sequence[WaveVector]) -> dict[tuple[int, int], complex]:
    """Return complex amplitudes by wave vector, each vector in the half-plane of positive x."""
    unit = _EQUAL_WAVES * max((wave.number for wave in waves), default=1.0) or 1.0
    spectrum: dict[tuple[int, int], complex] = {}
    for wave in waves:
        key = (round(wave.along / unit), round(wave.across / unit))
        amplitude = wave.amplitude * complex(math.cos(wave.phase), math.sin(wave.phase))
        if key < (0, 0):
            key, amplitude = (-key[0], -key[1]), amplitude.conjugate()
        if key == (0, 0):
            amplitude = complex(amplitude.real)
        spectrum[key] = spectrum.get(key, 0j) + amplitude
    return spectrum


def root_mean_square(waves: Sequence[WaveVector]) -> float:
    """Return the root mean square height of a sum of harmonics over the plane [m]."""
    spectrum = _spectrum(waves).items()
    return math.sqrt(sum(abs(a) ** 2 * (1.0 if key == (0, 0) else 0.5) for key, a in spectrum))
