"""Physics on lines that crowd at the ends of rollers: heat, thinning, scarce oil, asperities."""

from contextlib import nullcontext
from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest

import tehl
from tehl.api.problem import case_from_tables
from tehl.contact.options import Options
from tehl.estimate.scaling import ScaledProblem
from tehl.result.solution import Status
from tehl.solver.attempts import Attempt, _better
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.ladder import ladder
from tehl.solver.judging.convergence import DivergedError
from tehl.solver.judging.ends import RELIEVE
from tests.solver.runs import mixed_line, multigrid
from tests.solver.test_roller import LOGARITHMIC, STANDARD, roller


@pytest.mark.parametrize(
    ("sources", "minimum", "traction"),
    [(None, 0.01765, -0.05358), ("line", 0.01662, -0.04883), ("full", 0.01669, -0.04875)],
)
def test_lines_of_thinning_and_heated_films_crowd_too(sources, minimum, traction):
    """On uniform lines the minimum is 0.025 (heated 0.023); values are those of 257 x 129 nodes."""
    oil = {"name": "mineral-oil", "shear": {"law": "eyring", "stress": "5 MPa"}}
    heat = {"temperature": "40 degC", "sources": sources} if sources else None
    stated = {"slide_roll_ratio": 0.3, "lubricant": oil, "thermal": heat}
    found = tehl.solve(roller(profile=LOGARITHMIC, **stated), Options(points=(129, 65)))
    assert found.scaled.y[-1] - found.scaled.y[-2] < 0.003
    # at the ends oil does not flow along y, and does not thin by it: one strategy does
    assert sources == "full" or {one.smoother for one in found.history} == {"broad"}
    assert found.film_scaled.minimum == pytest.approx(minimum, rel=0.02)
    assert found.traction.mid_film == pytest.approx(traction, rel=2e-3)
    if sources:
        assert found.heat.balance.error == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize(
    ("sources", "central", "minimum", "tractions", "rises"),
    [
        ("line", 0.02726, 0.0202, (-0.02461, -0.03835), (36.02, 32.46, 33.90)),
        ("full", 0.02668, 0.0200, (-0.02456, -0.03826), (35.76, 32.20, 33.51)),
    ],
)
def test_lines_crowd_where_surfaces_slide_across_them(sources, central, minimum, tractions, rises):
    """Values are those of 257 x 257 nodes on uniform lines; here those are 1 % from them."""
    oil = {"name": "mineral-oil", "shear": {"law": "eyring", "stress": "5 MPa"}}
    stated = {"slide_roll_ratio": 0.8, "sliding_angle": 1.0, "lubricant": oil}
    stated |= {"length": "3 mm", "profile": {"shape": "crown", "radius": "100 mm"}}
    heat = {"temperature": "40 degC", "sources": sources}
    found = tehl.solve(roller(**stated, thermal=heat), Options(points=(129, 65), wedge_order=3))
    steps = np.diff(found.scaled.y)
    assert steps.max() > 3.0 * steps.min()
    assert found.film_scaled.central == pytest.approx(central, rel=0.012)
    assert found.film_scaled.minimum == pytest.approx(minimum, rel=0.02)
    traction, warmer = found.traction, found.temperature
    assert (traction.mid_film, traction.across) == pytest.approx(tractions, rel=2e-3)
    largest = warmer.film_rise_max, warmer.surface_1_rise_max, warmer.surface_2_rise_max
    assert largest == pytest.approx(rises, rel=2e-3)


def test_lines_crowd_where_oil_is_scarce():
    """On uniform lines the minimum is 0.0055 and 0.0054 on as many and twice as many nodes."""
    short = roller(20.0, length="2 mm", profile={"shape": "lundberg"})
    tables = short.model_dump(exclude_none=True) | {"supply": {"ratio": 0.5}}
    options = Options(points=(257, 129), wedge_order=3, accuracy="tight")
    found = tehl.solve(case_from_tables(tables)[0], options)
    steps = np.diff(found.scaled.y)
    assert steps.max() > 3.0 * steps.min()
    assert found.supplied.balance < 1e-8
    # 0.0084 on 513 x 257 nodes
    assert found.film_scaled.minimum == pytest.approx(0.0084, rel=found.errors.minimum)


def mixed_roller():
    """Return a roller between asperities."""
    law = {"model": "greenwood-tripp", "rms": "0.3 um", "summit_radius": "20 um"}
    return roller(profile=LOGARITHMIC, asperities={**law, "summit_density": 1e10})


def test_asperities_of_rollers_change_one_by_one_if_they_do_not_converge_together():
    """At sharp ends films flip from cycle to cycle (M = 65)."""
    mixed, options = mixed_roller(), Options(points=(65, 33))
    first, second, *_ = ladder(ScaledProblem.of(mixed), options, rough=False)
    level = multigrid(mixed, options).hierarchy.levels[-1]
    for strategy in (first, second):
        level.set_relaxation(strategy.relaxation)
        assert level.share.moves_together(level) == (strategy is first)
    assert second.description == "the fast smoother, asperities one by one"
    line = mixed_line()
    strategies = ladder(ScaledProblem.of(line), options, rough=False)
    assert all(one.relaxation.together for one in strategies)


def test_asperities_of_rollers_that_thin_change_one_by_one_too():
    """A tapered roller (M = 247) converges by no other strategy in 40 s, and by it in 5 s."""
    eyring = {"name": "mineral-oil", "shear": {"law": "eyring", "stress": "5 MPa"}}
    law = {"model": "greenwood-tripp", "rms": "0.3 um", "summit_radius": "20 um"}
    thinning = roller(
        profile=LOGARITHMIC, asperities={**law, "summit_density": 1e10}, lubricant=eyring
    )
    second = ladder(ScaledProblem.of(thinning), Options(points=(65, 33)), rough=False)[1]
    assert second.description == "the fast smoother, asperities one by one"


