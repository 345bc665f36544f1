"""Thermal resistances of rotating bodies, beside exact series."""

import math

import numpy as np
import pytest
from scipy import special

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.base.errors import InputError
from tehl.contact.cooling import Ball, Disc, HalfSpace
from tehl.contact.materials import material
from tests.cases import ball_tables

STEEL = material("steel")
K = STEEL.conductivity


@pytest.mark.parametrize(
    ("radius", "speed", "width"),
    [(0.02, 1.0, 2e-4), (0.02, 10.0, 5e-4), (0.05, 0.3, 2e-4), (0.01, 30.0, 1e-3)],
)
def test_a_half_space_is_the_sum_of_all_ring_sources_before(radius, speed, width):
    # Carslaw and Jaeger, 10.3: an instantaneous ring source on its own circle, twice in a half
    # space; the track widens its spread across the circle
    turn, kappa = 2 * math.pi * radius / speed, STEEL.diffusivity
    time = turn * np.arange(1, 100_001.0)
    ring = special.ive(0, radius**2 / (2 * kappa * time)) / (4 * np.pi * kappa * time) ** 1.5
    ring *= np.sqrt(kappa * time / (kappa * time + width**2 / 5))
    terms = 2 * turn * kappa / K * ring
    late = radius**2 / (2 * kappa * time[-1])
    exact = terms.sum() + 2 * terms[-1] * time.size * (1 + late / 1.5)  # as n^(-3/2) (1 - late N/n)
    body = HalfSpace(body="half-space", track_radius=radius)
    # the formula leaves out squares of the spread of a turn over the radius
    assert body.resistance(STEEL, speed, width) == pytest.approx(exact, rel=3e-4)
    assert body.resistance(STEEL, -speed, width) == body.resistance(STEEL, speed, width)


@pytest.mark.parametrize(("radius", "speed", "half"), [(0.02, 5.0, 5e-3), (0.03, 1.0, 4e-3)])
def test_the_even_heat_of_a_roller_is_that_of_a_strip(radius, speed, half):
    """As a Hertz contact of the same width it would be 5 and 3 % warmer."""
    turn, kappa = 2 * math.pi * radius / speed, STEEL.diffusivity
    time = turn * np.arange(1, 300_001.0)
    ring = special.ive(0, radius**2 / (2 * kappa * time)) / (4 * np.pi * kappa * time) ** 1.5
    u = 2 * half / np.sqrt(4 * kappa * time)  # the mean of the Gauss function over both widths
    ring *= np.sqrt(np.pi) * special.erf(u) / u + np.expm1(-(u**2)) / u**2
    terms = 2 * turn * kappa / K * ring
    exact = terms.sum() + 2 * terms[-1] * time.size
    surface = {"material": "steel", "radius": radius, "cooling": {"body": "half-space"}}
    surface["cooling"]["track_radius"] = radius
    tables = ball_tables(lubricant="mineral-oil", thermal={}) | {"surface_1": surface}
    tables["contact"] = {
        "type": "roller",
        "length": 2 * half,
        "load": 1e3,
        "entrainment_speed": speed,
    }
    tables["surface_2"] = {"material": "steel", "radius": "inf"}
    found = ContactProblem.model_validate(tables).resistances[0]
    assert found == pytest.approx(exact, rel=0.01)


@pytest.mark.parametrize(("transfer", "error"), [(50.0, 5e-4), (500.0, 0.01), (1300.0, 0.03)])
def test_a_fast_ball_is_the_series_of_legendre(transfer, error):
    # steady, the heat along the equator as a Gaussian band of the variance a_y^2 / 5
    radius, width, terms = 0.01, 5e-4, 5000
    half = np.arange(1, terms)
    at_equator = np.concatenate([[1.0], np.cumprod((1.0 - 0.5 / half) ** 2)])  # P_n(0)^2
    n = 2.0 * np.arange(terms)
    band = np.exp(-n * (n + 1) * width**2 / 5 / radius**2)
    parts = at_equator * (2 * n + 1) * band / (n + transfer * radius / K)
    exact = parts.sum() / (4 * math.pi * radius * K)
    body = Ball(body="ball", radius=radius, heat_transfer=transfer)
    assert body.resistance(STEEL, 1e7, width) == pytest.approx(exact, rel=error)


