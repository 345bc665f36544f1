"""Asperities below the mesh: laws, exact and dry limits, equations, convergence, bad input."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from benchmarks import any_contacts
from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import ConvergenceError, Result, load
from tehl.api.solvers import certify, solve, solve_transient
from tehl.base.errors import InputError
from tehl.cli.text import as_text
from tehl.contact.options import Options
from tehl.contact.summits import channel, gaussian_integral, mean_gap, shear_flow
from tehl.estimate.film_formulas import expected_film
from tehl.estimate.nodes import finest_grid
from tehl.estimate.scaling import ScaledProblem, scales
from tehl.estimate.summits import shared_load
from tehl.io.store import save
from tehl.kernels import properties, reynolds, summits
from tehl.operators.deformation import DirectDeformation
from tehl.operators.influence import dense_matrix
from tehl.operators.line_source import line_rise
from tehl.operators.summits import LEFT_OF_LACKING, asperity_table, change_together
from tehl.operators.trail import Trail
from tehl.operators.transient_film import Rubbing
from tehl.plots import asperity_map, pictures_of
from tehl.post.heat import work_error
from tehl.report.page import report_text
from tehl.result.solution import Status
from tehl.solver.cycle.equations import MOSTLY_DRY
from tehl.solver.cycle.methods import solve_coarsest
from tehl.solver.cycle.start import from_dry_pressure
from tehl.solver.judging.outputs import asperity_balance
from tehl.solver.monitor import SILENT
from tehl.solver.physics.cavity import oil_flow
from tehl.solver.steady import try_strategies
from tests.cases import moes_problem
from tests.reference import CLOSE, heated_contact, moes_contact
from tests.reference import touching_contact as rough
from tests.solver.runs import mixed_line, multigrid

# ---- laws


@pytest.mark.parametrize("gap", [-3.0, -0.5, 0.0, 1.0, 2.5, 4.0])
def test_the_integrals_of_greenwood_and_tripp_are_exact(gap):
    def density(s):
        return math.exp(-0.5 * s * s) / math.sqrt(2.0 * math.pi)

    at = np.array([gap])
    for n in (1.5, 2.0, 2.5):
        exact = quad(lambda s, n=n: (s - gap) ** n * density(s), gap, gap + 20.0, epsrel=1e-11)[0]
        assert gaussian_integral(n, at)[0] == pytest.approx(exact, rel=1e-9)
    exact = quad(lambda s: (gap - s) * density(s), gap - 20.0, gap, epsrel=1e-11)[0]
    assert mean_gap(at)[0] == pytest.approx(exact, rel=1e-9)


def test_the_integrals_go_on_as_powers_of_the_depth():
    for n in (2.0, 2.5):
        found = gaussian_integral(n, np.array([-40.0, -1e4]))
        assert found == pytest.approx([40.0**n, 1e4**n], rel=4e-3)


def test_the_pressure_of_asperities_has_its_published_form():
    asperities, sigma, modulus = rough(100.0, 8.0, 1.0).asperities, 0.4e-6, 226e9
    beta, eta = asperities.summit_radius, asperities.summit_density
    factor = 16.0 * math.sqrt(2.0) * math.pi / 15.0 * (eta * beta * sigma) ** 2
    at = np.array([1.0])
    exact = factor * math.sqrt(sigma / beta) * 0.5 * modulus * gaussian_integral(2.5, at)
    assert asperities.pressure(at, sigma, modulus) == pytest.approx(exact, rel=1e-12)
    area = math.pi**2 * (eta * beta * sigma) ** 2 * gaussian_integral(2.0, at)
    assert asperities.spots(at, sigma)[0] == pytest.approx(area, rel=1e-12)


def test_the_channel_is_that_of_patir_and_cheng_and_stays_open():
    gaps = np.array([0.5, 1.0, 3.0, 6.0])
    factors = (channel(gaps) / gaps) ** 3
    assert factors == pytest.approx([0.320, 0.486, 0.832, 0.969], abs=2e-3)
    wide = np.linspace(-6.0, 8.0, 400)
    assert (np.diff(channel(wide)) > 0.0).all()
    assert channel(wide).min() > 0.0


# ---- the film


def dense_state(problem: ContactProblem, points: int):
    """Return the finest level of a tight solve, on which its equations can be checked."""
    options = Options(points=points, accuracy="tight", tolerance=1e-8, half_domain="never")
    attempt, result = try_strategies(problem, options, monitor=SILENT, rough=False)
    assert result.status.converged
    return attempt.run.finest


def test_film_and_asperities_satisfy_their_equations():
    problem = rough(100.0, 8.0, 0.5)
    level = dense_state(problem, 65)
    level.update()
    film, grid = level.film, level.grid
    influence = dense_matrix(grid.shape, grid.mirror, level.equations.influence)
    total = film.p + film.asperity
    separation = level.rigid_approach + level.equations.gap.ravel() + influence @ total.ravel()
    assert separation == pytest.approx(level.separation.ravel(), abs=1e-5)
    scales, sigma = ScaledProblem.of(problem).scales, problem.asperity_rms
    gaps = level.separation * scales.film_thickness / sigma
    carried = problem.asperities.pressure(gaps, sigma, problem.reduced_modulus)
    assert film.asperity == pytest.approx(carried / scales.hertz_pressure, abs=1e-6)
    assert film.h == pytest.approx(mean_gap(gaps) * sigma / scales.film_thickness, rel=1e-5)
    assert film.p.min() > -1e-6
    carried = total.sum() * grid.dx * grid.dy + level.outside
    assert carried == pytest.approx(2.0 * math.pi / 3.0, rel=2e-3)
    flow = np.empty(grid.shape)
    reynolds.operator(film, level.stencil, flow)
    scale = np.abs(np.diff(film.rho * film.h, axis=1)).max() / grid.dx
    assert np.abs(flow[1:-1, 1:-1][film.p[1:-1, 1:-1] > 1e-6]).max() < 1e-4 * scale


def test_far_asperities_do_not_touch():
    smooth, far = moes_contact(50.0, 8.0), rough(50.0, 8.0, 40.0)
    options = Options(points=129, accuracy="tight", tolerance=1e-7)
    first, second = (solve(one, options) for one in (smooth, far))
    assert second.film_scaled.central == pytest.approx(first.film_scaled.central, rel=1e-6)


def test_low_asperities_leave_a_smooth_film_and_valid_numbers():
    tables = rough(50.0, 8.0, 1.0).model_dump(exclude_none=True)
    tables["asperities"] |= {"rms": 5e-10, "summit_density": 1e13}
    found = solve(case_from_tables(tables)[0], Options(points=129))
    assert found.load_sharing.share == 0.0
    assert np.isfinite(found.asperities.area).all()
    assert found.load_sharing.friction == 0.0  # pure rolling


def test_stiff_and_high_asperities_carry_nearly_all():
    problem = rough(100.0, 8.0, 0.15, steep=0.08, dense=0.18)
    found = solve(problem, Options(points=129))
    assert found.load_sharing.share > 0.95


def test_asperities_far_higher_than_the_film_start_on_a_wide_coarsest_grid():
    problem = rough(13.3, 10.3, 0.056, steep=6.7e-4, dense=0.0132)
    found = solve(problem, Options(points=129))
    assert min(report.points[0] for report in found.history) == 33  # its matrix is dense


def shares(problem: ContactProblem, points: int) -> float:
    """Return the part of the load on asperities."""
    attempt, result = try_strategies(problem, Options(points=points), monitor=SILENT, rough=False)
    assert result.status.converged
    level = attempt.run.finest
    return float(level.film.asperity.sum() / level.pressure.sum())


def test_the_share_of_asperities_converges_with_second_order():
    problem = rough(100.0, 8.0, 0.5)
    found = [shares(problem, points) for points in (65, 129, 257)]
    ratio = (found[1] - found[0]) / (found[2] - found[1])
    assert 2.8 < ratio < 6.0


def test_slow_contacts_are_dry_and_fast_ones_are_not():
    found = [
        shares(rough(100.0, 8.0, ratio, steep=0.02, dense=0.1), 129)
        for ratio in (0.02, 0.1, 0.4, 1.0, 3.0)
    ]
    assert found == sorted(found, reverse=True)
    assert found[0] > 0.995
    assert found[-1] < 0.01


def test_a_dry_contact_is_that_of_greenwood_and_tripp():
    problem = rough(100.0, 8.0, 0.02, steep=0.02, dense=0.1)
    level = dense_state(problem, 33)
    grid, scales = level.grid, ScaledProblem.of(problem).scales
    influence = dense_matrix(grid.shape, grid.mirror, level.equations.influence)
    gap, sigma = level.equations.gap.ravel(), problem.asperity_rms
    unit = sigma / scales.film_thickness

    def carried(separation):
        found = problem.asperities.pressure(separation / unit, sigma, problem.reduced_modulus)
        return found / scales.hertz_pressure

    pressure, approach = np.zeros(gap.size), level.rigid_approach
    for _ in range(400):  # damped, with the approach that carries the load
        separation = approach + gap + influence @ pressure
        pressure += 0.3 * (carried(separation) - pressure)
        missing = 2.0 * math.pi / 3.0 - pressure.sum() * grid.dx * grid.dy
        approach -= 0.3 * unit * missing
    total = level.film.p + level.film.asperity
    assert total.max() == pytest.approx(pressure.max(), rel=0.01)
    assert level.rigid_approach == pytest.approx(approach, rel=0.01)
    assert total.ravel() == pytest.approx(pressure, abs=0.01 * pressure.max())


def test_half_and_full_domain_share_the_load_alike():
    problem = rough(100.0, 8.0, 0.4)
    options = Options(points=65)
    full = options.model_copy(update={"half_domain": "never"})
    first, second = (solve(problem, one) for one in (options, full))
    assert first.film_scaled.central == pytest.approx(second.film_scaled.central, rel=2e-3)


# ---- the oil


def test_the_oil_through_all_sections_of_a_tight_film_is_constant():
    """The wedge m' = (3 m_i - 4 m_(i-1) + m_(i-2)) / 2 dx is a difference of fluxes at faces."""
    problem = rough(50.0, 8.0, 0.7)
    options = Options(points=65, accuracy="tight", half_domain="never")
    attempt, result = try_strategies(problem, options, monitor=SILENT, rough=False)
    result, level = Result.of(result), attempt.run.finest
    film, grid, stencil = level.film, level.grid, level.stencil
    mass = film.rho * film.h
    along = 1.5 * mass[1:-1, 1:-1] - 0.5 * mass[1:-1, :-2]
    eps = 0.5 * (film.eps_x[:, 1:] + film.eps_x[:, :-1])
    along -= (stencil.cx * grid.dx * eps * np.diff(film.p, axis=1))[1:-1, 1:]
    eps = 0.5 * (film.eps_y[1:] + film.eps_y[:-1])
    sideways = stencil.cy * eps * np.diff(film.p, axis=0)
    out = np.cumsum((sideways[0] - sideways[-1])[2:-1]) * grid.dx
    through = along.sum(axis=0)
    through[1:] += out
    full = np.logical_and.accumulate((film.p[1:-1, 1:-1] > 0.0).all(axis=0))
    assert full.sum() > 0.6 * full.size  # cavities begin at the outlet
    assert np.abs(through - through[0])[full].max() < 2e-10 * mass[1:-1, 0].sum()
    assert result.load_sharing.balance < 1e-10
    assert asperity_balance(level) == result.load_sharing.balance


