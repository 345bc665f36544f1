"""The strategies of the ladder: what they combine, and what it saves."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from unittest.mock import Mock

import pytest

from benchmarks import machines
from tehl.api.problem import case_from_tables
from tehl.contact.heat import Thermal
from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.contact.supply import Supply
from tehl.estimate.nodes import finest_grid
from tehl.estimate.scaling import ScaledProblem
from tehl.kernels.energy.march import LARGEST_KELVIN_STEP
from tehl.solver import attempts, steady
from tehl.solver.attempts import Climb
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.ladder import (
    AT_EDGES,
    BETWEEN_ROUGH,
    COUPLED,
    STARVED_DAMPING,
    STEEPEST_SPEED,
    THIRD_ORDER_STRATEGIES,
    TOUCHING,
    UNCOMBINED,
    UNDAMPED,
    UNDAMPED_FIRST,
    Strategy,
    ladder,
)
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.relaxation import BROAD, FAST, THIN
from tehl.solver.judging.convergence import Criteria, DivergedError
from tehl.solver.judging.goal import Goal
from tehl.solver.judging.measures import film_extremes
from tehl.solver.monitor import SILENT
from tests.reference import heated_contact, moes_contact
from tests.solver.rough import wavy
from tests.solver.test_line import line
from tests.solver.test_touching import through_film

OPTIONS = Options(extrapolate=True)
NODES = 193


@pytest.fixture(scope="module")
def hybrid_bearing() -> ContactProblem:
    """A ball on the inner ring of a hybrid bearing, M = 9200, whose oil thins by shear."""
    tables = {
        "contact": {
            "hertz_pressure": "2.0 GPa",
            "entrainment_speed": "2.0 m/s",
            "slide_roll_ratio": 0.01,
        },
        "surface_1": {"material": "silicon-nitride", "radius": "6 mm"},
        "surface_2": {"material": "steel", "radius_x": "16 mm", "radius_y": "-6.24 mm"},
        "lubricant": {
            "viscosity": {"law": "barus", "eta_0": "8 mPa s", "alpha": "18 1/GPa"},
            "density": {"law": "dowson-higginson", "rho_0": "880 kg/m^3"},
            "shear": {"law": "eyring", "stress": "6 MPa"},
        },
    }
    return case_from_tables(tables)[0]


def test_damped_strategies_combine_cycles_with_a_wedge_of_third_order_alone(
    hybrid_bearing: ContactProblem,
) -> None:
    rungs = ladder(ScaledProblem.of(hybrid_bearing), OPTIONS, rough=False)
    damped = [one for one in rungs if one.damping < 1.0]
    assert damped[0].memory > 0
    assert all(one.memory == 0 for one in damped if one.wedge_order == 2)


def test_combined_cycles_are_fewer_and_give_the_same_film(
    hybrid_bearing: ContactProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    tables = hybrid_bearing.model_dump(exclude_none=True)
    tables["lubricant"]["viscosity"]["eta_0"] *= 0.3  # M = 27,400
    tables["lubricant"]["shear"] = {"law": "newtonian"}
    heavy = ContactProblem.model_validate(tables)
    rungs = ladder(ScaledProblem.of(heavy), OPTIONS, rough=False)
    steep = next(one for one in rungs if one.memory)
    cycles, films = [], []
    for memory in (0, steep.memory):
        one = replace(steep, memory=memory)
        monkeypatch.setattr(steady, "ladder", lambda *_, one=one, **__: (one,))
        options = OPTIONS.on_points(NODES, NODES // 2 + 1)
        found = steady.try_strategies(heavy, options, monitor=SILENT, rough=False)[1]
        assert found.status.converged
        cycles.append(sum(NODES in report.points for report in found.history))
        films.append(found.film_scaled.minimum)
    assert cycles[1] <= 0.8 * cycles[0]  # 9 for 12
    assert films[1] == pytest.approx(films[0], rel=2e-3)


def test_the_steep_front_of_a_thinning_oil_converges_without_combined_cycles(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An outer ring, M = 480, L = 22, in nearly pure rolling."""
    tables = {
        "contact": {
            "hertz_pressure": "1.5 GPa",
            "entrainment_speed": "8 m/s",
            "slide_roll_ratio": 0.02,
        },
        "surface_1": {"material": "steel", "radius": "6 mm"},
        "surface_2": {"material": "steel", "radius_x": "-30 mm", "radius_y": "-6.3 mm"},
        "lubricant": {
            "viscosity": {"law": "barus", "eta_0": "64 mPa s", "alpha": "20 1/GPa"},
            "density": {"law": "dowson-higginson", "rho_0": "880 kg/m^3"},
            "shear": {"law": "eyring", "stress": "2.4 MPa"},
        },
    }
    monkeypatch.setattr(steady, "ladder", lambda *_, **__: (UNCOMBINED,))
    ring, options = case_from_tables(tables)[0], OPTIONS.on_points(97, 49)
    found = steady.try_strategies(ring, options, monitor=SILENT, rough=False)[1]
    assert found.status.converged


