r"""Theory of waves of the surfaces: what is left of them in film and pressure.

Linear theory [1]_ [2]_ of a wave :math:`s = A\cos(\mathbf{w}\cdot\mathbf{x} + \psi)` in an
isothermal film of constant thickness h and constant properties of Newtonian oil, with
:math:`\kappa = |\mathbf{w}|`:

.. math:: \frac{\hat p}{A} = -\frac{\kappa E'}{4}\,\frac{iQ}{1 - iQ - iCQ}, \quad
          \frac{\hat h}{A} = -1 - \frac{iQ}{1 - iQ - iCQ}, \quad
          C = \frac{h E' \kappa}{4B}, \quad
          Q = \frac{48\,\eta\,(\mathbf{u}_s - \mathbf{u}_m)\cdot\mathbf{w}}
                   {E' h^3 \kappa^3}

B is the bulk modulus and u_s the velocity of the wave, zero for a standing one. The viscosity in a
contact is so large that Q is practically infinite, but for crests that move with the oil or along
themselves: ``C/(1 + C)`` of the wave is left in the film, and the pressure carries
``1/(1 + C)`` of what flattens the whole wave.

A wave that passes in pure rolling is flattened by the inlet, less the shorter it is. A fit to
computed contacts [3]_, eq. (29), gives

.. math:: \frac{A_d}{A_i} = \frac{1}{1 + 0.15 f\nabla + 0.015 (f\nabla)^2}, \quad
          \nabla = \frac{\lambda}{a}\sqrt{\frac{M}{L}}

with :math:`\lambda` the shorter of the wavelengths along x and y, :math:`r = \lambda_x /
\lambda_y`, and :math:`f = e^{1 - 1/r}` for r > 1, else one.

References
----------
.. [1] G. E. Morales-Espejel and V. Brizmer, Tribology Transactions 54 (2011), 625-643, after
   C. J. Hooke (2006).
.. [2] J. A. Greenwood and G. E. Morales-Espejel, Proc. IMechE Part J 208 (1994), 121-132.
.. [3] C. H. Venner and A. A. Lubrecht, Proc. IMechE Part J 214 (2000), 43-62.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tehl.contact.problem import ContactProblem
from tehl.lubricant.density import DensityLaw
from tehl.roughness import AnyRoughness, Sum, WaveVector
from tehl.roughness.waves import HarmonicModel

Velocity = tuple[float, float]
_PRESSURE_STEP = 1e5
"""Difference of pressure over which the bulk modulus is taken [Pa]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LinearTheory:
    """Ripples of a wave by linear theory."""

    compressibility: float
    """C = h E' kappa / (4 B) [-]."""
    film_ratio: float | None
    """Amplitude of the film over that of the wave [-]; None where the theory does not hold."""
    pressure: float | None
    """Amplitude of the pressure [Pa]; None where the theory does not hold."""
    elastic_pressure: float
    """Pressure that flattens the whole wave, pi E' A / (2 lambda) [Pa]."""

    @property
    def left_to_inlet(self) -> bool:
        """Whether the pressure does not act on the wave, so that the inlet decides."""
        return self.pressure == 0


@dataclass(frozen=True, kw_only=True, slots=True)
class FlatFilm:
    """A film of constant thickness under constant pressure."""

    film: float
    """Thickness h [m]."""
    bulk_modulus: float
    """Of the oil, B = rho dp/drho [Pa]."""
    viscosity: float
    """Of the oil under that pressure [Pa s]."""
    reduced_modulus: float
    """E' [Pa]."""

    def theory(
        self, wave: WaveVector, amplitude: float, drift: Velocity, *, holds: bool = True
    ) -> LinearTheory:
        """Return the ripples of a wave by linear theory.

        Parameters
        ----------
        wave : WaveVector
            Its wave numbers.
        amplitude : float
            Of the heights [m].
        drift : (float, float)
            u_s - u_m: velocity of the wave less the mean one, along x and y [m/s].
        holds : bool
            Whether the film is isothermal and Newtonian; if not, the theory holds only for a wave
            on which the pressure does not act.
        """
        stiffness = 0.25 * wave.number * self.reduced_modulus
        compressed = self.film * stiffness / self.bulk_modulus
        q = 48.0 * self.viscosity * wave.rate(drift)
        q /= self.reduced_modulus * (self.film * wave.number) ** 3
        # iQ/(1 - iQ - iCQ), in a form that holds for infinite Q
        flattened = 0j if q == 0 else -1.0 / (1.0 + compressed + 1j / q)
        holds = holds or flattened == 0
        return LinearTheory(
            compressibility=compressed,
            film_ratio=abs(1.0 + flattened) if holds else None,
            pressure=abs(flattened) * stiffness * amplitude if holds else None,
            elastic_pressure=stiffness * amplitude,
        )


