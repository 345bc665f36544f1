"""Accuracy on request: the grid follows from the error to reach, the domain from the film."""

import math
import tomllib
from dataclasses import replace
from itertools import pairwise
from unittest.mock import Mock

import numpy as np
import pytest

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import ConvergenceError
from tehl.api.solvers import solve, solve_transient
from tehl.contact.options import Domain, Options
from tehl.contact.supply import Supply
from tehl.estimate.domain import domain_of, recommended_domain
from tehl.estimate.grid import Grid
from tehl.estimate.memory import RESTING_PART, needed_memory
from tehl.estimate.nodes import finest_grid
from tehl.estimate.scaling import ScaledProblem, groups
from tehl.estimate.settled import settled
from tehl.estimate.starvation import part_passed_on
from tehl.estimate.third_order import third_order_bar
from tehl.io.templates import template_text
from tehl.result.bars import ErrorEstimate
from tehl.solver import steady
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.iteration import GridIteration
from tehl.solver.judging import diagnosis
from tehl.solver.judging.convergence import GridTrace
from tehl.solver.judging.film_errors import PART_AT_EXIT
from tehl.solver.judging.film_summary import film_summary
from tehl.solver.judging.goal import (
    FLOODED_PART,
    MOST_OTHERS,
    MOST_SPARE,
    SPARE_PART,
    Goal,
)
from tehl.solver.judging.measures import SAMPLED, side_reach
from tests.reference import heated_contact, moes_contact
from tests.solver.rough import wavy


def grids(result) -> list[int]:
    """Return the nodes of the grids, in the order of their first cycle."""
    return list(dict.fromkeys(report.points[0] for report in result.history))


@pytest.mark.parametrize(
    ("load", "speed", "ratio", "error"),
    [
        (1.0, 2.0, 1.0, 0.02),
        (7.0, 5.0, 0.2, 0.005),
        (50.0, 10.0, 2.0, 0.02),
        *(
            pytest.param(*contact, error, marks=pytest.mark.slow)
            for contact, error in (
                ((1.0, 2.0, 1.0), 0.005),
                ((7.0, 5.0, 0.2), 0.02),
                ((50.0, 10.0, 2.0), 0.005),
                ((500.0, 5.0, 1.0), 0.02),
                ((500.0, 5.0, 1.0), 0.005),
            )
        ),
    ],
)
def test_the_film_is_as_accurate_as_stated(load, speed, ratio, error):
    problem = moes_contact(load, speed, radius_ratio=ratio)
    found = solve(problem, Options(error=error))
    assert max(found.errors.central, found.errors.minimum) <= error
    nodes = 2 * max(grids(found)) - 1
    # the error chooses the domain here, which a user cannot ask for beside nodes
    finer = steady.solve(problem, Options(points=nodes, error=0.2 * error, extrapolate=True))
    for name in ("central", "minimum"):
        there = getattr(finer.film_scaled, name)
        bar = getattr(found.errors, name)
        assert getattr(found.film_scaled, name) == pytest.approx(there, rel=bar)


def test_no_grid_is_solved_twice():
    found = grids(solve(moes_contact(300.0, 5.0), Options(error=0.004)))
    assert found == sorted(found)
    assert all(fine == 2 * coarse - 1 for coarse, fine in pairwise(found))


def test_a_minimum_that_errs_by_the_mesh_along_y_gets_more_lines_alone():
    found = solve(moes_contact(400.0, 1.0))
    ny, nx = found.scaled.film.shape
    assert ny == 2 * nx - 1
    assert found.errors.minimum <= found.options.target
    before = max(report.points[1] for report in found.history if report.points[0] == nx)
    assert before == ny


def test_a_quarter_of_the_lines_gives_the_film_that_is_thinnest_at_the_exit():
    problem = moes_contact(1000.0, 8.0, radius_ratio=12.0)
    few = solve(problem)
    ny, nx = few.scaled.film.shape
    many = solve(problem, Options(points=(nx, 2 * ny - 1), extrapolate=True))
    assert ny - 1 == (nx - 1) / 4
    for name in ("central", "minimum"):
        films = [getattr(one.film_scaled, name) for one in (few, many)]
        assert films[0] == pytest.approx(films[1], rel=5e-4)


