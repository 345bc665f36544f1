"""Cycles for surfaces that touch: the contact they solve, and the answers of Newton's method."""

import numpy as np
import pytest
from benchmarks.touching import of_share
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import nnls

from benchmarks import any_contacts
from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.api.solvers import solve
from tehl.contact.options import Domain, Options
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.operators.influence import dense_matrix
from tehl.operators.jacobian import neighbours_of
from tehl.solver import steady
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.ladder import TOUCHING
from tehl.solver.cycle.relaxation import ROUGH
from tehl.solver.cycle.start import from_dry_pressure
from tehl.solver.cycle.transfers import restrict
from tehl.solver.judging.convergence import DivergedError
from tehl.solver.physics.boundary_contact import choose_orders, oil_step
from tehl.solver.physics.boundary_cycle import TouchingCycle
from tehl.solver.physics.solid_shares import contact_of
from tests.reference import moes_contact
from tests.solver.rough import wavy
from tests.solver.test_touching import through_film

SQUARE = Domain(x=(-2.0, 2.0), y=(-2.0, 2.0))


@pytest.mark.parametrize("mirror", [False, True])
def test_the_contact_pressure_is_that_of_a_complementarity_problem(mirror: bool):
    least = 0.05
    problem = through_film(moes_contact(100.0, 5.0), least)
    grid = Grid(nx=33, ny=33, domain=SQUARE, mirror=mirror)
    options = Options(points=33, edges="zero", domain=SQUARE, deformation="fft")
    level = Hierarchy.on(grid, ScaledProblem.of(problem), options, ROUGH).finest
    from_dry_pressure(level, 0.1)
    rough = 0.1 * np.cos(4.0 * np.pi * grid.x) * np.cos(2.0 * np.pi * grid.y)[:, None]
    level.sources.film -= rough
    oil = 0.6 * level.film.p
    level.set_state(oil, level.rigid_approach)
    level.update()
    apart = level.separation.copy()

    TouchingCycle([level], lambda: None)._settle(12, 1e-12)

    # P_c >= 0, K P_c + H - H_c >= 0, complementary: least squares with the Cholesky factor of K
    influence = dense_matrix(grid.shape, mirror, level.equations.influence)
    inner = np.zeros(grid.shape, bool)
    inner[(0 if mirror else 1) : -1, 1:-1] = True
    inside = inner.ravel()
    matrix = influence[np.ix_(inside, inside)]
    weights = np.ones(grid.shape)
    weights[1:] = 2.0 if mirror else 1.0  # a node and its image
    scale = np.sqrt(weights.ravel()[inside])
    symmetric = scale[:, None] * matrix / scale
    factor = cholesky(0.5 * (symmetric + symmetric.T))
    gap = scale * (apart.ravel()[inside] - least)
    found, _ = nnls(factor, solve_triangular(factor, -gap, trans=1))
    expected = np.zeros(inside.size)
    expected[inside] = found / scale
    assert expected.max() > 0.1
    assert level.film.asperity.ravel() == pytest.approx(expected, abs=1e-9)
    assert level.film.p == pytest.approx(oil)  # it stays
    assert (level.separation[inner] >= least - 1e-12).all()


@pytest.mark.parametrize("mirror", [False, True])
def test_the_response_keeps_the_contact_closed(mirror: bool):
    """A step of the rigid approach leaves H = H_c and moves the load by the stiffness."""
    problem = through_film(moes_contact(100.0, 5.0), 0.5)
    grid = Grid(nx=65, ny=65, domain=SQUARE, mirror=mirror)
    options = Options(points=65, edges="zero", domain=SQUARE, deformation="fft")
    level = Hierarchy.on(grid, ScaledProblem.of(problem), options, ROUGH).finest
    from_dry_pressure(level, 0.1)
    level.set_state(0.4 * level.film.p, level.rigid_approach - 0.8)
    cycle = TouchingCycle([level], lambda: None)
    for _ in range(4):
        cycle._settle(12)
    assert np.count_nonzero(level.share.touching) * (1 + mirror) > 1200
    indented = cycle._respond()
    response, touching = level.share.response, level.share.touching.copy()
    load, separation = level.load_error() * level.sources.load, level.separation.copy()
    level.move(-0.01)
    answered = -level.missing_load()
    cycle._take_response(indented)
    level.share.stays = True
    level.update()
    moved = level.separation - separation
    assert moved[touching] == pytest.approx(0.0, abs=3e-5)
    assert moved == pytest.approx(-0.01 * response.lift, abs=3e-5)
    taken = level.load_error() * level.sources.load
    assert taken - load == pytest.approx(0.01 * response.stiffness, rel=1e-9)
    assert answered == pytest.approx(taken, rel=1e-9)


