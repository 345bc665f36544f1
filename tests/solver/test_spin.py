"""Spin of the mean motion: independent values, mirror images, small spin, a nearly rigid ball."""

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError, Result
from tehl.api.solvers import solve
from tehl.contact.options import Domain, Options
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import spin_error
from tehl.post.film import mass_flow
from tests.reference import moes_contact, read
from tests.solver.test_line import line

SPIN = read("directions")["spin"]
RATIO = 1.0 / 0.351771642
"""R_y/R_x of a_y/a_x = 2, by the D of the reference."""


def spinning(spin: float, load: float = 50.0, speed: float = 5.0, ratio: float = 1.0):
    """Return a contact whose surfaces both have a spin, over u_m/a_x."""
    found = moes_contact(load, speed, radius_ratio=ratio)
    omega = spin * found.entrainment_speed / found.hertz.half_width_x
    contact = found.contact.model_copy(update={"spin_1": omega, "spin_2": omega})
    return found.model_copy(update={"contact": contact})


def solved(problem: ContactProblem, **options) -> Result:
    return solve(problem, Options(**{"points": 65, "half_domain": "never"} | options))


@pytest.mark.parametrize("name", ["circle", "ellipse"])
def test_the_film_is_that_of_another_program(name):
    reference = SPIN[name]
    ratio = RATIO if "kappa" in reference else 1.0
    problem = spinning(reference["spin"], reference["M"], reference["L"], ratio)
    west, east, south, north = reference["box"]
    box = Domain(x=(west, east), y=(south, north))
    found = solved(problem, points=257, domain=box, edges="zero", extrapolate=True)
    assert found.film_scaled.central == pytest.approx(reference["h_central"], rel=2e-3)
    assert found.film_scaled.minimum == pytest.approx(reference["minimum_left"], rel=5e-3)
    if "minimum_right" in reference:
        right = found.scaled.film[found.y < 0.0].min()
        assert right == pytest.approx(reference["minimum_right"], rel=2e-3)
    assert found.scaled.at_origin(found.scaled.pressure) == pytest.approx(
        reference["p_central"], rel=5e-4
    )


def test_the_opposite_spin_has_the_mirrored_film():
    one, other = (solved(spinning(spin), tolerance=1e-9) for spin in (0.8, -0.8))
    assert np.abs(other.scaled.film[::-1] / one.scaled.film - 1.0).max() < 1e-5
    assert one.film.minimum_at[1] > 0.0  # on the left, where the surfaces are slower


def test_a_light_ellipse_that_spins_fast_is_told_what_would_help():
    """Its load far outside grows with the logarithm of the radius: no domain holds it."""
    problem = spinning(0.6, load=3.5, speed=2.7, ratio=RATIO)
    with pytest.raises(ConvergenceError) as caught:
        solve(problem, Options(error=0.02))
    status = caught.value.result.status
    assert status.cause == "error_not_reached"
    assert "more of the load is then on the grid" in str(status.hint)


def test_a_little_spin_changes_the_central_film_by_its_square_and_the_sides_in_proportion():
    films = [solved(spinning(spin), tolerance=1e-9) for spin in (0.0, 0.1, 0.2)]
    small, large = (film.film.central / films[0].film.central - 1.0 for film in films[1:])
    assert small < 0.0
    assert large / small == pytest.approx(4.0, rel=0.1)
    lows = [film.scaled.film[film.y > 0.0].min() for film in films]
    assert (lows[2] - lows[0]) / (lows[1] - lows[0]) == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize(("angle", "order"), [(0.0, 2), (90.0, 2), (45.0, 1)])
def test_a_little_spin_of_an_ellipse_changes_its_middle_by_the_square_but_at_an_angle(angle, order):
    along = moes_contact(20.0, 5.0, radius_ratio=RATIO)
    turned = along.contact.model_copy(update={"entrainment_angle": np.radians(angle)})
    problem = along.model_copy(update={"contact": turned})
    films = []
    for spin in (0.0, 0.1, -0.1, 0.2):
        omega = spin * problem.entrainment_speed / problem.hertz.half_width_x
        contact = turned.model_copy(update={"spin_1": omega, "spin_2": omega})
        found = solved(problem.model_copy(update={"contact": contact}), points=129)
        films.append(found.film.central)
    small, opposite, large = (film / films[0] - 1.0 for film in films[1:])
    assert small == pytest.approx((-1.0) ** order * opposite, rel=0.2 if order == 1 else 1e-6)
    assert large / small == pytest.approx(2.0**order, rel=0.1)
    # by the square a fall along the long axis, and a rise across it
    assert small == pytest.approx({0.0: -0.0023, 90.0: 0.0012, 45.0: 0.021}[angle], rel=0.1)


def test_a_nearly_rigid_ball_that_spins_moves_no_oil_by_it():
    """The velocity is then along lines of equal gap: the wedge and its far field are the same."""
    plain, spun = (solved(spinning(spin, 1.0, 5.0)) for spin in (0.0, 0.5))
    assert spun.film.central == pytest.approx(plain.film.central, rel=1e-3)


def test_the_oil_that_enters_leaves():
    found = solved(spinning(0.7), points=257)
    flow = mass_flow(found)
    assert np.count_nonzero(flow.full) > 100
    assert flow.imbalance < 3e-3


def test_the_bar_contains_the_load_outside_an_ellipse():
    found = [solved(spinning(0.5, 10.0, 5.0, RATIO)), solved(spinning(0.5, 10.0, 5.0))]
    errors = [spin_error(ScaledProblem.of(one.problem)) for one in found]
    assert errors[1] == pytest.approx(0.003)  # by the sides, which are inlets too
    assert errors[0] == pytest.approx(0.14, rel=0.1)  # twice the domain changes it by 7 to 9 %
    assert found[0].errors.domain > errors[0]


def test_what_follows_oil_along_x_alone_is_refused():
    stated = spinning(0.3).model_dump(mode="json", exclude_none=True) | {"dynamics": {}}
    with pytest.raises(ValueError, match="linearised along x alone"):
        ContactProblem.model_validate(stated)


def test_a_line_does_not_spin():
    with pytest.raises(ValueError, match="distance along the line, without end"):
        line(50.0, 5.0, contact={"spin_1": 10.0})