def test_a_minimum_at_the_sides_of_scarce_oil_is_not_missed_between_the_lines():
    """On 65 lines the film seems to be thinnest at the exit, 2.5 % thicker than on 513."""
    ring = moes_contact(1270.0, 9.5, radius_ratio=14.3)
    found = solve(ring.model_copy(update={"supply": Supply(ratio=0.45)}))
    assert abs(found.film_scaled.minimum / 0.03187 - 1.0) < found.errors.minimum < 0.01


def test_the_bar_of_a_minimum_at_the_sides_holds_on_too_few_lines():
    problem = moes_contact(450.0, 2.0)
    few, many = (
        solve(problem, Options(points=points, extrapolate=True)) for points in (161, (321, 641))
    )
    assert few.film_scaled.minimum_at[1] > 0.9
    off = abs(few.film_scaled.minimum / many.film_scaled.minimum - 1.0)
    assert 0.5 * few.errors.minimum < off < few.errors.minimum


def test_a_smaller_error_takes_a_finer_grid_and_a_larger_domain():
    runs = [solve(moes_contact(20.0, 10.0), Options(error=error)) for error in (0.05, 0.003)]
    meshes = [np.diff(run.scaled.x)[0] for run in runs]
    assert meshes[1] < 0.5 * meshes[0]
    assert runs[1].scaled.x[0] < 1.3 * runs[0].scaled.x[0]


def test_the_grid_between_rough_surfaces_resolves_their_waves():
    found = solve(wavy((57.21, 10.52), (0.1, 0.5, 0.0)), Options(error=0.02))
    width = np.diff(found.scaled.x)[0]
    assert 0.5 / width > 12.0
    assert found.errors.central <= 0.02


def test_the_time_limits_the_grid_and_the_result_says_so(monkeypatch):
    monkeypatch.setattr(Goal, "is_over", False)  # a grid that has begun is solved
    with pytest.raises(ConvergenceError) as caught:
        solve(moes_contact(20.0, 5.0), Options(error=1e-4, max_time=0.05))
    status = caught.value.result.status
    assert status.cause == "error_not_reached"
    assert "numerics.max_time is 0.05 s" in status.message
    assert "numerics.error = " in str(status.hint)
    # following the hint works
    wanted = status.hint.settings["numerics.error"]
    assert solve(moes_contact(20.0, 5.0), Options(error=wanted)).status.converged


def test_the_memory_limits_the_grid_and_the_result_says_so():
    options = Options.model_validate({"error": 1e-4, "max_memory": "50 MB"})
    with pytest.raises(ConvergenceError) as caught:
        solve(moes_contact(20.0, 5.0), options)
    result = caught.value.result
    assert result.status.cause == "error_not_reached"
    assert "numerics.max_memory is 0.05 GB" in result.status.message
    assert result.scaled.film.size * 180 < 50e6
    assert result.errors.central < 0.01  # that of the largest grid


def test_a_hint_says_something_where_no_error_was_reached(monkeypatch):
    monkeypatch.setattr(diagnosis, "LARGEST_ERROR", 1e-5)
    options = Options.model_validate({"error": 1e-4, "max_memory": "50 MB"})
    with pytest.raises(ConvergenceError) as caught:
        solve(moes_contact(20.0, 5.0), options)
    assert str(caught.value.result.status.hint).startswith("Take a larger numerics.max_memory")


@pytest.mark.parametrize("load", [0.1, 1.0])
def test_a_rigid_contact_follows_its_similarity_law(load):
    # isoviscous and rigid: H in half-widths of the gap does not depend on the load
    results = [solve(moes_contact(m, 1e-3), Options(error=0.005)) for m in (load, 0.5 * load)]
    # H_Moes M^2 is constant, and H = H_Moes (3 M / 2)^(-2/3)
    first, second = (run.film_scaled.central for run in results)
    assert first / second == pytest.approx(0.5 ** (8.0 / 3.0), rel=0.02 if load == 1.0 else 0.005)


