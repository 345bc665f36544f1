"""Load, speed and radius that change in time: films of another program, steady ones, oil."""

import tomllib
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from tehl import InputError, certify_transient, solve, solve_transient
from tehl.api.problem import ContactProblem
from tehl.api.results import TransientResult, result_of
from tehl.cli.text import as_text
from tehl.contact.moment import Moment, courses_of, moment_at
from tehl.contact.options import Domain, Options
from tehl.estimate.duration import stride_on
from tehl.estimate.film_formulas import expected_film
from tehl.estimate.nodes import planned
from tehl.estimate.scaling import ScaledProblem, scales
from tehl.estimate.schedule import Schedule
from tehl.estimate.ways import Way
from tehl.io.templates import template_text
from tehl.operators.reynolds import carried
from tehl.operators.trail import VaryingTrail
from tehl.post.transient import film_at, way
from tehl.solver.monitor import SILENT
from tehl.solver.transient import certify as certifying
from tehl.solver.transient.endings import no_film
from tehl.solver.transient.oil import Lead, Oil
from tehl.solver.transient.run import Run
from tehl.solver.transient.snapshot import Snapshot, pack, unpack
from tehl.solver.transient.step import SETTLED_AFTER
from tests.cases import moes_problem
from tests.reference import moes_contact, read
from tests.solver.test_line import line

CITED = read("in_time")
UNITS = scales(line(20, 10))
UNIT = UNITS.half_width_x / UNITS.speed
CHANGES: dict[str, dict] = {
    "sine": {"entrainment_speed": f"1 + 0.5*sin(t/({UNIT!r} s))"},
    "load": {"load": f"1 + 0.3*sin(t/({UNIT!r} s))"},
    "start": {"entrainment_speed": [[0.0, 0.2], [UNIT, 1.0]]},
    "reverse": {"entrainment_speed": [[UNIT, 1.0], [11.0 * UNIT, -1.0]]},
}
TIGHT = {"tolerance": 1e-5, "frames": 0, "max_cycles": 40}


def changing(
    points: int, edges: list[float], end: float, *, order: int | None = None, **transient: object
) -> TransientResult:
    """Return the run of M = 20, L = 10 until T = ``end``."""
    case = line(20, 10, transient={"duration": end * UNIT} | TIGHT | transient)
    box = Domain(x=tuple(edges))
    return solve_transient(case, Options(points=points, domain=box, wedge_order=order))


SLOW = [pytest.param(one, marks=pytest.mark.slow) for one in ("load", "sine", "start")]


@pytest.mark.parametrize("name", ["reverse", *SLOW])
def test_films_are_those_of_another_program(name):
    cited, films = CITED[name], []
    few, many = (193, 385) if name in ("start", "reverse") else (129, 257)
    for points, order in ((few, 2), (many, 2), (few, None)):
        end = cited["samples"][-1][0] + 0.1
        run = changing(points, cited["edges"], end, order=order, **CHANGES[name])
        assert run.status.converged
        time = run.history.time / UNIT
        both = (run.history.film_central, run.history.film_minimum)
        splines = [CubicSpline(time, one / UNITS.film_thickness) for one in both]
        films.append([[float(one(row[0])) for one in splines] for row in cited["samples"]])
    coarse, fine, third = np.array(films)
    wanted = np.array(cited["samples"])[:, 1:]
    order = np.log2(np.abs(coarse - wanted) / np.abs(fine - wanted))
    assert np.median(order) == pytest.approx(2.0, abs=0.25)
    np.testing.assert_allclose((4.0 * fine - coarse) / 3.0, wanted, rtol=2e-3)
    # stated nodes have a wedge of third order: half as many err by less
    assert np.abs(third / wanted - 1.0).max() < np.abs(fine / wanted - 1.0).max()