@pytest.mark.parametrize("kind", ["half", "thinning", "scarce"])
def test_tight_films_with_asperities_lose_no_oil(kind):
    problem = rough(50.0, 8.0, 0.7)
    tables = problem.model_dump(exclude_none=True)
    tables["contact"]["slide_roll_ratio"] = 0.1
    if kind == "thinning":
        tables["lubricant"]["shear"] = {"law": "eyring", "stress": 5e6}
    elif kind == "scarce":
        tables["supply"] = {"ratio": 0.5}
    found = solve(case_from_tables(tables)[0], Options(points=65, accuracy="tight"))
    assert found.load_sharing.balance < 1e-10


@pytest.mark.usefixtures("no_pictures")
def test_the_balance_of_the_oil_is_printed_and_small(mixed):
    balance = mixed.load_sharing.balance
    assert 0.0 < balance < 0.02  # of the same size as the error in the inlet
    assert mixed.summary()["load_sharing"]["balance"] == balance
    assert f"{balance:.1e} of the inflow" in as_text(mixed)
    assert f"{balance:.1e}" in report_text(mixed, dpi=30)


# ---- bad input


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"model": "other"}, "greenwood-tripp"),
        ({"summit_radius": -1e-5}, "must be positive"),
        ({"summit_density": "1e10 1/m"}, "number per area"),
        ({"rms": 0.0}, "asperities.rms"),
        ({"friction": -0.1}, "must not be negative"),
        ({"summit_density": 1.0}, "check the units"),
        ({"summit_radius": 1.0}, "check the units"),
        ({"rms": 1e-20}, "check the units"),
    ],
)
def test_asperities_that_make_no_sense_are_one_sentence(change, text):
    tables = rough(100.0, 8.0, 1.0).model_dump(exclude_none=True)
    with pytest.raises(InputError, match=text) as caught:
        case_from_tables(tables | {"asperities": tables["asperities"] | change})
    assert "\n" not in str(caught.value)


