"""Cycles of rollers on fine grids, and their nodes: thick films that thin, short and rough ones."""

import pytest

import tehl
from tehl.contact.options import Domain, Options
from tehl.estimate.grid import Grid, coarsest_of, long_grids
from tehl.estimate.nodes import planned
from tehl.estimate.scaling import ScaledProblem
from tests.solver.test_roller import roller

THIN = {
    "viscosity": {"law": "barus", "eta_0": 0.0143, "alpha": 2.33e-8, "gamma": 0.047},
    "density": {"law": "dowson-higginson", "rho_0": 880.0, "beta": 6.5e-4},
    "shear": {"law": "eyring", "stress": "2.47 MPa"},
    "temperature": "80 degC",
}
LUNDBERG = {"shape": "lundberg"}
SHORT = {"shape": "iso-16281", "diameter": "20 mm"}


def residuals(problem: tehl.ContactProblem, points: tuple[int, int], smoother: str) -> list[float]:
    """Return the residuals of the cycles on the finest grid."""
    options = Options(points=points, wedge_order=3, smoother=smoother)
    found = tehl.solve(problem, options)
    return [one.residual for one in found.history if one.points == points]


def test_a_thick_film_that_thins_converges_on_fine_grids():
    """A line of points lacked the deflection from afar, and grew 30-fold in a sweep."""
    thinning = roller(
        11.9,
        moes_speed=6.75,
        radius="60 mm",
        length="14.4 mm",
        profile=LUNDBERG,
        slide_roll_ratio=1.88,
        surface_2={"material": "silicon-nitride"},
        lubricant=THIN,
    )
    first, *_, last = residuals(thinning, (513, 129), "broad")
    assert last < 0.1 * first


def test_an_oil_that_hardly_thickens_under_pressure_converges():
    """The same: the first cycle on 257 x 129 nodes left a residual of 0.3."""
    short = {"length": "0.58 mm", "profile": {"shape": "crown", "radius": "0.8 m"}}
    first, *_, last = residuals(roller(15.0, moes_speed=0.9, **short), (257, 129), "fast")
    assert first < 2e-5
    assert last < 0.2 * first


def test_cells_of_a_short_roller_are_never_shorter_than_wide():
    """On 65 x 257 nodes every sweep doubled the error."""
    first, *_, last = residuals(roller(140.0, profile=SHORT), (257, 257), "fast")
    assert last < 0.3 * first


def test_a_rough_roller_has_the_lines_of_its_waves_and_no_more_nodes_along_x():
    """It had 1025 x 513 nodes, too few along y: shorter bumps were rejected as aliased."""
    bump = {"type": "bump", "amplitude": "10 nm", "radius": "60 um"}
    long = {"length": "10 mm", "surface_2": {"material": "steel", "roughness": bump}}
    scaled = ScaledProblem.of(roller(50.0, profile=SHORT, **long))
    lines, nodes = planned(scaled, Options()).shape
    assert nodes <= 513
    assert lines >= 1025


@pytest.mark.parametrize("crowding", [0.0, 2.2])
def test_lines_that_crowd_halve_while_cells_are_long(crowding):
    ends = Domain.model_construct(x=(-3.0, 1.8), y=(-1.0, 1.0))
    finest = Grid(nx=513, ny=257, domain=ends, mirror=False, crowding=crowding)
    grids = long_grids(finest, coarsest_of(finest, 0.09), 12.0)
    shortest = min(12.0 * one.dy / one.dx for one in grids)
    assert (shortest >= 1.5) == (crowding > 0.0)
