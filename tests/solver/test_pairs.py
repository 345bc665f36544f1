"""Contact through a boundary film together with the other physics: limits that must hold."""

from functools import cache

import numpy as np
import pytest
from benchmarks.pairs import NAMES, WAVE, WAYS, contact, outcome
from scipy.integrate import quad

from benchmarks import any_contacts
from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.api.solvers import solve, solve_transient
from tehl.cli.text import as_text
from tehl.contact.options import Options
from tehl.post import boundary_contact
from tehl.post.bodies import heat_into_bodies
from tehl.post.boundary_contact import touching_nodes
from tehl.post.roughness import rough_film
from tehl.report.page import report_text
from tests.solver.runs import rubbed_states

TIGHT = Options(points=65, accuracy="tight")
BESIDE_CONTACT = ("heat", "thinning", "starved", "conserving", "asperities")


@cache
def solved(*features: str, **changes: object) -> Result:
    return solve(changed(contact(*features), **changes), TIGHT)


def changed(problem: ContactProblem, **tables: object) -> ContactProblem:
    given = problem.model_dump(exclude_none=True)
    for name, table in tables.items():
        given[name] = given.get(name, {}) | table
    return ContactProblem.model_validate(given)


@pytest.mark.parametrize("other", BESIDE_CONTACT)
def test_a_boundary_film_below_that_of_the_oil_leaves_it_as_it_is(other: str):
    alone = solved(other)
    thin = changed(contact(other, "boundary"), contact_film={"thickness": 1e-10})
    found = solve(thin, TIGHT)
    assert found.touching.share == 0.0
    assert found.scaled.film == pytest.approx(alone.scaled.film, rel=2e-3, abs=1e-5)
    assert found.scaled.film.min() == pytest.approx(alone.scaled.film.min(), rel=1e-4)
    if other == "heat":
        rise = alone.temperature.film_rise_max
        assert found.temperature.film_rise_max == pytest.approx(rise, rel=1e-4)


@pytest.mark.parametrize(
    ("other", "tables"),
    [
        ("thinning", {"lubricant": {"shear": {"law": "eyring", "stress": 1e12}}}),
        ("conserving", {}),
        ("starved", {"supply": {"layer": 1e-4}}),
        ("asperities", {"asperities": {"rms": 2e-9, "summit_radius": 1e-3}}),
    ],
)
def test_grooves_that_touch_are_those_without_the_other_physics_in_its_limit(other, tables):
    """No thinning, cavities behind the contact, oil in plenty, asperities that are very low."""
    lubricant = {"lubricant": {"shear": {"law": "newtonian"}}} if other != "thinning" else {}
    alone = touching_grooves()
    found = solve(changed(grooves("boundary", other), **(lubricant | tables)), TIGHT)
    assert 0.3 < alone.touching.share < 0.9
    assert found.touching.share == pytest.approx(alone.touching.share, abs=5e-3)
    assert found.film.central == pytest.approx(alone.film.central, rel=2e-3)


@cache
def touching_grooves() -> Result:
    return solve(grooves("boundary"), TIGHT)


def grooves(*features: str, thickness: float = 1.2e-7) -> ContactProblem:
    rough = WAVE | {"amplitude": "0.3 um", "phase": "180 deg"}
    tables = {"surface_1": {"roughness": rough}, "contact_film": {"thickness": thickness}}
    return changed(contact(*features), **tables)


def test_the_heat_of_a_contact_is_its_friction(monkeypatch):
    """Flux into both surfaces = friction coefficient, load where they touch, sliding speed."""
    states = rubbed_states(monkeypatch)
    found = solve(grooves("boundary", "heat"), TIGHT)
    state, scales = states[-1], found.scales
    flux = state.film.flux_unit * state.grid.unfold(sum(state.solids.rubbing).T)
    cell = state.grid.dx * state.grid.dy * scales.half_width_x * scales.half_width_y
    assert found.touching.power_boundary > 0.05
    assert flux.sum() * cell == pytest.approx(found.touching.power_boundary, rel=1e-8)
    into_film, into_bodies = found.heat.balance, sum(heat_into_bodies(found))
    rubbed = into_bodies - into_film.surface_1 - into_film.surface_2
    assert rubbed == pytest.approx(found.touching.power_boundary, rel=1e-9)
    meets, heated = touching_nodes(found), state.grid.unfold(state.view("shear").T.copy())
    assert meets.sum() > 50
    assert (heated[meets] == 0.0).all()  # the surfaces rub there in place of the oil
    assert (heated[~meets] > 0.0).any()


