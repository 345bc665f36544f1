"""Transient runs: films without a change, passing waves, loads, snapshots, failures."""

from dataclasses import replace
from functools import cache
from unittest.mock import Mock

import numpy as np
import pytest

from tehl import InputError, solve, solve_transient
from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError, TransientResult
from tehl.contact.options import Domain, Options
from tehl.estimate.nodes import planned
from tehl.estimate.scaling import scales
from tehl.result.solution import Status
from tehl.solver.cost import Clock
from tehl.solver.judging import goal
from tehl.solver.monitor import SILENT
from tehl.solver.transient import run
from tehl.solver.transient.endings import step_not_settled, time_over
from tehl.solver.transient.run import Run
from tehl.solver.transient.snapshot import pack, unpack
from tehl.solver.transient.step import StepError
from tests.reference import DOMAIN, moes_contact

M, L = 50.0, 10.0
OPTIONS = Options(points=65, domain=DOMAIN)


def in_time(distance: float, *, slide: float = 0.0, **tables: object) -> ContactProblem:
    """Return M = 50, L = 10 while the mean motion advances by ``distance`` half-widths."""
    case = moes_contact(M, L)
    units = scales(case)
    given = case.model_dump(exclude_none=True)
    given["contact"]["slide_roll_ratio"] = slide
    surfaces = {key: given[key] | tables.pop(key, {}) for key in ("surface_1", "surface_2")}
    transient = {"duration": distance * units.half_width_x / units.speed, "frames": 3}
    transient |= tables.pop("transient", {})
    return ContactProblem.model_validate(given | surfaces | {"transient": transient} | tables)


def wave(amplitude: float = 0.01, wavelength: float = 1.5, phase: float = 0.0) -> dict:
    """Return a transverse wave as a table, in units of a^2/R and a."""
    units = scales(moes_contact(M, L))
    return {
        "roughness": {
            "type": "wave",
            "amplitude": amplitude * units.film_thickness,
            "wavelength": wavelength * units.half_width_x,
            "phase": phase,
        }
    }


@cache
def rolling(phase: float = 0.0) -> TransientResult:
    """Return a run in pure rolling in which a wave on surface 1 passes."""
    return solve_transient(in_time(7.5, surface_1=wave(phase=phase)), OPTIONS)


def test_a_film_without_roughness_stays_steady():
    run = solve_transient(in_time(1.0), OPTIONS)
    start, history = run.start, run.history
    assert run.status.converged
    assert len(history.time) == 12
    assert (history.cycles[1:] <= 2).all()
    np.testing.assert_allclose(run.profiles.film, run.profiles.film[:1].repeat(12, 0), rtol=1e-6)
    largest = start.pressure.max()
    np.testing.assert_allclose(run.frames.pressure[-1], start.pressure, rtol=0, atol=1e-6 * largest)


def test_a_run_starts_from_a_film_as_accurate_as_asked_if_a_tight_one_is_not_reached(monkeypatch):
    for name in ("START_TOLERANCE", "ACCEPTED_START_TOLERANCE"):
        monkeypatch.setattr(f"tehl.solver.transient.run.{name}", 1e-30)
    case = in_time(0.2)
    run = solve_transient(case, OPTIONS)
    assert run.status.converged
    assert run.start.film.central == pytest.approx(solve(moes_contact(M, L), OPTIONS).film.central)
    tight = OPTIONS.model_copy(update={"accuracy": "tight"})
    with pytest.raises(ConvergenceError, match="steady film at time zero did not converge"):
        solve_transient(case, tight)


@pytest.mark.parametrize("cause", ["error_not_reached", "grid_too_coarse"])
def test_a_tight_start_that_misses_the_error_gives_way_to_the_accuracy_of_the_options(
    monkeypatch, cause
):
    """As one whose cycles take the time of the finer grid that the error needs.

    A film whose cycles did not end may seem too coarse, which ended the run.
    """
    solved, tried = run.try_strategies, []

    def without_time(problem, options, **others):
        attempt, result = solved(problem, options, **others)
        tried.append(options.accuracy)
        if options.accuracy == "tight":
            status = Status(kind="not_converged", cause=cause, message="too coarse")
            attempt = replace(attempt, status=status, reached=cause == "error_not_reached")
            result = result.but(status=status)
        return attempt, result

    monkeypatch.setattr(run, "try_strategies", without_time)
    assert solve_transient(in_time(0.2), OPTIONS).status.converged
    assert tried == ["tight", OPTIONS.accuracy]