@pytest.mark.slow
@pytest.mark.parametrize("load", [1.0, 2.0, 3.0, 5.0])
@pytest.mark.parametrize("speed", [1e-3, 5.0, 10.0])
def test_a_nearly_rigid_contact_agrees_with_a_domain_four_times_as_wide(load, speed):
    problem = moes_contact(load, speed)
    found = solve(problem, Options())
    x, y = found.scaled.x, found.scaled.y
    domain = Domain(x=(4 * x[0], 4 * x[-1]), y=(4 * y[0], 4 * y[-1]))
    points = tuple(8 * (n.size - 1) + 1 for n in (x, y))  # and twice as fine
    wide = solve(problem, Options(points=points, domain=domain, edges="far_field"))
    assert found.film_scaled.central == pytest.approx(
        wide.film_scaled.central, rel=found.errors.central
    )


@pytest.mark.parametrize(
    "domain", [{"x": (-3.4, 1.5), "y": (-1.2, 1.2)}, {"x": (-1.01, 1.01), "y": (-1.01, 1.01)}]
)
def test_a_stated_domain_that_is_too_narrow_for_the_far_field_fails_with_a_hint(domain):
    problem = moes_contact(75.0, 11.0)
    usual = solve(problem, Options()).film_scaled
    with pytest.raises(ConvergenceError) as caught:
        solve(problem, Options(domain=Domain(**domain), edges="far_field"))
    found = caught.value.result
    assert found.status.cause == "error_not_reached"
    assert "due to numerics.domain" in found.status.message
    assert found.status.hint.settings["numerics.domain"] is False
    for name in ("central", "minimum"):
        there, bar = getattr(usual, name), getattr(found.errors, name)
        assert getattr(found.film_scaled, name) == pytest.approx(there, rel=bar)


def test_a_mesh_is_refined_until_it_leaves_as_much_as_the_domain_that_misses_the_error():
    case = moes_contact(2.3, 10.5).model_dump(exclude_none=True)
    case["contact"]["slide_roll_ratio"] = 1.9
    case["lubricant"]["shear"] = {"law": "limiting", "slope": 0.03}  # it thins upstream
    problem = ContactProblem.model_validate(case)
    domain = recommended_domain(groups(problem), 0.02, near=True)
    with pytest.raises(ConvergenceError, match="due to numerics") as caught:
        solve(problem, Options(domain=domain, edges="far_field"))
    errors = caught.value.result.errors
    assert 0.01 < errors.domain < errors.central < 2.0 * errors.domain


NAMES = ("pressure_max", "traction_mid_film", "film_rise_max", "mid_film_rise_central")


def values(run) -> dict[str, float]:
    """Return the values that have error bars beside the film."""
    return {
        "pressure_max": float(run.scaled.pressure.max()),
        "traction_mid_film": run.traction.mid_film,
        "film_rise_max": run.temperature.film_rise_max,
        "mid_film_rise_central": run.temperature.mid_film_rise_central,
        "heat_shear": run.heat.balance.shear,
        "heat_surface_1": run.heat.balance.surface_1,
        "heat_surface_2": run.heat.balance.surface_2,
    }


@pytest.mark.parametrize(
    "shear", [pytest.param(None, marks=pytest.mark.slow), {"law": "eyring", "stress": 5e6}]
)
def test_pressure_traction_and_temperatures_have_error_bars_that_hold(shear):
    problem = heated_contact(0.5, shear=shear)
    found = solve(problem, Options())
    finer = values(solve(problem, Options(points=2 * found.scaled.x.size - 1)))
    for name, value in values(found).items():
        bar = getattr(found.errors, name)
        assert 0.0 < bar < 1.0
        assert value == pytest.approx(finer[name], rel=bar)


def test_the_traction_of_a_coarse_grid_without_heat_is_left_out_of_its_error_bar():
    """At 2 % the grid before the last has 48 intervals and is not heated: Newtonian traction."""
    found = solve(*case_from_tables(tomllib.loads(template_text("thermal")))).errors
    assert found.traction_mid_film is None or found.traction_mid_film < 1.0
    assert found.film_rise_max is None or found.film_rise_max < 1.0


