r"""Transient runs read: what travels with a surface, what a passage does, what is left of a wave.

A wave that passes is flattened less the shorter it is. For pure rolling its amplitude in the film
follows, by a fit to computed contacts,

.. math:: \frac{A_d}{A_i} = \frac{1}{1 + 0.15 f\nabla + 0.015 (f\nabla)^2}, \quad
          \nabla = \frac{\lambda}{a}\sqrt{\frac{M}{L}}

with :math:`\lambda` the shorter one of the wavelengths along x and y, :math:`r = \lambda_x /
\lambda_y`, and :math:`f = e^{1 - 1/r}` for r > 1, else one.

References
----------
.. [1] C. H. Venner and A. A. Lubrecht, Proc. IMechE Part J 214 (2000), 43-62.
"""

import cmath
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tehl.duration import parts_of
from tehl.errors import InputError
from tehl.post.waviness import waves_of
from tehl.roughness import WaveVector
from tehl.typing import Array

if TYPE_CHECKING:
    from tehl.transient_result import TransientResult


MOST_PERIODS = 4
"""Periods at the end of a run over which a passing wave is fitted."""
FEWEST_STEPS = 8
"""Steps of time in a period that a fit needs."""
_WHOLE = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True)
class MovingProfiles:
    """The line y = 0 as somebody on a surface sees it.

    Attributes
    ----------
    offset : (n,) array
        Distance along x from the place that moves along [m].
    place : (nt,) array
        Where that place is at each step [m].
    pressure, film, height : (nt, n) array
        [Pa], [m] and the height of that surface [m]; NaN outside the domain.
    """

    offset: Array
    place: Array
    pressure: Array
    film: Array
    height: Array


@dataclass(frozen=True, kw_only=True, slots=True)
class Envelope:
    """Least and largest values along y = 0 over a passage, (nx,) each.

    Attributes
    ----------
    x : array
        [m].
    film_least, film_largest : array
        [m].
    pressure_least, pressure_largest : array
        [Pa].
    """

    x: Array
    film_least: Array
    film_largest: Array
    pressure_least: Array
    pressure_largest: Array


@dataclass(frozen=True, kw_only=True, slots=True)
class PassingWave:
    """What is left of a wave that passes a place on y = 0.

    Attributes
    ----------
    x : float
        The place [m].
    periods : int
        Periods that were fitted.
    steps_per_period : float
        Steps of time in each of them.
    amplitude : float
        Of the heights, as the grid carries them [m].
    film_amplitude, pressure_amplitude : float
        Of the ripples [m], [Pa].
    film_phase, pressure_phase : float
        Zero where the film is thinnest and the pressure highest under the crests; positive where
        the ripple comes later [rad].
    nabla : float
        (lambda / a) sqrt(M/L) [-].
    published_ratio : float
        Amplitude reduction by the fit for pure rolling [-].
    """

    x: float
    periods: int
    steps_per_period: float
    amplitude: float
    film_amplitude: float
    film_phase: float
    pressure_amplitude: float
    pressure_phase: float
    nabla: float
    published_ratio: float

    @property
    def film_ratio(self) -> float:
        """Return the part of the wave that is left in the film [-]."""
        return self.film_amplitude / self.amplitude


def speed_of(run: "TransientResult", surface: int) -> float:
    """Return the speed of surface 1 or 2 [m/s].

    Raises
    ------
    InputError
        For any other number.
    """
    motion = run.start.problem.motion
    if surface not in (1, 2):
        raise InputError(f"surface = {surface} must be 1 or 2")
    return motion.speed_1 if surface == 1 else motion.speed_2


