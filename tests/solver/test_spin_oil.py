"""Spin where oil is conserved in cavities, is scarce, or leaves a boundary film: limits, moment."""

from functools import cache

import numpy as np
import pytest
from benchmarks.pairs import contact

from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.api.solvers import solve, solve_transient
from tehl.cli.text import as_text
from tehl.contact.options import Options
from tehl.post.bodies import heat_into_bodies
from tehl.solver.judging.outputs import oil_balance
from tehl.solver.monitor import SILENT
from tehl.solver.steady import try_strategies
from tests.solver.runs import rubbed_states

OTHERS = ("starved", "conserving", "boundary")
SPIN = 600.0


@cache
def solved(*features: str, spin: float = 0.0, points: int = 65) -> Result:
    """Return a contact of the table of pairs, both of whose surfaces spin [rad/s]."""
    options = Options(points=points, accuracy="tight", half_domain="never")
    return solve(spinning(*features, spin=spin), options)


def spinning(*features: str, spin: float = 0.0, **tables: object) -> ContactProblem:
    given = contact(*features).model_dump(exclude_none=True)
    given["contact"] |= {"spin_1": spin, "spin_2": spin}
    for name, table in tables.items():
        given[name] = given.get(name, {}) | table
    return ContactProblem.model_validate(given)


@pytest.mark.parametrize("other", OTHERS)
def test_hardly_any_spin_leaves_the_film_as_it_is(other):
    plain, turned = solved(other), solved(other, spin=1e-7)
    np.testing.assert_allclose(turned.scaled.film, plain.scaled.film, rtol=2e-6)


@pytest.mark.parametrize("other", OTHERS)
def test_the_opposite_spin_mirrors_film_and_oil(other):
    one, opposite = solved(other, spin=SPIN), solved(other, spin=-SPIN)
    np.testing.assert_allclose(opposite.scaled.film[::-1], one.scaled.film, rtol=1e-8)
    assert one.film.minimum < 0.99 * solved(other).film.minimum
    if one.oil is not None:
        np.testing.assert_allclose(opposite.oil.fill[::-1], one.oil.fill, atol=1e-8)


def test_scarce_oil_in_plenty_is_a_flooded_film_that_spins():
    supply = {"layer": 1e-4}
    plenty = solve(spinning("starved", spin=SPIN, supply=supply), Options(points=65))
    conserving = solve(spinning("conserving", spin=SPIN), Options(points=65))
    assert plenty.film.central == pytest.approx(conserving.film.central, rel=2e-4)
    assert plenty.film.minimum == pytest.approx(conserving.film.minimum, rel=2e-4)


@pytest.mark.parametrize("spin", [pytest.param(SPIN, marks=pytest.mark.slow), 3000.0])
def test_scarce_oil_that_enters_leaves(spin):
    """Through all sides: at 3,000 rad/s oil enters at the sides too, and leaves at the inlet."""
    problem = spinning("starved", spin=spin)
    options = Options(points=65, accuracy="tight")
    attempt, result = try_strategies(problem, options, monitor=SILENT, rough=True)
    assert result.status.converged
    assert oil_balance(attempt.run.finest) < 1e-4
    entering = result.oil.entering
    assert (entering.min() < 0.0) == (spin > 1000.0)


def test_the_moment_of_a_dry_contact_that_spins_is_the_closed_one():
    """3 pi/16 mu w a of a circle under pure spin, and its power becomes heat."""
    tables = {
        "contact": {"load": 20.0, "entrainment_speed": 0.05, "slide_roll_ratio": 0.0},
        "contact_film": {"thickness": 5e-7, "friction": 0.1},
    }
    given = spinning("boundary", **tables).model_dump(exclude_none=True)
    given["contact"] |= {"spin_1": 100.0, "spin_2": -100.0}
    found = solve(ContactProblem.model_validate(given), Options(points=129))
    touching, hertz = found.touching, found.problem.hertz
    assert touching.share > 0.98
    limit = 3.0 * np.pi / 16.0 * 0.1 * touching.share * found.load * hertz.half_width_x
    assert -touching.drilling_boundary == pytest.approx(limit, rel=0.01)
    assert touching.power_boundary == pytest.approx(-200.0 * touching.drilling_boundary, rel=1e-9)
    assert touching.friction_boundary < 1e-3  # what rolls brings the centre of the load upstream
    assert "moment of friction" in as_text(found)


def test_the_heat_of_a_contact_that_spins_is_its_friction(monkeypatch):
    states = rubbed_states(monkeypatch)
    tables = {
        "contact": {"entrainment_speed": 1.0, "spin_1": 800.0, "spin_2": -400.0},
        "contact_film": {"thickness": 3e-7},
    }
    given = contact("heat", "boundary").model_dump(exclude_none=True)
    for name, table in tables.items():
        given[name] |= table
    found = solve(ContactProblem.model_validate(given), Options(points=65))
    state, scales = states[-1], found.scales
    flux = state.film.flux_unit * state.grid.unfold(sum(state.solids.rubbing).T)
    cell = state.grid.dx * state.grid.dy * scales.half_width_x * scales.half_width_y
    assert found.touching.power_boundary > 0.02
    assert flux.sum() * cell == pytest.approx(found.touching.power_boundary, rel=1e-8)
    into_film, into_bodies = found.heat.balance, sum(heat_into_bodies(found))
    rubbed = into_bodies - into_film.surface_1 - into_film.surface_2
    assert rubbed == pytest.approx(found.touching.power_boundary, rel=1e-8)


@pytest.mark.parametrize(
    ("others", "duration"),
    [
        pytest.param(("starved",), 5e-3, marks=pytest.mark.slow),
        (("conserving", "boundary"), 2e-3),
    ],
)
def test_a_slow_change_follows_the_steady_films(others, duration):
    """As well as without spin: minima of conserving films then differ by 0.25 % on these nodes.

    The first film keeps its wedge, others do not.
    """
    slow, there = (
        solve_transient(
            spinning(*others, spin=SPIN, transient={"load": course, "duration": end, "frames": 0}),
            Options(points=65, tolerance=1e-7),
        ).history
        for course, end in (
            ([[0.0, 1.0], [0.4 * duration, 1.2]], duration),
            ([[0.0, 1.2]], 1e-5),
        )
    )
    assert slow.film_central[-1] == pytest.approx(there.film_central[0], rel=1e-3)
    assert slow.film_minimum[-1] == pytest.approx(there.film_minimum[0], rel=2.5e-3)
