"""Spin of the mean motion: independent values, mirror images, small spin, a nearly rigid ball."""

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError, Result
from tehl.api.solvers import solve
from tehl.contact.options import Domain, Options
from tehl.estimate.domain import domain_of
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import ends_within, load_per_e_fold, outside_by_spin, spin_error
from tehl.post.film import mass_flow
from tehl.solver.judging.diagnosis import likely_cause
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


def test_a_light_ellipse_that_floats_is_told_what_would_help():
    """The oil far outside would carry more than all of its load."""
    problem = spinning(0.12, 4.25, 6.93, ratio=5.0)
    scaled = ScaledProblem.of(problem)
    assert outside_by_spin(scaled) > 0.7
    assert spin_error(scaled, domain_of(scaled, Options())) > 1.0
    with pytest.raises(ConvergenceError) as caught:
        solve(problem, Options(error=0.02))
    status = caught.value.result.status
    assert status.cause == "error_not_reached"
    assert "State contact.flooded_radius if oil ends nearer" in str(status.hint)
    told = likely_cause(
        Grid(nx=65, ny=65, domain=Domain(x=(-9.0, 4.5), y=(-9.0, 9.0)), mirror=False),
        ScaledProblem.of(flooded(problem, 1e4)),
    )
    assert told is not None
    assert told.cause == "spin"


def test_a_little_spin_changes_the_central_film_by_its_square_and_the_sides_in_proportion():
    films = [solved(spinning(spin), tolerance=1e-9) for spin in (0.0, 0.1, 0.2)]
    small, large = (film.film.central / films[0].film.central - 1.0 for film in films[1:])
    assert small < 0.0
    assert large / small == pytest.approx(4.0, rel=0.1)
    lows = [film.scaled.film[film.y > 0.0].min() for film in films]
    assert (lows[2] - lows[0]) / (lows[1] - lows[0]) == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize(("angle", "order"), [(0.0, 2), (90.0, 2), (45.0, 1)])
def test_a_little_spin_of_an_ellipse_changes_its_middle_by_the_square_but_at_an_angle(angle, order):
    """As long as oil ends within the radius u_m / omega: beyond it enters from both sides."""
    box = Domain(x=(-6.0, 3.0), y=(-3.0, 3.0))
    along = moes_contact(20.0, 5.0, radius_ratio=RATIO)
    turned = along.contact.model_copy(update={"entrainment_angle": np.radians(angle)})
    problem = along.model_copy(update={"contact": turned})
    films = []
    for spin in (0.0, 0.1, -0.1, 0.2):
        omega = spin * problem.entrainment_speed / problem.hertz.half_width_x
        contact = turned.model_copy(update={"spin_1": omega, "spin_2": omega})
        found = solved(
            problem.model_copy(update={"contact": contact}), points=161, domain=box, tolerance=1e-9
        )
        films.append(found.film.central)
    small, opposite, large = (film / films[0] - 1.0 for film in films[1:])
    assert small == pytest.approx((-1.0) ** order * opposite, rel=0.2 if order == 1 else 1e-6)
    assert large / small == pytest.approx(2.0**order, rel=0.1)
    # by the square a fall along the long axis, and a rise across it
    assert small == pytest.approx({0.0: -0.0027, 90.0: 0.0013, 45.0: 0.0226}[angle], rel=0.1)


def test_a_nearly_rigid_ball_that_spins_moves_no_oil_by_it():
    """The velocity is then along lines of equal gap: the wedge and its far field are the same."""
    plain, spun = (solved(spinning(spin, 1.0, 5.0)) for spin in (0.0, 0.5))
    assert spun.film.central == pytest.approx(plain.film.central, rel=1e-3)


def test_the_oil_that_enters_leaves():
    found = solved(spinning(0.7), points=257)
    flow = mass_flow(found)
    assert np.count_nonzero(flow.full) > 100
    assert flow.imbalance < 3e-3