def test_a_nearly_dry_contact_is_that_of_hertz_and_a_moving_source():
    """Both surfaces as warm as line sources of friction under the Hertz pressure make them."""
    solid = {"young_modulus": 206e9, "poisson_ratio": 0.3, "density": 6000.0}
    solid |= {"heat_capacity": 450.0, "conductivity": 2.2}
    found = solve(
        changed(
            contact("heat", "boundary"),
            contact={"load": 20.0, "entrainment_speed": 0.5, "slide_roll_ratio": 0.2},
            surface_1={"material": solid},
            surface_2={"material": solid},
            contact_film={"thickness": 5e-7, "friction": 0.1},
        ),
        Options(points=65),
    )
    shared, scales, motion = found.touching, found.scales, found.problem.motion
    assert 0.93 < shared.share < 0.96
    assert shared.pressure_max == pytest.approx(scales.hertz_pressure, rel=0.02)
    speeds = np.array([motion.speed_1, motion.speed_2])
    product = solid["conductivity"] * solid["density"] * solid["heat_capacity"]
    part = np.sqrt(speeds) / np.sqrt(speeds).sum()
    integral = max(
        quad(lambda s: np.sqrt(1.0 - s * s), -1.0, x, weight="alg", wvar=(0.0, -0.5))[0]
        for x in np.linspace(-0.9, 1.0, 39)
    )
    flux = 0.1 * shared.share * scales.hertz_pressure * abs(speeds[0] - speeds[1])
    rise = part * flux * np.sqrt(scales.half_width_x / (np.pi * product * speeds)) * integral
    walls = found.heat.temperature[[0, -1]].max(axis=(1, 2)) - scales.temperature
    assert walls == pytest.approx(rise, rel=0.03)


@pytest.mark.parametrize("load", [pytest.param(1.0, marks=pytest.mark.slow), 0.8])
def test_friction_in_time_is_that_of_film_and_solids(load: float):
    """Under a load that differs from that of the contact both are parts of the present one."""
    tables = {"roughness": WAVE | {"amplitude": "0.3 um", "phase": "180 deg"}}
    problem = changed(
        contact("heat", "boundary"),
        surface_1=tables,
        contact={"slide_roll_ratio": -0.9},
        contact_film={"thickness": 1.2e-7},
        transient={
            "duration": 2e-4,
            "start": "standing",
            "frames": 0,
            "load": [[0.0, load], [2e-4, load]],
        },
    )
    run = solve_transient(problem, Options(points=65))
    history, shared = run.history, run.start.touching
    assert run.status.converged
    assert run.start.load == pytest.approx(load * problem.load)
    assert history.asperity_load == pytest.approx(shared.share, rel=1e-3)
    assert history.solid_friction[0] == pytest.approx(shared.friction_boundary, rel=1e-9)
    assert np.ptp(history.temperature_rise) < 0.01 * history.temperature_rise[0]


@pytest.mark.usefixtures("unrendered")
@pytest.mark.parametrize("other", [name for name in NAMES if name not in ("boundary", "spin")])
def test_each_physics_works_with_a_boundary_film(other: str):
    assert outcome((other, "boundary"), 49, "report") == "works"


@pytest.mark.parametrize("way", [way for way in WAYS if way not in ("solve", "report")])
def test_a_heated_contact_through_a_boundary_film_works_each_way(way: str):
    assert outcome(("heat", "boundary"), 65, way) == "works"


def test_a_film_that_may_touch_is_heated_on_coarser_grids_too():
    """The nodes that touch follow the heat: to find them on the finest grid takes many cycles."""
    found = solve(contact("heat", "boundary"), Options(points=129))
    rises = {one.points[0]: one.temperature_rise for one in found.history}
    assert rises[65] == pytest.approx(rises[129], rel=0.1)


@pytest.mark.slow
def test_a_contact_that_spreads_as_it_heats_is_followed_to_its_end():
    """Hot oil leaves it, surfaces touch where it was and rub: its rim moves a little per cycle."""
    _, _, problem = any_contacts.contact(1, 53, tables_at_once=True)
    found = solve(problem, Options(points=81))
    assert found.status.converged
    assert 0.8 < found.touching.share < 0.9


def test_the_oil_stays_balanced_while_heat_and_thinning_still_change():
    """Oil that is solved again at a fixed film, as the heat goes on, loses the load.

    On 65 nodes the film errs by a half, and by its last digits too much to be a result.
    """
    _, _, problem = any_contacts.contact(1, 87, tables_at_once=True)
    steady = problem.model_copy(update={"transient": None})
    found = solve(steady, Options(points=97, accuracy="tight", tolerance=1e-7))
    assert found.status.converged
    assert abs(found.history[-1].load_error) < 1e-9


def test_a_study_of_a_transient_run_works():
    assert outcome(("load",), 49, "study") == "works"


@pytest.mark.usefixtures("no_pictures")
def test_the_text_states_the_friction_of_film_contact_and_asperities_together(monkeypatch):
    monkeypatch.setattr(boundary_contact, "LEAST_CELLS", 0.0)  # the share of few cells
    monkeypatch.setattr(boundary_contact, "LARGEST_SHARE_BAR", 1.0)
    found = solve(grooves("boundary", "asperities"), Options(points=65))
    shared, apart = found.touching, found.load_sharing
    assert 0.3 < shared.share < shared.share + apart.share < 1.0
    total = shared.friction_film + shared.friction_boundary + apart.friction_boundary
    text = as_text(found)
    assert f"friction         {total:.3g}: film" in text
    assert text.count("  friction    ") == 1
    assert "friction" in report_text(found, dpi=30)
    assert rough_film(found).share == pytest.approx(shared.share + apart.share)


def test_stated_roughness_decides_the_lubrication_beside_a_contact_of_smooth_surfaces():
    """It is not computed: that nothing touches on the grid does not make the film a full one."""
    bare = contact("boundary").model_dump(exclude_none=True)
    bare["surface_1"]["rms_roughness"] = 0.5e-6
    found = solve(ContactProblem.model_validate(bare), Options(points=49))
    rough = rough_film(found)
    assert found.touching.share == 0.0
    assert rough.share is None
    assert rough.lambda_central < 1.0
    assert rough.lubrication == "boundary"