@pytest.mark.slow
def test_a_slow_change_passes_through_steady_films():
    """Speed, load and radius grow by some per cent while the film passes 20 half-widths."""
    end, last = 20.0 * UNIT, {"entrainment_speed": 1.03, "load": 1.02, "radius": 1.01}
    tables = {key: [[0.0, 1.0], [end, value]] for key, value in last.items()}
    run = changing(257, [-4.5, 1.5], 20.0, order=2, **tables)
    case = line(20, 10)
    stated = {
        "moes_load": None,
        "moes_speed": None,
        "radius": 1.01 * case.radius_x,
        "load_per_length": 1.02 * case.load,
        "entrainment_speed": 1.03 * case.entrainment_speed,
    }
    heavier = case.model_copy(update={"contact": case.contact.model_copy(update=stated)})
    heavier = ContactProblem.model_validate(heavier.model_dump(exclude_none=True))
    part = UNITS.half_width_x / scales(heavier).half_width_x
    box = Domain(x=(-4.5 * part, 1.5 * part))
    steady = solve(heavier, Options(points=257, domain=box, extrapolate=False, wedge_order=2))
    assert run.history.film_central[-1] == pytest.approx(steady.film.central, rel=1e-3)
    assert run.history.film_minimum[-1] == pytest.approx(steady.film.minimum, rel=1e-3)
    assert abs(steady.film.central / run.history.film_central[0] - 1.0) > 0.02


@pytest.mark.parametrize(
    "key",
    [
        "entrainment_speed",
        *(pytest.param(one, marks=pytest.mark.slow) for one in ("load", "radius")),
    ],
)
def test_the_rolling_moment_of_a_slow_change_is_that_of_the_steady_film(key):
    """It differs by a part in proportion to the rate: the film that opens holds oil back."""
    ends = []
    for end in (9.0, 18.0):  # the change goes on, as it lifts the film at its end too
        tables = {key: [[0.0, 1.0], [2.0 * end * UNIT, 1.4]]}
        run = changing(129, [-4.5, 1.5], end, **tables)
        first = run.start.rolling.moment
        assert run.history.rolling_moment[0] == pytest.approx(first, rel=1e-6)
        ends.append(float(run.history.rolling_moment[-1]))
    steady = changing(129, [-4.5, 1.5], 0.01, **{key: "1.2"}).start.rolling
    assert 2.0 * ends[1] - ends[0] == pytest.approx(steady.moment, rel=2e-3)
    assert abs(ends[1] / steady.moment - 1.0) < 0.02
    # on the grid it is the moment of the pressure, whatever the radius is
    assert abs(steady.closure_error) < 1e-6


def test_a_stored_film_has_load_motion_and_rolling_moment_of_its_time():
    tables = {"entrainment_speed": [[0.0, 1.0], [4.0 * UNIT, 1.5]], "frames": 3}
    course = {"load": [[0.0, 1.0], [4.0 * UNIT, 1.2]], "radius": [[0.0, 1.0], [4.0 * UNIT, 0.9]]}
    run = changing(129, [-4.5, 1.5], 4.0, **tables, **course)
    for frame, step in enumerate(run.frames.step):
        film, history = result_of(film_at(run, frame)), run.history
        assert film.load == pytest.approx(history.load[step] * run.start.scales.load)
        # the fields have single precision
        assert film.rolling.moment == pytest.approx(history.rolling_moment[step], rel=1e-4)


def test_the_rolling_moment_turns_with_the_motion():
    turn = [[0.5 * UNIT, 1.0], [2.5 * UNIT, -1.0]]
    run = changing(129, [-4.5, 4.5], 8.0, entrainment_speed=turn, max_cycles=60)
    moment, film = run.history.rolling_moment, run.history.film_central
    assert film[-1] == pytest.approx(film[0], rel=5e-4)  # its mirror image, on any grid
    assert moment[-1] == pytest.approx(-moment[0], rel=2e-3)
    numbers, text = run.summary(), as_text(run)
    assert numbers["rolling"]["moment_n_m"]["least"] == pytest.approx(moment.min())
    assert "rolling          moment" in text