def moving_profiles(
    run: "TransientResult", surface: int, *, start: float | None = None, reach: float | None = None
) -> MovingProfiles:
    """Return the profiles along y = 0 around a place that moves with a surface.

    Parameters
    ----------
    run : TransientResult
        The run.
    surface : {1, 2}
        Which surface.
    start : float
        Where the place is at time zero [m]; if left out, where the feature of the surface stands,
        and 0 if it has none.
    reach : float
        How far from it profiles go on either side [m]; a half-width of the contact if left out.

    Returns
    -------
    MovingProfiles
        Interpolated linearly between the nodes.

    Raises
    ------
    InputError
        If the surface has several features, or one beside the line y = 0, and ``start`` is not
        given.
    """
    speed, x = speed_of(run, surface), run.x
    start = _place_of_feature(run, surface) if start is None else start
    reach = run.start.scales.half_width_x if reach is None else reach
    if not reach > 0:
        raise InputError(f"reach = {reach} m must be positive")
    count = round(reach / (x[1] - x[0]))
    offset = np.linspace(-reach, reach, 2 * max(count, 1) + 1)
    place = start + speed * run.history.time
    lines = (run.profiles.pressure, run.profiles.film, getattr(run.profiles, f"height_{surface}"))
    pressure, film, height = (
        np.stack(
            [
                np.interp(here + offset, x, line, left=np.nan, right=np.nan)
                for here, line in zip(place, lines_in_time, strict=True)
            ]
        )
        for lines_in_time in lines
    )
    return MovingProfiles(offset=offset, place=place, pressure=pressure, film=film, height=height)


def _place_of_feature(run: "TransientResult", surface: int) -> float:
    """Return where the feature of a surface stands at time zero [m].

    Raises
    ------
    InputError
        If it has several, or the line y = 0 does not see it.
    """
    name = f"surface_{surface}"
    parts = [one for one in parts_of(run.start.scaled_problem) if one.surface == name]
    features = [one for one in parts if not one.is_endless]
    if not features:
        return 0.0
    if len(features) > 1:
        raise InputError(f"{name} has {len(features)} features: say around which place, start")
    feature = features[0].roughness
    y, (first, last) = float(getattr(feature, "y", 0.0)), features[0].extent[1]
    if not abs(y) <= 0.25 * (last - first):
        raise InputError(
            f"the {feature.type} of {name} stands at y = {y:g} m, beside the line y = 0 whose "
            "profiles are kept: read its fields (tehl.post.instant.film_at)"
        )
    return float(getattr(feature, "x", 0.0))


def envelope(run: "TransientResult", *, since: float = 0.0, until: float = math.inf) -> Envelope:
    """Return the least and largest film and pressure along y = 0 over a passage.

    Parameters
    ----------
    run : TransientResult
        The run.
    since, until : float
        First and last time that counts [s].

    Raises
    ------
    InputError
        If no step lies between them.
    """
    inside = (run.history.time >= since) & (run.history.time <= until)
    if not inside.any():
        raise InputError(
            f"no step lies between {since:g} s and {until:g} s: the run ends at "
            f"{run.history.time[-1]:g} s"
        )
    film, pressure = run.profiles.film[inside], run.profiles.pressure[inside]
    return Envelope(
        x=run.x,
        film_least=film.min(axis=0),
        film_largest=film.max(axis=0),
        pressure_least=pressure.min(axis=0),
        pressure_largest=pressure.max(axis=0),
    )


def passing_wave(run: "TransientResult", surface: int, *, x: float = 0.0) -> PassingWave:
    """Return what is left of the wave of a surface at a place that it passes.

    A harmonic, its overtone, a mean and a drift are fitted to film, pressure and height at the
    place over the last whole periods, four of them at most.

    Parameters
    ----------
    run : TransientResult
        Of a surface with a ``wave`` or crossed waves.
    surface : {1, 2}
        Which surface.
    x : float
        Where on y = 0 [m].

    Raises
    ------
    InputError
        If the surface has no wave that passes, if no whole period is left after the wave has come
        to the place, or if there are too few steps in a period.
    """
    speed, wave = speed_of(run, surface), _wave(run, surface)
    rate = abs(wave.along * speed)
    if not rate > 0:
        raise InputError(f"the wave of surface_{surface} does not pass: it lies along x or stands")
    period, time = 2.0 * math.pi / rate, run.history.time
    steps = period / run.time_step
    if steps < FEWEST_STEPS:
        raise InputError(
            f"a period of the wave of surface_{surface} has {steps:.3g} steps of time, and a fit "
            f"takes {FEWEST_STEPS} or more: take more nodes"
        )
    left = time[-1] - _arrival(run, surface, x)
    periods = min(math.floor(left / period + _WHOLE), MOST_PERIODS)
    if periods < 1:
        raise InputError(
            f"the wave of surface_{surface} has been at x = {x:g} m for "
            f"{max(left, 0.0) / period:.2g} of a period: let transient.duration be longer"
        )
    fit = _TimeFit.over(time, time[-1] - periods * period, rate)
    height, film, pressure = (
        fit.amplitude(_at(run, line, x))
        for line in (
            getattr(run.profiles, f"height_{surface}"),
            run.profiles.film,
            run.profiles.pressure,
        )
    )
    number = nabla_of(run, wave)
    return PassingWave(
        x=x,
        periods=periods,
        steps_per_period=steps,
        amplitude=abs(height),
        film_amplitude=abs(film),
        film_phase=_later(film / -height),
        pressure_amplitude=abs(pressure),
        pressure_phase=_later(pressure / height),
        nabla=number,
        published_ratio=amplitude_reduction(number, ratio=_ratio(wave)),
    )