# ---- results


@pytest.fixture(scope="module")
def mixed():
    """Return a sliding contact in which asperities carry some of the load."""
    tables = rough(100.0, 8.0, 0.5).model_dump(exclude_none=True)
    tables["contact"]["slide_roll_ratio"] = 0.1
    tables["lubricant"]["shear"] = {"law": "eyring", "stress": 5e6}
    return solve(case_from_tables(tables)[0], Options(points=129))


def test_load_and_friction_are_shared(mixed):
    shared, found = mixed.load_sharing, mixed.asperities
    cell = (mixed.x[1] - mixed.x[0]) * (mixed.y[1] - mixed.y[0])
    both = (found.pressure + mixed.pressure).sum() * cell
    assert both == pytest.approx(mixed.scales.load, rel=0.01)
    assert shared.share == pytest.approx(found.pressure.sum() * cell / mixed.scales.load, rel=1e-6)
    assert shared.friction == pytest.approx(
        0.1 * shared.share + abs(mixed.traction.mid_film), rel=1e-12
    )
    assert 0.0 < shared.share_error < 0.5 * shared.share
    assert 0.0 < shared.area_part < 0.1
    assert shared.pressure_max > shared.asperity_pressure_max
    assert found.separation.min() < mixed.film.minimum


def test_shared_loads_are_stored_summed_up_and_drawn(mixed, tmp_path):
    save(mixed, tmp_path / "mixed.nc")
    again = load(tmp_path / "mixed.nc")
    assert again.load_sharing == mixed.load_sharing
    np.testing.assert_array_equal(again.asperities.pressure, mixed.asperities.pressure)
    assert again.summary()["load_sharing"]["share"] == mixed.load_sharing.share
    assert asperity_map(again).axes
    assert mixed.load_sharing.share == pytest.approx(0.1, abs=0.02)


def test_a_certified_share_has_a_bar_that_holds():
    problem = rough(50.0, 8.0, 0.5)
    found = certify(problem, Options(points=129)).uncertainty["load_share"]
    finer = solve(problem, Options(points=513)).load_sharing.share
    assert found.value == pytest.approx(finer, abs=found.uncertainty)
    assert 0.0 < found.uncertainty < 0.1 * found.value


def test_explain_says_which_part_asperities_will_carry(mixed):
    expected = mixed.problem.explain()
    assert "asperities" in repr(expected)
    assert expected.shared.share == pytest.approx(mixed.load_sharing.share, rel=0.5)


# ---- scarce oil


