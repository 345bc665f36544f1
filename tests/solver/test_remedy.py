"""Hints are settings that were seen to converge."""

import math
import time
from dataclasses import replace
from types import SimpleNamespace

import pytest
from benchmarks.random_contacts import contact

from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError
from tehl.api.solvers import solve
from tehl.base.errors import InputError
from tehl.contact.options import Options
from tehl.estimate.nodes import planned
from tehl.estimate.scaling import ScaledProblem
from tehl.result.solution import Hint, Status
from tehl.solver import steady
from tehl.solver.cost import LEAST_SECONDS, end_of_time, working_time
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.judging.diagnosis import error_setting
from tehl.solver.judging.goal import Goal
from tehl.solver.judging.remedy import solved_on_other_nodes, working_hint
from tehl.solver.monitor import SILENT
from tests.cases import ball_tables
from tests.solver.test_roller import roller
from tests.solver.test_status import failure, moes


def test_the_smallest_error_that_converges_is_named():
    failed = replace(failure(100.0, points=33).result, options=Options())

    def only_coarse(problem: ContactProblem, options: Options):
        if options.error < 0.1:
            raise InputError("no memory")
        return solve(problem, options)

    texts: list[str] = []
    hint = working_hint(failed, only_coarse, SimpleNamespace(message=texts.append), math.inf)
    assert hint.settings == {"numerics.error": "20 %"}
    assert "nodes then converge to an error of" in hint.advice
    assert len(texts) == 3


def test_no_setting_is_named_if_none_converges():
    failed = failure(100.0, points=33).result
    hint = working_hint(failed, lambda *_: failed, SILENT, math.inf)
    assert hint.settings == {}
    assert str(hint) == "No setting is known with which this contact converges."
    wave = {"type": "wave", "amplitude": "0.5 um", "wavelength": "50 um"}
    rough = failed.problem.model_dump(exclude_unset=True)
    rough["surface_1"]["roughness"] = wave
    failed = replace(failed, problem=ContactProblem.model_validate(rough))
    hint = working_hint(failed, lambda *_: failed, SILENT, math.inf)
    assert "converges; lower or longer asperities may." in str(hint)


def test_no_hint_removes_heat_or_names_another_oil():
    problem, _ = contact(12, 225)  # Barus, L = 14, Carreau, pure sliding, heated
    tried, failed = [], replace(failure(100.0, points=33).result, problem=problem)

    def fails(changed: ContactProblem, _: Options):
        tried.append(changed)
        raise InputError("no memory")

    assert working_hint(replace(failed, options=Options()), fails, SILENT, math.inf).settings == {}
    assert {one.lubricant.viscosity.law for one in tried} == {"barus", "roelands"}
    assert all(one.thermal == problem.thermal for one in tried)
    assert all(one.lubricant.shear == problem.lubricant.shear for one in tried)


def test_bodies_of_stated_temperature_do_not_break_the_search_for_a_hint():
    """Without heat the temperature of a body is not valid: it was removed alone."""
    tables = ball_tables(thermal={"temperature": "40 degC"})
    tables["surface_1"] = tables["surface_1"] | {"temperature": "60 degC"}
    tables["lubricant"] |= {"conductivity": 0.14, "heat_capacity": 2000.0}
    tables["lubricant"]["viscosity"] |= {"gamma": 0.04, "reference_temperature": "40 degC"}
    problem = ContactProblem.model_validate(tables)
    failed = replace(failure(100.0, points=33).result, problem=problem, options=Options())

    def fails(*_):
        raise InputError("no memory")

    assert working_hint(failed, fails, SILENT, math.inf).settings == {}


def test_a_film_that_meets_the_goal_on_nodes_for_a_larger_error_is_the_result(monkeypatch):
    found = solve(moes(100.0), Options(error=0.01))
    failed = replace(failure(100.0, points=33).result, problem=found.problem)
    monkeypatch.setattr(steady, "solved_on_other_nodes", lambda *_: None)
    monkeypatch.setattr(steady, "try_strategies", lambda *_, **__: (None, found))
    result = steady._after_failure(
        replace(failed, options=Options(error=0.02)), None, SILENT, math.inf
    )
    assert result.status.converged
    assert result.options == Options(error=0.02)
    assert result.history == failed.history + found.history
    strict = replace(failed, options=Options(error=1e-4))
    kept = steady._after_failure(strict, None, SILENT, math.inf)
    assert not kept.status.converged
    assert kept.status.hint.settings


