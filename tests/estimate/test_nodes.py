"""Number of nodes, planned for the error to reach."""

import math

import pytest

from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.contact.supply import Supply
from tehl.contact.transient import Transient
from tehl.estimate.domain import domain_of, far_field_error
from tehl.estimate.duration import bend_between
from tehl.estimate.entering import entry_error
from tehl.estimate.nodes import (
    ENOUGH_LINES,
    FAVOURED,
    FEWEST_LINES,
    LEAST_MESH_PART,
    LIMITED_RATIO,
    LINES_OF_SCARCE,
    LONGEST_CELL,
    MARGIN_OF_MIDDLE,
    WAVE_NODES,
    _left_to_the_mesh,
    is_thinnest_at_exit,
    lines_bar,
    planned,
    side_bar,
)
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.settled import settled
from tehl.estimate.summits import _shared_by_summits, shared_load
from tehl.estimate.third_order import LEAST_SHARED, third_order_bar
from tests.reference import heated_contact, moes_contact, touching_contact


@pytest.mark.parametrize(("radius_ratio", "margin"), [(12.0, 1.0), (2.0, MARGIN_OF_MIDDLE)])
def test_a_slender_flooded_contact_is_planned_without_a_margin(
    radius_ratio: float, margin: float
) -> None:
    problem = moes_contact(1000.0, 8.0, radius_ratio=radius_ratio)
    scaled, options = ScaledProblem.of(problem), settled(problem, Options(error=0.01))
    assert (scaled.groups.ellipticity > LIMITED_RATIO) is (margin == 1.0)
    domain, nodes = domain_of(scaled, options), planned(scaled, options).shape[1]
    fewer = FAVOURED[FAVOURED.index(nodes) - 1]
    bars = [third_order_bar(scaled, domain, one) for one in (nodes, fewer)]
    assert bars[0] <= (0.01 - far_field_error(scaled.groups, domain)) / margin < bars[1]


@pytest.mark.parametrize(
    ("load", "speed", "radius_ratio", "part"),
    [
        (1000.0, 8.0, 12.0, 0.25),  # thinnest at the exit
        (30000.0, 8.0, 12.0, 1.0),  # at the sides, as the load is heavy,
        (75000.0, 4.8, 12.0, 2.0),
        (8700.0, 1.5, 1.0, 2.0),
        (1000.0, 8.0, 4.0, 0.5),  # or the contact less slender
        (100.0, 30.0, 12.0, 0.5),  # thick
        (450.0, 2.0, 1.0, 2.0),
        (450.0, 10.0, 1.0, 1.0),
    ],
)
def test_a_film_that_is_thinnest_at_the_exit_needs_few_lines_and_one_at_the_sides_many(
    load: float, speed: float, radius_ratio: float, part: float
) -> None:
    scaled = ScaledProblem.of(moes_contact(load, speed, radius_ratio=radius_ratio))
    ny, nx = planned(scaled, Options(error=0.01)).shape
    assert (ny - 1) == part * (nx - 1)


@pytest.mark.parametrize(
    ("radius_ratio", "supply", "is_quarter"),
    [(12.0, 0.3, False), (20.0, 0.3, True), (20.0, 0.5, False), (50.0, 0.5, True)],
)
def test_a_film_short_of_oil_is_thinnest_at_the_exit_of_more_slender_contacts_alone(
    radius_ratio: float, supply: float, is_quarter: bool
) -> None:
    flooded = moes_contact(5000.0, 8.0, radius_ratio=radius_ratio)
    starved = flooded.model_copy(update={"supply": Supply(ratio=supply)})
    assert is_thinnest_at_exit(ScaledProblem.of(flooded))
    assert is_thinnest_at_exit(ScaledProblem.of(starved)) is is_quarter


@pytest.mark.parametrize("ratio", [0.01, 0.1, 0.4])
@pytest.mark.parametrize("supply", [None, {"ratio": 0.5}])
def test_the_cells_of_a_wide_contact_are_not_much_longer_along_the_entrainment(
    ratio: float, supply: dict[str, float] | None
) -> None:
    problem = moes_contact(100.0, 10.0, radius_ratio=ratio)
    tables = problem.model_dump(exclude_none=True) | ({"supply": supply} if supply else {})
    scaled = ScaledProblem.of(type(problem).model_validate(tables))
    ny, nx = planned(scaled, Options(error=0.01)).shape
    assert FEWEST_LINES <= (ny - 1) / (nx - 1) / scaled.groups.ellipticity <= LONGEST_CELL


