r"""Waves of the surfaces in film and pressure: how much of each is left, and what theory expects.

A wave :math:`s = A\cos(\mathbf{w}\cdot\mathbf{x} + \psi)` of the height stands in the flat part of
a contact. There linear theory gives the ripple of film and pressure, with
:math:`\kappa = |\mathbf{w}|`:

.. math:: \frac{\hat p}{A} = -\frac{\kappa E'}{4}\,\frac{iQ}{1 - iQ - iCQ}, \quad
          \frac{\hat h}{A} = -1 - \frac{iQ}{1 - iQ - iCQ}, \quad
          C = \frac{h E' \kappa}{4B}, \quad Q = \frac{48\,\eta\,(u_s - u_m) w_x}{E' h^3 \kappa^3}

B is the bulk modulus and u_s the speed of the wave, zero for one that stands. The viscosity in a
contact is so large that Q is as good as infinite unless crests lie along the entrainment or move
with the mean speed: ``C/(1 + C)`` of the wave is left in the film, and the pressure carries
``1/(1 + C)`` of what flattens the whole wave.

All of that is for an isothermal film of Newtonian oil. An oil that thins under shear has another
viscosity for ripples than for the mean flow, heat has one for each layer, and both let more or less
of the wave through: beside such films there is no theory.

References
----------
.. [1] G. E. Morales-Espejel and V. Brizmer, Tribology Transactions 54 (2011), 625-643, after
   C. J. Hooke (2006).
.. [2] J. A. Greenwood and G. E. Morales-Espejel, Proc. IMechE Part J 208 (1994), 121-132.
"""

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tehl.lubricant.density import DensityLaw
from tehl.post.wave_search import distinct_waves
from tehl.problem import ContactProblem
from tehl.roughness import AnyRoughness, Map, Random, Sum, WaveVector
from tehl.roughness.waves import HarmonicModel
from tehl.typing import Array, BoolArray

if TYPE_CHECKING:
    from tehl.result import Result


REACH = 0.4
"""Half-widths on each side of the centre in which waves are fitted: the pressure is even there."""
FEWEST = 1.5
"""Waves that must lie in that square to be told from the shape of the film."""
_TURN = 0.25
_STEP = 1e5


@dataclass(frozen=True, kw_only=True, slots=True)
class LinearTheory:
    """Ripples that linear theory expects of a wave.

    Attributes
    ----------
    compressibility : float
        C = h E' kappa / (4 B) [-].
    film_ratio : float or None
        Amplitude of the film over that of the wave [-]; None where the theory does not hold.
    pressure : float or None
        Amplitude of the pressure [Pa]; None where the theory does not hold.
    elastic_pressure : float
        Pressure that flattens the whole wave, pi E' A / (2 lambda) [Pa].
    """

    compressibility: float
    film_ratio: float | None
    pressure: float | None
    elastic_pressure: float

    @property
    def left_to_inlet(self) -> bool:
        """Return whether the pressure leaves the wave alone, so that the inlet decides."""
        return self.pressure == 0


@dataclass(frozen=True, kw_only=True, slots=True)
class WaveResponse:
    """One wave of the surfaces, and its ripples in the middle of the contact.

    Attributes
    ----------
    wavelength : float
        Across the crests [m].
    angle : float
        Zero: crests across the entrainment; between -pi/2 and pi/2 [rad].
    amplitude : float
        Of the heights, as the grid carries them [m].
    points_per_wave : float
        Nodes on a wave, along the axis that has fewer [-].
    film_amplitude, pressure_amplitude : float
        Of the ripples [m], [Pa].
    film_phase, pressure_phase : float
        Zero where crests have the thinnest film and the highest pressure; positive where the
        ripple comes after, along the wave vector [rad].
    carried_amplitude : float
        Of the streaks along x that the film brings from the inlet [m]; zero where crests lie
        across or along the entrainment, or nearly so.
    theory : LinearTheory
        What linear theory expects, where it holds (:func:`why_no_theory`).
    """

    wavelength: float
    angle: float
    amplitude: float
    points_per_wave: float
    film_amplitude: float
    film_phase: float
    pressure_amplitude: float
    pressure_phase: float
    carried_amplitude: float
    theory: LinearTheory

    @property
    def film_ratio(self) -> float:
        """Return the part of the wave that is left in the film [-]."""
        return self.film_amplitude / self.amplitude