def starved(problem: ContactProblem, ratio: float) -> ContactProblem:
    """Return the contact with less oil than it needs."""
    tables = problem.model_dump(exclude_none=True) | {"supply": {"ratio": ratio}}
    return case_from_tables(tables)[0]


def test_less_oil_leaves_more_load_to_the_asperities():
    problem = rough(50.0, 8.0, 0.7)
    runs = [solve(starved(problem, ratio), Options(points=97)) for ratio in (0.2, 0.6, 1.5, 5.0)]
    found = [run.load_sharing.share for run in runs]
    assert found == sorted(found, reverse=True)
    assert found[0] > 3.0 * found[-1]
    flooded = solve(problem, Options(points=97)).load_sharing
    assert flooded.share == pytest.approx(found[-1], rel=0.05)
    assert flooded.share < found[-1]


def test_a_starved_film_between_asperities_conserves_oil():
    problem = starved(rough(50.0, 8.0, 0.7), 0.5)
    options = Options(points=65, accuracy="tight", tolerance=1e-10, max_cycles=60)
    attempt, result = try_strategies(problem, options, monitor=SILENT, rough=False)
    assert result.status.converged
    _, passed = oil_flow(attempt.run.finest)
    passed[0] *= 0.5  # the symmetry line
    through = passed[:, :-1].sum(axis=0)
    assert through == pytest.approx(np.full_like(through, through[0]), rel=1e-9)
    film, asperity = attempt.run.finest.film.p, attempt.run.finest.film.asperity
    assert asperity[film == 0.0].max() > 1e-3  # some of them touch in the cavities


def test_stiff_asperities_that_are_nearly_all_dry_converge_together():
    """Each by itself they diverge from the film that all others move."""
    smooth = moes_problem(224.0, 0.5)
    film = expected_film(ScaledProblem.of(smooth))
    radius = 55.0 * film
    asperities = {"model": "greenwood-tripp", "rms": 1.79 * film, "summit_radius": radius}
    asperities["summit_density"] = 3.5 / (1.79 * film * radius)
    tables = smooth.model_dump(exclude_none=True) | {"asperities": asperities}
    problem = starved(ContactProblem.model_validate(tables), 0.42)
    assert shared_load(ScaledProblem.of(problem)).share > MOSTLY_DRY
    found = solve(problem, Options(points=65))
    assert len(found.history) < 10
    # the oil carries 1e-8 of the load on 129 nodes
    assert found.load_sharing.share == pytest.approx(1.0, abs=found.errors.bars["load_share"])


def test_far_asperities_leave_a_starved_film_as_it_is():
    smooth, far = moes_contact(50.0, 8.0), rough(50.0, 8.0, 100.0)
    options = Options(points=65, domain=CLOSE, accuracy="tight", tolerance=1e-7)
    layer = {"supply": {"layer": 0.4 * solve(smooth, options).film.central}}
    films = []
    for case in (smooth, far):
        tables = case.model_dump(exclude_none=True) | layer
        films.append(solve(case_from_tables(tables)[0], options).film.central)
    assert films[1] == pytest.approx(films[0], rel=1e-6)


# ---- heat


def test_the_rise_under_a_given_line_source_is_exact():
    x = np.linspace(0.0, 2.0, 81)
    for flux, exact in (
        (np.ones_like(x), 2.0 * np.sqrt(x)),
        (x, 4.0 / 3.0 * x**1.5),
    ):
        # of the flux that begins at the first node: half an interval before it is another flux
        found = line_rise(np.concatenate([[0.0], flux])[:, None], x[1])[1:, 0]
        assert found[20:] == pytest.approx(exact[20:], abs=0.03 if flux[0] else 1e-3)


def test_asperities_that_rub_heat_the_surfaces():
    case = heated_contact(0.5)
    sigma = expected_film(ScaledProblem.of(case)) / 0.3
    found = []
    for friction in (0.0, 0.1):
        table = {
            "model": "greenwood-tripp",
            "rms": sigma,
            "summit_radius": 100.0 * sigma,
            "summit_density": 0.05 / (100.0 * sigma**2),
            "friction": friction,
        }
        tables = case.model_dump(exclude_none=True) | {"asperities": table}
        problem = case_from_tables(tables)[0]
        attempt, result = try_strategies(problem, Options(points=97), monitor=SILENT, rough=False)
        found.append(Result.of(result))
    cold, warm = found
    assert warm.status.converged
    power = warm.load_sharing.power_boundary
    assert cold.load_sharing.power_boundary == 0.0
    sliding = warm.problem.motion
    rubbed = 0.1 * warm.load_sharing.share * warm.scales.load
    assert power == pytest.approx(rubbed * abs(sliding.speed_1 - sliding.speed_2), rel=1e-9)
    state = attempt.run.coupling.state
    scales, grid = warm.scales, attempt.run.finest.grid
    weights = np.where(np.arange(grid.shape[0]) > 0, 2.0, 1.0)  # half of the domain
    flux = sum((flux * weights).sum() for flux in state.solids.rubbing) * state.film.flux_unit
    cell = grid.dx * grid.dy * scales.half_width_x * scales.half_width_y
    assert flux * cell == pytest.approx(power, rel=0.01)
    first, second = (rise.max() for rise in state.solids.rises)
    assert first == pytest.approx(second, rel=0.1)  # both become as warm
    for one in found:  # the flow that asperities narrow takes less work
        assert abs(one.heat.balance.error) < 0.01
        assert abs(work_error(one)) < 0.02
    for rise, surface in ((first, "surface_1_rise_max"), (second, "surface_2_rise_max")):
        more = getattr(warm.temperature, surface) - getattr(cold.temperature, surface)
        assert more == pytest.approx(rise, rel=0.5)
    assert warm.film.central < cold.film.central