def test_a_start_on_a_grid_that_is_too_coarse_is_solved_once(monkeypatch):
    solved, tried = run.try_strategies, []

    def counted(problem, options, **others):
        tried.append(options.accuracy)
        return solved(problem, options, **others)

    monkeypatch.setattr(run, "try_strategies", counted)
    given = moes_contact(300.0, L).model_dump(exclude_none=True)
    problem = ContactProblem.model_validate(given | {"transient": {"duration": 1e-4}})
    with pytest.raises(ConvergenceError, match="the grid is too coarse for the film"):
        solve_transient(problem, Options(points=33, domain=DOMAIN))
    assert tried == ["tight"]


def test_the_film_at_time_zero_is_the_steady_film():
    run = rolling()
    steady = solve(moes_contact(M, L), Options(points=65, domain=DOMAIN, accuracy="tight"))
    assert run.history.film_central[0] == pytest.approx(steady.film.central, rel=1e-6)
    assert run.history.cycles[0] == 0


def test_the_minimum_film_of_the_history_lies_between_the_nodes():
    """The smallest node is 2.1 % above it at time zero, and 1.0 % at the end."""
    run = rolling()
    assert run.history.film_minimum[0] == pytest.approx(run.start.film.minimum, rel=1e-12)
    assert run.history.film_minimum[-1] < 0.998 * float(run.frames.film[-1].min())


def test_a_wave_is_flattened_but_keeps_its_length():
    run = rolling()
    assert run.status.converged
    units = run.start.scales
    x = run.start.scaled.x
    centre = int(np.argmin(np.abs(x)))
    period = 1.5 * units.half_width_x / units.speed
    last = run.history.time > run.history.time[-1] - period * (1 + 1e-9)
    film = run.profiles.film[last, centre] / units.film_thickness
    assert 0.3 < 0.5 * np.ptp(film) / 0.01 < 0.9
    # the film at one place repeats after the surfaces have moved by a wavelength
    earlier = np.interp(
        run.history.time[last] - period, run.history.time, run.profiles.film[:, centre]
    )
    assert np.corrcoef(earlier, run.profiles.film[last, centre])[0, 1] > 0.9


def test_a_wave_on_either_surface_is_the_same_in_pure_rolling():
    first, second = rolling(), solve_transient(in_time(7.5, surface_2=wave()), OPTIONS)
    np.testing.assert_allclose(
        first.profiles.film, second.profiles.film, rtol=0, atol=1e-12 * first.start.film.central
    )


def test_a_wave_shifted_by_half_a_period_gives_the_opposite_ripple():
    """Small waves are linear: the mean of both films is the smooth one, to second order."""
    one, other = rolling(), rolling(np.pi)
    mean = 0.5 * (one.profiles.film + other.profiles.film)
    ripple = np.abs(one.profiles.film - other.profiles.film).max()
    x = np.abs(one.start.scaled.x) < 0.7
    assert np.abs(mean - one.profiles.film[:1])[:, x].max() < 0.12 * ripple


def test_mass_travels_through_the_contact_at_the_mean_speed():
    """Under high pressure only the surfaces move the oil: rho h travels unchanged."""
    case = moes_contact(300.0, L)
    units = scales(case)
    given = case.model_dump(exclude_none=True)
    given["surface_1"]["roughness"] = {
        "type": "wave",
        "amplitude": 0.004 * units.film_thickness,
        "wavelength": 0.75 * units.half_width_x,
    }
    given["transient"] = {"duration": 4.5 * units.half_width_x / units.speed, "tolerance": 1e-4}
    run = solve_transient(
        ContactProblem.model_validate(given),
        Options(points=97, domain=Domain(x=(-2.5, 1.5), y=(-2.0, 2.0))),
    )
    density = case.lubricant.density.density(run.profiles.pressure, case.inlet_temperature)
    mass = density * run.profiles.film
    x, mesh = run.start.scaled.x, 4.0 / 96
    ahead, behind = (int(np.argmin(np.abs(x - place))) for place in (0.25, -0.25))
    steps = round(0.5 / mesh)
    arriving, leaving = mass[-40 - steps : -steps, behind], mass[-40:, ahead]
    assert ahead - behind == steps
    assert np.ptp(arriving) > 0.02 * arriving.mean()
    difference = (arriving - arriving.mean()) - (leaving - leaving.mean())
    assert np.abs(difference).max() < 0.05 * np.ptp(arriving)