def test_steps_at_the_default_tolerance_are_within_a_hundredth_of_a_percent_of_tight_ones():
    """A step that starts from the approach of the last one errs always to the same side."""
    course = CHANGES["sine"]
    tight, usual = (
        changing(257, [-4.5, 1.5], 2.0, order=2, **course, **one)
        for one in ({}, {"tolerance": 1e-3})
    )
    for name in ("film_central", "film_minimum"):
        found, wanted = (getattr(one.history, name) for one in (usual, tight))
        np.testing.assert_allclose(found, wanted, rtol=3e-5)
    assert usual.history.cycles[1:].mean() < 2.1


def with_tables(problem: ContactProblem, **tables: object) -> ContactProblem:
    return ContactProblem.model_validate(problem.model_dump(exclude_none=True) | tables)


CONSERVING, SCARCE = {"cavitation": {"model": "conserving"}}, {"supply": {"ratio": 0.6}}
SHAPES = {
    "circle": (moes_contact(50, 5), 65, 1.0),
    "conserving circle": (with_tables(moes_contact(50, 5), **CONSERVING), 65, 1.0),
    "starved circle": (with_tables(moes_contact(50, 5), **SCARCE), 65, 1.25),
    "line": (line(50, 5), 257, 1.0),
    "starved line": (line(50, 5, **SCARCE), 257, 1.0),
}
"""Contacts, nodes, and errors of third order over those of second order on twice as many."""


@pytest.mark.parametrize(
    "shape",
    [
        "circle",
        "starved circle",
        *(
            pytest.param(one, marks=pytest.mark.slow)
            for one in ("conserving circle", "line", "starved line")
        ),
    ],
)
def test_a_wedge_of_third_order_stays_so_while_the_speed_varies(shape):
    """On 65 nodes it errs by less than one of second order on twice as many."""
    case, fewest, most = SHAPES[shape]
    unit = scales(case).half_width_x / scales(case).speed
    course = {"duration": unit, "entrainment_speed": f"1 + 0.5*sin(t/({unit!r} s))", "stride": 1}
    varying = with_tables(case, transient=course | {"frames": 0})
    assert planned(ScaledProblem.of(varying), Options()).order == 3
    moments, films, more = np.linspace(0.0, 1.0, 9), {}, 2 * fewest - 1
    for nodes, order in ((fewest, 2), (more, 2), (fewest, 3)):
        history = solve_transient(varying, Options(points=nodes, wedge_order=order)).history
        times = history.time / course["duration"]
        both = history.film_central, history.film_minimum
        films[nodes, order] = np.array([np.interp(moments, times, one) for one in both])
    wanted = (4.0 * films[more, 2] - films[fewest, 2]) / 3.0
    off = {key: np.abs(one / wanted - 1.0).max(axis=1) for key, one in films.items()}
    assert (off[fewest, 3] < most * off[more, 2]).all()
    assert (off[fewest, 3] < 0.3 * off[fewest, 2]).all()


def test_a_node_where_a_starved_film_begins_comes_to_rest_between_two_values():
    """It went to and fro by 1.2 tolerances in all cycles of a step, after a reversal."""
    case = moes_contact(60, 8)
    unit = scales(case).half_width_x / scales(case).speed
    course = {"duration": 3 * unit, "entrainment_speed": [[0.0, 1.0], [3 * unit, -0.6]]}
    turning = with_tables(case, **SCARCE, transient=course | {"frames": 0})
    run = solve_transient(turning, Options(points=129, wedge_order=3))
    assert run.status.converged
    assert run.history.cycles.max() < 8


def test_ridges_that_scarce_oil_leaves_after_reversal_come_to_rest():
    """They took turns with the coarse grids, and no relaxation converged."""
    case = moes_problem(4, 0.7)
    unit = scales(case).half_width_x / scales(case).speed
    course = {"duration": 8 * unit, "entrainment_speed": [[0.0, 1.0], [8 * unit, -0.6]]}
    turning = with_tables(case, supply={"ratio": 0.5}, transient=course | {"frames": 0})
    run = solve_transient(turning, Options(points=65))
    assert run.status.converged
    assert (run.history.cycles > SETTLED_AFTER).any()
    assert (run.history.film_minimum > 0.0).all()