def test_stated_nodes_are_not_searched(monkeypatch):
    monkeypatch.setattr(steady, "working_hint", None)
    with pytest.raises(ConvergenceError):
        solve(moes(2000.0), Options(points=33))


def test_a_contact_that_lacks_time_gets_an_error_that_was_reached(monkeypatch):
    monkeypatch.setattr(Goal, "is_over", False)  # a grid that has begun is solved
    with pytest.raises(ConvergenceError) as caught:
        solve(moes(100.0), Options(error=1e-4, max_time=0.05))
    status = caught.value.result.status
    assert status.cause in ("error_not_reached", "grid_too_coarse")
    assert "nodes then converge" in str(status.hint)
    assert solve(moes(100.0), Options(error=status.hint.settings["numerics.error"]))


@pytest.mark.parametrize(
    ("reached", "named"),
    [(1e-5, "0.01 %"), (6.4e-4, "0.08 %"), (0.03, "4 %"), (0.44, "49 %"), (0.47, None)],
)
def test_an_error_is_named_only_where_it_can_be_asked_for(reached, named):
    found = error_setting(reached)
    assert found == ({} if named is None else {"numerics.error": named})
    Options.model_validate({"error": named})


def test_the_film_of_a_coarser_grid_is_kept_where_the_memory_ends(monkeypatch):
    real = FilmSolver._solve_finest

    def without_memory(run: FilmSolver):
        if run.finest.grid.nx > 350:
            raise MemoryError
        real(run)

    monkeypatch.setattr(FilmSolver, "_solve_finest", without_memory)
    with pytest.raises(ConvergenceError, match=r"memory is not enough .* is kept") as caught:
        solve(moes(100.0), Options(error=2e-3, max_time=60.0))
    result = caught.value.result
    assert result.status.cause == "memory"
    assert result.film.central > 0
    assert result.errors.central < 0.1


def test_other_nodes_are_tried_before_a_hint(monkeypatch):
    """The strategies are made to fail on the planned nodes only."""
    real, tried = steady.try_strategies, []

    def fails_as_planned(problem, options, **others):
        tried.append(others.get("nodes"))
        attempt, result = real(problem, options, **others)
        if tried[-1] is None:
            status = Status(kind="diverged", cause="diverged", message="x")
            result = replace(result, status=status)
        return attempt, result

    monkeypatch.setattr(steady, "try_strategies", fails_as_planned)
    result = solve(moes(20.0), Options())
    assert result.status.converged
    assert tried[0] is None
    assert result.options.points == "auto"
    assert result.scaled.x.size > solve_size(20.0)
    assert max(result.errors.central, result.errors.minimum) <= 0.02


def solve_size(load: float) -> int:
    return max(planned(ScaledProblem.of(moes(load)), Options()).shape)


def test_a_film_that_converged_on_the_way_is_kept_and_nothing_worse_is_named():
    failed = replace(failure(100.0, points=33).result, options=Options())
    calls: list[float] = []

    def fails(_, options: Options):
        calls.append(options.target)
        raise InputError("no memory")

    hint = working_hint(failed, fails, SILENT, math.inf, ((129, 129), 0.09))
    assert hint.settings == {"numerics.error": "10 %"}
    assert max(calls) < 0.09


def test_no_hint_is_tried_after_the_time_of_the_solve_is_over():
    failed = failure(100.0, points=33).result
    failed = replace(failed, options=Options(), cost=replace(failed.cost, wall_seconds=50.0))
    limits: list[float] = []

    def fails(_, options: Options):
        limits.append(options.max_time)
        raise InputError("no memory")

    working_hint(failed, fails, SILENT, working_time() - 10.0)
    assert max(limits) <= 1.0  # the least time that trials get


