"""Starts from another film: the same result to the tolerance, and less work where it is near."""

import numpy as np
import pytest

from tehl import Options, solve
from tehl.api.results import ConvergenceError
from tehl.base.errors import InputError
from tehl.studies import Case, Store, cases_of, run, table
from tehl.studies.runner import Neighbours
from tests.cases import moes_problem
from tests.study.contacts import QUICK, problem

TIGHT = Options(points=65, accuracy="tight", tolerance=1e-7)


def sliding(slide: float, load: float = 20.0):
    base = problem(load, 10.0)
    contact = base.contact.model_copy(update={"slide_roll_ratio": slide})
    return base.model_copy(update={"contact": contact})


def cycles(result) -> int:
    return sum(report.points == result.history[-1].points for report in result.history)


@pytest.mark.parametrize("load", [20.0, 21.0, 40.0])
def test_a_guess_changes_the_result_by_less_than_the_tolerance(load):
    first = solve(sliding(0.0), TIGHT)
    cold = solve(sliding(0.1, load), TIGHT)
    warm = solve(sliding(0.1, load), TIGHT, guess=first)
    # the change of pressure in the last cycle is below the tolerance; that of the film follows it
    assert np.abs(warm.scaled.pressure - cold.scaled.pressure).max() < 10 * TIGHT.tolerance
    assert warm.film.minimum == pytest.approx(cold.film.minimum, rel=10 * TIGHT.tolerance)
    assert cycles(warm) <= cycles(cold) + 1


def test_a_film_that_is_the_same_saves_most_cycles():
    first = solve(sliding(0.0), TIGHT)
    assert cycles(solve(sliding(0.3), TIGHT, guess=first)) <= 2 < cycles(first)


def test_a_guess_on_another_grid_and_a_far_one_do_no_harm():
    cold = solve(sliding(0.0), TIGHT)
    finer = solve(sliding(0.0), Options(points=129))
    far = solve(moes_problem(6.0, 10.0), Options(points=65))
    for guess in (finer, far):
        warm = solve(sliding(0.0), TIGHT, guess=guess)
        assert warm.film.minimum == pytest.approx(cold.film.minimum, rel=10 * TIGHT.tolerance)


def test_a_run_at_default_accuracy_ignores_a_guess():
    first, usual = solve(sliding(0.0), TIGHT), Options(points=65)
    cold, warm = solve(sliding(0.2), usual), solve(sliding(0.2), usual, guess=first)
    assert np.array_equal(cold.scaled.pressure, warm.scaled.pressure)


def test_a_guess_that_failed_does_no_harm():
    with pytest.raises(ConvergenceError) as failed:
        solve(problem(300.0, 2.0), QUICK)
    cold = solve(sliding(0.0), TIGHT)
    warm = solve(sliding(0.0), TIGHT, guess=failed.value.result)
    assert warm.film.minimum == pytest.approx(cold.film.minimum, rel=10 * TIGHT.tolerance)


def test_a_study_starts_from_its_nearest_case_and_finds_the_same(tmp_path):
    axes = {"contact.slide_roll_ratio": [0.0, 0.1, 0.2]}
    study = cases_of(sliding(0.0), axes, TIGHT)
    cold, warm = Store(tmp_path / "cold"), Store(tmp_path / "warm", keep="fields")
    run(study.cases, cold)
    run(study.cases, warm, warm_start=True)
    first, second = table(study.cases, cold), table(study.cases, warm)
    for name in ("film.h_min_m", "film.h_central_m", "pressure.max_pa"):
        assert second[name].to_numpy() == pytest.approx(first[name].to_numpy(), rel=1e-6)
    assert second["convergence.cycles"].sum() < 0.6 * first["convergence.cycles"].sum()


def test_a_warm_start_needs_fields(tmp_path):
    with pytest.raises(InputError, match='keep = "fields"'):
        run([Case("a", problem(), TIGHT)], Store(tmp_path), warm_start=True)


def test_the_nearest_case_has_the_same_words_and_the_nearest_numbers():
    def case(load: float, law: str = "n", points: int = 65) -> Case:
        return Case("", problem(), Options(points=points), {"law": law, "load": load})

    known = Neighbours([case(10.0), case(100.0), case(31.0, "e"), case(31.0, "n", 129)])
    assert known.nearest(case(30.0)).labels["load"] == 10.0
    assert known.nearest(case(40.0)).labels["load"] == 100.0
    assert known.nearest(case(40.0, "x")) is None