@pytest.mark.parametrize(
    ("load", "speed", "central"), [(67.0, 5.0, 0.0147), (57.0, 9.5, 0.0249)], ids=["edge", "beside"]
)
def test_an_end_that_is_pressed_hard_falls_back_to_uniform_lines_without_a_smallest_film(
    load, speed, central
):
    """Where lines crowd, the film of the first is -0.04 on this grid, and all cycles lead away.

    The gap of the second opens at its end, where nothing is pressed, and the peak is beside it.
    """
    shape = {"length": "20 mm", "moes_speed": speed, "profile": {"shape": "lundberg"}, "tilt": 5e-4}
    found = tehl.solve(roller(load, **shape), Options(points=(129, 65), wedge_order=3))
    assert np.ptp(np.diff(found.scaled.y)) < 1e-12
    assert found.errors.of("film_minimum") is None
    assert found.errors.of("pressure_max") is None
    # 257 x 129 nodes
    assert found.film_scaled.central == pytest.approx(central, rel=0.02)
    assert "minimum film and largest pressure open" in found.status.outcome
    assert "converged on uniform lines only" in found.status.message


def test_rollers_on_which_coarse_grids_oscillate_insist_on_finer_ones():
    """A needle (M = 1.6, L = 36) converges so in 11 s, and by no other strategy in 60 s."""
    eyring = {"name": "mineral-oil", "shear": {"law": "eyring", "stress": "5 MPa"}}
    options = Options(points=(65, 33), wedge_order=3)

    def strategies(speed):
        shape = {"profile": LOGARITHMIC, "lubricant": eyring, "moes_speed": speed}
        return ladder(ScaledProblem.of(roller(**shape)), options, rough=False)

    steep = strategies(20.0)
    assert steep[1].early
    assert [one.crowds for one in steep[:3]] == [True, True, False]
    assert not any(one.early for one in strategies(5.0))


@pytest.mark.parametrize("early", [True, False])
def test_a_strategy_that_heats_early_tries_the_finest_grid_after_one_that_oscillates(
    monkeypatch, early
):
    answers = {"_approximate": False, "_runs_away": False, "_is_last": False}
    for name, answer in {**answers, "_has_converged": True}.items():
        monkeypatch.setattr(FilmSolver, name, Mock(return_value=answer))
    tried = Mock()
    monkeypatch.setattr(FilmSolver, "_improve_finest", tried)
    run = multigrid(roller(profile=LOGARITHMIC), Options(points=(257, 129)))
    run.accepted, run.strategy = False, replace(run.strategy, early=early)
    with nullcontext() if early else pytest.raises(DivergedError):
        run.solve(force=False)
    assert tried.called == early


def test_lines_crowd_beside_asperities_too():
    """On uniform lines the minimum is 0.0420 on 129 x 65 and on 257 x 129 nodes."""
    mixed = mixed_roller()
    found = tehl.solve(mixed, Options(points=(129, 65)))
    assert found.film_scaled.minimum == pytest.approx(0.0377, rel=0.01)  # 257 x 129 nodes
    assert found.load_sharing.share == pytest.approx(0.0496, rel=0.01)
    assert found.load_sharing.balance == pytest.approx(0.0, abs=1e-4)


@pytest.mark.parametrize("tilt", [0.0, pytest.param(1e-4, marks=pytest.mark.slow)])
def test_cavities_between_lines_that_crowd_conserve_oil(tilt):
    short = roller(20.0, length="3 mm", profile=STANDARD, tilt=tilt)
    conserving = {"cavitation": {"model": "conserving"}}
    problem = case_from_tables(short.model_dump(exclude_none=True) | conserving)[0]
    options = Options(points=(129, 65), wedge_order=3, accuracy="tight")
    found = tehl.solve(problem, options)
    steps = np.diff(found.scaled.y)
    assert steps.max() > 5.0 * steps.min()
    assert found.supplied.balance < 1e-8
    # where oil leaves no cavity before the exit, they change nothing
    plain = tehl.solve(short, options)
    assert found.film.central == pytest.approx(plain.film.central, rel=1e-4)
    assert found.film.minimum == pytest.approx(plain.film.minimum, rel=2e-3)


def test_cycles_end_by_films_between_lines_that_crowd():
    """Of the nodes at a steep end the smallest one is 17 % thicker on 129 x 65 than on 257 x 129.

    By their changes cycles on 1025 x 513 nodes ended with an iteration error of 0.5 %, not 0.2.
    """
    steep = roller(50.0, length="4.4 mm", profile={"shape": "lundberg"})
    found = tehl.solve(steep, Options(points=(257, 129), wedge_order=3))
    assert found.history[-1].film_minimum == pytest.approx(found.film_scaled.minimum)


def test_uniform_lines_name_the_error_that_lines_at_the_ends_reached():
    """Asked for 1 %, a tilted roller lost the smallest film that it has to 1.3 % on others."""
    crowded, uniform = Mock(name="crowded"), Mock(name="uniform")
    crowded.reached_before.return_value = ((257, 129), 0.0125)
    crowded.hierarchy.scaled.problem.is_rough = False
    uniform.finest.grid.crowding = 0.0
    failed = Attempt(run=crowded, status=Status(kind="not_converged"), reached=False)
    open_ends = Status(kind="converged", cause="minimum_film_open", hint=RELIEVE)
    found = _better(_better(None, failed), Attempt(run=uniform, status=open_ends, reached=True))
    assert found.run is uniform
    assert 'Set numerics.error = "2 %": 257 x 129 nodes' in str(found.status.hint)