@pytest.mark.slow
def test_a_film_that_touches_errs_less_by_geometric_means_while_the_load_varies():
    case = moes_contact(50, 5)
    unit = scales(case).half_width_x / scales(case).speed
    film = 0.8 * expected_film(ScaledProblem.of(case))
    course = {"duration": 0.5 * unit, "load": [[0.0, 1.0], [unit, 1.2]], "frames": 0}
    tables = {"contact_film": {"thickness": film}, "transient": course}
    touching = ContactProblem.model_validate(case.model_dump(exclude_none=True) | tables)
    central = {}
    for nodes, order in ((65, 2), (129, 2), (65, 3)):
        history = solve_transient(touching, Options(points=nodes, wedge_order=order)).history
        assert history.film_minimum[-1] == pytest.approx(film, rel=1e-3)
        central[nodes, order] = np.array([history.film_central[k] for k in (0, -1)])
    wanted = (4.0 * central[129, 2] - central[65, 2]) / 3.0
    off = {key: np.abs(one / wanted - 1.0) for key, one in central.items()}
    assert (off[65, 3] < 0.7 * off[65, 2]).all()


def test_a_table_that_does_not_change_gives_the_same_run_bit_by_bit():
    plain = changing(129, [-4.5, 1.5], 2.0)
    table = [[0.0, 1.0], [UNIT, 1.0]]
    same = changing(129, [-4.5, 1.5], 2.0, entrainment_speed=table, radius=table, load=table)
    np.testing.assert_array_equal(plain.profiles.pressure, same.profiles.pressure)
    np.testing.assert_array_equal(plain.profiles.film, same.profiles.film)


def test_the_film_after_a_reversal_is_the_mirror_image():
    """The domain and the pressure on its edges follow the motion."""
    case = moes_contact(50, 5)
    unit, speed = scales(case).half_width_x / scales(case).speed, case.entrainment_speed
    turn = [[0.5 * unit, f"{speed} m/s"], [1.5 * unit, f"{-speed} m/s"]]
    tables = case.model_dump(exclude_none=True) | {
        "transient": {
            "duration": 7 * unit,
            "entrainment_speed": turn,
            "frames": 2,
            "tolerance": 1e-5,
        }
    }
    run = solve_transient(ContactProblem.model_validate(tables), Options(points=65))
    x = run.start.scaled.x
    assert x[0] == -x[-1]
    # at the first speed to 0.5, through zero at 1.0, at the last speed from 1.5 to 7
    assert way(run) == pytest.approx(0.5 + 0.25 + 0.25 + 5.5, rel=2e-3)
    first, last = run.frames.film
    inside = np.abs(x) < 1.0
    np.testing.assert_allclose(last[:, ::-1][:, inside], first[:, inside], rtol=1e-3)
    assert run.history.film_minimum.min() < 0.7 * run.history.film_minimum[0]


def test_a_run_starts_from_the_dry_contact_of_its_first_moment():
    """From that of its case, of three times the load, the first grid alone took 40 cycles."""
    case = line(36, 8, transient={"duration": 0.05 * UNIT, "load": "0.333", "radius": "0.465"})
    start = solve_transient(case, Options(points=257, tolerance=1e-6)).start
    first = [one for one in start.history if one.points[0] == start.history[0].points[0]]
    assert abs(first[0].load_error) < 0.05
    assert len(start.history) < 20