@pytest.mark.parametrize("mirror", [False, True])
def test_the_contact_of_a_coarser_level_stays_closed_as_its_oil_changes(mirror: bool):
    """By steps of descent, and at once on the coarsest level; the load grows by the answer too."""
    problem = through_film(moes_contact(100.0, 5.0), 0.5)
    grid = Grid(nx=65, ny=65, domain=SQUARE, mirror=mirror)
    options = Options(points=65, edges="zero", domain=SQUARE, deformation="fft")
    hierarchy = Hierarchy.on(grid, ScaledProblem.of(problem), options, ROUGH)
    fine, coarse = hierarchy.finest, hierarchy.levels[-2]
    from_dry_pressure(fine, 0.1)
    fine.set_state(0.4 * fine.film.p, fine.rigid_approach - 0.8)
    cycle = TouchingCycle([fine], lambda: None)
    for _ in range(4):
        cycle._settle(12)
    cycle._respond()
    restrict(fine, coarse)
    share = contact_of(coarse.share)
    touching, before = share.touching.copy(), coarse.separation.copy()
    assert 400 < touching.sum() * (1 + mirror) < 460
    missing = coarse.missing_load()
    x, y = coarse.grid.x, coarse.grid.y[:, None]
    pressed = np.where(touching, 0.0, 0.01 * np.exp(-((x + 1.5) ** 2) - y**2))
    coarse.film.p[:] += pressed
    for _ in range(12):
        coarse.is_stale = True
        coarse.update()
    moved, answer = coarse.separation - before, share.answer(coarse)
    assert (answer[~touching] == 0.0).all()
    assert moved[touching] == pytest.approx(0.0, abs=1e-3 * moved.max())
    dense = dense_matrix(coarse.grid.shape, mirror, coarse.equations.influence)
    exact = (share.yielding(dense) @ pressed.ravel()).reshape(moved.shape)
    assert exact[touching] == pytest.approx(0.0, abs=1e-12)
    assert moved == pytest.approx(exact, abs=1e-3 * moved.max())
    free = (dense @ pressed.ravel()).reshape(moved.shape)
    beside = ~touching & (np.roll(touching, -1, axis=1) | np.roll(touching, 1, axis=1))
    assert (exact[beside] < 0.6 * free[beside]).all()  # what a cycle without the answer misses
    carried = coarse.equations.balances.integral(pressed + answer)
    assert missing - coarse.missing_load() == pytest.approx(carried, rel=0.05)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_an_oil_step_is_that_of_newtons_method_where_surfaces_touch(order: int):
    """A small part of the step takes that part of the residual away, at fixed film."""
    problem = through_film(moes_contact(100.0, 5.0), 0.5)
    grid = Grid(nx=65, ny=65, domain=SQUARE, mirror=True)
    options = Options(points=65, edges="zero", domain=SQUARE, deformation="fft", wedge_order=order)
    level = Hierarchy.on(grid, ScaledProblem.of(problem), options, ROUGH).finest
    from_dry_pressure(level, 0.1)
    level.set_state(0.4 * level.film.p, level.rigid_approach - 0.8)
    level.update()
    choose_orders(level, min(order, 2))
    touching, part = contact_of(level.share).touching & (level.film.p > 0.0), 1e-7
    assert touching.sum() > 400
    level.evaluate_residual()
    before = level.sources.residual.copy()
    change = oil_step(level, neighbours_of(grid, level.stencil), touching)
    assert (change[~touching] == 0.0).all()
    level.film.p[:] += part * change
    level.update_properties()
    level.evaluate_residual()
    taken = (before - level.sources.residual)[touching] / part
    assert taken == pytest.approx(before[touching], abs=1e-4 * np.abs(before).max())


def test_a_film_that_is_not_finite_has_diverged():
    problem = through_film(moes_contact(100.0, 5.0), 0.05)
    grid = Grid(nx=33, ny=33, domain=SQUARE, mirror=False)
    level = Hierarchy.on(grid, ScaledProblem.of(problem), Options(points=33), ROUGH).finest
    from_dry_pressure(level, 0.1)
    level.sources.film[16, 16] = -np.inf
    with pytest.raises(DivergedError):
        TouchingCycle([level], lambda: None)._settle(12)