def test_the_rougher_surface_carries_more_if_it_is_faster():
    """On the line y = 0 in the contact, where no oil flows by pressure, the oil is constant."""
    case = moes_contact(200.0, 10.0)
    sigma = expected_film(ScaledProblem.of(case))
    table = {
        "model": "greenwood-tripp",
        "summit_radius": 100.0 * sigma,
        "summit_density": 0.05 / (100.0 * sigma**2),
    }
    films = []
    for parts, sliding in (((1.0, 0.0), 1.0), ((0.0, 1.0), -1.0), ((0.0, 1.0), 1.0)):
        tables = case.model_dump(exclude_none=True) | {"asperities": table}
        tables["contact"] |= {"slide_roll_ratio": sliding}
        for key, part in zip(("surface_1", "surface_2"), parts, strict=True):
            tables[key] = tables[key] | {"rms_roughness": part * sigma}
        result = solve(case_from_tables(tables)[0], Options(points=129))
        assert result.status.converged
        films.append(result.film.central)
        middle = result.y.size // 2
        inside = np.abs(result.x) < 0.6 * result.scales.half_width_x
        gap = (result.asperities.separation / sigma)[middle, inside]
        law, inlet = result.problem.lubricant.density, result.problem.inlet_temperature
        density = law.density(result.pressure[middle, inside], inlet)
        part = 0.5 * sliding * (parts[0] - parts[1])
        carried = density * (mean_gap(gap) + part * shear_flow(gap))
        assert np.ptp(carried) < 0.02 * carried.mean()
        assert np.ptp(density * mean_gap(gap)) > 2.0 * np.ptp(carried)
    assert films[0] == pytest.approx(films[1], rel=1e-9)  # surfaces and directions swapped
    assert films[2] > 1.05 * films[0]


@pytest.mark.parametrize("part", [-1.0, -0.7, 0.7, 1.0])
def test_closer_surfaces_hold_less_oil_however_they_slide(part):
    """Else a film has two separations, and cycles go to and fro between them."""
    gap = np.linspace(-2.0, 6.0, 801)
    held = mean_gap(gap) + part * shear_flow(gap)
    assert np.diff(held).min() > 0.0
    below, above = shear_flow(np.array([0.5 - 1e-9, 0.5]))
    assert below == pytest.approx(above, rel=1e-6)


def test_a_smooth_surface_slides_fast_over_a_rough_one_that_it_nearly_touches():
    tables = rough(300.0, 5.0, 0.4).model_dump(exclude_none=True)
    sigma = tables["asperities"].pop("rms")
    tables["contact"]["slide_roll_ratio"] = 1.6
    tables["surface_2"]["rms_roughness"] = sigma
    found = solve(case_from_tables(tables)[0])
    assert max(found.errors.central, found.errors.minimum) < 0.01
    assert found.asperities.separation.min() < 0.5 * sigma


# ---- time


def test_a_mixed_film_stays_as_it_is_and_follows_the_load():
    tables = rough(50.0, 8.0, 0.5).model_dump(exclude_none=True)
    tables["contact"] |= {"slide_roll_ratio": 0.02}
    found = []
    for course in ([[0.0, 0.7], [2e-4, 0.7]], [[0.0, 1.0], [1e-4, 1.3], [2e-4, 1.3]]):
        transient = {"duration": 2e-4, "frames": 0, "load": course}
        problem = case_from_tables(tables | {"transient": transient})[0]
        run = solve_transient(problem, Options(points=65))
        assert run.status.converged
        assert run.history.asperity_load[0] == pytest.approx(run.start.load_sharing.share, rel=0.01)
        film, shared = abs(run.history.traction[0]), run.start.load_sharing
        boundary = run.start.problem.asperities.friction * run.history.asperity_load[0]
        assert run.friction[0] == pytest.approx(film + boundary)
        assert shared.friction_boundary == pytest.approx(boundary, rel=0.01)
        assert run.summary()["friction"]["start"] == run.friction[0]
        found.append(run.history)
    steady, pressed = found
    assert np.ptp(steady.film_minimum) < 1e-6 * steady.film_minimum[0]
    assert np.ptp(steady.asperity_load) < 1e-4 * steady.asperity_load[0]
    assert pressed.film_minimum.min() < 0.99 * pressed.film_minimum[0]
    assert 1.3 * pressed.asperity_load[-1] > 1.1 * pressed.asperity_load[0]
    assert run.summary()["asperity_load"]["value"] == pytest.approx(pressed.asperity_load.max())
    assert "asperities       carry" in as_text(run)


