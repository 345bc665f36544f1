"""Ripples of the waves of the surfaces in the middle of a contact, by least squares."""

import cmath
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from tehl.base.typing import Array, BoolArray
from tehl.contact.problem import ContactProblem
from tehl.estimate.wave_theory import (
    FlatFilm,
    LinearTheory,
    Velocity,
    bulk_modulus,
    drift_of_heights,
    drifting_waves,
    why_no_theory,
)
from tehl.post.heat import mean_temperature
from tehl.post.waves.search import distinct_waves
from tehl.result.solution import Solution
from tehl.roughness import Map, Random, WaveVector

FIT_HALF_WIDTH = 0.4
"""Half-widths on each side of the centre in which waves are fitted: the pressure is even there."""
LEAST_WAVES = 1.5
"""Waves in that square below which a wave cannot be separated from the shape of the film."""
_TURN = 0.25
"""Part of a wave in that square below which it is the same as one along an axis."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Ripple:
    """Ripples of film and pressure over a wave of the heights."""

    amplitude: float
    """Of the heights, as the grid carries them [m]."""
    film_amplitude: float
    """Of the ripples [m], [Pa]."""
    film_phase: float
    """Zero where crests have the thinnest film and the highest pressure; positive where the ripple
    lies behind, along the wave vector or in time [rad]."""
    pressure_amplitude: float
    """Of the ripples [m], [Pa]."""
    pressure_phase: float
    """Zero where crests have the thinnest film and the highest pressure; positive where the ripple
    lies behind, along the wave vector or in time [rad]."""

    @property
    def film_ratio(self) -> float:
        """Return the part of the wave that is left in the film [-]."""
        return self.film_amplitude / self.amplitude


def ripple(amplitudes: Iterable[complex]) -> dict[str, float]:
    """Return the fields of :class:`Ripple` of complex height, film [m] and pressure [Pa]."""
    height, film, pressure = amplitudes
    return {
        "amplitude": abs(height),
        "film_amplitude": abs(film),
        "film_phase": -cmath.phase(film / -height) + 0.0,
        "pressure_amplitude": abs(pressure),
        "pressure_phase": -cmath.phase(pressure / height) + 0.0,
    }


@dataclass(frozen=True, kw_only=True, slots=True)
class WaveResponse(Ripple):
    """One wave of the surfaces, and its ripples in the middle of the contact."""

    wavelength: float
    """Across the crests [m]."""
    angle: float
    """Zero: crests across the entrainment; between -pi/2 and pi/2 [rad]."""
    points_per_wave: float
    """Nodes on a wave, along the axis that has fewer [-]."""
    carried_amplitude: float
    """Of the streaks along x that the film brings from the inlet [m]; zero where crests lie across
    or along the entrainment, or nearly so."""
    theory: LinearTheory
    """Ripples by linear theory, where it holds (`tehl.estimate.wave_theory.why_no_theory`)."""


def wave_responses(result: Solution, smooth: Solution | None = None) -> tuple[WaveResponse, ...]:
    """Return how film and pressure respond to each wave of the surfaces.

    Waves are those of ``wave`` and ``crossed`` surfaces, alone or in a sum; of measured and random
    surfaces those that stand out of the heights in the contact, often none. Ripples are fitted by
    least squares where ``|X|, |Y| < 0.4``, together with a quadratic background and with the
    streaks that an oblique wave makes in the inlet and the film carries along x.

    Parameters
    ----------
    result : Solution
        Of a rough contact; others have no waves.
    smooth : Solution or None
        The same contact with smooth surfaces on the same grid, which is subtracted first.

    Returns
    -------
    tuple of WaveResponse
        Without the waves that are too long to be separated from the shape of the film;
        :func:`wave_notes` names them.
    """
    found = _Waves.of(result)
    if found is None or not found.fitted:
        return ()
    patch, waves = found.patch, found.fitted
    film, pressure = result.film_thickness, result.pressure
    if smooth is not None:
        film, pressure = film - smooth.film_thickness, pressure - smooth.pressure
    fit = patch.fit(waves)
    cuts = [patch.cut(field) for field in (found.heights, film, pressure)]
    level = _flat_film(result, patch)
    return tuple(
        WaveResponse(
            **ripple(amplitudes),
            wavelength=wave.wavelength,
            angle=wave.angle,
            points_per_wave=patch.points_per_wave(wave),
            carried_amplitude=fit.carried(cuts[1], wave),
            theory=found.theory(wave, level, abs(amplitudes[0])),
        )
        for wave, *amplitudes in zip(waves, *map(fit.ripples, cuts), strict=True)
        if abs(amplitudes[0]) > 0
    )


def wave_notes(result: Solution) -> tuple[str, ...]:
    """Return what :func:`wave_responses` leaves out and why, a sentence each."""
    found = _Waves.of(result)
    if found is None:
        return ()
    patch = found.patch
    notes = [patch.too_long(wave) for wave in found.all if wave not in found.fitted]
    if not found.all and _is_searched(result.problem):
        notes.append("no wave stands out of the heights in the contact: they are broad-band")
    why = why_no_theory(result.problem)
    if found.drift is None and not found.stated:
        why = why or "no theory: it is not known which of two surfaces that move apart has the wave"
    if why and any(patch.straight(wave).along for wave in found.fitted):
        notes.append(why)
    return tuple(notes)


@dataclass(frozen=True, slots=True)
class _Waves:
    """The waves of the surfaces of a result: stated ones, else those found in the heights."""

    problem: ContactProblem
    heights: Array
    patch: "_Patch"
    stated: dict[WaveVector, Velocity]
    all: list[WaveVector]
    drift: Velocity | None  # of found waves, less the mean one [m/s]

    @classmethod
    def of(cls, result: Solution) -> "_Waves | None":
        if result.heights is None:
            return None
        patch, heights = _Patch.of(result), result.heights.together
        stated = dict(drifting_waves(result.problem))
        waves = list(stated) or _standing_out(result, heights, patch)
        drift = drift_of_heights(result.problem)
        return cls(result.problem, heights, patch, stated, waves, drift)

    @property
    def fitted(self) -> list[WaveVector]:
        """Waves of which enough lies in the patch."""
        return [wave for wave in self.all if self.patch.holds(wave)]

    def theory(self, wave: WaveVector, level: FlatFilm, amplitude: float) -> LinearTheory:
        """Return the ripples of a wave by theory.

        Parameters
        ----------
        wave : WaveVector
            Stated or found.
        level : FlatFilm
            Film and oil in the middle of the contact.
        amplitude : float
            Of the undeformed wave [m].
        """
        drift, straight = self.stated.get(wave, self.drift), self.patch.straight(wave)
        if drift is None:
            standing = -self.problem.entrainment_speed, 0.0
            return level.theory(straight, amplitude, standing, holds=False)
        holds = why_no_theory(self.problem) is None
        return level.theory(straight, amplitude, drift, holds=holds)


def _is_searched(problem: ContactProblem) -> bool:
    """Return whether a surface may have waves that it does not state."""
    parts = (part for one in problem.surfaces for part in one.roughness.summands)
    return any(isinstance(part, Map | Random) for part in parts)


def _standing_out(result: Solution, heights: Array, patch: "_Patch") -> list[WaveVector]:
    """Return the waves of surfaces that state none, also those too long for the patch."""
    if not _is_searched(result.problem):
        return []
    width_x, width_y = patch.half_widths

    def vector(along: float, across: float) -> WaveVector:
        return WaveVector(1.0, along / width_x, across / width_y, 0.0)

    found = distinct_waves(
        result.scaled.x,
        result.scaled.y,
        heights,
        lambda wave: patch.holds(vector(wave.along, wave.across)),
    )
    return [vector(wave.along, wave.across) for wave in found]


@dataclass(frozen=True, slots=True)
class _Patch:
    """The middle of the contact: coordinates in metres, and in half-widths."""

    rows: BoolArray
    columns: BoolArray
    x: Array
    y: Array
    half_widths: tuple[float, float]

    @classmethod
    def of(cls, result: Solution) -> "_Patch":
        columns, rows = (
            np.abs(axis) <= FIT_HALF_WIDTH for axis in (result.scaled.x, result.scaled.y)
        )
        widths = (result.scales.half_width_x, result.scales.half_width_y)
        return cls(rows, columns, result.x[columns], result.y[rows], widths)

    def cut(self, field: Array) -> Array:
        return field[np.ix_(self.rows, self.columns)]

    def counts(self, wave: WaveVector) -> tuple[float, float]:
        """Return how many waves lie in the patch along both axes."""
        width_x, width_y = (FIT_HALF_WIDTH * width / math.pi for width in self.half_widths)
        return abs(wave.along) * width_x, abs(wave.across) * width_y

    def holds(self, wave: WaveVector) -> bool:
        """Return whether enough of a wave lies in the patch."""
        return sum(self.counts(wave)) >= LEAST_WAVES

    def too_long(self, wave: WaveVector) -> str:
        """Return why a wave has no ripples."""
        return (
            f"{1e6 * wave.wavelength:.4g} um at {math.degrees(wave.angle) + 0.0:.3g} deg is too "
            f"long to part from the shape of the film: {sum(self.counts(wave)):.3g} waves where "
            f"|X|, |Y| < {FIT_HALF_WIDTH:g}, and it takes {LEAST_WAVES:g}"
        )

    def straight(self, wave: WaveVector) -> WaveVector:
        """Return a wave with crests along the entrainment if it nearly has them.

        Where it turns by less than a quarter of its phase, what the inlet carries along x looks
        like the wave itself.
        """
        return wave if self.counts(wave)[0] >= _TURN else wave._replace(along=0.0)

    def points_per_wave(self, wave: WaveVector) -> float:
        steps = [np.ptp(axis) / max(axis.size - 1, 1) for axis in (self.x, self.y)]
        phase = max(abs(wave.along) * steps[0], abs(wave.across) * steps[1])
        return float(2.0 * math.pi / phase)

    def fit(self, waves: Sequence[WaveVector]) -> "_Fit":
        """Return a least-squares fit of ``waves``, their streaks and a quadratic background."""
        x, y = (axis.ravel() for axis in np.meshgrid(self.x, self.y))
        # Less than a quarter of a streak is part of the quadratic background.
        wide = (wave for wave in waves if self.counts(wave)[1] >= _TURN or not wave.along)
        streaks = _streaks([self.straight(wave) for wave in wide])
        phases = [wave.along * x + wave.across * y + wave.phase for wave in waves]
        phases += [number * y for number in streaks]
        columns = [function(phase) for phase in phases for function in (np.cos, np.sin)]
        unit_x, unit_y = x / self.half_widths[0], y / self.half_widths[1]
        columns += [unit_x**i * unit_y**j for i in range(3) for j in range(3 - i)]
        return _Fit(np.linalg.pinv(np.stack(columns, axis=1)), len(waves), streaks)


def _streaks(waves: Sequence[WaveVector]) -> list[float]:
    """Return the wave numbers across of the streaks that oblique waves make, each once."""
    longitudinal = [abs(wave.across) for wave in waves if not wave.along]
    found: list[float] = []
    for number in (abs(wave.across) for wave in waves if wave.along and wave.across):
        if not any(math.isclose(number, other) for other in longitudinal + found):
            found.append(number)
    return found


@dataclass(frozen=True, slots=True)
class _Fit:
    """The inverse of the matrix of a fit, and what its first rows are."""

    inverse: Array
    waves: int
    streaks: list[float]

    def ripples(self, field: Array) -> list[complex]:
        """Return the complex amplitude of each wave, relative to its phase."""
        return self._pairs(field)[: self.waves]

    def carried(self, field: Array, wave: WaveVector) -> float:
        """Return the amplitude of the streaks that belong to a wave.

        Parameters
        ----------
        field : Array
            Film or pressure in the patch.
        wave : WaveVector
            A transverse one has its own streaks; one without variation along x has none.
        """
        pairs = zip(self._pairs(field)[self.waves :], self.streaks, strict=True)
        own = (abs(p) for p, number in pairs if math.isclose(number, abs(wave.across)))
        return next(own, 0.0) if wave.along else 0.0

    def _pairs(self, field: Array) -> list[complex]:
        count = 2 * (self.waves + len(self.streaks))
        values = self.inverse[:count] @ field.ravel()
        return [complex(c, -s) for c, s in zip(values[::2], values[1::2], strict=True)]


def _flat_film(result: Solution, patch: _Patch) -> FlatFilm:
    """Return the means of a film over the patch."""
    pressure = float(patch.cut(result.pressure).mean())
    temperature = result.scales.temperature
    if result.heat is not None:
        temperature = float(patch.cut(mean_temperature(result.heat)).mean())
    thinning = 1.0 if result.shear is None else float(patch.cut(result.shear.thinning).mean())
    oil = result.problem.lubricant
    return FlatFilm(
        film=float(patch.cut(result.film_thickness).mean()),
        bulk_modulus=bulk_modulus(oil.density, pressure, temperature),
        viscosity=thinning * float(oil.viscosity.viscosity(np.array(pressure), temperature)),
        reduced_modulus=result.problem.reduced_modulus,
    )
