"""Status and error bars of a run: causes of failure, and bars that are not too narrow."""

import pickle

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError
from tehl.api.solvers import solve
from tehl.contact.options import Domain, Options
from tehl.estimate.domain import domain_error, far_field_error, recommended_domain
from tehl.estimate.scaling import groups
from tehl.solver.judging.measures import spike_of
from tehl.solver.judging.richardson import (
    estimate,
    first_order_bar,
    spike_reach,
    with_growing_spike,
)


def moes(load: float, speed: float = 10.0) -> ContactProblem:
    return ContactProblem.model_validate(
        {
            "contact": {"radius": 0.02, "moes_load": load, "moes_speed": speed},
            "surface_1": {"material": "steel"},
            "surface_2": {"material": "steel"},
            "lubricant": {
                "viscosity": {"law": "roelands", "eta_0": 0.04, "alpha": 22e-9},
                "density": {"law": "dowson-higginson", "rho_0": 890},
            },
        }
    )


def failure(load: float, **numerics) -> ConvergenceError:
    with pytest.raises(ConvergenceError) as caught:
        solve(moes(load), Options(**numerics))
    return caught.value


def test_the_domain_of_a_nearly_rigid_contact_is_reported_as_too_small():
    status = failure(1.0, points=65, edges="zero").result.status
    assert status.cause == "domain_too_small"
    assert status.hint.settings == {"numerics.domain": False, "numerics.edges": False}


def test_side_edges_too_close_to_the_contact_are_reported():
    narrow = Domain(x=(-4.5, 1.5), y=(-1.01, 1.01))
    assert failure(100.0, points=(129, 65), domain=narrow).result.status.cause == "sides_too_close"


def test_a_domain_twice_as_wide_truncates_half_as_much():
    case = groups(moes(3.0))
    near = recommended_domain(case)
    far = Domain(x=(2 * near.x[0], 2 * near.x[1]), y=(2 * near.y[0], 2 * near.y[1]))
    assert domain_error(case, far) == pytest.approx(0.5 * domain_error(case, near))


@pytest.mark.parametrize("load", [0.1, 1.0, 5.0, 100.0, 2000.0])
@pytest.mark.parametrize("error", [0.02, 0.002])
def test_the_proposed_domain_takes_a_part_of_the_error_that_is_accepted(load, error):
    case = groups(moes(load))
    assert far_field_error(case, recommended_domain(case, error)) < error / 5.0


def test_the_smallest_grid_has_an_error_bar_too():
    result = failure(100.0, points=33).result
    assert result.errors is not None
    assert result.errors.discretisation_minimum > 0.5


def test_a_diverged_run_ends_in_a_finite_state():
    result = failure(100.0, points=65, domain=Domain(x=(-4.5, 900.0), y=(-3.0, 3.0))).result
    assert np.isfinite(result.scaled.film).all()
    assert np.isfinite(result.scaled.pressure).all()


def test_the_bar_of_a_first_order_wedge_covers_the_larger_change():
    assert first_order_bar([1.0, 1.3, 1.2]) == pytest.approx(0.6)


def test_a_growing_spike_widens_the_bar_of_the_largest_pressure():
    flat = estimate((1.0, 1.01, 1.0125), domain=0.0)
    assert with_growing_spike(flat, spike_reach(0.7, [0.1, 0.11, 0.111])) == flat
    slowing, steady = (spike_reach(0.9, [0.1, 0.2, last]) for last in (0.25, 0.3))
    assert slowing == pytest.approx(1.0)
    assert steady == pytest.approx(1.5)
    assert with_growing_spike(flat, steady).uncertainty > 0.4


def test_a_spike_whose_cusp_falls_between_two_nodes_is_narrow():
    """It was resolved by chance: no higher than on the coarser grid, it grows by half."""
    place = np.arange(-20.0, 20.0)
    cusp, smooth = np.exp(np.where(place > 0, -2.0, 0.2) * place), np.exp(-0.05 * place**2)
    for shape, is_narrow in ((cusp, True), (smooth, False)):
        found = spike_of(np.full((1, 40), 0.6) + 0.4 * shape, np.full((1, 40), 0.6))
        assert found["excess"] == pytest.approx(0.4)
        assert found["narrow"] == pytest.approx(0.4 * is_narrow)
    assert spike_reach(1.0, [0.41, 0.4], 0.4) == pytest.approx(1.4)


def test_a_failure_can_be_pickled():
    error = failure(100.0, points=33)
    back = pickle.loads(pickle.dumps(error))
    assert str(back) == str(error)
    np.testing.assert_array_equal(back.result.scaled.film, error.result.scaled.film)


def test_the_fields_of_a_result_are_read_only():
    result = solve(moes(20.0), Options(points=65))
    with pytest.raises(ValueError, match="read-only"):
        result.scaled.film[0, 0] = 9.0