def wave_responses(result: "Result", smooth: "Result | None" = None) -> tuple[WaveResponse, ...]:
    """Return how film and pressure respond to each wave of the surfaces.

    Waves are those of ``wave`` and ``crossed`` surfaces, alone or in a sum; of measured and random
    surfaces those that stand out of the heights in the contact, often none. Ripples are fitted by
    least squares where ``|X|, |Y| < 0.4``, together with a quadratic background and with the
    streaks that an oblique wave makes in the inlet and the film carries along x.

    Parameters
    ----------
    result : Result
        Of a rough contact; others have no waves.
    smooth : Result or None
        The same contact with smooth surfaces on the same grid, which is subtracted first.

    Returns
    -------
    tuple of WaveResponse
        Waves that are too long to be told from the shape of the film are left out;
        :func:`wave_notes` names them.
    """
    if result.heights is None:
        return ()
    patch = _Patch.of(result)
    heights = patch.cut(result.heights.together)
    known = dict(drifting_waves(result.problem))
    waves = [wave for wave in known or _standing_out(result, patch) if patch.holds(wave)]
    if not waves:
        return ()
    fit = patch.fit(waves)
    film, pressure = result.film_thickness, result.pressure
    if smooth is not None:
        film, pressure = film - smooth.film_thickness, pressure - smooth.pressure
    fields = (heights, patch.cut(film), patch.cut(pressure))
    ripples = [fit.ripples(field) for field in fields]
    level = _flat_film(result, patch)
    drift = drift_of_found(result.problem)
    holds = why_no_theory(result.problem) is None
    return tuple(
        WaveResponse(
            **_place(wave, patch),
            **_ripple(*(pairs[n] for pairs in ripples)),
            carried_amplitude=fit.carried(fields[1], wave),
            theory=level.theory(
                patch.straight(wave),
                abs(ripples[0][n]),
                known.get(wave, -result.scales.speed if drift is None else drift),
                holds=holds and (wave in known or drift is not None),
            ),
        )
        for n, wave in enumerate(waves)
        if abs(ripples[0][n]) > 0
    )


def wave_notes(result: "Result") -> tuple[str, ...]:
    """Return what :func:`wave_responses` leaves out and why, a sentence each.

    Parameters
    ----------
    result : Result
        Of a rough contact; of others there is nothing to say.
    """
    if result.heights is None:
        return ()
    patch = _Patch.of(result)
    known = dict(drifting_waves(result.problem))
    waves = list(known) or _standing_out(result, patch)
    notes = [patch.too_long(wave) for wave in waves if not patch.holds(wave)]
    if not waves and _is_searched(result.problem):
        notes.append("no wave stands out of the heights in the contact: they are broad-band")
    told = [patch.straight(wave) for wave in waves if patch.holds(wave)]
    why = why_no_theory(result.problem)
    if not known and drift_of_found(result.problem) is None:
        why = why or "no theory: it is not known which of two surfaces that move apart has the wave"
    if why and any(wave.along for wave in told):
        notes.append(why)
    return tuple(notes)


def why_no_theory(problem: ContactProblem) -> str | None:
    """Return why linear theory says nothing of the waves in a film; None where it does."""
    law = problem.lubricant.shear.law
    parts = [] if law == "newtonian" else [f"shear-thinning ({law})"]
    if problem.thermal is not None:
        parts.append("heated")
    if not parts:
        return None
    return f"no theory: it is for isothermal Newtonian films, and this one is {' and '.join(parts)}"


def drift_of_found(problem: ContactProblem) -> float | None:
    """Return the speed of waves that are found in the heights, less the mean speed [m/s].

    None where both surfaces may have them and move apart. Without ``transient`` they stand still.
    """
    motion = problem.motion
    if problem.transient is None:
        return -motion.entrainment_speed
    surfaces = ((problem.surface_1, motion.speed_1), (problem.surface_2, motion.speed_2))
    speeds = {speed for one, speed in surfaces if not one.roughness.is_smooth}
    return speeds.pop() - motion.entrainment_speed if len(speeds) == 1 else None


def drifting_waves(problem: ContactProblem) -> Iterator[tuple[WaveVector, float]]:
    """Yield each harmonic of both surfaces, and its speed less the mean speed [m/s].

    Parameters
    ----------
    problem : ContactProblem
        Without ``transient`` its waves stand still.
    """
    motion = problem.motion
    speeds = (0.0, 0.0) if problem.transient is None else (motion.speed_1, motion.speed_2)
    for surface, speed in zip((problem.surface_1, problem.surface_2), speeds, strict=True):
        for wave in waves_of(surface.roughness):
            yield wave, speed - motion.entrainment_speed


def waves_of(roughness: AnyRoughness) -> Iterator[WaveVector]:
    """Yield the harmonics of a surface that consists of waves, wholly or in part."""
    if isinstance(roughness, HarmonicModel):
        yield from (wave for wave in roughness.components if wave.amplitude > 0)
    elif isinstance(roughness, Sum):
        for part in roughness.parts:
            yield from waves_of(part)


