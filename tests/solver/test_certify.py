"""Richardson extrapolation with error bars, and the error bars of a single run."""

import sys
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError
from tehl.api.solvers import certify, solve
from tehl.base.errors import InputError
from tehl.contact.options import Options
from tehl.estimate.scaling import scales
from tehl.result.solution import Status
from tehl.solver.judging.richardson import SAFETY, discretisation_bar, estimate
from tests.reference import DOMAIN, moes_contact

LIMITS = st.floats(0.01, 2.0)
COEFFICIENTS = st.floats(-0.2, 0.2).filter(lambda c: abs(c) > 1e-6)


def sequence(limit: float, coefficient: float, order: float) -> tuple[float, float, float]:
    first, second, third = (limit * (1 + coefficient * 2.0 ** (-order * k)) for k in range(3))
    return first, second, third


@given(LIMITS, COEFFICIENTS)
def test_an_exact_second_order_sequence_gives_its_limit(limit, coefficient):
    found = estimate(sequence(limit, coefficient, 2.0), domain=0.0)
    assert found.value == pytest.approx(limit, rel=1e-9)
    assert found.observed_order == pytest.approx(2.0, abs=1e-6)
    assert found.discretisation > 0.0


@given(LIMITS, COEFFICIENTS, st.floats(1.5, 2.7))
def test_the_bar_contains_the_limit_of_nearly_second_order(limit, coefficient, order):
    found = estimate(sequence(limit, coefficient, order), domain=0.0)
    assert abs(found.value - limit) <= found.uncertainty * (1 + 1e-6)


@given(LIMITS, COEFFICIENTS)
def test_a_sequence_that_alternates_gives_the_finest_value_and_twice_the_change(limit, coefficient):
    values = (limit, limit * (1 + coefficient), limit)
    found = estimate(values, domain=0.0)
    assert found.value == values[2]
    assert found.uncertainty == pytest.approx(2.0 * abs(values[2] - values[1]))
    assert found.observed_order is None


@given(LIMITS, COEFFICIENTS, st.floats(0.75, 1.35))
def test_the_bar_of_a_low_order_contains_the_limit(limit, coefficient, order):
    found = estimate(sequence(limit, coefficient, order), domain=0.0)
    assert abs(found.value - limit) <= found.uncertainty * (1 + 1e-6)


def test_changes_that_grow_have_a_bar_of_twice_the_last_one():
    found = estimate((1.0, 1.001, 1.003), domain=0.0)
    assert found.value == 1.003
    assert found.uncertainty == pytest.approx(0.004)
    assert found.observed_order < 0.0


def test_values_that_follow_from_the_film_keep_the_change_of_the_extrapolation():
    values = (1.0, 1.03, 1.0375)  # second order, to which the film would give a quarter of it
    of_film, of_traction = (estimate(values, 0.0, residue).uncertainty for residue in (0.25, 1.0))
    assert of_traction == pytest.approx(0.0025)
    assert of_film == pytest.approx(0.25 * of_traction)


def test_a_constant_sequence_has_the_bar_of_the_domain_only():
    found = estimate((0.3, 0.3, 0.3), domain=0.01)
    assert (found.value, found.uncertainty) == (0.3, 0.01)


def test_the_parts_of_the_bar_add_in_quadrature():
    found = estimate(sequence(1.0, 0.1, 2.0), domain=0.004)
    assert found.uncertainty**2 == pytest.approx(found.discretisation**2 + 0.004**2)


@given(LIMITS, COEFFICIENTS)
def test_the_bar_of_a_second_order_run_is_a_third_of_the_change_with_a_margin(limit, coefficient):
    values = list(sequence(limit, coefficient, 2.0))
    bar = discretisation_bar(values)
    # the error of the last value is a third of the last change
    assert bar == pytest.approx(SAFETY * abs(values[2] - limit), rel=1e-6)


@given(LIMITS, COEFFICIENTS)
def test_the_bar_without_an_order_is_the_whole_change(limit, coefficient):
    values = [limit, limit * (1 + coefficient)]
    assert discretisation_bar(values) == pytest.approx(abs(values[1] - values[0]))


def test_an_order_is_not_used_while_the_value_still_changes_by_half():
    values = [0.4, 0.52, 0.55]  # last change 5 %, ratio 4
    assert discretisation_bar(values) == pytest.approx(SAFETY * 0.01)
    values = [3.0, 1.4, 1.0]  # ratio 4 as well, but the last change is 40 %
    assert discretisation_bar(values) == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("values", "bar"),
    [
        ([0.0617, 0.0555, 0.0554], 0.00155),  # a heated film whose error was 0.0008
        ([0.0617, 0.0555, 0.0555], 0.00155),
        ([0.0555, 0.0554, 0.0617], 0.0063),
        ([0.2, 0.0555, 0.0554], 0.0001),  # the first grid says nothing
    ],
)
def test_two_grids_that_agree_by_chance_do_not_give_a_narrow_bar(values, bar):
    assert discretisation_bar(values) == pytest.approx(bar)


