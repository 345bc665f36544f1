"""Transient films between surfaces that slide across the entrainment, or spin."""

from functools import cache

import numpy as np
import pytest
from benchmarks.pairs import contact

from tehl.api.problem import ContactProblem
from tehl.api.results import TransientResult
from tehl.api.solvers import solve, solve_transient
from tehl.contact.options import Domain, Options
from tehl.operators.turning import Entrainment
from tehl.post.stress.moving import frame_loads
from tehl.post.transient import film_at
from tehl.solver.monitor import SILENT
from tehl.solver.transient.run import Run

OPTIONS = Options(points=49, tolerance=1e-7)
ACROSS = {"sliding_angle": 0.5 * np.pi}
BOTH = {"spin_1": 600.0, "spin_2": 600.0}
APART = {"spin_1": 400.0, "spin_2": -200.0, "sliding_angle": 0.4}


def case(*features: str, contact_table=None, **transient: object) -> ContactProblem:
    """Return a contact of the table of pairs that moves in another way, in time."""
    given = contact(*features).model_dump(exclude_none=True)
    given["contact"] |= contact_table or {}
    if transient:
        given["transient"] = given.get("transient", {}) | transient
    return ContactProblem.model_validate(given)


@cache
def run(motion: str, duration: float, **transient: object) -> TransientResult:
    """Return a transient run with one of the motions above."""
    tables = {"along": {}, "across": ACROSS, "both": BOTH, "apart": APART}[motion]
    stated = {name: [list(row) for row in course] for name, course in transient.items()}
    return solve_transient(
        case(contact_table=tables, **stated | {"frames": 2, "duration": duration}), OPTIONS
    )


@pytest.mark.parametrize(
    ("motion", "course"),
    [("across", "load"), ("apart", "load"), ("both", "entrainment_speed")],
)
def test_a_film_that_has_changed_slowly_is_the_steady_one(motion, course):
    """To the accuracy of the plain film: 1e-9 under the load, 1e-4 at another speed."""
    end = 1.2
    slow = run(motion, 0.005, **{course: ((0.0, 1.0), (0.002, end))}).history
    there = run(motion, 1e-5, **{course: ((0.0, end), (0.002, end))}).history
    part = 1e-7 if course == "load" else 2e-4
    for name in ("film_central", "film_minimum"):
        wanted = getattr(there, name)[0]
        assert getattr(slow, name)[-1] == pytest.approx(wanted, rel=part)
        assert wanted != pytest.approx(getattr(slow, name)[0], rel=5e-3)
    for name in ("traction", "traction_across", "drilling_moment"):
        wanted = getattr(there, name)[0]
        close = {
            "rel": 1e-6 if part < 1e-6 else 1e-2,
            "abs": 1e-7,
        }  # surfaces that spin alike: 4e-7
        assert getattr(slow, name)[-1] == pytest.approx(wanted, **close)


def test_a_film_whose_motion_spins_stays_as_it_is():
    found = run("both", 1e-3, load=((0.0, 1.0), (0.01, 1.0)))
    pressure = found.frames.pressure
    assert np.abs(pressure[-1] - pressure[0]).max() < 1e-5 * pressure[0].max()
    steady = found.start
    assert found.history.film_central[-1] == pytest.approx(steady.film.central, rel=1e-6)
    mirrored = solve_transient(
        case(
            contact_table={name: -spin for name, spin in BOTH.items()},
            duration=1e-3,
            frames=2,
        ),
        OPTIONS,
    )
    np.testing.assert_allclose(mirrored.frames.film[-1][::-1], found.frames.film[0], rtol=2e-5)


def test_forces_of_sliding_across_are_those_of_sliding_along_turned():
    """Of a Newtonian film, which depends on the mean motion alone."""
    course = {"load": ((0.0, 1.0), (0.002, 1.2))}
    along, across = (run(motion, 0.005, **course).history for motion in ("along", "across"))
    np.testing.assert_allclose(across.film_minimum, along.film_minimum, rtol=2e-4)
    np.testing.assert_allclose(across.traction_across, along.traction, rtol=1e-3)
    np.testing.assert_allclose(across.traction, 0.0, atol=1e-12)
    np.testing.assert_allclose(along.traction_across, 0.0)


