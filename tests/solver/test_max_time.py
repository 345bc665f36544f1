"""The limit of the time: no cycle begins after it, and the best solved grid is the result."""

import time
from collections.abc import Sequence
from itertools import count

import pytest

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import ConvergenceError
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.result.solution import CycleReport
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.level import Level
from tehl.solver.judging.convergence import DivergedError
from tehl.solver.judging.goal import Goal
from tehl.solver.monitor import SILENT, Silent
from tehl.solver.physics.thermal import Coupling
from tehl.solver.steady import try_strategies
from tests.reference import heated_contact, moes_contact
from tests.solver.rough import wavy

Reports = list[CycleReport]


class Seen(Silent):
    """Records the cycles."""

    def __init__(self) -> None:
        self.reports: Reports = []

    def cycle(self, report: CycleReport) -> None:
        """Record the report."""
        self.reports.append(report)


@pytest.fixture
def cut(monkeypatch):
    """Return a function that solves with time for some cycles; it returns failure and cycles."""

    def run(problem: ContactProblem, options: Options, cycles: int):
        seen = Seen()
        over = property(lambda _: len(seen.reports) >= cycles)
        monkeypatch.setattr(Goal, "is_over", over)
        with pytest.raises(ConvergenceError) as caught:
            solve(problem, options, monitor=seen)
        return caught.value.result, seen.reports

    return run


def before_last_grid(reports: Reports) -> int:
    """Return the cycles before those of the finest grid."""
    return next(k for k, one in enumerate(reports) if one.points == reports[-1].points)


def scarce() -> ContactProblem:
    tables = moes_contact(50.0, 8.0).model_dump(exclude_none=True)
    return case_from_tables(tables | {"supply": {"ratio": 0.6}})[0]


@pytest.mark.parametrize(
    "contact",
    [
        moes_contact(100.0, 8.0),
        heated_contact(),
        pytest.param(scarce(), marks=pytest.mark.slow),
    ],
)
def test_the_film_of_the_grid_before_is_the_result_where_the_time_ends(cut, contact):
    seen, options = Seen(), Options(error=0.01, extrapolate=False)
    solve(contact, options, monitor=seen)
    cycles = before_last_grid(seen.reports)
    before = seen.reports[cycles - 1]

    result, reports = cut(contact, options, cycles + 1)
    assert len(reports) == cycles + 1
    assert result.status.cause == "error_not_reached"
    assert "numerics.max_time is 3600 s, and over" in result.status.message
    assert result.scaled.film.shape == before.points[::-1]
    assert result.scaled.film.min() == pytest.approx(before.film_minimum, rel=1e-6)
    assert 0.01 < result.errors.film() < 0.2


def test_a_film_without_error_bars_says_that_the_time_is_over(cut):
    result, reports = cut(moes_contact(100.0, 8.0), Options(error=2e-3), 3)
    assert len(reports) == 3
    assert result.status.cause == "time_over"
    assert "numerics.max_time = 3600 s is over on " in result.status.message
    assert "or a larger numerics.error" in str(result.status.hint)


def test_the_film_before_cycles_that_lead_away_is_the_result_where_the_time_ends(monkeypatch):
    """It was solved again, which there was no time for: nothing was left."""
    real, ended = FilmSolver._solve_finest, []

    def leads_away(run: FilmSolver) -> None:
        if run.finest.grid.nx > 150:
            ended.append(run.finest.grid.nx)
            raise DivergedError
        real(run)

    monkeypatch.setattr(FilmSolver, "_solve_finest", leads_away)
    monkeypatch.setattr(Goal, "is_over", property(lambda _: bool(ended)))
    with pytest.raises(ConvergenceError, match="max_time is 3600 s, and over") as caught:
        solve(moes_contact(100.0, 8.0), Options(error=2e-3))
    result = caught.value.result
    assert result.status.cause == "error_not_reached"
    assert result.scaled.film.shape[1] == ended[0] // 2 + 1
    assert result.errors.film() < 0.1


def test_a_film_that_lacks_time_names_what_may_keep_it_from_converging(cut):
    contact = heated_contact(1.9, hertz_pressure=1.5e9, entrainment_speed=20.0)
    result, _ = cut(contact, Options(error=2e-3), 3)
    assert result.status.cause == "time_over"
    assert "Likely cause: lubricant.shear.law = newtonian" in result.status.message
    assert "lubricant.shear" in result.status.hint.settings


def test_a_grid_that_was_not_reached_is_not_the_cause(cut):
    result, _ = cut(moes_contact(5000.0, 8.0), Options(points=129, max_time=3600.0), 3)
    assert result.status.cause == "time_over"
    assert "Likely cause" not in result.status.message
    assert "Take a longer numerics.max_time, or fewer nodes" in str(result.status.hint)


def test_heights_are_not_raised_after_the_time(cut):
    contact = wavy((57.21, 10.52), (0.4, 0.25, 0.0))
    for cycles in (20, 52):
        result, reports = cut(contact, Options(error=0.02), cycles)
        assert len(reports) == cycles
        assert not result.status.converged


@pytest.mark.parametrize("stated", [{}, {"max_time": 3600.0}])
def test_stated_nodes_have_the_time_that_is_stated(monkeypatch, stated):
    clock = count(time.perf_counter(), 1000.0)
    monkeypatch.setattr("tehl.solver.judging.goal.working_time", lambda: next(clock))
    options = Options(points=65, **stated)
    if not stated:
        assert solve(moes_contact(20.0, 5.0), options).status.converged
        return
    with pytest.raises(ConvergenceError, match="max_time = 3600 s is over on "):
        solve(moes_contact(20.0, 5.0), options)


def test_the_first_heat_of_a_film_does_not_count_as_time_of_finer_grids(monkeypatch) -> None:
    """A spinning ellipse (M = 778): 7 of the 11 s on 81 lines, and 3 s for all of 161."""
    clock, whole = [0.0], Coupling.begin

    def slow(coupling: Coupling, levels: Sequence[Level], **settings: bool) -> bool:
        is_first = coupling.state is None
        begun = whole(coupling, levels, **settings)
        clock[0] += 100.0 * (begun and is_first)
        return begun

    options = Options(error=0.02, max_time=300.0)
    usual = solve(heated_contact(), options)
    monkeypatch.setattr(Coupling, "begin", slow)
    monkeypatch.setattr("tehl.solver.judging.goal.working_time", lambda: clock[0])
    found = try_strategies(heated_contact(), options, monitor=SILENT, rough=False, until=300.0)[1]
    assert clock[0] == 100.0
    assert found.scaled.film.shape == usual.scaled.film.shape
