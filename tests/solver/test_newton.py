"""Newton's method: Jacobian, rate of convergence, and films on which no cycle converges."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tehl import ContactProblem, ConvergenceError, Options, Result, solve
from tehl.contact.options import ROLLER_ENDS, Domain
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.kernels import reynolds
from tehl.operators.flow import flow_table
from tehl.operators.jacobian import interpolation, jacobian, neighbours_of
from tehl.operators.turning import Entrainment
from tehl.result.solution import Status
from tehl.solver import attempts, steady
from tehl.solver.cycle.continuation import MOST_NEWTON_STEPS, RAISED_RESIDUAL, Homotopy
from tehl.solver.cycle.equations import Equations
from tehl.solver.cycle.ladder import BETWEEN_ROUGH, Strategy
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.linearised import conductance_slopes, set_unknowns, unknowns
from tehl.solver.cycle.newton import (
    LINEAR_RESIDUAL,
    RETRY_RESIDUAL,
    Newton,
    Preconditioner,
    System,
    limited,
)
from tehl.solver.cycle.relaxation import ROUGH
from tehl.solver.cycle.start import from_dry_pressure, pose_problem
from tehl.solver.judging.convergence import DivergedError
from tests.reference import DOMAIN, moes_contact
from tests.solver.rough import wavy
from tests.solver.test_roller import roller

POINTS = 65


def level(mirror: bool = True, points: int = POINTS) -> Level:
    """Return the level of a light contact, at a pressure near its solution."""
    problem = moes_contact(20.0, 10.0)
    grid = Grid(nx=points, ny=points, domain=DOMAIN, mirror=mirror)
    scaled = ScaledProblem.of(problem)
    equations = Equations.on(
        grid, scaled, flow_table(scaled), Options(deformation="fft", edges="zero")
    )
    made = Level(equations, ROUGH)
    run = solve(problem, Options(points=points, domain=DOMAIN))
    pose_problem(made)
    made.set_state(run.scaled.pressure[-grid.shape[0] :], run.rigid_approach)
    made.update()
    return made


@pytest.mark.parametrize(
    ("mirror", "spins", "third"),
    [(True, False, False), (False, False, False), (False, True, False), (False, True, True)],
)
def test_the_jacobian_is_the_derivative_of_the_operator(
    mirror: bool, spins: bool, third: bool
) -> None:
    """Products with the Jacobian are the difference of L between two states, to second order."""
    fine = level(mirror)
    shape, moves = fine.film.p.shape, None
    if third:
        weight = 1.0 / (3.0 * fine.grid.dx)
        fine.equations = replace(
            fine.equations, stencil=fine.stencil._replace(third=weight, fore=30)
        )
    if spins:  # in some rows the oil moves against x
        moves = Entrainment(1.0 - fine.grid.y, np.tile(0.7 * fine.grid.x, (shape[0], 1)))
        fine.film = fine.film._replace(speed=moves.speed, drift=moves.drift)
    rng = np.random.default_rng(1)
    change = np.where(fine.film.p > 0.05, rng.standard_normal(shape), 0.0)
    by_pressure, by_film = jacobian(
        fine.film,
        fine.stencil,
        neighbours_of(fine.grid, fine.stencil, moves),
        *conductance_slopes(fine),
    )
    bent = np.empty(shape)
    fine.equations.deformation.deflect(change, bent)
    linear = (by_pressure @ change.ravel() + by_film @ (bent.ravel() + 0.3)).reshape(shape)
    before, approach, errors = fine.film.p.copy(), fine.rigid_approach, []
    for step in (1e-4, 1e-5):
        sides = []
        for sign in (1.0, -1.0):
            fine.set_state(before + sign * step * change, approach + sign * step * 0.3)
            fine.update()
            operator = np.empty(shape)
            reynolds.operator(fine.film, fine.stencil, operator)
            sides.append(operator)
        numeric = (sides[0] - sides[1]) / (2.0 * step)
        errors.append(np.abs(numeric - linear).max() / np.abs(linear).max())
    assert errors[1] < 1e-5
    assert errors[1] < 0.1 * errors[0] + 1e-6


@pytest.mark.parametrize(("mirror", "spin"), [(True, 0.0), (False, 0.0), (False, 1.3)])
def test_the_jacobian_of_a_roller_is_the_derivative_of_the_operator(
    mirror: bool, spin: float
) -> None:
    """What lines conduct to each other depends on both films beside the conductances.

    With the spin lines beside one end move against x.
    """
    stated = {"length": "2 mm", "profile": {"shape": "logarithmic"}}
    omega = spin * roller(20.0, **stated).entrainment_speed / 1e-3
    scaled = ScaledProblem.of(roller(20.0, spin_1=omega, spin_2=omega, **stated))
    ends = Domain.model_construct(x=(-3.0, 1.6), y=ROLLER_ENDS)
    grid = Grid(nx=POINTS, ny=POINTS, domain=ends, mirror=mirror, crowding=1.5)
    options = Options(deformation="fft", edges="zero", wedge_order=3 if spin else 2)
    fine = Level(Equations.on(grid, scaled, flow_table(scaled), options), ROUGH)
    pose_problem(fine)
    from_dry_pressure(fine, 0.1)
    shape, rng, states = grid.shape, np.random.default_rng(2), []
    fine.set_state(0.5 * fine.film.p + 0.02 * rng.random(shape) * (fine.film.p > 0.0), 0.5)
    fine.update()
    change = np.where(fine.film.p > 0.05, rng.standard_normal(shape), 0.0)
    by_pressure, by_film = jacobian(
        fine.film,
        fine.stencil,
        neighbours_of(grid, fine.stencil, fine.equations.entrainment),
        *conductance_slopes(fine),
    )
    bent = np.empty(shape)
    fine.equations.deformation.deflect(change, bent)
    linear = (by_pressure @ change.ravel() + by_film @ (bent.ravel() + 0.3)).reshape(shape)
    before, approach, step = fine.film.p.copy(), fine.rigid_approach, 1e-5
    for sign in (1.0, -1.0):
        fine.set_state(before + sign * step * change, approach + sign * step * 0.3)
        fine.update()
        states.append(np.empty(shape))
        reynolds.operator(fine.film, fine.stencil, states[-1])
    numeric = (states[0] - states[1]) / (2.0 * step)
    assert np.abs(numeric - linear).max() < 1e-4 * np.abs(linear).max()


def test_bilinear_interpolation_is_exact_for_planes() -> None:
    """From a coarser grid."""
    fine, coarse = (Grid(nx=n, ny=n, domain=DOMAIN, mirror=False) for n in (33, 9))
    matrix = interpolation(fine, coarse)
    planes = [np.add.outer(2.0 * g.y, -3.0 * g.x).ravel() + 1.0 for g in (fine, coarse)]
    np.testing.assert_allclose(matrix @ planes[1], planes[0], atol=1e-12)


def test_newton_converges_quadratically_to_the_film_of_the_cycles() -> None:
    """From a perturbed film, with the load balance."""
    fine = level()
    newton = Newton(fine, Grid(nx=17, ny=17, domain=DOMAIN, mirror=True))
    central = fine.film.h[0, fine.grid.nx // 2]
    disturbed = fine.film.p * (1.0 + 0.05 * np.cos(3.0 * fine.grid.x))
    fine.set_state(disturbed, fine.rigid_approach)
    residuals = []
    for _ in range(7):
        newton.step()
        residuals.append(fine.evaluate_residual())
    assert residuals[-1] < 1e-9
    assert abs(fine.load_error()) < 1e-8
    assert fine.film.h[0, fine.grid.nx // 2] == pytest.approx(central, rel=2e-3)


def test_a_step_that_does_not_reduce_the_residual_is_undone_and_raises() -> None:
    """The level has the same state as before."""
    fine = level()
    newton = Newton(fine, Grid(nx=17, ny=17, domain=DOMAIN, mirror=True))
    fine.set_state(1.05 * fine.film.p, fine.rigid_approach)
    fine.update()
    before = unknowns(fine)
    with pytest.raises(DivergedError):
        newton.line_search(np.append(np.ones(before.size - 1), 1.0))
    np.testing.assert_array_equal(unknowns(fine), before)


def test_a_step_that_fails_is_repeated_with_more_accurate_linear_equations(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An inaccurate solution of the linear equations need not reduce the residual."""
    fine, accuracies = level(), list[float]()
    newton = Newton(fine, Grid(nx=17, ny=17, domain=DOMAIN, mirror=True))
    disturbed = fine.film.p * (1.0 + 0.05 * np.cos(3.0 * fine.grid.x))
    fine.set_state(disturbed, fine.rigid_approach)
    fine.update()
    before, solve_system = fine.evaluate_residual(), System.solve

    def misled(self: System, preconditioner: Any, accuracy: float) -> Any:
        accuracies.append(accuracy)
        change = solve_system(self, preconditioner, accuracy)
        return -change if accuracy > RETRY_RESIDUAL else change

    monkeypatch.setattr(System, "solve", misled)
    assert newton.step() == 1.0
    assert accuracies == [LINEAR_RESIDUAL, RETRY_RESIDUAL]
    assert fine.evaluate_residual() < 0.5 * before