@pytest.mark.parametrize("radius_ratio", [1.0, 3.0, 12.0])
@pytest.mark.parametrize("load", [1e3, 4e3, 1.6e4])
@pytest.mark.parametrize("ratio", [None, 1.0])
def test_lines_leave_no_more_of_the_error_than_they_may(
    load: float, radius_ratio: float, ratio: float | None
) -> None:
    """With more a heavy contact is solved on another grid after it, with all of its coarse ones."""
    problem = moes_contact(load, 8.0, radius_ratio=radius_ratio)
    problem = problem.model_copy(update={"supply": Supply(ratio=ratio) if ratio else None})
    scaled, options = ScaledProblem.of(problem), settled(problem, Options(error=0.01))
    domain, (ny, _) = domain_of(scaled, options), planned(scaled, options).shape
    left = _left_to_the_mesh(scaled.entering, domain, 0.01)
    if radius_ratio == 1.0:
        assert side_bar(scaled, domain, ny) <= left
    elif not is_thinnest_at_exit(scaled):
        assert lines_bar(scaled, domain, ny) <= (LINES_OF_SCARCE if ratio else ENOUGH_LINES) * left


def test_heat_upstream_takes_no_part_of_the_error_of_scarce_oil() -> None:
    case = moes_contact(200.0, 28.0).model_dump(exclude_none=True) | {"supply": {"ratio": 0.6}}
    case["contact"]["slide_roll_ratio"] = 1.0
    case["lubricant"]["viscosity"]["gamma"] = 0.04
    case["lubricant"] |= {"conductivity": 0.14, "heat_capacity": 2000.0}
    cold, hot = (
        ScaledProblem.of(ContactProblem.model_validate(one))
        for one in (case, case | {"thermal": {}})
    )
    options = Options(error=0.01)
    assert entry_error(hot, domain_of(hot, options)) == 0.0
    assert planned(hot, options).shape[0] <= 1.5 * planned(cold, options).shape[0]


def test_the_mesh_is_left_a_part_of_the_error_that_the_bodies_exceed() -> None:
    case, error = heated_contact(0.5), 0.003
    warm = case.with_bodies(*2 * (case.inlet_temperature + 60.0,))
    plans = {}
    for part in (1.0, LEAST_MESH_PART):
        scaled, options = ScaledProblem.of(warm), Options(error=part * error)
        plans[part] = planned(scaled, options).shape
        assert entry_error(scaled, domain_of(scaled, options)) > options.error
    cold = planned(ScaledProblem.of(case), Options(error=LEAST_MESH_PART * error)).shape
    assert plans[1.0][0] <= 2.0 * cold[0] < plans[LEAST_MESH_PART][0]


def test_no_more_columns_are_planned_for_lines_than_are_known_to_be_needed() -> None:
    """Its bar asks for 3073 x 1537 lines and columns; the film of L = 0.5 needs far fewer."""
    scaled = ScaledProblem.of(moes_contact(1e5, 0.5, radius_ratio=3.0))
    assert planned(scaled, Options(error=0.01)).shape == (513, 513)


def test_asperities_need_more_lines_than_their_film() -> None:
    case = touching_contact(1000.0, 8.0, 1.0, radius_ratio=12.0)
    smooth = case.model_copy(update={"asperities": None})
    plans = [planned(ScaledProblem.of(one), Options(error=0.01)).shape for one in (case, smooth)]
    assert [(ny - 1) / (nx - 1) for ny, nx in plans] == [0.5, 0.25]


@pytest.mark.parametrize(("ratio", "dense"), [(2.5, 0.5), (0.1, 0.05), (0.1, 0.5)])
def test_asperities_lower_the_bar_by_their_load_to_a_quarter_at_least(
    ratio: float, dense: float
) -> None:
    case = touching_contact(1000.0, 8.0, ratio, dense=dense)
    scaled = ScaledProblem.of(case)
    smooth = ScaledProblem.of(case.model_copy(update={"asperities": None}))
    domain = domain_of(smooth, settled(case, Options()))
    bars = [third_order_bar(one, domain, 129) for one in (scaled, smooth)]
    assert bars[0] / bars[1] == pytest.approx(max(1.0 - shared_load(scaled).share, LEAST_SHARED))
    assert (shared_load(scaled).share > 1.0 - LEAST_SHARED) is (ratio * dense == 0.05)