def test_asperities_that_rub_heat_a_transient_film():
    """At constant load nothing changes; a steady flux warms as by the moving source at rest."""
    case = heated_contact(0.5)
    sigma, units = expected_film(ScaledProblem.of(case)) / 0.5, scales(case)
    table = {
        "model": "greenwood-tripp",
        "rms": sigma,
        "summit_radius": 100.0 * sigma,
        "summit_density": 0.05 / (100.0 * sigma**2),
    }
    duration = 0.5 * units.half_width_x / units.speed
    rises = []
    for friction in (0.0, 0.1):
        tables = case.model_dump(exclude_none=True) | {
            "asperities": table | {"friction": friction},
            "transient": {"duration": duration, "frames": 0},
        }
        history = solve_transient(case_from_tables(tables)[0], Options(points=65)).history
        rise = history.temperature_rise
        np.testing.assert_allclose(rise, rise[0], rtol=0, atol=1e-3)
        assert np.ptp(history.asperity_load) < 1e-4 * history.asperity_load[0]
        rises.append(rise[-1])
    assert rises[1] > rises[0] + 0.5

    x = np.linspace(-2.0, 1.0, 97)
    flux = np.maximum(1.0 - x**2, 0.0)[:, None] * np.ones(8)
    rubbing = Rubbing(flux, lambda heat: Trail(heat, x[1] - x[0], 1.0))
    steady = line_rise(flux, x[1] - x[0])
    np.testing.assert_allclose(rubbing.rise(), steady, atol=2e-4 * steady.max())
    rubbing.flux[:] = 0.0  # the surface carries what it took up away, half a width in 16 steps
    for _ in range(16):
        left = rubbing.rise()
        rubbing.trail.advance()
    assert left[x < -0.55].max() < 1e-3 * steady.max()
    assert left[x > 0.9].min() > 0.3 * steady.max()


def test_dry_asperities_follow_the_film_that_they_move():
    problem = rough(100.0, 8.0, 0.5, steep=0.03, dense=0.15)
    laws, reach = asperity_table(ScaledProblem.of(problem)), 1.5
    rng = np.random.default_rng(4)
    separation = laws.sigma * rng.uniform(-4.0, 6.0, (20, 30))
    before = rng.uniform(0.0, 1.5, separation.shape)
    film = properties.Film(*(np.zeros(separation.shape) for _ in range(7)))._replace(
        asperity=before.copy(),
        **{name: np.zeros(separation.shape) for name in ("stiffness", "opening", "channel")},
    )
    frozen = np.zeros(separation.shape, np.uint8)
    oil = properties.FlowTable(np.ones((9, 2)), np.ones((9, 2)), 1.0)
    summits.touch(film, separation, laws.laws, oil, frozen, reach)
    scales, sigma = ScaledProblem.of(problem).scales, problem.asperity_rms

    def left(more: float, height: float, q: float) -> float:
        gap = np.array([(height + reach * more) * scales.film_thickness / sigma])
        law = problem.asperities.pressure(gap, sigma, problem.reduced_modulus)
        return law[0] / scales.hertz_pressure - q - more

    exact = [
        brentq(left, -q - 1.0, 1e3, args=(height, q))
        for height, q in zip(separation.ravel(), before.ravel(), strict=True)
    ]
    assert film.asperity.ravel() - before.ravel() == pytest.approx(exact, rel=0.02, abs=1e-3)
    assert film.p.max() == 0.0


def test_asperities_that_keep_their_pressure_take_no_more_than_that_of_the_oil():
    problem = rough(100.0, 8.0, 0.5, steep=0.03, dense=0.15)
    laws = asperity_table(ScaledProblem.of(problem))
    rng = np.random.default_rng(5)
    separation = laws.sigma * rng.uniform(0.0, 5.0, (20, 30))
    wet, before = rng.uniform(size=separation.shape) < 0.7, rng.uniform(0.0, 0.3, separation.shape)
    film = properties.Film(*(np.zeros(separation.shape) for _ in range(7)))._replace(
        asperity=before.copy(),
        **{name: np.zeros(separation.shape) for name in ("stiffness", "opening", "channel")},
    )
    film.p[wet] = 0.1
    together, frozen = film.p + film.asperity, np.zeros(separation.shape, np.uint8)
    oil = properties.FlowTable(np.ones((9, 2)), np.ones((9, 2)), 1.0)
    summits.touch(film, separation, laws.laws, oil, frozen, np.inf)
    assert film.p + film.asperity == pytest.approx(together, abs=1e-15)
    assert (film.asperity == before)[~wet].all()
    emptied = wet & (laws.carried(separation) >= together)
    assert 0 < emptied.sum() < wet.sum()
    assert film.p[emptied].max() == 0.0
    left = wet & ~emptied
    assert film.asperity[left] == pytest.approx(laws.carried(separation)[left], abs=1e-12)


def test_asperities_that_change_together_solve_their_linear_equations():
    scaled = ScaledProblem.of(mixed_line())
    grid = finest_grid(scaled, Options(points=(65, 1)))
    deflection = DirectDeformation(grid, scaled.groups)
    rng, alone = np.random.default_rng(6), np.abs(grid.x) < 0.8
    lacking, stiffness = np.zeros(grid.shape), np.zeros(grid.shape)
    lacking[0, alone], stiffness[0, alone] = rng.uniform(0.0, 60.0, (2, alone.sum()))
    step, moved = change_together(deflection, lacking, stiffness)
    assert moved[0] == pytest.approx(deflection.matrix @ step[0], abs=1e-12 * np.abs(step).max())
    assert not step[0, ~alone].any()
    left = lacking - step - stiffness * moved
    # as much as GMRES may leave
    assert np.linalg.norm(left) <= LEFT_OF_LACKING * np.linalg.norm(lacking)