@pytest.mark.parametrize("angle", [0.0, pytest.param(math.pi / 4, marks=pytest.mark.slow)])
def test_ripples_of_a_wave_have_error_bars_that_hold(angle):
    wave = {"type": "wave", "amplitude": 6e-8, "wavelength": 5e-5, "angle": angle}
    case = moes_contact(75.0, 11.0).model_dump(exclude_none=True)
    case["surface_2"] |= {"roughness": wave}
    found = solve(ContactProblem.model_validate(case), Options())
    finer = solve(found.problem, Options(points=2 * found.scaled.x.size - 1)).roughness
    for name in ("ripple_film", "ripple_pressure"):
        bar = getattr(found.errors, name)
        assert 0.0 < bar < 0.2
        assert getattr(found.roughness, name) == pytest.approx(getattr(finer, name), rel=bar)


@pytest.mark.parametrize(("load", "speed", "resolved"), [(10, 2, True), (10, 10, False)])
def test_a_spike_narrower_than_the_mesh_is_stated(load, speed, resolved):
    problem = moes_contact(load, speed)
    found = solve(problem, Options())
    finer = solve(problem, Options(points=4 * found.scaled.x.size - 3)).scaled.pressure.max()
    change = finer / found.scaled.pressure.max() - 1.0
    assert found.errors.spike_resolved == resolved
    assert abs(change) <= found.errors.pressure_max


def test_an_isothermal_film_in_pure_rolling_has_neither_traction_nor_temperature_bars():
    errors = solve(moes_contact(20.0, 5.0), Options()).errors
    assert errors.pressure_max is not None
    assert [getattr(errors, name) for name in NAMES[1:]] == [None, None, None]


@pytest.mark.parametrize(
    ("load", "speed", "changes"),
    [
        (6.38, 15.98, {"shear": {"law": "eyring", "stress": 2.8e6}}),
        (144.0, 19.2, {"shear": {"law": "eyring", "stress": 4e6}}),
    ],
)
def test_thinning_at_a_steep_spike_converges_with_damping(load, speed, changes):
    # pure rolling: undamped, mobility and pressure of the spike oscillate and diverge
    case = moes_contact(load, speed).model_dump(exclude_none=True)
    case["lubricant"] |= changes
    found = solve(ContactProblem.model_validate(case), Options())
    assert max(found.errors.central, found.errors.minimum) <= 0.02


@pytest.mark.parametrize("load", [pytest.param(3.0, marks=pytest.mark.slow), 100.0])
def test_between_warm_bodies_the_film_hardly_depends_on_the_domain(load):
    # so slow that the oil is as warm as the bodies before it reaches the domain
    case = heated_contact(0.5).model_dump(exclude_none=True)
    case["contact"] = {"radius": 0.02, "moes_load": load, "moes_speed": 5.0}
    for side in ("surface_1", "surface_2"):
        case[side]["temperature"] = heated_contact(0.5).inlet_temperature + 25.0
    problem = ContactProblem.model_validate(case)
    found = solve(problem, Options())
    x, y = found.scaled.x, found.scaled.y
    domain = Domain(x=(1.5 * x[0], 1.5 * x[-1]), y=(1.5 * y[0], 1.5 * y[-1]))
    points = 3 * (x.size - 1) // 32 * 16 + 1
    options = Options(points=points, domain=domain, edges="far_field", extrapolate=True)
    wide = solve(problem, options)
    for name in ("central", "minimum"):
        there = getattr(wide.film_scaled, name)
        assert getattr(found.film_scaled, name) == pytest.approx(there, rel=5e-3)


def test_a_transient_run_finds_its_grid_and_resolves_what_moves_in():
    case = tomllib.loads(template_text("passing-dent"))
    del case["numerics"]
    case["transient"]["duration"] = "0.06 ms"
    case["surface_1"]["roughness"]["x"] = "-350 um"
    run = solve_transient(ContactProblem.model_validate(case), Options())
    assert run.status.converged
    assert run.start.errors.central <= 0.02
    width = (run.start.x[1] - run.start.x[0]) * 1e6
    assert 4.0 * 50.0 / width > 12.0  # four radii of the dent


def errors(central: float, minimum: float, iteration: float = 1e-4) -> ErrorEstimate:
    return ErrorEstimate(
        discretisation_central=central,
        discretisation_minimum=minimum,
        iteration_central=iteration,
        iteration_minimum=iteration,
        domain=1e-3,
    )