class Steps:
    """Records the reports of the steps."""

    def __init__(self) -> None:
        self.reports = []

    def __getattr__(self, name):
        return getattr(SILENT, name)

    def step(self, report):
        self.reports.append(report)


def test_a_load_that_rises_during_the_run_needs_no_slower_relaxation():
    end = in_time(1.5).transient.duration
    load = [[0.0, 1.0], [0.4 * end, 1.0], [end, 1.3]]
    monitor = Steps()
    run = solve_transient(in_time(1.5, transient={"load": load}), OPTIONS, monitor=monitor)
    assert run.status.converged
    assert {one.smoother for one in monitor.reports} == {"fast"}
    assert run.history.cycles.max() <= 5
    history, last = run.history, monitor.reports[-1]
    assert last.film_central * run.start.scales.film_thickness == history.film_central[-1]
    assert last.film_minimum * run.start.scales.film_thickness == history.film_minimum[-1]
    assert last.pressure_max * run.start.scales.hertz_pressure == history.pressure_max[-1]


def test_the_load_follows_its_table():
    units = scales(moes_contact(M, L))
    end = 2.0 * units.half_width_x / units.speed
    run = solve_transient(in_time(2.0, transient={"load": [[0.0, 1.0], [end, 1.3]]}), OPTIONS)
    cell = run.start.scaled
    area = (cell.x[1] - cell.x[0]) * (cell.y[1] - cell.y[0])
    carried = run.frames.pressure[-1].sum() * area / run.start.scales.hertz_pressure
    load = run.history.load[run.frames.step[-1]]
    assert load == pytest.approx(1.3, rel=0.05)
    assert carried == pytest.approx(load * 2 * np.pi / 3, rel=2e-4)
    assert run.history.pressure_max[-1] > 1.05 * run.history.pressure_max[0]


def test_a_resumed_run_is_equal_bit_by_bit():
    case = in_time(1.0, slide=0.5, surface_1=wave(), transient={"entrance": 0.6})
    kept = []

    def keep(snapshot):
        if len(snapshot.record.rows) == 6:
            kept.append(snapshot.copy())

    whole = solve_transient(case, OPTIONS, keep=keep)
    again = solve_transient(case, OPTIONS, resume=kept[0])
    for name in ("pressure", "film", "height_1"):
        assert (getattr(whole.profiles, name) == getattr(again.profiles, name)).all()
        assert (whole.frames.pressure == again.frames.pressure).all()
    assert (whole.history.rigid_approach == again.history.rigid_approach).all()


def test_roughness_of_a_surface_at_rest_is_rejected():
    case = in_time(1.0, slide=-2.0, surface_1=wave())
    with pytest.raises(InputError, match="as the surface stands still"):
        solve_transient(case, OPTIONS)


@pytest.mark.parametrize("stride", [2, 4])
def test_a_longer_step_keeps_the_steady_film_and_carries_a_wave(stride):
    still = solve_transient(in_time(1.0, transient={"stride": stride}), OPTIONS)
    film = still.history.film_central
    np.testing.assert_allclose(film, film[0], rtol=1e-6)
    short, long = (
        rolling(),
        solve_transient(in_time(7.5, surface_1=wave(), transient={"stride": stride}), OPTIONS),
    )
    centre = int(np.argmin(np.abs(short.start.scaled.x)))
    last = [run.history.time > 0.75 * run.history.time[-1] for run in (short, long)]
    first = np.ptp(short.profiles.film[last[0], centre])
    assert np.ptp(long.profiles.film[last[1], centre]) == pytest.approx(first, rel=0.06)


FAR = {"type": "bump", "amplitude": 1e-8, "radius": 1e-4, "x": -1.0}
INVALID = [
    ({"transient": {"stride": 8}}, r"take 4 or less"),
    ({"surface_1": wave(wavelength=0.2)}, "shortest wave has 2.1 nodes"),
    ({"surface_1": {"roughness": FAR}}, "does not enter the contact"),
]


@pytest.mark.parametrize(("tables", "words"), INVALID)
def test_an_invalid_transient_problem_is_rejected(tables, words):
    with pytest.raises(InputError, match=words):
        solve_transient(in_time(4.0, **tables), OPTIONS)


def test_too_many_steps_are_rejected_before_any_work():
    with pytest.raises(InputError, match=r"give a shorter one, or a larger transient\.stride"):
        solve_transient(in_time(1e6), OPTIONS)