@pytest.fixture(scope="module")
def grooves() -> list[Result]:
    """Return grooves along the motion by cycles, default and tight, and by Newton's method."""
    film = expected_central_film(ScaledProblem.of(moes_contact(100.0, 8.0)).groups)
    problem = through_film(wavy((100.0, 8.0), (film, 1.0, 90.0)), 0.5 * film)
    found = [solve(problem, Options(points=65, accuracy=a)) for a in ("discretisation", "tight")]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(steady, "ladder", lambda *_, **__: TOUCHING[-1:])
        return [*found, solve(problem, Options(points=65, accuracy="tight"))]


def test_cycles_and_newtons_method_find_the_same_film_and_contact(grooves: list[Result]):
    _, cycles, newton = grooves
    assert (cycles.history[-1].smoother, newton.history[-1].smoother) == ("careful", "newton")
    assert 0.4 < cycles.touching.share < 0.5
    assert cycles.scaled.film == pytest.approx(newton.scaled.film, abs=1e-7)
    assert cycles.scaled.pressure == pytest.approx(newton.scaled.pressure, abs=1e-5)
    unit = cycles.scales.hertz_pressure
    assert cycles.contact.pressure / unit == pytest.approx(newton.contact.pressure / unit, abs=1e-5)
    assert max(float(one.contact.balance) for one in (cycles, newton)) < 1e-10


def test_a_solve_to_the_error_of_the_grid_balances_the_oil_to_a_hundredth(grooves: list[Result]):
    default, tight, _ = grooves
    least = default.problem.contact_film.thickness / default.scales.film_thickness
    assert default.scaled.film.min() >= least * (1.0 - 1e-12)
    assert 1e-10 < float(default.contact.balance) < 0.01
    assert len(default.history) < len(tight.history)
    # the iteration error is a part of the bar, which is that of the grid
    assert default.touching.share == pytest.approx(
        tight.touching.share, abs=0.1 * default.touching.share_error
    )
    assert default.touching.share_error > 0.01


def test_geometric_means_find_the_film_between_summits_on_fewer_nodes():
    """By arithmetic ones it is too thin: summits touch, on 129 and 257 nodes, by that error."""
    problem = of_share("random", 0.05)
    stated = (Options(points=129, wedge_order=order) for order in (2, 3))
    arithmetic, geometric = (solve(problem, one) for one in stated)
    assert {one.history[-1].smoother for one in (arithmetic, geometric)} == {"careful"}
    # on 513 nodes 0.3728 by geometric means, and nothing touches; by arithmetic ones 0.3692
    assert arithmetic.film_scaled.central == pytest.approx(0.3725, rel=0.07)
    assert geometric.film_scaled.central == pytest.approx(0.3725, rel=0.04)
    assert arithmetic.touching.share > 0.1
    assert geometric.touching.share == 0.0


def test_the_bar_of_a_film_that_touches_is_not_that_of_third_order_alone():
    """Where surfaces touch the wedge is of first order: that bar is 0.8 of the error."""
    _, _, problem = any_contacts.contact(63, 12, tables_at_once=True)
    coarse, fine = (solve(problem, Options(points=n, wedge_order=3)) for n in (129, 257))
    off = abs(fine.film.central / coarse.film.central - 1.0)
    assert 0.0 < coarse.touching.share < 1.0
    assert off < 0.8 * coarse.errors.central


def test_oil_before_a_patch_is_corrected_by_coarser_grids():
    """On them the contact answers to it; else the patch spreads over twice the load, and stalls."""
    _, _, problem = any_contacts.contact(1, 15, tables_at_once=True)
    tables = problem.model_dump(exclude_none=True)
    del tables["thermal"]
    options = Options(points=65, accuracy="tight", tolerance=1e-7, max_cycles=40)
    found = solve(ContactProblem.model_validate(tables), options)
    reports = [one for one in found.history if one.points[0] == 65]
    assert {one.smoother for one in reports} == {"careful"}
    assert reports[30].residual < 1e-3 * reports[10].residual


def test_surfaces_whose_oil_fills_no_boundary_film_touch_beside_asperities():
    """Where they part, asperities that lose the pressure of the contact move the film at once."""
    _, features, problem = any_contacts.contact(57, 36, tables_at_once=True)
    assert {"asperities", "contact_film", "rough", "supply"} <= features
    still = problem.model_copy(update={"transient": None})
    found = solve(still, Options(points=81))
    assert found.touching.share == pytest.approx(1.0, abs=0.01)  # little oil, a rough dry contact
    assert found.film_scaled.minimum == pytest.approx(found.film_scaled.central, rel=1e-6)