@pytest.mark.parametrize(
    ("minimum", "spare"),
    [(0.001, MOST_SPARE * 0.01), (0.007, SPARE_PART * 0.002), (0.012, -0.0015)],
)
def test_the_iteration_may_keep_what_the_other_errors_leave(minimum: float, spare: float) -> None:
    goal = Goal(ScaledProblem.of(moes_contact(400.0, 1.0)), Options(error=0.01))
    assert goal.spare(errors(0.001, minimum)) == pytest.approx(spare)
    assert goal.spare(None) == 0.0
    assert goal.spare(errors(0.001, minimum)) <= goal.most_spare


@pytest.mark.parametrize(
    ("minimum", "thinnest", "lines"),
    [(0.017, 0.9, 161), (0.021, 0.9, 193), (0.014, 0.9, None), (0.025, 0.1, None)],
)
def test_a_minimum_that_errs_by_the_mesh_along_y_alone_gets_as_many_more_lines_as_it_needs(
    minimum: float, thinnest: float, lines: int | None
) -> None:
    scaled = ScaledProblem.of(moes_contact(400.0, 1.0))
    options = settled(scaled.problem, Options())
    level = with_minimum_at(thinnest, finest_grid(scaled, options.on_points(97, 97)))
    assert Goal(scaled, options).more_lines(level, errors(0.008, minimum)) == lines


def test_a_minimum_at_the_sides_gets_the_most_lines_where_the_mesh_width_cannot_be_halved() -> None:
    scaled = ScaledProblem.of(moes_contact(400.0, 1.0))
    options = settled(scaled.problem, Options())
    level = with_minimum_at(0.9, finest_grid(scaled, options.on_points(97, 161)))
    assert Goal(scaled, options).more_lines(level, errors(0.008, 0.025)) is None
    limited = options.model_copy(update={"max_memory": 1})
    assert Goal(scaled, limited).more_lines(level, errors(0.008, 0.025)) == 193


@pytest.mark.parametrize(
    ("central", "minimum", "nodes"),
    [
        (0.006, 0.011, (161, 161)),
        (0.006, 0.016, (193, 193)),
        (0.006, 0.03, None),  # half the mesh width
        (0.012, 0.012, (161, 161)),
    ],
)
def test_a_bar_that_hardly_exceeds_the_error_gets_a_grid_between(
    central: float, minimum: float, nodes: tuple[int, int] | None
) -> None:
    scaled = ScaledProblem.of(moes_contact(400.0, 10.0))
    options = settled(scaled.problem, Options())
    level = with_minimum_at(0.1, finest_grid(scaled, options.on_points(129, 129)))
    assert Goal(scaled, options).other_nodes(level, errors(central, minimum)) == nodes


@pytest.mark.parametrize(("radius_ratio", "nodes"), [(1.0, (193, 193)), (0.5, None)])
def test_with_scarce_oil_the_margin_of_a_grid_between_is_wider_and_wide_contacts_get_none(
    radius_ratio: float, nodes: tuple[int, int] | None
) -> None:
    """A circle that is flooded gets 161 nodes; a wide drive (M = 489) took four times as long."""
    flooded = moes_contact(400.0, 10.0, radius_ratio=radius_ratio)
    starved = flooded.model_copy(update={"supply": Supply(ratio=0.9)})
    scaled, options = ScaledProblem.of(starved), settled(starved, Options())
    level = with_minimum_at(0.1, finest_grid(scaled, options.on_points(129, 129)))
    assert Goal(scaled, options).other_nodes(level, errors(0.012, 0.012)) == nodes


def test_another_grid_fits_beside_the_one_that_is_kept() -> None:
    problem = moes_contact(400.0, 1.0)
    scaled, options = ScaledProblem.of(problem), settled(problem, Options())
    level = with_minimum_at(0.1, finest_grid(scaled, options.on_points(129, 129)))
    both = needed_memory(options.on_points(161, 161), problem)
    both += RESTING_PART * needed_memory(options.on_points(129, 129), problem)
    for part, nodes in ((1.01, (161, 161)), (0.99, None)):
        limited = options.model_copy(update={"max_memory": int(part * both)})
        assert Goal(scaled, limited).other_nodes(level, errors(0.012, 0.012)) == nodes