@pytest.mark.slow
def test_cycles_are_combined_where_asperities_share_the_load_with_a_steep_spike():
    """Alone they move the pressure at the spike to and fro, on all grids from 321 nodes on."""
    wide = Options.model_validate(
        {"domain": {"x": (-9.8, 9.8 * 5 / 11), "y": (-4.5, 4.5)}, "edges": "far_field"}
        | {"error": 0.008}
    )
    found = solve(rough(246.0, 14.6, 0.0637), wide)
    assert found.status.converged
    assert found.history[-1].smoother == "robust"
    assert found.errors.central < 0.02
    coarser = solve(rough(246.0, 14.6, 0.0637), Options(points=161))  # by cycles alone
    difference = coarser.film_scaled.central / found.film_scaled.central - 1.0
    assert abs(difference) < coarser.errors.central


def test_stiff_summits_of_a_slender_contact_start_from_a_dry_contact_in_balance():
    """One change of their pressure moves the film by more than in a circle: it went to and fro."""
    problem = rough(2828.0, 11.1, 0.93, steep=0.0141, dense=0.209, radius_ratio=22.4)
    run = multigrid(problem, Options(points=(97, 49)))
    coarsest = run.levels[0]
    from_dry_pressure(coarsest, run.hierarchy.expected_film)
    coarsest.update()
    assert abs(coarsest.load_error()) < 0.03
    assert coarsest.pressure.max() < 1.1
    assert solve_coarsest(run.hierarchy, newton=False)


def test_soft_summits_of_a_bearing_do_not_press_the_start_into_each_other():
    """Their dry contact lies 10 sigma deep, where the oil carries all: no start for its cycles."""
    tables = {
        "contact": {
            "hertz_pressure": "0.837 GPa",
            "entrainment_speed": "1.515 m/s",
            "slide_roll_ratio": -0.046,
        },
        "surface_1": {"material": "steel", "radius": "10.5 mm", "ra_roughness": "0.0125 um"},
        "surface_2": {
            "material": "steel",
            "radius_x": "37 mm",
            "radius_y": "-10.7363 mm",
            "ra_roughness": "0.012 um",
        },
        "lubricant": {
            "viscosity": {
                "law": "walther",
                "nu_40": "10 mm^2/s",
                "nu_100": "2.6 mm^2/s",
                "alpha": "19.4 1/GPa",
            },
            "density": {"law": "dowson-higginson", "rho_0": 880.0},
            "temperature": "84 degC",
        },
        "asperities": {
            "model": "greenwood-tripp",
            "summit_radius": "8.3 um",
            "summit_density": 3e9,
        },
    }
    found = solve(case_from_tables(tables)[0])  # M = 6,900, L = 5.0, a_y/a_x = 13
    assert max(found.errors.central, found.errors.minimum) < 0.01
    assert found.load_sharing.share < 1e-4


def test_summits_higher_than_the_bodies_are_pressed_in_start_near_their_dry_contact():
    """sigma 70 films, 12 times the approach: pressed in as by Hertz, they carried too much to end.

    On 65 nodes the share is within 0.1 % of that on 257, and the approach within 0.01 %.
    """
    _, _, drawn = any_contacts.contact(131, 22, tables_at_once=True)
    problem = drawn.model_copy(update={"thermal": None})
    run = multigrid(problem, Options(points=65))
    from_dry_pressure(run.levels[0], run.hierarchy.expected_film)
    assert solve_coarsest(run.hierarchy, newton=False)
    found = solve(problem, Options(points=65))
    assert found.load_sharing.share == pytest.approx(0.4932, rel=1.5e-3)
    assert found.film_scaled.central == pytest.approx(296.911, rel=1e-4)


def test_the_mean_gap_determines_the_separation_however_far_the_planes_cross():
    laws = asperity_table(ScaledProblem.of(rough(100.0, 8.0, 0.5))).laws
    slopes = np.diff(laws.gap[:, 0]) / laws.grid[1]
    assert slopes.min() == pytest.approx(0.01, rel=1e-9)
    linear = laws.gap[:, 0] < 0.004 * laws.grid[1] / 0.02  # of sigma
    exact = mean_gap(np.arange(-6.0, 0.0, 0.02)) * laws.grid[1] / 0.02
    assert laws.gap[: exact.size, 0][~linear[: exact.size]] == pytest.approx(
        exact[~linear[: exact.size]], rel=1e-12
    )


def test_a_contact_that_runs_dry_rests_on_its_asperities():
    tables = rough(50.0, 8.0, 0.7).model_dump(exclude_none=True)
    problem = case_from_tables(tables | {"supply": {"layer": 1e-9}})[0]
    found = solve(problem, Options(points=65))
    assert found.load_sharing.share == pytest.approx(1.0, abs=2e-3)
    assert found.pressure.max() == 0.0
    assert "the oil fills the gap nowhere" in as_text(found)


