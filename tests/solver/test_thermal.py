"""Properties of every heated or shear-thinning film: invariance, symmetry, limits."""

import math
import tomllib
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.sparse.linalg import gmres

from benchmarks import any_contacts, machines
from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import Result
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.estimate.inlet_heating import inlet_factors
from tehl.io.templates import template_text
from tehl.operators import surfaces
from tehl.post.heat import work_error
from tehl.result.fields import FilmHeat
from tehl.solver import steady
from tehl.solver.attempts import Attempt
from tehl.solver.monitor import SILENT
from tehl.solver.steady import try_strategies
from tests.reference import heated_contact
from tests.solver.runs import tight

EYRING = {"law": "eyring", "stress": 10e6}
CLOSE = 1e-5
"""Films iterated to 1e-6 agree to a few times that."""


@cache
def heated(
    slide_roll_ratio: float, law: str = "newtonian", points: int = 65, sources: str = "line"
) -> Result:
    """Return the film of the heated reference contact."""
    shear = EYRING if law == "eyring" else None
    problem = heated_contact(slide_roll_ratio, shear=shear, sources=sources)
    return solve(problem, tight(points))


def heat_of(run: Result) -> FilmHeat:
    assert run.heat is not None
    return run.heat


@pytest.mark.parametrize(
    ("slide", "law", "sources"),
    [(0.5, "newtonian", "line"), (0.5, "eyring", "line"), (1.9, "eyring", "auto")],
)
def test_exchanging_the_speeds_of_equal_solids_mirrors_the_film(slide, law, sources):
    ahead, behind = (heated(sign * slide, law, sources=sources) for sign in (1.0, -1.0))
    for name in ("film", "pressure"):
        one, other = getattr(ahead.scaled, name), getattr(behind.scaled, name)
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-8 * one.max())
    rise = heat_of(ahead).temperature - 313.0
    mirrored = heat_of(behind).temperature[::-1] - 313.0
    assert rise.max() > 10.0
    np.testing.assert_allclose(rise, mirrored, rtol=0, atol=1e-8 * rise.max())
    assert ahead.traction is not None
    assert behind.traction is not None
    assert ahead.traction.mid_film == pytest.approx(-behind.traction.mid_film, rel=1e-8)
    assert ahead.traction.surface_1 == pytest.approx(-behind.traction.surface_2, rel=1e-8)


def test_half_a_domain_gives_the_heated_film_of_the_full_one():
    problem = heated_contact(0.5)
    half, full = (
        solve(problem, tight(65, deformation="fft", half_domain=half)) for half in ("auto", "never")
    )
    np.testing.assert_allclose(half.scaled.film, full.scaled.film, rtol=0, atol=CLOSE)
    np.testing.assert_allclose(half.scaled.pressure, full.scaled.pressure, rtol=0, atol=10 * CLOSE)
    one, other = heat_of(half).temperature, heat_of(full).temperature
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-2)


def test_the_heated_film_is_symmetric_across():
    full = solve(heated_contact(0.5), tight(65, half_domain="never"))
    film, pressure = full.scaled.film, full.scaled.pressure
    np.testing.assert_allclose(film, film[::-1], rtol=0, atol=CLOSE)
    np.testing.assert_allclose(pressure, pressure[::-1], rtol=0, atol=10 * CLOSE)
    temperature = heat_of(full).temperature
    np.testing.assert_allclose(temperature, temperature[:, ::-1], rtol=0, atol=1e-2)


def scaled_copy(problem: ContactProblem, size: float, modulus: float) -> ContactProblem:
    """Return a contact of other size and stiffness with the same groups, heat included.

    Lengths grow by ``size``, pressures by ``modulus``; viscosity and speed keep, so that lambda
    needs ``modulus`` in the viscosity and ``size`` in the speed; conductivities follow so that the
    Peclet numbers and eta u^2 / k are the same.
    """
    tables: dict[str, Any] = problem.model_dump(mode="python", exclude_none=True)
    contact, oil = tables["contact"], tables["lubricant"]
    contact["radius"] *= size
    contact["hertz_pressure"] *= modulus
    contact["entrainment_speed"] *= size
    # p_h dT per volume: heat of a volume grows like a pressure
    oil["heat_capacity"] *= modulus
    oil["conductivity"] *= modulus * size**2
    law = oil["viscosity"]
    law["eta_0"] *= modulus
    law["alpha"] /= modulus
    oil["density"]["slope"] /= modulus
    oil["density"]["saturation"] /= modulus
    for name in ("surface_1", "surface_2"):
        solid = tables[name]["material"]
        solid["young_modulus"] *= modulus
        solid["heat_capacity"] *= modulus
        solid["conductivity"] *= modulus * size**2
    return ContactProblem.model_validate(tables)


