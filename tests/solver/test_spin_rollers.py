"""Rollers that spin: limits, mirror images, the ellipse in their middle, oil beyond the inlet."""

import numpy as np
import pytest
from benchmarks.pairs import tables_of
from scipy.linalg.lapack import dgetrs

from benchmarks import any_contacts
from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import Result
from tehl.api.solvers import solve, solve_transient
from tehl.contact.moment import Moment
from tehl.contact.options import ROLLER_ENDS, Domain, Options
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import load_per_e_fold, slowing
from tehl.operators.far_field import far_field
from tehl.operators.surfaces import Solids, sides
from tehl.operators.turning import entrainment, turning_wedge
from tehl.post.film import mass_flow
from tehl.solver.cycle.linearised import linearised, residual_of
from tehl.solver.judging.outputs import oil_balance
from tehl.solver.monitor import SILENT
from tehl.solver.physics.cavity import around, oil_flow
from tehl.solver.steady import try_strategies
from tests.solver.runs import multigrid

NODES = (65, 33)
SPIN = 300.0
"""Of both surfaces [rad/s]: on a roller of 1 mm at 0.4 m/s both ends differ by 75 % of the mean."""
CROWN = {"shape": "crown", "radius": "0.2 m"}


def spinning(*features: str, spin: float = SPIN, **contact: object) -> ContactProblem:
    """Return the roller of the table of pairs, crowned, both of whose surfaces spin [rad/s]."""
    tables = tables_of("roller", *features)
    motion = {"spin_1": spin, "spin_2": spin, "profile": CROWN}
    tables["contact"] = tables["contact"] | motion | contact
    return case_from_tables(tables)[0]


def solved(problem: ContactProblem) -> Result:
    return solve(problem, Options(points=NODES, accuracy="tight", half_domain="never"))


@pytest.mark.parametrize(
    ("other", "error"),  # conserved oil: the error of the iteration
    [((), 1e-9), (("conserving",), 1e-5), (("boundary",), 1e-9)],
    ids=["flooded", "conserving", "boundary"],
)
def test_hardly_any_spin_changes_nothing_and_the_opposite_one_mirrors_the_film(other, error):
    plain, hardly = solved(spinning(*other, spin=0.0)), solved(spinning(*other, spin=1e-7))
    np.testing.assert_allclose(hardly.scaled.film, plain.scaled.film, rtol=error)
    one, opposite = solved(spinning(*other)), solved(spinning(*other, spin=-SPIN))
    np.testing.assert_allclose(opposite.scaled.film[::-1], one.scaled.film, rtol=1e-8)
    assert one.film.minimum < 0.97 * plain.film.minimum
    assert one.film.minimum_at[1] > 0.0  # on the left, where the surfaces are slower
    # what the surfaces carry through the ends counts; as well as without spin
    balances = [mass_flow(found).imbalance for found in (one, plain)]
    assert balances[0] < 1.1 * balances[1]


def scarce(spin: float = SPIN) -> ContactProblem:
    """Return the roller with a layer of 0.2 um, whose meniscus reaches both loaded ends."""
    given = spinning("starved", spin=spin).model_dump(exclude_none=True)
    return ContactProblem.model_validate(given | {"supply": {"layer": 2e-7}})


def test_scarce_oil_comes_in_through_the_ends_as_the_layer():
    options = Options(points=NODES, accuracy="tight", half_domain="never")
    attempt, found = try_strategies(scarce(), options, monitor=SILENT, rough=True)
    assert found.status.converged
    assert len(found.history) < 22  # 16
    level, opposite = attempt.run.finest, solved(scarce(-SPIN))
    assert oil_balance(level) < 1e-4
    np.testing.assert_allclose(opposite.scaled.film[::-1], found.scaled.film, rtol=1e-8)
    np.testing.assert_allclose(opposite.oil.fill[::-1], found.oil.fill, atol=1e-8)
    # in time the oil of this film stays where it is: of cavities beside ends too
    held, _ = oil_flow(level)
    wedge = turning_wedge(held, level.equations.entrainment, level.balance, level.film)
    oil = around(level.film.partial == 0)
    assert np.abs(wedge[~oil]).max() < 1e-9 * np.abs(wedge).max()
    assert (~oil[0, 1:-1] & (level.film.drift[0, 1:-1] > 0.0)).any()