def _is_searched(problem: ContactProblem) -> bool:
    """Return whether a surface may have waves that it does not state."""
    parts = (problem.surface_1.roughness, problem.surface_2.roughness)
    return any(map(_may_hold_waves, parts))


def _may_hold_waves(roughness: AnyRoughness) -> bool:
    if isinstance(roughness, Sum):
        return any(map(_may_hold_waves, roughness.parts))
    return isinstance(roughness, Map | Random)


def _standing_out(result: "Result", patch: "_Patch") -> list[WaveVector]:
    """Return the waves of surfaces that state none, also those too long for the patch."""
    if result.heights is None or not _is_searched(result.problem):
        return []
    width_x, width_y = patch.half_widths

    def vector(along: float, across: float) -> WaveVector:
        return WaveVector(1.0, along / width_x, across / width_y, 0.0)

    found = distinct_waves(
        result.scaled.x,
        result.scaled.y,
        result.heights.together,
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
    def of(cls, result: "Result") -> "_Patch":
        columns, rows = (np.abs(axis) <= REACH for axis in (result.scaled.x, result.scaled.y))
        widths = (result.scales.half_width_x, result.scales.half_width_y)
        return cls(rows, columns, result.x[columns], result.y[rows], widths)

    def cut(self, field: Array) -> Array:
        return field[np.ix_(self.rows, self.columns)]

    def counts(self, wave: WaveVector) -> tuple[float, float]:
        """Return how many waves lie in the patch along both axes."""
        lengths = (2.0 * REACH * width for width in self.half_widths)
        along, across = (
            abs(number) * length / (2.0 * math.pi)
            for number, length in zip((wave.along, wave.across), lengths, strict=True)
        )
        return along, across

    def holds(self, wave: WaveVector) -> bool:
        """Return whether enough of a wave lies in the patch."""
        return sum(self.counts(wave)) >= FEWEST

    def too_long(self, wave: WaveVector) -> str:
        """Return why the ripples of a wave are not told."""
        length, angle = 2e6 * math.pi / wave.number, math.degrees(angle_of(wave)) + 0.0
        return (
            f"{length:.4g} um at {angle:.3g} deg is too long to part from the shape of the film: "
            f"{sum(self.counts(wave)):.3g} waves where |X|, |Y| < {REACH:g}, and it takes "
            f"{FEWEST:g}"
        )

    def straight(self, wave: WaveVector) -> WaveVector:
        """Return a wave that lies along the entrainment if the patch cannot tell it from one.

        Where it turns by less than a quarter of its phase, what the inlet carries along x looks
        like the wave itself.
        """
        return wave if self.counts(wave)[0] >= _TURN else wave._replace(along=0.0)

    def points_per_wave(self, wave: WaveVector) -> float:
        steps = (np.ptp(self.x) / (self.x.size - 1), np.ptp(self.y) / (self.y.size - 1))
        phase = max(abs(wave.along) * steps[0], abs(wave.across) * steps[1])
        return float(2.0 * math.pi / phase)

    def fit(self, waves: Sequence[WaveVector]) -> "_Fit":
        """Return a least-squares fit of ``waves``, their streaks and a quadratic background."""
        x, y = (axis.ravel() for axis in np.meshgrid(self.x, self.y))
        # Less than a quarter of a streak is part of the quadratic background.
        wide = (wave for wave in waves if self.counts(wave)[1] >= _TURN or not wave.along)
        streaks = _streaks([self.straight(wave) for wave in wide])
        vectors = [(wave.along, wave.across, wave.phase) for wave in waves]
        vectors += [(0.0, number, 0.0) for number in streaks]
        columns = [
            function(along * x + across * y + phase)
            for along, across, phase in vectors
            for function in (np.cos, np.sin)
        ]
        unit_x, unit_y = x / self.half_widths[0], y / self.half_widths[1]
        columns += [unit_x**i * unit_y**j for i in range(3) for j in range(3 - i)]
        return _Fit(np.linalg.pinv(np.stack(columns, axis=1)), len(waves), streaks)


def _streaks(waves: Sequence[WaveVector]) -> list[float]:
    """Return the wave numbers across of the streaks that oblique waves make, each once."""
    longitudinal = [abs(wave.across) for wave in waves if not wave.along]
    found: list[float] = []
    for number in (abs(wave.across) for wave in waves if wave.along and wave.across):
        if not any(math.isclose(number, other) for other in (*longitudinal, *found)):
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
        """Return the amplitude of the streaks that belong to a wave."""
        pairs = self._pairs(field)[self.waves :]
        return next(
            (
                abs(pair)
                for pair, number in zip(pairs, self.streaks, strict=True)
                if wave.along and math.isclose(number, abs(wave.across))
            ),
            0.0,
        )

    def _pairs(self, field: Array) -> list[complex]:
        count = 2 * (self.waves + len(self.streaks))
        values = self.inverse[:count] @ field.ravel()
        return [complex(c, -s) for c, s in zip(values[::2], values[1::2], strict=True)]


@dataclass(frozen=True, kw_only=True, slots=True)
class FlatFilm:
    """What linear theory knows of a film: one of constant thickness under constant pressure.

    Attributes
    ----------
    film : float
        Thickness [m].
    bulk_modulus : float
        Of the oil, B = rho dp/drho [Pa].
    viscosity : float
        Of the oil under that pressure [Pa s].
    reduced_modulus : float
        E' [Pa].
    """

    film: float
    bulk_modulus: float
    viscosity: float
    reduced_modulus: float

    def theory(
        self, wave: WaveVector, amplitude: float, drift: float, *, holds: bool = True
    ) -> LinearTheory:
        """Return the ripples that a wave makes.

        Parameters
        ----------
        wave : WaveVector
            Its wave numbers.
        amplitude : float
            Of the heights [m].
        drift : float
            Speed of the wave less the mean speed of both surfaces [m/s]: minus the latter for one
            that stands.
        holds : bool
            Whether the film is isothermal and Newtonian; if not, only a wave that is left to the
            inlet has ripples to expect.
        """
        number, stiffness = wave.number, 0.25 * wave.number * self.reduced_modulus
        compressed = self.film * stiffness / self.bulk_modulus
        ratio = 48.0 * self.viscosity * drift * wave.along
        ratio /= self.reduced_modulus * (self.film * number) ** 3
        # iQ/(1 - iQ - iCQ), written so that an infinite Q does no harm.
        flattened = 0j if ratio == 0 else -1.0 / (1.0 + compressed + 1j / ratio)
        told = holds or flattened == 0
        return LinearTheory(
            compressibility=compressed,
            film_ratio=abs(1.0 + flattened) if told else None,
            pressure=abs(flattened) * stiffness * amplitude if told else None,
            elastic_pressure=stiffness * amplitude,
        )


def _flat_film(result: "Result", patch: _Patch) -> FlatFilm:
    """Return the means of a film over the patch."""
    pressure = float(patch.cut(result.pressure).mean())
    temperature = result.scales.temperature
    if result.heat is not None:
        layers = np.tensordot(result.heat.weights, result.heat.temperature, axes=1)
        temperature = float(patch.cut(layers).mean())
    thinning = 1.0 if result.shear is None else float(patch.cut(result.shear.thinning).mean())
    oil = result.problem.lubricant
    return FlatFilm(
        film=float(patch.cut(result.film_thickness).mean()),
        bulk_modulus=bulk_modulus(oil.density, pressure, temperature),
        viscosity=thinning * float(oil.viscosity.viscosity(np.array(pressure), temperature)),
        reduced_modulus=result.problem.reduced_modulus,
    )


def bulk_modulus(law: DensityLaw, pressure: float, temperature: float) -> float:
    """Return rho dp/drho [Pa] at ``pressure`` [Pa] and ``temperature`` [K]."""
    below, here, above = law.density(pressure + np.array([-_STEP, 0.0, _STEP]), temperature)
    return float(here * 2.0 * _STEP / (above - below)) if above > below else math.inf


def angle_of(wave: WaveVector) -> float:
    """Return the angle of a wave as cases state it, between -pi/2 and pi/2 [rad]."""
    backwards = wave.along < 0 or (wave.along == 0 and wave.across > 0)
    sign = -1.0 if backwards else 1.0
    return math.atan2(-sign * wave.across, sign * wave.along)


def _place(wave: WaveVector, patch: _Patch) -> dict[str, float]:
    return {
        "wavelength": 2.0 * math.pi / wave.number,
        "angle": angle_of(wave),
        "points_per_wave": patch.points_per_wave(wave),
    }


def _ripple(height: complex, film: complex, pressure: complex) -> dict[str, float]:
    return {
        "amplitude": abs(height),
        "film_amplitude": abs(film),
        "film_phase": _lag(film / -height),
        "pressure_amplitude": abs(pressure),
        "pressure_phase": _lag(pressure / height),
    }


def _lag(ratio: complex) -> float:
    """Return how far a ripple lies behind the wave, along its vector [rad]."""
    return -cmath.phase(ratio) + 0.0