def test_single_large_changes_are_clipped_without_shortening_the_step() -> None:
    """A few are clipped; many shorten the whole step."""
    change = np.append(np.full(4000, 0.5), 2.0)
    change[7] = -300.0
    step, share = limited(change)
    assert (step[7], share) == (-5.0, 1.0)
    np.testing.assert_array_equal(np.delete(step, 7), np.delete(change, 7))
    change[:40] = 50.0
    step, share = limited(change)
    assert share == pytest.approx(0.1)
    np.testing.assert_allclose(step, 0.1 * change, rtol=1e-15)
    np.testing.assert_array_equal(limited(0.01 * change)[0], 0.01 * change)


def test_the_norm_of_the_residual_is_positive_even_with_a_negative_diagonal() -> None:
    """Where the film is far below zero the density makes the diagonal negative."""
    fine = level()
    fine.set_state(fine.film.p, fine.rigid_approach - 50.0)
    fine.update()
    diagonal = np.empty(fine.grid.shape)
    reynolds.diagonal(fine.film, fine.stencil, fine.equations.influence.self_film, diagonal)
    assert diagonal[:, 1:-1].min() < 0.0
    assert fine.evaluate_residual() > 0.0


@pytest.mark.filterwarnings("ignore:invalid value encountered:RuntimeWarning")
def test_the_coarse_equations_are_not_singular_where_few_nodes_are_wet() -> None:
    """A wet line between two coarse lines, of which either would have the same effect."""
    fine = level()
    middle = fine.grid.nx // 2
    wet = np.zeros(fine.grid.shape, bool)
    wet[:, 1:middle] = fine.film.p[:, 1:middle] > 0.0
    wet[:-1, middle + 9] = True
    fine.set_state(np.where(wet, np.maximum(fine.film.p, 0.1), 0.0), fine.rigid_approach)
    fine.sources.reynolds[:] = np.where(wet, 0.0, 1e3)  # all other nodes stay dry
    fine.update()
    newton = Newton(fine, fine.grid.coarser())
    matrix = Preconditioner(System(newton)).coarse_matrix(System(newton))
    assert np.linalg.cond(matrix) < 1e6