def test_oil_that_does_not_fill_the_gap_of_a_line_carries_nothing():
    """Waves of what dry asperities lack were hardly reduced: cycles stalled, or diverged."""
    drawn = any_contacts.contact(431, 30)[2].supply
    options = Options(points=(257, 1))
    flooded, scarce, scarcer = (
        solve(mixed_line(supply=supply), options)
        for supply in (
            None,
            drawn.model_copy(update={"ratio": 0.95}),
            drawn.model_copy(update={"ratio": 0.3}),
        )
    )
    # from the first strategy: 56 cycles with its fallbacks before, and none that converged
    assert len(flooded.history) < 12
    fine = solve(mixed_line(), Options(points=(513, 1)))
    assert flooded.film_scaled.central == pytest.approx(fine.film_scaled.central, rel=1e-3)
    assert 0.8 < flooded.load_sharing.share < 0.9
    assert flooded.errors.central < 0.02
    for dry in (scarce, scarcer):
        assert dry.pressure.max() == 0.0
        assert dry.load_sharing.share == pytest.approx(1.0, abs=1e-4)
    assert scarcer.film_scaled.central == pytest.approx(scarce.film_scaled.central, rel=1e-4)
    assert scarce.film_scaled.central < 0.97 * flooded.film_scaled.central


def test_summits_that_do_not_touch_have_no_spots():
    found = solve(rough(50.0, 8.0, 15.0), Options(points=129)).load_sharing
    assert (found.share, found.spots) == (0.0, None)


def test_a_diverged_result_offers_no_map_of_asperities(mixed):
    lost = replace(mixed, status=Status(kind="diverged", cause="diverged"))
    assert "asperities" in pictures_of(mixed)
    assert "asperities" not in pictures_of(lost)


def softer(result, hardness):
    """Return a result whose first solid has a hardness [Pa]."""
    case = result.problem
    solid = case.surface_1.material.model_copy(update={"hardness": hardness})
    surface = case.surface_1.model_copy(update={"material": solid})
    return replace(result, problem=case.model_copy(update={"surface_1": surface}))


@pytest.mark.usefixtures("no_pictures")
def test_summits_yield_at_the_hardness_of_the_softer_solid(mixed):
    elastic = mixed.load_sharing
    assert elastic.spots.pressure == elastic.spots.elastic_pressure
    hardness = 0.4 * elastic.spots.pressure
    pressed = softer(mixed, hardness)
    shared, found = pressed.load_sharing, mixed.asperities
    assert shared.spots.pressure == pytest.approx(hardness)
    assert shared.spots.elastic_pressure == elastic.spots.pressure
    assert shared.spots.radius == pytest.approx(elastic.spots.radius * 0.4**-0.5)
    cell = (mixed.x[1] - mixed.x[0]) * (mixed.y[1] - mixed.y[0])
    assert shared.area >= found.pressure.sum() * cell / hardness * (1 - 1e-6)
    assert shared.share == elastic.share
    assert "their hardness (" in as_text(pressed)
    assert "the hardness, where most is carried" in report_text(pressed, dpi=30)


@pytest.mark.usefixtures("no_pictures")
def test_the_regime_follows_the_share_of_the_load_where_asperities_are_computed(mixed):
    rough_numbers = mixed.roughness
    assert rough_numbers.share == mixed.load_sharing.share
    assert rough_numbers.lubrication == "mixed"
    thin = replace(rough_numbers, lambda_central=0.5)
    assert thin.lubrication == "mixed"
    assert replace(thin, share=None).lubrication == "boundary"
    assert replace(thin, share=0.005).lubrication == "full film"
    assert replace(thin, share=0.95).lubrication == "boundary"
    assert f"asperities carry {percent(rough_numbers.share)} of the load" in as_text(mixed)
    page = report_text(mixed, dpi=30)
    assert "Mixed lubrication" in page
    assert f"asperities carry {percent(rough_numbers.share)} of the load" in page


def percent(part):
    return f"{float(f'{100 * part:.3g}'):g} %"


@pytest.mark.slow
def test_cycles_go_on_until_the_oil_between_asperities_balances():
    tables = {
        "contact": {
            "radius_x": "19.66 mm",
            "radius_y": "180.8 mm",
            "moes_load": 921.8,
            "moes_speed": 8.694,
            "spin_1": 7219.0,
            "spin_2": 1520.0,
        },
        "surface_1": {"material": "steel"},
        "surface_2": {"material": "steel"},
        "lubricant": {
            "density": {"law": "dowson-higginson", "rho_0": 880.0, "beta": 6.5e-4},
            "viscosity": {"law": "roelands", "eta_0": "20.98 mPa s", "alpha": "17.91 1/GPa"},
            "shear": {"law": "eyring", "stress": "8.569 MPa"},
            "temperature": "73.1 degC",
        },
        "asperities": {
            "model": "greenwood-tripp",
            "rms": "0.7708 um",
            "summit_radius": "42.97 um",
            "summit_density": "2.479e10 1/m^2",
        },
    }
    tables["lubricant"]["viscosity"] |= {"gamma": 0.0563, "reference_temperature": "40 degC"}
    problem, _ = case_from_tables(tables)
    found = solve(problem, Options(error=0.02))
    assert found.load_sharing.balance < 0.05  # 2.4 after the cycles that the film takes


def test_asperities_whose_oil_does_not_balance_fail_by_name(monkeypatch):
    problem, options = rough(100.0, 8.0, 1.0), Options(points=129)
    monkeypatch.setattr("tehl.solver.judging.verdict.asperity_balance", lambda _: 0.2)
    with pytest.raises(ConvergenceError) as failure:
        solve(problem, options)
    status = failure.value.result.status
    assert status.cause == "oil_not_balanced"
    assert "mass-balance error is 20 % of the inflow" in status.message