def test_oil_is_conserved_through_a_reversal():
    """What the cells hold changes by what passes the edges, step by step."""
    turn = {"entrainment_speed": [[0.5 * UNIT, 1.0], [2.5 * UNIT, -1.0]], "duration": 4.0 * UNIT}
    settings = {"tolerance": 1e-8, "max_cycles": 60, "frames": 0}
    case = line(20, 10, transient=turn | settings, supply={"ratio": 0.6})
    assert case.transient is not None
    run = Run(case, Options(points=129, domain=Domain(x=(-4.0, 4.0))), case.transient, SILENT)
    oil, spacing, film = run.stepper.oil, run.level.grid.dx, run.level.film
    time_step = run.schedule.step
    for step in range(1, run.steps + 1):
        moment, passed = run.schedule.moments[step], run.schedule.passed(step)
        assert passed is not None
        came = [
            part * carried(one - oil.steady, way.along / spacing, limited=True)
            for part, one, way in zip((2.0, -0.5), (oil.now, oil.before), passed, strict=True)
        ]
        run.stepper.step(np.zeros(run.level.grid.shape), step)
        gained = (1.5 * (oil.now - oil.steady) - sum(came)) / time_step
        gained += moment.speed * oil.wedge
        flow = 0.5 * (film.eps_x[0, 1:] + film.eps_x[0, :-1]) * np.diff(film.p[0]) / spacing
        missing = flow[-1] - flow[0] - spacing * gained[0, 1:-1].sum()
        assert abs(missing) * time_step < 1e-8 * spacing * oil.now.sum()
        assert oil.now.min() > 0.2 * oil.steady.min()
    assert moment.speed == -1.0


def test_a_field_is_carried_to_fourth_order_and_fronts_stay_monotone():
    errors = []
    for nodes in (32, 64):
        x = np.arange(nodes) / nodes
        wave = np.sin(2.0 * np.pi * x)[None]
        moved = carried(wave, -1.3)[0] - np.sin(2.0 * np.pi * (x + 1.3 / nodes))
        errors.append(np.abs(moved[4:-4]).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.1)
    front = np.where(np.arange(40) < 20, 1.0, 0.1)[None]
    for distance in (0.3, 2.7, -0.6):
        moved = carried(front, distance, limited=True)
        assert moved.sum() == pytest.approx(front.sum() + 0.9 * distance, rel=1e-12)
        assert moved.min() >= 0.1 - 1e-12
        assert moved.max() <= 1.0 + 1e-12


