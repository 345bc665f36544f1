"""A failed solve has a named cause, a hint, and the last state."""

import warnings

import numpy as np
import pytest

from tehl.api.results import ConvergenceError
from tehl.api.solvers import solve
from tehl.contact.options import Domain, Options
from tests.reference import DOMAIN, moes_contact


def failure(load: float, speed: float, **options: object):
    with pytest.raises(ConvergenceError) as caught:
        solve(
            moes_contact(load, speed),
            Options.model_validate({"points": 65, "domain": DOMAIN, **options}),
        )
    return caught.value.result


def test_plain_gauss_seidel_fails_in_a_loaded_contact_with_a_message():
    result = failure(200.0, 10.0, smoother="gauss-seidel", accuracy="tight", max_cycles=15)
    assert result.status.kind in ("diverged", "stalled", "not_converged")
    assert result.status.cause
    assert result.status.message
    assert result.status.hint


@pytest.mark.parametrize(("load", "speed"), [(2000.0, 10.0), (1000.0, 2.0)])
def test_a_grid_too_coarse_for_the_film_names_the_grid_it_needs(load, speed):
    result = failure(load, speed)
    assert result.status.cause in ("grid_too_coarse", "film_not_positive", "film_below_grid")
    assert "numerics.points = " in str(result.status.hint)
    assert "65 x 65" in result.status.message


def test_an_inlet_that_starves_the_contact_is_named():
    result = failure(10.0, 10.0, domain=Domain(x=(-1.5, 1.5), y=(-3.0, 3.0)))
    assert result.status.cause == "inlet_too_short"
    assert "-1.5" in result.status.message


def test_too_few_cycles_are_named():
    result = failure(20.0, 10.0, accuracy="tight", max_cycles=1)
    assert result.status.cause == "too_few_cycles"
    assert "max_cycles" in str(result.status.hint)
    assert result.history[-1].cycle == 1


def test_a_failed_run_still_gives_fields_of_the_grid():
    result = failure(20.0, 10.0, accuracy="tight", max_cycles=1)
    assert result.scaled.film.shape == (65, 65)
    assert np.isfinite(result.scaled.film).all()
    assert np.isfinite(result.scaled.pressure).all()


@pytest.mark.parametrize("speed", [1.0, 15.0, 20.0])
def test_diverging_runs_end_in_a_status_without_warnings(speed):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = failure(2000.0, speed, points=33)
    assert result.status.kind != "converged"
    assert np.isfinite(result.scaled.film).all()


def test_a_tolerance_below_round_off_is_not_reached():
    result = failure(20.0, 10.0, points=33, accuracy="tight", tolerance=1e-18)
    assert result.status.kind in ("stalled", "not_converged")