def amplitude_reduction(nabla: float, *, ratio: float = 1.0) -> float:
    """Return the published part of a wave that is left in the film, for pure rolling [-].

    Parameters
    ----------
    nabla : float
        (lambda / a) sqrt(M/L) [-].
    ratio : float
        Wavelength along x over that along y [-]; zero for a transverse wave.
    """
    scaled = nabla * (math.exp(1.0 - 1.0 / ratio) if ratio > 1.0 else 1.0)
    return 1.0 / (1.0 + 0.15 * scaled + 0.015 * scaled**2)


def nabla_of(run: "TransientResult", wave: WaveVector) -> float:
    """Return (lambda / a) sqrt(M/L) [-], lambda the shorter one of those along x and y."""
    groups, half_width = run.start.groups, run.start.scales.half_width_x
    number = max(abs(wave.along), abs(wave.across))
    return 2.0 * math.pi / (number * half_width) * math.sqrt(groups.M / groups.L)


def _ratio(wave: WaveVector) -> float:
    """Return the wavelength along x over that along y."""
    return abs(wave.across / wave.along)


def _wave(run: "TransientResult", surface: int) -> WaveVector:
    """Return the one wave of a surface, or one of several that pass equally often."""
    roughness = getattr(run.start.problem, f"surface_{surface}").roughness
    waves = list(waves_of(roughness))
    if not waves:
        raise InputError(f"surface_{surface} has no wave: its roughness is {roughness.type}")
    if not all(math.isclose(abs(one.along), abs(waves[0].along)) for one in waves):
        raise InputError(f"surface_{surface} has waves of several lengths along x: fit one of them")
    return waves[0]


def _arrival(run: "TransientResult", surface: int, x: float) -> float:
    """Return when a wave that comes in from the inlet has come to ``x`` in full [s]."""
    transient, speed = run.start.problem.transient, speed_of(run, surface)
    if transient is None or transient.start == "standing":
        return 0.0
    front = transient.entrance * run.start.scales.half_width_x
    wave = _wave(run, surface)
    faded = min(2.0 * math.pi / abs(wave.along), 0.5 * front)
    return (math.copysign(x, x * speed) + front + faded) / abs(speed)


def _at(run: "TransientResult", line: Array, x: float) -> Array:
    """Return a line in time at one place, interpolated."""
    if not run.x[0] <= x <= run.x[-1]:
        raise InputError(f"x = {x:g} m lies outside the domain, {run.x[0]:g} to {run.x[-1]:g} m")
    return np.array([np.interp(x, run.x, values) for values in line])


@dataclass(frozen=True, slots=True)
class _TimeFit:
    """The steps of a fit, and the rows of its inverse matrix that give the harmonic."""

    inside: slice
    rows: Array

    @classmethod
    def over(cls, time: Array, since: float, rate: float) -> "_TimeFit":
        first = int(np.searchsorted(time, since - 1e-9 * abs(time[-1])))
        t = time[first:]
        drift = (t - t.mean()) / max(np.ptp(t), 1e-300)
        columns = [np.cos(rate * t), np.sin(rate * t), np.cos(2 * rate * t), np.sin(2 * rate * t)]
        matrix = np.stack([*columns, np.ones_like(t), drift], axis=1)
        return cls(slice(first, None), np.linalg.pinv(matrix)[:2])

    def amplitude(self, values: Array) -> complex:
        """Return the complex amplitude of ``cos(rate t)`` in values of all times."""
        cosine, sine = self.rows @ values[self.inside]
        return complex(cosine, -sine)


def _later(ratio: complex) -> float:
    """Return how much later a ripple comes than what it is divided by [rad]."""
    return -cmath.phase(ratio) + 0.0
