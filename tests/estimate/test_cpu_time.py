"""CPU time that a solve needs."""

import tomllib

import pytest

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import Result
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.estimate import cpu_time
from tehl.estimate.cpu_time import expected_cycles, expected_seconds, seconds_range
from tehl.estimate.machine import machine_factor
from tehl.estimate.scaling import ScaledProblem
from tehl.io.templates import template_text
from tests.cases import ball_tables, moes_problem
from tests.reference import heated_contact, moes_contact

WAVE = {"material": "steel", "roughness": {"type": "wave", "amplitude": "20 nm"}}
RANDOM = {"type": "random", "rms": "20 nm", "correlation_length": "100 um"}
EYRING = {"name": "mineral-oil", "shear": {"law": "eyring", "stress": "5 MPa"}}


def ball(**tables: object) -> ScaledProblem:
    """Return the ball on the disc with other tables."""
    return ScaledProblem.of(ContactProblem.model_validate(ball_tables(**tables)))


def wavy(wavelength: str, angle: str = "0 deg") -> ScaledProblem:
    """Return the ball with a wave on the disc."""
    wave = WAVE["roughness"] | {"wavelength": wavelength, "angle": angle}
    return ball(surface_2=WAVE | {"roughness": wave})


def work_of(result: Result) -> int:
    """Return the nodes of the finest grids of all cycles."""
    return sum(report.points[0] * report.points[1] for report in result.history)


@pytest.mark.parametrize("scaled", [ball(), ball(lubricant=EYRING), wavy("150 um"), wavy("60 um")])
def test_the_cycles_expected_are_those_of_the_solve(scaled):
    known = expected_cycles(scaled, Options())
    expected = sum(cycles * grid.nx * grid.ny for grid, cycles in known)
    # full multigrid may end one grid before the planned one, or one behind it
    assert 0.3 < work_of(solve(scaled.problem)) / expected < 4.0


def test_the_heights_are_raised_on_the_first_grid_that_has_eight_nodes_per_wave():
    def raised(wavelength: str) -> int:
        cycles = expected_cycles(wavy(wavelength), Options(points=513))
        return max(cycles, key=lambda one: one[1])[0].nx

    assert raised("400 um") < raised("100 um") < raised("25 um") == 513


def test_time_grows_with_the_nodes():
    coarse, fine = (expected_seconds(ball(), Options(points=n)) for n in (1025, 2049))
    assert 3.5 < fine / coarse < 4.5


def test_heights_that_are_not_symmetric_take_twice_the_time():
    options = Options(points=1025)
    along, oblique = (expected_seconds(wavy("150 um", a), options) for a in ("0 deg", "20 deg"))
    assert oblique / along == pytest.approx(2.0, rel=0.1)


def test_thinning_and_heat_and_sampled_heights_add_to_the_time():
    options = Options(points=257)
    heated = ball(lubricant="mineral-oil", thermal={})
    thinning = ball(lubricant=EYRING)
    smooth, *others = (expected_seconds(one, options) for one in (ball(), thinning, heated))
    assert smooth < others[0] < others[1]
    sampled = ball(surface_2=WAVE | {"roughness": RANDOM})
    assert expected_seconds(sampled, options) > expected_seconds(wavy("150 um", "20 deg"), options)


def test_scarce_oil_takes_the_time_of_the_flooded_contact_too():
    flooded, starved = ball(), ball(supply={"ratio": 0.5})
    seconds = [expected_seconds(one, Options()) for one in (flooded, starved)]
    assert 2.0 * seconds[0] < seconds[1] < 8.0 * seconds[0]


def test_an_error_to_reach_adds_to_the_time_of_its_grid():
    scaled = ball()
    finest = expected_cycles(scaled, Options())[-1][0]
    stated = Options(points=finest.points)
    assert expected_seconds(scaled, Options()) > expected_seconds(scaled, stated)


def test_hard_contacts_have_a_wider_range_of_time():
    easy = ScaledProblem.of(moes_contact(100.0, 8.0))
    heavy = ScaledProblem.of(moes_contact(4000.0, 8.0))
    heated = ScaledProblem.of(heated_contact(0.5))
    assert seconds_range(easy, 2.0) == (1.0, 6.0)
    slender = ScaledProblem.of(moes_problem(100.0, 8.0, radius_x=0.02, radius_y=0.01))
    assert seconds_range(heavy, 2.0) == seconds_range(heated, 2.0) == (1.0, 20.0)
    assert seconds_range(slender, 2.0) == (1.0, 20.0)


def test_the_grids_expected_of_a_roller_are_those_of_its_solve():
    """With the coarsest grid of others, 17 x 33 nodes, the time would be a tenth."""
    problem, _ = case_from_tables(tomllib.loads(template_text("roller")))
    options = Options(points=(129, 65), wedge_order=3)
    scaled = ScaledProblem.of(problem)
    expected = [grid.points for grid, _ in expected_cycles(scaled, options)]
    found = solve(problem, options)
    known = list(dict.fromkeys(one.points for one in found.history))
    assert expected[1:] == known
    assert expected[0] == (65, 17)


def test_thin_films_and_steep_spikes_that_thin_take_longer():
    def seconds(load: float, speed: float) -> float:
        contact = moes_problem(load, speed, radius_x=0.02, radius_y=0.2)
        known = contact.model_dump(exclude_none=True)
        known["lubricant"] |= {"shear": {"law": "eyring", "stress": 5e6}}
        return expected_seconds(ScaledProblem.of(ContactProblem.model_validate(known)), Options())

    assert seconds(4100.0, 10.0) > 1.8 * seconds(3900.0, 10.0)
    assert seconds(40000.0, 10.0) > 1.8 * seconds(9900.0, 10.0)
    assert seconds(500.0, 24.0) > 2.0 * seconds(500.0, 12.0)


def test_the_time_is_that_of_this_machine(monkeypatch):
    assert 0.0 < machine_factor() == machine_factor()
    before = expected_seconds(ball(), Options())
    monkeypatch.setattr(cpu_time, "machine_factor", lambda: 3.0 * machine_factor())
    assert expected_seconds(ball(), Options()) == pytest.approx(3.0 * before)