def test_a_plan_computes_the_share_of_the_asperities_once():
    """It took half of the time of an outer ring (60 ms): each grid was asked anew."""
    case = touching_contact(900.0, 7.0, 1.1, radius_ratio=12.0)
    before = _shared_by_summits.cache_info()
    planned(ScaledProblem.of(case), Options())
    after = _shared_by_summits.cache_info()
    assert after.misses == before.misses + 1
    assert after.hits > before.hits + 5


@pytest.mark.parametrize(
    ("radius_ratio", "part", "boundary"),
    [(1.0, 1, True), (8.0, 2, True), (30.0, 4, True), (30.0, 4, False)],
)
def test_a_dent_on_a_slender_ellipse_has_more_lines_than_columns(
    radius_ratio: float, part: int, boundary: bool
) -> None:
    """It is as long as wide, and its cells are a_y/a_x times as long with as many lines."""
    tables = moes_contact(36.0, 5.0, radius_ratio=radius_ratio).model_dump(exclude_none=True)
    radius = 0.3 * ScaledProblem.of(ContactProblem.model_validate(tables)).scales.half_width_x
    tables["surface_2"]["roughness"] = {"type": "bump", "amplitude": -5e-8, "radius": radius}
    if boundary:
        tables["contact_film"] = {"thickness": 1e-8}
    problem = ContactProblem.model_validate(tables)
    scaled = ScaledProblem.of(problem)
    plan = planned(scaled, Options(error=0.02))
    ny, nx = plan.shape
    assert ny - 1 == part * (nx - 1)
    # as a smooth film without boundary contact has
    assert plan.order == 3
    domain, scales = domain_of(scaled, plan), scaled.scales
    along, across = problem.shortest_wavelengths
    cells = (
        along / scales.half_width_x * (nx - 1) / (domain.x[1] - domain.x[0]),
        across / scales.half_width_y * (ny - 1) / (domain.y[1] - domain.y[0]),
    )
    assert min(cells) >= WAVE_NODES


@pytest.mark.parametrize(
    "tables", [{}, {"cavitation": {"model": "conserving"}}, {"contact_film": {"thickness": 1e-8}}]
)
def test_a_film_that_varies_in_time_has_an_order_of_three(tables: dict) -> None:
    stated = moes_contact(50.0, 5.0).model_dump(exclude_none=True) | tables
    stated["transient"] = {"duration": 1e-3, "load": [[0.0, 1.0], [1e-3, 1.2]]}
    scaled = ScaledProblem.of(ContactProblem.model_validate(stated))
    assert planned(scaled, Options()).order == 3
    assert planned(scaled, Options(points=129)).order == 2


def changing(duration: float, load: object) -> ScaledProblem:
    """Return a contact whose load changes over a time [a_x/u_m]."""
    problem = moes_contact(50.0, 5.0)
    unit = problem.hertz.half_width_x / problem.entrainment_speed
    stated = {"duration": duration * unit, "load": load(duration * unit)}
    transient = Transient.model_validate(stated)
    return ScaledProblem.of(problem.model_copy(update={"transient": transient}))


def test_a_parabola_is_off_a_straight_line_by_the_square_of_the_step():
    """By c dt^2 / 4 of c t^2."""
    scaled = changing(8.0, lambda end: f"1 + 0.5*(t/({end} s))**2")
    bends = [bend_between(scaled, steps) for steps in (2, 4, 8)]
    assert bends == pytest.approx([0.5 / 16 / 1.5, 0.5 / 64 / 1.5, 0.5 / 256 / 1.5], rel=1e-6)


@pytest.mark.parametrize("duration", [0.3, 4.0, 100.0])
def test_time_steps_follow_what_changes(duration: float):
    """A change of a sine within some mesh widths takes a finer mesh, a slow one does not."""
    scaled = changing(duration, lambda end: f"1 + 0.2*sin(6.283*t/({end} s))")
    options = planned(scaled, Options(error=0.02))
    domain = domain_of(scaled, options)
    cell = (domain.x[1] - domain.x[0]) / (options.shape[1] - 1)
    steps = math.ceil(duration / cell)
    assert bend_between(scaled, steps) < 0.25 * 0.02
    without = changing(duration, lambda end: [[0.0, 1.0], [end, 1.2]])  # a straight line
    usual = planned(without, Options(error=0.02)).shape
    assert (options.shape > usual) == (duration == 0.3)