def bulk_modulus(law: DensityLaw, pressure: float, temperature: float) -> float:
    """Return rho dp/drho [Pa] by a central difference.

    Parameters
    ----------
    law : DensityLaw
        Density of the oil.
    pressure, temperature : float
        State [Pa], [K].
    """
    below, here, above = law.density(
        pressure + np.array([-_PRESSURE_STEP, 0.0, _PRESSURE_STEP]), temperature
    )
    return float(here * 2.0 * _PRESSURE_STEP / (above - below)) if above > below else math.inf


def why_no_theory(problem: ContactProblem) -> str | None:
    """Return why linear theory does not hold for a film; None where it does."""
    law = problem.lubricant.shear.law
    parts = [] if law == "newtonian" else [f"shear-thinning ({law})"]
    if problem.thermal is not None:
        parts.append("heated")
    if not parts:
        return None
    return f"no theory: it is for isothermal Newtonian films, and this one is {' and '.join(parts)}"


def expected_waves(
    problem: ContactProblem, film: float
) -> Iterator[tuple[WaveVector, LinearTheory]]:
    """Yield the stated waves of both surfaces with their ripples in the middle of the contact.

    Parameters
    ----------
    problem : ContactProblem
        Oil properties are taken at the Hertz pressure and the inlet temperature.
    film : float
        Expected central film [m].
    """
    oil, pressure = problem.lubricant, problem.hertz.pressure
    temperature = problem.inlet_temperature
    flat = FlatFilm(
        film=film,
        bulk_modulus=bulk_modulus(oil.density, pressure, temperature),
        viscosity=oil.viscosity.viscosity(pressure, temperature),
        reduced_modulus=problem.reduced_modulus,
    )
    for wave, drift in drifting_waves(problem):
        holds = why_no_theory(problem) is None
        yield wave, flat.theory(wave, wave.amplitude, drift, holds=holds)


def drifting_waves(problem: ContactProblem) -> Iterator[tuple[WaveVector, Velocity]]:
    """Yield each harmonic of both surfaces, and its velocity less the mean one [m/s].

    Without ``transient`` the waves stand still.
    """
    for surface, drift in zip(problem.surfaces, _drifts(problem), strict=True):
        for wave in waves_of(surface.roughness):
            yield wave, drift


def _drifts(problem: ContactProblem) -> tuple[Velocity, Velocity]:
    """Return the velocities of both surfaces less the mean one; they stand in a steady case."""
    motion = problem.motion
    still = -motion.entrainment_speed, 0.0
    if problem.transient is None:
        return still, still
    (u_1, v_1), (u_2, v_2) = (motion.velocity_of(number) for number in (1, 2))
    return (u_1 - motion.entrainment_speed, v_1), (u_2 - motion.entrainment_speed, v_2)


def drift_of_heights(problem: ContactProblem) -> Velocity | None:
    """Return the velocity of waves found in the heights, less the mean one [m/s].

    None where both surfaces may have them and move apart. Without ``transient`` they stand still.
    """
    drifts = _drifts(problem)
    if problem.transient is None:
        return drifts[0]
    rough = [not one.roughness.is_smooth for one in problem.surfaces]
    found = {drift for drift, counts in zip(drifts, rough, strict=True) if counts}
    return found.pop() if len(found) == 1 else None


def waves_of(roughness: AnyRoughness) -> Iterator[WaveVector]:
    """Yield the harmonics of a surface that consists of waves, wholly or in part."""
    if isinstance(roughness, HarmonicModel):
        yield from (wave for wave in roughness.components if wave.amplitude > 0)
    elif isinstance(roughness, Sum):
        for part in roughness.parts:
            yield from waves_of(part)


def nabla_of(wavelength: float, load: float, speed: float) -> float:
    """Return the wavelength over that of the inlet, (lambda/a) sqrt(M/L) [-].

    Parameters
    ----------
    wavelength : float
        The shorter of those along x and y, over the half-width [-].
    load, speed : float
        M and L [-].
    """
    return wavelength * math.sqrt(load / speed)


def amplitude_reduction(nabla: float, *, ratio: float = 1.0) -> float:
    """Return the part of a wave that is left in the film in pure rolling [-], [3]_ eq. (29).

    Parameters
    ----------
    nabla : float
        (lambda / a) sqrt(M/L) [-].
    ratio : float
        Wavelength along x over that along y [-], zero for a transverse wave.
    """
    scaled = nabla * (math.exp(1.0 - 1.0 / ratio) if ratio > 1.0 else 1.0)
    return 1.0 / (1.0 + 0.15 * scaled + 0.015 * scaled**2)