def test_solving_a_transient_problem_as_a_steady_one_is_rejected():
    with pytest.raises(InputError, match=r"tehl\.solve_transient"):
        solve(in_time(1.0), OPTIONS)


def test_solving_a_steady_problem_as_a_transient_one_is_rejected():
    with pytest.raises(InputError, match="transient: missing from the case"):
        solve_transient(moes_contact(M, L), OPTIONS)


@pytest.mark.parametrize("failure", [StepError("diverged", np.nan), ZeroDivisionError()])
def test_a_relaxation_that_diverges_does_not_affect_the_next_one(failure):
    """A step whose pressure is NaN is repeated from the last valid film."""
    case = in_time(1.0, surface_1=wave(), transient={"entrance": 0.6})
    assert case.transient is not None
    run = Run(case, OPTIONS, case.transient, SILENT)
    stepper, level = run.stepper, run.level
    solve_step, calls = stepper._solve, []

    def diverge_once(name: str) -> object:
        calls.append(name)
        if len(calls) > 1:
            return solve_step(name)
        level.set_state(np.full_like(level.film.p, np.nan), np.nan)
        raise failure

    stepper._solve = diverge_once
    assert run.advance(SILENT).converged
    assert calls[1] != calls[0]
    undisturbed = solve_transient(case, OPTIONS)
    film = run.record.lines(run.scaled.scales).film
    # both within the tolerance of a step, 1e-3 of the pressure
    np.testing.assert_allclose(film, undisturbed.profiles.film, rtol=2e-3)


@pytest.mark.parametrize("harm", ["lost", "cut", "more"])
def test_a_damaged_snapshot_is_rejected(harm):
    case, kept = in_time(0.2), []
    solve_transient(case, OPTIONS, keep=lambda snapshot: kept.append(snapshot.copy()))
    fields = kept[0].fields
    if harm == "lost":
        del fields["pressure_changes"]
    elif harm == "cut":
        fields["pressure_changes"] = fields["pressure_changes"][:2]
    else:
        fields["temperature"] = fields["mass"]
    with pytest.raises(InputError, match="or is damaged"):
        solve_transient(case, OPTIONS, resume=kept[0])


@pytest.fixture(scope="module")
def packed() -> dict:
    """Return the arrays of a run of four steps after the third, with two frames."""
    kept = []
    solve_transient(in_time(0.3), OPTIONS, keep=lambda snapshot: kept.append(snapshot.copy()))
    return pack(kept[2])


@pytest.mark.parametrize(
    ("name", "harm"),
    [
        ("field_pressure", lambda field: field * np.nan),
        ("field_pressure", lambda field: field.astype(str)),
        ("rigid_approach", lambda number: number * np.nan),
        ("rows", lambda rows: rows[:2]),
        ("rows", lambda rows: rows[0]),
        ("rows", lambda rows: rows[:, :3]),
        ("rows", lambda rows: np.tile(rows, (10, 1))),
        ("profiles", lambda lines: lines[:, :2]),
        ("frame_steps", lambda steps: steps[:-1]),
        ("frame_steps", lambda steps: steps[::-1].copy()),
        ("frame_steps", lambda steps: steps + 10),
        ("frames", lambda frames: frames[:, :2]),
        ("setting", lambda _: np.array([0, 1])),
        ("cost", lambda cost: -cost),
    ],
)
def test_a_checkpoint_with_inconsistent_arrays_is_rejected(packed, name, harm):
    with pytest.raises(InputError, match=r"the checkpoint is damaged: .*starts anew"):
        unpack(packed | {name: harm(packed[name])})


def test_a_checkpoint_with_a_film_newer_than_its_steps_is_rejected(packed):
    older = {name: packed[name][:2] for name in ("rows", "profiles")}
    older |= {name: packed[name][:1] for name in ("frames", "frame_steps")}
    with pytest.raises(InputError, match="its pressure is not that of its last step"):
        unpack(packed | older)


@pytest.mark.parametrize(
    ("name", "harm"),
    [
        ("setting", lambda _: np.array(9)),
        ("setting", lambda _: np.array(-1)),
        ("rows", lambda rows: rows * ([2.0] + [1.0] * (rows.shape[1] - 1))),
        ("profiles", lambda lines: lines[..., :9]),
        ("frames", lambda frames: frames[..., :9]),
        ("frame_steps", lambda steps: np.minimum(steps + 1, 3)),
        ("field_mass", lambda mass: mass.astype(np.float32)),
    ],
)
def test_a_checkpoint_of_another_case_is_rejected(packed, name, harm):
    state = unpack(packed | {name: harm(packed[name])})
    with pytest.raises(InputError, match="than the case, or"):
        solve_transient(in_time(0.3), OPTIONS, resume=state)


