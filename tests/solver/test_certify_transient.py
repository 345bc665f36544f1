"""Transient runs with error bars: what they contain, and the status without them."""

import re
import sys
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tehl import InputError, certify_transient, solve_transient
from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError, TransientResult, load_as
from tehl.contact.options import Options
from tehl.estimate.scaling import scales
from tehl.result.solution import Status
from tehl.solver.cost import working_time
from tehl.solver.judging.richardson import grid_bar
from tehl.solver.transient.certify import estimates, history_bars
from tests.fixtures_result import make_result
from tests.fixtures_transient import make_transient
from tests.reference import DOMAIN, moes_contact
from tests.solver.test_transient_heat import hot

M, L = 10.0, 5.0
FILMS = ("film_minimum", "film_central_least", "film_central_largest")
MODULE = "tehl.solver.transient.certify"


def passing(load: float = M, *, wavelength: float = 0.0, **transient: object) -> ContactProblem:
    """Return a dent, or a wave, of surface 1 that passes at SRR 0.5; lengths in half-widths."""
    case = moes_contact(load, L)
    units, given = scales(case), case.model_dump(exclude_none=True)
    given["contact"]["slide_roll_ratio"] = 0.5
    width, height = units.half_width_x, units.film_thickness
    dent = {"type": "bump", "amplitude": -0.05 * height, "radius": 0.5 * width, "x": -2.2 * width}
    wave = {"type": "wave", "amplitude": 0.01 * height, "wavelength": wavelength * width}
    given["surface_1"]["roughness"] = wave if wavelength else dent
    given["transient"] = {"duration": 3.6 * width / units.speed, "frames": 3} | transient
    return ContactProblem.model_validate(given)


def options(points: int) -> Options:
    return Options(points=points, domain=DOMAIN)


@cache
def certified(points: int = 129) -> TransientResult:
    return certify_transient(passing(), options(points))


@pytest.mark.parametrize("points", [65, pytest.param(129, marks=pytest.mark.slow)])
def test_the_run_on_a_twice_finer_grid_is_within_the_bars(points):
    run, finer = certified(points), certified(2 * points - 1)
    history = finer.history
    extremes = {
        "film_minimum": history.film_minimum.min(),
        "film_central_least": history.film_central.min(),
        "film_central_largest": history.film_central.max(),
        "pressure_max": history.pressure_max.max(),
    }
    assert set(run.uncertainty) == set(extremes)
    for name, value in extremes.items():
        bar = run.uncertainty[name]
        assert abs(value - bar.value) <= bar.uncertainty
    steps = np.searchsorted(run.history.time, run.bars.time)
    np.testing.assert_array_equal(run.history.time[steps], run.bars.time)
    for name in ("film_central", "film_minimum", "pressure_max"):
        later = np.interp(run.bars.time, history.time, getattr(history, name))
        error = np.abs(later - getattr(run.history, name)[steps])
        assert (error <= getattr(run.bars, name)).all()


def test_three_grids_show_the_order_and_narrow_the_bar():
    run = certified()
    central = run.uncertainty["film_central_least"]
    assert central.observed_order == pytest.approx(2.0, abs=0.2)
    assert central.values[2] == pytest.approx(run.history.film_central.min(), rel=1e-9)
    assert 0 < central.discretisation < 0.01 * central.value
    assert 0 < central.domain < 0.05 * central.value
    assert run.status.converged
    for grid in ("33 x 33", "65 x 65", "129 x 129"):
        assert f"{grid} converged" in run.status.message
    assert len(run.bars.time) == (len(run.history.time) - 1) // 4 + 1
    assert (run.bars.film_central < 0.03 * run.history.film_central.mean()).all()
    assert run.frames.film.shape[0] == 3
    assert run.cost.cpu_seconds > solve_transient(passing(), options(65)).cost.cpu_seconds