def test_spins_of_random_rollers_leave_all_else_that_is_drawn_as_it_is(monkeypatch):
    kind, features, spins = any_contacts.contact(401, 22)
    assert (kind, features) == ("roller", {"spin"})
    monkeypatch.setattr(any_contacts, "_turned", lambda *_: None)
    plain = any_contacts.contact(401, 22)[2]
    alone = {"spin_1": plain.contact.spin_1, "spin_2": plain.contact.spin_2}
    assert spins.model_copy(update={"contact": spins.contact.model_copy(update=alone)}) == plain
    ends = 0.5 * spins.contact.length * np.abs([spins.contact.spin_1, spins.contact.spin_2])
    assert 0.0 < ends.max() <= 0.5 * spins.entrainment_speed


@pytest.mark.parametrize("layer", [0.1, 100.0])
def test_the_newton_step_of_the_coarsest_grid_has_the_derivative_of_what_comes_in(layer):
    hierarchy = multigrid(scarce(), Options(points=NODES, half_domain="never")).hierarchy
    solver, level = hierarchy.coarsest, hierarchy.coarsest.level
    level.cavity.mark = lambda _: None  # all is full
    rng, shape = np.random.default_rng(1), level.grid.shape
    level.film.layer[:], level.film.second[:], level.film.partial[:] = layer, 1, 0
    pressure, change = np.zeros(shape), np.zeros(shape)
    pressure[:, 1:-1] = 0.5 + 0.1 * rng.random((shape[0], shape[1] - 2))
    change[:, 1:-1] = rng.standard_normal((shape[0], shape[1] - 2))
    level.set_state(pressure, 1.0)
    level.update()
    known, steps = solver._factored(linearised(level), solver._system()), []
    free = known.work.free[: known.size]
    for step in (1e-6, -1e-6):
        level.set_state(pressure + step * change, 1.0)
        level.update()
        steps.append(residual_of(level).ravel()[free])
    numeric = np.append((steps[1] - steps[0]) / 2e-6, np.zeros(level.rigid.size))
    numeric[known.size] = solver._system().area[free] @ change.ravel()[free]
    solution, _ = dgetrs(known.factors, known.pivots, numeric, trans=1)
    np.testing.assert_allclose(solution[: known.size], change.ravel()[free], atol=1e-4)


def test_bars_compare_with_a_film_of_the_coarsest_grid_that_has_converged():
    """In 7 steps of limited length; the start would make a bar of 46 % of a minimum within 2 %."""
    found = solve(spinning(profile={"shape": "logarithmic"}), Options(points=NODES))
    assert found.errors.minimum < 0.12


def test_a_crown_that_carries_nothing_at_its_ends_is_an_ellipse_that_spins():
    """At one mesh width, with different spins of both surfaces; lines of the roller crowd."""
    found, half_widths = [], (1.0, 1.0)
    tables = tables_of()
    for shape in ("ellipse", "roller"):
        motion = {"entrainment_speed": "1 m/s", "spin_1": 800.0, "spin_2": 400.0}
        stated = {"slide_roll_ratio": 0.3, "load": "60 N"} | motion
        if shape == "ellipse":
            stated |= {"radius_x": "20 mm", "radius_y": "200 mm"}
            problem = case_from_tables(tables | {"contact": stated})[0]
            half_widths = problem.hertz.half_width_x, problem.hertz.half_width_y
            box = Domain(x=(-4.5, 1.5), y=(-3.2, 3.2))
        else:
            stated |= {"type": "roller", "radius": "20 mm", "profile": CROWN}
            stated["length"] = 6.4 * half_widths[1]
            problem = case_from_tables(tables | {"contact": stated})[0]
            unit = half_widths[0] / problem.hertz.half_width_x
            box = Domain(x=(-4.5 * unit, 1.5 * unit))
        options = Options(points=129, half_domain="never", edges="zero", wedge_order=3, domain=box)
        found.append(solve(problem, options))
    ellipse, roller = found
    assert roller.film.central == pytest.approx(ellipse.film.central, rel=3e-4)
    assert roller.film.minimum == pytest.approx(ellipse.film.minimum, rel=1e-3)
    moments = [one.traction.drilling_moment for one in found]
    assert moments[1] == pytest.approx(moments[0], rel=0.01)  # the rim on other nodes
    assert ellipse.film.minimum < 0.9 * ellipse.film.central