@pytest.mark.parametrize(
    ("thickness", "transfer", "track", "error"),
    [(5e-3, 200.0, 0.04, 0.005), (2e-3, 50.0, 0.045, 5e-4), (10e-3, 1300.0, 0.03, 0.05)],
)
def test_a_fast_disc_is_the_series_of_bessel(thickness, transfer, track, error):
    # steady cylinder without flux through its rim, cooled on both faces, heated along a ring
    width, rim, ratio = 2e-4, 0.05, transfer / K
    beta = np.concatenate([[1e-9], special.jn_zeros(1, 5000)]) / rim
    tanh = np.tanh(beta * thickness)
    face = (beta + ratio * tanh) / (beta * (beta * tanh + ratio) + ratio * (beta + ratio * tanh))
    modes = special.j0(beta * track) ** 2 / special.j0(beta * rim) ** 2
    band = np.exp(-(beta**2) * width**2 / 5)
    exact = (modes * band * face).sum() / (math.pi * rim**2 * K)
    body = Disc(
        body="disc", track_radius=track, radius=rim, thickness=thickness, heat_transfer=transfer
    )
    assert body.resistance(STEEL, 1e7, width) == pytest.approx(exact, rel=error)


def wrong(**surface):
    tables = ball_tables(lubricant="mineral-oil", thermal={})
    tables["surface_1"] = {"material": "steel"} | surface
    with pytest.raises(InputError) as caught:
        case_from_tables(tables)
    return str(caught.value)


BALL = {"body": "ball", "radius": "20 mm", "heat_transfer": "200 W/m^2/K"}
DISC = {"body": "disc", "track_radius": "60 mm", "radius": "50 mm", "thickness": "5 mm"}


@pytest.mark.parametrize(
    ("surface", "said"),
    [
        ({"thermal_resistance": "2 K/W", "temperature": "60 degC"}, "leave one of them out"),
        ({"thermal_resistance": "-2 K/W"}, "negative"),
        ({"thermal_resistance": "2 W/K"}, "a thermal resistance such as"),
        ({"cooling": {"body": "cone"}}, "half-space"),
        ({"cooling": BALL | {"heat_transfer": "0.2 MW/m^2/K"}}, "Biot number h L / k of 87"),
        ({"cooling": BALL | {"radius": "0.2 mm"}}, "must exceed twice the half-width"),
        ({"cooling": DISC | {"heat_transfer": "200 W/m^2/K"}}, "must be at most the radius"),
    ],
)
def test_a_body_that_is_not_one_is_named(surface, said):
    assert said in wrong(**surface)
    assert "surface_1" in wrong(**surface)


def test_a_body_must_turn_fast_enough_and_belongs_to_a_single_heated_film():
    tables = ball_tables(lubricant="mineral-oil", thermal={})
    tables["surface_2"] = {"material": "steel", "cooling": BALL}
    for slide, said in ((2.0, "is at rest"), (1.9999, "turns too slowly")):
        tables["contact"]["slide_roll_ratio"] = slide
        with pytest.raises(InputError, match=said):
            case_from_tables(tables)
    tables["contact"]["slide_roll_ratio"] = 0.5
    with pytest.raises(InputError, match="in thermal runs only"):
        case_from_tables(tables | {"thermal": None})
    with pytest.raises(InputError, match="a single steady film"):
        case_from_tables(tables | {"transient": {"duration": "1 ms"}})
    passes = {"layer": "0.5 um", "passes": 3, "track": "0.2 m"}
    with pytest.raises(InputError, match=r"leave out supply\.passes"):
        case_from_tables(tables | {"supply": passes})