def test_heavy_films_are_tried_undamped_first_which_saves_cycles(
    hybrid_bearing: ContactProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    usual = ladder(ScaledProblem.of(hybrid_bearing), OPTIONS, rough=False)
    cycles, films = [], []
    for one in usual[:2]:
        monkeypatch.setattr(steady, "ladder", lambda *_, one=one, **__: (one,))
        options = OPTIONS.on_points(129, 65)
        found = steady.try_strategies(hybrid_bearing, options, monitor=SILENT, rough=False)[1]
        assert found.status.converged or found.status.cause == "grid_too_coarse"
        cycles.append(len(found.history))
        films.append(found.film_scaled.minimum)
    assert usual[0] is UNDAMPED_FIRST
    assert cycles[0] <= 0.8 * cycles[1]
    assert films[0] == pytest.approx(films[1], rel=2e-3)
    tables = hybrid_bearing.model_dump(exclude_none=True)
    starved = ContactProblem.model_validate({**tables, "supply": {"ratio": 0.7}})
    assert UNDAMPED_FIRST not in ladder(ScaledProblem.of(starved), OPTIONS, rough=False)


def test_steep_fronts_are_tried_without_combined_cycles_first(
    hybrid_bearing: ContactProblem,
) -> None:
    viscous = hybrid_bearing.model_dump(exclude_none=True)
    viscous["lubricant"]["viscosity"]["eta_0"] *= 40.0
    for problem, place in ((hybrid_bearing, -1), (ContactProblem.model_validate(viscous), 1)):
        rungs = ladder(ScaledProblem.of(problem), OPTIONS, rough=False)
        third = [one for one in rungs if one.wedge_order is None]
        assert third[place] is UNCOMBINED


@pytest.mark.parametrize("heat", [None, {}])
@pytest.mark.parametrize("supply", [None, {"ratio": 0.5}])
def test_the_steepest_fronts_are_tried_with_a_wedge_of_second_order_soon(
    hybrid_bearing: ContactProblem, heat: dict | None, supply: dict | None
) -> None:
    """After two strategies where oil heats, else after that one which damps as well."""
    tables, third = hybrid_bearing.model_dump(exclude_none=True), []
    tables |= {"thermal": heat, "supply": supply}
    if heat is not None:
        tables["lubricant"] |= {"conductivity": 0.14, "heat_capacity": 2000.0}
        tables["lubricant"]["viscosity"] |= {"gamma": 0.04, "reference_temperature": 313.15}
        tables["lubricant"]["density"]["beta"] = 7e-4
    for speed in (14.0, 25.0):
        tables["contact"] |= {"entrainment_speed": None, "moes_speed": speed}
        scaled = ScaledProblem.of(ContactProblem.model_validate(tables))
        rungs = ladder(scaled, OPTIONS, rough=False)
        third.append(next(k for k, one in enumerate(rungs) if one.wedge_order == 2))
        assert (scaled.groups.L > STEEPEST_SPEED) == (speed > 20.0)
    assert third[0] >= third[1]
    assert third[1] == (THIRD_ORDER_STRATEGIES if heat is not None else 3 + (supply is not None))
    assert heat is not None or rungs[third[1] - 1].damping < 1.0


@pytest.mark.parametrize("thins", [False, True])
@pytest.mark.parametrize("early", [False, True])
def test_a_strategy_goes_on_from_the_grids_that_another_one_solved(
    monkeypatch: pytest.MonkeyPatch, *, thins: bool, early: bool
) -> None:
    """Not where it heats a coarser grid than the other, which then has no start for it."""
    tables = moes_contact(50.0, 8.0, radius_ratio=4.0).model_dump(exclude_none=True)
    tables["contact"]["slide_roll_ratio"] = 0.02
    if thins:
        tables["lubricant"]["shear"] = {"law": "eyring", "stress": 5e6}
    case, options = ContactProblem.model_validate(tables), OPTIONS.on_points(257, 129)
    first = Strategy(relaxation=BROAD if thins else FAST)
    rungs = first, replace(first, early=early)
    monkeypatch.setattr(steady, "ladder", lambda *_, **__: rungs)
    usual = steady.try_strategies(case, options, monitor=SILENT, rough=False)[1]
    runs: list[FilmSolver] = []
    whole = FilmSolver._approximate

    def fails_once(run: FilmSolver, levels: Sequence[Level]) -> bool:
        if levels[-1].grid.points == (129, 65) and not runs:
            runs.append(run)
            raise DivergedError
        return whole(run, levels)

    monkeypatch.setattr(FilmSolver, "_approximate", fails_once)
    found = steady.try_strategies(case, options, monitor=SILENT, rough=False)[1]
    once, both = (Counter(one.points for one in run.history) for run in (usual, found))
    again = {points for points in both if both[points] > once[points]}
    assert again == ({(65, 33)} if thins and early else set())
    assert found.film_scaled.central == pytest.approx(usual.film_scaled.central, rel=2e-3)
    assert found.film_scaled.minimum == pytest.approx(usual.film_scaled.minimum, rel=2e-3)
    assert found.errors.central == pytest.approx(usual.errors.central, rel=0.2)


@pytest.mark.parametrize(
    ("residuals", "kelvins", "reached", "leads"),
    [
        ((2e-3, 9e-5), 1.0, None, False),
        ((2e-4, 5e-4), 1.0, None, True),
        ((2e-3, 9e-5), 1.0, 0.09, True),
        ((2e-3, 9e-5), LARGEST_KELVIN_STEP, None, True),
    ],
)
def test_a_grid_is_not_too_coarse_where_cycles_lead_away_or_a_coarser_one_has_a_film(
    residuals: tuple[float, ...], kelvins: float, reached: float | None, leads: bool
) -> None:
    """A tooth (M = 6,534): bars of 9 % on 257 nodes, and of 480 % after 7 cycles on 513.

    Heat that runs away leads away too (a heated ellipse, M = 431, on 193 x 193 nodes).
    """
    reports = [Mock(residual=one, temperature_change=kelvins) for one in residuals]
    before = None if reached is None else ((257, 65), reached)
    run = Mock(traces=[Mock(reports=reports)], reached_before=Mock(return_value=before))
    assert FilmSolver.leads_away(run) is leads


@pytest.mark.parametrize(
    ("minimum", "missing", "found"),
    [(1e-3, 1e-4, ((257, 65), 0.01)), (-1e-3, 1e-4, None), (1e-3, -0.068, None)],
)
def test_a_grid_without_a_positive_film_under_its_load_has_no_error_to_fall_back_on(
    monkeypatch: pytest.MonkeyPatch, minimum: float, missing: float, found: object
) -> None:
    """The hint named errors of films that are negative (a tilted roller, M = 15) or carry another
    load (a hypoid gear, -6.8 %)."""
    level = Mock(share=Mock(bounds_film=False), equations=Mock(floor=1e-5))
    level.grid.points = (257, 65)
    report = Mock(load_error=missing)
    traces = [Mock(reports=[report], minimum=Mock(values=[minimum])) for _ in range(4)]
    traces.append(Mock(reports=[], minimum=Mock(values=[])))  # it diverged before its first cycle
    errors = Mock(return_value=Mock(film=Mock(return_value=0.01)))
    monkeypatch.setattr("tehl.solver.cycle.film_solver.estimated_errors", errors)
    run = Mock(traces=traces, levels=[level] * 5)
    assert FilmSolver.reached_before(run, last=True) == found


@pytest.mark.parametrize(("kelvins", "starts"), [(39.0, True), (LARGEST_KELVIN_STEP, False)])
def test_no_grid_starts_from_a_film_whose_heat_runs_away(kelvins: float, starts: bool) -> None:
    """A turned ellipse (M = 1,611) heated by 753 K on 321 lines: 641 took half of all its time."""
    first = Mock(residual=7.8e-3)
    last = Mock(cycle=10, residual=1.2e-3, change=0.15, load_error=6.6e-3)
    last.temperature_change = kelvins
    run = Mock(strategy=Mock(newton=False), options=Options())
    trace = Mock(reports=[first, last], criteria=Criteria())
    run.finest.grid.is_closed = False
    assert FilmSolver._is_acceptable(run, trace) is starts


def test_a_grid_that_diverges_before_it_is_heated_has_a_trace_of_its_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    whole = FilmSolver._start_heat

    def fails(run: FilmSolver, levels: Sequence[Level]) -> int:
        if len(levels) == 2:
            raise DivergedError
        return whole(run, levels)

    monkeypatch.setattr(FilmSolver, "_start_heat", fails)
    attempt, found = steady.try_strategies(
        heated_contact(), OPTIONS.on_points(129, 129), monitor=SILENT, rough=False
    )
    run = attempt.run
    assert [trace.columns for trace in run.traces] == [level.grid.nx for level in run.levels]
    assert [trace.diverged for trace in run.traces] == [
        False,
        True,
        *[False] * (len(run.levels) - 2),
    ]
    assert found.status.converged


def test_scarce_oil_is_tried_undamped_unless_heavily_loaded_and_is_damped_more(
    hybrid_bearing: ContactProblem,
) -> None:
    def rungs(problem: ContactProblem, **tables: object) -> tuple[Strategy, ...]:
        one = problem.model_copy(update=tables)
        return ladder(ScaledProblem.of(one), OPTIONS, rough=False)

    scarce, light = {"supply": Supply(ratio=0.6)}, moes_contact(50.0, 8.0)
    light = light.model_copy(update={"thermal": Thermal()})
    viscous = moes_contact(50.0, 20.0).model_copy(update={"thermal": Thermal()})
    assert rungs(light, **scarce)[1] is rungs(viscous, **scarce)[1] is UNDAMPED
    assert UNDAMPED not in (*rungs(light), *rungs(hybrid_bearing, **scarce))
    assert UNCOMBINED in rungs(light, **scarce)
    assert AT_EDGES in rungs(hybrid_bearing, **scarce)
    steep, less = (
        next(one.damping for one in some if one.damping < 1.0)
        for some in (rungs(hybrid_bearing, **scarce), rungs(hybrid_bearing))
    )
    assert steep == STARVED_DAMPING < less


BALLS = {
    "thinning": ("4.8 mm", "-27.8 mm", "-5.01 mm", "12.1 m/s", 0.0174, "2.39 MPa", "22.5 1/GPa"),
    "heated": ("2.1 mm", "5.4 mm", "-2.164 mm", "14.06 m/s", 0.0292, "2.7 MPa", "16.9 1/GPa"),
}


@pytest.mark.parametrize(("name", "nodes"), [("thinning", 129), ("heated", 161)])
def test_a_very_steep_front_converges(
    monkeypatch: pytest.MonkeyPatch, name: str, nodes: int
) -> None:
    """Rings of bearings, L = 27 and 30: neither the coarse grid nor heat moves the front away."""
    ball, x, y, speed, slip, stress, alpha = BALLS[name]
    tables: dict[str, dict[str, object]] = {
        "contact": {
            "hertz_pressure": "1.5 GPa",
            "entrainment_speed": speed,
            "slide_roll_ratio": slip,
        },
        "surface_1": {"material": "steel", "radius": ball},
        "surface_2": {"material": "steel", "radius_x": x, "radius_y": y},
        "lubricant": {
            "temperature": "53.4 degC",
            "conductivity": "0.14 W/m/K",
            "heat_capacity": "2000 J/kg/K",
            "viscosity": {
                "law": "walther",
                "nu_40": "150 mm^2/s",
                "nu_100": "14.7 mm^2/s",
                "alpha": alpha,
            },
            "density": {"law": "dowson-higginson", "rho_0": "880 kg/m^3"},
            "shear": {"law": "eyring", "stress": stress},
        },
    }
    if name == "heated":
        tables["thermal"] = {}
    monkeypatch.setattr(steady, "ladder", lambda *_, **__: (UNCOMBINED,))
    ring, options = case_from_tables(tables)[0], OPTIONS.on_points(nodes, nodes // 2 + 1)
    found = steady.try_strategies(ring, options, monitor=SILENT, rough=False)[1]
    assert found.status.converged
    assert abs(found.history[-1].temperature_rise) < 60.0


def test_a_line_stays_one_row_with_a_wedge_of_another_order(monkeypatch):
    """Strategies with a wedge of their own have as many lines as columns, but on a line contact."""
    second = (Strategy(relaxation=FAST, wedge_order=2),)
    monkeypatch.setattr(steady, "ladder", lambda *_, **__: second)
    found = steady.solve(line(20.0, 10.0), Options(points=129, extrapolate=True))
    assert found.scaled.film.shape == (1, 129)


def tried(
    monkeypatch: pytest.MonkeyPatch,
    ratio: float,
    lines: int,
    wanted: Sequence[tuple[int, int] | None],
) -> list[tuple[tuple[int, int], str, tuple[int, int] | None]]:
    """Return grid, smoother and grid gone on from of attempts that fail, or want another grid.

    By two strategies, and one with a wedge of second order, on 129 columns.
    """
    found: list[tuple[tuple[int, int], str, tuple[int, int] | None]] = []
    wishes = iter(wanted)

    def attempt(
        climb: Climb, plan: Options, strategy: Strategy, solved: object = None, *, force: bool
    ) -> Mock:
        del climb, force
        order = "" if plan.wedge_order is None else f" {plan.wedge_order}"
        found.append((plan.shape[::-1], strategy.name + order, solved or None))
        return Mock(run=Mock(wanted=next(wishes, None), solved=plan.shape[::-1]), is_final=False)

    monkeypatch.setattr(Climb, "_attempt", attempt)
    monkeypatch.setattr(attempts, "_better", lambda _, attempt: attempt)
    scaled = ScaledProblem.of(moes_contact(20.0, 5.0, radius_ratio=ratio))
    rungs = Strategy(relaxation=FAST), Strategy(relaxation=THIN)
    rungs = (*rungs, replace(rungs[0], wedge_order=2))
    climb = Climb(scaled, Goal(scaled, Options()), SILENT, Mock())
    climb.best(OPTIONS.on_points(129, lines), rungs)
    return found


def test_a_strategy_begins_on_the_grid_to_which_the_error_of_the_one_before_led(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert tried(monkeypatch, 0.5, 129, [(129, 257)]) == [
        ((129, 129), "fast", None),
        ((129, 257), "fast", None),
        ((129, 257), "thin", (129, 257)),
        ((129, 129), "fast 2", None),
    ]


def test_few_lines_are_followed_by_as_many_as_columns_before_a_wedge_of_second_order(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With few lines the edge of scarce oil may not rest."""
    assert tried(monkeypatch, 4.0, 33, []) == [
        ((129, 33), "fast", None),
        ((129, 33), "thin", (129, 33)),
        ((129, 129), "fast", None),
        ((129, 129), "thin", (129, 129)),
        ((129, 129), "fast 2", None),
    ]


def test_cycles_that_lead_away_do_not_blame_the_grid() -> None:
    """A cam with a thick film (M = 245, L = 14): that of the first strategy wanders."""
    found = steady.solve(machines.contact(17, 30)[2], Options())
    assert found.errors.film() < 0.01


def test_a_grid_that_oscillates_is_not_kept_for_another_strategy(monkeypatch) -> None:
    """A test rig (M = 2900): bars by the film that swings on 161 columns ask for 641 columns."""
    monkeypatch.setattr(steady, "ladder", lambda *_, **__: COUPLED[:2])
    found = steady.solve(machines.contact(97, 109)[2], Options())
    assert found.scaled.film.shape[1] == 321
    assert found.errors.film() < 0.01


def test_a_film_too_thin_for_coarse_grids_converges_by_small_steps_of_relaxation() -> None:
    problem = moes_contact(120_000.0, 3.0, radius_ratio=16.0)
    scaled, options = ScaledProblem.of(problem), OPTIONS.on_points(257, 129)
    thinnest = ladder(scaled, options, rough=False)[0]
    assert thinnest.relaxation is THIN
    hierarchy = Hierarchy.on(finest_grid(scaled, options), scaled, options, THIN)
    run = FilmSolver(hierarchy, thinnest)
    assert run.solve(force=True)
    central, minimum = film_extremes(run.finest)
    assert 0.6 * central < minimum < central
    assert central == pytest.approx(hierarchy.expected_film, rel=0.3)
    # between less thin ones the usual strategies, which most of them take, come before
    less = ScaledProblem.of(moes_contact(60_000.0, 3.0, radius_ratio=16.0))
    assert [one.relaxation is THIN for one in ladder(less, options, rough=False)[:3]] == [0, 0, 1]


@pytest.mark.parametrize(("touches", "rungs"), [(False, BETWEEN_ROUGH), (True, TOUCHING)])
def test_rough_contacts_fall_back_to_a_wedge_of_second_order_unless_nodes_or_order_are_stated(
    touches: bool, rungs: tuple[Strategy, ...]
) -> None:
    problem = wavy((200.0, 6.0), (0.1, 1.0, 0.0))
    scaled = ScaledProblem.of(through_film(problem, 0.01) if touches else problem)
    orders = [one.wedge_order for one in ladder(scaled, Options(), rough=True)]
    assert orders == [None, None, *(2 for _ in rungs)]
    for stated in (Options(points=129), Options(wedge_order=3)):
        assert ladder(scaled, stated, rough=True) == rungs


@pytest.mark.parametrize(("rms", "cycles", "first"), [(0.96e-6, 20, "fast"), (1e-8, 40, "rough")])
def test_rough_surfaces_that_asperities_below_the_mesh_hold_apart_are_not_combined(
    rms: float, cycles: int, first: str
) -> None:
    """Combined cycles pass 4 % of the load from oil to asperities and back, by all strategies."""
    tables = moes_contact(214.0, 7.9, radius_ratio=0.53).model_dump(exclude_none=True)
    tables["asperities"] = {
        "model": "greenwood-tripp",
        "rms": rms,
        "summit_radius": 4.07e-6,
        "summit_density": 3.16e11,
    }
    bump = {"type": "bump", "amplitude": 1.16e-8, "radius": 5.66e-5, "x": -8.7e-5, "y": -1.34e-4}
    tables["surface_2"]["roughness"] = bump
    found = steady.solve(case_from_tables(tables)[0], Options(error=0.02))
    assert {one.smoother for one in found.history} == {first}
    assert len(found.history) < cycles
    assert found.errors.film() < 0.02
