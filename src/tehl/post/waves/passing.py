"""Amplitude of a wave that passes a place, fitted in time, beside `tehl.estimate.wave_theory`."""

import math
from dataclasses import dataclass

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.transient import MOTION
from tehl.estimate.wave_theory import amplitude_reduction, nabla_of, waves_of
from tehl.post.waves.response import Ripple, ripple
from tehl.result.transient import TransientSolution
from tehl.roughness import WaveVector

FEWEST_STEPS = 8
"""Time steps per period that a fit needs."""
_WHOLE_NUMBER_TOLERANCE = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True)
class PassingWave(Ripple):
    """Amplitudes of a wave that passes a place on y = 0."""

    x: float
    """The place [m]."""
    periods: int
    """Number of fitted periods."""
    steps_per_period: float
    """Time steps in each of them."""
    nabla: float
    """(lambda / a) sqrt(M/L) [-]."""
    published_ratio: float
    """Amplitude reduction by the fit for pure rolling [-]."""


def passing_wave(run: TransientSolution, surface: int, *, x: float = 0.0) -> PassingWave:
    """Return the amplitudes of the wave of a surface at a place that it passes.

    A harmonic, its overtone, a mean and a drift are fitted to film, pressure and height at the
    place over the last whole periods, at most four.

    Parameters
    ----------
    run : TransientSolution
        Of a surface with a ``wave`` or crossed waves.
    surface : {1, 2}
        Which surface.
    x : float
        Place on y = 0 [m].

    Raises
    ------
    InputError
        If no wave of the surface passes, if less than a period remains after the wave has reached
        the place, or if there are too few steps in a period.
    """
    transient = run.start.problem.transient
    if transient is not None and any(getattr(transient, key) for key in MOTION):
        raise InputError("the surfaces change their speeds: a wave has no period to fit")
    velocity = run.start.problem.motion.velocity_of(surface)
    wave = _wave(run, surface, velocity)
    rate = abs(wave.rate(velocity))
    periods, steps = _periods(run, surface, (wave, rate), x)
    harmonic = _harmonic(run.history.time, rate, periods)
    if not run.x[0] <= x <= run.x[-1]:
        raise InputError(f"x = {x:g} m: outside the domain, {run.x[0]:g} to {run.x[-1]:g} m")
    profiles, count = run.profiles, harmonic.shape[1]
    amplitudes = (
        complex(*(harmonic @ [np.interp(x, run.x, line) for line in lines[-count:]])).conjugate()
        for lines in (getattr(profiles, f"height_{surface}"), profiles.film, profiles.pressure)
    )
    shorter = 2.0 * math.pi / max(abs(wave.along), abs(wave.across))  # of those along x and y
    groups = run.start.groups
    nabla = nabla_of(shorter / run.start.scales.half_width_x, groups.M, groups.L)
    return PassingWave(
        **ripple(amplitudes),
        x=x,
        periods=periods,
        steps_per_period=steps,
        nabla=nabla,
        published_ratio=amplitude_reduction(
            nabla, ratio=abs(wave.across / wave.along) if wave.along else math.inf
        ),
    )


def _wave(run: TransientSolution, surface: int, velocity: tuple[float, float]) -> WaveVector:
    """Return the wave of a surface, or one of several that pass at one frequency."""
    roughness = getattr(run.start.problem, f"surface_{surface}").roughness
    waves = list(waves_of(roughness))
    if not waves:
        raise InputError(f"surface_{surface} has no wave to fit: its roughness is {roughness.type}")
    first, *others = (abs(one.rate(velocity)) for one in waves)
    if not all(math.isclose(one, first) for one in others):
        raise InputError(
            f"surface_{surface} has waves that pass at several frequencies: a fit needs one alone"
        )
    return waves[0]


def _periods(
    run: TransientSolution, surface: int, passing: tuple[WaveVector, float], x: float
) -> tuple[int, float]:
    """Return the whole periods to fit, the last four at most, and the time steps in each."""
    wave, rate = passing
    if not rate > 0:
        raise InputError(
            f"the wave of surface_{surface} does not pass: it moves along its crests, or stands"
        )
    period = 2.0 * math.pi / rate
    steps = period / run.time_step
    if steps < FEWEST_STEPS:
        raise InputError(
            f"a period of the wave of surface_{surface} has {steps:.3g} time steps: a fit needs "
            f"{FEWEST_STEPS} or more; take more nodes"
        )
    left = (float(run.history.time[-1]) - _arrival(run, surface, wave, x)) / period
    if math.floor(left + _WHOLE_NUMBER_TOLERANCE) < 1:
        raise InputError(
            f"the wave of surface_{surface} has been at x = {x:g} m for {max(left, 0.0):.2g} "
            "periods: a fit needs one or more; increase transient.duration"
        )
    return min(math.floor(left + _WHOLE_NUMBER_TOLERANCE), 4), steps


def _arrival(run: TransientSolution, surface: int, wave: WaveVector, x: float) -> float:
    """Return when a wave that enters at the inlet has reached ``x`` in full [s]."""
    problem = run.start.problem
    transient, speed = problem.transient, problem.motion.speed_of(surface)
    if transient is None or transient.start == "standing":
        return 0.0
    front = transient.entrance * run.start.scales.half_width_x
    along = abs(wave.along)
    fade_in = min(2.0 * math.pi / along, 0.5 * front) if along else 0.5 * front
    if speed == 0.0:
        return math.inf
    return (math.copysign(x, x * speed) + front + fade_in) / abs(speed)


def _harmonic(time: Array, rate: float, periods: int) -> Array:
    """Return the rows of a least-squares fit that give cosine and sine of ``rate t``.

    They apply to the last whole periods; overtone, mean and drift are fitted too.
    """
    since = time[-1] - 2.0 * math.pi * periods / rate
    t = time[int(np.searchsorted(time, since - 1e-9 * abs(time[-1]))) :]
    drift = (t - t.mean()) / max(np.ptp(t), 1e-300)
    columns = [np.cos(rate * t), np.sin(rate * t), np.cos(2 * rate * t), np.sin(2 * rate * t)]
    return np.linalg.pinv(np.stack([*columns, np.ones_like(t), drift], axis=1))[:2]