def test_a_heated_film_keeps_its_temperature_while_nothing_changes():
    tables = {"spin_1": 600.0, "spin_2": -600.0, "sliding_angle": 0.5, "entrainment_speed": 1.0}
    found = solve_transient(
        case("heat", contact_table=tables, duration=2e-4, frames=0), Options(points=33)
    ).history
    rise = found.temperature_rise
    np.testing.assert_allclose(rise, rise[0], rtol=3e-3)
    np.testing.assert_allclose(found.film_central, found.film_central[0], rtol=2e-4)
    np.testing.assert_allclose(found.drilling_moment, found.drilling_moment[0], rtol=2e-3)


def test_heat_in_time_of_sliding_across_goes_to_both_sides_alike():
    """Surfaces of one material: turning the sliding by half a turn mirrors the film."""
    one, other = (
        solve_transient(
            case("heat", "load", contact_table={"sliding_angle": angle}, duration=1e-4, frames=2),
            Options(points=49),
        )
        for angle in (0.5 * np.pi, -0.5 * np.pi)
    )
    np.testing.assert_allclose(other.frames.film[-1][::-1], one.frames.film[-1], rtol=1e-4)
    parts = one.history.traction_across, other.history.traction_across
    np.testing.assert_allclose(parts[0], -parts[1], rtol=1e-3)


def test_a_dent_goes_where_its_surface_does():
    """On the circle of its surface, and through the contact when it should be there."""
    dent = {"type": "bump", "amplitude": -1e-7, "radius": 3e-5, "x": -1.7e-4, "y": 2e-5}
    given = case(contact_table={"spin_1": 2000.0, "spin_2": -500.0}).model_dump(exclude_none=True)
    given["surface_1"]["roughness"] = dent
    given["transient"] = {"duration": 3e-4, "frames": 4}
    found = solve_transient(ContactProblem.model_validate(given), Options(points=65))
    motion, x, y = found.start.problem.motion, found.x, found.y
    for frame, step in enumerate(found.frames.step):
        time, spin = float(found.history.time[step]), motion.spin_1
        radius = motion.speed_1 / spin  # it turns about the place at rest, (0, radius)
        cosine, sine = np.cos(spin * time), np.sin(spin * time)
        place = cosine * dent["x"] - sine * (dent["y"] - radius)
        aside = sine * dent["x"] + cosine * (dent["y"] - radius) + radius
        heights = found.frames.height[frame]
        row, column = np.unravel_index(int(heights.argmin()), heights.shape)
        assert x[column] == pytest.approx(place, abs=0.6 * (x[1] - x[0]))
        assert y[row] == pytest.approx(aside, abs=0.6 * (y[1] - y[0]))
        own = film_at(found, frame).heights.surface_1
        np.testing.assert_allclose(own, heights, atol=1e-12)


def test_oil_is_conserved_where_the_motion_spins():
    """What the contact holds changes by what the pressure and the motion carry out of it.

    To second order, and as well as without spin.
    """
    coarse, fine = (missing_oil(nodes, **BOTH) for nodes in (65, 129))
    assert fine < 0.003
    assert fine < 0.25 * coarse
    assert fine == pytest.approx(missing_oil(129), rel=0.05)


def missing_oil(nodes: int, **turn: float) -> float:
    """Return the oil that is missing in a rectangle without cavities, over that which enters."""
    problem = case("load", contact_table=turn, frames=0, duration=2e-4)
    assert problem.transient is not None
    box = Domain(x=(-3.0, 2.0), y=(-2.5, 2.5))
    options = Options(points=nodes, domain=box, half_domain="never")
    whole = Run(problem, options, problem.transient, SILENT)
    level, oil, grid = whole.level, whole.stepper.oil, whole.level.grid
    inside = (np.abs(grid.y) < 0.6)[:, None] & (grid.x > -1.2) & (grid.x < 0.5)
    ways = oil.ways if turn else Entrainment(np.ones(grid.ny), np.zeros(grid.shape))
    for step in range(1, whole.steps + 1):
        before, places = oil.now.copy(), whole.schedule.places(step)
        whole.stepper.step(sum(whole.heights.at(step * whole.seconds, places)), step)
    gained = (oil.now - before)[inside].sum() * grid.dx * grid.dy / whole.schedule.step
    out = _outflow(level, oil.now, ways, inside)
    return abs(out + gained) / _entering(oil.now, inside, grid.dy)