def barus(problem: ContactProblem) -> ContactProblem:
    """Return the same contact with a law without a pressure scale."""
    tables: dict[str, Any] = problem.model_dump(mode="python", exclude_none=True)
    tables["lubricant"]["viscosity"] = {
        "law": "barus", "eta_0": 0.04, "alpha": 14e-9, "gamma": 0.042,
        "reference_temperature": 313.0,
    }  # fmt: skip
    return ContactProblem.model_validate(tables)


@pytest.mark.parametrize(("size", "modulus"), [(0.2, 1.0), (1.0, 0.5), (3.0, 2.0)])
def test_contacts_with_equal_groups_have_equal_heated_films(size, modulus):
    problem = barus(heated_contact(0.5))
    one = solve(problem, tight(65))
    other = solve(scaled_copy(problem, size, modulus), tight(65))
    assert other.groups.M == pytest.approx(one.groups.M, rel=1e-12)
    assert other.groups.L == pytest.approx(one.groups.L, rel=1e-12)
    np.testing.assert_allclose(other.scaled.film, one.scaled.film, rtol=0, atol=CLOSE)
    np.testing.assert_allclose(other.scaled.pressure, one.scaled.pressure, rtol=0, atol=10 * CLOSE)
    rise = heat_of(one).temperature - 313.0
    assert rise.max() > 5.0
    np.testing.assert_allclose(
        heat_of(other).temperature - 313.0, rise, rtol=0, atol=1e-4 * rise.max()
    )


def test_an_eyring_film_of_huge_stress_is_newtonian():
    cold = {"reynolds": None}
    newtonian = solve(heated_contact(0.5, **cold), tight(65))
    hard = {"law": "eyring", "stress": 1e15}
    thinning = solve(heated_contact(0.5, shear=hard, **cold), tight(65))
    np.testing.assert_allclose(thinning.scaled.film, newtonian.scaled.film, rtol=0, atol=CLOSE)
    np.testing.assert_allclose(
        thinning.scaled.pressure, newtonian.scaled.pressure, rtol=0, atol=10 * CLOSE
    )
    assert thinning.traction is not None
    assert newtonian.traction is not None
    assert thinning.traction.mid_film == pytest.approx(newtonian.traction.mid_film, rel=1e-4)
    assert thinning.shear is not None
    np.testing.assert_allclose(thinning.shear.thinning, 1.0, rtol=1e-6)


def test_inlet_heating_thins_a_rolling_film_as_the_formulas_predict():
    warm = heated(0.0, points=129)
    cold = solve(heated_contact(0.0, reynolds=None), tight(129))
    ratio = warm.film_scaled.central / cold.film_scaled.central
    factors = [found.factor for found in inlet_factors(warm.problem)]
    assert 0.9 < ratio < 1.0
    # correlations for pure rolling, accurate to a few per cent
    assert min(factors) - 0.03 < ratio < max(factors) + 0.03
    # both solids take the same heat, and little is generated in the contact
    heat = heat_of(warm)
    np.testing.assert_allclose(heat.flux_1, heat.flux_2, rtol=0, atol=1e-8 * heat.flux_1.max())
    assert warm.temperature is not None
    assert warm.temperature.mid_film_rise_central < 1.0


def test_sliding_heats_the_film_and_reduces_the_traction():
    rises = [heated(slide).temperature for slide in (0.0, 0.5)]
    central = [rise.mid_film_rise_central for rise in rises if rise is not None]
    assert 0.0 < central[0] < 1.0
    assert central[1] > 10.0
    cold = solve(heated_contact(0.5, reynolds=None), tight(65)).traction
    warm = heated(0.5).traction
    assert cold is not None
    assert warm is not None
    assert abs(warm.mid_film) < 0.5 * abs(cold.mid_film)


def test_shear_thinning_reduces_the_heat_of_the_film():
    newtonian, thinning = heated(0.5), heated(0.5, "eyring")
    for run in (newtonian, thinning):
        assert abs(heat_of(run).balance.error) < 0.01
    assert heat_of(thinning).balance.shear < heat_of(newtonian).balance.shear
    assert thinning.shear is not None
    assert thinning.shear.thinning.min() < 0.9
    assert thinning.shear.thinning.max() <= 1.0 + 1e-9