def test_few_other_grids_are_tried_each_finer_than_the_one_before() -> None:
    """A heated ellipse (M = 431) went from 97 to 129, back to 97 and to 129 nodes again."""
    scaled = ScaledProblem.of(moes_contact(400.0, 10.0))
    options = settled(scaled.problem, Options())
    goal, found = Goal(scaled, options), []
    for nodes in (129, 129, 161, 193, 225):
        level = with_minimum_at(0.1, finest_grid(scaled, options.on_points(nodes, nodes)))
        found.append(goal.other_nodes(level, errors(0.006, 0.011)))
    assert found == [(161, 161), None, (193, 193), (225, 225), None]
    assert MOST_OTHERS == 3


def test_another_grid_has_the_time_that_its_nodes_take(monkeypatch) -> None:
    scaled = ScaledProblem.of(moes_contact(400.0, 10.0))
    options = settled(scaled.problem, Options())
    level = with_minimum_at(0.1, finest_grid(scaled, options.on_points(129, 129)))
    monkeypatch.setattr("tehl.solver.judging.goal.working_time", lambda: 10.0)
    for left, nodes in ((25.0, (161, 161)), (15.0, None)):
        goal = Goal(scaled, options, until=10.0 + left, _started=0.0, _last=0.0)
        assert goal.other_nodes(level, errors(0.006, 0.011)) == nodes


def test_the_minimum_at_the_exit_of_a_heavy_slender_contact_has_a_least_bar() -> None:
    """On a quarter of the lines grids may agree by chance: bearings erred by up to three bars."""
    bearing = moes_contact(5949.0, 7.0, radius_ratio=24.0)
    found, scaled = (
        solve(bearing, Options(extrapolate=True).on_points(193, 49)),
        ScaledProblem.of(bearing),
    )
    expected = third_order_bar(scaled, domain_of(scaled, found.options), 193, 49)
    assert found.errors.discretisation_minimum >= PART_AT_EXIT * expected
    finer = solve(bearing, Options(extrapolate=True).on_points(769, 193))
    change = abs(finer.film_scaled.minimum / found.film_scaled.minimum - 1.0)
    assert change < found.errors.minimum


def test_so_has_that_of_scarce_oil() -> None:
    flooded = moes_contact(3451.0, 6.3, radius_ratio=45.0)
    starved = flooded.model_copy(update={"supply": Supply(ratio=0.9)})
    found = solve(starved, Options(extrapolate=True).on_points(257, 65))
    edges = Domain(x=tuple(found.scaled.x[[0, -1]]), y=tuple(found.scaled.y[[0, -1]]))
    expected = third_order_bar(ScaledProblem.of(starved), edges, 257, 65)
    assert found.errors.discretisation_minimum >= 0.999 * PART_AT_EXIT * expected


def with_minimum_at(y: float, grid: Grid) -> Mock:
    """Return a level whose film is thinnest at a distance from the centre line."""
    film = np.abs(grid.y - y)[:, None] + np.ones(grid.nx)
    return Mock(grid=grid, film=Mock(h=film))


@pytest.mark.parametrize("place", [0.985, 0.99, 0.9925, 0.995])
def test_a_lobe_that_lines_miss_is_within_reach_of_the_film_that_was_found(place: float) -> None:
    """Convex and steep beyond the edge, as of outer rings; or the film is thinnest elsewhere."""
    grid = finest_grid(ScaledProblem.of(moes_contact(400.0, 1.0)), Options().on_points(193, 193))
    aside = grid.y - place
    lobe = 0.05 + 0.5 * np.sqrt(aside**2 + 1e-5) + 2.0 * np.maximum(aside, 0.0)
    for elsewhere in (1.0, 0.0517):
        exit_film = elsewhere + (grid.x - 1.0) ** 2 + grid.y[:, None] ** 2
        film = np.minimum(lobe[:, None] + grid.x**2, exit_film)
        level = Mock(grid=grid, film=Mock(h=film))
        found, true = film_summary(grid, film).minimum, min(0.05 + 0.5 * 1e-5**0.5, elsewhere)
        assert (1.0 - side_reach(level) / SAMPLED) * found < true < 1.04 * found
        assert side_reach(level, scarce=True) >= 2.0 * side_reach(level)