def test_the_bars_of_two_grids_are_the_whole_change():
    run = certified(65)
    for name in FILMS:
        bar = run.uncertainty[name]
        assert (len(bar.values), bar.observed_order) == (2, None)
        assert bar.value == bar.values[1]
        assert bar.discretisation == pytest.approx(abs(bar.values[1] - bar.values[0]))
    assert "17 x 17 has too few nodes" in run.status.message
    assert "left out" in run.status.message
    assert len(run.bars.time) == (len(run.history.time) - 1) // 2 + 1


def test_a_rejected_run_on_a_quarter_of_the_intervals_is_left_out_and_named():
    run = certify_transient(passing(wavelength=0.7), options(129))
    assert run.status.converged
    assert "33 x 33 not possible (roughness: the shortest wave" in run.status.message
    assert all(len(run.uncertainty[name].values) == 2 for name in FILMS)


FAILED = [
    (
        passing(stride=8),
        129,
        r"half the intervals failed \(65 x 65 not possible \(transient.str",
    ),
    (passing(50.0), 65, r"failed \(33 x 33 at time zero not converged: grid too coarse\)"),
]


@pytest.mark.parametrize(("case", "points", "words"), FAILED)
def test_the_finest_run_is_returned_if_that_on_half_the_intervals_fails(case, points, words):
    run = certify_transient(case, options(points))
    assert run.status.cause == "not_certified"
    assert not run.status.converged
    assert re.search(words, run.status.message)
    assert np.all(run.history.film_minimum > 0)
    assert str(run.status.hint).startswith(f"Set numerics.points = {2 * points - 1}")
    assert (run.uncertainty, run.bars) == ({}, None)


def test_a_grid_that_cannot_be_halved_is_rejected_before_any_run():
    with pytest.raises(InputError, match="65 nodes or more"):
        certify_transient(passing(), options(33))


