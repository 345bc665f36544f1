"""What roughness does to a film: a rough result beside its smooth reference run."""

import math
from dataclasses import dataclass

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.problem import ContactProblem
from tehl.post.roughness import areas_in_contact, in_contact, middle_film, square
from tehl.post.traction import traction as traction_of
from tehl.result.solution import Solution
from tehl.roughness import Smooth
from tehl.roughness.prepare import gaussian_mean
from tehl.roughness.statistics import statistics


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MicroFilm:
    """Ripples of film and pressure."""

    film: Array
    """(ny, nx): Film less that of the smooth contact [m]."""
    pressure: Array
    """(ny, nx): Pressure less that of the smooth contact [Pa]."""
    by_reference: bool
    """Whether the smooth contact was solved; if not, ripples are what is left when long waves are
    filtered off, and are meaningful inside the contact only."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RoughnessEffect:
    """A rough contact over its smooth reference run; a block of the summary."""

    central: float
    minimum: float
    middle: float
    """Ratio of the central and minimum films, and of the mean films where |X|, |Y| < 0.4 [-]."""
    largest_pressure: float
    """Ratio of the largest pressures [-]."""
    traction: float | None
    """Ratio of the mid-film tractions [-]; None where there is no sliding."""
    smooth_h_central_m: float
    smooth_h_min_m: float
    """Films of the reference run [m]."""
    smooth_max_pa: float
    """Of the reference run [Pa]."""
    ripple_film_m: float
    ripple_pressure_pa: float
    """Root mean square of both ripples over the Hertz contact [m], [Pa]."""


def smooth_reference(problem: ContactProblem) -> ContactProblem:
    """Return ``problem`` with both surfaces smooth, and steady.

    Raises
    ------
    InputError
        If they are smooth already.
    """
    if not problem.is_rough:
        raise InputError("both surfaces are smooth: the case has no roughness to compare without")
    surfaces = {
        name: getattr(problem, name).model_copy(update={"roughness": Smooth()})
        for name in ("surface_1", "surface_2")
    }
    return problem.model_copy(update=surfaces | {"transient": None})


def micro_film(rough: Solution, smooth: Solution | None = None) -> MicroFilm:
    """Return the ripples of film and pressure.

    Parameters
    ----------
    rough : Solution
        Of the rough contact.
    smooth : Solution or None
        Of its smooth reference run on the same grid. Without it a Gaussian filter removes all
        waves that are longer than twice those of the surface.

    Raises
    ------
    InputError
        If the grids differ.
    """
    if smooth is None:
        cut_off = 2.0 * typical_wavelength(rough)
        film, pressure = (
            field - gaussian_mean(field, _pixel(rough), cut_off)
            for field in (rough.film_thickness, rough.pressure)
        )
        return MicroFilm(film=film, pressure=pressure, by_reference=False)
    if not is_reference(rough, smooth):
        raise InputError("the rough and the smooth film are not those of one contact on one grid")
    return MicroFilm(
        film=rough.film_thickness - smooth.film_thickness,
        pressure=rough.pressure - smooth.pressure,
        by_reference=True,
    )


def is_reference(rough: Solution, smooth: Solution) -> bool:
    """Return whether two results differ by nothing but the heights of the surfaces.

    Parameters
    ----------
    rough, smooth : Solution
        Compared by their nodes, groups and scales; heights are ignored.
    """
    same_grid = all(
        one.shape == other.shape and np.allclose(one, other)
        for one, other in ((rough.scaled.x, smooth.scaled.x), (rough.scaled.y, smooth.scaled.y))
    )
    return same_grid and rough.groups == smooth.groups and rough.scales == smooth.scales


def typical_wavelength(result: Solution) -> float:
    """Return the wavelength 2 pi Sq/Sdq of the heights in the contact [m]; at most a_x."""
    longest = result.scales.half_width_x
    if result.heights is None:
        return longest
    heights = result.heights.together[square(result)]
    if len(heights) == 1:  # the same on all lines
        heights = np.repeat(heights, 3, axis=0)
    found = statistics(heights, _pixel(result))
    return min(2.0 * math.pi * found.sq / found.sdq, longest) if found.sdq > 0 else longest


def _pixel(result: Solution) -> tuple[float, float]:
    along = float(np.diff(result.x[:2])[0])
    return along, float(np.diff(result.y[:2])[0]) if result.y.size > 1 else along


def roughness_effect(rough: Solution, smooth: Solution) -> RoughnessEffect:
    """Return what roughness does to the film, from a rough result and its reference run.

    Parameters
    ----------
    rough : Solution
        With heights.
    smooth : Solution
        Same contact with smooth surfaces, on the same grid.

    Raises
    ------
    InputError
        If ``smooth`` is not the reference run of ``rough``.
    """
    ripples, contact = micro_film(rough, smooth), in_contact(rough)
    areas = areas_in_contact(rough)
    highest, without = float(rough.pressure.max()), float(smooth.pressure.max())
    here, there, traction = traction_of(rough), traction_of(smooth), None
    if here and there and there.size and rough.problem.slide_roll_ratio != 0:
        traction = here.size / there.size

    def rms(field: Array) -> float:
        return math.sqrt(float(np.average(field[contact] ** 2, weights=areas)))

    return RoughnessEffect(
        central=rough.film.central / smooth.film.central,
        minimum=rough.film.minimum / smooth.film.minimum,
        middle=middle_film(rough) / middle_film(smooth),
        largest_pressure=highest / without,
        traction=traction,
        smooth_h_central_m=smooth.film.central,
        smooth_h_min_m=smooth.film.minimum,
        smooth_max_pa=without,
        ripple_film_m=rms(ripples.film),
        ripple_pressure_pa=rms(ripples.pressure),
    )