def test_what_fails_for_a_larger_error_is_not_tried_for_a_smaller_one_on_the_same_grid():
    """A roller is planned on 257 nodes for any error: three trials failed alike, a minute each."""
    failed = replace(failure(100.0, points=33).result, problem=roller(50.0), options=Options())
    failed = failed.but(cost=replace(failed.cost, wall_seconds=20.0))
    tried: list[tuple[float, float]] = []

    def fails(_, options: Options):
        tried.append((options.target, options.max_time))
        raise InputError("no memory")

    working_hint(failed, fails, SILENT, math.inf)
    assert [error for error, _ in tried] == [0.5]
    assert tried[0][1] == pytest.approx(20.0, abs=0.1)  # no longer than the failed solve
    # nor at all where that grid led to the film that is kept
    tried.clear()
    ended = failed.but(
        status=replace(failed.status, cause="error_not_reached"),
        history=[replace(failed.history[0], points=(257, 129))],
    )
    hint = working_hint(ended, fails, SILENT, math.inf, ((513, 257), 0.31))
    assert not tried
    assert hint.settings == {"numerics.error": "35 %"}


def test_a_trial_ends_after_the_time_that_is_left(monkeypatch):
    failed = replace(failure(100.0, points=33).result, options=Options())
    limits: list[float] = []

    def fails(_, options: Options, **_others):
        limits.append(end_of_time(options) - working_time())
        raise InputError("no memory")

    monkeypatch.setattr(steady, "try_strategies", fails)
    result = steady._after_failure(failed, None, SILENT, working_time() - 10.0)
    assert "No setting is known" in str(result.status.hint)
    assert limits
    assert max(limits) <= LEAST_SECONDS


def test_the_hint_to_a_likely_cause_stays_where_the_time_to_try_others_is_over():
    failed, law = failure(100.0, points=33).result, Hint("oils shear at such stresses.", {})
    failed = replace(failed, options=Options(), cost=replace(failed.cost, wall_seconds=50.0))

    def takes_long(*_):
        time.sleep(1.1 * LEAST_SECONDS)
        raise InputError("no memory")

    for cause, kept in (("shear_stress", True), ("diverged", False)):
        status = replace(failed.status, kind="diverged", cause=cause, hint=law)
        hint = working_hint(replace(failed, status=status), takes_long, SILENT, 0.0)
        assert (hint == law) is kept

    # cycles that stalled there have no cause of their own
    law = replace(law, settings={"lubricant.shear": {"law": "eyring", "stress": "5 MPa"}})
    status = replace(failed.status, kind="stalled", cause="stalled", hint=law)
    assert working_hint(replace(failed, status=status), takes_long, SILENT, 0.0) == law


def test_a_shear_law_is_tried_first_where_the_stress_is_the_likely_cause():
    tables = ball_tables(thermal={})
    tables["lubricant"] |= {"conductivity": 0.14, "heat_capacity": 2000.0}
    tables["lubricant"]["viscosity"] |= {"gamma": 0.04, "reference_temperature": "40 degC"}
    problem = ContactProblem.model_validate(tables)
    failed = replace(failure(100.0, points=33).result, problem=problem, options=Options())
    law = Hint("oils shear at such stresses.", {"lubricant.shear": {"law": "eyring"}})
    for hint, first in ((law, "eyring"), (Hint("Take more."), "newtonian")):
        tried: list[str] = []

        def fails(problem: ContactProblem, _options: Options, tried=tried):
            tried.append(problem.lubricant.shear.law)
            raise InputError("no memory")

        status = replace(failed.status, hint=hint)
        working_hint(replace(failed, status=status), fails, SILENT, math.inf)
        assert tried[0] == first