def test_a_flooded_film_to_which_a_supply_is_stated_has_the_goal_of_its_centre() -> None:
    scaled = ScaledProblem.of(moes_contact(400.0, 1.0))
    options = settled(scaled.problem, Options(error=0.01))
    level = with_minimum_at(0.9, finest_grid(scaled, options.on_points(97, 97)))
    goal = Goal(scaled, options, passed_on=1.0)
    assert goal.is_met(errors(0.004, 0.025))
    assert not goal.is_met(errors(0.0065, 0.001))
    assert goal.more_lines(level, errors(0.004, 0.025)) is None
    assert goal.spare(errors(0.001, 0.025)) == pytest.approx(MOST_SPARE * FLOODED_PART * 0.01)
    # the more oil comes, the less of its error is passed on; the film itself may be asked for
    for ratio, target in ((0.8, 1.64 * FLOODED_PART * 0.01), (1.2, 0.01)):
        passed_on = part_passed_on(Supply(ratio=ratio))
        assert Goal(scaled, options, passed_on=passed_on).target == pytest.approx(target)


@pytest.mark.parametrize(
    ("central", "iteration", "awaits"),
    [(0.011, 0.004, True), (0.008, 0.004, False), (0.013, 0.003, False)],
)
def test_cycles_go_on_where_their_error_alone_exceeds_the_goal(
    central: float, iteration: float, awaits: bool
) -> None:
    """A quarter of it is left, and a finer grid costs more."""
    goal = Goal(ScaledProblem.of(moes_contact(400.0, 10.0)), Options(error=0.01))
    found = replace(errors(central - iteration, 0.001), iteration_central=iteration)
    assert goal.awaits_cycles(found, 1.0) is awaits
    left = iter((found, replace(found, iteration_central=0.0)))  # the next cycle leaves nothing
    run = Mock(goal=goal, errors=lambda: next(left), minimum_part=lambda: 1.0)
    run.traces, run.options, run.strategy.patience = [GridTrace()], Options(), 1
    FilmSolver._reach_goal(run)
    assert run._go_further.call_count == int(awaits)


@pytest.mark.parametrize(
    ("diverged", "coupled", "damping", "ends"),
    [(True, True, 1.0, True), (True, True, 0.3, False), (True, False, 1.0, False)],
)
def test_an_undamped_attempt_ends_where_its_heat_runs_away(
    diverged: bool, coupled: bool, damping: float, ends: bool
) -> None:
    trace = GridTrace(coupled=coupled)
    trace.diverged = diverged
    run = Mock(traces=[trace], strategy=Mock(damping=damping))
    assert FilmSolver._runs_away(run) is ends


def test_a_flooded_film_is_solved_as_exactly_as_it_is_passed_on(monkeypatch) -> None:
    asked: list[float] = []

    def strategies(*_, passed_on: float, **__):
        asked.append(passed_on)
        raise ArithmeticError

    monkeypatch.setattr(steady, "try_strategies", strategies)
    problem = moes_contact(400.0, 10.0).model_copy(update={"supply": Supply(ratio=0.5)})
    with pytest.raises(ArithmeticError):
        steady.flooded_film(problem, Options())
    assert asked == [pytest.approx(0.8)]


@pytest.mark.parametrize(
    ("minimum", "oil", "awaits"),
    [(0.003, 0.007, True), (0.003, 0.004, False), (0.012, 0.007, False)],
)
def test_cycles_go_on_where_the_oil_balance_alone_exceeds_the_error_to_reach(
    minimum: float, oil: float, awaits: bool
) -> None:
    goal = Goal(ScaledProblem.of(moes_contact(400.0, 10.0)), Options(error=0.01))
    found = replace(errors(0.001, minimum), supply=0.001 + oil)
    run = Mock(goal=goal, balance=Mock(oil_error=oil), errors=lambda: found)
    assert GridIteration.awaits_oil(run) is awaits


def test_another_solve_on_the_grid_of_a_result_has_its_domain():
    """That follows from the error, which stays: without it the inlet begins nearer."""
    first = solve(moes_contact(20.0, 8.0), Options(error=0.003))
    again = solve(first.problem, first.grid_options)
    np.testing.assert_array_equal(again.scaled.x, first.scaled.x)
    np.testing.assert_array_equal(again.scaled.y, first.scaled.y)
    assert again.film.central == pytest.approx(first.film.central, rel=first.errors.central)
