"""Amplitude of waves that pass the contact in pure rolling.

The amplitude of the film at the centre, by a harmonic fit over whole periods, is compared with the
curve of Venner and Lubrecht (2000), Proc. IMechE J 214, 43-62, eq. (29), a fit to their
computations. The one value that they print (M = 1007.6, L = 12.05, wavelength a/4, isotropic:
0.739) lies 5 % above the curve.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from tests.reference import moes_contact

from benchmarks.table import Table
from tehl import solve_transient
from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError, TransientResult
from tehl.contact.options import Domain, Options
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.scaling import groups, scales
from tehl.estimate.wave_theory import amplitude_reduction, nabla_of

DOMAIN = Domain(x=(-2.5, 1.5), y=(-2.0, 2.0))
ENTRANCE = 1.7
"""Distance upstream at which waves start, where the pressure is low [a_x]."""
TOLERANCE = 1e-5
"""Change of P per step, at which the amplitudes are within 2e-4 of those at 3e-6; 1e-3 and 1e-4
change them by up to 3e-3 (M = 1000, wavelength 1.2)."""
PERIODS = 2
"""Periods over which the harmonic is fitted."""
WHOLE = Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))
"""Domain on which coarse grids have a film too, for the order of the scheme."""
SMALL = 0.05
"""Amplitude of the waves over the central film."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Passing:
    """A passing wave: M, L, wavelength [a_x], form, and settings of the run."""

    load: float
    speed: float
    wavelength: float
    isotropic: bool = False
    tolerance: float = TOLERANCE
    domain: Domain = DOMAIN
    entrance: float = ENTRANCE

    @property
    def nabla(self) -> float:
        """Return the wavelength over that of the inlet, lambda/a sqrt(M/L) [-]."""
        return nabla_of(self.wavelength, self.load, self.speed)

    @property
    def curve(self) -> float:
        """Return the published curve."""
        return amplitude_reduction(self.nabla)

    def problem(self) -> ContactProblem:
        """Return the contact, its surface 1 with the wave."""
        case = moes_contact(self.load, self.speed)
        units, given = scales(case), case.model_dump(exclude_none=True)
        amplitude = SMALL * expected_film(case)
        wave = {
            "type": "crossed" if self.isotropic else "wave",
            "amplitude": amplitude * units.film_thickness,
            "wavelength": self.wavelength * units.half_width_x,
        } | ({"form": "product"} if self.isotropic else {})
        given["surface_1"]["roughness"] = wave
        fade = max(self.wavelength, 0.2)
        distance = self.entrance + fade + PERIODS * self.wavelength
        given["transient"] = {
            "duration": distance * units.half_width_x / units.speed,
            "entrance": self.entrance,
            "tolerance": self.tolerance,
            "frames": 0,
        }
        return ContactProblem.model_validate(given)


def expected_film(case: ContactProblem) -> float:
    """Return the central film that the formula gives, H [-]."""
    return expected_central_film(groups(case))


def amplitude(run: TransientResult, wavelength: float) -> float:
    """Return the amplitude of the film at the centre over that of the surface [-]."""
    centre = int(np.argmin(np.abs(run.start.scaled.x)))
    period = wavelength * run.start.scales.half_width_x / run.start.scales.speed
    time = run.history.time
    last = time > time[-1] - PERIODS * period * (1.0 - 1e-9)

    def first_harmonic(values: np.ndarray) -> float:
        phase = 2.0 * math.pi * time[last] / period
        basis = np.stack([np.ones_like(phase), phase, np.cos(phase), np.sin(phase)], axis=1)
        fit = np.linalg.lstsq(basis, values[last], rcond=None)[0]
        return math.hypot(fit[2], fit[3])

    surface = run.profiles.height_1[:, centre]
    return first_harmonic(run.profiles.film[:, centre]) / first_harmonic(surface)


def cases(*, quick: bool) -> Iterator[Passing]:
    """Yield the waves, by growing nabla."""
    if quick:
        yield Passing(load=50, speed=10, wavelength=1.0)
        return
    plain = ((50, 0.3125), (200, 0.25), (50, 1.0), (200, 0.5), (1000, 0.25), (50, 1.5),
             (200, 1.0), (1000, 0.5), (200, 1.5), (1000, 1.2))  # fmt: skip
    for isotropic in (False, True):
        for load, wavelength in plain:
            yield Passing(load=load, speed=10, wavelength=wavelength, isotropic=isotropic)
    yield Passing(load=1007.6, speed=12.05, wavelength=0.25, isotropic=True)


def table(*, quick: bool = False, points: int = 257) -> Table:
    """Return the amplitudes of passing waves on a grid and on one with half its intervals."""
    made = Table(
        title=f"Waves that pass in pure rolling, {points} x {points} nodes, X in [-2.5, 1.5]",
        columns=("form", "M", "L", "wavelength [a]", "nabla", "points per wave", "amplitude",
                 "coarser", "extrapolated", "curve", "over the curve", "CPU s"),
    )  # fmt: skip
    for case in cases(quick=quick):
        fine, seconds = measured(case, points)
        coarse, _ = measured(case, half(points))
        limit = in_the_limit(fine, coarse)
        made.rows.append(
            ("isotropic" if case.isotropic else "transverse", case.load, case.speed,
             case.wavelength, case.nabla, case.wavelength / 4.0 * (points - 1), fine, coarse, limit,
             case.curve, None if limit is None else limit / case.curve, seconds)
        )  # fmt: skip
    made.notes.append("extrapolated: order two in space and time together")
    return made


def half(points: int) -> int:
    """Return the nodes of the grid of half the intervals."""
    return (points - 1) // 2 + 1


def in_the_limit(fine: float | None, coarse: float | None) -> float | None:
    """Return the Richardson extrapolation of order two; None if a value is missing."""
    return None if fine is None or coarse is None else fine + (fine - coarse) / 3.0


def extrapolated(case: Passing, points: int = 257) -> float | None:
    """Return the extrapolated amplitude; None if a run failed."""
    return in_the_limit(measured(case, points)[0], measured(case, half(points))[0])


def refined() -> tuple[list[float], float]:
    """Return the amplitude of a wave on 65, 129 and 257 nodes, and the order in space and time.

    Raises
    ------
    RuntimeError
        If one of the runs failed.
    """
    case = Passing(load=50, speed=10, wavelength=1.0, domain=WHOLE, entrance=2.5)
    found = [value for points in (65, 129, 257) if (value := measured(case, points)[0])]
    if len(found) < 3:
        raise RuntimeError("a run with a wave failed")
    coarse, middle, fine = found
    return found, math.log2((coarse - middle) / (middle - fine))


def measured(case: Passing, points: int) -> tuple[float | None, float]:
    """Return the amplitude and the CPU seconds; None if the run failed."""
    try:
        run = solve_transient(case.problem(), Options(points=points, domain=case.domain))
    except ConvergenceError:
        return None, 0.0
    found = amplitude(run, case.wavelength) if run.status.converged else None
    return found, run.cost.cpu_seconds