def test_a_shear_law_and_that_of_roelands_are_tried_together_first():
    """A heated line of a Barus oil at 4.2 GPa converges by both, and by neither alone."""
    tables = ball_tables(thermal={})
    tables["lubricant"] |= {"conductivity": 0.14, "heat_capacity": 2000.0}
    tables["lubricant"]["viscosity"] = {
        "law": "barus",
        "eta_0": 0.14,
        "alpha": "20 1/GPa",
        "gamma": 0.04,
        "reference_temperature": "40 degC",
    }
    failed = replace(failure(100.0, points=33).result, options=Options())
    failed = replace(failed, problem=ContactProblem.model_validate(tables))
    failed = failed.but(cost=replace(failed.cost, wall_seconds=5.0))
    law = Hint("oils shear at such stresses.", {"lubricant.shear": {"law": "eyring"}})
    failed = replace(failed, status=replace(failed.status, hint=law))
    tried: list[tuple[str, str, float]] = []

    def fails(problem: ContactProblem, options: Options):
        oil = problem.lubricant
        tried.append((oil.shear.law, oil.viscosity.law, options.max_time))
        raise InputError("no memory")

    working_hint(failed, fails, SILENT, math.inf)
    assert tried[0][:2] == ("eyring", "roelands")
    assert tried[0][2] == pytest.approx(15.0, abs=0.1)  # all the time of trials


def test_the_law_of_roelands_is_tried_in_place_of_that_of_barus():
    """With its constants a heated circle at 1.6 GPa converges, by Barus' law it does not."""
    tables = ball_tables()
    tables["lubricant"]["viscosity"] = {"law": "barus", "eta_0": 0.14, "alpha": "20 1/GPa"}
    failed = replace(
        failure(100.0, points=33).result,
        problem=ContactProblem.model_validate(tables),
        options=Options(error=0.5),
    )
    tried = []

    def fails(problem: ContactProblem, _options: Options):
        tried.append(problem.lubricant.viscosity)
        raise InputError("no memory")

    working_hint(failed, fails, SILENT, math.inf)
    assert [(one.law, one.alpha) for one in tried] == [("roelands", 2e-8)]


@pytest.mark.parametrize(("errors", "number"), [((0.04, 0.03), 1), ((0.03, 0.04), 0), ((), None)])
def test_the_best_film_from_other_nodes_on_is_kept(errors, number):
    """Beside it a coarser one that converged on the way was far off (M = 245,000)."""
    failed = replace(failure(100.0, points=33).result, options=Options())
    failed = failed.but(status=Status(kind="stalled", cause="stalled", message="x"))
    open_status = Status(kind="not_converged", cause="error_not_reached", message="x")
    bars = solve(moes(20.0), Options(points=65)).errors
    films = [
        failed.but(
            status=open_status,
            errors=replace(bars, discretisation_central=one, discretisation_minimum=one),
        )
        for one in errors
    ]
    left = iter(films)

    def solved(_: tuple[int, int]):
        try:
            return next(left)
        except StopIteration:
            raise InputError("no memory") from None

    found = solved_on_other_nodes(failed, solved, SILENT, math.inf)
    assert found is (None if number is None else films[number])


@pytest.mark.parametrize("seconds", [0.5, 30.0])
def test_other_nodes_keep_the_lines_of_a_roller_and_need_a_part_of_the_time(seconds):
    failed = replace(failure(100.0, points=33).result, problem=roller(50.0), options=Options())
    status = Status(kind="stalled", cause="stalled", message="x")
    failed = failed.but(cost=replace(failed.cost, wall_seconds=20.0), status=status)
    tried: list[tuple[int, int]] = []

    def fails(nodes: tuple[int, int]):
        tried.append(nodes)
        raise InputError("no memory")

    end = working_time() + seconds
    assert solved_on_other_nodes(failed, fails, SILENT, end) is None
    assert tried == ([] if seconds < 1.0 else [(321, 161), (385, 193)])


def test_other_nodes_have_all_of_the_time_that_is_left(monkeypatch):
    """A film failed for want of 1.7 s of an hour: it had three times the time of the failed one."""
    failed, known = failure(100.0, points=33).result, {}

    def tried(*_, **named):
        known.update(named)
        return None, failed

    monkeypatch.setattr(steady, "try_strategies", tried)
    monkeypatch.setattr(steady, "solved_on_other_nodes", lambda _, solve, *__: solve((97, 97)))
    steady._after_failure(failed, None, SILENT, 1e9)
    assert (known["nodes"], known["until"]) == ((97, 97), 1e9)
