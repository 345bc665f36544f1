"""Waves that pass in pure rolling, against a published number and in the order of the scheme."""

import math

import pytest

from tehl import solve_transient
from tehl.api.problem import ContactProblem
from tehl.contact.options import Domain, Options
from tehl.estimate.scaling import scales
from tehl.post.waves import passing_wave
from tests.reference import CLOSE, DOMAIN, moes_contact

pytestmark = pytest.mark.slow

PUBLISHED = 0.739
"""Venner and Lubrecht, Proc. IMechE J 214 (2000), 43-62: M = 1007.6, L = 12.05, isotropic, a/4."""


def reduction(
    contact: tuple[float, float],
    wavelength: float,
    points: int,
    place: tuple[Domain, float] = (CLOSE, 1.7),
    **wave: object,
) -> float:
    """Return the amplitude of the film at the centre over that of the surface.

    ``place``: the domain, and the distance upstream at which the wave starts.
    """
    domain, entrance = place
    case = moes_contact(*contact)
    units, given = scales(case), case.model_dump(exclude_none=True)
    given["surface_1"]["roughness"] = {
        "type": "wave",
        "amplitude": 0.002 * units.film_thickness,
        "wavelength": wavelength * units.half_width_x,
    } | wave
    distance = entrance + max(wavelength, 0.2) + 2.2 * wavelength
    given["transient"] = {
        "duration": distance * units.half_width_x / units.speed,
        "entrance": entrance,
        "tolerance": 1e-4,
        "frames": 0,
    }
    run = solve_transient(
        ContactProblem.model_validate(given), Options(points=points, domain=domain)
    )
    assert run.status.converged
    return passing_wave(run, 1).film_ratio


def test_an_isotropic_wave_keeps_the_published_part_of_its_amplitude():
    found = reduction((1007.6, 12.05), 0.25, 257, type="crossed", form="product")
    assert found == pytest.approx(PUBLISHED, rel=0.05)


def test_waves_converge_to_second_order_in_space_and_time():
    coarse, middle, fine = (
        reduction((50.0, 10.0), 1.0, points, (DOMAIN, 2.5)) for points in (65, 129, 257)
    )
    assert math.log2((coarse - middle) / (middle - fine)) == pytest.approx(2.0, abs=0.3)