def _outflow(level, mass, ways, inside) -> float:
    """Return the oil that leaves a rectangle of nodes by motion and pressure [-]."""
    film, grid = level.film, level.grid
    rows, columns = np.flatnonzero(inside.any(axis=1)), np.flatnonzero(inside.any(axis=0))
    total = 0.0
    for edge, sign in ((columns[-1], 1), (columns[0] - 1, -1)):
        west, east = np.s_[rows, edge], np.s_[rows, edge + 1]
        moved = ways.speed[rows] * 0.5 * (mass[west] + mass[east])
        pressed = 0.5 * (film.eps[west] + film.eps[east]) * (film.p[east] - film.p[west]) / grid.dx
        total += sign * (moved - pressed).sum() * grid.dy
    for edge, sign in ((rows[-1], 1), (rows[0] - 1, -1)):
        south, north = np.s_[edge, columns], np.s_[edge + 1, columns]
        drift = ways.drift[0, columns] * grid.dy / grid.dx
        moved = drift * 0.5 * (mass[south] + mass[north])
        pressed = 0.5 * (film.eps[south] + film.eps[north]) * (film.p[north] - film.p[south])
        total += sign * (moved - pressed / grid.dy).sum() * grid.dx
    return float(total)


def _entering(mass, inside, spacing) -> float:
    """Return the oil that enters a rectangle at unit speed [-]."""
    column = int(np.flatnonzero(inside.any(axis=0))[0])
    return float(mass[inside.any(axis=1), column].sum() * spacing)


def test_a_run_goes_on_from_a_checkpoint_where_surfaces_spin():
    faster = APART | {"entrainment_speed": 1.0}
    problem = case("heat", "load", contact_table=faster, duration=1e-4, frames=0)
    kept = []
    whole = solve_transient(problem, Options(points=33), keep=lambda one: kept.append(one.copy()))
    again = solve_transient(problem, Options(points=33), resume=kept[len(kept) // 2])
    np.testing.assert_array_equal(again.history.film_central, whole.history.film_central)
    np.testing.assert_array_equal(again.history.temperature_rise, whole.history.temperature_rise)


def test_steady_films_start_at_the_speed_of_the_moment():
    """Spin lowers the film of a run that begins at another speed as it does that of this speed."""
    fast = {"entrainment_speed": 1.5 * contact().entrainment_speed}
    begun = {"duration": 1e-5, "frames": 0, "entrainment_speed": [[0.0, 1.5]]}
    spun, plain = (
        solve_transient(case(contact_table=turn, **begun), OPTIONS).start.film.minimum
        for turn in (BOTH, {})
    )
    alike, wanted = (
        solve(case(contact_table=fast | turn), Options(points=65)).film.minimum
        for turn in (BOTH, {})
    )
    assert alike / wanted < 0.985
    assert spun / plain == pytest.approx(alike / wanted, rel=1e-3)


def test_the_traction_across_loads_the_bodies_along_y():
    """Of sliding across what sliding along has along x, the rolling part apart."""
    course = {"load": ((0.0, 1.0), (0.002, 1.2))}
    along, across = (run(motion, 0.005, **course) for motion in ("along", "across"))
    loads = [frame_loads(one, 1, 1) for one in (along, across)]
    turned = loads[1].traction_y - loads[0].traction_y
    wanted = loads[0].traction_x - loads[1].traction_x
    np.testing.assert_allclose(turned, wanted, atol=2e-3 * np.abs(wanted).max())


def test_a_hot_line_that_slides_across_is_carried_along_in_time():
    """Its motion changes, so that the surfaces carry their heat along paths: by a thousandth."""
    given = case("line", "heat", contact_table={"slide_roll_ratio": 0.5} | ACROSS)
    steady = solve(given, Options(points=(129, 1)))
    course = [[0.0, 1.0], [2e-4, 1.001]]
    moving = given.model_dump(exclude_none=True)
    moving["transient"] = {"entrainment_speed": course, "duration": 2e-4}
    found = solve_transient(ContactProblem.model_validate(moving), Options(points=(129, 1)))
    rise, film = found.history.temperature_rise, found.history.film_central
    assert rise[0] > 1.0
    assert rise[-1] == pytest.approx(rise[0], rel=5e-3)
    assert film[-1] == pytest.approx(steady.film.central, rel=2e-3)