def test_the_cost_of_a_resumed_run_is_that_of_all_its_parts(packed):
    cost = np.array([1000.0, 2000.0])
    again = solve_transient(in_time(0.3), OPTIONS, resume=unpack(packed | {"cost": cost}))
    assert packed["cost"].min() > 0.0
    assert 1000.0 < again.cost.cpu_seconds < 1900.0
    assert 2000.0 < again.cost.wall_seconds < 2900.0


@pytest.mark.parametrize(("place", "value"), [("p", np.nan), ("h", np.nan), ("h", np.inf)])
def test_a_step_with_a_film_that_is_not_finite_fails(place, value):
    case = in_time(0.3)
    run = Run(case, OPTIONS, case.transient, SILENT)
    update = run.level.update

    def poisoned():
        update()
        getattr(run.level.film, place)[3, 3] = value

    run.level.update = poisoned
    assert run.advance(SILENT, None).cause == "step_not_settled"
    assert len(run.record.rows) == 1


def test_a_step_of_an_oil_that_shears_beyond_its_stress_names_its_law():
    """Sliding as fast as rolling, a heated Newtonian line diverges on 1025 nodes at step 60.

    Waves of six nodes grow inside the film, at X = -0.65, the same with either order and half as
    many steps; of an Eyring oil all 830 steps converge.
    """
    tables = moes_contact(50.0, 8.0).model_dump(exclude_none=True)
    tables["contact"] = {"type": "line", "radius": 0.01, "moes_load": 50.0, "moes_speed": 8.0}
    tables["contact"]["slide_roll_ratio"] = 1.0
    tables["surface_1"] = tables["surface_2"] = {"material": "steel"}
    tables["lubricant"] = {
        "viscosity": {"law": "roelands", "eta_0": 0.04, "alpha": 2.2e-8, "gamma": 0.042},
        "density": {"law": "dowson-higginson", "rho_0": 870.0, "beta": 6.5e-4},
        "shear": {"law": "newtonian"},
        "conductivity": 0.14,
        "heat_capacity": 2000.0,
    }
    tables["lubricant"]["viscosity"]["reference_temperature"] = 313.15
    speed = "1 + 0.5*t/(1 ms)"
    tables |= {"thermal": {}, "transient": {"duration": 1e-3, "entrainment_speed": speed}}
    case = ContactProblem.model_validate(tables)
    run = Run(case, Options(points=(1025, 1)), case.transient, SILENT)
    status = step_not_settled(run.stepper, StepError("diverged", 1e5), 1e-4)
    assert "Likely cause: lubricant.shear.law = newtonian" in status.message
    assert set(status.hint.settings) == {"lubricant.shear"}


def test_the_hint_of_waves_names_the_law_of_oil_that_slides_later():
    """A pair of gears (L = 19, Newtonian, waves of 0.3 um) stalls; of an Eyring oil it goes on."""
    tables = moes_contact(10.0, 19.0).model_dump(exclude_none=True)
    tables["contact"] = {"type": "line", "radius": 0.01, "moes_load": 10.0, "moes_speed": 19.0}
    wavy = {"type": "wave", "amplitude": 2e-7, "wavelength": 3e-4}
    tables["surface_1"] = {"material": "steel", "roughness": wavy}
    tables["surface_2"] = {"material": "steel"}
    tables["transient"] = {"duration": 1e-3, "sliding_speed": [[0.0, 0.0], [1e-3, 1.0]]}
    case = ContactProblem.model_validate(tables)
    run = Run(case, Options(points=(257, 1)), case.transient, SILENT)
    status = step_not_settled(run.stepper, StepError("stalled", 1.4), 1e-4)
    assert set(status.hint.settings) == {"lubricant.shear"}
    assert "slide_roll_ratio = 1:" in status.message


def test_an_unreachable_tolerance_is_reported():
    run = solve_transient(in_time(0.3, transient={"tolerance": 1e-300, "max_cycles": 5}), OPTIONS)
    assert run.status.cause == "step_not_settled"
    assert "Set transient.tolerance = 1e-06: " in str(run.status.hint)
    assert "asperities" not in str(run.status.hint)