@pytest.mark.slow
def test_a_slow_change_of_the_load_follows_the_steady_films():
    duration, films = 2e-3, []
    for course, end in (([[0.0, 1.0], [0.4 * duration, 1.2]], duration), ([[0.0, 1.2]], 1e-5)):
        given = spinning().model_dump(exclude_none=True)
        given["transient"] = {"load": course, "duration": end, "frames": 0}
        run = solve_transient(ContactProblem.model_validate(given), Options(points=NODES))
        films.append(run.history)
    slow, there = films
    assert slow.film_central[-1] == pytest.approx(there.film_central[0], rel=1e-3)
    assert slow.film_minimum[-1] == pytest.approx(there.film_minimum[0], rel=5e-3)


def grid_of(crowding: float) -> Grid:
    ends = Domain.model_construct(x=(-3.0, 1.5), y=ROLLER_ENDS)
    return Grid(nx=NODES[0], ny=NODES[1], domain=ends, mirror=False, crowding=crowding)


def test_oil_beyond_the_inlet_comes_with_the_speed_of_its_line():
    scaled = ScaledProblem.of(spinning(spin=1000.0))  # beside one end the film moves against x
    grid, entering = grid_of(1.0), scaled.entering
    film, edges = np.full(grid.shape, 5.0), []
    slower = slowing(scaled, grid.y)
    for oil in (far_field(grid, entering), far_field(grid, entering, slower=slower)):
        pressure = np.zeros(grid.shape)
        oil.set_edges(pressure, film)
        edges.append(pressure[:, 0])
    assert slower.max() > 1.2
    np.testing.assert_allclose(edges[1], np.maximum(1.0 - slower, 0.0) * edges[0], rtol=1e-2)
    # half a turn: the same oil behind a film that moves against x
    pressure = np.zeros(grid.shape)
    wide = Domain.model_construct(x=(-1.5, 3.0), y=ROLLER_ENDS)
    turned = Grid(nx=NODES[0], ny=NODES[1], domain=wide, mirror=False, crowding=1.0)
    far_field(turned, entering, Moment(speed=-1.0), slower).set_edges(pressure, film)
    np.testing.assert_allclose(pressure[::-1, -1], edges[1], rtol=1e-9, atol=1e-15)


def test_the_drift_of_lines_has_their_distance_and_what_enters_at_the_ends_their_half_width():
    scaled = ScaledProblem.of(spinning())
    even, crowded = (entrainment(grid_of(c), scaled).drift for c in (0.0, 1.5))
    y, x = grid_of(1.5).y, grid_of(1.5).x
    for end, enters in ((0, x > 0.0), (-1, x < 0.0)):
        np.testing.assert_array_equal(even[end], np.where(enters, 2.0, 1.0) * even[16])
    ratio = (y[-1] - y[0]) / (NODES[1] - 1) / (0.5 * (y[2:] - y[:-2]))
    np.testing.assert_allclose(crowded[1:-1], ratio[:, None] * even[1:-1], rtol=1e-12)
    assert load_per_e_fold(scaled) == 0.0  # nothing is beside the ends


def test_heat_along_circles_is_that_of_even_lines_where_lines_crowd():
    """Sources are summed on even lines, whose speeds are those at their places."""
    hot = {"entrainment_speed": "4 m/s", "slide_roll_ratio": 0.1}
    scaled = ScaledProblem.of(spinning("heat", **hot))
    heat, turned = scaled.problem.heat, []
    assert heat is not None
    both = sides(scaled, heat)
    for crowding in (0.0, 1.5):
        solids = Solids(grid_of(crowding), scaled, both, 1.0, finest=True)
        turned.append(solids._turned(0, np.ones(NODES[::-1])))
    assert np.abs(turned[0]).max() > 0.0
    np.testing.assert_allclose(turned[1], turned[0], rtol=1e-9, atol=1e-12)