def test_the_vector_of_unknowns_restores_pressure_and_approach() -> None:
    """As one array."""
    fine = level()
    before = unknowns(fine)
    film = fine.film.h.copy()
    fine.set_state(np.zeros_like(fine.film.p), 7.0)
    fine.update()
    set_unknowns(fine, before)
    np.testing.assert_allclose(unknowns(fine), before, rtol=1e-15)
    fine.update()
    np.testing.assert_allclose(fine.film.h, film, atol=1e-14)


NEWTON = BETWEEN_ROUGH[-1]


@pytest.mark.parametrize("strategy", [BETWEEN_ROUGH[0], NEWTON], ids=["cycles", "newton"])
def test_newton_and_cycles_find_the_same_film_between_waves(
    strategy: Strategy, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A wave three times as high as the smooth film, by either method."""
    monkeypatch.setattr(steady, "ladder", lambda *_, **__: (strategy,))
    run = finished(wavy((57.21, 10.52), (0.4, 1.0, 0.0)), Options(points=65, domain=DOMAIN))
    assert run.history[-1].smoother == strategy.name
    assert run.film_scaled.central == pytest.approx(0.4232, rel=5e-4)
    assert run.film_scaled.minimum == pytest.approx(0.0106, abs=2e-4)


def test_heights_are_raised_on_the_finest_grid_if_the_start_from_the_coarser_film_fails(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The film is the same whether they are raised on 65 nodes or on the coarser grid."""
    monkeypatch.setattr(steady, "ladder", lambda *_, **__: (NEWTON,))
    problem, options = wavy((57.21, 10.52), (0.2, 1.0, 0.0)), Options(points=65, domain=DOMAIN)
    raised: list[tuple[int, bool]] = []
    search, run = Newton.line_search, Homotopy.run

    def noted(self: Homotopy, iterate: Any) -> None:
        raised.append((self.level.grid.nx, self.finest))
        run(self, iterate)

    def failing(self: Newton, change: Any) -> float:
        if self.level.grid.nx == 65 and raised[-1][0] < 65:
            raise DivergedError
        return search(self, change)

    monkeypatch.setattr(Homotopy, "run", noted)
    plain = finished(problem, options)
    assert raised == [(33, False)]
    monkeypatch.setattr(Newton, "line_search", failing)
    again = finished(problem, options)
    assert raised == [(33, False), (33, False), (65, True)]
    assert plain.history[-1].residual < RAISED_RESIDUAL
    assert again.film_scaled.minimum == pytest.approx(plain.film_scaled.minimum, rel=1e-3)
    assert again.film_scaled.central == pytest.approx(plain.film_scaled.central, rel=1e-4)


def test_a_coarser_grid_raises_all_heights_even_if_its_film_is_negative(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The finest grid decides."""
    monkeypatch.setattr(steady, "ladder", lambda *_, **__: (NEWTON,))
    run = finished(wavy((20.0, 10.0), (3.0, 2.0, 0.0)), Options(points=65, domain=DOMAIN))
    assert {report.points[0] for report in run.history} == {33, 65}
    assert not run.status.converged
    assert run.film_scaled.minimum <= 0.0


def test_heights_are_not_raised_again_if_the_coarser_film_is_negative(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """They would fail again; the status reports the coarser film."""
    monkeypatch.setattr(steady, "ladder", lambda *_, **__: (NEWTON,))
    run = finished(wavy((57.21, 10.52), (1.0, 1.0, 0.0)), Options(points=65, domain=DOMAIN))
    assert (run.status.kind, run.status.cause) == ("diverged", "grid_too_coarse")
    assert "of 33 x 33 nodes, is not positive (smallest H = -" in (run.status.message or "")
    assert "more nodes" in str(run.status.hint)
    assert sum(report.points[0] == 65 for report in run.history) <= MOST_NEWTON_STEPS


@pytest.mark.slow
def test_newton_converges_where_all_cycles_stall() -> None:
    """Waves six times as high as the smooth film: Newton's method ends where the film vanishes."""
    run = finished(wavy((126.0, 12.34), (0.4, 0.5, 0.0)), Options(points=129, domain=DOMAIN))
    assert run.history[-1].smoother == "newton"
    assert run.status.cause == "grid_too_coarse"
    assert "not positive" in (run.status.message or "")
    assert run.film_scaled.minimum <= 0.0


@pytest.mark.slow
def test_newton_converges_where_all_cycles_diverge() -> None:
    """M = 200, A = 0.2, wavelength 0.5 on 257 nodes: positive, though the grid is too coarse."""
    run = finished(wavy((200.0, 10.0), (0.2, 0.5, 0.0)), Options(points=257, domain=DOMAIN))
    assert run.status.converged or run.status.cause == "grid_too_coarse"
    assert run.history[-1].residual < 1e-5
    assert abs(run.history[-1].load_error) < 1e-4
    assert run.history[-1].smoother == "newton"
    assert run.film_scaled.minimum == pytest.approx(0.0142, abs=2e-4)
    assert run.film_scaled.central == pytest.approx(0.1763, rel=2e-3)


def finished(problem: ContactProblem, options: Options) -> Result:
    """Return the result, converged or not."""
    try:
        return solve(problem, options)
    except ConvergenceError as error:
        return error.result


def test_a_film_that_vanishes_during_the_continuation_is_reported_with_the_part_of_the_heights(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Ridges far too high: the continuation ends where the film is not positive."""
    monkeypatch.setattr(steady, "ladder", lambda *_, **__: (NEWTON,))
    run = finished(wavy((20.0, 10.0), (3.0, 2.0, 0.0)), Options(points=33, domain=DOMAIN))
    assert run.status.cause in ("asperity_contact", "grid_too_coarse")
    assert run.status.message is not None
    assert "of the heights" in run.status.message
    assert run.film_scaled.minimum <= 0.0


def test_the_last_relaxation_before_newton_continues_to_the_finest_grid(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Even if coarser grids are not converging; with heat it is the last strategy."""
    seen: list[tuple[str, bool]] = []
    run = attempts._run

    def noted(*args: Any, force: bool, **solved: Any) -> Any:
        seen.append((args[0].strategy.name, force))
        found = run(*args, force=force, **solved)
        return replace(found, status=Status(kind="stalled", cause="stalled"))

    monkeypatch.setattr(attempts, "_run", noted)
    smooth = wavy((20.0, 10.0), (0.01, 2.0, 0.0))
    sheared = smooth.model_copy(update={"lubricant": thinning(smooth)})
    for problem in (smooth, sheared):
        finished(problem, Options(points=33, domain=DOMAIN))
    relaxed = [("rough", False), ("careful", False), ("damped", True)]
    assert seen == [*relaxed, ("newton", True), *relaxed]


def thinning(problem: ContactProblem) -> Any:
    """Return the lubricant with an Eyring stress."""
    given = problem.lubricant.model_dump(exclude_none=True)
    return type(problem.lubricant).model_validate(
        given | {"shear": {"law": "eyring", "stress": 5e6}}
    )