def test_a_run_ends_at_the_time_that_is_stated_and_continues_from_there(monkeypatch):
    case, kept = in_time(0.5), []
    over = property(lambda clock: np.isfinite(clock.until) and len(kept) > 2)
    monkeypatch.setattr(Clock, "is_over", over)
    stated = OPTIONS.model_copy(update={"max_time": 2.5})
    run = solve_transient(case, stated, keep=lambda snapshot: kept.append(snapshot.copy()))
    assert run.status.cause == "time_over"
    assert run.history.time.size == 1 + 3
    assert "numerics.max_time = 2.5 s is over at " in str(run.status.message)
    whole = solve_transient(case, OPTIONS, resume=kept[-1])
    assert whole.status.converged
    assert whole.history.film_central[:4] == pytest.approx(run.history.film_central, rel=0.0)


def test_the_time_that_a_hint_gives_counts_the_start_once():
    clock = Mock(start=50.0, cost=lambda: Mock(wall_seconds=60.0))
    status = time_over(Options(max_time=60.0), clock, (10, 100), 1e-3)
    assert status.hint.settings == {"numerics.max_time": "200 s"}  # 50 + 1.5 * 10 * 10


@pytest.mark.parametrize(("cause", "change"), [("stalled", 1e-3), ("diverged", 1e-9)])
@pytest.mark.parametrize("rough", [False, True])
def test_the_hint_of_a_step_that_does_not_converge_names_asperities_if_any(cause, change, rough):
    case = in_time(7.5, transient={"tolerance": 1e-12}, surface_1=wave() if rough else {})
    run = Run(case, OPTIONS, case.transient, SILENT)
    error = StepError(cause, change)
    hint = str(step_not_settled(run.stepper, error, 0.0).hint)
    assert ("asperities" in hint) == rough
    assert "numerics.points" in hint


@pytest.mark.slow
def test_a_dent_passes_on_a_fine_grid_as_on_a_coarse_one():
    """With the dipole threshold of steady films it drifts away on 513 nodes."""
    case = moes_contact(50.0, 5.0)
    units, given = scales(case), case.model_dump(exclude_none=True)
    width, height = units.half_width_x, units.film_thickness
    dent = {"type": "bump", "amplitude": -0.05 * height, "radius": 0.5 * width, "x": -2.2 * width}
    given["contact"]["slide_roll_ratio"] = 0.5
    given["surface_1"]["roughness"] = dent
    given["transient"] = {"duration": 2.2 * width / units.speed, "frames": 0}
    problem = ContactProblem.model_validate(given)
    coarse, fine = (solve_transient(problem, Options(points=n, domain=DOMAIN)) for n in (257, 513))
    assert fine.status.converged
    assert fine.history.cycles.max() <= 4
    one, other = (run.history.film_central / run.history.film_central[0] for run in (coarse, fine))
    there = np.interp(coarse.history.time, fine.history.time, other)
    np.testing.assert_allclose(there, one, atol=0.01)


def test_a_start_that_ends_its_cycles_near_its_tolerance_is_kept():
    """Other strategies, and a solve to the accuracy of the options, would begin anew."""
    run = solve_transient(in_time(0.1), OPTIONS.model_copy(update={"max_cycles": 9}))
    assert {one.smoother for one in run.start.history} == {"fast"}
    assert 1e-7 < run.start.history[-1].change < 1e-5
    np.testing.assert_allclose(run.history.film_central, run.history.film_central[0], rtol=1e-8)


def test_a_run_starts_on_the_fewest_nodes_that_leave_half_of_the_error(monkeypatch):
    given = moes_contact(20.0, 8.0, radius_ratio=0.5).model_dump(exclude_none=True)
    transient = {"load": [[0.0, 1.0], [1e-4, 1.1]]}
    case = ContactProblem.model_validate(given | {"transient": transient})
    options, found = Options(error=0.02), {}
    for part in (goal.PART_AT_START, 0.0):
        monkeypatch.setattr(goal, "PART_AT_START", part)
        found[part] = Run(case, options, case.transient, SILENT)
    fewer, first = found.values()
    assert fewer.level.grid.points == (161, 81)
    assert first.level.grid.points == (193, 97)
    assert 0.004 < first.start.errors.film() < fewer.start.errors.film() < 0.01
    given["surface_1"] |= wave(1e-4, 0.3)
    rough = ContactProblem.model_validate(given | {"transient": transient})
    monkeypatch.undo()
    kept = Run(rough, options, case.transient, SILENT)
    assert kept.level.grid.points == planned(kept.scaled, options).points  # for the wave