def test_the_heat_balance_closes_with_mesh_and_nodes():
    """Measured 0.058, 0.031 and, on 257 nodes with 17 layers, 0.017 per cent."""
    missing = []
    for points, layers in ((65, 9), (129, 13)):
        problem = heated_contact(0.5, sources="auto", layers=layers)
        run = solve(problem, tight(points, tolerance=1e-5))
        missing.append(100.0 * abs(heat_of(run).balance.error))
    assert missing[0] < 0.1
    assert missing[1] < 0.6 * missing[0]


def test_heat_of_sideways_and_backward_flow_converges_with_the_film():
    """In pure rolling most of the heat is in the inlet, where the oil hardly advances."""
    run = solve(heated_contact(0.0), tight(65, tolerance=1e-5))
    assert abs(heat_of(run).balance.error) < 1e-3
    assert run.history[-1].cycle < 15


def test_friction_power_is_the_shear_heat_and_the_work_on_the_flow():
    """The surfaces supply the shear heat and the work of the pressure on the flow."""
    run = heated(0.5, points=129)
    assert run.traction is not None
    shear = heat_of(run).balance.shear
    # the work that pressure does on the oil is a few per cent of the shear heat
    assert run.traction.friction_power == pytest.approx(shear, rel=0.02)


def test_bars_of_surface_temperatures_compare_the_same_moving_sources():
    # lines of heat on the coarse grids in place of areas made bars of 8 to 12 %
    problem = case_from_tables(tomllib.loads(template_text("thermal")))[0]
    coarse, fine = (solve(problem, Options(points=points)) for points in (129, 257))
    for side in ("surface_1_rise_max", "surface_2_rise_max"):
        first, second = (getattr(run.temperature, side) for run in (coarse, fine))
        bars = [getattr(run.errors, side) for run in (coarse, fine)]
        assert bars[1] < bars[0] < 0.04
        assert bars[1] < 0.02
        assert abs(first / second - 1.0) < bars[0]


def test_the_grid_before_the_finest_is_heated_with_half_as_many_lines():
    """An isothermal one would put the effect of heat into the error bar of the finest grid."""
    case = heated_contact(0.5).model_dump(exclude_none=True)
    case["contact"] = {"radius_x": 0.01, "radius_y": 0.1, "moes_load": 200.0, "moes_speed": 8.0}
    run = solve(ContactProblem.model_validate(case), Options(points=(129, 65)))
    rises = {one.points: one.temperature_rise for one in run.history}
    assert rises[65, 33] == pytest.approx(rises[129, 65], rel=0.1)
    assert list(rises.values()).count(0.0) == len(rises) - 2


def test_sweeps_keep_the_temperature_of_oil_that_flows_back_and_sideways():
    # hot thin oil between large radii: a change that alternates across the thick inlet was carried
    # too far along y, and grew to 8 K
    tables = tomllib.loads(template_text("thermal"))
    tables["contact"] = {
        "radius_x": 0.05,
        "radius_y": 0.036,
        "hertz_pressure": 1.6e9,
        "entrainment_speed": 3.8,
        "slide_roll_ratio": 0.003,
    }
    tables["surface_1"] = tables["surface_2"] = {"material": "steel"}
    tables["thermal"]["temperature"] = 383.0
    tables["lubricant"] |= {
        "viscosity": {"law": "walther", "nu_40": 68e-6, "nu_100": 8.7e-6, "alpha": 1.9e-8},
    }
    tables["numerics"] = {"points": [129, 257]}
    problem, options = case_from_tables(tables)
    attempt, _ = try_strategies(problem, options, monitor=SILENT, rough=False)
    state = attempt.run.coupling.state
    assert state is not None
    for _ in range(10):
        state.sweep(3)
    before = state.temperature.copy()
    for _ in range(10):
        state.sweep(3)
    assert 0.4 < before.max() - 383.0 < 1.0
    assert np.abs(state.temperature - before).max() < 0.02


def test_surfaces_of_a_thin_film_become_warm_together():
    """Peclet numbers 8 and 0.06: one that takes the other as it is warms by 0.05 of 3 K a sweep.

    The rise is 3.05 K on 129 x 257 nodes, 3.04 K on 161 x 321.
    """
    found = solve(any_contacts.contact(604, 6)[2], Options(error=0.03, max_time=10.0))
    assert found.status.converged
    assert found.heat.sources == ("full", "full")
    assert found.temperature.film_rise_max == pytest.approx(3.04, rel=0.02)