@given(st.lists(st.floats(-1.0, 1.0), min_size=2, max_size=3))
def test_the_bar_is_never_less_than_a_third_of_the_last_change(values):
    assert discretisation_bar(values) >= abs(values[-1] - values[-2]) / 3.0


def test_a_grid_that_cannot_be_halved_twice_is_rejected():
    with pytest.raises(InputError, match="129 nodes"):
        certify(moes_contact(20.0, 10.0), Options(points=65))


def test_a_certified_run_has_bars_for_film_and_pressure():
    result = certify(moes_contact(20.0, 10.0), Options(points=129, domain=DOMAIN))
    assert set(result.uncertainty) == {"film_central", "film_minimum", "pressure_max"}
    central = result.uncertainty["film_central"]
    assert central.values[2] == result.film_scaled.central
    assert central.observed_order == pytest.approx(2.0, abs=0.2)
    assert 0 < central.discretisation < 0.01 * central.value
    assert 0 < central.domain < 0.05 * central.value  # this domain costs 1 % at M = 20
    assert "33 x 33 converged, 65 x 65 converged, 129 x 129 converged" in result.status.message


def test_the_bar_of_the_largest_pressure_holds_that_of_a_spike_that_no_grid_resolves():
    """On 161, 1025 and 2049 nodes it is 1.014, 1.115 and 1.205 Hertz pressures."""
    highest = certify(moes_contact(75.0, 11.0), Options(points=161)).uncertainty["pressure_max"]
    assert highest.value == pytest.approx(1.014, abs=2e-3)
    assert highest.value + highest.uncertainty > 1.205


def test_two_values_give_the_finer_one_with_the_whole_change_as_its_bar():
    found = estimate((0.5, 0.4), domain=0.0)
    assert (found.value, found.observed_order) == (0.4, None)
    assert found.uncertainty == pytest.approx(0.1)


def test_a_coarsest_grid_without_a_film_is_left_out_and_reported():
    result = certify(moes_contact(700.0, 8.0), Options(points=257))
    central = result.uncertainty["film_central"]
    assert len(central.values) == 2
    assert central.discretisation == pytest.approx(abs(central.values[1] - central.values[0]))
    assert "65 x 65 too coarse for the film" in result.status.message
    assert "left out" in result.status.message
    assert all(value > 0 for bar in result.uncertainty.values() for value in bar.values)


def test_a_grid_with_too_few_nodes_for_the_waves_is_left_out_and_reported():
    """A wave of eight nodes on 129 x 129, which would be a flat surface on 33 x 33."""
    case = wavy(8.0 * 6.0 / 128.0)
    result = certify(case, Options(points=129, domain=DOMAIN))
    assert "33 x 33 too coarse for the roughness" in result.status.message
    assert all(len(bar.values) == 2 for bar in result.uncertainty.values())
    with pytest.raises(ConvergenceError, match="65 x 65 too coarse for the roughness"):
        certify(wavy(4.5 * 6.0 / 128.0), Options(points=129, domain=DOMAIN))


def wavy(wavelength: float) -> ContactProblem:
    """M = 20, L = 10 with a low transverse wave of a length in half-widths."""
    case = moes_contact(20.0, 10.0)
    units, given = scales(case), case.model_dump(exclude_none=True)
    given["surface_1"]["roughness"] = {
        "type": "wave",
        "amplitude": 0.003 * units.film_thickness,
        "wavelength": wavelength * units.half_width_x,
    }
    return ContactProblem.model_validate(given)


def test_the_finest_result_has_no_bar_if_the_next_coarser_grid_fails(monkeypatch):
    module = sys.modules["tehl.solver.judging.certify"]

    def failing(problem, options, **others):
        found = solve(problem, options, **others)
        if options.shape != (65, 65):
            return found
        stalled = Status(kind="stalled", cause="stalled", message="stalled")
        raise ConvergenceError("stalled", replace(found, status=stalled))

    monkeypatch.setattr(module, "solve", failing)
    with pytest.raises(ConvergenceError, match="65 x 65 stalled") as caught:
        certify(moes_contact(20.0, 10.0), Options(points=129, domain=DOMAIN))
    result = caught.value.result
    assert result.scaled.x.size == 129
    assert result.status.cause == "not_certified"
    assert result.film_scaled.minimum > 0
