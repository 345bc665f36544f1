"""What a transient run asks of its grid."""

import numpy as np
import pytest

from tehl.base.errors import InputError
from tehl.contact.moment import Moment, frozen
from tehl.contact.options import Domain, Options
from tehl.contact.problem import ContactProblem
from tehl.contact.transient import Transient
from tehl.estimate.domain import domain_of
from tehl.estimate.in_time import films_of_run
from tehl.estimate.line import line_error, line_points
from tehl.estimate.nodes import least_in_time, planned
from tehl.estimate.scaling import ScaledProblem
from tehl.report.explain import explain
from tests.reference import moes_contact

AT = Moment(load=0.4, speed=0.7, sliding=-0.2, curvature=4.0)


def line() -> ContactProblem:
    """Return a line of steel with Moes groups M = 50, L = 10."""
    given = moes_contact(50.0, 10.0).model_dump(exclude_none=True)
    contact = {"type": "line", "radius": 0.01, "moes_load": 50.0, "moes_speed": 10.0}
    return ContactProblem.model_validate(given | {"contact": contact})


def run(problem: ContactProblem, **courses: object) -> ScaledProblem:
    """Return a run of one millisecond."""
    transient = Transient.model_validate({"duration": "1 ms"} | courses)
    return ScaledProblem.of(problem.model_copy(update={"transient": transient}))


@pytest.mark.parametrize("problem", [moes_contact(50.0, 5.0), line()], ids=["circle", "line"])
def test_a_frozen_contact_has_load_motion_and_radius_of_its_moment(problem: ContactProblem):
    still, whole = frozen(problem, AT), ScaledProblem.of(problem)
    own = ScaledProblem.of(still)
    assert still.transient is None
    assert still.load == pytest.approx(0.4 * problem.load)
    assert still.radius_x == pytest.approx(0.25 * problem.radius_x)
    assert still.motion.speed_1 - still.motion.speed_2 == pytest.approx(-0.2 * whole.scales.speed)
    # (2 U) goes with speed and curvature, W of a line with load and curvature, of a point with R^2
    if problem.contact.is_line:
        width, highest = whole.groups.shape.grown(AT.load, AT.curvature)
        assert own.scales.half_width_x == pytest.approx(width * whole.scales.half_width_x)
        assert own.scales.hertz_pressure == pytest.approx(highest * whole.scales.hertz_pressure)
    power = whole.groups.shape.speed_power
    load = AT.load * AT.curvature ** (1.0 if problem.contact.is_line else 2.0)
    rolling = AT.speed * AT.curvature
    assert own.groups.M == pytest.approx(whole.groups.M * load * rolling**-power)
    assert own.groups.L == pytest.approx(whole.groups.L * rolling**0.25)


def test_a_run_has_the_nodes_of_its_smallest_contact_on_its_own_domain():
    """Near the base circle a pinion's contact is a quarter as wide as at the pitch point."""
    options = Options(error=0.02)
    grows = run(line(), load=[[0, 0.4], ["1 ms", 1.0]], radius=[[0, 0.2], ["1 ms", 1.0]])
    domain = domain_of(grows, options)
    films = films_of_run(grows, domain)
    first, edges = films[0]
    part = first.scales.half_width_x / grows.scales.half_width_x
    assert part == pytest.approx((0.4 * 0.2) ** 0.5)
    assert edges.x == pytest.approx([edge / part for edge in domain.x])
    nodes = planned(grows, options).shape[1]
    assert nodes == line_points(first.entering, edges, options.target, 0.0)
    assert nodes >= 2 * planned(ScaledProblem.of(line()), options).shape[1] - 1
    # the same way back: now its end, which has no bars, may decide, and the start has its nodes
    shrinks = run(line(), load=[[0, 1.0], ["1 ms", 0.4]], radius=[[0, 1.0], ["1 ms", 0.2]])
    of_end = line_points(first.entering, edges, options.target, 0.0, is_bar=False)
    assert of_end <= nodes
    assert least_in_time(shrinks, options) >= of_end
    assert planned(shrinks, options).shape[1] >= of_end
    assert least_in_time(grows, options) <= nodes


def test_the_domain_of_a_load_that_grows_contains_its_widest_contact():
    """Up to twice as wide, it lay beyond the outlet, and the run was refused."""
    options = Options(error=0.02)
    grows = run(line(), load=[[0, 1.0], ["1 ms", 4.0]])
    inlet, outlet = domain_of(ScaledProblem.of(line()), options).x
    assert domain_of(grows, options).x == pytest.approx((2.0 * inlet, 2.0 * outlet))
    falls = run(line(), load=[[0, 1.0], ["1 ms", 0.2]])
    assert domain_of(falls, options).x == (inlet, outlet)


@pytest.mark.parametrize(
    ("load", "nodes", "bar"), [(3.0, 161, 0.0050), (8.6, 129, 0.0548), (8.6, 257, 0.0120)]
)
def test_the_bar_of_a_line_on_few_nodes_is_expected(load: float, nodes: int, bar: float):
    """Bars of films with L = 6 on 4.9 half-widths; on more nodes errors fall faster."""
    contact = {"type": "line", "radius": 0.01, "moes_load": load, "moes_speed": 6.0}
    given = moes_contact(50.0, 6.0).model_dump(exclude_none=True) | {"contact": contact}
    groups = ScaledProblem.of(ContactProblem.model_validate(given)).groups
    assert 0.8 * bar < line_error(groups, Domain(x=(-3.4, 1.5)), nodes) < 1.2 * bar


def test_a_film_that_stops_has_the_speed_at_which_its_oil_came_in():
    """Half a width earlier; without anything that changes all that counts is the film."""
    turns = run(line(), duration="150 ms", entrainment_speed="cos(2*pi*t/(150 ms))")
    films = films_of_run(turns, domain_of(turns, Options()))
    speeds = [own.scales.speed / turns.scales.speed for own, _ in films]
    assert max(speeds) == speeds[0] == 1.0
    # from rest over b: u = sqrt(2 u' b), u' = 2 pi u_m/T
    stopped = (4.0 * np.pi * turns.scales.half_width_x / (turns.scales.speed * 0.15)) ** 0.5
    assert min(speeds) == pytest.approx(stopped, rel=0.3)  # of 200 samples
    still = ScaledProblem.of(line())
    assert films_of_run(still, domain_of(still, Options())) == [
        (still, domain_of(still, Options()))
    ]


@pytest.mark.parametrize(
    "courses",
    [
        {"load": "1 - 3*t/(1 ms)"},
        {"radius": "1 - 3*t/(1 ms)"},
        {"radius": "1 - 2*t/(1 ms)"},
        {"entrainment_speed": [[0, -1.0], ["1 ms", -0.6]]},
        {"entrainment_speed": [[0, 0.0], ["1 ms", 1.0]]},
    ],
)
def test_a_moment_that_is_not_possible_is_left_to_the_schedule(courses):
    """It says in one sentence which value is not, and when."""
    faulty = run(line(), **courses)
    assert len(films_of_run(faulty, domain_of(faulty, Options()))) == 1
    with pytest.raises(InputError, match="transient"):
        explain(faulty.problem, Options())