@pytest.mark.slow
def test_temperatures_of_a_very_hot_inlet_rest_between_the_layers_of_its_oil(monkeypatch):
    monkeypatch.setattr(Attempt, "at_rest", lambda attempt: attempt)  # it would drop the state
    # 46 m/s, a thermal loading of 57: with nine nodes across the film they swing by several kelvin
    problem = any_contacts.contact(151, 52)[2].model_copy(update={"supply": None})
    attempt, _ = try_strategies(problem, Options(points=(193, 97)), monitor=SILENT, rough=False)
    state = attempt.run.coupling.state
    assert state is not None
    assert state.temperature.shape[1] == 17
    changes = [state.sweep(3) for _ in range(30)]
    assert changes[-1] < 1e-3


def test_hot_oil_that_flows_back_comes_to_rest_on_fine_grids():
    """A traction drive, M = 637, L = 17: by whole changes its inlet swings up to 170 K."""
    found = steady.solve(machines.contact(97, 51)[2], Options(error=0.015))
    assert found.errors.film() < 0.015
    finest = found.history[-1].points
    rises = [one.temperature_rise for one in found.history if one.points == finest]
    assert max(rises) == pytest.approx(92.0, abs=2.0)


BALL_ON_GLASS = """
contact = { load = "75.8 N", entrainment_speed = "1.51 m/s", slide_roll_ratio = 1.926 }
surface_1 = { material = "steel", radius = "10 mm" }
surface_2 = { material = "glass", radius = "inf" }
thermal = {}

[lubricant]
temperature = "35 degC"
conductivity = "0.14 W/m/K"
heat_capacity = "2000 J/kg/K"
viscosity = { law = "walther", nu_40 = "22 mm^2/s", nu_100 = "4.3 mm^2/s", alpha = "21.8 1/GPa" }
density = { law = "dowson-higginson", rho_0 = "880 kg/m^3", beta = "6.5e-4 1/K" }
shear = { law = "limiting", slope = 0.041 }
"""


def test_oil_that_heats_out_of_its_limiting_stress_does_not_swing(monkeypatch):
    """Cold oil reaches the limit and heats most; hot oil does not: sweeps changed by 25 K."""
    problem = case_from_tables(tomllib.loads(BALL_ON_GLASS))[0]
    rungs = steady.ladder
    monkeypatch.setattr(steady, "ladder", lambda *args, **named: rungs(*args, **named)[:1])
    options = Options(points=113, wedge_order=3)
    found = try_strategies(problem, options, monitor=SILENT, rough=False)[1]
    assert found.status.converged
    last = found.history[-1]
    assert last.temperature_change < 0.1 * last.temperature_rise
    assert last.cycle < 10


TRACTION_LINE = """
surface_1 = { material = "steel" }
surface_2 = { material = "steel" }
thermal = {}

[contact]
type = "line"
radius = "30 mm"
hertz_pressure = "2.8 GPa"
entrainment_speed = "10 m/s"
slide_roll_ratio = 0.01

[lubricant]
name = "santotrac-50"
temperature = "90 degC"
shear = { law = "limiting", slope = 0.09, stress = "2 MPa" }
"""


def test_oil_at_its_limiting_stress_slides_and_heats_however_stiff_it_is():
    """By alpha p_h = 62: a stress that ended 2 % above the limit lost 78 % of the heat."""
    found = solve(case_from_tables(tomllib.loads(TRACTION_LINE))[0], Options(points=513))
    assert abs(work_error(found)) < 0.005
    heat = found.heat.balance
    assert heat.shear == pytest.approx(found.traction.friction_power, rel=0.005)
    assert heat.surface_1 + heat.surface_2 == pytest.approx(heat.shear, rel=0.02)
    # the limit, 0.09 and 2 MPa over the mean pressure of a line, and what ln F exceeds it by
    limit = 0.09 + 2e6 / (math.pi / 4.0 * 2.8e9)
    assert 1.0 < -found.traction.mid_film / limit < 1.05


def test_errors_of_surface_temperatures_that_do_not_matter_are_left(monkeypatch):
    misfits: list[float] = []

    def noted(operator, right, **settings):
        misfits.append(np.abs(right).max())
        return gmres(operator, right, **settings)

    monkeypatch.setattr(surfaces, "gmres", noted)
    slow = heated_contact(1.0, sources="auto", entrainment_speed=0.03, hertz_pressure=0.3e9)
    exact = solve(slow, Options(points=65, accuracy="tight"))
    assert min(misfits) < 0.01 * surfaces.SURFACE_KELVIN
    misfits.clear()
    usual = solve(slow, Options(points=65))
    assert misfits
    assert min(misfits) > surfaces.SURFACE_KELVIN
    found, wanted = (heat_of(run).temperature - 313.0 for run in (usual, exact))
    assert wanted.max() > 0.1
    np.testing.assert_allclose(found, wanted, rtol=0, atol=2.0 * surfaces.SURFACE_KELVIN)