def flooded(problem: ContactProblem, radius: float) -> ContactProblem:
    """Return a contact with oil out to a radius [a_x]."""
    to = {"flooded_radius": radius * problem.hertz.half_width_x}
    return problem.model_copy(update={"contact": problem.contact.model_copy(update=to)})


def test_the_load_outside_an_ellipse_is_that_of_a_wider_domain():
    """With the far field without spin the wider domain had a film thicker by 7 to 9 %."""
    problem, films = flooded(spinning(0.5, 10.0, 5.0, RATIO), 60.0), []
    for inlet, points in ((10.0, 81), (20.0, 161)):
        box = Domain(x=(-inlet, 0.5 * inlet), y=(-0.6 * inlet, 0.6 * inlet))
        films.append(solved(problem, domain=box, edges="far_field", points=points))
    near, far = (film.film_scaled.central for film in films)
    scaled, box = ScaledProblem.of(problem), Domain(x=(-10.0, 5.0), y=(-6.0, 6.0))
    assert near == pytest.approx(far, rel=spin_error(scaled, box))
    assert near > 1.3  # 0.83 with oil out to 8 half-widths


def test_the_oil_ends_where_it_is_said_to_end():
    """A domain of all of the oil, without pressure on its edges, has the film of a small one.

    But for what a square has other than the circle of the same area.
    """
    problem = flooded(spinning(0.3, 10.0, 5.0, RATIO), 12.0)
    options = Options(error=0.02)
    domain = domain_of(ScaledProblem.of(problem), options)
    assert domain.x[1] == -domain.x[0] == pytest.approx(0.886 * 12.0)
    whole = solve(problem, options)
    box = Domain(x=(-8.0, 4.0), y=(-4.0, 4.0))
    near = solved(problem, domain=box, edges="far_field", points=97)
    assert near.film_scaled.central == pytest.approx(whole.film_scaled.central, rel=0.02)
    assert ends_within(ScaledProblem.of(problem), domain)


def test_a_light_ellipse_that_spins_has_a_film_within_its_bar():
    problem = spinning(0.15, 8.0, 5.0, RATIO)
    coarse, fine = (solve(problem, Options(error=error)) for error in (0.02, 0.008))
    found, known = coarse.film_scaled.central, fine.film_scaled.central
    assert coarse.errors is not None
    assert found == pytest.approx(known, rel=coarse.errors.central)
    assert 0.0 < coarse.errors.domain < 0.02
    assert found > 1.2 * solve(spinning(0.0, 8.0, 5.0, RATIO)).film_scaled.central


def test_the_bar_of_a_circle_has_its_sides_alone():
    scaled = ScaledProblem.of(spinning(0.5, 10.0, 5.0))
    assert load_per_e_fold(scaled) == outside_by_spin(scaled) == 0.0
    assert spin_error(scaled, domain_of(scaled, Options())) == pytest.approx(0.003)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"contact": {"flooded_radius": "1 um"}}, "lies within the contact, whose half-widths"),
        ({"contact": {"flooded_radius": "1 mm"}, "supply": {"ratio": 0.5}}, "exclude each other"),
    ],
)
def test_a_flooded_radius_is_that_of_a_flooded_contact(change, message):
    stated = spinning(0.3).model_dump(mode="json", exclude_none=True)
    stated["contact"] |= change.pop("contact")
    with pytest.raises(ValueError, match=message):
        ContactProblem.model_validate(stated | change)


def test_a_line_has_no_flooded_radius():
    with pytest.raises(ValueError, match="belongs to ellipses that spin"):
        line(50.0, 5.0, contact={"flooded_radius": 1.0})


def test_what_follows_oil_along_x_alone_is_refused():
    stated = spinning(0.3).model_dump(mode="json", exclude_none=True) | {"dynamics": {}}
    with pytest.raises(ValueError, match="linearised along x alone"):
        ContactProblem.model_validate(stated)


def test_a_line_does_not_spin():
    with pytest.raises(ValueError, match="distance along the line, without end"):
        line(50.0, 5.0, contact={"spin_1": 10.0})
