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

import numpy as np

from tehl.lubricant.density import DensityLaw
from tehl.problem import ContactProblem
from tehl.result import Result
from tehl.roughness import AnyRoughness, Sum, WaveVector
from tehl.roughness.waves import HarmonicModel
from tehl.typing import Array, BoolArray

REACH = 0.4
"""Half-widths on each side of the centre in which waves are fitted: the pressure is even there."""
FEWEST = 1.5
"""Waves that must lie in that square to be told from the shape of the film."""
STRONGEST = 3
"""Components that are looked for in a surface without known waves."""
_STEP = 1e5


@dataclass(frozen=True, kw_only=True, slots=True)
class LinearTheory:
    """Ripples that linear theory expects of a wave.

    Attributes
    ----------
    compressibility : float
        C = h E' kappa / (4 B) [-].
    film_ratio : float
        Amplitude of the film over that of the wave [-].
    pressure : float
        Amplitude of the pressure [Pa].
    elastic_pressure : float
        Pressure that flattens the whole wave, pi E' A / (2 lambda) [Pa].
    """

    compressibility: float
    film_ratio: float
    pressure: float
    elastic_pressure: float


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
        across or along the entrainment.
    theory : LinearTheory
        What linear theory expects.
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


def wave_responses(result: Result, smooth: Result | None = None) -> tuple[WaveResponse, ...]:
    """Return how film and pressure respond to each wave of the surfaces.

    Waves are those of ``wave`` and ``crossed`` surfaces, alone or in a sum; of other surfaces the
    strongest ones in the middle of the contact. Ripples are fitted by least squares where
    ``|X|, |Y| < 0.4``, together with a quadratic background and with the streaks that an oblique
    wave makes in the inlet and the film carries along x.

    Parameters
    ----------
    result : Result
        Of a rough contact; others have no waves.
    smooth : Result or None
        The same contact with smooth surfaces on the same grid, which is subtracted first.

    Returns
    -------
    tuple of WaveResponse
        Waves that are too long to be told from the shape of the film are left out.
    """
    if result.heights is None:
        return ()
    patch = _Patch.of(result)
    heights = patch.cut(result.heights.together)
    known = list(drifting_waves(result.problem))
    waves = [wave for wave, _ in known if patch.holds(wave)]
    if not known:
        waves = patch.strongest(heights)
    if not waves:
        return ()
    fit = patch.fit(waves)
    film, pressure = result.film_thickness, result.pressure
    if smooth is not None:
        film, pressure = film - smooth.film_thickness, pressure - smooth.pressure
    fields = (heights, patch.cut(film), patch.cut(pressure))
    ripples = [fit.ripples(field) for field in fields]
    level = _flat_film(result, patch)
    drifts = dict(known) | dict.fromkeys(set(waves) - set(dict(known)), -result.scales.speed)
    return tuple(
        WaveResponse(
            **_place(wave, patch),
            **_ripple(*(pairs[n] for pairs in ripples)),
            carried_amplitude=fit.carried(fields[1], wave),
            theory=level.theory(wave, abs(ripples[0][n]), drifts[wave]),
        )
        for n, wave in enumerate(waves)
        if abs(ripples[0][n]) > 0
    )


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


@dataclass(frozen=True, slots=True)
class _Patch:
    """The middle of the contact: coordinates in metres, and in half-widths."""

    rows: BoolArray
    columns: BoolArray
    x: Array
    y: Array
    half_widths: tuple[float, float]

    @classmethod
    def of(cls, result: Result) -> "_Patch":
        columns, rows = (np.abs(axis) <= REACH for axis in (result.scaled.x, result.scaled.y))
        widths = (result.scales.half_width_x, result.scales.half_width_y)
        return cls(rows, columns, result.x[columns], result.y[rows], widths)

    def cut(self, field: Array) -> Array:
        return field[np.ix_(self.rows, self.columns)]

    def holds(self, wave: WaveVector) -> bool:
        """Return whether enough of a wave lies in the patch."""
        along, across = (2.0 * REACH * width for width in self.half_widths)
        count = (abs(wave.along) * along + abs(wave.across) * across) / (2.0 * math.pi)
        return count >= FEWEST

    def points_per_wave(self, wave: WaveVector) -> float:
        steps = (np.ptp(self.x) / (self.x.size - 1), np.ptp(self.y) / (self.y.size - 1))
        phase = max(abs(wave.along) * steps[0], abs(wave.across) * steps[1])
        return float(2.0 * math.pi / phase)

    def strongest(self, heights: Array) -> list[WaveVector]:
        """Return the strongest waves of heights, on the lattice of the patch and apart on it."""
        ny, nx = heights.shape
        window = np.hanning(ny + 2)[1:-1, None] * np.hanning(nx + 2)[1:-1]
        spectrum = np.abs(np.fft.rfft2((heights - heights.mean()) * window))
        numbers = (
            2.0 * np.pi * np.fft.rfftfreq(nx, np.ptp(self.x) / (nx - 1)),
            2.0 * np.pi * np.fft.fftfreq(ny, np.ptp(self.y) / (ny - 1)),
        )
        found: list[WaveVector] = []
        taken: list[tuple[int, int]] = []
        for place in np.argsort(spectrum, axis=None)[::-1]:
            row, column = divmod(int(place), spectrum.shape[1])
            wave = WaveVector(1.0, float(numbers[0][column]), float(numbers[1][row]), 0.0)
            if len(found) == STRONGEST or not spectrum[row, column] > 0:
                break
            if self.holds(wave) and not _is_near((row, column), taken, ny):
                found.append(wave)
            taken.append((row, column))
        return found

    def fit(self, waves: Sequence[WaveVector]) -> "_Fit":
        """Return a least-squares fit of ``waves``, their streaks and a quadratic background."""
        x, y = (axis.ravel() for axis in np.meshgrid(self.x, self.y))
        streaks = _streaks(waves)
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


def _is_near(place: tuple[int, int], taken: Sequence[tuple[int, int]], rows: int) -> bool:
    """Return whether a place of a spectrum belongs to the peak of another one."""
    return any(
        abs(place[1] - column) <= 1 and min((place[0] - row) % rows, (row - place[0]) % rows) <= 1
        for row, column in taken
    )


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

    def theory(self, wave: WaveVector, amplitude: float, drift: float) -> LinearTheory:
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
        """
        number, stiffness = wave.number, 0.25 * wave.number * self.reduced_modulus
        compressed = self.film * stiffness / self.bulk_modulus
        ratio = 48.0 * self.viscosity * drift * wave.along
        ratio /= self.reduced_modulus * (self.film * number) ** 3
        # iQ/(1 - iQ - iCQ), written so that an infinite Q does no harm.
        flattened = 0j if ratio == 0 else -1.0 / (1.0 + compressed + 1j / ratio)
        return LinearTheory(
            compressibility=compressed,
            film_ratio=abs(1.0 + flattened),
            pressure=abs(flattened) * stiffness * amplitude,
            elastic_pressure=stiffness * amplitude,
        )


def _flat_film(result: Result, patch: _Patch) -> FlatFilm:
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