@pytest.mark.parametrize("stride", [1, 2, 4])
def test_oil_keeps_nothing_of_a_film_that_has_left(stride):
    """The kink of the first film leaves with the motion, where solid oil flows by nothing else."""
    spacing, x = 0.05, 0.05 * np.arange(101)
    kink = 1.0 + 0.5 * np.maximum(0.0, 1.0 - np.abs(x - 2.5) / 0.15)[None, :]
    film = SimpleNamespace(rho=np.ones_like(kink), h=kink)
    level = SimpleNamespace(
        film=film,
        grid=SimpleNamespace(dx=spacing, x=x - 2.5),
        stencil=SimpleNamespace(conserves=0),
        equations=SimpleNamespace(solids=SimpleNamespace(contact_film=None)),
        cavity=SimpleNamespace(held=lambda _: film.h),
    )
    step, (first, later) = stride * spacing, (Moment(), Moment(load=1.5))
    schedule = Schedule(step=step, moments=(first, later), ways=None)
    oil, largest = Oil(level, stride, 3, schedule), 0.0
    for number in range(800 // stride):
        film.h = oil.brought(number) * step / 1.5
        oil.accept(later)
        largest = max(largest, float(np.abs(film.h - 1.0).max()))
    assert largest < 1.5  # no wave grows on its way
    assert np.abs(film.h - 1.0).max() < 1e-6  # a difference that stays with the first film: 0.7


def test_the_lead_of_a_film_that_has_left_is_forgotten():
    kink = np.maximum(0.0, 1.0 - np.abs(np.arange(101.0) - 50.0) / 3.0)[None, :]
    grid = SimpleNamespace(dx=0.05, x=0.05 * np.arange(-50, 51))
    lead = Lead(kink[None], grid, 3, 1.0, follows=0.1)
    for _ in range(200):
        lead.update(np.zeros_like(kink)[None])
        lead.advance()
    assert np.abs(lead.onward()).max() < 1e-6


def test_a_file_a_table_and_a_formula_state_the_same(tmp_path):
    path = tmp_path / "speed.csv"
    speed = line(20, 10).entrainment_speed
    path.write_text(f"t [ms], u [m/s]\n0, {speed}\n2, {2 * speed}\n")
    base = line(20, 10).model_dump(exclude_none=True)
    for stated in ("speed.csv", [[0, 1], ["2 ms", 2]], "1 + t/(2 ms)"):
        base["transient"] = {"duration": "2 ms", "entrainment_speed": stated}
        case = ContactProblem.model_validate(base, context={"folder": tmp_path})
        again = ContactProblem.model_validate_json(case.model_dump_json(exclude_none=True))
        for found in (case, again):
            assert moment_at(found, 1e-3).speed == pytest.approx(1.5, rel=1e-12)
            assert set(courses_of(found)) == {"entrainment_speed"}
    base["transient"] = {"sliding_speed": [[0, f"{speed} m/s"], [1, 0]], "radius": [[0, "40 mm"]]}
    moment = moment_at(ContactProblem.model_validate(base), 0.5)
    assert moment.speeds == pytest.approx((1.25, 0.75))
    assert moment.curvature == pytest.approx(0.5)


MISTAKES = [
    ({"entrainment_speed": "1 + x"}, "unknown name 'x': known are t and pi"),
    ({"entrainment_speed": "1 + t"}, "adds a plain number and a time"),
    ({"entrainment_speed": "1 - t/(1 s)"}, "transient.duration is missing"),
    ({"entrainment_speed": [[0, "3 mm"]]}, "unit of a length"),
    ({"entrainment_speed": [[0, 1], [0, 2]]}, "times that increase"),
    ({"load": [[0, -1]]}, "must be positive"),
    ({"radius": 3}, "pairs of a time and a value"),
    ({"radius": "missing.csv"}, "cannot be read"),
    ({"slide_roll_ratio": [[0, 1]], "sliding_speed": [[0, 1]]}, "state the same"),
    ({"entrainment_speed": [[0, 0], [1e-5, 1]]}, "first speed must be positive, such as"),
    ({"load": "0.5 - t/(1 ms)", "duration": "1 ms"}, "transient.load = .* must be positive"),
]


@pytest.mark.parametrize(("transient", "words"), MISTAKES)
def test_what_cannot_be_is_one_sentence(transient, words):
    with pytest.raises((InputError, ValueError), match=words):
        solve_transient(line(20, 10, transient=transient), Options(points=65))


def test_a_surface_keeps_its_heat_wherever_it_goes():
    """A stripe of the surface takes up a constant flux while it moves on, stops and comes back."""
    x, step, steps = np.linspace(-3.0, 3.0, 241), 0.02, 60

    def stripe(place: float) -> np.ndarray:
        return np.exp(-(((x - place) / 0.4) ** 2))[:, None]

    nodes = [2.0 * np.cos(np.pi * n / steps) for n in range(steps)]
    spacing, place = x[1] - x[0], -0.5
    trail = VaryingTrail(0.0 * stripe(0.0), step, (spacing, spacing), (steps, 0))
    for moved in nodes:
        trail.move(Way(moved * spacing))
        place += moved * spacing
        past, flux = trail.update(stripe(place)), stripe(place)
        trail.advance()
    time = step * steps
    rise = 4.0 / 3.0 * (time**1.5 - (time - step) ** 1.5) / step  # the flux begins within a step
    np.testing.assert_allclose(past + trail.near * flux, rise * stripe(place), atol=2e-4)
    assert place == pytest.approx(-0.5 + 2.0 * (x[1] - x[0]))


ROLLER = tomllib.loads(template_text("line"))
ROLLER["contact"]["slide_roll_ratio"] = 0.4
ROLLER["lubricant"]["viscosity"] |= {"gamma": 0.04, "reference_temperature": 333.0}
ROLLER["lubricant"] |= {"conductivity": 0.14, "heat_capacity": 2000.0}
ROLLER["thermal"] = {"temperature": 333.0}


def heated(end: float, right: float, **transient: object) -> TransientResult:
    """Return the run of a heated roller over ``end`` half-widths; times are in these."""
    units = scales(ContactProblem.model_validate(ROLLER))
    unit = units.half_width_x / units.speed
    tables = {
        key: [[time * unit, value] for time, value in rows] for key, rows in transient.items()
    }
    tables |= {"duration": end * unit, "frames": 0}
    case = ContactProblem.model_validate(ROLLER | {"transient": tables})
    return solve_transient(case, Options(points=97, domain=Domain(x=(-3.5, right))))


def test_heat_of_a_speed_that_hardly_changes_is_that_of_a_constant_one():
    load = [[0.0, 1.0], [1.5, 1.2]]
    plain = heated(1.8, 1.8, load=load)
    varied = heated(1.8, 1.8, load=load, entrainment_speed=[[0.0, 1.0], [9.0, 1.0 + 1e-7]])
    assert plain.status.converged
    for name, error in (("film_central", 2e-3), ("film_minimum", 2e-3), ("traction", 2e-3)):
        wanted = getattr(plain.history, name)
        np.testing.assert_allclose(getattr(varied.history, name), wanted, rtol=error)


def test_a_heated_film_turns():
    """Where the entrainment stops sliding alone heats the film; the new film is thin at first."""
    turn, slide = [[0.5, 1.0], [2.5, -1.0]], [[0.0, 0.4]]
    run = heated(7.5, 3.5, entrainment_speed=turn, sliding_speed=slide)
    assert run.status.converged
    history = run.history
    stop = int(np.argmin(np.abs(history.time / history.time[-1] - 1.5 / 7.5)))
    assert history.temperature_rise[stop:].max() > 1.2 * history.temperature_rise[0]
    # the surfaces that come back are still warm
    assert 0.8 < history.film_central[-1] / history.film_central[0] < 1.0
    assert history.film_central.min() < 0.7 * history.film_central[0]
    assert history.traction[-1] == pytest.approx(history.traction[0], rel=0.1)


def test_a_turning_heated_run_resumes_bit_by_bit():
    turn, slide = [[0.0, 1.0], [0.6, -0.4]], [[0.0, 0.4]]
    case = heated(0.6, 3.5, entrainment_speed=turn, sliding_speed=slide).start.problem
    assert case.transient is not None
    options = Options(points=97, domain=Domain(x=(-3.5, 3.5)))
    kept: list[Snapshot] = []
    whole = solve_transient(case, options, keep=lambda one: kept.append(one.copy()))
    resumed = solve_transient(case, options, resume=unpack(pack(kept[len(kept) // 2])))
    for name in ("film_central", "pressure_max", "temperature_rise", "traction"):
        np.testing.assert_array_equal(getattr(resumed.history, name), getattr(whole.history, name))


@pytest.mark.slow
def test_bars_of_a_reversal_contain_the_finer_run():
    turn = {"entrainment_speed": [[0.0, 1.0], [2.0 * UNIT, -1.0]], "duration": 1.5 * UNIT}
    case = line(20, 10, transient=turn | {"frames": 0})
    box = {"domain": Domain(x=(-3.0, 3.0))}
    run = certify_transient(case, Options(points=257, **box))
    fine = solve_transient(case, Options(points=513, **box))
    bar = run.uncertainty["film_minimum"]
    assert run.status.converged
    assert abs(fine.history.film_minimum.min() - bar.value) < bar.uncertainty
    history = np.interp(run.bars.time, fine.history.time, fine.history.film_central)
    found = np.interp(run.bars.time, run.history.time, run.history.film_central)
    assert (np.abs(found - history) <= 1.05 * run.bars.film_central).all()


def test_a_contact_that_outgrows_its_domain_is_named():
    grows = {"load": [[0.0, 1.0], [UNIT, 4.0]]}
    with pytest.raises(InputError, match="beyond the edge of the domain"):
        changing(129, [-4.5, 1.5], 1.0, **grows)


def test_a_film_at_rest_may_become_very_thin_and_is_not_called_negative():
    """A line (M = 10, L = 16) that stops has 0.022 of its film at its edges 4 ms later."""
    runs = [
        Run(case, Options(points=129), case.transient, SILENT)
        for case in (
            line(20, 10, transient={"duration": UNIT} | CHANGES[name])
            for name in ("load", "reverse")
        )
    ]
    loaded, stops = (run.level.equations.floor for run in runs)
    assert stops == pytest.approx(0.05 * loaded)
    film = runs[1].level.film.h
    film[:] = 0.5 * stops
    status = no_film(runs[1].level, 1e-3, rough=False)
    assert status.cause == "film_not_positive"
    assert "the film is thinner than its equations are solved for: smallest H" in status.message
    film[:] = -1.0
    assert (
        "the film is not positive: smallest H = -1"
        in no_film(runs[1].level, 1e-3, rough=False).message
    )


def test_steps_between_smooth_surfaces_are_as_long_on_fine_grids_as_on_usual_ones():
    """On 513 nodes films of the template of gears differ by 0.03 % (median) and 0.6 % from those of
    half the steps, by less than their errors."""
    slow = {"duration": 20.0 * UNIT, "load": [[0.0, 1.0], [20.0 * UNIT, 1.2]]}
    widths = {1: 0.03, 2: 0.0099, 4: 0.0012}
    scaled = ScaledProblem.of(line(20, 10, transient=slow))
    assert [stride_on(scaled, width, 0.005) for width in widths.values()] == list(widths)
    stated = ScaledProblem.of(line(20, 10, transient=slow | {"stride": 1}))
    assert stride_on(stated, 0.0012, 0.005) == 1
    fast = slow | {"load": f"1 + 0.3*sin(6.28*t/({0.03 * UNIT!r} s))"}
    assert stride_on(ScaledProblem.of(line(20, 10, transient=fast)), 0.0012, 0.005) < 4
    wave = {"type": "wave", "amplitude": 1e-8, "wavelength": 1e-4, "angle": 0.0}
    rough = line(20, 10, transient=slow, surface_1={"material": "steel", "roughness": wave})
    assert stride_on(ScaledProblem.of(rough), 0.0012, 0.005) == 1


def test_the_grids_that_certify_a_run_have_its_stride(monkeypatch):
    strides, solved = [], certifying.solve_transient

    def noted(problem, *args, **named):
        strides.append(problem.transient.stride)
        return solved(problem, *args, **named)

    monkeypatch.setattr(certifying, "solve_transient", noted)
    case = line(20, 10, transient={"duration": 0.3 * UNIT, "load": [[0.0, 1.0], [UNIT, 1.2]]})
    found = certify_transient(case, Options(points=513, domain=Domain(x=(-3.0, 1.5))))
    assert found.status.converged
    assert strides == [1, 2, 2, 2]  # the first is not stated
    assert found.time_step == pytest.approx(2.0 * 4.5 / 512.0 * UNIT)


def test_a_heated_run_whose_surface_stands_first_is_told_from_when_on_both_move():
    """The base circle of a cam: its follower stands still there."""
    course = {"duration": 4.0 * UNIT, "entrainment_speed": [[0.0, 0.5], [4.0 * UNIT, 2.5]]}
    course["sliding_speed"] = [[0.0, 2.0], [4.0 * UNIT, 2.0]]
    oil = {"name": "mineral-oil", "shear": {"law": "eyring", "stress": "5 MPa"}}
    case = line(20, 10, transient=course, thermal={}, lubricant=oil)
    with pytest.raises(InputError, match=r"along x, as they do after (.+) s") as caught:
        solve_transient(case, Options(points=65))
    since = float(str(caught.value).split()[-2])
    assert since == pytest.approx(UNIT, rel=0.1)
