"""The solver of the coarsest grid: Newton steps, and steps with an earlier matrix."""

import numpy as np
import pytest

from tehl.api.problem import case_from_tables
from tehl.api.solvers import solve, solve_transient
from tehl.contact.options import Options
from tehl.estimate.scaling import scales
from tehl.solver.cycle import film_solver
from tehl.solver.cycle.coarsest import CoarsestSolver
from tehl.solver.cycle.linearised import residual_of
from tehl.solver.cycle.start import from_dry_pressure
from tehl.solver.judging.measures import film_extremes
from tehl.solver.transient.snapshot import pack, unpack
from tests.reference import DOMAIN, moes_contact
from tests.solver.runs import mixed_line, multigrid
from tests.solver.test_roller import roller

STEPS = 7
"""Newton steps from the Hertz pressure to rounding errors."""


@pytest.fixture
def solved() -> CoarsestSolver:
    """Return a coarsest grid whose equations are solved."""
    hierarchy = multigrid(moes_contact(100.0, 10.0), Options(points=65, domain=DOMAIN)).hierarchy
    from_dry_pressure(hierarchy.levels[0], hierarchy.expected_film)
    for _ in range(STEPS):
        change = hierarchy.coarsest.newton_step()
    assert change < 1e-6
    return hierarchy.coarsest


def stepped(solver: CoarsestSolver, load: float, *, newton: bool) -> tuple[np.ndarray, float]:
    """Return pressure and rigid approach after a step under ``load`` times the load."""
    level = solver.level
    start, target = level.state(), level.sources.load
    level.sources.load *= load
    (solver.newton_step if newton else solver.step)()
    found = level.pressure.copy(), level.rigid_approach
    level.set_state(*start)
    level.sources.load = target
    return found


def test_an_earlier_matrix_solves_equations_that_changed_little(solved):
    known = solved.last
    pressure, approach = stepped(solved, 1.02, newton=False)
    assert solved.last is known
    exact, there = stepped(solved, 1.02, newton=True)
    moved = np.abs(exact - solved.level.pressure).max()
    assert np.abs(pressure - exact).max() < 0.05 * moved
    assert approach == pytest.approx(there, abs=0.05 * abs(there - solved.level.rigid_approach))


@pytest.fixture(scope="module")
def between_asperities() -> CoarsestSolver:
    """Return the solved coarsest grid of a line that runs dry between asperities."""
    hierarchy = multigrid(mixed_line(), Options(points=(129, 1))).hierarchy
    from_dry_pressure(hierarchy.levels[0], hierarchy.expected_film)
    changes = [hierarchy.coarsest.newton_step() for _ in range(24)]
    assert changes[-1] < 1e-9
    hierarchy.levels[0].update()
    return hierarchy.coarsest


def test_steps_between_asperities_satisfy_their_equations(between_asperities):
    """Oil was clipped where it would be negative, and the load that it left was lost."""
    level = between_asperities.level
    assert abs(level.load_error()) < 1e-9
    wet, separation = level.film.p > 0.0, level.separation
    assert 0 < wet.sum() < wet.size
    table = level.equations.solids.asperities
    assert level.film.asperity == pytest.approx(table.carried(separation), abs=1e-9)
    moves = residual_of(level) / (level.stencil.cx * level.film.eps)  # as a change of pressure
    assert np.abs(moves[:, 1:-1][wet[:, 1:-1]]).max() < 1e-9


def test_a_matrix_without_rows_of_oil_is_not_used_where_oil_has_come(between_asperities):
    """Their errors stayed, 0.9 a cycle: the steps converged, but not to the film."""
    known, level = between_asperities.last, between_asperities.level
    exact = stepped(between_asperities, 1.001, newton=True)
    wet = np.flatnonzero(level.film.p.ravel() > 0.0)
    known.work.dry[wet[wet.size // 2]] = 1
    between_asperities.last = known
    pressure, approach = stepped(between_asperities, 1.001, newton=False)
    assert between_asperities.last is not known
    assert pressure == pytest.approx(exact[0], abs=1e-12)
    assert approach == pytest.approx(exact[1], abs=1e-12)


def test_where_it_does_not_a_newton_step_takes_its_place(solved):
    known = solved.last
    pressure, approach = stepped(solved, 3.0, newton=False)
    assert solved.last is not known
    exact, there = stepped(solved, 3.0, newton=True)
    assert pressure == pytest.approx(exact, abs=1e-12)
    assert approach == pytest.approx(there, abs=1e-12)


@pytest.mark.parametrize("points", [33, 65])  # with the finest grid next, or another one
def test_a_coarsest_state_that_has_not_converged_is_no_start(points, monkeypatch):
    def fails(hierarchy, **_):
        coarsest = hierarchy.levels[0]
        coarsest.set_state(np.full_like(coarsest.film.p, np.nan), np.nan)
        coarsest.update()
        return False

    case, options = moes_contact(20.0, 10.0), Options(points=points, domain=DOMAIN)
    usual, found = multigrid(case, options), multigrid(case, options)
    usual.solve(force=False)
    monkeypatch.setattr(film_solver, "solve_coarsest", fails)
    assert found.solve(force=False)
    assert film_extremes(found.finest) == pytest.approx(film_extremes(usual.finest), rel=2e-3)


def test_rigid_contacts_with_scarce_oil_are_similar_whatever_their_load():
    """Without deflection and pressure in the oil the load scales all films alike.

    Of the start no node carried a load, which left Newton's method without unknowns.
    """
    parts, errors = [], []
    for load in (0.05, 0.15):
        tables = moes_contact(load, 10.0).model_dump(exclude_none=True)
        contact = case_from_tables(tables | {"supply": {"ratio": 0.72}})[0]
        film = solve(contact, Options(error=0.02))
        flooded = solve(moes_contact(load, 10.0), Options(error=0.02))
        parts.append(film.film.central / flooded.film.central)
        errors.append(film.errors.central)
        assert 0.0 < errors[-1] < 0.02
    assert parts[0] == pytest.approx(parts[1], rel=max(errors))
    assert parts[0] < 0.72


def test_time_steps_of_a_roller_keep_the_matrix(monkeypatch):
    """It takes half of a step; a resumed run makes that of an earlier state again, bit by bit."""
    made, newton_step = [], CoarsestSolver.newton_step

    def counted(solver):
        made.append(1)
        return newton_step(solver)

    ends = {"length": "1 mm", "profile": {"shape": "logarithmic"}, "moes_speed": 6.0}
    units = scales(roller(10.0, **ends))
    unit = units.half_width_x / units.speed
    course = {"duration": 0.2 * unit, "load": [[0.0, 1.0], [unit, 1.5]], "frames": 0}
    case, kept = roller(10.0, transient=course, **ends), []
    options = Options(points=(129, 65), wedge_order=3)

    def keep(snapshot):
        kept.append(snapshot.copy())
        monkeypatch.setattr(CoarsestSolver, "newton_step", counted)  # after the first step

    whole = solve_transient(case, options, keep=keep).history
    assert len(made) < 0.3 * whole.time.size
    monkeypatch.undo()
    again = solve_transient(case, options, resume=unpack(pack(kept[2]))).history
    for name in ("film_central", "film_minimum", "rigid_approach"):
        np.testing.assert_array_equal(getattr(again, name), getattr(whole, name))