class Replayed:
    """Replaces the runs (finest, half, larger domain, quarter) and records their arguments."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *outcomes: object) -> None:
        self.outcomes, self.calls, self.ends = list(outcomes), [], []
        monkeypatch.setattr(sys.modules[MODULE], "solve_transient", self)

    def __call__(self, problem, options, *, monitor, until, one_grid=False):
        del monitor, one_grid
        self.ends.append(until)
        self.calls.append((options.points, problem.transient))
        outcome = self.outcomes.pop(0)
        if isinstance(outcome, Exception):
            raise outcome
        return outcome


STALLED = Status(kind="stalled", cause="step_not_settled", message="it did not settle")


def test_a_finest_run_that_fails_is_returned_unchanged(monkeypatch):
    run = replace(make_transient(), status=STALLED)
    replayed = Replayed(monkeypatch, run)
    assert certify_transient(passing(), options(129)) is run
    assert len(replayed.calls) == 1


def test_the_other_runs_have_the_same_stride_and_store_no_fields(monkeypatch):
    replayed = Replayed(monkeypatch, *[every(step) for step in (1, 2, 2, 4)])
    certify_transient(passing(stride=2), options(129))
    assert [points for points, _ in replayed.calls] == [129, (65, 65), 129, (33, 33)]
    assert [transient.frames for _, transient in replayed.calls] == [3, 0, 0, 0]
    assert {transient.stride for _, transient in replayed.calls} == {2}


def test_all_runs_share_the_time_that_is_stated(monkeypatch):
    """Each of them had all of it."""
    replayed = Replayed(monkeypatch, *[every(step) for step in (1, 2, 2, 4)])
    begun = working_time()
    certify_transient(passing(), options(129).model_copy(update={"max_time": 60.0}))
    assert len(set(replayed.ends)) == 1
    assert replayed.ends[0] == pytest.approx(begun + 60.0, abs=5.0)


def test_there_is_no_bar_if_the_larger_domain_fails(monkeypatch):
    Replayed(monkeypatch, every(1), every(2), replace(every(2), status=STALLED))
    run = certify_transient(passing(), options(129))
    assert run.status.cause == "not_certified"
    assert "larger domain failed (129 x 129 stalled: step not settled)" in run.status.message
    assert run.cost.cpu_seconds == pytest.approx(3 * make_transient().cost.cpu_seconds)


def test_a_failed_run_on_a_quarter_of_the_intervals_is_left_out(monkeypatch):
    stalled = Status(kind="stalled", cause="stalled", message="stalled")
    error = ConvergenceError("no", replace(make_result(33), status=stalled))
    Replayed(monkeypatch, every(1), every(2), every(2), error)
    run = certify_transient(passing(), options(129))
    assert run.status.converged
    assert "33 x 33 at time zero stalled" in run.status.message
    assert len(run.uncertainty["film_minimum"].values) == 2


def test_bars_that_are_too_wide_mean_too_coarse_a_grid(monkeypatch):
    Replayed(monkeypatch, every(1), every(2, error=0.6), every(2), every(4))
    run = certify_transient(passing(), options(129))
    assert run.status.cause == "grid_too_coarse"
    assert run.uncertainty["film_minimum"].uncertainty > 0.5 * run.uncertainty["film_minimum"].value


def every(step: int, *, error: float = 0.0, steps: int = 57) -> TransientResult:
    """Return a run whose film and pressure grow to the end, with every ``step``-th step."""
    whole = make_transient()
    count = -(-steps // step) + 1
    time = step * whole.time_step * np.arange(count)
    growth = 1.0 + error + 0.01 * time / whole.time_step
    ones = np.ones_like(time)
    history = replace(
        whole.history,
        time=time,
        load=ones,
        film_central=1e-7 * growth,
        film_minimum=5e-8 * growth,
        pressure_max=1e9 * growth,
        traction=-0.04 * ones,
        rigid_approach=ones,
        temperature_rise=0.0 * ones,
        cycles=np.full(count, 3),
        change=ones,
    )
    return replace(whole, history=history)


def test_runs_of_other_durations_are_compared_until_the_end_of_the_finest():
    """57 steps are shorter than 29 of twice the length, which must not count as an error."""
    runs = (every(4), every(2), every(1))
    found = estimates(runs, every(2))
    assert found["film_central_largest"].value == pytest.approx(1.57e-7, rel=1e-12)
    assert found["film_central_largest"].uncertainty < 1e-12 * 1e-7
    bars = history_bars(runs, every(2))
    np.testing.assert_allclose(bars.time, every(4).history.time[:15], rtol=1e-12)
    assert bars.film_central.max() < 1e-12 * 1e-7


def test_the_change_by_the_larger_domain_is_part_of_the_bars():
    runs, wide = (every(4), every(2), every(1)), every(2, error=0.02)
    assert estimates(runs, wide)["film_minimum"].uncertainty == pytest.approx(0.02 * 5e-8)
    np.testing.assert_allclose(history_bars(runs, wide).film_central, 0.02 * 1e-7, rtol=1e-9)


def test_the_bar_of_a_pressure_without_order_allows_for_further_growth():
    runs = (every(4, error=-0.02), every(2, error=-0.01), every(1))
    highest = estimates(runs, every(2, error=-0.01))["pressure_max"]
    assert highest.value == pytest.approx(1.57e9)  # at the end, which only the finest run has
    assert highest.discretisation == pytest.approx(2 * 0.01e9)
    bars = history_bars(runs, every(2, error=-0.01)).pressure_max
    assert (bars >= 2 * 0.01e9 * (1 - 1e-9)).all()


def with_spike(run: TransientResult, height: float) -> TransientResult:
    """Add a spike, in Hertz pressures, to the steady film; it is below the largest pressure."""
    start = run.start
    pressure = np.where(start.scaled.x > 0.5, 0.0, start.scaled.pressure)
    pressure[:, start.scaled.x > 0.5] = height
    unit = np.full_like(run.history.time, start.scales.hertz_pressure)
    return replace(
        run,
        start=replace(start, scaled=replace(start.scaled, pressure=pressure)),
        history=replace(run.history, pressure_max=unit),
    )


def test_a_spike_that_may_exceed_the_largest_pressure_widens_its_bar():
    heights = {4: 0.86, 2: 0.9, 1: 0.98}
    runs = tuple(with_spike(every(step), height) for step, height in heights.items())
    unit = runs[0].start.scales.hertz_pressure
    assert estimates(runs, runs[1])["pressure_max"].discretisation == pytest.approx(0.46 * unit)
    np.testing.assert_allclose(history_bars(runs, runs[1]).pressure_max, 0.46 * unit)


TIME = np.linspace(0.0, 1.0, 21)


@pytest.mark.parametrize(("order", "divisor"), [(1.5, 2**1.5 - 1), (2.0, 3.0), (2.6, 3.0)])
def test_the_bar_of_a_history_near_second_order_follows_from_its_order(order, divisor):
    change = 1.0 + TIME
    series = [1.0 + change * 2.0 ** (-order * k) for k in range(3)]
    last = np.abs(series[2] - series[1])
    bar = grid_bar(series)
    assert (bar >= last / divisor).all()
    assert (bar <= 1.1 * last / divisor).all()


@pytest.mark.parametrize("order", [0.5, 3.5, None])
def test_the_bar_of_a_history_without_order_is_the_whole_change(order):
    change = 1.0 + TIME
    series = [1.0 + change * 2.0 ** (-(order or 1.0) * k) for k in range(3)]
    if order is None:
        series = series[1:]
    last = np.abs(series[-1] - series[-2])
    assert (grid_bar(series) >= last).all()
    assert (grid_bar(series) <= 1.1 * last).all()


def test_the_bar_does_not_vanish_where_the_change_passes_through_zero():
    series = [4.0 * (TIME - 0.5), 1.0 * (TIME - 0.5), 0.25 * (TIME - 0.5)]
    assert grid_bar(series).min() > 0.2 * grid_bar(series).mean() * 0.9


def test_a_heated_film_that_slides_has_bars_for_temperature_and_traction():
    run = certify_transient(hot(1.0), options(65))
    finer = solve_transient(hot(1.0), options(129)).history
    rise, traction = run.uncertainty["film_rise_max"], run.uncertainty["traction_extreme"]
    assert abs(finer.temperature_rise.max() - rise.value) <= rise.uncertainty
    assert traction.value < 0
    assert abs(finer.traction.min() - traction.value) <= traction.uncertainty


def test_runs_on_chosen_nodes_are_compared_with_runs_of_the_same_order():
    """Those on stated nodes had a wedge of second order: bars of 3.3 and 8 %."""
    given = moes_contact(20.0, 8.0, radius_ratio=0.5).model_dump(exclude_none=True)
    change = {"load": [[0.0, 1.0], [2e-5, 1.1]], "duration": 2e-5, "frames": 0}
    case = ContactProblem.model_validate(given | {"transient": change})
    bars = certify_transient(case, Options(error=0.02)).uncertainty
    for name in ("film_central_least", "film_minimum"):
        assert 0.0 < bars[name].uncertainty < 0.01 * bars[name].value


def test_what_has_no_limit_at_the_ends_of_a_roller_has_no_bar(tmp_path):
    """The pressure at sharp ends grows with each grid: its bar on 129 x 65 nodes held no other."""
    contact = {"type": "roller", "radius": 8e-3, "length": 3e-3, "load": 300.0}
    tables = moes_contact(20.0, 10.0).model_dump(exclude_none=True)
    tables |= {"contact": contact | {"entrainment_speed": 2.0}}
    tables |= {"transient": {"duration": 4e-6, "frames": 2}}
    run = certify_transient(ContactProblem.model_validate(tables), Options(points=65))
    assert {"film_minimum", "pressure_max"}.isdisjoint(run.uncertainty)
    assert "film_central_least" in run.uncertainty
    assert run.status.is_vague
    assert np.isnan(run.bars.pressure_max).all()
    assert np.isfinite(run.bars.film_central).all()
    run.save(tmp_path / "run.nc")
    kept = load_as(TransientResult, tmp_path / "run.nc").bars
    assert kept is not None
    np.testing.assert_array_equal(kept.pressure_max, run.bars.pressure_max)
