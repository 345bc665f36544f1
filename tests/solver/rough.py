"""Rough contacts for the tests of the solver."""

import numpy as np

from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import scales
from tehl.operators.heights import Heights
from tests.reference import moes_contact


def with_roughness(contact: tuple[float, float], **table: object) -> ContactProblem:
    """Return a contact (M, L) with ``table`` as the roughness of surface 1."""
    given = moes_contact(*contact).model_dump(exclude_none=True)
    return ContactProblem.model_validate(
        given | {"surface_1": given["surface_1"] | {"roughness": table}}
    )


def wavy(contact: tuple[float, float], shape: tuple[float, float, float]) -> ContactProblem:
    """Return a contact with a wave (amplitude, length, degrees) that thickens the gap at 0."""
    units, (amplitude, length, degrees) = scales(moes_contact(*contact)), shape
    return with_roughness(
        contact,
        type="wave",
        amplitude=amplitude * units.film_thickness,
        wavelength=length * units.half_width_x,
        angle=np.radians(degrees),
        phase=np.pi,
    )


def bumpy(contact: tuple[float, float], height: float, radius: float) -> ContactProblem:
    """Return a contact with a Gaussian bump at the origin; a dent if ``height`` is negative."""
    units = scales(moes_contact(*contact))
    return with_roughness(
        contact,
        type="bump",
        amplitude=height * units.film_thickness,
        radius=radius * units.half_width_x,
    )


def wave_on(grid: Grid, amplitude: float, length: float) -> Heights:
    """Return a transverse wave on a grid."""
    values = -amplitude * np.cos(2.0 * np.pi * grid.x / length) * np.ones(grid.shape)
    return Heights(surface_1=values, surface_2=np.zeros(grid.shape), wavelengths=(length, np.inf))


def rough_film(
    contact: tuple[float, float], options: Options, shape: tuple[float, float, float]
) -> Result:
    """Return the result of a contact (M, L) with a wave (amplitude, length, degrees)."""
    return solve(wavy(contact, shape), options)
