"""Films against independent programs and published curves; the numbers are in tests/reference."""

from functools import cache

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.api.solvers import solve
from tehl.contact.options import Domain, Options
from tehl.solver.judging.richardson import estimate
from tests.reference import DOMAIN, moes_contact, read

FILMS = read("films")
INDEPENDENT = FILMS["independent"]["case"]
C_PROGRAM = FILMS["c_program"]["case"]
GRIDS = (129, 257, 513)


def name(case: dict) -> str:
    return f"M={case['M']:g},L={case['L']:g}"


@cache
def film(load: float, speed: float, points: int, source: str = "independent") -> Result:
    density = (FILMS[source]["density_slope"], FILMS[source]["density_saturation"])
    options = Options(points=points, domain=DOMAIN, accuracy="tight")
    return solve(moes_contact(load, speed, density=density), options)


@pytest.mark.parametrize("case", INDEPENDENT, ids=name)
def test_the_groups_are_those_of_the_reference(case):
    groups = film(case["M"], case["L"], 129).groups
    assert groups.lambda_bar == pytest.approx(case["lambda_bar"], rel=1e-12)
    assert groups.alpha_bar == pytest.approx(case["alpha_bar"], rel=1e-12)


@pytest.mark.parametrize("case", INDEPENDENT, ids=name)
def test_the_discrete_film_on_129_nodes_is_that_of_the_independent_solver(case):
    options = Options(points=129, domain=DOMAIN, accuracy="tight", deformation="fft")
    run = solve(moes_contact(case["M"], case["L"]), options)
    there = case["on_129"]
    # the same discrete equations, here iterated to 1e-6
    assert run.film_scaled.central == pytest.approx(there["h_central"], rel=1e-6)
    node = run.scaled.y.size // 2, int(np.argmin(np.abs(run.scaled.x)))
    assert run.scaled.pressure[node] == pytest.approx(there["p_central"], rel=1e-6)
    # both minima are of cubic splines, but through different neighbours
    assert run.film_scaled.minimum == pytest.approx(there["h_minimum"], rel=2e-4)


@pytest.mark.parametrize("case", INDEPENDENT, ids=name)
def test_the_multilevel_sum_changes_the_film_by_a_tenth_of_the_discretisation_error(case):
    run = film(case["M"], case["L"], 129).film_scaled
    for quantity in ("central", "minimum"):
        there, limit = case["on_129"][f"h_{quantity}"], case[f"h_{quantity}"]["value"]
        assert abs(getattr(run, quantity) - there) < 0.1 * abs(there - limit)


@pytest.mark.slow
@pytest.mark.parametrize("case", INDEPENDENT, ids=name)
@pytest.mark.parametrize(
    ("quantity", "tolerance", "orders"),
    [("central", 1e-3, (1.8, 2.2)), ("minimum", 3e-3, (1.6, 2.5))],
)
def test_three_grids_extrapolate_to_the_reference(case, quantity, tolerance, orders):
    values = tuple(getattr(film(case["M"], case["L"], n).film_scaled, quantity) for n in GRIDS)
    found = estimate(values, domain=0.0)
    reference = case[f"h_{quantity}"]
    assert found.value == pytest.approx(reference["value"], rel=tolerance)
    assert found.observed_order is not None
    assert orders[0] <= found.observed_order <= orders[1]
    # the two error bars overlap
    assert abs(found.value - reference["value"]) <= found.uncertainty + reference["error"]


@pytest.mark.slow
@pytest.mark.parametrize("case", C_PROGRAM, ids=name)
def test_the_film_on_257_nodes_is_that_of_the_c_program(case):
    run = film(case["M"], case["L"], FILMS["c_program"]["points"], "c_program")
    assert run.film_scaled.central == pytest.approx(case["h_central"], rel=1e-3)
    assert run.film_scaled.minimum_node == pytest.approx(case["h_minimum_node"], rel=5e-3)


def mourier_contact() -> ContactProblem:
    given = FILMS["mourier_2006"]
    solid = {"material": {"young_modulus": given["reduced_modulus"], "poisson_ratio": 0.0}}
    return ContactProblem.model_validate(
        {
            "contact": {
                "radius": given["radius"],
                "load": given["load"],
                "entrainment_speed": given["entrainment_speed"],
            },
            "surface_1": solid,
            "surface_2": solid,
            "lubricant": {
                "viscosity": {
                    "law": "roelands", "eta_0": given["eta_0"], "alpha": given["alpha"]
                },
                "density": {
                    "law": "dowson-higginson",
                    "rho_0": 870.0,
                    "slope": given["density_slope"],
                    "saturation": given["density_saturation"],
                },
            },
        }
    )  # fmt: skip


def test_the_smooth_film_of_mourier_is_met_within_the_scatter_of_the_curves():
    given = FILMS["mourier_2006"]
    wide = Domain(x=(-4.0, 2.0), y=(-3.0, 3.0))
    run = solve(mourier_contact(), Options(points=129, domain=wide))
    low, high = given["measured_plateau"]
    assert low < run.film.central < high
    # five simulated curves scatter by 2 %; theirs are on 257 x 257 nodes, ours on 129 x 129
    assert run.film.central == pytest.approx(np.mean(given["simulated_plateau"]), rel=0.02)
    middle = run.scaled.y.size // 2
    line_minimum = run.film_thickness[middle].min()
    assert line_minimum == pytest.approx(np.mean(given["simulated_line_minimum"]), rel=0.03)
    assert run.pressure[middle][np.abs(run.scaled.x) < 0.5].max() == pytest.approx(
        given["simulated_pressure_maximum"], rel=0.01
    )
